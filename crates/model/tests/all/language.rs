//! The language as its reference shows it: whole files become models.
#![allow(clippy::unwrap_used)]

use kempe_model::{
    Acts, Amount, Between, Center, Checked, Diagnostic, DriveKind, ForceMeasure, FrictionAt,
    LawPiece, Leaf, LoadKind, Measure, Model, Place, Plot, Rows, StudyKind, ToothSize, value,
};

fn read(name: &str) -> Checked {
    let path = format!("{}/tests/good/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut files = |name: &str| match name {
        "measured.csv" => Ok("t [s];angle\n0;10\n0.5;20\n1;25\n2;20\n".to_owned()),
        "card.csv" => Ok("p [bar],phi [deg]\n1,0\n50,360\n2,400\n1,719\n".to_owned()),
        "plain.csv" => Ok("time,force\n0,10\n1,20\n".to_owned()),
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
    let Checked {
        model, warnings, ..
    } = read("crank-rocker");
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
    let Checked {
        model, warnings, ..
    } = read("door-lock");
    let codes: Vec<&str> = warnings.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["no-inertia"]);
    assert_eq!(model.clearances.len(), 1);
    assert!(matches!(model.studies[2].kind, StudyKind::Clearance(_)));
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
    let Checked {
        model, warnings, ..
    } = read("tractor-hitch");
    assert!(warnings.is_empty(), "{warnings:#?}");
    let StudyKind::Optimize(best) = &model.studies[1].kind else {
        panic!()
    };
    assert_eq!(
        (best.vary.len(), best.goals.len(), best.subject_to.len()),
        (2, 2, 2)
    );
    assert_eq!(model.measures.len(), 6);
    let inertia = model.links[4].inertia.clone().unwrap();
    assert_eq!(inertia.mass.unwrap().eval(&mut |_| 0.0), 1000.0);
    let kempe_model::Measure::Leaf(Leaf::Pose(kempe_model::PoseMeasure::TransmissionAngle {
        a,
        b,
        ..
    })) = &model.measures[5].measure
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
    let Checked {
        model, warnings, ..
    } = read("joints");
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

/// A parameter set by a program winds no torsion spring by its free angle, as one in the file does not.
#[test]
fn free_angles_are_less_than_a_turn() {
    let text = r#"
[parameters]
free = "-20 deg"
[links]
frame = { A = [0, 0] }
drum  = { A-B = 1 }
[springs]
back = { links = ["frame", "drum"], stiffness = "3 N m/rad", free = "free" }
"#;
    let model = Model::from_toml(text, "test", &mut |_| Err("no table".into()))
        .unwrap()
        .model;
    let codes = |free: f64| -> Vec<&str> {
        let found = model.unsound(&[free]).into_iter();
        found.map(|d| d.code).collect()
    };
    assert!(codes(6.2).is_empty() && codes(-6.2).is_empty());
    assert_eq!(codes(6.29), ["wound-spring"]);
    assert_eq!(codes(-12.0), ["wound-spring"]);
}

/// A parameter set by a program stays between none and 45 degrees, as one in the file does.
#[test]
fn pressure_angles_are_those_of_teeth() {
    let text = r#"
[parameters]
alpha = "20 deg"
[links]
frame = { A = [0, 0], B = [0.3, 0] }
sun   = { A = [0, 0] }
wheel = { B = [0, 0] }
[joints]
mesh = { gears = ["sun", "wheel"], teeth = ["0.1 m", "0.2 m"], pressure_angle = "alpha", module = "5 mm" }
[drives]
motor = { turns = "sun", speed = "1 rad/s" }
"#;
    let model = Model::from_toml(text, "test", &mut |_| Err("no table".into()))
        .unwrap()
        .model;
    let codes = |alpha: f64| -> Vec<&str> {
        let found = model.unsound(&[alpha]).into_iter();
        found.map(|d| d.code).collect()
    };
    assert!(codes(0.3).is_empty() && codes(0.785).is_empty());
    assert_eq!(codes(0.0), ["bad-size"]);
    assert_eq!(codes(-0.1), ["bad-size"]);
    assert_eq!(codes(0.786), ["pressure-angle"]);
    let teeth = model.joints[0].kind.teeth().unwrap();
    assert!(matches!(&teeth.size, ToothSize::Module(Some(m)) if value::<f64>(m, &[]) == 0.005));
    // A file written from it says the same.
    let again = Model::from_toml(&model.to_toml().toml, "again", &mut |_| {
        Err("no table".into())
    });
    assert_eq!(again.unwrap().model.joints[0].kind, model.joints[0].kind);
}

#[test]
fn everything_that_acts() {
    let Checked {
        model, warnings, ..
    } = read("forces");
    assert!(warnings.is_empty(), "{}", all(&warnings, "forces", ""));
    let p: Vec<f64> = model.parameter_values();
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} != {b}");
    let acts = &model.actions;
    let [gx, gy] = acts.gravity.as_ref().unwrap();
    near(value(gx, &p), 0.0);
    near(value(gy, &p), -9.81);

    let bar = model.links[1].inertia.as_ref().unwrap();
    let mass = 7850.0 * 0.02 * 0.005 * 0.02;
    near(value(bar.mass.as_ref().unwrap(), &p), mass);
    near(
        value(bar.moment.as_ref().unwrap(), &p),
        mass * (0.02 * 0.02 + 0.02 * 0.02) / 12.0,
    );
    assert_eq!(model.links[1].center_of_mass(&p), Some([0.01, 0.0]));
    let rod = model.links[2].inertia.as_ref().unwrap();
    near(
        value(rod.moment.as_ref().unwrap(), &p),
        0.05 * 0.05 * 0.05 / 12.0,
    );
    assert!(matches!(
        model.links[3].inertia.as_ref().unwrap().center,
        Center::Point(_)
    ));

    assert_eq!(
        (
            acts.loads.len(),
            acts.masses.len(),
            acts.springs.len(),
            acts.dampers.len()
        ),
        (7, 3, 4, 2)
    );
    let constant = |amount: &Amount| match amount {
        Amount::Measure(measure) => measure.as_constant().unwrap(),
        Amount::Table { .. } => panic!(),
    };
    let LoadKind::Force {
        at,
        components: [x, y],
        ..
    } = &acts.loads[1].kind
    else {
        panic!()
    };
    assert_eq!(model.links[at.link.index()].name, "rocker");
    near(constant(x), 50.0 * 0.75f64.sqrt());
    near(constant(y), 25.0);
    let LoadKind::Force { axes, .. } = &acts.loads[2].kind else {
        panic!()
    };
    assert_eq!(model.links[axes.index()].name, "coupler");
    let LoadKind::Force {
        at: hinge,
        components:
            [
                _,
                Amount::Table {
                    at,
                    values,
                    period,
                    factor,
                    ..
                },
            ],
        ..
    } = &acts.loads[4].kind
    else {
        panic!()
    };
    assert_eq!(model.links[hinge.link.index()].name, "piston");
    near(at[1], std::f64::consts::TAU);
    near(values[1], 5e6);
    near(period.unwrap(), 2.0 * std::f64::consts::TAU);
    near(value(factor, &p), -std::f64::consts::PI * 0.04 * 0.04);
    let LoadKind::Force {
        components: [Amount::Table { factor, .. }, _],
        ..
    } = &acts.loads[5].kind
    else {
        panic!()
    };
    near(value(factor, &p), 0.75f64.sqrt());
    assert!(matches!(
        acts.loads[6].kind,
        LoadKind::Torque {
            amount: Amount::Table { .. },
            ..
        }
    ));

    let pull = &acts.springs[0];
    assert_eq!(pull.acts, Acts::Tension);
    near(value(&pull.stiffness, &p), 2000.0);
    near(value(pull.stops[1].as_ref().unwrap(), &p), 0.12);
    let door = &acts.springs[3];
    assert!(matches!(door.between, Between::Links(..)) && door.stops[0].is_none());
    near(
        value(door.stop_stiffness.as_ref().unwrap(), &p),
        180.0 / std::f64::consts::PI,
    );

    assert!(matches!(acts.friction[2].at, FrictionAt::All));
    let FrictionAt::Pin(shared) = acts.friction[3].at else {
        panic!()
    };
    let holder = model.points[shared.index()].holder.unwrap();
    assert_eq!(model.links[holder.index()].name, "coupler");
    near(
        value(acts.friction[0].stribeck_speed.as_ref().unwrap(), &p),
        1e-3,
    );
    near(
        value(acts.cylinders[0].flow.as_ref().unwrap(), &p),
        20e-3 / 60.0,
    );
    near(
        value(&acts.motors[0].curve[1].0, &p),
        100.0 * std::f64::consts::PI,
    );

    let forces: Vec<bool> = model.measures.iter().map(|m| m.needs_forces).collect();
    assert_eq!(forces, [true, true, true, true, false]);
    assert!(matches!(&model.studies[0].kind, StudyKind::Motion(_)));
    let StudyKind::Forces(study) = &model.studies[1].kind else {
        panic!()
    };
    assert_eq!(study.columns.len(), 7);
    assert_eq!(
        study.columns[5].measure,
        Measure::Leaf(Leaf::Force(ForceMeasure::Spring(3)))
    );
    assert!(model.needs_forces(&study.columns[0].measure));
    assert!(matches!(&study.plots[1], Plot::Path(_)));
    assert!(matches!(&study.plots[2], Plot::Hodograph(h) if h.name == "hodograph(C, coupler)"));
    assert!(matches!(&study.plots[3], Plot::Curves(both) if both.len() == 2));
}

/// The place of `at` is a value like any other: a bare number is in the file's unit.
#[test]
fn the_place_of_a_number_over_the_motion_is_in_the_files_unit() {
    let measure = |angle: &str, place: &str| {
        let text = format!(
            "units = {{ angle = \"{angle}\" }}\n[links]\nframe = {{ A = [0, 0] }}\ncrank = {{ A-B = 1 }}\n\
             [drives]\nmotor = {{ turns = \"crank\", speed = \"1 rad/s\" }}\n[measures]\nm = \"at(y(B), motor, {place})\"\n"
        );
        let read = kempe_model::Model::from_toml(&text, "at", &mut |_| Err(String::new()));
        read.unwrap().model.measures[0].measure.clone()
    };
    assert_eq!(measure("rad", "0.5"), measure("deg", "0.5 rad"));
    assert_eq!(measure("deg", "90"), measure("rad", "90 deg"));
    assert_ne!(measure("rad", "90"), measure("deg", "90"));
}
