//! Steps of a trace: along the arc, and onto a given path parameter.

use super::acceptance::{
    CORRECTION_LIMIT, MIDDLE_TOLERANCE, SHORTEST_STEP, TURN_LIMIT, hides_limits,
};
use super::by_plan::ByPlan;
use super::cubic::{chord, distance, hermite};
use super::node::{Node, dot};
use super::{Follower, Path};

/// Steps shorter than this are not held to a path parameter that runs one way: rounding would decide.
pub(crate) const WIGGLE: f64 = 1e-6;
/// Longest step, in mechanism sizes and rad over all bodies (root of the sum of squares).
const LONGEST_STEP: f64 = 0.5;

impl<P: Path> Follower<'_, P> {
    /// One step along the arc; `step` is the length to try and is adapted for the next. `None` when stuck.
    pub fn advance(&mut self, from: &Node, step: &mut f64) -> Option<Node> {
        let longest = LONGEST_STEP * ((self.design.mechanism.bodies - 1) as f64).sqrt();
        let longest = longest.min(self.restrictions.longest_step(&from.z));
        let mut odd = 0;
        while *step > SHORTEST_STEP {
            let h = step.min(longest);
            // The cubic's error goes with the fourth power of the step.
            let grown = |gap: f64| {
                let grow = (0.5 * MIDDLE_TOLERANCE * h / gap.max(1e-18)).sqrt().sqrt();
                (h * grow.clamp(0.5, 2.0)).min(longest)
            };
            match self.step_by_plan(from, h) {
                ByPlan::Reached(to, _) if self.skips(from, &to, h) => {
                    *step = 0.5 * h;
                    continue;
                }
                ByPlan::Reached(to, gap) => {
                    self.determined = None;
                    *step = grown(gap);
                    return Some(to);
                }
                ByPlan::Bent => {
                    *step = 0.5 * h;
                    continue;
                }
                ByPlan::Unfit => {}
            }
            let mut z = from.ahead(h);
            let outcome = self
                .correct(&mut z, &from.tangent)
                .filter(|first| *first <= CORRECTION_LIMIT * h)
                .and_then(|_| {
                    let tangent = self.tangent(&z, &from.tangent)?;
                    // Right on a crossing of branches the tangent is not determined: step elsewhere.
                    let determined = self.conditioning();
                    self.determined = Some(determined);
                    if determined < 1e-10 {
                        odd += 1;
                        return None;
                    }
                    (dot(&tangent, &from.tangent) >= TURN_LIMIT).then_some(tangent)
                });
            let Some(tangent) = outcome else {
                *step = h * if odd > 0 { 0.71 } else { 0.5 };
                continue;
            };
            let to = Node::new(z, tangent);
            if self.skips(from, &to, h) {
                *step = 0.5 * h;
                continue;
            }
            let mut middle = hermite(from, &to, 0.5);
            let chord = chord(from, &to);
            let gap = self.correct(&mut middle, &chord);
            match gap {
                Some(gap) if gap <= MIDDLE_TOLERANCE * h => {
                    *step = grown(gap);
                    return Some(to);
                }
                _ => *step = 0.6 * h,
            }
        }
        None
    }

    /// Whether a step of a length goes past what lies between.
    fn skips(&self, from: &Node, to: &Node, length: f64) -> bool {
        (hides_limits(from, to) && length > WIGGLE) || self.turns_inside_out(from, to)
    }

    /// The node at a scaled path parameter ahead of `from`, reached at fixed parameter, and the length of the first
    /// correction there.
    fn land(&mut self, from: &Node, target: f64) -> Option<(Node, f64)> {
        let last = from.z.len() - 1;
        let rate = from.tangent[last];
        let far = (target - from.z[last]) / rate;
        let mut z = from.ahead(far);
        z[last] = target;
        let mut border = vec![0.0; z.len()];
        border[last] = rate.signum();
        let gap = self.correct(&mut z, &border)?;
        let tangent = self.tangent(&z, &border)?;
        (far >= 0.0).then_some((Node::new(z, tangent), gap))
    }

    /// The node at a scaled path parameter a little ahead, over a place where the drives' rates jump. `None` when it lies
    /// farther away than the rates on both sides explain.
    pub fn land_over(&mut self, from: &Node, target: f64) -> Option<Node> {
        let (over, _) = self.land(from, target)?;
        let last = from.z.len() - 1;
        let width = (target - from.z[last]).abs();
        let arcs = width / from.tangent[last].abs() + width / over.tangent[last].abs();
        (distance(&from.z, &over.z) <= arcs + SHORTEST_STEP).then_some(over)
    }

    /// The node at a scaled path parameter ahead, such as where the drives' rates jump, but only as far as the cubic of
    /// one step holds; shortens `step` otherwise.
    pub fn land_smoothly(&mut self, from: &Node, target: f64, step: &mut f64) -> Option<Node> {
        let last = from.z.len() - 1;
        let far = (target - from.z[last]) / from.tangent[last];
        let landed = self.land(from, target);
        let near = landed.filter(|(_, gap)| *gap <= 0.3 * far.max(SHORTEST_STEP));
        let smooth = near.map(|(to, _)| to).filter(|to| {
            let middle = hermite(from, to, 0.5);
            let mut corrected = middle.clone();
            let across = chord(from, to);
            dot(&to.tangent, &from.tangent) >= TURN_LIMIT
                && self
                    .correct(&mut corrected, &across)
                    .is_some_and(|gap| gap <= MIDDLE_TOLERANCE * far)
        });
        if smooth.is_none() {
            *step = step.min(0.5 * far);
        }
        smooth
    }
}
