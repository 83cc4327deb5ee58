//! What methods of populations share: they ask for a batch of designs, are told what these are worth, and so on.

use crate::problem::{Evaluation, Problem, Scales, evaluate};
use crate::progress::{Ended, Hears, Progress};
use crate::sqp::{Optimum, SqpOptions, sqp};
use crate::standing::{Candidate, Standing};

/// Of an answer, violations up to this part of their scale are none.
pub const FEASIBLE: f64 = 1e-9;
/// While a population evolves, none is: it would settle beyond the constraint.
pub(crate) const STRICTLY: f64 = 0.0;
/// When a best design is polished, its scales are at least this part of what is typical in the box.
const POLISHED: f64 = 1e-6;

/// A method that works in generations. Its state is a plain struct: what was asked stays in it until it is answered, so a state that was
/// stored goes on as if nothing had happened.
pub trait Generations {
    /// The designs of the next generation; the same ones until they are answered.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// What they are worth, in their order.
    fn tell(&mut self, evaluations: Vec<Evaluation>);

    /// The best design so far.
    fn best(&self) -> Option<&Candidate>;

    /// Typical sizes, once anything was told.
    fn scales(&self) -> Option<&Scales>;

    /// Designs evaluated.
    fn evaluations(&self) -> usize;

    /// Designs evaluated at most; a generation that is begun is finished.
    fn budget(&self) -> usize;

    /// Whether nothing more is to be found this way.
    fn is_finished(&self) -> bool;
}

/// Goes on from the state that a method is in until it is finished, its budget is used or it is stopped.
pub fn generations(problem: &mut dyn Problem, method: &mut dyn Generations, hears: Hears) -> Ended {
    loop {
        if method.is_finished() {
            return Ended::Converged;
        }
        if method.evaluations() >= method.budget() {
            return Ended::Budget;
        }
        let best = method.best();
        let violation =
            best.zip(method.scales())
                .map(|(best, scales)| match best.evaluation.is_defined() {
                    true => best.evaluation.violation(scales),
                    false => f64::INFINITY,
                });
        let progress = Progress {
            evaluations: method.evaluations(),
            budget: method.budget(),
            best: best.map(|b| (b.design.as_slice(), b.evaluation.largest())),
            violation: violation.unwrap_or(f64::INFINITY),
        };
        if hears(&progress).is_break() {
            return Ended::Stopped;
        }
        let designs = method.ask();
        let evaluations = evaluate(problem, &designs);
        method.tell(evaluations);
    }
}

/// What a global method found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best design, polished where that made it better; none where nothing was evaluated.
    pub best: Option<Candidate>,
    /// How good it is.
    pub standing: Standing,
    /// The local optimum that steps from the best design led to, if asked for.
    pub polished: Option<Optimum>,
    /// Designs evaluated, all together.
    pub evaluations: usize,
    /// Why the generations ended.
    pub ended: Ended,
}

/// Runs a method and polishes what it found.
pub(crate) fn find(
    problem: &mut dyn Problem,
    method: &mut dyn Generations,
    polish: Option<&SqpOptions>,
    hears: Hears,
) -> Found {
    let ended = generations(problem, method, hears);
    let scales = problem
        .scales()
        .or_else(|| method.scales().cloned())
        .unwrap_or_default();
    let stand = |c: &Candidate| Standing::of(&c.evaluation, &scales, FEASIBLE);
    let mut best = method.best().cloned();
    let mut evaluations = method.evaluations();
    let start = best.clone().filter(|_| ended != Ended::Stopped);
    let polished = polish.zip(start).map(|(options, start)| {
        let options = SqpOptions {
            least: Some(scales.times(POLISHED)),
            ..options.clone()
        };
        sqp(problem, &start.design, &options, hears)
    });
    if let Some(optimum) = &polished {
        evaluations += optimum.evaluations;
        let better = Candidate {
            design: optimum.design.clone(),
            evaluation: optimum.evaluation.clone(),
        };
        if best
            .as_ref()
            .is_none_or(|b| stand(&better).order(&stand(b)).is_lt())
        {
            best = Some(better);
        }
    }
    Found {
        standing: best
            .as_ref()
            .map_or(Standing::Lacking(f64::INFINITY), stand),
        best,
        polished,
        evaluations,
        ended,
    }
}
