//! Sums of squares within a box, with what must be kept: the Gauss-Newton method with K. Levenberg's (1944) and D. Marquardt's (1963) damping.
//!
//! Each step minimises the linearised residuals' squares, damped, with the linearised pieces of the constraints as an elastic level beside them: a quadratic
//! programme that always has a minimum. It leads from far away to near an optimum in few steps; what hangs on what there, and how exactly it is one, is for
//! [`sqp`](crate::sqp) to say.

use crate::problem::{Piece, largest, sound_scale};
use crate::quadratic::{Quadratic, Row, minimise};
use crate::space::Space;

/// What squares are to be small of. What a design is worth hangs on the design alone, so that several may be asked at once.
pub trait Squares: Sync {
    /// The least and the largest value of every variable, finite.
    fn bounds(&self) -> &[[f64; 2]];

    /// The sum of squares, and the constraints, which must be at most zero; `None` where they are not defined.
    fn square(&self, design: &[f64]) -> Option<(f64, Vec<f64>)>;

    /// All of it with its derivatives; `None` where there are none.
    fn linear(&self, design: &[f64]) -> Option<Linear>;
}

/// Residuals and constraints at a design, with their derivatives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    /// The residuals, each with its slope. Where some unknowns are eliminated, slopes are those that are left when these follow.
    pub residuals: Vec<Piece>,
    /// Pieces of every constraint.
    pub constraints: Vec<Vec<Piece>>,
}

/// Where a descent ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// The design.
    pub design: Vec<f64>,
    /// Its sum of squares.
    pub square: f64,
    /// Its constraints: kept where not positive.
    pub constraints: Vec<f64>,
    /// The largest violation of one of these, in its scale.
    pub violation: f64,
    /// Whether no step lessens it any more.
    pub settled: bool,
    /// Designs evaluated, and those whose derivatives were taken.
    pub evaluations: usize,
    /// See [`evaluations`](Self::evaluations).
    pub slopes: usize,
}

/// Damping, as a part of the columns' size: at the start, and beyond which no step helps.
const DAMPING: f64 = 1e-2;
const MOST_DAMPING: f64 = 1e9;
const LEAST_DAMPING: f64 = 1e-10;
/// By what damping falls after a step that was good, and rises after one that was not.
const EASED: f64 = 0.2;
const RAISED: f64 = 6.0;
/// A column is at least this part of the longest for its damping.
const SHORT_COLUMN: f64 = 1e-4;
/// Squares that fall by less than this part twice in a row are settled.
const SETTLED: f64 = 1e-12;
/// Along curved constraints steps that know no curvature of theirs creep: such parts so often in a row, and the rest is for others.
const CREEPING: f64 = 1e-5;
const CREEPS: usize = 4;
/// The weight of the largest violation beside the squares, in parts of these; it rises by the factor where that is too little.
const WEIGHT: f64 = 10.0;
const WEIGHT_FACTOR: f64 = 10.0;
const MOST_WEIGHT: f64 = 1e8;
/// The part of the violation that a step must be able to take away.
const STEERED: f64 = 0.5;
/// A violation below this, in its scale, is none.
const KEPT: f64 = 1e-10;

