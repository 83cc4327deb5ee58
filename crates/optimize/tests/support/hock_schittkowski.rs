//! Problems of W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes (1981), with their starts and published optima. What has
//! no bounds there has wide ones here.

use super::{Case, cube};
use kempe_number::{Number, powi};

/// A problem, where it is begun, and its published optimum.
pub struct Known<const N: usize> {
    pub case: Case<N>,
    pub start: [f64; N],
    pub optimum: f64,
}

/// A valley with a bound.
pub fn hs1() -> Known<2> {
    let case = Case::<2>::smooth(vec![[-10.0, 10.0], [-1.5, 10.0]], 0, |[x, y]| {
        (
            (*y - x.square()).square() * 100.0 + (-*x + 1.0).square(),
            vec![],
        )
    });
    Known {
        case,
        start: [-2.0, 1.0],
        optimum: 0.0,
    }
}

/// A valley beyond a bound.
pub fn hs2() -> Known<2> {
    let case = Case::<2>::smooth(vec![[-10.0, 10.0], [1.5, 10.0]], 0, |[x, y]| {
        (
            (*y - x.square()).square() * 100.0 + (-*x + 1.0).square(),
            vec![],
        )
    });
    Known {
        case,
        start: [1.3, 1.6],
        optimum: 0.050_426_187_9,
    }
}

/// A sine.
pub fn hs5() -> Known<2> {
    let case = Case::<2>::smooth(vec![[-1.5, 4.0], [-3.0, 3.0]], 0, |[x, y]| {
        let sine = (*x + *y).sin_cos().0;
        (
            sine + (*x - *y).square() - *x * 1.5 + *y * 2.5 + 1.0,
            vec![],
        )
    });
    let published = -(3.0_f64.sqrt()) / 2.0 - std::f64::consts::PI / 3.0;
    Known {
        case,
        start: [0.0, 0.0],
        optimum: published,
    }
}

/// One row.
pub fn hs21() -> Known<2> {
    let case = Case::<2>::smooth(vec![[2.0, 50.0], [-50.0, 50.0]], 1, |[x, y]| {
        (
            x.square() * 0.01 + y.square() - 100.0,
            vec![-*x * 10.0 + *y + 10.0],
        )
    });
    Known {
        case,
        start: [2.0, -1.0],
        optimum: -99.96,
    }
}

/// A vertex.
pub fn hs24() -> Known<2> {
    let case = Case::<2>::smooth(cube(2, 0.0, 100.0), 3, |[x, y]| {
        let root = 3.0_f64.sqrt();
        let f = ((*x - 3.0).square() - 9.0) * powi(*y, 3) / (27.0 * root);
        (
            f,
            vec![-(*x / root - *y), -(*x + *y * root), *x + *y * root - 6.0],
        )
    });
    Known {
        case,
        start: [1.0, 0.5],
        optimum: -1.0,
    }
}

/// A quadratic.
pub fn hs35() -> Known<3> {
    let case = Case::<3>::smooth(cube(3, 0.0, 100.0), 1, |[x, y, z]| {
        let f = -*x * 8.0 - *y * 6.0 - *z * 4.0
            + x.square() * 2.0
            + y.square() * 2.0
            + z.square()
            + *x * *y * 2.0
            + *x * *z * 2.0
            + 9.0;
        (f, vec![*x + *y + *z * 2.0 - 3.0])
    });
    Known {
        case,
        start: [0.5; 3],
        optimum: 1.0 / 9.0,
    }
}

/// A product of valleys.
pub fn hs38() -> Known<4> {
    let case = Case::<4>::smooth(cube(4, -10.0, 10.0), 0, |[a, b, c, d]| {
        let f = (*b - a.square()).square() * 100.0
            + (-*a + 1.0).square()
            + (*d - c.square()).square() * 90.0
            + (-*c + 1.0).square()
            + ((*b - 1.0).square() + (*d - 1.0).square()) * 10.1
            + (*b - 1.0) * (*d - 1.0) * 19.8;
        (f, vec![])
    });
    Known {
        case,
        start: [-3.0, -1.0, -3.0, -1.0],
        optimum: 0.0,
    }
}

/// Of rosen and suzuki.
pub fn hs43() -> Known<4> {
    let case = Case::<4>::smooth(cube(4, -100.0, 100.0), 3, |[a, b, c, d]| {
        let (a2, b2, c2, d2) = (a.square(), b.square(), c.square(), d.square());
        let f = a2 + b2 + c2 * 2.0 + d2 - *a * 5.0 - *b * 5.0 - *c * 21.0 + *d * 7.0;
        let rows = vec![
            a2 + b2 + c2 + d2 + *a - *b + *c - *d - 8.0,
            a2 + b2 * 2.0 + c2 + d2 * 2.0 - *a - *d - 10.0,
            a2 * 2.0 + b2 + c2 + *a * 2.0 - *b - *d - 5.0,
        ];
        (f, rows)
    });
    Known {
        case,
        start: [0.0; 4],
        optimum: -44.0,
    }
}

