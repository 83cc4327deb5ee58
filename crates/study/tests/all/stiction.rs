//! Friction that holds at joints with play, as a user runs it.
#![allow(clippy::unwrap_used)]

use crate::told::column;
use kempe_model::Model;
use kempe_study::{Silent, StudyResult, run};

fn read(text: &str) -> Result<Model, Vec<&'static str>> {
    let codes = |found: Vec<kempe_model::Diagnostic>| found.iter().map(|d| d.code).collect();
    let read = Model::from_toml(text, "stiction", &mut |_| Err("no files".into()));
    match read {
        Ok(read) if read.warnings.is_empty() => Ok(read.model),
        Ok(read) => Err(codes(read.warnings)),
        Err(errors) => Err(codes(errors)),
    }
}

fn result(text: &str) -> StudyResult {
    let model = read(text).unwrap();
    run(&model, &model.studies[0], &mut Silent).unwrap()
}

/// Energy and power balance, whatever is held, and nothing is to be said.
fn is_sound(result: &StudyResult) {
    let balance = result.table.balance.as_ref().unwrap();
    let worst = |column: &[f64]| column.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(
        worst(&balance.energy) < 1e-9,
        "{:e}",
        worst(&balance.energy)
    );
    assert!(worst(&balance.power) < 1e-6, "{:e}", worst(&balance.power));
    let codes: Vec<_> = result.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(codes, [""; 0]);
}

/// How often friction is told to hold.
fn holds(result: &StudyResult) -> usize {
    let happened = result
        .listings
        .iter()
        .find(|it| it.title == "What happened");
    let rows = happened.iter().flat_map(|it| &it.rows);
    rows.filter(|row| row[1].starts_with("friction holds"))
        .count()
}

/// A block that falls on a guide of 20 degrees, springy and damped.
fn incline(coefficient: f64) -> String {
    format!(
        r#"
units = {{ length = "mm" }}
gravity = ["3.3552 m/s^2", "-9.2184 m/s^2"]
[links]
frame = {{ O = [0, 0], X = [1000, 0] }}
block = {{ C = [0, 0], mass = 1, inertia = "500 kg mm^2" }}
[joints]
way = {{ slider = "block", at = "C", on = "O -> X" }}
[drives]
travel = {{ slides = "way", at = 100 }}
[clearance]
all = {{ radial = 0.1, friction = {coefficient}, stiction = true }}
way = {{ radial = 0.1, length = 40, height = 20, spring = "1e6 N/m", damping = "600 N s/m" }}
[studies.s]
kind = "clearance"
model = "two-state"
release = ["travel"]
until = "100 ms"
rows = 21
columns = ["x(C)", "rate(x(C))", "acceleration(C)"]
"#
    )
}

/// Where the coefficient is below the slope it slides, faster by `g (sin - mu cos)` all the time once it has settled; where it is above, it lies
/// still on both of its corners.
#[test]
fn a_block_slides_down_or_lies_still() {
    for coefficient in [0.2_f64, 0.36] {
        let found = result(&incline(coefficient));
        is_sound(&found);
        let known = 3355.2 - coefficient * 9218.4;
        let last = *column(&found, "acceleration(C)").last().unwrap();
        assert!(
            (last / known - 1.0).abs() < 1e-8,
            "{last} mm/s^2 for {known}"
        );
    }
    let found = result(&incline(0.5));
    is_sound(&found);
    assert!(holds(&found) > 0);
    let (place, speed) = (column(&found, "x(C)"), column(&found, "rate(x(C))"));
    assert!(place[0] < place[10] && (place[20] - place[19]).abs() < 1e-10);
    assert!(speed[20].abs() < 1e-8, "{} mm/s", speed[20]);
}

/// The slider-crank of the benchmark, with more friction.
fn slider_crank(onset: &str) -> String {
    format!(
        r#"
units = {{ length = "m", angle = "rad" }}
gravity = [0, 0]
[links]
frame  = {{ O = [0, 0], X = [1, 0] }}
slider = {{ C = [0, 0], mass = 0.14, inertia = 0 }}
crank  = {{ O-B = 0.05 }}
rod    = {{ B-C = 0.12, mass = 0.21, inertia = 0.00025, center = [0.06, 0] }}
[joints]
guide = {{ slider = "slider", at = "C", on = "O -> X" }}
[clearance]
C = {{ radial = "0.5 mm", radius = "9.5 mm", law = "lankarani-nikravesh", restitution = 0.9, friction = 0.3, {onset} }}
[drives]
motor = {{ turns = "crank", from = 0, to = "720 deg", speed = "5000 rpm" }}
[assembly]
C = {{ near = [0.17, 0] }}
[studies.rattle]
kind    = "clearance"
model   = "three-state"
until   = "0.8 ms"
rows    = 9
columns = ["x(C)"]
"#
    )
}

