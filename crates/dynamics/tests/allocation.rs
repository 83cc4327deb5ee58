//! The forces of one instant allocate nothing once their storage is there.

#[path = "../../integrate/tests/support/counting.rs"]
mod counting;
mod support;

use counting::allocations;
use kempe_dynamics::{ForceSampler, Forces, Instant};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::DriveId;
use kempe_motion::Motion;
use kempe_number::Jet;

const FIVE_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
frame   = { A = [-40, 0], D = [40, 0] }
upper_a = { A-B = 80, mass = "1 kg", inertia = "1e-3 kg m^2", center = [40, 0] }
upper_d = { D-C = 80, mass = "1 kg", inertia = "1e-3 kg m^2", center = [40, 0] }
lower_b = { B-P = 100 }
lower_c = { C-P = 100 }
[drives]
left  = { turns = "upper_a", from = 110, to = 130, law = "cycloidal", in = "2 s" }
right = { turns = "upper_d", from = 70, to = 60, speed = "4 deg/s" }
[assembly]
P = "left of B -> C"
[masses]
tool = { at = "P", mass = "0.5 kg" }
[friction]
all = { coefficient = 0.1, radius = 5 }
"#;

#[test]
fn forces_of_the_door_lock_allocate_nothing() {
    let mut model = support::model(&support::example("door-lock"));
    model.actions.friction.push(kempe_model::Friction {
        at: kempe_model::FrictionAt::All,
        coefficient: support::number(0.1),
        static_coefficient: None,
        stribeck_speed: None,
        viscous: None,
        drag: None,
        radius: Some(support::number(0.01)),
        span: 0..0,
    });
    let mechanism = Mechanism::new(&model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).expect("a motion");
    let rich: Design<Jet<f64, 3>> =
        Design::new(&mechanism, &model.parameter_values::<Jet<f64, 3>>());
    let mut forces = Forces::new(design.clone()).expect("forces");
    let mut instant = Instant::new(&mechanism, 0);
    let mut solver = motion.solver();
    motion.solve(&rich, Jet::variable(0.3), &mut solver);
    let mut once = |speed: f64| {
        let near = &solver.branch.near;
        instant.set_along(&solver.state, near, DriveId(0), [speed, 2.0]);
        forces.solve(&instant);
        forces.drives[0].value
    };
    let first = once(1.0);
    let (mut again, mut other) = (0.0, 0.0);
    let count = allocations(|| (again, other) = (once(1.0), once(2.0)));
    assert_eq!(count, 0);
    assert!(first == again && other.is_finite() && other != first);
}

/// Two motors, each along its own law: everything at this instant comes from both.
#[test]
fn forces_of_a_five_bar_on_two_motors_allocate_nothing() {
    let model = support::model(FIVE_BAR);
    let mechanism = Mechanism::new(&model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).expect("a motion");
    let mut sampler = ForceSampler::new(&motion, &[]).expect("forces");
    let instants = [0.4, 1.1].map(|time| {
        assert!(sampler.at_time(time).sample.closure < 1e-9, "not reached");
        let mut instant = Instant::new(&mechanism, 0);
        sampler.solved().1.value_into(&mut instant);
        instant
    });
    assert!(
        instants
            .iter()
            .all(|i| i.drive_speeds.iter().all(|v| *v != 0.0))
    );
    let mut forces = Forces::new(design).expect("forces");
    let mut torques = |instant: &Instant<f64>| {
        forces.solve(instant);
        [0, 1].map(|drive| forces.drives[drive].value)
    };
    let first = torques(&instants[0]);
    let (mut other, mut again) = ([0.0; 2], [0.0; 2]);
    let count = allocations(|| (other, again) = (torques(&instants[1]), torques(&instants[0])));
    assert_eq!(count, 0);
    // Loads and friction are iterated from the loads before: the same forces, not the same bits.
    for drive in 0..2 {
        let (a, b, c) = (first[drive], again[drive], other[drive]);
        assert!((a - b).abs() < 1e-9 * a.abs(), "{a} {b}");
        assert!((a - c).abs() > 1e-3 * a.abs(), "{a} {c}");
    }
}
