//! Two designs beside each other, held against themselves, against a scaled one and against what is worked out by hand.

#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{
    Comparison, Design, Kind, Pair, ReportAgainst, ReportOrigin, Silent, StudyOutcome, check,
    compare, encode, figures_against, outline, report, run,
};

/// A crank-rocker of a scale, in a unit of length that is so many mm.
fn four_bar(scale: f64, unit: &str, mm: f64, study: &str) -> String {
    let [crank, coupler, rocker, ground, half] =
        [20.0, 50.0, 40.0, 60.0, 25.0].map(|l| scale * l / mm);
    format!(
        "units = {{ length = \"{unit}\", angle = \"deg\" }}\n[parameters]\na = \"{crank} {unit}\"\n[links]\n\
         frame = {{ A = [0, 0], D = [{ground}, 0] }}\ncrank = {{ A-B = \"a\" }}\n\
         coupler = {{ B-C = {coupler}, P = [{half}, 0] }}\nrocker = {{ D-C = {rocker} }}\n[drives]\n\
         motor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\n\
         C = \"left of B -> D\"\n[measures]\nswing = \"angle(rocker)\"\nplay = \"range(swing)\"\n\
         lift = \"range(y(P))\"\n[studies.turn]\nkind = \"motion\"\n{study}\n"
    )
}

const COLUMNS: &str =
    "step = 10\ncolumns = [\"swing\", \"x(P)\", \"speed(P)\"]\nplot = [\"swing\", \"path(P)\"]";

fn model(text: &str, set: &[(&str, &str)]) -> Model {
    let set: Vec<(String, String)> = (set.iter())
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    let read = Model::from_bytes(text.as_bytes(), "x", &mut |_| Err(String::new()), &set);
    read.expect("a model").model
}

fn outcomes(model: &Model) -> Vec<StudyOutcome<'_>> {
    let outcome = |study| StudyOutcome {
        study,
        result: run(model, study, &mut Silent),
    };
    model.studies.iter().map(outcome).collect()
}

fn compared(this: &Model, against: &Model) -> Comparison {
    let (one, two) = (outcomes(this), outcomes(against));
    let design = |name, model, outcomes| Design {
        name,
        model,
        outcomes,
    };
    compare(&design("this", this, &one), &design("other", against, &two))
}

fn pair<'c>(comparison: &'c Comparison, kind: Kind, name: &str) -> &'c Pair {
    let mut pairs = comparison.studies.iter().flat_map(|s| &s.pairs);
    let found = pairs.find(|p| p.kind == kind && p.name == name);
    found.unwrap_or_else(|| panic!("no {name}"))
}

fn near(value: Option<f64>, expected: f64) {
    let value = value.expect("a number");
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs().max(1.0),
        "{value} is not {expected}"
    );
}

#[test]
fn a_design_does_not_differ_from_itself() {
    let text = four_bar(1.0, "mm", 1.0, COLUMNS);
    let (one, two) = (model(&text, &[]), model(&text, &[("a", "2 cm")]));
    for (this, against) in [(&one, &one), (&one, &two)] {
        let comparison = compared(this, against);
        assert!(!comparison.differs(), "{comparison:#?}");
        assert!(comparison.parameters.is_empty());
        let pairs = &comparison.studies[0].pairs;
        // two numbers, and the extremes of three columns
        assert_eq!(pairs.len(), 8);
        for pair in pairs {
            assert!(pair.difference().expect("a number").abs() <= 1e-12 * pair.size);
        }
        assert!(comparison.sameness().is_some());
    }
}

