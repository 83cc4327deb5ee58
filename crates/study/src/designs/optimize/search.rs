//! Runs a method over designs.

use std::ops::ControlFlow;

use kempe_model::{OptimizeMethod, OptimizeStudy};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_optimize::{
    Ended, Evaluation, Front, MultiStartOptions, Optima, Optimum, PopulationOptions,
    Progress as Told, SqpOptions, cma_es, differential_evolution, multi_start, nsga2, refine, sqp,
};

use super::discrete::{all_of, with_choices};
use super::fit::{downhill, fitted};
use super::problem::Designs;

/// Designs that are looked at to choose starts from, for each parameter, and how many starts.
const LOOKED_AT: usize = 24;
const STARTS: usize = 6;
/// Designs of a global search for each parameter, where the file does not say.
const GLOBAL: usize = 400;
/// Designs of a front for each parameter, and points of it.
const OF_FRONT: usize = 600;
const POINTS: usize = 40;
/// Steps and designs of one descent.
const STEPS: usize = 150;
const OF_DESCENT: usize = 1000;

/// What was found.
pub(super) enum Sought {
    /// Local optima, the best first, and how they were found.
    Optima { optima: Optima, how: String },
    /// A front.
    Front { front: Front, how: String },
}

fn local() -> SqpOptions {
    SqpOptions {
        iterations: STEPS,
        evaluations: OF_DESCENT,
        ..SqpOptions::default()
    }
}

/// The best designs that a study's method finds; `None` where it was stopped before there was one.
pub(super) fn search(
    problem: &mut Designs<'_, '_>,
    study: &OptimizeStudy,
    progress: &mut dyn Progress,
) -> Option<Sought> {
    let own = problem.bench.own_values();
    let n = own.len();
    let seed = study.seed as u64;
    let mut hears = |told: &Told| {
        let done = Done::Of(told.evaluations, told.budget.max(told.evaluations));
        progress.reached(Stage::Trying, done)
    };
    if study.goals.len() > 1 {
        let options = PopulationOptions {
            evaluations: study.designs.unwrap_or(OF_FRONT * n),
            size: Some(POINTS.min(study.designs.unwrap_or(POINTS))),
            seed,
        };
        let mut front = nsga2(problem, &own, &options, &mut hears)?;
        if !front.stopped {
            refine(problem, &mut front, &local(), &mut hears);
        }
        let how = "NSGA-II; each point moved down until no step betters all goals".to_owned();
        return (!front.points.is_empty()).then_some(Sought::Front { front, how });
    }
    if let Some(optima) = all_of(problem, study) {
        let how = "all combinations of the values were tried".to_owned();
        return Some(Sought::Optima { optima, how });
    }
    let method = study.method.unwrap_or(OptimizeMethod::MultiStart);
    let (mut optima, mut how) = match method {
        OptimizeMethod::Local | OptimizeMethod::MultiStart if problem.fit.is_some() => {
            fitted(problem, study, &local(), &mut hears)
        }
        OptimizeMethod::Local => {
            let options = SqpOptions {
                evaluations: study.designs.unwrap_or(OF_DESCENT),
                ..local()
            };
            let found = sqp(problem, &own, &options, &mut hears);
            (one(found), "downhill from the file's own design".to_owned())
        }
        OptimizeMethod::MultiStart => {
            let looked_at = study.designs.map_or(LOOKED_AT * n, |all| all / 2);
            let options = MultiStartOptions {
                looked_at,
                starts: STARTS,
                seed,
                local: local(),
            };
            let found = multi_start(problem, &own, &options, &mut hears);
            let how =
                format!("downhill from the file's own design and the best of {looked_at} others");
            (found, how)
        }
        OptimizeMethod::DifferentialEvolution | OptimizeMethod::CmaEs => {
            let options = PopulationOptions {
                evaluations: study.designs.unwrap_or(GLOBAL * n),
                size: None,
                seed,
            };
            let (found, name) = match method {
                OptimizeMethod::CmaEs => (cma_es(problem, &own, &options, &mut hears), "CMA-ES"),
                _ => (
                    differential_evolution(problem, &own, &options, &mut hears),
                    "differential evolution",
                ),
            };
            let found = found?;
            let how = format!(
                "{name} over {} designs, then downhill from the best",
                found.evaluations
            );
            let from = downhill(problem, &found.design);
            let mut best = sqp(problem, &from, &local(), &mut |told| match found.stopped {
                true => ControlFlow::Break(()),
                false => hears(told),
            });
            // A descent that fails leaves what there was.
            if !best.evaluation.is_defined()
                || best.objective() > found.evaluation.largest() && found.violation <= 0.0
            {
                best.design = found.design;
                best.evaluation = found.evaluation;
                best.violation = found.violation;
            }
            (one(best), how)
        }
    };
    let defined = |it: &Optimum| it.evaluation.is_defined();
    if !optima.list.iter().any(defined) && optima.stopped {
        return None;
    }
    if let Some(repaired) = with_choices(problem, study, &optima, &local(), &mut hears) {
        optima = repaired;
        how += "; values of a catalogue by rounding to their neighbours, the rest moved again";
    }
    Some(Sought::Optima { optima, how })
}

fn one(found: Optimum) -> Optima {
    Optima {
        stopped: found.ended == Ended::Stopped,
        list: vec![found],
        reached: vec![1],
    }
}

/// A design that was only evaluated.
pub(super) fn plain(design: Vec<f64>, evaluation: Evaluation, violation: f64) -> Optimum {
    Optimum {
        design,
        evaluation,
        multipliers: Default::default(),
        residual: f64::NAN,
        violation,
        conflict: Vec::new(),
        scales: Default::default(),
        iterations: 0,
        evaluations: 0,
        slopes: 0,
        ended: Ended::Converged,
    }
}
