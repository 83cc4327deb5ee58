//! Which solutions of real data are linkages.

use kempe_linear::C;

use crate::double::Double;
use crate::equations::{PIVOTS, State, Storage, UNKNOWNS, Way, Z, correction, solve};
use crate::given::Given;

/// Hats that are the conjugates to this part of their size may be those of a real solution.
const NEARLY_REAL: f64 = 1e-6;
/// Hats of a real solution that has been improved are the conjugates to this part, and the improvement came from no farther.
const REAL: f64 = 1e-9;
/// Newton's corrections of the conjugate mean.
const CORRECTIONS: usize = 6;

/// The real solution that a solution of real data is, with its last digits improved and its hats exactly conjugate; `None` where it is not real.
pub fn real(given: &Given, state: &State) -> Option<State> {
    let unknowns = given.kind.unknowns();
    if !(apart(given, state) <= NEARLY_REAL) {
        return None;
    }
    let mut near = mean(given, state);
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let step = correction(given, &near)?;
        let size = (0..unknowns)
            .map(|k| step[k].norm() / (1.0 + near[k].norm()))
            .fold(0.0, kempe_number::math::max);
        if !(size < last) {
            break;
        }
        last = size;
        for k in 0..unknowns {
            near[k] -= step[k];
        }
    }
    let fits = last <= NEARLY_REAL && apart(given, &near) <= REAL;
    fits.then(|| mean(given, &in_double(given, &mean(given, &near))))
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

/// One correction with twice the digits.
fn in_double(given: &Given, state: &State) -> State {
    let wide = |z: &C| {
        Z::new(
            Double {
                high: z.re,
                low: 0.0,
            },
            Double {
                high: z.im,
                low: 0.0,
            },
        )
    };
    let at: [Z<Double>; UNKNOWNS] = std::array::from_fn(|k| wide(&state[k]));
    let mut found = [[Z::zero(); UNKNOWNS]; 2];
    solve(
        &Way::at(given),
        wide(&C::zero()).re,
        &at,
        &mut found,
        &mut Storage::new(),
    );
    let better: State = std::array::from_fn(|k| {
        let z = at[k] - found[0][k];
        C::new(z.re.high, z.im.high)
    });
    if better.iter().all(|z| z.is_finite()) {
        better
    } else {
        *state
    }
}
