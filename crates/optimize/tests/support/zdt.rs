//! Problems of E. Zitzler, K. Deb and L. Thiele (ZDT, 2000) with two objectives, whose fronts are known.

use std::f64::consts::PI;

use super::{Case, D, cube};
use kempe_number::{Number, powi};

/// Square root with a slope that is a number at zero.
fn root<const N: usize>(x: D<N>) -> D<N> {
    if x.re < 1e-300 { x * 1e10 } else { x.sqrt() }
}

/// A problem of several objectives.
pub fn several<const N: usize>(
    bounds: Vec<[f64; 2]>,
    objectives: usize,
    f: impl Fn(&[D<N>; N]) -> Vec<D<N>> + Send + Sync + 'static,
) -> Case<N> {
    Case {
        bounds,
        objectives,
        constraints: 0,
        functions: Box::new(move |x| Some((f(x).into_iter().map(|f| vec![f]).collect(), vec![]))),
        asked: Default::default(),
    }
}

fn mean_of_rest<const N: usize>(x: &[D<N>; N]) -> D<N> {
    x[1..].iter().fold(D::constant(0.0), |sum, x| sum + *x) / (N as f64 - 1.0)
}

/// Its front is convex.
pub fn zdt1() -> Case<30> {
    several(cube(30, 0.0, 1.0), 2, |x| {
        let g = mean_of_rest(x) * 9.0 + 1.0;
        vec![x[0], g - root(x[0] * g)]
    })
}

/// Its front is hollow.
pub fn zdt2() -> Case<30> {
    several(cube(30, 0.0, 1.0), 2, |x| {
        let g = mean_of_rest(x) * 9.0 + 1.0;
        vec![x[0], g - x[0].square() / g]
    })
}

/// Its front is in pieces.
pub fn zdt3() -> Case<30> {
    several(cube(30, 0.0, 1.0), 2, |x| {
        let g = mean_of_rest(x) * 9.0 + 1.0;
        let wave = (x[0] * (10.0 * PI)).sin_cos().0;
        vec![x[0], g - root(x[0] * g) - x[0] * wave]
    })
}

/// Its front is one of many.
pub fn zdt4() -> Case<10> {
    let mut bounds = cube(10, -5.0, 5.0);
    bounds[0] = [0.0, 1.0];
    several(bounds, 2, |x| {
        let term = |x: &D<10>| x.square() - (*x * (4.0 * PI)).sin_cos().1 * 10.0 + 10.0;
        let g = x[1..].iter().fold(D::constant(1.0), |sum, x| sum + term(x));
        vec![x[0], g - root(x[0] * g)]
    })
}

/// Its front is uneven.
pub fn zdt6() -> Case<10> {
    several(cube(10, 0.0, 1.0), 2, |x| {
        let one = -((x[0] * -4.0).exp() * powi((x[0] * (6.0 * PI)).sin_cos().0, 6)) + 1.0;
        let mean = mean_of_rest(x);
        // The fourth root rises without bound at zero.
        let steep = if mean.re < 1e-60 {
            mean * 1e15
        } else {
            mean.sqrt().sqrt()
        };
        let g = steep * 9.0 + 1.0;
        vec![one, g - one.square() / g]
    })
}
