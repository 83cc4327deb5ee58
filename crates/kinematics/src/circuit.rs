//! A whole circuit, past its dead points: the curve of poses followed by arc length until it closes or cannot go on.
//!
//! Between two dead points the drive's coordinate runs one way, so a circuit is a list of ordinary motions, travelled
//! up and down in turn.

use kempe_model::{DriveKind, Measure};

use crate::assemble::{Assemblies, find_assemblies};
use crate::drive_path::DrivePath;
use crate::events::locate_limit;
use crate::force_source::NoForces;
use crate::mechanism::Mechanism;
use crate::motion::{EndReason, Motion, MotionError, Unlocated, runs_away, with_care};
use crate::plan::Plan;
use crate::sampler::{Sample, Sampler, Unprepared};
use crate::state::Design;
use crate::trace::{Cubic, Follower, Node, Path, distance, hermite, interval};
use crate::watch::{Stage, Unwatched, Watch};

/// Steps after which a circuit that has not closed is given up.
pub const CIRCUIT_STEPS: usize = 50_000;
/// A multiple of a step this near (in steps) to a place is that place.
const ON_STEP: f64 = 1e-9;
/// Arc lengths this near (mechanism sizes and rad) are one row.
const SAME_ARC: f64 = 1e-9;
/// A start this near a singular pose is moved along the drive by these parts of its range.
const ANCHORS: [f64; 4] = [0.0, 0.0137, 0.1234, 0.3719];

/// A stretch of a circuit on which the drive's coordinate runs one way.
#[derive(Clone, Debug)]
pub struct Stretch<'m> {
    /// The motion, over rising coordinates.
    pub motion: Motion<'m>,
    /// Whether the circuit travels it upwards.
    pub forward: bool,
    /// Arc length (mechanism sizes and rad over all bodies) at every node, in the order of travel.
    arcs: Vec<f64>,
    /// The nodes in the order of travel.
    nodes: Vec<Node>,
}

impl Stretch<'_> {
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

/// A circuit of a mechanism: everything that can be reached without taking it apart.
#[derive(Clone, Debug)]
pub struct Circuit<'m> {
    /// Its stretches in the order of travel.
    pub stretches: Vec<Stretch<'m>>,
    /// Whether it came back to its start.
    pub closed: bool,
    /// Whole arc length, in mechanism sizes and rad over all bodies.
    pub length: f64,
    /// All assemblies at the start.
    pub assemblies: Assemblies,
    scale: f64,
}

impl<'m> Circuit<'m> {
    /// Traces the circuit through the assembly meant by the file's hints at the drive's start.
    ///
    /// # Errors
    /// When it cannot start; see [`Motion::new`].
    pub fn new(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        parameters: &[f64],
    ) -> Result<Self, MotionError> {
        Self::watched(mechanism, plan, design, parameters, &mut Unwatched)
    }

    /// As [`Circuit::new`]; `watch` hears how far it has come and may stop it.
    ///
    /// # Errors
    /// As [`Circuit::new`], and [`MotionError::Stopped`].
    pub fn watched(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        parameters: &[f64],
        watch: &mut dyn Watch,
    ) -> Result<Self, MotionError> {
        let stopped = |stage| move || MotionError::Stopped { stage };
        // The demanded motion finds the start, with all its checks.
        let mut motion = Motion::watched(mechanism, plan, design, parameters, watch)?;
        let path = motion.path.clone();
        let (low, high) = motion.demanded;
        let mut follower = Follower::new(mechanism, plan, &design.geometry, &path);
        let mut coordinates = vec![0.0; mechanism.model.drives.len()];
        let far = if motion.start == low { high } else { low };
        for part in ANCHORS {
            let anchor = motion.anchor + part * (far - motion.anchor);
            path.coordinates(anchor, &mut coordinates);
            let assemblies = if anchor == motion.anchor {
                std::mem::take(&mut motion.assemblies)
            } else {
                find_assemblies(mechanism, plan, design, &coordinates, watch)
                    .ok_or_else(stopped(Stage::Assembling))?
            };
            let Some(chosen) = assemblies.list.first() else {
                continue;
            };
            let z = follower.scaled(&chosen.poses, &chosen.branch.near, anchor);
            let direction = if far >= motion.start { 1.0 } else { -1.0 };
            let Some(start) = follower.start(z, direction) else {
                continue;
            };
            return with_care(&mut follower, |follower| {
                let (nodes, closed) =
                    go_round(follower, start.clone(), mechanism, &path, high, watch)
                        .ok_or(Unlocated::Stopped(Stage::Following))?;
                let assemblies = assemblies.clone();
                Self::of_nodes(
                    mechanism, plan, design, &path, assemblies, nodes, closed, follower, watch,
                )
            });
        }
        Err(MotionError::Locked { at: motion.start })
    }

