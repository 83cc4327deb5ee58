//! What methods of populations share: they ask for a batch of designs, are told what these are worth, and so on.

use std::ops::ControlFlow;

use crate::multi_start::{MultiStartOptions, keeping};
use crate::problem::{Evaluation, Problem, Scales, exactly, nearly};
use crate::progress::{Ended, Hears, Progress};
use crate::sqp::{Optimum, SqpOptions, sqp};
use crate::standing::{Candidate, Standing, worst_first};
use crate::workers::Workers;

/// Of an answer, violations up to this part of their scale are none.
pub const FEASIBLE: f64 = 1e-9;
/// While a population evolves, none is: it would settle beyond the constraint.
pub(crate) const STRICTLY: f64 = 0.0;
/// Designs evaluated between two questions whether to go on.
const TOGETHER: usize = 32;
/// When a best design is polished, its scales are at least this part of what is typical in the box.
const POLISHED: f64 = 1e-6;
/// The seed of what looks for designs that keep all constraints, where the method found none: not one that it has itself.
const KEEPING: u64 = 0x6b65_6570;

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

    /// Designs evaluated at most; the last generation is smaller where no more are left.
    fn budget(&self) -> usize;

    /// Whether nothing more is to be found this way.
    fn is_finished(&self) -> bool;
}

/// Why generations ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// Why.
    pub ended: Ended,
    /// What was evaluated of a generation that was stopped before its end. The method was not told.
    pub untold: Vec<Candidate>,
}

/// Goes on from the state that a method is in until it is finished, its budget is used or it is stopped.
pub fn generations(
    problem: &dyn Problem,
    method: &mut dyn Generations,
    workers: &dyn Workers,
    hears: Hears,
) -> Generated {
    let over = |ended| Generated {
        ended,
        untold: Vec::new(),
    };
    loop {
        if method.is_finished() {
            return over(Ended::Converged);
        }
        if method.evaluations() >= method.budget() {
            return over(Ended::Budget);
        }
        let designs = method.ask();
        let mut evaluations = Vec::with_capacity(designs.len());
        for some in designs.chunks(TOGETHER) {
            if told(method, evaluations.len(), hears).is_break() {
                let untold = designs.into_iter().zip(evaluations);
                let untold = untold.map(|(design, evaluation)| Candidate { design, evaluation });
                return Generated {
                    ended: Ended::Stopped,
                    untold: untold.collect(),
                };
            }
            evaluations.extend(nearly(problem, some, workers));
        }
        method.tell(evaluations);
    }
}

/// How far a method is, with so many designs that it does not know yet.
fn told(method: &dyn Generations, more: usize, hears: Hears) -> ControlFlow<()> {
    let best = method.best();
    let violation =
        (best.zip(method.scales())).map(|(best, scales)| match best.evaluation.is_defined() {
            true => best.evaluation.violation(scales),
            false => f64::INFINITY,
        });
    hears(&Progress {
        evaluations: method.evaluations() + more,
        budget: method.budget(),
        best: best.map(|b| (b.design.as_slice(), b.evaluation.largest())),
        violation: violation.unwrap_or(f64::INFINITY),
    })
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
    /// Of these so many to find one that keeps all constraints, where neither the generations nor the polish did.
    pub for_constraints: usize,
    /// Why the generations ended.
    pub ended: Ended,
}

