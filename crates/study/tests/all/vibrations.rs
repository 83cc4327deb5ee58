//! Studies of natural vibrations from the text of a file to their tables, pictures and warnings, against closed forms.
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::told::{column, scalar};
use kempe_model::{Diagnostic, Model};
use kempe_study::{ReportOrigin, Silent, StudyOutcome, StudyResult, check, report, run};

fn rendered(found: &[Diagnostic], text: &str) -> String {
    let lines = found.iter().map(|d| d.render_plain("test.toml", text));
    lines.collect()
}

fn model(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn ran_study(text: &str, index: usize) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[index], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn ran(text: &str) -> StudyResult {
    ran_study(text, 0)
}

fn refused(text: &str) -> Vec<&'static str> {
    let model = model(text);
    let found = run(&model, &model.studies[0], &mut Silent).err();
    found.into_iter().flatten().map(|d| d.code).collect()
}

fn codes(result: &StudyResult) -> Vec<&'static str> {
    result.diagnostics.iter().map(|d| d.code).collect()
}

fn close(found: f64, exact: f64, part: f64) {
    assert!(
        (found - exact).abs() <= part * exact.abs(),
        "{found}, not {exact}"
    );
}

fn example(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/gallery");
    std::fs::read_to_string(root.join(format!("{name}.toml"))).expect("an example")
}

#[test]
fn the_double_pendulum_of_the_gallery_swings_as_its_head_says() {
    let result = ran(&example("double-pendulum"));
    let frequency = column(&result, "frequency");
    for (mode, sign) in [-1.0, 1.0].into_iter().enumerate() {
        let square: f64 = (2.0 + sign * 2.0_f64.sqrt()) * 9.81 / 0.5;
        close(frequency[mode], square.sqrt() / TAU, 1e-13);
        close(column(&result, "period")[mode], TAU / square.sqrt(), 1e-13);
        close(
            column(&result, "angular_frequency")[mode],
            square.sqrt(),
            1e-13,
        );
        // The lower rod goes by 1 deg, the upper one by the root of a half to one side or the other.
        close(
            column(&result, "shape(upper_angle)")[mode],
            -sign * 0.5_f64.sqrt(),
            1e-12,
        );
        close(column(&result, "shape(lower_angle)")[mode], 1.0, 1e-15);
        // P goes by the arc of the upper rod, Q by both.
        let degree = PI / 180.0;
        let p = 500.0 * degree * 0.5_f64.sqrt();
        close(column(&result, "amplitude(P)")[mode], p, 1e-12);
        close(
            column(&result, "amplitude(Q)")[mode],
            (500.0 * degree - sign * p).abs(),
            1e-12,
        );
        // Kinetic energy for 1 rad of the lower rod: two masses at 0.5 m times these.
        let q = 1.0 - sign * 0.5_f64.sqrt();
        close(
            column(&result, "modal_inertia")[mode],
            0.25 * (0.5 + q * q),
            1e-12,
        );
    }
    assert_eq!(scalar(&result, "upper_angle in equilibrium"), -90.0);
    assert!(codes(&result).is_empty(), "{:?}", result.diagnostics);
    assert_eq!(result.listings[0].rows.len(), 2);
}

#[test]
fn the_metronome_of_the_gallery_slows_as_its_weight_goes_up() {
    let result = ran(&example("metronome"));
    let (rod, rod_at, weight, bob, a, g) = (0.005, 0.05, 0.012, 0.06, 0.05, 9.81);
    let places = column(&result, "tempo");
    assert_eq!(places.len(), 23);
    for (row, x) in places.iter().map(|x| x / 1e3).enumerate() {
        let inertia = 17e-6 + rod * rod_at * rod_at + bob * a * a + 0.5e-6 + weight * x * x;
        let stiffness = g * (bob * a - rod * rod_at - weight * x);
        let frequency = (stiffness / inertia).sqrt();
        close(column(&result, "frequency_1")[row], frequency / TAU, 1e-12);
        close(
            column(&result, "damping_ratio_1")[row],
            2e-5 / 2.0 / inertia / frequency,
            1e-11,
        );
        close(column(&result, "growth_1")[row], -1e-5 / inertia, 1e-11);
        close(column(&result, "time")[row], (x - 0.03) / 0.01, 1e-9);
    }
    assert_eq!(result.abscissa().map(|c| c.name.as_str()), Some("tempo"));
    // The other study holds the weight at one place of these.
    let slow = ran_study(&example("metronome"), 1);
    let row = places
        .iter()
        .position(|x| (*x - 130.0).abs() < 1e-9)
        .expect("a row");
    close(
        column(&slow, "frequency")[0],
        column(&result, "frequency_1")[row],
        1e-12,
    );
}

