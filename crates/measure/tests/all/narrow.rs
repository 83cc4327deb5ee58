//! Numbers over a motion of what is narrow or infinite, against what is known of it.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::support::{Case, Rng};
use kempe_measure::{Sampler, StatisticNote};
use kempe_motion::Motion;

/// A crank-rocker that turns once in 2 pi seconds, with measures of the drive, `q`, and of the poses, `w`.
fn crank_rocker(measures: &str) -> Case {
    crank_rocker_with(["", ""], measures)
}

/// The same with more points of its frame and its coupler.
fn crank_rocker_with([frame, coupler]: [&str; 2], measures: &str) -> Case {
    let text = format!(
        "units = {{ length = \"m\", angle = \"rad\" }}\n\
         [links]\nframe = {{ A = [0, 0], D = [3, 0]{frame} }}\nk = {{ A-B = 1 }}\n\
         l = {{ B-C = 2.5, P = [1, 0.5]{coupler} }}\nr = {{ D-C = 2 }}\n\
         [drives]\nm = {{ turns = \"k\", from = 0, to = \"360 deg\", speed = 1 }}\n\
         [assembly]\nC = \"left of B -> D\"\n[measures]\n{measures}\
         q = \"m / 1 rad\"\nw = \"angle(r) / 1 rad\"\n"
    );
    Case::read(&text, "narrow.toml")
}

/// The numbers that a file names, with what is told of them.
fn numbers(motion: &Arc<Motion>) -> Vec<(f64, Vec<StatisticNote>)> {
    let named = &motion.mechanism().model.measures;
    let measures: Vec<_> = named.iter().map(|m| &m.measure).collect();
    let mut sampler = Sampler::new(motion, &measures).unwrap();
    let values = sampler.values_at_time(1.0);
    let notes = measures.iter().map(|m| sampler.notes_of(m));
    values.into_iter().zip(notes).collect()
}

/// Peaks of a width of 1e-3 to 1e-8 of the range stand where no sample is, of several shapes, on a slower course.
#[test]
fn narrow_peaks_of_the_drive_are_found() {
    let mut rng = Rng(11);
    for case in 0..60 {
        let center = rng.range(0.02, TAU - 0.02);
        let width = TAU * kempe_number::math::exp(rng.range(-18.0, -7.0));
        let slow = rng.range(-0.4, 0.4);
        let u = format!("((q - {center}) / {width})");
        let (peak, area) = [
            (format!("exp(-{u}^2)"), PI.sqrt()),
            (format!("max(0, 1 - abs{u})"), 1.0),
            (format!("exp(-abs{u})"), 2.0),
        ][case % 3]
            .clone();
        let text = format!(
            "high = \"max({peak} + {slow} * cos(m))\"\nlow = \"min({slow} * cos(m) - {peak})\"\n\
             area = \"mean({peak})\"\nboth = \"mean({peak} + {slow} * cos(m))\"\n"
        );
        let found = numbers(&crank_rocker(&text).must_move());
        let at = slow * kempe_number::math::cos(center);
        let values: Vec<f64> = found.iter().map(|(value, _)| *value).collect();
        // The slow course moves the peak by less than its square.
        assert!(
            (values[0] - (1.0 + at)).abs() < 2.0 * width,
            "{peak}: {values:?}"
        );
        assert!(
            (values[1] - (at - 1.0)).abs() < 2.0 * width,
            "{peak}: {values:?}"
        );
        let mean = area * width / TAU;
        assert!(
            (values[2] - mean).abs() < 1e-9 * mean,
            "{peak}: {values:?} {mean}"
        );
        assert!(
            (values[3] - mean).abs() < 1e-12,
            "{peak}: {values:?} {mean}"
        );
    }
}

/// Peaks over a pose, against the same looked at closely where the pose passes their centre.
#[test]
fn narrow_peaks_of_poses_are_found() {
    let mut rng = Rng(5);
    for _ in 0..12 {
        let (center, width) = (rng.range(1.75, 2.6), rng.range(1e-6, 1e-4));
        let text = format!(
            "high = \"max(exp(-((w - {center}) / {width})^2))\"\n\
             low = \"min(w)\"\ntop = \"max(w)\"\n"
        );
        let found = numbers(&crank_rocker(&text).must_move());
        let [high, low, top] = [0, 1, 2].map(|k: usize| found[k].0);
        let passes = low < center && center < top;
        let expected = match passes {
            true => 1.0,
            false => {
                let off = (low - center).max(center - top) / width;
                kempe_number::math::exp(-off * off)
            }
        };
        assert!(
            (high - expected).abs() < 1e-9,
            "{center} {width}: {high} {expected}"
        );
    }
}