    #[allow(
        clippy::too_many_arguments,
        reason = "the parts of a mechanism at work, named"
    )]
    fn of_nodes(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        path: &DrivePath,
        assemblies: Assemblies,
        nodes: Vec<Node>,
        closed: bool,
        follower: &mut Follower<'_, DrivePath>,
        watch: &mut dyn Watch,
    ) -> Result<Self, Unlocated> {
        let mut stretches: Vec<Stretch<'m>> = Vec::new();
        let mut arc = 0.0;
        let mut current: Vec<Node> = Vec::new();
        for node in nodes {
            let at_limit = node.parameter_rate() == 0.0;
            current.push(node.clone());
            if at_limit && current.len() > 1 {
                let done = std::mem::replace(&mut current, vec![node]);
                push_stretch(
                    &mut stretches,
                    &mut arc,
                    done,
                    (mechanism, plan, design),
                    path,
                    &assemblies,
                    (follower, watch),
                )?;
            }
        }
        if current.len() > 1 {
            push_stretch(
                &mut stretches,
                &mut arc,
                current,
                (mechanism, plan, design),
                path,
                &assemblies,
                (follower, watch),
            )?;
        }
        Ok(Self {
            stretches,
            closed,
            length: arc,
            assemblies,
            scale: path.scale(),
        })
    }

    /// Size of a typical change of the path parameter: a radian, or the mechanism's size.
    pub fn scale(&self) -> f64 {
        self.scale
    }

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

    /// Prepares measures for rows of the circuit.
    ///
    /// # Errors
    /// All measures that cannot be evaluated, or that `watch` stopped it.
    pub fn samplers<'a>(
        &'a self,
        measures: &[&Measure],
        watch: &mut dyn Watch,
    ) -> Result<Vec<Sampler<'a>>, Unprepared>
    where
        'm: 'a,
    {
        self.stretches
            .iter()
            .map(|s| Sampler::watched(&s.motion, measures, NoForces, watch))
            .collect()
    }

    /// The row at an arc length. Time does not run along a circuit: measures of speed are NaN.
    pub fn row(&self, samplers: &mut [Sampler<'_>], arc: f64) -> Option<Sample> {
        let (index, p) = self.locate(arc);
        samplers
            .get_mut(index)
            .map(|sampler| sampler.without_time(p))
    }
}

