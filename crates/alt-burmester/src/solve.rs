//! All solutions of given data, led there from generic ones.

use std::ops::ControlFlow;

use crate::class::{Class, Classes};
use crate::equations::State;
use crate::flock::Place;
use crate::follow::{Progress, follow_on};
use crate::given::{Given, Kind};
use crate::starts::StartSet;
use crate::tracker::{CARES, End};

/// The finite regular solutions of some data, and what became of the other paths.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// One solution of each class, in the order of the starts.
    pub solutions: Vec<State>,
    /// Paths that went to infinity: special data have fewer solutions.
    pub infinite: usize,
    /// Paths that ended in singular solutions, or several in one: multiple solutions, or families of them, of special data.
    pub singular: usize,
    /// Paths that could not be followed to the end.
    pub lost: usize,
}

/// So many paths that do not arrive say that the data are special: these end singularly, however they are followed. With twice the digits
/// each takes up to a fifth of a second.
const SPECIAL: usize = 240;

/// All solutions of some data. `None` where the progress stopped it; it hears of paths that have ended, of all.
///
/// Paths that did not arrive or that met others are followed again with more care, the last time with twice
/// the digits, those that came near the end from the last place they passed.
pub fn solve(start: &StartSet, target: &Given, progress: Progress) -> Option<Solved> {
    let kind = target.kind;
    if start.given.kind != kind {
        return Some(Solved {
            solutions: Vec::new(),
            infinite: 0,
            singular: 0,
            lost: start.solutions.len(),
        });
    }
    let starts: Vec<Place> = start.solutions.iter().map(Place::start).collect();
    let followed = follow_on(&start.given, target, &starts, CARES[0], progress)?;
    let (mut ends, mut last): (Vec<End>, Vec<Place>) = followed.into_iter().unzip();
    let all = ends.len();
    for care in &CARES[1..] {
        let mut again = doubtful(kind, &ends);
        if care.doubled && again.len() > SPECIAL {
            break;
        }
        if !care.doubled {
            // What stops at the end of the way is stopped by rounding, or by nothing that care helps.
            again.retain(|k| matches!(ends[*k], End::Lost | End::Arrived(_)));
        }
        if again.is_empty() {
            continue;
        }
        let from = |k: &usize| match ends[*k] {
            End::Singular | End::Infinite => last[*k],
            End::Lost | End::Arrived(_) => starts[*k],
        };
        let places: Vec<Place> = again.iter().map(from).collect();
        let quiet = |_, _| match progress(all, all) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            stop => stop,
        };
        let new = follow_on(&start.given, target, &places, *care, &quiet)?;
        for (k, new) in again.into_iter().zip(new) {
            (ends[k], last[k]) = new;
        }
    }
    let mut solved = Solved {
        solutions: Vec::new(),
        infinite: 0,
        singular: 0,
        lost: 0,
    };
    let mut known = Classes::default();
    for end in ends {
        match end {
            End::Arrived(state) => {
                let class = Class::of(kind, &state);
                if known.find(&class).is_some() {
                    solved.singular += 1;
                } else {
                    known.add(class, solved.solutions.len());
                    solved.solutions.push(*state);
                }
            }
            End::Infinite => solved.infinite += 1,
            End::Singular => solved.singular += 1,
            End::Lost => solved.lost += 1,
        }
    }
    Some(solved)
}

/// Paths that are to be followed again: all that met and those that did not arrive, those first that tell least.
fn doubtful(kind: Kind, ends: &[End]) -> Vec<usize> {
    let mut doubts = vec![0; ends.len()];
    let mut known = Classes::default();
    for (k, end) in ends.iter().enumerate() {
        match end {
            End::Arrived(state) => {
                let class = Class::of(kind, state);
                match known.find(&class) {
                    Some(other) => (doubts[k], doubts[other]) = (3, 3),
                    None => known.add(class, k),
                }
            }
            End::Lost => doubts[k] = 4,
            End::Singular => doubts[k] = 2,
            End::Infinite => doubts[k] = 1,
        }
    }
    let mut again: Vec<usize> = (0..ends.len()).filter(|k| doubts[*k] > 0).collect();
    again.sort_by_key(|k| std::cmp::Reverse(doubts[*k]));
    again
}
