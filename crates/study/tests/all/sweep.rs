//! Sweeps: which designs they have, what is told of each, and that their parts make the same whole.
// Rows are Parquet: without it there is nothing to hold sweeps against.
#![cfg(feature = "parquet")]
#![allow(
    clippy::disallowed_methods,
    reason = "numbers found by hand beside ours, not reproducible ones"
)]

use crate::told::{column, scalar};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

use crate::impatient::Impatient;
use crate::read::read;
use kempe_batch::{Serial, Threads};
use kempe_model::{Diagnostic, Model, Study};
use kempe_study::{
    Done, Figure, Parts, ReportOrigin, RowFiles, Silent, Stage, StudyOutcome, StudyResult, check,
    compute_parts, encode, part_count, report, run, run_in_parts, run_with,
};

/// A crank-rocker; the rocker swings the further, the longer the crank is.
const FOUR_BAR: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\nidle = \"3 mm\"\n[links]\n\
    frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = \"b\", P = [25, 10] }\nrocker = { D-C = 40 }\n[drives]\n\
    motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> D\"\n[measures]\n\
    swing = \"range(angle(rocker))\"\nangle = \"angle(rocker)\"\n[studies.turn]\nkind = \"motion\"\nstep = 30\ncolumns = [\"angle\"]\n";

fn model(sweep: &str) -> Model {
    let text = format!("{FOUR_BAR}[studies.some]\nkind = \"sweep\"\nover = \"turn\"\n{sweep}\n");
    match Model::from_toml(&text, "test", &mut |_| Err("no files".into())) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found)),
    }
}

fn rendered(found: &[Diagnostic]) -> String {
    found
        .iter()
        .map(|d| format!("{}: {}\n", d.code, d.message))
        .collect()
}

fn result_of(model: &Model, study: &Study) -> StudyResult {
    run(model, study, &mut Silent).unwrap_or_else(|told| panic!("{}", rendered(&told)))
}

fn ran(sweep: &str) -> StudyResult {
    let model = model(sweep);
    result_of(&model, &model.studies[1])
}

/// The swing of the rocker between the dead centres of a crank-rocker, deg.
fn swing(a: f64, b: f64) -> f64 {
    let angle =
        |r: f64| ((60.0_f64.powi(2) + 40.0_f64.powi(2) - r * r) / (2.0 * 60.0 * 40.0)).acos();
    (angle(b + a) - angle(b - a)).to_degrees()
}

/// The x of the coupler's point P as the crank stands at an angle, rad, mm.
fn place(a: f64, b: f64, crank: f64) -> f64 {
    let (x, y) = (a * crank.cos(), a * crank.sin());
    let (far, down) = (60.0 - x, -y);
    let d = far.hypot(down);
    let along = (b * b - 1600.0 + d * d) / (2.0 * d);
    let aside = (b * b - along * along).sqrt();
    let (c, s) = (
        (far * along - down * aside) / (d * b),
        (down * along + far * aside) / (d * b),
    );
    x + 25.0 * c - 10.0 * s
}

/// The place of an `at` goes with the parameters that it is made of, in designs, derivatives and searches.
#[test]
fn the_place_of_an_at_follows_its_parameters() {
    let there = "at(x(P), motor, a * 50 rad / (1 m))";
    let of = |a: f64| place(a, 50.0, 0.05 * a);
    let result = ran(&format!(
        "vary = {{ a = {{ from = 15, to = 25, count = 6 }} }}\ncolumns = [\"{there}\"]"
    ));
    let found = column(&result, there);
    for (found, a) in found.iter().zip(column(&result, "a")) {
        assert!((found - of(a)).abs() < 1e-9, "{a}: {found}");
    }
    let search = format!(
        "{FOUR_BAR}[studies.best]\nkind = \"optimize\"\nover = \"turn\"\nvary = {{ a = [15, 25] }}\nmaximize = \"{there}\"\n"
    );
    let checked = Model::from_toml(&search, "test", &mut |_| Err("no files".into()));
    let model = checked.expect("a model").model;
    let best = result_of(&model, &model.studies[1]);
    let known = (0..=10_000).map(|k| of(15.0 + f64::from(k) * 1e-3));
    let known = known.fold(f64::NEG_INFINITY, f64::max);
    let found = scalar(&best, there);
    assert!((found - known).abs() < 1e-6, "{found} {known}");
}

