//! Runs a method over designs.

use std::ops::ControlFlow;

use kempe_batch::Executor;
use kempe_model::{Diagnostic, OptimizeMethod, OptimizeStudy};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_optimize::{
    CmaEsOptions, DifferentialEvolutionOptions, Ended, FEASIBLE, Found, MultiStartOptions, Optimum,
    Progress as Told, Reached, SqpOptions, Standing, Task, Workers, cma_es, differential_evolution,
    multi_start, sqp, worst_first,
};

use super::designs::Designs;
use super::discrete::{all_of, with_choices};
use super::effort::{GLOBAL, KEPT, LOOKED_AT, STARTS, UNSEEN, further, local, of_descent};
use super::fit::{fitted, led};
use super::front::{Front, front};
use super::optima::{Optima, one, plain};
use crate::designs::kept_parts::Parts;
use crate::unit::Units;

/// Where searches begin that could not at the file's own design.
const BESIDE: &str =
    "beside the file's own design (which goes on as none beside it where its branches cross)";

/// What was found.
pub(super) enum Sought {
    /// Local optima, the best first, and how they were found.
    Optima { optima: Optima, how: String },
    /// A front.
    Front { front: Front, how: String },
}

impl Sought {
    /// Whether any design was found that has all its numbers.
    pub fn has_any(&self) -> bool {
        match self {
            Self::Optima { optima, .. } => optima.list.iter().any(|it| it.evaluation.is_defined()),
            Self::Front { front, .. } => front.points.iter().any(|it| it.evaluation.is_defined()),
        }
    }

    /// Looks at designs that a search which was stopped had not asked yet, the best first, where it knows no other: whoever stops it does not want to wait.
    pub fn look(&mut self, problem: &Designs<'_, '_>) {
        let has_any = self.has_any();
        let Self::Optima { optima, .. } = self else {
            return;
        };
        if has_any {
            return;
        }
        let waits = |it: &&mut Optimum| it.evaluation.lack == f64::INFINITY;
        let mut scales = None;
        for it in optima.list.iter_mut().filter(waits) {
            (it.evaluation, _) = problem.look(&it.design);
            if it.evaluation.is_defined() {
                it.violation = it.evaluation.violation(&it.scales);
            }
            scales.get_or_insert_with(|| it.scales.clone());
        }
        if let Some(scales) = scales {
            let order = |a: &Optimum, b: &Optimum| {
                worst_first(&a.evaluation, &b.evaluation, &scales, FEASIBLE)
            };
            optima.list.sort_by(order);
        }
    }

    /// It was stopped in the middle of a design: what had not come to its end by itself ended there.
    pub fn stop(&mut self) {
        match self {
            Self::Optima { optima, .. } => {
                optima.stopped = true;
                let unfinished = |it: &&mut Optimum| {
                    matches!(
                        it.ended,
                        Ended::Stuck | Ended::Undefined | Ended::Slopeless | Ended::Budget
                    )
                };
                let cut = optima.list.iter_mut().filter(unfinished);
                cut.for_each(|it| it.ended = Ended::Stopped);
            }
            Self::Front { front, .. } => front.stopped = true,
        }
    }
}

/// Workers that an executor is.
pub(super) struct On<'e>(pub &'e dyn Executor);

impl Workers for On<'_> {
    fn run_heard(&self, tasks: Vec<Task<'_>>, between: &mut dyn FnMut()) {
        self.0.run_heard(tasks, between);
    }
}

/// What hears how far a search is: keeps what was asked, tells the best so far, and asks whether to go on.
pub(super) struct Listener<'l> {
    pub progress: &'l mut dyn Progress,
    pub parts: &'l mut dyn Parts,
    /// Parts that are kept.
    pub kept: usize,
    /// Why a part could not be kept.
    pub failed: Option<Box<Diagnostic>>,
    /// The best that was told, and its violation.
    best: Option<(f64, f64)>,
}

impl<'l> Listener<'l> {
    pub fn new(
        problem: &Designs<'_, '_>,
        parts: &'l mut dyn Parts,
        progress: &'l mut dyn Progress,
    ) -> Self {
        Self {
            progress,
            parts,
            kept: problem.journal.parts(),
            failed: None,
            best: None,
        }
    }

