//! What is said of designs that were found.

mod before;
mod front;
mod infeasible;
mod one;

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, OptimizeMethod, OptimizeStudy, Severity, StudyKind};
use kempe_motion::Motion;
use kempe_motion::progress::Silent;
use kempe_optimize::{Evaluation, Optimum};
use kempe_units::Unit;

use super::designs::Designs;
use super::search::Sought;
use crate::designs::bench::{Answer, Bench};
use crate::designs::notes::{CROSSES, NEXT, noted};
use crate::designs::warned::warned;
use crate::motion::run_along;
use crate::quantity::Quantity;
use crate::result::{FoundDesign, StudyResult};
use crate::run::run_motion;
use crate::simulation::simulation;
use crate::table::{Column, Table};
use crate::unit::{Units, shown};
use crate::words::list;

/// What is said of a search that was stopped.
const STOPPED: &str = "stopped before its end: the best so far";
/// Designs that become files; a catalogue may leave more of them.
const MOST_FILES: usize = 400;
/// A limit that is missed by less, in its scale, is kept.
const KEPT: f64 = 1e-7;

/// How many designs a search tried, and of how many it took derivatives: numbers of the search, not of what it found.
pub(in crate::designs) const COUNTS: [&str; 2] = ["designs tried", "derivatives taken"];

pub(super) use before::{idle_method, outside};

pub(super) struct Teller<'b, 'm> {
    bench: &'b Bench<'m>,
    /// Numbers that are told besides: the left sides of limits, then those of the study.
    beside: &'b Bench<'m>,
    study: &'b OptimizeStudy,
    name: &'b str,
    units: Units,
}

/// A design that is told of.
struct Told {
    design: Vec<f64>,
    evaluation: Evaluation,
    /// Left sides of limits and further numbers, with the evidence of where the motion starts.
    beside: Answer,
    note: Option<String>,
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

