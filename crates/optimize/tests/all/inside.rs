//! What constraints cost that leave nothing inside of them.

use kempe_number::Random;
use kempe_optimize::{Alone, Ended, Evaluation, Piece, Problem, Slopes, SqpOptions, silent, sqp};

/// A goal that is linear, with a distance that may be so much at most.
struct Cone {
    most: f64,
}

const BOUNDS: [[f64; 2]; 2] = [[-2.0, 3.0], [-1.0, 2.0]];
const SLOPE: [f64; 2] = [0.7, -2.4];

fn pieces(at: &[f64], most: f64) -> Vec<Piece> {
    let size = (at[0] * at[0] + at[1] * at[1]).sqrt();
    let piece = |slope: [f64; 2]| Piece {
        value: size - most,
        slope: slope.to_vec(),
    };
    match size > 0.0 {
        true => vec![piece([at[0] / size, at[1] / size])],
        // Its corner as differences in each variable see it.
        false => [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]
            .map(piece)
            .to_vec(),
    }
}

impl Problem for Cone {
    fn bounds(&self) -> &[[f64; 2]] {
        &BOUNDS
    }

    fn constraints(&self) -> usize {
        1
    }

    fn least_of(&self, _: usize) -> f64 {
        -self.most
    }

    fn evaluate(&self, at: &[f64]) -> Evaluation {
        let goal: f64 = at.iter().zip(SLOPE).map(|(x, d)| x * d).sum();
        Evaluation {
            objectives: vec![goal],
            constraints: vec![(at[0] * at[0] + at[1] * at[1]).sqrt() - self.most],
            lack: 0.0,
        }
    }

    fn slopes(&self, at: &[f64]) -> Option<Slopes> {
        let goal = Piece {
            value: self.evaluate(at).objectives[0],
            slope: SLOPE.to_vec(),
        };
        Some(Slopes {
            objectives: vec![vec![goal]],
            constraints: vec![pieces(at, self.most)],
        })
    }
}

/// The goal falls by its slope, 2.5, for each unit by which the distance may be longer, from nothing as from more.
#[test]
fn a_distance_of_nothing_costs_the_slope_of_the_goal() {
    for most in [0.0, 1e-9, 1e-4, 0.1] {
        for start in [[0.0, 0.0], [1.5, 1.2], [-1e-10, 1e-10]] {
            let found = sqp(
                &Cone { most },
                &start,
                &SqpOptions::default(),
                &Alone,
                &mut |it| silent(it),
            );
            assert!(found.ended.is_optimal(), "{most} {start:?} {found:?}");
            assert_ne!(found.ended, Ended::Edge);
            let far = found.evaluation.constraints[0];
            assert!(far < 1e-8, "{most} {start:?} {found:?}");
            for cost in [found.multipliers.cost(0), found.eased.cost(0)] {
                assert!((cost - 2.5).abs() < 1e-6, "{most} {start:?}: {cost}");
            }
        }
    }
}

/// A goal that is linear, over three unknowns of which two are to be those of a curve over the first: their distance from it is to be nothing.
struct Along {
    goal: [f64; 3],
    curve: [[f64; 2]; 2],
}

const ALONG: [[f64; 2]; 3] = [[-2.0, 2.0], [-9.0, 9.0], [-9.0, 9.0]];

impl Along {
    /// The curve's two places over the first unknown, and their slopes.
    fn curve(&self, x: f64) -> [[f64; 2]; 2] {
        let [[a, b], [c, d]] = self.curve;
        [
            [a * x + b * x * x, a + 2.0 * b * x],
            [c * x + d * x * x * x, c + 3.0 * d * x * x],
        ]
    }

    /// The goal on the curve.
    fn on_curve(&self, x: f64) -> f64 {
        let [[y, _], [z, _]] = self.curve(x);
        self.goal[0] * x + self.goal[1] * y + self.goal[2] * z
    }
}

impl Problem for Along {
    fn bounds(&self) -> &[[f64; 2]] {
        &ALONG
    }

    fn constraints(&self) -> usize {
        1
    }

    fn least_of(&self, _: usize) -> f64 {
        0.0
    }

    fn evaluate(&self, at: &[f64]) -> Evaluation {
        let slopes = self.slopes(at).expect("slopes");
        let largest = |all: &[Piece]| all.iter().map(|it| it.value).fold(f64::MIN, f64::max);
        Evaluation {
            objectives: vec![largest(&slopes.objectives[0])],
            constraints: vec![largest(&slopes.constraints[0])],
            lack: 0.0,
        }
    }

    fn slopes(&self, at: &[f64]) -> Option<Slopes> {
        let [[y, dy], [z, dz]] = self.curve(at[0]);
        let off = [at[1] - y, at[2] - z];
        let far = (off[0] * off[0] + off[1] * off[1]).sqrt();
        // In its corner no slope at all is known.
        let [a, b] = match far > 0.0 {
            true => off.map(|x| x / far),
            false => [0.0; 2],
        };
        let distance = Piece {
            value: far,
            slope: vec![-a * dy - b * dz, a, b],
        };
        let goal = Piece {
            value: at.iter().zip(self.goal).map(|(x, d)| x * d).sum(),
            slope: self.goal.to_vec(),
        };
        Some(Slopes {
            objectives: vec![vec![goal]],
            constraints: vec![vec![distance]],
        })
    }
}

/// What is told as an optimum along a curve that a limit without an inside keeps is one: beside it on the curve none is better.
#[test]
fn optima_along_a_limit_without_an_inside_are_some() {
    let mut random = Random(11);
    let mut any = |size: f64| size * (2.0 * random.uniform() - 1.0);
    let mut shown = 0;
    for _ in 0..60 {
        let problem = Along {
            goal: [any(2.0), any(1.0), any(1.0)],
            curve: [[any(1.0), any(1.0)], [any(1.0), any(0.5)]],
        };
        let start = [any(2.0), any(5.0), any(5.0)];
        let options = SqpOptions::default();
        let found = sqp(&problem, &start, &options, &Alone, &mut |it| silent(it));
        if !found.ended.is_optimal() {
            continue;
        }
        shown += 1;
        assert!(found.evaluation.constraints[0] < 1e-8, "{found:?}");
        let x = found.design[0];
        let beside = (-50..=50).map(|k| (x + 1e-3 * f64::from(k)).clamp(-2.0, 2.0));
        let best = beside.map(|x| problem.on_curve(x)).fold(f64::MAX, f64::min);
        let goal = found.evaluation.objectives[0];
        assert!(goal < best + 1e-8, "{goal} at {x}, {best} beside it");
    }
    assert!(shown >= 57, "{shown} of 60 are shown");
}
