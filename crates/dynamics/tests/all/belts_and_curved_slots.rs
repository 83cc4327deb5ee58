//! Belts and pins in curved slots against closed forms and against the linkages that move alike.
#![allow(
    clippy::disallowed_methods,
    reason = "std's functions are good enough to expect a value"
)]

use crate::support::*;
use kempe_model::{
    DriveId, ForceMeasure, Friction, FrictionAt, JointRef, Load, LoadKind, Measure, Model,
};

fn measures(model: &Model) -> Vec<Measure> {
    model.measures.iter().map(|m| m.measure.clone()).collect()
}

fn reaction(model: &Model, name: &str) -> Measure {
    let joint = JointRef::Joint(joint(model, name), None);
    ask(ForceMeasure::Reaction(joint))
}

const OFFSET: f64 = 0.012;
const RADIUS: f64 = 0.03;

fn latch() -> Model {
    let text = r#"
[links]
frame = { O = [0, 0], G = [-1, 0], E = [1, 0] }
plate = { O = [0, 0], A = [0.012, 0.03], B = [0.012, -0.03] }
bolt  = { P = [0, 0] }
[joints]
cam   = { pin = "P", arc = "A -> B", radius = 0.03, closed = true }
guide = { slider = "bolt", at = "P", on = "G -> E" }
[drives]
handle = { turns = "plate", from = 0, to = "300 deg", speed = "1 rad/s" }
[assembly]
P = { near = [0.042, 0] }
[measures]
x    = "x(P)"
rate = "d(x(P), handle)"
snap = "d(x(P), handle, 2)"
"#;
    let mut model = model(text);
    no_gravity(&mut model);
    let push = force("push", on(&model, "bolt", "P"), [-40.0, 0.0]);
    model.actions.loads.push(push);
    model
}

/// An eccentric circle, open as a semicircle of that diameter: the bolt goes as the slider of a crank.
#[test]
fn an_eccentric_circular_slot_is_a_slider_crank() {
    let model = latch();
    let mut asked = measures(&model);
    asked.extend([drive(), reaction(&model, "cam")]);
    let at = [0.0, 0.4, 1.3, 2.2, 3.1, 4.5, 5.2];
    for (q, row) in at.iter().zip(values(&model, &asked, &at)) {
        let (s, c) = f64::sin_cos(*q);
        let root = (RADIUS * RADIUS - (OFFSET * s).powi(2)).sqrt();
        let rate = -OFFSET * s - OFFSET * OFFSET * s * c / root;
        let gain = OFFSET * OFFSET * (c * c - s * s) / root
            + OFFSET.powi(4) * (s * c).powi(2) / root.powi(3);
        close("x", row[0], OFFSET * c + root, 1e-15);
        close("rate", row[1], rate, 1e-14);
        close("snap", row[2], -OFFSET * c - gain, 1e-13);
        close("torque", row[3], 40.0 * rate, 1e-12);
        close("normal force", row[4], 40.0 * RADIUS / root, 1e-11);
    }
}

/// The slot rubs: its resistance is the coefficient times the normal force along the tangent.
#[test]
fn a_curved_slot_rubs() {
    let mut model = latch();
    let coefficient = 0.15;
    model.actions.friction.push(Friction {
        at: FrictionAt::Joint(joint(&model, "cam")),
        coefficient: number(coefficient),
        static_coefficient: None,
        stribeck_speed: None,
        viscous: None,
        drag: None,
        radius: None,
        span: 0..0,
    });
    let asked = [drive(), reaction(&model, "cam")];
    let at = [0.4, 1.3, 2.2];
    for (q, row) in at.iter().zip(values(&model, &asked, &at)) {
        let (s, c) = f64::sin_cos(*q);
        // The pin's place seen from the slot's centre, as a unit vector; the plate turns counter-clockwise, so the slot
        // drags the pin along its own tangent.
        let lean = [
            (1.0 - (OFFSET * s / RADIUS).powi(2)).sqrt(),
            -OFFSET * s / RADIUS,
        ];
        let drag = [-lean[1], lean[0]];
        // Along the guide the slot's normal force and friction hold 40 N.
        let normal = 40.0 / (lean[0] + coefficient * drag[0]);
        let on_pin = [0, 1].map(|k| normal * (lean[k] + coefficient * drag[k]));
        let place = [OFFSET * c + RADIUS * lean[0], 0.0];
        close(
            "torque",
            row[0],
            place[0] * on_pin[1] - place[1] * on_pin[0],
            1e-12,
        );
        close(
            "force",
            row[1],
            normal * (1.0 + coefficient * coefficient).sqrt(),
            1e-10,
        );
    }
}

