//! Slider-cranks with play, against solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::known::{ROUGH, SMOOTH};
use crate::support::until;
use kempe_contact::{
    BlockInGuide, Body, Damping, Fit, Friction, Material, Normal, PinWithPlay, Touch, stiffness,
};
use kempe_integrate::{Integrator, Method, Tolerance};
use kempe_mechanism::pose::Pose;
use kempe_number::math::{cos, sin, sin_cos};

/// A crank of 0.05 m at 5000 rpm, a rod of 0.12 m, and a slider whose pin has 0.5 mm of play in the rod (data of P. Flores).
/// The state is the rod's angle and the slider's place, and their rates.
struct SliderCrank {
    pin: PinWithPlay<f64>,
    normal: Normal<f64>,
    friction: Friction<f64>,
}

const SPEED: f64 = 523.5987755982989;
const CRANK: f64 = 0.05;
const ROD: f64 = 0.12;
const ROD_MASS: f64 = 0.21;
const ROD_INERTIA: f64 = 0.00025;
const SLIDER_MASS: f64 = 0.14;

impl SliderCrank {
    fn new(friction: Friction<f64>) -> Self {
        let steel = Material {
            modulus: 207e9,
            poisson: 0.3,
        };
        let radii = [0.010, 0.0095];
        Self {
            pin: PinWithPlay::new([ROD, 0.0], [0.0, 0.0], radii).unwrap(),
            normal: Normal {
                damping: Damping::Factor(0.1425),
                ..Normal::hertz(stiffness([steel; 2], radii, Fit::Inside).unwrap()).unwrap()
            },
            friction,
        }
    }

    /// Rod, with its origin in the crank's pin, and slider.
    fn bodies(&self, time: f64, y: &[f64]) -> [Body<f64>; 2] {
        let (s, c) = sin_cos(SPEED * time);
        let rod = Body {
            pose: Pose::from_angle(CRANK * c, CRANK * s, y[0]),
            motion: [-CRANK * SPEED * s, CRANK * SPEED * c, y[2]],
        };
        let slider = Body {
            pose: Pose::from_angle(y[1], 0.0, 0.0),
            motion: [y[3], 0.0, 0.0],
        };
        [rod, slider]
    }

    fn touch(&self, time: f64, y: &[f64]) -> Touch<f64> {
        self.pin.touch(&self.bodies(time, y))
    }

    fn force(&self, time: f64, y: &[f64], began_with: f64) -> f64 {
        self.touch(time, y)
            .forces(&self.normal, &self.friction, began_with)[0]
    }

    /// Free, or in a contact that began with a speed. What is free stays so past the touch, so that the place where it is located
    /// lies on a smooth solution.
    fn rates(&self, time: f64, y: &[f64], began_with: Option<f64>, rates: &mut [f64]) {
        let bodies = self.bodies(time, y);
        let touch = self.pin.touch(&bodies);
        let forces = began_with.map_or([0.0; 2], |speed| {
            touch.forces(&self.normal, &self.friction, speed)
        });
        let [on_rod, on_slider] = touch.wrenches(&bodies, forces);
        let (s, c) = sin_cos(SPEED * time);
        let (sr, cr) = sin_cos(y[0]);
        let pin = [-CRANK * SPEED * SPEED * c, -CRANK * SPEED * SPEED * s];
        let half = 0.5 * ROD;
        let turning = on_rod[2] - ROD_MASS * half * (pin[1] * cr - pin[0] * sr);
        rates.copy_from_slice(&[
            y[2],
            y[3],
            turning / (ROD_INERTIA + ROD_MASS * half * half),
            on_slider[0] / SLIDER_MASS,
        ]);
    }
}

/// Start, approach speed, end, depth and largest force of each contact.
fn contacts(
    friction: Friction<f64>,
    method: Method,
    relative: f64,
    known: &[[f64; 5]],
    time_off: f64,
) {
    let it = SliderCrank::new(friction);
    let tolerance = Tolerance {
        relative,
        absolute: [1.0, 0.1, 500.0, 30.0].map(|size| relative * size).to_vec(),
    };
    // Outstretched, with the centres together and the speeds of ideal joints.
    let start = [0.0, CRANK + ROD, -CRANK * SPEED / ROD, 0.0];
    let mut flight = |t: f64, y: &[f64], r: &mut [f64]| {
        it.rates(t, y, None, r);
        true
    };
    let mut now = Integrator::with(method, &mut flight, 0.0, &start, 1.0, tolerance).unwrap();
    for (k, [begin, approach, end, depth, largest]) in known.iter().enumerate() {
        let (time, state) = seek(&it, &mut now, &mut flight, 1.0, |_, _| {});
        let touch = it.touch(time, &state);
        assert!((time / begin - 1.0).abs() < time_off, "{k}: {time}");
        assert!(
            (touch.approach / approach - 1.0).abs() < 5.0 * time_off,
            "{k}: {}",
            touch.approach
        );
        let began_with = touch.approach;
        let mut pressed = |t: f64, y: &[f64], r: &mut [f64]| {
            it.rates(t, y, Some(began_with), r);
            true
        };
        assert!(now.restart(&mut pressed, time, &state));
        let (mut deepest, mut most) = (0.0_f64, 0.0_f64);
        let (time, state) = seek(&it, &mut now, &mut pressed, -1.0, |t, y| {
            deepest = deepest.max(-it.touch(t, y).gap);
            most = most.max(it.force(t, y, began_with));
        });
        assert!((time / end - 1.0).abs() < time_off, "{k}: {time}");
        // Looked at often; the reference has five digits.
        assert!((deepest / depth - 1.0).abs() < 1e-3, "{k}: {deepest}");
        assert!((most / largest - 1.0).abs() < 1e-3, "{k}: {most}");
        assert!(now.restart(&mut flight, time, &state));
    }
}

