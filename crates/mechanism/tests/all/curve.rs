//! Smooth curves on every kind of number.
#![allow(
    clippy::disallowed_methods,
    reason = "std's functions are good enough to expect a value"
)]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use kempe_mechanism::curve::LocalCurve;
use kempe_mechanism::pose::Pose;
use kempe_number::{Dual, Interval, Lanes4, Number};

const POINTS: [[f64; 2]; 7] = [
    [0.31, 0.02],
    [0.21, 0.24],
    [-0.04, 0.33],
    [-0.24, 0.17],
    [-0.27, -0.11],
    [-0.02, -0.26],
    [0.19, -0.23],
];

fn curve<T: Number>(closed: bool) -> LocalCurve<T> {
    LocalCurve::through(&POINTS.map(|p| p.map(T::from_f64)), closed)
}

fn shoe<T: Number>(angle: T) -> Pose<T> {
    Pose::from_angle(T::zero(), T::zero(), angle)
}

/// Angles of the shoe all over the curve; on an open one beyond its ends too.
fn angles(closed: bool) -> impl Iterator<Item = f64> {
    let reach = if closed { PI } else { 0.6 * PI };
    (0..=200).map(move |k| reach * (f64::from(k) / 100.0 - 1.0) * 0.999)
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn a_curve_goes_through_its_points_from_end_to_end() {
    for closed in [false, true] {
        let curve = curve::<f64>(closed);
        for (place, point) in curve.along(1).iter().zip(POINTS) {
            assert!(apart(place.place, point) < 1e-15);
            assert!(curve.distance(point) < 1e-15);
        }
        assert_eq!(curve.along(1).len(), 7);
        let [first, last] = [-FRAC_PI_2, FRAC_PI_2].map(|a| curve.at(&shoe(a), 0.0).place);
        if closed {
            assert!(apart(curve.at(&shoe(0.0), 0.0).place, POINTS[0]) < 1e-15);
        } else {
            assert!(apart(first, POINTS[0]) < 1e-15 && apart(last, POINTS[6]) < 1e-15);
        }
    }
}

/// Place, first and second derivative do not jump, at the joint of a closed curve's ends neither; turns do not count.
#[test]
fn a_curve_is_smooth_all_along() {
    const H: f64 = 1e-4;
    for closed in [false, true] {
        let curve = curve::<f64>(closed);
        let rate = |angle: f64| curve.at(&shoe(angle), angle).rate;
        for angle in angles(closed).chain(closed.then_some(PI)) {
            let second = |from: f64| {
                let (a, b) = (rate(from - H), rate(from + H));
                [(b[0] - a[0]) / (2.0 * H), (b[1] - a[1]) / (2.0 * H)]
            };
            assert!(apart(second(angle), second(angle + H)) < 0.01, "{angle}");
            if closed {
                for turns in [-3.0, 1.0, 20.0] {
                    let there = curve.at(&shoe(angle), angle + turns * TAU).place;
                    assert!(apart(there, curve.at(&shoe(angle), angle).place) < 1e-13);
                }
            }
        }
    }
}

/// To the shoe's angle and to a coordinate of a point.
#[test]
fn derivatives_agree_with_differences() {
    const H: f64 = 1e-5;
    for closed in [false, true] {
        let plain = curve::<f64>(closed);
        let moved = |by: f64| {
            let mut points = POINTS;
            points[2][1] += by;
            LocalCurve::through(&points, closed)
        };
        let (less, more) = (moved(-H), moved(H));
        type D = Dual<f64, 1>;
        let mut points = POINTS.map(|p| p.map(D::constant));
        points[2][1] = D::variable(POINTS[2][1], 0);
        let varied = LocalCurve::through(&points, closed);
        for angle in angles(closed) {
            let at = plain.at(&shoe(angle), angle);
            let turned = curve::<D>(closed).at(&shoe(D::variable(angle, 0)), angle);
            let wanted = turned.place.map(|x| x.eps[0]);
            assert!(apart(at.rate, wanted) < 1e-13, "{angle}");
            let (a, b) = (
                less.at(&shoe(angle), angle).place,
                more.at(&shoe(angle), angle).place,
            );
            let wanted = [(b[0] - a[0]) / (2.0 * H), (b[1] - a[1]) / (2.0 * H)];
            let found = varied.at(&shoe(D::constant(angle)), angle).place;
            assert!(apart(found.map(|x| x.eps[0]), wanted) < 1e-8, "{angle}");
        }
    }
}

#[test]
fn lanes_on_several_pieces_are_what_each_is_alone() {
    for closed in [false, true] {
        let (wide, plain) = (curve::<Lanes4>(closed), curve::<f64>(closed));
        for angle in angles(closed) {
            let all: [f64; 4] = std::array::from_fn(|k| angle * (1.0 - 0.3 * k as f64));
            let found = wide.at(&shoe(kempe_number::Lanes(all)), 0.0);
            for (k, angle) in all.into_iter().enumerate() {
                let alone = plain.at(&shoe(angle), 0.0);
                for axis in 0..2 {
                    let pairs = [
                        (found.place[axis].0[k], alone.place[axis]),
                        (found.rate[axis].0[k], alone.rate[axis]),
                    ];
                    for (a, b) in pairs {
                        assert!((a - b).abs() < 1e-15, "{angle} {a} {b}");
                    }
                }
            }
        }
    }
}

#[test]
fn intervals_hold_all_that_is_within() {
    for closed in [false, true] {
        let (wide, plain) = (curve::<Interval>(closed), curve::<f64>(closed));
        for (angle, radius) in angles(closed).zip([1e-9, 1e-3, 0.05, 0.4].into_iter().cycle()) {
            let found = wide.at(&shoe(Interval::around(angle, radius)), angle);
            for part in [-1.0, -0.3, 0.0, 0.7, 1.0] {
                let at = plain.at(&shoe(angle + part * radius), angle);
                for axis in 0..2 {
                    assert!(
                        found.place[axis].contains(at.place[axis]),
                        "{angle} {radius}"
                    );
                    assert!(found.rate[axis].contains(at.rate[axis]), "{angle} {radius}");
                }
            }
            if radius < 1e-8 {
                assert!(found.place[0].width() < 1e-7);
            }
        }
    }
}

/// Points of a parabola give it back from end to end and beyond: no knot is felt.
#[test]
fn three_points_are_a_parabola() {
    let points = [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]];
    let curve = LocalCurve::through(&points, false);
    for angle in angles(false) {
        let [x, y] = curve.at(&shoe(angle), 0.0).place;
        assert!((y - x * x).abs() < 1e-14 * (1.0 + y));
    }
}
