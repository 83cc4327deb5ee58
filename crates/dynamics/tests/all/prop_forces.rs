//! Random mechanisms with random masses, springs, dampers, loads and friction.

use crate::mechanisms;
use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, spread};
use crate::toothed::give_teeth;
use kempe_dynamics::{ForceEvidence, ForceNote, ForceSampler, FrictionOutcome};
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    Acts, Amount, Between, Center, Damper, DriveId, ForceMeasure, Friction, FrictionAt, Inertia,
    JointRef, Leaf, LinkId, LinkPointRef, Load, LoadKind, Measure, Model, Place, PointId,
    PointMass, PoseMeasure, Scalar, Spring,
};
use kempe_motion::Motion;
use kempe_units::Expr;
use proptest::prelude::*;

/// Condition up to which a mechanism is regular enough to be held to full accuracy.
const REGULAR: f64 = 1e4;

fn number(x: f64) -> Scalar {
    Expr::Const(x)
}

/// How a model's forces are to change: lengths, masses and the frame's direction.
#[derive(Clone, Copy, Debug)]
struct Units {
    length: f64,
    mass: f64,
    turn: f64,
    friction: f64,
}

const PLAIN: Units = Units {
    length: 1.0,
    mass: 1.0,
    turn: 0.0,
    friction: 0.0,
};

