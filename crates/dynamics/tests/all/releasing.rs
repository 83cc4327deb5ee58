//! Joints and drives let go: the load of a joint is the force of the coordinate that lets it go, and what nothing holds
//! moves as it must.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use crate::mechanisms;
use std::sync::Arc;

use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, spread};
use kempe_dynamics::{Rates, Reaction, Source};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::constraint::Source as From;
use kempe_mechanism::evidence::closure;
use kempe_mechanism::plan::{Condition, Step};
use kempe_mechanism::{Branch, Configuration, Design, Mechanism, NotReleased};
use kempe_model::{
    Center, DriveId, DriveKind, Inertia, JointId, JointKind, JointRef, Model, Place,
};
use kempe_motion::Motion;
use kempe_number::Number;
use kempe_units::{Dimension, Expr};

/// A mechanism at a pose, with or without joints let go.
struct Bench {
    design: Arc<Design<Series<f64>>>,
    branch: Branch,
    /// Places of the coordinates, those of released joints at zero.
    q: Vec<f64>,
}

impl Bench {
    /// The mechanism of a motion with this let go, at a place of the motion.
    fn new(motion: &Arc<Motion>, p: f64, released: &[From]) -> Self {
        let mut solver = motion.solver::<f64>();
        motion.solve(&motion.design, p, &mut solver);
        let mechanism = motion.mechanism().releasing(released).unwrap();
        let mut q = solver.coordinates.clone();
        q.resize(mechanism.model.drives.len(), 0.0);
        let turns = &motion.design.geometry.turns;
        let mut plain = Design::new(&mechanism, &motion.design.parameters);
        plain.count_turns(turns);
        let branch = plain.branch_through(&solver.state.poses, &solver.branch.near, &q);
        Self {
            design: Arc::new(plain.lift(Series::constant)),
            branch,
            q,
        }
    }

    fn mechanism(&self) -> &Arc<Mechanism> {
        &self.design.mechanism
    }

    /// The forces where coordinates have these speeds and accelerations.
    fn forces(&self, speeds: &[f64], accelerations: &[f64]) -> Source<f64> {
        let moving: Vec<Series<f64>> = (0..self.q.len())
            .map(|k| [self.q[k], speeds[k], accelerations[k] / 2.0, 0.0, 0.0])
            .map(Series::from_coefficients)
            .collect();
        let state = State::moving(&self.design, &self.branch, 0.0, &moving);
        let rich: Design<Rates> = {
            let given = self.design.parameters.iter();
            let parameters: Vec<Rates> = given.map(|x| Rates::from_f64(x.value())).collect();
            let mut design = Design::new(self.mechanism(), &parameters);
            design.count_turns(&self.design.geometry.turns);
            design
        };
        let mut source = Source::of(rich, &self.branch.near).unwrap();
        let amounts: Vec<Series<f64>> = (source.measures().iter())
            .map(|m| measure(&state, &History::default(), None, m, Along::Time))
            .collect();
        source.solve(&state, &amounts);
        source
    }

    /// The accelerations with the released coordinates free, all others as given.
    fn free(&self, speeds: &[f64], given: &[f64]) -> Option<Vec<f64>> {
        let source = self.forces(speeds, given);
        let equations = source.forces.equations_of_motion(&source.instant);
        let given: Vec<Rates> = given.iter().map(|a| Rates::from_f64(*a)).collect();
        let nothing = vec![Rates::from_f64(0.0); given.len()];
        let found = equations.accelerations(&self.mechanism().released, &given, &nothing)?;
        Some(found.iter().map(|a| a.value()).collect())
    }
}

/// Gives every link some mass.
fn weigh(model: &mut Model, rng: &mut Rng) {
    for link in &mut model.links {
        let mut number = |low: f64, high: f64| Expr::Const(rng.range(low, high));
        link.inertia = Some(Inertia {
            mass: Some(number(0.1, 2.0)),
            moment: Some(number(0.001, 0.01)),
            center: Center::Place(Place::Cartesian {
                x: number(-0.05, 0.05),
                y: number(-0.05, 0.05),
            }),
        });
    }
}

/// What the joint of a constraint is called in a measure, on the link that feels it.
fn joint(source: From) -> JointRef {
    match source {
        From::Pin { point, link } => JointRef::Pin(point, Some(link)),
        From::Joint(joint) => JointRef::Joint(joint, None),
        From::Drive(_) => unreachable!(),
    }
}

