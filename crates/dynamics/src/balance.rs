//! Balancing masses: rest at any pose, no shaking force, or as little of it as a counterweight can leave.

use kempe_linear::independent_least_squares;
use kempe_number::math;

use crate::acting::Acting;
use crate::instant::Instant;

/// A counterweight: its first moment about the pivot of its link, in the link's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counterweight {
    /// Mass times distance along the link's axes, kg m.
    pub first_moment: [f64; 2],
    /// What is left of the quantity that was to vanish, over what there was without the counterweight.
    pub left: f64,
}

impl Counterweight {
    /// Mass needed at a distance from the pivot, kg.
    pub fn mass_at(&self, radius: f64) -> f64 {
        math::hypot(self.first_moment[0], self.first_moment[1]) / radius
    }

    /// Direction from the pivot to the mass in the link's axes, rad.
    pub fn direction(&self) -> f64 {
        math::atan2(self.first_moment[1], self.first_moment[0])
    }
}

/// First harmonics of a turning vector over a full turn of a crank: `sum over k of forward_k e^{i k q} + back_k e^{-i k q}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    /// Mean.
    pub mean: [f64; 2],
    /// Complex amplitudes (real, imaginary) turning with the crank, k = 1, 2, ...
    pub forward: Vec<[f64; 2]>,
    /// Complex amplitudes turning against it.
    pub back: Vec<[f64; 2]>,
}

/// Harmonics of a vector given at evenly spread crank angles over one turn (the first at `start`, the turn's end left
/// out). Exact for as many harmonics as half the number of samples, less one.
pub fn harmonics(samples: &[[f64; 2]], start: f64, count: usize) -> Harmonics {
    let n = samples.len().max(1) as f64;
    let amplitude = |k: f64| {
        let mut sum = [0.0; 2];
        for (i, v) in samples.iter().enumerate() {
            let (s, c) = math::sin_cos(-k * (start + std::f64::consts::TAU * i as f64 / n));
            sum[0] += v[0] * c - v[1] * s;
            sum[1] += v[0] * s + v[1] * c;
        }
        sum.map(|x| x / n)
    };
    Harmonics {
        mean: amplitude(0.0),
        forward: (1..=count).map(|k| amplitude(k as f64)).collect(),
        back: (1..=count).map(|k| amplitude(-(k as f64))).collect(),
    }
}

/// The counterweight on a crank that takes away the part of the shaking force that turns with it.
///
/// At the constant speed `w` a first moment `u` (complex, in the crank's axes) shakes with `u w^2 e^{i q}`, so
/// `u = -forward_1 / w^2` takes the first harmonic that turns with the crank away whole; the one that turns against it
/// can only be balanced by a shaft that turns against it (F. W. Lanchester, 1911). `samples` are shaking forces at
/// evenly spread crank angles over one turn.
pub fn crank_counterweight(samples: &[[f64; 2]], start: f64, speed: f64) -> Counterweight {
    let first = harmonics(samples, start, 1).forward[0];
    let square = speed * speed;
    let u = first.map(|x| -x / square);
    let n = samples.len().max(1) as f64;
    let (mut before, mut after) = (0.0, 0.0);
    for (i, v) in samples.iter().enumerate() {
        let (s, c) = math::sin_cos(start + std::f64::consts::TAU * i as f64 / n);
        let taken = [
            (u[0] * c - u[1] * s) * square,
            (u[0] * s + u[1] * c) * square,
        ];
        before += v[0] * v[0] + v[1] * v[1];
        after += kempe_number::powi(v[0] + taken[0], 2) + kempe_number::powi(v[1] + taken[1], 2);
    }
    Counterweight {
        first_moment: u,
        left: ratio(after, before),
    }
}

/// The first moments (kg m, along the axes of their links) of counterweights on links that turn about fixed pivots,
/// chosen together: what is left of a quantity over a motion is least in the sense of least squares.
///
/// `before` is the quantity at all places of the motion, such as both components of the shaking force; `units` holds for
/// each link what a first moment of 1 kg m along its x axis and along its y axis adds to it. The quantity must be linear
/// in the first moments, as shaking force and the reduced load of gravity are. Where several choices are equally good,
/// the links that help most get the weight and the others none.
pub fn counterweights(before: &[f64], units: &[[Vec<f64>; 2]]) -> Vec<[f64; 2]> {
    let columns: Vec<&[f64]> = units.iter().flatten().map(Vec::as_slice).collect();
    let found = independent_least_squares(&columns, before);
    found.chunks_exact(2).map(|u| [-u[0], -u[1]]).collect()
}

