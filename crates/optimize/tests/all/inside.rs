//! What constraints cost that leave nothing inside of them.

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