#[test]
fn the_last_parameter_of_a_grid_goes_fastest() {
    let result = ran(
        "vary = { a = [15, 20], b = { from = 46, to = 54, count = 3 } }\ncolumns = [\"swing\"]",
    );
    assert_eq!(column(&result, "design"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(column(&result, "a"), [15.0, 15.0, 15.0, 20.0, 20.0, 20.0]);
    assert_eq!(column(&result, "b"), [46.0, 50.0, 54.0, 46.0, 50.0, 54.0]);
    let found = column(&result, "swing");
    let pairs = column(&result, "a").into_iter().zip(column(&result, "b"));
    for (found, (a, b)) in found.iter().zip(pairs) {
        assert!((found - swing(a, b)).abs() < 1e-9, "{a} {b}: {found}");
    }
    assert!(result.table.worst_closure() < 1e-12);
    assert!(result.table.least_singular_value() > 1e-3);
}

/// Readers of tables find columns by name: what is varied, or asked for twice, has one.
#[test]
fn what_is_asked_for_twice_stands_once() {
    let result =
        ran("vary = { a = [15, 20] }\ncolumns = [\"a\", \"swing\", \"swing\", \"max(angle)\"]");
    let names: Vec<&str> = (result.table.columns.iter())
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(names, ["design", "a", "swing", "max(angle)"]);
    assert_eq!(column(&result, "a"), [15.0, 20.0]);
}

#[test]
fn one_at_a_time_the_rest_is_as_in_the_file() {
    let result = ran(
        "vary = { a = { by = \"1 %\" }, b = [48, 50, 52, 53] }\ncombine = \"one at a time\"\ncolumns = [\"swing\"]",
    );
    let a = column(&result, "a");
    // The file's own design once, and nothing else twice.
    assert_eq!(a, [20.0, 19.8, 20.2, 20.0, 20.0, 20.0]);
    assert_eq!(column(&result, "b"), [50.0, 50.0, 50.0, 48.0, 52.0, 53.0]);
    let told = result
        .listings
        .iter()
        .find(|l| l.title.starts_with("what changes swing"));
    let rows = &told.expect("a ranking").rows;
    // From 19.8 to 20.2 mm the swing grows by 1.2 deg, from 48 to 53 mm it falls by less.
    assert!(
        rows[0][0].starts_with("a ") && rows[1][0].starts_with("b "),
        "{rows:?}"
    );
    let tornado = result.figures.iter().find_map(|figure| match figure {
        Figure::Graph { name, curves, .. } if name.starts_with("tornado") => Some(curves),
        _ => None,
    });
    let bars = tornado.expect("a tornado");
    let (least, greatest) = (bars[0].points[0][0], bars[0].points[1][0]);
    assert!((least - swing(19.8, 50.0)).abs() < 1e-9);
    assert!((greatest - swing(20.2, 50.0)).abs() < 1e-9);
}

/// The crane that luffs level: what counts for its drop, in order and by how much, as the closed form of the four-bar has it (docs/luffing-crane.md).
#[test]
fn sizes_of_the_crane_are_ranked() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/seeds/luffing-crane.toml"
    );
    let text = std::fs::read_to_string(path).expect("text");
    let model = read(&text);
    let study = model.studies.iter().find(|study| study.name == "sizes");
    let result = result_of(&model, study.expect("a study"));
    let mut all = result.listings.iter();
    let ranked = all.find(|l| l.title.starts_with("what changes drop"));
    let ranked = ranked.expect("a ranking").rows.iter();
    let told = ranked.map(|row| {
        let name = row[0].split(' ').next().unwrap_or_default();
        let apart = row.last().and_then(|it| it.parse().ok());
        (name, apart.unwrap_or(f64::NAN))
    });
    let told: Vec<(&str, f64)> = told.collect();
    let wanted = [
        ("l3", 0.483_650_109_000 - 0.124_461_032_792),
        ("l1", 0.406_593_380_491 - 0.124_461_032_792),
        ("theta", 0.303_120_132_449 - 0.124_461_032_792),
        ("cx", 0.228_451_234_464 - 0.124_461_032_792),
        ("l2", 0.201_823_589_904 - 0.124_461_032_792),
        ("l4", 0.174_210_170_037 - 0.111_698_810_791),
        ("cy", 0.130_371_678_726 - 0.124_461_032_792),
    ];
    assert_eq!(told.len(), wanted.len(), "{told:?}");
    for ((name, apart), (other, exact)) in told.iter().zip(wanted) {
        assert_eq!(*name, other, "{told:?}");
        assert!(
            (apart - exact).abs() < 1e-5 * exact,
            "{name}: {apart} {exact}"
        );
    }
}

#[test]
fn together_the_first_values_go_with_the_first() {
    let result = ran(
        "vary = { a = [15, 18, 21], b = [46, 49, 52] }\ncombine = \"together\"\ncolumns = [\"swing\"]",
    );
    assert_eq!(column(&result, "a"), [15.0, 18.0, 21.0]);
    assert_eq!(column(&result, "b"), [46.0, 49.0, 52.0]);
}

#[test]
fn a_design_that_fails_is_a_row_with_its_reason() {
    // 20 + 60 > 15 + 40: no crank turns all around; a crank of no length is none.
    let result = ran("vary = { b = [50, 15, 5], a = [20, 0] }\ncolumns = [\"swing\"]");
    let notes: Vec<bool> = result.table.notes.iter().map(Option::is_some).collect();
    let values: Vec<bool> = column(&result, "swing")
        .iter()
        .map(|v| v.is_finite())
        .collect();
    assert_eq!(notes.len(), 6);
    assert!(!notes[0] && values[0]);
    for row in 1..6 {
        assert!(
            notes[row] != values[row],
            "{row}: {:?}",
            result.table.notes[row]
        );
    }
    assert!(notes[2] && notes[4], "{:?}", result.table.notes);
    assert_eq!(column(&result, "b"), [50.0, 50.0, 15.0, 15.0, 5.0, 5.0]);
}

/// Designs without values are told with their reasons wherever they stand, in the page, too.
#[test]
fn designs_without_values_are_listed_wherever_they_stand() {
    let model = model(
        "vary = { a = { from = '10.25 mm', to = '38.25 mm', count = 57 } }\ncolumns = 'swing'",
    );
    let result = result_of(&model, &model.studies[1]);
    let first = result
        .table
        .notes
        .iter()
        .position(Option::is_some)
        .expect("a note");
    assert_eq!(first, 40);
    let told = |listing: &[Vec<String>]| {
        listing
            .iter()
            .filter(|row| row.join(" ").contains("cannot cover"))
            .count()
    };
    let rows = &result.listings[0].rows;
    assert_eq!(told(rows), 10.min(result.table.unreached()));
    let all = rows.len() - 1;
    assert_eq!(rows[all], [format!("and {} more", 57 - all)]);
    let outcome = StudyOutcome {
        study: &model.studies[1],
        result: Ok(result.clone()),
    };
    let origin = ReportOrigin::default();
    let page = report(&model, &origin, &[], &check(&model), &[outcome], None).to_html();
    assert_eq!(
        page.matches("cannot cover").count(),
        result.table.unreached()
    );
}

#[test]
fn the_file_s_own_design_need_not_move() {
    let result = {
        let text = FOUR_BAR.replace("b = \"50 mm\"", "b = \"15 mm\"");
        let text = format!(
            "{text}[studies.some]\nkind = \"sweep\"\nover = \"turn\"\nvary = {{ b = [15, 50] }}\ncolumns = [\"swing\"]\n"
        );
        let checked = Model::from_toml(&text, "test", &mut |_| Err("no files".into()));
        let model = checked.expect("a model").model;
        run(&model, &model.studies[1], &mut Silent).expect("a result")
    };
    let found = column(&result, "swing");
    assert!(found[0].is_nan() && (found[1] - swing(20.0, 50.0)).abs() < 1e-9);
    let told = &result.diagnostics[0].message;
    assert!(
        told.starts_with("the file's own design does not move"),
        "{told}"
    );
}

