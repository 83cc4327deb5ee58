//! Motion studies against known numbers, and what is said when they cannot run.

use std::ops::ControlFlow;

use kempe_model::{Diagnostic, Model};
use kempe_study::{
    Done, Setting, ShownPose, Silent, Stage, StudyResult, check, encode, pose_at, run,
};

const FOUR_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = 50, P = [25, 0] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
[assembly]
C = "left of B -> D"
[measures]
swing = "angle(rocker)"
play  = "range(swing)"
gain  = "d(y(P), motor)"
[studies.turn]
kind = "motion"
step = 1
columns = ["swing", "rate(swing)", "rate(swing, 2)", "x(P)", "gain", "rate(x(P))"]
plot = ["swing", "path(P)"]
"#;

fn model(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn rendered(found: &[Diagnostic], text: &str) -> String {
    found
        .iter()
        .map(|d| d.render_plain("test.toml", text))
        .collect()
}

fn ran(text: &str) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

fn fails(text: &str) -> (Vec<Diagnostic>, String) {
    let model = model(text);
    let found = run(&model, &model.studies[0], &mut Silent).expect_err("it cannot run");
    let text = rendered(&found, text);
    (found, text)
}

/// Whether something of this kind is told.
fn has(diagnostics: &[Diagnostic], code: &str) -> bool {
    diagnostics.iter().any(|d| d.code == code)
}

#[test]
fn a_crank_rocker_gives_the_reference_rows_in_the_units_of_the_file() {
    let result = ran(FOUR_BAR);
    let table = &result.table;
    assert_eq!(table.rows(), 361);
    let heads: Vec<String> = table
        .columns
        .iter()
        .map(kempe_study::Column::head)
        .collect();
    assert_eq!(
        heads,
        [
            "time [s]",
            "motor [deg]",
            "swing [deg]",
            "rate(swing) [rad/s]",
            "rate(swing, 2) [rad/s^2]",
            "x(P) [mm]",
            "gain [mm/rad]",
            "rate(x(P)) [mm/s]"
        ]
    );
    // Closed form of the four-bar 20, 50, 40, 60: rows 60 and 90 of the reference table (S2).
    let at = |row: usize| -> Vec<f64> { table.columns.iter().map(|c| c.values[row]).collect() };
    let close = |ours: &[f64], theirs: &[f64]| {
        for (a, b) in ours.iter().zip(theirs) {
            assert!(
                (a - b).abs() <= 1e-10 * b.abs().max(1.0),
                "{ours:?} {theirs:?}"
            );
        }
    };
    close(
        &at(60)[1..6],
        &[
            60.0,
            97.562_217_639_34,
            0.291_595_776_15,
            0.499_673_893_21,
            32.367_945_446_74,
        ],
    );
    close(&at(90)[6..], &[-3.098_679_459_15, -18.824_038_904_98]);
    assert_eq!(
        table.columns[1].values,
        (0..=360).map(f64::from).collect::<Vec<_>>(),
        "whole degrees, exactly"
    );
    assert!(table.worst_closure() < 1e-12 && table.unreached() == 0);
    let [play] = result.scalars.as_slice() else {
        panic!("{:?}", result.scalars)
    };
    close(&[play.value], &[60.032_348_552_120]);
    assert_eq!((play.name.as_str(), play.unit.text()), ("play", "deg"));
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let (one, two) = (ran(FOUR_BAR), ran(FOUR_BAR));
    assert_eq!(encode::csv(&one.table), encode::csv(&two.table));
    assert_eq!(
        encode::result(&one, true).to_string(),
        encode::result(&two, true).to_string()
    );
}

#[test]
fn without_measures_the_table_says_where_everything_is() {
    let text = FOUR_BAR.split("[measures]").next().unwrap_or("");
    let result = ran(text);
    let heads: Vec<String> = result
        .table
        .columns
        .iter()
        .map(kempe_study::Column::head)
        .collect();
    assert_eq!(
        heads[2..],
        [
            "x(B) [mm]",
            "y(B) [mm]",
            "x(C) [mm]",
            "y(C) [mm]",
            "x(P) [mm]",
            "y(P) [mm]",
            "angle(crank) [deg]",
            "angle(coupler) [deg]",
            "angle(rocker) [deg]"
        ]
    );
}

#[test]
fn stopping_keeps_the_finished_rows_and_says_so() {
    let model = model(FOUR_BAR);
    let mut stop = |_: Stage, done: Done| match done {
        Done::Of(100, _) => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let result = run(&model, &model.studies[0], &mut stop).unwrap();
    assert!(result.interrupted());
    assert_eq!((result.table.rows(), result.demanded_rows), (100, 361));
    let whole = ran(FOUR_BAR);
    for (part, all) in result.table.columns.iter().zip(&whole.table.columns) {
        assert_eq!(part.values, all.values[..100]);
    }
}

#[test]
fn a_range_beyond_the_limit_is_an_error_with_the_limit_in_it() {
    // 20, 50, 40, 100 mm: the crank turns to acos((20^2 + 100^2 - 90^2) / (2 20 100)) = 54.9003678046 deg at most.
    let text = FOUR_BAR.replace("D = [60, 0]", "D = [100, 0]");
    let (found, text) = fails(&text);
    assert_eq!(found[0].code, "range-beyond-limit");
    assert!(text.contains("360 deg is beyond 54.9004 deg"), "{text}");
    assert!(text.contains("motor = {"), "points at the drive: {text}");
    assert!(
        text.contains("ask for no more than \"0 deg\" to \"54.9 deg\""),
        "{text}"
    );
    assert!(
        text.contains("`coupler` and `rocker` stand in line"),
        "{text}"
    );
}

/// At either end of the range: a cylinder of 30 mm to 150 mm on an arm of 60 mm, its foot 90 mm from the pivot.
#[test]
fn a_limit_at_either_end_has_its_reason() {
    let text = |way: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], F = [90, 0] }}\narm = {{ A-B = 60 }}\n\
             [assembly]\nB = \"left of A -> F\"\n[drives]\nlift = {{ cylinder = \"F-B\", {way}, speed = \"1 mm/s\" }}\n\
             [studies.s]\nkind = \"motion\"\n"
        )
    };
    for (way, limit) in [
        ("from = 100, to = 20", "30 mm"),
        ("from = 100, to = 160", "150 mm"),
    ] {
        let (found, said) = fails(&text(way));
        assert_eq!(found[0].code, "range-beyond-limit", "{way}: {said}");
        assert!(said.contains(&format!("beyond {limit}")), "{way}: {said}");
        let reason = "at the limit `arm` and the cylinder `lift` stand in line";
        assert!(said.contains(reason), "{way}: {said}");
    }
}

