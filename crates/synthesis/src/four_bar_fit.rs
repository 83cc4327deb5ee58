//! Six and more poses: four-bars that come near to all of them.
//!
//! Links that come nearest each for itself ([`fit_dyads`]) may be a poor four-bar: where both are nearly parallel, little that either is off
//! moves the body far. So pairs of them, and pairs that keep some of the poses exactly, are starts, from which K. Levenberg's and
//! D. Marquardt's method goes to the nearest minimum of the sum of squares by which the body is off, its turn in lengths of its way.

use kempe_linear::{C, Qr, Residuals, smallest_squares};
use kempe_number::math;

use crate::displacements::Displacements;
use crate::dyad::Dyad;
use crate::error::SynthesisError;
use crate::four_bar::FourBar;
use crate::guidance_fit::{Freedom, fit_dyads, freedoms, subsets};
use crate::linkage::Linkage;
use crate::motion::{DyadCondition, dyads};
use crate::pose::Pose;

/// Sets of poses from which starts are taken, starts that are gone on from, the best ones, and fits of single links that are paired.
const SETS: usize = 60;
const STARTS: usize = 160;
const SINGLE: usize = 12;
/// Starts are compared at so many poses, and of more poses fewer of them are gone on from, but so many at least.
const FEW: usize = 24;
const FEWEST: usize = 40;
/// Poses that determine a dyad of two pins.
const EXACT: usize = 5;
/// Differences of derivatives, and how far apart two minima are, in the poses' own unit.
const STEP: f64 = 1e-6;
const APART: f64 = 1e-5;
/// Minima with an error of more than this many times the least are of no use.
const WORSE: f64 = 30.0;

/// Boxes in which pivots are looked for: the least and the largest corner of that of the fixed ones, and of that of the moving ones in the body.
pub type PivotBoxes = [Option<[C; 2]>; 2];

