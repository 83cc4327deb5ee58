//! Roots of small real polynomials.

use kempe_linear::{C, eigenvalues};

/// A leading coefficient below this part of the largest is what rounding left of a zero: its root lies at infinity.
const LEADING: f64 = 1e-14;
/// Newton's steps on a root at most.
const STEPS: usize = 8;

/// All finite roots, real or not, of a polynomial by its real coefficients, the constant first. None for a constant.
///
/// Eigenvalues of the companion matrix, then Newton's method, which is left where it does not make the value smaller.
pub(crate) fn roots(coefficients: &[f64]) -> Vec<C> {
    let largest = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let Some(degree) = (coefficients.iter()).rposition(|c| c.abs() > LEADING * largest) else {
        return Vec::new();
    };
    let p = &coefficients[..=degree];
    match degree {
        0 => Vec::new(),
        1 => vec![C::from(-p[0] / p[1])],
        2 => quadratic(p[2], p[1], p[0]).to_vec(),
        _ => {
            let mut matrix = vec![0.0; degree * degree];
            for k in 0..degree {
                matrix[k] = -p[degree - 1 - k] / p[degree];
                if k > 0 {
                    matrix[k * degree + k - 1] = 1.0;
                }
            }
            let found = eigenvalues(&matrix, degree).unwrap_or_default();
            (found.into_iter())
                .map(|[re, im]| polished(p, C::new(re, im)))
                .collect()
        }
    }
}

/// Value and derivative.
fn value(p: &[f64], x: C) -> (C, C) {
    (p.iter().rev()).fold((C::zero(), C::zero()), |(f, d), c| {
        (f * x + C::from(*c), d * x + f)
    })
}

fn polished(p: &[f64], start: C) -> C {
    let mut x = start;
    let (mut f, mut slope) = value(p, x);
    for _ in 0..STEPS {
        let next = x - f * slope.recip();
        let (there, there_slope) = value(p, next);
        if !(there.norm_sqr() < f.norm_sqr()) {
            break;
        }
        (x, f, slope) = (next, there, there_slope);
    }
    x
}

/// Both roots of a x^2 + b x + c without cancellation.
fn quadratic(a: f64, b: f64, c: f64) -> [C; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        let (re, im) = (-b / (2.0 * a), (-discriminant).sqrt() / (2.0 * a));
        return [C::new(re, im), C::new(re, -im)];
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let other = if q == 0.0 { 0.0 } else { c / q };
    [C::from(q / a), C::from(other)]
}

/// A form in two variables by the powers of the second, along the line (x, y) = (c, s) t + (-s, c): a polynomial in t, the constant first.
pub(crate) fn along(form: &[f64], (s, c): (f64, f64)) -> Vec<f64> {
    let degree = form.len() - 1;
    let mut sum = vec![0.0; form.len()];
    for (k, factor) in form.iter().enumerate() {
        let mut term = vec![*factor];
        for power in 0..degree {
            let [constant, slope] = if power < k { [c, s] } else { [-s, c] };
            let mut next = vec![0.0; term.len() + 1];
            for (i, x) in term.iter().enumerate() {
                next[i] += x * constant;
                next[i + 1] += x * slope;
            }
            term = next;
        }
        for (sum, x) in sum.iter_mut().zip(&term) {
            *sum += x;
        }
    }
    sum
}

/// A root that is complex by no more than this, beside 1, is a real one, double but for rounding.
const NEARLY_REAL: f64 = 1e-6;

/// The real directions (x, y) in which a form in two variables, by the powers of the second, vanishes.
pub(crate) fn directions(form: &[f64]) -> Vec<[f64; 2]> {
    // Turned by an angle of no meaning, so that no direction lies along an axis.
    let (s, c) = (0.6, 0.8);
    let found = roots(&along(form, (s, c)));
    let mut all: Vec<[f64; 2]> = (found.iter())
        .filter(|t| t.im.abs() <= NEARLY_REAL * (1.0 + t.norm()))
        .map(|t| [c * t.re - s, s * t.re + c])
        .collect();
    if found.len() + 1 < form.len() {
        all.push([c, s]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_roots(real: &[f64]) -> Vec<f64> {
        let mut p = vec![1.0];
        for r in real {
            p.insert(0, 0.0);
            for k in 0..p.len() - 1 {
                p[k] -= r * p[k + 1];
            }
        }
        p
    }

    #[test]
    fn roots_of_products_are_found() {
        for known in [
            vec![2.0],
            vec![1.0, -3.0],
            vec![0.5, -0.25, 7.0],
            vec![1e-3, 4.0, -2.0, 30.0],
        ] {
            let mut found: Vec<f64> = roots(&from_roots(&known)).iter().map(|r| r.re).collect();
            found.sort_by(f64::total_cmp);
            let mut known = known;
            known.sort_by(f64::total_cmp);
            assert_eq!(found.len(), known.len());
            for (a, b) in found.iter().zip(&known) {
                assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} {b}");
            }
        }
    }

    #[test]
    fn a_vanishing_leading_coefficient_is_left_out() {
        assert_eq!(roots(&[-6.0, 2.0, 1e-17]), [C::from(3.0)]);
        assert!(roots(&[1.0]).is_empty() && roots(&[0.0, 0.0]).is_empty());
        let [a, b] = quadratic(1.0, -1e9, 1.0).map(|x| x.re);
        assert!((a - 1e9).abs() < 1e-6 && (b - 1e-9).abs() < 1e-24);
    }

    #[test]
    fn a_form_vanishes_in_its_directions() {
        // x y (x - 2 y), with directions along both axes.
        let found = directions(&[0.0, 1.0, -2.0, 0.0]);
        assert_eq!(found.len(), 3);
        for [x, y] in found {
            assert!((x * y * (x - 2.0 * y)).abs() < 1e-14 * (x * x + y * y));
        }
        assert!(directions(&[1.0, 0.0, 1.0]).is_empty());
    }
}
