//! Random mechanisms, built so that they close at the start: the motion closes, starts where it was built, and does not
//! depend on how it is asked for.
#![allow(clippy::unwrap_used)]

mod support;

use std::time::{Duration, Instant};

use kempe_kinematics::{MotionError, Sampler};
use support::generate::{Made, make, recipe};
use support::{Case, difference, spread};

/// Closure residual that a row may have without being marked, in sizes of the mechanism.
const CLOSED: f64 = 1e-12;
/// A mechanism nearer to singular than this at its start need not be found.
const REGULAR: f64 = 1e-4;
/// No trace may take longer (dev profile, a busy machine).
const PATIENCE: Duration = Duration::from_secs(20);

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
    let regular = sigma > REGULAR && case.plan.decomposition.surplus.is_empty();
    let start = Instant::now();
    let motion = case.motion();
    let took = start.elapsed();
    if took > PATIENCE {
        return Err(format!("took {took:?}"));
    }
    let motion = match motion {
        Ok(motion) => motion,
        Err(MotionError::CannotAssemble { .. } | MotionError::Locked { .. }) if !regular => {
            return Ok(Outcome::NotRegular);
        }
        Err(MotionError::Undetermined { .. }) if !regular => return Ok(Outcome::NotRegular),
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
            support::SJoint::Gears { .. } | support::SJoint::Rack { .. }
        )
    }) && !case.plan.newton_blocks.is_empty();
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
    let mut sampler = Sampler::new(&motion, &[]).map_err(|e| format!("{e:?}"))?;
    for p in spread(&motion, 23) {
        let row = sampler.at_parameter(p);
        if row.note.is_some() {
            let note = row.note.unwrap();
            let gap = spec.gap(&row.links, &row.coordinates);
            let marked = note.contains("limit of the drive") || note.contains("change point");
            if !marked || !(gap < 1e-8) {
                return Err(format!(
                    "row at {p}: {note}, gap {gap:e}, ends {:?}",
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
    if start.elapsed() > 2 * PATIENCE {
        return Err(format!("took {:?}", start.elapsed()));
    }
    Ok(if regular {
        Outcome::Moved
    } else {
        Outcome::NotRegular
    })
}

/// Link poses with the turn counts that the assembly keeps.
fn unwrapped(case: &Case, assembly: &kempe_kinematics::assemble::Assembly) -> Vec<[f64; 3]> {
    let mut poses = case.link_poses(&assembly.poses);
    for (index, pose) in poses.iter_mut().enumerate() {
        let seat = &case.mechanism.seats[index];
        let near =
            assembly.branch.near[seat.body.index()] + case.design.geometry.seat_angles[index];
        pose[2] = near + support::wrapped(pose[2] - near);
    }
    poses
}

/// Searches for failures: `KEMPE_HUNT=from..to cargo test -p kempe-kinematics --test prop_motion hunt -- --ignored`.
#[test]
#[ignore = "a search, not a test"]
fn hunt() {
    let range = std::env::var("KEMPE_HUNT").unwrap_or_else(|_| "0..100".into());
    let (from, to) = range.split_once("..").unwrap();
    let (mut moved, mut other, mut failed) = (0, 0, 0);
    for seed in from.parse::<u64>().unwrap()..to.parse::<u64>().unwrap() {
        let recipe = recipe(seed);
        let start = Instant::now();
        if std::env::var_os("KEMPE_SHOW").is_some() {
            println!("{}", make(&recipe).spec.toml());
        }
        let result = std::panic::catch_unwind(|| {
            let made = make(&recipe);
            check(&made)
        });
        let took = start.elapsed();
        match result {
            Ok(Ok(Outcome::Moved)) => moved += 1,
            Ok(Ok(Outcome::NotRegular)) => other += 1,
            Ok(Err(text)) => {
                failed += 1;
                println!(
                    "{seed}: {text}\n    {:?} {:?} {took:?}",
                    recipe.driver, recipe.groups
                );
            }
            Err(_) => {
                failed += 1;
                println!("{seed}: PANIC {:?} {:?}", recipe.driver, recipe.groups);
            }
        }
        if took > Duration::from_secs(3) {
            println!(
                "{seed}: slow {took:?} {:?} {:?}",
                recipe.driver, recipe.groups
            );
        }
    }
    println!("moved {moved}, not regular {other}, failed {failed}");
}
