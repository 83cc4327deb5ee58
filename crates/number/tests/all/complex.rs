//! Field laws and roots of complex numbers.

use kempe_number::{Complex, Dual};
use proptest::prelude::*;

fn complex() -> impl Strategy<Value = Complex<f64>> {
    (-10.0..10.0, -10.0..10.0).prop_map(|(re, im)| Complex::new(re, im))
}

fn near(a: Complex<f64>, b: Complex<f64>) -> bool {
    (a - b).norm() <= 1e-13 * (1.0 + a.norm().max(b.norm()))
}

proptest! {
    #[test]
    fn field_laws(a in complex(), b in complex(), c in complex()) {
        prop_assert!(near(a * (b + c), a * b + a * c));
        prop_assert!(near((a * b).conj(), a.conj() * b.conj()));
        prop_assume!(b.norm() > 1e-3);
        prop_assert!(near(a / b * b, a) && near(b.recip() * b, Complex::one()));
        prop_assert!(near(Complex::from_polar(b.norm(), b.arg()), b));
    }

    #[test]
    fn roots_square_back(a in complex()) {
        let r = a.sqrt();
        prop_assert!(near(r * r, a) && r.re >= 0.0);
    }

    #[test]
    fn powers(a in complex(), n in 0_u32..9) {
        let product = (0..n).fold(Complex::one(), |p, _| p * a);
        let difference = (a.powi(n) - product).norm();
        prop_assert!(difference <= 1e-13 * (1.0 + product.norm()));
    }
}

#[test]
fn roots_of_special_numbers() {
    assert_eq!(Complex::new(-4.0, 0.0).sqrt(), Complex::new(0.0, 2.0));
    assert_eq!(Complex::new(-4.0, -0.0).sqrt(), Complex::new(0.0, -2.0));
    assert_eq!(Complex::new(0.0, 0.0).sqrt(), Complex::zero());
    assert_eq!(Complex::<f64>::i() * Complex::i(), -Complex::one());
}

#[test]
fn derivatives_pass_through() {
    // d/dx (x + i)^2 = 2 (x + i).
    let z = Complex::new(Dual::<f64, 1>::variable(3.0, 0), Dual::constant(1.0));
    let square = z * z;
    assert_eq!((square.re.eps[0], square.im.eps[0]), (6.0, 2.0));
}
