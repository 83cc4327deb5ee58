//! Differential evolution with success-history adaptation and a shrinking population: L-SHADE (R. Tanabe and A. S. Fukunaga, 2014).

use std::f64::consts::PI;

use kempe_number::{Random, math};

use crate::generations::{Found, Generations, STRICTLY, find};
use crate::halton::halton;
use crate::problem::{self, Candidate, Evaluation, Problem, Scales};
use crate::progress::Hears;
use crate::space::Space;
use crate::sqp::SqpOptions;
use crate::standing::{Standing, ranked};
use crate::workers::Workers;

/// Designs for each variable at the start, as published.
const POPULATION: usize = 18;
/// The smallest population: a mutation needs as many.
const SMALLEST: usize = 4;
/// Places of the memory, what the archive holds for each of the population, and the part of it that is taken for best.
const MEMORY: usize = 6;
const ARCHIVE: f64 = 2.6;
const BEST_PART: f64 = 0.11;
/// What the memory holds at first, and how far factors spread about it.
const FIRST: f64 = 0.5;
const SPREAD: f64 = 0.1;

/// Limits.
#[derive(Clone, Debug, PartialEq)]
pub struct DifferentialEvolutionOptions {
    /// Designs at the start; `None`: eighteen for each variable.
    pub population: Option<usize>,
    /// Designs evaluated at most; the population shrinks towards that.
    pub evaluations: usize,
    /// A population within this part of the box has converged.
    pub spread: f64,
    /// A design that is in the first generation.
    pub start: Option<Vec<f64>>,
    /// Whether and how the best design is polished.
    pub polish: Option<SqpOptions>,
    /// What all chance comes from.
    pub seed: u64,
}

impl Default for DifferentialEvolutionOptions {
    fn default() -> Self {
        Self {
            population: None,
            evaluations: 40_000,
            spread: 1e-9,
            start: None,
            polish: Some(SqpOptions::default()),
            seed: 1,
        }
    }
}

/// A design on trial, with what made it.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The design.
    pub design: Vec<f64>,
    /// How far differences are taken.
    pub factor: f64,
    /// How likely a variable is to change.
    pub crossover: f64,
}

/// The state of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct DifferentialEvolution {
    /// The box.
    pub bounds: Vec<[f64; 2]>,
    /// The limits.
    pub options: DifferentialEvolutionOptions,
    /// The generator.
    pub random: Random,
    /// Given, or typical of the first generation.
    pub scales: Option<Scales>,
    /// The designs, the best first.
    pub population: Vec<Candidate>,
    /// Designs that were replaced.
    pub archive: Vec<Vec<f64>>,
    /// Factors and crossover rates that served; a negative rate says that none will.
    pub memory: Vec<[f64; 2]>,
    /// The place of the memory that is written next.
    pub place: usize,
    /// What is asked.
    pub asked: Vec<Trial>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// How many objectives and constraints there are.
    pub functions: [usize; 2],
}

impl DifferentialEvolution {
    /// The start of a search.
    pub fn new(problem: &dyn Problem, options: &DifferentialEvolutionOptions) -> Self {
        let functions = [problem.objectives(), problem.constraints()];
        Self {
            bounds: problem.bounds().to_vec(),
            options: options.clone(),
            random: Random(options.seed),
            scales: problem::scales(problem),
            population: Vec::new(),
            archive: Vec::new(),
            memory: vec![[FIRST; 2]; MEMORY],
            place: 0,
            asked: Vec::new(),
            evaluations: 0,
            functions,
        }
    }

    /// Designs at the start.
    fn first_size(&self) -> usize {
        let size = self
            .options
            .population
            .unwrap_or(POPULATION * self.bounds.len());
        size.min(self.options.evaluations).max(SMALLEST)
    }

    /// The first generation.
    fn first(&mut self) -> Vec<Trial> {
        let space = Space::new(&self.bounds);
        let points = halton(self.random.bits(), self.first_size(), self.bounds.len());
        let mut designs: Vec<Vec<f64>> = points.iter().map(|unit| space.design(unit)).collect();
        if let Some(start) = &self.options.start {
            designs[0] = space.within(start);
        }
        let trial = |design: Vec<f64>| Trial {
            design,
            factor: FIRST,
            crossover: FIRST,
        };
        designs.into_iter().map(trial).collect()
    }

    /// A trial against a member: current-to-pbest/1 with binomial crossover.
    fn trial(&mut self, member: usize) -> Trial {
        let size = self.population.len();
        let random = &mut self.random;
        let [factor_about, rate_about] = self.memory[random.below(self.memory.len())];
        let crossover = match rate_about < 0.0 {
            true => 0.0,
            false => (rate_about + SPREAD * random.normal()).clamp(0.0, 1.0),
        };
        let factor = loop {
            let factor = factor_about + SPREAD * math::tan(PI * (random.uniform() - 0.5));
            if factor > 0.0 {
                break factor.min(1.0);
            }
        };
        let among_best = ((BEST_PART * size as f64).round() as usize).clamp(2, size);
        let best = random.below(among_best);
        let one = another(random, size, &[member]);
        let two = another(random, size + self.archive.len(), &[member, one]);
        let two = match two < size {
            true => &self.population[two].design,
            false => &self.archive[two - size],
        };
        let sure = random.below(self.bounds.len());
        let design = (0..self.bounds.len())
            .map(|k| {
                let own = self.population[member].design[k];
                if k != sure && random.uniform() >= crossover {
                    return own;
                }
                let [low, high] = self.bounds[k];
                let best = self.population[best].design[k];
                let moved = own + factor * (best - own + self.population[one].design[k] - two[k]);
                // Half way to the bound that it would cross.
                match () {
                    () if moved < low => (low + own) / 2.0,
                    () if moved > high => (high + own) / 2.0,
                    () => moved,
                }
            })
            .collect();
        Trial {
            design,
            factor,
            crossover,
        }
    }