/// Friction that sets in at once is what remains where it sets in over less and less: contacts come ten times as near where the sliding
/// speeds are ten times less.
#[test]
fn what_sticks_is_the_limit_of_what_creeps() {
    let sticks = result(&slider_crank("stiction = true"));
    is_sound(&sticks);
    assert!(holds(&sticks) >= 1);
    let apart = |speeds: &str| {
        let creeps = result(&slider_crank(&format!("friction_speeds = {speeds}")));
        let pairs = creeps.contacts.iter().zip(&sticks.contacts);
        let apart: Vec<f64> = pairs.map(|(a, b)| (a.time - b.time).abs()).collect();
        assert_eq!(apart.len(), 3);
        apart
    };
    let (far, near) = (
        apart("[\"0.1 mm/s\", \"1 mm/s\"]"),
        apart("[\"0.01 mm/s\", \"0.1 mm/s\"]"),
    );
    assert!(far[1] > 1e-8 && far[1] < 1e-6, "{far:?}");
    for (far, near) in far.iter().zip(&near).filter(|(far, _)| **far > 1e-8) {
        assert!((near / far - 0.1).abs() < 0.03, "{far:e} {near:e}");
    }
}

/// A bob whose bore of radius 25 mm hangs on a pin of 20 mm.
const BOB: &str = r#"
units = { length = "m", angle = "rad" }
[links]
frame = { O = [0, 0] }
bob   = { O-P = 0.2, mass = 1, inertia = 0.01, center = "P" }
[drives]
swing = { turns = "bob", at = "-1.5 rad" }
[clearance]
O = { radial = "5 mm", radius = "20 mm", spring = "1e6 N/m", damping = "1000 N s/m", friction = MU, stiction = true }
[studies.s]
kind = "clearance"
model = "two-state"
release = ["swing"]
start = { O = ["5 mm", "-90 deg"] }
until = "1.3 s"
step = "2 ms"
columns = ["swing"]
"#;

/// Held by friction, a bore rolls on its pin: its centre turns about the pin's by `R / c` of the angle of the bob, and small swings are as
/// fast as energy has it, `w^2 = m g (R^2 / c + L) / (m (R + L)^2 + I)`. Without friction the bob swings as its centre falls and rises.
#[test]
fn a_bore_rolls_on_its_pin() {
    let rolls = result(&BOB.replace("MU", "0.8"));
    is_sound(&rolls);
    let (bore, play, length, mass, inertia) = (0.025_f64, 0.005, 0.2, 1.0, 0.01);
    let square = mass * 9.81 * (bore * bore / play + length)
        / (mass * (bore + length) * (bore + length) + inertia);
    let known = std::f64::consts::TAU / square.sqrt();
    let (time, angle) = (column(&rolls, "time"), column(&rolls, "swing"));
    let middle = -0.5 * std::f64::consts::PI;
    let passes: Vec<f64> = (1..angle.len())
        .filter(|k| angle[k - 1] > middle && angle[*k] <= middle)
        .map(|k| {
            let part = (angle[k - 1] - middle) / (angle[k - 1] - angle[k]);
            time[k - 1] + part * (time[k] - time[k - 1])
        })
        .collect();
    assert!(passes.len() >= 2);
    let turns = (passes.len() - 1) as f64;
    let period = (passes[passes.len() - 1] - passes[0]) / turns;
    assert!(
        (period / known - 1.0).abs() < 5e-3,
        "{period} s for {known} s"
    );
}

/// What starts pressed on its bore, where nothing presses yet, slips at once where friction is little, in the sense that shows as soon as it does.
#[test]
fn a_greased_bore_slips_from_the_start() {
    for coefficient in ["0.02", "0.1"] {
        let slips = result(
            &BOB.replace("MU", coefficient)
                .replace("-1.5 rad", "-1.3 rad")
                .replace("1.3 s", "0.2 s"),
        );
        is_sound(&slips);
        let happened = slips.listings.iter().find(|it| it.title == "What happened");
        assert_eq!(happened.unwrap().rows[1][1], "friction lets pin O go");
    }
}

#[test]
fn how_friction_sets_in_is_said_once() {
    let both = slider_crank("stiction = true, friction_speeds = [\"1 mm/s\", \"2 mm/s\"]");
    assert_eq!(read(&both).unwrap_err(), ["contradictory-values"]);
    let idle = slider_crank("stiction = true").replace("friction = 0.3, ", "");
    assert_eq!(read(&idle).unwrap_err(), ["idle-key"]);
    // What one joint says goes before what all do.
    let text = incline(0.5).replace(
        "damping = \"600 N s/m\"",
        "damping = \"600 N s/m\", stiction = false",
    );
    assert_eq!(holds(&result(&text)), 0);
    for text in [slider_crank("stiction = true"), text] {
        let model = read(&text).unwrap();
        let again = read(&model.to_toml().toml).unwrap();
        assert_eq!(model.clearances.len(), again.clearances.len());
        for (one, other) in model.clearances.iter().zip(&again.clearances) {
            assert_eq!(one.contact, other.contact);
        }
    }
}