#[test]
fn the_quarter_car_heaves_and_hops_as_two_masses_on_springs_do() {
    let result = ran(&example("quarter-car"));
    // Two masses in a row, seen from the wheel: arm, coil and damper count by the square of their leverage, nearly.
    let [heave, hop] = column(&result, "frequency")[..] else {
        panic!()
    };
    assert!(
        (1.1..1.5).contains(&heave) && (9.0..13.0).contains(&hop),
        "{heave} {hop}"
    );
    let ratio = column(&result, "damping_ratio");
    assert!(ratio.iter().all(|z| (0.2..0.4).contains(z)), "{ratio:?}");
    // It has sunk: weights of 366 kg on the coil and tyre, on what was drawn a little out of balance.
    let [drawn, rests] =
        ["heave at the pose asked for", "heave in equilibrium"].map(|n| scalar(&result, n));
    assert!(
        drawn == 360.0 && (drawn - rests).abs() < 5.0,
        "{drawn} {rests}"
    );
    assert!(scalar(&result, "out of balance there, along heave") < 0.0);
}

const ROD: &str = "[links]\nframe = { O = [0, 0], W = [1, 0.5] }\nrod = { O-P = 1, mass = 2, inertia = \"0.2 kg m^2\" }\n";

fn rod(angle: &str, more: &str) -> String {
    format!("{ROD}[drives]\nswing = {{ turns = \"rod\", at = {angle} }}\n{more}\n")
}

#[test]
fn a_pose_out_of_balance_sinks_or_is_told() {
    let sinks = ran(&rod("-30", "[studies.modes]\nkind = \"vibrations\""));
    assert_eq!(scalar(&sinks, "swing at the pose asked for"), -30.0);
    close(scalar(&sinks, "swing in equilibrium"), -90.0, 1e-12);
    close(
        scalar(&sinks, "out of balance there, along swing"),
        -2.0 * 9.81 * 0.5 * 30.0_f64.to_radians().cos(),
        1e-12,
    );
    let inertia: f64 = 0.2 + 2.0 * 0.25;
    close(
        column(&sinks, "frequency")[0],
        (9.81 / inertia).sqrt() / TAU,
        1e-12,
    );
    assert!(codes(&sinks).is_empty());
    let held = ran(&rod(
        "-30",
        "[studies.modes]\nkind = \"vibrations\"\nequilibrium = false",
    ));
    assert_eq!(codes(&held), ["not-in-equilibrium"]);
    close(
        column(&held, "frequency")[0],
        (9.81 * 0.5 / inertia).sqrt() / TAU,
        1e-12,
    );
    let elsewhere = ran(&rod(
        "170",
        "[studies.modes]\nkind = \"vibrations\"\nat = { swing = \"-80 deg\" }",
    ));
    close(scalar(&elsewhere, "swing in equilibrium"), -90.0, 1e-12);
}

