//! How far to go along a step: as far as the penalty falls by a part of what is promised (L. Armijo, 1966).

use crate::problem::{self, Evaluation, Problem};
use crate::quadratic::{Minimum, minimise};
use crate::space::Space;

use super::curvature::Curvature;
use super::local::{Local, Of, Part, Sizes, scaled};

/// The part of the promise that must be kept.
const KEPT: f64 = 1e-4;
/// The penalty may seem to rise by this part of it from rounding.
const NOISE: f64 = 4e-16;
/// Shorter steps are tried so many at once, each half the one before, and so often.
const AT_ONCE: usize = 4;
const ROUNDS: usize = 9;
/// A corrected step is at most so many times as long.
const CORRECTED: f64 = 2.0;

/// The problem, with what was asked of it.
pub(super) struct Search<'a> {
    pub problem: &'a mut dyn Problem,
    pub space: Space,
    pub sizes: Sizes,
    pub evaluations: usize,
    pub slopes: usize,
}

impl Search<'_> {
    /// A design with its slopes, where it has any.
    pub fn at(&mut self, design: Vec<f64>) -> Option<Local> {
        let evaluation = self.evaluate(std::slice::from_ref(&design)).swap_remove(0);
        self.with_slopes(design, evaluation)
    }

    /// The same of an evaluated one.
    fn with_slopes(&mut self, design: Vec<f64>, evaluation: Evaluation) -> Option<Local> {
        if !evaluation.is_defined() {
            return None;
        }
        self.slopes += 1;
        let slopes = problem::slopes(self.problem, &design)?;
        Some(Local::new(
            design,
            evaluation,
            &slopes,
            &self.sizes,
            &self.space,
        ))
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        self.evaluations += designs.len();
        problem::evaluate(self.problem, designs)
    }

    /// The penalty of a design; infinite where there is none.
    fn penalty(&self, evaluation: &Evaluation, weight: f64) -> f64 {
        if !evaluation.is_defined() {
            return f64::INFINITY;
        }
        let (objective, violation) = scaled(evaluation, &self.sizes);
        objective + weight * violation
    }

    /// The first place along a step that is good enough: the whole step, a corrected one, shorter ones.
    pub fn step(
        &mut self,
        place: &Local,
        minimum: &Minimum,
        curvature: &Curvature,
        weight: f64,
        promise: f64,
    ) -> Option<Local> {
        let from = place.penalty(weight);
        let noise = NOISE * from.abs().max(place.size());
        let good = |penalty: f64, part: f64| penalty <= from - KEPT * part * promise + noise;
        let whole = self.space.moved(&place.design, &minimum.step, 1.0);
        if whole == place.design {
            return None;
        }
        let evaluation = self.evaluate(std::slice::from_ref(&whole)).swap_remove(0);
        let defined = evaluation.is_defined();
        let short = good(self.penalty(&evaluation, weight), 1.0);
        let there = self.with_slopes_if(defined, whole, evaluation);
        if short && there.is_some() {
            return there;
        }
        if let Some(there) = there
            && let Some(corrected) = self.corrected(place, &there, minimum, curvature, weight)
            && good(corrected.penalty(weight), 1.0)
        {
            return Some(corrected);
        }
        let mut part = 1.0;
        for _ in 0..ROUNDS {
            let parts: Vec<f64> = (0..AT_ONCE)
                .map(|_| {
                    part /= 2.0;
                    part
                })
                .collect();
            let designs: Vec<Vec<f64>> = (parts.iter())
                .map(|part| self.space.moved(&place.design, &minimum.step, *part))
                .collect();
            let evaluations = self.evaluate(&designs);
            for ((design, evaluation), part) in designs.into_iter().zip(evaluations).zip(parts) {
                if design == place.design {
                    return None;
                }
                if good(self.penalty(&evaluation, weight), part)
                    && let Some(next) = self.with_slopes(design, evaluation)
                {
                    return Some(next);
                }
            }
        }
        None
    }

    fn with_slopes_if(
        &mut self,
        wanted: bool,
        design: Vec<f64>,
        evaluation: Evaluation,
    ) -> Option<Local> {
        wanted
            .then(|| self.with_slopes(design, evaluation))
            .flatten()
    }

    /// The step with what the whole one taught: the parts' values as they are there (R. Fletcher's second-order correction, 1982), and the
    /// parts that are only there.
    fn corrected(
        &mut self,
        place: &Local,
        there: &Local,
        minimum: &Minimum,
        curvature: &Curvature,
        weight: f64,
    ) -> Option<Local> {
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
        let top = place.top();
        let new = there.parts.iter().zip(met).filter(|(_, met)| !met);
        let new: Vec<Part> = new
            .map(|(part, _)| {
                let back: f64 = part.slope.iter().zip(step).map(|(g, d)| g * d).sum();
                Part {
                    value: part.value - back,
                    ..part.clone()
                }
            })
            .collect();
        debug_assert!(
            new.iter()
                .all(|p| matches!(p.of, Of::Objective(_) | Of::Constraint(_)))
                && top.is_finite()
        );
        let programme = place.shifted(curvature.matrix(), weight, &self.space, &shifts, &new);
        let corrected = minimise(&programme).ok()?;
        let size = |d: &[f64]| d.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if size(&corrected.step) > CORRECTED * size(step) {
            return None;
        }
        let design = self.space.moved(&place.design, &corrected.step, 1.0);
        self.at(design)
    }
}