    fn besides(&self, values: &[f64]) -> Answer {
        self.beside.answer(values).unwrap_or_else(|_| Answer {
            numbers: vec![f64::NAN; self.beside.numbers.len()],
            closure: f64::NAN,
            smallest_singular_value: f64::NAN,
            crosses: false,
        })
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

    /// The value of a goal as the file has it.
    fn goal(&self, goal: usize, evaluation: &Evaluation) -> f64 {
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

    fn goal_unit(&self, goal: usize) -> Unit {
        self.bench.numbers[goal].unit(&self.units)
    }

    /// The table, the files and all that does not hang on the method.
    fn shown(
        &self,
        own: Option<&Told>,
        all: &[Told],
        stopped: Option<usize>,
        diagnostics: Vec<Diagnostic>,
    ) -> StudyResult {
        let rows: Vec<(&Told, f64)> = own
            .map(|own| (own, 0.0))
            .into_iter()
            .chain(
                all.iter()
                    .zip(1..)
                    .map(|(told, number)| (told, f64::from(number))),
            )
            .collect();
        let mut number = Column::new("design", Unit::one());
        number.values = rows.iter().map(|(_, number)| *number).collect();
        let mut columns = vec![number];
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let unit = self.units.unit(parameter.dimension);
            let mut column = Column::new(&parameter.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(told.design[k], &unit))
                .collect();
            columns.push(column);
        }
        for (k, goal) in self.study.goals.iter().enumerate() {
            // A goal may be what is varied.
            if columns.iter().any(|known| known.name == goal.number.name) {
                continue;
            }
            let unit = self.goal_unit(k);
            let mut column = Column::new(&goal.number.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(self.goal(k, &told.evaluation), &unit))
                .collect();
            columns.push(column);
        }
        for (k, quantity) in self.beside.numbers.iter().enumerate() {
            if columns.iter().any(|known| known.name == quantity.name) {
                continue;
            }
            let unit = quantity.unit(&self.units);
            let mut column = Column::new(&quantity.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(told.beside.numbers[k], &unit))
                .collect();
            columns.push(column);
        }
        let mut designs = Vec::new();
        let mut told = diagnostics;
        let is_front = self.study.goals.len() > 1 && all.len() > 1;
        let mut warnings: Vec<Option<String>> = Vec::new();
        for (k, it) in all.iter().take(MOST_FILES).enumerate() {
            let (design, more) = self.design(k + 1, all.len(), it);
            let own = noted(&[&self.bench.over.name], &more);
            warnings.push((!own.is_empty()).then(|| own.join(NEXT)));
            // What is said of the file's own design in the same words is not said again.
            let new = |d: &Diagnostic| told.iter().all(|known| known.message != d.message);
            if k == 0 && !is_front {
                let more: Vec<Diagnostic> = more.into_iter().filter(new).collect();
                told.extend(more.into_iter().map(of_best));
            }
            designs.push(design);
        }
        if is_front {
            let notes = warnings.iter().map(Option::as_deref);
            let of = (self.name, &self.study.over);
            let notes = (notes, all.len());
            told.extend(warned(of, self.bench, notes, |k| all[k].design.clone()));
        }
        let warnings = (own.iter().map(|_| None)).chain(warnings);
        let warnings = warnings.chain(std::iter::repeat(None));
        let notes = rows.iter().zip(warnings).map(|((told, _), warnings)| {
            let notes: Vec<String> = told.note.clone().into_iter().chain(warnings).collect();
            (!notes.is_empty()).then(|| notes.join(NEXT))
        });
        // Of a design whose motion is told that of all its rows, as in a sweep; else of where it starts.
        let evidence = |of: fn(&Table) -> f64, of_start: fn(&Answer) -> f64| -> Vec<f64> {
            let tables = designs.iter().map(|it| Some(&it.motion.as_ref()?.table));
            let tables = (own.iter().map(|_| None)).chain(tables);
            let tables = tables.chain(std::iter::repeat(None));
            let both = rows.iter().zip(tables);
            both.map(|((told, _), table)| table.map_or_else(|| of_start(&told.beside), of))
                .collect()
        };
        let table = Table {
            name: self.name.to_owned(),
            columns,
            places: 1 + self.study.vary.len(),
            closure: evidence(Table::worst_closure, |it| it.closure),
            smallest_singular_value: evidence(Table::least_singular_value, |it| {
                it.smallest_singular_value
            }),
            forces: None,
            balance: None,
            notes: notes.collect(),
        };
        let demanded_rows = table.rows();
        StudyResult {
            name: self.name.to_owned(),
            table,
            beside: Vec::new(),
            scalars: Vec::new(),
            figures: Vec::new(),
            listings: Vec::new(),
            contacts: Vec::new(),
            happenings: Vec::new(),
            frames: Vec::new(),
            shapes: Vec::new(),
            designs,
            events: Vec::new(),
            along: 0,
            assemblies: (0, 0),
            diagnostics: told,
            demanded_rows,
            stopped_at: stopped.map(|tried| format!("{tried} designs")),
        }
    }

    /// What is to be told of the goals of a design, and of what its limits are of.
    fn number_warnings(&self, motion: &Arc<Motion>) -> Vec<Diagnostic> {
        let goals = self.bench.numbers.iter().take(self.study.goals.len());
        let goals = goals.filter(|_| self.study.fit.is_none());
        let all: Vec<&Quantity> = goals.chain(&self.beside.numbers).collect();
        let along = self.bench.along(motion, &all, &mut Silent);
        let over = Some(self.bench.over.name.as_str());
        along.map_or_else(|_| Vec::new(), |it| it.number_warnings(over, &all))
    }

    /// A design as a file, moved by the study that is run.
    fn design(&self, number: usize, of: usize, told: &Told) -> (FoundDesign, Vec<Diagnostic>) {
        let (model, file) = self.bench.model_with(&told.design);
        let read = Model::from_toml(&file.toml, &model.title, &mut file.tables.files());
        let model = read.map_or(model, |checked| checked.model);
        let motion = match &self.bench.over.kind {
            StudyKind::Motion(along) => {
                run_motion(&model, &self.bench.over.name, along, &mut Silent)
            }
            StudyKind::Forces(along) => {
                run_along(&model, &self.bench.over.name, along, true, &mut Silent)
            }
            StudyKind::Simulate(it) => {
                let found = simulation(&model, &self.bench.over.name, it, &[], &mut Silent);
                found.map(|(result, _)| result)
            }
            _ => Err(Vec::new()),
        };
        let (motion, mut more) = match motion {
            Ok(motion) => {
                let told = motion.diagnostics.clone();
                (Some(Box::new(motion)), told)
            }
            Err(more) => {
                let soft = more.into_iter().map(|mut d| {
                    d.severity = Severity::Warning;
                    d
                });
                (None, soft.collect())
            }
        };
        // A simulation has told of its own.
        if !matches!(self.bench.over.kind, StudyKind::Simulate(_))
            && let Ok((moves, otherwise)) = self.bench.told_motion(&told.design, &mut Silent)
        {
            more.extend(otherwise);
            let of_numbers = self.number_warnings(&moves).into_iter();
            let new = |d: &Diagnostic| more.iter().all(|known| known.message != d.message);
            let of_numbers: Vec<Diagnostic> = of_numbers.filter(new).collect();
            more.extend(of_numbers);
        }
        let digits = of.to_string().len().max(2);
        let goals = (0..self.study.goals.len()).map(|k| {
            let value = self.goal(k, &told.evaluation);
            let value = self.bench.numbers[k].text(value, &self.units);
            format!("{} = {value}", self.study.goals[k].number.name)
        });
        let name = format!("{number:0digits$}");
        let design = FoundDesign {
            title: format!("{name}: {}", goals.collect::<Vec<_>>().join(", ")),
            name,
            file,
            model,
            motion,
        };
        (design, more)
    }
}

/// What the study that is run tells of the best design; it is none of the file's.
fn of_best(mut told: Diagnostic) -> Diagnostic {
    told.message = format!("the best design: {}", told.message);
    told.labels.clear();
    told
}
