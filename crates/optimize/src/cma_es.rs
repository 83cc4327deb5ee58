//! Evolution with an adapted covariance matrix: CMA-ES (N. Hansen, The CMA Evolution Strategy: A Tutorial, 2016), restarted with larger populations
//! (A. Auger and N. Hansen, 2005).
//!
//! The box is kept by a map of the whole space onto it (`onto_unit`), as in Hansen's pycma: linear inside, bent to a
//! parabola near the bounds, and mirrored beyond. So every design that is evaluated is within the box, none is punished for where it came
//! from, and an optimum on a bound is the smooth one of the mapped function.

use kempe_linear::symmetric_eigen;
use kempe_number::{Random, math};

use crate::generations::{Found, Generations, STRICTLY, find};
use crate::problem::{self, Candidate, Evaluation, Problem, Scales};
use crate::progress::Hears;
use crate::space::Space;
use crate::sqp::SqpOptions;
use crate::standing::{Standing, ranked};
use crate::workers::Workers;

/// The map is bent within this part of the box from a bound.
const BENT: f64 = 0.05;
/// A run that moves no farther than this part of the box has ended.
const SETTLED: f64 = 1e-12;
/// And one whose best values differ by this part for some generations.
const FLAT: f64 = 1e-13;
/// And one whose axes differ by this factor.
const ILL: f64 = 1e7;
/// Each restart has so many times the population.
const LARGER: usize = 2;

/// Limits.
#[derive(Clone, Debug, PartialEq)]
pub struct CmaEsOptions {
    /// Designs of a generation; `None`: 4 + 3 ln n of n variables, as published.
    pub population: Option<usize>,
    /// The first step, as a part of the box.
    pub step: f64,
    /// Designs evaluated at most.
    pub evaluations: usize,
    /// Restarts at most, each from a random place with twice the population.
    pub restarts: usize,
    /// Where the first search begins; `None`: in the middle of the box.
    pub start: Option<Vec<f64>>,
    /// Whether and how the best design is polished.
    pub polish: Option<SqpOptions>,
    /// What all chance comes from.
    pub seed: u64,
}

impl Default for CmaEsOptions {
    fn default() -> Self {
        Self {
            population: None,
            step: 0.3,
            evaluations: 40_000,
            restarts: 9,
            start: None,
            polish: Some(SqpOptions::default()),
            seed: 1,
        }
    }
}

/// The state of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct CmaEs {
    /// The box.
    pub bounds: Vec<[f64; 2]>,
    /// The limits.
    pub options: CmaEsOptions,
    /// The generator.
    pub random: Random,
    /// Given, or typical of the first generation.
    pub scales: Option<Scales>,
    /// Where the population is about, before the map onto the unit box.
    pub mean: Vec<f64>,
    /// The size of a step.
    pub step: f64,
    /// The shape of steps, a symmetric matrix by rows.
    pub covariance: Vec<f64>,
    /// Where steps of late lead to, made comparable, and as they are.
    pub paths: [Vec<f64>; 2],
    /// Designs of a generation.
    pub population: usize,
    /// Generations since the last start.
    pub generation: usize,
    /// Restarts so far.
    pub restarts: usize,
    /// The best of each late generation.
    pub history: Vec<Candidate>,
    /// What is asked, before the map.
    pub asked: Vec<Vec<f64>>,
    /// The best design so far.
    pub best: Option<Candidate>,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Whether all restarts are used.
    pub finished: bool,
    /// How many objectives and constraints there are.
    pub functions: [usize; 2],
}

impl CmaEs {
    /// The start of a search.
    pub fn new(problem: &dyn Problem, options: &CmaEsOptions) -> Self {
        let functions = [problem.objectives(), problem.constraints()];
        let n = problem.bounds().len();
        let usual = 4 + (3.0 * math::ln(n.max(1) as f64)) as usize;
        let mut state = Self {
            bounds: problem.bounds().to_vec(),
            options: options.clone(),
            random: Random(options.seed),
            scales: problem::scales(problem),
            mean: Vec::new(),
            step: 0.0,
            covariance: Vec::new(),
            paths: [Vec::new(), Vec::new()],
            population: options.population.unwrap_or(usual).max(4),
            generation: 0,
            restarts: 0,
            history: Vec::new(),
            asked: Vec::new(),
            best: None,
            evaluations: 0,
            finished: false,
            functions,
        };
        state.start();
        state
    }

    /// Begins anew, from the given design or the middle of the box at first, from a random place afterwards.
    fn start(&mut self) {
        let n = self.bounds.len();
        let random = &mut self.random;
        self.mean = match (self.restarts, &self.options.start) {
            (0, None) => vec![0.5; n],
            (0, Some(start)) => {
                let space = Space::new(&self.bounds);
                let unit = space.unit(&space.within(start));
                unit.into_iter().map(from_unit).collect()
            }
            _ => (0..n).map(|_| random.uniform()).collect(),
        };
        self.step = self.options.step;
        self.covariance = (0..n * n)
            .map(|k| if k / n == k % n { 1.0 } else { 0.0 })
            .collect();
        self.paths = [vec![0.0; n], vec![0.0; n]];
        self.generation = 0;
        self.history.clear();
    }

