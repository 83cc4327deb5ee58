//! Assemblies of a block that holds a gear pair or a rack.
//!
//! A gear ties angles in the ratio of its teeth, which no polynomial of small degree says. Without it the block has one
//! freedom, and its poses form curves. They are cut at some angles of the gear, where every pose is found as that of a
//! mechanism in which the gear is driven; each curve is followed through these all the way round, past its dead points,
//! and the gear's equation is one function along it whose zeros are the assemblies.
//!
//! What can be missed is a curve that lies between two neighbouring cuts.

use std::ops::ControlFlow;

use kempe_mechanism::Design;
use kempe_mechanism::blocks::{Block, Unknown};
use kempe_mechanism::constraint::{Joint, Situation};
use kempe_mechanism::plan::Plan;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::Source;
use kempe_mechanism::{Mechanism, Structure};
use kempe_model::{Drive, DriveKind, Law};
use kempe_number::math::within_half_a_turn;
use kempe_units::{Dimension, Expr};

use super::earlier::Earlier;
use super::search::Search;
use crate::circuit::go_round;
use crate::drive_path::DrivePath;
use crate::progress::{Done, Progress, Stage};
use crate::trace::{Cubic, Follower, Node, hermite};

/// Angles of the gear at which the curves are cut.
pub const CUTS: usize = 12;
/// The first cut, as a part of the way to the next: special poses tend to lie at special angles.
const OFFSET: f64 = 0.37;
/// Two points on a cut closer than this (mechanism sizes and rad) lie on one curve; a trace is this good between nodes.
const SAME_CURVE: f64 = 1e-3;
/// Places within a step of the trace at which the gear's equation is evaluated.
const SAMPLES: usize = 12;

/// A gear pair or rack to open.
pub(crate) struct Gear<'a> {
    /// Its constraint.
    pub constraint: usize,
    /// The step of the plan whose block holds it.
    pub step: usize,
    /// Angles near which those of the bodies are counted.
    pub meant: &'a [f64],
}

/// Poses in whose neighbourhood the gear's constraint may hold; of what is placed after it they say nothing. `None` when stopped; nothing where the gear cannot be opened.
pub(crate) fn candidates(
    design: &Design<f64>,
    coordinates: &[f64],
    gear: Gear<'_>,
    progress: &mut dyn Progress,
) -> Option<Vec<Vec<Pose<f64>>>> {
    let mechanism = &*design.mechanism;
    let Some(opened) = open(design, &gear) else {
        return Some(Vec::new());
    };
    let drive = mechanism.model.drives.len();
    let mut held = coordinates.to_vec();
    held.push(0.0);
    let path = DrivePath::Coordinate {
        drive,
        held: held.clone(),
        is_angle: true,
        scale: 1.0,
    };
    let mut follower = Follower::new(&opened, &path);
    let mut curves: Vec<Vec<Node>> = Vec::new();
    for cut in 0..CUTS {
        let mut hears = |_: Stage, _: Done| -> ControlFlow<()> {
            progress.reached(Stage::Assembling, Done::Part(cut as f64 / CUTS as f64))
        };
        let angle = (cut as f64 + OFFSET) / CUTS as f64 * std::f64::consts::TAU;
        held[drive] = angle;
        let found = Search::new(&opened, &held, Earlier::default(), &mut hears).run()?;
        for assembly in &found.list {
            let z = follower.scaled(&assembly.poses, &assembly.branch.near, angle);
            if curves.iter().any(|curve| passes(curve, &z)) {
                continue;
            }
            for direction in [1.0, -1.0] {
                let Some(start) = follower.start(z.clone(), direction) else {
                    continue;
                };
                let (nodes, closed) = go_round(
                    &mut follower,
                    start,
                    &opened.mechanism,
                    &path,
                    f64::INFINITY,
                    &mut hears,
                )?;
                curves.push(nodes);
                if closed {
                    break;
                }
            }
        }
    }
    let constraint = &mechanism.constraints[gear.constraint].0;
    let mut poses = vec![Pose::identity(); mechanism.bodies];
    let mut near = vec![0.0; mechanism.bodies];
    let mut at = |z: &[f64]| -> (f64, Vec<Pose<f64>>) {
        follower.unscaled(z, &mut poses, &mut near);
        for (near, (pose, meant)) in near.iter_mut().zip(poses.iter().zip(gear.meant)) {
            *near = pose.angle_near(*meant);
        }
        let situation = Situation {
            geometry: &design.geometry,
            inputs: &[],
            poses: &poses,
            near: &near,
        };
        (situation.residual(constraint)[0], poses.clone())
    };
    let mut found = Vec::new();
    for pair in curves.iter().flat_map(|curve| curve.windows(2)) {
        let (from, to) = (&pair[0], &pair[1]);
        let mut last: Option<(f64, f64)> = None;
        for k in 0..=SAMPLES {
            let s = k as f64 / SAMPLES as f64;
            let (value, _) = at(&hermite(from, to, s));
            if let Some((before, other)) = last
                && other * value <= 0.0
            {
                // A jump of the count of turns is bisected too; the block's equations tell it from a zero.
                let (mut low, mut high) = (before, s);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if at(&hermite(from, to, middle)).0 * other > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                found.push(at(&hermite(from, to, 0.5 * (low + high))).1);
            }
            last = Some((s, value));
        }
    }
    Some(found)
}