/// A parallelogram and one with a third crank, let go beside their dead points: both hang down as one pendulum, whatever change points lie on the way.
#[test]
fn a_parallelogram_sinks_and_goes_through_its_change_points() {
    let parallel = |third: &str, drive: &str, studies: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [200, 0], E = [100, 0] }}\n\
             crank = {{ A-B = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }}\n\
             coupler = {{ B-C = 200, M = [100, 0], mass = \"1 kg\", inertia = \"0.004 kg m^2\", center = \"M\" }}\n\
             rocker = {{ D-C = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }}\n{third}\
             [drives]\nm = {{ turns = \"crank\", at = {drive} }}\n[assembly]\nC = \"left of B -> D\"\n{studies}"
        )
    };
    let third = "third = { E-M = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }\n";
    for (third, cranks) in [("", 2.0), (third, 3.0)] {
        // Torque at the crank's angle, and the inertia of all.
        let weight: f64 = 9.81 * (cranks * 0.04 + 0.08);
        let inertia = cranks * (0.001 + 0.04 * 0.04) + 0.08 * 0.08;
        for drive in ["40", "130"] {
            let sinks = parallel(third, drive, "[studies.v]\nkind = \"vibrations\"\n");
            let result = ran(&sinks);
            let place = scalar(&result, "m in equilibrium");
            close((place + 90.0) % 360.0 + 1.0, 1.0, 1e-9);
            close(
                column(&result, "frequency")[0],
                (weight / inertia).sqrt() / TAU,
                1e-9,
            );
            assert!(!codes(&result).contains(&"no-equilibrium"));
        }
        for at in [-20.0_f64, 200.0, 380.0, -560.0] {
            let there = format!(
                "[studies.v]\nkind = \"vibrations\"\nat = {{ m = \"{at} deg\" }}\nequilibrium = false\n"
            );
            let result = ran(&parallel(third, "130", &there));
            let force = scalar(&result, "out of balance, along m");
            close(force, -weight * at.to_radians().cos(), 1e-9);
        }
    }
}

/// Parallelograms that hang in line: they would rest where branches cross, and that is told of them, not a jump of forces.
#[test]
fn what_would_rest_at_a_change_point_is_told() {
    let one = r#"units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0], D = [0, -40] }
lower = { A-B = 300, mass = "0.3 kg", inertia = "2e-3 kg m^2" }
stay  = { D-C = 300, mass = "0.2 kg", inertia = "1e-3 kg m^2" }
elbow = { B = [0, 0], C = [0, -40], mass = "0.2 kg", inertia = "1e-4 kg m^2" }
[drives]
shoulder = { turns = "lower", at = 60 }
[assembly]
C = { near = [150, 220] }
"#;
    let two = include_str!("../../../model/tests/support/lamp.toml");
    for text in [one, two] {
        let result = ran(&format!("{text}[studies.v]\nkind = \"vibrations\"\n"));
        let told = (result.diagnostics.iter()).find(|d| d.code == "no-equilibrium");
        let told = told.expect("no equilibrium");
        assert!(told.message.contains("change point"), "{told:?}");
    }
}

#[test]
fn unstable_and_free_motions_are_told() {
    let upright = ran(&rod("90", "[studies.modes]\nkind = \"vibrations\""));
    assert_eq!(codes(&upright), ["unstable-pose"]);
    close(
        column(&upright, "growth")[0],
        (9.81_f64 / 0.7).sqrt(),
        1e-12,
    );
    assert!(column(&upright, "frequency")[0].is_nan());
    assert!(
        upright.table.notes[0]
            .as_deref()
            .is_some_and(|n| n.contains("grows by e in 0.2671 s"))
    );
    let free = format!(
        "gravity = [0, 0]\n{}",
        rod("0", "[studies.modes]\nkind = \"vibrations\"")
    );
    let free = ran(&free);
    assert_eq!(
        (column(&free, "frequency")[0], column(&free, "growth")[0]),
        (0.0, 0.0)
    );
    assert_eq!(
        free.table.notes[0].as_deref(),
        Some("free, nothing brings it back")
    );
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let light = "[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1 }\n[drives]\nswing = { turns = \"rod\", at = 0 }\n[studies.m]\nkind = \"vibrations\"\n";
    assert_eq!(refused(light), ["no-mass"]);
    let far = rod(
        "-90",
        "[loads]\npush = { torque = \"1 N m / (angle(rod) + 90 deg) * 1 rad\", on = \"rod\" }\n[studies.m]\nkind = \"vibrations\"",
    );
    assert_eq!(refused(&far), ["load-without-value"]);
    let mut stops = |_, _| std::ops::ControlFlow::Break(());
    let model = model(&rod("-30", "[studies.m]\nkind = \"vibrations\""));
    let found = run(&model, &model.studies[0], &mut stops).expect_err("stopped");
    assert!(found.iter().any(|d| d.code == "stopped"), "{found:?}");
}