    /// Learns from trials that were better: factor, rate and by how much.
    fn learn(&mut self, served: &[(f64, f64, f64)]) {
        let total: f64 = served.iter().map(|s| s.2).sum();
        if !(total > 0.0) {
            return;
        }
        // C. Lehmer's means, weighed by the gain.
        let mean = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
            let squares: f64 = served.iter().map(|s| s.2 * of(s) * of(s)).sum();
            let sum: f64 = served.iter().map(|s| s.2 * of(s)).sum();
            if sum > 0.0 { squares / sum } else { 0.0 }
        };
        let none = self.memory[self.place][1] < 0.0 || served.iter().all(|s| s.1 <= 0.0);
        let rate = if none { -1.0 } else { mean(&|s| s.1) };
        self.memory[self.place] = [mean(&|s| s.0), rate];
        self.place = (self.place + 1) % self.memory.len();
    }

    /// Members at this time: fewer the more of the budget is used.
    fn size_now(&self) -> usize {
        let first = self.first_size() as f64;
        let used = self.evaluations as f64 / self.options.evaluations.max(1) as f64;
        let size = first + (SMALLEST as f64 - first) * used.min(1.0);
        (size.round() as usize).max(SMALLEST)
    }
}

impl Generations for DifferentialEvolution {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.asked.is_empty() {
            self.asked = match self.population.is_empty() {
                true => self.first(),
                false => {
                    let left = self.options.evaluations.saturating_sub(self.evaluations);
                    let count = self.population.len().min(left.max(1));
                    (0..count).map(|k| self.trial(k)).collect()
                }
            };
        }
        self.asked.iter().map(|t| t.design.clone()).collect()
    }

    fn tell(&mut self, evaluations: Vec<Evaluation>) {
        let trials = std::mem::take(&mut self.asked);
        self.evaluations += trials.len();
        let [objectives, constraints] = self.functions;
        let scales = self.scales.take();
        let scales =
            scales.unwrap_or_else(|| Scales::typical(&evaluations, objectives, constraints));
        let stand = |e: &Evaluation| Standing::of(e, &scales, STRICTLY);
        let mut served = Vec::new();
        let first = self.population.is_empty();
        for (k, (trial, evaluation)) in trials.into_iter().zip(evaluations).enumerate() {
            let candidate = Candidate {
                design: trial.design,
                evaluation,
            };
            if first {
                self.population.push(candidate);
                continue;
            }
            let (old, new) = (
                stand(&self.population[k].evaluation),
                stand(&candidate.evaluation),
            );
            if new.order(&old).is_gt() {
                continue;
            }
            let old_member = std::mem::replace(&mut self.population[k], candidate);
            if new.order(&old).is_lt() {
                self.archive.push(old_member.design);
                served.push((trial.factor, trial.crossover, old, new));
            }
        }
        // Gains of different kinds have no common unit: each counts by the largest of its kind, a change of kind as such.
        let kind = |s: &Standing| std::mem::discriminant(s);
        let gains: Vec<(f64, f64, f64)> = (served.iter())
            .map(|(factor, rate, old, new)| {
                let own = new.ahead(*old).unwrap_or(0.0);
                let alike = served.iter().filter(|s| kind(&s.3) == kind(new));
                let most = alike.filter_map(|s| s.3.ahead(s.2)).fold(0.0, f64::max);
                let gain = if kind(old) != kind(new) || !(most < f64::INFINITY) {
                    1.0
                } else {
                    own / most.max(f64::MIN_POSITIVE)
                };
                (*factor, *rate, gain)
            })
            .collect();
        self.learn(&gains);
        let order = ranked(&self.population, &scales, STRICTLY);
        let size = if first {
            order.len()
        } else {
            self.size_now().min(order.len())
        };
        self.population = order[..size]
            .iter()
            .map(|k| self.population[*k].clone())
            .collect();
        let room = (ARCHIVE * size as f64) as usize;
        while self.archive.len() > room {
            let out = self.random.below(self.archive.len());
            self.archive.swap_remove(out);
        }
        self.scales = Some(scales);
    }

    fn best(&self) -> Option<&Candidate> {
        self.population.first()
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
        let space = Space::new(&self.bounds);
        let Some(best) = self
            .population
            .first()
            .filter(|b| b.evaluation.is_defined())
        else {
            return false;
        };
        let near = |c: &Candidate| space.distance(&best.design, &c.design) <= self.options.spread;
        self.population.iter().all(near)
    }
}

/// A number below `n` that is none of these.
fn another(random: &mut Random, n: usize, than: &[usize]) -> usize {
    loop {
        let number = random.below(n);
        if !than.contains(&number) {
            return number;
        }
    }
}

/// The best design that differential evolution finds, for the largest objective.
pub fn differential_evolution(
    problem: &dyn Problem,
    options: &DifferentialEvolutionOptions,
    workers: &dyn Workers,
    hears: Hears,
) -> Found {
    let mut state = DifferentialEvolution::new(problem, options);
    let polish = (options.start.as_deref(), options.polish.as_ref());
    find(problem, &mut state, polish, workers, hears)
}