#[test]
fn poles_are_infinite_and_their_place_is_told() {
    let mut rng = Rng(3);
    for power in [1, 2, 3] {
        for _ in 0..8 {
            let center = rng.range(0.01, TAU - 0.01);
            let of = format!("1 / (q - {center})^{power} + sin(m)");
            let text =
                format!("high = \"max({of})\"\nlow = \"min({of})\"\nmean = \"mean({of})\"\n");
            let found = numbers(&crank_rocker(&text).must_move());
            assert_eq!(found[0].0, f64::INFINITY, "{of}");
            match power % 2 {
                1 => assert_eq!(found[1].0, f64::NEG_INFINITY, "{of}"),
                _ => assert!(found[1].0.is_finite(), "{of}"),
            }
            assert!(found[2].0.is_nan(), "{of}: {:?}", found[2]);
            let place = |note: &StatisticNote| match note {
                StatisticNote::Infinite { time } | StatisticNote::Diverges { time } => *time,
                note => panic!("{of}: {note:?}"),
            };
            for (value, notes) in &found[..3] {
                // The smallest value of what runs away upwards alone is as good as any.
                if value.is_finite() {
                    assert!(notes.is_empty(), "{of}: {value} {notes:?}");
                } else {
                    assert!((place(&notes[0]) - center).abs() < 1e-9, "{of}: {notes:?}");
                }
            }
        }
    }
    // A narrow peak is seen beside a pole, before it and behind it.
    for at in [0.5, 5.0] {
        let of = format!("1 / (q - 2)^2 - 9 * exp(-((q - {at}) / 1e-5)^2)");
        let found =
            numbers(&crank_rocker(&format!("a = \"max({of})\"\nb = \"min({of})\"\n")).must_move());
        assert_eq!(found[0].0, f64::INFINITY);
        let low = 1.0 / ((at - 2.0) * (at - 2.0)) - 9.0;
        assert!((found[1].0 - low).abs() < 1e-4, "{at}: {found:?} {low}");
    }
    // A toggle: the mechanical advantage of a crank-rocker where the rocker turns about, twice a turn.
    let of = "mechanical_advantage(angle(r), m)";
    let found =
        numbers(&crank_rocker(&format!("a = \"max({of})\"\nb = \"min({of})\"\n")).must_move());
    assert_eq!([found[0].0, found[1].0], [f64::INFINITY, f64::NEG_INFINITY]);
}

/// Roots and logarithms can be averaged over where they are infinite; the digits that are not sure are told.
#[test]
fn means_over_weak_poles_exist() {
    let cases = [
        ("ln(abs(q - 1))", 0.399_611_144_596_957_4),
        ("1 / sqrt(abs(sin(m)))", 1.669_253_683_139_807),
        ("abs(sin(500 * m))", 2.0 / PI),
        ("sqrt(abs(sin(m)))", 0.762_759_763_501_8),
    ];
    for (of, truth) in cases {
        let (value, notes) =
            numbers(&crank_rocker(&format!("mean = \"mean({of})\"\n")).must_move()).remove(0);
        let mut digits = 10;
        for note in &notes {
            match note {
                StatisticNote::Unsettled { digits: told } => digits = *told,
                note => panic!("{of}: {note:?}"),
            }
        }
        let error = (value / truth - 1.0).abs();
        // One unit in the last digit that is told to hold.
        let allowed = 10.0 * kempe_number::powi(0.1, digits as i32);
        assert!(
            error < allowed && digits >= 7,
            "{of}: {value} {truth} {notes:?}"
        );
    }
}