/// At a dead point of what is let go, or where branches cross, there are no vibrations: the pose is the reason, and no load.
#[test]
fn a_singular_pose_is_told_as_one() {
    let piston = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0], E = [0, 0], F = [300, 0] }\n\
        crank = { A-B = 60, mass = \"1 kg\", inertia = \"0.003 kg m^2\", center = [10, 5] }\nrod = { B-C = 200 }\n\
        piston = { C = [0, 0], mass = \"1.2 kg\" }\n[joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n\
        [drives]\np = { slides = \"piston\", at = 260 }\n[assembly]\nB = { near = [60, 1] }\n[studies.v]\nkind = \"vibrations\"\n";
    let kite = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0], D = [200, 0] }\n\
        crank = { A-B = 80, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }\ncoupler = { B-C = 200, mass = \"1 kg\" }\nrocker = { D-C = 80 }\n\
        [drives]\nm = { turns = \"crank\", at = 0 }\n[assembly]\nC = \"left of B -> D\"\n[studies.v]\nkind = \"vibrations\"\n";
    for text in [piston, kite] {
        assert_eq!(refused(text), ["singular-pose"]);
    }
}

#[test]
fn each_mode_moves_through_real_poses_in_the_report() {
    for name in ["double-pendulum", "metronome", "quarter-car"] {
        let text = example(name);
        let model = model(&text);
        let results: Vec<StudyResult> = (model.studies.iter())
            .map(|s| run(&model, s, &mut Silent).expect("a result"))
            .collect();
        for result in &results {
            for (row, shape) in result.shapes.iter().enumerate() {
                assert!(shape.closure.iter().all(|c| *c < 1e-12), "{name}");
                let ends =
                    [shape.frames.first(), shape.frames.last()].map(|f| f.map(|f| &f.points));
                assert_eq!(ends[0], ends[1]);
                let [up, down] = shape.extremes.map(|k| &shape.frames[k]);
                let middle = &shape.frames[0];
                // Points go as far as the table says, times the amplitude, as far as it is linear.
                let amplitudes: Vec<f64> = (model.points.iter().enumerate())
                    .filter_map(|(p, point)| {
                        let told = result.table.column(&format!("amplitude({})", point.name))?;
                        let gone = [0, 1].map(|axis| up.points[p][axis] - down.points[p][axis]);
                        let gone = gone[0].hypot(gone[1]) / 2.0;
                        let there = [0, 1].map(|axis| up.points[p][axis] - middle.points[p][axis]);
                        assert!(there[0].hypot(there[1]) > 0.0 || told.values[row] < 1e-9);
                        (told.values[row] > 1e-3).then(|| gone / told.values[row])
                    })
                    .collect();
                let least = amplitudes.iter().copied().fold(f64::INFINITY, f64::min);
                let most = amplitudes.iter().copied().fold(0.0, f64::max);
                assert!(most <= 1.1 * least, "{name}: {amplitudes:?}");
            }
        }
        let outcomes: Vec<StudyOutcome<'_>> = (model.studies.iter().zip(&results))
            .map(|(study, result)| StudyOutcome {
                study,
                result: Ok(result.clone()),
            })
            .collect();
        let page = report(
            &model,
            &ReportOrigin::default(),
            &[],
            &check(&model),
            &outcomes,
            None,
        );
        let names: Vec<&str> = page.motions.iter().map(|m| m.name.as_str()).collect();
        let wanted: &[&str] = match name {
            "metronome" => &["beat", "slow-mode-1"],
            _ => &["modes-mode-1", "modes-mode-2"],
        };
        assert_eq!(names, wanted);
    }
}

