//! Limits and change points, located on the curve and not at a step.

use crate::drive_path::DrivePath;
use crate::trace::{Follower, Node, chord, distance, hermite};

/// What a motion met.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// What.
    pub kind: EventKind,
    /// Path parameter (the drive's coordinate, or time).
    pub at: f64,
    /// The steps of the plan whose determinant vanishes.
    pub steps: Vec<usize>,
    /// Half width of the stretch over which the motion is interpolated from both sides.
    pub bridge: f64,
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The drive turns back: it can go no further on this circuit.
    Limit,
    /// Two branches cross; the motion went on smoothly.
    ChangePoint,
    /// The assembly mode of a group changes sign where other (redundant) constraints keep the motion determined.
    ModeChange,
}

/// The limit between two nodes whose parameter rates differ in sign: bisection on the rate with a secant speed-up
/// (Illinois), along the corrected cubic.
///
/// At the limit the parameter is stationary along the arc, so its error is of second order in the arc's.
pub fn locate_limit(follower: &mut Follower<'_, DrivePath>, from: &Node, to: &Node) -> Node {
    let across = chord(from, to);
    let at = |follower: &mut Follower<'_, DrivePath>, s: f64| -> Option<Node> {
        let mut z = hermite(from, to, s);
        follower.correct(&mut z, &across)?;
        let tangent = follower.tangent(&z, &across)?;
        Some(Node::new(z, tangent))
    };
    let (mut low, mut high) = (0.0, 1.0);
    let (mut f_low, mut f_high) = (from.parameter_rate(), to.parameter_rate());
    let mut best = if f_low.abs() < f_high.abs() {
        from.clone()
    } else {
        to.clone()
    };
    let mut side = 0;
    for _ in 0..80 {
        let mut s = (low * f_high - high * f_low) / (f_high - f_low);
        if !(s > low && s < high) {
            s = 0.5 * (low + high);
        }
        let Some(node) = at(follower, s) else { break };
        let rate = node.parameter_rate();
        if rate.abs() < best.parameter_rate().abs() {
            best = node;
        }
        if rate.abs() < 1e-14 || high - low < 1e-15 {
            break;
        }
        if (rate > 0.0) == (f_low > 0.0) {
            (low, f_low) = (s, rate);
            if side == -1 {
                f_high *= 0.5;
            }
            side = -1;
        } else {
            (high, f_high) = (s, rate);
            if side == 1 {
                f_low *= 0.5;
            }
            side = 1;
        }
    }
    let last = best.tangent.len() - 1;
    best.tangent[last] = 0.0;
    best
}

/// Where along the step from one node to the next the determinant of a step of the plan vanishes although no limit is met.
///
/// At the crossing itself the constraints do not determine the tangent, so the pose is not computed there: it and the
/// determinant are interpolated from four points on each side, close enough for full accuracy and far enough for good
/// conditioning. With `by_plan` the plan finds them first; it may take other branches that come near. Of the `others` those are
/// named whose determinants vanish at the same pose.
pub fn locate_change_point(
    follower: &mut Follower<'_, DrivePath>,
    from: &Node,
    to: &Node,
    (step, others): (usize, &[usize]),
    by_plan: bool,
) -> Option<Located> {
    const OFFSETS: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];
    let across = chord(from, to);
    let length = distance(&from.z, &to.z);
    let [f0, f1] = [from, to].map(|node| follower.determinants_at(node)[step]);
    let mut s = f0 / (f0 - f1);
    let mut found = None;
    for (width, is_last) in [(0.4, false), (0.2, false), (0.15, true)] {
        let mut places = Vec::with_capacity(8);
        let mut values: Vec<Vec<f64>> = Vec::with_capacity(8);
        for offset in OFFSETS {
            let place = s + width * offset;
            let mut z = hermite(from, to, place);
            let known = match by_plan {
                true => follower.correct_by_plan(&mut z, length, step),
                false => None,
            };
            let mut row = Vec::with_capacity(1 + z.len() + others.len());
            match known {
                // The plan loses digits near a crossing.
                Some(determinant) if !is_last => row.push(determinant),
                _ if follower.correct(&mut z, &across).is_none() => continue,
                _ => row.push(follower.determinants(&z)[step]),
            };
            if !row[0].is_finite() || row[0] == 0.0 {
                continue;
            }
            row.extend(&z);
            if is_last {
                let determinants = follower.determinants(&z);
                row.extend(others.iter().map(|other| determinants[*other]));
            }
            places.push(place);
            values.push(row);
        }
        if places.len() < 6 {
            break;
        }
        let at = |s: f64, column: usize| interpolate(&places, &values, column, s);
        // The root of the interpolating polynomial, by bisection between the innermost points.
        let (mut low, mut high) = (s - width, s + width);
        let (f_low, f_high) = (at(low, 0), at(high, 0));
        if f_low * f_high > 0.0 {
            break;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(middle, 0) * f_low > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        s = 0.5 * (low + high);
        let z: Vec<f64> = (0..from.z.len()).map(|k| at(s, k + 1)).collect();
        let ahead: Vec<f64> = (0..from.z.len()).map(|k| at(s + 1e-3, k + 1)).collect();
        let mut tangent: Vec<f64> = z.iter().zip(&ahead).map(|(a, b)| b - a).collect();
        let length = tangent.iter().map(|t| t * t).sum::<f64>().sqrt();
        tangent.iter_mut().for_each(|t| *t /= length);
        let vanishes = |index: usize| {
            let [before, here, after] =
                [s - SLIGHTLY, s, s + SLIGHTLY].map(|s| at(s, 1 + z.len() + index));
            here.abs() <= SAME_PLACE * ((after - before) / (2.0 * SLIGHTLY)).abs()
        };
        let as_well = (others.iter().enumerate())
            .filter(|(index, _)| is_last && vanishes(*index))
            .map(|(_, other)| *other);
        found = Some(Located {
            s,
            as_well: as_well.collect(),
            at: Node::new(z, tangent),
        });
    }
    found
}

/// Determinants that vanish this near each other, as a part of the step between two nodes, do so at one pose; and such a part by which
/// their slopes are taken.
const SAME_PLACE: f64 = 1e-8;
const SLIGHTLY: f64 = 1e-3;

/// Where a determinant vanishes.
pub struct Located {
    /// The place on the step from one node to the next, from 0 to 1.
    pub s: f64,
    /// The pose.
    pub at: Node,
    /// Other steps whose determinants vanish there, too.
    pub as_well: Vec<usize>,
}

/// Neville's interpolation of one column.
fn interpolate(places: &[f64], values: &[Vec<f64>], column: usize, s: f64) -> f64 {
    let n = places.len();
    let mut p: Vec<f64> = values.iter().map(|row| row[column]).collect();
    for level in 1..n {
        for i in 0..n - level {
            p[i] = ((s - places[i + level]) * p[i] - (s - places[i]) * p[i + 1])
                / (places[i] - places[i + level]);
        }
    }
    p[0]
}
