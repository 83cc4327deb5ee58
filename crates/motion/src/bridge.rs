//! Across a change point: the motion is smooth there, but the constraints alone do not determine its derivatives.
//!
//! The series on both sides are joined by the polynomial that agrees with all their coefficients (Hermite
//! interpolation, divided differences with repeated points).

use kempe_mechanism::Design;
use kempe_mechanism::pose::Pose;
use kempe_number::{Jet, Number};

use crate::events::Event;
use crate::motion::{Motion, Solver};

/// Coefficients taken from each side.
const SIDE_ORDER: usize = 6;

/// The series on one side.
pub type SideSeries = Jet<f64, SIDE_ORDER>;

/// The poses at a path parameter within the bridge of a change point, as series joined from both sides. `solver` is
/// storage.
pub fn across<const N: usize>(
    motion: &Motion,
    design: &Design<SideSeries>,
    event: &Event,
    p: f64,
    solver: &mut Solver<SideSeries>,
) -> Vec<Pose<Jet<f64, N>>> {
    let (at, half) = (event.at, event.bridge);
    let low = solve_sides(motion, design, [at - half, at + half], solver);
    let joined = |low: &SideSeries, high: &SideSeries| join(low, high, half, p - at);
    low.iter()
        .zip(&solver.state.poses)
        .map(|(low, high)| Pose {
            x: joined(&low.x, &high.x),
            y: joined(&low.y, &high.y),
            c: joined(&low.c, &high.c),
            s: joined(&low.s, &high.s),
        })
        .collect()
}

/// Solves on both sides: returns the poses on the first, leaves those on the second in `solver`. Apart, so that solving is
/// compiled here and once, not for every order in every crate that asks.
fn solve_sides(
    motion: &Motion,
    design: &Design<SideSeries>,
    at: [f64; 2],
    solver: &mut Solver<SideSeries>,
) -> Vec<Pose<SideSeries>> {
    motion.solve(design, Jet::variable(at[0]), solver);
    let first = solver.state.poses.clone();
    motion.solve(design, Jet::variable(at[1]), solver);
    first
}

/// The series at `at_from_center` of the polynomial through two series given `half` to either side of a center, of which as many coefficients
/// are taken as [`SideSeries`] has at most.
pub fn join<B: Number, const S: usize, const N: usize>(
    low: &Jet<B, S>,
    high: &Jet<B, S>,
    half: f64,
    at_from_center: B,
) -> Jet<B, N> {
    let each = S.min(SIDE_ORDER);
    let all = 2 * each;
    // In the variable u = (p - center) / half the points are -1 and +1.
    let mut scaled = [[B::zero(); SIDE_ORDER]; 2];
    let mut power = 1.0;
    for k in 0..each {
        scaled[0][k] = low.coefficient(k) * power;
        scaled[1][k] = high.coefficient(k) * power;
        power *= half;
    }
    let node = |i: usize| if i < each { -1.0 } else { 1.0 };
    let side = |i: usize| usize::from(i >= each);
    // Divided differences of rising order; within one side they are the Taylor coefficients.
    let mut table = [B::zero(); 2 * SIDE_ORDER];
    for (i, entry) in table.iter_mut().enumerate().take(all) {
        *entry = scaled[side(i)][0];
    }
    let mut newton = [B::zero(); 2 * SIDE_ORDER];
    newton[0] = table[0];
    for order in 1..all {
        for i in 0..all - order {
            table[i] = if side(i) == side(i + order) {
                scaled[side(i)][order]
            } else {
                (table[i + 1] - table[i]) / (node(i + order) - node(i))
            };
        }
        newton[order] = table[0];
    }
    // Newton's form, evaluated as a series at the wanted place.
    let u = Jet::<B, N>::variable(at_from_center / half);
    let mut sum = Jet::<B, N>::constant(newton[all - 1]);
    for i in (0..all - 1).rev() {
        sum = sum * (u - node(i)) + Jet::constant(newton[i]);
    }
    let mut coefficients = *sum.coefficients();
    let mut power = 1.0;
    for c in &mut coefficients {
        *c = *c * power;
        power /= half;
    }
    Jet::from_coefficients(coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joins_a_smooth_function_to_full_accuracy() {
        let f = |p: f64| Jet::<f64, SIDE_ORDER>::variable(p).sin_cos().0;
        let (center, half) = (0.7, 0.03);
        let joined: Jet<f64, 5> = join(&f(center - half), &f(center + half), half, 0.004);
        let truth = Jet::<f64, 5>::variable(center + 0.004).sin_cos().0;
        for k in 0..5 {
            let tolerance = [1e-15, 1e-14, 1e-12, 1e-10, 1e-8][k];
            assert!(
                (joined.derivative(k) - truth.derivative(k)).abs() < tolerance,
                "order {k}"
            );
        }
    }
}
