//! Nonlinear least squares: K. Levenberg's (1944) and D. Marquardt's (1963) method.

use crate::Qr;

/// Residuals of unknowns, and what their squares are to be smallest of.
pub trait Residuals {
    /// The residuals; `None` where they are not defined.
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>>;

    /// Their derivatives, added to an empty matrix with room below; whether they are defined.
    fn jacobian(&self, unknowns: &[f64], residuals: &[f64], jacobian: &mut Qr) -> bool;

    /// The least and the largest value of an unknown, by its place.
    fn bounds(&self, _: usize) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }
}

/// Steps at most.
const STEPS: usize = 300;
/// A step that lessens the sum of squares by less than this part ends the method.
const SETTLED: f64 = 1e-14;
/// Damping, as a part of the columns' size: at the start, and beyond which no step helps.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;

/// Unknowns at a local minimum of the sum of squares within their bounds, or where the steps end; `None` where the start, brought within them, has
/// no residuals.
pub fn smallest_squares(model: &impl Residuals, start: &[f64]) -> Option<Vec<f64>> {
    let sum = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
    let bounds: Vec<[f64; 2]> = (0..start.len()).map(|k| model.bounds(k)).collect();
    let within = |x: f64, [low, high]: [f64; 2]| x.max(low).min(high);
    let mut x: Vec<f64> = (start.iter().zip(&bounds))
        .map(|(x, ends)| within(*x, *ends))
        .collect();
    let mut residuals = model.residuals(&x)?;
    let mut square = sum(&residuals);
    let mut damping = DAMPING;
    let (n, m) = (x.len(), residuals.len());
    let mut qr = Qr::with_capacity(m + n, n);
    for _ in 0..STEPS {
        if !square.is_finite() {
            return None;
        }
        // The columns' sizes, so that the damping has no unit.
        qr.reset(m + n, n);
        if !model.jacobian(&x, &residuals, &mut qr) {
            break;
        }
        let sizes = qr.column_lengths();
        for (k, size) in sizes.iter().enumerate() {
            qr.add(m + k, k, damping.sqrt() * size.max(f64::MIN_POSITIVE));
        }
        // What would leave its bounds stays on them.
        for (k, slope) in qr.transposed_times(&residuals).into_iter().enumerate() {
            let [low, high] = bounds[k];
            if (x[k] <= low && slope > 0.0) || (x[k] >= high && slope < 0.0) {
                qr.hold(k, m + k);
            }
        }
        qr.factor();
        let mut step: Vec<f64> = residuals.clone();
        step.resize(m + n, 0.0);
        qr.solve(&mut step);
        let next: Vec<f64> = (x.iter().zip(&step).zip(&bounds))
            .map(|((x, s), ends)| within(x - s, *ends))
            .collect();
        let there = model.residuals(&next).filter(|r| sum(r) < square);
        match there {
            Some(better) => {
                let now = sum(&better);
                let settled = square - now <= SETTLED * square;
                (x, residuals, square) = (next, better, now);
                if settled && damping <= DAMPING {
                    break;
                }
                damping *= 0.2;
            }
            None => {
                damping *= 8.0;
                if damping > MOST_DAMPING {
                    break;
                }
            }
        }
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H. H. Rosenbrock's valley (1960): residuals 10 (y - x^2) and 1 - x.
    struct Valley {
        bounds: [[f64; 2]; 2],
    }

    impl Residuals for Valley {
        fn residuals(&self, at: &[f64]) -> Option<Vec<f64>> {
            Some(vec![10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]])
        }

        fn jacobian(&self, at: &[f64], _: &[f64], jacobian: &mut Qr) -> bool {
            jacobian.add(0, 0, -20.0 * at[0]);
            jacobian.add(0, 1, 10.0);
            jacobian.add(1, 0, -1.0);
            true
        }

        fn bounds(&self, unknown: usize) -> [f64; 2] {
            self.bounds[unknown]
        }
    }

    #[test]
    fn a_valley_is_followed_to_its_end() {
        let free = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
        let found = smallest_squares(&Valley { bounds: free }, &[-1.2, 1.0]);
        let found = found.expect("a minimum");
        assert!(found.iter().all(|x| (x - 1.0).abs() < 1e-12), "{found:?}");
    }

    /// With x at 1/2 at most the minimum is on the bound: y = x^2 there.
    #[test]
    fn bounds_are_kept_and_slid_along() {
        let bounds = [[-2.0, 0.5], [-2.0, 2.0]];
        let found = smallest_squares(&Valley { bounds }, &[-1.2, 1.0]);
        let found = found.expect("a minimum");
        assert_eq!(found[0], 0.5);
        assert!((found[1] - 0.25).abs() < 1e-9, "{found:?}");
    }
}
