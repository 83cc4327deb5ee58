//! What is told of every design that was found, whatever the method.

use kempe_model::OptimizeStudy;
use kempe_optimize::Evaluation;
use kempe_units::Unit;

use crate::designs::bench::{Answer, Bench};
use crate::unit::Units;

/// What is said of a search that was stopped.
pub(super) const STOPPED: &str = "stopped before its end: the best so far";
/// Designs that become files; a catalogue may leave more of them.
pub(super) const MOST_FILES: usize = 400;
/// A limit that is missed by less, in its scale, is kept.
pub(super) const KEPT: f64 = 1e-7;

/// How many designs a search tried, and of how many it took derivatives: numbers of the search, not of what it found.
pub(in crate::designs) const COUNTS: [&str; 2] = ["designs tried", "derivatives taken"];

/// Who says what was found of a study.
pub(in crate::designs::optimize) struct Teller<'b, 'm> {
    pub(super) bench: &'b Bench<'m>,
    /// Numbers that are told besides: the left sides of limits, then those of the study.
    pub(super) beside: &'b Bench<'m>,
    pub(super) study: &'b OptimizeStudy,
    pub(super) name: &'b str,
    pub(super) units: Units,
}

/// A design that is told of.
pub(super) struct Told {
    pub design: Vec<f64>,
    pub evaluation: Evaluation,
    /// Left sides of limits and further numbers, with the evidence of where the motion starts.
    pub beside: Answer,
    pub note: Option<String>,
}

impl<'b, 'm> Teller<'b, 'm> {
    pub fn new(
        bench: &'b Bench<'m>,
        beside: &'b Bench<'m>,
        study: &'b OptimizeStudy,
        name: &'b str,
    ) -> Self {
        Self {
            bench,
            beside,
            study,
            name,
            units: Units::of(bench.model),
        }
    }

    pub(super) fn besides(&self, values: &[f64]) -> Answer {
        self.beside.answer(values).unwrap_or_else(|_| Answer {
            numbers: vec![f64::NAN; self.beside.numbers.len()],
            closure: f64::NAN,
            smallest_singular_value: f64::NAN,
            crosses: false,
        })
    }

    /// The value of a goal as the file has it.
    pub(super) fn goal(&self, goal: usize, evaluation: &Evaluation) -> f64 {
        let sign = if self.study.goals[goal].maximize {
            -1.0
        } else {
            1.0
        };
        evaluation
            .objectives
            .get(goal)
            .map_or(f64::NAN, |x| sign * x)
    }

    pub(super) fn goal_unit(&self, goal: usize) -> Unit {
        self.bench.numbers[goal].unit(&self.units)
    }
}
