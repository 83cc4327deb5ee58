//! The equations of motion in time: mechanisms that nothing drives, against reference solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

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
    // Uniform rods of 1 kg/m; from 90 degrees at 30 rad/s. Reference: another integrator with an energy drift below 4e-12.
    let text = include_str!("../../../examples/benchmarks/crank-rocker.toml");
    let mut free = Free::new(text);
    for (time, angle, rate) in [
        (0.1, 5.552026524037504, 29.04393968614691),
        (0.5, 20.25304488137455, 31.07100123095598),
        (1.0, 38.92717954011124, 33.02780516330781),
    ] {
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
    // The benchmark's data; at 0.03 s a solution in quadruple precision (beta and its rate).
    let text = include_str!("../../../examples/benchmarks/andrews.toml");
    let mut free = Free::new(text);
    let first = free.acceleration(free.start, 0.0).unwrap();
    assert!(
        (first / 14222.443919954113_f64 - 1.0).abs() < 1e-11,
        "{first}"
    );
    for (time, beta, rate) in [
        (0.01, 2.160_113_131_531_526, 711.923_152_831_103_9),
        (0.03, 15.810771195153707, 1139.9203022591061),
    ] {
        let [q, v] = free.at(0.0, time, 1e-13);
        assert!((q / beta - 1.0).abs() < 1e-11, "{time}: {q}, not {beta}");
        assert!((v / rate - 1.0).abs() < 1e-9, "{time}: {v}, not {rate}");
    }
}

#[test]
fn a_pendulum_runs_free_as_elliptic_functions_say() {
    // 1 kg on 1 m without mass, from rest at x = -1 m: Jacobi's functions at 10 s, to 40 digits.
    let text = include_str!("../../../examples/benchmarks/pendulum.toml");
    let [q, v] = Free::new(text).at(0.0, 10.0, 1e-14);
    let (x, y) = (-0.275_087_462_576_116_86, -0.961_419_205_099_125);
    let (s, c) = sin_cos(q);
    assert!((c - x).abs() < 1e-11 && (s - y).abs() < 1e-11, "{c} {s}");
    assert!((v.abs() - 4.343_160_692_864_683).abs() < 1e-10, "{v}");
}

#[test]
fn a_slider_crank_runs_free_from_its_dead_point() {
    // Uniform rods, no gravity, 10 N m on the crank, stretched and at rest. Reference: another integrator, work against energy 5e-11.
    let text = include_str!("../../../examples/benchmarks/free-slider-crank.toml");
    let [q, v] = Free::new(text).at(0.0, 1.0, 1e-13);
    assert!((q / 5.642_329_982_104_728 - 1.0).abs() < 1e-10, "{q}");
    assert!((v / 10.176_525_166_012_459 - 1.0).abs() < 1e-10, "{v}");
}