/// Puts random masses, springs, dampers and loads on a model of this size. The same seed gives the same system in the
/// units asked for; time stays. Returns the power of the loads as a measure.
fn load(model: &mut Model, seed: u64, size: f64, units: Units) -> Measure {
    let mut rng = Rng(seed ^ 0xf0_2ce5);
    let (l, m) = (size * units.length, units.mass);
    let force = m * l;
    let place = |rng: &mut Rng| Place::Cartesian {
        x: number(rng.range(-0.6, 0.6) * l),
        y: number(rng.range(-0.6, 0.6) * l),
    };
    for link in &mut model.links {
        if rng.chance(0.8) {
            link.inertia = Some(Inertia {
                mass: Some(number(rng.range(0.1, 2.0) * m)),
                moment: Some(number(rng.range(0.0, 0.5) * m * l * l)),
                center: Center::Place(place(&mut rng)),
            });
        }
    }
    let (s, c) = kempe_number::math::sin_cos(units.turn);
    let turned = |v: [f64; 2]| [c * v[0] - s * v[1], s * v[0] + c * v[1]];
    let gravity = [rng.range(-2.0, 2.0) * l, rng.range(-10.0, 1.0) * l];
    model.actions.gravity = Some(turned(gravity).map(number));
    let links = model.links.len();
    let a_point = |rng: &mut Rng, model: &Model| {
        let link = rng.below(links);
        let points = &model.links[link].points;
        LinkPointRef {
            link: LinkId(link as u32),
            point: points[rng.below(points.len())].point,
        }
    };
    let mut power = Expr::Const(0.0);
    let mut add_power = |more: Measure| {
        let so_far = std::mem::replace(&mut power, Expr::Const(0.0));
        power = Expr::Add(Box::new(so_far), Box::new(more));
    };
    let rate =
        |pose: PoseMeasure| Expr::Leaf(Leaf::Rate(Box::new(Expr::Leaf(Leaf::Pose(pose))), 1));
    let times = |a: Measure, b: Measure| Expr::Mul(Box::new(a), Box::new(b));
    for index in 0..rng.below(3) {
        model.actions.masses.push(PointMass {
            name: format!("m{index}"),
            on: LinkId(rng.below(links) as u32),
            place: place(&mut rng),
            mass: number(rng.range(0.1, 2.0) * m),
            span: 0..0,
        });
    }
    for index in 0..rng.below(3) {
        let at = a_point(&mut rng, model);
        // The file's point is on its first link; the same place whichever link carries it.
        let size = [rng.range(-3.0, 3.0) * force, rng.range(-3.0, 3.0) * force];
        let growth = rng.range(-1.0, 1.0);
        let components = turned(size).map(|x| {
            // F (1 + growth q), q the drive's path from its start: the frame's turn does not count.
            let pose = Expr::Leaf(Leaf::Time);
            let varying = times(Expr::Const(x * growth), pose);
            Expr::Add(Box::new(Expr::Const(x)), Box::new(varying))
        });
        add_power(times(components[0].clone(), rate(PoseMeasure::X(at.point))));
        add_power(times(components[1].clone(), rate(PoseMeasure::Y(at.point))));
        model.actions.loads.push(Load {
            name: format!("f{index}"),
            kind: LoadKind::Force {
                at,
                components: components.map(Amount::Measure),
                axes: kempe_model::FRAME,
            },
            span: 0..0,
        });
    }
    if rng.chance(0.5) {
        let (on, against) = (
            LinkId(rng.below(links) as u32),
            LinkId(rng.below(links) as u32),
        );
        let torque = rng.range(-3.0, 3.0) * force * l;
        add_power(times(
            Expr::Const(torque),
            rate(PoseMeasure::AngleBetween(on, against)),
        ));
        model.actions.loads.push(Load {
            name: "t".into(),
            kind: LoadKind::Torque {
                on,
                against,
                amount: Amount::Measure(Expr::Const(torque)),
            },
            span: 0..0,
        });
    }
    let same_body = {
        let mechanism = Mechanism::new(model);
        move |a: LinkId, b: LinkId| mechanism.body_of(a) == mechanism.body_of(b)
    };
    for index in 0..rng.below(4) {
        let (a, b) = (a_point(&mut rng, model), a_point(&mut rng, model));
        let acts = [Acts::Both, Acts::Tension, Acts::Compression][rng.below(3)];
        let (stiffness, free, preload) = (
            rng.range(0.1, 9.0),
            rng.range(0.0, 1.5),
            rng.range(-2.0, 2.0),
        );
        let (damping, closing) = (rng.range(0.0, 2.0), rng.range(0.0, 2.0));
        let kind = rng.below(3);
        if same_body(a.link, b.link) || a.point == b.point {
            continue;
        }
        let name = format!("s{index}");
        match kind {
            0 => model.actions.springs.push(Spring {
                name,
                between: Between::Points(a, b),
                stiffness: number(stiffness * m),
                free: number(free * l),
                preload: number(preload * force),
                stops: [Some(number(0.2 * l)), Some(number(1.2 * l))],
                stop_stiffness: Some(number(20.0 * m)),
                acts,
                span: 0..0,
            }),
            1 => model.actions.springs.push(Spring {
                name,
                between: Between::Links(a.link, b.link),
                stiffness: number(stiffness * force * l),
                // Against the frame the angle turns with it.
                free: number(free + angle_shift(a.link, b.link, units.turn)),
                preload: number(preload * force * l),
                stops: [None, None],
                stop_stiffness: None,
                acts,
                span: 0..0,
            }),
            _ => model.actions.dampers.push(Damper {
                name,
                between: if damping > 1.0 {
                    Between::Points(a, b)
                } else {
                    Between::Links(a.link, b.link)
                },
                damping: number(damping * if damping > 1.0 { m } else { force * l }),
                closing: Some(number(closing * if damping > 1.0 { m } else { force * l })),
                span: 0..0,
            }),
        }
    }
    if units.friction > 0.0 {
        model.actions.friction.push(Friction {
            at: FrictionAt::All,
            coefficient: number(units.friction),
            static_coefficient: Some(number(1.3 * units.friction)),
            stribeck_speed: Some(number(0.1 * l)),
            viscous: None,
            drag: None,
            radius: Some(number(0.03 * l)),
            span: 0..0,
        });
    }
    let rubs = (units.friction > 0.0).then(|| number(units.friction));
    give_teeth(model, &mut Rng(seed ^ 0x7ee7), rubs, |_, x| number(x));
    power
}

fn angle_shift(a: LinkId, b: LinkId, turn: f64) -> f64 {
    let of = |link: LinkId| {
        if link == kempe_model::FRAME {
            0.0
        } else {
            turn
        }
    };
    of(b) - of(a)
}