/// Runs a method and polishes what it found.
pub(crate) fn find(
    problem: &dyn Problem,
    method: &mut dyn Generations,
    polish: Option<&SqpOptions>,
    workers: &dyn Workers,
    hears: Hears,
) -> Found {
    let Generated { mut ended, untold } = generations(problem, method, workers, hears);
    let given = problem.scales().or_else(|| method.scales().cloned());
    let scales = given.unwrap_or_else(|| {
        let evaluations: Vec<Evaluation> = untold.iter().map(|c| c.evaluation.clone()).collect();
        Scales::typical(&evaluations, problem.objectives(), problem.constraints())
    });
    let stand = |c: &Candidate| Standing::of(&c.evaluation, &scales, FEASIBLE);
    let keeps = |c: &Candidate| matches!(stand(c), Standing::Feasible(_));
    let candidate_of = |it: &Optimum| Candidate {
        design: it.design.clone(),
        evaluation: it.evaluation.clone(),
    };
    let mut best = method.best().cloned();
    let mut evaluations = method.evaluations() + untold.len();
    let better = |new: &Candidate, best: &Option<Candidate>| {
        (best.as_ref()).is_none_or(|best| stand(new).order(&stand(best)).is_lt())
    };
    for new in untold {
        if better(&new, &best) {
            best = Some(new);
        }
    }
    if let Some(best) = &mut best {
        exactly(problem, best);
    }
    let start = best.clone().filter(|_| ended != Ended::Stopped);
    let mut polished = polish.zip(start).map(|(options, start)| {
        let options = SqpOptions {
            least: Some(scales.times(POLISHED)),
            ..options.clone()
        };
        let before = evaluations;
        sqp(problem, &start.design, &options, workers, &mut |told| {
            // The best is told, wherever the steps are.
            let violation = match start.evaluation.is_defined() {
                true => start.evaluation.violation(&scales),
                false => f64::INFINITY,
            };
            let own = told.best.filter(|(_, value)| {
                told.violation <= FEASIBLE && !(*value >= start.evaluation.largest())
            });
            let (best, violation) = match own {
                Some(own) => (own, told.violation),
                None => (
                    (start.design.as_slice(), start.evaluation.largest()),
                    violation,
                ),
            };
            hears(&Progress {
                evaluations: before + told.evaluations,
                budget: before + told.budget,
                best: Some(best),
                violation,
            })
        })
    });
    if let Some(optimum) = &polished {
        evaluations += optimum.evaluations;
        let new = candidate_of(optimum);
        // The least violation by its own scales is the answer where nothing keeps all constraints.
        let feasible = best.as_ref().is_some_and(&keeps);
        if better(&new, &best) || (optimum.ended == Ended::Infeasible && !feasible) {
            best = Some(new);
        }
        if optimum.ended == Ended::Stopped {
            ended = Ended::Stopped;
        }
    }
    let mut for_constraints = 0;
    if let Some((options, spent)) = polish.zip(polished.as_ref().map(|it| it.evaluations))
        && ended != Ended::Stopped
        && !best.as_ref().is_some_and(&keeps)
    {
        let asked = MultiStartOptions {
            sqp: options.clone(),
            seed: KEEPING,
            ..MultiStartOptions::default()
        };
        let asked = (&asked, options.evaluations.saturating_sub(spent));
        let before = (evaluations, Some(&scales));
        let kept = keeping(problem, asked, before, workers, hears);
        evaluations += kept.evaluations;
        for_constraints = kept.evaluations;
        if kept.ended == Ended::Stopped {
            ended = Ended::Stopped;
        }
        let order = |a: &Evaluation, b: &Evaluation| worst_first(a, b, &scales, FEASIBLE);
        let defined = kept.found.into_iter();
        let defined = defined.filter(|it| it.evaluation.is_defined());
        let least = defined.min_by(|a, b| order(&a.evaluation, &b.evaluation));
        let known = best.as_ref().map(|best| &best.evaluation);
        let less = |it: &Optimum| known.is_none_or(|best| order(&it.evaluation, best).is_lt());
        if let Some(mut optimum) = least.filter(less) {
            best = Some(candidate_of(&optimum));
            optimum.evaluations = spent;
            polished = Some(optimum);
        }
    }
    Found {
        standing: best
            .as_ref()
            .map_or(Standing::Lacking(f64::INFINITY), stand),
        best,
        polished,
        evaluations,
        for_constraints,
        ended,
    }
}
