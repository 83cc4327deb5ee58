//! Random mechanisms on which everything acts that can, with dimensions that hang on parameters.

use kempe_mechanism::Mechanism;
use kempe_model::{
    Acts, Amount, Between, Center, Damper, DriveId, DriveKind, ForceMeasure, Friction, FrictionAt,
    HydraulicCylinder, Inertia, JointId, JointRef, Leaf, LinkId, LinkPointRef, Load, LoadKind,
    Model, Motor, Parameter, ParameterId, Place, PointId, PointMass, PoseMeasure, Scalar, Spring,
};
use kempe_units::{Dimension, Expr};

use crate::mechanisms::Rng;
use crate::toothed::give_teeth;

/// Parameters, all 1: the first is a factor of friction, the others of everything else.
pub const PARAMETERS: usize = 6;

/// Puts masses, springs, dampers, loads, friction, motors and cylinders on a model of this size.
pub fn act(model: &mut Model, rng: &mut Rng, size: f64) {
    assert!(model.parameters.is_empty());
    for k in 0..PARAMETERS {
        model.parameters.push(Parameter {
            name: format!("p{k}"),
            value: Expr::Const(1.0),
            dimension: Dimension::NONE,
            span: 0..0,
        });
    }
    let times = |x: f64, parameter: usize| -> Scalar {
        let leaf = Expr::Leaf(ParameterId(parameter as u32));
        Expr::Mul(Box::new(Expr::Const(x)), Box::new(leaf))
    };
    let number = |rng: &mut Rng, low: f64, high: f64| {
        let x = rng.range(low, high);
        times(x, 1 + rng.below(PARAMETERS - 1))
    };
    let l = size;
    let place = |rng: &mut Rng| Place::Cartesian {
        x: number(rng, -0.6 * l, 0.6 * l),
        y: number(rng, -0.6 * l, 0.6 * l),
    };
    for link in &mut model.links {
        if rng.chance(0.8) {
            link.inertia = Some(Inertia {
                mass: Some(number(rng, 0.1, 2.0)),
                moment: Some(number(rng, 0.0, 0.5 * l * l)),
                center: Center::Place(place(rng)),
            });
        }
    }
    model.actions.gravity = Some([number(rng, -2.0 * l, 2.0 * l), number(rng, -10.0 * l, l)]);
    let links = model.links.len();
    let a_point = |rng: &mut Rng, model: &Model| {
        let link = rng.below(links);
        let points = &model.links[link].points;
        LinkPointRef {
            link: LinkId(link as u32),
            point: points[rng.below(points.len())].point,
        }
    };
    model.actions.masses.push(PointMass {
        name: "m".into(),
        on: LinkId(rng.below(links) as u32),
        place: place(rng),
        mass: number(rng, 0.1, 2.0),
        span: 0..0,
    });
    let at = a_point(rng, model);
    let component = |rng: &mut Rng| {
        let over = Expr::Leaf(Leaf::Pose(PoseMeasure::X(at.point)));
        Amount::Table {
            over: Box::new(over),
            over_dimension: Dimension::LENGTH,
            at: vec![-l, 0.3 * l, 0.4 * l, 1.2 * l],
            values: (0..4).map(|_| rng.range(-3.0, 3.0) * l).collect(),
            period: rng.chance(0.5).then_some(2.5 * l),
            factor: number(rng, 0.5, 2.0),
        }
    };
    model.actions.loads.push(Load {
        name: "f".into(),
        kind: LoadKind::Force {
            at,
            components: [component(rng), component(rng)],
            axes: LinkId(rng.below(links) as u32),
        },
        span: 0..0,
    });
    model.actions.loads.push(Load {
        name: "t".into(),
        kind: LoadKind::Torque {
            on: LinkId(rng.below(links) as u32),
            against: LinkId(rng.below(links) as u32),
            amount: Amount::Measure(Expr::Const(rng.range(-3.0, 3.0) * l * l)),
        },
        span: 0..0,
    });
    let mechanism = Mechanism::new(model);
    for index in 0..4 {
        let (a, b) = (a_point(rng, model), a_point(rng, model));
        if mechanism.body_of(a.link) == mechanism.body_of(b.link) || a.point == b.point {
            continue;
        }
        let acts = [Acts::Both, Acts::Tension, Acts::Compression][rng.below(3)];
        let turning = Between::Links(a.link, b.link);
        let spring =
            |rng: &mut Rng, between, unit: f64, long: f64, stops: [Option<Scalar>; 2]| Spring {
                name: format!("s{index}"),
                between,
                stiffness: number(rng, 0.1 * unit, 9.0 * unit),
                free: number(rng, 0.0, 1.5 * long),
                preload: number(rng, -2.0 * unit * long, 2.0 * unit * long),
                stop_stiffness: stops[0]
                    .as_ref()
                    .map(|_| number(rng, 5.0 * unit, 20.0 * unit)),
                stops,
                acts,
                span: 0..0,
            };
        match index {
            0 => {
                let stops = [Some(times(0.2 * l, 1)), Some(times(1.2 * l, 2))];
                let between = Between::Points(a, b);
                model
                    .actions
                    .springs
                    .push(spring(rng, between, 1.0, l, stops));
            }
            1 => {
                let one = spring(rng, turning, l * l, 1.0, [None, None]);
                model.actions.springs.push(one);
            }
            _ => model.actions.dampers.push(Damper {
                name: format!("d{index}"),
                between: match index {
                    2 => Between::Points(a, b),
                    _ => turning,
                },
                damping: number(rng, 0.0, if index == 2 { 2.0 } else { 2.0 * l * l }),
                closing: Some(number(rng, 0.0, if index == 2 { 2.0 } else { 2.0 * l * l })),
                span: 0..0,
            }),
        }
    }
    if rng.chance(0.7) {
        let friction = rng.range(0.02, 0.3);
        model.actions.friction.push(Friction {
            at: FrictionAt::All,
            coefficient: times(friction, 0),
            static_coefficient: Some(times(1.3 * friction, 0)),
            stribeck_speed: rng.chance(0.5).then(|| number(rng, 0.05 * l, 0.2 * l)),
            viscous: rng.chance(0.5).then(|| number(rng, 0.0, 0.01)),
            drag: rng.chance(0.3).then(|| number(rng, 0.0, 0.01)),
            radius: Some(number(rng, 0.01 * l, 0.04 * l)),
            span: 0..0,
        });
    }
    for (index, drive) in model.drives.iter().enumerate() {
        let drive_id = DriveId(index as u32);
        match drive.kind {
            DriveKind::Turn { .. } => model.actions.motors.push(Motor {
                throttle: None,
                drive: drive_id,
                curve: vec![
                    (times(rng.range(-0.5, 0.1), 1), number(rng, 1.0, 3.0)),
                    (times(0.4, 2), number(rng, 1.0, 3.0)),
                    (times(3.0, 3), Expr::Const(0.0)),
                ],
                span: 0..0,
            }),
            _ => model.actions.cylinders.push(HydraulicCylinder {
                oil: None,
                drive: drive_id,
                bore: times(0.05 * l, 1),
                rod: times(0.03 * l, 2),
                supply: Some(number(rng, 1e3, 2e4)),
                relief: Some(number(rng, 1e3, 2e4)),
                back: number(rng, 10.0, 100.0),
                flow: None,
                friction: number(rng, 0.0, 0.1 * l),
                count: Expr::Const(2.0),
                span: 0..0,
            }),
        }
    }
    let rubs = rng.chance(0.7).then(|| times(rng.range(0.02, 0.2), 0));
    give_teeth(model, rng, rubs, |rng, x| {
        times(x, 1 + rng.below(PARAMETERS - 1))
    });
}

