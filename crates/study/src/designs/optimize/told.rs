//! What is said of designs that were found.

use kempe_model::{Diagnostic, Goal, Model, OptimizeStudy, Severity, StudyKind};
use kempe_motion::progress::Silent;
use kempe_number::text::significant;
use kempe_optimize::{Ended, Evaluation, Optimum};
use kempe_units::{Dimension, Unit};

use super::front::Front;
use super::problem::Designs;
use super::search::Sought;
use crate::designs::bench::{Answer, Bench, CROSSES};
use crate::motion::run_along;
use crate::result::{Figure, FoundDesign, Listing, Scalar, StudyResult};
use crate::run::run_motion;
use crate::table::{Column, Table};
use crate::unit::{Units, shown};
use crate::words::list;

/// A multiplier below this part of the objective's scale is none.
const FREE: f64 = 1e-9;
/// What is said of a search that was stopped.
const STOPPED: &str = "stopped before its end: the best so far";
/// Designs that become files.
const MOST_FILES: usize = 40;
/// A limit that is missed by less, in its scale, is kept.
const KEPT: f64 = 1e-7;

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

/// The file's own values that lie outside of what may be chosen.
pub(super) fn outside(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    units: &Units,
) -> Vec<Diagnostic> {
    let own = problem.bench.own_values();
    let places = own.iter().zip(problem.ranges()).zip(&study.vary);
    let odd = places.filter(|((x, [low, high]), _)| *x < low || *x > high);
    odd.map(|((x, [low, high]), chosen)| {
        let parameter = &problem.bench.model.parameters[chosen.parameter.index()];
        let text = |x: f64| units.text(x, parameter.dimension);
        let message = format!(
            "`{}` is {} in the file, and is looked for from {} to {}",
            parameter.name,
            text(*x),
            text(*low),
            text(*high)
        );
        Diagnostic::warning("outside-bounds", message)
            .at(chosen.span.clone(), "the search begins on the nearer end")
            .help("widen the bounds, or change the value in the file")
    })
    .collect()
}

