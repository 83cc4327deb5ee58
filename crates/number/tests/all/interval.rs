//! Containment: whatever numbers are taken from the arguments, the result of the operation is in the interval.

use std::f64::consts::PI;

use kempe_number::{Dual, Interval, Jet, Number, math, powi};
use proptest::prelude::*;

/// A finite number of any size, often with a small exponent, sometimes an exact special.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -10.0..10.0,
        2 => (-1.0..1.0, -300..300).prop_map(|(m, e)| m * powi(10.0, e)),
        1 => prop::num::f64::ANY.prop_filter("finite", |x| x.is_finite()),
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, PI]),
    ]
}

/// An interval and a number in it: degenerate, narrow, wide, half-unbounded or the whole line.
fn member() -> impl Strategy<Value = (Interval, f64)> {
    (number(), number(), number(), 0..8, -20..3).prop_map(|(a, b, c, kind, scale)| {
        let mut three = [a, b, c];
        three.sort_by(f64::total_cmp);
        let [lo, middle, hi] = three;
        let narrow = b.abs().min(1.0) * powi(10.0, scale);
        match kind {
            0 => (Interval::from_f64(a), a),
            1 | 2 => (Interval::new(a - narrow, a + narrow), a),
            3 => (Interval::new(lo, f64::INFINITY), middle),
            4 => (Interval::new(f64::NEG_INFINITY, hi), middle),
            5 => (Interval::new(lo, hi), lo),
            6 => (Interval::new(lo, hi), hi),
            _ => (Interval::new(lo, hi), middle),
        }
    })
}

/// Whether the plain result `x` is in `bounds`: infinity stands for overflow and needs an infinite bound, NaN is 0/0.
fn holds(bounds: Interval, x: f64) -> bool {
    x.is_nan() || bounds.contains(x)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8192))]

    #[test]
    fn arithmetic((a, x) in member(), (b, y) in member()) {
        prop_assert!(a.contains(x) && b.contains(y));
        prop_assert!(holds(a + b, x + y), "{a:?} + {b:?} = {:?} without {}", a + b, x + y);
        prop_assert!(holds(a - b, x - y), "{a:?} - {b:?}");
        prop_assert!(holds(a * b, x * y), "{a:?} * {b:?} = {:?} without {}", a * b, x * y);
        prop_assert!(holds(a / b, x / y), "{a:?} / {b:?} = {:?} without {}", a / b, x / y);
        prop_assert!(holds(-a, -x) && holds(a.abs(), x.abs()) && holds(a.square(), x * x));
        prop_assert!(holds(a.min(b), x.min(y)) && holds(a.max(b), x.max(y)));
        prop_assert!(holds(a + y, x + y) && holds(a - y, x - y) && holds(a * y, x * y) && holds(a / y, x / y));
        prop_assert!(holds(a.hull(b), x) && holds(a.hull(b), y));
        prop_assert_eq!(a.intersect(b).contains(x), b.contains(x));
        prop_assert!(![a + b, a - b, a * b, a / b, a.square(), a.abs()].iter().any(|r| r.is_empty()));
    }

    #[test]
    fn functions((a, x) in member(), (b, y) in member()) {
        let ((s, c), (sin, cos)) = (a.sin_cos(), math::sin_cos(x));
        prop_assert!(s.contains(sin), "sin {a:?} = {s:?} without sin {x} = {sin}");
        prop_assert!(c.contains(cos), "cos {a:?} = {c:?} without cos {x} = {cos}");
        prop_assert!(holds(a.exp(), math::exp(x)));
        let angle = math::atan2(x, y);
        prop_assert!(a.atan2(b).contains(angle), "atan2({a:?}, {b:?}) = {:?} without {angle}", a.atan2(b));
        if x >= 0.0 {
            prop_assert!(a.sqrt().contains(x.sqrt()));
        }
        if x > 0.0 {
            prop_assert!(a.ln().contains(math::ln(x)));
        }
    }

    #[test]
    fn sums_round_outward(x in number(), y in number()) {
        // Knuth's two-sum gives the error of x + y exactly; the interval must cover it.
        let sum = x + y;
        prop_assume!(x.abs() < 1e300 && y.abs() < 1e300);
        let z = sum - x;
        let error = (x - (sum - z)) + (y - z);
        let r = Interval::from_f64(x) + Interval::from_f64(y);
        prop_assert!(r.lo() <= sum && sum <= r.hi());
        prop_assert!(error >= 0.0 || r.lo() < sum);
        prop_assert!(error <= 0.0 || r.hi() > sum);
    }

    #[test]
    fn sine_and_cosine_over_many_widths(start in -1e4..1e4_f64, scale in -16..3, part in 0.0..1.0_f64) {
        let width = powi(10.0, scale);
        let a = Interval::new(start, start + width);
        let (s, c) = a.sin_cos();
        for k in 0..=32 {
            let x = (start + width * (f64::from(k) / 32.0 + part / 64.0)).min(a.hi());
            let (sin, cos) = math::sin_cos(x);
            prop_assert!(s.contains(sin) && c.contains(cos));
        }
        // No wider than the slope allows, plus rounding.
        prop_assert!(s.width() <= a.width() + 1e-11 && c.width() <= a.width() + 1e-11);
        prop_assert!(s.mag() <= 1.0 && c.mag() <= 1.0);
    }

    #[test]
    fn angles_of_boxes_are_tight((a, x) in member(), (b, y) in member()) {
        let angle = a.atan2(b);
        prop_assert!(angle.mag() <= PI.next_up());
        // Away from the cut the bounds are reached at corners.
        if !(a.contains_zero() && b.lo() <= 0.0) && a.is_finite() && b.is_finite() {
            let corners = [(a.lo(), b.lo()), (a.lo(), b.hi()), (a.hi(), b.lo()), (a.hi(), b.hi())]
                .map(|(y, x)| math::atan2(y, x));
            let lo = corners.iter().copied().fold(f64::MAX, f64::min);
            let hi = corners.iter().copied().fold(f64::MIN, f64::max);
            // Not below -pi or above pi even when a corner touches the cut from outside.
            prop_assert!(angle.lo() <= lo && angle.lo() >= lo - 1e-15, "{angle:?} {lo} {x} {y}");
            prop_assert!(angle.hi() >= hi && angle.hi() <= hi + 1e-15, "{angle:?} {hi}");
        }
    }

    #[test]
    fn division_undoes_multiplication((a, x) in member(), (b, y) in member()) {
        if !b.contains_zero() && (x * y).is_finite() {
            prop_assert!((a * b / b).contains(x));
        }
    }

    #[test]
    fn parts_are_consistent((a, x) in member()) {
        let m = a.midpoint();
        prop_assert!(a.contains(m) && m.is_finite());
        prop_assert!(a.mig() <= x.abs() && x.abs() <= a.mag());
        let (left, right) = a.bisect();
        prop_assert!(left.contains(x) || right.contains(x));
        prop_assert!(a.is_inside(a) && !a.is_inside_interior(a));
        prop_assert!(a.width() >= 0.0);
    }
}

