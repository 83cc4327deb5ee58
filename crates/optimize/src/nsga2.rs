//! Designs of which none is better than another in every objective: NSGA-II (K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, 2002).

use kempe_number::Random;

use crate::dominance::{crowding, fronts};
use crate::generations::{FEASIBLE, Generated, Generations, STRICTLY, generations};
use crate::halton::halton;
use crate::problem::{self, Candidate, Evaluation, Problem, Scales, exactly};
use crate::progress::{Ended, Hears};
use crate::space::Space;
use crate::standing::Standing;
use crate::variation::{crossed, mutate};
use crate::workers::Workers;

/// Limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Nsga2Options {
    /// Designs of a generation, and of the front at most.
    pub population: usize,
    /// Designs evaluated at most.
    pub evaluations: usize,
    /// A design that is in the first generation.
    pub start: Option<Vec<f64>>,
    /// An objective that is more than this many times as large as usual, of the designs of the first generation, is too large: beside a pole what is usual
    /// would be lost.
    pub within: f64,
    /// What all chance comes from.
    pub seed: u64,
}

impl Default for Nsga2Options {
    fn default() -> Self {
        Self {
            population: 100,
            evaluations: 25_000,
            start: None,
            within: f64::INFINITY,
            seed: 1,
        }
    }
}

/// A design with its place among the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The design and what it is worth.
    pub candidate: Candidate,
    /// The front that it is in, from zero.
    pub front: usize,
    /// How much room it has there.
    pub room: f64,
}

/// The state of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Nsga2 {
    /// The box.
    pub bounds: Vec<[f64; 2]>,
    /// The limits.
    pub options: Nsga2Options,
    /// The generator.
    pub random: Random,
    /// Given, or typical of the first generation.
    pub scales: Option<Scales>,
    /// What every objective may be at most; nothing before the first generation is known.
    pub most: Vec<f64>,
    /// All designs that were evaluated, as they came: first those from all over the box.
    pub seen: Vec<Candidate>,
    /// The designs, front by front.
    pub population: Vec<Member>,
    /// What is asked.
    pub asked: Vec<Vec<f64>>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// How many objectives and constraints there are.
    pub functions: [usize; 2],
}

impl Nsga2 {
    /// The start of a search.
    pub fn new(problem: &dyn Problem, options: &Nsga2Options) -> Self {
        let functions = [problem.objectives(), problem.constraints()];
        Self {
            bounds: problem.bounds().to_vec(),
            options: options.clone(),
            random: Random(options.seed),
            scales: problem::scales(problem),
            most: Vec::new(),
            seen: Vec::new(),
            population: Vec::new(),
            asked: Vec::new(),
            evaluations: 0,
            functions,
        }
    }

    /// Designs of a generation.
    fn size(&self) -> usize {
        self.options.population.min(self.options.evaluations).max(4)
    }

    /// The better one of two members at random: the earlier front, the larger room.
    fn parent(&mut self) -> Vec<f64> {
        let n = self.population.len();
        let (a, b) = (self.random.below(n), self.random.below(n));
        let (one, two) = (&self.population[a], &self.population[b]);
        let order = one
            .front
            .cmp(&two.front)
            .then(two.room.total_cmp(&one.room));
        let better = if order.is_gt() { two } else { one };
        better.candidate.design.clone()
    }

    /// The designs that keep all constraints, none of whose objectives is too large, and that none dominates, by their first objective; equal objectives once.
    pub fn front(&self) -> Vec<Candidate> {
        let Some(scales) = &self.scales else {
            return Vec::new();
        };
        let feasible = |c: &&Candidate| {
            let standing = Standing::within(&c.evaluation, (scales, STRICTLY), &self.most);
            matches!(standing, Standing::Feasible(_))
        };
        let first = self
            .population
            .iter()
            .filter(|m| m.front == 0)
            .map(|m| &m.candidate);
        let mut front: Vec<Candidate> = first.filter(feasible).cloned().collect();
        let key = |c: &Candidate| c.evaluation.objectives.clone();
        front.sort_by(|a, b| {
            let (a, b) = (key(a), key(b));
            let orders = a.iter().zip(&b).map(|(x, y)| x.total_cmp(y));
            orders.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        });
        front.dedup_by(|a, b| a.evaluation.objectives == b.evaluation.objectives);
        front
    }
}