/// The total mass (kg) and the common centre of all moving masses (m): a mechanism whose centre stands still has no
/// shaking force.
pub fn common_center(acting: &Acting<f64>, at: &Instant<f64>) -> (f64, [f64; 2]) {
    let (mut total, mut moment) = (0.0, [0.0; 2]);
    for mass in &acting.masses {
        let place = at.place(mass.body, mass.arm(at));
        total += mass.mass;
        moment[0] += mass.mass * place[0];
        moment[1] += mass.mass * place[1];
    }
    (total, moment.map(|m| m / total))
}

fn ratio(after: f64, before: f64) -> f64 {
    if before > 0.0 {
        (after / before).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_mass_is_balanced_whole_and_a_sliding_one_by_half() {
        let n = 24;
        let at = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
        // 2 kg at 0.1 m, 30 degrees ahead on the crank, at 5 rad/s.
        let turning: Vec<[f64; 2]> = (0..n)
            .map(|k| {
                let (s, c) = math::sin_cos(at(k) + 0.5235987755982988);
                [0.2 * 25.0 * c, 0.2 * 25.0 * s]
            })
            .collect();
        let weight = crank_counterweight(&turning, 0.0, 5.0);
        assert!(weight.left < 1e-14);
        assert!((weight.mass_at(0.1) - 2.0).abs() < 1e-13);
        let opposite = 0.5235987755982988 - std::f64::consts::PI;
        assert!((weight.direction() - opposite).abs() < 1e-13);
        let sliding: Vec<[f64; 2]> = (0..n).map(|k| [5.0 * math::cos(at(k)), 0.0]).collect();
        let weight = crank_counterweight(&sliding, 0.0, 5.0);
        assert!((weight.first_moment[0] + 0.1).abs() < 1e-14);
        assert!((weight.left - 0.5_f64.sqrt()).abs() < 1e-14);
        let found = harmonics(&sliding, 0.0, 2);
        assert!(
            (found.forward[0][0] - 2.5).abs() < 1e-14 && (found.back[0][0] - 2.5).abs() < 1e-14
        );
        assert!(found.forward[1][0].abs() < 1e-14);
    }

    /// What a first moment along x and along y on a crank at constant speed shakes with.
    fn on_crank(angles: &[f64], speed: f64) -> [Vec<f64>; 2] {
        let turned = |ahead: f64| {
            let both = angles.iter().flat_map(|q| {
                let (s, c) = math::sin_cos(q + ahead);
                [c * speed * speed, s * speed * speed]
            });
            both.collect()
        };
        [turned(0.0), turned(std::f64::consts::FRAC_PI_2)]
    }

    #[test]
    fn least_squares_agree_with_harmonics_at_constant_speed() {
        let n = 36;
        let angles: Vec<f64> = (0..n)
            .map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(n))
            .collect();
        let forces: Vec<[f64; 2]> = angles
            .iter()
            .map(|q| {
                [
                    math::cos(*q) + 0.3 * math::cos(2.0 * q),
                    0.4 * math::sin(*q),
                ]
            })
            .collect();
        let by_harmonics = crank_counterweight(&forces, 0.0, 3.0).first_moment;
        let before: Vec<f64> = forces.iter().flatten().copied().collect();
        let unit = on_crank(&angles, 3.0);
        // A second crank in step with the first can do no more, and gets nothing.
        let by_squares = counterweights(&before, &[unit.clone(), unit]);
        for k in 0..2 {
            assert!((by_harmonics[k] - by_squares[0][k] - by_squares[1][k]).abs() < 1e-14);
            assert!(by_squares[0][k] == 0.0 || by_squares[1][k] == 0.0);
        }
    }

    #[test]
    fn two_cranks_are_balanced_together() {
        let angles: Vec<f64> = (0..24).map(|k| 0.25 * f64::from(k)).collect();
        let (first, second) = (
            on_crank(&angles, 3.0),
            on_crank(&angles.iter().map(|q| -2.0 * q).collect::<Vec<_>>(), 6.0),
        );
        let wanted = [[0.3, -0.1], [-0.02, 0.05]];
        let before: Vec<f64> = (0..48)
            .map(|i| {
                let part =
                    |unit: &[Vec<f64>; 2], u: [f64; 2]| unit[0][i] * u[0] + unit[1][i] * u[1];
                -part(&first, wanted[0]) - part(&second, wanted[1])
            })
            .collect();
        let found = counterweights(&before, &[first, second]);
        for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
        }
    }
}
