//! Following one direction from the start: how far the trace goes, and why it ends there.

use std::ops::ControlFlow;

use kempe_model::SAME_END;

use crate::drive_path::DrivePath;
use crate::events::locate_limit;
use crate::progress::{Done, Progress, Stage};
use crate::trace::{Follower, Node, distance};

/// Steps after which a trace is given up.
pub const STEP_LIMIT: usize = 200_000;
/// A part this far out, in mechanism sizes, is taken to run away to infinity.
pub const FAR: f64 = 1e3;
/// What is this far out, in mechanism sizes, while the drive stands still, is on its way there.
const ON_ITS_WAY: f64 = 10.0;
/// A body that turns on by this much, rad, while the drive all but stands still is taken to run away too.
pub const WHIRLING: f64 = 300.0;
/// Rate of the scaled path parameter along the arc below which the drive all but stands still.
pub(super) const STANDING: f64 = 1e-4;
/// Rate below which it stands still, as far as rounding lets tell: such a place is a limit only where the rate changes sign
/// from what is more than rounding.
const STILL: f64 = 1e-10;
/// Shortest step, in mechanism sizes and rad, over which the drive must stand still for a part to run away.
const STILL_STEP: f64 = 1e-3;
/// Pivot ratio of the bordered Jacobian above which a node is far enough from where branches cross to be the last one.
const WELL_DETERMINED: f64 = 1e-3;
/// Steps beyond the range in search of such a node.
const STEPS_BEYOND: usize = 3;
/// Width, as a part of the time of the last, between a place where the drives' rates jump and its near and far sides: a law is at its end
/// as near to that as `SAME_END`.
const SIDES: f64 = 2.0 * SAME_END;
/// Where the drives' rates jump twice within this part of the whole range, no step fits between: impacts that follow each other faster
/// and faster come so.
const AT_ONCE: f64 = 1e-8;

/// Why the motion ends before the demanded range does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndReason {
    /// The demanded range, or a whole turn, is covered.
    Covered,
    /// The drive can go no further: a limit (for this drive a dead point).
    Limit,
    /// The trace got stuck: no regular continuation was found.
    Stuck,
    /// A part runs away to infinity as the drive nears a value, as where two crossing slots become parallel.
    Runaway,
    /// The range is longer than [`STEP_LIMIT`] steps of the trace.
    TooLong,
}

/// Follows both directions, the upper one first, over a range of the scaled parameter. Returns the nodes in rising order
/// and why they end at the low and the high end. `progress` hears the finished part of the whole range, of which `share` lies
/// above the start; `None` when it stops the work.
pub(super) fn follow_both(
    follower: &mut Follower<'_, DrivePath>,
    [down, up]: [&Node; 2],
    (low, high): (f64, f64),
    share: f64,
    progress: &mut dyn Progress,
) -> Option<(Vec<Node>, (EndReason, EndReason))> {
    let mut heard = |before: f64, part: f64| {
        progress.reached(
            Stage::Following,
            Done::Part((before + part).clamp(0.0, 1.0)),
        )
    };
    let (upper, end_high) = follow(follower, up.clone(), high, &mut |part| {
        heard(0.0, part * share)
    })?;
    let (lower, end_low) = follow(follower, down.clone(), low, &mut |part| {
        heard(share, part * (1.0 - share))
    })?;
    // From the low end to the high one.
    let turned = lower.into_iter().skip(1).map(Node::turned);
    let mut nodes: Vec<Node> = turned.rev().collect();
    nodes.extend(upper);
    Some((nodes, (end_low, end_high)))
}

