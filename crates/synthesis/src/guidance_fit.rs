//! Six and more poses: dyads that come near to all of them.
//!
//! No link keeps so many poses but by chance. The exact dyads of five of them (of fewer where pivots are given) are starts, from which
//! K. Levenberg's and D. Marquardt's method goes to the nearest minimum of the sum of |place(moving) - fixed| - length squared.

use kempe_linear::{C, Qr, Residuals, smallest_squares};
use kempe_number::math;

use crate::displacements::Displacements;
use crate::dyad::{Dyad, same};
use crate::error::{SynthesisError, all_finite};
use crate::motion::{DyadCondition, dyads};
use crate::pose::{Line, Pose};

/// A dyad that comes near to poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DyadFit {
    /// The dyad, of two pins.
    pub dyad: Dyad,
    /// Root of the mean square of [`Dyad::residual`] over the poses.
    pub rms: f64,
}

/// Sets of poses from which starts are taken.
const STARTS: usize = 60;
/// A minimum with a pivot further away, in parts of the poses' spread and the body's, is one at infinity.
const REACH: f64 = 1e4;

/// Dyads of two pins at local minima of the sum of squares of their residuals over all poses, the best first; conditions are kept exactly.
///
/// # Errors
/// As of [`dyads`], where no set of the poses has a start; fewer poses than determine the dyad.
pub fn fit_dyads(
    poses: &[Pose],
    conditions: &[DyadCondition],
) -> Result<Vec<DyadFit>, SynthesisError> {
    let finite = poses.iter().map(Pose::is_finite);
    all_finite(finite.chain(conditions.iter().map(DyadCondition::is_finite)))?;
    let asked: usize = conditions.iter().map(DyadCondition::equations).sum();
    // Poses of an exact start; a dyad that is wholly given needs none, and has only its length to find.
    let exact = UNKNOWN_POSES.saturating_sub(asked);
    if poses.len() < exact.max(1) {
        return Err(SynthesisError::TooFew {
            equations: (poses.len() + asked).saturating_sub(1),
            unknowns: UNKNOWN_POSES - 1,
        });
    }
    let displacements = Displacements::new(poses)?;
    let problem = Problem::new(poses, conditions)?;
    let mut found: Vec<DyadFit> = Vec::new();
    let mut refused = None;
    for set in subsets(poses.len(), exact, STARTS) {
        let chosen: Vec<Pose> = set.iter().map(|k| poses[*k]).collect();
        let starts = match dyads(&chosen, conditions) {
            Ok(starts) => starts,
            Err(error) => {
                refused.get_or_insert(error);
                continue;
            }
        };
        for start in starts {
            let Dyad::Rr { fixed, moving, .. } = start.dyad else {
                continue;
            };
            let Some(fit) = problem.fit(fixed, moving) else {
                continue;
            };
            if fit.dyad.reach() > REACH * displacements.scale {
                continue;
            }
            let known = found
                .iter()
                .any(|f| same(&f.dyad, &fit.dyad, NEAR * displacements.scale));
            if !known {
                found.push(fit);
            }
        }
    }
    match (found.is_empty(), refused) {
        (true, Some(error)) => Err(error),
        _ => {
            found.sort_by(|a, b| a.rms.total_cmp(&b.rms));
            Ok(found)
        }
    }
}

/// Poses that determine a dyad of two pins.
const UNKNOWN_POSES: usize = 5;
/// Minima are found to the root of rounding only: so many times as far apart as exact dyads they are one.
const NEAR: f64 = 30.0;

