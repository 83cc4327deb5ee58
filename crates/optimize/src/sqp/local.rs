//! All pieces at a design, in their scales and in parts of the box, and the quadratic programmes made of them.

use crate::problem::{Evaluation, Piece, Scales, Slopes, largest, sound_scale};
use crate::quadratic::{Minimum, Quadratic, Row};
use crate::space::Space;

use super::edge::Edge;
use super::optimum::Multipliers;
use super::vector::{diagonal, dot};

/// Of programmes that look only for feasibility, or at slopes alone: a curvature so small that it decides only between steps that are as good.
const FLAT: f64 = 1e-6;

/// By what functions are divided: all objectives by the same, so that the largest stays the largest.
#[derive(Clone, Debug)]
pub(super) struct Sizes {
    pub objective: f64,
    pub constraints: Vec<f64>,
}

impl Sizes {
    pub fn new(scales: &Scales) -> Self {
        Self {
            objective: sound_scale(largest(scales.objectives.iter().copied())),
            constraints: scales.constraints.clone(),
        }
    }

    /// The larger of value and slope over the box.
    pub fn of(slopes: &Slopes, space: &Space) -> Scales {
        let of = |pieces: &Vec<Piece>| {
            let sizes = pieces.iter().map(|p| {
                let slopes = p
                    .slope
                    .iter()
                    .zip(&space.widths)
                    .map(|(g, w)| (g * w).abs());
                largest(slopes).max(p.value.abs())
            });
            sound_scale(largest(sizes))
        };
        Scales {
            objectives: slopes.objectives.iter().map(of).collect(),
            constraints: slopes.constraints.iter().map(of).collect(),
        }
    }
}

/// Of what function something is a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    Objective(usize),
    Constraint(usize),
    /// Of the edge of what can be evaluated: by how much it is passed.
    Edge,
}

/// A piece in its scale, with its slopes over the box.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub of: Of,
    pub value: f64,
    pub slope: Vec<f64>,
}

impl Part {
    /// Its value after a step, as its slope has it.
    pub fn after(&self, step: &[f64]) -> f64 {
        self.value + dot(&self.slope, step)
    }

    /// Which of other parts, a step away, is this one: the one of the same function whose value is what the mean of both slopes promises. For
    /// the same smooth function that misses by the step's cube, for another one by its size. A difference of the slopes themselves
    /// counts a little, so that two peaks of one height are told apart.
    pub fn among(&self, others: &[Part], step: &[f64]) -> Option<usize> {
        const TURNED: f64 = 0.1;
        let size = dot(step, step).sqrt();
        let same = others.iter().enumerate().filter(|(_, p)| p.of == self.of);
        let far = same.map(|(k, p)| {
            let mean = (dot(&self.slope, step) + dot(&p.slope, step)) / 2.0;
            let turned: f64 = (self.slope.iter().zip(&p.slope))
                .map(|(a, b)| (a - b) * (a - b))
                .sum();
            (
                k,
                (p.value - self.value - mean).abs() + TURNED * turned.sqrt() * size,
            )
        });
        far.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
    }
}

/// A design with all that is known there.
#[derive(Clone, Debug)]
pub(super) struct Local {
    pub design: Vec<f64>,
    pub evaluation: Evaluation,
    /// The largest objective, scaled.
    pub objective: f64,
    /// The largest violation, scaled, zero where all is kept.
    pub violation: f64,
    /// Those of objectives first, that of the edge last.
    pub parts: Vec<Part>,
    /// The edge of what can be evaluated that is known beside it.
    pub edge: Option<Edge>,
}

impl Local {
    pub fn new(
        design: Vec<f64>,
        evaluation: Evaluation,
        slopes: &Slopes,
        sizes: &Sizes,
        space: &Space,
    ) -> Self {
        let part = |of: Of, p: &Piece, size: f64| Part {
            of,
            value: p.value / size,
            slope: (p.slope.iter().zip(&space.widths))
                .map(|(g, w)| g * w / size)
                .collect(),
        };
        let mut parts = Vec::new();
        for (k, pieces) in slopes.objectives.iter().enumerate() {
            parts.extend(
                pieces
                    .iter()
                    .map(|p| part(Of::Objective(k), p, sizes.objective)),
            );
        }
        for (k, pieces) in slopes.constraints.iter().enumerate() {
            parts.extend(
                pieces
                    .iter()
                    .map(|p| part(Of::Constraint(k), p, sizes.constraints[k])),
            );
        }
        let (objective, violation) = scaled(&evaluation, sizes);
        Self {
            design,
            evaluation,
            objective,
            violation,
            parts,
            edge: None,
        }
    }

    /// The same, beside an edge.
    pub fn beside(mut self, edge: Option<Edge>, space: &Space) -> Self {
        self.parts.retain(|part| part.of != Of::Edge);
        if let Some(edge) = &edge {
            self.parts.push(Part {
                of: Of::Edge,
                value: edge.passed(&space.unit(&self.design)).min(0.0),
                slope: edge.normal.clone(),
            });
        }
        self.edge = edge;
        self
    }