#[test]
fn exact_derivatives_stand_beside_differences() {
    // The second bends at the file's own value.
    let result = ran(
        "vary = { a = { by = \"0.001 mm\" } }\ncolumns = [\"swing\", \"max(2 * a + abs(a - 20 mm))\"]",
    );
    let told = result
        .listings
        .iter()
        .find(|l| l.title.starts_with("exact derivatives"));
    let rows = &told.expect("derivatives").rows;
    let slopes = |texts: &[String]| -> Vec<f64> {
        let texts = texts.iter();
        texts.map(|x| x.parse().expect("a number")).collect()
    };
    let numbers = slopes(&rows[0][2..5]);
    let slope = (swing(20.001, 50.0) - swing(19.999, 50.0)) / 0.002;
    assert!(
        numbers.iter().all(|x| (x - slope).abs() < 1e-4 * slope),
        "{rows:?}, {slope}"
    );
    assert_eq!(rows[0][5], "deg/mm");
    // There is no derivative, and one on either side.
    assert_eq!(rows[1][2], "none");
    let bent = slopes(&rows[1][3..5]);
    assert!(
        (bent[0] - 1.0).abs() < 1e-6 && (bent[1] - 3.0).abs() < 1e-6,
        "{bent:?}"
    );
}

#[test]
fn a_parameter_without_effect_is_told_by_check_and_run() {
    let sweep = "vary = { idle = [2, 4], a = [18, 20] }\ncolumns = [\"swing\", \"max(speed(C))\"]";
    let idle = |found: &[Diagnostic]| -> Vec<String> {
        let found = found.iter().filter(|d| d.code == "idle-parameter");
        found.map(|d| d.message.clone()).collect()
    };
    let wanted = ["`idle` changes none of the numbers"];
    assert_eq!(idle(&ran(sweep).diagnostics), wanted);
    assert_eq!(idle(&check(&model(sweep)).diagnostics), wanted);
}

/// One value cannot show that nothing changes, and what has no effect at the file's own design may have one beside it.
#[test]
fn what_may_have_an_effect_is_not_told_to_have_none() {
    let idle = |sweep: &str| {
        let found = ran(sweep).diagnostics.into_iter();
        found.filter(|d| d.code == "idle-parameter").count()
    };
    assert_eq!(idle("vary = { a = [20] }\ncolumns = ['swing']"), 0);
    let mixed = "swing + (a - 20 mm)*(idle - 3 mm)/(1 mm^2)*(1 deg)";
    let both = format!("columns = [\"{mixed}\"]");
    assert_eq!(idle(&format!("vary = {{ idle = [2, 4] }}\n{both}")), 1);
    assert_eq!(
        idle(&format!("vary = {{ idle = [2, 4], a = [18, 21] }}\n{both}")),
        0
    );
}

/// A number that some designs have and others have not is told once for all, beside the notes of the rows.
#[test]
fn numbers_that_some_designs_lack_are_told() {
    let root = "sqrt(60 - swing/(1 deg))";
    let result = ran(&format!(
        "vary = {{ a = [18, 19, 20, 22] }}\ncolumns = [\"{root}\"]"
    ));
    let found = result.diagnostics.iter().find(|d| d.code == "no-value");
    let told = found.map(|d| d.message.as_str());
    assert_eq!(
        told,
        Some(&*format!("`{root}` has no value in 2 of 4 designs"))
    );
    let values = column(&result, root);
    let wanted = [18.0, 19.0, 20.0, 22.0].map(|a| (60.0 - swing(a, 50.0)).sqrt());
    for (found, wanted) in values.iter().zip(wanted) {
        let same = (found - wanted).abs() < 1e-6;
        assert!(
            same || found.is_nan() && wanted.is_nan(),
            "{found} {wanted}"
        );
    }
}

#[test]
fn designs_whose_branches_cross_are_noted() {
    let result = ran("vary = { a = ['29 mm', '30 mm'] }\ncolumns = ['swing']");
    let notes: Vec<Option<&str>> = result.table.notes.iter().map(Option::as_deref).collect();
    assert_eq!(notes, [None, Some("through a change point")]);
}

#[test]
fn curves_of_all_designs_are_in_one_picture_up_to_some() {
    let result =
        ran("vary = { a = { from = 15, to = 20, count = 50 } }\nplot = [\"angle\", \"path(P)\"]");
    // Three numbers over the parameter are not asked for: the least and the largest of all named ones.
    let family = result.figures.iter().find_map(|figure| match figure {
        Figure::Graph {
            name, x, curves, ..
        } if name == "angle" => Some((x, curves)),
        _ => None,
    });
    let (x, curves) = family.expect("a family");
    assert_eq!((x.0.as_str(), x.1.text()), ("motor", "deg"));
    assert_eq!(curves.len(), 24);
    assert_eq!(curves[0].name, "a = 15 mm");
    assert_eq!(curves[23].name, "a = 20 mm");
    assert_eq!(curves[0].points.len(), 13);
    let paths = result.figures.iter().find_map(|figure| match figure {
        Figure::Plane { name, curves, .. } => Some((name, curves)),
        _ => None,
    });
    let (name, paths) = paths.expect("paths");
    assert_eq!((name.as_str(), paths.len()), ("path-P", 24));
    let left = result
        .listings
        .iter()
        .any(|l| l.title.contains("24 designs of 50"));
    assert!(left, "it is told that some are left out");
}

/// Keeps parts in memory, and stops after some.
#[derive(Default)]
struct Memory(BTreeMap<usize, Vec<u8>>, Option<(usize, usize)>);

impl Parts for Memory {
    fn kept(&mut self, part: usize) -> Result<Option<Vec<u8>>, Box<Diagnostic>> {
        Ok(self.0.get(&part).cloned())
    }

    fn keep(&mut self, part: usize, bytes: Vec<u8>) -> Result<(), Box<Diagnostic>> {
        self.0.insert(part, bytes);
        Ok(())
    }

    fn computes(&self, part: usize) -> bool {
        self.1.is_none_or(|(own, of)| part % of == own)
    }
}

const MANY: &str = "vary = { a = { from = 15, to = 20, count = 20 }, b = { from = 14, to = 54, count = 5 } }\ncolumns = [\"swing\"]\nplot = [\"angle\"]";

/// All that is told of a sweep, as bytes.
fn told(model: &Model, parts: &mut Memory) -> Vec<u8> {
    let study = &model.studies[1];
    let result = run_in_parts(model, study, (&Serial, parts), &mut Silent).expect("a result");
    let mut bytes = encode::csv(&result.table).into_bytes();
    bytes.extend(format!("{:?}{:?}", result.figures, result.listings).into_bytes());
    let files = RowFiles::of(model, study).expect("a sweep");
    assert_eq!(files.count(), 1);
    files.write(0, parts, &[], &mut bytes).expect("rows");
    bytes
}

