//! A cubic spline through measured points, twice continuously differentiable.

use kempe_number::{Number, piecewise};

/// The spline's second derivatives at its knots, for `times` that increase.
///
/// Not-a-knot ends: the third derivative does not jump at the second and the last but one knot, so that points of one
/// cubic give that cubic back. Three points give the parabola through them, two the straight line.
/// Source: C. de Boor, A Practical Guide to Splines (1978), chapter IV.
pub(crate) fn moments(times: &[f64], values: &[f64]) -> Vec<f64> {
    let n = times.len().min(values.len());
    let step: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let slope: Vec<f64> = values
        .windows(2)
        .zip(&step)
        .map(|(w, h)| (w[1] - w[0]) / h)
        .collect();
    if n < 3 {
        return vec![0.0; n];
    }
    if n == 3 {
        return vec![2.0 * (slope[1] - slope[0]) / (step[0] + step[1]); 3];
    }
    // rows 1..n-1: h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (slope[i] - slope[i-1]);
    // the end conditions M[0] = M[1] - h0/h1 (M[2] - M[1]), and alike at the far end, are put into the first and last row
    let last = n - 2;
    let mut lower: Vec<f64> = (1..=last).map(|i| step[i - 1]).collect();
    let mut diagonal: Vec<f64> = (1..=last).map(|i| 2.0 * (step[i - 1] + step[i])).collect();
    let mut upper: Vec<f64> = (1..=last).map(|i| step[i]).collect();
    let mut right: Vec<f64> = (1..=last)
        .map(|i| 6.0 * (slope[i] - slope[i - 1]))
        .collect();
    let first_ratio = step[0] / step[1];
    diagonal[0] += lower[0] * (1.0 + first_ratio);
    upper[0] -= lower[0] * first_ratio;
    let last_ratio = step[last] / step[last - 1];
    diagonal[last - 1] += upper[last - 1] * (1.0 + last_ratio);
    lower[last - 1] -= upper[last - 1] * last_ratio;
    for i in 1..last {
        let factor = lower[i] / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        right[i] -= factor * right[i - 1];
    }
    let mut m = vec![0.0; n];
    m[last] = right[last - 1] / diagonal[last - 1];
    for i in (1..last).rev() {
        m[i] = (right[i - 1] - upper[i - 1] * m[i + 1]) / diagonal[i - 1];
    }
    m[0] = m[1] - first_ratio * (m[2] - m[1]);
    m[n - 1] = m[n - 2] + last_ratio * (m[n - 2] - m[n - 3]);
    m
}

/// The spline's value at `t`, by its second derivatives at the knots.
pub(crate) fn spline_at<T: Number>(times: &[f64], values: &[f64], moments: &[f64], t: T) -> T {
    piecewise(times, t, &|i| {
        let pair = |list: &[f64]| match (list.get(i), list.get(i + 1)) {
            (Some(a), Some(b)) => (*a, *b),
            _ => (f64::NAN, f64::NAN),
        };
        let ((t0, t1), (y0, y1), (m0, m1)) = (pair(times), pair(values), pair(moments));
        let h = t1 - t0;
        let b = (t - t0) / h;
        let a = -b + 1.0;
        let cubic = |s: T, m: f64| (s.square() * s - s) * (m * h * h / 6.0);
        a * y0 + b * y1 + cubic(a, m0) + cubic(b, m1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_given_back() {
        let f = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t + 0.5 * t * t * t;
        let times = [0.0, 0.5, 0.7, 1.6, 2.0, 3.1];
        let values: Vec<f64> = times.iter().map(|t| f(*t)).collect();
        let m = moments(&times, &values);
        for k in 0..=62 {
            let t = f64::from(k) * 0.05;
            assert!(
                (spline_at(&times, &values, &m, t) - f(t)).abs() < 1e-13,
                "{t}"
            );
        }
    }

    #[test]
    fn four_points_three_points_two_points() {
        let f = |t: f64| 4.0 - t * t * t;
        for n in 2..=4 {
            let times: Vec<f64> = (0..n).map(f64::from).collect();
            let values: Vec<f64> = times.iter().map(|t| f(*t)).collect();
            let m = moments(&times, &values);
            for (t, y) in times.iter().zip(&values) {
                assert!((spline_at(&times, &values, &m, *t) - y).abs() < 1e-14);
            }
        }
    }
}
