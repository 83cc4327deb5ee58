//! Change points of several coordinates: the mechanism goes on as it moves, as its own closed form does.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at};
use std::f64::consts::TAU;

use kempe_dynamics::ForceSampler;
use kempe_integrate::{Integrator, System, Tolerance};
use kempe_model::Measure;
use kempe_motion::{MotionError, Silent};
use kempe_number::math::{cos, sin};
use kempe_simulate::{Ending, Simulated, Unsimulated, simulate};

/// What turns on a pendulum: whatever the pendulum does, its bodies are where one angle says, that of the crank on it.
struct Form {
    text: &'static str,
    /// Of all bodies, the pendulum first.
    bodies: &'static [Body],
    /// The pendulum turns evenly, and the crank alone is let go.
    driven: bool,
}

/// A body on the pendulum.
struct Body {
    /// Mass, kg, and moment of inertia about its center, kg m^2.
    mass: f64,
    moment: f64,
    /// How often it turns while the crank turns once.
    turns: f64,
    /// Where its center is on the pendulum, m, and its derivatives to the crank's angle.
    place: fn(f64) -> [[f64; 2]; 3],
}

/// A point at `[x, y]` of a pendulum and, from there, at `[u, v]` of what turns as the crank does.
fn on_crank([x, y]: [f64; 2], [u, v]: [f64; 2], angle: f64) -> [[f64; 2]; 3] {
    let (c, s) = (cos(angle), sin(angle));
    let [u, v] = [c * u - s * v, s * u + c * v];
    [[x + u, y + v], [-v, u], [-u, -v]]
}

/// A parallelogram: its crank and rocker are parallel, and its coupler is to the pendulum.
const PARALLELOGRAM: Form = Form {
    text: r#"
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
of_last = "angle(rocker)"
push = "reaction(C)"
just_behind = "motor + 0.01 rad"
just_before = "motor - 0.01 rad"
far_behind = "motor + 0.1 rad"
right_before = "motor - 1e-7 rad"
right_behind = "motor + 1e-7 rad"
right_there = "motor + 0 rad"
"#,
    bodies: &[
        Body {
            mass: 3.0,
            moment: 0.03,
            turns: 0.0,
            place: |angle| on_crank([0.0, -0.04], [0.0, 0.0], angle),
        },
        Body {
            mass: 1.0,
            moment: 0.001,
            turns: 1.0,
            place: |angle| on_crank([-0.1, -0.05], [0.04, 0.0], angle),
        },
        Body {
            mass: 1.0,
            moment: 0.004,
            turns: 0.0,
            place: |angle| on_crank([0.0, -0.05], [0.08, 0.0], angle),
        },
        Body {
            mass: 1.4,
            moment: 0.001,
            turns: 1.0,
            place: |angle| on_crank([0.1, -0.05], [0.03, 0.01], angle),
        },
    ],
    driven: false,
};

/// A slider-crank whose rod is as long as its crank: the slider comes to the crank's pivot, where it might stay.
const ISOSCELES: Form = Form {
    text: r#"
units = { length = "mm", angle = "deg" }
[links]
pendulum = { O = [0, 0], E = [100, 0], mass = "3 kg", center = [0, -40], inertia = "0.03 kg m^2" }
frame   = { O = [0, 0] }
crank   = { O-B = 80, mass = "1 kg", center = [40, 0], inertia = "0.001 kg m^2" }
rod     = { B-C = 80, mass = "0.8 kg", center = [40, 0], inertia = "0.001 kg m^2" }
block   = { C = [0, 0], mass = "0.5 kg", inertia = "0.0002 kg m^2" }
[joints]
bore = { slider = "block", at = "C", on = "O -> E" }
[drives]
swing = { turns = "pendulum", LAW }
motor = { turns = "crank", relative_to = "pendulum", at = 40 }
[assembly]
C = { near = [120, 0] }
[measures]
of_pendulum = "angle(pendulum)"
of_crank = "angle(crank)"
of_last = "2 * angle(pendulum) - angle(rod)"
push = "reaction(C)"
"#,
    bodies: &[
        Body {
            mass: 3.0,
            moment: 0.03,
            turns: 0.0,
            place: |angle| on_crank([0.0, -0.04], [0.0, 0.0], angle),
        },
        Body {
            mass: 1.0,
            moment: 0.001,
            turns: 1.0,
            place: |angle| on_crank([0.0, 0.0], [0.04, 0.0], angle),
        },
        Body {
            mass: 0.8,
            moment: 0.001,
            turns: -1.0,
            place: |angle| {
                let (c, s) = (cos(angle), sin(angle));
                [
                    [0.12 * c, 0.04 * s],
                    [-0.12 * s, 0.04 * c],
                    [-0.12 * c, -0.04 * s],
                ]
            },
        },
        Body {
            mass: 0.5,
            moment: 0.0002,
            turns: 0.0,
            place: |angle| {
                let (c, s) = (cos(angle), sin(angle));
                [[0.16 * c, 0.0], [-0.16 * s, 0.0], [-0.16 * c, 0.0]]
            },
        },
    ],
    driven: false,
};

