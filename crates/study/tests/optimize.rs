//! Optimisation of mechanisms: optima against closed forms and published ones, what limits cost, catalogues, fronts, what cannot be.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_number::math;
use kempe_study::{Silent, StudyResult, check, run};

const ROCKER: &str = r#"
units = { length = "mm", angle = "deg" }
[parameters]
a = "20 mm"
b = "50 mm"
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = "a" }
coupler = { B-C = "b" }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 360, speed = "60 rpm" }
[assembly]
C = "left of B -> D"
[measures]
play = "range(angle(rocker))"
mu = "transmission_angle(C)"
[studies.turn]
kind = "motion"
"#;

fn read(text: &str) -> Model {
    match Model::from_toml(text, "test", &mut |_| Err(String::new())) {
        Ok(checked) => checked.model,
        Err(found) => panic!(
            "{}",
            found
                .iter()
                .map(|d| d.render_plain("test", text))
                .collect::<String>()
        ),
    }
}

fn best(study: &str) -> StudyResult {
    let model = read(&format!(
        "{ROCKER}[studies.best]\nkind = 'optimize'\n{study}"
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

fn number(result: &StudyResult, name: &str) -> f64 {
    result
        .scalars
        .iter()
        .find(|s| s.name == name)
        .unwrap_or_else(|| panic!("no {name}"))
        .value
}

/// The swing of the crank-rocker, deg, by its dead points.
fn swing(a: f64, b: f64) -> f64 {
    let (c, d) = (40.0, 60.0);
    let at = |reach: f64| math::acos((d * d + c * c - reach * reach) / (2.0 * d * c)).to_degrees();
    at(b + a) - at(b - a)
}

/// Its least transmission angle, deg: where the crank lies along the frame.
fn least_mu(a: f64, b: f64) -> f64 {
    let (c, d) = (40.0, 60.0);
    let at = |reach: f64| {
        let mu = math::acos((b * b + c * c - reach * reach) / (2.0 * b * c)).to_degrees();
        mu.min(180.0 - mu)
    };
    at(d + a).min(at(d - a))
}

#[test]
fn the_largest_swing_at_a_least_transmission_angle() {
    let result = best(
        "vary = { a = ['10 mm', '30 mm'], b = ['45 mm', '65 mm'] }\nmaximize = 'play'\nsubject_to = 'mu >= 40 deg'\n",
    );
    let (a, b) = (number(&result, "a"), number(&result, "b"));
    assert!((number(&result, "play") - swing(a, b)).abs() < 1e-7);
    assert!(least_mu(a, b) > 40.0 - 1e-5 && number(&result, "largest violation") < 1e-7);
    // A dense search finds none better.
    let mut dense: f64 = 0.0;
    for i in 0..=400 {
        for j in 0..=400 {
            let (a, b) = (
                10.0 + 20.0 * f64::from(i) / 400.0,
                45.0 + 20.0 * f64::from(j) / 400.0,
            );
            let turns = a + 60.0 < b + 40.0 - 1e-9;
            if turns && least_mu(a, b) >= 40.0 {
                dense = dense.max(swing(a, b));
            }
        }
    }
    let found = number(&result, "play");
    assert!(
        found > dense - 1e-6 && found < dense + 0.5,
        "{found} {dense}"
    );
    assert!(number(&result, "first-order residual") < 1e-6);
    // The file that comes back has the values in it, and nothing else changed.
    let file = &result.designs[0].file.toml;
    let again = read(file);
    let values = again.parameter_values::<f64>();
    assert!((values[0] * 1e3 - a).abs() < 1e-9 && (values[1] * 1e3 - b).abs() < 1e-9);
    let differs = ROCKER.lines().filter(|line| !file.contains(line)).count();
    assert_eq!(differs, 2, "{file}");
}

/// What a limit costs is how the optimum changes with it.
#[test]
fn costs_of_limits() {
    let at = |limit: f64| {
        best(&format!(
            "vary = {{ a = ['10 mm', '30 mm'], b = ['45 mm', '65 mm'] }}\nmaximize = 'play'\nsubject_to = 'mu >= {limit} deg'\nmethod = 'local'\n"
        ))
    };
    let (less, own, more) = (at(39.9), at(40.0), at(40.1));
    let slope = (number(&less, "play") - number(&more, "play")) / 0.2;
    let costs = own
        .listings
        .iter()
        .find(|l| l.title.starts_with("what holds"))
        .unwrap();
    let row = costs
        .rows
        .iter()
        .find(|row| row[0].starts_with("mu"))
        .unwrap();
    let told: f64 = row[2].trim_end_matches(" deg").parse().unwrap();
    assert!((told - slope).abs() < 0.02 * slope.abs(), "{told} {slope}");
}

#[test]
fn all_methods_agree() {
    let study = |method: &str| {
        best(&format!(
            "vary = {{ a = ['10 mm', '30 mm'], b = ['45 mm', '65 mm'] }}\nmaximize = 'play'\nsubject_to = 'mu >= 40 deg'\nmethod = '{method}'\ndesigns = 120\n"
        ))
    };
    let own = number(&study("multi-start"), "play");
    for method in ["differential evolution", "cma-es", "local"] {
        let found = number(&study(method), "play");
        assert!((found - own).abs() < 1e-6 * own, "{method}: {found} {own}");
    }
    // The same study gives the same bytes.
    let again = [
        study("differential evolution"),
        study("differential evolution"),
    ];
    assert_eq!(again[0].table, again[1].table);
}

#[test]
fn catalogues_by_trying_all_or_by_rounding() {
    let all = best(
        "vary = { a = { only = ['15 mm', '18 mm', '22 mm', '28 mm'] }, b = { between = ['46 mm', '60 mm'], step = '2 mm' } }\nmaximize = 'play'\nsubject_to = 'mu >= 40 deg'\n",
    );
    let mut dense = (0.0, 0.0, 0.0);
    for a in [15.0, 18.0, 22.0, 28.0] {
        for b in (46..=60).step_by(2).map(f64::from) {
            if a + 60.0 < b + 40.0 - 1e-9 && least_mu(a, b) >= 40.0 && swing(a, b) > dense.0 {
                dense = (swing(a, b), a, b);
            }
        }
    }
    assert!((number(&all, "play") - dense.0).abs() < 1e-7, "{dense:?}");
    assert_eq!(
        (number(&all, "a").round(), number(&all, "b").round()),
        (dense.1, dense.2)
    );
    let mixed = best(
        "vary = { a = { only = ['15 mm', '18 mm', '22 mm', '28 mm'] }, b = ['46 mm', '60 mm'] }\nmaximize = 'play'\nsubject_to = 'mu >= 40 deg'\n",
    );
    let a = number(&mixed, "a");
    assert!(
        [15.0, 18.0, 22.0, 28.0]
            .iter()
            .any(|v| (v - a).abs() < 1e-9),
        "{a}"
    );
    assert!(
        number(&mixed, "play") >= dense.0 - 1e-7 && least_mu(a, number(&mixed, "b")) > 40.0 - 1e-5
    );
}

#[test]
fn what_cannot_be_is_named() {
    let result = best(
        "vary = { a = ['10 mm', '30 mm'], b = ['45 mm', '65 mm'] }\nmaximize = 'play'\nsubject_to = ['mu >= 50 deg', 'play >= 90 deg', 'b >= 46 mm']\n",
    );
    let told = result
        .diagnostics
        .iter()
        .find(|d| d.code == "infeasible")
        .unwrap();
    let notes = told.notes.join("; ");
    assert!(
        notes.contains("mu >= 50 deg") && notes.contains("play >= 90 deg"),
        "{notes}"
    );
    assert!(!notes.contains("b >= 46 mm"), "{notes}");
    let model = read(&format!(
        "{ROCKER}[studies.best]\nkind = 'optimize'\nvary = {{ b = ['5 mm', '6 mm'] }}\nminimize = 'play'\n"
    ));
    let told = run(&model, &model.studies[1], &mut Silent).unwrap_err();
    let codes: Vec<&str> = told.iter().map(|d| d.code).collect();
    assert!(codes.contains(&"no-answer"), "{codes:?}");
    assert!(
        check(&model)
            .diagnostics
            .iter()
            .any(|d| d.code == "outside-bounds")
    );
}

#[test]
fn a_front_of_swing_against_transmission() {
    let result = best(
        "vary = { a = ['10 mm', '30 mm'], b = ['45 mm', '65 mm'] }\nmaximize = ['play', 'min(mu)']\ndesigns = 240\n",
    );
    let column = |name: &str| result.table.column(name).unwrap().values.clone();
    let (play, mu) = (column("play"), column("min(mu)"));
    assert!(play.len() > 10, "{}", play.len());
    for i in 0..play.len() {
        for j in 0..play.len() {
            let better =
                play[j] >= play[i] && mu[j] >= mu[i] && (play[j] > play[i] || mu[j] > mu[i]);
            assert!(!better, "{i} {j}");
        }
        assert!((play[i] - swing(column("a")[i], column("b")[i])).abs() < 1e-6);
        assert!((mu[i] - least_mu(column("a")[i], column("b")[i])).abs() < 1e-6);
    }
    assert!(number(&result, "points optimal to first order") > 0.7 * play.len() as f64);
    assert_eq!(result.designs.len(), play.len().min(40));
}

/// The steering linkage: 58414.257 N for a window of 180 degrees, by differential evolution and SLSQP over areas of triangles.
#[test]
fn the_published_steering_linkage() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/seeds/steering-optimum.toml"
    );
    let text = std::fs::read_to_string(path).unwrap();
    for (window, force, rotation) in [
        ("180 deg", 58_414.257, 229.145_710),
        ("195 deg", 76_282.689, 236.573_775),
    ] {
        let set = [("window".to_owned(), window.to_owned())];
        let model = Model::from_toml_with(&text, "test", &mut |_| Err(String::new()), &set)
            .unwrap()
            .model;
        let study = model.studies.iter().find(|s| s.name == "best").unwrap();
        let result = run(&model, study, &mut Silent).unwrap();
        let found = number(&result, "peak");
        assert!((found - force).abs() < 1e-5 * force, "{window}: {found}");
        let turn = result.table.column("rotation").unwrap().values[1];
        assert!((turn - rotation).abs() < 1e-2, "{turn}");
    }
}