fn reaction(source: &Source<f64>, of: From) -> Reaction<Rates> {
    source.forces.reaction(&source.instant, joint(of)).unwrap()
}

/// Every joint that can be let go, once.
fn joints(mechanism: &Mechanism) -> Vec<From> {
    let mut list: Vec<From> = Vec::new();
    for (_, source) in &mechanism.constraints[..mechanism.joint_constraints] {
        if !list.contains(source) && mechanism.releasing(&[*source]).is_ok() {
            list.push(*source);
        }
    }
    list
}

fn random(rng: &mut Rng, own: usize, all: usize) -> Vec<f64> {
    let mut list: Vec<f64> = (0..own).map(|_| rng.range(-2.0, 2.0)).collect();
    list.resize(all, 0.0);
    list
}

/// Motions of random mechanisms and of the examples, all links with mass, without friction.
fn motions() -> Vec<(String, Arc<Motion>)> {
    let mut list = Vec::new();
    let mut add = |name: String, mut model: Model, seed: u64| {
        weigh(&mut model, &mut Rng(seed ^ 0x0b5e));
        model.actions.friction.clear();
        if let Ok(motion) = Case::from_model(model).motion() {
            list.push((name, motion));
        }
    };
    for seed in 0..120 {
        add(
            format!("seed {seed}"),
            Case::of(&make(&recipe(seed)).spec).model,
            seed,
        );
    }
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for part in ["seeds", "gallery"] {
        let mut files: Vec<_> = std::fs::read_dir(folder.join(part))
            .unwrap()
            .flatten()
            .collect();
        files.sort_by_key(|file| file.file_name());
        for (seed, file) in (0..).zip(files) {
            let name = format!("{part}/{}", file.file_name().to_str().unwrap());
            if let Some(name) = name.strip_suffix(".toml") {
                let model = Case::example(name).model;
                // Loads that go by switches are those of simulations.
                if model.actions.switches.is_empty() {
                    add(name.to_owned(), model, seed);
                }
            }
        }
    }
    list
}

/// Closed forms take joints that stand open: what they find closes all loops, near the pose from which it opens.
#[test]
fn joints_that_stand_open_close_their_loops() {
    // Openings, in mechanism sizes and rad; limits leave no pose there, or send one far away.
    const OPEN: f64 = 1e-4;
    const NEAR: f64 = 0.1;
    let mut rng = Rng(29);
    let (mut apart, mut beside, mut far, mut all) = (0, 0, 0, 0);
    for (name, motion) in motions() {
        let size = motion.design.size();
        for p in spread(&motion, 2) {
            let mut joints = joints(motion.mechanism());
            while joints.len() > 3 {
                let at = (rng.range(0.0, 1.0) * joints.len() as f64) as usize;
                joints.swap_remove(at.min(joints.len() - 1));
            }
            let Ok(mechanism) = motion.mechanism().releasing(&joints) else {
                continue;
            };
            // Overconstrained mechanisms have no pose where one of their joints opens alone.
            let plan = &mechanism.plan;
            if !plan.decomposition.surplus.is_empty()
                || plan.blocks.iter().any(|block| !block.surplus.is_empty())
            {
                continue;
            }
            let mut bench = Bench::new(&motion, p, &joints);
            let design = Design::new(&mechanism, &motion.design.parameters);
            let mut state = Configuration::new(&mechanism);
            for (q, drive) in bench.q.iter_mut().zip(&mechanism.model.drives) {
                if let DriveKind::Release { .. } = drive.kind {
                    let unit = if drive.dimension == Dimension::LENGTH {
                        size
                    } else {
                        1.0
                    };
                    *q += OPEN * unit * rng.range(-1.0, 1.0);
                }
            }
            state.set_inputs(&mechanism, &bench.q);
            design.solve(&bench.branch, &mut state);
            let off = closure(&design, &bench.branch, &state, size);
            let poses = state.poses.iter().zip(&bench.branch.guess);
            let moved = poses
                .map(|(a, b)| ((a.x - b.x).abs() + (a.y - b.y).abs()) / size + (a.c - b.c).abs())
                .fold(0.0, f64::max);
            all += 1;
            if !(moved < NEAR) || !off.is_finite() {
                far += 1;
                continue;
            }
            assert!(off < 1e-12, "{name} at {p}, {joints:?}: {off:e}");
            let steps = mechanism.plan.steps.iter();
            apart += steps
                .clone()
                .filter(|s| matches!(s, Step::Apart(_)))
                .count();
            let is_beside = |s: &&Step| match s.closed() {
                Step::Swing(swing) => matches!(swing.condition, Condition::BesideLine { .. }),
                Step::Cross { conditions, .. } => conditions.iter().any(|c| {
                    matches!(
                        c,
                        Condition::BesideLine { .. } | Condition::LineBeside { .. }
                    )
                }),
                _ => false,
            };
            beside += steps.filter(is_beside).count();
        }
    }
    println!("{all} mechanisms, {apart} open groups, {beside} lines; {far} without a pose near");
    assert!(
        apart > 150 && beside > 10 && 10 * far < all,
        "{all} {apart} {beside} {far}"
    );
}

