//! Objectives that may not be too large: beside a pole of one of them all that is usual would be lost in a front.

use kempe_number::math;

use crate::problem::{self, Evaluation, Piece, Problem, Scales, Slopes};
use crate::workers::Workers;

/// A problem with a constraint more, behind its own, for each of some objectives: to be no more than a value.
pub struct Within<'a> {
    inner: &'a dyn Problem,
    most: Vec<(usize, f64)>,
}

impl<'a> Within<'a> {
    /// Of a problem and what its objectives are at most, positive, infinite where they may be anything.
    pub fn new(inner: &'a dyn Problem, most: &[f64]) -> Self {
        let limits = most.iter().copied().enumerate();
        Self {
            inner,
            most: limits.filter(|(_, most)| most.is_finite()).collect(),
        }
    }

    /// What a design is worth by the problem itself.
    pub fn without(&self, mut evaluation: Evaluation) -> Evaluation {
        evaluation.constraints.truncate(self.inner.constraints());
        evaluation
    }

    /// The same beside what its limits make of it.
    pub fn with(&self, mut evaluation: Evaluation) -> Evaluation {
        if evaluation.is_defined() {
            let own = &evaluation.objectives;
            let over = self.most.iter().map(|(k, most)| over(own[*k] / most));
            evaluation
                .constraints
                .extend(over.map(|it| it.value).collect::<Vec<_>>());
        }
        evaluation
    }
}

/// How far a value is over one, at most zero below it, and its derivative.
struct Over {
    value: f64,
    slope: f64,
}

/// Above one its logarithm, so that linear steps lead down from a pole.
fn over(part: f64) -> Over {
    let (value, slope) = match part > 1.0 {
        true => (math::ln(part), 1.0 / part),
        false => (part - 1.0, 1.0),
    };
    Over { value, slope }
}

impl Problem for Within<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.inner.bounds()
    }

    fn objectives(&self) -> usize {
        self.inner.objectives()
    }

    fn constraints(&self) -> usize {
        self.inner.constraints() + self.most.len()
    }

    fn scales(&self) -> Option<Scales> {
        let mut scales = self.inner.scales()?;
        scales.constraints.extend(self.most.iter().map(|_| 1.0));
        Some(scales)
    }

    fn least(&self) -> f64 {
        self.inner.least()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        match constraint < self.inner.constraints() {
            true => self.inner.least_of(constraint),
            false => f64::NEG_INFINITY,
        }
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.with(problem::evaluate(self.inner, design))
    }

    fn nearly(&self, designs: &[Vec<f64>], workers: &dyn Workers) -> Vec<Evaluation> {
        let all = self.inner.nearly(designs, workers).into_iter();
        all.map(|it| self.with(it)).collect()
    }

    fn exactly(&self, design: &[f64]) -> Option<Evaluation> {
        self.inner.exactly(design).map(|it| self.with(it))
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let mut slopes = self.inner.slopes(design)?;
        for (k, most) in &self.most {
            let pieces = slopes.objectives.get(*k)?.iter().map(|piece| {
                let Over { value, slope } = over(piece.value / most);
                Piece {
                    value,
                    slope: piece.slope.iter().map(|g| g / most * slope).collect(),
                }
            });
            let pieces = pieces.collect();
            slopes.constraints.push(pieces);
        }
        Some(slopes)
    }
}
