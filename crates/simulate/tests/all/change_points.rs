//! Change points of several coordinates: the mechanism goes on as it moves, as its own closed form does.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at};
use kempe_dynamics::ForceSampler;
use kempe_integrate::{Integrator, System, Tolerance};
use kempe_model::Measure;
use kempe_motion::Silent;
use kempe_number::math::{cos, sin};
use kempe_simulate::{Ending, Simulated, Unsimulated, simulate};

/// A parallelogram on a pendulum: its crank and rocker are parallel whatever it does, and its coupler is to the pendulum.
const ON_PENDULUM: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
pendulum = { O = [0, 0], A = [-100, -50], D = [100, -50], mass = "3 kg", center = [0, -40], inertia = "0.03 kg m^2" }
frame   = { O = [0, 0] }
crank   = { A-B = 80, mass = "1 kg", center = [40, 0], inertia = "0.001 kg m^2" }
coupler = { B-C = 200, mass = "1 kg", center = [100, 0], inertia = "0.004 kg m^2" }
rocker  = { D-C = 80, mass = "1.4 kg", center = [30, 10], inertia = "0.001 kg m^2" }
[drives]
swing = { turns = "pendulum", LAW }
motor = { turns = "crank", relative_to = "pendulum", at = 40 }
[assembly]
C = "left of B -> D"
[measures]
of_pendulum = "angle(pendulum)"
of_crank = "angle(crank)"
of_rocker = "angle(rocker)"
push = "reaction(C)"
just_behind = "motor + 0.01 rad"
just_before = "motor - 0.01 rad"
far_behind = "motor + 0.1 rad"
"#;

const STANDS: &str = "at = 10";

fn on_pendulum(law: &str) -> String {
    ON_PENDULUM.replace("LAW", law)
}

/// It is a double pendulum: of every body the mass, kg, and the parts of its center's place, m, that turn as the pendulum and as the crank.
const BODIES: [(f64, [f64; 2], [f64; 2]); 4] = [
    (3.0, [0.0, -0.04], [0.0, 0.0]),
    (1.0, [-0.1, -0.05], [0.04, 0.0]),
    (1.0, [0.0, -0.05], [0.08, 0.0]),
    (1.4, [0.1, -0.05], [0.03, 0.01]),
];
const GRAVITY: f64 = 9.81;

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (c, s) = (cos(angle), sin(angle));
    [c * x - s * y, s * x + c * y]
}

/// What the closed form is followed with: pendulum and crank are let go, or the crank alone while the pendulum turns by itself.
struct Parallel {
    driven: bool,
}

impl System for Parallel {
    /// Of pendulum and crank: angles, then speeds.
    fn rates(&mut self, _: f64, y: &[f64], rates: &mut [f64]) -> bool {
        let ([p, q], [u, v]) = ([y[0], y[1]], [y[2], y[3]]);
        let mut inertia = [0.03 + 0.004, 0.001 + 0.001];
        let (mut both, mut change, mut force) = (0.0, 0.0, [0.0; 2]);
        for (m, s, t) in BODIES {
            let (s, t) = (turned(s, p), turned(t, q));
            inertia[0] += m * dot(s, s);
            inertia[1] += m * dot(t, t);
            both += m * dot(s, t);
            change += m * dot(s, [-t[1], t[0]]);
            force[0] -= m * GRAVITY * s[0];
            force[1] -= m * GRAVITY * t[0];
        }
        force[0] -= change * v * v;
        force[1] += change * u * u;
        let whole = inertia[0] * inertia[1] - both * both;
        rates[..2].copy_from_slice(&[u, v]);
        (rates[2], rates[3]) = match self.driven {
            true => (0.0, force[1] / inertia[1]),
            false => (
                (inertia[1] * force[0] - both * force[1]) / whole,
                (inertia[0] * force[1] - both * force[0]) / whole,
            ),
        };
        true
    }
}

/// Energy of the closed form, J.
fn energy([p, q]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    let of = |(m, s, t): (f64, [f64; 2], [f64; 2])| {
        let (s, t) = (turned(s, p), turned(t, q));
        let speed = [-u * s[1] - v * t[1], u * s[0] + v * t[0]];
        0.5 * m * dot(speed, speed) + m * GRAVITY * (s[1] + t[1])
    };
    BODIES.into_iter().map(of).sum::<f64>() + 0.5 * (0.034 * u * u + 0.002 * v * v)
}

