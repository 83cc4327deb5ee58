//! Studies of clearance: the door lock of the published paper, and what is told where contacts do not settle.
#![allow(clippy::unwrap_used)]

use kempe_model::{Diagnostic, Model};
use kempe_study::{Figure, Silent, StudyResult, encode, run};

const LOCK: &str = include_str!("../../../examples/seeds/door-lock.toml");
const WORN: &str = include_str!("../../../examples/gallery/worn-slider-crank.toml");

fn model(text: &str, set: &[(&str, &str)]) -> Model {
    let set: Vec<(String, String)> = (set.iter())
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    let mut files = |_: &str| Err(String::new());
    let read = Model::from_toml_with(text, "x.toml", &mut files, &set);
    read.unwrap_or_else(|found| panic!("{found:#?}")).model
}

/// The study of clearance of a text.
fn study(text: &str, set: &[(&str, &str)]) -> Result<StudyResult, Vec<Diagnostic>> {
    let model = model(text, set);
    let is_clearance =
        |kind: &kempe_model::StudyKind| matches!(kind, kempe_model::StudyKind::Clearance(_));
    let study = model
        .studies
        .iter()
        .find(|s| is_clearance(&s.kind))
        .unwrap();
    run(&model, study, &mut Silent)
}

fn column<'r>(result: &'r StudyResult, name: &str) -> &'r [f64] {
    &result
        .table
        .column(name)
        .unwrap_or_else(|| panic!("{name}"))
        .values
}

