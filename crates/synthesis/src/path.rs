//! Path generation: four-bars whose coupler carries a point through places.
//!
//! Where the crank's turns are given, the crank and the coupler's arm are a dyad that is found as one of motion generation; where the crank
//! is given, its places are. Both tell how the coupler turns, and its second dyad is one of motion generation again. With both ground
//! pivots given and nothing else, the equations are solved by following paths (`path/ground_pivots.rs`), and so they are where as many points
//! and poses are given as a four-bar can pass (`path/alt_burmester.rs`).

mod alt_burmester;
mod ground_pivots;
mod one_curve;
mod tracker;

pub use alt_burmester::{FourBarThrough, FourBarsThrough, four_bars_through};
pub use ground_pivots::{GroundPivotPaths, paths_with_ground_pivots};

use kempe_linear::C;
use kempe_number::math;

use crate::dyad::{Dyad, same};
use crate::error::{SynthesisError, all_finite, balanced};
use crate::linkage::Linkage;
use crate::motion::{DyadCondition, dyads, equations};
use crate::pose::{Line, Pose};

/// A linkage whose coupler carries its origin through the points, with the coupler's poses there.
#[derive(Clone, Debug, PartialEq)]
pub struct PathLinkage {
    /// The linkage: the crank first where one is told from the other.
    pub linkage: Linkage,
    /// The coupler's poses at the points. Its origin is the point that is carried; its angle counts from the first point.
    pub poses: Vec<Pose>,
}

/// All linkages with a crank whose coupler carries a point through places as the crank is at given angles (rad, from any zero): with five points
/// up to twelve four-bars.
///
/// Each list of conditions adds to the points to make the four equations of its dyad, as of [`dyads`]: the moving pivot of the crank is
/// the crank's end as seen from its pivot when its angle is zero; that of the other dyad is a point of the coupler at the first
/// point, whose origin is the point that is carried.
///
/// # Errors
/// As of [`dyads`]; lists of different lengths. Two points alike at one angle are a repeated datum.
pub fn timed_paths(
    points: &[C],
    angles: &[f64],
    crank: &[DyadCondition],
    other: &[DyadCondition],
) -> Result<Vec<PathLinkage>, SynthesisError> {
    if points.len() != angles.len() {
        return Err(SynthesisError::Lengths {
            first: points.len(),
            second: angles.len(),
        });
    }
    // |P - g - w e| stays: with poses (-P, e) that is the dyad of -g and w.
    let turned: Vec<Pose> = (points.iter().zip(angles))
        .map(|(p, angle)| Pose {
            origin: -*p,
            angle: *angle,
        })
        .collect();
    let conditions: Vec<DyadCondition> = (crank.iter())
        .map(|condition| match *condition {
            DyadCondition::FixedAt(place) => DyadCondition::FixedAt(-place),
            DyadCondition::FixedOn(line) => DyadCondition::FixedOn(Line {
                point: -line.point,
                ..line
            }),
            of_crank => of_crank,
        })
        .collect();
    let mut found = Vec::new();
    for solution in dyads(&turned, &conditions)? {
        let Dyad::Rr {
            fixed: minus,
            moving: crank,
            ..
        } = solution.dyad
        else {
            // An arm without end, or a crank.
            continue;
        };
        let ends: Vec<C> = (angles.iter())
            .map(|angle| crank * C::from_polar(1.0, *angle) - minus)
            .collect();
        // What one crank cannot do another may.
        found.extend(with_crank_ends(points, -minus, &ends, other).unwrap_or_default());
    }
    Ok(found)
}

/// All linkages with a given crank whose coupler carries a point through places, whenever: the crank's fixed pivot, and where its end is at
/// the first point. At every later point the crank has two places, so two points more double the linkages.
///
/// The conditions add to the points to make the four equations of the other dyad, as of [`dyads`]; its moving pivot is a point of
/// the coupler, which is not turned at the first point and has its origin there.
///
/// # Errors
/// As of [`dyads`], and [`SynthesisError::OutOfRange`] for a point, by its distance from the pivot, that crank and arm do not
/// reach.
pub fn paths_with_crank(
    points: &[C],
    pivot: C,
    end: C,
    other: &[DyadCondition],
) -> Result<Vec<PathLinkage>, SynthesisError> {
    let finite = points.iter().chain([&pivot, &end]).map(|p| p.is_finite());
    all_finite(finite)?;
    let asked: usize = other.iter().map(DyadCondition::equations).sum();
    balanced(equations(points.len(), asked), 4)?;
    let (crank, arm) = ((end - pivot).norm(), (points[0] - end).norm());
    let mut ends = vec![vec![end]];
    for (datum, point) in points.iter().enumerate().skip(1) {
        let to = *point - pivot;
        let far = math::hypot(to.re, to.im);
        let along = (far * far + crank * crank - arm * arm) / (2.0 * far);
        let square = crank * crank - along * along;
        if !(square >= 0.0) {
            return Err(SynthesisError::OutOfRange {
                datum,
                value: far,
                least: (crank - arm).abs(),
                most: crank + arm,
            });
        }
        let unit = to.scale(1.0 / far);
        ends = (ends.iter())
            .flat_map(|known| {
                [1.0, -1.0].map(|side| {
                    let place = pivot + unit * C::new(along, side * square.sqrt());
                    known.iter().copied().chain([place]).collect()
                })
            })
            .collect();
    }
    let mut found = Vec::new();
    let mut error = None;
    for ends in &ends {
        match with_crank_ends(points, pivot, ends, other) {
            Ok(some) => found.extend(some),
            Err(other) => error = Some(other),
        }
    }
    match error {
        Some(error) if found.is_empty() => Err(error),
        _ => Ok(found),
    }
}

/// All linkages of a crank whose end is at places as the coupler's origin is at points.
fn with_crank_ends(
    points: &[C],
    pivot: C,
    ends: &[C],
    other: &[DyadCondition],
) -> Result<Vec<PathLinkage>, SynthesisError> {
    let first = points[0] - ends[0];
    let poses: Vec<Pose> = (points.iter().zip(ends))
        .map(|(point, end)| {
            let turn = (*point - *end) * first.conj();
            Pose {
                origin: *point,
                angle: math::atan2(turn.im, turn.re),
            }
        })
        .collect();
    let crank = Dyad::rr(pivot, -first, &poses[0]);
    let size = (pivot - points[0]).norm() + first.norm();
    let found = (dyads(&poses, other)?.into_iter())
        .filter(|d| !same(&d.dyad, &crank, size))
        .filter_map(|d| Linkage::of(crank, d.dyad))
        .map(|linkage| PathLinkage {
            linkage,
            poses: poses.clone(),
        });
    Ok(found.collect())
}
