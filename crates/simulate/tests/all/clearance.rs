//! Joints with play whose bodies touch and part, against solutions found apart from Kempe.
#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use crate::common::{Free, at};
use crate::known;
use kempe_model::ContactStates;
use kempe_number::math::atan2;
use kempe_simulate::{Ending, Happened, Touched};

const SLIDER_CRANK: &str =
    include_str!("../../../../examples/benchmarks/clearance-slider-crank.toml");
const SLIDER: &str = include_str!("../../../../examples/benchmarks/clearance-slider.toml");

/// In the middle of the play.
const REST: [[f64; 2]; 2] = [[0.0; 2]; 2];

fn slider_crank(friction: f64, until: f64) -> Free {
    let text = SLIDER_CRANK.replace("mu       = 0 ", &format!("mu       = {friction} "));
    let mut free = Free::new(&text, until);
    free.question.free.clear();
    free.question.start.clear();
    free.play(ContactStates::Three, REST);
    free
}

#[test]
fn a_rattling_pin_meets_its_bore_as_known() {
    for (friction, known) in [(0.0, known::SMOOTH), (0.03, known::ROUGH)] {
        let found = slider_crank(friction, 1e-3).run();
        assert_eq!(found.ending, Ending::Until);
        let first = found.touched[0].touching;
        assert!((first.from - known[0][0]).abs() < 1e-15, "{}", first.from);
        assert!((first.to - known[0][2]).abs() < 1e-15, "{}", first.to);
        for (touch, [from, speed, to, depth, force]) in found.touched.iter().zip(known) {
            let it = &touch.touching;
            let near = |found: f64, known: f64, by: f64| {
                let off = (found / known - 1.0).abs();
                assert!(
                    off < by,
                    "{friction}, at {from}: {found} is {off:e} off {known}"
                );
            };
            near(it.from, from, 1e-8);
            near(it.speed, speed, 1e-8);
            near(it.to, to, 1e-8);
            // These are printed to five digits.
            near(touch.depth[0], depth, 5e-5);
            near(touch.force[0], force, 5e-5);
        }
    }
}

#[test]
fn it_rattles_on_without_friction_and_comes_to_follow_with_it() {
    // Over two turns: contacts, those of the first turn, and the largest force after it, kN.
    for (friction, contacts, in_first_turn, force) in [(0.0, 44, 28, 27.79), (0.03, 25, 23, 8.57)] {
        let found = slider_crank(friction, 0.024).run();
        let (first, after): (Vec<&Touched>, Vec<&Touched>) =
            (found.touched.iter()).partition(|touch| touch.touching.from < 0.012);
        assert_eq!(
            [found.touched.len(), first.len()],
            [contacts, in_first_turn],
            "{friction}"
        );
        let largest = after.iter().map(|t| t.force[0]).fold(0.0, f64::max);
        assert!(
            (largest / 1e3 - force).abs() < 0.01,
            "{friction}: {largest}"
        );
    }
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let [a, b] = [0, 1].map(|_| slider_crank(0.03, 2e-3).run());
    assert!(a.touched.len() > 3);
    assert_eq!(a.touched, b.touched);
    assert_eq!(a.laws, b.laws);
}