/// A method that is named where several goals have one of their own.
pub(super) fn idle_method(study: &OptimizeStudy) -> Option<Diagnostic> {
    let idle = study.goals.len() > 1 && study.method.is_some();
    idle.then(|| {
        Diagnostic::warning(
            "idle-key",
            "`method` means nothing where several goals make a front",
        )
        .at(study.over.span.clone(), "")
        .help("leave it out")
    })
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
        let (evaluation, why) = problem.look(&own);
        let own = Some(Told {
            beside: self.besides(&own),
            note: why.or(Some("the file's own".to_owned())),
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
                result.diagnostics.extend(self.findings(&best, &all[0]));
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
        let message = format!(
            "no design within the bounds of study `{}` has all its numbers",
            self.name
        );
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
        error.help(
            "give bounds between which the mechanism can be assembled, goes all the way, and what is asked of it has a finite value",
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
        for (k, it) in all.iter().take(MOST_FILES).enumerate() {
            let (design, more) = self.design(k + 1, all.len(), it);
            told.extend(more.into_iter().filter(|_| k == 0));
            designs.push(design);
        }
        let evidence = |of: fn(&Answer) -> f64| -> Vec<f64> {
            rows.iter().map(|(told, _)| of(&told.beside)).collect()
        };
        let table = Table {
            name: self.name.to_owned(),
            columns,
            places: 1 + self.study.vary.len(),
            closure: evidence(|it| it.closure),
            smallest_singular_value: evidence(|it| it.smallest_singular_value),
            forces: None,
            balance: None,
            notes: rows.iter().map(|(told, _)| told.note.clone()).collect(),
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
            _ => Err(Vec::new()),
        };
        let (motion, more) = match motion {
            Ok(motion) => (Some(Box::new(motion)), Vec::new()),
            Err(more) => {
                let soft = more.into_iter().map(|mut d| {
                    d.severity = Severity::Warning;
                    d
                });
                (None, soft.collect())
            }
        };
        let digits = of.to_string().len().max(2);
        let goals = (0..self.study.goals.len()).map(|k| {
            let value = self.units.text(
                self.goal(k, &told.evaluation),
                self.bench.numbers[k].dimension,
            );
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

    fn scalars(&self, best: &Optimum, told: &Told, problem: &Designs<'_, '_>) -> Vec<Scalar> {
        let mut all = Vec::new();
        let mut tell = |name: &str, value: f64, unit: Unit| {
            all.push(Scalar {
                name: name.to_owned(),
                unit,
                value,
            });
        };
        let (goal, unit) = (&self.study.goals[0].number.name, self.goal_unit(0));
        tell(goal, shown(self.goal(0, &told.evaluation), &unit), unit);
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let unit = self.units.unit(parameter.dimension);
            if parameter.name != *goal {
                tell(&parameter.name, shown(told.design[k], &unit), unit);
            }
        }
        if best.residual.is_finite() {
            tell("first-order residual", best.residual, Unit::one());
        }
        tell("largest violation", best.violation, Unit::one());
        tell("designs tried", problem.asked() as f64, Unit::one());
        tell("derivatives taken", problem.sloped() as f64, Unit::one());
        all
    }

    fn listings(
        &self,
        own: Option<&Told>,
        told: &Told,
        best: &Optimum,
        (how, stopped): (&str, bool),
        problem: &Designs<'_, '_>,
    ) -> Vec<Listing> {
        let mut all = vec![self.before_and_after(own, told, problem)];
        // Away from an optimum multipliers say nothing.
        let costs = match best.ended.is_optimal() {
            true => self.costs(best, problem),
            false => Vec::new(),
        };
        if !costs.is_empty() {
            let goal = &self.study.goals[0].number.name;
            all.push(Listing {
                title: format!("what holds {goal} where it is"),
                head: ["held by", "eased by", "changes it by"]
                    .map(str::to_owned)
                    .to_vec(),
                rows: costs,
            });
        }
        let tried = format!(
            "{} designs tried, derivatives of {}",
            problem.asked(),
            problem.sloped()
        );
        let mut rows = vec![vec![how.to_owned()], vec![tried]];
        rows.push(vec![match best.residual.is_finite() {
            true => format!(
                "{}: first-order residual {}",
                best.ended.text(),
                significant(best.residual, 2)
            ),
            false => best.ended.text().to_owned(),
        }]);
        if told.beside.crosses {
            rows.push(vec![format!(
                "the best moves {CROSSES}: what designs beside it do may be far from it"
            )]);
        }
        if stopped {
            rows.push(vec![STOPPED.to_owned()]);
        }
        all.push(Listing {
            title: "how it was found".to_owned(),
            head: Vec::new(),
            rows,
        });
        all
    }

    fn before_and_after(
        &self,
        own: Option<&Told>,
        told: &Told,
        problem: &Designs<'_, '_>,
    ) -> Listing {
        let text = |x: Option<f64>, dimension: Dimension| match x {
            Some(x) if x.is_finite() => self.units.text(x, dimension),
            _ => String::new(),
        };
        let mut rows = Vec::new();
        for (k, goal) in self.study.goals.iter().enumerate() {
            let dimension = self.bench.numbers[k].dimension;
            let word = if goal.maximize {
                "as large as can be"
            } else {
                "as small as can be"
            };
            rows.push(vec![
                goal.number.name.clone(),
                text(own.map(|own| self.goal(k, &own.evaluation)), dimension),
                text(Some(self.goal(k, &told.evaluation)), dimension),
                word.to_owned(),
            ]);
        }
        for (k, limit) in self.study.subject_to.iter().enumerate() {
            let quantity = &self.beside.numbers[k];
            rows.push(vec![
                quantity.name.clone(),
                text(own.map(|own| own.beside.numbers[k]), quantity.dimension),
                text(Some(told.beside.numbers[k]), quantity.dimension),
                limit.condition.text.clone(),
            ]);
        }
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let [low, high] = problem.ranges()[k];
            let range = format!(
                "{} to {}",
                text(Some(low), parameter.dimension),
                text(Some(high), parameter.dimension)
            );
            rows.push(vec![
                parameter.name.clone(),
                text(own.map(|own| own.design[k]), parameter.dimension),
                text(Some(told.design[k]), parameter.dimension),
                range,
            ]);
        }
        Listing {
            title: "before and after".to_owned(),
            head: ["", "in the file", "found", "wanted"]
                .map(str::to_owned)
                .to_vec(),
            rows,
        }
    }

    /// What each limit and bound that is met costs.
    fn costs(&self, best: &Optimum, problem: &Designs<'_, '_>) -> Vec<Vec<String>> {
        let scale = best.scales.objectives.first().copied().unwrap_or(1.0);
        let goal = &self.bench.numbers[0];
        let sign = if self.study.goals[0].maximize {
            1.0
        } else {
            -1.0
        };
        let mut rows = Vec::new();
        let mut tell = |what: String, cost: f64, dimension: Dimension| {
            let unit = self.units.unit(dimension);
            let one = unit.to_si(1.0) - unit.to_si(0.0);
            let step = match unit.text() {
                "" => "1".to_owned(),
                text => format!("1 {text}"),
            };
            let by = self.units.text(sign * cost * one, goal.dimension);
            rows.push(vec![what, step, by]);
        };
        for (k, limit) in self.study.subject_to.iter().enumerate() {
            let cost = best.multipliers.cost(k);
            let own = best.scales.constraints.get(k).copied().unwrap_or(1.0);
            if cost * own > FREE * scale {
                tell(
                    limit.condition.text.clone(),
                    cost,
                    limit.condition.dimension,
                );
            }
        }
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let [low, high] = problem.ranges()[k];
            let Some(both) = best.multipliers.bounds.get(k) else {
                continue;
            };
            for (cost, end, word) in [(both[0], low, ">="), (both[1], high, "<=")] {
                if cost * (high - low) > FREE * scale {
                    let end = self.units.text(end, parameter.dimension);
                    tell(
                        format!("{} {word} {end}", parameter.name),
                        cost,
                        parameter.dimension,
                    );
                }
            }
        }
        rows
    }

    fn findings(&self, best: &Optimum, told: &Told) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        let span = self.study.over.span.clone();
        if best.violation > KEPT {
            let missed = self
                .study
                .subject_to
                .iter()
                .enumerate()
                .filter_map(|(k, limit)| {
                    let by = told.evaluation.constraints.get(k)?;
                    let scale = best.scales.constraints.get(k).copied().unwrap_or(1.0);
                    let by = (*by > KEPT * scale)
                        .then(|| self.units.text(*by, limit.condition.dimension))?;
                    Some(format!("`{}` is missed by {by}", limit.condition.text))
                });
            let missed: Vec<String> = missed.collect();
            let mut told = Diagnostic::warning(
                "infeasible",
                format!(
                    "no design was found that keeps all limits of study `{}`",
                    self.name
                ),
            )
            .at(span.clone(), "")
            .note(format!(
                "the least violation that was reached: {}",
                list(&missed)
            ));
            let conflict = best.conflict.iter().filter(|(_, share)| *share > 1e-6);
            let names: Vec<String> = conflict
                .filter_map(|(k, _)| {
                    Some(format!(
                        "`{}`",
                        self.study.subject_to.get(*k)?.condition.text
                    ))
                })
                .collect();
            if names.len() > 1 {
                told = told.note(format!("there {} contradict each other", list(&names)));
            }
            found.push(told.help("ask for less of one of them, or widen the bounds"));
        } else if !best.ended.is_optimal() && best.ended != Ended::Stopped {
            let mut told = Diagnostic::warning(
                "not-converged",
                format!(
                    "the best design of study `{}` is not shown to be an optimum: {}",
                    self.name,
                    best.ended.text()
                ),
            )
            .at(span, "");
            if best.residual.is_finite() {
                told = told.note(format!(
                    "the first-order conditions are missed by {}",
                    significant(best.residual, 2)
                ));
            }
            found.push(told.help(match best.ended {
                Ended::Unbounded => "keep it away from there by `subject_to` or narrower bounds, or ask for what has one",
                _ => "give more `designs`, another `method`, or start from other values in the file",
            }));
        }
        found
    }

    fn front(
        &self,
        own: Option<Told>,
        front: &Front,
        how: &str,
        problem: &Designs<'_, '_>,
        diagnostics: Vec<Diagnostic>,
    ) -> StudyResult {
        let all: Vec<Told> = (front.points.iter())
            .filter(|p| p.evaluation.is_defined())
            .map(|p| {
                let beside = self.besides(&p.design);
                let missed = (p.violation > KEPT).then_some("not all limits are kept");
                let crosses = beside.crosses.then_some(CROSSES);
                let notes: Vec<&str> = missed.into_iter().chain(crosses).collect();
                Told {
                    design: p.design.clone(),
                    evaluation: p.evaluation.clone(),
                    beside,
                    note: (!notes.is_empty()).then(|| notes.join("; ")),
                }
            })
            .collect();
        let mut result = self.shown(
            None,
            &all,
            front.stopped.then(|| problem.asked()),
            diagnostics,
        );
        let optimal = front.points.iter().filter(|p| p.residual <= 1e-5).count();
        let mut tell = |name: &str, value: f64| {
            result.scalars.push(Scalar {
                name: name.to_owned(),
                unit: Unit::one(),
                value,
            });
        };
        tell("points", all.len() as f64);
        if front.has_conditions {
            tell("points optimal to first order", optimal as f64);
        }
        tell("designs tried", problem.asked() as f64);
        tell("derivatives taken", problem.sloped() as f64);
        if let Some(volume) = dominated(&all, own.as_ref()) {
            tell("hypervolume", volume);
        }
        let columns = &result.table.columns;
        let place = |goal: &Goal| columns.iter().position(|c| c.name == goal.number.name);
        let goals: Vec<usize> = self.study.goals.iter().filter_map(place).collect();
        let first = goals.first().copied().unwrap_or(0);
        result.along = first;
        let known = own.as_ref().filter(|own| own.evaluation.is_defined());
        let own_goals: Option<Vec<f64>> = known.map(|own| {
            let goals = 0..self.study.goals.len();
            let shown = goals.map(|k| shown(self.goal(k, &own.evaluation), &self.goal_unit(k)));
            shown.collect()
        });
        let figures = goals.iter().enumerate().skip(1);
        result.figures = figures
            .map(|(k, goal)| Figure::Front {
                x: result.table.columns[first].clone(),
                y: result.table.columns[*goal].clone(),
                own: own_goals.as_ref().map(|own| [own[0], own[k]]),
            })
            .collect();
        let ends = self.ends(own.as_ref(), &all);
        result.listings = vec![ends];
        let (asked, sloped) = (problem.asked(), problem.sloped());
        let mut rows = vec![
            how.to_owned(),
            format!("{asked} designs tried, derivatives of {sloped}"),
        ];
        if front.has_conditions {
            rows.push(format!(
                "{optimal} of {} points are optimal to first order",
                all.len()
            ));
        }
        if front.stopped {
            rows.push(STOPPED.to_owned());
        }
        result.listings.push(Listing {
            title: "how it was found".to_owned(),
            head: Vec::new(),
            rows: rows.into_iter().map(|row| vec![row]).collect(),
        });
        let missed = front.points.iter().all(|p| p.violation > KEPT);
        if missed {
            result.diagnostics.push(
                Diagnostic::warning(
                    "infeasible",
                    format!(
                        "no design was found that keeps all limits of study `{}`",
                        self.name
                    ),
                )
                .at(self.study.over.span.clone(), "")
                .help("ask for less of one of them, or widen the bounds"),
            );
        } else if front.has_conditions && optimal == 0 && !front.stopped {
            let message = format!(
                "no point of the front of study `{}` is shown to be an optimum",
                self.name
            );
            result.diagnostics.push(
                Diagnostic::warning("not-converged", message)
                    .at(self.study.over.span.clone(), "")
                    .help("give more `designs`, or start from other values in the file"),
            );
        }
        result
    }

    /// The designs at the ends of a front, one for each goal, beside the file's own.
    fn ends(&self, own: Option<&Told>, all: &[Told]) -> Listing {
        let text = |told: Option<&Told>, k: usize| {
            let value = told.map_or(f64::NAN, |told| self.goal(k, &told.evaluation));
            match value.is_finite() {
                true => self.units.text(value, self.bench.numbers[k].dimension),
                false => String::new(),
            }
        };
        let goals = 0..self.study.goals.len();
        let best = |k: usize| {
            let by = |a: &&Told, b: &&Told| {
                a.evaluation.objectives[k].total_cmp(&b.evaluation.objectives[k])
            };
            all.iter().min_by(by)
        };
        let mut head = vec![String::new(), "in the file".to_owned()];
        head.extend(
            goals
                .clone()
                .map(|k| format!("best {}", self.study.goals[k].number.name)),
        );
        let rows = goals.clone().map(|k| {
            let mut row = vec![self.study.goals[k].number.name.clone(), text(own, k)];
            row.extend(goals.clone().map(|end| text(best(end), k)));
            row
        });
        Listing {
            title: "the ends of the front".to_owned(),
            head,
            rows: rows.collect(),
        }
    }
}

/// The part of the box between the best of each goal and the worst on the front (and of the file's own design, where that is worse) that the front dominates.
fn dominated(all: &[Told], own: Option<&Told>) -> Option<f64> {
    let goals = all.first()?.evaluation.objectives.len();
    let known = own.filter(|own| own.evaluation.is_defined());
    let ends: Vec<[f64; 2]> = (0..goals)
        .map(|k| {
            let values = all
                .iter()
                .chain(known)
                .map(|told| told.evaluation.objectives[k]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            })
        })
        .collect();
    if ends.iter().any(|[low, high]| !(high > low)) {
        return None;
    }
    let unit = |told: &Told| -> Vec<f64> {
        let places = told.evaluation.objectives.iter().zip(&ends);
        places
            .map(|(x, [low, high])| (x - low) / (high - low))
            .collect()
    };
    let points: Vec<Vec<f64>> = all.iter().map(unit).collect();
    Some(kempe_optimize::hypervolume(&points, &vec![1.0; goals]))
}
