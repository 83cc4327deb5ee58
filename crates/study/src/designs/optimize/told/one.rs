//! What is said of the best of all designs.

use kempe_model::{Among, Diagnostic};
use kempe_number::text::significant;
use kempe_optimize::{Ended, Optimum};
use kempe_units::Unit;

use super::teller::{COUNTS, KEPT, STOPPED, Teller, Told};
use crate::designs::notes::CROSSES;
use crate::designs::optimize::designs::Designs;
use crate::result::{Listing, Scalar};
use crate::unit::{shown, text_in};

/// A multiplier below this part of the objective's scale is none.
const FREE: f64 = 1e-9;
/// Multipliers that miss the conditions by more are not told.
const MISSED: f64 = 1e-3;
/// What holds a design beyond which none can be asked.
const BEYOND: &str = "the edge of the designs that can be asked";

impl Teller<'_, '_> {
    pub(super) fn scalars(
        &self,
        best: &Optimum,
        told: &Told,
        problem: &Designs<'_, '_>,
    ) -> Vec<Scalar> {
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
        tell(COUNTS[0], problem.asked() as f64, Unit::one());
        tell(COUNTS[1], problem.sloped() as f64, Unit::one());
        all
    }

    /// Whether any parameter is one of some values alone.
    fn chooses(&self) -> bool {
        let mut vary = self.study.vary.iter();
        vary.any(|it| matches!(it.among, Among::Steps { .. } | Among::Only(_)))
    }

    pub(super) fn listings(
        &self,
        own: Option<&Told>,
        told: &Told,
        best: &Optimum,
        (how, stopped): (&str, bool),
        problem: &Designs<'_, '_>,
    ) -> Vec<Listing> {
        let mut all = vec![self.before_and_after(own, told, problem)];
        // Away from an optimum multipliers say nothing, as where a goal is steep without bound towards an edge.
        let costs = match best.ended.is_optimal() && best.residual <= MISSED {
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
        let designs = match problem.asked() {
            1 => "1 design".to_owned(),
            many => format!("{many} designs"),
        };
        let tried = format!("{designs} tried, derivatives of {}", problem.sloped());
        let mut rows = vec![vec![how.to_owned()], vec![tried]];
        rows.push(vec![match best.residual.is_finite() {
            true => format!(
                "{}: first-order residual {}{}",
                best.ended.text(),
                significant(best.residual, 2),
                match best.ended.is_optimal() {
                    true if self.chooses() =>
                        "; with these choices none beside it is better, other choices and designs farther away may be",
                    true => "; no design beside it is better, those farther away may be",
                    false if best.ended == Ended::Infeasible =>
                        "; designs farther away may miss them by less",
                    false => "",
                }
            ),
            false => best.ended.text().to_owned(),
        }]);
        let beyond = best.beyond.as_deref();
        if let Some(why) = beyond.and_then(|beyond| problem.look(beyond).1) {
            rows.push(vec![format!("just beyond the best: {why}")]);
        }
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
        let text = |x: Option<f64>, unit: &Unit| match x {
            Some(x) if x.is_finite() => text_in(x, unit),
            _ => String::new(),
        };
        let mut rows = Vec::new();
        for (k, goal) in self.study.goals.iter().enumerate() {
            let unit = self.goal_unit(k);
            let word = if goal.maximize {
                "as large as can be"
            } else {
                "as small as can be"
            };
            rows.push(vec![
                goal.number.name.clone(),
                text(own.map(|own| self.goal(k, &own.evaluation)), &unit),
                text(Some(self.goal(k, &told.evaluation)), &unit),
                word.to_owned(),
            ]);
        }
        for (k, limit) in self.study.subject_to.iter().enumerate() {
            let quantity = &self.beside.numbers[k];
            let unit = quantity.unit(&self.units);
            rows.push(vec![
                quantity.name.clone(),
                text(own.map(|own| own.beside.numbers[k]), &unit),
                text(Some(told.beside.numbers[k]), &unit),
                limit.condition.text.clone(),
            ]);
        }
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let unit = self.units.unit(parameter.dimension);
            let [low, high] = problem.ranges()[k].map(|end| text(Some(end), &unit));
            rows.push(vec![
                parameter.name.clone(),
                text(own.map(|own| own.design[k]), &unit),
                text(Some(told.design[k]), &unit),
                format!("{low} to {high}"),
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
        // At an edge multipliers are known by differences.
        let free = if best.ended == Ended::Edge {
            MISSED
        } else {
            FREE
        };
        let scale = best.scales.objectives.first().copied().unwrap_or(1.0);
        let goal = &self.bench.numbers[0];
        let sign = if self.study.goals[0].maximize {
            1.0
        } else {
            -1.0
        };
        let mut rows = Vec::new();
        let mut tell = |what: String, (cost, scale): (f64, f64), unit: Unit| {
            let one = unit.to_si(1.0) - unit.to_si(0.0);
            let step = match unit.text() {
                "" => "1".to_owned(),
                text => format!("1 {text}"),
            };
            let by = match cost > free * scale {
                true => goal.text(sign * cost * one, &self.units),
                false => "nothing alone".to_owned(),
            };
            rows.push(vec![what, step, by]);
        };
        for (k, limit) in self.study.subject_to.iter().enumerate() {
            let cost = best.multipliers.cost(k);
            let own = best.scales.constraints.get(k).copied().unwrap_or(1.0);
            if cost * own > free * scale {
                tell(
                    limit.condition.text.clone(),
                    (best.eased.cost(k), scale / own),
                    self.beside.numbers[k].unit(&self.units),
                );
            }
        }
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let [low, high] = problem.ranges()[k];
            let Some(both) = best.multipliers.bounds.get(k) else {
                continue;
            };
            let eased = best.eased.bounds.get(k).copied().unwrap_or_default();
            for (side, end, word) in [(0, low, ">="), (1, high, "<=")] {
                if both[side] * (high - low) > free * scale {
                    let end = self.units.text(end, parameter.dimension);
                    tell(
                        format!("{} {word} {end}", parameter.name),
                        (eased[side], scale / (high - low)),
                        self.units.unit(parameter.dimension),
                    );
                }
            }
        }
        if best.ended == Ended::Edge {
            rows.push(vec![BEYOND.to_owned(), String::new(), String::new()]);
        }
        rows
    }

    pub(super) fn findings(
        &self,
        best: &Optimum,
        told: &Told,
        problem: &Designs<'_, '_>,
    ) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        if best.violation > KEPT {
            let least = (best.design.as_slice(), &told.evaluation, &best.scales);
            found.push(self.infeasible(least, &best.conflicts, problem));
        } else if !best.ended.is_optimal() && best.ended != Ended::Stopped {
            let mut told = Diagnostic::warning(
                "not-converged",
                format!(
                    "the best design of study `{}` is not shown to be an optimum: {}",
                    self.name,
                    best.ended.text()
                ),
            )
            .at(self.study.over.span.clone(), "");
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
}
