//! Teeth that push their wheels apart and rub, against formulas of gears and balances by hand.
#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use crate::support::*;
use kempe_dynamics::{ForceNote, ForceSample};
use kempe_model::{ForceMeasure, JointRef, Measure, Model};
use kempe_number::math;

const ALPHA: f64 = 20.0 * PI / 180.0;

/// A wheel (teeth, radius) of a mesh; both negative for a ring.
#[derive(Clone, Copy)]
struct Wheel {
    teeth: f64,
    radius: f64,
}

/// The tooth loss factor, its parts of the contact ratio by where the circles of tips cross the pressure line, or where the
/// other's involutes begin.
fn loss_factor(a: Wheel, b: Wheel) -> f64 {
    let module = 2.0 * a.radius / a.teeth;
    let reach = |w: Wheel, other: Wheel| {
        let (tip, base) = (w.radius + module, w.radius * math::cos(ALPHA));
        let along = f64::sqrt(tip * tip - base * base) - w.radius.abs() * math::sin(ALPHA);
        let begins = match other.radius > 0.0 {
            true => other.radius * math::sin(ALPHA),
            false => f64::INFINITY,
        };
        along.abs().min(begins) / (PI * module * math::cos(ALPHA))
    };
    let (e1, e2) = (reach(a, b), reach(b, a));
    PI * (1.0 / a.teeth + 1.0 / b.teeth) * (1.0 - e1 - e2 + e1 * e1 + e2 * e2)
}

/// Efficiency of a mesh whose first wheel drives, its axes at rest: of `F r_1 + M` comes `F r_2 - M`, with `M` the moment by
/// which a power `F v` loses `mu H F v`.
fn efficiency(mu: f64, driver: Wheel, driven: Wheel) -> f64 {
    let loss = mu * loss_factor(driver, driven);
    let arm = loss / (1.0 / driver.radius + 1.0 / driven.radius);
    (1.0 - arm / driven.radius) / (1.0 + arm / driver.radius)
}

fn reaction(model: &Model, name: &str, on: &str) -> [Measure; 2] {
    let at = JointRef::Joint(joint(model, name), Some(link(model, on)));
    [ForceMeasure::ReactionX, ForceMeasure::ReactionY].map(|of| ask(of(at)))
}

/// Wheels `a` at the origin and `b` on the x axis, on the frame; `load` turns `b`.
fn pair(more: &str, teeth: &str, speed: f64, load: f64, mu: f64) -> Model {
    model(&format!(
        r#"
units = {{ length = "m", angle = "rad" }}
[links]
frame = {{ A = [0, 0], B = [0.3, 0] }}
a = {{ A = [0, 0] }}
b = {{ B = [0, 0] }}
[joints]
mesh = {{ gears = ["a", "b"], teeth = {teeth}, pressure_angle = "20 deg"{more} }}
[drives]
motor = {{ turns = "a", from = 0, to = "{speed} rad", speed = "{speed} rad/s" }}
[loads]
brake = {{ torque = "{load} N m", on = "b" }}
[friction]
mesh = {{ coefficient = {mu} }}
"#
    ))
}

/// The whole force of the teeth on `a`, those of the pins, and the motor's torque, while the motor turns this way.
fn forces_on_axes(model: &Model, way: f64) -> Vec<f64> {
    let mut measures = reaction(model, "mesh", "a").to_vec();
    measures.extend(pin_on(model, "A", "a"));
    measures.extend(pin_on(model, "B", "b"));
    measures.push(drive());
    values(model, &measures, &[0.3 * way]).remove(0)
}