/// A demand that is 3e-11 mm too long: the two places read alike, whatever the digits.
#[test]
fn a_limit_missed_by_a_hair_says_by_how_much() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], E = [-28.194, -3] }\n\
        boom = { A-B = 23.853, T = [31.702, 1] }\n[drives]\n\
        push = { cylinder = \"E-B\", from = 40.92702675490301, to = 52.206159189090066, speed = \"10 mm/s\" }\n\
        [assembly]\nT = \"left of A -> E\"\n[studies.s]\nkind = \"motion\"\n";
    let (found, said) = fails(text);
    assert_eq!(found[0].code, "range-beyond-limit");
    let (_, by) = said
        .split_once("52.2062 mm is beyond 52.2062 mm by ")
        .expect(&said);
    let by: f64 = by
        .split(' ')
        .next()
        .and_then(|x| x.parse().ok())
        .expect(&said);
    // hypot(28.194, 3) + 23.853
    let over = 52.206159189090066 - (kempe_number::math::hypot(28.194, 3.0) + 23.853);
    assert!((by - over).abs() < 1e-13, "{by} {over}");
}

#[test]
fn a_loop_that_cannot_close_names_its_links_and_distances() {
    let text = FOUR_BAR.replace("D = [60, 0]", "D = [125, 0]");
    let (found, text) = fails(&text);
    assert_eq!(found[0].code, "cannot-assemble");
    assert!(
        text.contains("B and D are 105 mm apart, but `coupler` and `rocker` reach only 90 mm"),
        "{text}"
    );
    let text = FOUR_BAR.replace("B-C = 50", "B-C = 95");
    let (_, text) = fails(&text);
    assert!(
        text.contains("B and D are 40 mm apart, but `coupler` and `rocker` differ by 55 mm"),
        "{text}"
    );
}

/// Which lengths would have to be longer or shorter, and by how much: with that much more, and no less, it closes.
#[test]
fn what_cannot_be_assembled_says_which_lengths_would_do() {
    let slider = |rod: &str, offset: &str, joint: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n\
             [links]\nframe = {{ A = [0, 0], E = [0, {offset}], F = [100, {offset}] }}\ncrank = {{ A-B = 20 }}\nrod = {{ B-C = {rod} }}\n{joint}\n\
             [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 1, speed = \"1 rad/s\" }}\n[studies.t]\nkind = \"motion\"\nrows = 2\n"
        )
    };
    let piston = "block = { C = [0, 0] }\n[joints]\nguide = { slider = \"block\", at = \"C\", on = \"E -> F\" }";
    let slot = "[joints]\nway = { pin = \"C\", on = \"E -> F\" }";
    let beside = piston
        .replace("C = [0, 0]", "C = [0, 0], S = [0, 5]")
        .replace("at = \"C\"", "at = \"S\"");
    let cases = [
        (
            FOUR_BAR.replace("D = [60, 0]", "D = [125, 0]"),
            "make `coupler` or `rocker` longer, by 15 mm together at least",
            "B-C = 50",
            "B-C = 65.001",
        ),
        (
            FOUR_BAR.replace("B-C = 50", "B-C = 95"),
            "make `coupler` shorter or `rocker` longer, by 15 mm together at least",
            "B-C = 95",
            "B-C = 79.999",
        ),
        (
            slider("40", "60", piston),
            "B is 60 mm from the line on which C is to lie, but `rod` reaches only 40 mm",
            "",
            "",
        ),
        (
            slider("40", "60", piston),
            "make `rod` longer, by 20 mm at least",
            "B-C = 40",
            "B-C = 60.001",
        ),
        (
            slider("40", "-60", slot),
            "make `rod` longer, by 20 mm at least",
            "B-C = 40",
            "B-C = 60.001",
        ),
        (
            slider("40", "60", &beside),
            "make `rod` longer, by 15 mm at least",
            "B-C = 40",
            "B-C = 55.001",
        ),
    ];
    for (text, says, from, to) in cases {
        let (found, told) = fails(&text);
        assert_eq!(found[0].code, "cannot-assemble");
        assert!(told.contains(says), "{told}");
        if from.is_empty() {
            continue;
        }
        let mended = model(&text.replace(from, to));
        let again = run(&mended, &mended.studies[0], &mut Silent);
        let assembled = match again {
            Ok(_) => true,
            Err(found) => found.iter().all(|d| d.code != "cannot-assemble"),
        };
        assert!(assembled, "{told}");
    }
}

