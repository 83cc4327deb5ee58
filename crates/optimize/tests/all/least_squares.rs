//! Sums of squares of the literature: J. J. Moré, B. S. Garbow and K. E. Hillstrom's (1981), with bounds and constraints those of W. Hock and
//! K. Schittkowski (1981) that are sums of squares.
#![allow(clippy::unwrap_used)]

use kempe_number::math::{atan2, exp, hypot};
use kempe_optimize::{Descent, Linear, Piece, Squares, least_squares};

type Residuals = fn(&[f64]) -> Vec<f64>;

struct Case {
    bounds: Vec<[f64; 2]>,
    residuals: Residuals,
    /// At most zero.
    kept: Residuals,
}

/// Derivatives by central differences, which are exact to ten digits here.
fn pieces(of: Residuals, at: &[f64]) -> Vec<Piece> {
    let mut all: Vec<Piece> = of(at)
        .into_iter()
        .map(|value| Piece {
            value,
            slope: vec![0.0; at.len()],
        })
        .collect();
    for k in 0..at.len() {
        let step = 1e-5 * at[k].abs().max(1e-2);
        let moved = |by: f64| {
            let mut to = at.to_vec();
            to[k] += by;
            of(&to)
        };
        for (piece, (low, high)) in all.iter_mut().zip(moved(-step).iter().zip(moved(step))) {
            piece.slope[k] = (high - low) / (2.0 * step);
        }
    }
    all
}

impl Squares for Case {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn square(&self, at: &[f64]) -> Option<(f64, Vec<f64>)> {
        let all = (self.residuals)(at);
        let sum: f64 = all.iter().map(|r| r * r).sum();
        sum.is_finite().then(|| (sum, (self.kept)(at)))
    }

    fn linear(&self, at: &[f64]) -> Option<Linear> {
        let kept = pieces(self.kept, at).into_iter();
        Some(Linear {
            residuals: pieces(self.residuals, at),
            constraints: kept.map(|piece| vec![piece]).collect(),
        })
    }
}

fn nothing(_: &[f64]) -> Vec<f64> {
    Vec::new()
}

fn led(bounds: &[[f64; 2]], residuals: Residuals, kept: Residuals, start: &[f64]) -> Descent {
    let case = Case {
        bounds: bounds.to_vec(),
        residuals,
        kept,
    };
    least_squares(&case, start, 500).unwrap()
}

fn free(residuals: Residuals, start: &[f64]) -> Descent {
    led(&vec![[-1e3, 1e3]; start.len()], residuals, nothing, start)
}

fn rosenbrock(x: &[f64]) -> Vec<f64> {
    vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
}

fn freudenstein_roth(x: &[f64]) -> Vec<f64> {
    vec![
        -13.0 + x[0] + ((5.0 - x[1]) * x[1] - 2.0) * x[1],
        -29.0 + x[0] + ((x[1] + 1.0) * x[1] - 14.0) * x[1],
    ]
}

fn helical(x: &[f64]) -> Vec<f64> {
    let turn = atan2(x[1], x[0]) / std::f64::consts::TAU;
    vec![
        10.0 * (x[2] - 10.0 * turn),
        10.0 * (hypot(x[0], x[1]) - 1.0),
        x[2],
    ]
}

fn powell(x: &[f64]) -> Vec<f64> {
    let (a, b) = (x[1] - 2.0 * x[2], x[0] - x[3]);
    vec![
        x[0] + 10.0 * x[1],
        5.0_f64.sqrt() * (x[2] - x[3]),
        a * a,
        10.0_f64.sqrt() * b * b,
    ]
}

fn wood(x: &[f64]) -> Vec<f64> {
    vec![
        10.0 * (x[1] - x[0] * x[0]),
        1.0 - x[0],
        90.0_f64.sqrt() * (x[3] - x[2] * x[2]),
        1.0 - x[2],
        10.0_f64.sqrt() * (x[1] + x[3] - 2.0),
        (x[1] - x[3]) / 10.0_f64.sqrt(),
    ]
}

fn bard(x: &[f64]) -> Vec<f64> {
    const Y: [f64; 15] = [
        0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39, 0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39,
    ];
    let one = |(i, y): (usize, &f64)| {
        let u = (i + 1) as f64;
        let v = 16.0 - u;
        y - (x[0] + u / (v * x[1] + u.min(v) * x[2]))
    };
    Y.iter().enumerate().map(one).collect()
}

