//! The trace by the plan against one by the bordered systems alone in small steps; a design followed again against a fresh motion.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

mod support;

use std::ops::ControlFlow;

use kempe_motion::Motion;
use kempe_motion::events::EventKind;
use kempe_motion::progress::{Done, Silent, Stage};
use kempe_motion::trace::{Follower, Path};
use support::generate::{make, recipe};
use support::{Case, Rng, difference, spread};

/// Follows a motion from its anchor both ways by the bordered systems alone, in steps of at most `longest`, and holds the rows' poses
/// to the nodes; returns how many were compared.
fn agrees_with_small_steps(case: &Case, motion: &Motion, longest: f64, idle: &[usize]) -> usize {
    let mut follower = Follower::new(&motion.design, &motion.path).without_plan();
    let mut solver = motion.solver();
    let (low, high) = motion.reached();
    let scale = motion.path.scale();
    let anchor = (motion.node_parameters().iter())
        .position(|p| (p - motion.anchor).abs() <= 1e-9 * scale)
        .unwrap();
    let mut compared = 0;
    for direction in [1.0, -1.0] {
        let (p, poses, near) = motion.node(anchor);
        let z = follower.scaled(&poses, &near, p);
        let Some(mut node) = follower.start(z, direction) else {
            continue;
        };
        for index in 0..4000 {
            let mut step = longest;
            let Some(next) = follower.advance(&node, &mut step) else {
                break;
            };
            node = next;
            let p = follower.parameter(&node.z);
            if !(low..=high).contains(&p) || node.parameter_rate() * direction <= 0.0 {
                break;
            }
            let by_an_event = motion.places.iter().any(|e| {
                let margin = if e.kind == EventKind::Limit {
                    1e-5 * scale
                } else {
                    e.bridge
                };
                (p - e.at).abs() <= margin
            });
            if index % 3 > 0 || by_an_event || follower.conditioning() < 1e-6 {
                continue;
            }
            let (mut poses, mut near) = (poses.clone(), near.clone());
            follower.unscaled(&node.z, &mut poses, &mut near);
            let placed = motion.placed(p, &mut solver).unwrap();
            let [a, b] = [&poses, &placed.poses].map(|poses| case.link_poses(poses));
            let off = difference(&a, &b, motion.size(), idle);
            assert!(
                off < 1e-7,
                "at {p} of {low} to {high}: {off:e}\n{}",
                case.text
            );
            let turned = (near.iter().zip(&placed.near).enumerate())
                .filter(|(body, _)| idle.is_empty() && *body > 0)
                .map(|(_, (a, b))| (a - b).abs());
            assert!(
                turned.fold(0.0, f64::max) < 0.1,
                "turns at {p}\n{}",
                case.text
            );
            compared += 1;
        }
    }
    compared
}

#[test]
fn random_mechanisms_are_traced_alike_by_plan_and_by_small_steps() {
    let (mut moved, mut compared) = (0, 0);
    for seed in 0..90 {
        let made = make(&recipe(seed ^ 0x7_1ace));
        let case = Case::of(&made.spec);
        let Ok(motion) = case.motion() else { continue };
        moved += 1;
        compared += agrees_with_small_steps(&case, &motion, 0.03, &made.idle);
    }
    assert!(moved > 40 && compared > 2000, "{moved} {compared}");
}

fn four_bar([a, b, c, d]: [f64; 4], side: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [{d:e}, 0] }}
crank = {{ A-B = {a:e} }}
coupler = {{ B-C = {b:e} }}
rocker = {{ D-C = {c:e} }}
[drives]
motor = {{ turns = \"crank\", from = 0.7, to = 6.9, speed = \"1 rad/s\" }}
[assembly]
C = \"{side} of B -> D\"
"
    )
}

/// Four-bars a little off a change point, on either side of it, of any size: the branches come near each other at 0 or half a turn.
#[test]
fn slivers_are_traced_alike_by_plan_and_by_small_steps() {
    let mut rng = Rng(31);
    let mut compared = 0;
    for round in 0..48 {
        let off = [1e-1, 1e-2, 1e-3, 1e-4][round % 4] * if rng.chance(0.5) { 1.0 } else { -1.0 };
        let [p, q, r] = std::array::from_fn(|_| rng.range(20.0, 90.0));
        let s = (p + q - r).max(10.0);
        // Either the folded or the stretched position is nearly flat.
        let l = if rng.chance(0.5) {
            [p, r, s * (1.0 + off), q]
        } else {
            [p, r, q * (1.0 + off), s]
        };
        let size = 10_f64.powi([0, -4, 5][round % 3]);
        let side = if rng.chance(0.5) { "left" } else { "right" };
        let case = Case::read(&four_bar(l.map(|x| x * size), side), "sliver.toml");
        let Ok(motion) = case.motion() else { continue };
        compared += agrees_with_small_steps(&case, &motion, 0.05 * off.abs().sqrt().min(0.5), &[]);
    }
    assert!(compared > 3000, "{compared}");
}

