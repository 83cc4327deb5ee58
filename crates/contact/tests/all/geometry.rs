//! Where bodies with play touch, against differences in time, virtual power and formulas of the literature.
#![allow(clippy::unwrap_used)]

use kempe_contact::{BlockInGuide, Body, Friction, Normal, PinWithPlay, Touch, Unfit};
use kempe_mechanism::pose::Pose;
use kempe_number::Random;
use kempe_number::math::{cos, sin};

fn random() -> impl FnMut(f64, f64) -> f64 {
    let mut random = Random(11);
    move |low, high| low + (high - low) * random.uniform()
}

/// A body anywhere, moving anyhow.
fn body(next: &mut impl FnMut(f64, f64) -> f64) -> Body<f64> {
    Body {
        pose: Pose::from_angle(next(-1.0, 1.0), next(-1.0, 1.0), next(-3.0, 3.0)),
        motion: [next(-2.0, 2.0), next(-2.0, 2.0), next(-5.0, 5.0)],
    }
}

/// The same bodies a little later.
fn later(bodies: &[Body<f64>; 2], time: f64) -> [Body<f64>; 2] {
    bodies.map(|it| {
        let [x, y, turn] = it.motion.map(|v| v * time);
        Body {
            pose: it.pose.moved(x, y, turn),
            motion: it.motion,
        }
    })
}

fn guide() -> BlockInGuide<f64> {
    BlockInGuide {
        guide: [0.1, -0.2],
        along: [0.8, 0.6],
        block: [0.05, 0.02],
        block_along: [0.6, -0.8],
        half_length: 0.05,
        half_height: 0.025,
        half_width: 0.026,
    }
    .checked()
    .unwrap()
}

fn all(
    pin: &PinWithPlay<f64>,
    guide: &BlockInGuide<f64>,
    bodies: &[Body<f64>; 2],
) -> Vec<Touch<f64>> {
    let corners = guide.touches(bodies);
    [pin.touch(bodies)].into_iter().chain(corners).collect()
}

#[test]
fn gaps_change_as_fast_as_bodies_approach_and_power_is_that_of_both_slips() {
    let mut next = random();
    let pin = PinWithPlay::new([0.3, -0.1], [-0.2, 0.4], [0.010, 0.0095]).unwrap();
    let guide = guide();
    for _ in 0..50 {
        let bodies = [body(&mut next), body(&mut next)];
        let step = 1e-6;
        let [before, after] = [-step, step].map(|time| all(&pin, &guide, &later(&bodies, time)));
        for (k, touch) in all(&pin, &guide, &bodies).into_iter().enumerate() {
            let rate = (after[k].gap - before[k].gap) / (2.0 * step);
            assert!(
                (rate + touch.approach).abs() < 1e-6,
                "{k}: {rate} {}",
                touch.approach
            );
            // The points are apart by the gap, along the normal.
            let [first, second] = touch.points;
            for axis in 0..2 {
                let apart = first[axis] - second[axis] - touch.gap * touch.normal[axis];
                assert!(apart.abs() < 1e-14, "{k}: {apart}");
            }
            // Whatever the forces and whatever the motion.
            let forces = [next(0.0, 100.0), next(-20.0, 20.0)];
            let wrenches = touch.wrenches(&bodies, forces);
            let power: f64 = (wrenches.iter().zip(&bodies))
                .flat_map(|(w, body)| w.iter().zip(body.motion).map(|(f, v)| f * v))
                .sum();
            let known = -forces[0] * touch.approach + forces[1] * touch.slip;
            assert!((power - known).abs() < 1e-11, "{k}: {power} {known}");
            assert_eq!(wrenches[0][..2], wrenches[1].map(|x| -x)[..2], "{k}");
            // Without friction the moments are opposite too, about any point: about the frame's origin.
            let about_origin = |pressing: f64| {
                let wrenches = touch.wrenches(&bodies, [pressing, 0.0]);
                (wrenches.iter().zip(&bodies))
                    .map(|(w, body)| w[2] + body.pose.x * w[1] - body.pose.y * w[0])
                    .sum::<f64>()
            };
            assert!(about_origin(70.0).abs() < 1e-12, "{k}");
        }
    }
}

