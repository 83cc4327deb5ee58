//! A block with play in its guide, whose corners touch by laws, against its equations written by hand and followed by Runge and
//! Kutta's classical method.
#![allow(clippy::unwrap_used)]

use crate::common::{Free, at};
use kempe_contact::{Dissipation, factor};
use kempe_model::ContactStates;
use kempe_number::math::sin_cos;
use kempe_simulate::Ending;

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.003;
/// The centre of mass ahead of the block's middle.
const AHEAD: f64 = 0.02;
const GRAVITY: f64 = 9.81;
const LENGTH: f64 = 0.1;
const HEIGHT: f64 = 0.05;
const PLAY: f64 = 1e-3;
const SPRING: f64 = 2e5;
const DAMPING: f64 = 30.0;
const STIFFNESS: f64 = 1e8;
const FRICTION: f64 = 0.2;

/// How its corners resist.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    /// Spring and damper.
    Spring,
    /// Hertz's law, with this factor of what dissipates.
    Hertz(f64),
}

/// A guide along the x axis, or one that rises by 30 degrees, across gravity as before, with a block that is turned in its own axes: the
/// same seen along the guide.
fn text(law: &str, rises: bool) -> String {
    let (to, gravity, center, angle) = match rises {
        false => ("1, 0", "0, \"-9.81 m/s^2\"", "0.02, 0", ""),
        true => (
            "0.8660254037844387, 0.49999999999999994",
            "\"4.904999999999999 m/s^2\", \"-8.495709211125344 m/s^2\"",
            "0.012855752193730788, -0.015320888862379561",
            ", angle = \"50 deg\"",
        ),
    };
    format!(
        r#"
        units = {{ length = "m", angle = "rad" }}
        gravity = [{gravity}]
        [links]
        frame = {{ O = [0, 0], X = [{to}] }}
        block = {{ C = [0, 0], mass = 2, inertia = 0.003, center = [{center}] }}
        [joints]
        guide = {{ slider = "block", at = "C", on = "O -> X"{angle} }}
        [clearance]
        guide = {{ radial = "1 mm", length = "100 mm", height = "50 mm", spring = "2e5 N/m", damping = "30 N s/m", stiffness = 1e8, {law}, friction = 0.2 }}
        [drives]
        pos = {{ slides = "guide", at = 0.1 }}
        "#
    )
}

/// Height and angle of the block, and their rates.
type State = [f64; 4];

/// The block by hand: corners with what they do, and the speed with which each began to touch.
struct Block {
    law: Law,
    began: [Option<f64>; 4],
}

impl Block {
    /// Of each corner: its side, gap, approach, place off the block's middle, sliding speed.
    fn corners([height, angle, rise, turning]: State) -> [[f64; 6]; 4] {
        let (s, c) = sin_cos(angle);
        [(1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0)].map(|(side, end)| {
            let (ahead, up) = (end * LENGTH / 2.0, side * HEIGHT / 2.0);
            let (x, y) = (ahead * c - up * s, ahead * s + up * c);
            let gap = HEIGHT / 2.0 + PLAY - side * (height + y);
            [side, gap, side * (rise + turning * x), x, y, -turning * y]
        })
    }

    /// Notes with which speed contacts began.
    fn watch(&mut self, state: State) {
        for (began, [_, gap, approach, ..]) in self.began.iter_mut().zip(Self::corners(state)) {
            match gap < 0.0 {
                true => _ = began.get_or_insert(approach),
                false => *began = None,
            }
        }
    }

    fn rates(&self, state: State) -> State {
        let [_, angle, rise, turning] = state;
        let (s, c) = sin_cos(angle);
        let (own, coupled, all) = (MASS, MASS * AHEAD * c, INERTIA + MASS * AHEAD * AHEAD);
        let mut force = MASS * (AHEAD * s * turning * turning - GRAVITY);
        let mut moment = -MASS * GRAVITY * AHEAD * c;
        for ([side, gap, approach, x, y, slip], began) in
            Self::corners(state).into_iter().zip(self.began)
        {
            let deep = -gap;
            if deep <= 0.0 {
                continue;
            }
            let pressing = match self.law {
                Law::Spring => SPRING * deep + DAMPING * approach,
                Law::Hertz(chi) => {
                    let began = began.unwrap_or(approach);
                    STIFFNESS * deep * deep.sqrt() * (1.0 + chi * approach / began)
                }
            };
            let pressing = pressing.max(0.0);
            let part = ((slip.abs() - 1e-3) / 9e-3).clamp(0.0, 1.0).copysign(slip);
            let (along, across) = (-part * FRICTION * pressing, -side * pressing);
            force += across;
            moment += x * across - y * along;
        }
        let det = own * all - coupled * coupled;
        let up = (all * force - coupled * moment) / det;
        let turn = (own * moment - coupled * force) / det;
        [rise, turning, up, turn]
    }