    /// Hears it.
    fn hear(
        &mut self,
        problem: &Designs<'_, '_>,
        study: &OptimizeStudy,
        told: &Told,
    ) -> ControlFlow<()> {
        if let Err(failed) = problem.journal.keep(&mut self.kept, self.parts) {
            self.failed = Some(failed);
            return ControlFlow::Break(());
        }
        if let (Some((_, value)), [goal]) = (told.best, study.goals.as_slice())
            && self.best != Some((value, told.violation))
            && told.violation.is_finite()
        {
            self.best = Some((value, told.violation));
            let sign = if goal.maximize { -1.0 } else { 1.0 };
            let units = Units::of(problem.bench.model);
            let number = problem.bench.numbers[0].text(sign * value, &units);
            let kept = match (study.subject_to.is_empty(), told.violation <= KEPT) {
                (true, _) => "",
                (false, true) => ", all limits kept",
                (false, false) => ", not all limits kept",
            };
            self.progress
                .found(&format!("{} = {number}{kept}", goal.number.name));
        }
        // Of one work in several pieces: all that was tried so far.
        let asked = problem.asked().max(told.evaluations);
        let left = told.budget.saturating_sub(told.evaluations);
        let all = study.designs.unwrap_or(usize::MAX);
        let done = Done::Of(asked, all.min(asked.saturating_add(left)).max(asked));
        self.progress.reached(Stage::Searching, done)
    }
}

/// The best designs that a study's method finds; `None` where it was stopped before there was one.
pub(super) fn search(
    problem: &Designs<'_, '_>,
    study: &OptimizeStudy,
    workers: &dyn Workers,
    listener: &mut Listener<'_>,
) -> Option<Sought> {
    let (own, is_beside) = problem.begin();
    let own_design = match is_beside {
        true => BESIDE,
        false => "the file's own design",
    };
    let n = own.len();
    let seed = study.seed as u64;
    // What the file allows, all together.
    let all = study.designs.unwrap_or(usize::MAX);
    let mut hears = |told: &Told| listener.hear(problem, study, told);
    if study.goals.len() > 1 {
        let (front, mut how) = front(problem, (study, own), workers, &mut hears)?;
        if is_beside {
            how += &format!("; begun {BESIDE}");
        }
        return Some(Sought::Front { front, how });
    }
    if let Some(optima) = all_of(problem, study, workers, &mut hears) {
        let how = "all combinations of the values were tried".to_owned();
        return Some(Sought::Optima { optima, how });
    }
    let method = study.method.unwrap_or(OptimizeMethod::MultiStart);
    let (mut optima, mut how) = match method {
        OptimizeMethod::Local | OptimizeMethod::MultiStart if problem.fit.is_some() => {
            fitted(problem, (study, own, own_design), workers, &mut hears)?
        }
        OptimizeMethod::Local => {
            let options = SqpOptions {
                evaluations: study.designs.unwrap_or(of_descent(n)),
                ..local()
            };
            let found = sqp(problem, &own, &options, workers, &mut hears);
            let stopped = found.ended == Ended::Stopped;
            let how = format!("downhill from {own_design}");
            (one(found, stopped), how)
        }
        OptimizeMethod::MultiStart => {
            let looked_at = study.designs.map_or(LOOKED_AT * n, |all| all / 3);
            let options = MultiStartOptions {
                samples: Some(looked_at),
                starts: STARTS.min(looked_at),
                further: Some(further(study, n)),
                start: Some(own),
                evaluations: all,
                sqp: SqpOptions {
                    evaluations: of_descent(n),
                    ..local()
                },
                seed,
            };
            let found = multi_start(problem, &options, workers, &mut hears);
            let others = match found.starts {
                0 => (found.evaluations - found.for_constraints).saturating_sub(1),
                _ => found.samples,
            };
            let how = format!(
                "downhill from {own_design} and the best of {others} others{}{}",
                for_limits(found.for_constraints),
                led_to(&found.reached)
            );
            let (mut list, mut reached): (Vec<_>, Vec<_>) = found.optima.into_iter().unzip();
            // Where nothing leads downhill there is what was looked at.
            if !list.iter().any(|it: &Optimum| it.evaluation.is_defined()) {
                let ended = match found.ended {
                    Ended::Stopped => Ended::Stopped,
                    _ => Ended::Stuck,
                };
                let best = found.best_sample.map(|(best, standing)| Optimum {
                    ended,
                    ..plain(best.design, best.evaluation, missed_by(standing))
                });
                (list, reached) = (best.into_iter().collect(), vec![1]);
            }
            let stopped = found.ended == Ended::Stopped;
            (
                Optima {
                    list,
                    reached,
                    stopped,
                },
                how,
            )
        }
        OptimizeMethod::DifferentialEvolution | OptimizeMethod::CmaEs => {
            // A part is left for the way down.
            let evaluations = study
                .designs
                .map_or(GLOBAL * n, |all| (all * 2).div_ceil(3));
            let polish = problem.fit.is_none().then(|| SqpOptions {
                evaluations: of_descent(n).min(all.saturating_sub(evaluations)).max(1),
                ..local()
            });
            let (found, name) = match method {
                OptimizeMethod::CmaEs => {
                    let options = CmaEsOptions {
                        evaluations,
                        start: Some(own),
                        polish,
                        seed,
                        ..CmaEsOptions::default()
                    };
                    let found = cma_es(problem, &options, workers, &mut hears);
                    (found, "CMA-ES")
                }
                _ => {
                    let options = DifferentialEvolutionOptions {
                        evaluations,
                        start: Some(own),
                        polish,
                        seed,
                        ..DifferentialEvolutionOptions::default()
                    };
                    let found = differential_evolution(problem, &options, workers, &mut hears);
                    (found, "differential evolution")
                }
            };
            let how = format!(
                "{name} over {} designs, then downhill from the best{}{}",
                found.evaluations - found.descents - found.for_constraints,
                if found.from_given || problem.fit.is_some() {
                    format!(" and from {own_design}")
                } else {
                    String::new()
                },
                for_limits(found.for_constraints)
            );
            let best = best_of(found)?;
            match &problem.fit {
                None => (best, how),
                Some(_) => (led(problem, best, workers, &mut hears)?, how),
            }
        }
    };
    let defined = |it: &Optimum| it.evaluation.is_defined();
    if !optima.list.iter().any(defined) && optima.stopped {
        return None;
    }
    let left = all.saturating_sub(problem.asked());
    if let Some((repaired, chosen)) =
        with_choices(problem, study, &optima, left, workers, &mut hears)
    {
        optima = repaired;
        how += &chosen;
    }
    optima.tell_poles(problem);
    optima.in_parameters(problem);
    Some(Sought::Optima { optima, how })
}