/// Two wheels are pushed apart, a wheel in a ring to the ring's axis, whichever flank carries.
#[test]
fn the_pressure_angle_parts_the_axes() {
    let tangent = math::tan(ALPHA);
    // Which way `a` is pushed along x, and the way the force across it goes for a load that turns `b` forwards.
    for (more, teeth, radius_a, off) in [
        ("", "[20, 40]", 0.1, -1.0),
        (", internal = true", "[20, 80]", 0.1, 1.0),
        (", internal = true", "[80, 20]", 0.4, 1.0),
    ] {
        for load in [12.0, -12.0] {
            let model = pair(more, teeth, 1.0, load, 0.0);
            let found = forces_on_axes(&model, 1.0);
            let ratio = if more.is_empty() { -1.0 } else { 1.0 };
            let radius_b = if teeth == "[20, 40]" {
                0.2
            } else {
                0.5 - radius_a
            };
            let torque = -load * ratio * radius_a / radius_b;
            close("motor", found[6], torque, 1e-12);
            // The motor and the teeth on `a` balance; the pitch point lies at x = radius (or at -radius inside a ring).
            let x = if teeth == "[20, 80]" {
                -radius_a
            } else {
                radius_a
            };
            let along = -torque / x;
            close("teeth along", found[1], along, 1e-10);
            close("teeth apart", found[0], off * tangent * along.abs(), 1e-10);
            for k in 0..2 {
                close("pin of a", found[2 + k], -found[k], 1e-10);
                close("pin of b", found[4 + k], found[k], 1e-10);
            }
        }
    }
}

/// Without a pressure angle nothing changes, and with one the drive does not either.
#[test]
fn what_parts_the_axes_takes_no_power() {
    let with = pair("", "[20, 40]", 1.0, 12.0, 0.0);
    let mut without = with.clone();
    without.actions.friction.clear();
    if let kempe_model::JointKind::Gears { teeth, .. } = &mut without.joints[0].kind {
        teeth.pressure_angle = None;
    }
    let (with, without) = (forces_on_axes(&with, 1.0), forces_on_axes(&without, 1.0));
    assert_eq!(without[0], 0.0);
    for k in [1, 3, 5, 6] {
        close("along", with[k], without[k], 1e-12);
    }
}

#[test]
fn a_pair_has_its_efficiency() {
    let mu = 0.06;
    let small = Wheel {
        teeth: 20.0,
        radius: 0.1,
    };
    let large = Wheel {
        teeth: 40.0,
        radius: 0.2,
    };
    for (speed, load, driver, driven) in [
        (1.0, 12.0, small, large),
        (-1.0, -12.0, small, large),
        // The load drives: the motor holds back what comes through the mesh.
        (1.0, -12.0, large, small),
    ] {
        let model = pair("", "[20, 40]", speed, load, mu);
        let torque = forces_on_axes(&model, speed)[6];
        let eta = efficiency(mu, driver, driven);
        let expected = match driver.teeth == 20.0 {
            true => load / 2.0 / eta,
            false => load / 2.0 * eta,
        };
        close("motor", torque, expected, 1e-6);
        // The loss factor is that of the formula.
        let lost = 1.0 - eta;
        close("loss", lost, mu * loss_factor(small, large), 2e-4);
        assert!((0.008..0.012).contains(&lost), "{lost}");
    }
}