fn kowalik_osborne(x: &[f64]) -> Vec<f64> {
    const Y: [f64; 11] = [
        0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246,
    ];
    const U: [f64; 11] = [
        4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625,
    ];
    let one = |(y, u): (&f64, &f64)| y - x[0] * (u * u + u * x[1]) / (u * u + u * x[2] + x[3]);
    Y.iter().zip(&U).map(one).collect()
}

fn box_three(x: &[f64]) -> Vec<f64> {
    let one = |i: i32| {
        let t = 0.1 * f64::from(i);
        exp(-t * x[0]) - exp(-t * x[1]) - x[2] * (exp(-t) - exp(-10.0 * t))
    };
    (1..=10).map(one).collect()
}

/// The least sums of squares as they are published, to their digits.
#[test]
fn published_minima_are_reached() {
    let cases: [(&str, Residuals, &[f64], f64); 8] = [
        ("Rosenbrock", rosenbrock, &[-1.2, 1.0], 0.0),
        (
            "Freudenstein and Roth, the lesser",
            freudenstein_roth,
            &[0.5, -2.0],
            48.9842,
        ),
        ("helical valley", helical, &[-1.0, 0.1, 0.2], 0.0),
        ("Powell, singular", powell, &[3.0, -1.0, 0.1, 1.0], 0.0),
        ("Wood", wood, &[-3.0, -1.0, -3.0, -1.0], 0.0),
        ("Bard", bard, &[1.0, 1.0, 1.0], 8.21487e-3),
        (
            "Kowalik and Osborne",
            kowalik_osborne,
            &[0.25, 0.39, 0.415, 0.39],
            3.07505e-4,
        ),
        ("Box", box_three, &[0.2, 10.1, 18.0], 0.0),
    ];
    for (name, residuals, start, least) in cases {
        let found = free(residuals, start);
        let off = (found.square - least).abs();
        assert!(off <= 1e-5 * least + 1e-14, "{name}: {found:?}");
    }
}

/// Hock and Schittkowski's second: Rosenbrock's valley above its floor.
#[test]
fn an_active_bound() {
    let bounds = [[-1e2, 1e2], [1.5, 1e2]];
    let found = led(&bounds, rosenbrock, nothing, &[2.0, 3.0]);
    assert_eq!(found.design[1], 1.5);
    assert!((found.square - 0.050_426_187_9).abs() < 1e-9, "{found:?}");
    assert!((found.design[0] - 1.224_370_749).abs() < 1e-7);
    // Bard's with its third variable no more than it may be: the others go where they would without it.
    let bounds = [[-1e2, 1e2], [-1e2, 1e2], [-1e2, 2.0]];
    let found = led(&bounds, bard, nothing, &[1.0, 1.0, 1.0]);
    assert_eq!(found.design[2], 2.0);
    let held: Residuals = |x| bard(&[x[0], x[1], 2.0]);
    let other = free(held, &[1.0, 1.0]);
    assert!((found.square - other.square).abs() < 1e-12 && found.square > 8.3e-3);
}

/// The 22nd and the 65th: a line and a parabola; a ball within a box, a bound of which is near.
#[test]
fn active_constraints() {
    let found = led(
        &[[-10.0, 10.0]; 2],
        |x| vec![x[0] - 2.0, x[1] - 1.0],
        |x| vec![x[0] + x[1] - 2.0, x[0] * x[0] - x[1]],
        &[2.0, 2.0],
    );
    assert!(
        (found.square - 1.0).abs() < 1e-7 && found.violation < 1e-8,
        "{found:?}"
    );
    let found = led(
        &[[-4.5, 4.5], [-4.5, 4.5], [-5.0, 5.0]],
        |x| vec![x[0] - x[1], (x[0] + x[1] - 10.0) / 3.0, x[2] - 5.0],
        |x| vec![x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 48.0],
        &[-5.0, 5.0, 0.0],
    );
    assert!((found.square - 0.953_528_856_7).abs() < 1e-5, "{found:?}");
    assert!(found.violation < 1e-6, "{found:?}");
}

/// A start outside of the box begins on it; one of which nothing is known ends nothing.
#[test]
fn starts_that_are_none() {
    let found = led(
        &[[-2.0, 0.5], [-2.0, 2.0]],
        rosenbrock,
        nothing,
        &[9.0, 9.0],
    );
    assert!(
        found.design[0] <= 0.5 && (found.square - 0.25).abs() < 1e-9,
        "{found:?}"
    );
    let case = Case {
        bounds: vec![[-1.0, 1.0]],
        residuals: |_| vec![f64::NAN],
        kept: nothing,
    };
    assert!(least_squares(&case, &[0.0], 10).is_none());
    assert!(least_squares(&case, &[0.0, 1.0], 10).is_none());
}