/// Sets of so many of `n` places, well spread ones first, at most so many.
pub(crate) fn subsets(n: usize, size: usize, most: usize) -> Vec<Vec<usize>> {
    if size >= n {
        return vec![(0..n).collect()];
    }
    let mut all: Vec<Vec<usize>> = Vec::new();
    let mut set: Vec<usize> = (0..size).collect();
    // All of them in order where they are not many, else from evenly spread ones on with growing steps aside.
    if size > 1 {
        let even: Vec<usize> = (0..size).map(|k| k * (n - 1) / (size - 1)).collect();
        all.push(even);
    }
    let mut count = 1usize;
    for k in 0..size {
        count = count.saturating_mul(n - k) / (k + 1);
    }
    let stride = count.div_ceil(most).max(1);
    let mut number = 0usize;
    loop {
        if number.is_multiple_of(stride) && !all.contains(&set) {
            all.push(set.clone());
        }
        number += 1;
        // The next set in order.
        let Some(k) = (0..size).rev().find(|&k| set[k] < n - size + k) else {
            break;
        };
        set[k] += 1;
        for later in k + 1..size {
            set[later] = set[later - 1] + 1;
        }
        // Beyond this many sets only the even ones count.
        if number > MOST_SETS {
            break;
        }
    }
    all.truncate(most);
    all
}

/// Sets that are counted through at most.
const MOST_SETS: usize = 1_000_000;

/// What is free of a pivot.
#[derive(Clone, Copy)]
pub(crate) enum Freedom {
    At(C),
    On(Line),
    Free,
}

impl Freedom {
    pub(crate) fn unknowns(self) -> usize {
        match self {
            Self::At(_) => 0,
            Self::On(_) => 1,
            Self::Free => 2,
        }
    }

    pub(crate) fn place(self, unknowns: &[f64]) -> C {
        match (self, unknowns) {
            (Self::At(place), _) => place,
            (Self::On(line), [along, ..]) => line.point + line.direction.scale(*along),
            (_, [x, y, ..]) => C::new(*x, *y),
            _ => C::zero(),
        }
    }

    pub(crate) fn start(self, place: C) -> Vec<f64> {
        match self {
            Self::At(_) => Vec::new(),
            Self::On(line) => vec![((place - line.point) * line.direction.conj()).re],
            Self::Free => vec![place.re, place.im],
        }
    }

    /// What a gradient to the place is to the unknowns.
    fn gradient(self, gradient: C) -> [f64; 2] {
        match self {
            Self::At(_) => [0.0; 2],
            Self::On(line) => [(gradient * line.direction.conj()).re, 0.0],
            Self::Free => [gradient.re, gradient.im],
        }
    }
}

struct Problem<'a> {
    poses: &'a [Pose],
    fixed: Freedom,
    moving: Freedom,
}

/// What conditions leave free of the fixed and of the moving pivot of a link through so many poses.
///
/// # Errors
/// Two conditions of one pivot.
pub(crate) fn freedoms(
    poses: usize,
    conditions: &[DyadCondition],
) -> Result<[Freedom; 2], SynthesisError> {
    let mut free = [Freedom::Free; 2];
    for (k, condition) in conditions.iter().enumerate() {
        let (pivot, given) = match *condition {
            DyadCondition::FixedAt(place) => (0, Freedom::At(place)),
            DyadCondition::FixedOn(line) => (0, Freedom::On(line)),
            DyadCondition::MovingAt(place) => (1, Freedom::At(place)),
            DyadCondition::MovingOn(line) => (1, Freedom::On(line)),
        };
        if !matches!(free[pivot], Freedom::Free) {
            return Err(SynthesisError::Dependent { datum: poses + k });
        }
        free[pivot] = given;
    }
    Ok(free)
}

impl<'a> Problem<'a> {
    fn new(poses: &'a [Pose], conditions: &[DyadCondition]) -> Result<Self, SynthesisError> {
        let [fixed, moving] = freedoms(poses.len(), conditions)?;
        Ok(Self {
            poses,
            fixed,
            moving,
        })
    }

