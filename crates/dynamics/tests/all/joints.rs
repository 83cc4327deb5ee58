//! What joints carry, in cases that can be worked out by hand.
use crate::support;
use crate::support::*;
use kempe_dynamics::{Carrier, ForceNote, FrictionOutcome};
use kempe_model::{
    Acts, Between, DriveId, ForceMeasure, Friction, FrictionAt, HydraulicCylinder, JointRef, Load,
    LoadKind, Measure, Model, Motor, Spring,
};
use kempe_units::Expr;

const SLIDER_CRANK: &str = r#"
[links]
frame  = { A = [0, 0], E = [1, 0] }
crank  = { A-B = 0.1 }
rod    = { B-C = 0.3 }
slider = { C = [0, 0] }
[joints]
bore = { slider = "slider", at = "C", on = "A -> E" }
[drives]
motor = { turns = "crank", from = "20 deg", to = "160 deg", speed = "1 rad/s" }
[assembly]
C = { near = [0.39, 0] }
"#;

fn friction(at: FrictionAt, coefficient: f64, radius: Option<f64>) -> Friction {
    Friction {
        at,
        coefficient: number(coefficient),
        static_coefficient: None,
        stribeck_speed: None,
        viscous: None,
        drag: None,
        radius: radius.map(number),
        span: 0..0,
    }
}

fn joint_measure(model: &Model, name: &str, of: fn(JointRef) -> ForceMeasure) -> Measure {
    ask(of(JointRef::Joint(joint(model, name), None)))
}

/// Every joint's load on one link is the opposite of that on the other, and the loads on a link balance.
#[test]
fn action_is_reaction() {
    let text = include_str!("../../../../examples/seeds/door-lock.toml");
    let model = model(text);
    let pairs = [
        ("O", "frame", "bar2"),
        ("A", "bar2", "plate3"),
        ("B", "plate3", "plate4"),
        ("E", "plate3", "bar6"),
        ("F", "bar6", "bar5"),
    ];
    let mut measures = Vec::new();
    for (at, a, b) in pairs {
        measures.extend(pin_on(&model, at, a));
        measures.extend(pin_on(&model, at, b));
    }
    for row in values(&model, &measures, &[-0.5, 0.0, 1.2]) {
        for pair in row.chunks_exact(4) {
            assert!(pair[0].abs() + pair[1].abs() > 1e-3);
            assert_eq!((pair[0], pair[1]), (-pair[2], -pair[3]));
        }
    }
}

/// Three links at one pin: what each feels, and all of it together nothing.
#[test]
fn a_multiple_joint_carries_a_load_for_every_link() {
    let text = r#"
[links]
frame = { A = [0, 0] }
one   = { A-B = 0.5 }
two   = { B-C = 0.8 }
three = { B-F = 0.9 }
[drives]
motor = { turns = "one", from = "60 deg", to = "70 deg", speed = "1 rad/s" }
swing = { turns = "two", at = "10 deg" }
nod   = { turns = "three", at = "-50 deg" }
"#;
    let mut model = model(text);
    let load = force("pull", on(&model, "two", "C"), [30.0, -40.0]);
    let other = force("push", on(&model, "three", "F"), [-5.0, 70.0]);
    model.actions.loads.extend([load, other]);
    let mut measures = Vec::new();
    for link in ["one", "two", "three"] {
        measures.extend(pin_on(&model, "B", link));
    }
    measures.push(ask(ForceMeasure::Drive(DriveId(1))));
    let row = &values(&model, &measures, &[1.1])[0];
    for k in 0..2 {
        let sum = row[k] + row[2 + k] + row[4 + k];
        assert!(sum.abs() < 1e-12, "{row:?}");
    }
    // The second and third links only have their loads and the pin.
    for (found, expected) in row[2..6].iter().zip([-30.0, 40.0, 5.0, -70.0]) {
        close("pin", *found, expected, 1e-12);
    }
    let (s, c) = kempe_number::math::sin_cos(10.0_f64.to_radians());
    close("torque", row[6], -0.8 * (c * -40.0 - s * 30.0), 1e-12);
}