#[test]
fn parts_make_the_same_whole_however_they_were_computed() {
    let model = model(MANY);
    let study = &model.studies[1];
    assert_eq!(part_count(&model, study), Ok(Some(7)));
    assert_eq!(part_count(&model, &model.studies[0]), Ok(None));
    let whole = told(&model, &mut Memory::default());
    // By others, in another order.
    let mut shared = Memory::default();
    for own in [2, 0, 1] {
        shared.1 = Some((own, 3));
        let done = compute_parts(&model, study, (&Threads(2), &mut shared), &mut Silent);
        assert!(done.is_ok_and(|(all, _)| all));
    }
    assert_eq!(shared.0.len(), 7);
    assert!(
        told(&model, &mut shared) == whole,
        "three shares differ from one run"
    );
    // Stopped after any number of designs, and gone on with.
    for stop in [1, 16, 17, 60, 99] {
        let mut kept = Memory::default();
        let mut until = |stage: Stage, done: Done| match (stage, done) {
            (Stage::Rows, Done::Of(done, _)) if done >= stop => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let partial = run_in_parts(&model, study, (&Serial, &mut kept), &mut until);
        let partial = partial.expect("some designs");
        assert!(
            partial.table.rows() >= stop.min(16) && partial.table.rows() < stop + 16,
            "stopped at {stop}"
        );
        assert!(told(&model, &mut kept) == whole, "stopped at {stop}");
    }
    // Or in the middle of any design.
    for asks in [40, 1000, 5000] {
        let mut kept = Memory::default();
        let mut until = Impatient::after(asks);
        let partial = run_in_parts(&model, study, (&Threads(2), &mut kept), &mut until);
        let rows = partial.map_or(0, |partial| partial.table.rows());
        assert!(until.is_out() && rows < 100, "{rows} after {asks}");
        assert!(told(&model, &mut kept) == whole, "stopped after {asks}");
    }
    // What is no part is computed again.
    let mut wrong = Memory::default();
    told(&model, &mut wrong);
    let second = wrong.0[&1].clone();
    wrong.0.insert(0, second);
    wrong.0.insert(2, b"nonsense".to_vec());
    assert!(told(&model, &mut wrong) == whole, "wrong parts are used");
}

#[test]
fn threads_and_kept_rows_change_nothing() {
    let model = model(MANY);
    let study = &model.studies[1];
    let serial = run(&model, study, &mut Silent).expect("a result");
    let threads = run_with(&model, study, &Threads(3), &mut Silent).expect("a result");
    let kept = run_in_parts(
        &model,
        study,
        (&Serial, &mut Memory::default()),
        &mut Silent,
    );
    let csv = encode::csv(&serial.table);
    assert_eq!(encode::csv(&threads.table), csv);
    assert_eq!(encode::csv(&kept.expect("a result").table), csv);
}

/// The first numbers of the rows in a file.
fn rows_of(files: &RowFiles<'_>, file: usize, parts: &mut Memory) -> Vec<Vec<f64>> {
    let mut bytes = Vec::new();
    files.write(file, parts, &[], &mut bytes).expect("rows");
    let reader = parquet::file::reader::SerializedFileReader::new(bytes::Bytes::from(bytes));
    let reader = reader.expect("a file");
    let rows = parquet::file::reader::FileReader::get_row_iter(&reader, None).expect("rows");
    rows.map(|row| {
        let row = row.expect("a row");
        let double = |k| parquet::record::RowAccessor::get_double(&row, k);
        (0..6).map(|k| double(k).expect("a number")).collect()
    })
    .collect()
}

#[test]
fn rows_that_have_no_room_in_one_file_are_in_several() {
    let model = model(MANY);
    let study = &model.studies[1];
    let mut parts = Memory::default();
    run_in_parts(&model, study, (&Serial, &mut parts), &mut Silent).expect("a result");
    let whole = RowFiles::of(&model, study).expect("a sweep");
    assert_eq!(whole.count(), 1);
    let whole = rows_of(&whole, 0, &mut parts);
    // Seven parts of at most 16 designs.
    let files = RowFiles::with_numbers(&model, study, 1.0).expect("a sweep");
    assert_eq!(files.count(), 7);
    // Of 13 rows with 8 columns.
    let some = 3.5 * 16.0 * 13.0 * 8.0;
    let files = RowFiles::with_numbers(&model, study, some).expect("a sweep");
    assert!((2..7).contains(&files.count()), "{}", files.count());
    let apart = (0..files.count()).flat_map(|k| rows_of(&files, k, &mut parts));
    assert_eq!(apart.collect::<Vec<_>>(), whole);
}

#[test]
fn rows_are_those_of_the_study_itself() {
    let model = model("vary = { a = [15, 20] }\ncolumns = [\"swing\"]");
    let mut parts = Memory::default();
    let study = &model.studies[1];
    run_in_parts(&model, study, (&Serial, &mut parts), &mut Silent).expect("a result");
    let files = RowFiles::of(&model, study).expect("a sweep");
    let rows = rows_of(&files, 0, &mut parts);
    let own = run(&model, &model.studies[0], &mut Silent).expect("a result");
    assert_eq!(rows.len(), 2 * own.table.rows());
    for (k, row) in rows.iter().skip(own.table.rows()).enumerate() {
        assert_eq!(row[0], 2.0);
        for (name, value) in ["time", "motor", "angle"].iter().zip(&row[1..]) {
            assert_eq!(own.table.column(name).expect("a column").values[k], *value);
        }
        assert_eq!(row[4], own.table.closure[k]);
    }
}

#[test]
fn too_many_designs_are_refused_at_once() {
    let model = model(
        "vary = { a = { from = 15, to = 20, count = 100000 }, b = { from = 45, to = 50, count = 100000 } }",
    );
    let refused = run(&model, &model.studies[1], &mut Silent);
    let codes: Vec<&str> = refused
        .err()
        .into_iter()
        .flatten()
        .map(|d| d.code)
        .collect();
    assert_eq!(codes, ["too-large"]);
    assert!(
        check(&model)
            .diagnostics
            .iter()
            .any(|d| d.code == "too-large")
    );
}

#[test]
fn forces_and_simulations_are_swept_too() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\nm = \"1 kg\"\n[links]\nframe = { A = [0, 0] }\n\
        arm = { A-B = 100, mass = \"m\", inertia = 0, center = \"B\" }\n[drives]\nswing = { turns = \"arm\", from = -90, to = 90, speed = \"1 rad/s\" }\n\
        [studies.hold]\nkind = \"forces\"\nrows = 10\n[studies.fall]\nkind = \"simulate\"\nuntil = \"0.2 s\"\nrows = 11\nrelease = [\"swing\"]\nstart = { swing = 0 }\n\
        [studies.torques]\nkind = \"sweep\"\nover = \"hold\"\nvary = { m = [1, 2] }\ncolumns = [\"max(torque(swing))\"]\nplot = [\"torque(swing)\"]\n\
        [studies.falls]\nkind = \"sweep\"\nover = \"fall\"\nvary = { m = [1, 2] }\ncolumns = [\"min(angle(arm))\"]\nplot = [\"angle(arm)\"]\n";
    let checked = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = match checked {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", rendered(&found)),
    };
    let named = |name: &str| {
        let study = model
            .studies
            .iter()
            .find(|s| s.name == name)
            .expect("a study");
        let mut parts = Memory::default();
        let result = run_in_parts(&model, study, (&Serial, &mut parts), &mut Silent);
        result.unwrap_or_else(|found| panic!("{}", rendered(&found)))
    };
    let torques = named("torques");
    let found = column(&torques, "max(torque(swing))");
    assert!((found[1] / found[0] - 2.0).abs() < 1e-9, "{found:?}");
    let falls = named("falls");
    let found = column(&falls, "min(angle(arm))");
    assert!(
        found[0] < -5.0 && (found[1] - found[0]).abs() < 1e-6,
        "{found:?}"
    );
    assert!(falls.table.worst_closure().is_finite());
}

