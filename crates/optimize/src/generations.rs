//! What methods of populations share: they ask for a batch of designs, are told what these are worth, and so on.

use std::ops::ControlFlow;

use crate::multi_start::keeping;
use crate::problem::{Candidate, Evaluation, Problem, Scales, exactly, nearly};
use crate::progress::{Ended, Hears, Progress};
use crate::rounds::MultiStartOptions;
use crate::space::Space;
use crate::sqp::{Optimum, SqpOptions, sqp};
use crate::standing::{Standing, worst_first};
use crate::workers::Workers;

/// Of an answer, violations up to this part of their scale are none.
pub const FEASIBLE: f64 = 1e-9;
/// While a population evolves, none is: it would settle beyond the constraint.
pub(crate) const STRICTLY: f64 = 0.0;
/// Designs evaluated between two questions whether to go on.
const TOGETHER: usize = 32;
/// When a best design is polished, its scales are at least this part of what is typical in the box.
const POLISHED: f64 = 1e-6;
/// An optimum that is worse than a design by this part of the objective's scale is as good.
const AS_GOOD: f64 = 1e-10;
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
    /// The local optimum that steps led to, if asked for: from the best design, or, where that is better, from the given one.
    pub polished: Option<Optimum>,
    /// Designs evaluated, all together.
    pub evaluations: usize,
    /// Of these so many on these steps.
    pub descents: usize,
    /// Whether steps went from the given design, too.
    pub from_given: bool,
    /// Of these so many to find one that keeps all constraints, where neither the generations nor the polish did.
    pub for_constraints: usize,
    /// Why the generations ended.
    pub ended: Ended,
}

/// Runs a method and polishes what it found, and a design that is given: what leads downhill from that is not missed.
pub(crate) fn find(
    problem: &dyn Problem,
    method: &mut dyn Generations,
    (start, polish): (Option<&[f64]>, Option<&SqpOptions>),
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
    let mut polished: Option<Optimum> = None;
    let mut descents = 0;
    let mut ways = 0;
    if let (Some(options), Some(first)) = (polish, best.clone()) {
        let given = start.map(|start| Space::new(problem.bounds()).within(start));
        let given = given.filter(|given| *given != first.design);
        for from in std::iter::once(first.design).chain(given) {
            let left = options.evaluations.saturating_sub(descents);
            if ended == Ended::Stopped || left == 0 {
                break;
            }
            let options = SqpOptions {
                evaluations: left,
                ..options.clone()
            };
            let known = (best.as_ref(), &scales, evaluations);
            let optimum = descent(problem, (&from, &options), known, workers, hears);
            evaluations += optimum.evaluations;
            descents += optimum.evaluations;
            ways += 1;
            if optimum.ended == Ended::Stopped {
                ended = Ended::Stopped;
            }
            let new = candidate_of(&optimum);
            let kept = best.as_ref().is_some_and(&keeps);
            let is_optimal = polished.as_ref().is_some_and(|it| it.ended.is_optimal());
            let leads = match (keeps(&new), kept) {
                (true, true) if !is_optimal && as_good(&optimum, &best, &scales) => true,
                // The least violation by its own scales is the answer where nothing keeps all constraints.
                (false, false) if polished.is_none() && optimum.ended == Ended::Infeasible => true,
                _ => better(&new, &best),
            };
            if leads {
                best = Some(new);
            }
            if leads || polished.is_none() {
                polished = Some(optimum);
            }
        }
    }
    let mut for_constraints = 0;
    if let Some(options) = polish.filter(|_| polished.is_some())
        && ended != Ended::Stopped
        && !best.as_ref().is_some_and(&keeps)
    {
        let asked = MultiStartOptions {
            sqp: options.clone(),
            seed: KEEPING,
            ..MultiStartOptions::default()
        };
        let asked = (&asked, options.evaluations.saturating_sub(descents));
        let before = (evaluations, &scales);
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
        if let Some(optimum) = least.filter(less) {
            best = Some(candidate_of(&optimum));
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
        descents,
        from_given: ways > 1,
        for_constraints,
        ended,
    }
}

/// Steps from a design, of whose progress the best is told that is known, of so many designs.
fn descent(
    problem: &dyn Problem,
    (from, options): (&[f64], &SqpOptions),
    (best, scales, before): (Option<&Candidate>, &Scales, usize),
    workers: &dyn Workers,
    hears: Hears,
) -> Optimum {
    let options = SqpOptions {
        least: Some(scales.times(POLISHED)),
        typical: Some(scales.clone()),
        ..options.clone()
    };
    let known = best.map(|it| (it.design.as_slice(), it.evaluation.largest()));
    let missed = best.map(|it| match it.evaluation.is_defined() {
        true => it.evaluation.violation(scales),
        false => f64::INFINITY,
    });
    let missed = missed.unwrap_or(f64::INFINITY);
    sqp(problem, from, &options, workers, &mut |told| {
        // The best is told, wherever the steps are.
        let leads = |(_, value): &(&[f64], f64)| {
            let behind = known.is_some_and(|(_, known)| *value >= known) && missed <= FEASIBLE;
            told.violation <= FEASIBLE && !behind
        };
        let own = told.best.filter(leads);
        hears(&Progress {
            evaluations: before + told.evaluations,
            budget: before + told.budget,
            best: own.or(known),
            violation: if own.is_some() {
                told.violation
            } else {
                missed
            },
        })
    })
}

/// Whether what is shown to be an optimum is as good as the best but for rounding.
fn as_good(optimum: &Optimum, best: &Option<Candidate>, scales: &Scales) -> bool {
    let size = scales.objectives.iter().copied().fold(0.0, f64::max);
    optimum.ended.is_optimal()
        && best
            .as_ref()
            .is_some_and(|best| optimum.objective() <= best.evaluation.largest() + AS_GOOD * size)
}
