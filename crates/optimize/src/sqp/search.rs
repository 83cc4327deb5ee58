//! How far to go along a step: as far as the penalty falls by a part of what is promised (L. Armijo, 1966).

use crate::problem::Evaluation;
use crate::quadratic::{Minimum, minimise};
use crate::space::Space;
use crate::workers::{Alone, Workers, each};

use super::curvature::Curvature;
use super::local::{Local, Part, Sizes, scaled};
use super::vector::dot;
use super::violation::View;

/// The part of the promise that must be kept.
const KEPT: f64 = 1e-4;
/// The penalty may seem to rise by this part of it from rounding.
const NOISE: f64 = 4e-16;
/// What is worth being without slopes is better by more than this, in the objective's size.
const BETTER: f64 = 1e-9;
/// Four shorter steps at once are tried so often.
const ROUNDS: usize = 9;
/// A corrected step is at most so many times as long.
const CORRECTED: f64 = 2.0;

/// A step, as it was asked.
#[derive(Clone, Copy)]
pub(super) struct Step<'a> {
    pub minimum: &'a Minimum,
    pub curvature: &'a Curvature,
    /// Of the violation.
    pub weight: f64,
    /// No component is larger.
    pub radius: f64,
    /// By how much the penalty is to fall.
    pub promise: f64,
}

/// Whether a part of a step brings the penalty down far enough.
pub(super) fn is_enough(place: &Local, step: Step, part: f64, penalty: f64) -> bool {
    let from = place.penalty(step.weight);
    let noise = NOISE * from.abs().max(place.size());
    penalty <= from - KEPT * part * step.promise + noise
}

/// The problem, with what was asked of it.
pub(super) struct Search<'a> {
    pub view: View<'a>,
    pub space: Space,
    pub sizes: Sizes,
    pub evaluations: usize,
    /// No edge is sought with more evaluations than these.
    pub allowed: usize,
    pub slopes: usize,
    /// Constraints that are missed by no more than this are kept.
    pub feasibility: f64,
    /// The best of those that keep the constraints and have no slopes, as where a bound is a corner of a function: steps end there.
    pub bare: Option<(Vec<f64>, Evaluation)>,
    /// Whether the last whole step led to where nothing can be evaluated.
    pub passed: bool,
}

