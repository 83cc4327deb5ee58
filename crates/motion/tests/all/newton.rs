//! Newton groups in the coordinates of their spanning trees: the poses, their derivatives and the determinants that the
//! poses of all bodies as unknowns give.

use std::sync::Arc;

use crate::support::Case;
use crate::support::generate::{make, recipe};
use kempe_measure::Sampler;
use kempe_mechanism::{Branch, Configuration, Design, PlanNumber};
use kempe_motion::Motion;
use kempe_number::{Dual, Jet, Number};

/// Mechanisms of the generator that are looked at.
const SEEDS: u64 = 150;

/// Solves at a path parameter, with the plan's trees or without.
fn solve<T: PlanNumber>(
    case: &Case,
    motion: &Motion,
    trees: bool,
    p: f64,
    seed: impl Fn(f64) -> T,
) -> Configuration<T> {
    let mut mechanism = (*case.mechanism).clone();
    if !trees {
        for block in &mut mechanism.plan.newton_blocks {
            block.tree = None;
        }
    }
    let parameters: Vec<T> = case.model.parameter_values();
    let mut design = Design::new(&Arc::new(mechanism), &parameters);
    design.count_turns(&motion.design.geometry.turns);
    let mut branch = Branch::neutral(&case.mechanism);
    motion.branch_at(p, &mut branch);
    let mut coordinates = vec![T::zero(); case.model.drives.len()];
    motion.path.coordinates(seed(p), &mut coordinates);
    let mut state = Configuration::new(&case.mechanism);
    state.set_inputs(&case.mechanism, &coordinates);
    design.solve(&branch, &mut state);
    state
}

/// All numbers of a state's poses, lengths in mechanism sizes.
fn numbers<T: Number>(state: &Configuration<T>, size: f64) -> Vec<T> {
    (state.poses.iter())
        .flat_map(|pose| [pose.x / size, pose.y / size, pose.c, pose.s])
        .collect()
}

fn compare(case: &Case, name: &str) -> usize {
    let Ok(motion) = case.motion() else { return 0 };
    let (low, high) = motion.reached();
    let size = motion.size();
    for part in [0.13, 0.5, 0.87] {
        let p = low + part * (high - low);
        let singular = Sampler::new(&motion, &[])
            .expect("a sampler")
            .without_time(p)
            .smallest_singular_value;
        if !(singular > 1e-3)
            || motion
                .events
                .iter()
                .any(|e| (e.at - p).abs() < 2.0 * e.bridge)
        {
            continue;
        }
        // Rounding of a row moves a pose by its part over the smallest singular value, and every order once more.
        let close = |order: i32, a: f64, b: f64, scale: f64| {
            let allowed = 1e-13 * scale / kempe_number::powi(singular, order + 1);
            assert!(
                (a - b).abs() <= allowed,
                "{name} at {p}, order {order}: {a:e} {b:e}, {singular:e}"
            );
        };
        let [tree, bodies] = [true, false].map(|trees| solve(case, &motion, trees, p, |p| p));
        for (a, b) in numbers(&tree, size).iter().zip(numbers(&bodies, size)) {
            close(0, *a, b, 1.0 + b.abs());
        }
        for (a, b) in tree.determinants.iter().zip(&bodies.determinants) {
            close(0, a / b, 1.0, 100.0);
        }
        let seed = Jet::<f64, 3>::variable;
        let [tree, bodies] =
            [true, false].map(|trees| numbers(&solve(case, &motion, trees, p, seed), size));
        let largest = bodies
            .iter()
            .flat_map(|x| *x.coefficients())
            .fold(1.0, f64::max);
        for (a, b) in tree.iter().zip(&bodies) {
            for k in 0..3 {
                close(k as i32, a.coefficient(k), b.coefficient(k), largest);
            }
        }
        let seed = |p| Dual::<f64, 1>::variable(p, 0);
        let [tree, bodies] =
            [true, false].map(|trees| numbers(&solve(case, &motion, trees, p, seed), size));
        for (a, b) in tree.iter().zip(&bodies) {
            close(1, a.eps[0], b.eps[0], largest);
        }
    }
    1
}

#[test]
fn trees_give_what_the_poses_of_all_bodies_give() {
    let files = [
        "seeds/door-lock",
        "gallery/chebyshev",
        "gallery/class-iii",
        "gallery/scissor-lift",
        "gallery/stephenson-ii",
    ];
    for file in files {
        let case = Case::example(file);
        assert!(
            case.mechanism
                .plan
                .newton_blocks
                .iter()
                .any(|b| b.tree.is_some())
        );
        assert_eq!(compare(&case, file), 1, "{file}");
    }
    let mut seen = 0;
    for seed in 0..SEEDS {
        let case = Case::of(&make(&recipe(seed)).spec);
        if case
            .mechanism
            .plan
            .newton_blocks
            .iter()
            .any(|b| b.tree.is_some())
        {
            seen += compare(&case, &format!("seed {seed}"));
        }
    }
    assert!(
        seen > 15,
        "only {seen} of the generator's mechanisms have a tree"
    );
}

/// Poses hang on guesses only where the plan goes by them: without them they are the same to the last bit, and so are turns.
#[test]
fn poses_solved_alone_are_those_solved_with_guesses() {
    let (mut seen, mut without) = (0, 0);
    let generated = (0..SEEDS).map(|seed| Case::of(&make(&recipe(seed)).spec));
    let files = [
        "gallery/chebyshev",
        "gallery/andrews-squeezer",
        "gallery/drag-link",
    ];
    for case in files.into_iter().map(Case::example).chain(generated) {
        let Ok(motion) = case.motion() else { continue };
        let (low, high) = motion.reached();
        let (mut one, mut other) = (motion.solver::<f64>(), motion.solver::<f64>());
        for k in 0..40 {
            let p = low + (high - low) * (f64::from(k) + 0.5) / 40.0;
            motion.solve(&motion.design, p, &mut one);
            motion.solve_alone(&motion.design, p, &mut other);
            let poses = one.state.poses.iter().zip(&other.state.poses);
            for (a, b) in poses.skip(1) {
                let bits = |pose: &kempe_mechanism::Pose<f64>| {
                    [pose.x, pose.y, pose.c, pose.s].map(f64::to_bits)
                };
                assert_eq!(bits(a), bits(b), "at {p}");
            }
            for (a, b) in one.branch.near.iter().zip(&other.branch.near) {
                assert!((a - b).abs() < 1.0, "{a} {b} at {p}");
            }
        }
        seen += 1;
        let steps = &case.mechanism.plan.steps;
        without += usize::from(!steps.iter().any(kempe_mechanism::plan::Step::needs_guess));
    }
    assert!(seen > 50 && without > 20, "{seen} {without}");
}
