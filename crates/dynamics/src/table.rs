//! Measured curves: smooth, monotone where the data is, periodic where it repeats.

use kempe_number::{Number, piecewise};

/// A curve through measured points.
///
/// Between the points a cubic with the slopes of Fritsch and Butland (1984): the curve never overshoots the data, and
/// its first derivative is continuous. Beyond the ends of a curve that does not repeat the end values hold.
#[derive(Clone, Debug)]
pub struct Table {
    at: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
    period: Option<f64>,
}

impl Table {
    /// A curve through points with rising abscissas; with a period the first point follows the last one again.
    ///
    /// # Errors
    /// A sentence when the points cannot make a curve.
    pub fn new(at: &[f64], values: &[f64], period: Option<f64>) -> Result<Self, String> {
        if at.is_empty() || at.len() != values.len() {
            return Err("a table needs as many values as abscissas, and at least one".into());
        }
        if at
            .windows(2)
            .any(|w| w[1].partial_cmp(&w[0]) != Some(std::cmp::Ordering::Greater))
        {
            return Err("the abscissas of a table must rise".into());
        }
        let (mut at, mut values) = (at.to_vec(), values.to_vec());
        if let Some(period) = period {
            let span = at[at.len() - 1] - at[0];
            if !(period.is_finite() && period > 0.0) {
                return Err("the period of a table must be positive".into());
            }
            if span > period * (1.0 + 1e-9) {
                return Err("a table that repeats must not be longer than its period".into());
            }
            if span < period * (1.0 - 1e-9) {
                at.push(at[0] + period);
                values.push(values[0]);
            }
        }
        let slopes = slopes(&at, &values, period.is_some());
        Ok(Self {
            at,
            values,
            slopes,
            period,
        })
    }

    /// Abscissas of its points, rising: between them it is a cubic.
    pub fn knots(&self) -> &[f64] {
        &self.at
    }

    /// After how much it repeats itself, if it does.
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// The value at an abscissa.
    pub fn value<T: Number>(&self, x: T) -> T {
        let last = self.at.len() - 1;
        let x = match self.period {
            Some(period) => x + ((x - self.at[0]) / period).floor() * -period,
            None => x,
        };
        let held = |k: usize| T::from_f64(self.values[k]);
        if last == 0 {
            return x.choose_with(|| held(0), || held(0));
        }
        (x - self.at[0]).choose_with(
            || (-x + self.at[last]).choose_with(|| self.inside(x), || held(last)),
            || held(0),
        )
    }

    /// The value at an abscissa between the first point and the last, of several.
    fn inside<T: Number>(&self, x: T) -> T {
        let past = |k: usize| x - self.at[k];
        let [value] = piecewise(self.at.len() - 1, &past, &|k| {
            let h = self.at[k + 1] - self.at[k];
            let rise = (self.values[k + 1] - self.values[k]) / h;
            let (low, high) = (self.slopes[k], self.slopes[k + 1]);
            let s = x + -self.at[k];
            let square = (3.0 * rise - 2.0 * low - high) / h;
            let cube = (low + high - 2.0 * rise) / (h * h);
            [((s * cube + square) * s + low) * s + self.values[k]]
        });
        value
    }
}

/// Slopes at the points: the weighted harmonic mean of the neighbouring rises, zero at an extreme.
fn slopes(at: &[f64], values: &[f64], repeats: bool) -> Vec<f64> {
    let n = at.len();
    let steps: Vec<f64> = at.windows(2).map(|w| w[1] - w[0]).collect();
    let rises: Vec<f64> = values
        .windows(2)
        .zip(&steps)
        .map(|(w, h)| (w[1] - w[0]) / h)
        .collect();
    let inner = |a: usize, b: usize| {
        let (h0, h1, d0, d1) = (steps[a], steps[b], rises[a], rises[b]);
        if d0 * d1 <= 0.0 {
            0.0
        } else {
            let w0 = 2.0 * h1 + h0;
            let w1 = h1 + 2.0 * h0;
            (w0 + w1) / (w0 / d0 + w1 / d1)
        }
    };
    let mut slopes = vec![0.0; n];
    for k in 1..n.saturating_sub(1) {
        slopes[k] = inner(k - 1, k);
    }
    match n {
        0 | 1 => {}
        2 if !repeats => slopes.fill(rises[0]),
        _ if repeats => {
            slopes[0] = inner(n - 2, 0);
            slopes[n - 1] = slopes[0];
        }
        _ => {
            slopes[0] = end_slope(steps[0], steps[1], rises[0], rises[1]);
            slopes[n - 1] = end_slope(steps[n - 2], steps[n - 3], rises[n - 2], rises[n - 3]);
        }
    }
    slopes
}

/// One-sided three-point slope that keeps the shape of the data.
fn end_slope(h0: f64, h1: f64, d0: f64, d1: f64) -> f64 {
    let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if slope * d0 <= 0.0 {
        0.0
    } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
        3.0 * d0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use kempe_number::{Interval, Lanes};

    use super::*;

    #[test]
    fn meets_its_points_and_never_overshoots() {
        let (at, values) = ([0.0, 1.0, 1.5, 4.0, 5.0], [0.0, 2.0, 2.0, 7.0, 1.0]);
        let table = Table::new(&at, &values, None).unwrap();
        for (x, y) in at.iter().zip(&values) {
            assert!((table.value(*x) - y).abs() < 1e-14);
        }
        for k in 0..=500 {
            let y: f64 = table.value(0.01 * f64::from(k));
            assert!((0.0..=7.0).contains(&y));
        }
        assert_eq!((table.value(-3.0), table.value(9.0)), (0.0, 1.0));
    }

    #[test]
    fn repeats_with_its_period() {
        let table = Table::new(&[0.0, 1.0, 3.0], &[1.0, 4.0, 2.0], Some(4.0)).unwrap();
        for k in 0..40 {
            let x = 0.1 * f64::from(k);
            let (a, b): (f64, f64) = (table.value(x), table.value(x + 8.0));
            assert!((a - b).abs() < 1e-12);
        }
        assert!((table.value(-1.0) - 2.0_f64).abs() < 1e-14);
        // Every part of a number is in its own piece and period.
        let at: [f64; 8] = std::array::from_fn(|k| 1.7 * k as f64 - 5.0);
        let lanes: Lanes<8> = table.value(Lanes(at));
        for (lane, x) in at.iter().enumerate() {
            assert_eq!(lanes.lane(lane), table.value(*x));
            let bounds: Interval = table.value(Interval::new(*x, x + 1.1));
            for k in 0..=10 {
                assert!(bounds.contains(table.value(x + 0.11 * f64::from(k))));
            }
        }
        assert!(Table::new(&[0.0, 5.0], &[1.0, 4.0], Some(4.0)).is_err());
        assert!(Table::new(&[0.0, 0.0], &[1.0, 4.0], None).is_err());
    }
}