#[test]
fn twice_the_size_has_twice_the_lengths_and_the_same_angles_in_any_unit() {
    let small = model(&four_bar(1.0, "mm", 1.0, COLUMNS), &[]);
    for (unit, mm) in [("mm", 1.0), ("cm", 10.0), ("in", 25.4)] {
        let large = model(&four_bar(2.0, unit, mm, COLUMNS), &[]);
        let comparison = compared(&large, &small);
        let a = &comparison.parameters[0];
        assert_eq!((a.name.as_str(), a.unit.text()), ("a", unit));
        near(a.relative(), 1.0);
        for (kind, name) in [
            (Kind::Number, "lift"),
            (Kind::Smallest, "x(P)"),
            (Kind::Largest, "x(P)"),
            (Kind::Largest, "speed(P)"),
        ] {
            let pair = pair(&comparison, kind, name);
            let [this, other] = pair.values.map(|v| v.expect("a number"));
            near(Some(this), 2.0 * other);
            near(pair.relative(), 1.0);
            near(pair.difference(), other);
            assert_eq!(pair.places[0], pair.places[1], "{name}");
        }
        for (kind, name) in [(Kind::Number, "play"), (Kind::Largest, "swing")] {
            near(pair(&comparison, kind, name).difference(), 0.0);
        }
    }
}

/// The stroke of a centric slider-crank is twice its crank: 40 mm and 50 mm.
#[test]
fn the_stroke_of_a_slider_crank_differs_by_twice_the_crank() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nr = \"20 mm\"\n[links]\n\
                frame = { O = [0, 0], E = [200, 0] }\ncrank = { O-A = \"r\" }\nrod = { A-B = 80 }\npiston = { B = [0, 0] }\n\
                [joints]\nbore = { slider = \"piston\", at = \"B\", on = \"O -> E\" }\n[drives]\n\
                motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\n\
                B = { near = [100, 0] }\n[measures]\nstroke = \"range(x(B))\"\n[studies.turn]\nkind = \"motion\"\n\
                step = 10\ncolumns = [\"x(B)\"]\n";
    let comparison = compared(&model(text, &[]), &model(text, &[("r", "25 mm")]));
    let stroke = pair(&comparison, Kind::Number, "stroke");
    near(stroke.values[0], 40.0);
    near(stroke.values[1], 50.0);
    near(stroke.difference(), -10.0);
    near(stroke.relative(), -0.2);
    // the dead points: the rod stretched at 0 deg, folded back at 180 deg
    let (far, near_) = (
        pair(&comparison, Kind::Largest, "x(B)"),
        pair(&comparison, Kind::Smallest, "x(B)"),
    );
    near(far.difference(), -5.0);
    near(near_.difference(), 5.0);
    assert_eq!(near_.places, [Some(180.0), Some(180.0)]);
    assert_eq!(far.places[0], Some(0.0));
}

#[test]
fn what_only_one_has_is_told() {
    let text = four_bar(1.0, "mm", 1.0, COLUMNS);
    let other = text
        .replace("\"speed(P)\"", "\"y(P)\"")
        .replace("a = \"20 mm\"", "a = \"20 mm\"\nb = 3")
        .replace("lift = \"range(y(P))\"", "lift = \"range(swing)\"")
        + "[studies.more]\nkind = \"motion\"\nstep = 30\n";
    let comparison = compared(&model(&text, &[]), &model(&other, &[]));
    let b = &comparison.parameters[0];
    assert_eq!((b.name.as_str(), b.values), ("b", [None, Some(3.0)]));
    assert_eq!(
        pair(&comparison, Kind::Largest, "speed(P)").note,
        "only in this design"
    );
    assert_eq!(
        pair(&comparison, Kind::Smallest, "y(P)").note,
        "only in the other design"
    );
    let lift = pair(&comparison, Kind::Number, "lift");
    assert_eq!((lift.difference(), lift.relative()), (None, None));
    assert_eq!(lift.note, "of another kind in the other design, in deg");
    assert_eq!(
        comparison.studies[1].note,
        "not compared: there is no such study in this design"
    );
    let csv = encode::comparison_csv(&comparison);
    let fields = csv.lines().next().expect("a head").split(',').count();
    assert!(csv.contains(",only in this design\n"), "{csv}");
    assert!(
        csv.lines()
            .all(|l| l.contains('"') || l.split(',').count() == fields)
    );
    let json = encode::comparison_json(&comparison);
    assert_eq!(json["studies"][0]["rows"]["against"], 37);
    assert_eq!(json["parameters"][0]["this"], serde_json::Value::Null);
}