/// A pin in a curved slot moves as a bar about the slot's centre, and the slot carries what the bar would.
#[test]
fn a_curved_slot_is_a_bar_about_its_centre() {
    let text = |slot: bool, side: &str, arc: &str| {
        let (rocker, joints) = if slot {
            let joint = format!(
                "track = {{ pin = \"P\", arc = \"{arc}\", radius = 0.25, side = \"{side}\" }}"
            );
            (String::new(), joint)
        } else {
            ("rocker = { D-P = 0.25 }".to_owned(), String::new())
        };
        format!(
            r#"
[links]
frame   = {{ O = [0, 0], D = [0.3, 0], L = [0.1, 0.15], R = [0.5, 0.15] }}
crank   = {{ O-C = 0.1 }}
coupler = {{ C-P = 0.28, Q = [0.1, 0.05] }}
{rocker}
[joints]
{joints}
[drives]
motor = {{ turns = "crank", from = 0, to = "360 deg", speed = "2 rad/s" }}
[assembly]
P = {{ near = [0.36, 0.24] }}
[measures]
x = "x(P)"
a = "angle(coupler)"
w = "d(angle(coupler), motor)"
e = "d(x(P), motor, 2)"
"#
        )
    };
    let loaded = |text: String| {
        let mut model = model(&text);
        no_gravity(&mut model);
        let pull = force("pull", on(&model, "coupler", "Q"), [7.0, -11.0]);
        model.actions.loads.push(pull);
        model
    };
    let bar = loaded(text(false, "", ""));
    let mut asked = measures(&bar);
    asked.extend([drive(), pin(&bar, "P")]);
    let at = [0.0, 0.7, 1.9, 3.3, 4.4, 6.0];
    let wanted = values(&bar, &asked, &at);
    // The centre D lies on the left of the way from R to L, on the right of that from L to R.
    for (side, arc) in [("left", "R -> L"), ("right", "L -> R")] {
        let slot = loaded(text(true, side, arc));
        let mut asked = measures(&slot);
        asked.extend([drive(), reaction(&slot, "track")]);
        for (found, wanted) in values(&slot, &asked, &at).iter().zip(&wanted) {
            for (found, wanted) in found.iter().zip(wanted) {
                close(side, *found, *wanted, 1e-11);
            }
        }
    }
}

fn wheels(belt: &str) -> Model {
    let text = format!(
        r#"
[links]
frame = {{ A = [0, 0], B = [0.5, 0] }}
small = {{ A = [0, 0], M = [0.03, 0] }}
large = {{ B = [0, 0], N = [0.1, 0] }}
[joints]
belt = {{ belt = ["small", "large"], {belt} }}
[drives]
motor = {{ turns = "small", from = 0, to = "900 deg", speed = "3 rad/s" }}
[measures]
turned = "angle(large)"
"#
    );
    let mut model = model(&text);
    no_gravity(&mut model);
    let brake = Load {
        name: "brake".into(),
        kind: LoadKind::Torque {
            on: link(&model, "large"),
            against: kempe_model::FRAME,
            amount: amount(-3.0),
        },
        span: 0..0,
    };
    model.actions.loads.push(brake);
    model
}

