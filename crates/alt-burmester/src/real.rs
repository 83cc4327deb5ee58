//! Which solutions of real data are linkages.

use kempe_linear::C;
use kempe_number::Number;

use crate::double::Double;
use crate::equations::{PIVOTS, State, Storage, UNKNOWNS, Way, Z, solve};
use crate::given::Given;

/// Hats that are the conjugates to this part of their size may be those of a real solution.
const NEARLY_REAL: f64 = 1e-6;
/// Hats of a real solution that has been improved are the conjugates to this part, and the improvement came from no farther.
const REAL: f64 = 1e-9;
/// Newton's corrections of the conjugate mean, and one after which the next changes no digit.
const CORRECTIONS: usize = 6;
const SETTLED: f64 = 1e-12;

/// The real solution that a solution of real data is, with its last digits improved and its hats exactly conjugate; `None` where it is not real.
pub fn real(given: &Given, state: &State) -> Option<State> {
    let unknowns = given.kind.unknowns();
    if !(apart(given, state) <= NEARLY_REAL) {
        return None;
    }
    // With twice the digits: of badly conditioned equations plain corrections are what rounding left, and no hat would stay conjugate.
    let mut near = mean(given, state).map(wide);
    let mut found = [[Z::zero(); UNKNOWNS]; 2];
    let mut storage = Storage::new();
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        solve(
            &Way::at(given),
            Double::from_f64(0.0),
            &near,
            &mut found,
            &mut storage,
        );
        let size = (0..unknowns)
            .map(|k| plain(found[0][k]).norm() / (1.0 + plain(near[k]).norm()))
            .fold(0.0, kempe_number::math::max);
        if !(size < last) {
            return None;
        }
        last = size;
        for k in 0..unknowns {
            near[k] -= found[0][k];
        }
        if last <= SETTLED {
            break;
        }
    }
    let better = near.map(plain);
    (last <= SETTLED && apart(given, &better) <= REAL).then(|| mean(given, &better))
}

fn wide(z: C) -> Z<Double> {
    Z::new(Double::from_f64(z.re), Double::from_f64(z.im))
}

fn plain(z: Z<Double>) -> C {
    C::new(z.re.high, z.im.high)
}

/// Where the hat of an unknown is.
const fn hat(unknown: usize) -> usize {
    if unknown < PIVOTS {
        unknown ^ 2
    } else {
        unknown ^ 1
    }
}

/// By how much hats differ from conjugates, beside their size.
fn apart(given: &Given, state: &State) -> f64 {
    (0..given.kind.unknowns())
        .map(|k| (state[k] - state[hat(k)].conj()).norm() / (1.0 + state[k].norm()))
        .fold(0.0, kempe_number::math::max)
}

/// The mean of a state and its conjugate.
fn mean(given: &Given, state: &State) -> State {
    let mut mean = [C::zero(); UNKNOWNS];
    for k in 0..given.kind.unknowns() {
        mean[k] = (state[k] + state[hat(k)].conj()).scale(0.5);
    }
    mean
}