const GRAVITY: f64 = 9.81;
const STANDS: &str = "at = 10";

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A vector turned by a right angle to the left.
fn left([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

impl Form {
    fn free(&self, law: &str, until: f64) -> Free {
        Free::new(&self.text.replace("LAW", law), until)
    }

    /// Energy at angles and speeds of pendulum and crank, J.
    fn energy(&self, [p, q]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
        let of = |body: &Body| {
            let [place, first, _] = (body.place)(q);
            let speed = [0, 1].map(|k| u * left(place)[k] + v * first[k]);
            let turns = u + body.turns * v;
            let height = sin(p) * place[0] + cos(p) * place[1];
            body.mass * (0.5 * dot(speed, speed) + GRAVITY * height)
                + 0.5 * body.moment * turns * turns
        };
        self.bodies.iter().map(of).sum()
    }
}

impl System for Form {
    /// Of the pendulum and of the crank on it: angles, then speeds. By d'Alembert's principle along both, as the pendulum sees it.
    fn rates(&mut self, _: f64, y: &[f64], rates: &mut [f64]) -> bool {
        let ([p, q], [u, v]) = ([y[0], y[1]], [y[2], y[3]]);
        let (mut inertia, mut force) = ([[0.0; 2]; 2], [0.0; 2]);
        for body in self.bodies {
            let [place, first, second] = (body.place)(q);
            let along = [left(place), first];
            let turns = [1.0, body.turns];
            let weight = [-GRAVITY * sin(p), -GRAVITY * cos(p)];
            let by_speeds =
                [0, 1].map(|k| second[k] * v * v - place[k] * u * u + 2.0 * u * v * left(first)[k]);
            for i in 0..2 {
                let lacks = [0, 1].map(|k| weight[k] - by_speeds[k]);
                force[i] += body.mass * dot(along[i], lacks);
                for j in 0..2 {
                    inertia[i][j] +=
                        body.mass * dot(along[i], along[j]) + body.moment * turns[i] * turns[j];
                }
            }
        }
        let [[a, b], [_, c]] = inertia;
        rates[..2].copy_from_slice(&[u, v]);
        (rates[2], rates[3]) = match self.driven {
            true => (0.0, force[1] / c),
            false => {
                let whole = a * c - b * b;
                (
                    (c * force[0] - b * force[1]) / whole,
                    (a * force[1] - b * force[0]) / whole,
                )
            }
        };
        true
    }
}

/// How far what was simulated is from the closed form, rad, at many times: pendulum, crank and what goes with it.
fn off(mut form: Form, free: &Free, found: &Simulated) -> f64 {
    let tolerance = Tolerance {
        relative: 1e-14,
        absolute: vec![1e-14; 4],
    };
    let [p, m] = [0, 1].map(|drive| at(found, drive, 0.0));
    let start = [p[0], m[0], p[1], m[1]];
    let mut known = Integrator::new(&mut form, 0.0, &start, 1.0, tolerance).unwrap();
    let motion = found.motion(&mut Silent).unwrap();
    let names = ["of_pendulum", "of_crank", "of_last", "push"].map(|name| free.measure(name));
    let asked: Vec<&Measure> = names.iter().collect();
    let mut sampler = ForceSampler::new(&motion, &asked).unwrap();
    let mut worst = 0.0_f64;
    for k in 1..=100 {
        let time = found.end * f64::from(k) / 100.0;
        while known.time() < time {
            known.step(&mut form, time).unwrap();
        }
        let values = sampler.values_at_time(time);
        let p = known.state()[0];
        let q = p + known.state()[1];
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
        let mut free = PARALLELOGRAM.free(STANDS, 2.0);
        free.question.start[1][1] = rate;
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        // At half a turn and at whole ones, and beyond.
        let turned = (at(&found, 1, 2.0)[0] / std::f64::consts::PI).abs();
        assert!(turned > 8.0, "{turned}");
        let off = off(PARALLELOGRAM, &free, &found);
        assert!(off < allowed, "{rate} to {tolerance:e}: {off:e}");
    }
}

#[test]
fn a_slider_on_a_pendulum_passes_the_pivot_of_its_crank() {
    for (rate, tolerance, allowed) in [
        (40.0, 1e-13, 5e-9),
        (-35.0, 1e-13, 5e-9),
        (40.0, 1e-9, 1e-5),
    ] {
        let mut free = ISOSCELES.free(STANDS, 2.0);
        free.question.start[1][1] = rate;
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        let turned = at(&found, 1, 2.0)[0].abs();
        assert!(turned > 10.0, "{turned}");
        let off = off(ISOSCELES, &free, &found);
        assert!(off < allowed, "{rate} to {tolerance:e}: {off:e}");
    }
}

/// A lamp's arm of two parallelograms that falls: each keeps its links parallel through its own change points, and energy is kept.
#[test]
fn a_lamp_that_falls_stays_parallel() {
    let lamp = include_str!("../../../model/tests/support/lamp.toml");
    let text = format!(
        "{lamp}{}",
        r#"[measures]
of_elbow = "angle(elbow)"
of_head = "angle(head)"
off_lower = "angle(lower) - angle(stay)"
off_upper = "angle(upper) - angle(rod)"
kinetic = "kinetic_energy"
potential = "potential_energy"
"#
    );
    for (tolerance, allowed) in [(1e-13, 1e-8), (1e-8, 1e-5)] {
        let mut free = Free::new(&text, 1.5);
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until);
        let motion = found.motion(&mut Silent).unwrap();
        let names = [
            "of_elbow",
            "of_head",
            "off_lower",
            "off_upper",
            "kinetic",
            "potential",
        ];
        let names = names.map(|name| free.measure(name));
        let asked: Vec<&Measure> = names.iter().collect();
        let mut sampler = ForceSampler::new(&motion, &asked).unwrap();
        let energy = |values: &[f64]| values[4] + values[5];
        let (mut begin, mut fastest) = (f64::NAN, 0.0_f64);
        let mut worst = [0.0_f64; 2];
        for k in 0..=150 {
            let values = sampler.values_at_time(0.01 * f64::from(k));
            if k == 0 {
                begin = energy(&values);
            }
            fastest = fastest.max(values[4]);
            for angle in &values[..4] {
                let turned = (angle / TAU).round() * TAU;
                worst[0] = worst[0].max((angle - turned).abs());
            }
            worst[1] = worst[1].max((energy(&values) - begin).abs());
        }
        assert!(fastest > 1.0, "{fastest}");
        assert!(worst[0] < 1e-9, "{tolerance:e}: {worst:?}");
        assert!(worst[1] < allowed * fastest, "{tolerance:e}: {worst:?}");
    }
}

#[test]
fn one_that_is_let_go_passes_its_change_points_beside_one_that_is_driven() {
    let turns = r#"from = 10, to = 130, speed = "1 rad/s""#;
    let mut free = PARALLELOGRAM.free(turns, 2.0);
    free.question.free.remove(0);
    free.question.start.remove(0);
    free.question.start[0][1] = 20.0;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let form = Form {
        driven: true,
        ..PARALLELOGRAM
    };
    let off = off(form, &free, &found);
    assert!(off < 5e-9, "{off:e}");
}

/// What struck a stop at an offset of the motor, rad, that gives back all that it takes: energy lost until the end, as a part.
fn lost_at_stop(found: &Simulated, offset: f64) -> f64 {
    let struck = found.happenings.first().unwrap();
    let gap = at(found, 1, struck.time)[0] + offset;
    assert!(gap.abs() < 1e-9, "{offset}: {gap:e}");
    let energies = [0.0, found.end].map(|time| {
        let [p, m] = [0, 1].map(|drive| at(found, drive, time));
        PARALLELOGRAM.energy([p[0], m[0]], [p[1], m[1]])
    });
    (energies[1] / energies[0] - 1.0).abs()
}

fn against_stop(name: &str) -> Simulated {
    let mut free = PARALLELOGRAM.free(STANDS, 0.5);
    free.question.start[1][1] = -15.0;
    free.stop(name, 1.0);
    free.run()
}

#[test]
fn stops_hold_beside_change_points() {
    for (name, offset) in [
        ("just_behind", 0.01),
        ("just_before", -0.01),
        ("far_behind", 0.1),
    ] {
        let found = against_stop(name);
        assert_eq!(found.ending, Ending::Until, "{name}");
        let lost = lost_at_stop(&found, offset);
        assert!(lost < 1e-8, "{name}: {lost:e}");
    }
}

/// So near that rounding tells nothing of how it goes on: it goes on as it has to, or ends there and says so.
#[test]
fn stops_at_change_points_send_nothing_astray() {
    for (name, offset) in [
        ("right_before", -1e-7),
        ("right_behind", 1e-7),
        ("right_there", 0.0),
    ] {
        let found = against_stop(name);
        match found.ending {
            Ending::Until => {
                let lost = lost_at_stop(&found, offset);
                assert!(lost < 1e-6, "{name}: {lost:e}");
            }
            Ending::TooShort | Ending::NoWay(_) => {
                let [m, _] = at(&found, 1, found.end);
                assert!(m.abs() < 1e-3, "{name}: {m}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn nothing_begins_at_a_change_point() {
    let mut free = PARALLELOGRAM.free(STANDS, 0.5);
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
        let mut free = PARALLELOGRAM.free(STANDS, 0.3);
        free.question.start[1] = [m, rate];
        free.question.tolerance = tolerance;
        let found = free.run();
        assert_eq!(found.ending, Ending::Until, "{m} {rate} {tolerance:e}");
        let off = off(PARALLELOGRAM, &free, &found);
        assert!(off < allowed, "{m} {rate} {tolerance:e}: {off:e}");
    }
}

/// What rests there has no direction by which its table could know the branch that was simulated.
#[test]
fn a_table_on_another_branch_is_refused() {
    let mut free = PARALLELOGRAM.free(STANDS, 0.3);
    free.question.start[1] = [1e-4, 0.0];
    free.question.tolerance = 1e-10;
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    match found.motion(&mut Silent) {
        Ok(_) => {
            let off = off(PARALLELOGRAM, &free, &found);
            assert!(off < 1e-6, "{off:e}");
        }
        Err(refused) => assert!(matches!(refused, MotionError::Entangled { .. })),
    }
}

/// At rest so near to one that rounding makes its steps short.
#[test]
fn what_rests_a_hair_before_a_change_point_passes_it() {
    let mut free = PARALLELOGRAM.free(STANDS, 0.3);
    free.question.start[1] = [1e-4, 0.0];
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let known = PARALLELOGRAM.energy([at(&found, 0, 0.0)[0], 1e-4], [0.0, 0.0]);
    let [p, m] = [0, 1].map(|drive| at(&found, drive, 0.3));
    let energy = PARALLELOGRAM.energy([p[0], m[0]], [p[1], m[1]]);
    let steps = found.used.explicit + found.used.implicit;
    assert!((energy / known - 1.0).abs() < 1e-8);
    assert!(steps < 5000, "{steps}");
}