/// How far what was simulated is from the closed form, rad, at many times: pendulum, crank and rocker.
fn off(free: &Free, found: &Simulated, driven: bool) -> f64 {
    let tolerance = Tolerance {
        relative: 1e-14,
        absolute: vec![1e-14; 4],
    };
    let [p, m] = [0, 1].map(|drive| at(found, drive, 0.0));
    let start = [p[0], p[0] + m[0], p[1], p[1] + m[1]];
    let mut form = Parallel { driven };
    let mut known = Integrator::new(&mut form, 0.0, &start, 1.0, tolerance).unwrap();
    let motion = found.motion(&mut Silent).unwrap();
    let names = ["of_pendulum", "of_crank", "of_rocker", "push"].map(|name| free.measure(name));
    let asked: Vec<&Measure> = names.iter().collect();
    let mut sampler = ForceSampler::new(&motion, &asked).unwrap();
    let mut worst = 0.0_f64;
    for k in 1..=100 {
        let time = found.end * f64::from(k) / 100.0;
        while known.time() < time {
            known.step(&mut form, time).unwrap();
        }
        let values = sampler.values_at_time(time);
        let [p, q] = [known.state()[0], known.state()[1]];
        for (value, wanted) in values.iter().zip([p, q, q]) {
            let off = (value - wanted).abs();
            assert!(off.is_finite(), "nothing at {time}");
            worst = worst.max(off);
        }
        assert!(values[3].is_finite(), "no force at {time}");
    }
    worst
}

#[test]
fn a_parallelogram_on_a_pendulum_passes_its_change_points() {
    for (rate, tolerance, allowed) in [
        (-15.0, 1e-13, 5e-9),
        (9.0, 1e-13, 5e-9),
        (-15.0, 1e-10, 1e-6),
        (-15.0, 1e-8, 1e-4),
    ] {
        let mut free = Free::new(&on_pendulum(STANDS), 2.0);
        free.question.start[1][1] = rate;
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        // At half a turn and at whole ones, and beyond.
        let turned = (at(&found, 1, 2.0)[0] / std::f64::consts::PI).abs();
        assert!(turned > 8.0, "{turned}");
        let off = off(&free, &found, false);
        assert!(off < allowed, "{rate} to {tolerance:e}: {off:e}");
    }
}

#[test]
fn one_that_is_let_go_passes_its_change_points_beside_one_that_is_driven() {
    let turns = r#"from = 10, to = 130, speed = "1 rad/s""#;
    let mut free = Free::new(&on_pendulum(turns), 2.0);
    free.question.free.remove(0);
    free.question.start.remove(0);
    free.question.start[0][1] = 20.0;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let off = off(&free, &found, true);
    assert!(off < 5e-9, "{off:e}");
}

/// A stop just behind a change point, or before one, that gives back all that it takes.
#[test]
fn stops_hold_beside_change_points() {
    for at_stop in ["just_behind", "just_before", "far_behind"] {
        let mut free = Free::new(&on_pendulum(STANDS), 0.5);
        free.question.start[1][1] = -15.0;
        free.stop(at_stop, 1.0);
        let found = free.run();
        assert_eq!(found.ending, Ending::Until, "{at_stop}");
        let struck = found.happenings.first().unwrap();
        let [p, m] = [0, 1].map(|drive| at(&found, drive, struck.time));
        let gap = match at_stop {
            "just_behind" => m[0] + 0.01,
            "just_before" => m[0] - 0.01,
            _ => m[0] + 0.1,
        };
        assert!(gap.abs() < 1e-9, "{at_stop}: {gap:e} {p:?}");
        let energies = [0.0, found.end].map(|time| {
            let [p, m] = [0, 1].map(|drive| at(&found, drive, time));
            energy([p[0], p[0] + m[0]], [p[1], p[1] + m[1]])
        });
        let lost = (energies[1] / energies[0] - 1.0).abs();
        assert!(lost < 1e-8, "{at_stop}: {lost:e}");
    }
}

#[test]
fn nothing_begins_at_a_change_point() {
    let mut free = Free::new(&on_pendulum(STANDS), 0.5);
    free.question.start[1] = [0.0, -15.0];
    let refused = simulate(&free.design, &free.question, &mut Silent);
    let refused = refused.map(|found| found.ending);
    assert!(
        matches!(refused, Err(Unsimulated::AtChangePoint)),
        "{refused:?}"
    );
}

/// Where rounding tells little of accelerations: on this side of the change point, on its way to it or away, and at rest.
#[test]
fn it_may_begin_beside_a_change_point() {
    for (m, rate, tolerance, allowed) in [
        (1e-4, -15.0, 1e-10, 1e-8),
        (1e-3, -15.0, 1e-10, 1e-8),
        (1e-3, -15.0, 1e-13, 1e-8),
        (1e-3, 15.0, 1e-10, 1e-7),
        (1e-3, 0.0, 1e-10, 1e-8),
        (0.01, 0.0, 1e-10, 1e-8),
        (0.03, -15.0, 1e-13, 1e-9),
        (0.1, -15.0, 1e-8, 1e-6),
    ] {
        let mut free = Free::new(&on_pendulum(STANDS), 0.3);
        free.question.start[1] = [m, rate];
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until, "{m} {rate} {tolerance:e}");
        let off = off(&free, &found, false);
        assert!(off < allowed, "{m} {rate} {tolerance:e}: {off:e}");
    }
}