impl Search<'_> {
    /// A design with its slopes, where it has any.
    pub fn at(&mut self, design: Vec<f64>) -> Option<Local> {
        let evaluation = self
            .evaluate(std::slice::from_ref(&design), &Alone)
            .swap_remove(0);
        self.with_slopes(design, evaluation)
    }

    /// The same of an evaluated one.
    pub fn with_slopes(&mut self, design: Vec<f64>, evaluation: Evaluation) -> Option<Local> {
        if !evaluation.is_defined() {
            return None;
        }
        self.slopes += 1;
        let Some(slopes) = self.view.slopes(&design) else {
            self.keep_bare(design, evaluation);
            return None;
        };
        Some(Local::new(
            design,
            evaluation,
            &slopes,
            &self.sizes,
            &self.space,
        ))
    }

    fn keep_bare(&mut self, design: Vec<f64>, evaluation: Evaluation) {
        let (objective, violation) = scaled(&evaluation, &self.sizes);
        let known = self.bare.as_ref();
        let better = known.is_none_or(|(_, known)| objective < scaled(known, &self.sizes).0);
        if violation <= self.feasibility && better {
            self.bare = Some((design, evaluation));
        }
    }

    /// The best without slopes, where it is better than a place by more than rounding, or that keeps no constraints.
    pub fn bare_below(&mut self, here: &Evaluation) -> Option<(Vec<f64>, Evaluation)> {
        let (objective, violation) = scaled(here, &self.sizes);
        let below = |(_, evaluation): &(Vec<f64>, Evaluation)| {
            violation > self.feasibility || scaled(evaluation, &self.sizes).0 < objective - BETTER
        };
        self.bare.take().filter(below)
    }

    pub fn evaluate(&mut self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        self.evaluations += designs.len();
        let view = &self.view;
        each(workers, designs.iter().collect(), |design: &Vec<f64>| {
            view.evaluate(design)
        })
    }

    /// The penalty of a design; infinite where there is none.
    pub fn penalty(&self, evaluation: &Evaluation, weight: f64) -> f64 {
        if !evaluation.is_defined() {
            return f64::INFINITY;
        }
        let (objective, violation) = scaled(evaluation, &self.sizes);
        objective + weight * violation
    }

    /// The place a whole step away if it is good enough, or a corrected one.
    pub fn whole(&mut self, place: &Local, step: Step) -> Option<Local> {
        let Step {
            minimum, weight, ..
        } = step;
        self.passed = false;
        let whole = self.space.moved(&place.design, &minimum.step, 1.0);
        if whole == place.design {
            return None;
        }
        let evaluation = self
            .evaluate(std::slice::from_ref(&whole), &Alone)
            .swap_remove(0);
        let enough = is_enough(place, step, 1.0, self.penalty(&evaluation, weight));
        self.passed = !evaluation.is_defined();
        let there = self.with_slopes(whole, evaluation)?;
        if enough {
            return Some(there);
        }
        let corrected = self.corrected(place, &there, step)?;
        is_enough(place, step, 1.0, corrected.penalty(weight)).then_some(corrected)
    }

    /// The first place along a step, halved again and again, that is good enough.
    pub fn shorter(&mut self, place: &Local, step: Step, workers: &dyn Workers) -> Option<Local> {
        let Step {
            minimum, weight, ..
        } = step;
        let mut part = 1.0;
        for _ in 0..ROUNDS {
            let parts = [0.5, 0.25, 0.125, 0.0625].map(|p| p * part);
            part = parts[3];
            let designs = parts.map(|part| self.space.moved(&place.design, &minimum.step, part));
            let evaluations = self.evaluate(&designs, workers);
            for ((design, evaluation), part) in designs.into_iter().zip(evaluations).zip(parts) {
                if design == place.design {
                    return None;
                }
                if is_enough(place, step, part, self.penalty(&evaluation, weight))
                    && let Some(next) = self.with_slopes(design, evaluation)
                {
                    return Some(next);
                }
            }
        }
        None
    }

    /// The best place that ways lead to, and which way, where the penalty is less there by more than rounding.
    pub fn below(
        &mut self,
        place: &Local,
        ways: &[Vec<f64>],
        weight: f64,
        workers: &dyn Workers,
    ) -> Option<(usize, Local)> {
        let moved = ways
            .iter()
            .map(|way| self.space.moved(&place.design, way, 1.0));
        let moved = moved.enumerate().filter(|(_, it)| *it != place.design);
        let (ways, designs): (Vec<usize>, Vec<Vec<f64>>) = moved.unzip();
        let evaluations = self.evaluate(&designs, workers);
        let most = place.penalty(weight) - BETTER;
        let penalties = evaluations.iter().map(|it| self.penalty(it, weight));
        let below = penalties.enumerate().filter(|(_, it)| *it < most);
        let (k, _) = below.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut both = designs.into_iter().zip(evaluations);
        let (design, evaluation) = both.nth(k)?;
        Some((ways[k], self.with_slopes(design, evaluation)?))
    }

    /// The step with what the whole one taught: the parts' values as they are there (R. Fletcher's second-order correction, 1982), and the
    /// parts that are only there.
    fn corrected(&mut self, place: &Local, there: &Local, asked: Step) -> Option<Local> {
        let Step {
            minimum,
            curvature,
            weight,
            radius,
            ..
        } = asked;
        let step = &minimum.step;
        let mut met = vec![false; there.parts.len()];
        let shifts: Vec<f64> = (place.parts.iter())
            .map(|part| match part.among(&there.parts, step) {
                Some(k) => {
                    met[k] = true;
                    there.parts[k].value - part.after(step)
                }
                None => 0.0,
            })
            .collect();
        let new = there.parts.iter().zip(met).filter(|(_, met)| !met);
        let new: Vec<Part> = new
            .map(|(part, _)| {
                let back = dot(&part.slope, step);
                Part {
                    value: part.value - back,
                    ..part.clone()
                }
            })
            .collect();
        let programme = place.shifted(
            curvature.matrix(),
            weight,
            (&self.space, radius),
            &shifts,
            &new,
        );
        let corrected = minimise(&programme).ok()?;
        let size = |d: &[f64]| d.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if size(&corrected.step) > CORRECTED * size(step) {
            return None;
        }
        let design = self.space.moved(&place.design, &corrected.step, 1.0);
        self.at(design)
    }
}
