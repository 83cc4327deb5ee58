//! The trace by the plan against one by the bordered systems alone in small steps; a design followed again against a fresh motion.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::support::generate::{make, recipe};
use crate::support::{Case, Rng, difference, spread};
use kempe_mechanism::Design;
use kempe_motion::Motion;
use kempe_motion::events::EventKind;
use kempe_motion::progress::{Done, Silent, Stage};
use kempe_motion::trace::{Follower, Path};

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
    assert_eq!(again.choices, fresh.choices, "{what}");
    assert_eq!(again.anchor, fresh.anchor, "{what}");
    let label = |motion: &Motion| -> Vec<_> {
        motion
            .events
            .iter()
            .map(|e| (e.kind, e.steps.clone()))
            .collect()
    };
    assert_eq!(label(again), label(fresh), "{what}");
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

/// The design with its points moved by up to a part of their distance from their bodies' origins.
fn moved(design: &Design<f64>, part: f64, rng: &mut Rng) -> Design<f64> {
    let mut geometry = design.geometry.clone();
    for marker in &mut geometry.markers {
        let by = rng.range(1.0 - part, 1.0 + part);
        marker.iter_mut().for_each(|x| *x *= by);
    }
    let plain = vec![geometry.clone()];
    Design::from_geometry(&design.mechanism, &design.parameters, geometry, plain)
}

/// Whether a motion was found over the nodes of another.
fn led(again: &Motion, known: &Motion) -> bool {
    let same = |p: f64, q: &f64| (p - q).abs() <= 1e-12 * again.path.scale();
    let mut at = known.node_parameters().iter();
    at.all(|p| again.node_parameters().iter().any(|q| same(*p, q)))
}

/// Random mechanisms, their points moved by little and by much, one change after the other.
#[test]
fn random_designs_followed_again_are_on_the_branch_of_a_fresh_motion() {
    let (mut over, mut met, mut rng) = (0, 0, Rng(9));
    for seed in 0..60 {
        let case = Case::of(&make(&recipe(seed ^ 0x00a9_a111)).spec);
        let Ok(mut known) = case.motion() else {
            continue;
        };
        let mut design = case.design.clone();
        for round in 0..4 {
            design = moved(&design, [1e-4, 1e-3, 0.01, 0.1][round], &mut rng);
            let again = known.again(&design, &mut Silent);
            match (again, Motion::new(&design)) {
                (Ok(again), Ok(fresh)) => {
                    is_fresh(&again, &fresh, &case.text);
                    over += usize::from(led(&again, &known));
                    met += usize::from(!again.places.is_empty());
                    known = again;
                }
                (again, fresh) => assert_eq!(again.is_ok(), fresh.is_ok(), "{}", case.text),
            }
        }
    }
    assert!(over > 20 && met > 20, "{over} {met}");
}

/// Four-bars whose crank turns all the way round, or no longer, and back again: limits appear, vanish, and change points open.
#[test]
fn a_four_bar_followed_again_notices_limits_and_change_points() {
    let text = four_bar([1.0; 4], "left").replace(
        "[links]",
        "[parameters]\na = \"2 mm\"\nb = \"5 mm\"\nc = \"4 mm\"\nd = \"6 mm\"\n[links]",
    );
    let text = ["a", "b", "c"].iter().fold(text, |text, name| {
        text.replacen("= 1e0 }", &format!("= \"{name}\" }}"), 1)
    });
    let text = text.replace("D = [1e0, 0]", "D = [\"d\", 0]");
    let case = Case::read(&text, "four-bar.toml");
    let mut rng = Rng(17);
    let mut known: Option<Arc<Motion>> = None;
    let mut at = [2.0, 5.0, 4.0, 6.0];
    let (mut over, mut appeared, mut vanished, mut crossed) = (0, 0, 0, 0);
    for round in 0..400 {
        // Mostly small changes; now and then one on, or all but on, a change point: the crank with one of the others as long as
        // the rest.
        let by = [1e-4, 1e-3, 1e-2, 0.1][rng.below(4)];
        at = std::array::from_fn(|k| {
            let home = [2.0, 5.0, 4.0, 6.0][k];
            (at[k] * rng.range(1.0 - by, 1.0 + by)).clamp(0.6 * home, 1.4 * home)
        });
        let mut lengths = at;
        if round % 5 == 4 {
            let off = [0.0, 0.0, 0.0, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3][rng.below(9)];
            lengths[0] = at[1] + at[2] - at[3] + off;
        }
        if lengths[0] < 0.2 {
            continue;
        }
        let design = Design::new(&case.mechanism, &lengths.map(|x| 1e-3 * x));
        let fresh = Motion::new(&design);
        let Some(before) = &known else {
            known = fresh.ok();
            continue;
        };
        match (before.again(&design, &mut Silent), fresh) {
            (Ok(again), Ok(fresh)) => {
                is_fresh(&again, &fresh, &format!("{lengths:?}"));
                over += usize::from(led(&again, before));
                let limits = |m: &Motion| m.places.iter().any(|e| e.kind == EventKind::Limit);
                appeared += usize::from(limits(&again) && !limits(before));
                vanished += usize::from(!limits(&again) && limits(before));
                crossed += again.places.len() - usize::from(limits(&again));
                known = Some(again);
            }
            (again, fresh) => assert_eq!(again.is_ok(), fresh.is_ok(), "{lengths:?}"),
        }
    }
    assert!(over > 50 && appeared > 10 && vanished > 10 && crossed > 10);
}
