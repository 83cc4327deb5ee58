//! Studies of clearance: the door lock of the published paper, and what is told where contacts do not settle.
#![allow(clippy::unwrap_used)]

use kempe_model::{Diagnostic, Model};
use kempe_study::{Figure, Silent, StudyResult, encode, run};

const LOCK: &str = include_str!("../../../../examples/seeds/door-lock.toml");
const WORN: &str = include_str!("../../../../examples/gallery/worn-slider-crank.toml");

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

/// The rows between two places of the lock, deg.
fn within(angle: &[f64], from: f64, to: f64) -> Vec<usize> {
    (0..angle.len())
        .filter(|row| (from..=to).contains(&angle[*row]))
        .collect()
}

#[test]
fn deviations_grow_with_the_clearance_and_keep_within_the_worst_case() {
    let [small, large] = ["10 um", "100 um"].map(|play| study(LOCK, &[("play", play)]).unwrap());
    let angle = column(&small, "lock").to_vec();
    let within = |from: f64, to: f64| within(&angle, from, to);
    // As docs/door-lock-clearance.md tells it: in how many rows ten times the deviation is missed by more than 1 % of it.
    for (name, missed) in [
        ("th2", 6),
        ("w2", 9),
        ("a2", 11),
        ("torque(lock)", 2),
        ("reaction(O, bar2)", 23),
    ] {
        let name = format!("{name} deviation");
        let (a, b) = (column(&small, &name), column(&large, &name));
        let rows = within(-50.0, 80.0);
        assert_eq!(rows.len(), 131);
        let most = rows.iter().map(|row| a[*row].abs()).fold(0.0, f64::max);
        let off: Vec<[f64; 2]> = (rows.iter())
            .map(|row| [(b[*row] / 10.0 - a[*row]).abs(), a[*row].abs()])
            .collect();
        for (row, [off, _]) in rows.iter().zip(&off) {
            assert!(*off <= 0.007 * most, "{name} at {}: {off}", angle[*row]);
        }
        let beyond = off.iter().filter(|[off, size]| *off > 0.01 * size);
        assert_eq!(beyond.count(), missed, "{name}");
    }
    for result in [&small, &large] {
        let (deviation, worst, rms) = (
            column(result, "th2 deviation"),
            column(result, "th2 worst case"),
            column(result, "th2 rms"),
        );
        // In every row that settles.
        let mut settled = 0;
        for row in (0..angle.len()).filter(|row| !deviation[*row].is_nan()) {
            let part = if angle[row] > 110.0 { 1.0 } else { 0.75 };
            let at = angle[row];
            assert!(deviation[row].abs() <= part * worst[row], "{at}");
            settled += 1;
        }
        assert!(settled >= 166);
        for row in 0..angle.len() {
            assert!(rms[row] < 0.35 * worst[row], "{}", angle[row]);
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

/// Whether a number as a page prints it is this one, to its last digit.
fn prints(cell: &str, value: f64) -> bool {
    let text = cell.split_whitespace().next().unwrap_or(cell);
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let last = exponent.parse::<i32>().unwrap() - decimals as i32;
    let half = 0.5 * kempe_number::powi(10.0, last);
    (text.parse::<f64>().unwrap() - value).abs() <= 1.000_001 * half
}

/// The tables of docs/door-lock-clearance.md are what the example gives, cell by cell.
#[test]
fn the_page_tells_what_the_lock_gives() {
    const PAGE: &str = include_str!("../../../../docs/door-lock-clearance.md");
    let [small, large] = ["10 um", "100 um"].map(|play| study(LOCK, &[("play", play)]).unwrap());
    let angle = column(&small, "lock").to_vec();
    // SI, as the page has it.
    let si = |result: &StudyResult, name: &str| {
        let name = format!("{name} deviation");
        result.table.column(&name).unwrap().si()
    };
    let names = ["th2", "w2", "a2", "torque(lock)", "reaction(O, bar2)"];
    let quantities = ["theta 2", "speed", "acceleration", "torque", "force at O"];
    let (mut poses, mut sizes, mut of) = (0, 0, &small);
    for line in PAGE.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        of = match cells[0].split(',').next().unwrap() {
            "10 um" => &small,
            "100 um" => &large,
            _ => of,
        };
        if let Some(lock) = cells[0].strip_suffix(" deg") {
            let lock: f64 = lock.rsplit_once(' ').unwrap().1.parse().unwrap();
            let row = within(&angle, lock - 0.1, lock + 0.1)[0];
            for (cell, name) in cells[1..].iter().zip(names) {
                let found = si(of, name)[row];
                assert!(prints(cell, found), "{name} at {lock}: {cell} is {found:e}");
                poses += 1;
            }
        } else if cells.len() == 5 {
            let what = cells[1].split(',').next().unwrap();
            let Some(k) = quantities.iter().position(|it| *it == what) else {
                continue;
            };
            let values = si(of, names[k]);
            for (cell, to) in cells[3..].iter().zip([125.0, 110.0]) {
                let rows = within(&angle, -50.0, to).into_iter();
                let all: Vec<f64> = rows
                    .map(|row| values[row].abs())
                    .filter(|it| !it.is_nan())
                    .collect();
                let most = all.iter().copied().fold(0.0, f64::max);
                let mean = all.iter().sum::<f64>() / all.len() as f64;
                let (first, second) = cell.split_once(" / ").unwrap();
                let name = names[k];
                assert!(prints(first, most), "{name} to {to}: {cell} is {most:e}");
                assert!(prints(second, mean), "{name} to {to}: {cell} is {mean:e}");
                sizes += 2;
            }
        }
    }
    assert_eq!((poses, sizes), (25, 40));
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

/// What `check` tells of a text.
fn checked(text: &str) -> Vec<&'static str> {
    let report = kempe_study::check(&model(text, &[]));
    report.diagnostics.iter().map(|d| d.code).collect()
}

/// Two links that are welded, on a pin of their own; a third one on the same pin.
fn welded(clearance: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
         crank = {{ A-B = 20, mass = 1, inertia = 0 }}\narm = {{ B-P = 20 }}\n\
         coupler = {{ B-C = 50, mass = \"1 kg\", inertia = 0 }}\nlid = {{ C-Q = 20 }}\nrocker = {{ D-C = 40 }}\n\
         [joints]\nfast = {{ weld = [\"crank\", \"arm\"], at = \"B\", angle = 40 }}\n\
         firm = {{ weld = [\"rocker\", \"lid\"], at = \"C\", angle = 40 }}\n\
         [drives]\nmotor = {{ turns = \"crank\", speed = \"60 rpm\" }}\n[assembly]\nC = \"left of B -> D\"\n\
         [clearance]\n{clearance}\n[studies.play]\nkind = \"clearance\"\nrows = 5\ncolumns = [\"angle(rocker)\"]\n"
    )
}

#[test]
fn between_links_that_are_welded_there_is_no_clearance() {
    let refused = |clearance: &str| {
        let text = welded(clearance);
        let found = study(&text, &[]).unwrap_err();
        assert_eq!(found[0].code, "no-clearance-there", "{found:?}");
        assert!(
            checked(&text).contains(&"no-clearance-there"),
            "{clearance}"
        );
        found[0].message.clone()
    };
    let told = refused("B = { radial = \"20 um\", on = \"arm\" }");
    assert!(
        told.contains("B of arm") && told.contains("welded"),
        "{told}"
    );
    // Without any left there is nothing to tell of; what is welded to a later link sits on the pin with it.
    let column_of = |clearance: &str| {
        let result = study(&welded(clearance), &[]).unwrap();
        column(&result, "angle(rocker) deviation").to_vec()
    };
    assert_eq!(
        column_of("C = { radial = \"20 um\", on = \"lid\" }"),
        column_of("C = { radial = \"20 um\", on = \"rocker\" }")
    );
    assert!(column_of("C = { radial = \"20 um\" }")[0] != 0.0);
    let pair = welded("B = { radial = \"20 um\" }")
        .replace("coupler = { B-C", "coupler = { K-C")
        .replace("arm = { B-P", "arm = { B-K");
    let found = study(&pair, &[]).unwrap_err();
    assert!(
        found
            .iter()
            .any(|d| d.message.contains("at B cannot be counted")),
        "{found:?}"
    );
}

#[test]
fn check_tells_what_run_tells() {
    let base = "[clearance]\nall = { radial = \"20 um\" }\n";
    let rubs = rocker(&format!(
        "{base}[friction]\nall = {{ coefficient = 0.1, radius = 5 }}\n"
    ));
    assert!(checked(&rubs).contains(&"friction-left-out"));
    let massless = rubs.replace(", mass = \"1 kg\", inertia = 0", "");
    assert!(checked(&massless).contains(&"nothing-acts"));
    let follows = rocker(&format!(
        "{base}[loads]\npush = {{ force = [\"1 N/mm * path_length(C)\", 0], at = \"C\", on = \"rocker\" }}\n"
    ));
    assert!(checked(&follows).contains(&"not-measurable"));
    let geared = "[links]\nframe = { A = [0, 0], D = [3, 0] }\nsun = { A-B = 1, mass = 1, inertia = 1 }\nwheel = { D-E = 1 }\n\
                  [joints]\nmesh = { gears = [\"sun\", \"wheel\"], teeth = [20, 40] }\n[drives]\nmotor = { turns = \"sun\", speed = 1 }\n\
                  [clearance]\nA = { radial = \"20 um\" }\n[studies.play]\nkind = \"clearance\"\n";
    assert!(checked(geared).contains(&"no-clearance-there"));
    assert!(
        checked(&geared.replace("A = { radial", "all = { radial")).contains(&"clearance-left-out")
    );
    // Whatever run refuses or warns of before its rows, and nothing else.
    let silent = rocker("[clearance]\nB = { radial = \"20 um\" }\n");
    assert_eq!(checked(&silent), [""; 0]);
}

/// Three cranks hold one coupler.
const THREE: &str = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [60, 0], E = [30, 0] }\n\
     crank = { A-B = 20, mass = 1, inertia = 0 }\ncoupler = { B = [0, 0], C = [60, 0], F = [30, 0], mass = 1, inertia = 0 }\n\
     rocker = { D-C = 20 }\nthird = { E-F = 20 }\nflag = { F-Q = 10, mass = 1, inertia = 0 }\n\
     [drives]\nmotor = { turns = \"crank\", from = 30, to = 150, speed = \"60 rpm\" }\n\
     wave = { turns = \"flag\", at = 20 }\n[assembly]\nC = { near = [77, 10] }\n\
     [clearance]\nall = { radial = \"20 um\" }\n[studies.play]\nkind = \"clearance\"\nrows = 5\ncolumns = [\"angle(rocker)\"]\n";

#[test]
fn joints_that_repeat_each_other_are_told_once() {
    let result = study(THREE, &[]).unwrap();
    assert_eq!(
        codes(&result),
        ["overconstrained", "clearance-undetermined"]
    );
    let told = &result.diagnostics[1];
    assert!(
        told.message
            .contains("other joints repeat A, D, E, B, C and F of third, which open only"),
        "{told:?}"
    );
    assert!(
        told.help
            .as_deref()
            .is_some_and(|h| h.ends_with("nothing is repeated: F of flag")),
        "{told:?}"
    );
    for name in [
        "angle(rocker)",
        "angle(rocker) worst case",
        "angle(rocker) rms",
    ] {
        assert!(column(&result, name).iter().all(|x| x.is_nan()), "{name}");
    }
    assert!(result.listings.is_empty());
    assert!(checked(THREE).contains(&"clearance-undetermined"));
    let one = THREE.replace(
        "all = { radial = \"20 um\" }",
        "F = { radial = \"20 um\", on = \"flag\" }",
    );
    let one = study(&one, &[]).unwrap();
    assert_eq!(codes(&one), ["overconstrained", "reactions-not-unique"]);
    assert_eq!(one.table.unreached(), 0);
    assert!(!checked(&THREE.replace("[\"angle(rocker)\"]", "[\"x(Q)\"]")).contains(&"no-value"));
}

/// The last joint is found not to be idle in the last row: nothing is left to be told.
#[test]
fn a_joint_that_carries_in_the_last_row_alone_is_not_idle() {
    // The hook of the tail carries nothing but what hangs on it at the end.
    let text = rocker(
        "[clearance]\nall = { radial = \"20 um\" }\n[loads]\nwind = { force = [\"max(0 s, time - 0.95 s) * 1 N/s\", 0], at = \"T\", on = \"tail\" }\n",
    );
    let result = study(&text, &[]).unwrap();
    assert!(
        !codes(&result).contains(&"clearance-idle"),
        "{:?}",
        result.diagnostics
    );
    assert!(
        codes(&result).contains(&"clearance-not-settled"),
        "{:?}",
        result.diagnostics
    );
}

/// Two joints that are worn, one across and the others all round: all round the mean square of one component is half.
#[test]
fn the_root_mean_square_is_that_of_independent_directions() {
    let result = study(WORN, &[]).unwrap();
    let [a, b, c, guide] = [0.02_f64, 0.03, 0.05, 0.015];
    let pins = a * a + b * b + c * c;
    for row in [0, 90, 180] {
        // At its dead points the piston goes by every pin, and not by its guide.
        let place = column(&result, "place rms")[row];
        assert!((place - (pins / 2.0).sqrt()).abs() < 1e-12, "{place}");
        // The rod of 110 mm tilts by every pin and by the guide.
        let tilt = column(&result, "tilt rms")[row];
        let wanted = (pins / 2.0 + guide * guide).sqrt() / 110.0;
        assert!((tilt.to_radians() - wanted).abs() < 1e-14, "{tilt}");
        let worst = column(&result, "tilt worst case")[row];
        assert!(
            (worst.to_radians() - 0.115 / 110.0).abs() < 1e-14,
            "{worst}"
        );
    }
}

#[test]
fn numbers_over_the_rows_are_those_of_the_columns() {
    for (text, along, names) in [
        (LOCK, "lock", ["th2", "w2", "torque(lock)"]),
        (WORN, "motor", ["place", "tilt", "torque(motor)"]),
    ] {
        let result = study(text, &[]).unwrap();
        let scalar = |name: String| {
            let found = result.scalars.iter().find(|s| s.name == name);
            found.unwrap_or_else(|| panic!("{name}")).value
        };
        let extremes = kempe_study::extremes(&result);
        for name in names {
            let sizes = column(&result, &format!("{name} deviation")).iter();
            let sizes: Vec<f64> = sizes.map(|x| x.abs()).collect();
            let known: Vec<f64> = sizes.iter().copied().filter(|x| !x.is_nan()).collect();
            let most = known.iter().copied().fold(0.0, f64::max);
            let row = sizes
                .iter()
                .position(|x| *x >= most * (1.0 - 1e-9))
                .unwrap();
            assert_eq!(scalar(format!("largest deviation of {name}")), most);
            assert_eq!(
                scalar(format!("{along} at the largest deviation of {name}")),
                column(&result, along)[row],
                "{name}: of equals the first"
            );
            let mean = known.iter().sum::<f64>() / known.len() as f64;
            let told = scalar(format!("mean deviation of {name}"));
            assert!((told - mean).abs() <= 1e-15 * mean, "{name}");
            // And those that are told of every column.
            let of = format!("{name} deviation");
            let it = extremes.iter().find(|e| e.column.name == of).unwrap();
            let places = [it.smallest.unwrap(), it.largest.unwrap()].map(|e| (e.value.abs(), e.at));
            assert!(
                places.contains(&(most, column(&result, along)[row])),
                "{name}: {places:?}"
            );
        }
    }
    // The list of first order looks at the rows that the columns are told of, settled or not.
    let result = study(LOCK, &[("play", "100 um")]).unwrap();
    let extremes = kempe_study::extremes(&result);
    let worst = extremes
        .iter()
        .find(|e| e.column.name == "th2 worst case")
        .unwrap();
    let told = worst.largest.unwrap();
    assert!((112.0..=121.0).contains(&told.at), "{told:?}");
    let row = &result.listings[0].rows[0];
    assert_eq!(row[0], "th2 [deg]");
    assert_eq!(row[1], kempe_number::text::significant(told.value, 4));
    assert_eq!(row[3].parse::<f64>().unwrap(), told.at);
}

/// Where the links in the clearances turn with the forces, speeds are what the columns of places grow by; frozen, they are not.
#[test]
fn turning_links_give_the_speeds_of_the_deviations() {
    let text = |rates: &str| {
        rocker("[clearance]\nB = { radial = \"2 um\" }\nC = { radial = \"3 um\", on = \"rocker\" }\n").replace(
            "rows = 9\n",
            &format!("rows = 721\nrates = \"{rates}\"\ncolumns = [\"angle(rocker)\", \"angular_speed(rocker)\"]\n"),
        )
    };
    let [turning, frozen] = ["turning", "frozen"].map(|rates| study(&text(rates), &[]).unwrap());
    let (time, angle) = (
        column(&turning, "time"),
        column(&turning, "angle(rocker) deviation"),
    );
    let off = |result: &StudyResult| {
        let speed = &result
            .table
            .column("angular_speed(rocker) deviation")
            .unwrap();
        let speeds = speed.si();
        let size = speeds.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // A contact that turns round within a row is no place for differences.
        let smooth = (1..720).filter(|k| {
            let second = angle[k + 1] - 2.0 * angle[*k] + angle[k - 1];
            second.abs() < 0.02 * (angle[k + 1] - angle[k - 1]).abs()
        });
        let gaps = smooth.map(|k| {
            let grown = (angle[k + 1] - angle[k - 1]).to_radians() / (time[k + 1] - time[k - 1]);
            (grown - speeds[k]).abs() / size
        });
        let gaps: Vec<f64> = gaps.collect();
        (gaps.iter().copied().fold(0.0, f64::max), gaps.len())
    };
    let (exact, rows) = off(&turning);
    assert!(exact < 0.01 && rows > 200, "{exact} in {rows}");
    assert!(off(&frozen).0 > 0.1, "{:?}", off(&frozen));
}

#[test]
fn the_search_for_idle_joints_hears_progress() {
    use kempe_motion::{Done, Stage};
    let text = rocker("[clearance]\nall = { radial = \"20 um\" }\n");
    let model = model(&text, &[]);
    let mut heard = Vec::new();
    let mut stops = |stage: Stage, done: Done| {
        heard.push((stage, done));
        match (stage, done) {
            (Stage::Measuring, Done::Of(3, 9)) => std::ops::ControlFlow::Break(()),
            _ => std::ops::ControlFlow::Continue(()),
        }
    };
    let found = run(&model, &model.studies[0], &mut stops).unwrap_err();
    assert_eq!(found[0].code, "stopped");
    assert!(!heard.iter().any(|(stage, _)| *stage == Stage::Rows));
}

/// An angle at a pin is one of its two links to each other, also where pins stand open: not of points of different links.
#[test]
fn an_angle_at_a_pin_with_play_is_that_of_its_links() {
    let result = study(
        r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 250], D = [-350, 0], J = [0, 0] }
lever = { D-C = 400 }
link = { C-B = 350 }
bucket = { J-B = 380, T = [900, "-60 deg"] }
[drives]
push = { turns = "lever", from = 80, to = 120, speed = "10 deg/s" }
[assembly]
B = "right of C -> J"
[clearance]
all = { radial = 0.4 }
[loads]
tooth = { force = ["1 kN", 0], at = "T", axes = "bucket" }
[studies.worn]
kind = "clearance"
rows = 5
columns = ["transmission_angle(B)", "angle(C, B, J)", "angle(bucket, link)"]
"#,
        &[],
    );
    let result = result.unwrap_or_else(|found| panic!("{found:#?}"));
    for what in ["deviation", "worst case", "rms"] {
        let of = |name: &str| column(&result, &format!("{name} {what}"));
        for (row, wanted) in of("angle(bucket, link)").iter().enumerate() {
            assert!(*wanted != 0.0);
            for name in ["transmission_angle(B)", "angle(C, B, J)"] {
                let found = of(name)[row];
                assert!(
                    (found.abs() - wanted.abs()).abs() < 1e-6 * wanted.abs(),
                    "{name} {what}: {found} for {wanted}"
                );
            }
        }
    }
}
