//! A box that Krawczyk's operator maps into itself.

use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Situation;
use kempe_mechanism::pose::Pose;
use kempe_number::{Interval, Number, math};

use super::given::Given;
use super::system::System;
use crate::not_proved::NotProved;

/// Boxes tried before a proof is given up.
const INFLATIONS: usize = 12;
/// How much wider than the last image the next box is.
const INFLATION: f64 = 1.1;
/// Absolute part of the inflation, in mechanism sizes and rad: a box must have an interior.
const SMALLEST: f64 = 1e-17;
/// Sums of `n` non-negative numbers are too small by less than this part, for every n below 10^3.
const SUMMED: f64 = 1.0 + 1e-12;
/// Half widths (mechanism sizes and rad) of the boxes tried for uniqueness once a pose is proved, the widest first.
const ROOMS: [f64; 9] = [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11];
/// Inflations of each of them.
const ROOM_TRIES: usize = 3;

impl System {
    /// Finds a box of corrections that Krawczyk's operator maps into itself: its half widths, and the image. With
    /// `widen` the half widths are those of a larger box, in which the zero is still the only one.
    ///
    /// `value` encloses Y F at the middle, `spread` gives the poses for a reach.
    pub(super) fn contract(
        &self,
        given: &Given<'_>,
        inverse: &[f64],
        value: &[Interval],
        widen: bool,
        poses: &mut [Pose<Interval>],
        mut spread: impl FnMut(&[Interval], &mut [Pose<Interval>]),
    ) -> Result<(Vec<f64>, Vec<Interval>), NotProved> {
        let units = self.units(given.size);
        let least = |i: usize| value[i].mag() * INFLATION + SMALLEST * units[i];
        let mut deviation = Vec::new();
        let mut attempt = |mut radii: Vec<f64>, tries: usize| {
            for _ in 0..tries {
                let reach: Vec<Interval> = radii.iter().map(|r| Interval::new(-r, *r)).collect();
                spread(&reach, poses);
                let situation = given.situation(poses);
                self.deviation(given.mechanism, &situation, inverse, &mut deviation);
                let image: Vec<Interval> = (deviation.chunks_exact(self.size).zip(value))
                    .map(|(row, value)| {
                        let products = row.iter().zip(&radii).map(|(m, r)| m.mag() * r);
                        let sum = products.sum::<f64>() * SUMMED;
                        Interval::new(-sum, sum) - *value
                    })
                    .collect();
                // An empty or undefined image is inside nothing.
                if image
                    .iter()
                    .zip(&reach)
                    .all(|(image, reach)| image.is_inside_interior(*reach))
                {
                    return Some((radii, image));
                }
                // Grow only: a box that shrinks in one unknown while it grows in another may go round in circles.
                for (i, radius) in radii.iter_mut().enumerate() {
                    let next = image[i].mag() * INFLATION + SMALLEST * units[i];
                    *radius = math::max(*radius, next);
                    if !radius.is_finite() {
                        return None;
                    }
                }
            }
            None
        };
        let tight = (0..self.size).map(least).collect();
        let (radii, image) = attempt(tight, INFLATIONS).ok_or(NotProved::Wide)?;
        if widen {
            for room in ROOMS {
                let floor = radii
                    .iter()
                    .zip(&units)
                    .map(|(r, unit)| math::max(*r, room * unit));
                if let Some((wide, _)) = attempt(floor.collect(), ROOM_TRIES) {
                    return Ok((wide, image));
                }
            }
        }
        Ok((radii, image))
    }

    /// I - Y J, a sparse J entry by entry, row after row.
    fn deviation(
        &self,
        mechanism: &Mechanism,
        situation: &Situation<'_, Interval>,
        inverse: &[f64],
        out: &mut Vec<Interval>,
    ) {
        let n = self.size;
        let zero = Interval::from_f64(0.0);
        out.clear();
        out.resize(n * n, zero);
        for i in 0..n {
            out[i * n + i] = Interval::from_f64(1.0);
        }
        self.jacobian(mechanism, situation, |row, column, entry| {
            if entry == zero {
                return;
            }
            for i in 0..n {
                let y = inverse[i * n + row];
                if y != 0.0 {
                    out[i * n + column] -= entry * y;
                }
            }
        });
    }
}

/// Matrix times vector, the matrix exact.
pub(super) fn multiply(matrix: &[f64], vector: &[Interval]) -> Vec<Interval> {
    matrix
        .chunks_exact(vector.len().max(1))
        .map(|row| {
            row.iter()
                .zip(vector)
                .fold(Interval::from_f64(0.0), |sum, (y, f)| {
                    if *y == 0.0 { sum } else { sum + *f * *y }
                })
        })
        .collect()
}
