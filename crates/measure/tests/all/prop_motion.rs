//! Random mechanisms, built so that they close at the start: the motion closes, starts where it was built, and does not
//! depend on how it is asked for.
#![allow(clippy::unwrap_used)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "not a number must fail too"
)]

use crate::support;
use std::ops::ControlFlow;

use crate::support::generate::{Made, Recipe, config, make, recipe, recipes};
use crate::support::{Case, SKind, Spec, bits, difference, spread, turn};
use kempe_measure::{RowNote, Sample, Sampler};
use kempe_motion::assemble::Shortfall;
use kempe_motion::{EndReason, Motion, MotionError};
use proptest::prelude::*;

/// Closure residual that a row may have without being marked, in sizes of the mechanism.
const CLOSED: f64 = 1e-12;
/// A mechanism nearer to singular than this at its start need not be found.
const REGULAR: f64 = 1e-4;
/// No motion may take more work than this, counted in how often its progress hears of it.
const MOST_WORK: usize = 20_000;

/// What happened, for the hunt's statistics.
#[derive(Debug, PartialEq)]
enum Outcome {
    Moved,
    NotRegular,
}

/// Closes everywhere, starts where it was built.
fn check(made: &Made) -> Result<Outcome, String> {
    let spec = &made.spec;
    let built = spec.gap(&spec.poses(), &spec.coordinates());
    if !(built < 1e-11) {
        return Err(format!("the generator is wrong: gap {built:e}"));
    }
    let case = Case::of(spec);
    let sigma = case.sigma(&spec.poses(), &spec.coordinates());
    // A floating drive may fall on two links that cannot move against each other.
    let regular = sigma > REGULAR && case.mechanism.plan.decomposition.surplus.is_empty();
    let on_curve = |j: &support::SJoint| matches!(j, support::SJoint::Curve { .. });
    let mut work = 0;
    let mut bounded = |_, _| {
        work += 1;
        match work < MOST_WORK {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    let motion = match Motion::with_progress(&case.design, &mut bounded) {
        Ok(motion) => motion,
        Err(MotionError::CannotAssemble { .. } | MotionError::Locked { .. }) if !regular => {
            return Ok(Outcome::NotRegular);
        }
        // Groups on smooth curves that no interval search holds are sought from many starts, and said to be.
        Err(MotionError::CannotAssemble { assemblies, .. })
            if spec.joints.iter().any(on_curve)
                && assemblies.shortfall == Some(Shortfall::Searched) =>
        {
            return Ok(Outcome::NotRegular);
        }
        // What hangs on a roller turns with it.
        Err(MotionError::Undetermined { .. }) if !regular || !made.idle.is_empty() => {
            return Ok(Outcome::NotRegular);
        }
        Err(error) => {
            let mut text = format!("sigma {sigma:e}: {error:?}");
            text.truncate(300);
            return Err(text);
        }
    };
    let size = spec.size();
    // Where gears close a loop the same teeth mesh after some turns: then there are more assemblies than are listed.
    let by_teeth = spec.joints.iter().any(|j| {
        matches!(
            j,
            support::SJoint::Gears { .. }
                | support::SJoint::Belt { .. }
                | support::SJoint::Rack { .. }
        )
    }) && !case.mechanism.plan.newton_blocks.is_empty();
    if regular && !by_teeth {
        let near = motion
            .assemblies
            .list
            .iter()
            .map(|a| difference(&case.link_poses(&a.poses), &spec.poses(), size, &made.idle))
            .fold(f64::INFINITY, f64::min);
        if !(near < 1e-9 / sigma.min(0.1)) && motion.anchor == motion.start {
            return Err(format!(
                "the built pose is not among {} assemblies (complete {}): nearest {near:e}, sigma {sigma:e}",
                motion.assemblies.list.len(),
                motion.assemblies.complete
            ));
        }
        if spec.hints && !by_teeth {
            let first = &motion.assemblies.list[0];
            let off = difference(
                &case.link_poses(&first.poses),
                &spec.poses(),
                size,
                &made.idle,
            );
            if !(off < 1e-9 / sigma.min(0.1)) && motion.anchor == motion.start {
                return Err(format!("hints chose another assembly: {off:e}"));
            }
        }
    }
    for assembly in &motion.assemblies.list {
        let mut coordinates = spec.coordinates();
        motion.path.coordinates(motion.anchor, &mut coordinates);
        let gap = spec.gap(&unwrapped(&case, assembly), &coordinates);
        if !(gap < 1e-9) {
            return Err(format!("an assembly does not close: {gap:e}"));
        }
    }
    // Far beyond the ends of its slot a pin is on a cubic that runs away: there rows may be missing, and say so.
    let ends = [motion.ends.0, motion.ends.1];
    let runs_away = ends.contains(&EndReason::Runaway) && spec.joints.iter().any(on_curve);
    let mut sampler = Sampler::new(&motion, &[]).map_err(|e| format!("{e:?}"))?;
    for p in spread(&motion, 23) {
        let row = sampler.at_parameter(p);
        if let Some(note) = row.note {
            let gap = spec.gap(&row.links, &row.coordinates);
            let marked = matches!(
                note,
                RowNote::AtLimit | RowNote::ChangePoint(_) | RowNote::StartsOnChangePoint { .. }
            );
            if runs_away && row.links.iter().flatten().all(|x| x.is_nan()) {
                continue;
            }
            if !marked || !(gap < 1e-8) {
                return Err(format!(
                    "row at {p}: {note:?}, gap {gap:e}, ends {:?}",
                    motion.ends
                ));
            }
            continue;
        }
        // Far out, all is counted from there.
        let far = row.links.iter().fold(1.0_f64, |far, l| {
            far.max(l[0].abs() / size).max(l[1].abs() / size)
        });
        if !(row.closure < CLOSED * far) {
            return Err(format!(
                "row at {p}: closure {:e}, sigma {:e}",
                row.closure, row.smallest_singular_value
            ));
        }
        let gap = spec.gap(&row.links, &row.coordinates);
        if !(gap < 2.0 * CLOSED * far * far) {
            return Err(format!(
                "row at {p}: gap {gap:e} but closure {:e}",
                row.closure
            ));
        }
    }
    Ok(if regular {
        Outcome::Moved
    } else {
        Outcome::NotRegular
    })
}

/// Link poses with the turn counts that the assembly keeps.
fn unwrapped(case: &Case, assembly: &kempe_motion::assemble::Assembly) -> Vec<[f64; 3]> {
    let mut poses = case.link_poses(&assembly.poses);
    for (index, pose) in poses.iter_mut().enumerate() {
        let seat = &case.mechanism.seats[index];
        let near =
            assembly.branch.near[seat.body.index()] + case.design.geometry.seat_angles[index];
        pose[2] = near + support::wrapped(pose[2] - near);
    }
    poses
}

/// Rows of a motion at chosen path parameters.
fn rows(motion: &std::sync::Arc<Motion>, at: &[f64]) -> Vec<Sample> {
    let mut sampler = Sampler::new(motion, &[]).unwrap();
    at.iter().map(|p| sampler.at_parameter(*p)).collect()
}

/// The motion of a recipe and that of its mechanism seen another way are one: `p` tells where the other motion is when
/// this one is at a path parameter, `pose` where the links are.
fn compare(
    made: &Made,
    other: &Spec,
    p: &dyn Fn(f64) -> f64,
    pose: &dyn Fn(usize, [f64; 3]) -> [f64; 3],
    length: f64,
) -> Result<(), TestCaseError> {
    let (one, two) = (Case::of(&made.spec), Case::of(other));
    if !one.mechanism.plan.decomposition.surplus.is_empty() {
        return Ok(());
    }
    let sigma = one.sigma(&made.spec.poses(), &made.spec.coordinates());
    let (Ok(a), Ok(b)) = (one.motion(), two.motion()) else {
        prop_assert!(
            one.motion().is_err() || sigma < 1e-3,
            "the other does not move"
        );
        prop_assert!(
            two.motion().is_err() || sigma < 1e-3,
            "this one does not move"
        );
        return Ok(());
    };
    // Nearly singular starts and gears in loops may choose another assembly.
    if sigma < 1e-3 || !one.mechanism.plan.newton_blocks.is_empty() && has_gears(&made.spec) {
        return Ok(());
    }
    let size = made.spec.size();
    let scale = if a.path.coordinates_are_angles() {
        1.0
    } else {
        size
    };
    let (low, high) = a.reached();
    let (other_low, other_high) = {
        let (low, high) = (p(low), p(high));
        (low.min(high), low.max(high))
    };
    let ends = b.reached();
    let far = format!("{:?} {:?}", a.ends, b.ends);
    if !far.contains("Runaway") && !far.contains("Stuck") {
        let gap = ((ends.0 - other_low).abs()).max((ends.1 - other_high).abs());
        prop_assert!(
            gap <= 1e-10 * scale * length.max(1e-300),
            "reached {:?}, the other {ends:?}, {far}, off {gap:e}",
            (low, high)
        );
    }
    let at: Vec<f64> = (1..12)
        .map(|k| low + (high - low) * f64::from(k) / 12.0)
        .collect();
    let others: Vec<f64> = at.iter().map(|x| p(*x)).collect();
    for (x, y) in rows(&a, &at).iter().zip(&rows(&b, &others)) {
        if x.note.is_some() || y.note.is_some() || far.contains("Runaway") {
            continue;
        }
        let seen: Vec<[f64; 3]> = x
            .links
            .iter()
            .enumerate()
            .map(|(i, l)| pose(i, *l))
            .collect();
        let off = difference(&seen, &y.links, other.size(), &made.idle);
        let allowed = 1e-11 / x.smallest_singular_value.min(0.1);
        prop_assert!(
            off <= allowed,
            "at {}: off {off:e}, sigma {:e}\n{}",
            x.parameter,
            x.smallest_singular_value,
            one.text
        );
    }
    Ok(())
}

fn has_gears(spec: &Spec) -> bool {
    spec.joints.iter().any(|j| {
        matches!(
            j,
            support::SJoint::Gears { .. }
                | support::SJoint::Belt { .. }
                | support::SJoint::Rack { .. }
        )
    })
}

/// Along time there is no coordinate to transform.
fn turns(spec: &Spec) -> Option<bool> {
    spec.drives
        .iter()
        .find(|d| d.from != d.to)
        .map(|d| matches!(d.kind, SKind::Turn { .. }))
}

fn with_hints(recipe: Recipe) -> Made {
    make(&Recipe {
        hints: true,
        ..recipe
    })
}

proptest! {
    #![proptest_config(config(400))]

    /// Closure below 1e-12 of the size; the built pose is among the assemblies, and the hints choose it.
    #[test]
    fn random_mechanisms_close_and_start_where_they_were_built(recipe in recipes(0.8)) {
        let result = check(&make(&recipe));
        prop_assert!(result.is_ok(), "{}\n{}", result.unwrap_err(), make(&recipe).spec.toml());
    }
}

proptest! {
    #![proptest_config(config(150))]

    /// More rows, in another order, from another sampler: the rows that both have are the same to the bit.
    #[test]
    fn rows_do_not_depend_on_the_step(recipe in recipes(1.0)) {
        let case = Case::of(&make(&recipe).spec);
        let Ok(motion) = case.motion() else { return Ok(()) };
        let (coarse, fine) = (spread(&motion, 9), spread(&motion, 33));
        let first = rows(&motion, &coarse);
        let backwards: Vec<f64> = fine.iter().rev().copied().collect();
        let second = rows(&case.motion().unwrap(), &backwards);
        for (k, row) in first.iter().enumerate() {
            prop_assert_eq!(bits(row), bits(&second[32 - 4 * k]));
        }
    }

    #[test]
    fn the_mirror_image_moves_as_the_mirror_image(recipe in recipes(1.0)) {
        let made = with_hints(recipe);
        let turns = turns(&made.spec) == Some(true);
        let p = move |p: f64| if turns { -p } else { p };
        compare(&made, &made.spec.mirrored(), &p, &|_, [x, y, a]| [x, -y, -a], 1.0)?;
    }

    #[test]
    fn size_changes_nothing(recipe in recipes(1.0), power in proptest::sample::select(vec![1e-6, 1e6, 0.3, 1e3])) {
        let made = with_hints(Recipe { decade: 0.0, ..recipe });
        let turns = turns(&made.spec) == Some(true);
        let p = move |p: f64| if turns { p } else { p * power };
        let length = if turns { 1.0 } else { power };
        compare(&made, &made.spec.scaled(power), &p, &|_, [x, y, a]| [x * power, y * power, a], length)?;
    }

    #[test]
    fn moving_and_turning_the_frame_changes_nothing(
        recipe in recipes(1.0),
        x in -50.0..50.0_f64,
        y in -50.0..50.0_f64,
        angle in -3.0..3.0_f64,
    ) {
        let made = with_hints(Recipe { decade: 0.0, ..recipe });
        // Teeth mesh by angles counted from -pi to pi at the start: turned, they may mesh one turn on.
        let angle = if has_gears(&made.spec) { 0.0 } else { angle };
        let moved = made.spec.moved([x, y], angle);
        let shift = moved.drives[0].from - made.spec.drives[0].from;
        let pose = move |link: usize, [px, py, a]: [f64; 3]| {
            let q = turn([px, py], angle);
            if link == 0 { [0.0; 3] } else { [q[0] + x, q[1] + y, a + angle] }
        };
        compare(&made, &moved, &|p| p + shift, &pose, 1.0)?;
    }

    /// Driven from its other end backwards, or from its start the other way in time: the same poses. Here: the drive
    /// starts where it ended, on the assembly it ended on.
    #[test]
    fn going_back_gives_the_same_poses(recipe in recipes(1.0)) {
        let made = with_hints(recipe);
        let case = Case::of(&made.spec);
        let Ok(motion) = case.motion() else { return Ok(()) };
        let (low, high) = motion.reached();
        let drive = &made.spec.drives[0];
        let end = if drive.to > drive.from { high } else { low };
        if motion.assemblies.list.is_empty() || has_gears(&made.spec) {
            return Ok(());
        }
        let row = &rows(&motion, &[end])[0];
        if row.note.is_some() || row.smallest_singular_value < 1e-3 {
            return Ok(());
        }
        let mut back = made.spec.clone();
        (back.drives[0].from, back.drives[0].to) = (end, drive.from);
        if back.drives[0].from == back.drives[0].to {
            return Ok(());
        }
        for (link, pose) in back.links.iter_mut().zip(&row.links).skip(1) {
            link.pose = *pose;
        }
        compare(&Made { spec: back, idle: made.idle.clone() }, &made.spec, &|p| p, &|_, l| l, 1.0)?;
    }
}

/// Searches for failures: `KEMPE_HUNT=from..to cargo test -p kempe-measure --test all prop_motion::hunt -- --ignored`.
#[test]
#[ignore = "a search, not a test"]
fn hunt() {
    let range = std::env::var("KEMPE_HUNT").unwrap_or_else(|_| "0..100".into());
    let (from, to) = range.split_once("..").unwrap();
    let (mut moved, mut other, mut failed) = (0, 0, 0);
    for seed in from.parse::<u64>().unwrap()..to.parse::<u64>().unwrap() {
        let recipe = recipe(seed);
        if std::env::var_os("KEMPE_SHOW").is_some() {
            println!("{}", make(&recipe).spec.toml());
        }
        let result = std::panic::catch_unwind(|| {
            let made = make(&recipe);
            check(&made)
        });
        match result {
            Ok(Ok(Outcome::Moved)) => moved += 1,
            Ok(Ok(Outcome::NotRegular)) => other += 1,
            Ok(Err(text)) => {
                failed += 1;
                println!(
                    "{seed}: {text}\n    {:?} {:?}",
                    recipe.driver, recipe.groups
                );
            }
            Err(_) => {
                failed += 1;
                println!("{seed}: PANIC {:?} {:?}", recipe.driver, recipe.groups);
            }
        }
    }
    println!("moved {moved}, not regular {other}, failed {failed}");
}
