//! What is said of a front.

use kempe_model::{Diagnostic, Goal};
use kempe_number::text::rounded;
use kempe_optimize::{EndsFrom, FIRST_ORDER};
use kempe_units::Unit;

use super::teller::{COUNTS, KEPT, MOST_FILES, STOPPED, Teller, Told};
use crate::designs::notes::CROSSES;
use crate::designs::optimize::designs::Designs;
use crate::designs::optimize::front::{Front, FrontPoint, Sought, WITHIN};
use crate::result::{Figure, Listing, Scalar, StudyResult};
use crate::unit::shown;

/// What is noted of a point that does not keep the conditions.
const OPEN: &str = "not shown to be optimal";
/// What is said where too few designs were allowed to look farther.
const FROM_OWN: &str = "its ends were sought from its own points alone: with more `designs` they are sought from all over the bounds, too";
const FROM_KNOWN: &str = "its ends were sought from few designs elsewhere, and pieces of it may be missing: with more `designs` they are sought from the best of many";
const FROM_SOME: &str = "its ends were sought from starts all over the bounds, and these went on leading elsewhere: with more `designs` more of them are followed";
const NEXT_TO: &str = "combinations of the values of catalogues that are far from those of the front may be better: none was sought by itself";
/// A gap between two points of a front is told where it is more than this part of the range of a goal.
const WIDE: f64 = 0.2;
/// Of what a front is cut off at.
const DIGITS: usize = 3;

