//! From which turn the angle of every link counts.
//!
//! A body has one angle; its links, welded to each other, have one each, and where the motion starts these are what their
//! drives say or within half a turn of their hints, whatever the order of the file and however a weld's angle is written.

use std::f64::consts::{PI, TAU};

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_mechanism::constraint::Joint;
use kempe_mechanism::plan::Step;
use kempe_mechanism::structure::BodyId;
use kempe_model::{DriveKind, HintKind};

use super::assemblies::Assembly;
use super::earlier::Like;

/// An angle this near, rad, to half a turn below its hint counts as half a turn above it: rounding decides no turn.
const HALF_TURN: f64 = 1e-9;

/// Whole turns, rad, of every link's angle in an assembly found with a design; those that no hint tells as in one like it.
pub(super) fn counted_turns(
    design: &Design<f64>,
    coordinates: &[f64],
    assembly: &Assembly,
    like: Option<Like<'_>>,
) -> Vec<f64> {
    let mechanism = &*design.mechanism;
    let model = &mechanism.model;
    let parameters = &design.parameters;
    let geometry = &design.geometry;
    let mut turns = geometry.turns.clone();
    let angle = |link: usize, turns: &[f64]| {
        let body = mechanism.seats[link].body.index();
        let pose = assembly.poses[body].angle_near(assembly.branch.near[body]);
        pose + geometry.seat_angles[link] - geometry.turns[link] + turns[link]
    };
    let mut alone = vec![0; mechanism.bodies];
    for seat in &mechanism.seats {
        alone[seat.body.index()] += 1;
    }
    let meshed = meshed(mechanism);
    for link in 0..model.links.len() {
        let body = mechanism.seats[link].body.index();
        // A body of one link counts its own turns, and one that a gear turns is counted by that gear.
        if alone[body] == 1 || meshed[body] {
            continue;
        }
        let mut hints = model.assembly.iter().filter_map(|hint| match &hint.kind {
            HintKind::NearAngle { link: of, angle } if of.index() == link => {
                Some(kempe_model::value(angle, parameters))
            }
            _ => None,
        });
        let meant = match like {
            Some(like) => like.angle(link),
            None => hints.next_back().unwrap_or(0.0),
        };
        let off = angle(link, &turns) - meant;
        turns[link] -= TAU * ((off - PI - HALF_TURN) / TAU).ceil();
    }
    // A driven angle is what its drive says; that against which it is driven may be driven itself.
    for _ in &model.drives {
        for (drive, coordinate) in model.drives.iter().zip(coordinates) {
            if let DriveKind::Turn { link, relative_to } = drive.kind {
                let wanted = angle(relative_to.index(), &turns) + coordinate;
                let off = wanted - angle(link.index(), &turns);
                turns[link.index()] += TAU * (off / TAU).round();
            }
        }
    }
    turns
}

/// Which bodies are turned by a gear or rack.
fn meshed(mechanism: &Mechanism) -> Vec<bool> {
    let plan = &mechanism.plan;
    let mut meshed = vec![false; mechanism.bodies];
    let mut mark = |body: BodyId| meshed[body.index()] = true;
    for step in &plan.steps {
        match step {
            Step::Gear { body, .. } => mark(*body),
            Step::Roll { own, .. } => mark(own.body),
            Step::Newton { block } => {
                let block = &plan.newton_blocks[*block];
                let of = |row: usize| &mechanism.constraints[row].0;
                let mut rows = block.rows.iter().map(|row| of(row.constraint));
                if rows.any(Joint::counts_turns) {
                    block.unknowns.iter().for_each(|u| mark(u.body()));
                }
            }
            _ => {}
        }
    }
    meshed
}