    fn fit(&self, fixed: C, moving: C) -> Option<DyadFit> {
        let mut start = [self.fixed.start(fixed), self.moving.start(moving)].concat();
        let lengths = self.poses.iter().map(|p| (p.place(moving) - fixed).norm());
        start.push(lengths.sum::<f64>() / self.poses.len() as f64);
        let least = smallest_squares(self, &start)?;
        let (fixed, moving, length) = self.told(&least)?;
        let dyad = Dyad::Rr {
            fixed,
            moving,
            length,
        };
        let square: f64 = (self.poses.iter())
            .map(|pose| {
                let residual = dyad.residual(pose);
                residual * residual
            })
            .sum();
        let rms = (square / self.poses.len() as f64).sqrt();
        (rms.is_finite() && length > 0.0).then_some(DyadFit { dyad, rms })
    }

    fn told(&self, unknowns: &[f64]) -> Option<(C, C, f64)> {
        let (pivots, length) = unknowns.split_at_checked(unknowns.len().checked_sub(1)?)?;
        let (of_fixed, of_moving) = pivots.split_at_checked(self.fixed.unknowns())?;
        Some((
            self.fixed.place(of_fixed),
            self.moving.place(of_moving),
            *length.first()?,
        ))
    }
}

impl Residuals for Problem<'_> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>> {
        let (fixed, moving, length) = self.told(unknowns)?;
        let all = self.poses.iter().map(|pose| {
            let link = pose.place(moving) - fixed;
            math::hypot(link.re, link.im) - length
        });
        Some(all.collect())
    }

    fn jacobian(&self, unknowns: &[f64], _: &[f64], jacobian: &mut Qr) -> bool {
        let Some((fixed, moving, _)) = self.told(unknowns) else {
            return false;
        };
        let (of_fixed, of_moving) = (self.fixed.unknowns(), self.moving.unknowns());
        for (row, pose) in self.poses.iter().enumerate() {
            let link = pose.place(moving) - fixed;
            let size = math::hypot(link.re, link.im);
            if !(size > 0.0) {
                return false;
            }
            let along = link.scale(1.0 / size);
            let fixed = self.fixed.gradient(-along);
            let moving = self.moving.gradient(pose.turn().conj() * along);
            let all = fixed[..of_fixed].iter().chain(&moving[..of_moving]);
            for (column, value) in all.chain([&-1.0]).enumerate() {
                jacobian.add(row, column, *value);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_spread_and_few() {
        assert_eq!(subsets(6, 5, 60).len(), 6);
        let many = subsets(30, 5, 60);
        assert_eq!(many[0], [0, 7, 14, 21, 29]);
        assert!(many.len() > 30 && many.len() <= 60, "{}", many.len());
        assert_eq!(subsets(3, 5, 60), [[0, 1, 2]]);
        assert_eq!(subsets(7, 1, 60).len(), 7);
    }

    /// Poses of a known link with a little wrong in each: the fit misses them by no more than the link does.
    #[test]
    fn a_link_is_found_again_near_poses_that_are_a_little_wrong() {
        let (fixed, moving, length) = (C::new(3.0, -8.0), C::new(-4.0, 6.0), 14.0);
        let wrong = [0.01, -0.02, 0.015, 0.005, -0.01, 0.02, -0.015, 0.0];
        let poses: Vec<Pose> = (wrong.iter().enumerate())
            .map(|(k, wrong)| {
                let turn = 0.1 * k as f64;
                let at = fixed + C::from_polar(length + wrong, 1.9 - 0.21 * k as f64);
                let angle = 0.5 * turn + 0.3 * turn * turn;
                let origin = at - C::from_polar(1.0, angle) * moving;
                Pose::new(origin.re, origin.im, angle)
            })
            .collect();
        let found = fit_dyads(&poses, &[]).expect("fits");
        let best = found.first().expect("one");
        let own = wrong.iter().map(|w| w * w).sum::<f64>() / 8.0;
        assert!(best.rms <= own.sqrt(), "{found:?}");
        let held = fit_dyads(&poses, &[DyadCondition::FixedAt(fixed)]).expect("fits");
        let Dyad::Rr { fixed: at, .. } = held[0].dyad else {
            panic!("{held:?}");
        };
        assert_eq!(at, fixed);
        assert!(held[0].rms >= best.rms && held[0].rms <= own.sqrt());
    }
}