/// Studies that are not moved along a path alone, by their names; `a` and `play` are parameters.
const WHOLE: &str = "[studies.worn]\nkind = \"clearance\"\nmodel = \"continuous\"\nstep = 30\ncolumns = [\"angle\"]\nplot = [\"angle\"]\n\
    [studies.rattle]\nkind = \"clearance\"\nmodel = \"three-state\"\nuntil = \"4 ms\"\nstep = \"1 ms\"\ncolumns = [\"angle\"]\n\
    [studies.round]\nkind = \"motion\"\ncircuit = true\nstep = 30\ncolumns = [\"angle\"]\n\
    [studies.set]\nkind = \"adjust\"\nunknown = [\"b\"]\nmatch = [{ motor = \"30 deg\", angle = \"103 deg\" }]\n";

#[test]
fn any_study_is_swept_as_it_runs_alone() {
    let text = |a: f64, play: f64, sweep: &str| {
        let text = FOUR_BAR.replace(
            "a = \"20 mm\"",
            &format!("a = \"{a} mm\"\nplay = \"{play} um\""),
        );
        let heavy = "mass = \"0.5 kg\", inertia = \"100 kg mm^2\" }";
        let text = text.replace("P = [25, 10] }", &format!("P = [25, 10], {heavy}"));
        let text = text.replace("D-C = 40 }", &format!("D-C = 40, {heavy}"));
        format!(
            "{text}{WHOLE}[friction]\nB = {{ coefficient = 0.1, radius = \"3 mm\" }}\n[clearance]\nC = {{ radial = \"play\", radius = \"5 mm\", restitution = 0.5 }}\n{sweep}"
        )
    };
    let read = |text: &str| {
        let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
        read.unwrap_or_else(|found| panic!("{}", rendered(&found)))
            .model
    };
    let mut warned = 0;
    for (k, over) in ["worn", "rattle", "round", "set"].into_iter().enumerate() {
        let sweep = format!(
            "[studies.some]\nkind = \"sweep\"\nover = \"{over}\"\nvary = {{ a = [19, 21], play = [\"20 um\", \"60 um\"] }}\n"
        );
        let model = read(&text(20.0, 50.0, &sweep));
        let mut parts = Memory::default();
        let study = model.studies.last().expect("the sweep");
        let swept = run_in_parts(&model, study, (&Threads(2), &mut parts), &mut Silent)
            .unwrap_or_else(|found| panic!("{over}: {}", rendered(&found)));
        for (row, (a, play)) in [(19.0, 20.0), (19.0, 60.0), (21.0, 20.0), (21.0, 60.0)]
            .into_iter()
            .enumerate()
        {
            let alone = read(&text(a, play, ""));
            let alone = run(&alone, &alone.studies[1 + k], &mut Silent);
            let alone = alone.unwrap_or_else(|found| panic!("{over}: {}", rendered(&found)));
            assert!(!alone.scalars.is_empty(), "{over} tells no number");
            for scalar in &alone.scalars {
                let found = column(&swept, &scalar.name)[row];
                let both_nothing = found.is_nan() && scalar.value.is_nan();
                assert!(
                    both_nothing
                        || (found - scalar.value).abs() <= 1e-9 * scalar.value.abs().max(1e-9),
                    "{over} {}: {found} for {}",
                    scalar.name,
                    scalar.value
                );
            }
        }
        let own = read(&text(20.0, 50.0, ""));
        let own = run(&own, &own.studies[1 + k], &mut Silent).unwrap();
        for told in &own.diagnostics {
            let mut all = swept.diagnostics.iter();
            assert!(all.any(|d| d.message == told.message), "{over}: {told:?}");
        }
        warned += own.diagnostics.len();
        // From its parts the same again.
        let again = run_in_parts(&model, study, (&Serial, &mut parts), &mut Silent);
        assert_eq!(swept.table, again.expect("a sweep").table, "{over}");
        // No measure can be asked of it besides.
        let asked = sweep.replace("vary", "columns = [\"swing\"]\nvary");
        let refused = Model::from_toml(&text(20.0, 50.0, &asked), "test", &mut |_| {
            Err(String::new())
        });
        let refused = refused.expect_err("refused");
        assert!(refused.iter().any(|d| d.code == "bad-choice"), "{over}");
    }
    assert!(warned > 0);
}

/// What tells no numbers is swept by what its rows come to.
#[test]
fn a_circuit_without_numbers_is_swept_by_its_rows() {
    let text = |a: &str, sweep: &str| {
        let text = FOUR_BAR.replace("a = \"20 mm\"", &format!("a = \"{a} mm\""));
        let (text, _) = text.split_once("[measures]").unwrap_or((&text, ""));
        format!("{text}\n[studies.round]\nkind = \"motion\"\ncircuit = true\nstep = 30\n{sweep}")
    };
    let read = |text: &str| {
        let read = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
        read.unwrap_or_else(|found| panic!("{}", rendered(&found)))
            .model
    };
    let last = |text: &str| {
        let model = read(text);
        let study = model.studies.last().expect("a study");
        run(&model, study, &mut Silent).unwrap_or_else(|found| panic!("{}", rendered(&found)))
    };
    let sweep = "[studies.some]\nkind = \"sweep\"\nover = \"round\"\nvary = { a = [19, 21] }\n";
    let swept = last(&text("20", sweep));
    for (row, a) in ["19", "21"].into_iter().enumerate() {
        let alone = column(&last(&text(a, "")), "x(C)");
        let least = alone.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = alone.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(column(&swept, "x(C), least in its rows")[row], least);
        assert_eq!(column(&swept, "x(C), greatest in its rows")[row], greatest);
    }
}