#[test]
fn loads_are_the_forces_of_what_lets_a_joint_go() {
    let mut rng = Rng(11);
    let mut compared = std::collections::BTreeMap::new();
    for (name, motion) in motions() {
        for p in spread(&motion, 2) {
            let whole = Bench::new(&motion, p, &[]);
            let own = whole.q.len();
            let (v, a) = (random(&mut rng, own, own), random(&mut rng, own, own));
            let held = whole.forces(&v, &a);
            let loose = held.forces.equilibrium.not_unique();
            for of in joints(motion.mechanism()) {
                let constraints = motion.mechanism().constraints.iter().enumerate();
                let mut own_rows = constraints.filter(|(_, (_, source))| *source == of);
                if own_rows.any(|(index, _)| loose.contains(&index)) {
                    continue;
                }
                let open = Bench::new(&motion, p, &[of]);
                let pad = |list: &[f64]| {
                    let mut list = list.to_vec();
                    list.resize(open.q.len(), 0.0);
                    list
                };
                let found = open.forces(&pad(&v), &pad(&a));
                let released = &open.mechanism().released;
                let gives = |k: usize| {
                    let drive = &found.forces.drives[released[k].index()];
                    (drive.by_power.value.value(), drive.by_equilibrium.value())
                };
                let (before, after) = (reaction(&held, of), reaction(&found, of));
                let sides = held.forces.sides.iter().flatten();
                let size = sides.flat_map(|side| side.wrench.map(|w| w.value().abs()));
                let size = size.fold(1.0, f64::max);
                let known = before.force[0].value().is_finite() && size < 1e5;
                // At limits and change points the coordinates do not say how the mechanism moves.
                if !known || !(0..released.len()).all(|k| gives(k).0.is_finite()) {
                    continue;
                }
                let what = format!("{name} at {p}: {of:?}");
                let force = before.force.map(|f| f.value());
                let near = |found: f64, wanted: f64, what: &str| {
                    assert!(
                        (found - wanted).abs() <= 1e-7 * size,
                        "{what}: {found} is not {wanted} (of {size})"
                    );
                };
                for k in 0..released.len() {
                    let (by_power, by_equilibrium) = gives(k);
                    near(by_power, by_equilibrium, &format!("{what}, coordinate {k}"));
                }
                let kind = match of {
                    From::Pin { .. } => {
                        // Along the frame's axes, on the later link.
                        for k in 0..2 {
                            near(gives(k).0, force[k], &what);
                        }
                        "pin"
                    }
                    From::Joint(id) => match &motion.mechanism().model.joints[id.index()].kind {
                        JointKind::Slider { .. } => {
                            near(gives(0).0.abs(), before.moment.value().abs(), &what);
                            near(gives(1).0.abs(), mechanisms::norm(force), &what);
                            "slider"
                        }
                        JointKind::Slot { .. } | JointKind::ArcSlot { .. } => {
                            near(gives(0).0.abs(), mechanisms::norm(force), &what);
                            "slot"
                        }
                        _ => "toothed",
                    },
                    From::Drive(_) => unreachable!(),
                };
                // Gears and belts, let go, are held by torques: where they mesh is not asked any more.
                if kind != "toothed" {
                    for k in 0..2 {
                        near(after.force[k].value(), force[k], &what);
                    }
                }
                *compared.entry(kind).or_insert(0) += 1;
            }
        }
    }
    println!("{compared:?}");
    for (kind, least) in [("pin", 300), ("slider", 30), ("slot", 10), ("toothed", 10)] {
        assert!(
            compared.get(kind).is_some_and(|n| *n >= least),
            "{compared:?}"
        );
    }
}