/// Goes down from a design for so many steps at most; `None` where nothing is known there.
pub fn least_squares(problem: &dyn Squares, start: &[f64], steps: usize) -> Option<Descent> {
    let space = Space::new(problem.bounds());
    if !space.holds(start.len()) {
        return None;
    }
    let design = space.within(start);
    let (square, constraints) = problem.square(&design)?;
    let linear = problem.linear(&design)?;
    let scales: Vec<f64> = (linear.constraints.iter())
        .map(|pieces| scale(pieces, &space))
        .collect();
    let mut at = At {
        violation: violation(&constraints, &scales),
        design,
        square,
        constraints,
    };
    let mut descent = Descent {
        design: Vec::new(),
        square,
        constraints: Vec::new(),
        violation: at.violation,
        settled: false,
        evaluations: 1,
        slopes: 1,
    };
    let (mut damping, mut weight, mut small, mut creeps) = (DAMPING, WEIGHT, 0, 0);
    let mut local = Some(linear);
    for _ in 0..steps {
        if !(at.square > 0.0) && at.violation <= KEPT {
            descent.settled = true;
            break;
        }
        let linear = match local.take() {
            Some(linear) => linear,
            None => {
                descent.slopes += 1;
                match problem.linear(&at.design) {
                    Some(linear) => linear,
                    None => break,
                }
            }
        };
        let step = step(&linear, &at, &space, &scales, damping, &mut weight);
        let next = step.map(|step| space.moved(&at.design, &step, 1.0));
        let next = next.filter(|next| *next != at.design);
        let there = next.and_then(|design| {
            descent.evaluations += 1;
            let (square, constraints) = problem.square(&design)?;
            Some(At {
                violation: violation(&constraints, &scales),
                design,
                square,
                constraints,
            })
        });
        let merit = |it: &At| it.square / at.square.max(f64::MIN_POSITIVE) + weight * it.violation;
        match there {
            Some(there) if merit(&there) < merit(&at) => {
                let fell = merit(&at) - merit(&there);
                small = if fell <= SETTLED { small + 1 } else { 0 };
                creeps = if fell <= CREEPING { creeps + 1 } else { 0 };
                at = there;
                damping = (damping * EASED).max(LEAST_DAMPING);
                if small > 1 {
                    descent.settled = true;
                    break;
                }
                if creeps > CREEPS && !scales.is_empty() {
                    break;
                }
            }
            _ => {
                local = Some(linear);
                damping *= RAISED;
                if damping > MOST_DAMPING {
                    descent.settled = true;
                    break;
                }
            }
        }
    }
    descent.design = at.design;
    descent.square = at.square;
    descent.constraints = at.constraints;
    descent.violation = at.violation;
    Some(descent)
}

/// A design with what it is worth.
struct At {
    design: Vec<f64>,
    square: f64,
    constraints: Vec<f64>,
    violation: f64,
}

/// The size of a constraint: the larger of its value and its slope over the box.
fn scale(pieces: &[Piece], space: &Space) -> f64 {
    let sizes = pieces.iter().map(|piece| {
        let slopes = piece.slope.iter().zip(&space.widths);
        largest(slopes.map(|(g, w)| (g * w).abs())).max(piece.value.abs())
    });
    sound_scale(largest(sizes))
}

fn violation(constraints: &[f64], scales: &[f64]) -> f64 {
    largest(constraints.iter().zip(scales).map(|(c, s)| c / s)).max(0.0)
}

