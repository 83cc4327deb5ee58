//! What is said where no design keeps all limits.

use kempe_model::Diagnostic;
use kempe_number::text::rounded;
use kempe_optimize::{Evaluation, Scales};

use super::super::discrete::is_rounded;
use super::{KEPT, Teller};
use crate::words::list;

/// To so many digits a violation is known: what was eased before it was by a little more.
const DIGITS: usize = 7;

impl Teller<'_, '_> {
    /// By how much the design that misses them least misses the limits, in these scales, and which of them contradict each other there, by
    /// their shares.
    pub(super) fn infeasible(
        &self,
        (least, scales): (&Evaluation, &Scales),
        conflicts: &[Vec<(usize, f64)>],
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
        let message = format!(
            "no design was found that keeps all limits of study `{}`",
            self.name
        );
        let mut told =
            Diagnostic::warning("infeasible", message).at(self.study.over.span.clone(), "");
        if !missed.is_empty() {
            let missed = list(&missed);
            told = told.note(format!("the least violation that was reached: {missed}"));
        }
        for conflict in conflicts {
            let names = conflict.iter().filter_map(|(k, _)| {
                let limit = self.study.subject_to.get(*k)?;
                Some(format!("`{}`", limit.condition.text))
            });
            let names: Vec<String> = names.collect();
            told = match names.as_slice() {
                [one] if self.study.subject_to.len() > 1 => {
                    told.note(format!("there {one} cannot be kept, whatever the others"))
                }
                [] | [_] => told,
                _ => told.note(format!("there {} contradict each other", list(&names))),
            };
        }
        if is_rounded(self.bench.model, self.study) {
            told = told.note(
                "values of a catalogue were found by rounding to their neighbours: other combinations, which were not tried, may keep all limits",
            );
        }
        told.help("ask for less of one of them, or widen the bounds")
    }
}
