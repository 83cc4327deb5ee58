//! Fronts for which few designs may be tried.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::scalar;
use kempe_study::{Silent, StudyResult, run};

/// A level-luffing crane: its jib's path is to be level and to reach far.
const CRANE: &str = r#"
units = { length = "m", angle = "deg" }
[parameters]
lj = "20 m"
lr = "16 m"
lk = "7 m"
lp = "12 m"
[links]
frame = { A = [0, 0], D = [-5, 6] }
jib = { A-B = "lj" }
fly = { B-C = "lk", P = ["-lp", 0] }
back = { D-C = "lr" }
[drives]
luff = { turns = "jib", from = 40, to = 75, speed = "1 deg/s" }
[assembly]
C = "left of D -> B"
[studies.luff]
kind = "motion"
[studies.best]
kind = "optimize"
vary = { lj = ["16 m", "24 m"], lr = ["10 m", "22 m"], lk = ["3 m", "10 m"], lp = ["6 m", "16 m"] }
minimize = "max(abs(d(y(P), luff)))*1 rad"
maximize = "range(x(P))"
subject_to = "range(y(P)) <= 1 m"
"#;

fn front(study: &str) -> StudyResult {
    let model = read(&format!("{CRANE}{study}"));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

fn is_whole(result: &StudyResult) -> bool {
    let told = result.diagnostics.iter().map(|d| &d.message);
    !told.clone().any(|message| message.contains("is not whole"))
}

/// Designs are left for what lies between its ends: of two of three seeds nearly all of the front was missing, untold.
#[test]
fn a_front_of_few_designs_is_spread() {
    for seed in 1..=3 {
        let result = front(&format!("designs = 1500\nseed = {seed}\n"));
        let [points, tried, volume] =
            ["points", "designs tried", "hypervolume"].map(|name| scalar(&result, name));
        assert!(
            points >= 30.0 && tried <= 1500.0,
            "{seed}: {points} {tried}"
        );
        // By sixty thousand designs it is 0.884.
        assert!(volume > 0.87, "{seed}: {volume}");
        assert!(is_whole(&result), "{seed}");
    }
}

/// What designs do not do for is told.
#[test]
fn a_front_that_is_not_whole_says_so() {
    let result = front("designs = 200\n");
    assert!(scalar(&result, "designs tried") <= 200.0);
    assert!(!is_whole(&result), "{:?}", result.diagnostics);
}