/// The step that minimises the damped squares, in parts of the box.
fn step(
    linear: &Linear,
    at: &At,
    space: &Space,
    scales: &[f64],
    damping: f64,
    weight: &mut f64,
) -> Option<Vec<f64>> {
    let n = at.design.len();
    let size = at.square.max(f64::MIN_POSITIVE).sqrt();
    let scaled = |piece: &Piece, by: f64| -> Vec<f64> {
        let slopes = piece.slope.iter().zip(&space.widths);
        slopes.map(|(g, w)| g * w / by).collect()
    };
    let mut hessian = vec![0.0; n * n];
    let mut slope = vec![0.0; n];
    for residual in &linear.residuals {
        let (value, row) = (residual.value / size, scaled(residual, size));
        for (i, a) in row.iter().enumerate() {
            slope[i] += 2.0 * a * value;
            for (j, b) in row.iter().enumerate() {
                hessian[i * n + j] += 2.0 * a * b;
            }
        }
    }
    let longest = (0..n).map(|i| hessian[i * n + i]).fold(0.0, f64::max);
    if !(longest > 0.0) {
        return None;
    }
    for i in 0..n {
        let own = hessian[i * n + i].max(SHORT_COLUMN * longest);
        hessian[i * n + i] += damping * own;
    }
    let mut rows: Vec<Row> = Vec::new();
    for (pieces, scale) in linear.constraints.iter().zip(scales) {
        rows.extend(pieces.iter().map(|piece| Row {
            normal: scaled(piece, *scale),
            limit: -piece.value / scale,
            level: Some(0),
        }));
    }
    let elastic = !rows.is_empty();
    for (k, x) in at.design.iter().enumerate() {
        let ([low, high], width) = (space.bounds[k], space.widths[k]);
        let unit = |sign: f64| (0..n).map(|j| if j == k { sign } else { 0.0 }).collect();
        let room = |room: f64| if width > 0.0 { room / width } else { 0.0 };
        for (sign, limit) in [(-1.0, room(x - low)), (1.0, room(high - x))] {
            rows.push(Row {
                normal: unit(sign),
                limit,
                level: None,
            });
        }
    }
    if elastic {
        // The violation is never below nothing.
        rows.push(Row {
            normal: vec![0.0; n],
            limit: 0.0,
            level: Some(0),
        });
    }
    let mut programme = Quadratic {
        hessian,
        slope,
        weights: if elastic { vec![*weight] } else { Vec::new() },
        rows,
    };
    loop {
        let minimum = minimise(&programme).ok()?;
        let left = minimum.levels.first().copied().unwrap_or(0.0);
        let enough = left <= KEPT.max(STEERED * at.violation);
        if !elastic || enough || *weight >= MOST_WEIGHT {
            return Some(minimum.step);
        }
        *weight *= WEIGHT_FACTOR;
        programme.weights = vec![*weight];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H. H. Rosenbrock's valley (1960), with what x and y must sum to at most.
    struct Valley {
        bounds: [[f64; 2]; 2],
        most: Option<f64>,
    }

    impl Valley {
        fn kept(&self, at: &[f64]) -> Vec<f64> {
            self.most
                .map(|most| at[0] + at[1] - most)
                .into_iter()
                .collect()
        }
    }

    impl Squares for Valley {
        fn bounds(&self) -> &[[f64; 2]] {
            &self.bounds
        }

        fn square(&self, at: &[f64]) -> Option<(f64, Vec<f64>)> {
            let [a, b] = [10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]];
            Some((a * a + b * b, self.kept(at)))
        }

        fn linear(&self, at: &[f64]) -> Option<Linear> {
            let piece = |value: f64, slope: [f64; 2]| Piece {
                value,
                slope: slope.to_vec(),
            };
            let kept = self.kept(at).into_iter();
            Some(Linear {
                residuals: vec![
                    piece(10.0 * (at[1] - at[0] * at[0]), [-20.0 * at[0], 10.0]),
                    piece(1.0 - at[0], [-1.0, 0.0]),
                ],
                constraints: kept.map(|c| vec![piece(c, [1.0, 1.0])]).collect(),
            })
        }
    }

    #[test]
    fn a_valley_is_followed_to_its_end() {
        let valley = Valley {
            bounds: [[-5.0, 5.0]; 2],
            most: None,
        };
        let found = least_squares(&valley, &[-1.2, 1.0], 200).expect("a minimum");
        assert!(
            found.design.iter().all(|x| (x - 1.0).abs() < 1e-9),
            "{found:?}"
        );
        assert!(found.square < 1e-20 && found.settled);
    }

    #[test]
    fn bounds_are_kept_and_slid_along() {
        let valley = Valley {
            bounds: [[-2.0, 0.5], [-2.0, 2.0]],
            most: None,
        };
        let found = least_squares(&valley, &[-1.2, 1.0], 200).expect("a minimum");
        assert_eq!(found.design[0], 0.5);
        assert!((found.design[1] - 0.25).abs() < 1e-6, "{found:?}");
    }

    /// On the line x + y = 1 the valley's floor is where the golden section is; the exact place is from a fine search.
    #[test]
    fn constraints_are_kept() {
        let valley = Valley {
            bounds: [[-2.0, 2.0]; 2],
            most: Some(1.0),
        };
        let found = least_squares(&valley, &[-1.2, 1.0], 300).expect("a minimum");
        let on_line = |x: f64| valley.square(&[x, 1.0 - x]).map_or(f64::NAN, |(s, _)| s);
        let best = (0..400_000).map(|k| on_line(f64::from(k) * 1e-5 - 2.0));
        let best = best.fold(f64::INFINITY, f64::min);
        assert!(found.violation < 1e-8, "{found:?}");
        assert!(
            (found.square - best).abs() < 1e-6 * best.max(1e-3),
            "{found:?} {best}"
        );
    }
}