    /// What the edge holds it by, of the multipliers of a programme's rows.
    pub fn held_by_edge(&self, rows: &[f64]) -> f64 {
        let both = self.parts.iter().zip(rows);
        let own = both.filter(|(part, _)| part.of == Of::Edge);
        own.map(|(_, m)| *m).fold(0.0, |sum, m| sum + m)
    }

    /// The parts of objectives.
    fn of_objectives(&self) -> impl Iterator<Item = &Part> {
        (self.parts.iter()).filter(|p| matches!(p.of, Of::Objective(_)))
    }

    /// The parts of constraints.
    fn of_constraints(&self) -> impl Iterator<Item = &Part> {
        (self.parts.iter()).filter(|p| matches!(p.of, Of::Constraint(_)))
    }

    /// The largest of the objective's parts.
    pub fn top(&self) -> f64 {
        largest(self.of_objectives().map(|p| p.value))
    }

    /// Whether anything is constrained.
    pub fn has_constraints(&self) -> bool {
        self.of_constraints().next().is_some()
    }

    /// What steps must lessen.
    pub fn penalty(&self, weight: f64) -> f64 {
        self.objective + weight * self.violation
    }

    /// The size of the numbers that the objective is made of, as far as is known.
    pub fn size(&self) -> f64 {
        self.objective.abs()
    }

    /// The penalty that the linearised parts have after a step.
    pub fn promised(&self, minimum: &Minimum, weight: f64) -> f64 {
        let step = &minimum.step;
        let objective = largest(self.of_objectives().map(|p| p.after(step)));
        let violation = largest(self.of_constraints().map(|p| p.after(step)));
        // Parts and value may differ by rounding.
        let drift = self.objective - self.top();
        objective + drift + weight * violation.max(0.0)
    }

    /// The step: the objective's linearised parts below the first level, the constraints' below the second, with this curvature, no
    /// component larger than the radius.
    pub fn programme(&self, hessian: &[f64], weight: f64, space: &Space, radius: f64) -> Quadratic {
        self.shifted(hessian, weight, (space, radius), &[], &[])
    }

    /// The same, without a curvature that counts.
    pub fn flat(&self, weight: f64, space: &Space) -> Quadratic {
        let hessian = diagonal(self.design.len(), FLAT);
        self.programme(&hessian, weight, space, f64::INFINITY)
    }

    /// The same, with the values of parts changed by `shifts` (none, or one for each), and with more parts.
    pub fn shifted(
        &self,
        hessian: &[f64],
        weight: f64,
        (space, radius): (&Space, f64),
        shifts: &[f64],
        more: &[Part],
    ) -> Quadratic {
        let n = self.design.len();
        let top = self.top();
        let shifts = shifts.iter().copied().chain(std::iter::repeat(0.0));
        let row = |(part, shift): (&Part, f64)| match part.of {
            Of::Objective(_) => row(&part.slope, top - part.value - shift, Some(0)),
            Of::Constraint(_) => row(&part.slope, -part.value - shift, Some(1)),
            Of::Edge => row(&part.slope, -part.value, None),
        };
        let mut rows: Vec<Row> = self.parts.iter().zip(shifts).map(row).collect();
        let mut weights = vec![1.0];
        self.bound_rows(space, radius, &mut rows);
        rows.extend(more.iter().map(|p| row((p, 0.0))));
        if self.has_constraints() {
            weights.push(weight);
            rows.push(self::row(&vec![0.0; n], 0.0, Some(1)));
        }
        Quadratic {
            hessian: hessian.to_vec(),
            slope: vec![0.0; n],
            weights,
            rows,
        }
    }

    /// The step that lessens the largest linearised violation most.
    pub fn feasibility(&self, space: &Space, radius: f64) -> Quadratic {
        let n = self.design.len();
        let rows = self.parts.iter().filter_map(|p| match p.of {
            Of::Objective(_) => None,
            Of::Constraint(_) => Some(row(&p.slope, -p.value, Some(0))),
            Of::Edge => Some(row(&p.slope, -p.value, None)),
        });
        let mut rows: Vec<Row> = rows.collect();
        self.bound_rows(space, radius, &mut rows);
        rows.push(row(&vec![0.0; n], 0.0, Some(0)));
        Quadratic {
            hessian: diagonal(n, FLAT),
            slope: vec![0.0; n],
            weights: vec![1.0],
            rows,
        }
    }

