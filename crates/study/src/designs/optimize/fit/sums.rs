//! A fit as the sums of squares that descents go down, and in what an optimum of one counts.

use kempe_model::OptimizeStudy;
use kempe_optimize::{Evaluation, Linear, Piece, Problem, Scales, Slopes, Squares};

use super::super::designs::Designs;
use super::fitted::{Fitted, Pairing};
use super::met::square;

/// Misses below this part of the size of what is given count as this part: where a fit is exact, rounding leaves nothing to go by.
const EXACT: f64 = 1e-6;
/// Where a motion starts at a dead point slopes are without bound, and nothing would count in their size: they count as so far beside it, in parts of the bounds.
const BESIDE: f64 = 1e-3;

/// A fit as sums of squares, its places paired in one way.
pub(super) struct Sums<'p, 'b, 'm> {
    pub problem: &'p Designs<'b, 'm>,
    pub fit: &'p Fitted<'b, 'm>,
    pub pairing: Pairing,
}

impl Pairing {
    /// How the journal tells it.
    fn number(self) -> u64 {
        match self {
            Self::Asked => 1,
            Self::Leading => 2,
        }
    }
}

impl Sums<'_, '_, '_> {
    /// The sum of squares of parameters, SI, and what must be kept: as a search chooses among designs, where the pairing is that of the file.
    fn numbers(&self, values: &[f64]) -> Evaluation {
        match self.pairing {
            Pairing::Asked => self.problem.look(values).0,
            Pairing::Leading => self.problem.told_as(values, self.pairing).0.0,
        }
    }

    /// The residuals of parameters, SI, and what must be kept, with their derivatives to the variables.
    fn slopes(&self, values: &[f64]) -> Option<Slopes> {
        let mut slopes = Slopes {
            objectives: vec![self.problem.residuals(values, self.pairing)?],
            constraints: self.problem.limits(values)?,
        };
        let growth = self.problem.growth(values);
        let pieces = slopes.objectives.iter_mut().chain(&mut slopes.constraints);
        for piece in pieces.flatten() {
            let slope = piece.slope.iter_mut().zip(&growth);
            slope.for_each(|(d, growth)| *d *= growth);
        }
        Some(slopes)
    }
}

impl Squares for Sums<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn square(&self, design: &[f64]) -> Option<(f64, Vec<f64>)> {
        self.problem.count(1, 0);
        let values = self.problem.values(design);
        let of = self.pairing.number();
        let journal = &self.problem.journal;
        let (told, _) = journal.evaluation(of, &values, || (self.numbers(&values), None));
        told.is_defined()
            .then(|| (told.objectives[0], told.constraints))
    }

    fn linear(&self, design: &[f64]) -> Option<Linear> {
        self.problem.count(0, 1);
        let values = self.problem.values(design);
        let of = self.pairing.number();
        let slopes = self
            .problem
            .journal
            .slopes(of, &values, || self.slopes(&values))?;
        Some(Linear {
            residuals: slopes.objectives.into_iter().next()?,
            constraints: slopes.constraints,
        })
    }
}

/// A fit as methods see it, with the scales in which an optimum of it counts.
pub(super) struct Scaled<'p, 'b, 'm> {
    pub problem: &'p Designs<'b, 'm>,
    pub scales: Option<Scales>,
}

impl Problem for Scaled<'_, '_, '_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn constraints(&self) -> usize {
        self.problem.constraints()
    }

    fn scales(&self) -> Option<Scales> {
        self.scales.clone()
    }

    fn least_of(&self, constraint: usize) -> f64 {
        self.problem.least_of(constraint)
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.problem.evaluate(design)
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        self.problem.slopes(design)
    }
}

/// The fit at a design with the scales in which an optimum there counts: the product of misses and slopes, so that 1 is a slope along which all of the
/// misses vanishes, whatever the width of the box.
pub(super) fn scaled<'p, 'b, 'm>(sums: &Sums<'p, 'b, 'm>, design: &[f64]) -> Scaled<'p, 'b, 'm> {
    Scaled {
        problem: sums.problem,
        scales: scales(sums, design),
    }
}

fn scales(sums: &Sums<'_, '_, '_>, design: &[f64]) -> Option<Scales> {
    let linear = sums.linear(design)?;
    let squares = linear.residuals.iter().map(|r| r.value * r.value);
    let missed = squares.sum::<f64>().sqrt();
    let all = sums.fit.given.places.iter().map(square);
    let size = all.fold(0.0, f64::max).sqrt();
    let bounds = sums.bounds();
    let over = |piece: &Piece| {
        let all = piece.slope.iter().zip(bounds);
        let all = all.map(|(d, [low, high])| (d * (high - low)).abs());
        all.fold(0.0, f64::max)
    };
    let longest = |linear: &Linear| {
        let all = bounds.iter().enumerate().map(|(k, [low, high])| {
            let squares = linear.residuals.iter().map(|r| r.slope[k] * r.slope[k]);
            squares.sum::<f64>().sqrt() * (high - low)
        });
        all.fold(0.0, f64::max)
    };
    let beside = [1.0, -1.0].into_iter().filter_map(|side| {
        let all = design.iter().zip(bounds);
        let there = all.map(|(x, [low, high])| {
            let by = side * BESIDE * ((low + high) / 2.0 - x);
            (x + by).clamp(*low, *high)
        });
        sums.linear(&there.collect::<Vec<f64>>())
    });
    let longest = beside
        .map(|it| longest(&it))
        .fold(longest(&linear), f64::min);
    let positive = |size: f64| if size > 0.0 { size } else { 1.0 };
    let constraints = linear.constraints.iter().map(|pieces| {
        let sizes = pieces.iter().map(|p| over(p).max(p.value.abs()));
        positive(sizes.fold(0.0, f64::max))
    });
    Some(Scales {
        objectives: vec![positive(2.0 * missed.max(EXACT * size) * longest)],
        constraints: constraints.collect(),
    })
}

/// What is asked of a study's fit, its places paired so; none where nothing is fitted.
pub(super) fn sums<'p, 'b, 'm>(
    problem: &'p Designs<'b, 'm>,
    pairing: Pairing,
) -> Option<Sums<'p, 'b, 'm>> {
    Some(Sums {
        problem,
        fit: problem.fit.as_ref()?,
        pairing,
    })
}

/// Whether a study asks for nothing but the descent from its own design.
pub(super) fn is_alone(study: &OptimizeStudy) -> bool {
    study.method == Some(kempe_model::OptimizeMethod::Local)
}
