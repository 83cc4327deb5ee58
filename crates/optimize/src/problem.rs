//! What is to be minimised: a box, objectives, constraints.

use crate::workers::{Workers, each};

/// What is to be minimised within a box.
///
/// Every function is the largest of its pieces, as the peak of a quantity over a motion is the largest of its local peaks. Its
/// value is what [`evaluate`](Problem::evaluate) answers, its pieces with their derivatives what [`slopes`](Problem::slopes) does;
/// both must agree: the value is that of the largest piece. Methods for one objective minimise the largest of all of them.
///
/// What a design is worth hangs on the design alone, so that several may be asked at once.
pub trait Problem: Sync {
    /// The least and the largest value of every variable, finite. No method looks outside.
    fn bounds(&self) -> &[[f64; 2]];

    /// How many objectives there are.
    fn objectives(&self) -> usize {
        1
    }

    /// How many constraints there are; each must be at most zero.
    fn constraints(&self) -> usize {
        0
    }

    /// Typical sizes, so that tolerances mean something; `None` takes them from values.
    fn scales(&self) -> Option<Scales> {
        None
    }

    /// What the largest objective is never below, by what it is; minus infinity where nothing is known of it.
    fn least(&self) -> f64 {
        f64::NEG_INFINITY
    }

    /// What a constraint is never below, by what it is; minus infinity where nothing is known of it.
    fn least_of(&self, _constraint: usize) -> f64 {
        f64::NEG_INFINITY
    }

    /// What a design is worth.
    fn evaluate(&self, design: &[f64]) -> Evaluation;

    /// What many designs are worth, for whoever compares them: not to the last digit, where that takes less time. What is made of one of them is asked
    /// of it alone, [exactly](Problem::exactly).
    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        each(workers, designs.iter().collect(), |design: &Vec<f64>| {
            self.evaluate(design)
        })
    }

    /// What a design that was one of many is worth to the last digit; none where that is known. It was counted as tried before.
    fn exactly(&self, _: &[f64]) -> Option<Evaluation> {
        None
    }

    /// All pieces of all functions at a design, with their derivatives; `None` where there are none.
    fn slopes(&self, design: &[f64]) -> Option<Slopes>;
}

/// What a design is worth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// The objectives, which are to be small.
    pub objectives: Vec<f64>,
    /// The constraints, which must be at most zero.
    pub constraints: Vec<f64>,
    /// Zero where the design can be evaluated; otherwise how far it is from that, in whatever unit: a linkage that does not assemble
    /// by the length that is missing. The other values mean nothing then.
    pub lack: f64,
}

impl Evaluation {
    /// Of a design that cannot be evaluated, so far from one that can.
    pub fn lacking(lack: f64) -> Self {
        Self {
            lack,
            ..Self::default()
        }
    }

    /// The largest objective.
    pub fn largest(&self) -> f64 {
        largest(self.objectives.iter().copied())
    }

    /// The largest constraint by its scale, zero where all are kept.
    pub fn violation(&self, scales: &Scales) -> f64 {
        let scaled = self.constraints.iter().zip(&scales.constraints);
        largest(scaled.map(|(c, s)| c / s)).max(0.0)
    }

    /// Whether all values are there.
    pub fn is_defined(&self) -> bool {
        self.lack <= 0.0
    }
}

/// A design with what it is worth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidate {
    /// The design.
    pub design: Vec<f64>,
    /// What it is worth.
    pub evaluation: Evaluation,
}

/// Every function as its pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slopes {
    /// Pieces of every objective, at least one each.
    pub objectives: Vec<Vec<Piece>>,
    /// Pieces of every constraint, at least one each.
    pub constraints: Vec<Vec<Piece>>,
}

impl Slopes {
    /// Whether every function has pieces of `n` variables that are numbers.
    fn is_sound(&self, objectives: usize, constraints: usize, n: usize) -> bool {
        let sound = |f: &Vec<Piece>| !f.is_empty() && f.iter().all(|p| p.is_sound(n));
        self.objectives.len() == objectives
            && self.constraints.len() == constraints
            && self.objectives.iter().chain(&self.constraints).all(sound)
    }
}

/// A smooth function, a part of a larger one, at a design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// Its value.
    pub value: f64,
    /// Its derivative to every variable.
    pub slope: Vec<f64>,
}

impl Piece {
    /// Whether all of it are numbers.
    fn is_sound(&self, n: usize) -> bool {
        self.value.is_finite() && self.slope.len() == n && self.slope.iter().all(|x| x.is_finite())
    }
}

