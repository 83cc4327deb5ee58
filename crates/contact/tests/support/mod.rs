//! Impacts followed in time.
#![allow(dead_code, clippy::unwrap_used)]

use kempe_contact::Normal;
use kempe_integrate::{Integrator, Method, System, Tolerance, crossing};

/// What an impact was, followed step by step until nothing presses any more.
pub struct Followed {
    pub restitution: f64,
    pub indentation: f64,
    pub force: f64,
    pub duration: f64,
    /// The work of the contact force, J.
    pub lost: f64,
}

/// Steps until `event` falls below zero within one; the time and the state there.
pub fn until<S: System>(
    it: &mut Integrator,
    system: &mut S,
    end: f64,
    mut event: impl FnMut(&[f64]) -> f64,
    mut seen: impl FnMut(&[f64]),
) -> (f64, Vec<f64>) {
    let mut state = it.state().to_vec();
    loop {
        it.step(system, end).unwrap();
        let (before, now) = (it.before(), it.time());
        let mut at = |time: f64, state: &mut [f64]| {
            assert!(it.between(system, time, state));
            event(state)
        };
        for part in 1..=8 {
            let time = before + f64::from(part) / 8.0 * (now - before);
            at(time, &mut state);
            seen(&state);
        }
        if at(now, &mut state) < 0.0 && at(before, &mut state) > 0.0 {
            let found = crossing(|t| at(t, &mut state), before, now).unwrap();
            at(found, &mut state);
            return (found, state);
        }
        assert!(now < end, "it never ends");
    }
}

/// Two bodies of a reduced mass meet with a speed.
pub fn follow(law: &Normal<f64>, mass: f64, speed: f64, method: Method, relative: f64) -> Followed {
    // Depth, speed and work in natural sizes: of a law of Hertz the depth is of this order.
    let law_depth = (mass * speed * speed / law.stiffness).sqrt().sqrt();
    let time = law_depth / speed;
    // After the first touch nothing presses only where it ends: for a law that clips, its unclipped force tells.
    let force = |d: f64, v: f64| law.force(d, v, speed);
    let mut system = |_: f64, y: &[f64], r: &mut [f64]| {
        let (d, v) = (y[0] * law_depth, y[1] * speed);
        let f = force(d, v);
        r[0] = y[1];
        r[1] = -f / mass * time / speed;
        r[2] = f * v * time / (mass * speed * speed);
        true
    };
    let tolerance = Tolerance {
        relative,
        absolute: vec![1e-3 * relative, relative, relative],
    };
    let start = [0.0, 1.0, 0.0];
    let mut it = Integrator::with(method, &mut system, 0.0, &start, 1.0, tolerance).unwrap();
    let (mut deepest, mut largest) = (0.0_f64, 0.0_f64);
    // A first short step leaves the beginning, which is no end.
    it.step(&mut system, 1e-3).unwrap();
    let (end, state) = until(
        &mut it,
        &mut system,
        1e4,
        |y| y[0],
        |y| {
            deepest = deepest.max(y[0]);
            largest = largest.max(force(y[0] * law_depth, y[1] * speed));
        },
    );
    Followed {
        restitution: -state[1],
        indentation: deepest * law_depth,
        force: largest,
        duration: end * time,
        lost: state[2] * mass * speed * speed,
    }
}