/// A rack pushed by its pinion, by hand: `F r + mu F e / cos(alpha)` at the pinion, `F` at the rack; it is pushed off.
#[test]
fn a_rack_is_pushed_off_and_rubs() {
    for (side, up) in [("left", 1.0), ("right", -1.0)] {
        for push in [500.0_f64, -500.0] {
            let model = model(&format!(
                r#"
units = {{ length = "m", angle = "rad" }}
[links]
frame = {{ O = [0, 0], G = [0, {g}], K = [1, {g}] }}
pinion = {{ O = [0, 0] }}
bar = {{ R = [0, 0], W = [1, 0] }}
[joints]
way = {{ slider = "bar", at = "R", on = "G -> K" }}
mesh = {{ rack = "bar", pinion = "pinion", radius = 0.04, side = "{side}", pressure_angle = "20 deg", module = 0.004 }}
[drives]
motor = {{ turns = "pinion", from = 0, to = 1, speed = "1 rad/s" }}
[loads]
push = {{ force = [{push}, 0], at = "R", on = "bar" }}
[friction]
mesh = {{ coefficient = 0.1 }}
"#,
                g = -0.04 * up
            ));
            let mut measures = vec![drive()];
            measures.extend(reaction(&model, "mesh", "pinion"));
            measures.extend(reaction(&model, "way", "bar"));
            let row = &values(&model, &measures, &[0.2])[0];
            // Of the tooth's tips a rack's reach 1 / (pi sin cos), the pinion's by its circle.
            let pinion = Wheel {
                teeth: 20.0,
                radius: 0.04,
            };
            let rack = Wheel {
                teeth: 2e7,
                radius: 4e4,
            };
            let arm = 0.1 * loss_factor(pinion, rack) / (1.0 / pinion.radius);
            // The bar goes with the pinion's lower side, towards +x for a rack below it.
            let way = up;
            close("motor", row[0], -push * way * 0.04 + push.abs() * arm, 1e-4);
            close("teeth along", row[1], push, 1e-9);
            close(
                "teeth apart",
                row[2],
                up * push.abs() * math::tan(ALPHA),
                1e-9,
            );
            // The rack is pushed the other way, and its guide holds it.
            close("guide", row[4], up * push.abs() * math::tan(ALPHA), 1e-9);
        }
    }
}

const SUN: Wheel = Wheel {
    teeth: 24.0,
    radius: 24.0,
};
const PLANET: Wheel = Wheel {
    teeth: 18.0,
    radius: 18.0,
};
const RING: Wheel = Wheel {
    teeth: -60.0,
    radius: -60.0,
};

fn planetary(speed: f64, load: f64, mu: f64) -> Model {
    model(&format!(
        r#"
units = {{ length = "m", angle = "rad" }}
[links]
frame = {{ O = [0, 0] }}
sun = {{ O = [0, 0] }}
carrier = {{ O-C = 0.042 }}
planet = {{ C = [0, 0] }}
[joints]
inner = {{ gears = ["sun", "planet"], arm = "carrier", teeth = [24, 18], pressure_angle = "20 deg" }}
outer = {{ gears = ["frame", "planet"], arm = "carrier", teeth = [60, 18], internal = true, pressure_angle = "20 deg" }}
[drives]
motor = {{ turns = "sun", from = 0, to = {speed}, speed = {speed} }}
[loads]
work = {{ torque = "{load} N m", on = "carrier" }}
[friction]
inner = {{ coefficient = {mu} }}
outer = {{ coefficient = {mu} }}
"#
    ))
}

/// The efficiencies of a planetary set, `(1 - i_0 eta_0) / (1 - i_0)` and `(1 - i_0) / (1 - i_0 / eta_0)` (VDI 2157), with the
/// standing efficiency `eta_0` for each way that power rolls through.
#[test]
fn a_planetary_set_has_its_efficiencies() {
    let mu = 0.1;
    let standing = -60.0 / 24.0;
    let turns = 1.0 / (1.0 - standing);
    // The sun drives the carrier.
    let outward = efficiency(mu, SUN, PLANET) * efficiency(mu, PLANET, RING);
    let eta = (1.0 - standing * outward) / (1.0 - standing);
    let torque = values(&planetary(1.0, -100.0, mu), &[drive()], &[0.3])[0][0];
    close("sun drives", torque, 100.0 * turns / eta, 1e-9);
    assert!((0.95..0.995).contains(&eta), "{eta}");
    // The carrier drives the sun.
    let inward = efficiency(mu, RING, PLANET) * efficiency(mu, PLANET, SUN);
    let eta = (1.0 - standing) / (1.0 - standing / inward);
    let torque = values(&planetary(-1.0, -100.0, mu), &[drive()], &[-0.3])[0][0];
    close("carrier drives", torque, 100.0 * turns * eta, 1e-9);
}