#[test]
fn a_sweep_of_which_no_design_moves_is_no_success() {
    let none = ran("vary = { a = [\"200 mm\", \"210 mm\"] }\ncolumns = [\"swing\"]");
    let told = none.diagnostics.iter().find(|d| d.code == "no-answer");
    assert!(
        told.unwrap().message.contains("none of its 2 designs"),
        "{told:?}"
    );
    let some = ran("vary = { a = [\"20 mm\", \"210 mm\"] }\ncolumns = [\"swing\"]");
    assert!(some.diagnostics.iter().all(|d| d.code != "no-answer"));
}

/// What the study that is run warns of is told of every design of which it does, whatever is asked for.
#[test]
fn designs_are_warned_of_what_their_study_warns_of() {
    let text = "[parameters]\nw = \"20 kN\"\n[links]\nframe = { A = [0, 0], F = [0.5, -0.4] }\n\
        boom = { A-T = 2, B = [0.8, 0] }\n[drives]\nlift = { cylinder = \"F-B\", from = 0.45, to = 0.95, speed = \"20 mm/s\" }\n\
        [assembly]\nT = { near = [2, 0] }\n[loads]\nhook = { force = [0, \"-w\"], at = \"T\" }\n\
        [cylinders]\nlift = { bore = \"80 mm\", rod = \"50 mm\", supply = \"160 bar\", count = 1 }\n\
        [studies.lifting]\nkind = \"forces\"\nrows = 21\ncolumns = [\"pressure(lift)\"]\n\
        [studies.some]\nkind = \"sweep\"\nover = \"lifting\"\nvary = { w = [\"5 kN\", \"30 kN\", \"40 kN\"] }\n";
    let model = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = model
        .unwrap_or_else(|found| panic!("{}", rendered(&found)))
        .model;
    let result = run(&model, &model.studies[1], &mut Silent).expect("a result");
    for (row, note) in result.table.notes.iter().enumerate() {
        let told = note.as_deref().unwrap_or_default();
        assert_eq!(
            told.contains("warned of `cylinder-too-weak`"),
            row > 0,
            "{row}: {told}"
        );
    }
    let warned = result
        .diagnostics
        .iter()
        .find(|d| d.code == "designs-warned");
    let warned = warned.expect("a warning");
    assert!(
        warned
            .message
            .contains("2 designs are warned of `cylinder-too-weak`, first number 2"),
        "{}",
        warned.message
    );
    // Kept parts tell it too.
    let mut kept = Memory::default();
    let study = &model.studies[1];
    for _ in 0..2 {
        let again =
            run_in_parts(&model, study, (&Serial, &mut kept), &mut Silent).expect("a result");
        assert!(again.diagnostics.contains(warned));
    }
}

/// What a study finds under the name of a parameter that varies stands beside it.
#[test]
fn what_is_found_is_told_apart_from_what_varies() {
    let text = format!(
        "{FOUR_BAR}[studies.some]\nkind = \"sweep\"\nover = \"adjusted\"\nvary = {{ a = [19, 21] }}\n\
         [studies.adjusted]\nkind = \"adjust\"\nunknown = [\"a\"]\nmatch = [{{ motor = 90, rocker = 110 }}]\n"
    );
    let model = Model::from_toml(&text, "test", &mut |_| Err("no files".into()));
    let model = model
        .unwrap_or_else(|found| panic!("{}", rendered(&found)))
        .model;
    let study = model.studies.iter().find(|s| s.name == "some").expect("it");
    let result = run(&model, study, &mut Silent).expect("a result");
    let of = |name: &str| {
        let found = result.table.columns.iter().find(|c| c.name == name);
        found
            .map(|c| c.values.clone())
            .unwrap_or_else(|| panic!("{name}"))
    };
    assert_eq!(of("a"), [19.0, 21.0]);
    let found = of("a of adjusted");
    assert!(
        (found[0] - found[1]).abs() < 1e-6 && (found[0] - 19.0).abs() > 0.1,
        "{found:?}"
    );
}

/// A synthesis needs no mechanism, alone or for many designs; those of which it accepts nothing are no designs without values.
#[test]
fn a_synthesis_without_a_mechanism_can_be_swept() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\no2 = \"82 deg\"\n\
        [studies.generator]\nkind = \"synthesize\"\ntask = \"function\"\npairs = [[45, 52], [90, \"o2\"], [135, 112]]\nground = \"50 mm\"\n\
        [studies.some]\nkind = \"sweep\"\nover = \"generator\"\nvary = { o2 = [\"80 deg\", \"82 deg\", \"85 deg\", \"52 deg\"] }\n";
    let model = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = model
        .unwrap_or_else(|found| panic!("{}", rendered(&found)))
        .model;
    let study = model.studies.iter().find(|s| s.name == "some").expect("it");
    let result = run(&model, study, &mut Silent).expect("a result");
    assert_eq!((result.table.rows(), result.table.unreached()), (4, 0));
    assert!(
        result.table.notes[3]
            .as_deref()
            .is_some_and(|n| n.contains("none-accepted"))
    );
}