/// What only looks like a pole is none.
#[test]
fn what_has_a_bound_is_not_infinite() {
    for (of, high) in [
        ("sin(m - 2 rad) / (q - 2)", 1.0),
        ("(1 - cos(m - 2 rad)) / (q - 2)", f64::NAN),
        ("atan2(y(C), x(C))", f64::NAN),
        ("sqrt(abs(q - 3))", (TAU - 3.0_f64).sqrt()),
        ("abs(q - 1)^0.3", f64::NAN),
        ("1 / (1e-9 + (q - 2)^2)", 1e9),
        ("speed(C) / (1e-6 * 1 m/s + speed(C))", f64::NAN),
    ] {
        let text = format!("high = \"max({of})\"\nlow = \"min({of})\"\n");
        let found = numbers(&crank_rocker(&text).must_move());
        assert!(
            found
                .iter()
                .all(|(value, notes)| value.is_finite() && notes.is_empty()),
            "{of}: {found:?}"
        );
        if !high.is_nan() {
            assert!((found[0].0 / high - 1.0).abs() < 1e-9, "{of}: {found:?}");
        }
    }
}

/// Derivatives of numbers over narrow peaks: the same numbers, and what a change of the peak changes in them.
#[test]
fn derivatives_of_numbers_over_narrow_peaks_are_those_of_the_numbers() {
    use kempe_measure::{Held, sensitivities};
    use kempe_model::ParameterId;
    let text = "units = { length = \"m\", angle = \"rad\" }\n\
         [parameters]\nhigh = 2\nat = 1.23456\nwidth = 1e-5\n\
         [links]\nframe = { A = [0, 0] }\nk = { A-B = 1 }\n\
         [drives]\nm = { turns = \"k\", from = 0, to = \"360 deg\", speed = 1 }\n[measures]\n\
         peak = \"max(high * exp(-((m / 1 rad - at) / width)^2))\"\n\
         area = \"mean(high * exp(-((m / 1 rad - at) / width)^2))\"\n\
         none = \"mean(high / (m / 1 rad - at))\"\n\
         weak = \"mean(high * ln(abs(m / 1 rad - at)))\"\n";
    let motion = Case::read(text, "narrow.toml").must_move();
    let named = &motion.mechanism().model.measures;
    let measures: Vec<_> = named.iter().map(|m| &m.measure).collect();
    let ids = [ParameterId(0), ParameterId(1), ParameterId(2)];
    let found = sensitivities(&motion, Held::Path(0.0), &measures, &ids).unwrap();
    let plain = numbers(&motion);
    for (k, (value, _)) in plain.iter().enumerate() {
        let same = found.values[k] == *value || found.values[k].is_nan() && value.is_nan();
        assert!(same, "{k}: {} {value}", found.values[k]);
    }
    let area = PI.sqrt() / TAU;
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b.abs().max(1e-6);
    let wanted = [[1.0, 0.0, 0.0], [area * 1e-5, 0.0, 2.0 * area]];
    for (found, wanted) in found.derivatives.iter().zip(wanted) {
        for (a, b) in found.iter().zip(wanted) {
            assert!(near(*a, b), "{found:?} {wanted:?}");
        }
    }
    assert!(found.values[2].is_nan());
    assert!(near(found.derivatives[3][0], found.values[3] / 2.0));
}

/// What cancels but for rounding is nothing that changes too fast, and what remains of it is seen where it is narrow.
#[test]
fn differences_that_cancel_are_known_to() {
    let text = "nothing = \"max(x(B) - 1 m * cos(angle(k)))\"\n\
         small = \"max(x(B) - 1 m * cos(angle(k)) + 1e-6 m * sin(7 * m))\"\n\
         peak = \"max(x(B) - 1 m * cos(angle(k)) + 1e-6 m * exp(-((q - 2.34567) / 1e-4)^2))\"\n";
    let found = numbers(&crank_rocker(text).must_move());
    let [nothing, small, peak] = [0, 1, 2].map(|k| &found[k]);
    assert!(nothing.0.abs() < 1e-15, "{nothing:?}");
    assert!((small.0 - 1e-6).abs() < 1e-15, "{small:?}");
    assert!((peak.0 - 1e-6).abs() < 1e-13, "{peak:?}");
    for (value, notes) in [nothing, small, peak] {
        assert!(notes.is_empty(), "{value} {notes:?}");
    }
}

