//! What a step of a trace must keep to be accepted, whichever way it is made.

use super::cubic::distance;
use super::node::Node;

/// How far the corrected middle of a step may lie from the cubic through its ends, as a part of the step.
pub const MIDDLE_TOLERANCE: f64 = 1e-3;
/// How far the end of a step may lie from the tangent at its start, as a part of the step.
pub(super) const CORRECTION_LIMIT: f64 = 0.3;
/// Smallest cosine between the tangents at the ends of a step.
pub const TURN_LIMIT: f64 = 0.97;
/// Shortest step: below it the motion is stuck.
pub(super) const SHORTEST_STEP: f64 = 1e-9;

/// Whether the path parameter cannot run one way all along a step that leaves and arrives the same way (the condition
/// of Fritsch and Carlson 1980 for a monotonic cubic): two limits lie in between.
pub(crate) fn hides_limits(from: &Node, to: &Node) -> bool {
    let last = from.z.len() - 1;
    let (a, b) = (from.parameter_rate(), to.parameter_rate());
    let h = distance(&from.z, &to.z);
    let mean = (to.z[last] - from.z[last]) / h;
    a * b > 0.0 && (mean * a <= 0.0 || a.abs().max(b.abs()) > 3.0 * mean.abs())
}