#[test]
fn along_a_motion_what_is_let_go_follows_its_equilibrium() {
    // A pendulum on a beam that turns: it hangs down whatever the beam does, by the angle that it has against it.
    let text = "[links]\nframe = { A = [0, 0] }\nbeam = { A-B = 1 }\nrod = { B-C = 0.4 }\n[masses]\nbob = { on = \"rod\", at = \"C\", mass = 2 }\n\
                [drives]\nturn = { turns = \"beam\", from = 0, to = 360, speed = \"1 rad/s\" }\n\
                swing = { turns = \"rod\", relative_to = \"beam\", at = -90 }\n[studies.all]\nkind = \"vibrations\"\nrelease = [\"swing\"]\nrows = 25\n";
    let result = ran(text);
    let (turn, swing) = (column(&result, "turn"), column(&result, "swing"));
    for row in 0..25 {
        assert!(
            (turn[row] + swing[row] + 90.0).abs() < 1e-9,
            "{} {}",
            turn[row],
            swing[row]
        );
        close(
            column(&result, "frequency_1")[row],
            (9.81_f64 / 0.4).sqrt() / TAU,
            1e-12,
        );
    }
    assert!(codes(&result).is_empty(), "{:?}", result.diagnostics);
    // As it stands it would be thrown about, and that is told.
    let stiff = ran(&format!("{text}equilibrium = false\n"));
    assert!(
        codes(&stiff).contains(&"not-in-equilibrium") && codes(&stiff).contains(&"unstable-pose")
    );
}

#[test]
fn other_units_tell_the_same_vibrations() {
    let text = example("quarter-car");
    let other = text.replace(
        "length = \"mm\", angle = \"deg\"",
        "length = \"mm\", angle = \"rad\"",
    );
    let (one, two) = (ran(&text), ran(&other));
    for name in [
        "frequency",
        "damping_ratio",
        "growth",
        "modal_mass",
        "modal_inertia",
    ] {
        for (a, b) in column(&one, name).into_iter().zip(column(&two, name)) {
            close(a, b, 1e-12);
        }
    }
    let per_degree = column(&one, "shape(heave)")[0];
    close(
        column(&two, "shape(heave)")[0],
        per_degree * 180.0 / PI,
        1e-12,
    );
}

/// What `check` tells of a text.
fn checked(text: &str) -> Vec<&'static str> {
    let report = check(&model(text));
    report.diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn check_tells_what_run_tells_before_anything_is_let_go() {
    let light = "[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1 }\n[drives]\nswing = { turns = \"rod\", at = 0 }\n[studies.m]\nkind = \"vibrations\"\n";
    assert_eq!(checked(light), refused(light));
    let study = "[studies.m]\nkind = \"vibrations\"";
    let infinite = rod(
        "-90",
        &format!(
            "[loads]\npush = {{ torque = \"1 N m / (angle(rod) + 90 deg) * 1 rad\", on = \"rod\" }}\n{study}"
        ),
    );
    assert_eq!(checked(&infinite), refused(&infinite));
    let held = "[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 20, mass = 1, inertia = 1 }\ncoupler = { B-C = 50 }\n\
                rocker = { D-C = 40 }\n[drives]\nswing = { turns = \"rocker\", at = 120 }\n[assembly]\nC = \"left of B -> D\"\n\
                [studies.m]\nkind = \"vibrations\"\nat = { swing = 10 }\n";
    assert_eq!(refused(held), ["pose-not-reached"]);
    assert!(checked(held).contains(&"pose-not-reached"));
    let rubs = rod(
        "-30",
        &format!(
            "[friction]\nO = {{ coefficient = 0.1, radius = 0.01 }}\n[dampers]\nd = {{ between = \"P-W\", damping = 1, closing = 2 }}\n{study}"
        ),
    );
    for told in [checked(&rubs), codes(&ran(&rubs))] {
        assert_eq!(told, ["dry-friction-left-out", "uneven-damper"]);
    }
    assert_eq!(checked(&rod("-30", study)), [""; 0]);
}

