//! Places that no coupler curve has, as they lie on one line or circle.
//!
//! A coupler curve is of sixth order, with triple points at both circular points (S. Roberts 1875): a line meets it in six points, a circle in
//! twelve, six of them the circular points. One with more of either is all of it. No four-bar of finite links has a line in its curve; circles
//! are drawn by the ends of its links and by couplers of parallelograms.

use kempe_linear::C;

use crate::error::{OnCurve, SynthesisError};

/// What a coupler curve has in common with a line or a circle at most.
const MOST: usize = 6;
/// Places are on a curve to this part of their spread.
const ON_CURVE: f64 = 1e-9;
/// Circles are told from lines up to this many times the spread.
const LARGEST: f64 = 1e6;

/// More than six places on one line or one circle, which no four-bar passes; lengths are in parts of about their spread.
pub(super) fn of_one_curve(places: &[C]) -> Result<(), SynthesisError> {
    if places.len() <= MOST {
        return Ok(());
    }
    for j in 1..places.len() {
        for i in 0..j {
            let along = places[j] - places[i];
            let length = along.norm();
            if length <= ON_CURVE {
                continue;
            }
            let off = |p: C| ((p - places[i]) * along.conj()).im / length;
            too_many(places, OnCurve::Line, off)?;
            for third in &places[j + 1..] {
                let Some((centre, radius)) = circle(places[i], places[j], *third) else {
                    continue;
                };
                too_many(places, OnCurve::Circle, |p| (p - centre).norm() - radius)?;
            }
        }
    }
    Ok(())
}

fn too_many(places: &[C], curve: OnCurve, off: impl Fn(C) -> f64) -> Result<(), SynthesisError> {
    let on = |k: &usize| off(places[*k]).abs() <= ON_CURVE;
    let met = (0..places.len()).filter(on);
    match (met.clone().count(), met.last()) {
        (count, Some(datum)) if count > MOST => Err(SynthesisError::OneCurve {
            curve,
            count,
            datum,
        }),
        _ => Ok(()),
    }
}

/// The circle through three points.
fn circle(a: C, b: C, c: C) -> Option<(C, f64)> {
    let (b, c) = (b - a, c - a);
    let twice = 2.0 * (b.conj() * c).im;
    let across = b.scale(c.norm() * c.norm()) - c.scale(b.norm() * b.norm());
    let centre = C::new(across.im / twice, -across.re / twice).scale(-1.0);
    let radius = centre.norm();
    (radius < LARGEST).then_some((a + centre, radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_are_those_through_three_points() {
        let made = |angle: f64| C::new(0.3, -2.0) + C::from_polar(1.7, angle);
        let (centre, radius) = circle(made(0.2), made(1.9), made(4.0)).unwrap();
        assert!((centre - C::new(0.3, -2.0)).norm() < 1e-14 && (radius - 1.7).abs() < 1e-14);
        assert!(circle(C::zero(), C::one(), C::new(2.0, 0.0)).is_none());
    }

    #[test]
    fn seven_are_too_many_and_six_are_not() {
        let others = [C::new(0.2, 0.9), C::new(-0.4, 0.6), C::new(0.1, -0.8)];
        let line = |k: usize| C::new(0.1 * k as f64, 0.3 - 0.05 * k as f64);
        let round = |k: usize| C::from_polar(0.7, 0.8 * k as f64);
        for (curve, made) in [
            (OnCurve::Line, &line as &dyn Fn(usize) -> C),
            (OnCurve::Circle, &round),
        ] {
            let six: Vec<C> = (0..6).map(made).chain(others).collect();
            assert_eq!(of_one_curve(&six), Ok(()));
            let seven: Vec<C> = (others[..2].iter().copied())
                .chain((0..7).map(made))
                .collect();
            let found = SynthesisError::OneCurve {
                curve,
                count: 7,
                datum: 8,
            };
            assert_eq!(of_one_curve(&seven), Err(found));
        }
    }
}
