//! Local optima of standard problems (W. Hock and K. Schittkowski 1981; minimax problems after K. Madsen and H. Schjaer-Jacobsen 1978).
#![allow(clippy::unwrap_used)]

mod support;

use kempe_number::Number;
use kempe_optimize::{Ended, Optimum, SqpOptions, silent, sqp};
use support::{D, Given, c, sq};

const WIDE: [f64; 2] = [-50.0, 50.0];

fn solve(mut problem: Given, start: &[f64]) -> Optimum {
    sqp(&mut problem, start, &SqpOptions::default(), &mut silent)
}

fn reaches(name: &str, problem: Given, start: &[f64], best: f64, at: &[f64]) -> Optimum {
    let found = solve(problem, start);
    let off = (found.objective() - best).abs();
    assert!(found.ended.is_optimal(), "{name}: {found:#?}");
    assert!(
        off <= 1e-7 * best.abs().max(1.0),
        "{name}: {} for {best}",
        found.objective()
    );
    for (x, y) in found.design.iter().zip(at) {
        assert!(
            (x - y).abs() < 1e-4 * y.abs().max(1.0),
            "{name}: {:?}",
            found.design
        );
    }
    assert!(
        found.residual < 1e-5 && found.violation < 1e-8,
        "{name}: {found:#?}"
    );
    found
}

fn rosenbrock(x: &[D]) -> D {
    c(100.0) * sq(x[1] - x[0] * x[0]) + sq(c(1.0) - x[0])
}

#[test]
fn without_constraints_and_with_bounds() {
    let hs1 =
        |bounds: [f64; 2]| Given::new(&[WIDE, bounds], [1, 0], |x| Some(vec![vec![rosenbrock(x)]]));
    reaches("HS1", hs1([-1.5, 50.0]), &[-2.0, 1.0], 0.0, &[1.0, 1.0]);
    // HS2: x2 >= 1.5 is active, and costs.
    let found = reaches(
        "HS2",
        hs1([1.5, 50.0]),
        &[1.3, 1.6],
        0.0504261879,
        &[1.224370749, 1.5],
    );
    let cost = found.multipliers.bounds[1][0];
    assert!(
        (cost - 200.0 * (1.5 - 1.224370749_f64 * 1.224370749)).abs() < 1e-3,
        "{cost}"
    );
    let hs5 = Given::new(&[[-1.5, 4.0], [-3.0, 3.0]], [1, 0], |x| {
        let sum = x[0] + x[1];
        let (s, _) = sum.sin_cos();
        Some(vec![vec![
            s + sq(x[0] - x[1]) - c(1.5) * x[0] + c(2.5) * x[1] + c(1.0),
        ]])
    });
    let best = -(3.0_f64.sqrt() / 2.0 + std::f64::consts::PI / 3.0);
    reaches("HS5", hs5, &[0.0, 0.0], best, &[-0.547197551, -1.547197551]);
    let hs38 = Given::new(&[[-10.0, 10.0]; 4], [1, 0], |x| {
        let f = rosenbrock(x)
            + c(90.0) * sq(x[3] - sq(x[2]))
            + sq(c(1.0) - x[2])
            + c(10.1) * (sq(x[1] - c(1.0)) + sq(x[3] - c(1.0)))
            + c(19.8) * (x[1] - c(1.0)) * (x[3] - c(1.0));
        Some(vec![vec![f]])
    });
    reaches("HS38", hs38, &[-3.0, -1.0, -3.0, -1.0], 0.0, &[1.0; 4]);
}

