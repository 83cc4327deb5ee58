//! Optima on ridges: where two peaks of a motion, in a formula of several, are equally high.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::scalar;
use kempe_study::{Silent, StudyResult, run};

/// A lever that swings by 60 deg, from where `s` says, with what is asked of it.
fn swing(goal: &str) -> StudyResult {
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
l = "60.3 mm"
s = "4 deg"
[links]
frame = {{ A = [0, 0] }}
lever = {{ A-B = "l" }}
[drives]
m = {{ turns = "lever", from = "60 deg + s", to = "120 deg + s", speed = 10 }}
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
over = "turn"
vary = {{ s = ["-20 deg", "25 deg"], l = ["50 mm", "70 mm"] }}
{goal}
"#
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

#[track_caller]
fn shown(result: &StudyResult, wanted: &[(&str, f64)]) {
    assert!(result.diagnostics.is_empty(), "{:?}", result.diagnostics);
    assert!(scalar(result, "first-order residual") < 1e-7);
    for (name, wanted) in wanted {
        let found = scalar(result, name);
        assert!((found - wanted).abs() < 1e-7, "{name}: {found}");
    }
}

/// The swing stands upright, where it reaches as far to either side: x = l cos 60 deg of a height of l.
#[test]
fn a_ratio_of_two_statistics_is_least_on_the_ridge_of_one() {
    let goal = "max(abs(x(B))) / max(y(B)) + max(y(B)) / (1 m)";
    let result = swing(&format!("minimize = '{goal}'"));
    shown(&result, &[(goal, 0.55), ("s", 0.0), ("l", 50.0)]);
}

/// So does what is farthest from a mean, which itself moves.
#[test]
fn a_ratio_of_what_is_farthest_from_a_mean_is_least_on_its_ridge() {
    let goal = "max(abs(x(B) - mean(x(B)))) / max(y(B)) + max(y(B)) / (1 m)";
    let beside = "subject_to = ['s >= -5 deg', 's <= 5 deg']";
    let result = swing(&format!("minimize = '{goal}'\n{beside}"));
    shown(&result, &[(goal, 0.55), ("s", 0.0), ("l", 50.0)]);
}

/// Both sums have their ridge there, and both ends of the swing are in each of them.
#[test]
fn a_sum_of_two_statistics_is_least_where_both_have_their_ridges() {
    let goal = "max(abs(x(B))) + 2 * max(abs(angle(lever) - 90 deg)) * (1 m) + range(y(B))";
    let result = swing(&format!("minimize = '{goal}'"));
    // 50 mm cos 60 deg + 2 (pi / 6) m + 50 mm (1 - sin 60 deg).
    let wanted = 25.0 + 1000.0 * std::f64::consts::PI / 3.0 + 50.0 * (1.0 - 0.75_f64.sqrt());
    shown(&result, &[(goal, wanted), ("s", 0.0), ("l", 50.0)]);
}

/// What is to be large: the least of two ends, over a mean of both.
#[test]
fn what_is_to_be_large_has_its_ridge_upside_down() {
    let goal = "min(y(B)) / mean(y(B))";
    let result = swing(&format!("maximize = '{goal}'\nsubject_to = ['l <= 60 mm']"));
    // sin 60 deg over the mean of the sine from 60 to 120 deg, 3 / pi.
    let wanted = 0.75_f64.sqrt() * std::f64::consts::PI / 3.0;
    assert!(
        (scalar(&result, goal) - wanted).abs() < 1e-7,
        "{}",
        scalar(&result, goal)
    );
    assert!(scalar(&result, "s").abs() < 1e-6);
}

/// A limit that is kept where a distance is nothing has no slope there: along what keeps it the goal still falls, down to a bound. One unknown is left where both
/// coordinates are eliminated: u + v = 20 mm, and v - w + 0.004 u v / mm = 10 mm.
#[test]
fn along_a_limit_without_an_inside_the_best_is_found() {
    let goal = "max(distance(B, P)) + 0.05 * u + 0.02 * w";
    let model = read(&format!(
        r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
u = "5 mm"
v = "12 mm"
w = "4 mm"
[links]
frame = {{ A = [0, 0], S = [20, 10] }}
arm   = {{ A-B = 30, P = ["u + v", "v - w + 0.004 * u * v / (1 mm)"] }}
[drives]
motor = {{ turns = "arm", from = 0, to = 90, speed = "60 rpm" }}
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
over = "turn"
minimize = "{goal}"
subject_to = ["at(distance(P, S), motor, 0 deg) <= 0 mm"]
vary = {{ u = ["2 mm", "18 mm"], v = ["2 mm", "18 mm"], w = ["0 mm", "15 mm"] }}
"#
    ));
    let result = run(&model, &model.studies[1], &mut Silent).unwrap();
    let told: Vec<_> = result.diagnostics.iter().map(|d| d.code).collect();
    assert!(told.is_empty(), "{told:?}");
    let found = scalar(&result, goal);
    // P lies on S: the distance to B stays, and the rest falls with u.
    let best = (0..=16_000).map(|k| {
        let u = 2.0 + f64::from(k) / 1000.0;
        let v = 20.0 - u;
        let w = v + 0.004 * u * v - 10.0;
        let kept = (0.0..=15.0).contains(&w);
        if kept {
            200.0_f64.sqrt() + 0.05 * u + 0.02 * w
        } else {
            f64::INFINITY
        }
    });
    let best = best.fold(f64::INFINITY, f64::min);
    assert!((found - best).abs() < 1e-5, "{found} instead of {best}");
}

/// The peak lies where C turns back, at once: it goes with that, and is no peak of one side. Along the limit the goal falls to the least length of the
/// coupler, and what easing the limit brings is what it brings.
#[test]
fn a_peak_where_a_speed_vanishes_is_led_down_with_it() {
    let found = |limit: f64| {
        let model = read(&format!(
            r#"
units = {{ length = "mm", angle = "deg" }}
[parameters]
a = "20 mm"
b = "50 mm"
[links]
frame = {{ A = [0, 0], D = [60, 0] }}
crank = {{ A-B = "a" }}
coupler = {{ B-C = "b", P = [25, 10] }}
rocker = {{ D-C = 40 }}
[drives]
motor = {{ turns = "crank", speed = "60 rpm" }}
[assembly]
C = "left of B -> D"
[studies.turn]
kind = "motion"
[studies.best]
kind = "optimize"
over = "turn"
method = "local"
vary = {{ a = ["15 mm", "25 mm"], b = ["45 mm", "60 mm"] }}
minimize = "max(speed(P) - speed(C))"
subject_to = "range(angle(rocker)) >= {limit} deg"
"#
        ));
        run(&model, &model.studies[1], &mut Silent).unwrap()
    };
    let own = found(60.0);
    shown(&own, &[("b", 45.0)]);
    let goal = |limit: f64| scalar(&found(limit), "max(speed(P) - speed(C))");
    let eased = (goal(60.01) - goal(59.99)) / 0.02;
    assert!((eased - 0.8845).abs() < 1e-3, "{eased}");
    let held = own
        .listings
        .iter()
        .find(|it| it.title.starts_with("what holds"));
    let told = &held.unwrap().rows[0];
    assert_eq!(told[2], format!("-{:.6} mm/s", 0.884514));
}