    /// From rest in the middle: the states at these times.
    fn follow(law: Law, times: &[f64], step: f64) -> Vec<State> {
        let mut it = Self {
            law,
            began: [None; 4],
        };
        let (mut state, mut done) = ([0.0; 4], 0_u32);
        let on = |state: State, rates: State, step: f64| -> State {
            std::array::from_fn(|k| state[k] + step * rates[k])
        };
        let mut reach = |time: f64| {
            let until = (time / step).round() as u32;
            while done < until {
                it.watch(state);
                let one = it.rates(state);
                let two = it.rates(on(state, one, step / 2.0));
                let three = it.rates(on(state, two, step / 2.0));
                let four = it.rates(on(state, three, step));
                let mean = std::array::from_fn(|k| {
                    (one[k] + 2.0 * two[k] + 2.0 * three[k] + four[k]) / 6.0
                });
                state = on(state, mean, step);
                done += 1;
            }
            state
        };
        times.iter().map(|time| reach(*time)).collect()
    }
}

/// The largest difference to the equations by hand, in parts of the play and of a speed of 0.1 m/s at the corners.
fn off(law: Law, words: &str, rises: bool, states: ContactStates, times: &[f64]) -> f64 {
    let mut free = Free::new(&text(words, rises), *times.last().unwrap());
    free.question.free.clear();
    free.question.start.clear();
    free.play(states, [[0.0; 2]; 2]);
    let found = free.run();
    assert_eq!(found.ending, Ending::Until);
    let known = Block::follow(law, times, 1e-7);
    let sizes = [PLAY, PLAY / LENGTH, 0.1, 0.1 / LENGTH];
    times
        .iter()
        .zip(known)
        .fold(0.0, |most: f64, (time, known)| {
            let ([angle, turning], [height, rise]) = (at(&found, 1, *time), at(&found, 2, *time));
            let own = [height, angle, rise, turning];
            println!("{law:?} {rises} {time} {own:?} {known:?}");
            (0..4).fold(most, |most, k| {
                most.max((own[k] - known[k]).abs() / sizes[k])
            })
        })
}

/// Steps of the classical method know only to a step when corners touch and part: that counts where forces jump there, or go on with
/// the speed that they began with.
const AT_TOUCH: f64 = 1e-5;
const SMOOTH: f64 = 1e-8;

const TIMES: [f64; 5] = [0.02, 0.03, 0.04, 0.05, 0.06];

#[test]
fn corners_press_as_springs_with_dampers() {
    for rises in [false, true] {
        let off = off(
            Law::Spring,
            "law = \"hertz\"",
            rises,
            ContactStates::Two,
            &TIMES,
        );
        assert!(off < AT_TOUCH, "{rises}: {off:e}");
    }
}

#[test]
fn corners_press_by_the_law_of_hertz() {
    for rises in [false, true] {
        let off = off(
            Law::Hertz(0.0),
            "law = \"hertz\"",
            rises,
            ContactStates::Three,
            &TIMES,
        );
        assert!(off < SMOOTH, "{rises}: {off:e}");
    }
}

#[test]
fn corners_lose_by_how_fast_each_began_to_touch() {
    let words = "law = \"exact\", restitution = 0.5";
    let chi = factor(Dissipation::Exact, 0.5).unwrap();
    for rises in [false, true] {
        let off = off(
            Law::Hertz(chi),
            words,
            rises,
            ContactStates::Three,
            &TIMES[..2],
        );
        assert!(off < AT_TOUCH, "{rises}: {off:e}");
    }
}