#[test]
fn a_mode_in_which_nothing_slides_has_no_modal_mass() {
    let text = "[links]\nframe = { A = [0, 0], E = [1, 0], O = [3, 0] }\nblock = { P = [0, 0], mass = 2, inertia = 1 }\nrod = { O-Q = 1, mass = 2, inertia = 0.3 }\n\
                [joints]\nguide = { slider = \"block\", at = \"P\", on = \"A -> E\" }\n\
                [drives]\nway = { slides = \"block\", at = 0.5 }\nswing = { turns = \"rod\", at = -90 }\n\
                [springs]\nk = { between = \"A-P\", stiffness = 1000, free = 0.5 }\n[studies.m]\nkind = \"vibrations\"\n";
    let result = ran(text);
    let (masses, inertias) = (
        column(&result, "modal_mass"),
        column(&result, "modal_inertia"),
    );
    // The rod swings first.
    close(inertias[0], 0.3 + 2.0 * 0.25, 1e-12);
    close(masses[1], 2.0, 1e-12);
    assert!(
        masses[0].is_nan() && inertias[1].is_nan(),
        "{masses:?} {inertias:?}"
    );
}

#[test]
fn a_column_under_a_following_load_flutters() {
    // Two rods of 1 m with springs at both joints: H. Ziegler, Ingenieur-Archiv 20 (1952).
    let text = |push: f64| {
        format!(
            "gravity = [0, 0]\n[links]\nframe = {{ O = [0, 0] }}\none = {{ O-P = 1 }}\ntwo = {{ P-Q = 1 }}\n\
             [masses]\na = {{ on = \"one\", at = \"P\", mass = 2 }}\nb = {{ on = \"two\", at = \"Q\", mass = 1 }}\n\
             [drives]\nlow = {{ turns = \"one\", at = 0 }}\nhigh = {{ turns = \"two\", at = 0 }}\n\
             [springs]\ns = {{ links = [\"frame\", \"one\"], stiffness = \"1 N m/rad\", free = 0 }}\n\
             t = {{ links = [\"one\", \"two\"], stiffness = \"1 N m/rad\", free = 0 }}\n\
             [loads]\npush = {{ force = [\"-{push:?} N * cos(angle(two))\", \"-{push:?} N * sin(angle(two))\"], at = \"Q\", on = \"two\" }}\n\
             [studies.m]\nkind = \"vibrations\"\n"
        )
    };
    // Masses 2 m and m: the load at which the frequencies meet is (7/2 - sqrt 2) c / l.
    let critical = 3.5 - 2.0_f64.sqrt();
    let below = ran(&text(critical - 0.01));
    assert!(codes(&below).is_empty(), "{:?}", below.diagnostics);
    let above = ran(&text(critical + 0.01));
    assert_eq!(codes(&above), ["unstable-pose"]);
    assert!(
        above.diagnostics[0]
            .help
            .as_deref()
            .is_some_and(|h| h.contains("follows the motion"))
    );
}

/// What the drives' laws demand beyond the reach is no matter of poses that are led there one by one.
#[test]
fn rows_beyond_the_reach_are_rows_with_a_note_for_check_too() {
    let text = "[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 50 }\ncoupler = { B-C = 30 }\nrocker = { D-C = 40 }\n\
                flap = { C-P = 20, mass = 1, inertia = 1 }\n[drives]\nmotor = { turns = \"crank\", from = 20, to = 300, speed = 1 }\n\
                hang = { turns = \"flap\", at = -90 }\n[assembly]\nC = \"left of B -> D\"\n\
                [studies.m]\nkind = \"vibrations\"\nrelease = [\"hang\"]\nrows = 15\n";
    let result = ran(text);
    assert_eq!(codes(&result), ["rows-not-reached"]);
    assert_eq!(checked(text), [""; 0]);
}

