//! Rounds of samples of the box and of ways down from the best of them.
//!
//! A first round starts from the best samples that are not near to each other. Each further one adds samples and starts where it was not begun yet, first from
//! those that are less than all their neighbours, until what was reached says that hardly anything is left to find (`reached.rs`).

use crate::halton::halton;
use crate::problem::{self, Candidate, Problem, Scales, exactly, nearly};
use crate::progress::{Ended, Hears, Progress};
use crate::reached::{NEAR, Reached, distinct};
use crate::space::Space;
use crate::sqp::{Going, Optimum, SqpOptions, side_by_side};
use crate::standing::{Standing, ranked};
use crate::topography::Topography;
use crate::workers::Workers;

/// Samples for each variable, if nothing else is asked.
const SAMPLES: usize = 100;
/// Samples evaluated at once.
const BATCH: usize = 32;
/// Of what is left this part at most looks for further starts.
const PART: usize = 3;
/// Starts are at least this part of the box apart at first; half of it, and so on, where there are not enough.
const APART: f64 = 0.25;

/// Limits.
#[derive(Clone, Debug, PartialEq)]
pub struct MultiStartOptions {
    /// Designs that are evaluated to find starts; `None`: a hundred for each variable.
    pub samples: Option<usize>,
    /// From how many of them steps start.
    pub starts: usize,
    /// Whether as many are evaluated and followed again, and how long; `None`: once.
    pub further: Option<Further>,
    /// A design from which steps start besides, wherever it is.
    pub start: Option<Vec<f64>>,
    /// Designs evaluated at most, all together; what is begun then is finished.
    pub evaluations: usize,
    /// Of each start.
    pub sqp: SqpOptions,
    /// What all chance comes from.
    pub seed: u64,
}

/// Rounds of samples and starts go on as long as there may be optima that none led to.
#[derive(Clone, Debug, PartialEq)]
pub struct Further {
    /// They are over where no more than this part of all starts is [expected](Reached::unseen) to lead elsewhere.
    pub unseen: f64,
    /// No round begins where so many designs were evaluated.
    pub evaluations: usize,
}

impl Default for MultiStartOptions {
    fn default() -> Self {
        Self {
            samples: None,
            starts: 12,
            further: None,
            start: None,
            evaluations: usize::MAX,
            sqp: SqpOptions::default(),
            seed: 1,
        }
    }
}

/// What is known before.
#[derive(Default)]
pub(crate) struct Begun {
    /// Designs that were evaluated.
    pub evaluations: usize,
    /// The scales.
    pub scales: Option<Scales>,
    /// The first samples of the seed.
    pub samples: Vec<Candidate>,
    /// A design that is a start, too.
    pub start: Option<Vec<f64>>,
}

/// Starts that were followed.
pub(crate) struct Followed {
    /// Where each led to.
    pub found: Vec<Optimum>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// [`Ended::Stopped`] or [`Ended::Converged`].
    pub ended: Ended,
    pub best_sample: Option<(Candidate, Standing)>,
    pub scales: Scales,
    pub starts: usize,
    pub samples: usize,
    pub reached: Reached,
}

impl Followed {
    /// The best of the optima that are not next to each other and keep all constraints, so many at most.
    pub fn optima(self, tolerance: f64, most: usize, space: &Space) -> Vec<Optimum> {
        let keeps = |it: &Optimum| it.violation <= tolerance && it.evaluation.is_defined();
        let found = self.found.into_iter().filter(keeps);
        let mut optima: Vec<Optimum> = Vec::new();
        for (optimum, _) in distinct(found, (&self.scales, tolerance), space) {
            let is_next = |other: &Optimum| space.distance(&other.design, &optimum.design) <= NEAR;
            if optima.len() < most && !optima.iter().any(is_next) {
                optima.push(optimum);
            }
        }
        optima
    }
}

/// Samples of the box, and where steps from the best of them lead to, in as many rounds as it takes.
pub(crate) fn followed(
    problem: &dyn Problem,
    options: &MultiStartOptions,
    begun: Begun,
    workers: &dyn Workers,
    hears: Hears,
) -> Followed {
    let space = Space::new(problem.bounds());
    let mut rounds = Rounds {
        has_scales: begun.scales.is_some(),
        before: begun.evaluations,
        candidates: begun.samples,
        given: (options.start.iter().chain(&begun.start))
            .map(|start| space.within(start))
            .collect(),
        space,
        taken: Vec::new(),
        problem,
        options,
        workers,
        hears,
        all: Followed {
            found: Vec::new(),
            evaluations: 0,
            ended: Ended::Converged,
            best_sample: None,
            scales: begun.scales.unwrap_or_default(),
            starts: 0,
            samples: 0,
            reached: Reached::default(),
        },
    };
    while rounds.round() && rounds.goes_on() {}
    rounds.all
}