/// An equation as two constraints.
pub fn hs71() -> Known<4> {
    let case = Case::<4>::smooth(cube(4, 1.0, 5.0), 3, |[a, b, c, d]| {
        let squares = a.square() + b.square() + c.square() + d.square();
        (
            *a * *d * (*a + *b + *c) + *c,
            vec![-(*a * *b * *c * *d) + 25.0, squares - 40.0, -squares + 40.0],
        )
    });
    Known {
        case,
        start: [1.0, 5.0, 5.0, 1.0],
        optimum: 17.014_017_3,
    }
}

/// A quadratic with bounds.
pub fn hs76() -> Known<4> {
    let case = Case::<4>::smooth(cube(4, 0.0, 100.0), 3, |[a, b, c, d]| {
        let f = a.square() + b.square() * 0.5 + c.square() + d.square() * 0.5 - *a * *c + *c * *d
            - *a
            - *b * 3.0
            + *c
            - *d;
        (
            f,
            vec![
                *a + *b * 2.0 + *c + *d - 5.0,
                *a * 3.0 + *b + *c * 2.0 - *d - 4.0,
                -(*b + *c * 4.0) + 1.5,
            ],
        )
    });
    Known {
        case,
        start: [0.5; 4],
        optimum: -4.681_818_181_818,
    }
}

/// Seven variables.
pub fn hs100() -> Known<7> {
    let case = Case::<7>::smooth(cube(7, -20.0, 20.0), 4, |x| {
        let f = (x[0] - 10.0).square()
            + (x[1] - 12.0).square() * 5.0
            + powi(x[2], 4)
            + (x[3] - 11.0).square() * 3.0
            + powi(x[4], 6) * 10.0
            + x[5].square() * 7.0
            + powi(x[6], 4)
            - x[5] * x[6] * 4.0
            - x[5] * 10.0
            - x[6] * 8.0;
        let rows = vec![
            x[0].square() * 2.0 + powi(x[1], 4) * 3.0 + x[2] + x[3].square() * 4.0 + x[4] * 5.0
                - 127.0,
            x[0] * 7.0 + x[1] * 3.0 + x[2].square() * 10.0 + x[3] - x[4] - 282.0,
            x[0] * 23.0 + x[1].square() + x[5].square() * 6.0 - x[6] * 8.0 - 196.0,
            x[0].square() * 4.0 + x[1].square() - x[0] * x[1] * 3.0
                + x[2].square() * 2.0
                + x[5] * 5.0
                - x[6] * 11.0,
        ];
        (f, rows)
    });
    Known {
        case,
        start: [1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0],
        optimum: 680.630_057_37,
    }
}

/// Ten variables.
pub fn hs113() -> Known<10> {
    let case = Case::<10>::smooth(cube(10, -20.0, 20.0), 8, |x| {
        let sq = |k: usize, by: f64| (x[k] - by).square();
        let f = x[0].square() + x[1].square() + x[0] * x[1] - x[0] * 14.0 - x[1] * 16.0
            + sq(2, 10.0)
            + sq(3, 5.0) * 4.0
            + sq(4, 3.0)
            + sq(5, 1.0) * 2.0
            + x[6].square() * 5.0
            + sq(7, 11.0) * 7.0
            + sq(8, 10.0) * 2.0
            + sq(9, 7.0)
            + 45.0;
        let rows = vec![
            x[0] * 4.0 + x[1] * 5.0 - x[6] * 3.0 + x[7] * 9.0 - 105.0,
            x[0] * 10.0 - x[1] * 8.0 - x[6] * 17.0 + x[7] * 2.0,
            x[0] * -8.0 + x[1] * 2.0 + x[8] * 5.0 - x[9] * 2.0 - 12.0,
            sq(0, 2.0) * 3.0 + sq(1, 3.0) * 4.0 + x[2].square() * 2.0 - x[3] * 7.0 - 120.0,
            x[0].square() * 5.0 + x[1] * 8.0 + sq(2, 6.0) - x[3] * 2.0 - 40.0,
            sq(0, 8.0) * 0.5 + sq(1, 4.0) * 2.0 + x[4].square() * 3.0 - x[5] - 30.0,
            x[0].square() + sq(1, 2.0) * 2.0 - x[0] * x[1] * 2.0 + x[4] * 14.0 - x[5] * 6.0,
            x[0] * -3.0 + x[1] * 6.0 + sq(8, 8.0) * 12.0 - x[9] * 7.0,
        ];
        (f, rows)
    });
    Known {
        case,
        start: [2.0, 3.0, 5.0, 5.0, 1.0, 2.0, 7.0, 3.0, 6.0, 10.0],
        optimum: 24.306_209_068,
    }
}