    /// The shape's axes: vectors by their roots of eigenvalues.
    fn axes(&self) -> Vec<(Vec<f64>, f64)> {
        let pairs = symmetric_eigen(&self.covariance, self.bounds.len());
        pairs
            .into_iter()
            .map(|p| (p.vector, p.value.max(0.0).sqrt()))
            .collect()
    }

    /// The design of a place before the map.
    fn design(&self, space: &Space, place: &[f64]) -> Vec<f64> {
        space.design(&place.iter().map(|y| onto_unit(*y)).collect::<Vec<_>>())
    }

    /// Whether the run at hand leads nowhere any more.
    fn has_ended(&self, scales: &Scales) -> bool {
        let sizes: Vec<f64> = self.axes().iter().map(|a| a.1).collect();
        let (least, most) = sizes
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(l, m), s| (l.min(*s), m.max(*s)));
        let window = self.window();
        let flat = self.history.len() >= window && {
            let standings = self
                .history
                .iter()
                .map(|c| Standing::of(&c.evaluation, scales, STRICTLY));
            let values: Vec<f64> = standings
                .map(|s| match s {
                    Standing::Feasible(v) | Standing::Violating(v) | Standing::Lacking(v) => v,
                })
                .collect();
            let (low, high) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                    (l.min(*v), h.max(*v))
                });
            high - low <= FLAT * high.abs().max(low.abs())
        };
        !(self.step * most > SETTLED) || !(most < ILL * least) || !self.step.is_finite() || flat
    }

    /// Generations that are looked at for whether anything changes.
    fn window(&self) -> usize {
        10 + 30 * self.bounds.len() / self.population
    }
}

