//! Test problems from formulas on dual numbers.
#![allow(dead_code, reason = "every test file takes what it needs")]

pub mod hock_schittkowski;
pub mod zdt;

use std::sync::atomic::{AtomicUsize, Ordering};

use kempe_number::Dual;
use kempe_optimize::{Evaluation, Piece, Problem, Slopes, Task, Workers};

/// A number with its derivatives.
pub type D<const N: usize> = Dual<f64, N>;

/// Pieces of every objective and of every constraint; `None` where undefined.
pub type Functions<const N: usize> = (Vec<Vec<D<N>>>, Vec<Vec<D<N>>>);

/// The functions at a design.
pub type Formulas<const N: usize> = dyn Fn(&[D<N>; N]) -> Option<Functions<N>> + Send + Sync;

/// A problem of `N` variables.
pub struct Case<const N: usize> {
    pub bounds: Vec<[f64; 2]>,
    pub objectives: usize,
    pub constraints: usize,
    pub functions: Box<Formulas<N>>,
    /// How many designs were asked.
    pub asked: AtomicUsize,
}

impl<const N: usize> Case<N> {
    /// Smooth objective and constraints.
    pub fn smooth(
        bounds: Vec<[f64; 2]>,
        constraints: usize,
        functions: impl Fn(&[D<N>; N]) -> (D<N>, Vec<D<N>>) + Send + Sync + 'static,
    ) -> Self {
        Self::pieces(bounds, constraints, move |x| {
            let (objective, constraints) = functions(x);
            (
                vec![objective],
                constraints.into_iter().map(|c| vec![c]).collect(),
            )
        })
    }

    /// One objective of pieces, constraints of pieces.
    pub fn pieces(
        bounds: Vec<[f64; 2]>,
        constraints: usize,
        functions: impl Fn(&[D<N>; N]) -> (Vec<D<N>>, Vec<Vec<D<N>>>) + Send + Sync + 'static,
    ) -> Self {
        Self {
            bounds,
            objectives: 1,
            constraints,
            functions: Box::new(move |x| {
                let (objective, constraints) = functions(x);
                Some((vec![objective], constraints))
            }),
            asked: AtomicUsize::new(0),
        }
    }

    fn at(&self, design: &[f64]) -> Option<Functions<N>> {
        (self.functions)(&std::array::from_fn(|k| D::variable(design[k], k)))
    }
}

impl<const N: usize> Problem for Case<N> {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn objectives(&self) -> usize {
        self.objectives
    }

    fn constraints(&self) -> usize {
        self.constraints
    }

    fn evaluate(&self, design: &[f64]) -> Evaluation {
        self.asked.fetch_add(1, Ordering::Relaxed);
        let largest =
            |pieces: &Vec<D<N>>| pieces.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.re));
        for (x, [low, high]) in design.iter().zip(&self.bounds) {
            assert!(low <= x && x <= high, "a design outside of its box: {x}");
        }
        match self.at(design) {
            None => Evaluation::lacking(1.0),
            Some((objectives, constraints)) => Evaluation {
                objectives: objectives.iter().map(largest).collect(),
                constraints: constraints.iter().map(largest).collect(),
                lack: 0.0,
            },
        }
    }

    fn slopes(&self, design: &[f64]) -> Option<Slopes> {
        let piece = |p: &D<N>| Piece {
            value: p.re,
            slope: p.eps.to_vec(),
        };
        let (objectives, constraints) = self.at(design)?;
        let all = |f: Vec<Vec<D<N>>>| {
            f.iter()
                .map(|pieces| pieces.iter().map(piece).collect())
                .collect()
        };
        Some(Slopes {
            objectives: all(objectives),
            constraints: all(constraints),
        })
    }
}

/// A box of the same bounds for every variable.
pub fn cube(n: usize, low: f64, high: f64) -> Vec<[f64; 2]> {
    vec![[low, high]; n]
}

/// Several threads, which take pieces as they come.
pub struct Threads(pub usize);

impl Workers for Threads {
    fn run_heard(&self, tasks: Vec<Task<'_>>, _: &mut dyn FnMut()) {
        let queue = std::sync::Mutex::new(tasks.into_iter());
        let next = || queue.lock().expect("a queue").next();
        std::thread::scope(|scope| {
            for _ in 0..self.0 {
                scope.spawn(|| {
                    while let Some(task) = next() {
                        task();
                    }
                });
            }
        });
    }
}