struct Rounds<'r> {
    problem: &'r dyn Problem,
    options: &'r MultiStartOptions,
    workers: &'r dyn Workers,
    hears: Hears<'r>,
    space: Space,
    /// Designs that were evaluated before.
    before: usize,
    /// Whether scales were known before.
    has_scales: bool,
    candidates: Vec<Candidate>,
    /// Designs that are starts, wherever they are.
    given: Vec<Vec<f64>>,
    /// Designs from which a way went or at which one ended.
    taken: Vec<Vec<f64>>,
    all: Followed,
}

impl Rounds<'_> {
    /// Whether it is expected that further starts lead elsewhere, and there are designs for them.
    fn goes_on(&self) -> bool {
        let all = &self.all;
        let keeps = |it: &Optimum| it.violation <= self.options.sqp.feasibility;
        let goes_on = |further: &Further| {
            all.reached.unseen() > further.unseen
                && all.evaluations < further.evaluations.min(self.options.evaluations)
        };
        all.ended != Ended::Stopped
            && all.found.iter().any(keeps)
            && self.options.further.as_ref().is_some_and(goes_on)
    }

    /// One round; whether there was a start for it.
    fn round(&mut self) -> bool {
        let options = self.options;
        let is_first = self.all.starts == 0;
        let samples = match options.starts {
            0 => 0,
            starts => {
                let usual = SAMPLES * self.space.bounds.len();
                options.samples.unwrap_or(usual).max(starts)
            }
        };
        let given = std::mem::take(&mut self.given);
        let ways = options.starts + given.len();
        let budget = self.all.evaluations + samples + ways * options.sqp.evaluations;
        let budget = budget.min(options.evaluations);
        let left = options.evaluations.saturating_sub(self.all.evaluations);
        self.sample(
            match is_first {
                true => samples.saturating_sub(self.candidates.len()),
                false => samples.min(left / PART),
            },
            budget,
        );
        if is_first && !self.has_scales {
            self.all.scales = scales_of(self.problem, &self.candidates);
        }
        let order = ranked(&self.candidates, &self.all.scales, options.sqp.feasibility);
        self.all.best_sample = order.first().map(|k| {
            let mut best = self.candidates[*k].clone();
            exactly(self.problem, &mut best);
            let scales = &self.all.scales;
            let standing = Standing::of(&best.evaluation, scales, options.sqp.feasibility);
            (best, standing)
        });
        if self.all.ended == Ended::Stopped {
            return false;
        }
        let chosen = match is_first {
            true => choose(&self.candidates, &order, options.starts, &self.space),
            false => self.others(&order),
        };
        let chosen = chosen.into_iter();
        let chosen = chosen.map(|k| self.candidates[k].design.clone());
        let starts: Vec<Vec<f64>> = given.into_iter().chain(chosen).collect();
        let any = !starts.is_empty();
        self.follow(starts, budget);
        any
    }

    /// So many more designs from all over the box with what they are worth, nearly.
    fn sample(&mut self, more: usize, budget: usize) {
        let known = self.candidates.len();
        let designs = halton(self.options.seed, known + more, self.space.bounds.len());
        for batch in designs[known..].chunks(BATCH) {
            let batch: Vec<Vec<f64>> = batch.iter().map(|u| self.space.design(u)).collect();
            let evaluations = nearly(self.problem, &batch, self.workers);
            self.all.evaluations += batch.len();
            let both = batch.into_iter().zip(evaluations);
            let both = both.map(|(design, evaluation)| Candidate { design, evaluation });
            self.candidates.extend(both);
            let progress = Progress {
                evaluations: self.before + self.all.evaluations,
                budget: self.before + budget,
                best: None,
                violation: f64::INFINITY,
            };
            if (self.hears)(&progress).is_break() {
                self.all.ended = Ended::Stopped;
                break;
            }
        }
        self.all.samples = self.candidates.len();
    }

    /// Starts besides those that were followed and what they led to: first samples that are less than all their neighbours, then the best of all others.
    fn others(&self, order: &[usize]) -> Vec<usize> {
        let designs = self.candidates.iter().map(|it| it.design.as_slice());
        let designs: Vec<&[f64]> = designs.collect();
        let least = Topography::of(&designs, &self.space).least(order);
        let rest = order.iter().filter(|k| !least.contains(k));
        let order: Vec<usize> = least.iter().chain(rest).copied().collect();
        let about = (self.options.starts, &self.taken[..]);
        choose_besides(&self.candidates, &order, about, &self.space)
    }

    /// Follows starts to where they lead.
    fn follow(&mut self, starts: Vec<Vec<f64>>, budget: usize) {
        self.all.starts += starts.len();
        self.taken.extend(starts.iter().cloned());
        let problem = self.problem;
        let starts = starts.into_iter().map(|start| (problem, start)).collect();
        let left = (self.options.evaluations).saturating_sub(self.all.evaluations);
        let mut any = self.candidates.iter().map(|it| it.evaluation.is_defined());
        let defined = self.has_scales || any.any(|it| it);
        let sqp = SqpOptions {
            typical: defined.then(|| self.all.scales.clone()),
            ..self.options.sqp.clone()
        };
        let tolerance = sqp.feasibility;
        let spent = self.before + self.all.evaluations;
        let (hears, ended) = (&mut self.hears, &mut self.all.ended);
        let found = side_by_side(starts, (&sqp, left), self.workers, &mut |going| {
            let places = going.iter().filter_map(Going::at);
            // The best is told, of all that go.
            let best = places.min_by(|a, b| {
                (a.2 > tolerance).cmp(&(b.2 > tolerance)).then(
                    match a.2 > tolerance && b.2 > tolerance {
                        true => a.2.total_cmp(&b.2),
                        false => a.1.total_cmp(&b.1),
                    },
                )
            });
            let told = hears(&Progress {
                evaluations: spent + going.iter().map(Going::evaluations).sum::<usize>(),
                budget: self.before + budget,
                best: best.map(|(design, value, _)| (design, value)),
                violation: best.map_or(f64::INFINITY, |(_, _, violation)| violation),
            });
            if told.is_break() {
                *ended = Ended::Stopped;
            }
            told
        });
        self.all.evaluations += found.iter().map(|it| it.evaluations).sum::<usize>();
        self.taken.extend(found.iter().map(|it| it.design.clone()));
        let optima = found.iter();
        let optima = optima.filter(|it| it.ended.is_optimal() && it.violation <= tolerance);
        let scale = self.all.scales.objectives.iter().copied();
        let scale = scale.fold(0.0, f64::max);
        self.all.reached.take(optima.map(Optimum::objective), scale);
        self.all.found.extend(found);
    }
}