/// Sides that lengths do not reach: not the side alone is to blame.
#[test]
fn sides_on_which_lengths_do_not_reach_are_told_with_these() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [60, 0], G = [60, -60] }\n\
        crank = { A-B = 20 }\ncoupler = { B-C = 50 }\nrocker = { D-C = 40 }\narm = { C-H = 30 }\nlever = { G-H = 30 }\n\
        [drives]\nmotor = { turns = \"crank\", from = 90, to = 91, speed = \"1 rad/s\" }\n\
        [assembly]\nC = \"left of B -> D\"\nH = \"left of C -> G\"\n[studies.t]\nkind = \"motion\"\nrows = 2\n";
    let (found, told) = fails(text);
    assert_eq!(found[0].code, "cannot-assemble");
    assert!(
        told.contains("no assembly agrees with [assembly]"),
        "{told}"
    );
    // C, 50 mm from B = (0, 20) and 40 mm from D, above the line between them, by hand.
    let line = kempe_number::math::hypot(60.0, 20.0);
    let along = (2500.0 - 1600.0 + line * line) / (2.0 * line);
    let height = (2500.0 - along * along).sqrt();
    let c = [
        (60.0 * along + 20.0 * height) / line,
        20.0 + (-20.0 * along + 60.0 * height) / line,
    ];
    let far = kempe_number::math::hypot(c[0] - 60.0, c[1] + 60.0);
    let reach = told.split("C and G are ").nth(1).expect(&told);
    let apart: f64 = reach
        .split(' ')
        .next()
        .and_then(|x| x.parse().ok())
        .expect(&told);
    assert!((apart - far).abs() < 1e-3, "{apart} {far}");
    assert!(
        told.contains("but `arm` and `lever` reach only 60 mm"),
        "{told}"
    );
    assert!(
        told.contains("or make `arm` or `lever` longer, by "),
        "{told}"
    );
}

#[test]
fn sides_that_contradict_each_other_are_told() {
    let text = FOUR_BAR.replace(
        "C = \"left of B -> D\"",
        "C = \"left of B -> D\"\nP = \"right of B -> D\"",
    );
    let (found, text) = fails(&text);
    assert_eq!(found[0].code, "cannot-assemble");
    assert!(
        text.contains("no assembly agrees with [assembly]"),
        "{text}"
    );
}

#[test]
fn a_pose_is_found_where_it_is_asked_for() {
    let model = model(FOUR_BAR);
    let setting = Setting::parse(&model, "motor = 60deg").unwrap();
    let ShownPose { frame, label, .. } = pose_at(&model, &[setting]).unwrap();
    let p = frame.points[model.points.iter().position(|p| p.name == "P").unwrap()];
    assert!(
        (p[0] - 0.032_367_945_446_74).abs() < 1e-14 && (p[1] - 0.028_486_304_800_13).abs() < 1e-14
    );
    assert_eq!(label, "motor = 60 deg");
    let start = pose_at(&model, &[]).unwrap().frame;
    assert!((start.points[0][0]).abs() < 1e-15);
    for (text, code) in [
        ("motr=3", "unknown-name"),
        ("motor", "syntax"),
        ("motor=3 mm", "unit-mismatch"),
        ("motor=x", "unknown-name"),
    ] {
        assert_eq!(
            Setting::parse(&model, text).unwrap_err().code,
            code,
            "{text}"
        );
    }
}

#[test]
fn check_tells_mobility_groups_and_reach() {
    let report = check(&model(FOUR_BAR));
    assert_eq!((report.mobility_count, report.mobility_rank), (1, Some(1)));
    assert_eq!(report.four_bars[0].kind, "crank-rocker");
    assert_eq!(report.reach.as_deref(), Some("motor turns fully"));
    assert_eq!(
        (report.assemblies, report.assemblies_rejected),
        (Some(1), 1)
    );
    assert!(!report.has_findings(), "{:?}", report.diagnostics);
    let text = report.to_text();
    assert!(text.contains("RRR dyad, class II, closed form"), "{text}");
}

