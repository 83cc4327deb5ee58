//! Polynomials of one variable.

/// Turns values at places that differ into the coefficients, that of the lowest power first, of the polynomial through them: Newton's divided
/// differences, then powers.
pub fn polynomial_through(places: &[f64], values: &mut [f64]) {
    let n = values.len();
    for order in 1..n {
        for k in (order..n).rev() {
            values[k] = (values[k] - values[k - 1]) / (places[k] - places[k - order]);
        }
    }
    // What stands behind k are the powers of the polynomial that Horner's rule has come to.
    for k in (0..n.saturating_sub(1)).rev() {
        for j in k..n - 1 {
            values[j] -= places[k] * values[j + 1];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_goes_through_its_own_values() {
        let wanted = [0.5, -2.0, 0.0, 3.0, 1.0];
        let at = |x: f64| wanted.iter().rev().fold(0.0, |sum, c| sum * x + c);
        let places = [-1.5, -1.0, 0.1, 0.25, 0.5];
        let mut found = places.map(at);
        polynomial_through(&places, &mut found);
        for (a, b) in found.iter().zip(wanted) {
            assert!((a - b).abs() < 1e-12, "{found:?}");
        }
    }
}
