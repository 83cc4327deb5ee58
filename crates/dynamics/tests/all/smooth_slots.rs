//! Pins in slots along smooth curves against circles, virtual work and the balance of power.
#![allow(
    clippy::disallowed_methods,
    reason = "std's functions are good enough to expect a value"
)]

use crate::support::*;
use kempe_model::{ForceMeasure, Friction, FrictionAt, JointRef, Measure, Model};

/// Force that holds the bolt back, N.
const PULL: f64 = 40.0;

/// A plate with a groove through points at these radii, evenly around a place beside its pivot, draws a bolt.
fn latch(offset: f64, radii: &[f64]) -> Model {
    let count = radii.len();
    let points: String = (radii.iter().enumerate())
        .map(|(k, radius)| {
            let angle = (k as f64 + 0.3) * std::f64::consts::TAU / count as f64;
            let (x, y) = (offset + radius * angle.cos(), radius * angle.sin());
            format!(", P{k} = [{x:e}, {y:e}]")
        })
        .collect();
    let names: Vec<String> = (0..count).map(|k| format!("P{k}")).collect();
    let text = format!(
        r#"
[links]
frame = {{ O = [0, 0], G = [-1, 0], E = [1, 0] }}
plate = {{ O = [0, 0]{points} }}
bolt  = {{ P = [0, 0] }}
[joints]
cam   = {{ pin = "P", through = {names:?}, closed = true }}
guide = {{ slider = "bolt", at = "P", on = "G -> E" }}
[drives]
handle = {{ turns = "plate", from = 0, to = "360 deg", speed = "1 rad/s" }}
[assembly]
P = {{ near = [{}, 0] }}
[measures]
x    = "x(P)"
rate = "d(x(P), handle)"
gain = "d(x(P), handle, 2)"
"#,
        offset + radii[0]
    );
    let mut model = model(&text);
    no_gravity(&mut model);
    let push = force("push", on(&model, "bolt", "P"), [-PULL, 0.0]);
    model.actions.loads.push(push);
    model
}

fn asked(model: &Model) -> Vec<Measure> {
    let reaction = JointRef::Joint(joint(model, "cam"), None);
    let mut asked: Vec<Measure> = model.measures.iter().map(|m| m.measure.clone()).collect();
    asked.extend([drive(), ask(ForceMeasure::Reaction(reaction))]);
    asked
}

/// Places of the drive between points and at knots.
const AT: [f64; 8] = [0.0, 0.4, 1.3, 2.2, 3.1, 4.5, 5.2, 6.2];

/// Through points of a circle the groove comes near the circle with the fourth power of their distance, its normal force
/// with what its second derivative does, the second.
#[test]
fn through_points_of_a_circle_it_comes_to_a_curved_slot_on_an_arc() {
    const OFFSET: f64 = 0.012;
    const RADIUS: f64 = 0.03;
    let errors = |count: usize| {
        let model = latch(OFFSET, &vec![RADIUS; count]);
        let mut worst = [0.0_f64; 4];
        for (q, row) in AT.iter().zip(values(&model, &asked(&model), &AT)) {
            let (s, c) = q.sin_cos();
            let root = (RADIUS * RADIUS - (OFFSET * s).powi(2)).sqrt();
            let rate = -OFFSET * s - OFFSET * OFFSET * s * c / root;
            let curl = OFFSET * OFFSET * (c * c - s * s) / root
                + OFFSET.powi(4) * (s * c).powi(2) / root.powi(3);
            let wanted = [
                OFFSET * c + root,
                rate,
                -OFFSET * c - curl,
                PULL * RADIUS / root,
            ];
            for (k, column) in [0, 1, 2, 4].into_iter().enumerate() {
                worst[k] =
                    worst[k].max(((row[column] - wanted[k]) / wanted[k].abs().max(RADIUS)).abs());
            }
        }
        worst
    };
    let (coarse, fine) = (errors(12), errors(48));
    for (k, order) in [4, 3, 2, 3].into_iter().enumerate() {
        let gained = coarse[k] / fine[k];
        let wanted = 4.0_f64.powi(order);
        assert!(
            gained > 0.5 * wanted && coarse[k] < 0.05,
            "{k}: {coarse:?} {fine:?}"
        );
    }
}

const RADII: [f64; 9] = [0.03, 0.032, 0.036, 0.033, 0.028, 0.027, 0.031, 0.034, 0.033];

/// Without friction the groove pushes the pin along its normal and does no work: all that the handle gives, the bolt takes.
#[test]
fn without_friction_the_load_does_no_work() {
    let model = latch(0.004, &RADII);
    for row in values(&model, &asked(&model), &AT) {
        let [x, rate, _, torque, reaction] = row[..] else {
            panic!("{row:?}")
        };
        close("torque", torque, PULL * rate, 1e-12);
        // In the plate the pin moves by (rate, -x) a radian: the force across that has PULL along the guide.
        let along = (x * x + rate * rate).sqrt();
        close("reaction", reaction, PULL * along / x, 1e-10);
    }
}

/// With friction the handle gives besides what the slot takes: the coefficient times the normal force along the way of the
/// pin in the plate.
#[test]
fn with_friction_the_power_balances() {
    const COEFFICIENT: f64 = 0.15;
    let mut model = latch(0.004, &RADII);
    model.actions.friction.push(Friction {
        at: FrictionAt::Joint(joint(&model, "cam")),
        coefficient: number(COEFFICIENT),
        static_coefficient: None,
        stribeck_speed: None,
        viscous: None,
        drag: None,
        radius: None,
        span: 0..0,
    });
    for row in values(&model, &asked(&model), &AT) {
        let [x, rate, _, torque, reaction] = row[..] else {
            panic!("{row:?}")
        };
        let along = (x * x + rate * rate).sqrt();
        let normal = reaction / (1.0 + COEFFICIENT * COEFFICIENT).sqrt();
        let taken = COEFFICIENT * normal * along;
        close("torque", torque, PULL * rate + taken, 1e-10);
        assert!(taken > 0.1, "{taken}");
    }
}