#[test]
fn a_circuit_goes_past_its_dead_points() {
    let text = FOUR_BAR
        .replace("D = [60, 0]", "D = [100, 0]")
        .replace("step = 1", "rows = 181\ncircuit = true");
    let result = ran(&text);
    assert_eq!(result.table.rows(), 181);
    assert_eq!(result.table.columns[0].head(), "arc [1]");
    let motor = &result.table.columns[1].values;
    let (low, high) = motor
        .iter()
        .fold((0.0, 0.0), |(l, h): (f64, f64), v| (l.min(*v), h.max(*v)));
    assert!(
        (-54.91..-54.0).contains(&low) && (54.0..54.91).contains(&high),
        "{low} {high}"
    );
    assert_eq!(result.events.len(), 2, "{:?}", result.events);
}

/// Stops in the first stage before the rows that it hears of.
struct Impatient;

impl kempe_study::Progress for Impatient {
    fn reached(&mut self, stage: Stage, _: Done) -> ControlFlow<()> {
        match stage {
            Stage::Rows => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

#[test]
fn what_comes_before_the_rows_can_be_stopped() {
    let model = model(FOUR_BAR);
    let diagnostic = run(&model, &model.studies[0], &mut Impatient).unwrap_err();
    assert_eq!(diagnostic[0].code, "stopped");
    assert_eq!(
        diagnostic[0].message,
        "stopped while finding assemblies: there are no rows yet"
    );
    let report = kempe_study::check_with_progress(&model, &mut Impatient);
    assert_eq!(report.diagnostics[0].code, "stopped");
    assert_eq!(
        report.four_bars.len(),
        1,
        "what was found until then is told"
    );
}

/// A rocker-driven four-bar whose drive turns back at both ends.
const ROCKER_DRIVEN: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50 }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "rocker", from = 110, to = 130, speed = 10 }
[assembly]
C = "right of D -> B"
[measures]
turn = "angle(crank)"
[studies.round]
kind = "motion"
circuit = true
step = 5
"#;

#[test]
fn a_circuit_has_rows_at_the_steps_of_its_drive() {
    let result = run_ok(ROCKER_DRIVEN);
    let motor = &result.table.column("motor").unwrap().values;
    // Both dead points, where a multiple of the step need not lie.
    let ends = |x: f64| {
        result
            .events
            .iter()
            .any(|e| (e.at.to_degrees() - x).abs() < 1e-6)
    };
    let odd: Vec<f64> = (motor.iter().copied())
        .filter(|x| (x / 5.0 - (x / 5.0).round()).abs() > 1e-7)
        .collect();
    assert_eq!(odd.len(), 2, "{motor:?}");
    assert!(odd.iter().all(|x| ends(*x)), "{odd:?}");
    assert!(
        motor.windows(2).all(|p| (p[1] - p[0]).abs() < 5.0 + 1e-6),
        "{motor:?}"
    );
    assert_eq!(result.table.unreached(), 0);
    // A step of time means nothing here, and that is told.
    let timed = run_ok(&ROCKER_DRIVEN.replace("step = 5", "step = \"0.1 s\""));
    assert!(has(&timed.diagnostics, "circuit-without-time"));
    let plain = run_ok(&ROCKER_DRIVEN.replace("step = 5", ""));
    assert_eq!(plain.table.rows(), 361);
}

fn run_ok(text: &str) -> StudyResult {
    let model = model(text);
    match run(&model, &model.studies[0], &mut Silent) {
        Ok(result) => result,
        Err(found) => panic!("{}", rendered(&found, text)),
    }
}

#[test]
fn several_assemblies_are_told_apart_in_the_words_of_the_file() {
    let open = FOUR_BAR.replace("[assembly]\nC = \"left of B -> D\"\n", "");
    assert_ne!(open, FOUR_BAR);
    let lines = |text: &str| -> Vec<String> {
        let report = check(&model(text));
        let diagnostic = report
            .diagnostics
            .iter()
            .find(|d| d.code == "several-assemblies");
        let notes = &diagnostic.expect("it asks which is meant").notes;
        notes
            .iter()
            .map(|n| n.split_once(": ").unwrap().1.to_owned())
            .collect()
    };
    assert_eq!(
        lines(&open),
        ["C = \"left of B -> D\"", "C = \"right of B -> D\""]
    );
    // No dyad: a slot in a slot, and the lines are taken at their word.
    let slots = r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0], D = [60, 0] }
crank = { A-B = 80 }
rod   = { B-C = 90 }
block = { C = [0, 0] }
[joints]
bore = { slider = "block", at = "C", on = "A -> D" }
[drives]
motor = { turns = "crank", from = 60, to = 61, speed = 10 }
"#;
    let diagnostic = lines(slots);
    assert_eq!(diagnostic.len(), 2, "{diagnostic:?}");
    let mut chosen = Vec::new();
    for line in &diagnostic {
        assert!(line.contains("= { near = ["), "{line}");
        let text = format!("{slots}\n[assembly]\n{line}\n");
        let one = model(&text);
        let pose = pose_at(&one, &[]).unwrap();
        let index = one.points.iter().position(|p| p.name == "C").unwrap();
        let near: f64 = line
            .split(['[', ','])
            .nth(1)
            .unwrap()
            .trim()
            .parse()
            .unwrap();
        let x = pose.frame.points[index][0] * 1e3;
        assert!((x - near).abs() < 1.0, "{line}: {x}");
        chosen.push(x);
    }
    assert!((chosen[0] - chosen[1]).abs() > 10.0);
}

