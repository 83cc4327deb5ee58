//! Places on a circuit by arc length, and the rows there.

use super::{Circuit, Stroke};
use crate::trace::{Cubic, interval};

/// A multiple of a step this near (in steps) to a place is that place.
const ON_STEP: f64 = 1e-9;
/// Arc lengths this near (mechanism sizes and rad) are one row.
const SAME_ARC: f64 = 1e-9;

impl Circuit {
    /// Which stretch an arc length lies on, and the path parameter there.
    pub fn locate(&self, arc: f64) -> (usize, f64) {
        let index = self
            .stretches
            .partition_point(|s| s.arcs.last().is_some_and(|end| *end < arc));
        let index = index.min(self.stretches.len().saturating_sub(1));
        let Some(stretch) = self.stretches.get(index) else {
            return (0, f64::NAN);
        };
        let node = interval(&stretch.arcs, arc);
        let (Some(from), Some(to)) = (stretch.nodes.get(node), stretch.nodes.get(node + 1)) else {
            return (index, f64::NAN);
        };
        let (a, b) = (stretch.arcs[node], stretch.arcs[node + 1]);
        let cubic = Cubic::new(from, to);
        let place = cubic.at(((arc - a) / (b - a)).clamp(0.0, 1.0));
        (index, place.part(from.z.len() - 1) * self.scale)
    }

    /// How far the path parameter runs up and down in all, SI.
    pub fn travel(&self) -> f64 {
        let of_stretch = |stretch: &Stroke| -> f64 {
            let at = |node| stretch.parameter_at(node, self.scale);
            let parts = (1..stretch.nodes.len()).filter_map(|k| Some(at(k)? - at(k - 1)?));
            parts.map(f64::abs).sum()
        };
        self.stretches.iter().map(of_stretch).sum()
    }

    /// Arc lengths, rising, at the start, at every multiple of `step` (SI) of the path parameter from there on as it runs
    /// up and down, at every dead point, and at the end.
    pub fn arcs_by_step(&self, step: f64) -> Vec<f64> {
        let mut arcs = vec![0.0];
        let Some(origin) = (self.stretches.first()).and_then(|s| s.parameter_at(0, self.scale))
        else {
            return arcs;
        };
        for stretch in &self.stretches {
            for index in 1..stretch.nodes.len() {
                let ends = [index - 1, index].map(|k| stretch.parameter_at(k, self.scale));
                let [Some(from), Some(to)] = ends else {
                    continue;
                };
                // A node on a multiple belongs to the step before it.
                let (from, to) = ((from - origin) / step, (to - origin) / step);
                let multiples: Vec<i64> = if to > from {
                    ((from + ON_STEP).floor() as i64 + 1..=(to + ON_STEP).floor() as i64).collect()
                } else {
                    ((to - ON_STEP).ceil() as i64..(from - ON_STEP).ceil() as i64)
                        .rev()
                        .collect()
                };
                for multiple in multiples {
                    arcs.push(stretch.arc_where(
                        index,
                        origin + multiple as f64 * step,
                        self.scale,
                    ));
                }
            }
            if let Some(end) = stretch.arcs.last() {
                arcs.push(*end);
            }
        }
        // A multiple at a dead point or at the end is one row.
        arcs.dedup_by(|b, a| (*b - *a).abs() <= SAME_ARC);
        arcs
    }
}

impl Stroke {
    /// Path parameter at a node, in the order of travel.
    fn parameter_at(&self, node: usize, scale: f64) -> Option<f64> {
        self.nodes
            .get(node)
            .and_then(|n| n.z.last())
            .map(|z| z * scale)
    }

    /// Arc length between the nodes `index - 1` and `index` where the path parameter is `p`.
    fn arc_where(&self, index: usize, p: f64, scale: f64) -> f64 {
        let (from, to) = (&self.nodes[index - 1], &self.nodes[index]);
        let (cubic, last) = (Cubic::new(from, to), from.z.len() - 1);
        let at = |s: f64| cubic.at(s).part(last) * scale;
        let rising = at(1.0) > at(0.0);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if (at(middle) < p) == rising {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (a, b) = (self.arcs[index - 1], self.arcs[index]);
        a + 0.5 * (low + high) * (b - a)
    }
}