impl Generations for CmaEs {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.asked.is_empty() {
            let axes = self.axes();
            // A design that was given is looked at itself.
            if self.options.start.is_some() && self.evaluations == 0 {
                self.asked.push(self.mean.clone());
            }
            let left = self.options.evaluations.saturating_sub(self.evaluations);
            while self.asked.len() < self.population.min(left.max(1)) {
                let mut place = self.mean.clone();
                for (vector, length) in &axes {
                    let along = self.step * length * self.random.normal();
                    place
                        .iter_mut()
                        .zip(vector)
                        .for_each(|(x, v)| *x += along * v);
                }
                self.asked.push(place);
            }
        }
        let space = Space::new(&self.bounds);
        self.asked
            .iter()
            .map(|place| self.design(&space, place))
            .collect()
    }

    fn tell(&mut self, evaluations: Vec<Evaluation>) {
        let n = self.bounds.len();
        let dimension = n as f64;
        let space = Space::new(&self.bounds);
        let asked = std::mem::take(&mut self.asked);
        self.evaluations += asked.len();
        let [objectives, constraints] = self.functions;
        let scales = self.scales.take();
        let scales =
            scales.unwrap_or_else(|| Scales::typical(&evaluations, objectives, constraints));
        let candidates: Vec<Candidate> = (asked.iter().zip(evaluations))
            .map(|(place, evaluation)| Candidate {
                design: self.design(&space, place),
                evaluation,
            })
            .collect();
        let order = ranked(&candidates, &scales, STRICTLY);
        let stand = |c: &Candidate| Standing::of(&c.evaluation, &scales, STRICTLY);
        let now = &candidates[order[0]];
        if self
            .best
            .as_ref()
            .is_none_or(|best| stand(now).order(&stand(best)).is_lt())
        {
            self.best = Some(now.clone());
        }
        self.history.push(now.clone());
        let window = self.window();
        if self.history.len() > window {
            self.history.remove(0);
        }

        // The last generation, where it is smaller, teaches nothing more.
        if asked.len() < self.population {
            self.scales = Some(scales);
            return;
        }

        // Names as in the tutorial: mu, weights, c and d.
        let parents = order.len() / 2;
        let raw = |k: usize| math::ln((order.len() as f64 + 1.0) / 2.0) - math::ln(k as f64 + 1.0);
        let total: f64 = (0..parents).map(raw).sum();
        let weights: Vec<f64> = (0..parents).map(|k| raw(k) / total).collect();
        let effective = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_step = (effective + 2.0) / (dimension + effective + 5.0);
        let d_step =
            1.0 + 2.0 * (((effective - 1.0) / (dimension + 1.0)).sqrt() - 1.0).max(0.0) + c_step;
        let c_path =
            (4.0 + effective / dimension) / (dimension + 4.0 + 2.0 * effective / dimension);
        let c_one = 2.0 / ((dimension + 1.3) * (dimension + 1.3) + effective);
        let c_many = 2.0 * (effective - 2.0 + 1.0 / effective)
            / ((dimension + 2.0) * (dimension + 2.0) + effective);
        let c_many = c_many.min(1.0 - c_one);
        let expected = dimension.sqrt()
            * (1.0 - 1.0 / (4.0 * dimension) + 1.0 / (21.0 * dimension * dimension));

        let steps: Vec<Vec<f64>> = (order[..parents].iter())
            .map(|k| {
                asked[*k]
                    .iter()
                    .zip(&self.mean)
                    .map(|(x, m)| (x - m) / self.step)
                    .collect()
            })
            .collect();
        let mut moved = vec![0.0; n];
        for (weight, step) in weights.iter().zip(&steps) {
            moved
                .iter_mut()
                .zip(step)
                .for_each(|(m, s)| *m += weight * s);
        }
        // C^(-1/2) times the mean's step.
        let mut even = vec![0.0; n];
        for (vector, length) in self.axes() {
            if length > 0.0 {
                let along = vector.iter().zip(&moved).map(|(v, m)| v * m).sum::<f64>() / length;
                even.iter_mut()
                    .zip(&vector)
                    .for_each(|(e, v)| *e += along * v);
            }
        }
        let keep = (c_step * (2.0 - c_step) * effective).sqrt();
        self.paths[0]
            .iter_mut()
            .zip(&even)
            .for_each(|(p, e)| *p = (1.0 - c_step) * *p + keep * e);
        let length = self.paths[0].iter().map(|p| p * p).sum::<f64>().sqrt();
        self.generation += 1;
        let seen = 1.0 - math::powf(1.0 - c_step, 2.0 * self.generation as f64);
        let holds = length / seen.sqrt() < (1.4 + 2.0 / (dimension + 1.0)) * expected;
        let keep = if holds {
            (c_path * (2.0 - c_path) * effective).sqrt()
        } else {
            0.0
        };
        self.paths[1]
            .iter_mut()
            .zip(&moved)
            .for_each(|(p, m)| *p = (1.0 - c_path) * *p + keep * m);
        let lost = if holds {
            0.0
        } else {
            c_one * c_path * (2.0 - c_path)
        };
        for i in 0..n {
            for j in 0..n {
                let many: f64 = weights
                    .iter()
                    .zip(&steps)
                    .map(|(w, s)| w * s[i] * s[j])
                    .sum();
                let old = self.covariance[i * n + j];
                self.covariance[i * n + j] = (1.0 - c_one - c_many + lost) * old
                    + c_one * self.paths[1][i] * self.paths[1][j]
                    + c_many * many;
            }
        }
        self.mean
            .iter_mut()
            .zip(&moved)
            .for_each(|(m, d)| *m += self.step * d);
        self.step *= math::exp((c_step / d_step * (length / expected - 1.0)).min(1.0));

        if self.has_ended(&scales) {
            self.finished = self.restarts >= self.options.restarts;
            if !self.finished {
                self.restarts += 1;
                self.population *= LARGER;
                self.start();
            }
        }
        self.scales = Some(scales);
    }

    fn best(&self) -> Option<&Candidate> {
        self.best.as_ref()
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
        self.finished
    }
}

/// The place of the unit interval that any number stands for.
fn onto_unit(y: f64) -> f64 {
    // The numbers from -BENT to 1 + BENT go once over it, those beyond back again.
    let period = 1.0 + 2.0 * BENT;
    let from = (y + BENT) - 2.0 * period * ((y + BENT) / (2.0 * period)).floor();
    let from = if from > period {
        2.0 * period - from
    } else {
        from
    };
    let bent = |from: f64| from * from / (4.0 * BENT);
    match () {
        () if !from.is_finite() => 0.5,
        () if from < 2.0 * BENT => bent(from),
        () if from > period - 2.0 * BENT => 1.0 - bent(period - from),
        () => from - BENT,
    }
}

/// A number that stands for a place of the unit interval.
fn from_unit(u: f64) -> f64 {
    let bent = |u: f64| (4.0 * BENT * u).sqrt() - BENT;
    match () {
        () if u < BENT => bent(u.max(0.0)),
        () if u > 1.0 - BENT => 1.0 - bent((1.0 - u).max(0.0)),
        () => u,
    }
}

/// The best design that CMA-ES finds, for the largest objective.
pub fn cma_es(
    problem: &dyn Problem,
    options: &CmaEsOptions,
    workers: &dyn Workers,
    hears: Hears,
) -> Found {
    let mut state = CmaEs::new(problem, options);
    let polish = (options.start.as_deref(), options.polish.as_ref());
    find(problem, &mut state, polish, workers, hears)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_is_turned_back() {
        for k in 0..=200 {
            let u = f64::from(k) / 200.0;
            assert!((onto_unit(from_unit(u)) - u).abs() < 1e-15, "{u}");
        }
    }
}