/// Four-bars at local minima of what the body is off at the poses while the first link stands as it does in each, the best first. What is given of either
/// link is kept exactly, boxes as bounds.
///
/// # Errors
/// As of [`fit_dyads`], with the link, 0 or 1, that has no start.
pub fn fit_four_bars(
    poses: &[Pose],
    conditions: [&[DyadCondition]; 2],
    boxes: PivotBoxes,
) -> Result<Vec<FourBar>, (usize, SynthesisError)> {
    let of_link = |link: usize| move |error| (link, error);
    let displacements = Displacements::new(poses).map_err(of_link(0))?;
    let free = |link: usize| freedoms(poses.len(), conditions[link]).map_err(of_link(link));
    let mut whole = Whole {
        poses,
        links: [free(0)?, free(1)?],
        boxes,
        branch: 1,
        unit: displacements.scale,
    };
    let alike = conditions.iter().all(|given| given.is_empty());
    let firsts = links(poses, conditions[0]).map_err(of_link(0))?;
    let seconds = match alike {
        true => firsts.clone(),
        false => links(poses, conditions[1]).map_err(of_link(1))?,
    };
    let few = spread(poses);
    let mut starts: Vec<(f64, i8, FourBar)> = Vec::new();
    for (first, second) in (firsts.iter()).flat_map(|a| seconds.iter().map(move |b| (*a, *b))) {
        let Some(bar) = bar_of([first, second]) else {
            continue;
        };
        for branch in [1, -1] {
            let square = whole.off(&few, &bar, branch).map(|all| sum(&all));
            starts.extend(square.map(|square| (square, branch, bar)));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate((STARTS * FEW / poses.len()).clamp(FEWEST, STARTS));
    let mut found: Vec<(f64, FourBar)> = Vec::new();
    for (_, branch, bar) in starts {
        whole.branch = branch;
        let Some(least) = smallest_squares(&whole, &whole.unknowns(&bar)) else {
            continue;
        };
        let square = whole.residuals(&least).map(|all| sum(&all));
        let (Some(square), Some(bar)) = (square, whole.bar(&least)) else {
            continue;
        };
        let near = APART * whole.unit;
        if !found.iter().any(|(_, known)| whole.same(known, &bar, near)) {
            found.push((square, bar));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = found
        .first()
        .map_or(0.0, |(least, _)| WORSE * WORSE * least);
    found.retain(|(square, _)| *square <= most);
    Ok(found.into_iter().map(|(_, bar)| bar).collect())
}

fn sum(residuals: &[f64]) -> f64 {
    residuals.iter().map(|x| x * x).sum()
}

/// Evenly spread ones of many poses, by which starts are compared.
fn spread(poses: &[Pose]) -> Vec<Pose> {
    let count = poses.len().min(FEW);
    let at = |k: usize| poses[k * (poses.len() - 1) / (count - 1).max(1)];
    (0..count).map(at).collect()
}

/// Links to begin with: each comes nearest for itself, or keeps some of the poses exactly.
fn links(poses: &[Pose], given: &[DyadCondition]) -> Result<Vec<Dyad>, SynthesisError> {
    let alone = fit_dyads(poses, given)?.into_iter().take(SINGLE);
    let mut all: Vec<Dyad> = alone.map(|fit| fit.dyad).collect();
    let asked: usize = given.iter().map(DyadCondition::equations).sum();
    for set in subsets(poses.len(), EXACT.saturating_sub(asked).max(1), SETS) {
        let chosen: Vec<Pose> = set.iter().map(|k| poses[*k]).collect();
        let found = dyads(&chosen, given).unwrap_or_default();
        all.extend(found.into_iter().map(|found| found.dyad));
    }
    Ok(all)
}

/// The four-bar of two links; `None` where they share a pivot.
fn bar_of(links: [Dyad; 2]) -> Option<FourBar> {
    match Linkage::of(links[0], links[1])? {
        Linkage::FourBar(bar) => Some(bar),
        _ => None,
    }
}

/// A four-bar as a whole: of either link what is free of its fixed and of its moving pivot, and its length.
struct Whole<'a> {
    poses: &'a [Pose],
    links: [[Freedom; 2]; 2],
    boxes: PivotBoxes,
    branch: i8,
    /// In which the body's turn counts.
    unit: f64,
}

impl Whole<'_> {
    fn unknowns(&self, bar: &FourBar) -> Vec<f64> {
        let of = |link: usize| {
            let [fixed, moving] = self.links[link];
            let mut own = fixed.start(bar.fixed[link]);
            own.extend(moving.start(bar.moving[link]));
            own.push(bar.lengths[link]);
            own
        };
        [of(0), of(1)].concat()
    }

    fn bar(&self, unknowns: &[f64]) -> Option<FourBar> {
        let mut rest = unknowns;
        let mut link = |[fixed, moving]: [Freedom; 2]| {
            let (of_fixed, more) = rest.split_at_checked(fixed.unknowns())?;
            let (of_moving, more) = more.split_at_checked(moving.unknowns())?;
            let (length, more) = more.split_first()?;
            rest = more;
            (*length > 0.0).then(|| Dyad::Rr {
                fixed: fixed.place(of_fixed),
                moving: moving.place(of_moving),
                length: *length,
            })
        };
        let [first, second] = self.links;
        bar_of([link(first)?, link(second)?])
    }

    /// By how much a four-bar is off at poses; `None` where it does not close.
    fn off(&self, poses: &[Pose], bar: &FourBar, branch: i8) -> Option<Vec<f64>> {
        let mut all = Vec::with_capacity(3 * poses.len());
        for pose in poses {
            let met = bar.pose(bar.first_angle(pose), branch)?;
            let off = met.origin - pose.origin;
            let turn = math::within_half_a_turn(met.angle - pose.angle);
            all.extend([off.re, off.im, turn * self.unit]);
        }
        Some(all)
    }

    fn same(&self, a: &FourBar, b: &FourBar, near: f64) -> bool {
        let [a, b] = [a, b].map(|bar| self.unknowns(bar));
        a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= near)
    }
}

impl Residuals for Whole<'_> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>> {
        self.off(self.poses, &self.bar(unknowns)?, self.branch)
    }

    /// By central differences: the closed form of a pose has none of its own.
    fn jacobian(&self, unknowns: &[f64], _: &[f64], jacobian: &mut Qr) -> bool {
        let step = STEP * self.unit;
        let mut at = unknowns.to_vec();
        for column in 0..unknowns.len() {
            let mut side = |by: f64| {
                at[column] = unknowns[column] + by;
                let found = self.residuals(&at);
                at[column] = unknowns[column];
                found
            };
            let (Some(low), Some(high)) = (side(-step), side(step)) else {
                return false;
            };
            for (row, (low, high)) in low.iter().zip(&high).enumerate() {
                jacobian.add(row, column, (high - low) / (2.0 * step));
            }
        }
        true
    }

    fn bounds(&self, unknown: usize) -> [f64; 2] {
        let mut first = 0;
        for link in &self.links {
            for (freedom, corners) in link.iter().zip(&self.boxes) {
                let own = unknown
                    .checked_sub(first)
                    .filter(|k| *k < freedom.unknowns());
                if let (Some(axis), Freedom::Free, Some([low, high])) = (own, freedom, corners) {
                    return match axis {
                        0 => [low.re, high.re],
                        _ => [low.im, high.im],
                    };
                }
                first += freedom.unknowns();
            }
            first += 1;
        }
        [f64::NEG_INFINITY, f64::INFINITY]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Poses of a known four-bar with a little wrong in each: the fit is off by no more than they are, and is that four-bar; what is given is kept.
    #[test]
    fn a_four_bar_is_found_again_near_poses_that_are_a_little_wrong() {
        let own = FourBar {
            fixed: [C::new(1.0, -2.0), C::new(7.0, -1.0)],
            moving: [C::new(-1.0, 0.5), C::new(4.0, 1.5)],
            lengths: [2.0, 4.0],
        };
        let wrong = [3.0, -2.0, 1.0, -3.0, 2.0, -1.0, 2.0, -2.0, 1.0].map(|x| 1e-4 * x);
        let poses: Vec<Pose> = (wrong.iter().enumerate())
            .map(|(k, wrong)| {
                let pose = own.pose(0.3 + 0.5 * k as f64, 1).expect("a crank");
                let [x, y] = [pose.origin.re + wrong, pose.origin.im - 0.5 * wrong];
                Pose::new(x, y, pose.angle - 0.2 * wrong)
            })
            .collect();
        let unit = Displacements::new(&poses).expect("poses").scale;
        let off = |bar: &FourBar| {
            let all = poses.iter().map(|pose| {
                let met = bar.pose(bar.first_angle(pose), 1).expect("closed");
                let turn = unit * (met.angle - pose.angle);
                (met.origin - pose.origin).norm_sqr() + turn * turn
            });
            (all.sum::<f64>() / poses.len() as f64).sqrt()
        };
        let found = fit_four_bars(&poses, [&[], &[]], [None; 2]).expect("fits");
        assert!(off(&found[0]) <= off(&own), "{found:?}");
        let near = found[0].fixed[0] - own.fixed[0];
        assert!(near.norm() < 0.02, "{found:?}");
        // With the crank's pivot given, and the other in a box that leaves it out.
        let given = [DyadCondition::FixedAt(own.fixed[0])];
        let corners = [C::new(7.1, -3.0), C::new(9.0, 3.0)];
        let held = fit_four_bars(&poses, [&given, &[]], [Some(corners), None]).expect("fits");
        assert_eq!(held[0].fixed[0], own.fixed[0]);
        assert!(held.iter().all(|bar| bar.fixed[1].re >= 7.1), "{held:?}");
        assert!(off(&held[0]) > off(&own), "{held:?}");
    }
}
