//! Rigid contacts that rub: blocks that slide, stick, strike and wedge themselves, against closed forms.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at};
use kempe_model::ContactStates;
use kempe_motion::Silent;
use kempe_number::math::{cos, sin};
use kempe_simulate::{Ending, Happened, Lack, Place, Rubs, Simulated, Unsimulated, simulate};

const G: f64 = 9.81;
const MASS: f64 = 2.0;

/// A block in a guide along the x axis, with so much play; `start` are its place along the guide, its height, and its angle, each with its rate.
struct Block {
    gravity: [f64; 2],
    length: f64,
    height: f64,
    play: f64,
    inertia: f64,
    friction: f64,
    restitution: f64,
    start: [[f64; 2]; 3],
}

impl Block {
    fn lying(friction: f64) -> Self {
        Self {
            gravity: [0.0, -G],
            length: 0.1,
            height: 0.05,
            play: 1e-3,
            inertia: 0.003,
            friction,
            restitution: 0.4,
            start: [[0.0, 0.0], [-1e-3, 0.0], [0.0, 0.0]],
        }
    }

    fn free(&self, until: f64) -> Free {
        let Self {
            gravity: [gx, gy],
            length,
            height,
            play,
            inertia,
            friction,
            restitution,
            start: [along, across, angle],
        } = self;
        let text = format!(
            r#"
            units = {{ length = "m", angle = "rad" }}
            gravity = ["{gx} m/s^2", "{gy} m/s^2"]
            [links]
            frame = {{ O = [0, 0], X = [1, 0] }}
            block = {{ C = [0, 0], mass = {MASS}, inertia = {inertia} }}
            [joints]
            guide = {{ slider = "block", at = "C", on = "O -> X" }}
            [clearance]
            guide = {{ radial = {play}, length = {length}, height = {height}, law = "rigid", restitution = {restitution}, friction = {friction} }}
            [drives]
            pos = {{ slides = "guide", at = 0 }}
            "#
        );
        let mut free = Free::new(&text, until);
        free.question.start = vec![*along];
        free.play(ContactStates::Three, [*angle, *across]);
        free
    }

    fn run(&self, until: f64) -> Simulated {
        self.free(until).run()
    }
}

fn near(is: f64, wanted: f64, by: f64, what: &str) {
    assert!((is - wanted).abs() <= by, "{what}: {is} for {wanted}");
}

#[test]
fn a_block_slides_to_rest_and_stays() {
    for (friction, fast) in [(0.3, 2.0), (0.05, -1.0), (0.9, 3.0)] {
        let mut block = Block::lying(friction);
        block.start[0][1] = fast;
        let stops = fast.abs() / (friction * G);
        let way = 0.5 * fast * stops;
        let found = block.run(1.5 * stops);
        assert_eq!(found.ending, Ending::Until);
        for k in 0..=10 {
            let t = stops * f64::from(k) / 10.0;
            let [x, v] = at(&found, 0, t);
            near(v, fast * (1.0 - t / stops), 1e-12, "speed");
            near(x, fast * t * (1.0 - 0.5 * t / stops), 1e-12, "place");
        }
        assert_eq!(at(&found, 0, 1.5 * stops)[1], 0.0);
        near(at(&found, 0, 1.5 * stops)[0], way, 1e-12, "way");
        let last = found.happenings.last().unwrap();
        assert_eq!(last.what, Happened::Sticks);
        near(last.time, stops, 1e-12, "time");
        let lost = -0.5 * MASS * fast * fast;
        let work = found.work.at(1.5 * stops, &[]);
        near(work, lost, 1e-11, "work");
    }
}

/// Below the angle of friction it stays, above it it slides down.
#[test]
fn an_incline_holds_up_to_the_angle_of_friction() {
    let slope = 0.35_f64;
    let (down, press) = (G * sin(slope), G * cos(slope));
    for part in [0.99, 1.01] {
        let friction = part * down / press;
        let mut block = Block::lying(friction);
        block.gravity = [down, -press];
        let found = block.run(0.1);
        let faster = (down - friction * press).max(0.0);
        let [x, v] = at(&found, 0, 0.1);
        near(v, 0.1 * faster, 1e-12, "speed");
        near(x, 0.005 * faster, 1e-12, "place");
        let sticks = found.happenings.iter().any(|h| h.what == Happened::Sticks);
        assert_eq!(sticks, part > 1.0);
        // Thrown up it comes back where the slope is steep enough.
        block.start[0][1] = -1.0;
        let found = block.run(1.0);
        let up = 1.0 / (down + friction * press);
        let expected = faster * (1.0 - up);
        near(
            at(&found, 0, 1.0)[1],
            expected,
            1e-11,
            "speed after it turned",
        );
    }
}