/// Frequencies of several designs, one of which has no spring at all: `omega = sqrt(k / I)`.
#[test]
fn a_sweep_tells_the_frequencies_of_every_design() {
    let sweep = |of: &str, more: &str| {
        ran_study(
            &format!(
                "units = {{ length = \"mm\", angle = \"deg\" }}\ngravity = 0\n[parameters]\nk = \"0.5 N m/rad\"\n[links]\nframe = {{ O = [0, 0] }}\n\
                 arm = {{ O-A = 100, mass = \"1 kg\", inertia = \"0.02 kg m^2\", center = \"O\" }}\n\
                 lid = {{ A-C = 50, mass = \"0.1 kg\", inertia = \"0.001 kg m^2\", center = \"A\" }}\n\
                 [springs]\nback = {{ links = [\"frame\", \"arm\"], stiffness = \"k\", free = \"30 deg\" }}\n\
                 [drives]\nmotor = {{ turns = \"arm\", from = 0, to = 40, speed = \"1 rad/s\" }}\nhinge = {{ turns = \"lid\", from = 0, to = 90, speed = \"1 rad/s\" }}\n\
                 [studies.modes]\nkind = \"vibrations\"\nrelease = [\"motor\"]\n{of}\n\
                 [studies.some]\nkind = \"sweep\"\nover = \"modes\"\nvary = {{ k = [0, 0.5, 2] }}\n{more}\n"
            ),
            1,
        )
    };
    let exact = |k: f64| (k / (0.02 + 0.1 * 0.01)).sqrt() / TAU;
    let about = sweep("equilibrium = false", "");
    let [none, half, two] = column(&about, "frequency_1")[..] else {
        panic!("three designs");
    };
    assert_eq!(none, 0.0);
    close(half, exact(0.5), 1e-9);
    close(two, exact(2.0), 1e-9);
    assert_eq!(column(&about, "motor"), [0.0; 3]);
    let settled = sweep("", "");
    close(column(&settled, "motor")[2], 30.0, 1e-9);
    // Along the motion of the lid, whose centre lies on its hinge.
    let along = sweep("rows = 3", "");
    for name in ["min(frequency_1)", "max(frequency_1)"] {
        close(column(&along, name)[1], exact(0.5), 1e-9);
    }
    let drawn = along.figures.iter().any(|figure| match figure {
        kempe_study::Figure::Graph { name, curves, .. } => {
            name == "frequency_1" && curves.len() == 3
        }
        _ => false,
    });
    assert!(drawn, "{:?}", along.figures.len());
}

/// Stopped anywhere, also while a row looks for its equilibrium, it keeps the rows that it had.
#[test]
fn what_is_stopped_between_rows_keeps_those_before() {
    let model = model(
        "gravity = \"9.81 m/s^2\"\n[links]\nframe = { O = [0, 0] }\nbeam = { O-P = 1 }\nrod = { P-Q = 1, mass = 1, inertia = 0.1 }\n[drives]\n\
         lift = { turns = \"beam\", from = 0, to = 1, speed = \"1 rad/s\" }\nswing = { turns = \"rod\", relative_to = \"beam\", at = -1.5 }\n\
         [studies.all]\nkind = \"vibrations\"\nrelease = [\"swing\"]\nrows = 9\n",
    );
    let mut kept = Vec::new();
    for after in 1.. {
        let mut left = after;
        let mut stops = |_, _| {
            left -= 1;
            match left {
                0.. => std::ops::ControlFlow::Continue(()),
                _ => std::ops::ControlFlow::Break(()),
            }
        };
        let Ok(result) = run(&model, &model.studies[0], &mut stops) else {
            assert!(kept.is_empty(), "{after}: rows were lost");
            continue;
        };
        let rows = result.table.rows();
        let columns = &result.table.columns;
        assert!(columns.iter().all(|c| c.values.len() == rows) && result.frames.len() == rows);
        kept.push(rows);
        if rows == result.demanded_rows {
            break;
        }
    }
    assert!(
        kept.is_sorted() && (1..=9).all(|rows| kept.contains(&rows)),
        "{kept:?}"
    );
}
