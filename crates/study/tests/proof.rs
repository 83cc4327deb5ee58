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
    let bare = SLIDER.replace(
        "[measures]\ntravel = \"x(C)\"\nswing = \"angle(rod)\"\n",
        "",
    );
    let diagnostic = sensitivities(&model(&bare), None, &mut Silent).expect_err("nothing to ask");
    assert_eq!(diagnostic[0].code, "nothing-to-differentiate");
}