impl Teller<'_, '_> {
    pub(super) fn front(
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
                let optimal = is_optimal(p) || missed.is_some() || !front.has_conditions;
                let open = (!optimal).then_some(OPEN);
                let notes: Vec<&str> = missed.into_iter().chain(crosses).chain(open).collect();
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
        let optimal = front.points.iter().filter(|p| is_optimal(p)).count();
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
        tell(COUNTS[0], problem.asked() as f64);
        tell(COUNTS[1], problem.sloped() as f64);
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
                "{optimal} of {} points are optimal to first order: no design beside them is better in all goals, those farther away may be",
                all.len()
            ));
        }
        let from = match front.sought {
            Sought::Ends(EndsFrom::Own) => Some(FROM_OWN),
            Sought::Ends(EndsFrom::Known) => Some(FROM_KNOWN),
            Sought::Ends(EndsFrom::SomeSamples) => Some(FROM_SOME),
            Sought::NextTo => Some(NEXT_TO),
            Sought::Ends(EndsFrom::Samples) | Sought::All => None,
        };
        if !front.stopped {
            let gap = front.has_conditions.then(|| self.widest_gap(&all));
            rows.extend(gap.flatten());
            rows.extend(from.map(str::to_owned));
        }
        if all.len() > MOST_FILES {
            rows.push(format!("the first {MOST_FILES} points become files"));
        }
        if front.stopped {
            rows.push(STOPPED.to_owned());
        }
        result.listings.push(Listing {
            title: "how it was found".to_owned(),
            head: Vec::new(),
            rows: rows.into_iter().map(|row| vec![row]).collect(),
        });
        if !front.cut.is_empty() {
            result.diagnostics.push(self.cut(&front.cut));
        }
        if let (Some(missed), Some(nearest)) = (&front.missed, front.points.first()) {
            let design = nearest.design.as_slice();
            let least = (design, &nearest.evaluation, &missed.scales);
            let told = self.infeasible(least, &missed.conflicts, problem);
            result.diagnostics.push(told);
        } else if !front.endless.is_empty() {
            result.diagnostics.push(self.endless(&front.endless));
        } else if !front.hidden.is_empty() {
            result.diagnostics.push(self.hidden(&front.hidden));
        } else if front.short && !front.stopped {
            result.diagnostics.push(self.short(problem.asked()));
        } else if front.has_conditions && 2 * optimal < all.len() && !front.stopped {
            let points = match optimal {
                0 => "no point".to_owned(),
                some => format!("only {some} of {} points", all.len()),
            };
            let are = if optimal < 2 { "is" } else { "are" };
            let message = format!(
                "{points} of the front of study `{}` {are} shown to be optimal",
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

    /// Of goals that have no bound, the first of which leads a front to a pole.
    fn endless(&self, goals: &[usize]) -> Diagnostic {
        let names = self.names_of(goals);
        let message = format!(
            "the front of study `{}` has no end: {} {} no bound beside a pole",
            self.name,
            names,
            if goals.len() > 1 { "have" } else { "has" }
        );
        Diagnostic::warning("not-converged", message)
            .at(self.study.over.span.clone(), "")
            .note("points that a designer would choose among are lost beside what is so large")
            .help("keep designs away from there by `subject_to`, which may limit the goal itself, or by narrower bounds")
    }

    /// Of goals that were not let grow beyond what is usual.
    fn cut(&self, goals: &[(usize, f64)]) -> Diagnostic {
        let names: Vec<usize> = goals.iter().map(|(goal, _)| *goal).collect();
        let most = goals.iter().map(|(goal, most)| {
            let most = rounded(*most, DIGITS);
            let text = self.bench.numbers[*goal].text(most, &self.units);
            format!(
                "more than {text} of `{}`",
                self.study.goals[*goal].number.name
            )
        });
        let most: Vec<String> = most.collect();
        let message = format!(
            "the front of study `{}` is cut off beside a pole of {}",
            self.name,
            self.names_of(&names)
        );
        let note = format!(
            "what needs {}, {WITHIN} times what is usual between the bounds, is left out",
            most.join(" or ")
        );
        Diagnostic::warning("front-cut", message)
            .at(self.study.over.span.clone(), "")
            .note(note)
            .help("say in `subject_to` how large it may be; points are then spread up to there")
    }

    /// Of goals in which the file's own design is better than all points.
    fn hidden(&self, goals: &[usize]) -> Diagnostic {
        let message = format!(
            "the front of study `{}` does not come to its end: the file's own design is better in {} than all of its points",
            self.name,
            self.names_of(goals)
        );
        Diagnostic::warning("not-converged", message)
            .at(self.study.over.span.clone(), "")
            .note("beside what is as large as at a pole, what a designer would choose among is lost")
            .help("keep designs away from there by `subject_to`, which may limit a goal itself, or by narrower bounds")
    }

    /// Of designs that do not do.
    fn short(&self, asked: usize) -> Diagnostic {
        let message = format!(
            "the front of study `{}` is not whole, or lies in pieces: {asked} designs were too few to reach its ends and fill its gaps",
            self.name
        );
        Diagnostic::warning("not-converged", message)
            .at(self.study.over.span.clone(), "")
            .note("between its points or beyond its ends others may be missing")
            .help("give more `designs`")
    }

    /// Between which points of a front of two goals much of the range of one lies.
    fn widest_gap(&self, all: &[Told]) -> Option<String> {
        if self.study.goals.len() != 2 {
            return None;
        }
        let value = |told: &Told, goal: usize| told.evaluation.objectives[goal];
        let (first, last) = (all.first()?, all.last()?);
        let gaps = (0..2).flat_map(|goal| {
            let range = (value(last, goal) - value(first, goal)).abs();
            let pairs = all.windows(2).enumerate();
            pairs.map(move |(k, pair)| {
                let part = (value(&pair[1], goal) - value(&pair[0], goal)).abs() / range;
                (part, k, goal)
            })
        });
        let (part, k, goal) = gaps.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (part > WIDE && part.is_finite()).then(|| {
            let name = &self.study.goals[goal].number.name;
            let [from, to] = [&all[k], &all[k + 1]].map(|told| {
                let value = self.goal(goal, &told.evaluation);
                self.bench.numbers[goal].text(value, &self.units)
            });
            format!(
                "between points {} and {} lie {:.0} % of the range of `{name}`, {from} to {to}: no point was found there",
                k + 1,
                k + 2,
                100.0 * part,
            )
        })
    }

    fn names_of(&self, goals: &[usize]) -> String {
        let names = goals.iter().map(|k| &self.study.goals[*k].number.name);
        let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        names.join(" and ")
    }

    /// The designs at the ends of a front, one for each goal, beside the file's own.
    fn ends(&self, own: Option<&Told>, all: &[Told]) -> Listing {
        let text = |told: Option<&Told>, k: usize| {
            let value = told.map_or(f64::NAN, |told| self.goal(k, &told.evaluation));
            match value.is_finite() {
                true => self.bench.numbers[k].text(value, &self.units),
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
        head.extend(goals.clone().map(|k| {
            let name = &self.study.goals[k].number.name;
            let note = best(k).and_then(|it| it.note.as_deref()).unwrap_or("");
            match note.contains(OPEN) {
                true => format!("best {name} ({OPEN})"),
                false => format!("best {name}"),
            }
        }));
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

/// Whether the conditions of first order hold at a point.
fn is_optimal(point: &FrontPoint) -> bool {
    point.residual <= FIRST_ORDER
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