fn ask(measure: ForceMeasure) -> Measure {
    Expr::Leaf(Leaf::Force(measure))
}

fn drive_forces(model: &Model) -> Vec<Measure> {
    (0..model.drives.len())
        .map(|d| ask(ForceMeasure::Drive(DriveId(d as u32))))
        .collect()
}

/// Sizes of the loads of all pins.
fn pins(model: &Model) -> Vec<Measure> {
    (0..model.points.len())
        .filter(|p| model.points[*p].links.len() == 2)
        .map(|p| {
            ask(ForceMeasure::Reaction(JointRef::Pin(
                PointId(p as u32),
                None,
            )))
        })
        .collect()
}

struct Row {
    values: Vec<f64>,
    evidence: ForceEvidence,
    notes: Vec<ForceNote>,
    uncertain: bool,
    links: Vec<[f64; 3]>,
}

/// Rows of a loaded model; `None` where the mechanism has no regular motion.
fn rows(model: &Model, measures: &[Measure], parts: usize) -> Option<Vec<Row>> {
    rows_from_start(model, measures, &offsets(model, parts)?)
}

/// Evenly spread places inside what a model's motion reaches, from its start.
fn offsets(model: &Model, parts: usize) -> Option<Vec<f64>> {
    let mechanism = Mechanism::new(model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).ok()?;
    let inside = spread(&motion, parts + 2).into_iter().skip(1).take(parts);
    Some(inside.map(|p| p - motion.start).collect())
}

/// Rows at places counted from the start of the motion: two motions that end at a limit end at slightly different places.
fn rows_from_start(model: &Model, measures: &[Measure], offsets: &[f64]) -> Option<Vec<Row>> {
    let mechanism = Mechanism::new(model);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &parameters);
    let motion = Motion::new(&design).ok()?;
    let measures: Vec<&Measure> = measures.iter().collect();
    let mut sampler = match ForceSampler::new(&motion, &measures) {
        Ok(sampler) => sampler,
        Err(error) => panic!("{error}"),
    };
    let mut rows = Vec::new();
    for offset in offsets {
        let row = sampler.at_parameter(motion.start + offset);
        let Some(evidence) = row.evidence else {
            continue;
        };
        let regular = row.sample.note.is_none() && evidence.condition < REGULAR;
        if regular {
            rows.push(Row {
                values: row.sample.values,
                links: row.sample.links,
                evidence,
                uncertain: row.notes.iter().any(|n| {
                    matches!(
                        n,
                        ForceNote::NotUnique(_)
                            | ForceNote::Jammed { .. }
                            | ForceNote::FrictionNotConverged { .. }
                            | ForceNote::TeethPart(_)
                    )
                }),
                notes: row.notes,
            });
        }
    }
    Some(rows)
}

/// A random mechanism's model and its size.
fn mechanism(seed: u64) -> (mechanisms::Spec, Model, f64) {
    let mut spec = make(&recipe(seed)).spec;
    // The same assembly, however it is turned and scaled.
    spec.hints = true;
    let case = Case::of(&spec);
    (spec.clone(), case.model, spec.size())
}

/// Accuracy to ask for: that of the accelerations, which lose digits with the square of the condition.
fn accuracy(row: &Row) -> f64 {
    (1e-14 * row.evidence.condition * row.evidence.condition).max(1e-9)
}