/// A welded bracket carries its own load and nothing else.
#[test]
fn a_weld_is_cut() {
    let text = r#"
[links]
frame  = { A = [0, 0] }
arm    = { A-B = 0.5 }
flange = { B-C = 0.2, mass = "2 kg", center = "C" }
[joints]
rigid = { weld = ["arm", "flange"], at = "B", angle = "90 deg" }
[drives]
motor = { turns = "arm", from = "0 deg", to = "90 deg", speed = "3 rad/s" }
"#;
    let mut model = model(text);
    model
        .actions
        .loads
        .push(force("f", on(&model, "flange", "C"), [7.0, 0.0]));
    let of = |measure: fn(JointRef) -> ForceMeasure, link_name: &str| {
        let at = JointRef::Joint(joint(&model, "rigid"), Some(link(&model, link_name)));
        ask(measure(at))
    };
    let measures = [
        of(ForceMeasure::ReactionX, "flange"),
        of(ForceMeasure::ReactionY, "flange"),
        of(ForceMeasure::ReactionMoment, "flange"),
        of(ForceMeasure::ReactionMoment, "arm"),
    ];
    let row = &values(&model, &measures, &[1e-9])[0];
    // C stands at (0.5, 0.2) and turns at 3 rad/s about A: a = -9 (0.5, 0.2).
    close("x", row[0], 2.0 * -4.5 - 7.0, 1e-6);
    close("y", row[1], 2.0 * -1.8 + 2.0 * 9.81, 1e-6);
    // About B: m a at (0, 0.2) has the moment -0.2 * m ax; the load -0.2 * 7.
    close("moment", row[2], -0.2 * (2.0 * -4.5) + 0.2 * 7.0, 1e-6);
    close("other side", row[3], -row[2], 1e-15);
}

/// A gear train: the pins carry the tooth force.
#[test]
fn gears_push_their_pins_apart() {
    let text = r#"
[links]
frame  = { A = [0, 0], B = [0.3, 0] }
pinion = { A = [0, 0] }
wheel  = { B = [0, 0] }
[joints]
mesh = { gears = ["pinion", "wheel"], arm = "frame", teeth = [20, 40] }
[drives]
motor = { turns = "pinion", from = "0 deg", to = "90 deg", speed = "1 rad/s" }
"#;
    let mut model = model(text);
    model.actions.loads.push(Load {
        name: "brake".into(),
        kind: LoadKind::Torque {
            on: link(&model, "wheel"),
            against: kempe_model::FRAME,
            amount: amount(12.0),
        },
        span: 0..0,
    });
    let mut measures = vec![drive()];
    measures.extend(pin_on(&model, "B", "wheel"));
    measures.extend(pin_on(&model, "A", "pinion"));
    measures.push(joint_measure(&model, "mesh", ForceMeasure::ReactionY));
    let row = &values(&model, &measures, &[0.3])[0];
    // The wheel turns backwards at half speed; the brake's torque helps it forwards: the pinion must hold 6 N m.
    close("motor", row[0], 6.0, 1e-12);
    // 12 N m on a pitch radius of 0.2 m: the tooth pushes the wheel up on its left, and its pin pulls it down.
    close("pin B x", row[1], 0.0, 1e-12);
    close("pin B y", row[2], -60.0, 1e-12);
    close("pin A y", row[4], 60.0, 1e-12);
    close("tooth force on the pinion", row[5], -60.0, 1e-12);
}

