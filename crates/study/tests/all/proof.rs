//! Proofs and sensitivities from the text of a file.

use std::ops::ControlFlow;

use kempe_model::Model;
use kempe_study::{Done, Progress, Setting, Silent, Stage, prove, sensitivities};

/// A slider-crank that turns past its straight pose and not to its limit.
const SLIDER: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
turn = "5 deg"
[links]
frame = { A = [0, 0], E = [100, 0] }
crank = { A-B = "a" }
rod   = { B-C = 70 }
block = { C = [0, 0] }
[joints]
bore = { slider = "block", at = "C", on = "A -> E" }
[drives]
motor = { turns = "crank", from = "turn", to = 100, speed = "1 rad/s" }
[assembly]
C = { near = [90, 0] }
[measures]
travel = "x(C)"
swing = "angle(rod)"
"#;

fn model(text: &str) -> Model {
    Model::from_toml(text, "slider", &mut |_| Err(String::new()))
        .expect("a model")
        .model
}

#[test]
fn a_regular_motion_is_proved_whole_and_stops_when_told() {
    let proof = prove(&model(SLIDER), &mut Silent).expect("a motion");
    assert!(proof.is_whole() && proof.fraction == 1.0, "{proof:?}");
    assert_eq!(proof.runs, ["5 deg to 100 deg"]);

    struct Impatient;
    impl Progress for Impatient {
        fn reached(&mut self, stage: Stage, _: Done) -> ControlFlow<()> {
            match stage {
                Stage::Proving => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            }
        }
    }
    let stopped = prove(&model(SLIDER), &mut Impatient).expect("a motion");
    assert!(!stopped.finished && !stopped.is_whole());
    assert!(stopped.to_text().contains("Stopped"));
}

#[test]
fn a_change_point_is_a_gap_and_nothing_proved_is_zero() {
    // A parallelogram collapses in line where its crank comes to 180 degrees.
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [60, 0] }\n\
                crank = { A-B = 20 }\ncoupler = { B-C = 60 }\nrocker = { D-C = 20 }\n[drives]\n\
                motor = { turns = \"crank\", from = 170, to = 190, speed = 1 }\n[assembly]\nC = { near = [40, 4] }\n";
    let proof = prove(&model(text), &mut Silent).expect("a motion");
    assert!(proof.gaps.iter().all(|gap| gap.expected), "{proof:?}");
    assert!(!proof.gaps.is_empty() && !proof.is_whole(), "{proof:?}");

    let mut nothing = proof;
    nothing.fraction = 0.0;
    let text = nothing.to_text();
    assert!(text.contains("Proved    0 % of motor"), "{text}");
}

#[test]
fn derivatives_carry_the_units_of_the_file() {
    let model = model(SLIDER);
    let at = Setting::new("motor", 60.0_f64.to_radians());
    let found = sensitivities(&model, Some(&at), &mut Silent).expect("a motion");
    assert_eq!(found.place, "motor = 60 deg");
    // x = a cos q + sqrt(b^2 - a^2 sin^2 q), so dx/da = cos q - a sin^2 q / sqrt(...).
    let [travel, swing] = found.measures.as_slice() else {
        panic!("two measures");
    };
    let root = (70.0_f64 * 70.0 - 20.0 * 20.0 * 0.75).sqrt();
    assert!((travel.derivatives[0].value - (0.5 - 20.0 * 0.75 / root)).abs() < 1e-12);
    assert!((travel.value - (10.0 + root)).abs() < 1e-12);
    // sin(rod) = -a sin q / b: degrees for each millimetre.
    let slope = -(0.75_f64.sqrt() / root).to_degrees();
    assert!((swing.derivatives[0].value - slope).abs() < 1e-12);
    assert_eq!(
        (
            travel.derivatives[0].unit.as_str(),
            swing.derivatives[0].unit.as_str()
        ),
        ("mm/mm", "deg/mm")
    );
    // The drive's place is held: where it started does not matter.
    assert_eq!(travel.derivatives[1].value, 0.0);
    assert_eq!(travel.derivatives[1].unit, "mm/deg");
    assert!(found.to_text().contains("per a"));
}

#[test]
fn what_cannot_be_differentiated_is_told() {
    let beyond = Setting::new("motor", 3.0);
    let diagnostic =
        sensitivities(&model(SLIDER), Some(&beyond), &mut Silent).expect_err("not there");
    assert_eq!(diagnostic[0].code, "not-reached");
    // The trace goes on a little beyond the demanded range: that is not the motion.
    let (low, high) = (5.0_f64.to_radians(), 100.0_f64.to_radians());
    for (place, told) in [
        (low - 1e-3, false),
        (low - 1e-14, true),
        (low, true),
        (high + 1e-14, true),
        (high + 1e-3, false),
    ] {
        let found = sensitivities(
            &model(SLIDER),
            Some(&Setting::new("motor", place)),
            &mut Silent,
        );
        assert_eq!(found.is_ok(), told, "{place}");
        if let Err(diagnostics) = found {
            assert_eq!(diagnostics[0].code, "not-reached");
        }
    }
    let bare = SLIDER.replace(
        "[measures]\ntravel = \"x(C)\"\nswing = \"angle(rod)\"\n",
        "",
    );
    let diagnostic = sensitivities(&model(&bare), None, &mut Silent).expect_err("nothing to ask");
    assert_eq!(diagnostic[0].code, "nothing-to-differentiate");
}

