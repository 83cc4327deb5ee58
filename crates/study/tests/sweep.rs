//! Sweeps: the order of designs, numbers against closed forms, what parameters do, designs that do not move.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_number::math;
use kempe_study::{Figure, Silent, StudyResult, check, run};

const ROCKER: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
b = "50 mm"
d = "60 mm"
[links]
frame   = { A = [0, 0], D = ["d", 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b", P = [25, 10] }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
[measures]
swing = "angle(rocker)"
play = "range(swing)"
[studies.turn]
kind = "motion"
plot = ["swing", "path(P)"]
"#;

fn model(study: &str) -> Model {
    let text = format!("{ROCKER}{study}");
    match Model::from_toml(&text, "test", &mut |_| Err(String::new())) {
        Ok(checked) => checked.model,
        Err(found) => panic!(
            "{}",
            found
                .iter()
                .map(|d| d.render_plain("test", &text))
                .collect::<String>()
        ),
    }
}

fn swept(study: &str) -> StudyResult {
    let model = model(study);
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

/// The swing of a crank-rocker, deg, by its dead points in closed form.
fn swing(a: f64, b: f64, d: f64) -> f64 {
    let c = 40.0;
    let at = |reach: f64| math::acos((d * d + c * c - reach * reach) / (2.0 * d * c)).to_degrees();
    at(b + a) - at(b - a)
}

#[test]
fn a_grid_in_order_with_the_last_parameter_fastest() {
    let result = swept(
        "[studies.s]\nkind = 'sweep'\nvary = { a = ['18 mm', '20 mm'], b = { from = '48 mm', to = '52 mm', count = 3 } }\n",
    );
    let column = |name: &str| result.table.column(name).unwrap().values.clone();
    assert_eq!(column("design"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(column("a"), [18.0, 18.0, 18.0, 20.0, 20.0, 20.0]);
    assert_eq!(column("b"), [48.0, 50.0, 52.0, 48.0, 50.0, 52.0]);
    let play = column("play");
    for k in 0..6 {
        let exact = swing(column("a")[k], column("b")[k], 60.0);
        assert!((play[k] - exact).abs() < 1e-9, "{} {exact}", play[k]);
    }
    assert!(result.table.closure.iter().all(|c| *c < 1e-12));
    // A family of curves for each plot of the study that is run.
    let graphs: Vec<usize> = (result.figures.iter())
        .map(|figure| match figure {
            Figure::Graph { curves, .. } | Figure::Plane { curves, .. } => curves.len(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(graphs, [6, 6]);
    let Figure::Graph { curves, x, .. } = &result.figures[0] else {
        panic!()
    };
    assert_eq!(
        (curves[5].name.as_str(), x.0.as_str()),
        ("a = 20 mm, b = 52 mm", "motor")
    );
}

#[test]
fn one_at_a_time_with_what_each_does_beside_exact_derivatives() {
    let result = swept(
        "[studies.s]\nkind = 'sweep'\ncombine = 'one at a time'\nvary = { a = { by = '1 %' }, b = { by = '0.1 mm' }, d = { by = '1 %' } }\n",
    );
    let a = &result.table.column("a").unwrap().values;
    let expected = [20.0, 19.8, 20.2, 20.0, 20.0, 20.0, 20.0];
    assert!(
        a.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-12),
        "{a:?}"
    );
    let tornado = &result.listings[0];
    let names: Vec<&str> = tornado.rows.iter().map(|row| row[0].as_str()).collect();
    // By closed form.
    let by = |name: &str| match name {
        "a" => (swing(20.2, 50.0, 60.0) - swing(19.8, 50.0, 60.0)).abs(),
        "b" => (swing(20.0, 50.1, 60.0) - swing(20.0, 49.9, 60.0)).abs(),
        _ => (swing(20.0, 50.0, 60.6) - swing(20.0, 50.0, 59.4)).abs(),
    };
    assert!(names.windows(2).all(|w| by(w[0]) >= by(w[1])), "{names:?}");
    let slopes = result.listings.last().unwrap();
    let slope: f64 = slopes.rows[0][1].parse().unwrap();
    let exact = (swing(20.001, 50.0, 60.0) - swing(19.999, 50.0, 60.0)) / 0.002;
    assert!(
        (slope - exact).abs() < 1e-4 * exact.abs(),
        "{slope} {exact}"
    );
}

#[test]
fn together_and_designs_that_do_not_close() {
    let result = swept(
        "[studies.s]\nkind = 'sweep'\ncombine = 'together'\nvary = { a = ['18 mm', '20 mm', '95 mm'], b = ['49 mm', '50 mm', '51 mm'] }\n",
    );
    assert_eq!(result.table.rows(), 3);
    assert!(result.table.column("play").unwrap().values[2].is_nan());
    assert!(result.table.notes[2].is_some() && result.table.notes[1].is_none());
    let told: Vec<&str> = result.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(told, ["rows-not-reached"]);
}

#[test]
fn one_parameter_has_its_numbers_over_it() {
    let result = swept(
        "[studies.s]\nkind = 'sweep'\nvary = { a = { from = '10 mm', to = '25 mm', count = 4 } }\ncolumns = ['max(swing)', 'min(swing)']\nplot = ['swing']\n",
    );
    let Figure::Graph { x, y, curves, .. } = &result.figures[1] else {
        panic!("{:?}", result.figures[1])
    };
    assert_eq!(
        (x.0.as_str(), y.0.as_str(), curves[0].points.len()),
        ("a", "min(swing)", 4)
    );
}

#[test]
fn too_many_designs_are_told_by_check_and_run() {
    let model = model(
        "[studies.s]\nkind = 'sweep'\nvary = { a = { from = '10 mm', to = '25 mm', count = 40000 }, b = { from = '50 mm', to = '60 mm', count = 40000 } }\n",
    );
    let codes = |told: &[kempe_model::Diagnostic]| told.iter().map(|d| d.code).collect::<Vec<_>>();
    let told = run(&model, &model.studies[1], &mut Silent).unwrap_err();
    assert_eq!(codes(&told), ["too-large"]);
    assert!(codes(&check(&model).diagnostics).contains(&"too-large"));
}

#[test]
fn what_is_stopped_keeps_its_rows() {
    use kempe_study::{Done, Stage};
    use std::ops::ControlFlow::{Break, Continue};
    let model = model(
        "[studies.s]\nkind = 'sweep'\nvary = { a = { from = '10 mm', to = '25 mm', count = 9 } }\n",
    );
    let mut two = |stage: Stage, done: Done| match (stage, done) {
        (Stage::Rows, Done::Of(rows, 9)) if rows >= 2 => Break(()),
        _ => Continue(()),
    };
    let result = run(&model, &model.studies[1], &mut two).unwrap();
    assert!(result.interrupted() && result.table.rows() == 2);
}