/// Every measure of forces of a model.
pub fn measures(model: &Model) -> Vec<ForceMeasure> {
    let mut list = vec![
        ForceMeasure::KineticEnergy,
        ForceMeasure::PotentialEnergy,
        ForceMeasure::ShakingForceX,
        ForceMeasure::ShakingForceY,
        ForceMeasure::ShakingForce,
        ForceMeasure::ShakingMoment,
    ];
    for drive in (0..model.drives.len()).map(|d| DriveId(d as u32)) {
        list.extend([
            ForceMeasure::Drive(drive),
            ForceMeasure::Power(drive),
            ForceMeasure::ReducedMass(drive),
            ForceMeasure::ReducedLoad(drive),
            ForceMeasure::Pressure(drive),
            ForceMeasure::Capacity(drive),
        ]);
    }
    let pins = (0..model.points.len()).map(|p| JointRef::Pin(PointId(p as u32), None));
    let joints = (0..model.joints.len()).map(|j| JointRef::Joint(JointId(j as u32), None));
    for joint in pins.chain(joints) {
        list.extend([
            ForceMeasure::Reaction(joint),
            ForceMeasure::ReactionX(joint),
            ForceMeasure::ReactionY(joint),
            ForceMeasure::ReactionAngle(joint),
            ForceMeasure::ReactionAlong(joint),
            ForceMeasure::ReactionAcross(joint),
            ForceMeasure::ReactionMoment(joint),
        ]);
    }
    list.extend((0..model.actions.springs.len()).map(ForceMeasure::Spring));
    list.extend((0..model.actions.dampers.len()).map(ForceMeasure::Damper));
    for load in 0..model.actions.loads.len() {
        list.extend([
            ForceMeasure::Load(load),
            ForceMeasure::LoadX(load),
            ForceMeasure::LoadY(load),
        ]);
    }
    list
}
