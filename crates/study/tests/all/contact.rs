//! Studies of clearance in which contact is lost, as a user runs them.
#![allow(clippy::unwrap_used)]

use crate::told::column;
use std::ops::ControlFlow;

use kempe_model::Model;
use kempe_motion::{Done, Stage};
use kempe_study::{Figure, Silent, StudyResult, run};

const FOUR_BAR: &str = r#"
units = { length = "mm" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20, mass = 1, inertia = "100 kg mm^2" }
coupler = { B-C = 50, mass = 1, inertia = "100 kg mm^2" }
rocker  = { D-C = 40, mass = 1, inertia = "100 kg mm^2" }
[clearance]
B = { radial = "50 um", radius = "5 mm", restitution = 0.3, law = "LAW" }
[drives]
motor = { turns = "crank", from = 0, to = 90, speed = "300 rpm" }
[assembly]
C = { near = [50, 40] }
[measures]
swing = "angle(rocker)"
[studies.rattle]
kind    = "clearance"
model   = "three-state"
until   = "60 ms"
rows    = 121
columns = ["swing", "reaction(B)"]
"#;

fn model(text: &str) -> Model {
    let read = Model::from_toml(text, "contact", &mut |_| Err("no files".into()));
    read.unwrap().model
}

fn result(text: &str) -> StudyResult {
    let model = model(text);
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

fn codes(result: &StudyResult) -> Vec<&'static str> {
    result.diagnostics.iter().map(|d| d.code).collect()
}

/// The four-bar for a shorter time, with more in its file.
fn four_bar(until: &str, more: &str) -> String {
    let text = FOUR_BAR.replace("LAW", "rigid").replace("60 ms", until);
    text.replace("rows    = 121", "rows    = 13")
        .replace("[assembly]", &format!("{more}\n[assembly]"))
}

