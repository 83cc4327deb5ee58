//! Large blocks: the complete method follows few paths, within a bound, and says what it could not do.
#![allow(clippy::unwrap_used)]

mod support;

use std::ops::ControlFlow;

use kempe_kinematics::homotopy::{Solutions, WORK_LIMIT, all_real_solutions};
use kempe_kinematics::{Branch, State};
use support::Case;

fn two_triads() -> Case {
    Case::read(
        include_str!("models/two-triads-floating.toml"),
        "two-triads",
    )
}

/// Solves the one Newton block of a mechanism whose drives are at their start, with so much work allowed.
fn solved(case: &Case, work: &mut f64, told: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Solutions {
    let (mechanism, plan) = (&case.mechanism, &case.plan);
    let mut state: State<f64> = State::new(mechanism, plan);
    let start: Vec<f64> = (case.model.drives.iter())
        .map(|d| d.law.at(0.0, &case.parameters))
        .collect();
    state.set_inputs(mechanism, &start);
    // What comes before the block needs no branch; what the block seeks is not looked at.
    let branch = Branch::neutral(mechanism, plan);
    plan.solve(mechanism, &case.design, &branch, &mut state);
    let size = case.design.geometry.size(mechanism);
    let situation = state.situation(&case.design, &branch);
    all_real_solutions(
        &plan.newton_blocks[0],
        mechanism,
        &situation,
        size,
        work,
        told,
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