fn push_stretch<'m>(
    stretches: &mut Vec<Stretch<'m>>,
    arc: &mut f64,
    nodes: Vec<Node>,
    (mechanism, plan, design): (&'m Mechanism, &'m Plan, &'m Design<f64>),
    path: &DrivePath,
    assemblies: &Assemblies,
    (follower, watch): (&mut Follower<'_, DrivePath>, &mut dyn Watch),
) -> Result<(), Unlocated> {
    let mut arcs = vec![*arc];
    for pair in nodes.windows(2) {
        *arc += distance(&pair[0].z, &pair[1].z);
        arcs.push(*arc);
    }
    let last = nodes[0].z.len() - 1;
    let forward = nodes[nodes.len() - 1].z[last] > nodes[0].z[last];
    let mut rising = nodes.clone();
    if !forward {
        rising.reverse();
        for node in &mut rising {
            node.tangent.iter_mut().for_each(|t| *t = -*t);
        }
    }
    let mut motion = Motion::of_nodes(
        mechanism,
        plan,
        design,
        path.clone(),
        assemblies.clone(),
        rising,
    );
    motion.ends = (EndReason::Limit, EndReason::Limit);
    motion.find_events(follower, watch)?;
    stretches.push(Stretch {
        motion,
        forward,
        arcs,
        nodes,
    });
    Ok(())
}

/// Follows the curve until it is back at its start (angles of bodies and of a turning drive count modulo a turn). Along
/// time, where nothing comes back, until the motion's `end`; and no further than to where a part runs away. `None` when
/// stopped.
pub(crate) fn go_round(
    follower: &mut Follower<'_, DrivePath>,
    start: Node,
    mechanism: &Mechanism,
    path: &DrivePath,
    end: f64,
    watch: &mut dyn Watch,
) -> Option<(Vec<Node>, bool)> {
    let turning = match path {
        DrivePath::Coordinate { drive, .. } => {
            matches!(
                mechanism.model.drives.get(*drive).map(|d| &d.kind),
                Some(DriveKind::Turn { .. })
            )
        }
        DrivePath::Time { .. } => false,
    };
    let last = start.z.len() - 1;
    let is_angle = |i: usize| (i < last && i % 3 == 2) || (i == last && turning);
    // The start, seen whole turns away, nearest to a point.
    let image = |z: &[f64]| -> Vec<f64> {
        (0..=last)
            .map(|i| {
                let turns = if is_angle(i) {
                    ((z[i] - start.z[i]) / std::f64::consts::TAU).round()
                } else {
                    0.0
                };
                start.z[i] + turns * std::f64::consts::TAU
            })
            .collect()
    };
    let mut nodes = vec![start.clone()];
    let mut step = 0.02;
    let mut travelled = 0.0;
    for _ in 0..CIRCUIT_STEPS {
        watch.reached(Stage::Following, None).continue_value()?;
        let from = nodes[nodes.len() - 1].clone();
        let Some(next) = follower.advance(&from, &mut step) else {
            return Some((nodes, false));
        };
        let h = distance(&from.z, &next.z);
        travelled += h;
        // Back at the start when it lies between the two nodes and the travel is the same way.
        let home = image(&next.z);
        let ahead: f64 = (home.iter().zip(&from.z))
            .zip(&from.tangent)
            .map(|((a, b), t)| (a - b) * t)
            .sum();
        let same_way: f64 = start
            .tangent
            .iter()
            .zip(&from.tangent)
            .map(|(a, b)| a * b)
            .sum();
        let reached = travelled > 2.0 * h && (0.0..=1.05 * h).contains(&ahead) && same_way > 0.9;
        if reached && distance(&hermite_home(&from, &next, &home, h), &home) < 0.02 * h.max(1e-6) {
            nodes.push(Node {
                z: home,
                tangent: start.tangent.clone(),
            });
            return Some((nodes, true));
        }
        if from.parameter_rate() * next.parameter_rate() < 0.0 {
            nodes.push(locate_limit(follower, &from, &next));
        }
        let over = matches!(path, DrivePath::Time { .. }) && follower.parameter(&next.z) > end;
        let away = runs_away(&next.z, &start.z, false);
        nodes.push(next);
        if over || away {
            break;
        }
    }
    Some((nodes, false))
}

/// The point of the step's cubic that lies nearest to `home`, by its projection on the chord.
fn hermite_home(from: &Node, next: &Node, home: &[f64], h: f64) -> Vec<f64> {
    let mut s = 0.5;
    for _ in 0..20 {
        let z = hermite(from, next, s);
        let miss: f64 = (home.iter().zip(&z))
            .zip(from.z.iter().zip(&next.z))
            .map(|((a, b), (p, q))| (a - b) * (q - p))
            .sum();
        s += miss / (h * h);
        s = s.clamp(-0.1, 1.1);
    }
    hermite(from, next, s)
}