fn codes(result: &StudyResult) -> Vec<&str> {
    result.diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn deviations_grow_with_the_clearance_and_keep_within_the_worst_case() {
    let [small, large] = ["10 um", "100 um"].map(|play| study(LOCK, &[("play", play)]).unwrap());
    let angle = column(&small, "lock").to_vec();
    let rows = |from: f64, to: f64| (0..angle.len()).filter(move |_| from <= to);
    let within = |from: f64, to: f64| -> Vec<usize> {
        let inside = rows(from, to).filter(|row| (from..=to).contains(&angle[*row]));
        inside.collect()
    };
    for name in ["th2", "w2", "torque(lock)", "reaction(O, bar2)"] {
        let name = format!("{name} deviation");
        let (a, b) = (column(&small, &name), column(&large, &name));
        let rows = within(-50.0, 80.0);
        let most = rows.iter().map(|row| a[*row].abs()).fold(0.0, f64::max);
        for row in rows {
            // Within 1 %; where it goes through zero, of the largest.
            let off = (b[row] - 10.0 * a[row]).abs();
            let size = if a[row].abs() > 0.6 * most {
                a[row].abs()
            } else {
                most
            };
            let at = angle[row];
            assert!(off <= 0.1 * size, "{name} at {at}: {} {}", a[row], b[row]);
        }
    }
    for result in [&small, &large] {
        let (deviation, worst, rms) = (
            column(result, "th2 deviation"),
            column(result, "th2 worst case"),
            column(result, "th2 rms"),
        );
        for row in within(-50.0, 110.0) {
            assert!(deviation[row].abs() <= 1.01 * worst[row], "{}", angle[row]);
            assert!(rms[row] < worst[row]);
        }
    }
    // The statistics of an independent program, from -50 to 110 deg: largest and mean size.
    let stats = |result: &StudyResult, name: &str| {
        let values = column(result, name);
        let sizes: Vec<f64> = within(-50.0, 110.0)
            .iter()
            .map(|row| values[*row].abs())
            .collect();
        let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
        (sizes.into_iter().fold(0.0, f64::max), mean)
    };
    for (result, name, wanted) in [
        (
            &small,
            "th2 deviation",
            (0.00034_f64.to_degrees(), 0.00015_f64.to_degrees()),
        ),
        (&small, "w2 deviation", (0.0014, 0.00024)),
        (&small, "a2 deviation", (0.13, 0.0039)),
        (&small, "torque(lock) deviation", (0.21, 0.0082)),
        (&small, "reaction(O, bar2) deviation", (1.04, 0.017)),
        (
            &large,
            "th2 deviation",
            (0.0034_f64.to_degrees(), 0.0015_f64.to_degrees()),
        ),
        (&large, "w2 deviation", (0.0135, 0.0024)),
        (&large, "a2 deviation", (1.2, 0.038)),
        (&large, "torque(lock) deviation", (2.0, 0.082)),
        (&large, "reaction(O, bar2) deviation", (9.8, 0.17)),
    ] {
        let found = stats(result, name);
        let near = |a: f64, b: f64| (a - b).abs() <= 0.05 * b;
        assert!(
            near(found.0, wanted.0) && near(found.1, wanted.1),
            "{name}: {found:?} {wanted:?}"
        );
    }
}

#[test]
fn rows_that_do_not_settle_are_told_with_their_range() {
    let result = study(LOCK, &[("play", "100 um")]).unwrap();
    assert_eq!(codes(&result), ["clearance-not-settled"]);
    let told = &result.diagnostics[0].message;
    assert!(
        told.contains("10 rows from lock = 112 deg to lock = 121 deg"),
        "{told}"
    );
    let (angle, deviation) = (column(&result, "lock"), column(&result, "th2 deviation"));
    for row in 0..result.table.rows() {
        let lost = (112.0..=121.0).contains(&angle[row]);
        assert_eq!(deviation[row].is_nan(), lost, "{}", angle[row]);
        assert_eq!(result.table.notes[row].is_some(), lost, "{}", angle[row]);
        assert_eq!(result.table.closure[row].is_nan(), lost);
        // The cheap answer is there all the same.
        assert!(column(&result, "th2 worst case")[row] > 0.0);
    }
    let json = encode::result(&result, false);
    let names: Vec<&str> = json["values"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v["name"].as_str().unwrap())
        .collect();
    assert_eq!(
        names[..3],
        [
            "largest deviation of th2",
            "lock at the largest deviation of th2",
            "mean deviation of th2"
        ]
    );
    assert_eq!(json["rows_not_reached"], 10);
}

#[test]
fn without_play_it_is_the_ideal_motion() {
    let result = study(LOCK, &[("play", "0 um")]).unwrap();
    assert_eq!(result.table.unreached(), 0);
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
    for (name, size) in [
        ("th2", 200.0),
        ("w2", 10.0),
        ("a2", 200.0),
        ("torque(lock)", 600.0),
    ] {
        let deviation = column(&result, &format!("{name} deviation"));
        let most = deviation.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(most <= 1e-10 * size, "{name}: {most}");
    }
    assert!(column(&result, "th2 worst case").iter().all(|x| *x == 0.0));
    // With play, the ideal motion is that of the other studies.
    let played = study(LOCK, &[]).unwrap();
    let (value, deviation) = (column(&played, "th2"), column(&played, "th2 deviation"));
    for row in (0..150).step_by(7) {
        let ideal = column(&result, "th2")[row];
        assert!((value[row] - deviation[row] - ideal).abs() < 1e-11, "{row}");
    }
}

#[test]
fn at_the_dead_points_a_piston_is_off_by_the_sum_of_its_pins() {
    let result = study(WORN, &[]).unwrap();
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
    assert_eq!(result.table.unreached(), 0);
    let worst = column(&result, "place worst case");
    for row in [0, 90, 180] {
        assert!((worst[row] - 0.1).abs() < 1e-12, "{}", worst[row]);
    }
    // Inertia throws it out, gas pushes it back.
    let deviation = column(&result, "place deviation");
    assert!(
        deviation[2] > 0.099 && deviation[90] < -0.0999,
        "{deviation:?}"
    );
    assert!(
        matches!(&result.figures[0], Figure::Within { curve, .. } if curve.name == "place deviation")
    );
    assert!(
        matches!(&result.figures[2], Figure::Curves { curves, .. } if curves[0].name == "torque(motor) deviation")
    );
    assert!(
        matches!(&result.figures[3], Figure::Hodograph(name, _) if name == "hodograph(B, rod)")
    );
    // C has all three parts, the slider's guide next to nothing.
    let listing = &result.listings[0];
    assert!(
        listing.rows[0][4].starts_with("C 48 %, B 29 %"),
        "{:?}",
        listing.rows[0]
    );
}

/// A crank-rocker with these lines besides.
fn rocker(more: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
         crank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50, mass = \"1 kg\", inertia = 0 }}\nrocker = {{ D-C = 40 }}\n\
         tail = {{ C-T = 10 }}\n[drives]\nmotor = {{ turns = \"crank\", speed = \"60 rpm\" }}\n\
         tip = {{ turns = \"tail\", at = 0 }}\n[assembly]\nC = \"left of B -> D\"\n\
         [measures]\nswing = \"angle(rocker)\"\nwide = \"range(swing)\"\n{more}\
         [studies.play]\nkind = \"clearance\"\nrows = 9\n"
    )
}