/// A bar held by three parallel cranks: its redundant rows are named.
#[test]
fn overconstrained_loads_are_not_unique() {
    let text = r#"
[links]
frame = { A = [0, 0], C = [1, 0], E = [2, 0] }
one   = { A-B = 0.5 }
two   = { C-D = 0.5 }
three = { E-F = 0.5 }
bar   = { B = [0, 0], D = [1, 0], F = [2, 0], mass = "10 kg", center = "D" }
[drives]
motor = { turns = "one", from = "30 deg", to = "150 deg", speed = "1 rad/s" }
[assembly]
two = { near = "30 deg" }
"#;
    let model = model(text);
    let rows = rows(
        &model,
        &[drive(), pin(&model, "D"), pin(&model, "A")],
        &[1.0],
    );
    let evidence = rows[0].evidence.expect("forces");
    assert!(
        evidence.route_difference < 1e-12 && evidence.residual < 1e-13,
        "{evidence:?}"
    );
    // The bar only translates: its weight does the same at every crank.
    let (s, c) = kempe_number::math::sin_cos(1.0);
    let inertia = 10.0 * 0.5 * -s * 0.5 * c + 10.0 * 0.5 * c * 0.5 * s;
    close(
        "torque",
        rows[0].sample.values[0],
        10.0 * 9.81 * 0.5 * c + inertia,
        1e-12,
    );
    let named = rows[0].notes.iter().any(|n| {
        matches!(n, ForceNote::NotUnique(list) if list.contains(&Carrier::Pin(point(&model, "D"))))
    });
    assert!(named, "{:?}", rows[0].notes);
}

/// Friction in the bore only: N and mu N by hand.
#[test]
fn friction_in_a_bore() {
    let mut model = model(SLIDER_CRANK);
    model
        .actions
        .loads
        .push(force("gas", on(&model, "slider", "C"), [-1000.0, 0.0]));
    let bore = FrictionAt::Joint(joint(&model, "bore"));
    model.actions.friction.push(friction(bore, 0.2, None));
    let mut measures = vec![drive()];
    measures.extend(["bore"].map(|n| joint_measure(&model, n, ForceMeasure::ReactionX)));
    measures.extend(["bore"].map(|n| joint_measure(&model, n, ForceMeasure::ReactionY)));
    let at = 1.0_f64;
    let row = &rows(&model, &measures, &[at])[0];
    let evidence = row.evidence.expect("forces");
    assert!(matches!(
        evidence.friction,
        FrictionOutcome::Consistent { .. }
    ));
    assert!(
        evidence.route_difference < 1e-12 && evidence.residual < 1e-13,
        "{evidence:?}"
    );
    // The slider moves to -x, so friction pushes it to +x; the rod, at angle -phi, carries S.
    let sine = 0.1 * kempe_number::math::sin(at) / 0.3;
    let cosine = (1.0 - sine * sine).sqrt();
    // On the slider: S along (cos, -sin) from the rod, N up, mu |N| along x, -1000 along x.
    // S cos + mu N - 1000 = 0, N = S sin.
    let s = 1000.0 / (cosine + 0.2 * sine);
    let n = s * sine;
    close("friction", row.sample.values[1], 0.2 * n, 1e-10);
    close("normal", row.sample.values[2], n, 1e-10);
    let speed =
        -0.1 * kempe_number::math::sin(at) - 0.1 * kempe_number::math::cos(at) * sine / cosine;
    close("power", evidence.friction_power, 0.2 * n * speed, 1e-10);
    close(
        "drive",
        row.sample.values[0],
        (1000.0 - 0.2 * n) * speed,
        1e-10,
    );
}

/// A wedge-like drive through a shallow angle jams with enough friction, and the row says at which part of it.
#[test]
fn a_steep_push_jams() {
    let text = r#"
[links]
frame = { A = [0, 0], B = [1, 0], C = [0, 1] }
block = { P = [0, 0] }
rod   = { P-Q = 1 }
head  = { Q = [0, 0] }
[joints]
floor = { slider = "block", at = "P", on = "A -> B" }
wall  = { slider = "head", at = "Q", on = "A -> C" }
[drives]
push = { slides = "head", from = 0.2, to = 0.9, speed = "1 m/s" }
[assembly]
P = { near = [0.97, 0] }
"#;
    let text = text.replace("slides = \"head\"", "slides = \"wall\"");
    let again = "again = { slider = \"block\", at = \"P\", on = \"A -> B\" }";
    // A guide that is said twice shares its load, and rubs as one.
    let twice = text.replace("[drives]", &format!("{again}\n[drives]"));
    for (text, guides) in [
        (&text, &["floor", "wall"][..]),
        (&twice, &["floor", "wall", "again"]),
    ] {
        let mut model = model(text);
        model
            .actions
            .loads
            .push(force("load", on(&model, "block", "P"), [100.0, 0.0]));
        for name in guides {
            let at = FrictionAt::Joint(joint(&model, name));
            model.actions.friction.push(friction(at, 0.5, None));
        }
        drawn_in_and_jammed(&model);
    }
}

