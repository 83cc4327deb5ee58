//! The language as its reference shows it: whole files become models.
#![allow(clippy::unwrap_used)]

use kempe_model::{Checked, Diagnostic, DriveKind, LawPiece, Leaf, Model, Place, Rows, StudyKind};

fn read(name: &str) -> Checked {
    let path = format!("{}/tests/good/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut files = |name: &str| match name {
        "measured.csv" => Ok("t [s];angle\n0;10\n0.5;20\n1;25\n2;20\n".to_owned()),
        _ => Err("no such file".to_owned()),
    };
    Model::from_toml(&text, name, &mut files)
        .unwrap_or_else(|found| panic!("{}", all(&found, name, &text)))
}

fn all(found: &[Diagnostic], name: &str, text: &str) -> String {
    found.iter().map(|d| d.render_plain(name, text)).collect()
}

#[test]
fn crank_rocker() {
    let Checked { model, warnings } = read("crank-rocker");
    assert!(warnings.is_empty(), "{warnings:#?}");
    assert_eq!(model.title, "Crank-rocker");
    let names: Vec<&str> = model.points.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["A", "D", "B", "C", "P"]);
    let values: Vec<f64> = model.parameter_values();
    assert_eq!(values, [0.02, 0.05, 0.04, 0.06]);
    assert_eq!(
        model.links[2].evaluate(&values),
        [[0.0, 0.0], [0.05, 0.0], [0.025, 0.0]]
    );
    let StudyKind::Motion(turn) = &model.studies[0].kind else {
        panic!("a motion study")
    };
    assert!(matches!(&turn.rows, Rows::DriveStep(_)));
    assert_eq!(turn.plots.len(), 3);
    assert_eq!(model.drives[0].law.duration(&values), std::f64::consts::TAU);
}

#[test]
fn slider_crank() {
    let model = read("slider-crank").model;
    assert_eq!(model.joints.len(), 1);
    assert_eq!(model.studies[0].name, "motion");
    assert_eq!(
        model.measures[2].dimension,
        kempe_units::Dimension::ACCELERATION
    );
}

#[test]
fn door_lock() {
    let Checked { model, warnings } = read("door-lock");
    let codes: Vec<&str> = warnings.iter().map(|d| d.code).collect();
    assert_eq!(
        codes,
        [
            "section-not-available",
            "study-not-available",
            "study-not-available"
        ]
    );
    assert!(matches!(model.drives[0].kind, DriveKind::Turn { .. }));
    assert!(matches!(
        model.links[2].points[2].place,
        Place::Triangle { .. }
    ));
    let plate = model.links[2].evaluate::<f64>(&[]);
    assert!(plate[2][1] < 0.0, "E lies on the right of A -> B");
}

#[test]
fn tractor_hitch() {
    let Checked { model, warnings } = read("tractor-hitch");
    assert_eq!(warnings.len(), 3, "{warnings:#?}");
    assert_eq!(model.measures.len(), 4);
    let inertia = model.links[4].inertia.clone().unwrap();
    assert_eq!(inertia.mass.unwrap().eval(&mut |_| 0.0), 1000.0);
    let kempe_model::Measure::Leaf(Leaf::Pose(kempe_model::PoseMeasure::TransmissionAngle {
        a,
        b,
        ..
    })) = &model.measures[3].measure
    else {
        panic!()
    };
    assert_eq!(
        (
            model.points[a.index()].name.as_str(),
            model.points[b.index()].name.as_str()
        ),
        ("D", "Q")
    );
}

#[test]
fn every_joint_and_every_law() {
    let Checked { model, warnings } = read("joints");
    assert!(warnings.is_empty(), "{}", all(&warnings, "joints", ""));
    assert_eq!(
        (model.joints.len(), model.drives.len(), model.measures.len()),
        (5, 6, 9)
    );
    assert!(matches!(
        model.drives[2].law.pieces[0],
        LawPiece::Table { .. }
    ));
    assert!((model.drives[2].law.duration::<f64>(&[]) - 2.0).abs() < 1e-15);
}