#[test]
fn what_is_left_out_is_told() {
    let text = rocker(
        "[clearance]\nall = { radial = \"20 um\" }\n[friction]\nall = { coefficient = 0.1, radius = 5 }\n",
    );
    let result = study(&text, &[]).unwrap();
    // Nothing pulls at the tail, the third link at C.
    assert_eq!(codes(&result), ["friction-left-out", "clearance-idle"]);
    assert!(
        result.diagnostics[1].message.contains("at C of tail"),
        "{:?}",
        result.diagnostics[1]
    );
    assert_eq!(result.table.unreached(), 0);
    // Numbers over the motion are no columns of it.
    assert!(
        result.table.column("wide").is_none() && result.table.column("swing worst case").is_some()
    );

    let one = rocker("[clearance]\nC = { radial = \"20 um\", on = \"rocker\" }\n");
    let one = study(&one, &[]).unwrap();
    assert!(codes(&one).is_empty());
    assert_eq!(one.listings[0].rows[0][4], "C of rocker 100 %");

    let massless = text.replace(", mass = \"1 kg\", inertia = 0", "");
    let result = study(&massless, &[]).unwrap();
    assert_eq!(
        codes(&result),
        ["friction-left-out", "nothing-acts", "clearance-not-settled"]
    );
    assert!(column(&result, "swing worst case")[0] > 0.0);
}

/// Directions count turns, in loads too.
#[test]
fn directions_are_those_of_the_ideal_motion_but_for_the_play() {
    let more = "[clearance]\nall = { radial = \"20 um\" }\n";
    let load = "[loads]\nturned = { torque = \"0.01 N m/rad * angle(A -> B)\", on = \"rocker\" }\n";
    let columns = "columns = [\"angle(A -> B)\", \"angle(A -> C)\", \"load(turned)\", \"1 / (x(B) - x(B))\"]\n";
    let text =
        rocker(&format!("{more}{load}")).replace("rows = 9\n", &format!("rows = 9\n{columns}"));
    let result = study(&text, &[]).unwrap();
    let (turned, load) = (
        column(&result, "angle(A -> B)"),
        column(&result, "load(turned)"),
    );
    assert!((turned[8] - 360.0).abs() < 0.2, "{turned:?}");
    for row in 0..9 {
        assert!((load[row] - 0.01 * turned[row].to_radians()).abs() < 1e-12);
    }
    for name in ["angle(A -> B)", "angle(A -> C)"] {
        let deviation = column(&result, &format!("{name} deviation"));
        let worst = column(&result, &format!("{name} worst case"));
        for row in 0..9 {
            assert!(
                deviation[row].abs() <= 1.01 * worst[row] + 1e-9,
                "{name} {row}"
            );
        }
    }
    assert!(codes(&result).contains(&"no-value"), "{:?}", codes(&result));
}

#[test]
fn what_cannot_be_is_refused() {
    let text = rocker("[clearance]\nB = { radial = \"20 um\" }\n");
    let over = text.replace("rows = 9\n", "rows = 9\ncolumns = [\"swing\", \"wide\"]\n");
    let found = study(&over, &[]).unwrap_err();
    assert_eq!(found[0].code, "not-measurable");
    let check = kempe_study::check(&model(&over, &[]));
    assert!(check.diagnostics.iter().any(|d| d.code == "not-measurable"));

    let loaded = rocker(
        "[clearance]\nB = { radial = \"20 um\" }\n[loads]\npush = { force = [\"1 N/mm * path_length(C)\", 0], at = \"C\", on = \"rocker\" }\n",
    );
    let found = study(&loaded, &[]).unwrap_err();
    assert_eq!(found[0].code, "not-measurable", "{found:?}");

    let geared = "[links]\nframe = { A = [0, 0], D = [3, 0] }\nsun = { A-B = 1, mass = 1, inertia = 1 }\nwheel = { D-E = 1 }\n\
                  [joints]\nmesh = { gears = [\"sun\", \"wheel\"], teeth = [20, 40] }\n[drives]\nmotor = { turns = \"sun\", speed = 1 }\n\
                  [clearance]\nA = { radial = \"20 um\" }\n[studies.play]\nkind = \"clearance\"\n";
    let found = study(geared, &[]).unwrap_err();
    assert_eq!(found[0].code, "no-clearance-there");
    let all = geared.replace("A = { radial", "all = { radial");
    let result = study(&all, &[]).unwrap();
    assert_eq!(codes(&result), ["clearance-left-out"]);
}
