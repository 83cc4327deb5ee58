//! Where a function that is positive at two places is negative between them.

/// Golden sections before the lowest place is as near as numbers go.
const STEPS: usize = 90;
const GOLDEN: f64 = 0.381_966_011_250_105;

/// A place between `low` and `high` where `value`, positive at both, is at most `below`, which is no more than zero; `None` where it is
/// nowhere, as far as it has one lowest place between them. (Golden sections, until it cannot fall so far as it would have to: it falls by less than
/// it rises to an end of what is left.)
pub fn dip(mut value: impl FnMut(f64) -> f64, low: f64, high: f64, below: f64) -> Option<f64> {
    let (mut a, mut b) = (low, high);
    let (mut at_a, mut at_b) = (value(a), value(b));
    let mut inner = [a + GOLDEN * (b - a), b - GOLDEN * (b - a)];
    let mut at = inner.map(&mut value);
    for _ in 0..STEPS {
        for (place, there) in inner.iter().zip(at) {
            if there <= below && there < 0.0 {
                return Some(*place);
            }
        }
        let left = at[0] <= at[1];
        match left {
            true => (b, at_b) = (inner[1], at[1]),
            false => (a, at_a) = (inner[0], at[0]),
        }
        let lowest = at[0].min(at[1]).min(at_a).min(at_b);
        let hopeless = 2.0 * lowest - at_a.max(at_b) > 0.0;
        if hopeless || !(at_a + at_b).is_finite() {
            return None;
        }
        match left {
            true => {
                inner = [a + GOLDEN * (b - a), inner[0]];
                at = [value(inner[0]), at[0]];
            }
            false => {
                inner = [inner[1], b - GOLDEN * (b - a)];
                at = [at[1], value(inner[1])];
            }
        }
        if !(a < inner[0] && inner[0] < inner[1] && inner[1] < b) {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dips_of_any_depth_and_place_are_found() {
        for at in [0.001, 0.3, 0.5, 0.77, 0.999] {
            for depth in [1.0, 1e-3, 1e-9] {
                let round = |t: f64| (t - at) * (t - at) - depth * depth;
                let sharp = |t: f64| (t - at).abs() - depth * depth;
                for value in [&round as &dyn Fn(f64) -> f64, &sharp] {
                    if value(0.0) <= 0.0 || value(1.0) <= 0.0 {
                        continue;
                    }
                    let found = dip(value, 0.0, 1.0, 0.0).unwrap_or_else(|| panic!("{at} {depth}"));
                    assert!(value(found) < 0.0 && 0.0 < found && found < 1.0);
                }
            }
        }
    }

    #[test]
    fn what_stays_above_has_none_and_is_left_soon() {
        for at in [-1.0, 0.0, 0.3, 2.0] {
            let mut asked = 0;
            let value = |t: f64| {
                asked += 1;
                (t - at) * (t - at) + 0.01
            };
            assert_eq!(dip(value, 0.0, 1.0, 0.0), None);
            assert!(asked < 20, "{at}: {asked}");
        }
        assert_eq!(dip(|t| (t - 0.3).abs(), 0.0, 1.0, 0.0), None);
        assert_eq!(dip(|_| f64::NAN, 0.0, 1.0, 0.0), None);
        assert_eq!(dip(|t| (t - 0.3).abs() - 1e-9, 0.0, 1.0, -1e-8), None);
    }
}