    /// The box: the least, then the largest value of every variable that has a width, no farther than a radius.
    fn bound_rows(&self, space: &Space, radius: f64, rows: &mut Vec<Row>) {
        let n = self.design.len();
        for (k, x) in self.design.iter().enumerate() {
            let ([low, high], width) = (space.bounds[k], space.widths[k]);
            if width > 0.0 {
                let unit = |sign: f64| {
                    (0..n)
                        .map(|j| if j == k { sign } else { 0.0 })
                        .collect::<Vec<_>>()
                };
                rows.push(row(&unit(-1.0), ((x - low) / width).min(radius), None));
                rows.push(row(&unit(1.0), ((high - x) / width).min(radius), None));
            }
        }
    }

    /// How far the first-order conditions are missed here with these multipliers; `bent` is the curvature times the step, which the
    /// Lagrangian's slope is the opposite of.
    pub fn residual(&self, minimum: &Minimum, bent: &[f64], space: &Space, radius: f64) -> f64 {
        let top = self.top();
        let missed = self
            .parts
            .iter()
            .zip(&minimum.multipliers)
            .map(|(p, m)| match p.of {
                Of::Objective(_) => m * (top - p.value),
                Of::Constraint(_) => m * (self.violation - p.value),
                Of::Edge => m * -p.value,
            });
        let mut missed = missed.fold(0.0, |sum, x| sum + x);
        let mut slopes = bent.to_vec();
        let mut bounds = minimum.multipliers[self.parts.len()..].iter();
        for (k, d) in minimum.step.iter().enumerate() {
            let ([low, high], width) = (space.bounds[k], space.widths[k]);
            if width > 0.0 {
                for (sign, room) in [(-1.0, self.design[k] - low), (1.0, high - self.design[k])] {
                    let m = bounds.next().copied().unwrap_or(0.0);
                    match room > radius * width {
                        // The radius is no bound of the problem.
                        true => slopes[k] += sign * m,
                        // What a step that a bound ends uses up is the room that was left.
                        false => missed += m * d.abs(),
                    }
                }
            }
        }
        largest(slopes.iter().map(|x| x.abs())).max(missed)
    }

    /// Directions that a step may not go without leaving what holds the design, by multipliers larger than `least`: slopes of constraints, what
    /// slopes of the objective's parts differ by, and variables on their bounds or without room.
    pub fn held(&self, minimum: &Minimum, least: f64, space: &Space) -> Vec<Vec<f64>> {
        let unit = |k: usize| (0..self.design.len()).map(move |j| f64::from(u8::from(j == k)));
        let mut held: Vec<Vec<f64>> = Vec::new();
        let mut first: Option<&[f64]> = None;
        for (part, m) in self.parts.iter().zip(&minimum.multipliers) {
            match (part.of, first) {
                _ if *m <= least => {}
                (Of::Constraint(_) | Of::Edge, _) => held.push(part.slope.clone()),
                (Of::Objective(_), None) => first = Some(&part.slope),
                (Of::Objective(_), Some(first)) => {
                    held.push(first.iter().zip(&part.slope).map(|(a, b)| a - b).collect());
                }
            }
        }
        let mut bounds = minimum.multipliers[self.parts.len()..].iter();
        for (k, width) in space.widths.iter().enumerate() {
            let mut holds = || bounds.next().is_some_and(|m| *m > least);
            if !(*width > 0.0) || [holds(), holds()].contains(&true) {
                held.push(unit(k).collect());
            }
        }
        held
    }

    /// The multipliers of a programme's rows in the units of the problem; zeros without one.
    pub fn multipliers(&self, rows: Option<&[f64]>, sizes: &Sizes, space: &Space) -> Multipliers {
        let mut all = Multipliers {
            objectives: vec![Vec::new(); self.evaluation.objectives.len()],
            constraints: vec![Vec::new(); self.evaluation.constraints.len()],
            bounds: vec![[0.0; 2]; self.design.len()],
        };
        let of = |row: usize| rows.and_then(|rows| rows.get(row)).copied().unwrap_or(0.0);
        for (row, part) in self.parts.iter().enumerate() {
            match part.of {
                Of::Objective(k) => all.objectives[k].push(of(row)),
                Of::Constraint(k) => {
                    let unit = sizes.objective / sizes.constraints[k];
                    all.constraints[k].push(of(row) * unit);
                }
                Of::Edge => {}
            }
        }
        let mut row = self.parts.len();
        for (bounds, width) in all.bounds.iter_mut().zip(&space.widths) {
            if *width > 0.0 {
                *bounds = [row, row + 1].map(|row| of(row) * sizes.objective / width);
                row += 2;
            }
        }
        all
    }
}

/// The largest objective and violation, scaled.
pub(super) fn scaled(evaluation: &Evaluation, sizes: &Sizes) -> (f64, f64) {
    let constraints = evaluation.constraints.iter().zip(&sizes.constraints);
    let violation = largest(constraints.map(|(c, s)| c / s)).max(0.0);
    (evaluation.largest() / sizes.objective, violation)
}

/// A row of a programme.
fn row(normal: &[f64], limit: f64, level: Option<usize>) -> Row {
    Row {
        normal: normal.to_vec(),
        limit,
        level,
    }
}