#[test]
fn what_is_let_go_moves_so_that_nothing_need_hold_it() {
    let mut rng = Rng(12);
    let mut compared = 0;
    for (name, motion) in motions() {
        let p = spread(&motion, 1)[0];
        let joints = joints(motion.mechanism());
        let drives = motion.mechanism().model.drives.len();
        if joints.is_empty() {
            continue;
        }
        let mut open = vec![joints[rng.below(joints.len())]];
        open.extend((0..drives).map(|d| From::Drive(DriveId(d as u32))));
        let bench = Bench::new(&motion, p, &open);
        let all = bench.q.len();
        let plan = &bench.mechanism().plan.decomposition;
        // What other joints say as well has no coordinate of its own.
        if !plan.surplus.is_empty() || plan.blocks.iter().any(|block| !block.surplus.is_empty()) {
            continue;
        }
        // A joint that closes no loop, or closes one that others close, too, moves nothing by itself.
        let v = random(&mut rng, all, all);
        let Some(a) = bench.free(&v, &vec![0.0; all]) else {
            continue;
        };
        let size = a.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        if size.is_nan() || size > 1e6 {
            continue;
        }
        let found = bench.forces(&v, &a);
        let equations = found.forces.equations_of_motion(&found.instant);
        let mut largest = 1.0_f64;
        for (row, drive) in found.forces.drives.iter().enumerate() {
            let terms = a.iter().enumerate();
            let scale = terms.fold(equations.bias[row].value().abs().max(1.0), |sum, (k, a)| {
                sum + (equations.mass_at(row, k).value() * a).abs()
            });
            largest = largest.max(scale);
            for force in [drive.by_power.value, drive.by_equilibrium] {
                assert!(
                    force.value().abs() <= 1e-9 * scale,
                    "{name}: coordinate {row} needs {} of {scale}",
                    force.value()
                );
            }
        }
        let load = reaction(&found, open[0]).force.map(|f| f.value());
        assert!(
            mechanisms::norm(load) <= 1e-9 * largest,
            "{name}: {load:?} of {largest}"
        );
        compared += 1;
    }
    assert!(compared > 60, "{compared}");
}

