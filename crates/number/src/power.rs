//! Whole powers.

use crate::Number;

/// `x^n` by repeated squaring from the lowest bit of `n`; for negative `n` one divided by the power of `-n`, one for `n = 0`.
///
/// `f64::powi` promises neither the order of its products nor their rounding, so its bits may differ between targets and
/// compilers; this is a fixed chain of products.
///
/// # Example
///
/// ```
/// use kempe_number::{Dual, powi};
/// assert_eq!(powi(10.0, -2), 0.01);
/// let cube = powi(Dual::<f64, 1>::variable(2.0, 0), 3);
/// assert_eq!((cube.re, cube.eps[0]), (8.0, 12.0));
/// ```
#[inline]
pub fn powi<T: Number>(x: T, n: i32) -> T {
    let mut rest = n.unsigned_abs();
    let mut square = x;
    let mut product: Option<T> = None;
    while rest > 0 {
        if rest & 1 == 1 {
            product = Some(product.map_or(square, |p| p * square));
        }
        rest >>= 1;
        if rest > 0 {
            square = square.square();
        }
    }
    match product {
        None => T::one(),
        Some(product) if n < 0 => T::one() / product,
        Some(product) => product,
    }
}

#[cfg(test)]
mod tests {
    use super::powi;

    #[test]
    fn the_products_stand_in_a_fixed_order() {
        let x = 1.1_f64;
        let (second, fourth) = (x * x, (x * x) * (x * x));
        for (n, written) in [
            (0, 1.0),
            (1, x),
            (2, second),
            (3, x * second),
            (5, x * fourth),
            (7, (x * second) * fourth),
            (-3, 1.0 / (x * second)),
        ] {
            assert_eq!(powi(x, n).to_bits(), written.to_bits(), "x^{n}");
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(powi(2.0, i32::MIN), 0.0);
        assert_eq!(powi(-1.0, i32::MAX), -1.0);
        assert_eq!(powi(0.0, -1), f64::INFINITY);
        assert_eq!(powi(f64::NAN, 0), 1.0);
        assert!(powi(f64::NAN, 2).is_nan());
    }
}
