//! The equations of motion in time: mechanisms that nothing drives, against reference solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::known;
use std::sync::Arc;

use kempe_dynamics::Source;
use kempe_integrate::{Integrator, Method, Tolerance};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::{Branch, Design, Mechanism};
use kempe_model::{DriveId, Model};
use kempe_motion::Motion;
use kempe_number::Number;
use kempe_number::math::sin_cos;

/// A mechanism of one drive that is let go where its motion starts.
struct Free {
    design: Arc<Design<Series<f64>>>,
    branch: Branch,
    source: Source<f64>,
    start: f64,
}

impl Free {
    fn new(text: &str) -> Self {
        let read = Model::from_toml(text, "free", &mut |_| Err("no files".into())).unwrap();
        let mechanism = Mechanism::new(&read.model);
        let motion = Arc::new(
            Motion::new(&Design::new(&mechanism, &read.model.parameter_values())).unwrap(),
        );
        let mut branch = Branch::neutral(motion.mechanism());
        motion.branch_at(motion.start, &mut branch);
        Self {
            design: Arc::new(motion.design_on::<Series<f64>>()),
            branch,
            source: Source::new(&motion, &motion.design.parameters).unwrap(),
            start: motion.start,
        }
    }

    /// The acceleration of the coordinate.
    fn acceleration(&mut self, q: f64, v: f64) -> Option<f64> {
        let moving = [Series::from_coefficients([q, v, 0.0, 0.0, 0.0])];
        let state = State::moving(&self.design, &self.branch, 0.0, &moving);
        let amounts: Vec<Series<f64>> = (self.source.measures().iter())
            .map(|m| measure(&state, &History::default(), None, m, Along::Time))
            .collect();
        self.source.solve(&state, &amounts);
        let equations = self.source.forces.equations_of_motion(&self.source.instant);
        let nothing = vec![Number::from_f64(0.0)];
        let found = equations.accelerations(&[DriveId(0)], &nothing, &nothing)?;
        Some(found[0].value())
    }

    /// The coordinate and its speed at a time.
    fn at(&mut self, speed: f64, time: f64, relative: f64) -> [f64; 2] {
        let start = [self.start, speed];
        let mut rates = |_: f64, y: &[f64], rates: &mut [f64]| {
            rates[0] = y[1];
            match self.acceleration(y[0], y[1]) {
                Some(a) => rates[1] = a,
                None => return false,
            }
            true
        };
        let tolerance = Tolerance {
            relative,
            absolute: vec![relative],
        };
        let mut it =
            Integrator::with(Method::Explicit, &mut rates, 0.0, &start, 1.0, tolerance).unwrap();
        while it.time() < time {
            it.step(&mut rates, time).unwrap();
        }
        [it.state()[0], it.state()[1]]
    }
}

#[test]
fn a_crank_rocker_runs_free() {
    // Uniform rods of 1 kg/m; from 90 degrees at 30 rad/s.
    let text = include_str!("../../../../examples/benchmarks/crank-rocker.toml");
    let mut free = Free::new(text);
    for (time, angle, rate) in known::CRANK_ROCKER {
        let [q, v] = free.at(30.0, time, 1e-13);
        assert!(
            (q - angle).abs() < 1e-10 * angle,
            "{time}: {q}, not {angle}"
        );
        assert!((v - rate).abs() < 1e-10 * rate, "{time}: {v}, not {rate}");
    }
}

#[test]
fn andrews_squeezer_runs_free() {
    // The benchmark's data.
    let text = include_str!("../../../../examples/benchmarks/andrews.toml");
    let mut free = Free::new(text);
    let first = free.acceleration(free.start, 0.0).unwrap();
    assert!(
        (first / 14222.443919954113_f64 - 1.0).abs() < 1e-11,
        "{first}"
    );
    for (time, beta, rate) in known::ANDREWS {
        let [q, v] = free.at(0.0, time, 1e-13);
        assert!((q / beta - 1.0).abs() < 1e-11, "{time}: {q}, not {beta}");
        assert!((v / rate - 1.0).abs() < 1e-9, "{time}: {v}, not {rate}");
    }
}

#[test]
fn a_pendulum_runs_free_as_elliptic_functions_say() {
    let text = include_str!("../../../../examples/benchmarks/pendulum.toml");
    let mut free = Free::new(text);
    for (time, x, y, rate) in known::PENDULUM {
        let [q, v] = free.at(0.0, time, 1e-14);
        let (s, c) = sin_cos(q);
        assert!((c - x).abs() < 1e-11 && (s - y).abs() < 1e-11, "{c} {s}");
        assert!((v.abs() - rate.abs()).abs() < 1e-10, "{time}: {v}");
    }
}

#[test]
fn a_slider_crank_runs_free_from_its_dead_point() {
    // Uniform rods, no gravity, 10 N m on the crank, stretched and at rest. Reference: another integrator, work against energy 5e-11.
    let text = include_str!("../../../../examples/benchmarks/free-slider-crank.toml");
    let [q, v] = Free::new(text).at(0.0, 1.0, 1e-13);
    assert!((q / 5.642_329_982_104_728 - 1.0).abs() < 1e-10, "{q}");
    assert!((v / 10.176_525_166_012_459 - 1.0).abs() < 1e-10, "{v}");
}
