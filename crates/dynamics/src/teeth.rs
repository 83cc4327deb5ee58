//! Forces at the teeth of involute gears and racks, from their pressure angle and numbers of teeth.
//!
//! Teeth touch on the pressure line, which passes the pitch point under the pressure angle `alpha` to the common tangent of
//! the pitch circles. With `F` the force along that tangent, the normal force is `N = F / cos(alpha)`, and its part
//! `F tan(alpha)` across the tangent parts the wheels, whichever flank carries.
//!
//! At a distance `s` from the pitch point teeth slide with `s` times the speed at which one wheel turns against the other,
//! and turn about as they pass it. What friction does over a mesh is therefore a moment on each wheel against their turning
//! against each other, `mu N e` with `e` the mean of `s`. Wheels that turn as one block with their arm lose nothing.
//!
//! The mean, loads shared evenly by all pairs in contact, is that of the tooth loss factor `H = pi (1 / z_1 + 1 / z_2)
//! (1 - e_1 - e_2 + e_1^2 + e_2^2)` (H. Ohlendorf, 1958; G. Niemann, H. Winter, "Maschinenelemente II", 1989; ISO/TR 14179-2):
//! the part of its power that a mesh loses is about `mu H`. `e_1` and `e_2` tell how far contact reaches beyond the pitch
//! point on either side, in base pitches, here of teeth by ISO 53 without shift, a module high above the pitch circle. What
//! is left of the friction force itself, where it does not reach equally far on both sides, is left out: it acts at the pitch
//! point, where it takes no power.

use std::f64::consts::PI;

use kempe_number::Number;

/// What the teeth of a mesh do, over the force along the common tangent of the pitch circles.
#[derive(Clone, Copy, Debug)]
pub struct Teeth<T> {
    /// Tangent of the pressure angle: the force that parts the wheels.
    pub tangent: T,
    /// The normal force.
    pub secant: T,
    /// Mean distance of the contact from the pitch point, over half the module.
    pub path: T,
}

impl<T: Number> Teeth<T> {
    /// Of two wheels with these numbers of teeth, negative for a ring, `None` for a rack.
    pub fn new(angle: T, teeth: [Option<T>; 2]) -> Self {
        let (s, c) = angle.sin_cos();
        let tangent = s / c;
        let [a, b] = teeth;
        let reach = |own: Option<T>, other: Option<T>| {
            let by_tip = match own {
                Some(teeth) => {
                    let outside = ((teeth + 2.0) / (teeth * c)).square() - 1.0;
                    // Teeth end at the base circle: there is no involute inside.
                    let tip = outside.choose_with(|| outside.sqrt(), T::zero);
                    teeth * (tip - tangent) / (2.0 * PI)
                }
                None => T::one() / (s * c * PI),
            };
            match other {
                // The other's involutes begin at its base circle; those of a ring go on.
                Some(teeth) => {
                    let least = teeth * tangent / (2.0 * PI);
                    teeth.choose_with(|| by_tip.min(least), || by_tip)
                }
                None => by_tip,
            }
        };
        let (first, second) = (reach(a, b), reach(b, a));
        let mean = first.square() + second.square() - first - second + 1.0;
        Self {
            tangent,
            secant: T::one() / c,
            path: mean * c * PI,
        }
    }

    /// The numbers of teeth of a pair from the factors with which it ties its angles, the second negative where one of the two
    /// is a ring, and how much of them is a tooth.
    pub fn numbers(first: T, second: T, tooth: T) -> [Option<T>; 2] {
        let (a, b) = (first / tooth, second / tooth);
        // Of a ring and its wheel the larger is the ring.
        let ring_first = || (a + b).choose(T::one(), -T::one());
        let sign = second.choose_with(T::one, || -ring_first());
        [a * sign, b * sign].map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads shared evenly by all pairs in contact, added up along the path of contact in small steps.
    fn mean_distance(reach: [f64; 2]) -> f64 {
        let steps = 20_000;
        let mut sum = 0.0;
        for k in 0..steps {
            let phase = (f64::from(k) + 0.5) / f64::from(steps);
            let mut pairs = Vec::new();
            for pair in -3..=3 {
                let s = phase + f64::from(pair);
                if s > -reach[0] && s < reach[1] {
                    pairs.push(s.abs());
                }
            }
            sum += pairs.iter().sum::<f64>() / pairs.len() as f64;
        }
        sum / f64::from(steps)
    }

    /// Where the circles of tips cross the pressure line, in base pitches from the pitch point: by the law of cosines.
    fn crossing(teeth: f64, tip: f64, angle: f64) -> f64 {
        let (s, c) = kempe_number::math::sin_cos(angle);
        let root = |r: f64| f64::sqrt(r * r - (teeth * c).square()) / 2.0;
        (root(tip) - teeth * s / 2.0).abs() / (PI * c)
    }

    #[test]
    fn the_mean_distance_is_that_along_the_path_of_contact() {
        let angle = 20.0_f64.to_radians();
        for (numbers, tips) in [
            ([20.0, 40.0], [22.0, 42.0]),
            ([31.0, 31.0], [33.0, 33.0]),
            // A wheel in a ring: the tips of the ring stand inside its pitch circle.
            ([24.0, -90.0], [26.0, 88.0]),
        ] {
            let reach = [0, 1].map(|i| crossing(f64::abs(numbers[i]), tips[i], angle));
            let found = Teeth::new(angle, numbers.map(Some));
            // Half the module is 1: a base pitch is 2 pi cos(angle).
            let expected = mean_distance(reach) * 2.0 * PI * kempe_number::math::cos(angle);
            let error = (found.path - expected).abs();
            let limit = if reach[0].max(reach[1]) > 1.0 {
                0.05
            } else {
                1e-3
            };
            assert!(
                error < limit * expected,
                "{numbers:?}: {} {expected}",
                found.path
            );
        }
    }

    /// A rack is a wheel without end, and few teeth are cut off where their involutes begin.
    #[test]
    fn a_rack_is_the_limit_of_a_wheel() {
        let angle = 20.0_f64.to_radians();
        for pinion in [8.0, 15.0, 30.0] {
            let wheel = Teeth::new(angle, [Some(pinion), Some(1e7)]);
            let ring = Teeth::new(angle, [Some(pinion), Some(-1e7)]);
            let rack = Teeth::new(angle, [None, Some(pinion)]);
            assert!((wheel.path - rack.path).abs() < 1e-5, "{wheel:?} {rack:?}");
            assert!((ring.path - rack.path).abs() < 1e-5, "{ring:?} {rack:?}");
        }
    }
}
