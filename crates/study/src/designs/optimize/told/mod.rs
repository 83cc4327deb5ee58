//! What is said of designs that were found.

mod before;
mod front;
mod infeasible;
mod one;
mod shown;
mod teller;

use kempe_model::{Diagnostic, OptimizeMethod};
use kempe_optimize::Optimum;

use super::designs::Designs;
use super::search::Sought;
use crate::designs::notes::CROSSES;
use crate::result::StudyResult;
use crate::words::list;
use teller::{KEPT, Told};

pub(super) use before::{idle_method, outside};
pub(in crate::designs) use teller::COUNTS;
pub(super) use teller::Teller;

impl Teller<'_, '_> {
    /// The result of a study, or why there is none.
    pub fn result(
        &self,
        problem: &Designs<'_, '_>,
        found: Sought,
        diagnostics: Vec<Diagnostic>,
    ) -> Result<StudyResult, Vec<Diagnostic>> {
        let own = self.bench.own_values();
        let ((evaluation, why), crosses) = problem.told(&own);
        let crosses = if crosses {
            format!("; {CROSSES}")
        } else {
            String::new()
        };
        let own = Some(Told {
            beside: self.besides(&own),
            note: why.or(Some(format!("the file's own{crosses}"))),
            design: own,
            evaluation,
        });
        match found {
            Sought::Optima { optima, how } => {
                let stopped = optima.stopped;
                let Some(best) = optima.list.first().filter(|it| it.evaluation.is_defined()) else {
                    return Err(vec![self.nothing(problem)]);
                };
                let best = best.clone();
                let told = optima
                    .list
                    .iter()
                    .zip(&optima.reached)
                    .filter(|(it, _)| it.evaluation.is_defined());
                let all: Vec<Told> = told.map(|(it, reached)| self.told(it, *reached)).collect();
                let mut result = self.shown(
                    own.as_ref(),
                    &all,
                    stopped.then(|| problem.asked()),
                    diagnostics,
                );
                result.scalars = self.scalars(&best, &all[0], problem);
                result.listings =
                    self.listings(own.as_ref(), &all[0], &best, (&how, stopped), problem);
                result
                    .diagnostics
                    .extend(self.findings(&best, &all[0], problem));
                Ok(result)
            }
            Sought::Front { front, how } => {
                if !front.points.iter().any(|p| p.evaluation.is_defined()) {
                    return Err(vec![self.nothing(problem)]);
                }
                Ok(self.front(own, &front, &how, problem, diagnostics))
            }
        }
    }

    /// No design can be asked at all.
    fn nothing(&self, problem: &Designs<'_, '_>) -> Diagnostic {
        let message = match self.study.method {
            Some(OptimizeMethod::Local) => format!(
                "the design that study `{}` begins with has not all its numbers",
                self.name
            ),
            _ => format!(
                "no design within the bounds of study `{}` has all its numbers",
                self.name
            ),
        };
        let mut error =
            Diagnostic::error("no-answer", message).at(self.study.over.span.clone(), "");
        if let Some(nearest) = problem.nearest() {
            let values = self.study.vary.iter().zip(&nearest.values);
            let values = values.map(|(chosen, x)| {
                let parameter = &self.bench.model.parameters[chosen.parameter.index()];
                format!(
                    "{} = {}",
                    parameter.name,
                    self.units.text(*x, parameter.dimension)
                )
            });
            let values: Vec<String> = values.collect();
            error = error.note(format!(
                "{} designs were tried; the nearest to one that has them, {}, fails: {}",
                problem.asked(),
                list(&values),
                nearest.why
            ));
        }
        if self.study.method == Some(OptimizeMethod::Local) {
            return error.help(
                "`local` goes downhill from the file's own design: let that move as asked, or take another `method`",
            );
        }
        error.help(
            "give bounds between which the mechanism can be assembled, goes all the way, and what is asked of it has a finite value, at a place on its motion",
        )
    }

    fn told(&self, it: &Optimum, reached: usize) -> Told {
        let mut notes = Vec::new();
        if reached > 1 {
            notes.push(format!("reached from {reached} starts"));
        }
        if it.violation > KEPT {
            notes.push("not all limits are kept".to_owned());
        }
        if !it.ended.is_optimal() {
            notes.push(it.ended.text().to_owned());
        }
        let beside = self.besides(&it.design);
        if beside.crosses {
            notes.push(CROSSES.to_owned());
        }
        Told {
            design: it.design.clone(),
            evaluation: it.evaluation.clone(),
            beside,
            note: (!notes.is_empty()).then(|| notes.join("; ")),
        }
    }
}
