//! A whole circuit, past its dead points: the curve of poses followed by arc length until it closes or cannot go on.
//!
//! Between two dead points the drive's coordinate runs one way, so a circuit is a list of ordinary motions, travelled
//! up and down in turn.

mod round;
mod rows;

pub use self::round::CIRCUIT_STEPS;
pub(crate) use self::round::go_round;

use std::sync::Arc;

use kempe_mechanism::Design;

use kempe_model::{Law, LawPiece};
use kempe_units::Expr;

use crate::assemble::Assemblies;
use crate::drive_path::DrivePath;
use crate::motion::{EndReason, Motion, MotionError, Unlocated, restricting_steps};
use crate::progress::{Progress, Silent, Stage};
use crate::trace::{Follower, Node, Path, distance};

/// A stretch of a circuit on which the drive's coordinate runs one way.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// The motion, over rising coordinates.
    pub motion: Arc<Motion>,
    /// Whether the circuit travels it upwards.
    pub forward: bool,
    /// Arc length (mechanism sizes and rad over all bodies) at every node, in the order of travel.
    arcs: Vec<f64>,
    /// The nodes in the order of travel.
    nodes: Vec<Node>,
}

/// A circuit of a mechanism: everything that can be reached without taking it apart.
#[derive(Clone, Debug)]
pub struct Circuit {
    /// Its stretches in the order of travel.
    pub stretches: Vec<Stroke>,
    /// Whether it came back to its start.
    pub closed: bool,
    /// Whole arc length, in mechanism sizes and rad over all bodies.
    pub length: f64,
    /// All assemblies where one was chosen, at the start or as drawn.
    pub assemblies: Assemblies,
    /// The motion that the drives' laws demand, as far as it goes: where the circuit starts.
    pub demanded: Arc<Motion>,
    scale: f64,
}

impl Circuit {
    /// Traces the circuit through the assembly meant by the file's hints at the drive's start.
    ///
    /// # Errors
    /// When it cannot start; see [`Motion::new`].
    pub fn new(design: &Design<f64>) -> Result<Self, MotionError> {
        Self::with_progress(design, &mut Silent)
    }

    /// As [`Circuit::new`]; `progress` hears how far it has come and may stop it.
    ///
    /// # Errors
    /// As [`Circuit::new`], and [`MotionError::Stopped`].
    pub fn with_progress(
        design: &Design<f64>,
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        // The demanded motion finds the start, with all its checks.
        let motion = Motion::with_progress(design, progress)?;
        let (low, high) = motion.demanded;
        let direction = if motion.start == low { 1.0 } else { -1.0 };
        let (path, assemblies) = (motion.path.clone(), motion.assemblies.clone());
        let locked = || MotionError::Locked {
            at: motion.start,
            assemblies: Box::new(assemblies.clone()),
        };
        let Some(chosen) = assemblies.list.first() else {
            return Err(locked());
        };
        let design = chosen.count_in(design);
        // Arc lengths are counted along its nodes: steps as even as the bordered systems take them keep rows where they are.
        let mut follower = Follower::new(&design, &path).without_plan();
        let limit = motion
            .limit_at(motion.start)
            .map(|k| motion.nodes[k].clone());
        let start = match limit {
            Some(limit) if direction < 0.0 => limit.turned(),
            Some(limit) => limit,
            None => {
                // The assembly may be known elsewhere, where the mechanism is drawn.
                let at_start = match motion.start_crossing() {
                    None => motion.placed(motion.start, &mut motion.solver()),
                    Some(_) => None,
                };
                let z = match at_start {
                    Some(at) => follower.scaled(&at.poses, &at.near, motion.start),
                    None => follower.scaled(&chosen.poses, &chosen.branch.near, motion.anchor),
                };
                follower.start(z, direction).ok_or_else(locked)?
            }
        };
        restricting_steps(&mut follower, |follower| {
            let (nodes, closed) = go_round(
                follower,
                start.clone(),
                &design.mechanism,
                &path,
                high,
                progress,
            )
            .ok_or(Unlocated::Stopped(Stage::Following))?;
            let mut stretches = Vec::new();
            let mut length = 0.0;
            for nodes in pieces(nodes) {
                let arcs = arcs(&nodes, length);
                length = arcs.last().copied().unwrap_or(length);
                let (rising, forward) = rising(&nodes);
                let design = running_through(&design, &path, &nodes);
                let (path, assemblies) = (path.clone(), assemblies.clone());
                let mut motion = Motion::of_nodes(design, path, assemblies, rising);
                motion.ends = (EndReason::Limit, EndReason::Limit);
                motion.find_events(follower, progress)?;
                stretches.push(Stroke {
                    motion: Arc::new(motion),
                    forward,
                    arcs,
                    nodes,
                });
            }
            Ok(Self {
                stretches,
                closed,
                length,
                assemblies: assemblies.clone(),
                demanded: motion.clone(),
                scale: path.scale(),
            })
        })
    }

    /// The path parameter at its start. Where branches cross at the demanded start, that is a place beside it.
    pub fn start(&self) -> f64 {
        self.locate(0.0).1
    }

    /// Size of a typical change of the path parameter: a radian, or the mechanism's size.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

/// The design with a drive that runs evenly through a piece in a second: numbers over the piece are numbers over that motion.
fn running_through(design: &Design<f64>, path: &DrivePath, nodes: &[Node]) -> Design<f64> {
    let mut design = design.clone();
    let DrivePath::Coordinate { drive, scale, .. } = path else {
        return design;
    };
    let at = |node: Option<&Node>| Some(node?.z.last()? * scale);
    let (Some(from), Some(to)) = (at(nodes.first()), at(nodes.last())) else {
        return design;
    };
    let mechanism = Arc::make_mut(&mut design.mechanism);
    if let Some(drive) = mechanism.structure.model.drives.get_mut(*drive) {
        drive.law = Law {
            from: Expr::Const(from),
            pieces: vec![LawPiece::ConstantSpeed {
                to: Expr::Const(to),
                speed: Expr::Const((to - from).abs()),
            }],
        };
    }
    design
}

/// Cuts a curve at its dead points, which belong to both pieces.
fn pieces(nodes: Vec<Node>) -> Vec<Vec<Node>> {
    let mut pieces: Vec<Vec<Node>> = Vec::new();
    let mut current: Vec<Node> = Vec::new();
    for node in nodes {
        let at_limit = node.parameter_rate() == 0.0;
        current.push(node.clone());
        if at_limit && current.len() > 1 {
            pieces.push(std::mem::replace(&mut current, vec![node]));
        }
    }
    if current.len() > 1 {
        pieces.push(current);
    }
    pieces
}

/// Arc lengths at the nodes of a piece that begins at `arc`.
fn arcs(nodes: &[Node], mut arc: f64) -> Vec<f64> {
    let mut arcs = vec![arc];
    for pair in nodes.windows(2) {
        arc += distance(&pair[0].z, &pair[1].z);
        arcs.push(arc);
    }
    arcs
}

/// The nodes of a piece in the order of rising path parameters, and whether that is the order of travel.
fn rising(nodes: &[Node]) -> (Vec<Node>, bool) {
    let last = nodes[0].z.len() - 1;
    if nodes[nodes.len() - 1].z[last] > nodes[0].z[last] {
        return (nodes.to_vec(), true);
    }
    (
        nodes.iter().rev().cloned().map(Node::turned).collect(),
        false,
    )
}