/// The mechanism with the gear's constraint replaced by a drive that turns it, as far as the gear's block: what is placed
/// after it stands still. It is opened at the angle of one of its wheels on the arm, of the pinion on the rack.
fn open(design: &Design<f64>, gear: &Gear<'_>) -> Option<Design<f64>> {
    let mechanism = &*design.mechanism;
    let plan = &mechanism.plan;
    let Source::Joint(joint) = mechanism.constraints[gear.constraint].1 else {
        return None;
    };
    let placed = Placed::until(plan, gear.step);
    let joint = mechanism.model.joints.get(joint.index())?;
    let turning = mechanism.constraints[gear.constraint]
        .0
        .opened_by(mechanism);
    turning.into_iter().find_map(|(link, relative_to)| {
        let mut model = mechanism.model.clone();
        model.assembly.clear();
        model.drives.push(Drive {
            name: joint.name.clone(),
            kind: DriveKind::Turn { link, relative_to },
            law: Law {
                pieces: Vec::new(),
                from: Expr::Const(0.0),
            },
            dimension: Dimension::ANGLE,
            span: joint.span.clone(),
        });
        let mut opened = Structure::new(&model);
        let mut index = 0;
        let before = opened.joint_constraints;
        opened.constraints.retain(|_| {
            let kept = index != gear.constraint && placed.keeps(index);
            opened.joint_constraints -= usize::from(!kept && index < before);
            index += 1;
            kept
        });
        let opened = Mechanism::of(opened);
        let (old, decomposition) = (&plan.decomposition, &opened.plan.decomposition);
        let left = |unknown| placed.later.contains(unknown);
        let as_before = decomposition.undetermined.iter().all(left)
            && decomposition.surplus.len() == old.surplus.len();
        if !as_before {
            return None;
        }
        // The new drive's angle is the last, and counts from wherever it likes.
        let mut geometry = design.geometry.clone();
        geometry.angles.push([1.0, 0.0]);
        let plain = vec![geometry.clone()];
        Some(Design::from_geometry(
            &opened,
            &design.parameters,
            geometry,
            plain,
        ))
    })
}

/// What of a mechanism is placed up to a step of its plan.
struct Placed {
    /// Constraints that hold only what is placed later.
    dropped: Vec<usize>,
    /// Unknowns that are placed later.
    later: Vec<Unknown>,
}

impl Placed {
    fn until(plan: &Plan, step: usize) -> Self {
        // What is redundant may tie anything to anything.
        let end = match plan.decomposition.surplus.is_empty() {
            true => step + 1,
            false => plan.blocks.len(),
        };
        let constraints = |blocks: &[Block]| -> Vec<usize> {
            let rows = blocks.iter().flat_map(|b| &b.rows);
            rows.map(|row| row.constraint).collect()
        };
        let (now, later) = plan.blocks.split_at(end);
        let needed = constraints(now);
        let mut dropped = constraints(later);
        dropped.retain(|index| !needed.contains(index));
        Self {
            dropped,
            later: later.iter().flat_map(|b| &b.unknowns).copied().collect(),
        }
    }

    fn keeps(&self, constraint: usize) -> bool {
        !self.dropped.contains(&constraint)
    }
}

/// Whether a curve passes through a point, whole turns of any angle aside.
fn passes(curve: &[Node], z: &[f64]) -> bool {
    let last = z.len() - 1;
    let is_angle = |i: usize| i == last || i % 3 == 2;
    let gap = |a: f64, b: f64, i: usize| {
        let gap = a - b;
        if is_angle(i) {
            within_half_a_turn(gap)
        } else {
            gap
        }
    };
    curve.windows(2).any(|pair| {
        let (from, to) = (&pair[0], &pair[1]);
        // Where along the step the cut is passed, if it is.
        let (a, b) = (
            gap(from.z[last], z[last], last),
            gap(to.z[last], z[last], last),
        );
        if a * b > 0.0 || (a - b).abs() > 1.0 {
            return false;
        }
        let cubic = Cubic::new(from, to);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if gap(cubic.at(middle).part(last), z[last], last) * a > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let there = cubic.at(0.5 * (low + high));
        (z.iter().enumerate()).all(|(i, z)| gap(there.part(i), *z, i).abs() <= SAME_CURVE)
    })
}