#[test]
fn places_in_notes_and_warnings_have_the_units_of_the_file() {
    // Two drives, so that rows beyond the limit are marked and the rest is kept.
    let text = ROCKER_DRIVEN
        .replace(
            "from = 110, to = 130, speed = 10",
            "from = 110, to = 200, speed = 10",
        )
        .replace("circuit = true\n", "");
    let model_ = model(&text);
    let diagnostic = run(&model_, &model_.studies[0], &mut Silent).unwrap_err();
    assert!(has(&diagnostic, "range-beyond-limit"));
    let report = check(&model_);
    assert!(
        report.assumptions[0].contains("speeds in mm/s and deg/s"),
        "{:?}",
        report.assumptions
    );
    assert!(
        report.assumptions[1].ends_with("in 9 s"),
        "10 is 10 deg/s: {:?}",
        report.assumptions
    );
}

/// Two slots that become parallel: the pin in both runs away. That is no limit of the drive.
#[test]
fn a_part_that_runs_away_is_not_called_a_limit() {
    let text = r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0], E = [0, 40], F = [60, 40] }
crank = { A-B = 20 }
block = { P = [0, 0] }
[joints]
first = { pin = "P", on = "A -> B" }
second = { pin = "P", on = "E -> F" }
[drives]
motor = { turns = "crank", from = 60, to = -20, speed = 10 }
[studies.s]
kind = "motion"
step = 10
"#;
    let model = model(text);
    let result = run(&model, &model.studies[0], &mut Silent).unwrap();
    assert!(has(&result.diagnostics, "motion-runs-away"));
    let note = result.table.notes.iter().flatten().next().unwrap();
    assert!(
        note.contains("runs away to infinity beyond") && note.ends_with(" deg"),
        "{note}"
    );
}

#[test]
fn numbers_over_many_turns_are_those_of_one() {
    let numbers = |turns: u32| {
        let text = FOUR_BAR
            .replace("to = 360", &format!("to = {}", 360 * turns))
            .replace("step = 1\n", "rows = 3\n")
            .replace(
                "play  = \"range(swing)\"",
                "play = \"range(swing)\"\nratio = \"time_ratio(swing)\"\nmiddle = \"mean(swing)\"",
            );
        let result = ran(&text);
        let value = |name: &str| {
            let found = result.scalars.iter().find(|s| s.name == name);
            found.map_or(f64::NAN, |s| s.value)
        };
        ["play", "ratio", "middle"].map(value)
    };
    let one = numbers(1);
    assert!((one[0] - 60.032_348_552_120).abs() < 1e-10, "{one:?}");
    // theta = 1.564113482665 deg: (180 + theta) / (180 - theta).
    assert!((one[1] - 1.017_531_377_944).abs() < 1e-9, "{one:?}");
    for turns in [2, 7, 60] {
        let many = numbers(turns);
        for (a, b) in one.iter().zip(many) {
            assert!((a - b).abs() < 1e-9 * a.abs(), "{turns}: {one:?} {many:?}");
        }
    }
}

#[test]
fn one_drive_too_many_is_told_as_that() {
    let text = FOUR_BAR.replace(
        "[assembly]",
        "other = { turns = \"rocker\", from = 0, to = 10, speed = \"1 rad/s\" }\n[assembly]",
    );
    let text = text
        .replace("step = 1", "rows = 3")
        .replace("\"gain\", ", "");
    let (found, said) = fails(&text);
    assert_eq!(found[0].code, "cannot-assemble");
    assert!(
        said.contains("more often than they can move") && said.contains("one too many"),
        "{said}"
    );
}

/// Rows run along the drive only where it goes one way: there and back, a drive's value is no place.
#[test]
fn rows_run_along_time_where_the_drive_comes_back() {
    let along = |law: &str| {
        let text = FOUR_BAR
            .replace("from = 0, to = 360, speed = \"1 rad/s\"", law)
            .replace("step = 1", "rows = 9");
        ran(&text).along
    };
    let rise = |to: &str| format!("{{ rise = \"{to}\", in = \"1 s\" }}");
    let pieces = |list: &[&str]| {
        format!(
            "law = [{}]",
            list.iter()
                .map(|to| rise(to))
                .collect::<Vec<_>>()
                .join(", ")
        )
    };
    assert_eq!(along("from = 0, to = 360, speed = \"1 rad/s\""), 1);
    assert_eq!(along(&pieces(&["40 deg", "30 deg"])), 1);
    assert_eq!(along(&pieces(&["40 deg", "-40 deg"])), 0);
    // It ends where it has never been, and was at most places twice.
    assert_eq!(along(&pieces(&["40 deg", "-20 deg", "80 deg"])), 0);
}

