//! Large blocks: the complete method follows few paths, within a bound, and says what it could not do.
#![allow(clippy::unwrap_used)]

use crate::support;
use std::ops::ControlFlow;

use crate::support::Case;
use kempe_homotopy::WORK_LIMIT;
use kempe_mechanism::mobility::mobility;
use kempe_mechanism::{Branch, Configuration, Pose};
use kempe_motion::assemble::{Solutions, all_real_solutions};

fn two_triads() -> Case {
    Case::read(
        include_str!("../models/two-triads-floating.toml"),
        "two-triads",
    )
}

/// Solves the one Newton block of a mechanism whose drives are at their start, with so much work allowed.
fn solved(
    case: &Case,
    work: &mut f64,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Solutions {
    let mechanism = &case.mechanism;
    let plan = &mechanism.plan;
    let mut state: Configuration<f64> = Configuration::new(mechanism);
    let start: Vec<f64> = (case.model.drives.iter())
        .map(|d| d.law.at(0.0, &case.parameters))
        .collect();
    state.set_inputs(mechanism, &start);
    // What comes before the block needs no branch; what the block seeks is not looked at.
    let branch = Branch::neutral(mechanism);
    case.design.solve(&branch, &mut state);
    let size = case.design.size();
    let situation = state.situation(&case.design, &branch);
    all_real_solutions(
        &plan.newton_blocks[0],
        mechanism,
        &situation,
        size,
        None,
        work,
        progress,
    )
}

/// The two-homogeneous bound of this block is 924; its equations feel few of the unknowns, which leaves 414 paths. The
/// counts are those of this start system: a change that needs more paths shows here, on every machine alike.
#[test]
fn two_triads_under_a_floating_drive_need_few_paths_and_lose_none() {
    let case = two_triads();
    let mut work = WORK_LIMIT;
    let Solutions::Found(_, report) = solved(&case, &mut work, &mut |_| ControlFlow::Continue(()))
    else {
        panic!("it is algebraic");
    };
    assert_eq!(
        (report.paths, report.lost, report.exhausted),
        (414, 0, false)
    );
    assert!(
        WORK_LIMIT - work < 0.15 * WORK_LIMIT,
        "{:e}",
        WORK_LIMIT - work
    );
    let motion = case.must_move();
    assert!(motion.assemblies.complete);
    assert_eq!(motion.assemblies.list.len(), 14);
}

#[test]
fn a_search_that_may_do_less_says_that_it_is_not_complete() {
    let case = two_triads();
    let mut work = 0.01 * WORK_LIMIT;
    let Solutions::Found(_, report) = solved(&case, &mut work, &mut |_| ControlFlow::Continue(()))
    else {
        panic!("it is algebraic");
    };
    assert!(report.exhausted && report.lost > 100, "{report:?}");
    assert!(
        work > -0.01 * WORK_LIMIT,
        "it stops within a path: {work:e}"
    );
    let mut asked = 0;
    let stopped = solved(&case, &mut work, &mut |_| {
        asked += 1;
        if asked == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert!(matches!(stopped, Solutions::Stopped) && asked == 3);
}

/// Four-bars in a row, each driven by the rocker before it, and beside them a bar on three parallel cranks.
fn ladder(loops: usize) -> Case {
    let mut frame = String::from("A0 = [0, 0], E = [10, 0], F = [30, 0]");
    let mut links = String::from("r0 = { A0-B0 = 20 }\n");
    for k in 0..loops {
        frame += &format!(", D{k} = [{}, 0]", 60 * (k + 1));
        links += &format!(
            "c{k} = {{ B{k}-C{k} = 50 }}\nr{n} = {{ D{k}-C{k} = 40, B{n} = [20, 0] }}\n",
            n = k + 1
        );
    }
    links += "p0 = { A0-P = 15 }\np1 = { E-Q = 15 }\np2 = { F-R = 15 }\n";
    links += "bar = { P = [0, 0], Q = [10, 0], R = [30, 0] }\n";
    Case::read(
        &format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ {frame} }}\n{links}[drives]\n\
             motor = {{ turns = \"r0\", from = 0, to = 1, speed = \"1 rad/s\" }}\n"
        ),
        "ladder",
    )
}

/// The rank of the constraints of 800 bodies: dense elimination took half a minute for it.
#[test]
fn the_rank_of_a_large_mechanism_is_found() {
    let case = ladder(400);
    let mechanism = &case.mechanism;
    assert!(mechanism.bodies > 800);
    let mut state: Configuration<f64> = Configuration::new(mechanism);
    let mut rng = support::Rng(3);
    for (link, seat) in case.model.links.iter().zip(&mechanism.seats) {
        let angle = match link.name.as_str() {
            "frame" | "bar" => 0.0,
            "p0" | "p1" | "p2" => 0.7,
            _ => rng.range(0.2, 1.3),
        };
        state.poses[seat.body.index()] = Pose::from_angle(0.0, 0.0, angle);
    }
    let branch = Branch::neutral(mechanism);
    let found = mobility(&case.design, Some((&state, &branch)));
    // The ladder and the bar move; of the three parallel cranks one says nothing new.
    assert_eq!(found.by_rank, Some(2));
    assert_eq!(found.redundant_rows, Some(1));
}
