//! What methods share that keep a population of designs and ask for whole generations at once.

use crate::problem::{self, Evaluation, Problem, Scales};
use crate::progress::{Hears, Progress};
use crate::rank::compare;
use crate::space::Space;

/// How far a method goes, and with which random numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationOptions {
    /// Designs evaluated at most.
    pub evaluations: usize,
    /// Designs of a generation; `None` as the method suits the number of variables.
    pub size: Option<usize>,
    /// Which random numbers.
    pub seed: u64,
}

impl Default for PopulationOptions {
    fn default() -> Self {
        Self {
            evaluations: 20_000,
            size: None,
            seed: 1,
        }
    }
}

/// A design with what it is worth; places in the unit box.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Its place in the unit box.
    pub place: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
}

/// The best that a population has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The design.
    pub design: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
    /// The largest violation of its constraints, in their scales.
    pub violation: f64,
    /// Designs evaluated.
    pub evaluations: usize,
    /// Whether whoever listened stopped it.
    pub stopped: bool,
}

/// A problem asked generation by generation.
pub(crate) struct Asker<'a, 'h> {
    pub problem: &'a mut dyn Problem,
    pub space: Space,
    pub scales: Scales,
    pub asked: usize,
    budget: usize,
    hears: Hears<'h>,
    pub best: Option<Member>,
    pub stopped: bool,
}

impl<'a, 'h> Asker<'a, 'h> {
    /// Asks for the first generation; typical sizes are those of its values.
    pub fn begin(
        problem: &'a mut dyn Problem,
        first: Vec<Vec<f64>>,
        budget: usize,
        hears: Hears<'h>,
    ) -> (Self, Vec<Member>) {
        let space = Space::new(problem.bounds());
        let (objectives, constraints) = (problem.objectives(), problem.constraints());
        let mut asker = Self {
            problem,
            space,
            scales: Scales::unit(objectives, constraints),
            asked: 0,
            budget,
            hears,
            best: None,
            stopped: false,
        };
        let evaluations = asker.evaluations(&first);
        asker.scales = crate::multi_start::scales_of(asker.problem, &evaluations);
        let members = asker.members(first, evaluations);
        (asker, members)
    }

    fn evaluations(&mut self, places: &[Vec<f64>]) -> Vec<Evaluation> {
        let designs: Vec<Vec<f64>> = places
            .iter()
            .map(|place| self.space.design(place))
            .collect();
        self.asked += designs.len();
        problem::evaluate(self.problem, &designs)
    }

    fn members(&mut self, places: Vec<Vec<f64>>, evaluations: Vec<Evaluation>) -> Vec<Member> {
        let pairs = places.into_iter().zip(evaluations);
        let members: Vec<Member> = pairs
            .map(|(place, evaluation)| Member { place, evaluation })
            .collect();
        for member in &members {
            let better = self.best.as_ref().is_none_or(|best| {
                compare(&member.evaluation, &best.evaluation, &self.scales).is_lt()
            });
            if better {
                self.best = Some(member.clone());
            }
        }
        self.tell();
        members
    }

    /// What the designs at these places of the unit box are worth.
    pub fn ask(&mut self, places: Vec<Vec<f64>>) -> Vec<Member> {
        let evaluations = self.evaluations(&places);
        self.members(places, evaluations)
    }

    /// Whether there is no more to be asked.
    pub fn is_over(&self) -> bool {
        self.stopped || self.asked >= self.budget
    }

    /// How many may still be asked.
    pub fn left(&self) -> usize {
        self.budget.saturating_sub(self.asked)
    }

    fn tell(&mut self) {
        let design = self
            .best
            .as_ref()
            .map(|best| self.space.design(&best.place));
        let best = design
            .as_deref()
            .zip(self.best.as_ref().map(|b| b.evaluation.largest()));
        let violation = self
            .best
            .as_ref()
            .map_or(f64::INFINITY, |b| b.evaluation.violation(&self.scales));
        let progress = Progress {
            evaluations: self.asked,
            budget: self.budget,
            best,
            violation,
        };
        self.stopped |= (self.hears)(&progress).is_break();
    }

    /// What was found; `None` where nothing was asked.
    pub fn found(self) -> Option<Found> {
        let best = self.best?;
        Some(Found {
            design: self.space.design(&best.place),
            violation: match best.evaluation.is_defined() {
                true => best.evaluation.violation(&self.scales),
                false => f64::INFINITY,
            },
            evaluation: best.evaluation,
            evaluations: self.asked,
            stopped: self.stopped,
        })
    }
}