/// What is said of designs among which one that keeps all limits was looked for besides.
fn for_limits(designs: usize) -> String {
    match designs {
        0 => String::new(),
        some => format!("; as that kept not all limits, {some} more to find one that does"),
    }
}

/// What is said of where starts led to, and of others that may lead elsewhere. Optima that are equally good, as mirror images are, count as one value.
fn led_to(reached: &Reached) -> String {
    let (starts, values) = (reached.starts(), reached.optima());
    if starts == 0 {
        return String::new();
    }
    let values = match values {
        1 => "one value".to_owned(),
        many => format!("{many} different values"),
    };
    let others = match reached.unseen() > UNSEEN {
        true => ", and further ones may lead to others: more `designs` follow more",
        false => "",
    };
    format!("; {starts} of these ways led to optima of {values}{others}")
}

/// What a population found: the optimum that its best led to, or its best where that is better.
fn best_of(found: Found) -> Option<Optima> {
    let stopped = found.ended == Ended::Stopped;
    let best = found.best?;
    let polished = found.polished.filter(|it| it.design == best.design);
    let own = polished.unwrap_or_else(|| {
        let violation = missed_by(found.standing);
        let ended = if stopped {
            Ended::Stopped
        } else {
            Ended::Stuck
        };
        Optimum {
            ended,
            ..plain(best.design, best.evaluation, violation)
        }
    });
    Some(one(own, stopped))
}

fn missed_by(standing: Standing) -> f64 {
    match standing {
        Standing::Feasible(_) => 0.0,
        Standing::Violating(by) | Standing::Lacking(by) => by,
    }
}
