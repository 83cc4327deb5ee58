//! Systems that tests follow, and how.
#![allow(dead_code, clippy::unwrap_used)]

use kempe_integrate::{Integrator, Method, System, Tolerance};
use kempe_number::math::{sin, sin_cos};

/// The same tolerance for all, relative and absolute.
pub fn tolerance(relative: f64) -> Tolerance {
    Tolerance {
        relative,
        absolute: vec![relative],
    }
}

/// Follows a system to a time.
pub fn run(
    method: Method,
    system: &mut impl System,
    (from, to): (f64, f64),
    state: &[f64],
    tolerance: Tolerance,
) -> Integrator {
    let mut it = Integrator::with(method, system, from, state, to - from, tolerance).unwrap();
    while it.time() != to {
        it.step(system, to).unwrap();
    }
    it
}

/// Largest relative difference.
pub fn off(found: &[f64], known: &[f64]) -> f64 {
    assert_eq!(found.len(), known.len());
    (found.iter().zip(known)).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs() / b.abs()))
}

/// The library's simple pendulum: 1 kg on 1 m, 9.81 m/s^2.
pub fn pendulum(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    rates[0] = y[1];
    rates[1] = -9.81 * sin(y[0]);
    true
}

/// Van der Pol's oscillator in the time of its slow motion, with `stiffness` the square of its parameter.
pub fn van_der_pol(stiffness: f64) -> impl FnMut(f64, &[f64], &mut [f64]) -> bool {
    move |_, y, rates| {
        rates[0] = y[1];
        rates[1] = stiffness * ((1.0 - y[0] * y[0]) * y[1] - y[0]);
        true
    }
}

/// Robertson's reactions.
pub fn robertson(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    let (slow, fast, back) = (0.04 * y[0], 3e7 * y[1] * y[1], 1e4 * y[1] * y[2]);
    rates[0] = -slow + back;
    rates[1] = slow - back - fast;
    rates[2] = fast;
    true
}

/// High irradiance responses of plants, eight reactions (Schäfer).
pub fn hires(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    let pair = 280.0 * y[5] * y[7];
    rates[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
    rates[1] = 1.71 * y[0] - 8.75 * y[1];
    rates[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
    rates[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
    rates[4] = -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6];
    rates[5] = -pair + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
    rates[6] = pair - 1.81 * y[6];
    rates[7] = -rates[6];
    true
}

/// The reactions E5 of Enright, Hull and Lindberg, with rates that differ by 16 powers of ten.
pub fn e5(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    let (one, two) = (7.89e-10 * y[0], 1.1e7 * y[0] * y[2]);
    let (three, four) = (1.13e9 * y[1] * y[2], 1.13e3 * y[3]);
    rates[0] = -one - two;
    rates[1] = one - three;
    rates[2] = one - two - three + four;
    rates[3] = two - four;
    true
}

/// A hydraulic cylinder that lifts an arm of 1 m and 120 kg: angle, its rate, both pressures (Pa). The law of the cylinder is
/// Exudyn's HydraulicActuatorSimple.
pub fn hydraulic_arm(_: f64, y: &[f64], rates: &mut [f64]) -> bool {
    let (arm, foot) = (0.25, 0.25);
    let (piston, rod_side, volume, modulus) = (0.01, 0.006, 1e-3, 1.5e9);
    let (supply, tank, flow, damping) = (2e7, 0.0, 2e-8, 2e4);
    let (valve, valve_rod) = (0.5, -0.5);
    let [angle, turning, p0, p1] = [y[0], y[1], y[2], y[3]];
    let (s, c) = sin_cos(angle);
    let length = (arm * arm + foot * foot + 2.0 * arm * foot * s).sqrt();
    let lever = arm * foot * c / length;
    let speed = lever * turning;
    let tension = -p0 * piston + p1 * rod_side + damping * speed;
    let root = |x: f64| x.abs().sqrt().copysign(x);
    let through = |valve: f64, p: f64| {
        let fall = if valve >= 0.0 { supply - p } else { p - tank };
        valve * flow * root(fall)
    };
    rates[0] = turning;
    rates[1] = (-tension * lever - 120.0 * 9.81 * 0.5 * c) / 40.0;
    rates[2] = modulus / volume * (-piston * speed + through(valve, p0));
    rates[3] = modulus / volume * (rod_side * speed + through(valve_rod, p1));
    true
}