impl Generations for Nsga2 {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if !self.asked.is_empty() {
            return self.asked.clone();
        }
        let left = self.options.evaluations.saturating_sub(self.evaluations);
        let size = match self.population.is_empty() {
            true => self.size(),
            false => self.size().min(left.max(1)),
        };
        if self.population.is_empty() {
            let space = Space::new(&self.bounds);
            let points = halton(self.random.bits(), size, self.bounds.len());
            self.asked = points.iter().map(|u| space.design(u)).collect();
            if let Some(start) = &self.options.start {
                self.asked[0] = space.within(start);
            }
        }
        while self.asked.len() < size {
            let parents = [self.parent(), self.parent()];
            let children = crossed(&mut self.random, &self.bounds, [&parents[0], &parents[1]]);
            for mut child in children {
                mutate(&mut self.random, &self.bounds, &mut child);
                if self.asked.len() < size {
                    self.asked.push(child);
                }
            }
        }
        self.asked.clone()
    }

    fn tell(&mut self, evaluations: Vec<Evaluation>) {
        let asked = std::mem::take(&mut self.asked);
        self.evaluations += asked.len();
        let [objectives, constraints] = self.functions;
        let scales = self.scales.take();
        let scales =
            scales.unwrap_or_else(|| Scales::typical(&evaluations, objectives, constraints));
        if self.population.is_empty() && self.options.within < f64::INFINITY {
            self.most = usual(&evaluations, objectives);
            let within = self.options.within;
            self.most.iter_mut().for_each(|most| *most *= within);
        }
        let mut all: Vec<Candidate> = self.population.drain(..).map(|m| m.candidate).collect();
        let new = asked.into_iter().zip(evaluations);
        let new = new.map(|(design, evaluation)| Candidate { design, evaluation });
        let before = self.seen.len();
        self.seen.extend(new);
        all.extend_from_slice(&self.seen[before..]);
        let stood: Vec<(Standing, &[f64])> = (all.iter())
            .map(|c| {
                (
                    Standing::within(&c.evaluation, (&scales, STRICTLY), &self.most),
                    c.evaluation.objectives.as_slice(),
                )
            })
            .collect();
        let size = self.size();
        let mut chosen: Vec<(usize, usize, f64)> = Vec::with_capacity(size);
        for (rank, front) in fronts(&stood).into_iter().enumerate() {
            let objectives: Vec<&[f64]> = front.iter().map(|k| stood[*k].1).collect();
            let mut members: Vec<(usize, usize, f64)> = (front.iter().zip(crowding(&objectives)))
                .map(|(k, room)| (*k, rank, room))
                .collect();
            if chosen.len() + members.len() > size {
                members.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
                members.truncate(size - chosen.len());
            }
            chosen.extend(members);
            if chosen.len() == size {
                break;
            }
        }
        self.population = (chosen.into_iter())
            .map(|(k, front, room)| Member {
                candidate: all[k].clone(),
                front,
                room,
            })
            .collect();
        self.scales = Some(scales);
    }

    fn best(&self) -> Option<&Candidate> {
        self.population.first().map(|m| &m.candidate)
    }

    fn scales(&self) -> Option<&Scales> {
        self.scales.as_ref()
    }

    fn evaluations(&self) -> usize {
        self.evaluations
    }

    fn budget(&self) -> usize {
        self.options.evaluations
    }

    fn is_finished(&self) -> bool {
        false
    }
}

/// A size of every objective that three of four designs are below, where it is not zero; infinite where it always is. Beside a pole few are; what goes over
/// decades all the same, as with a parameter on a scale of logarithms, has a fourth of its designs at the upper end.
fn usual(evaluations: &[Evaluation], objectives: usize) -> Vec<f64> {
    let of = |k: usize| {
        let defined = evaluations.iter().filter(|e| e.is_defined());
        let sizes = defined.map(|e| e.objectives[k].abs());
        let mut sizes: Vec<f64> = sizes.filter(|size| *size > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
            .get(3 * sizes.len() / 4)
            .copied()
            .unwrap_or(f64::INFINITY)
    };
    (0..objectives).map(of).collect()
}

/// A front of designs.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// The designs, by their first objective. Where none keeps all constraints, the one that violates them least, or lacks least, alone.
    pub members: Vec<Candidate>,
    /// Whether they keep all constraints.
    pub feasible: bool,
    /// Sizes of objectives and constraints.
    pub scales: Scales,
    /// What every objective was allowed to be at most.
    pub most: Vec<f64>,
    /// All designs that were evaluated, as they came: first those from all over the box.
    pub seen: Vec<Candidate>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Why it ended; a front has no end of its own, so [`Ended::Budget`] unless stopped.
    pub ended: Ended,
}

/// The front that NSGA-II finds, for all objectives.
pub fn nsga2(
    problem: &dyn Problem,
    options: &Nsga2Options,
    workers: &dyn Workers,
    hears: Hears,
) -> Front {
    let mut state = Nsga2::new(problem, options);
    let Generated { ended, untold } = generations(problem, &mut state, workers, hears);
    let evaluations = state.evaluations + untold.len();
    if state.population.is_empty() && !untold.is_empty() {
        // Stopped in its first generation: what there is of it.
        state.asked = untold.iter().map(|c| c.design.clone()).collect();
        state.tell(untold.into_iter().map(|c| c.evaluation).collect());
    }
    let scales = state.scales.clone().unwrap_or_default();
    let mut members = state.front();
    if members.is_empty() {
        // Where limits ask for what is so large it is none too large.
        state.most.fill(f64::INFINITY);
        members = state.front();
    }
    let feasible = !members.is_empty();
    if !feasible {
        let stand = |m: &&Member| Standing::of(&m.candidate.evaluation, &scales, FEASIBLE);
        let least = (state.population.iter()).min_by(|a, b| stand(a).order(&stand(b)));
        members.extend(least.map(|m| m.candidate.clone()));
    }
    members.iter_mut().for_each(|it| exactly(problem, it));
    Front {
        members,
        feasible,
        scales,
        most: state.most,
        seen: state.seen,
        evaluations,
        ended,
    }
}