fn same(what: &str, a: f64, b: f64, scale: f64, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!(
        (a - b).abs() <= tolerance * scale,
        "{what}: {a:e} and {b:e}, scale {scale:e}, off by {:e}",
        (a - b).abs() / scale
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    /// Both routes agree, every body is in equilibrium, and the energy goes where it should: the rate of kinetic and
    /// potential energy is the power of the drives and loads less that of the dampers.
    #[test]
    fn routes_agree_and_energy_balances(seed in any::<u64>()) {
        let (_, mut model, size) = mechanism(seed);
        let load_power = load(&mut model, seed, size, PLAIN);
        let energy = Expr::Add(
            Box::new(ask(ForceMeasure::KineticEnergy)),
            Box::new(ask(ForceMeasure::PotentialEnergy)),
        );
        let gain = Expr::Leaf(Leaf::Rate(Box::new(energy), 1));
        let Some(rows) = rows(&model, &[gain, load_power], 7) else { return Ok(()) };
        for row in rows {
            let e = row.evidence;
            prop_assert!(e.route_difference <= 1e-9, "{e:?}");
            prop_assert!(e.residual <= 1e-12, "{e:?}");
            if row.notes.iter().any(|n| matches!(n, ForceNote::TeethPart(_))) { continue }
            let given = e.drive_power + row.values[1] - e.damping_power;
            let scale = row.values[0].abs() + e.drive_power.abs() + row.values[1].abs() + e.damping_power;
            // Loads that give nothing are counted in the size of those that could act.
            let scale = scale + 1e-3 * size * size;
            same("energy", row.values[0], given, scale, 1e-9)?;
        }
    }

    /// Friction takes energy, both routes agree with it, and the balance holds.
    #[test]
    fn friction_never_adds_energy(seed in any::<u64>(), coefficient in 0.01_f64..0.4) {
        let (_, mut model, size) = mechanism(seed);
        let units = Units { friction: coefficient, ..PLAIN };
        let load_power = load(&mut model, seed, size, units);
        let energy = Expr::Add(
            Box::new(ask(ForceMeasure::KineticEnergy)),
            Box::new(ask(ForceMeasure::PotentialEnergy)),
        );
        let gain = Expr::Leaf(Leaf::Rate(Box::new(energy), 1));
        let Some(rows) = rows(&model, &[gain, load_power], 5) else { return Ok(()) };
        for row in rows {
            let e = row.evidence;
            if let FrictionOutcome::Jammed { part } = e.friction {
                prop_assert!(part > 0.0 && part < 1.0);
                prop_assert!(e.drive_power.is_nan());
                continue;
            }
            prop_assert!(!matches!(e.friction, FrictionOutcome::NotConverged { .. }) || row.uncertain, "{e:?}");
            if row.uncertain { continue }
            prop_assert!(e.friction_power <= 0.0, "{e:?}");
            prop_assert!(e.route_difference <= 1e-9, "{e:?} {:?}", row.notes);
            let given = e.drive_power + row.values[1] - e.damping_power + e.friction_power;
            let scale = row.values[0].abs() + e.drive_power.abs() + row.values[1].abs()
                + e.damping_power - e.friction_power;
            // Loads that give nothing are counted in the size of those that could act.
            let scale = scale + 1e-3 * size * size;
            same("energy", row.values[0], given, scale, 1e-9)?;
        }
    }

    /// Longer and heavier: drive torques grow with mass and length squared, forces with mass and length.
    #[test]
    fn forces_scale(seed in any::<u64>(), length in 0.01_f64..100.0, mass in 0.01_f64..100.0) {
        let (spec, mut plain, size) = mechanism(seed);
        let mut grown = Case::of(&spec.scaled(length)).model;
        load(&mut plain, seed, size, PLAIN);
        load(&mut grown, seed, size, Units { length, mass, ..PLAIN });
        let Some(offsets) = offsets(&plain, 3) else { return Ok(()) };
        let moving: Vec<&kempe_model::Drive> = (plain.drives.iter())
            .filter(|d| d.law.extent(&[]).0 < d.law.extent(&[]).1)
            .collect();
        let along_length = matches!(moving[..], [d] if d.dimension != kempe_units::Dimension::ANGLE);
        let of = |model: &Model, factor: f64| {
            let mut measures = drive_forces(model);
            measures.extend(pins(model));
            let offsets: Vec<f64> = offsets.iter().map(|p| p * factor).collect();
            rows_from_start(model, &measures, &offsets)
        };
        let grow = if along_length { length } else { 1.0 };
        let drives: Vec<bool> = (plain.drives.iter())
            .map(|d| d.dimension == kempe_units::Dimension::ANGLE)
            .collect();
        let (Some(a), Some(b)) = (of(&plain, 1.0), of(&grown, grow)) else { return Ok(()) };
        if a.len() != b.len() { return Ok(()) }
        for (a, b) in a.iter().zip(&b) {
            let largest = (a.values.iter().enumerate())
                .map(|(k, v)| v.abs() / if drives.get(k) == Some(&true) { size } else { 1.0 })
                .fold(1e-3 * size, f64::max);
            for (k, (x, y)) in a.values.iter().zip(&b.values).enumerate() {
                let torque = drives.get(k) == Some(&true);
                if a.uncertain && k >= drives.len() { continue }
                let factor = mass * length * if torque { length } else { 1.0 };
                let scale = largest * if torque { size } else { 1.0 };
                if x.is_nan() && y.is_nan() { continue } // a pin within one body
                same("scaled", x * factor, *y, scale * factor, accuracy(a))?;
            }
        }
    }

    /// The whole system turned and moved: drives and joints carry the same.
    #[test]
    fn forces_turn_with_the_frame(seed in any::<u64>(), turn in -3.0_f64..3.0, x in -1.0_f64..1.0, y in -1.0_f64..1.0) {
        let (spec, mut plain, size) = mechanism(seed);
        let mut moved = Case::of(&spec.moved([x * size, y * size], turn)).model;
        load(&mut plain, seed, size, PLAIN);
        load(&mut moved, seed, size, Units { turn, ..PLAIN });
        // What is fixed in the frame's own coordinates does not turn with it.
        let mechanism = Mechanism::new(&plain);
        let counts_turns = plain.joints.iter().any(|j| {
            matches!(j.kind, kempe_model::JointKind::Gears { .. }
                | kempe_model::JointKind::Belt { .. }
                | kempe_model::JointKind::Rack { .. })
        });
        for model in [&mut plain, &mut moved] {
            let fixed = |link: LinkId| mechanism.body_of(link) == kempe_mechanism::BodyId::GROUND;
            model.actions.springs.retain(|s| match s.between {
                Between::Links(a, b) => !fixed(a) && !fixed(b),
                Between::Points(..) => true,
            });
        }
        let Some(offsets) = offsets(&plain, 3) else { return Ok(()) };
        let of = |model: &Model| {
            let mut measures = drive_forces(model);
            measures.extend(pins(model));
            rows_from_start(model, &measures, &offsets)
        };
        let (Some(a), Some(b)) = (of(&plain), of(&moved)) else { return Ok(()) };
        if a.len() != b.len() { return Ok(()) }
        let angles: Vec<bool> = (plain.drives.iter())
            .map(|d| d.dimension == kempe_units::Dimension::ANGLE)
            .collect();
        for (a, b) in a.iter().zip(&b) {
            // Where an idle body lies is anybody's choice, and it does not turn with the frame.
            if a.notes.iter().any(|n| matches!(n, ForceNote::IdleBodyDriven { .. })) { continue }
            // A gear's or pinion's turns are counted from its angle at the start, which is taken between -pi and pi.
            let whole = |x: f64| if counts_turns { x } else { mechanisms::wrapped(x) };
            let turned = (1..a.links.len()).all(|l| {
                mechanism.body_of(LinkId(l as u32)) == kempe_mechanism::BodyId::GROUND
                    || whole(b.links[l][2] - a.links[l][2] - turn).abs() < 1e-6
            });
            if !turned { continue }
            let unit = |k: usize| if angles.get(k) == Some(&true) { size } else { 1.0 };
            let largest = (a.values.iter().enumerate())
                .map(|(k, v)| v.abs() / unit(k))
                .fold(1e-3 * size, f64::max);
            for (k, (x, y)) in a.values.iter().zip(&b.values).enumerate() {
                if a.uncertain && k >= angles.len() { continue }
                if x.is_nan() && y.is_nan() { continue }
                same(&format!("turned, condition {:e}", a.evidence.condition), *x, *y, largest * unit(k), accuracy(a))?;
            }
        }
    }
}