fn drawn_in_and_jammed(model: &Model) {
    // The rod at the angle a over the floor: pulling Q up draws the block in. S is its tension:
    // floor: N1 = S sin a, S cos a = 100 + mu N1; wall: N2 = S cos a; drive = S sin a + mu N2.
    let measures = [ask(ForceMeasure::Drive(DriveId(0)))];
    let rows = rows(model, &measures, &[0.3, 0.8999]);
    let a = kempe_number::math::asin(0.3);
    let (s, c) = kempe_number::math::sin_cos(a);
    let tension = 100.0 / (c - 0.5 * s);
    close(
        "drive",
        rows[0].sample.values[0],
        tension * (s + 0.5 * c),
        1e-9,
    );
    // tan a >= 1 / mu: no tension overcomes the friction it makes itself.
    let tangent = 0.8999 / (1.0_f64 - 0.8999 * 0.8999).sqrt();
    let jam = rows[1].notes.iter().find_map(|n| match n {
        ForceNote::Jammed { part } => Some(*part),
        _ => None,
    });
    close("part", jam.expect("jammed"), 1.0 / tangent / 0.5, 1e-4);
    assert!(rows[1].sample.values[0].is_nan());
}

/// An arm with 50 N at its end, that goes down on a journal of 0.2 m with this coefficient.
fn arm_on_a_thick_journal(coefficient: f64) -> Model {
    let text = r#"
[links]
frame = { A = [0, 0] }
arm   = { A-B = 0.1 }
[drives]
motor = { turns = "arm", from = "0 deg", to = "-60 deg", speed = "1 rad/s" }
"#;
    let mut model = model(text);
    model
        .actions
        .loads
        .push(force("weight", on(&model, "arm", "B"), [0.0, -50.0]));
    let pin = FrictionAt::Pin(point(&model, "A"));
    let friction = friction(pin, coefficient, Some(0.2));
    model.actions.friction.push(friction);
    model
}

/// A load on a pin with a thick journal does not turn it: self-locking.
#[test]
fn a_thick_journal_holds_its_load() {
    let c = kempe_number::math::cos(0.5);
    for (coefficient, holds) in [(0.3, false), (0.6, true)] {
        let rows = rows(&arm_on_a_thick_journal(coefficient), &[drive()], &[-0.5]);
        close(
            "torque",
            rows[0].sample.values[0],
            // The load passes on the friction circle.
            50.0 * 0.1 * c - 50.0 * 0.2 * coefficient / (1.0 + coefficient * coefficient).sqrt(),
            1e-12,
        );
        let told = rows[0].notes.contains(&ForceNote::SelfLocking(DriveId(0)));
        assert_eq!(told, holds, "{:?}", rows[0].notes);
    }
}

/// What only slows holds no load, however much more the drive has to give than the load does.
#[test]
fn viscous_friction_holds_nothing() {
    let mut model = arm_on_a_thick_journal(0.0);
    model.actions.friction[0].viscous = Some(number(10.0));
    let rows = rows(&model, &[drive()], &[-0.5]);
    let c = kempe_number::math::cos(0.5);
    close(
        "torque",
        rows[0].sample.values[0],
        50.0 * 0.1 * c - 10.0,
        1e-12,
    );
    assert_eq!(rows[0].notes, [], "friction without a coefficient");
}