/// Typical sizes of functions, positive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scales {
    /// Of every objective.
    pub objectives: Vec<f64>,
    /// Of every constraint.
    pub constraints: Vec<f64>,
}

impl Scales {
    /// Sizes of one.
    pub fn unit(objectives: usize, constraints: usize) -> Self {
        Self {
            objectives: vec![1.0; objectives],
            constraints: vec![1.0; constraints],
        }
    }

    /// The median size of the values of all designs that can be evaluated, one where that is zero or nothing.
    pub fn typical(evaluations: &[Evaluation], objectives: usize, constraints: usize) -> Self {
        let of = |values: &dyn Fn(&Evaluation) -> f64| {
            let defined = evaluations.iter().filter(|e| e.is_defined());
            let mut sizes: Vec<f64> = defined.map(|e| values(e).abs()).collect();
            sizes.sort_by(f64::total_cmp);
            sound_scale(sizes.get(sizes.len() / 2).copied().unwrap_or(1.0))
        };
        Self {
            objectives: (0..objectives).map(|k| of(&|e| e.objectives[k])).collect(),
            constraints: (0..constraints)
                .map(|k| of(&|e| e.constraints[k]))
                .collect(),
        }
    }

    /// The larger of both.
    pub(crate) fn at_least(&self, least: &Self) -> Self {
        let larger = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.max(*b)).collect();
        Self {
            objectives: larger(&self.objectives, &least.objectives),
            constraints: larger(&self.constraints, &least.constraints),
        }
    }

    /// All of them as many times as large.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let times = |a: &[f64]| a.iter().map(|a| a * factor).collect();
        Self {
            objectives: times(&self.objectives),
            constraints: times(&self.constraints),
        }
    }

    /// Whether there are as many as asked for and all are positive numbers.
    pub(crate) fn fits(&self, objectives: usize, constraints: usize) -> bool {
        let positive = |s: &f64| *s > 0.0 && s.is_finite();
        self.objectives.len() == objectives
            && self.constraints.len() == constraints
            && self
                .objectives
                .iter()
                .chain(&self.constraints)
                .all(positive)
    }
}

/// The size, or one where it is no positive number.
pub(crate) fn sound_scale(size: f64) -> f64 {
    match size > 0.0 && size.is_finite() {
        true => size,
        false => 1.0,
    }
}

/// The largest of some numbers; less than all where there are none.
pub(crate) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

/// The problem's own scales, if it has some that fit it.
pub(crate) fn scales(problem: &dyn Problem) -> Option<Scales> {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    problem.scales().filter(|s| s.fits(objectives, constraints))
}

/// What a problem says of a design, with what is no number or is missing as a lack.
pub(crate) fn evaluate(problem: &dyn Problem, design: &[f64]) -> Evaluation {
    sound(problem, problem.evaluate(design))
}

fn sound(problem: &dyn Problem, evaluation: Evaluation) -> Evaluation {
    let values = || (evaluation.objectives.iter()).chain(&evaluation.constraints);
    let sound = evaluation.objectives.len() == problem.objectives()
        && evaluation.constraints.len() == problem.constraints()
        && values().all(|x| x.is_finite());
    match evaluation.lack.is_nan() || (evaluation.is_defined() && !sound) {
        true => Evaluation::lacking(f64::INFINITY),
        false => evaluation,
    }
}

/// What designs are worth, in their order.
pub fn evaluate_all(
    problem: &dyn Problem,
    designs: &[Vec<f64>],
    workers: &dyn Workers,
) -> Vec<Evaluation> {
    each(workers, designs.iter().collect(), |design| {
        evaluate(problem, design)
    })
}

/// What many designs are worth, in their order, nearly.
pub(crate) fn nearly(
    problem: &dyn Problem,
    designs: &[Vec<f64>],
    workers: &dyn Workers,
) -> Vec<Evaluation> {
    let all = problem.nearly(designs, workers).into_iter();
    all.map(|evaluation| sound(problem, evaluation)).collect()
}

/// A design that was one of many, with all its digits.
pub(crate) fn exactly(problem: &dyn Problem, candidate: &mut Candidate) {
    if let Some(evaluation) = problem.exactly(&candidate.design) {
        candidate.evaluation = sound(problem, evaluation);
    }
}

/// The pieces at a design; `None` where any is no number.
pub(crate) fn slopes(problem: &dyn Problem, design: &[f64]) -> Option<Slopes> {
    let (objectives, constraints) = (problem.objectives(), problem.constraints());
    let slopes = problem.slopes(design)?;
    slopes
        .is_sound(objectives, constraints, design.len())
        .then_some(slopes)
}
