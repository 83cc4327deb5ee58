//! What is optimised, as the methods see it: parameters in a box, numbers of designs on the bench.

use kempe_model::{Among, Model, OptimizeStudy, StudyKind, value};
use kempe_optimize::{Evaluation, Piece, Problem, Slopes};

use super::fit::{Fitted, sum};
use super::pieces::{Wanted, pieces};
use crate::designs::asked::kept;
use crate::designs::bench::{Bench, Refused};

/// Steps of differences where there are no exact derivatives, in parts of the box: simulations keep ten digits and more.
const DIFFERENCE: f64 = 1e-5;

/// Designs of a study as a problem.
pub(super) struct Designs<'b, 'm> {
    pub bench: &'b Bench<'m>,
    /// What is to be small or large, then what must be kept.
    pub wanted: Vec<Wanted>,
    /// What is fitted; its sum of squares stands in the place of the one goal.
    pub fit: Option<Fitted<'b, 'm>>,
    goals: usize,
    bounds: Vec<[f64; 2]>,
    /// Why the last design that cannot be asked cannot.
    pub refused: Option<String>,
    /// Designs that were asked for their numbers, and for their derivatives.
    pub asked: usize,
    pub sloped: usize,
}

impl<'b, 'm> Designs<'b, 'm> {
    /// The problem of a study; the numbers of its bench are the goals and then what is kept.
    pub fn new(bench: &'b Bench<'m>, study: &OptimizeStudy) -> Self {
        let (model, mechanism) = (bench.model, bench.mechanism());
        let goals = study.goals.iter().zip(&bench.numbers);
        let goals = goals.map(|(goal, number)| {
            let sign = if goal.maximize { -1.0 } else { 1.0 };
            Wanted::new(mechanism, number.clone(), sign)
        });
        let limits = study.subject_to.iter();
        let limits = limits.map(|limit| Wanted::new(mechanism, kept(model, limit), -1.0));
        Self {
            bench,
            wanted: goals.chain(limits).collect(),
            fit: study.fit.as_ref().map(|fit| Fitted::new(bench, fit)),
            goals: study.goals.len(),
            bounds: bounds(model, study),
            refused: None,
            asked: 0,
            sloped: 0,
        }
    }

    fn evaluated(&mut self, values: &[f64]) -> Evaluation {
        self.asked += 1;
        let numbers = match self.numbers(values) {
            Ok(numbers) => numbers,
            Err(refused) => return self.lacking(refused),
        };
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let why = format!("`{}` has no finite value", self.wanted[k].number.name);
            return self.lacking(Refused { lack: 1.0, why });
        }
        let signed = numbers.iter().zip(&self.wanted).map(|(x, w)| w.sign * x);
        let mut objectives: Vec<f64> = signed.collect();
        let constraints = objectives.split_off(self.goals);
        Evaluation {
            objectives,
            constraints,
            lack: 0.0,
        }
    }

    /// The numbers of a design, that of the fit in its place.
    pub fn numbers(&self, values: &[f64]) -> Result<Vec<f64>, Refused> {
        let Some(fit) = &self.fit else {
            return self.bench.numbers(values);
        };
        if self.wanted.len() == 1 {
            return Ok(vec![fit.seen(values)?.met.square()]);
        }
        let motion = self.bench.motion(values, &mut kempe_motion::Silent)?;
        let mut numbers = self.bench.answer_of(&motion)?.numbers;
        numbers[0] = fit.seen_of(&motion)?.met.square();
        Ok(numbers)
    }

    fn lacking(&mut self, refused: Refused) -> Evaluation {
        self.refused = Some(refused.why);
        Evaluation::lacking(refused.lack)
    }

    /// Pieces by central differences: each number is one.
    fn differences(&mut self, design: &[f64]) -> Option<Vec<Vec<Piece>>> {
        let own = self.bench.numbers(design).ok()?;
        let mut slopes = vec![vec![0.0; design.len()]; own.len()];
        for (k, [low, high]) in self.bounds.clone().into_iter().enumerate() {
            let step = DIFFERENCE * (high - low);
            let at = |x: f64| {
                let mut moved = design.to_vec();
                moved[k] = x.clamp(low, high);
                (moved[k], moved)
            };
            let (below, first) = at(design[k] - step);
            let (above, second) = at(design[k] + step);
            self.asked += 2;
            let (first, second) = (
                self.bench.numbers(&first).ok()?,
                self.bench.numbers(&second).ok()?,
            );
            for (slope, (a, b)) in slopes.iter_mut().zip(first.iter().zip(&second)) {
                slope[k] = (b - a) / (above - below);
            }
        }
        let signed = own.iter().zip(slopes).zip(&self.wanted);
        let piece = signed.map(|((value, slope), w)| {
            vec![Piece {
                value: w.sign * value,
                slope: slope.iter().map(|d| w.sign * d).collect(),
            }]
        });
        Some(piece.collect())
    }
}

impl Problem for Designs<'_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.goals
    }

    fn constraints(&self) -> usize {
        self.wanted.len() - self.goals
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        designs
            .iter()
            .map(|design| self.evaluated(design))
            .collect()
    }

    fn slopes(&mut self, design: &[f64]) -> Option<Slopes> {
        self.sloped += 1;
        let mut objectives = match self.bench.over.kind {
            StudyKind::Simulate(_) => self.differences(design)?,
            _ if self.fit.is_some() && self.wanted.len() == 1 => vec![Vec::new()],
            _ => pieces(self.bench, &self.wanted, design).ok()?,
        };
        if let Some(fit) = &self.fit {
            let mut seen = fit.seen(design).ok()?;
            objectives[0] = vec![sum(&fit.residuals(&mut seen).ok()?)];
        }
        let constraints = objectives.split_off(self.goals);
        Some(Slopes {
            objectives,
            constraints,
        })
    }
}

/// The least and the greatest value of every parameter, SI; discrete values lie between the ends of all.
fn bounds(model: &Model, study: &OptimizeStudy) -> Vec<[f64; 2]> {
    let parameters = model.parameter_values::<f64>();
    let number = |x| value::<f64>(x, &parameters);
    let ends = study.vary.iter().map(|chosen| match &chosen.among {
        Among::Between([low, high]) => [number(low), number(high)],
        Among::Steps { .. } | Among::Only(_) => {
            let all = choices(model, &chosen.among);
            let low = all.iter().copied().fold(f64::INFINITY, f64::min);
            let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            [low, high]
        }
    });
    ends.collect()
}

/// So many whole multiples of a step are told apart at most.
const MOST_CHOICES: f64 = 1e6;

/// The values of a parameter that is chosen among some, SI and rising; none of one that may have any between two.
pub(super) fn choices(model: &Model, among: &Among) -> Vec<f64> {
    let parameters = model.parameter_values::<f64>();
    let number = |x| value::<f64>(x, &parameters);
    let mut all: Vec<f64> = match among {
        Among::Between(_) => Vec::new(),
        Among::Only(values) => values.iter().map(number).collect(),
        Among::Steps { between, step } => {
            let step = number(step);
            let [first, last] = [
                (number(&between[0]) / step - 1e-9).ceil(),
                (number(&between[1]) / step + 1e-9).floor(),
            ];
            let count = (last - first).min(MOST_CHOICES) as usize;
            (0..=count).map(|k| (first + k as f64) * step).collect()
        }
    };
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
