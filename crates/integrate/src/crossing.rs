//! Where something becomes zero within a step.

/// Halvings and secants before a crossing is as near as numbers go.
const STEPS: usize = 200;

/// The place between `low` and `high` where `value` changes its sign, to rounding, on the side of `high`: there it has its new
/// sign or is zero. `None` where both ends have one sign. (Illinois: secants that keep the sign change between them, with halvings.)
pub fn crossing(mut value: impl FnMut(f64) -> f64, low: f64, high: f64) -> Option<f64> {
    let (mut a, mut b) = (low, high);
    let (mut at_a, mut at_b) = (value(a), value(b));
    if at_b == 0.0 {
        return Some(b);
    }
    if !(at_a * at_b < 0.0) {
        return None;
    }
    for step in 0..STEPS {
        let secant = b - at_b * (b - a) / (at_b - at_a);
        let inside = (secant - a) * (secant - b) < 0.0;
        // Every third time in the middle, so that flat functions come to an end too.
        let middle = 0.5 * a + 0.5 * b;
        let next = if inside && step % 3 != 2 {
            secant
        } else {
            middle
        };
        if next == a || next == b || middle == a || middle == b {
            break;
        }
        let at_next = value(next);
        if at_next == 0.0 {
            return Some(next);
        }
        if at_next * at_b < 0.0 {
            (a, at_a) = (next, at_next);
            at_b *= 0.5;
        } else {
            (b, at_b) = (next, at_next);
            at_a *= 0.5;
        }
    }
    Some(b)
}
