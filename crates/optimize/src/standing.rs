//! Which of two designs is better: K. Deb's rules (2000).
//!
//! A design that keeps all constraints is better than one that does not; of two that keep them the one of the smaller objective, of two that
//! do not the one that violates them less. One that cannot be evaluated is worse than every one that can; of two of these the one that
//! lacks less is better, so that there is a slope towards what can be evaluated, not a cliff.

use std::cmp::Ordering;

use kempe_number::text::rounded;

use crate::problem::{Candidate, Evaluation, Scales};

/// Violations that agree to so many digits are as large.
const AS_MUCH: usize = 5;

/// How good a design is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Standing {
    /// It keeps all constraints and has this largest objective.
    Feasible(f64),
    /// So much it violates its constraints, all together, each by its scale.
    Violating(f64),
    /// It cannot be evaluated, and is so far from that.
    Lacking(f64),
}

impl Standing {
    /// Of what a design is worth; violations up to the tolerance are none.
    pub fn of(evaluation: &Evaluation, scales: &Scales, tolerance: f64) -> Self {
        if !evaluation.is_defined() {
            return Self::Lacking(evaluation.lack);
        }
        let scaled = evaluation.constraints.iter().zip(&scales.constraints);
        let violations = scaled.map(|(c, s)| c / s).filter(|v| *v > tolerance);
        let violation: f64 = violations.fold(0.0, |sum, v| sum + v);
        match violation > 0.0 {
            true => Self::Violating(violation),
            false => Self::Feasible(evaluation.largest()),
        }
    }

    /// The same where objectives over some values are too large, which is as if a constraint were violated; those that no value is given for may be anything.
    pub(crate) fn within(
        evaluation: &Evaluation,
        (scales, tolerance): (&Scales, f64),
        most: &[f64],
    ) -> Self {
        let parts = evaluation.objectives.iter().zip(most);
        let over = parts.filter(|(f, most)| f > most).map(|(f, most)| f / most);
        let over: f64 = over.fold(0.0, |sum, v| sum + v);
        match Self::of(evaluation, scales, tolerance) {
            Self::Feasible(_) if over > 0.0 => Self::Violating(over),
            Self::Violating(other) => Self::Violating(other + over),
            standing => standing,
        }
    }

    /// Its kind, the best first, and its value.
    fn key(self) -> (u8, f64) {
        match self {
            Self::Feasible(value) => (0, value),
            Self::Violating(value) => (1, value),
            Self::Lacking(value) => (2, value),
        }
    }

    /// The better one first.
    pub fn order(&self, other: &Self) -> Ordering {
        let ((a, x), (b, y)) = (self.key(), other.key());
        a.cmp(&b).then(x.total_cmp(&y))
    }

    /// By how much it is better than another of its kind; `None` if the other is of another kind.
    pub(crate) fn ahead(self, other: Self) -> Option<f64> {
        let ((a, x), (b, y)) = (self.key(), other.key());
        (a == b).then(|| (y - x).max(0.0))
    }
}

/// The better one first, for who is told of one of them: as descents lessen the largest violation and then what is left, of two designs that violate some
/// constraints the one whose worst violation is the least, then the one whose second is; where all are as large, the one of the smaller objective.
pub fn worst_first(a: &Evaluation, b: &Evaluation, scales: &Scales, tolerance: f64) -> Ordering {
    match [a, b].map(|it| Standing::of(it, scales, tolerance)) {
        [Standing::Violating(_), Standing::Violating(_)] => {
            let [x, y] = [a, b].map(|it| violations(it, scales, tolerance));
            let mut pairs = x.iter().zip(&y).map(|(x, y)| x.total_cmp(y));
            let by_worst = pairs.find(|order| order.is_ne());
            (by_worst.unwrap_or_else(|| x.len().cmp(&y.len())))
                .then_with(|| a.largest().total_cmp(&b.largest()))
        }
        [x, y] => x.order(&y),
    }
}

/// The violations of a design by their scales, the worst first.
fn violations(evaluation: &Evaluation, scales: &Scales, tolerance: f64) -> Vec<f64> {
    let scaled = evaluation.constraints.iter().zip(&scales.constraints);
    let missed = scaled.map(|(c, s)| c / s).filter(|v| *v > tolerance);
    let mut all: Vec<f64> = missed.map(|v| rounded(v, AS_MUCH)).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all
}

/// The places of candidates, the best first; of equals the first first.
pub(crate) fn ranked(candidates: &[Candidate], scales: &Scales, tolerance: f64) -> Vec<usize> {
    let standings: Vec<Standing> = (candidates.iter())
        .map(|c| Standing::of(&c.evaluation, scales, tolerance))
        .collect();
    let mut places: Vec<usize> = (0..candidates.len()).collect();
    places.sort_by(|a, b| standings[*a].order(&standings[*b]).then(a.cmp(b)));
    places
}
