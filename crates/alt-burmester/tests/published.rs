//! Published problems of nine points: how many coupler curves pass them, and which.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::ops::ControlFlow;
use std::time::Instant;

use kempe_alt_burmester::{Bounds, Given, Kind, StartSet, State, real, solve};
use kempe_linear::C;

/// The nine points of C. W. Wampler, A. P. Morgan and A. J. Sommese (1992), as in FourBarLinkages.jl.
const CURVE: [[f64; 2]; 9] = [
    [0.8961867, -0.09802917],
    [1.2156535, -1.18749100],
    [1.5151435, -0.85449808],
    [1.6754775, -0.48768058],
    [1.7138690, -0.30099232],
    [1.7215236, 0.03269953],
    [1.6642029, 0.33241088],
    [1.4984171, 0.74435576],
    [1.3011834, 0.92153806],
];
const OVAL: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [0.30, -0.1],
    [0.70, 0.0],
    [0.82, 0.2],
    [0.90, 0.4],
    [0.90, 0.7],
    [0.60, 0.7],
    [0.10, 0.5],
    [0.0, 0.3],
];
const TWO_CIRCLES: [[f64; 2]; 9] = [
    [0.25, 0.0],
    [0.52, 0.10],
    [0.80, 0.70],
    [1.20, 1.00],
    [1.40, 1.30],
    [1.10, 1.48],
    [0.70, 1.40],
    [0.20, 1.00],
    [0.02, 0.40],
];

fn point([x, y]: [f64; 2]) -> C {
    C::new(x, y)
}

fn given(points: &[[f64; 2]]) -> Given {
    let from = point(points[0]);
    let rest: Vec<C> = points[1..].iter().map(|p| point(*p) - from).collect();
    Given::real(Kind::NinePoints, &rest, &[]).unwrap()
}

fn go_on(_: usize, _: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn foci(first: C, s: &State) -> [C; 3] {
    let [x, a, y, b] = [s[0], s[1], s[4], s[5]];
    [a, b, (b * x - a * y) * (x - y).recip()].map(|f| f + first)
}

#[test]
fn three_problems_have_as_many_real_answers_as_published() {
    let start = StartSet::found(Kind::NinePoints).unwrap();
    for (points, finite, count, sum) in [
        (CURVE, 1439, 21, [14.8494037580915, -5.17763614354745]),
        (OVAL, 1441, 45, [20.3451555192636, 23.5268694834621]),
        (TWO_CIRCLES, 1442, 64, [73.8297506063861, 17.727322775489]),
    ] {
        let begin = Instant::now();
        let given = given(&points);
        let solved = solve(&start, &given, &go_on).unwrap();
        let found: Vec<State> = (solved.solutions.iter())
            .filter_map(|s| real(&given, s))
            .collect();
        let mut centroids = C::zero();
        for s in &found {
            let [a, b, c] = foci(point(points[0]), s);
            centroids += (a + b + c).scale(1.0 / 3.0);
        }
        println!(
            "{} finite, {} infinite, {} singular, {} lost; {} real, {:?}, {:.2} s",
            solved.solutions.len(),
            solved.infinite,
            solved.singular,
            solved.lost,
            found.len(),
            centroids,
            begin.elapsed().as_secs_f64()
        );
        assert_eq!(found.len(), count);
        let begin = Instant::now();
        let bounds = Bounds::of(&given);
        let proved: Vec<_> = found.iter().filter_map(|s| bounds.certify(s)).collect();
        println!(
            "{} proved, {:.1} us each",
            proved.len(),
            begin.elapsed().as_secs_f64() * 1e6 / count as f64
        );
        assert_eq!(proved.len(), count);
        for (k, one) in proved.iter().enumerate() {
            assert!(one.contains(&found[k]));
            assert!(proved[..k].iter().all(|other| one.differs(other)));
        }
        assert!((centroids - point(sum)).norm() < 1e-9);
        assert!(
            solved.solutions.len() >= finite,
            "{}",
            solved.solutions.len()
        );
    }
}