/// A press whose pins are thicker than its crank is long holds its load from the dead point on, where the load only begins to
/// push, and not before it: by the friction circles, as far as they are wider than the load's arm about the crank.
#[test]
fn friction_holds_from_the_dead_point_on() {
    let text = r#"
[links]
frame = { A = [0, 0], E = [0, 0], G = [0.3, 0] }
crank = { A-B = 0.01 }
rod   = { B-C = 0.06 }
ram   = { C = [0, 0] }
[joints]
way = { slider = "ram", at = "C", on = "E -> G" }
[drives]
m = { turns = "crank", from = "-30 deg", to = "30 deg", speed = "1 rad/s" }
[assembly]
C = { near = [0.07, 0] }
"#;
    let mut model = model(text);
    let load = force("work", on(&model, "ram", "C"), [-1000.0, 0.0]);
    model.actions.loads.push(load);
    let (way, mu) = (FrictionAt::Joint(joint(&model, "way")), 0.3);
    model.actions.friction.push(friction(way, mu, None));
    for pin in ["A", "B", "C"].map(|name| FrictionAt::Pin(point(&model, name))) {
        model.actions.friction.push(friction(pin, mu, Some(0.012)));
    }
    let angles = (-29..30_i32).map(|k| f64::from(k).to_radians());
    let angles: Vec<f64> = angles.chain([1e-15]).collect();
    for (row, angle) in rows(&model, &[drive()], &angles).iter().zip(angles) {
        let locks = row.notes.contains(&ForceNote::SelfLocking(DriveId(0)));
        assert_eq!(locks, angle > 1e-9, "{angle}: {:?}", row.notes);
    }
}

/// Where a drive's torque passes through zero, as its masses or a spring take turns, any friction is more than it: no lock.
#[test]
fn a_torque_that_changes_its_sense_is_not_locked() {
    let text = SLIDER_CRANK
        .replace(
            "from = \"20 deg\", to = \"160 deg\", speed = \"1 rad/s\"",
            "speed = \"300 rpm\"",
        )
        .replace("{ C = [0, 0] }", "{ C = [0, 0], mass = \"2 kg\" }");
    let angles: Vec<f64> = (0..360).map(|k| f64::from(k).to_radians()).collect();
    let spring = "\n[springs]\nk = { between = \"A-C\", stiffness = \"5 N/mm\", free = 0.3 }\n";
    for extra in ["", spring] {
        let mut model = model(&format!("{text}{extra}"));
        let pins = ["A", "B", "C"].map(|name| FrictionAt::Pin(point(&model, name)));
        for pin in pins {
            model.actions.friction.push(friction(pin, 0.1, Some(0.02)));
        }
        let rows = rows(&model, &[drive()], &angles);
        let torques: Vec<f64> = rows.iter().map(|r| r.sample.values[0]).collect();
        assert!(torques.windows(2).any(|w| w[0] * w[1] < 0.0), "{torques:?}");
        for row in &rows {
            let locks = |n: &ForceNote| matches!(n, ForceNote::SelfLocking(_));
            assert!(!row.notes.iter().any(locks), "{:?}", row.sample.coordinates);
        }
    }
}

/// Pressure, capacity and notes of the hitch's cylinder, and a motor that is too weak.
#[test]
fn actuators() {
    let mut hitch = model(&example("tractor-hitch"));
    hitch.actions.cylinders = vec![HydraulicCylinder {
        oil: None,
        drive: DriveId(0),
        bore: number(0.06),
        rod: number(0.03),
        supply: None,
        relief: Some(number(1.3e7)),
        back: number(2e5),
        flow: None,
        friction: number(100.0),
        count: number(1.0),
        span: 0..0,
    }];
    let measures = [
        ask(ForceMeasure::Pressure(DriveId(0))),
        ask(ForceMeasure::Capacity(DriveId(0))),
        drive(),
    ];
    let rows = rows(&hitch, &measures, &[0.425, 0.45]);
    let bore = std::f64::consts::PI * 0.06 * 0.06 / 4.0;
    let v = &rows[0].sample.values;
    close(
        "pressure",
        v[0],
        (v[2] + 100.0 + 0.75 * bore * 2e5) / bore,
        1e-6,
    );
    close(
        "capacity",
        v[1],
        1.3e7 * bore - 0.75 * bore * 2e5 - 100.0,
        1e-8,
    );
    let weak = |row: &kempe_dynamics::ForceSample| {
        (row.notes.iter()).any(|n| matches!(n, ForceNote::CylinderTooWeak { .. }))
    };
    assert_eq!([weak(&rows[0]), weak(&rows[1])], [v[0] > 1.3e7, true]);

    let mut crank = model(SLIDER_CRANK);
    crank
        .actions
        .loads
        .push(force("gas", on(&crank, "slider", "C"), [1000.0, 0.0]));
    crank.actions.motors.push(Motor {
        throttle: None,
        drive: DriveId(0),
        curve: vec![(number(0.0), number(20.0)), (number(10.0), number(20.0))],
        span: 0..0,
    });
    let row = &support::rows(&crank, &[drive()], &[1.2])[0];
    let lacks = row.notes.iter().find_map(|n| match n {
        ForceNote::MotorTooWeak { lacks, .. } => Some(*lacks),
        _ => None,
    });
    close(
        "lacks",
        lacks.expect("too weak"),
        row.sample.values[0] - 20.0,
        1e-12,
    );
}

