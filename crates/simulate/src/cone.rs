//! Forces of contacts that are rigid and may rub: none pulls, and friction stays in Coulomb's cone.
//!
//! Rows are those of [`crate::sticking`]: a force along one changes how fast all of them accelerate, or an impulse their speeds. What
//! slides in a known sense rubs in proportion to what presses there, so that its push acts along another row than that of its gap.

use kempe_linear::{Qr, complementary};

use crate::vector::dot;

/// How much friction can do in a place that may stick.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Limit {
    /// So much, whatever presses.
    Fixed(f64),
    /// So many times what the push does of this index.
    OfPush(usize, f64),
}

/// Rows along which bodies press, and behind them such along which they may stick.
pub(crate) struct Cones<'a> {
    /// How fast gaps open and places slide.
    pub rows: &'a [Vec<f64>],
    /// The rows along which forces act.
    pub by: &'a [Vec<f64>],
    /// Of the rows that may stick.
    pub limits: &'a [Limit],
}

impl Cones<'_> {
    /// The forces along the rows, where these are their rates without them: no gap closes, and what is pushed at does not open; what may
    /// stick has no rate, or its force is at its limit against it. Nothing where no forces do that.
    pub fn forces(&self, free: &[f64]) -> Option<Vec<f64>> {
        let (all, places) = (self.rows.len(), self.limits.len());
        let pushes = all - places;
        // Rows of unit length: what turns and what slides have nothing to do with each other's units.
        let long: Vec<f64> = (self.rows.iter())
            .map(|row| match dot(row, row).sqrt() {
                0.0 => 1.0,
                long => long,
            })
            .collect();
        let yields: Vec<Vec<f64>> = (self.rows.iter().zip(&long))
            .map(|(row, own)| {
                let by = self.by.iter().zip(&long);
                by.map(|(by, long)| dot(row, by) / (own * long)).collect()
            })
            .collect();
        // Pushes, friction against each sense, and how fast each place slides.
        let row_of = |k: usize| if k < pushes + places { k } else { k - places };
        let against = |k: usize| if k < pushes + places { 1.0 } else { -1.0 };
        let first_speed = pushes + 2 * places;
        let entry =
            |i: usize, j: usize| match (i.checked_sub(first_speed), j.checked_sub(first_speed)) {
                (None, None) => against(i) * against(j) * yields[row_of(i)][row_of(j)],
                (None, Some(place)) => {
                    f64::from(u8::from(i >= pushes && row_of(i) == pushes + place))
                }
                (Some(place), None) => match self.limits[place] {
                    _ if j >= pushes => -f64::from(u8::from(row_of(j) == pushes + place)),
                    Limit::OfPush(push, times) if push == j => {
                        times * long[pushes + place] / long[push]
                    }
                    Limit::OfPush(..) | Limit::Fixed(_) => 0.0,
                },
                (Some(_), Some(_)) => 0.0,
            };
        let right = |i: usize| match i.checked_sub(first_speed) {
            None => against(i) * free[row_of(i)] / long[row_of(i)],
            Some(place) => match self.limits[place] {
                Limit::Fixed(limit) => limit * long[pushes + place],
                Limit::OfPush(..) => 0.0,
            },
        };
        let q: Vec<f64> = (0..first_speed + places).map(right).collect();
        let found = complementary(entry, &q)?;
        let force = |k: usize| match k < pushes {
            true => found[k] / long[k],
            false => (found[k] - found[k + places]) / long[k],
        };
        Some((0..all).map(force).collect())
    }
}

/// What is left of the determinant that yields of pushes have without friction, with it. Where it comes to zero, what slides presses
/// bodies together as fast as pushes hold them apart (P. Painlevé, 1895).
pub(crate) fn left_by_friction(smooth: &[Vec<f64>], rubbing: &[Vec<f64>]) -> f64 {
    determinant(rubbing) / determinant(smooth)
}

fn determinant(matrix: &[Vec<f64>]) -> f64 {
    let n = matrix.len();
    let mut factors = Qr::with_capacity(n, n);
    factors.reset(n, n);
    for (r, row) in matrix.iter().enumerate() {
        for (c, x) in row.iter().enumerate() {
            factors.add(r, c, *x);
        }
    }
    factors.factor();
    factors.determinant()
}