#[test]
fn every_column_of_a_table_has_a_head_of_its_own() {
    let text = FOUR_BAR.replace(
        "columns = [",
        "columns = [\"time\", \"motor\", \"swing\", \"motor\", ",
    );
    let csv = encode::csv(&ran(&text).table);
    let mut heads: Vec<&str> = csv.lines().next().expect("a head").split(',').collect();
    assert_eq!(heads[..3], ["time [s]", "motor [deg]", "swing [deg]"]);
    let all = heads.len();
    heads.sort_unstable();
    heads.dedup();
    assert_eq!(heads.len(), all, "{csv:.200}");
}

#[test]
fn settings_hold_together_and_are_told_of_where_they_stand() {
    let model = model(FOUR_BAR);
    let all = |texts: &[&str]| Setting::all(&model, texts.iter().copied());
    assert_eq!(all(&["motor=30deg"]).expect("a place").len(), 1);
    for texts in [
        &["motor=30deg", "motor=30deg"][..],
        &["time=1s", "motor=30deg"],
        &["time=1s", "time=2s"],
    ] {
        assert_eq!(
            all(texts).expect_err("refused").code,
            "over-specified",
            "{texts:?}"
        );
    }
    for text in ["time=200s", "time=-1s"] {
        let diagnostic = all(&[text]).expect_err("refused");
        assert_eq!(diagnostic.code, "not-on-the-motion");
        assert_eq!(
            diagnostic.labels[0].source.as_ref().expect("a source").name,
            "--at"
        );
    }
    assert_eq!(
        all(&["motor=1 deg / 0"]).expect_err("refused").code,
        "not-finite"
    );
    // The end of the motion is on it, however it was rounded.
    assert!(all(&["time=6.2831853072s"]).is_ok());
}

#[test]
fn a_change_point_at_zero_is_at_zero_and_rows_are_told() {
    // A kite: two short links, two long ones.
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [20, 0] }\n\
                crank = { A-B = 50 }\ncoupler = { B-C = 50 }\nrocker = { D-C = 20 }\n[drives]\n\
                motor = { turns = \"crank\", from = -10, to = 710, speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> D\"\n\
                [studies.m]\nkind = \"motion\"\nrows = 5\n[studies.t]\nkind = \"motion\"\nstep = \"5 ms\"\n";
    let said = check(&model(text)).to_text();
    assert!(said.contains("change point at motor = 0 deg\n"), "{said}");
    assert!(
        said.contains("study m       motion, 5 rows evenly in time"),
        "{said}"
    );
    assert!(
        said.contains("study t       motion, a row every 0.005 s"),
        "{said}"
    );
}

/// The sides that leave nothing are named, and no other.
#[test]
fn only_the_sides_that_contradict_are_underlined() {
    let text = FOUR_BAR.replace(
        "C = \"left of B -> D\"",
        "P = { near = [30, 20] }\nC = \"left of B -> D\"\nD = \"left of B -> C\"\nrocker = { near = 60 }",
    );
    let (found, text) = fails(&text);
    assert_eq!(found[0].code, "cannot-assemble");
    assert_eq!(found[0].labels.len(), 2, "{text}");
    assert!(
        text.contains("no assembly agrees with these together"),
        "{text}"
    );
    assert!(
        text.contains("has D right of B -> C") || text.contains("has C right of B -> D"),
        "{text}"
    );
}

/// A side of a driven point leaves the choice as open as no side at all.
#[test]
fn a_hint_that_decides_nothing_asks_as_if_it_were_not_there() {
    let hinted = |hint: &str| check(&model(&FOUR_BAR.replace("C = \"left of B -> D\"", hint)));
    for (hint, why) in [
        ("B = \"left of A -> D\"", "B lies on A -> D here"),
        ("D = \"right of B -> A\"\nB = \"left of A -> D\"", "lies on"),
    ] {
        let report = hinted(hint);
        assert_eq!(report.assemblies, Some(2));
        let diagnostic = report.diagnostics.iter();
        let diagnostic: Vec<_> = diagnostic
            .filter(|d| d.code == "several-assemblies")
            .collect();
        assert_eq!(diagnostic.len(), 1, "{hint}");
        assert_eq!(diagnostic[0].notes.len(), 2);
        assert!(
            diagnostic[0].labels[0].text.contains(why),
            "{:?}",
            diagnostic[0].labels
        );
        assert!(
            report.to_text().contains("decides nothing"),
            "{}",
            report.to_text()
        );
    }
    // A place decides, and the report says by how much.
    let report = hinted("C = { near = [40, 30] }");
    assert!(!report.has_findings(), "{:?}", report.diagnostics);
    assert!(
        report.chosen[0].contains("the nearest to [assembly]"),
        "{:?}",
        report.chosen
    );
}

