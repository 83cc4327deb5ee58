//! Cubic splines through points, twice continuously differentiable.
//!
//! Source: C. de Boor, A Practical Guide to Splines (1978), chapter IV.

use kempe_linear::{Tridiagonal, solve_tridiagonal};
use kempe_number::{Number, piecewise};

/// A spline's second derivatives at its knots, for `times` that increase.
///
/// Not-a-knot ends: the third derivative does not jump at the second and the last but one knot, so that points of one
/// cubic give that cubic back. Three points give the parabola through them, two the straight line.
pub fn moments<T: Number>(times: &[T], values: &[T]) -> Vec<T> {
    let n = times.len().min(values.len());
    let step: Vec<T> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let slope: Vec<T> = values
        .windows(2)
        .zip(&step)
        .map(|(w, h)| (w[1] - w[0]) / *h)
        .collect();
    if n < 3 {
        return vec![T::zero(); n];
    }
    if n == 3 {
        return vec![(slope[1] - slope[0]) * 2.0 / (step[0] + step[1]); 3];
    }
    // rows 1..n-1: h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (slope[i] - slope[i-1]);
    // the end conditions M[0] = M[1] - h0/h1 (M[2] - M[1]), and alike at the far end, are put into the first and last row
    let last = n - 2;
    let mut rows: Vec<Tridiagonal<T>> = (1..=last)
        .map(|i| between([step[i - 1], step[i]], [slope[i - 1], slope[i]]))
        .collect();
    let first_ratio = step[0] / step[1];
    let first = &mut rows[0];
    first.diagonal += first.lower * (first_ratio + 1.0);
    first.upper -= first.lower * first_ratio;
    let last_ratio = step[last] / step[last - 1];
    let end = &mut rows[last - 1];
    end.diagonal += end.upper * (last_ratio + 1.0);
    end.lower -= end.upper * last_ratio;
    let inner = solve_tridiagonal(rows);
    let mut m = vec![T::zero(); n];
    m[1..=last].copy_from_slice(&inner);
    m[0] = m[1] - first_ratio * (m[2] - m[1]);
    m[n - 1] = m[n - 2] + last_ratio * (m[n - 2] - m[n - 3]);
    m
}

/// The second derivatives of a closed spline at its knots, the first after the last left out: `steps` are the times from
/// every knot to the next, the last one back to the first. Three knots at least.
pub fn closed_moments<T: Number>(steps: &[T], values: &[T]) -> Vec<T> {
    let n = steps.len().min(values.len());
    if n < 3 {
        return vec![T::zero(); n];
    }
    let slope: Vec<T> = (0..n)
        .map(|i| (values[(i + 1) % n] - values[i]) / steps[i])
        .collect();
    let row = |i: usize| {
        let before = (i + n - 1) % n;
        between([steps[before], steps[i]], [slope[before], slope[i]])
    };
    // The last moment is M: the others are those of a chain, once for the right-hand sides and once for what M gives the
    // chain's ends; the last row then tells M.
    let inner = || (0..n - 1).map(row);
    let still = solve_tridiagonal(inner().collect());
    let mut for_last: Vec<Tridiagonal<T>> = inner().collect();
    for_last.iter_mut().for_each(|row| row.right = T::zero());
    let (first, end) = (for_last[0], for_last[n - 2]);
    for_last[0].right -= first.lower;
    for_last[n - 2].right -= end.upper;
    let with_last = solve_tridiagonal(for_last);
    let end = row(n - 1);
    let m = (end.right - end.lower * still[n - 2] - end.upper * still[0])
        / (end.diagonal + end.lower * with_last[n - 2] + end.upper * with_last[0]);
    let chain = still.iter().zip(&with_last).map(|(a, b)| *a + *b * m);
    chain.chain([m]).collect()
}

/// The row at a knot between these steps and slopes: the first derivative does not jump.
fn between<T: Number>(steps: [T; 2], slopes: [T; 2]) -> Tridiagonal<T> {
    Tridiagonal {
        lower: steps[0],
        diagonal: (steps[0] + steps[1]) * 2.0,
        upper: steps[1],
        right: (slopes[1] - slopes[0]) * 6.0,
    }
}

/// The cubic of one piece about its first knot, by rising powers: `step` is its length in time, `values` and `moments`
/// those at its ends.
pub fn piece<T: Number>(step: T, values: [T; 2], moments: [T; 2]) -> [T; 4] {
    let [y0, y1] = values;
    let [m0, m1] = moments;
    [
        y0,
        (y1 - y0) / step - step * (m0 * 2.0 + m1) / 6.0,
        m0 * 0.5,
        (m1 - m0) / (step * 6.0),
    ]
}

/// The spline's value at `t`, by its second derivatives at the knots.
pub(crate) fn spline_at<T: Number>(times: &[f64], values: &[f64], moments: &[f64], t: T) -> T {
    let past = |k: usize| t - times[k];
    let [value] = piecewise(times.len().saturating_sub(1), &past, &|i| {
        let pair = |list: &[f64]| match (list.get(i), list.get(i + 1)) {
            (Some(a), Some(b)) => (*a, *b),
            _ => (f64::NAN, f64::NAN),
        };
        let ((t0, t1), (y0, y1), (m0, m1)) = (pair(times), pair(values), pair(moments));
        let h = t1 - t0;
        let b = (t - t0) / h;
        let a = -b + 1.0;
        let cubic = |s: T, m: f64| (s.square() * s - s) * (m * h * h / 6.0);
        [a * y0 + b * y1 + cubic(a, m0) + cubic(b, m1)]
    });
    value
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

    /// Value and first two derivatives agree at every knot, at the last with those at the first.
    #[test]
    fn a_closed_spline_is_smooth_all_the_way_round() {
        for n in [3, 4, 7] {
            let steps: Vec<f64> = (0..n).map(|i| 0.6 + 0.3 * f64::from(i % 3)).collect();
            let values: Vec<f64> = (0..n).map(|i| f64::from((i * i * 7) % 5) - 1.3).collect();
            let m = closed_moments(&steps, &values);
            let n = steps.len();
            let pieces: Vec<[f64; 4]> = (0..n)
                .map(|i| {
                    let next = (i + 1) % n;
                    piece(steps[i], [values[i], values[next]], [m[i], m[next]])
                })
                .collect();
            for i in 0..n {
                let ([a, b, c, d], h, next) = (pieces[i], steps[i], pieces[(i + 1) % n]);
                let end = [
                    a + h * (b + h * (c + h * d)),
                    b + h * (2.0 * c + 3.0 * h * d),
                    c + 3.0 * h * d,
                ];
                for k in 0..3 {
                    assert!((end[k] - next[k]).abs() < 1e-13, "{n} {i} {k}");
                }
            }
        }
    }
}