#[test]
fn with_constraints() {
    let hs21 = Given::new(&[[2.0, 50.0], WIDE], [1, 1], |x| {
        Some(vec![
            vec![c(0.01) * sq(x[0]) + sq(x[1]) - c(100.0)],
            vec![c(10.0) - c(10.0) * x[0] + x[1]],
        ])
    });
    reaches("HS21", hs21, &[2.0, -1.0], -99.96, &[2.0, 0.0]);
    let hs24 = Given::new(&[[0.0, 50.0]; 2], [1, 3], |x| {
        let r = 3.0_f64.sqrt();
        let f = (sq(x[0] - c(3.0)) - c(9.0)) * x[1] * x[1] * x[1] * c(1.0 / (27.0 * r));
        Some(vec![
            vec![f],
            vec![x[1] - x[0] * c(1.0 / r)],
            vec![-(x[0] + c(r) * x[1])],
            vec![x[0] + c(r) * x[1] - c(6.0)],
        ])
    });
    reaches("HS24", hs24, &[1.0, 0.5], -1.0, &[3.0, 3.0_f64.sqrt()]);
    let hs35 = Given::new(&[[0.0, 50.0]; 3], [1, 1], |x| {
        let f = c(9.0) - c(8.0) * x[0] - c(6.0) * x[1] - c(4.0) * x[2]
            + c(2.0) * sq(x[0])
            + c(2.0) * sq(x[1])
            + sq(x[2])
            + c(2.0) * x[0] * x[1]
            + c(2.0) * x[0] * x[2];
        Some(vec![vec![f], vec![x[0] + x[1] + c(2.0) * x[2] - c(3.0)]])
    });
    let found = reaches(
        "HS35",
        hs35,
        &[0.5; 3],
        1.0 / 9.0,
        &[4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0],
    );
    // What the constraint costs: df/db of the optimum as it is eased.
    assert!((found.multipliers.cost(0) - 2.0 / 9.0).abs() < 1e-6);
    let hs43 = Given::new(&[WIDE; 4], [1, 3], |x| {
        let [a, b, d, e] = [x[0], x[1], x[2], x[3]];
        let f = sq(a) + sq(b) + c(2.0) * sq(d) + sq(e) - c(5.0) * a - c(5.0) * b - c(21.0) * d
            + c(7.0) * e;
        Some(vec![
            vec![f],
            vec![sq(a) + sq(b) + sq(d) + sq(e) + a - b + d - e - c(8.0)],
            vec![sq(a) + c(2.0) * sq(b) + sq(d) + c(2.0) * sq(e) - a - e - c(10.0)],
            vec![c(2.0) * sq(a) + sq(b) + sq(d) + c(2.0) * a - b - e - c(5.0)],
        ])
    });
    reaches("HS43", hs43, &[0.0; 4], -44.0, &[0.0, 1.0, 2.0, -1.0]);
    let hs71 = Given::new(&[[1.0, 5.0]; 4], [1, 3], |x| {
        let f = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
        let ball = x.iter().fold(c(-40.0), |s, x| s + sq(*x));
        Some(vec![
            vec![f],
            vec![c(25.0) - x[0] * x[1] * x[2] * x[3]],
            vec![ball],
            vec![-ball],
        ])
    });
    reaches(
        "HS71",
        hs71,
        &[1.0, 5.0, 5.0, 1.0],
        17.0140173,
        &[1.0, 4.7429994, 3.8211503, 1.3794082],
    );
    let hs76 = Given::new(&[[0.0, 50.0]; 4], [1, 3], |x| {
        let f = sq(x[0]) + c(0.5) * sq(x[1]) + sq(x[2]) + c(0.5) * sq(x[3]) - x[0] * x[2]
            + x[2] * x[3]
            - x[0]
            - c(3.0) * x[1]
            + x[2]
            - x[3];
        Some(vec![
            vec![f],
            vec![x[0] + c(2.0) * x[1] + x[2] + x[3] - c(5.0)],
            vec![c(3.0) * x[0] + x[1] + c(2.0) * x[2] - x[3] - c(4.0)],
            vec![c(1.5) - x[1] - c(4.0) * x[2]],
        ])
    });
    let found = reaches(
        "HS76",
        hs76,
        &[0.5; 4],
        -4.6818181818,
        &[0.2727273, 2.0909091, 0.0, 0.5454545],
    );
    assert!(found.multipliers.cost(0) > 0.1);
    let hs100 = Given::new(&[WIDE; 7], [1, 4], |x| {
        let p = |x: D, n: i32| (1..n).fold(x, |y, _| y * x);
        let f = sq(x[0] - c(10.0))
            + c(5.0) * sq(x[1] - c(12.0))
            + p(x[2], 4)
            + c(3.0) * sq(x[3] - c(11.0))
            + c(10.0) * p(x[4], 6)
            + c(7.0) * sq(x[5])
            + p(x[6], 4)
            - c(4.0) * x[5] * x[6]
            - c(10.0) * x[5]
            - c(8.0) * x[6];
        Some(vec![
            vec![f],
            vec![
                c(2.0) * sq(x[0]) + c(3.0) * p(x[1], 4) + x[2] + c(4.0) * sq(x[3]) + c(5.0) * x[4]
                    - c(127.0),
            ],
            vec![c(7.0) * x[0] + c(3.0) * x[1] + c(10.0) * sq(x[2]) + x[3] - x[4] - c(282.0)],
            vec![c(23.0) * x[0] + sq(x[1]) + c(6.0) * sq(x[5]) - c(8.0) * x[6] - c(196.0)],
            vec![
                c(4.0) * sq(x[0]) + sq(x[1]) - c(3.0) * x[0] * x[1]
                    + c(2.0) * sq(x[2])
                    + c(5.0) * x[5]
                    - c(11.0) * x[6],
            ],
        ])
    });
    reaches(
        "HS100",
        hs100,
        &[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0],
        680.6300573,
        &[
            2.330499, 1.951372, -0.4775414, 4.365726, -0.6244870, 1.038131, 1.594227,
        ],
    );
}