/// Follows one direction until the scaled parameter `target` is passed, a limit is met, or the trace is stuck. `told`
/// hears the finished part; `None` when it stops the work.
fn follow(
    follower: &mut Follower<'_, DrivePath>,
    start: Node,
    target: f64,
    heard: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<(Vec<Node>, EndReason)> {
    let last = start.z.len() - 1;
    let direction = start.tangent[last].signum();
    let mut nodes = vec![start];
    let mut step = 0.02;
    let mut beyond = 0;
    let stops = stops(follower, direction, nodes[0].z[last], target);
    let mut stops = stops.iter().peekable();
    for _ in 0..STEP_LIMIT {
        let from = &nodes[nodes.len() - 1];
        let whole = (target - nodes[0].z[last]).abs().max(f64::MIN_POSITIVE);
        heard((from.z[last] - nodes[0].z[last]).abs() / whole).continue_value()?;
        // A margin beyond the target, so that it lies inside a patch and not at the rim; and near a crossing of branches
        // on to its other side, so that rows there are joined from both sides.
        let past = (from.z[last] - target) * direction > 1e-9;
        if past {
            if follower.determined(from) > WELL_DETERMINED || beyond == STEPS_BEYOND {
                return Some((nodes, EndReason::Covered));
            }
            beyond += 1;
        }
        // Where the drives' rates jump the trace stops on the near side and goes on from the far side.
        if let Some((near, far)) = stops.peek()
            && (from.z[last] + 1.5 * step * from.tangent[last] - near) * direction >= 0.0
        {
            let far_side = *far;
            // What lies between two jumps that follow each other at once is jumped over with them.
            let at_once = (near - from.z[last]) * direction <= AT_ONCE * whole;
            let on = match at_once {
                true => Some(from.clone()),
                false => follower.land_smoothly(from, *near, &mut step),
            };
            if let Some(on) = on {
                let over = follower.land_over(&on, far_side);
                if !at_once {
                    nodes.push(on);
                }
                let Some(over) = over else {
                    return Some((nodes, EndReason::Stuck));
                };
                nodes.push(over);
                stops.next();
                step = 0.02;
                if (far_side - target) * direction >= 0.0 {
                    return Some((nodes, EndReason::Covered));
                }
                continue;
            }
        }
        let ended = |reason| if past { EndReason::Covered } else { reason };
        let Some(next) = follower.advance(from, &mut step) else {
            return Some((nodes, ended(EndReason::Stuck)));
        };
        // Where the drive's coordinate no longer changes while the mechanism moves on, rounding alone decides its sign.
        let still = [from, &next].map(|node| node.parameter_rate().abs() < STILL);
        if still == [true; 2] && distance(&from.z, &next.z) > STILL_STEP {
            // What has not gone far yet turns where branches all but meet: links of equal lengths that fold.
            let reason = match far(&next.z, &nodes[0].z, ON_ITS_WAY) {
                true => EndReason::Runaway,
                false => EndReason::Stuck,
            };
            return Some((nodes, ended(reason)));
        }
        if next.parameter_rate() * direction <= 0.0 {
            let limit = locate_limit(follower, from, &next);
            let covered = (limit.z[last] - target) * direction > 0.0;
            nodes.push(limit);
            let end = if covered {
                EndReason::Covered
            } else {
                EndReason::Limit
            };
            return Some((nodes, end));
        }
        let standing = next.parameter_rate().abs() < STANDING;
        let away = runs_away(&next.z, &nodes[0].z, standing);
        nodes.push(next);
        if away {
            return Some((nodes, ended(EndReason::Runaway)));
        }
    }
    Some((nodes, EndReason::TooLong))
}

/// Whether some part is so far from where it was at the start that it is taken to run away to infinity. Where the drive
/// all but stands still, turning on and on counts as that too.
pub(crate) fn runs_away(z: &[f64], start: &[f64], standing: bool) -> bool {
    let mut bodies = z.chunks_exact(3).zip(start.chunks_exact(3));
    let driven = |z: &[f64]| z.last().copied().unwrap_or(0.0);
    // What a drive carries along goes as far as the drive does.
    let most = FAR.max(2.0 * (driven(z) - driven(start)).abs());
    far(z, start, most) || (standing && bodies.any(|(p, q)| (p[2] - q[2]).abs() > WHIRLING))
}

/// Whether some body is farther from where it was at the start, in mechanism sizes.
fn far(z: &[f64], start: &[f64], sizes: f64) -> bool {
    let mut bodies = z.chunks_exact(3).zip(start.chunks_exact(3));
    bodies.any(|(p, q)| (p[0] - q[0]).abs() > sizes || (p[1] - q[1]).abs() > sizes)
}

/// The places ahead where the drives' rates jump, as near and far sides in scaled parameters. Between the two lies less
/// than any row can tell apart.
fn stops(
    follower: &Follower<'_, DrivePath>,
    direction: f64,
    start: f64,
    target: f64,
) -> Vec<(f64, f64)> {
    let (breaks, scale) = follower.breaks();
    let width = breaks.last().map_or(0.0, |end| SIDES * end / scale);
    let mut stops: Vec<(f64, f64)> = breaks
        .iter()
        .map(|b| b / scale)
        // A trace that starts on a break is on its far side already.
        .filter(|b| (b - start) * direction > width && (b - target) * direction <= 2.0 * width)
        .map(|b| (b - width * direction, b + width * direction))
        .collect();
    if direction < 0.0 {
        stops.reverse();
    }
    stops
}