/// A place that hangs on a parameter goes with it, from design to design and in exact derivatives.
#[test]
fn places_that_hang_on_parameters_go_with_them() {
    let text = |place: &str, more: &str| {
        let text = FOUR_BAR.replace("idle =", "ph = \"120 deg\"\nidle =");
        format!(
            "{text}[studies.some]\nkind = \"sweep\"\nover = \"turn\"\nvary = {{ ph = [119.9, 120, 120.1] }}\n\
             columns = [\"at(y(P), motor, {place})\", \"at(y(P), time, {more})\"]\n"
        )
    };
    let run_of = |text: &str| {
        let model = Model::from_toml(text, "test", &mut |_| Err("no files".into()));
        let model = model
            .unwrap_or_else(|found| panic!("{}", rendered(&found)))
            .model;
        run(&model, &model.studies[1], &mut Silent).expect("a result")
    };
    let moving = run_of(&text("2 * ph - 60 deg", "ph / (1 rad) * 1 s"));
    for (row, ph) in [119.9, 120.0, 120.1_f64].into_iter().enumerate() {
        let held = run_of(&text(
            &format!("{} deg", 2.0 * ph - 60.0),
            &format!("{} s", ph.to_radians()),
        ));
        for column in 2..4 {
            let [own, wanted] = [&moving, &held].map(|it| it.table.columns[column].values[row]);
            assert!((own - wanted).abs() < 1e-11, "{own} for {wanted}");
        }
    }
    let told = moving
        .listings
        .iter()
        .find(|l| l.title.contains("exact derivatives"));
    for row in &told.expect("derivatives").rows {
        let numbers: Vec<f64> = row[2..5]
            .iter()
            .map(|x| x.parse().expect("a number"))
            .collect();
        let middle = 0.5 * (numbers[1] + numbers[2]);
        assert!((numbers[0] - middle).abs() < 1e-5 * middle.abs(), "{row:?}");
        assert!(middle.abs() > 1e-3, "{row:?}");
    }
    assert!(
        !moving
            .diagnostics
            .iter()
            .any(|d| d.code == "idle-parameter")
    );
}

/// Simulated designs whose links start on both sides of half a turn count their turns as the file's own does.
#[test]
fn simulated_angles_do_not_jump_from_design_to_design() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\ne = \"0 mm\"\n\
        [links]\nframe = { A = [0, 0], E = [0, \"e\"], F = [-200, \"e\"] }\ncrank = { A-B = 30, mass = \"1 kg\", inertia = \"0.001 kg m^2\" }\nrod = { B-C = 100 }\npiston = { C = [0, 0] }\n\
        [joints]\nbore = { slider = \"piston\", at = \"C\", on = \"E -> F\" }\n\
        [drives]\nmotor = { turns = \"crank\", at = 180 }\n[assembly]\nC = { near = [-130, 0] }\n\
        [studies.go]\nkind = \"simulate\"\nuntil = \"50 ms\"\nrows = 3\ncolumns = [\"angle(rod)\"]\n\
        [studies.family]\nkind = \"sweep\"\nover = \"go\"\nvary = { e = { from = \"-0.2 mm\", to = \"0.2 mm\", count = 5 } }\ncolumns = [\"max(angle(rod))\"]\n\
        [studies.pieces]\nkind = \"tolerance\"\nover = \"go\"\nvary = { e = \"0.2 mm\" }\nsamples = 20\ncolumns = [\"max(angle(rod))\"]\n";
    let model = read(text);
    let ran = |study: usize| result_of(&model, &model.studies[study]);
    let pieces = ran(2);
    let deviation = pieces
        .scalars
        .iter()
        .find(|s| s.name == "max(angle(rod)), deviation");
    assert!(deviation.expect("a deviation").value < 1.0, "{deviation:?}");
    let result = ran(1);
    let column = result.table.column("max(angle(rod))");
    let values = &column.expect("a column").values;
    let of = |to: fn(f64, f64) -> f64| values.iter().copied().reduce(to).expect("values");
    assert!(of(f64::max) - of(f64::min) < 2.0, "{values:?}");
}

/// A design whose simulation breaks off has no values, wherever it is asked; one whose oil boils says so.
#[test]
fn simulations_that_break_off_are_no_designs() {
    let text = "units = { length = \"mm\" }\ngravity = 0\n[parameters]\npush = \"4 N\"\n\
        [links]\nframe = { O = [0, 0], X = [1000, 0] }\nblock = { A = [0, 0], mass = \"5 kg\", inertia = 0 }\n\
        [joints]\nguide = { slider = \"block\", at = \"A\", on = \"O -> X\" }\n\
        [drives]\nx = { slides = \"block\", at = 0 }\n\
        [loads]\np = { force = [\"push\", 0], at = \"A\", on = \"block\" }\n\
        drag = { force = [\"-1 N * sqrt(1 - x / 500 mm)\", 0], at = \"A\", on = \"block\" }\n\
        [studies.go]\nkind = \"simulate\"\nuntil = \"1 s\"\nstep = \"10 ms\"\n\
        [studies.sw]\nkind = \"sweep\"\nover = \"go\"\nvary = { push = [\"2 N\", \"20 N\"] }\ncolumns = [\"max(time)\"]\n\
        [studies.tol]\nkind = \"tolerance\"\nover = \"go\"\nvary = { push = \"4 N\" }\nsamples = 40\ncolumns = [\"max(time)\"]\n\
        [studies.opt]\nkind = \"optimize\"\nover = \"go\"\nvary = { push = [\"1 N\", \"20 N\"] }\nminimize = \"max(time)\"\n";
    let model = read(text);
    let ran = |study: usize| result_of(&model, &model.studies[study]);
    let swept = ran(1);
    let times = &swept.table.column("max(time)").expect("a column").values;
    assert!(times[0] == 1.0 && times[1].is_nan(), "{times:?}");
    let note = swept.table.notes[1].as_deref().unwrap_or_default();
    assert!(
        note.contains("goes no farther than 0.51") && note.contains("`drag`"),
        "{note}"
    );
    // Pieces of 6.3 N or more come to where the drag has no value.
    let pieces = ran(2);
    let moving = pieces
        .scalars
        .iter()
        .find(|s| s.name == "pieces that do not move");
    let names: Vec<&str> = pieces.scalars.iter().map(|s| s.name.as_str()).collect();
    assert!(moving.is_some_and(|it| it.value > 0.0), "{names:?}");
    let best = ran(3);
    let found = best
        .table
        .column("max(time)")
        .expect("a column")
        .values
        .clone();
    assert_eq!(
        found
            .iter()
            .copied()
            .filter(|x| !x.is_nan())
            .fold(f64::INFINITY, f64::min),
        1.0
    );
}