/// Mobility and a picture need no drive.
#[test]
fn a_file_without_drives_has_a_rank_and_a_pose() {
    let text = "units = { length = \"mm\" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50 }
rocker  = { D-C = 40 }
[assembly]
C = \"left of B -> D\"
";
    let bare = model(text);
    assert!(bare.drives.is_empty());
    let report = check(&bare);
    assert_eq!(report.mobility_rank, Some(1));
    assert_eq!(report.assemblies, None);
    assert!(!report.has_errors(), "{:?}", report.diagnostics);
    let frame = pose_at(&bare, &[]).unwrap().frame;
    let at = |name: &str| frame.points[bare.points.iter().position(|p| p.name == name).unwrap()];
    let apart = |a: &str, b: &str| {
        let (a, b) = (at(a), at(b));
        kempe_number::math::hypot(a[0] - b[0], a[1] - b[1])
    };
    for (a, b, length) in [("A", "B", 0.02), ("B", "C", 0.05), ("D", "C", 0.04)] {
        assert!((apart(a, b) - length).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn measures_that_name_each_other_many_times_over_are_evaluated_once() {
    let mut named =
        "m0 = \"x(P) / (1 mm)\"\nlargest = \"max(x(P))\"\nshare = \"max(x(P) / largest)\"\n"
            .to_owned();
    for k in 1..60 {
        named += &format!("m{k} = \"m{0} + m{0}\"\n", k - 1);
    }
    let text = FOUR_BAR
        .replace("[measures]\n", &format!("[measures]\n{named}"))
        .replace("columns = [", "columns = [\"m0\", \"rate(m59)\", ");
    let result = ran(&text);
    let column = |name: &str| &result.table.column(name).expect("a column").values;
    let times = kempe_number::powi(2.0, 59);
    for (m0, (slope, rate)) in column("m0")
        .iter()
        .zip(column("rate(x(P))").iter().zip(column("rate(m59)")))
    {
        assert!(
            m0.is_finite() && (rate / times - slope).abs() < 1e-9,
            "{rate} {slope}"
        );
    }
    // A number over the motion may hold another one.
    let share = result
        .scalars
        .iter()
        .find(|s| s.name == "share")
        .expect("a number");
    assert_eq!(share.value, 1.0);
    let found = kempe_study::sensitivities(&model(&text), None, &mut Silent).expect("derivatives");
    let slope = |name: &str| {
        let measure = found
            .measures
            .iter()
            .find(|m| m.name == name)
            .expect("a measure");
        measure.derivatives[0].value
    };
    assert!((slope("m59") / slope("m0") - times).abs() < 1e-9 * times);
}

/// Each names the one before it twice: whoever looks into all of them anew each time does not come to an end.
#[test]
fn measures_may_name_each_other_many_times_over() {
    let mut measures = String::from("m0 = \"y(P)\"\nf0 = \"torque(motor)\"\n");
    for k in 1..60 {
        let before = k - 1;
        measures += &format!("m{k} = \"(m{before} + m{before}) / 2\"\n");
        measures += &format!("f{k} = \"(f{before} + f{before}) / 2\"\n");
    }
    measures += "top = \"max(m59)\"\nratio = \"time_ratio(m59)\"\nload = \"max(abs(f59))\"\nslope = \"d(m59, motor)\"\n";
    measures += "s0 = \"max(m0)\"\n";
    for k in 1..12 {
        measures += &format!("s{k} = \"mean(m0 - s{}) + s{}\"\n", k - 1, k - 1);
    }
    let text = FOUR_BAR
        .replace("to = 360", "to = 200")
        .replace("A-B = \"a\"", "A-B = \"a\", mass = \"1 kg\", inertia = 0")
        .replace("[measures]\n", &format!("[measures]\n{measures}"))
        .replace(
            "[studies.turn]",
            "[studies.loads]\nkind = \"forces\"\nstep = 40\n[studies.turn]",
        )
        .replace("step = 1\n", "step = 40\n")
        .replace("columns = [\"swing\",", "columns = [\"m59\", \"swing\",");
    let model = model(&text);
    let report = check(&model);
    assert!(report.mobility_rank == Some(1), "{report:?}");
    for study in &model.studies {
        let result = run(&model, study, &mut Silent).unwrap();
        let number = |name: &str| {
            let found = result.scalars.iter().find(|s| s.name == name);
            found.map(|s| s.value)
        };
        let top = number("top").unwrap();
        assert!((top - number("s0").unwrap()).abs() < 1e-12 * top);
        assert!(number("ratio").unwrap().is_nan());
        let diagnostic = rendered(&result.diagnostics, &text);
        assert!(diagnostic.contains("this motion is none"), "{diagnostic}");
    }
    let found = kempe_study::sensitivities(&model, None, &mut Silent).unwrap();
    let of = |name: &str| {
        let measure = found.measures.iter().find(|m| m.name == name).unwrap();
        measure.derivatives[0].value
    };
    assert!((of("m59") - of("m0")).abs() < 1e-12);
}

/// Two couplers upon each other are one, whichever is named first and wherever the rocker stands among them.
#[test]
fn equal_links_upon_each_other_are_assembled_in_any_order() {
    let links = [
        "front = { B-C = 50, P = [10, 7] }",
        "back = { B = [1, 1], C = [31, 41] }",
        "rocker = { D-C = 40 }",
    ];
    let mut swings: Vec<Vec<f64>> = Vec::new();
    for order in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        let [a, b, c] = order.map(|k: usize| links[k]);
        let text = format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
             crank = {{ A-B = 20 }}\n{a}\n{b}\n{c}\n[drives]\nm = {{ turns = \"crank\", speed = \"1 rad/s\" }}\n\
             [assembly]\nC = \"left of B -> D\"\n[measures]\nswing = \"angle(rocker)\"\n"
        );
        let model = model(&text);
        let result = run(&model, &model.studies[0], &mut Silent).expect("it closes");
        assert!(has(&result.diagnostics, "overconstrained"), "{order:?}");
        assert_eq!(result.table.unreached(), 0);
        swings.push(result.table.column("swing").unwrap().values.clone());
    }
    for other in &swings[1..] {
        let pairs = swings[0].iter().zip(other);
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

/// A bar that nearly repeats others: one statement, of the motion that runs.
#[test]
fn what_nearly_repeats_others_is_told_with_how_far_it_misses() {
    let text = r#"
units = { length = "m", angle = "deg" }
[links]
frame  = { A = [0, 0], D = [1.3, 0], F = [0.6, 0.4] }
crank  = { A-B = 0.7 }
rod    = { B = [0, 0], C = [1.3, 0], G = [0.6, 0.40000000100000005] }
rocker = { D-C = 0.7 }
bar    = { F-G = 0.7 }
[drives]
m = { turns = "crank", from = 30, to = 150, speed = 10 }
[assembly]
C = { near = [1.9, 0.35] }
"#;
    let model = model(text);
    let report = check(&model);
    assert_eq!((report.mobility_rank, report.redundant), (Some(1), Some(1)));
    let codes: Vec<&str> = report.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["overconstrained"]);
    let note = &report.diagnostics[0].notes[0];
    assert!(note.contains("miss each other by"), "{note}");
    let result = run(&model, &model.studies[0], &mut Silent).expect("it moves");
    assert_eq!(result.table.unreached(), 0);
}

/// Drives that depend on each other stand where they start, though neither can be moved alone.
#[test]
fn drives_that_depend_on_each_other_stand_together() {
    let text = |law: &str| {
        format!(
            "[links]\nframe = {{ A = [0, 0], D = [2, 0] }}\ncrank = {{ A-B = 1 }}\ncoupler = {{ B-C = 2 }}\nrocker = {{ D-C = 1 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", {law} }}\n\
             other = {{ turns = \"rocker\", {law} }}\n"
        )
    };
    const TOGETHER: &str = "from = 30, to = 60, speed = \"1 rad/s\"";
    for law in [TOGETHER, "at = 30"] {
        let model = model(&text(law));
        let pose = pose_at(&model, &[]).unwrap();
        assert!(
            has(&pose.diagnostics, "overdriven"),
            "{:?}",
            pose.diagnostics
        );
        for point in [2, 3] {
            let [x, y] = pose.frame.points[point];
            let x = if point == 3 { x - 2.0 } else { x };
            assert!((x - 0.75_f64.sqrt()).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
        }
    }
    let both = ["motor=60deg", "other=60deg"].into_iter();
    let settings = Setting::all(&model(&text(TOGETHER)), both).unwrap();
    let pose = pose_at(&model(&text(TOGETHER)), &settings).unwrap();
    assert!((pose.frame.points[2][0] - 0.5).abs() < 1e-9);
    let alone = pose_at(&model(&text(TOGETHER)), &settings[..1]).unwrap_err();
    assert!(has(&alone, "locked"), "{alone:?}");
}

/// A pose right at a limit, which misses closure by a rounding error, and one that truly does not close.
#[test]
fn a_pose_at_a_limit_is_found_from_the_side_that_moves() {
    let text = |from: f64| {
        format!(
            "units = {{ length = \"m\", angle = \"rad\" }}\n[links]\nframe = {{ A = [0, 0], D = [3, 0] }}\n\
             crank = {{ A-B = 2.5 }}\ncoup = {{ B-C = 2, P = [1, 1] }}\nrock = {{ D-C = 2.2 }}\n\
             [drives]\nm = {{ turns = \"crank\", from = {from}, to = 0, speed = 1 }}\n[assembly]\nC = \"left of B -> D\"\n"
        )
    };
    // The rod and the rocker in line: 4.2^2 = 2.5^2 + 3^2 - 2 * 2.5 * 3 * cos(m).
    let limit = kempe_number::math::acos((2.5 * 2.5 + 9.0 - 4.2 * 4.2) / 15.0);
    for ulps in -4..=4 {
        let at = f64::from_bits((limit.to_bits() as i64 + ulps) as u64);
        let pose = pose_at(&model(&text(at)), &[]).unwrap();
        let [d, b, c] = [1, 2, 3].map(|k| pose.frame.points[k]);
        let apart = |p: [f64; 2], q: [f64; 2]| kempe_number::math::hypot(p[0] - q[0], p[1] - q[1]);
        let found = [apart(b, c), apart(d, c), apart(b, d)];
        for (found, wanted) in found.into_iter().zip([2.0, 2.2, 4.2]) {
            assert!((found - wanted).abs() < 1e-9, "{ulps}: {found} {wanted}");
        }
    }
    let beyond = pose_at(&model(&text(limit + 1e-3)), &[]).unwrap_err();
    assert!(has(&beyond, "cannot-assemble"), "{beyond:?}");
}
