//! The registry of measures against the reader: every example and every signature is understood.
#![allow(clippy::unwrap_used)]

use kempe_model::{Leaf, Model, Nature, Registry};

const FILE: &str = r#"
[links]
frame   = { A = [0, 0], D = [1, 0], E = [0, 0], F = [0, 1] }
crank   = { A-B = 0.3 }
coupler = { B-C = 0.9, P = [0.1, 0.1] }
rocker  = { D-C = 0.7 }
rod     = { B-Q = 1 }
piston  = { Q = [0, 0] }
arm     = { A-K = 1 }
[joints]
bore = { slider = "piston", at = "Q", on = "E -> F" }
[drives]
motor = { turns = "crank", speed = 1 }
lift  = { cylinder = "D-K", from = 1, to = 2, speed = 1 }
[springs]
return = { between = "A-C", stiffness = 100, free = 1 }
[dampers]
oil = { between = "A-C", damping = 10 }
[loads]
hook = { force = [0, -1], at = "P" }
[cylinders]
lift = { bore = 0.08, rod = 0.04, supply = "180 bar", oil = { bulk_modulus = "14000 bar", volume = ["1 L", "1 L"], valve = 1, flow = "1 L/min", drop = "1 bar" } }
[switches]
top = { on = "y(P) <= 0.1 m" }
[measures]
"#;

fn dimension(measure: &str) -> Result<String, String> {
    let text = format!("{FILE}asked = '{measure}'\n");
    match Model::from_toml(&text, "x", &mut |_| Err(String::new())) {
        Ok(checked) => Ok(checked.model.measures[0].dimension.to_string()),
        Err(found) => Err(found.iter().map(|d| d.render_plain("x", &text)).collect()),
    }
}

#[test]
fn every_example_is_understood() {
    for entry in Registry::all() {
        if let Err(why) = dimension(entry.example) {
            panic!("{}: {why}", entry.name);
        }
    }
}

/// What a row says of its measure is what the reader makes of it.
#[test]
fn every_example_is_of_its_nature() {
    for entry in Registry::all() {
        let text = format!("{FILE}asked = '{}'\n", entry.example);
        let model = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
        let measure = model.unwrap().model.measures.remove(0);
        let leaf = measure.measure.leaves().next().unwrap();
        match entry.nature {
            Nature::Geometric(_) | Nature::InTime(_) => {
                let Leaf::Pose(pose) = leaf else {
                    panic!("{}: {leaf:?}", entry.name);
                };
                // the length of a cylinder is a distance
                let name = if entry.name == "length" {
                    "distance"
                } else {
                    entry.name
                };
                assert_eq!(pose.entry().unwrap().name, name);
            }
            Nature::Forces => assert!(matches!(leaf, Leaf::Force(_)), "{}", entry.name),
            Nature::Derivative => assert!(matches!(leaf, Leaf::Rate(..) | Leaf::Coefficient(..))),
            Nature::Inner => assert!(matches!(leaf, Leaf::Inner(_)), "{}", entry.name),
            Nature::WholeMotion => assert!(matches!(leaf, Leaf::Over(..)), "{}", entry.name),
        }
        assert_eq!(measure.needs_forces, entry.nature == Nature::Forces);
        assert_eq!(
            matches!(entry.nature, Nature::InTime(_)),
            [
                "speed",
                "acceleration",
                "angular_speed",
                "angular_acceleration",
                "path_length"
            ]
            .contains(&entry.name)
        );
    }
}

#[test]
fn every_signature_is_understood() {
    for entry in Registry::all() {
        for signature in entry.signatures() {
            let signature = signature.as_str();
            let Some((name, arguments)) = signature.trim_end_matches(')').split_once('(') else {
                assert_eq!(signature, entry.name);
                dimension(signature).unwrap();
                continue;
            };
            assert_eq!(name, entry.name);
            let arguments: Vec<&str> = arguments
                .split(", ")
                .map(|argument| match argument {
                    "link" if signature.contains("joint") => "piston",
                    "link" if name.starts_with("reaction") => "coupler",
                    "link" => "crank",
                    "other" => "rocker",
                    "slider" => "piston",
                    "joint" => "bore",
                    "drive"
                        if ["length", "stroke", "force", "capacity"].contains(&name)
                            || name.contains("pressure") =>
                    {
                        "lift"
                    }
                    "P" if name.starts_with("reaction") => "B",
                    "spring" => "return",
                    "damper" => "oil",
                    "load" => "hook",
                    "switch" => "top",
                    "drive" => "motor",
                    "measure" => "x(C)",
                    "n" => "2",
                    "value" if signature.contains("time") => "0.1 s",
                    "value" => "3 deg",
                    "P" if name == "transmission_angle" => "C",
                    "A" if name == "transmission_angle" => "B",
                    "B" if name == "transmission_angle" => "D",
                    "C" => "D",
                    points => points,
                })
                .collect();
            let call = format!("{name}({})", arguments.join(", "));
            if let Err(why) = dimension(&call) {
                panic!("{signature}: {why}");
            }
        }
    }
}

#[test]
fn dimensions_follow_the_rules() {
    for (measure, expected) in [
        ("x(P)", "length"),
        ("angle(rocker)", "angle"),
        ("rate(angle(rocker), 2)", "angular acceleration"),
        ("d(angle(rocker), motor)", "number"),
        ("rate(y(C))", "speed"),
        ("max(speed(C)) / mean(speed(C))", "number"),
        ("time_ratio(angle(rocker))", "number"),
        ("min(x(B), x(C))", "length"),
        ("lift", "length"),
        ("motor", "angle"),
        ("time", "time"),
        ("at(y(P), motor, 30)", "length"),
        (
            "torque(motor) * angular_speed(crank) - power(motor)",
            "power",
        ),
        ("reduced_mass(lift)", "mass"),
        ("reduced_mass(motor)", "moment of inertia"),
        ("reduced_load(motor)", "torque"),
        ("spring_force(return) + shaking_force", "force"),
        ("kinetic_energy + potential_energy", "torque"),
        ("pressure(lift)", "pressure"),
    ] {
        assert_eq!(dimension(measure).as_deref(), Ok(expected), "{measure}");
    }
}