#[test]
fn a_design_that_cannot_run_is_told_and_does_not_hide_the_other() {
    let text = four_bar(1.0, "mm", 1.0, COLUMNS);
    let comparison = compared(&model(&text, &[]), &model(&text, &[("a", "75 mm")]));
    let study = &comparison.studies[0];
    assert_eq!(
        study.note,
        "not compared: it could not run in the other design"
    );
    assert_eq!(study.rows, [Some((37, 0)), None]);
    assert!(comparison.differs());
}

/// Rows that lie elsewhere: values between them are interpolated, so that they differ from the right ones by no more than the curve
/// bends in one step, and poses are those of the nearest row.
#[test]
fn rows_that_lie_elsewhere_are_matched_by_the_drive() {
    let fine = model(
        &four_bar(1.0, "mm", 1.0, &COLUMNS.replace("10", "7.5")),
        &[],
    );
    let coarse = model(&four_bar(1.0, "mm", 1.0, COLUMNS), &[]);
    let (one, two) = (outcomes(&coarse), outcomes(&fine));
    let (this, other) = (
        one[0].result.as_ref().expect("a result"),
        two[0].result.as_ref().expect("a result"),
    );
    let plots = figures_against(&coarse, this, &fine, other);
    let told = plots[0].1.curves[1].told.as_ref().expect("what is told");
    assert_eq!(plots[0].1.curves[1].x.len(), 49, "its own rows are drawn");
    let swing = &this.table.column("swing").expect("a column").values;
    for (row, (a, b)) in swing.iter().zip(&told.y).enumerate() {
        // the second derivative is below 60 deg a rad^2: h^2/8 of it
        let bend = 60.0 * 7.5_f64.to_radians() * 7.5_f64.to_radians() / 8.0;
        assert!((a - b).abs() < bend, "row {row}: {a}, {b}");
        if row % 3 == 0 {
            assert!((a - b).abs() < 1e-9, "row {row} stands in both");
        }
    }
    let (_, poses) = outline(this, &fine, other);
    let angle = |row: usize| poses[row].links[1][2].to_degrees();
    assert!((angle(3) - 30.0).abs() < 1e-9);
    assert!((angle(1) - 7.5).abs() < 1e-9, "{}", angle(1));
}

#[test]
fn a_report_has_both() {
    let text = four_bar(1.0, "mm", 1.0, COLUMNS);
    let set = [("a".to_owned(), "25mm".to_owned())];
    let (one, two) = (model(&text, &[]), model(&text, &[("a", "25mm")]));
    let (ran, other_ran) = (outcomes(&one), outcomes(&two));
    let origin = ReportOrigin {
        file_name: "x.toml",
        text: &text,
        ..ReportOrigin::default()
    };
    let other_origin = ReportOrigin {
        set: &set,
        ..origin
    };
    assert_eq!(other_origin.design_name(), "x.toml with a=25mm");
    let design = |name, model, outcomes| Design {
        name,
        model,
        outcomes,
    };
    let this = design("x.toml", &one, &ran);
    let other = design("x.toml with a=25mm", &two, &other_ran);
    let comparison = compare(&this, &other);
    let against = ReportAgainst {
        design: other,
        origin: &other_origin,
        warnings: &[],
        comparison: &comparison,
    };
    let report = report(&one, &origin, &[], &check(&one), &ran, Some(&against));
    let motion = &report.motions[0];
    let beside = motion.against.as_ref().expect("the other design");
    assert_eq!(beside.frames.len(), 37);
    assert_eq!(
        beside.values.len(),
        motion.columns.len() + motion.more.len() + motion.tests.len()
    );
    assert!(beside.values.iter().all(Option::is_some));
    for plot in &motion.plots {
        let labels: Vec<&str> = plot.curves.iter().map(|c| c.label.as_str()).collect();
        assert_eq!(labels, ["this", "against"]);
        assert_eq!(
            [plot.curves[0].dashed, plot.curves[1].dashed],
            [false, true]
        );
    }
    assert_eq!(report.sections[0].title, "Comparison");
    assert!(report.other_source.is_none(), "one text");
}