/// Ratio, torque and what the pins carry: the pull of 20 N at the rims leans by the runs' lean.
#[test]
fn a_belt_carries_the_difference_of_its_tensions() {
    for (belt, ratio, lean) in [
        ("radii = [0.05, 0.15]", 1.0 / 3.0, 0.2),
        ("radii = [0.05, 0.15], crossed = true", -1.0 / 3.0, 0.4),
        (
            "teeth = [20, 60], pitch = \"5 mm\"",
            1.0 / 3.0,
            40.0 * 0.005 / (2.0 * std::f64::consts::PI) / 0.5,
        ),
    ] {
        let model = wheels(belt);
        let mut asked = measures(&model);
        asked.push(drive());
        asked.extend(pin_on(&model, "A", "small"));
        asked.extend(pin_on(&model, "B", "large"));
        let on = |name: &str| JointRef::Joint(joint(&model, "belt"), Some(link(&model, name)));
        asked.push(ask(ForceMeasure::ReactionMoment(on("large"))));
        asked.push(ask(ForceMeasure::ReactionMoment(on("small"))));
        let at = [0.0, 1.0, 9.0];
        for (q, row) in at.iter().zip(values(&model, &asked, &at)) {
            close("turned", row[0], q * ratio, 1e-13);
            close("torque", row[1], 3.0 * ratio, 1e-12);
            close("moment", row[6], 3.0, 1e-12);
            close("moment", row[7], -3.0 * ratio, 1e-12);
            let radius = if belt.starts_with("radii") {
                0.15
            } else {
                60.0 * 0.005 / (2.0 * std::f64::consts::PI)
            };
            let across = 3.0 / radius * lean;
            close("along A", row[2], 0.0, 1e-12);
            close("along B", row[4], 0.0, 1e-12);
            close("across A", row[3].abs(), across, 1e-11);
            close("across both", row[3] + row[5], 0.0, 1e-11);
        }
    }
}

/// On a moving arm a belt turns the far wheel against the arm: with equal wheels it keeps its direction.
#[test]
fn a_belt_goes_with_its_arm() {
    for (radii, crossed) in [
        ([0.1, 0.1], false),
        ([0.06, 0.15], false),
        ([0.1, 0.05], true),
    ] {
        let text = format!(
            r#"
[links]
frame = {{ A = [0, 0] }}
arm   = {{ A-B = 0.5 }}
near  = {{ A = [0, 0], M = [0.03, 0] }}
far   = {{ B = [0, 0], N = [0.1, 0] }}
[joints]
belt = {{ belt = ["near", "far"], arm = "arm", radii = [{}, {}], crossed = {crossed} }}
[drives]
lift = {{ turns = "arm", from = 0, to = "200 deg", speed = "1 rad/s" }}
hold = {{ turns = "near", at = "0.3 rad" }}
[measures]
turned = "angle(far)"
"#,
            radii[0], radii[1]
        );
        let mut model = model(&text);
        no_gravity(&mut model);
        let weight = force("weight", on(&model, "far", "N"), [0.0, -10.0]);
        model.actions.loads.push(weight);
        let mut asked = measures(&model);
        asked.extend([0, 1].map(|d| ask(ForceMeasure::Drive(DriveId(d)))));
        let at = [0.0, 0.8, 3.0];
        for (q, row) in at.iter().zip(values(&model, &asked, &at)) {
            let ratio = radii[0] / radii[1] * if crossed { -1.0 } else { 1.0 };
            let far = q + (0.3 - q) * ratio;
            close("turned", row[0], far, 1e-13);
            // Virtual work of the weight for each drive.
            close(
                "lift",
                row[1],
                10.0 * (0.5 * q.cos() + 0.1 * far.cos() * (1.0 - ratio)),
                1e-12,
            );
            close("hold", row[2], 10.0 * 0.1 * far.cos() * ratio, 1e-12);
        }
    }
}