#[test]
fn undefined_spreads_through_everything() {
    let (e, a) = (Interval::EMPTY, Interval::new(-1.0, 2.0));
    let zero = Interval::zero();
    for r in [
        e + a,
        a + e,
        e - a,
        a - e,
        e * a,
        a * e,
        e * zero,
        zero * e,
        e / a,
        a / e,
        zero / e,
        -e,
        e + 1.0,
        e * 0.0,
        e / 2.0,
        e.sqrt(),
        e.exp(),
        e.ln(),
        e.abs(),
        e.square(),
        e.min(a),
        a.min(e),
        e.max(a),
        a.max(e),
        e.atan2(a),
        a.atan2(e),
        e.sin_cos().0,
        e.sin_cos().1,
        e.hull(a),
        a.hull(e),
        e.intersect(a),
        a.intersect(e),
        e.choose(a, a),
        Interval::from_f64(f64::NAN),
        Interval::new(2.0, 1.0),
        a * f64::NAN,
        a + f64::NAN,
        Interval::new(-2.0, -1.0).sqrt(),
        Interval::new(-2.0, 0.0).ln(),
    ] {
        assert!(
            r.is_empty() && !r.contains(0.0) && !r.is_finite() && !r.is_inside(Interval::WHOLE),
            "{r:?}"
        );
        assert!(
            r.width().is_nan() && r.midpoint().is_nan() && r.mag().is_nan() && r.mig().is_nan()
        );
        assert!(!r.is_inside_interior(Interval::WHOLE) && !a.is_inside_interior(r));
    }
}