/// What named measures are of is looked at once each: a formula that names the one before it twice, 40 deep, has 2^40 leaves.
#[test]
fn measures_that_name_each_other_twice_are_looked_at_once() {
    let mut text = "d0 = \"x(B) - 1 m * cos(angle(k)) + 1e-6 m * sin(7 * m)\"\n".to_owned();
    for k in 1..=40 {
        text += &format!("d{k} = \"0.5 * d{0} + 0.5 * d{0}\"\n", k - 1);
    }
    text += "most = \"max(d40)\"\n";
    let motion = crank_rocker(&text).must_move();
    let (value, notes) = numbers(&motion).swap_remove(41);
    assert!(
        (value - 1e-6).abs() < 1e-15 && notes.is_empty(),
        "{value} {notes:?}"
    );
}

/// What is zero but for rounding changes by nothing that anyone could look at more closely.
#[test]
fn what_is_zero_but_for_rounding_is_not_looked_at_closely() {
    let found = numbers(
        &crank_rocker("a = \"max(distance(A, B) - 1 m)\"\nb = \"range(distance(C, D) - 2 m)\"\n")
            .must_move(),
    );
    for (value, notes) in &found[..2] {
        assert!(value.abs() < 1e-14 && notes.is_empty(), "{found:?}");
    }
}

/// However small a size is, what it is of shows it: two points of a link that are a thousandth of a micrometre apart, and one that passes another so near.
#[test]
fn sizes_are_shown_however_small_they_are() {
    let points = [
        ", X = [\"1.000000001 m * cos(1.2345 rad)\", \"1.000000001 m * sin(1.2345 rad)\"]",
        ", Q = [1, 0.500000001]",
    ];
    let text = "apart = \"max(distance(P, Q))\"\nnear = \"min(distance(B, X))\"\n\
         off = \"max(abs(x(P) - x(Q)))\"\n\
         left = \"-max(-2 * abs(y(P) - y(Q)))\"\n";
    let found = numbers(&crank_rocker_with(points, text).must_move());
    for (value, notes) in &found[..2] {
        assert!((value - 1e-9).abs() < 1e-14, "{found:?}");
        assert!(notes.is_empty(), "{found:?}");
    }
    // The coupler turns by less than a right angle, and through where it is level.
    let tilt =
        numbers(&crank_rocker("low = \"min(angle(l))\"\nhigh = \"max(angle(l))\"\n").must_move());
    let most = tilt[..2]
        .iter()
        .map(|(angle, _)| kempe_number::math::sin(*angle).abs());
    let most = most.fold(0.0, f64::max);
    assert!(
        (found[2].0 - 1e-9 * most).abs() < 1e-14,
        "{found:?} {tilt:?}"
    );
    let least = tilt[..2]
        .iter()
        .map(|(angle, _)| kempe_number::math::cos(*angle));
    let least = least.fold(f64::INFINITY, f64::min);
    assert!(
        (found[3].0 - 2e-9 * least).abs() < 1e-14,
        "{found:?} {tilt:?}"
    );
    assert!(found[2].1.is_empty() && found[3].1.is_empty(), "{found:?}");
}

/// A place that a drive comes to again: what hangs on the way there is told with both times, what hangs on the place alone is not, nor what the end is.
#[test]
fn a_place_that_is_passed_again_is_told_where_it_has_another_value() {
    let text = "units = { length = \"m\", angle = \"rad\" }\n[links]\nframe = { A = [0, 0] }\narm = { A-B = 1 }\n\
        [drives]\nm = { turns = \"arm\", from = 0, law = [{ to = 1, speed = 1 }, { to = 0, speed = 0.5 }] }\n\
        [measures]\nquick = \"at(angular_speed(arm), m, 0.25)\"\nhigh = \"at(y(B), m, 0.25)\"\nlast = \"at(y(B), m, 1)\"\n";
    let found = numbers(&Case::read(text, "again.toml").must_move());
    assert!((found[0].0 - 1.0).abs() < 1e-12);
    match found[0].1[..] {
        [StatisticNote::PassedAgain { first, again }] => {
            assert!((first - 0.25).abs() < 1e-12 && (again - 2.5).abs() < 1e-12);
        }
        ref notes => panic!("{notes:?}"),
    }
    assert!(
        found[1..].iter().all(|(_, notes)| notes.is_empty()),
        "{found:?}"
    );
}
