//! Nonlinear least squares: K. Levenberg's (1944) and D. Marquardt's (1963) method.

use kempe_linear::Qr;

/// Residuals of unknowns.
pub(crate) trait Model {
    /// The residuals; `None` where they are not defined.
    fn residuals(&self, unknowns: &[f64]) -> Option<Vec<f64>>;

    /// Their derivatives, added to an empty matrix with room below; whether they are defined.
    fn jacobian(&self, unknowns: &[f64], residuals: &[f64], jacobian: &mut Qr) -> bool;
}

/// Steps at most.
const STEPS: usize = 300;
/// A step that lessens the sum of squares by less than this part ends the method.
const SETTLED: f64 = 1e-14;
/// Damping, as a part of the columns' size: at the start, and beyond which no step helps.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;

/// Unknowns at a local minimum of the sum of squares, or where the steps end; `None` where the start has no residuals.
pub(crate) fn smallest(model: &impl Model, start: &[f64]) -> Option<Vec<f64>> {
    let sum = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
    let mut x = start.to_vec();
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
        qr.factor();
        let mut step: Vec<f64> = residuals.clone();
        step.resize(m + n, 0.0);
        qr.solve(&mut step);
        let next: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x - s).collect();
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
