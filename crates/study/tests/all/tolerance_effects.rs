//! What deviations come from where there is no linear answer: main effects of the pieces against closed forms.

use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

use crate::support::examples;

/// A slider-crank, with two lengths that nothing is made of.
fn found(study: &str) -> StudyResult {
    let text = format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[parameters]\na = \"30 mm\"\nt = \"0 mm\"\ns = \"0 mm\"\n\
         [links]\nframe = {{ A = [0, 0], E = [0, 0], F = [100, 0] }}\ncrank = {{ A-B = \"a\" }}\nrod = {{ B-C = 100 }}\nblock = {{ C = [0, 0] }}\n\
         [joints]\nguide = {{ slider = \"block\", at = \"C\", on = \"E -> F\" }}\n\
         [drives]\nmotor = {{ turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }}\n[assembly]\nC = {{ near = [130, 0] }}\n\
         [studies.turn]\nkind = \"motion\"\nstep = 5\n[studies.pieces]\nkind = \"tolerance\"\nover = \"turn\"\n{study}\n"
    );
    let read = Model::from_toml(&text, "test", &mut |_| Err("no files".into()));
    let model = read.expect("a model").model;
    run(&model, &model.studies[1], &mut Silent).expect("a result")
}

/// What is told of contributions to a number: names and parts.
fn parts(result: &StudyResult, number: &str) -> Vec<(String, f64)> {
    let title = format!("contributions to {number}, by the pieces");
    let mut all = result.listings.iter();
    let listing = all.find(|l| l.title == title).expect("contributions");
    let part = |row: &Vec<String>| {
        let text = row.last().expect("a part");
        let text = text.trim_start_matches("below ").trim_end_matches(" %");
        (row[0].clone(), text.parse().expect("a number"))
    };
    listing.rows.iter().map(part).collect()
}

fn near(found: f64, wanted: f64, by: f64) {
    assert!((found - wanted).abs() <= by, "{found} instead of {wanted}");
}

/// Even in the crank over 1 mm, and in the size of a length from 0 to 2 mm: variances of 1/12 and of 4/12.
#[test]
fn what_adds_up_has_its_parts() {
    let number = "max(y(B)) + abs(t)";
    let result = found(&format!(
        "vary = {{ a = \"0.5 mm\", t = \"2 mm\", s = \"1 mm\" }}\nsamples = 20000\ncolumns = [\"{number}\"]"
    ));
    let told = parts(&result, number);
    assert_eq!(told[0].0, "t");
    near(told[0].1, 80.0, 0.5);
    assert_eq!(told[1].0, "a");
    near(told[1].1, 20.0, 0.5);
    // What does nothing is told as that, and nothing is left for several together.
    assert_eq!(told[2].0, "s");
    assert!(told[2].1 < 0.5);
    assert_eq!(told.len(), 3);
}

/// The product of two sizes, both even from 0 to 1: of a variance of 7/144 each makes 3/144 by itself, and both together 1/144.
#[test]
fn what_acts_together_is_told() {
    let number = "max(y(B)) / (30 mm) * abs(t) * abs(s) / (1 mm)";
    let result = found(&format!(
        "vary = {{ t = \"1 mm\", s = \"1 mm\" }}\nsamples = 40000\ncolumns = [\"{number}\"]"
    ));
    let told = parts(&result, number);
    near(told[0].1, 300.0 / 7.0, 0.5);
    near(told[1].1, 300.0 / 7.0, 0.5);
    assert_eq!(told[2].0, "several of them together");
    near(told[2].1, 100.0 / 7.0, 1.0);
}

/// Few pieces say nothing of it, and a number with derivatives has its linear answer.
#[test]
fn it_is_told_where_there_is_nothing_better() {
    let number = "max(y(B)) + abs(t)";
    let study = |samples: usize| {
        format!(
            "vary = {{ a = \"0.5 mm\", t = \"2 mm\" }}\nsamples = {samples}\ncolumns = [\"{number}\", \"max(y(B))\"]"
        )
    };
    let has = |result: &StudyResult, title: &str| result.listings.iter().any(|l| l.title == title);
    let by_pieces = format!("contributions to {number}, by the pieces");
    assert!(!has(&found(&study(64)), &by_pieces));
    let many = found(&study(2000));
    assert!(has(&many, &by_pieces));
    assert!(has(&many, "contributions to max(y(B))"));
}

/// The walking leg, optimal on a ridge: against 200,000 pieces at random of the four-bar's closed form, sorted by one length and averaged in 200 classes, 39.5, 6.6,
/// 2.6 and 1.1 %.
#[test]
fn an_optimum_on_a_ridge_has_its_main_effects() {
    let all = examples();
    let (_, model) = all
        .iter()
        .find(|(name, _)| name == "hoeken-leg")
        .expect("it");
    let study = model.studies.iter().find(|s| s.name == "made");
    let result = run(model, study.expect("it"), &mut Silent).expect("a result");
    let told = parts(&result, "bob");
    let wanted = [
        ("d_rocker", 39.5),
        ("d_frame", 6.56),
        ("d_coupler", 2.59),
        ("d_throw", 1.08),
    ];
    for ((name, part), (own, wanted)) in told.iter().zip(wanted) {
        assert_eq!(name, own);
        near(*part, wanted, 0.6);
    }
    assert_eq!(told[4].0, "several of them together");
}

/// A slider with play stands to either side of its line: nothing else differs, and all comes from that; nor does a length that is normal leave anything.
#[test]
fn sides_and_normal_lengths_are_explained_whole() {
    let number = "max(angle(rod)) + max(abs(angle(rod)))";
    let result = found(&format!(
        "clearance = true\nsamples = 200\ncolumns = [\"{number}\"]\n[clearance]\nguide = {{ radial = \"1 mm\" }}"
    ));
    let told = parts(&result, number);
    assert_eq!(told.len(), 1, "{told:?}");
    near(told[0].1, 100.0, 0.1);
    let number = "max(y(B)) + abs(t) / 1000";
    let result = found(&format!(
        "vary = {{ a = {{ normal = \"0.1 mm\" }}, t = \"1 mm\" }}\nsamples = 4000\ncolumns = [\"{number}\"]"
    ));
    let told = parts(&result, number);
    near(told[0].1, 100.0, 1.0);
}

/// Of half of the pieces the number has no value: the others are even in what is left, the root of which has the variance 1/18 beside the 1/12 of the crank.
#[test]
fn pieces_without_a_value_leave_the_parts_of_the_others() {
    let number = "sqrt(t * (1 mm))";
    let vary = "vary = { a = \"0.5 mm\", t = \"1 mm\" }\nsamples = 20000\n";
    let result = found(&format!("{vary}columns = [\"{number}\"]"));
    let told = parts(&result, number);
    assert_eq!(told[0].0, "t");
    near(told[0].1, 100.0, 0.5);
    let number = "max(y(B)) + sqrt(t * (1 mm))";
    let result = found(&format!("{vary}columns = [\"{number}\"]"));
    let told = parts(&result, number);
    assert_eq!([&told[0].0, &told[1].0], ["a", "t"]);
    near(told[0].1, 60.0, 0.5);
    near(told[1].1, 40.0, 0.5);
}