/// Gears that turn as one block with their arm lose nothing, though they carry.
#[test]
fn a_block_loses_nothing() {
    let text = r#"
units = { length = "m", angle = "rad" }
[links]
frame = { O = [0, 0] }
arm = { O-C = 0.3 }
sun = { O = [0, 0] }
planet = { C = [0, 0] }
[joints]
mesh = { gears = ["sun", "planet"], arm = "arm", teeth = [20, 40], pressure_angle = "20 deg" }
[drives]
one = { turns = "arm", from = 0, to = 1, speed = 1 }
two = { turns = "sun", from = 0, to = 1, speed = 1 }
[loads]
work = { torque = "8 N m", on = "planet" }
[friction]
mesh = { coefficient = 0.3 }
"#;
    let rubbing = model(text);
    let mut smooth = rubbing.clone();
    smooth.actions.friction.clear();
    let measures = [0, 1].map(|d| ask(ForceMeasure::Drive(kempe_model::DriveId(d))));
    let (a, b) = (
        rows(&rubbing, &measures, &[0.4]),
        rows(&smooth, &measures, &[0.4]),
    );
    assert_eq!(a[0].sample.values, b[0].sample.values);
    assert_eq!(a[0].evidence.unwrap().friction_power, 0.0);
    assert!(a[0].sample.values[1].abs() > 3.0);
}

/// Two rings over the same planets, the first one standing.
fn wolfrom(rings: [u32; 2], speed: f64, mu: f64) -> Model {
    model(&format!(
        r#"
units = {{ length = "m", angle = "rad" }}
[links]
frame = {{ O = [0, 0] }}
sun = {{ O = [0, 0] }}
carrier = {{ O-C = 0.06 }}
planet = {{ C = [0, 0] }}
drum = {{ O = [0, 0] }}
[joints]
inner = {{ gears = ["sun", "planet"], arm = "carrier", teeth = [40, 20], pressure_angle = "20 deg" }}
fixed = {{ gears = ["planet", "frame"], arm = "carrier", teeth = [20, {}], internal = true, pressure_angle = "20 deg" }}
outer = {{ gears = ["planet", "drum"], arm = "carrier", teeth = [20, {}], internal = true, pressure_angle = "20 deg" }}
[drives]
motor = {{ turns = "sun", from = 0, to = {speed}, speed = {speed} }}
[loads]
weight = {{ torque = "-400 N m", on = "drum" }}
[friction]
inner = {{ coefficient = {mu} }}
fixed = {{ coefficient = {mu} }}
outer = {{ coefficient = {mu} }}
"#,
        rings[0], rings[1]
    ))
}

/// The torque of the sun by the balance of the planet, seen from the carrier: each wheel gives it its torque by the ratio of
/// its mesh, times or over the efficiency of it, whichever way power goes there; all three together carry no torque.
fn sun_of_wolfrom(rings: [u32; 2], speed: f64, mu: f64) -> f64 {
    let z = |teeth: f64| {
        // All of one distance of axes: radii by teeth.
        let size = if teeth > 0.0 {
            teeth + 20.0
        } else {
            -teeth - 20.0
        };
        Wheel {
            teeth,
            radius: teeth / size,
        }
    };
    let planet = |of: f64| Wheel {
        teeth: 20.0,
        radius: 20.0 / if of > 0.0 { of + 20.0 } else { -of - 20.0 },
    };
    let wheels = [40.0, -f64::from(rings[0]), -f64::from(rings[1])];
    // Speeds against the carrier.
    let carrier = speed / (1.0 + f64::from(rings[0]) / 40.0);
    let turning = -carrier * f64::from(rings[0]) / 20.0;
    let drum = -400.0;
    let mut found = Vec::new();
    for ways in 0..8 {
        // What a torque on the wheel gives the planet: external meshes turn it about.
        let gives = [0, 1, 2].map(|k| {
            let of = wheels[k];
            let ratio = -20.0 / of;
            match ways >> k & 1 {
                0 => ratio * efficiency(mu, z(of), planet(of)),
                _ => ratio / efficiency(mu, planet(of), z(of)),
            }
        });
        // sun + fixed + drum = 0 and the planet's balance.
        let fixed = -(gives[2] - gives[0]) * drum / (gives[1] - gives[0]);
        let sun = -fixed - drum;
        // The wheel gives power to the planet where its torque turns it on against the carrier.
        let agrees = [sun, fixed, drum]
            .iter()
            .zip(wheels)
            .enumerate()
            .all(|(k, (torque, of))| {
                let on = torque * (-20.0 / of * turning) > 0.0;
                on == (ways >> k & 1 == 0)
            });
        if agrees {
            found.push(sun);
        }
    }
    // Where a wheel gives just nothing both ways of its power come to the same.
    let spread = found.iter().map(|sun| (sun - found[0]).abs());
    assert!(spread.fold(0.0, f64::max) < 1e-9, "{found:?}");
    found[0]
}