#[test]
fn division_by_an_interval_with_zero_is_the_whole_line() {
    let one = Interval::one();
    for b in [
        Interval::zero(),
        Interval::new(0.0, 1.0),
        Interval::new(-1.0, 0.0),
        Interval::new(-1.0, 1.0),
    ] {
        assert_eq!(one / b, Interval::WHOLE);
    }
    assert!((one / 0.0) == Interval::WHOLE);
}

#[test]
fn signs_that_are_certain_survive_rounding() {
    let a = Interval::new(0.0, 2.0);
    for r in [
        a + a,
        a * a,
        a.square(),
        a.sqrt(),
        a / Interval::new(1.0, 3.0),
        a.exp(),
    ] {
        assert!(r.lo() >= 0.0, "{r:?}");
    }
    for r in [a * -a, -a - a, -a / Interval::new(1.0, 3.0)] {
        assert!(r.hi() <= 0.0, "{r:?}");
    }
    assert_eq!(Interval::new(-2.0, 1.0).square().lo(), 0.0);
}

#[test]
fn unbounded_ends() {
    let ray = Interval::new(1.0, f64::INFINITY);
    assert_eq!((ray * ray).hi(), f64::INFINITY);
    assert!((ray / ray).lo() == 0.0 && (ray / ray).hi() == f64::INFINITY);
    assert_eq!(
        Interval::zero() * Interval::WHOLE,
        Interval::new(-5e-324, 5e-324)
    );
    assert!((ray - ray) == Interval::WHOLE);
    assert_eq!(ray.midpoint(), f64::MAX);
    assert_eq!(Interval::from_f64(f64::INFINITY).lo(), f64::MAX);
    assert!(ray.sin_cos().0 == Interval::new(-1.0, 1.0));
}

#[test]
fn the_branch_cut_gives_the_full_turn() {
    let full = Interval::new(-PI.next_up(), PI.next_up());
    let (left, around) = (Interval::new(-2.0, -1.0), Interval::new(-0.1, 0.1));
    assert_eq!(around.atan2(left), full);
    assert_eq!(Interval::zero().atan2(left), full);
    assert_eq!(around.atan2(around), full);
    assert!(around.atan2(-left).mag() < 0.1);
    // what begins at zero has no negative angle
    let upper = around.abs();
    let (back, near) = (upper.atan2(left), upper.atan2(around));
    assert!(back.lo() > 2.9 && back.hi() >= PI, "{back:?}");
    assert!(near.lo() == 0.0 && near.hi() >= PI, "{near:?}");
    assert!(upper.atan2(-left).lo() == 0.0, "not a little below");
    let above = Interval::new(0.1, 0.2).atan2(left);
    assert!(above.lo() > 2.9 && above.hi() < PI);
}

#[test]
fn extrema_are_met() {
    let (s, c) = Interval::new(1.5, 1.6).sin_cos();
    assert!(s.hi() == 1.0 && c.contains_zero() && c.mag() < 0.1);
    let (s, c) = Interval::new(3.0, 5.0).sin_cos();
    assert!(s.lo() == -1.0 && c.lo() == -1.0 && s.hi() < 0.15 && c.hi() < 0.29);
    assert_eq!(
        Interval::new(-3.2, 3.2).sin_cos(),
        (Interval::new(-1.0, 1.0), Interval::new(-1.0, 1.0))
    );
}

#[test]
fn derivatives_are_enclosed() {
    // Slope of sqrt(x^2 + 1) sin x over [0.2, 0.3], by dual and by series, against samples.
    fn f<T: Number>(x: T) -> T {
        (x.square() + 1.0).sqrt() * x.sin_cos().0
    }
    let range = Interval::new(0.2, 0.3);
    let dual = f(Dual::<Interval, 1>::variable(range, 0)).eps[0];
    let series = f(Jet::<Interval, 3>::variable(range));
    for k in 0..=10 {
        let exact = f(Jet::<f64, 3>::variable(0.2 + 0.01 * f64::from(k)));
        assert!(
            dual.contains(exact.derivative(1))
                && series.derivative(1).contains(exact.derivative(1))
        );
        assert!(series.derivative(2).contains(exact.derivative(2)));
    }
    // The kink of |x| has slopes from -1 to 1.
    assert_eq!(
        Dual::<Interval, 1>::variable(Interval::new(-1.0, 1.0), 0)
            .abs()
            .eps[0],
        Interval::new(-1.0, 1.0)
    );
}
