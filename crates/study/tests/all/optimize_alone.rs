//! Designs exactly at a change point, which do what none beside them does: a four-bar that folds over swings twice as far.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::{column, scalar};
use kempe_number::math;
use kempe_study::{Silent, StudyResult, run};

/// With A = 30, B = 50 and C = 40 all its pins meet in one line.
const ROCKER: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "OWN"
b = "50 mm"
c = "40 mm"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b", P = ["b / 2", "20 mm"] }
rocker  = { D-C = "c" }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
[measures]
play = "range(angle(rocker))"
jerky = "max(abs(angular_acceleration(rocker)))"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
over = "turn"
"#;
const BOX: &str =
    "vary = { a = ['15 mm', '30 mm'], b = ['50 mm', '60 mm'], c = ['40 mm', '50 mm'] }\n";

fn best(own: &str, study: &str) -> StudyResult {
    let model = read(&format!("{}{study}", ROCKER.replace("OWN", own)));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

/// The swing of a crank-rocker, deg, by its dead points.
fn swing([a, b, c]: [f64; 3]) -> f64 {
    let d = 60.0;
    let at = |reach: f64| math::acos((d * d + c * c - reach * reach) / (2.0 * d * c)).to_degrees();
    at(b + a) - at(b - a)
}

fn notes(result: &StudyResult) -> Vec<String> {
    let all = result.table.notes.iter();
    all.map(|note| note.clone().unwrap_or_default()).collect()
}

#[test]
fn an_optimum_is_none_of_them() {
    let most = swing([30.0, 50.0, 40.0]);
    let regular = ("20 mm", "multi-start");
    for (own, method) in [regular, ("30 mm", "multi-start"), ("30 mm", "local")] {
        let result = best(
            own,
            &format!("{BOX}maximize = 'play'\nmethod = '{method}'\n"),
        );
        let [play, a, b, c] = ["play", "a", "b", "c"].map(|name| scalar(&result, name));
        // As far as it can be beside the place itself.
        assert!(play < most && play > most - 0.01, "{own} {method}: {play}");
        assert!(a + 60.0 < b + c);
        assert!((play - swing([a, b, c])).abs() < 1e-3, "{own} {method}");
        let (notes, told) = (notes(&result), format!("{:?}", result.listings));
        assert!(!notes[1].contains("change point"), "{notes:?}");
        // The file's own may be one, and says so.
        let is_one = own == "30 mm";
        let said = [
            notes[0].contains("through a change point"),
            told.contains("beside the file's own design"),
        ];
        assert_eq!(said, [is_one; 2], "{notes:?} {told}");
    }
}

/// In a corner of the bounds few directions lead to where cranks turn.
#[test]
fn an_optimum_in_a_corner_is_none_of_them() {
    let result = best(
        "30 mm",
        "vary = { a = ['25 mm', '35 mm'], b = ['45 mm', '55 mm'] }\nmaximize = 'play'\nmethod = 'cma-es'\n",
    );
    let [play, most] = [scalar(&result, "play"), swing([35.0, 55.0, 40.0])];
    assert!(play < most + 1e-3 && play > most - 0.1, "{play} {most}");
}

#[test]
fn a_front_has_none_of_them() {
    {
        let result = best("30 mm", &format!("{BOX}maximize = ['play', '-jerky']\n"));
        let [play, a, b, c] = ["play", "a", "b", "c"].map(|name| column(&result, name));
        assert!(play.len() > 30, "{}", play.len());
        for (k, play) in play.iter().enumerate() {
            let own = swing([a[k], b[k], c[k]]);
            assert!((play - own).abs() < 1e-3, "{k}: {play} {own}");
        }
        assert!(
            notes(&result)
                .iter()
                .all(|note| !note.contains("change point"))
        );
        // Beside them it goes on to where accelerations have no bound.
        let codes: Vec<&str> = result.diagnostics.iter().map(|d| d.code).collect();
        assert_eq!(codes, ["front-cut"]);
        let most = play.iter().copied().fold(0.0, f64::max);
        assert!(most > 104.3, "{most}");
    }
}

/// The file's own design keeps a limit that none beside it comes near: it is not said that no design does.
#[test]
fn the_own_design_that_alone_keeps_a_limit_is_told() {
    let box_without_own = BOX.replace("'30 mm'", "'25 mm'");
    for (bounds, why) in [
        (BOX, "goes on as no design beside it does"),
        (&box_without_own, "lies outside of the bounds"),
    ] {
        let study = "minimize = 'max(x(B))'\nsubject_to = 'play >= 150 deg'\nmethod = 'local'\ndesigns = 60\n";
        let result = best("30 mm", &format!("{bounds}{study}"));
        let told = result.diagnostics.iter().find(|d| d.code == "infeasible");
        let told = told.unwrap();
        assert!(
            told.message.starts_with("no design but the file's own was"),
            "{}",
            told.message
        );
        assert!(told.notes[0].contains(why), "{:?}", told.notes);
    }
    let study =
        "minimize = 'max(x(B))'\nsubject_to = 'play >= 250 deg'\nmethod = 'local'\ndesigns = 60\n";
    let result = best("30 mm", &format!("{BOX}{study}"));
    let told = result.diagnostics.iter().find(|d| d.code == "infeasible");
    assert!(told.unwrap().message.starts_with("no design was"));
}

/// Of parallelograms each meets a change point, and so does each beside it.
#[test]
fn families_of_change_points_are_optimised() {
    let text = ROCKER
        .replace("D-C = \"c\"", "D-C = \"a\"")
        .replace("b = \"50 mm\"", "b = \"60 mm\"")
        .replace("OWN", "20 mm");
    for (goals, points) in [
        ("'range(x(P))'", 1),
        ("['range(x(P))', '-max(abs(speed(P)))']", 30),
    ] {
        let study = format!("vary = {{ a = ['15 mm', '30 mm'] }}\nmaximize = {goals}\n");
        let model = read(&format!("{text}{study}"));
        let result = run(&model, &model.studies[1], &mut Silent).unwrap();
        let a = column(&result, "a");
        assert!(a.len() >= points);
        assert!(
            (a.iter().copied().fold(0.0, f64::max) - 30.0).abs() < 1e-6,
            "{a:?}"
        );
        let notes = notes(&result);
        assert!(
            notes.iter().all(|note| note.contains("change point")),
            "{notes:?}"
        );
    }
    // Of values of a catalogue none lies beside another.
    let result = best(
        "20 mm",
        "vary = { a = { only = ['20 mm', '30 mm'] } }\nmaximize = 'play'\n",
    );
    assert!((scalar(&result, "a") - 30.0).abs() < 1e-9);
    assert!(notes(&result)[1].contains("through a change point"));
}