/// The problem's scales, or what is typical of the samples.
pub(crate) fn scales_of(problem: &dyn Problem, candidates: &[Candidate]) -> Scales {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    problem::scales(problem).unwrap_or_else(|| {
        let evaluations: Vec<_> = candidates.iter().map(|c| c.evaluation.clone()).collect();
        Scales::typical(&evaluations, objectives, constraints)
    })
}

/// The best samples that are not near to each other and can be evaluated.
pub(crate) fn choose(
    candidates: &[Candidate],
    order: &[usize],
    wanted: usize,
    space: &Space,
) -> Vec<usize> {
    choose_besides(candidates, order, (wanted, &[]), space)
}

/// The same, not near to these designs either.
fn choose_besides(
    candidates: &[Candidate],
    order: &[usize],
    (wanted, besides): (usize, &[Vec<f64>]),
    space: &Space,
) -> Vec<usize> {
    let usable = order.iter().copied();
    let usable = usable.filter(|k| candidates[*k].evaluation.is_defined());
    let usable: Vec<usize> = usable.collect();
    let mut chosen: Vec<usize> = Vec::new();
    let mut apart = APART;
    while chosen.len() < wanted.min(usable.len()) && apart > NEAR {
        for one in &usable {
            let own = &candidates[*one].design;
            let is_away = |other: &Vec<f64>| space.distance(own, other) > apart;
            let mut others = chosen.iter().map(|other| &candidates[*other].design);
            let far = others.all(is_away) && besides.iter().all(is_away);
            if far && chosen.len() < wanted {
                chosen.push(*one);
            }
        }
        apart /= 2.0;
    }
    chosen
}