/// A law gives back what it is asked for: a pin that falls into its bore, straight, while the crank stands still.
#[test]
fn a_pin_that_falls_gives_back_what_its_law_delivers() {
    const FALLING: &str = r#"
units = { length = "m" }
gravity = [0, "-9.81 m/s^2"]
[links]
frame = { A = [0, 0], X = [1, 0] }
bob   = { A = [0, 0], mass = 2, inertia = 1 }
[clearance]
A = { radial = "10 mm", radius = "50 mm", stiffness = 1e13, restitution = 0.5, spring = "1e6 N/m" }
[drives]
turn = { turns = "bob", at = 0 }
"#;
    for (law, delivered) in [
        ("exact", 0.5),
        ("lankarani-nikravesh", 0.72524111),
        ("flores", 0.47044478),
        ("hertz", 1.0),
    ] {
        let text = FALLING.replace("restitution", &format!("law = \"{law}\", restitution"));
        // A fall of 10 mm takes 45 ms, and weight adds its little: the law alone is held to 1e-8 elsewhere.
        let mut free = Free::new(&text, 0.05);
        free.question.free.clear();
        free.question.start.clear();
        free.play(ContactStates::Three, REST);
        let found = free.run();
        let touch = found.touched[0];
        let fall = (2.0 * 9.81 * 0.01_f64).sqrt();
        assert!((touch.touching.speed / fall - 1.0).abs() < 1e-10, "{law}");
        let restitution = touch.parting.unwrap() / touch.touching.speed;
        assert!(
            (restitution - delivered).abs() < 5e-4,
            "{law}: {restitution}"
        );
    }
    // A spring without damping, of two states: half a period, and nothing lost.
    let mut free = Free::new(FALLING, 0.06);
    free.question.free.clear();
    free.question.start.clear();
    free.play(ContactStates::Two, REST);
    let touch = free.run().touched[0];
    let (m, k, g) = (2.0_f64, 1e6_f64, 9.81);
    let w = (k / m).sqrt();
    let sag = g / (w * w);
    let v = touch.touching.speed;
    // x = sag (1 - cos wt) + v/w sin wt comes back to 0.
    let lasts = 2.0 * (std::f64::consts::PI - atan2(v / w, sag)) / w;
    let found = touch.touching.to - touch.touching.from;
    assert!((found / lasts - 1.0).abs() < 1e-9, "{found} {lasts}");
    assert!((touch.parting.unwrap() / v - 1.0).abs() < 1e-10);
    let deepest = sag + (sag * sag + v * v / (w * w)).sqrt();
    assert!((touch.depth[0] / deepest - 1.0).abs() < 1e-9);
    assert!((touch.force[0] / (k * deepest) - 1.0).abs() < 1e-9);
}

#[test]
fn a_block_strikes_with_two_corners_and_comes_to_lie_on_its_guide() {
    // P. Flores, R. Leine and C. Glocker's slider: both corners of a side strike at once.
    let mut free = Free::new(SLIDER, 0.01);
    free.question.start[0][1] = 150.0;
    free.play(ContactStates::Three, REST);
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let first = found.happenings[0];
    assert!(
        (first.time - 0.002692502752).abs() < 1e-12,
        "{}",
        first.time
    );
    for (happening, corner) in found.happenings.iter().zip([0, 1]) {
        let Happened::Strikes {
            stop,
            before,
            after,
        } = happening.what
        else {
            panic!("{happening:?}");
        };
        assert_eq!(found.place_of(stop).unwrap().place, corner);
        assert!((after / before + 0.4).abs() < 1e-12, "{before} {after}");
        assert_eq!(happening.time, first.time);
    }
    let [_, rate] = at(&found, 0, first.time - 1e-14);
    assert!((rate - 109.55768154).abs() < 1e-8, "{rate}");
    // Each flight is shorter than the one before, until both corners rest.
    let rests = found
        .happenings
        .iter()
        .filter(|it| matches!(it.what, Happened::Rests { .. }));
    let rests: Vec<f64> = rests.map(|it| it.time).collect();
    assert!(
        !rests.is_empty() && rests[0] > 0.009 && rests[0] < 0.0092,
        "{rests:?}"
    );
}

/// The first impact of a contact that stays is its hardest, however long it stays.
#[test]
fn the_largest_force_of_a_contact_is_that_of_its_first_impact_however_long_it_lasts() {
    const HANGING: &str = r#"
units = { length = "mm", angle = "deg" }
gravity = [0, "-9.81 m/s^2"]
[links]
frame = { A = [0, 0] }
arm   = { A-B = 100, mass = "1 kg", inertia = "1000 kg mm^2", center = "B" }
[clearance]
A = { radial = "0.1 mm", radius = "5 mm", stiffness = 1e10, restitution = 0.1 }
[drives]
swing = { turns = "arm", at = -90 }
"#;
    let touches = [0.02, 0.2].map(|until| {
        let mut free = Free::new(HANGING, until);
        free.play(ContactStates::Three, REST);
        free.run().touched[0]
    });
    let [short, long] = touches;
    assert!(short.force[0] > 390.0, "{}", short.force[0]);
    assert!((long.force[0] / short.force[0] - 1.0).abs() < 1e-6);
    assert!((long.depth[0] / short.depth[0] - 1.0).abs() < 1e-6);
}