/// The door lock with bars of these lengths (mm) in its first loop, which has a change point where 410 + bar2 = side + 210.
fn lock(bar2: f64, side: f64, bar6: f64) -> Case {
    let text = Case::example("seeds/door-lock").text;
    let text = text
        .replace("O-A = 230", &format!("O-A = {bar2}"))
        .replace("A-B = 430", &format!("A-B = {side}"))
        .replace("E-F = 300", &format!("E-F = {bar6}"));
    Case::read(&text, "lock.toml")
}

/// Holds a motion found from another to a fresh one.
fn is_fresh(again: &Motion, fresh: &Motion, what: &str) {
    let (a, b) = (&again.assemblies, &fresh.assemblies);
    assert_eq!(
        (a.list.len(), a.rejected, a.complete),
        (b.list.len(), b.rejected, b.complete),
        "{what}"
    );
    assert_eq!(again.ends, fresh.ends, "{what}");
    let diagnostic = |motion: &Motion| -> Vec<_> {
        motion
            .events
            .iter()
            .map(|e| (e.kind, e.steps.clone()))
            .collect()
    };
    assert_eq!(diagnostic(again), diagnostic(fresh), "{what}");
    for (a, b) in again.events.iter().zip(&fresh.events) {
        assert!((a.at - b.at).abs() < 1e-9, "{what}: {} {}", a.at, b.at);
    }
    let (mut one, mut other) = (again.solver(), fresh.solver());
    for p in spread(fresh, 23) {
        let (a, b) = (
            again.placed(p, &mut one).unwrap(),
            fresh.placed(p, &mut other).unwrap(),
        );
        for (a, b) in a.poses.iter().zip(&b.poses) {
            let off = ((a.x - b.x).abs() + (a.y - b.y).abs()) / fresh.size()
                + (a.c - b.c).abs()
                + (a.s - b.s).abs();
            // At a limit poses go with the root of what its place is off.
            assert!(off < 1e-6, "{what} at {p}: {off:e}");
        }
    }
}

#[test]
fn a_design_followed_again_is_on_the_branch_of_a_fresh_motion() {
    let mut rng = Rng(5);
    let mut known = lock(230.0, 430.0, 300.0).must_move();
    let (mut sooner, mut crossings) = (0, 0);
    for round in 0..40 {
        // Small changes, some that keep the change point, and now and then a large one.
        let by = if round % 8 == 7 { 40.0 } else { 4.0 };
        let bar2 = rng.range(230.0 - by, 230.0 + by);
        let side = if round % 3 == 0 {
            200.0 + bar2
        } else {
            rng.range(430.0 - by, 430.0 + by)
        };
        let case = lock(bar2, side, rng.range(300.0 - by, 300.0 + by));
        let mut followed = false;
        let again = known.again(&case.design, &mut |stage: Stage, done: Done| {
            followed |= stage == Stage::Assembling && done.part().is_some();
            ControlFlow::Continue(())
        });
        match (again, case.motion()) {
            (Ok(again), Ok(fresh)) => {
                is_fresh(&again, &fresh, &format!("{bar2} {side}"));
                sooner += usize::from(!followed);
                crossings += again
                    .events
                    .iter()
                    .filter(|e| e.kind == EventKind::ChangePoint)
                    .count();
                known = again;
            }
            (again, fresh) => assert_eq!(again.is_ok(), fresh.is_ok()),
        }
    }
    assert!(sooner > 20 && crossings > 5, "{sooner} {crossings}");
}

/// Nothing is taken from another mechanism's motion but where to look.
#[test]
fn another_mechanisms_motion_misleads_nobody() {
    let lock = lock(230.0, 430.0, 300.0).must_move();
    for seed in 0..25 {
        let case = Case::of(&make(&recipe(seed)).spec);
        let (again, fresh) = (lock.again(&case.design, &mut Silent), case.motion());
        match (again, fresh) {
            (Ok(again), Ok(fresh)) => is_fresh(&again, &fresh, &case.text),
            (again, fresh) => assert_eq!(again.is_ok(), fresh.is_ok()),
        }
    }
}