/// What a file could not say alone is no design of a sweep.
#[test]
fn values_that_no_file_may_have_are_no_designs() {
    let text = "units = { length = \"m\" }\n[parameters]\ne = 0.5\nv = \"1 m/s\"\nlow = \"1 N/m\"\n\
        [links]\nframe = { O = [0, 0], U = [0, 1] }\nball = { B = [0, 0], mass = \"1 kg\", inertia = \"1 kg m^2\" }\n\
        [joints]\nrail = { slider = \"ball\", at = \"B\", on = \"O -> U\" }\n\
        [drives]\nfall = { slides = \"rail\", from = 1, to = 2, speed = \"v\" }\n\
        [springs]\nheld = { between = \"O-B\", stiffness = \"2 N/m\", free = \"1 m\" }\n\
        [studies.go]\nkind = \"simulate\"\nuntil = \"1 s\"\nrows = 3\nstops = { fall = { between = [0, \"none\"], restitution = \"e\" } }\n\
        [studies.sw]\nkind = \"sweep\"\nover = \"go\"\nvary = { e = [0.5, 1.2] }\ncolumns = [\"max(time)\"]\n\
        [studies.m]\nkind = \"motion\"\nrows = 3\n\
        [studies.speed]\nkind = \"sweep\"\nover = \"m\"\nvary = { v = [\"1 m/s\", \"-1 m/s\", \"0 m/s\"] }\ncolumns = [\"max(time)\"]\n\
        [studies.sp]\nkind = \"spring\"\nspring = \"held\"\ndrive = \"fall\"\nwanted = \"0 N\"\nstiffness = [\"low\", \"5 N/m\"]\n\
        [studies.stiff]\nkind = \"sweep\"\nover = \"sp\"\nvary = { low = [\"1 N/m\", \"6 N/m\"] }\n";
    let model = read(text);
    for (study, wanted) in [
        ("sw", vec![None, Some("restitution")]),
        (
            "speed",
            vec![
                None,
                Some("its speed must be positive"),
                Some("its speed must be positive"),
            ],
        ),
        ("stiff", vec![None, Some("bounds of the stiffness")]),
    ] {
        let study = model
            .studies
            .iter()
            .find(|it| it.name == study)
            .expect("a study");
        let result = result_of(&model, study);
        for (note, wanted) in result.table.notes.iter().zip(wanted) {
            let found = note.as_deref().unwrap_or_default();
            assert!(
                wanted.map_or(found.is_empty(), |it| found.contains(it)),
                "{found}"
            );
        }
    }
}

/// A lever that reaches out by its length, of which an optimum is asked, and what pieces of it are.
const OVER_DESIGNS: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
l = "60 mm"
most = "25 deg"
[links]
frame = { A = [0, 0] }
lever = { A-B = "l" }
[drives]
m = { turns = "lever", from = 0, to = 30, speed = 10 }
[studies.turn]
kind = "motion"
rows = 3
[studies.best]
kind = "optimize"
over = "turn"
vary = { l = ["50 mm", "100 mm"] }
minimize = "max(y(B))"
subject_to = ["at(x(B), m, most) >= 60 mm"]
columns = ["min(x(B))"]
[studies.pieces]
kind = "tolerance"
over = "turn"
vary = { l = "0.1 mm" }
columns = ["max(x(B))"]
samples = 64
[studies.optima]
kind = "sweep"
over = "best"
vary = { most = ["0 deg", "20 deg", "25 deg", "60 deg"] }
[studies.tolerances]
kind = "sweep"
over = "pieces"
vary = { l = ["55 mm", "65 mm"] }
"#;

/// What an optimum is for several demands, and what tolerances do to several designs: each as it is alone, however the parts were computed.
#[test]
fn optima_and_tolerances_are_swept_as_they_are_alone() {
    let read = |text: &str| Model::from_toml(text, "test", &mut |_| Err("no files".into()));
    let model = read(OVER_DESIGNS).unwrap().model;
    let values = |result: &StudyResult, name: &str| {
        let mut columns = result.table.columns.iter();
        let found = columns.find(|c| c.name == name);
        found.unwrap_or_else(|| panic!("{name}")).values.clone()
    };
    let optima = run(&model, &model.studies[3], &mut Silent).unwrap();
    let lengths = values(&optima, "l");
    for (k, most) in [0.0_f64, 20.0, 25.0].into_iter().enumerate() {
        let cos = kempe_number::math::cos(most.to_radians());
        assert!((lengths[k] - 60.0 / cos).abs() < 1e-6, "{lengths:?}");
        let side = values(&optima, "at(x(B), m, most)")[k];
        assert!((side - 60.0).abs() < 1e-6, "{side}");
        let reach = lengths[k] * 0.75_f64.sqrt();
        assert!((values(&optima, "min(x(B))")[k] - reach).abs() < 1e-6);
    }
    assert!(
        !optima
            .table
            .columns
            .iter()
            .any(|c| c.name.contains("tried"))
    );
    // The last demand is not on the motion: that design says why, as alone.
    let note = optima.table.notes[3].as_deref().unwrap();
    assert!(lengths[3].is_nan(), "{note}");
    let alone = OVER_DESIGNS.replace("most = \"25 deg\"", "most = \"60 deg\"");
    let alone = read(&alone).unwrap().model;
    let alone = run(&alone, &alone.studies[1], &mut Silent).unwrap_err();
    assert!(note.contains(&alone[0].message), "{note}");
    let pieces = run(&model, &model.studies[4], &mut Silent).unwrap();
    let most = values(&pieces, "max(x(B)), worst case greatest");
    assert!((most[0] - 55.1).abs() < 1e-9 && (most[1] - 65.1).abs() < 1e-9);
    for which in [3, 4] {
        let study = &model.studies[which];
        let own = run_in_parts(
            &model,
            study,
            (&Serial, &mut Memory::default()),
            &mut Silent,
        );
        let own = own.unwrap();
        assert_eq!(part_count(&model, study), Ok(Some(own.table.rows())));
        let mut kept = Memory::default();
        for own in [1, 0] {
            kept.1 = Some((own, 2));
            let done = compute_parts(&model, study, (&Threads(2), &mut kept), &mut Silent);
            assert!(done.is_ok_and(|(all, _)| all));
        }
        let again = run_in_parts(&model, study, (&Threads(2), &mut kept), &mut Silent).unwrap();
        // Designs without values are not equal to themselves.
        assert_eq!(format!("{:?}", again.table), format!("{:?}", own.table));
        assert!(RowFiles::of(&model, study).is_none());
    }
    // A sweep of sweeps is refused.
    let twice = format!(
        "{OVER_DESIGNS}[studies.twice]\nkind = \"sweep\"\nover = \"optima\"\nvary = {{ l = [1, 2] }}\n"
    );
    let told = read(&twice);
    assert!(told.unwrap_err().iter().any(|d| d.code == "bad-choice"));
}