fn locks(rows: &[ForceSample]) -> bool {
    (rows.iter()).any(|row| (row.notes.iter()).any(|n| matches!(n, ForceNote::SelfLocking(_))))
}

/// A train of high ratio holds its load by its teeth alone; one of low ratio, or of smoother teeth, does not.
#[test]
fn a_wolfrom_train_locks_itself() {
    for (rings, mu, holds) in [
        ([80, 81], 0.1, true),
        ([80, 81], 0.02, false),
        ([80, 90], 0.1, false),
        ([81, 80], 0.1, true),
    ] {
        for speed in [30.0, -30.0] {
            let model = wolfrom(rings, speed, mu);
            let rows = rows(&model, &[drive()], &[0.5 * speed]);
            let row = &rows[0];
            let evidence = row.evidence.unwrap();
            assert!(evidence.route_difference < 1e-11, "{evidence:?}");
            let torque = row.sample.values[0];
            let expected = sun_of_wolfrom(rings, speed, mu);
            close("sun", torque, expected, 1e-6 * expected.abs().max(1.0));
            let lowers = (speed < 0.0) == (rings[1] > rings[0]);
            assert_eq!(
                locks(&rows),
                holds && lowers,
                "{rings:?} {mu} {speed}: {torque}"
            );
            if holds && lowers {
                assert!(torque * speed > 0.0);
            }
            // What the drum gives and the motor gives goes into the teeth.
            let ratio = 1.0 - f64::from(rings[0]) / f64::from(rings[1]);
            let drum = speed / (1.0 + f64::from(rings[0]) / 40.0) * ratio;
            let balance = evidence.drive_power - 400.0 * drum + evidence.friction_power;
            close("power", balance, 0.0, 1e-9 * 400.0);
            assert!(evidence.friction_power < 0.0);
        }
    }
}

/// Driven from its drum, the train jams: with that part of the friction with which it would just not hold its load.
#[test]
fn a_wolfrom_train_cannot_be_driven_from_its_drum() {
    let mut model = wolfrom([80, 81], -30.0, 0.1);
    let kempe_model::DriveKind::Turn { link: turned, .. } = &mut model.drives[0].kind else {
        panic!("a turn")
    };
    *turned = link(&model_of_wolfrom(), "drum");
    let kempe_model::LoadKind::Torque { on, amount: by, .. } = &mut model.actions.loads[0].kind
    else {
        panic!("a torque")
    };
    (*on, *by) = (link(&model_of_wolfrom(), "sun"), amount(1.0));
    let rows = rows(&model, &[drive()], &[-15.0]);
    let (mut low, mut high) = (0.01, 0.1);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match sun_of_wolfrom([80, 81], -30.0, middle) > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let part = (rows[0].notes.iter()).find_map(|note| match note {
        ForceNote::Jammed { part } => Some(*part),
        _ => None,
    });
    // The search ends where the loads are so large that rounding does not settle.
    close("part of the friction", part.unwrap(), low / 0.1, 1e-3);
    assert!((0.3..0.95).contains(&(low / 0.1)), "{low}");
    assert!(rows[0].sample.values[0].is_nan());
}

fn model_of_wolfrom() -> Model {
    wolfrom([80, 81], -30.0, 0.1)
}
