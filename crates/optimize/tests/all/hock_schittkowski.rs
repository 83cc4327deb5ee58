//! Problems of W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes (1981), beside their published optima and multipliers.

use crate::support::hock_schittkowski::{
    Known, hs1, hs2, hs5, hs21, hs24, hs35, hs38, hs43, hs71, hs76, hs100, hs113,
};
use kempe_optimize::{Alone, Optimum, SqpOptions, silent, sqp};

/// The optimum from a start; that it is the published one.
fn solve<const N: usize>(name: &str, known: Known<N>) -> Optimum {
    let Known {
        case,
        start,
        optimum: published,
    } = known;
    let found = sqp(&case, &start, &SqpOptions::default(), &Alone, &mut silent);
    println!(
        "{name}: {:.10} ({published}) residual {:.1e} violation {:.1e} steps {} evaluations {} {:?} at {:?}",
        found.objective(),
        found.residual,
        found.violation,
        found.iterations,
        found.evaluations,
        found.ended,
        found.design
    );
    let missed = (found.objective() - published).abs() / published.abs().max(1.0);
    assert!(found.ended.is_optimal(), "{name}: {:?}", found.ended);
    assert!(missed < 1e-7, "{name}: {} {published}", found.objective());
    assert!(found.violation < 1e-8 && found.residual < 1e-6, "{name}");
    found
}

#[test]
fn hs1_a_valley_with_a_bound() {
    solve("HS1", hs1());
}

#[test]
fn hs2_a_valley_beyond_a_bound() {
    let found = solve("HS2", hs2());
    let cost = 200.0 * (1.5 - 1.224_370_749_f64 * 1.224_370_749);
    assert!((found.multipliers.bounds[1][0] - cost).abs() < 1e-3);
}

#[test]
fn hs5_a_sine() {
    solve("HS5", hs5());
}

#[test]
fn hs21_one_row() {
    let found = solve("HS21", hs21());
    // x stands on its least value, and costs 0.04 there.
    assert!((found.multipliers.bounds[0][0] - 0.04).abs() < 1e-8);
}

#[test]
fn hs24_a_vertex() {
    solve("HS24", hs24());
}

#[test]
fn hs35_a_quadratic() {
    let found = solve("HS35", hs35());
    assert!((found.multipliers.cost(0) - 2.0 / 9.0).abs() < 1e-7);
}

#[test]
fn hs38_a_product_of_valleys() {
    solve("HS38", hs38());
}

#[test]
fn hs43_of_rosen_and_suzuki() {
    let found = solve("HS43", hs43());
    for (cost, published) in (0..3)
        .map(|k| found.multipliers.cost(k))
        .zip([1.0, 0.0, 2.0])
    {
        assert!((cost - published).abs() < 1e-5, "{cost}");
    }
}

#[test]
fn hs71_an_equation_as_two_constraints() {
    solve("HS71", hs71());
}

#[test]
fn hs76_a_quadratic_with_bounds() {
    solve("HS76", hs76());
}

#[test]
fn hs100_seven_variables() {
    solve("HS100", hs100());
}

#[test]
fn hs113_ten_variables() {
    solve("HS113", hs113());
}
