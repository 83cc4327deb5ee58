//! Problems with derivatives by dual numbers.
#![allow(dead_code)]

use kempe_number::{Dual, Number};
use kempe_optimize::{Evaluation, Piece, Problem, Slopes};

/// A number with derivatives to at most ten variables.
pub type D = Dual<f64, 10>;

/// Pieces of every function at a place; none where it is not defined.
pub type Functions = fn(&[D]) -> Option<Vec<Vec<D>>>;

/// A problem of functions: the objectives first.
pub struct Given {
    pub bounds: Vec<[f64; 2]>,
    pub objectives: usize,
    pub constraints: usize,
    pub functions: Functions,
    /// Designs that were evaluated.
    pub asked: usize,
}

impl Given {
    pub fn new(
        bounds: &[[f64; 2]],
        [objectives, constraints]: [usize; 2],
        functions: Functions,
    ) -> Self {
        Self {
            bounds: bounds.to_vec(),
            objectives,
            constraints,
            functions,
            asked: 0,
        }
    }

    fn at(&self, design: &[f64]) -> Option<Vec<Vec<D>>> {
        let x: Vec<D> = (design.iter().enumerate())
            .map(|(k, x)| {
                let mut eps = [0.0; 10];
                eps[k] = 1.0;
                D { re: *x, eps }
            })
            .collect();
        (self.functions)(&x)
    }
}

impl Problem for Given {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.objectives
    }

    fn constraints(&self) -> usize {
        self.constraints
    }

    fn evaluate(&mut self, designs: &[Vec<f64>]) -> Vec<Evaluation> {
        self.asked += designs.len();
        let one = |design: &Vec<f64>| {
            let Some(all) = self.at(design) else {
                return Evaluation::lacking(1.0);
            };
            let largest = |pieces: &Vec<D>| {
                pieces
                    .iter()
                    .map(|p| p.re)
                    .fold(f64::NEG_INFINITY, f64::max)
            };
            let mut objectives: Vec<f64> = all.iter().map(largest).collect();
            let constraints = objectives.split_off(self.objectives);
            Evaluation {
                objectives,
                constraints,
                lack: 0.0,
            }
        };
        designs.iter().map(one).collect()
    }

    fn slopes(&mut self, design: &[f64]) -> Option<Slopes> {
        let n = design.len();
        let piece = |p: &D| Piece {
            value: p.re,
            slope: p.eps[..n].to_vec(),
        };
        let all = self.at(design)?;
        let mut objectives: Vec<Vec<Piece>> = (all.iter())
            .map(|pieces| pieces.iter().map(piece).collect())
            .collect();
        let constraints = objectives.split_off(self.objectives);
        Some(Slopes {
            objectives,
            constraints,
        })
    }
}

/// A plain number among them.
pub fn c(x: f64) -> D {
    D::from_f64(x)
}

pub fn sq(x: D) -> D {
    x * x
}
