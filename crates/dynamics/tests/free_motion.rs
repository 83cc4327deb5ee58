//! The equations of motion in time: mechanisms that nothing drives, against reference solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use std::sync::Arc;

use kempe_dynamics::Source;
use kempe_integrate::{Dop853, Tolerance};
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
        let mut it = Dop853::new(&mut rates, 0.0, &start, 1.0, tolerance).unwrap();
        while it.time() < time {
            it.step(&mut rates, time).unwrap();
        }
        [it.state()[0], it.state()[1]]
    }
}

#[test]
fn a_crank_rocker_runs_free() {
    // Uniform rods of 1 kg/m; from 90 degrees at 30 rad/s. Reference: another integrator with an energy drift below 4e-12.
    let rod = |length: f64| {
        let inertia = length * length * length / 12.0;
        format!("mass = \"{length} kg\", inertia = \"{inertia} kg m^2\"")
    };
    let text = format!(
        "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = {{ A = [0, 0], D = [0.25, 0] }}\ncrank = {{ A-B = 0.1, {} }}\n\
         coupler = {{ B-C = 0.25, {} }}\nrocker = {{ D-C = 0.2, {} }}\n[assembly]\nC = \"left of B -> D\"\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 90, to = 450, speed = \"30 rad/s\" }}\n",
        rod(0.1),
        rod(0.25),
        rod(0.2)
    );
    let mut free = Free::new(&text);
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
    let text = "units = { length = \"mm\", angle = \"rad\" }\ngravity = [0, 0]\n[links]\n\
        frame = { O = [0, 0], A = [-69.34, -2.27], B = [-36.35, 32.73], C = [14, 72] }\n\
        k1 = { O-F = 7, mass = 0.04325, inertia = 2.194e-6, center = [0.92, 0] }\n\
        k2 = { F = [0, 0], E = [-28, 0], mass = 0.00365, inertia = 4.410e-7, center = [-11.5, 0] }\n\
        k3 = { B = [0, 0], E = [0, -35], D = [20, -18], mass = 0.02373, inertia = 5.255e-6, center = [18.74, 10.43] }\n\
        k4 = { G = [0, 0], E = [0, -20], mass = 0.00706, inertia = 5.667e-7, center = [0, -5.79] }\n\
        k5 = { A-G = 40, mass = 0.07050, inertia = 1.169e-5, center = [23.08, 9.16] }\n\
        k6 = { H-E = 20, mass = 0.00706, inertia = 5.667e-7, center = [5.79, 0] }\n\
        k7 = { A = [0, 0], H = [0, -40], mass = 0.05498, inertia = 1.912e-5, center = [12.28, 4.49] }\n\
        [drives]\nmotor = { turns = \"k1\", from = \"-0.0617138900142764496 rad\", to = \"15.8 rad\", speed = \"500 rad/s\" }\n\
        [assembly]\nE = { near = [-21, 1] }\nG = { near = [-34, 16] }\nH = { near = [-32, -16] }\n\
        [springs]\nback = { between = \"C-D\", stiffness = 4530, free = 77.85 }\n\
        [loads]\nmom = { torque = \"0.033 N m\", on = \"k1\" }\n";
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
    let text = "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1 }\n\
        [drives]\nmotor = { turns = \"rod\", from = 180, to = 540, speed = \"1 rad/s\" }\n\
        [masses]\nbob = { at = \"P\", mass = \"1 kg\" }\n";
    let [q, v] = Free::new(text).at(0.0, 10.0, 1e-14);
    let (x, y) = (-0.275_087_462_576_116_86, -0.961_419_205_099_125);
    let (s, c) = sin_cos(q);
    assert!((c - x).abs() < 1e-11 && (s - y).abs() < 1e-11, "{c} {s}");
    assert!((v.abs() - 4.343_160_692_864_683).abs() < 1e-10, "{v}");
}

#[test]
fn a_slider_crank_runs_free_from_its_dead_point() {
    // Uniform rods, no gravity, 10 N m on the crank, stretched and at rest. Reference: another integrator, work against energy 5e-11.
    let text = "gravity = [0, 0]\n[links]\nframe = { O = [0, 0], X = [1, 0] }\n\
        crank = { O-B = 0.5, mass = 2, inertia = \"0.5 / 12 * 1 kg m^2\" }\n\
        rod = { B-C = 1, mass = 4, inertia = \"4 / 12 * 1 kg m^2\" }\nslider = { C = [0, 0], mass = 1, inertia = 1 }\n\
        [joints]\nguide = { slider = \"slider\", at = \"C\", on = \"O -> X\" }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n\
        [assembly]\nC = { near = [1.5, 0] }\n[loads]\npush = { torque = \"10 N m\", on = \"crank\" }\n";
    let [q, v] = Free::new(text).at(0.0, 1.0, 1e-13);
    assert!((q / 5.642_329_982_104_728 - 1.0).abs() < 1e-10, "{q}");
    assert!((v / 10.176_525_166_012_459 - 1.0).abs() < 1e-10, "{v}");
}