/// A corner that strikes askew: it slips through, or sticks, by the masses that it feels.
#[test]
fn a_corner_that_strikes_slips_or_sticks() {
    let (half, up, angle) = (0.05_f64, 0.025_f64, -0.01_f64);
    let mut seen = [0; 3];
    for (friction, restitution, along, turning) in [
        (0.1, 0.4, 1.0, 0.0),
        (0.1, 0.4, -1.0, 0.0),
        (0.9, 0.4, 0.1, 0.0),
        (0.5, 0.7, 0.05, 2.0),
        (0.9, 0.0, 0.1, -3.0),
        (0.3, 0.0, -2.0, 5.0),
    ] {
        let mut block = Block::lying(friction);
        (block.gravity, block.restitution) = ([0.0, 0.0], restitution);
        let fall = -0.5;
        block.start = [[0.0, along], [0.0, fall], [angle, 0.0]];
        if turning != 0.0 {
            block.start[2] = [angle - 1e-3 * turning, turning];
        }
        let found = block.run(5e-3);
        let strike = found.happenings[0];
        let Happened::Strikes { stop, .. } = strike.what else {
            panic!("{strike:?}");
        };
        assert_eq!(found.place_of(stop).unwrap().place, 3);
        let state = |time: f64| [0, 1, 2].map(|drive| at(&found, drive, time));
        let before = state(strike.time - 1e-12);
        let after = state(strike.time + 1e-12);
        // The front right corner, off the middle of mass.
        let turned = before[1][0];
        let (s, c) = (sin(turned), cos(turned));
        let (x, y) = (half * c + up * s, half * s - up * c);
        let rates = |state: [[f64; 2]; 3]| {
            let [[_, vx], [_, spin], [_, vy]] = state;
            [vy + spin * x, vx - spin * y]
        };
        let [normal, slip] = rates(before);
        let inertia = block.inertia;
        let (nn, nt, tt) = (
            1.0 / MASS + x * x / inertia,
            -x * y / inertia,
            1.0 / MASS + y * y / inertia,
        );
        let push = -(1.0 + restitution) * normal;
        // Sticking: both rates are known.
        let det = nn * tt - nt * nt;
        let stick = [
            (push * tt + slip * nt) / det,
            (-push * nt - slip * nn) / det,
        ];
        let impulse = if stick[1].abs() <= friction * stick[0] {
            seen[0] += 1;
            stick
        } else {
            let sense = stick[1].signum();
            let pressing = push / (nn + sense * friction * nt);
            let after = slip + (nt + sense * friction * tt) * pressing;
            assert!(after * sense < 0.0, "slides against its friction");
            seen[if after * slip > 0.0 { 1 } else { 2 }] += 1;
            [pressing, sense * friction * pressing]
        };
        let wanted = [
            normal + nn * impulse[0] + nt * impulse[1],
            slip + nt * impulse[0] + tt * impulse[1],
        ];
        for (is, wanted) in rates(after).into_iter().zip(wanted) {
            near(is, wanted, 1e-9, "rate after");
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}

/// By Newton's law a tall block whose foot sticks would fly off with three tenths more energy than it came with (T. R. Kane): it keeps what
/// it had, and gives back less of the speed.
#[test]
fn a_foot_that_sticks_gives_no_energy() {
    let mut block = Block::lying(0.9);
    (block.height, block.inertia, block.restitution) = (0.2, 1.2e-5, 1.0);
    block.gravity = [0.0, 0.0];
    block.start = [[0.0, -0.38], [0.0, -0.5], [-1e-3, 0.0]];
    let found = block.run(2.1e-3);
    let strike = found.happenings[0];
    let Happened::Strikes { before, after, .. } = strike.what else {
        panic!("{strike:?}");
    };
    let energy = |time: f64| {
        let [[_, vx], [_, spin], [_, vy]] = [0, 1, 2].map(|drive| at(&found, drive, time));
        0.5 * (MASS * (vx * vx + vy * vy) + block.inertia * spin * spin)
    };
    let [first, last] = [-1e-12, 1e-12].map(|by| energy(strike.time + by));
    near(last / first, 1.0, 1e-9, "energy");
    let back = -after / before;
    assert!(back > 0.1 && back < 0.9, "{back}");
}

/// Blocks thrown against both walls, seen in a mirror along the guide or across it: they do the same, whichever corners have which numbers.
#[test]
fn mirrors_change_nothing() {
    let thrown = |along: f64, across: f64| {
        let mut block = Block::lying(0.35);
        let turned = along * across;
        block.gravity = [along * 2.0, across * -7.0];
        block.start = [
            [0.0, along * 1.2],
            [0.0, across * 0.8],
            [turned * 3e-3, turned * 2.0],
        ];
        block.run(0.06)
    };
    let one = thrown(1.0, 1.0);
    assert_eq!(one.ending, Ending::Until);
    let strikes = one
        .happenings
        .iter()
        .filter(|h| matches!(h.what, Happened::Strikes { .. }));
    assert!(strikes.count() > 5, "{:?}", one.happenings);
    for (along, across) in [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let other = thrown(along, across);
        for k in 0..=60 {
            let time = 1e-3 * f64::from(k);
            let signs = [along, along * across, across];
            for (drive, sign) in signs.into_iter().enumerate() {
                let (is, known) = (at(&other, drive, time), at(&one, drive, time));
                near(sign * is[0], known[0], 1e-9, "place");
                near(sign * is[1], known[1], 1e-6, "rate");
            }
        }
    }
}

/// A tall block tips over its front edge where friction pulls at its foot, and lies down again.
#[test]
fn a_tall_block_tips_where_friction_moves_its_load_over_the_edge() {
    for (friction, tips) in [(0.19, false), (0.21, true)] {
        let mut block = Block::lying(friction);
        (block.length, block.height) = (0.02, 0.1);
        block.start[0][1] = 2.0;
        let found = block.run(0.2);
        assert_eq!(found.ending, Ending::Until);
        let [angle, _] = at(&found, 1, 0.2);
        assert_eq!(angle.abs() > 1e-3, tips, "{angle}");
    }
}

/// P. Painlevé's rod, which slides with its foot ahead: at the start, or when it has risen so far.
#[test]
fn a_rod_that_wedges_itself_is_told() {
    let rod = |angle: f64, spin: f64, along: f64| {
        let mut rod = Block::lying(2.0);
        (rod.length, rod.height, rod.play) = (0.2, 0.0, 0.09);
        rod.inertia = MASS * 0.04 / 12.0;
        let (s, c) = (sin(angle), cos(angle));
        rod.start = [
            [0.0, along],
            [0.1 * s - 0.09, 0.1 * c * spin],
            [angle, spin],
        ];
        rod
    };
    let corner = Place {
        contact: 0,
        place: 2,
    };
    // 1 + 3 cos (cos - mu sin) is below 0 at 1 rad.
    let free = rod(1.0, 0.0, -2.0).free(0.1);
    let refused = simulate(&free.design, &free.question, &mut Silent).err();
    let Some(Unsimulated::Lacks(lack)) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(lack, Lack::Wedged(corner));
    // The other way it slides.
    assert_eq!(rod(1.0, 0.0, 2.0).run(0.1).ending, Ending::Until);
    let found = rod(0.35, 4.0, -9.0).run(0.5);
    assert_eq!(found.ending, Ending::NoWay(Lack::Wedged(corner)));
    let [angle, _] = at(&found, 1, found.end);
    let left = 1.0 + 3.0 * cos(angle) * (cos(angle) - 2.0 * sin(angle));
    assert!(
        found.end > 0.05 && left.abs() < 1e-2,
        "{} {left}",
        found.end
    );
}

/// A bob whose bore turns on its pin comes to roll: what slides has lost its energy, and what rolls loses none.
#[test]
fn a_bore_comes_to_roll_on_its_pin() {
    const BOB: &str = r#"
        units = { length = "mm", angle = "rad" }
        gravity = [0, "-9.81 m/s^2"]
        [links]
        frame = { A = [0, 0] }
        bob = { A = [0, 0], mass = 2, inertia = "0.01 kg m^2" }
        [clearance]
        A = { radial = 10, radius = 50, law = "rigid", restitution = 0.5, friction = 0.3 }
        [drives]
        turn = { turns = "bob", at = 0 }
        "#;
    let mut free = Free::new(BOB, 1.0);
    free.question.start = vec![[0.0, 2.0]];
    free.play(ContactStates::Three, [[0.0, 0.0], [-0.01, 0.0]]);
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let holds = found.happenings.iter().find_map(|h| match h.what {
        Happened::Holds {
            at: Rubs::Contact(_),
        } => Some(h.time),
        _ => None,
    });
    let rolls = holds.unwrap();
    assert!(rolls > 0.01 && rolls < 0.1, "{rolls}");
    let energy = |time: f64| {
        let [[_, spin], [x, vx], [y, vy]] = [0, 1, 2].map(|drive| at(&found, drive, time));
        near(x * x + y * y, 1e-4, 1e-12, "distance");
        0.5 * MASS * (vx * vx + vy * vy) + 0.005 * spin * spin
    };
    // The bore's centre goes around the pin's by what its edge rolls on: 60 mm about 50 mm.
    for k in 0..50 {
        let time = rolls + 0.02 + 0.015 * f64::from(k);
        let [[_, spin], [x, vx], [y, vy]] = [0, 1, 2].map(|drive| at(&found, drive, time));
        let around = (x * vy - y * vx) / 1e-4;
        near(0.01 * around, 0.06 * spin, 1e-9, "rolling");
        let whole = |time: f64| {
            let height = at(&found, 2, time)[0];
            energy(time) - MASS * G * -height
        };
        near(whole(time), whole(rolls + 1e-3), 1e-9, "energy");
    }
}
