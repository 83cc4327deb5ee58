//! The equations and their linear systems, against geometry and finite differences.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::ops::ControlFlow;

use kempe_alt_burmester::{
    CARES, Class, End, Given, Kind, PLACES, StartSet, State, UNKNOWNS, cognate, correction,
    follow_all, made_up, residuals, with_turns,
};
use kempe_linear::C;
use kempe_number::{Random, math};

fn go_on(_: usize, _: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn largest(values: &[C]) -> f64 {
    values.iter().map(|z| z.norm()).fold(0.0, math::max)
}

/// A real four-bar with its coupler at places: the data and the solution.
fn real_four_bar(kind: Kind, random: &mut Random) -> Option<(Given, State)> {
    let [a, b, x, y] = [(); 4].map(|()| random.complex());
    let (first, second, coupler) = ((x - a).norm(), (y - b).norm(), (y - x).norm());
    let mut state = [C::zero(); UNKNOWNS];
    for (k, z) in [x, a, x.conj(), a.conj(), y, b, y.conj(), b.conj()]
        .into_iter()
        .enumerate()
    {
        state[k] = z;
    }
    let mut places = Vec::new();
    for j in 0..kind.places() {
        // A place of the first link, and the coupler and the second link as a dyad.
        let joint = a + C::from_polar(
            first,
            math::atan2((x - a).im, (x - a).re) + 0.1 * (j + 1) as f64,
        );
        let to = b - joint;
        let far = to.norm();
        let cos = (far * far + coupler * coupler - second * second) / (2.0 * far * coupler);
        if !(cos.abs() < 1.0) {
            return None;
        }
        let side = C::new(cos, (1.0 - cos * cos).sqrt()).scale(coupler / far);
        let turn = to * side * (y - x).recip();
        let place = joint - turn * x;
        places.push((place, turn));
        if j < kind.points() {
            (state[8 + 2 * j], state[9 + 2 * j]) = (turn - C::one(), turn.conj() - C::one());
        }
    }
    let points: Vec<C> = places[..kind.points()].iter().map(|p| p.0).collect();
    let poses: Vec<(C, f64)> = (places[kind.points()..].iter())
        .map(|(place, turn)| (*place, turn.arg()))
        .collect();
    Some((Given::real(kind, &points, &poses)?, state))
}

#[test]
fn a_four_bar_at_its_places_solves_them() {
    let mut random = Random(3);
    for kind in Kind::ALL {
        let mut tried = 0;
        while tried < 20 {
            let Some((given, state)) = real_four_bar(kind, &mut random) else {
                continue;
            };
            tried += 1;
            assert!(largest(&residuals(&given, &state)) < 1e-12);
            let pivots = std::array::from_fn(|k| state[k]);
            let again = with_turns(&given, &pivots);
            assert!((0..UNKNOWNS).all(|k| (again[k] - state[k]).norm() < 1e-6));
        }
    }
}

#[test]
fn made_up_data_have_their_solution() {
    let mut random = Random(4);
    for kind in Kind::ALL {
        for _ in 0..20 {
            let Some((given, state)) = made_up(kind, &mut random) else {
                continue;
            };
            let size = 1.0 + largest(&given.place) * largest(&given.hat);
            assert!(largest(&residuals(&given, &state)) < 1e-11 * size);
        }
    }
}

#[test]
fn a_small_part_of_a_correction_takes_that_part_of_the_residuals() {
    let mut random = Random(5);
    let part = 1e-6;
    for kind in Kind::ALL {
        for _ in 0..20 {
            let given = Given::random(kind, &mut random);
            let mut state = [C::zero(); UNKNOWNS];
            for z in &mut state[..kind.unknowns()] {
                *z = random.complex();
            }
            let step = correction(&given, &state).unwrap();
            let before = residuals(&given, &state);
            let mut moved = state;
            for k in 0..UNKNOWNS {
                moved[k] -= step[k].scale(part);
            }
            let after = residuals(&given, &moved);
            let size = 1.0 + largest(&step);
            for k in 0..3 * PLACES {
                let off = (after[k] - before[k].scale(1.0 - part)).norm();
                assert!(off < 100.0 * part * part * size * size * size, "{off:e}");
            }
        }
    }
}

#[test]
fn cognates_are_solutions_of_one_class() {
    let mut random = Random(6);
    let (given, state) = made_up(Kind::NinePoints, &mut random).unwrap();
    let mut form = state;
    for _ in 0..3 {
        let next = cognate(&given, &form);
        assert!(largest(&residuals(&given, &next)) < 1e-9 * (1.0 + largest(&next)));
        let class = Class::of(Kind::NinePoints, &next);
        assert!(class.is(&Class::of(Kind::NinePoints, &form)));
        form = next;
    }
    assert!((0..UNKNOWNS).all(|k| (form[k] - state[k]).norm() < 1e-9 * (1.0 + state[k].norm())));
}

#[test]
fn ends_depend_on_nothing_but_their_start() {
    let start = StartSet::found(Kind::ThreePoses).unwrap();
    let to = Given::random(Kind::ThreePoses, &mut Random(7));
    let all = follow_all(&start.given, &to, &start.solutions, CARES[0], &go_on).unwrap();
    assert_eq!(all.len(), start.solutions.len());
    for k in [0, 7, 100, 200] {
        let alone = &start.solutions[k..=k];
        let end = follow_all(&start.given, &to, alone, CARES[0], &go_on).unwrap();
        assert_eq!(end[0], all[k]);
    }
    // Twice the digits lead to the same solution.
    let doubled = follow_all(&start.given, &to, &start.solutions[..2], CARES[2], &go_on).unwrap();
    for (one, other) in doubled.iter().zip(&all) {
        let (End::Arrived(one), End::Arrived(other)) = (one, other) else {
            panic!("lost");
        };
        assert!((0..UNKNOWNS).all(|k| (one[k] - other[k]).norm() < 1e-9 * (1.0 + one[k].norm())));
    }
}

#[test]
fn start_sets_are_read_as_they_were_written() {
    for kind in [Kind::FourPoses, Kind::ThreePoses] {
        let set = StartSet::found(kind).unwrap();
        let bytes = set.to_bytes();
        let read = StartSet::from_bytes(&bytes).unwrap();
        assert_eq!(read.given, set.given);
        assert_eq!(read.solutions.len(), kind.classes());
        for (one, other) in read.solutions.iter().zip(&set.solutions) {
            assert!(
                (0..UNKNOWNS).all(|k| (one[k] - other[k]).norm() < 1e-8 * (1.0 + one[k].norm()))
            );
        }
        assert!(StartSet::from_bytes(&bytes[..bytes.len() - 1]).is_none());
        assert!(StartSet::from_bytes(&bytes[..bytes.len() - 16]).is_none());
    }
    assert!(StartSet::from_bytes(&[]).is_none());
}