/// Work by quadrature: what the drive, the loads and the dampers do over the motion is the gain of energy.
#[test]
fn work_is_energy() {
    let mut model = model(SLIDER_CRANK);
    model.actions.springs.push(Spring {
        name: "s".into(),
        between: Between::Points(on(&model, "frame", "E"), on(&model, "rod", "B")),
        stiffness: number(500.0),
        free: number(0.9),
        preload: number(5.0),
        stops: [None, Some(number(1.0))],
        stop_stiffness: Some(number(2000.0)),
        acts: Acts::Both,
        span: 0..0,
    });
    model.links[3].inertia = Some(kempe_model::Inertia {
        mass: Some(number(3.0)),
        moment: None,
        center: kempe_model::Center::Centroid,
    });
    let total = Expr::Add(
        Box::new(ask(ForceMeasure::KineticEnergy)),
        Box::new(ask(ForceMeasure::PotentialEnergy)),
    );
    let measures = [ask(ForceMeasure::Power(DriveId(0))), total];
    with_sampler(&model, &measures, |sampler| {
        let (duration, n) = (sampler.duration(), 4000);
        let mut work = 0.0;
        for k in 0..n {
            let t = duration * (f64::from(k) + 0.5) / f64::from(n);
            work += sampler.at_time(t).sample.values[0] * duration / f64::from(n);
        }
        let gain =
            sampler.at_time(duration).sample.values[1] - sampler.at_time(0.0).sample.values[1];
        close("work", work, gain, 1e-5 * gain.abs());
    });
}

/// What makes no sense is told before anything is computed.
#[test]
fn problems_are_told() {
    let mut model = model(SLIDER_CRANK);
    model.links[1].inertia = Some(kempe_model::Inertia {
        mass: Some(number(-1.0)),
        moment: None,
        center: kempe_model::Center::Centroid,
    });
    let at = on(&model, "rod", "B");
    model.actions.springs.push(Spring {
        name: "loop".into(),
        between: Between::Points(at, at),
        stiffness: number(1.0),
        free: number(0.0),
        preload: number(0.0),
        stops: [None, None],
        stop_stiffness: None,
        acts: Acts::Both,
        span: 0..0,
    });
    let mut load = force("odd", at, [0.0, 0.0]);
    load.kind = LoadKind::Torque {
        on: link(&model, "crank"),
        against: kempe_model::FRAME,
        amount: kempe_model::Amount::Measure(drive()),
    };
    model.actions.loads.push(load);
    model
        .actions
        .friction
        .push(friction(FrictionAt::Pin(point(&model, "A")), 0.1, None));
    let mechanism = kempe_mechanism::Mechanism::new(&model);
    let parameters: Vec<f64> = Vec::new();
    let geometry = kempe_mechanism::Geometry::new(&mechanism, &parameters);
    let found = kempe_dynamics::Acting::new(&mechanism, &geometry, &parameters).unwrap_err();
    let codes: Vec<&str> = found.iter().map(|p| p.code).collect();
    for code in [
        "negative-mass",
        "spring-idle",
        "load-of-force",
        "friction-radius",
    ] {
        assert!(codes.contains(&code), "{code} in {codes:?}");
    }
}