/// Follows until the gap (`sign` 1) or the indentation (-1) is gone.
fn seek(
    crank: &SliderCrank,
    now: &mut Integrator,
    system: &mut impl FnMut(f64, &[f64], &mut [f64]) -> bool,
    sign: f64,
    mut seen: impl FnMut(f64, &[f64]),
) -> (f64, Vec<f64>) {
    let mut state = now.state().to_vec();
    let mut left = false;
    loop {
        // Shorter than any flight or contact.
        let end = now.time() + 1e-6;
        now.step(system, end).unwrap();
        let (before, time) = (now.before(), now.time());
        let mut gap = |t: f64, state: &mut [f64], now: &mut Integrator| {
            assert!(now.between(system, t, state));
            sign * crank.touch(t, state).gap
        };
        let at_end = gap(time, &mut state, now);
        seen(time, &state);
        if left && at_end < 0.0 {
            let found =
                kempe_integrate::crossing(|t| gap(t, &mut state, now), before, time).unwrap();
            gap(found, &mut state, now);
            return (found, state);
        }
        left |= at_end > 0.0;
        assert!(time < 3e-3, "nothing happens");
    }
}

#[test]
fn contacts_of_a_slider_crank_are_those_known() {
    contacts(Friction::none(), Method::Explicit, 1e-12, &SMOOTH, 1e-9);
    contacts(
        Friction::ambrosio(0.03, 1e-3, 1e-2),
        Method::Explicit,
        1e-12,
        &ROUGH,
        1e-9,
    );
}

#[test]
fn implicit_steps_find_them_too() {
    contacts(Friction::none(), Method::Implicit, 1e-9, &SMOOTH[..2], 1e-7);
}

#[test]
fn a_block_hits_its_guide_when_it_should() {
    // P. Flores, R. Leine, C. Glocker, 2010; the times are those of an event-driven solution.
    let (l1, l2, m1, m2, m3) = (0.153, 0.306, 0.038, 0.038, 0.076);
    let (j1, j2, g) = (7.4e-5, 5.9e-4, 9.81);
    let guide = BlockInGuide {
        guide: [0.0, 0.0],
        along: [1.0, 0.0],
        block: [0.0, 0.0],
        block_along: [1.0, 0.0],
        half_length: 0.05,
        half_height: 0.025,
        half_width: 0.026,
    };
    let touches = |y: &[f64]| {
        let (s1, c1) = sin_cos(y[0]);
        let (s2, c2) = sin_cos(y[1]);
        let block = Body {
            pose: Pose::from_angle(l1 * c1 + l2 * c2, l1 * s1 + l2 * s2, y[2]),
            motion: [
                -l1 * s1 * y[3] - l2 * s2 * y[4],
                l1 * c1 * y[3] + l2 * c2 * y[4],
                y[5],
            ],
        };
        guide.touches(&[Body::at_rest(Pose::identity()), block])
    };
    let p = (0.5 * m2 + m3) * l1 * l2;
    let mut system = |_: f64, y: &[f64], r: &mut [f64]| {
        let (a, b) = (
            j1 + (0.25 * m1 + m2 + m3) * l1 * l1,
            j2 + (0.25 * m2 + m3) * l2 * l2,
        );
        let coupled = p * cos(y[1] - y[0]);
        let s = p * sin(y[0] - y[1]);
        let h1 = -s * y[4] * y[4] - (0.5 * m1 + m2 + m3) * g * l1 * cos(y[0]);
        let h2 = s * y[3] * y[3] - (0.5 * m2 + m3) * g * l2 * cos(y[1]);
        let det = a * b - coupled * coupled;
        r.copy_from_slice(&[
            y[3],
            y[4],
            y[5],
            (b * h1 - coupled * h2) / det,
            (a * h2 - coupled * h1) / det,
            0.0,
        ]);
        true
    };
    for (turning, time, corner) in [(0.0, 0.002692502752, 0), (-0.01, 0.0026909036484, 0)] {
        let tolerance = Tolerance {
            relative: 1e-13,
            absolute: vec![1e-13],
        };
        let start = [0.0, 0.0, 0.0, 150.0, -75.0, turning];
        let mut it =
            Integrator::with(Method::Explicit, &mut system, 0.0, &start, 1.0, tolerance).unwrap();
        let nearest = |y: &[f64]| touches(y).iter().fold(1.0_f64, |least, t| least.min(t.gap));
        let (found, state) = until(&mut it, &mut system, 0.01, nearest, |_| {});
        assert!((found - time).abs() < 1e-12, "{turning}: {found}");
        let hit = &touches(&state);
        assert!(hit[corner].gap.abs() < 1e-14);
        if turning == 0.0 {
            assert!(hit[1].gap.abs() < 1e-14, "both at once");
        } else {
            assert!(hit[1].gap > 1e-7);
            assert!(
                (hit[0].approach - 0.8416338402).abs() < 1e-9,
                "{}",
                hit[0].approach
            );
        }
    }
}