#[test]
fn the_largest_of_several() {
    // C. Charalambous and J. W. Bandler (1976), problems 1 and 2.
    let cb = Given::new(&[[-10.0, 10.0]; 2], [1, 0], |x| {
        let three = c(2.0) * (x[1] - x[0]).exp();
        Some(vec![vec![
            sq(x[0]) + sq(x[1]) * sq(x[1]),
            sq(c(2.0) - x[0]) + sq(c(2.0) - x[1]),
            three,
        ]])
    });
    let found = reaches("CB2", cb, &[2.0, 2.0], 1.9522245, &[1.139038, 0.899560]);
    let shares = &found.multipliers.objectives[0];
    assert!(
        (shares.iter().sum::<f64>() - 1.0).abs() < 1e-9 && shares[2] < 1e-9,
        "{shares:?}"
    );
    let cb3 = Given::new(&[[-10.0, 10.0]; 2], [1, 0], |x| {
        let three = c(2.0) * (x[1] - x[0]).exp();
        Some(vec![vec![
            sq(sq(x[0])) + sq(x[1]),
            sq(c(2.0) - x[0]) + sq(c(2.0) - x[1]),
            three,
        ]])
    });
    reaches("CB3", cb3, &[2.0, 2.0], 2.0, &[1.0, 1.0]);
    // J. B. Rosen and S. Suzuki (1965) as a minimax problem.
    let rosen = Given::new(&[WIDE; 4], [1, 0], |x| {
        let [a, b, d, e] = [x[0], x[1], x[2], x[3]];
        let f =
            sq(a) + sq(b) + c(2.0) * sq(d) + sq(e) - c(5.0) * (a + b) - c(21.0) * d + c(7.0) * e;
        let ten = |g: D| f - c(10.0) * g;
        Some(vec![vec![
            f,
            ten(c(8.0) - sq(a) - sq(b) - sq(d) - sq(e) - a + b - d + e),
            ten(c(10.0) - sq(a) - c(2.0) * sq(b) - sq(d) - c(2.0) * sq(e) + a + e),
            ten(c(5.0) - c(2.0) * sq(a) - sq(b) - sq(d) - c(2.0) * a + b + e),
        ]])
    });
    reaches(
        "Rosen-Suzuki",
        rosen,
        &[0.0; 4],
        -44.0,
        &[0.0, 1.0, 2.0, -1.0],
    );
}

#[test]
fn what_cannot_be_kept_together_is_named() {
    // x >= 2 and x <= 1 cannot both be; the third can.
    let problem = Given::new(&[[-5.0, 5.0]; 2], [1, 3], |x| {
        Some(vec![
            vec![sq(x[0]) + sq(x[1])],
            vec![c(2.0) - x[0]],
            vec![x[0] - c(1.0)],
            vec![x[1] - c(4.0)],
        ])
    });
    let found = solve(problem, &[0.0, 3.0]);
    assert_eq!(found.ended, Ended::Infeasible, "{found:#?}");
    let named: Vec<usize> = found
        .conflict
        .iter()
        .filter(|(_, share)| *share > 1e-6)
        .map(|(k, _)| *k)
        .collect();
    assert!(
        named.len() == 2 && named.contains(&0) && named.contains(&1),
        "{named:?}"
    );
}

#[test]
fn where_it_is_not_defined_steps_are_shorter() {
    // The root is not there beyond 1; the least lies near it.
    let problem = Given::new(&[[-5.0, 5.0]], [1, 0], |x| {
        let inside = c(1.0) - x[0];
        (inside.re > 0.0).then(|| vec![vec![-x[0] - inside.ln() * c(0.1)]])
    });
    let found = solve(problem, &[-4.0]);
    assert!(
        found.ended.is_optimal() && (found.design[0] - 0.9).abs() < 1e-5,
        "{found:#?}"
    );
}

#[test]
fn constraints_twice_over_do_not_matter() {
    let problem = Given::new(&[WIDE; 2], [1, 4], |x| {
        let g = c(1.0) - x[0] - x[1];
        Some(vec![
            vec![sq(x[0]) + sq(x[1])],
            vec![g, g],
            vec![g],
            vec![c(2.0) * g],
            vec![g * c(1.0 + 1e-12)],
        ])
    });
    let found = reaches("twice", problem, &[3.0, -2.0], 0.5, &[0.5, 0.5]);
    let cost: f64 = [1.0, 1.0, 2.0, 1.0]
        .iter()
        .enumerate()
        .map(|(k, s)| s * found.multipliers.cost(k))
        .sum();
    assert!((cost - 1.0).abs() < 1e-5, "{cost}");
}