/// A crank-rocker whose rocker passes 180 degrees on its way, so that a little change counts its angle from another turn.
#[test]
fn angles_that_are_whole_turns_apart_say_so() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nl = \"28.4 mm\"\n[links]\n\
        frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 20 }\ncoupler = { B-C = \"l\" }\nrocker = { D-C = 40 }\n[drives]\n\
        motor = { turns = \"crank\", from = 90, to = 60, speed = \"60 rpm\" }\n[assembly]\nC = { near = [20, 0] }\n[measures]\n\
        swing = \"angle(rocker)\"\nm = \"mean(swing)\"\n[studies.turn]\nkind = \"motion\"\nstep = 2\ncolumns = [\"swing\"]\n";
    let found = compared(&model(text, &[]), &model(text, &[("l", "28.1 mm")]));
    let mean = pair(&found, Kind::Number, "m");
    assert!(mean.difference().unwrap().abs() > 350.0);
    let (apart, rest) = mean.note.split_once(' ').unwrap();
    assert!(
        (apart.parse::<f64>().unwrap() - 0.49).abs() < 0.01,
        "{}",
        mean.note
    );
    assert!(rest.contains("apart but for whole turns"), "{rest}");
}

/// Rows along the drive beside rows along time: the same quantities, whichever comes first.
#[test]
fn what_the_rows_of_one_run_along_is_a_column_of_the_other() {
    let drive = four_bar(1.0, "mm", 1.0, COLUMNS);
    let circuit = drive.replace("step = 10", "circuit = true\nrows = 50");
    let [drive, circuit] = [drive, circuit].map(|text| model(&text, &[]));
    for (this, other) in [(&drive, &circuit), (&circuit, &drive)] {
        let found = compared(this, other);
        let mut pairs = found.studies.iter().flat_map(|s| &s.pairs);
        assert!(
            pairs.all(|p| p.name != "motor" || p.note.is_empty()),
            "{found:?}"
        );
    }
    let (one, two) = (outcomes(&drive), outcomes(&circuit));
    let [one, two] = [&one, &two].map(|o| o[0].result.as_ref().unwrap());
    let plots = figures_against(&drive, one, &circuit, two);
    assert_eq!(
        plots[0].1.curves.len(),
        2,
        "over the drive, which both know"
    );
    let alone = figures_against(&circuit, two, &drive, one);
    let labels: Vec<&str> = alone[0].1.curves.iter().map(|c| c.label.as_str()).collect();
    assert_eq!(
        labels,
        ["only in this design"],
        "the other one knows no arc"
    );
}

/// Counterweights of two designs: what to write for the other one stands beside, and is a difference.
#[test]
fn what_the_other_design_chooses_is_told() {
    let text = four_bar(1.0, "mm", 1.0, "rows = 13")
        .replace("a = \"20 mm\"", "a = \"20 mm\"\nr = \"30 mm\"")
        + "[masses]\nload = { at = [15, 0], on = \"crank\", mass = \"1 kg\" }\n\
           [studies.quiet]\nkind = \"balance\"\non = [\"crank\"]\nradius = \"r\"\n";
    let (this, other) = (model(&text, &[]), model(&text, &[("r", "60 mm")]));
    let found = compared(&this, &other);
    let study = found.studies.iter().find(|s| s.name == "quiet").unwrap();
    let alone = outcomes(&other);
    let own = alone
        .iter()
        .find_map(|o| o.result.as_ref().ok().filter(|r| r.name == "quiet"));
    assert_eq!(study.told, own.unwrap().listings);
    assert!(!study.told.is_empty() && study.differs());
    let titles: Vec<String> = study.listings().into_iter().map(|l| l.title).collect();
    assert!(
        titles
            .iter()
            .any(|t| t.starts_with("Of the other design: ")),
        "{titles:?}"
    );
}
