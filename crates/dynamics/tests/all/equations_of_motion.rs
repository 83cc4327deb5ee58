//! The equations of motion of states that no path made, against inverse dynamics.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, spread};
use kempe_dynamics::{EquationsOfMotion, Source, energy};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::{Branch, Design};
use kempe_model::{Center, Inertia, Place};
use kempe_motion::Motion;
use kempe_number::Number;
use kempe_units::Expr;

/// What the drives give by virtual power, the equations of motion, and the kinetic energy.
struct Found {
    gives: Vec<f64>,
    equations: EquationsOfMotion<f64>,
    kinetic: f64,
}

/// Forces of the state in which the drives stand at `q` with these speeds and accelerations.
fn forces(
    motion: &Arc<Motion>,
    design: &Arc<Design<Series<f64>>>,
    branch: &Branch,
    q: &[f64],
    v: &[f64],
    a: &[f64],
) -> Found {
    let moving: Vec<Series<f64>> = (q.iter().zip(v.iter().zip(a)))
        .map(|(q, (v, a))| Series::from_coefficients([*q, *v, a / 2.0, 0.0, 0.0]))
        .collect();
    let state = State::moving(design, branch, 0.0, &moving);
    let mut source = Source::new(motion, &motion.design.parameters).unwrap();
    let amounts: Vec<Series<f64>> = (source.measures().iter())
        .map(|m| measure(&state, &History::default(), None, m, Along::Time))
        .collect();
    source.solve(&state, &amounts);
    let equations = source.forces.equations_of_motion(&source.instant);
    Found {
        gives: source
            .forces
            .drives
            .iter()
            .map(|d| d.by_power.value.value())
            .collect(),
        kinetic: energy::kinetic(&source.forces.acting, &source.instant).value(),
        equations: EquationsOfMotion {
            size: equations.size,
            mass: equations.mass.iter().map(|m| m.value()).collect(),
            bias: equations.bias.iter().map(|h| h.value()).collect(),
        },
    }
}

#[test]
fn inverse_dynamics_is_mass_times_acceleration_plus_bias() {
    let (mut compared, mut of_several) = (0, 0);
    for seed in 0..160 {
        let mut rng = Rng(seed ^ 0x5ea1);
        let mut model = Case::of(&make(&recipe(seed)).spec).model;
        for link in &mut model.links {
            let mut number = |low: f64, high: f64| Expr::Const(rng.range(low, high));
            link.inertia = Some(Inertia {
                mass: Some(number(0.1, 2.0)),
                moment: Some(number(0.0, 0.01)),
                center: Center::Place(Place::Cartesian {
                    x: number(-0.05, 0.05),
                    y: number(-0.05, 0.05),
                }),
            });
        }
        let case = Case::from_model(model);
        let Ok(motion) = case.motion() else { continue };
        let design = Arc::new(motion.design_on::<Series<f64>>());
        for p in spread(&motion, 4) {
            let mut branch = Branch::neutral(motion.mechanism());
            motion.branch_at(p, &mut branch);
            let mut q = vec![0.0; motion.mechanism().model.drives.len()];
            motion.path.coordinates(p, &mut q);
            let mut random =
                |n: usize| -> Vec<f64> { (0..n).map(|_| rng.range(-2.0, 2.0)).collect() };
            let (v, a, still) = (random(q.len()), random(q.len()), vec![0.0; q.len()]);
            let moving = forces(&motion, &design, &branch, &q, &v, &a);
            let coasting = forces(&motion, &design, &branch, &q, &v, &still);
            let size = moving
                .gives
                .iter()
                .chain(&coasting.equations.mass)
                .fold(0.0_f64, |m, x| m.max(x.abs()));
            let known = moving
                .gives
                .iter()
                .chain(&coasting.equations.mass)
                .all(|x| x.is_finite());
            // At limits coordinates of the drives do not say how the mechanism moves on.
            if !known || size > 1e4 {
                continue;
            }
            // The state without accelerations foretells what the state with them needs.
            for (needed, gives) in coasting.equations.needed(&a).iter().zip(&moving.gives) {
                assert!(
                    (needed - gives).abs() <= 1e-9 * size.max(1.0),
                    "seed {seed}: {needed} is not {gives}"
                );
            }
            for (h, gives) in coasting.equations.bias.iter().zip(&coasting.gives) {
                assert!((h - gives).abs() <= 1e-9 * size.max(1.0));
            }
            for (h, other) in moving.equations.bias.iter().zip(&coasting.equations.bias) {
                assert!((h - other).abs() <= 1e-9 * size.max(1.0));
            }
            let momenta = coasting.equations.mass.chunks_exact(q.len());
            let twice: f64 = (momenta.zip(&v))
                .map(|(row, vi)| vi * row.iter().zip(&v).map(|(m, vj)| m * vj).sum::<f64>())
                .sum();
            let off = (twice / 2.0 - moving.kinetic).abs();
            assert!(
                off <= 1e-9 * moving.kinetic.max(1.0),
                "{twice} {}",
                moving.kinetic
            );
            compared += 1;
            of_several += usize::from(q.len() > 1);
        }
    }
    assert!(
        compared > 200 && of_several > 20,
        "{compared} compared, {of_several} of several drives"
    );
}