/// A four-bar whose coupler lets go of its rocker and whose motor is off: a double pendulum and a pendulum.
#[test]
fn an_opened_four_bar_is_two_pendulums() {
    const G: f64 = 9.81;
    let text = "gravity = [0, \"-9.81 m/s^2\"]
[links]
frame = { A = [0, 0], D = [1, 0] }
crank = { A-B = 0.3, mass = \"2 kg\", inertia = \"0.05 kg m^2\", center = [0.1, 0] }
coupler = { B-C = 0.9, mass = \"3 kg\", inertia = \"0.2 kg m^2\", center = [0.4, 0] }
rocker = { D-C = 0.7, mass = \"1 kg\", inertia = \"0.1 kg m^2\", center = [0.5, 0] }
[drives]
motor = { turns = \"crank\", from = 40, to = 100, speed = \"1 rad/s\" }
[assembly]
C = \"left of B -> D\"
";
    let case = Case::read(text, "opened.toml");
    let motion = case.must_move();
    let of = joints(motion.mechanism());
    let model = &motion.mechanism().model;
    let c = |source: &&From| matches!(source, From::Pin { point, .. } if model.points[point.index()].name == "C");
    let c = *of.iter().find(c).unwrap();
    let bench = Bench::new(
        &motion,
        spread(&motion, 1)[0],
        &[c, From::Drive(DriveId(0))],
    );
    let v = [1.3, -0.7, 0.4];
    let a = bench.free(&v, &[0.0; 3]).unwrap();
    let found = bench.forces(&v, &a);
    let body = |link: usize| {
        let at = &found.instant;
        let body = bench.mechanism().seats[link].body.index();
        let (pose, speed) = (&at.poses[body], at.velocities[body][2].value());
        let angle = pose.s.value().atan2(pose.c.value());
        (angle, speed, at.accelerations[body][2].value())
    };
    let [(t1, w1, a1), (t2, w2, a2), (t3, _, a3)] = [1, 2, 3].map(body);
    let near =
        |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-10, "{found} {wanted}");
    near(a3, -0.5 * G * t3.cos() / (0.1 + 0.25));
    // Lagrange, both angles from the x axis.
    let (m1, d1, j1, l1, m2, d2, j2) = (2.0, 0.1, 0.05, 0.3, 3.0, 0.4, 0.2);
    let coupling = m2 * l1 * d2;
    let (c12, s12) = ((t1 - t2).cos(), (t1 - t2).sin());
    near(
        (j1 + m1 * d1 * d1 + m2 * l1 * l1) * a1 + coupling * (c12 * a2 + s12 * w2 * w2),
        -G * (m1 * d1 + m2 * l1) * t1.cos(),
    );
    near(
        coupling * (c12 * a1 - s12 * w1 * w1) + (j2 + m2 * d2 * d2) * a2,
        -G * m2 * d2 * t2.cos(),
    );
}

#[test]
fn what_cannot_be_let_go_is_refused() {
    let case = Case::example("gallery/wiper");
    let mechanism = Mechanism::new(&case.model);
    let weld = From::Joint(JointId(0));
    let pin = joints(&mechanism)[0];
    assert_eq!(
        mechanism.releasing(&[weld]).unwrap_err(),
        NotReleased::NoConstraint(weld)
    );
    assert_eq!(
        mechanism.releasing(&[pin, pin]).unwrap_err(),
        NotReleased::Twice(pin)
    );
    let drive = From::Drive(DriveId(0));
    let open = mechanism.releasing(&[pin, drive]).unwrap();
    assert_eq!(open.released, [DriveId(1), DriveId(2), DriveId(0)]);
    assert_eq!(
        open.releasing(&[drive]).unwrap_err(),
        NotReleased::Twice(drive)
    );
    let none = From::Drive(DriveId(9));
    assert_eq!(
        open.releasing(&[none]).unwrap_err(),
        NotReleased::NoConstraint(none)
    );
    // Files cannot say it: the file has the joint whole.
    assert_eq!(open.model.to_toml().toml, case.model.to_toml().toml);
}

/// A lever whose place is the frame's origin, held by rows of joints alone: how near its place is to zero says nothing of how far it is from there.
#[test]
fn a_place_at_the_origin_is_found_all_along_a_motion() {
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { S = [0, 0], A = [0, 80] }\ncrank = { A-B = 30 }\n\
                lever = { S-T = 200 }\n[joints]\nslot = { pin = \"B\", on = \"S -> T\" }\n[drives]\nmotor = { turns = \"crank\", speed = \"1 rad/s\" }\n\
                [assembly]\nlever = { near = \"70 deg\" }\n[measures]\nswing = \"angle(lever)\"\n";
    let read = Model::from_toml(text, "lever", &mut |_| Err(String::new()));
    let model = read.unwrap().model;
    let closed = Mechanism::new(&model);
    let sources = closed.structure.constraints.iter().map(|(_, from)| *from);
    let lets_go = |from: &From| match from {
        From::Pin { point, .. } => model.points[point.index()].name == "S",
        From::Joint(_) => true,
        From::Drive(_) => false,
    };
    let which: Vec<From> = sources.filter(lets_go).collect();
    let open = closed.releasing(&which).unwrap();
    assert!(matches!(open.plan.steps.last(), Some(Step::Newton { .. })));
    let measures = [&model.measures[0].measure];
    let angles = [closed, open].map(|mechanism| {
        let design = Design::new(&mechanism, &model.parameter_values());
        let motion = Arc::new(Motion::new(&design).unwrap());
        let mut sampler = kempe_measure::Sampler::new(&motion, &measures).unwrap();
        let angle = |k: u32| sampler.at_parameter(f64::from(k) * 0.01).values[0];
        (0..=628).map(angle).collect::<Vec<f64>>()
    });
    for (closed, open) in angles[0].iter().zip(&angles[1]) {
        assert!((closed - open).abs() < 1e-14, "{closed} {open}");
    }
}
