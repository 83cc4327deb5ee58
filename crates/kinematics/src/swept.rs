//! Length of path that a point has swept.

use kempe_model::PointId;
use kempe_number::{Jet, Number};

use crate::motion::Motion;
use crate::trace::interval;
use crate::watch::{Stage, Watch};

/// Gauss-Legendre points and weights on [-1, 1] (8 points).
pub(crate) const GAUSS: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

type Line = Jet<f64, 2>;

/// The swept length of one point, cumulated over the nodes of the trace.
#[derive(Clone, Debug)]
pub struct Swept {
    point: PointId,
    cumulated: Vec<f64>,
    /// Path parameters where the motion in time turns back, with times, from the start on.
    turns: Vec<(f64, f64)>,
}

impl Swept {
    /// Integrates over a motion; `None` when stopped.
    pub fn watched(motion: &Motion<'_>, point: PointId, watch: &mut dyn Watch) -> Option<Self> {
        let nodes = motion.node_parameters();
        let mut it = Self {
            point,
            cumulated: vec![0.0; nodes.len()],
            turns: turns(motion),
        };
        for index in 1..nodes.len() {
            let part = index as f64 / nodes.len() as f64;
            watch
                .reached(Stage::Measuring, Some(part))
                .continue_value()?;
            let length = it.stretch(motion, index - 1, nodes[index - 1], nodes[index]);
            it.cumulated[index] = it.cumulated[index - 1] + length;
        }
        Some(it)
    }

    /// The point.
    pub fn point(&self) -> PointId {
        self.point
    }

    /// Length swept from the start of the motion until a time, m.
    pub fn at_time(&self, motion: &Motion<'_>, parameters: &[f64], time: f64) -> f64 {
        if !time.is_finite() {
            return f64::NAN;
        }
        let now = motion
            .path
            .parameter_at(&motion.mechanism.model, time, parameters);
        let mut total = 0.0;
        let mut last = self.until(motion, motion.start);
        for (_, p) in self.turns.iter().filter(|(t, _)| *t < time) {
            let next = self.until(motion, *p);
            total += (next - last).abs();
            last = next;
        }
        total + (self.until(motion, now) - last).abs()
    }

    /// Length from the trace's first node to a path parameter.
    fn until(&self, motion: &Motion<'_>, p: f64) -> f64 {
        let nodes = motion.node_parameters();
        let node = interval(nodes, p);
        match nodes.get(node) {
            Some(&from) => self.cumulated[node] + self.stretch(motion, node, from, p),
            None => 0.0,
        }
    }

    /// Gauss quadrature of the path's speed over a part of the patch that begins at `node`. Towards a limit the speed
    /// grows like one over a root, which the substitution p = limit -+ w^2 takes away.
    fn stretch(&self, motion: &Motion<'_>, node: usize, from: f64, to: f64) -> f64 {
        let nodes = motion.node_parameters();
        let limit_at = |p: Option<&f64>| {
            p.copied().filter(|p| {
                motion
                    .places
                    .iter()
                    .any(|e| e.kind == crate::events::EventKind::Limit && e.at == *p)
            })
        };
        let mut solver = motion.solver::<Line>();
        let design = motion.design_on::<Line>();
        let Some(marker) = motion.mechanism.any_marker(self.point) else {
            return 0.0;
        };
        let mut speed = |p: f64| {
            motion.solve(&design, Line::variable(p), &mut solver);
            let at = solver.state.poses[marker.body.index()].place(design.geometry.marker(marker));
            (at[0].coefficient(1).square() + at[1].coefficient(1).square()).sqrt()
        };
        let integrate = |a: f64, b: f64, f: &mut dyn FnMut(f64) -> f64| -> f64 {
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            GAUSS
                .iter()
                .map(|(x, w)| w * f(middle + half * x))
                .sum::<f64>()
                * half
        };
        if let Some(limit) = limit_at(nodes.get(node + 1)) {
            let root = |p: f64| (limit - p).max(0.0).sqrt();
            return integrate(root(to), root(from), &mut |w| {
                2.0 * w * speed(limit - w * w)
            });
        }
        if let Some(limit) = limit_at(nodes.get(node)) {
            let root = |p: f64| (p - limit).max(0.0).sqrt();
            return integrate(root(from), root(to), &mut |w| {
                2.0 * w * speed(limit + w * w)
            });
        }
        integrate(from, to, &mut speed)
    }
}

/// Where the path parameter turns back in time, by the sign of its rate on a fine grid refined by bisection.
fn turns(motion: &Motion<'_>) -> Vec<(f64, f64)> {
    const GRID: usize = 4096;
    let model = &motion.mechanism.model;
    let parameters = model.parameter_values::<f64>();
    let rich: Vec<Line> = model.parameter_values();
    let duration = model
        .drives
        .iter()
        .map(|d| d.law.duration(&parameters))
        .fold(0.0, f64::max);
    let rate = |t: f64| {
        motion
            .path
            .parameter_at(model, Line::variable(t), &rich)
            .coefficient(1)
    };
    let mut found = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for k in 0..=GRID {
        let t = duration * k as f64 / GRID as f64;
        let r = rate(t);
        if r == 0.0 || !r.is_finite() {
            continue;
        }
        if let Some((t0, r0)) = last
            && r0 * r < 0.0
        {
            let (mut low, mut high) = (t0, t);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if rate(middle) * r0 > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push((low, motion.path.parameter_at(model, low, &parameters)));
        }
        last = Some((t, r));
    }
    found
}
