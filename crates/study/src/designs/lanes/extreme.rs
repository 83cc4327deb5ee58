//! Extremes between places.

/// Places that a curve is laid through.
pub(super) const THROUGH: usize = 5;
/// Steps of Newton's method to the vertex of that curve, from that of a parabola.
const STEPS: usize = 2;
/// A vertex that exceeds the largest value by more than so many times what the parabola's does belongs to no smooth curve.
const SMOOTH: f64 = 2.0;

/// Bends that differ by more than this part of the largest are those of a corner.
const UNEVEN: f64 = 0.75;
/// What bends by less than this part of the whole range is flat.
const FLAT: f64 = 1e-6;

/// The largest value of a smooth function of which values are known at some neighbouring places (three to five), rising; the largest of them
/// stands at `k`. Where the curve through them has no vertex beside it, that one.
pub(super) fn largest(places: &[f64], values: &[f64], k: usize) -> f64 {
    let known = values[k];
    let n = places.len().min(THROUGH);
    if n < 3 {
        return known;
    }
    // Relative to the place of the largest.
    let mut x = [0.0; THROUGH];
    for i in 0..n {
        x[i] = places[i] - places[k];
    }
    let middle = k.clamp(1, n - 2);
    let [a, b, c] = [middle - 1, middle, middle + 1];
    let (low, high) = (x[k.saturating_sub(1)], x[(k + 1).min(n - 1)]);
    let first = (values[b] - values[a]) / (x[b] - x[a]);
    let second = ((values[c] - values[b]) / (x[c] - x[b]) - first) / (x[c] - x[a]);
    if !(second < 0.0) {
        return known;
    }
    let vertex = 0.5 * (x[a] + x[b]) - 0.5 * first / second;
    if !(low <= vertex && vertex <= high) {
        return known;
    }
    let parabola = values[a] + (vertex - x[a]) * (first + (vertex - x[b]) * second);
    let through = curve(&x, values, n, vertex, low, high);
    let most = known + SMOOTH * (parabola - known).max(0.0);
    match through >= known && through <= most {
        true => through,
        false => parabola.max(known),
    }
}

/// Whether a curve through values at neighbouring places (three to five) shows no corner: it bends alike all along, or by nothing
/// against the whole range.
pub(super) fn is_smooth(places: &[f64], values: &[f64], range: f64) -> bool {
    let bends = places.windows(3).zip(values.windows(3)).map(|(x, f)| {
        let (before, after) = ((f[1] - f[0]) / (x[1] - x[0]), (f[2] - f[1]) / (x[2] - x[1]));
        (after - before) * 0.25 * (x[2] - x[0])
    });
    let (low, high) = bends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let most = high.max(-low);
    !(high - low > UNEVEN * most && most > FLAT * range)
}

/// The vertex of the polynomial through all the places.
fn curve(x: &[f64; THROUGH], values: &[f64], n: usize, start: f64, low: f64, high: f64) -> f64 {
    // Newton's divided differences.
    let mut d = [0.0; THROUGH];
    d[..n].copy_from_slice(&values[..n]);
    for order in 1..n {
        for i in (order..n).rev() {
            d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - order]);
        }
    }
    let at = |t: f64| {
        let (mut f, mut df, mut ddf) = (d[n - 1], 0.0, 0.0);
        for i in (0..n - 1).rev() {
            let s = t - x[i];
            ddf = ddf * s + 2.0 * df;
            df = df * s + f;
            f = f * s + d[i];
        }
        (f, df, ddf)
    };
    let mut t = start;
    for _ in 0..STEPS {
        let (_, df, ddf) = at(t);
        if !(ddf < 0.0) {
            break;
        }
        t = (t - df / ddf).clamp(low, high);
    }
    at(t).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_number::math;

    fn of(f: impl Fn(f64) -> f64, from: f64, step: f64) -> f64 {
        let places: [f64; 5] = std::array::from_fn(|i| from + step * i as f64);
        let values = places.map(f);
        let k = (0..5)
            .max_by(|a, b| values[*a].total_cmp(&values[*b]))
            .unwrap_or(0);
        largest(&places, &values, k)
    }

    #[test]
    fn the_top_of_a_smooth_curve_is_found_between_places() {
        let two_degrees = 0.0349;
        for k in 0..20 {
            let phase = -2.0 + f64::from(k) / 20.0;
            let top = of(math::cos, phase * two_degrees, two_degrees);
            assert!((top - 1.0).abs() < 1e-9, "{k}: {top}");
        }
        // A quartic is met exactly.
        let top = of(
            |x| 1.0 - (x - 0.1) * (x - 0.1) * (1.0 + x + x * x),
            -0.9,
            0.4,
        );
        assert!((top - 1.0).abs() < 1e-7, "{top}");
    }

    #[test]
    fn the_top_of_a_corner_is_not_far_exceeded_and_ends_are_kept() {
        let top = of(|x| -x.abs(), -1.8, 1.0);
        assert!((-0.2..=0.25).contains(&top), "{top}");
        assert_eq!(of(|x| x, 0.0, 1.0), 4.0);
        assert_eq!(of(|_| 3.0, 0.0, 1.0), 3.0);
        assert_eq!(largest(&[0.0], &[2.0], 0), 2.0);
    }
}