/// The crank keeps its law, against every impact, and stands still all at once where that ends, at 50 ms: what it gives is
/// counted, so that the energy balances, and inverse dynamics finds nothing along what is let go.
#[test]
fn energy_balances_where_a_drive_keeps_its_law_and_stops_at_once() {
    {
        let law = "rigid";
        let result = result(&FOUR_BAR.replace("LAW", law));
        assert_eq!(result.table.rows(), 121);
        let balance = result.table.balance.as_ref().unwrap();
        let worst = |column: &[f64]| {
            let sizes = column.iter().filter(|x| x.is_finite());
            sizes.fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        assert!(
            worst(&balance.energy) < 1e-7,
            "{law}: {:e}",
            worst(&balance.energy)
        );
        assert!(
            worst(&balance.power) < 1e-6,
            "{law}: {:e}",
            worst(&balance.power)
        );
        let column = |name: &str| result.table.column(name).unwrap().values.clone();
        let (x, y) = (column("B play x"), column("B play y"));
        let (touching, force) = (column("B touching"), column("reaction(B)"));
        for row in 0..121 {
            // A bore that gives lets the pin in a little deeper, and a force is where it touches.
            let off = kempe_number::math::hypot(x[row], y[row]);
            assert!(off < 0.0505, "{law}: {off} mm in row {row}");
            if touching[row] == 0.0 {
                assert!(force[row] < 1e-6, "{law}: {} N in row {row}", force[row]);
            } else {
                assert!(off > 0.05 - 1e-9, "{law}: {off} mm in row {row}");
            }
        }
        assert!(touching.contains(&1.0) && touching.contains(&0.0));
        // Half a tenth of a millimetre turns a rocker of 40 mm by some hundredths of a degree.
        let deviation = column("swing deviation");
        assert!(worst(&deviation) > 1e-3 && worst(&deviation) < 0.5);
        let orbit =
            |figure: &Figure| matches!(figure, Figure::Hodograph(name, _) if name == "orbit of B");
        assert!(result.figures.iter().any(orbit));
    }
}

/// A load that a switch turns on acts in the ideal motion too, from the instant on at which it was turned on with play: there the
/// motion is that of a study of forces with this load.
#[test]
fn a_switch_turns_a_load_on_in_the_ideal_motion_too() {
    let switched = four_bar(
        "30 ms",
        "[switches]\nfar = { on = \"motor >= 45 deg\" }\n[loads]\npush = { torque = \"-2 N m * switch(far)\", on = \"rocker\" }",
    )
    .replace("\"mm\"", "\"mm\", angle = \"deg\"")
    .replace("\"reaction(B)\"", "\"torque(motor)\", \"switch(far)\"");
    let found = result(&switched);
    let ideal: Vec<f64> = (column(&found, "torque(motor)").iter())
        .zip(column(&found, "torque(motor) deviation"))
        .map(|(value, deviation)| value - deviation)
        .collect();
    let forces = |push: f64| {
        let text = switched
            .split("[studies")
            .next()
            .unwrap()
            .replace("-2 N m * switch(far)", &format!("{push} N m"));
        let study = "[studies.loads]\nkind = \"forces\"\nstep = \"2.5 ms\"\ncolumns = [\"torque(motor)\"]\n";
        column(&result(&(text + study)), "torque(motor)")
    };
    let (off, on) = (forces(0.0), forces(-2.0));
    assert_eq!(
        column(&found, "switch(far)"),
        [vec![0.0; 10], vec![1.0; 3]].concat()
    );
    for row in 0..13 {
        let known = if row < 10 { off[row] } else { on[row] };
        assert!(
            (ideal[row] - known).abs() < 1e-9,
            "{row}: {} {known}",
            ideal[row]
        );
    }
    assert!((on[12] - off[12]).abs() > 0.1);
}

/// Whoever stops it while it shows what was found gets that, with its deviations; only before there is nothing.
#[test]
fn what_was_found_is_kept_whenever_it_is_stopped() {
    let model = model(&four_bar("10 ms", ""));
    let run_until = |calls: usize, again: bool| {
        let (mut count, mut stages) = (0, Vec::new());
        let mut progress = |stage: Stage, _: Done| {
            count += 1;
            stages.push(stage);
            match count == calls || (again && count > calls) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let found = run(&model, &model.studies[0], &mut progress);
        (found, stages)
    };
    let (whole, stages) = run_until(usize::MAX, false);
    let whole = whole.unwrap();
    assert!(!whole.interrupted());
    let first = |stage: Stage| stages.iter().position(|s| *s == stage).unwrap();
    let last = stages
        .iter()
        .rposition(|s| *s == Stage::Simulating)
        .unwrap();
    // On the way, and wherever what shows the motion comes to another stage.
    let changes = (last + 1..stages.len()).filter(|k| stages[*k] != stages[*k - 1]);
    let calls: Vec<usize> = [0, first(Stage::Simulating) + 200, last]
        .into_iter()
        .chain(changes)
        .chain([first(Stage::Rows) + 4])
        .collect();
    for (call, again) in calls
        .into_iter()
        .flat_map(|call| [(call, true), (call, false)])
    {
        let stage = stages[call];
        let found = match run_until(call + 1, again).0 {
            Err(told) => {
                assert_eq!((told[0].code, call), ("stopped", 0), "{stage:?}");
                continue;
            }
            Ok(found) => found,
        };
        let rows = found.table.rows();
        assert!(rows > 0 && rows <= 13, "{stage:?} {call}");
        assert_eq!(column(&found, "swing deviation").len(), rows);
        assert_eq!(column(&found, "B touching").len(), rows);
        assert!(found.interrupted() || rows == 13, "{stage:?} {call}");
        for name in ["swing", "swing deviation"] {
            let pairs = column(&whole, name).into_iter().zip(column(&found, name));
            for (whole, found) in pairs.take(rows - 1) {
                assert!((whole - found).abs() < 1e-9, "{name}, {stage:?} {call}");
            }
        }
    }
}

/// Where there is play the contact rubs, or nothing does: in the motion with play, in the ideal one, and in what is told.
#[test]
fn friction_of_a_joint_with_play_is_left_out_and_told() {
    let smooth = result(&four_bar("10 ms", ""));
    assert_eq!(codes(&smooth), [""; 0]);
    let rubs = four_bar("10 ms", "[friction]\nB = { coefficient = 0.1, radius = 5 }");
    let found = result(&rubs);
    assert_eq!(codes(&found), ["friction-left-out"]);
    for name in ["swing", "reaction(B)", "reaction(B) deviation"] {
        assert_eq!(column(&found, name), column(&smooth, name), "{name}");
    }
    let all = rubs.replace("\nB = { coefficient", "\nall = { coefficient");
    // Elsewhere it acts.
    let found = result(&all);
    assert_eq!(codes(&found), ["friction-left-out"]);
    assert_ne!(column(&found, "swing"), column(&smooth, "swing"));
    let balance = found.table.balance.as_ref().unwrap();
    assert!(balance.energy.iter().all(|x| x.abs() < 1e-7));
    let worn = all.replace("B = { radial", "all = { radial");
    let told = &kempe_study::check(&model(&worn)).diagnostics;
    let told: Vec<&str> = told.iter().map(|d| d.message.as_str()).collect();
    assert!(
        told.iter()
            .any(|m| m.contains("[friction] at A, D, B and C is left out")),
        "{told:?}"
    );
}

/// The ideal mechanism stops at its limit; with play it goes on a little.
#[test]
fn rows_that_the_ideal_motion_does_not_reach_are_told() {
    let text = include_str!("../../../cli/tests/bad/no-ideal-motion.toml");
    let found = result(text);
    assert_eq!(codes(&found), ["no-ideal-motion"]);
    let known: Vec<bool> = (column(&found, "angle(rocker) deviation").iter())
        .map(|x| x.is_finite())
        .collect();
    let reached = known.iter().filter(|known| **known).count();
    assert!(0 < reached && reached < known.len() && known[..reached].iter().all(|x| *x));
    assert!(
        column(&found, "angle(rocker)")
            .iter()
            .all(|x| x.is_finite())
    );
    let told = format!("{} rows from", known.len() - reached);
    assert!(found.diagnostics[0].message.contains(&told), "{found:?}");
}

/// A bob of 2 kg on a pin with a play of 10 mm, whose drive stands: it falls and flies as a point does.
fn bob(law: &str, start: &str) -> String {
    format!(
        "units = {{ length = \"mm\" }}\n[links]\nframe = {{ A = [0, 0] }}\nbob = {{ A = [0, 0], mass = 2, inertia = 1 }}\n\
         [clearance]\nA = {{ radial = 10, radius = 50, {law} }}\n[drives]\nturn = {{ turns = \"bob\", at = 0 }}\n\
         [studies.s]\nkind = \"clearance\"\nmodel = \"three-state\"\nuntil = \"60 ms\"\nrows = 7\n\
         start = {{ {start} }}\ncolumns = [\"reaction(A)\"]\n"
    )
}

const BLOCK: &str = "units = { length = \"mm\" }\n[links]\nframe = { O = [0, 0], X = [1000, 0] }\n\
     block = { C = [0, 0], mass = 1, inertia = \"500 kg mm^2\" }\n[joints]\nway = { slider = \"block\", at = \"C\", on = \"O -> X\" }\n\
     [drives]\ntravel = { slides = \"way\", at = 100 }\n[clearance]\n\
     way = { radial = 0.1, length = 40, height = 20, restitution = 0.3 }\n[studies.s]\nkind = \"clearance\"\n\
     model = \"three-state\"\nuntil = \"10 ms\"\nrows = 3\nstart = { START }\ncolumns = [\"y(C)\"]\n";

/// A journal starts where, and as fast as, it is told to: flights are those of a thrown stone.
#[test]
fn a_journal_starts_where_it_is_told() {
    const G: f64 = 9.81;
    let rigid = "law = \"rigid\", restitution = 0.5";
    let flight = |way: f64, up: f64| (up + (up * up + 2.0 * G * way).sqrt()) / G;
    for (start, way, up) in [
        ("A = [0, 4]", 0.014, 0.0),
        ("A = [\"4 mm\", \"90 deg\"]", 0.014, 0.0),
        ("A_rate = [0, 100]", 0.01, 0.1),
        (
            "A = [0, -6], A_rate = [\"0.1 m/s\", \"90 deg\"]",
            0.004,
            0.1,
        ),
    ] {
        let found = result(&bob(rigid, start));
        let known = flight(way, up);
        let time = found.contacts[0].time;
        assert!(
            (time / known - 1.0).abs() < 1e-10,
            "{start}: {time} {known}"
        );
        let speed = found.contacts[0].speed;
        assert!(
            (speed / (G * known - up) - 1.0).abs() < 1e-10,
            "{start}: {speed}"
        );
        assert_eq!(codes(&found), [""; 0], "{start}");
    }
    // The left side of its line is above it.
    for (start, way) in [("way = [0.05, 0]", 1.5e-4), ("way = [-0.05, 0]", 0.5e-4)] {
        let found = result(&BLOCK.replace("START", start));
        let (time, known) = (found.contacts[0].time, flight(way, 0.0));
        assert!(
            (time / known - 1.0).abs() < 1e-10,
            "{start}: {time} {known}"
        );
    }
    // Turned by 1 mrad its lower front corner is 20 um lower: it falls by so much less.
    let turned = result(&BLOCK.replace("START", "way = [0, \"-1 mrad\"]"));
    let (time, known) = (turned.contacts[0].time, flight(0.8e-4, 0.0));
    assert!((time / known - 1.0).abs() < 1e-3, "{time} {known}");
    assert_eq!(turned.contacts[0].place, "the front right corner of way");
    let turning = result(&BLOCK.replace("START", "way_rate = [0, -0.5]"));
    assert_eq!(turning.contacts[0].place, "the front right corner of way");
}

/// What starts at the bottom lies there, or gives and rises again: by energy, Hertz's law comes to five halves of the weight.
#[test]
fn a_journal_may_start_pressed_on_its_bore() {
    let weight = 2.0 * 9.81;
    let bottom = "A = [\"10 mm\", \"-90 deg\"]";
    let rests = result(&bob("law = \"rigid\", restitution = 0.5", bottom));
    assert!(
        column(&rests, "reaction(A)")
            .iter()
            .all(|n| (n - weight).abs() < 1e-9)
    );
    assert_eq!(column(&rests, "A touching"), [1.0; 7]);
    assert!(rests.contacts.is_empty());
    let counted = |it: &StudyResult| {
        let found = it.listings.iter().find(|it| it.title == "Contacts");
        found.unwrap().rows[0].clone()
    };
    assert_eq!(counted(&rests)[4], "100.0 %");
    for law in [
        "law = \"hertz\", stiffness = 1e9",
        "restitution = 0.5, stiffness = 1e9",
    ] {
        let gives = result(&bob(law, bottom));
        let touch = gives.contacts[0].touch.unwrap();
        assert_eq!(gives.contacts[0].time, 0.0, "{law}");
        assert!(
            (touch.force / (2.5 * weight) - 1.0).abs() < 1e-6,
            "{law}: {}",
            touch.force
        );
        let deepest = kempe_number::math::powf(2.5 * weight / 1e9, 2.0 / 3.0);
        assert!(
            (touch.depth / deepest - 1.0).abs() < 1e-6,
            "{law}: {}",
            touch.depth
        );
    }
}

#[test]
fn starts_that_cannot_be_are_refused() {
    let rigid = "law = \"rigid\", restitution = 0.5";
    let refused = |text: &str| {
        let file = Model::from_toml(text, "contact", &mut |_| Err("no files".into()));
        let told = match file {
            Err(told) => told,
            Ok(file) => run(&file.model, &file.model.studies[0], &mut Silent).unwrap_err(),
        };
        let first = &told[0];
        assert!(first.help.is_some(), "{first:?}");
        (first.code, first.message.clone())
    };
    let (code, told) = refused(&bob(rigid, "A = [0, 10.5]"));
    assert_eq!(code, "cannot-simulate");
    assert!(
        told.contains("A starts with its bodies in each other, by 0.5 mm"),
        "{told}"
    );
    let (code, told) = refused(&BLOCK.replace("START", "way = [0.09, \"1 deg\"]"));
    assert_eq!(code, "cannot-simulate");
    assert!(told.contains("corner of way"), "{told}");
    for (start, wanted) in [
        ("A = 3", "wrong-type"),
        ("A = [1, 2, 3]", "wrong-type"),
        ("A = [\"1 kg\", 2]", "unit-mismatch"),
        ("A = [1, \"2 kg\"]", "unit-mismatch"),
        ("A_rate = [1, \"2 mm\"]", "unit-mismatch"),
        ("E = [1, 2]", "unknown-name"),
        ("turn = 3", "contradictory-values"),
        ("nothing = 3", "unknown-name"),
    ] {
        assert_eq!(refused(&bob(rigid, start)).0, wanted, "{start}");
    }
    assert_eq!(
        refused(&four_bar("5 ms", "").replace("columns", "start = { C = [0, 0] }\ncolumns")).0,
        "no-clearance-there"
    );
    let three = four_bar("5 ms", "").replace(
        "B-C = 50,",
        "B-C = 50, C-E = 9, B-E = 50, E = \"left of B -> C\",",
    );
    let three = three.replace("[clearance]", "lid = { B-F = 9 }\n[clearance]");
    let three = three.replace("[drives]", "[drives]\nlift = { turns = \"lid\", at = 3 }");
    let (code, told) = refused(&three.replace("columns", "start = { B = [0, 0] }\ncolumns"));
    assert_eq!(code, "no-clearance-there");
    assert!(told.contains("several links"), "{told}");
}

/// The summary lists some contacts, JSON tells all of them, with the numbers of the result.
#[test]
fn json_tells_every_contact() {
    for (law, many) in [("rigid", true), ("exact", false)] {
        let result = result(&FOUR_BAR.replace("LAW", law));
        assert_eq!(result.contacts.len() > 30, many, "{law}");
        let told = kempe_study::encode::result(&result, false);
        let told = told["contacts"].as_array().unwrap();
        assert_eq!(told.len(), result.contacts.len(), "{law}");
        for (told, met) in told.iter().zip(&result.contacts) {
            assert_eq!(told["joint"], "B");
            assert_eq!(told["time_si"].as_f64(), Some(met.time));
            assert_eq!(told["speed_si"].as_f64(), Some(met.speed));
            assert_eq!(told["speed_after_si"].as_f64(), met.speed_after);
            let touch = met.touch.as_ref();
            assert_eq!(touch.is_none(), many, "{law}");
            assert_eq!(told["until_si"].as_f64(), touch.map(|it| it.until));
            assert_eq!(told["force_si"].as_f64(), touch.map(|it| it.force));
            assert_eq!(told["depth_si"].as_f64(), touch.map(|it| it.depth));
        }
    }
}