/// Bounds of numbers over the motion hold what a dense table has, in smooth measures and in such with kinks and narrow bumps, of
/// closed forms and of Newton groups, along a drive and along time; they are narrow; and there are none where there is none.
#[test]
fn bounds_of_numbers_hold_a_dense_table() {
    let four_bar = "units = { length = \"mm\", angle = \"deg\" }
[parameters]
a = \"20 mm\"
[links]
frame = { A = [0, 0], D = [60, 0] }
crank = { A-B = \"a\" }
rod = { B-C = 50, P = [25, 10] }
rocker = { D-C = 40 }
[drives]
motor = { turns = \"crank\", from = 0, to = 360, speed = \"5 rad/s\" }
[assembly]
C = \"left of B -> D\"
";
    let group = "units = { length = \"m\", angle = \"deg\" }
[links]
frame = { A = [0, 0], E = [4, 0.3], G = [2.1, 2.9] }
crank = { A-B = 0.5 }
plate = { B = [0, 0], C = [2, 0], D = [1, 1.2] }
one = { C-E = 1.9 }
two = { D-F = 1.1 }
three = { G-F = 0.9 }
[drives]
motor = { turns = \"crank\", from = 20, to = 70, speed = \"1 rad/s\" }
[assembly]
C = { near = [2.3, 0.7] }
";
    let of_four_bar = [
        "x(P)",
        "y(P) + 2 * x(C)",
        "angle(rocker)",
        "distance(A, P)",
        "transmission_angle(C)",
        "abs(angle(rocker) - 120 deg) / 1 rad",
        "exp(-((motor - 200.123 deg)/(0.03 deg))^2)",
        "max(x(P), 2 * y(P)) / a",
        "sqrt(x(P)^2 + y(C)^2)",
        "sin(3 * angle(rod)) * x(P)",
    ];
    let cases = [
        (four_bar, &of_four_bar[..]),
        (
            group,
            &["x(C)", "y(D)", "angle(plate)", "distance(A, D)"][..],
        ),
    ];
    for (text, measures) in cases {
        let mut text = format!("{text}[measures]\n");
        for (k, measure) in measures.iter().enumerate() {
            text += &format!("f{k} = \"{measure}\"\n");
        }
        for k in 0..measures.len() {
            text += &format!("low{k} = \"min(f{k})\"\nhigh{k} = \"max(f{k})\"\n");
        }
        text +=
            "pole = \"max(1/sin(3 * motor))\"\nspeed = \"max(speed(C))\"\nmean = \"mean(x(C))\"\n";
        let model = self::model(&text);
        let proof = prove(&model, &mut Silent).unwrap();
        assert!(proof.is_whole(), "{}", proof.to_text());
        let design = kempe_mechanism::Design::new(
            &kempe_mechanism::Mechanism::new(&model),
            &model.parameter_values(),
        );
        let motion = kempe_motion::Motion::with_progress(&design, &mut Silent).unwrap();
        let asked: Vec<_> = (model.measures.iter().take(measures.len()))
            .map(|m| &m.measure)
            .collect();
        let mut sampler = kempe_measure::Sampler::new(&motion, &asked).unwrap();
        let (low, high) = motion.reached();
        let rows: Vec<Vec<f64>> = (0..=20_000)
            .map(|i| sampler.values_at_parameter(low + (high - low) * f64::from(i) / 20_000.0))
            .collect();
        for number in &proof.numbers {
            let extreme = |k: usize, largest: bool| {
                let values = rows.iter().map(|r| r[k]);
                match largest {
                    true => values.fold(f64::NEG_INFINITY, f64::max),
                    false => values.fold(f64::INFINITY, f64::min),
                }
            };
            let of = |prefix: &str| number.name.strip_prefix(prefix)?.parse::<usize>().ok();
            let (k, largest) = match (of("low"), of("high")) {
                (Some(k), _) => (k, false),
                (_, Some(k)) => (k, true),
                _ => {
                    assert_eq!(number.bounds, None, "{}", number.name);
                    continue;
                }
            };
            let label = format!("{} of {}", number.name, measures[k]);
            let (from, to) = number.bounds.expect(&label);
            let found = extreme(k, largest);
            let size = from.abs().max(to.abs());
            // What is told of the bounds holds them, though it has nine digits.
            let words = number.told.split([' ', ',']);
            let told: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
            let per = [1.0, 1e3, 1e6, 1f64.to_degrees(), 1e-3];
            let near = |per: &f64| (number.value * per - told[0]).abs() <= 1e-6 * told[0].abs();
            let per = per.into_iter().find(near).expect(&number.told);
            assert!(
                told[1] <= from * per * (1.0 + 1e-15 * from.signum()),
                "{}",
                number.told
            );
            assert!(
                told[2] >= to * per * (1.0 - 1e-15 * to.signum()),
                "{}",
                number.told
            );
            // A dense table may miss the extreme, never pass it.
            let (inner, outer) = if largest {
                (found, to)
            } else {
                (-found, -from)
            };
            assert!(
                inner <= outer + 1e-12 * size,
                "{label}: {found} is beyond {from} to {to}"
            );
            let missed = (number.value - if largest { to } else { from }).abs();
            assert!(
                missed <= 1e-4 * size.max(1e-6),
                "{label}: {} in {from} to {to}",
                number.value
            );
            assert!(
                from <= number.value * (1.0 + 1e-9) + 1e-12 && number.value <= to + 1e-9 * size
            );
        }
    }
}

#[test]
fn what_stands_still_is_proved() {
    let held = SLIDER.replace("from = \"turn\", to = 100, speed = \"1 rad/s\"", "at = 60");
    let proof = prove(&model(&held), &mut Silent).expect("a motion");
    assert!(proof.is_whole() && proof.fraction == 1.0, "{proof:?}");
}
