//! Fixed points that a repeated map comes near to slowly: Anderson's mixing (D. G. Anderson, J. ACM 12, 1965).

use crate::independent_least_squares;

/// Steps towards the fixed point of a map, from what earlier steps did: for a linear map of n numbers exact after n + 1.
#[derive(Clone, Debug, Default)]
pub struct Anderson {
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Changes of places, and of what the map changed there; the latest last.
    changes: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// The step from a place that the map would change by `by`. All numbers should be of one size.
    pub fn step(&mut self, at: &[f64], by: &[f64]) -> Vec<f64> {
        let differ = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        if let Some((place, change)) = self.last.replace((at.to_vec(), by.to_vec())) {
            self.changes.push((differ(at, &place), differ(by, &change)));
            if self.changes.len() > at.len() {
                self.changes.remove(0);
            }
        }
        let columns: Vec<&[f64]> = self.changes.iter().map(|c| c.1.as_slice()).collect();
        let parts = independent_least_squares(&columns, by);
        let mut step = by.to_vec();
        for ((place, change), part) in self.changes.iter().zip(parts) {
            for ((step, place), change) in step.iter_mut().zip(place).zip(change) {
                *step -= part * (place + change);
            }
        }
        step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_map_that_comes_near_slowly_is_solved_at_once() {
        // x -> A x + b, with A's largest eigenvalue near one.
        let map = |x: &[f64]| {
            [
                0.95 * x[0] + 0.3 * x[1] + 1.0,
                0.1 * x[0] - 0.8 * x[1] - 2.0,
            ]
        };
        let (mut x, mut mixing) = (vec![0.0, 0.0], Anderson::default());
        for _ in 0..4 {
            let by: Vec<f64> = map(&x).iter().zip(&x).map(|(a, b)| a - b).collect();
            let step = mixing.step(&x, &by);
            for (x, step) in x.iter_mut().zip(step) {
                *x += step;
            }
        }
        for (a, b) in map(&x).iter().zip(&x) {
            assert!((a - b).abs() < 1e-12, "{x:?}");
        }
    }

    #[test]
    fn a_smooth_map_is_come_near_to_faster_than_by_itself() {
        let map = |x: f64| 0.9 / (1.0 + x * x);
        let (mut x, mut mixing) = (0.0, Anderson::default());
        for _ in 0..8 {
            x += mixing.step(&[x], &[map(x) - x])[0];
        }
        assert!((map(x) - x).abs() < 1e-15, "{x}");
    }
}