#[test]
fn a_pin_is_where_its_centres_say() {
    let pin = PinWithPlay::new([0.0, 0.0], [0.0, 0.0], [0.010, 0.0095]).unwrap();
    let at = |x: f64, y: f64, motion: [f64; 3]| Body {
        pose: Pose::from_angle(x, y, 0.7),
        motion,
    };
    // Down and to the right in a proportion of 3 to 4; the journal rolls.
    let bodies = [at(0.0, 0.0, [0.0; 3]), at(6e-4, -8e-4, [0.3, -0.4, 2.0])];
    let touch = pin.touch(&bodies);
    assert!((touch.gap + 5e-4).abs() < 1e-17);
    assert!((touch.normal[0] - 0.6).abs() < 1e-15 && (touch.normal[1] + 0.8).abs() < 1e-15);
    assert!((touch.approach - 0.5).abs() < 1e-15);
    assert!((touch.slip - 2.0 * 0.0095).abs() < 1e-15);
    // The journal is pushed back towards the middle and held back along its slip.
    let normal = Normal::hertz(1e9).unwrap();
    let forces = touch.forces(&normal, &Friction::coulomb(0.1), 0.5);
    assert!(forces[0] > 0.0 && (forces[1] + 0.1 * forces[0]).abs() < 1e-12);
    let [on_bearing, on_journal] = touch.wrenches(&bodies, forces);
    assert!(on_journal[0] * 6e-4 - on_journal[1] * 8e-4 < 0.0);
    assert!(on_journal[2] < 0.0, "against its turning");
    assert!(on_bearing[2] > 0.0, "taken along");
    // In the very middle nothing touches and nothing is undefined.
    let middle = pin.touch(&[at(1.0, 2.0, [0.0; 3]), at(1.0, 2.0, [0.1, 0.2, 3.0])]);
    assert_eq!(middle.gap, pin.clearance());
    assert_eq!(middle.normal, [1.0, 0.0]);
    assert!(middle.slip.is_finite() && middle.approach.is_finite());
    assert_eq!(
        middle.forces(&normal, &Friction::coulomb(0.1), 1.0),
        [0.0, 0.0]
    );
}

#[test]
fn corners_have_the_gaps_of_the_literature() {
    // P. Flores, R. Leine, C. Glocker, 2010: b + c -+ (Y -+ a sin q + b cos q) at a horizontal guide.
    let (a, b, c) = (0.05, 0.025, 0.001);
    let guide = BlockInGuide {
        guide: [0.0, 0.0],
        along: [1.0, 0.0],
        block: [0.0, 0.0],
        block_along: [1.0, 0.0],
        half_length: a,
        half_height: b,
        half_width: b + c,
    };
    for (y, q) in [(0.0, 0.0), (3e-4, 0.01), (-7e-4, -0.015)] {
        let block = Body::at_rest(Pose::from_angle(0.4, y, q));
        let touches = guide.touches(&[Body::at_rest(Pose::identity()), block]);
        let known = [
            b + c - (y - a * sin(q) + b * cos(q)),
            b + c - (y + a * sin(q) + b * cos(q)),
            b + c + y - a * sin(q) - b * cos(q),
            b + c + y + a * sin(q) - b * cos(q),
        ];
        for (k, (touch, known)) in touches.iter().zip(known).enumerate() {
            assert!(
                (touch.gap - known).abs() < 1e-16,
                "{k}: {} {known}",
                touch.gap
            );
        }
        assert_eq!(touches[0].normal, [0.0, 1.0]);
        assert_eq!(touches[2].normal[1], -1.0);
    }
    assert!((guide.clearance() - c).abs() < 1e-17);
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = PinWithPlay::new([0.0; 2], [0.0; 2], [0.0095, 0.010]).unwrap_err();
    assert_eq!(
        refused,
        Unfit::NoRoom {
            around: 0.0095,
            inside: 0.010
        }
    );
    assert!(PinWithPlay::new([0.0; 2], [0.0; 2], [-1.0, -2.0]).is_err());
    assert!(PinWithPlay::new([0.0; 2], [0.0; 2], [f64::NAN, 0.01]).is_err());
    assert!(
        PinWithPlay::new([0.0; 2], [0.0; 2], [0.01, 0.01]).is_ok(),
        "no play is no error"
    );
    let mut tight = guide();
    tight.half_width = 0.02;
    assert!(matches!(tight.checked(), Err(Unfit::NoRoom { .. })));
}
