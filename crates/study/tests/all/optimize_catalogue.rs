//! Optimisation over catalogues of which no value keeps all limits: by how much they are missed, and what is said of them.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::scalar;
use kempe_number::math::acos;
use kempe_study::{Silent, StudyResult, run};

/// A crank-rocker whose crank's pin goes as far to the right and up as the crank is long.
fn rocker(study: &str) -> StudyResult {
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
a = "20 mm"
b = "50 mm"
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = "a" }}
coupler = {{ B-C = "b", P = [25, 10] }}
rocker  = {{ D-C = 40 }}
[drives]
motor = {{ turns = "crank", from = 0, to = 360, speed = "60 rpm" }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
{study}
"#
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

/// The crank that was found, mm, and what is said of the limits.
fn crank(study: &str) -> (f64, Vec<String>) {
    let result = rocker(study);
    let told = (result.diagnostics.iter()).find(|d| d.code == "infeasible");
    let a = result.table.columns.iter().find(|c| c.name == "a").unwrap();
    (a.values[1], told.unwrap().notes.clone())
}

/// The crank must be longer than it may be. By the medians of what both sides miss the worst misses of 15, 19 and 22 mm are 1.8, 1 and 2, of 12 and 19.9 mm
/// 1 and 0.975; the sums of them would choose 15 and 12 mm.
#[test]
fn the_worst_miss_of_a_catalogue_is_the_least() {
    for (values, least) in [
        ("'15 mm', '19 mm', '22 mm'", 19.0),
        ("'12 mm', '19.9 mm'", 19.9),
    ] {
        let (a, _) = crank(&format!(
            "vary = {{ a = {{ only = [{values}] }} }}\nminimize = 'max(x(P))'\nsubject_to = ['max(x(B)) >= 24 mm', 'max(y(B)) <= 16 mm']"
        ));
        assert_eq!(a, least, "of {values}");
    }
}

/// Each of both limits is kept by a value, no value keeps both; one that none keeps stands by itself; one that all keep is not named.
#[test]
fn limits_that_no_value_keeps_together_contradict_each_other() {
    let study = "vary = { a = { only = ['15 mm', '19 mm', '22 mm'] } }\nminimize = 'max(x(P))'\nsubject_to = [LIMITS]";
    let both = "'max(x(B)) >= 21 mm', 'a >= 10 mm', 'max(y(B)) <= 16 mm'";
    let contradict = "there `max(x(B)) >= 21 mm` and `max(y(B)) <= 16 mm` contradict each other";
    let (a, notes) = crank(&study.replace("LIMITS", both));
    assert_eq!(a, 19.0);
    assert_eq!(
        notes,
        [
            "the least violation that was reached: `max(x(B)) >= 21 mm` is missed by 2 mm and `max(y(B)) <= 16 mm` is missed by 3 mm",
            contradict
        ]
    );
    let (_, notes) = crank(&study.replace("LIMITS", &format!("{both}, 'b >= 51 mm'")));
    assert_eq!(notes.len(), 3, "{notes:?}");
    assert!(
        notes[1..].contains(&"there `b >= 51 mm` cannot be kept, whatever the others".to_owned()),
        "{notes:?}"
    );
    let names = |note: &String| note.contains("max(x(B))") && note.contains("contradict");
    assert!(notes[1..].iter().any(names), "{notes:?}");
    let front = rocker(
        &study
            .replace(
                "minimize = 'max(x(P))'",
                "minimize = ['max(x(P))', 'max(y(P))']",
            )
            .replace("LIMITS", both),
    );
    let told = (front.diagnostics.iter()).find(|d| d.code == "infeasible");
    assert_eq!(told.unwrap().notes[1], contradict);
}

/// With the crank of 12 mm and a coupler of 45 mm the rocker swings by less than 50 degrees: only beside the crank that was taken it cannot.
#[test]
fn what_cannot_be_kept_is_said_of_the_value_that_was_taken() {
    let (a, notes) = crank(
        "vary = { a = { only = ['12 mm', '15 mm', '19 mm', '22 mm'] }, b = ['45 mm', '60 mm'] }\nminimize = 'max(x(P))'\nsubject_to = ['max(x(B)) >= 18 mm', 'range(angle(rocker)) <= 50 deg', 'max(x(P)) >= 36 mm']",
    );
    let with = format!("with a = {a} mm there `");
    assert!(notes.len() > 1 && notes[1].starts_with(&with), "{notes:?}");
    let kept = rocker(
        "vary = { a = { only = ['12 mm'] }, b = ['45 mm', '60 mm'] }\nminimize = 'range(angle(rocker))'",
    );
    assert!(scalar(&kept, "range(angle(rocker))") < 50.0);
}

/// A crank-rocker with crank, coupler and rocker of catalogues.
fn lengths(study: &str) -> StudyResult {
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
a = "20 mm"
b = "50 mm"
c = "40 mm"
px = "20 mm"
[links]
frame   = {{ A = [0, 0], D = [60, 0] }}
crank   = {{ A-B = "a" }}
coupler = {{ B-C = "b", P = ["px", 15] }}
rocker  = {{ D-C = "c" }}
[drives]
motor = {{ turns = "crank", from = 0, to = 360, speed = "60 rpm" }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
{study}
"#
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

fn how(result: &StudyResult) -> String {
    let mut all = result.listings.iter();
    let how = all.find(|it| it.title == "how it was found").unwrap();
    how.rows.concat().join("\n")
}

/// The swing of a crank-rocker and its least transmission angle, deg, by its dead points and where the crank lies along the frame; none of what does not turn.
fn swing([a, b, c]: [f64; 3]) -> Option<(f64, f64)> {
    let d = 60.0;
    let third = |x: f64, y: f64, z: f64| acos((x * x + y * y - z * z) / (2.0 * x * y)).to_degrees();
    let mu = |reach: f64| third(b, c, reach).min(180.0 - third(b, c, reach));
    let turns = a + d < b + c - 1e-9 && a + b < c + d - 1e-9 && a + c < b + d - 1e-9;
    let swing = third(d, c, b + a) - third(d, c, b - a);
    turns.then(|| (swing, mu(d + a).min(mu(d - a))))
}

/// Of 41 x 21 x 11 lengths those whose rocker swings most: the best without a catalogue lies between others.
#[test]
fn from_neighbour_to_neighbour_the_best_of_many_is_found() {
    // All of them would be tried, were as many designs allowed.
    let study = "designs = 9000\nvary = { a = { between = ['10 mm', '30 mm'], step = '0.5 mm' }, b = { between = ['45 mm', '65 mm'], step = '1 mm' }, c = { between = ['35 mm', '45 mm'], step = '1 mm' } }\nmaximize = 'range(angle(rocker))'\nsubject_to = 'transmission_angle(C) >= 40 deg'";
    let result = lengths(study);
    let mut most: (f64, [f64; 3]) = (0.0, [0.0; 3]);
    for a in (20..=60).map(|k| 0.5 * f64::from(k)) {
        for b in (45..=65).map(f64::from) {
            for c in (35..=45).map(f64::from) {
                match swing([a, b, c]) {
                    Some((own, mu)) if mu >= 40.0 && own > most.0 => most = (own, [a, b, c]),
                    _ => {}
                }
            }
        }
    }
    let found = scalar(&result, "range(angle(rocker))");
    let own = ["a", "b", "c"].map(|name| scalar(&result, name));
    assert!(
        (found - most.0).abs() < 1e-7,
        "{found} of {own:?}, not {most:?}"
    );
    assert!(how(&result).contains("from neighbour to neighbour until none was better"));
    // Where that is too much for the designs that are allowed, it is said.
    let few = lengths(&study.replace("designs = 9000", "designs = 60"));
    assert!(
        how(&few).contains("neighbours of the best were not all tried"),
        "{}",
        how(&few)
    );
    assert!(scalar(&few, "designs tried") < 90.0);
}

/// None of the combinations a step away is better, wherever the parameter without a catalogue goes.
#[test]
fn no_neighbour_is_better_with_the_rest_moved_again() {
    let study = |a: &str, b: &str, c: &str| {
        format!(
            "vary = {{ a = {a}, b = {b}, c = {c}, px = ['-20 mm', '60 mm'] }}\nminimize = 'range(x(P))'\nsubject_to = ['range(angle(rocker)) >= 55 deg', 'range(y(P)) >= 42 mm']"
        )
    };
    let result = lengths(&study(
        "{ between = ['10 mm', '30 mm'], step = '1.5 mm' }",
        "{ between = ['45 mm', '65 mm'], step = '2 mm' }",
        "{ between = ['35 mm', '45 mm'], step = '1 mm' }",
    ));
    let found = scalar(&result, "range(x(P))");
    let own = ["a", "b", "c"].map(|name| scalar(&result, name));
    let bounds = [[10.0, 30.0], [45.0, 65.0], [35.0, 45.0]];
    for (k, step) in [1.5, 2.0, 1.0].into_iter().enumerate() {
        for sign in [-1.0, 1.0] {
            let mut beside = own;
            beside[k] += sign * step;
            let [low, high] = bounds[k];
            if !(low..=high).contains(&beside[k]) || swing(beside).is_none() {
                continue;
            }
            let [a, b, c] = beside.map(|x| format!("{{ only = ['{x} mm'] }}"));
            let other = lengths(&study(&a, &b, &c));
            let kept = scalar(&other, "largest violation") < 1e-7;
            let value = scalar(&other, "range(x(P))");
            assert!(!kept || value > found - 1e-6, "{beside:?}: {value} {found}");
        }
    }
}

/// The crank's pin goes as far up as the crank is long whatever the other lengths are, but for rounding: that is no goal that designs better.
#[test]
fn designs_that_are_better_by_rounding_alone_are_no_points_of_a_front() {
    let result = rocker(
        "over = 'turn'\nvary = { b = { only = ['46 mm', '49.77 mm', '52.1 mm', '55 mm', '57.9 mm', '60 mm'] } }\n\
         minimize = ['range(distance(P, A))', 'range(angle(rocker))']\n",
    );
    assert!((scalar(&result, "points") - 1.0).abs() < 1e-9);
}

/// Few combinations are all searched: what is best with a value far from all others that look good is found, where rounding and neighbours do not lead to it.
#[test]
fn few_combinations_are_all_searched() {
    for seed in [1, 2, 4] {
        let model = read(&format!(
            "[parameters]
k = 2
x = 1
[links]
frame = {{ A = [0, 0] }}
arm = {{ A-B = '1 m + 0 m * (k + x)' }}
[drives]
m = {{ turns = 'arm', from = 0, to = '90 deg', speed = '1 rad/s' }}
[studies.turn]
kind = 'motion'
[studies.best]
kind = 'optimize'
vary = {{ k = {{ only = [1, 2, 3, 4, 5] }}, x = [-10, 10] }}
minimize = '5 - 4 * exp(-4 * (k - 1)^2 - (x / 5)^2) - 5 * exp(-4000 * (k - 5)^2 - ((x - 9) / 0.8)^2) + 0 * max(x(B)) / (1 m)'
seed = {seed}
"
        ));
        let result = run(&model, &model.studies[1], &mut Silent).unwrap();
        assert_eq!(scalar(&result, "k"), 5.0, "{seed}");
        assert!((scalar(&result, "x") - 9.0).abs() < 1e-6, "{seed}");
    }
}

/// The way without regard to a catalogue goes to valleys between its values: the file's own combination, which is the best of all, is not left for the neighbours
/// of those.
#[test]
fn the_files_own_combination_is_not_left_for_a_worse_one() {
    let model = read(
        r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
b = "30 mm"
[links]
frame = { A = [0, 0] }
crank = { A-B = "b" }
[drives]
motor = { turns = "crank", from = 0, to = 90, speed = "60 rpm" }
[measures]
between = "sin(3.14159265358979 rad * a / (10 mm))"
valley = "3 - 3 * exp(-((a - 20 mm) / (8 mm))^2) - exp(-((a - 100 mm) / (20 mm))^2)"
goal = "max(x(B)) / (1 m) + valley - 10 * between^2 * a / (120 mm)"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
over = "turn"
minimize = "goal"
[studies.best.vary]
a = { between = [10, 120], step = 10 }
b = [20, 40]
"#,
    );
    let result = run(&model, &model.studies[1], &mut Silent).unwrap();
    assert!((scalar(&result, "a") - 20.0).abs() < 1e-9);
    assert!((scalar(&result, "goal") - 0.02).abs() < 1e-6);
}
