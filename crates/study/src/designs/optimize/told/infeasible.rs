//! What is said where no design keeps all limits.

use kempe_model::{Among, Diagnostic};
use kempe_number::text::rounded;
use kempe_optimize::{Evaluation, Scales};

use super::super::designs::Designs;
use super::super::discrete::{are_some_chosen, is_rounded};
use super::teller::{KEPT, Teller};
use crate::words::list;

/// To so many digits a violation is known: what was eased before it was by a little more.
const DIGITS: usize = 7;

impl Teller<'_, '_> {
    /// By how much the design that misses them least misses the limits, in these scales, and which of them contradict each other there, by
    /// their shares.
    pub(super) fn infeasible(
        &self,
        (design, least, scales): (&[f64], &Evaluation, &Scales),
        conflicts: &[Vec<(usize, f64)>],
        problem: &Designs<'_, '_>,
    ) -> Diagnostic {
        let limits = self.study.subject_to.iter().enumerate();
        let missed = limits.filter_map(|(k, limit)| {
            let by = least.constraints.get(k)?;
            let scale = scales.constraints.get(k).copied().unwrap_or(1.0);
            let by = (*by > KEPT * scale)
                .then(|| self.beside.numbers[k].text(rounded(*by, DIGITS), &self.units))?;
            Some(format!("`{}` is missed by {by}", limit.condition.text))
        });
        let missed: Vec<String> = missed.collect();
        let own = self.own_left_out(scales, problem);
        let but = if own.is_some() {
            " but the file's own"
        } else {
            ""
        };
        let message = format!(
            "no design{but} was found that keeps all limits of study `{}`",
            self.name
        );
        let mut told =
            Diagnostic::warning("infeasible", message).at(self.study.over.span.clone(), "");
        told.notes.extend(own);
        if !missed.is_empty() {
            let missed = list(&missed);
            told = told.note(format!("the least violation that was reached: {missed}"));
        }
        let there = self.there(design);
        for conflict in conflicts {
            let names = conflict.iter().filter_map(|(k, _)| {
                let limit = self.study.subject_to.get(*k)?;
                Some(format!("`{}`", limit.condition.text))
            });
            let names: Vec<String> = names.collect();
            told = match names.as_slice() {
                [one] if self.study.subject_to.len() > 1 => {
                    told.note(format!("{there} {one} cannot be kept, whatever the others"))
                }
                [] | [_] => told,
                _ => told.note(format!("{there} {} contradict each other", list(&names))),
            };
        }
        if is_rounded(self.bench.model, self.study) {
            told = told.note(
                "values of a catalogue were found by rounding to their neighbours: other combinations, which were not tried, may keep all limits",
            );
        }
        told.help("ask for less of one of them, or widen the bounds")
    }

    /// Why the file's own design is not the answer, where it keeps all limits.
    fn own_left_out(&self, scales: &Scales, problem: &Designs<'_, '_>) -> Option<String> {
        let own = self.bench.own_values();
        let ((evaluation, why), _) = problem.told(&own);
        let kept = (evaluation.constraints.iter().zip(&scales.constraints))
            .all(|(by, scale)| *by <= KEPT * scale);
        if why.is_some() || !evaluation.is_defined() || !kept {
            return None;
        }
        let mut ranges = own.iter().zip(problem.ranges());
        let why = if ranges.any(|(x, [low, high])| x < low || x > high) {
            "it lies outside of the bounds"
        } else if problem.is_alone(&own) {
            "where its branches cross it goes on as no design beside it does, and such designs are left out"
        } else {
            "it is none of those that were tried"
        };
        Some(format!("the file's own design keeps them, but {why}"))
    }

    /// Where limits contradict each other: of catalogues of which not all combinations were tried, with the values that were taken.
    fn there(&self, design: &[f64]) -> String {
        if !are_some_chosen(self.bench.model, self.study) {
            return "there".to_owned();
        }
        let both = self.study.vary.iter().zip(design);
        let taken = both.filter(|(it, _)| matches!(it.among, Among::Steps { .. } | Among::Only(_)));
        let taken = taken.map(|(chosen, x)| {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let value = self.units.text(*x, parameter.dimension);
            format!("{} = {value}", parameter.name)
        });
        format!("with {} there", list(&taken.collect::<Vec<_>>()))
    }
}
