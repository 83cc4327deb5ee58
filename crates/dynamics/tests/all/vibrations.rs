//! Natural vibrations against closed forms, against differences of energies, and against the motion in time.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, spread};
use kempe_dynamics::{
    Forces, Instant, LetGo, Linearised, Lineariser, Mode, NoModes, Source, Unsettled, energy,
    modes, settle,
};
use kempe_integrate::{Integrator, Method, Tolerance};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{ForceSource, Series, State};
use kempe_mechanism::Mechanism;
use kempe_mechanism::{Branch, Design};
use kempe_model::{
    Acts, Between, Center, Damper, DriveId, Inertia, LinkPointRef, Model, Place, Spring,
};
use kempe_motion::{Motion, Silent, Stance};
use kempe_number::Number;
use kempe_units::Expr;

/// A mechanism standing at the start of its drives, some of which are let go.
struct Bench {
    stance: Stance,
    lineariser: Lineariser,
    free: Vec<DriveId>,
    motion: Arc<Motion>,
}

impl Bench {
    fn on(motion: Arc<Motion>, p: f64) -> Option<Self> {
        let stance = Stance::on(&motion, p)?;
        let drives = motion.mechanism().model.drives.len() as u32;
        let start = Stance::on(&motion, motion.start)?;
        Some(Self {
            lineariser: Lineariser::new(&motion.design, &start.branch().near).ok()?,
            stance,
            free: (0..drives).map(DriveId).collect(),
            motion,
        })
    }

    fn new(text: &str) -> Self {
        let read = Model::from_toml(text, "bench", &mut |_| Err("no files".into())).unwrap();
        let mechanism = Mechanism::new(&read.model);
        let design = Design::new(&mechanism, &read.model.parameter_values());
        let motion = Motion::new(&design).unwrap();
        let start = motion.start;
        Self::on(motion, start).unwrap()
    }

    fn linearised(&mut self) -> Linearised {
        let (branch, q) = (self.stance.branch(), self.stance.coordinates());
        self.lineariser.at(branch, q, 0.0, &self.free)
    }

    fn modes(&mut self) -> Vec<Mode> {
        modes(&self.linearised()).unwrap()
    }

    fn settle(&mut self) -> Result<Linearised, Unsettled> {
        settle(
            &mut self.stance,
            &mut self.lineariser,
            0.0,
            &self.free,
            &mut Silent,
        )
    }

    /// Potential energy with the coordinates so far from the pose.
    fn potential(&self, away: &[f64]) -> f64 {
        let q: Vec<f64> = (self.stance.coordinates().iter().zip(away))
            .map(|(q, x)| q + x)
            .collect();
        let still = vec![0.0; q.len()];
        let source = solved(&self.motion, self.stance.branch(), &q, &still);
        energy::potential(
            &source.forces.acting,
            &source.forces.design.geometry,
            &source.instant,
        )
        .value()
    }
}

/// Forces where the drives stand at `q` with these speeds.
fn solved(motion: &Arc<Motion>, branch: &Branch, q: &[f64], v: &[f64]) -> Source<f64> {
    let moving: Vec<Series<f64>> = (q.iter().zip(v))
        .map(|(q, v)| Series::from_coefficients([*q, *v, 0.0, 0.0, 0.0]))
        .collect();
    let design = Arc::new(motion.design_on::<Series<f64>>());
    let state = State::moving(&design, branch, 0.0, &moving);
    let mut source = Source::new(motion, &motion.design.parameters).unwrap();
    let amounts: Vec<Series<f64>> = (source.measures().iter())
        .map(|m| measure(&state, &History::default(), None, m, Along::Time))
        .collect();
    source.solve(&state, &amounts);
    source
}

fn close(found: f64, exact: f64, part: f64) {
    assert!(
        (found - exact).abs() <= part * exact.abs(),
        "{found}, not {exact}"
    );
}

const PENDULUM: &str =
    "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = { O = [0, 0] }\nrod = { O-P = 2 }\n";

#[test]
fn a_pendulum_swings_as_its_length_says() {
    let bob = "[masses]\nbob = { at = \"P\", mass = \"3 kg\" }\n";
    let mut hangs = Bench::new(&format!(
        "{PENDULUM}[drives]\nswing = {{ turns = \"rod\", at = -90 }}\n{bob}"
    ));
    let [mode] = &hangs.modes()[..] else { panic!() };
    close(mode.square, 9.81 / 2.0, 1e-15);
    let upright = format!("{PENDULUM}[drives]\nswing = {{ turns = \"rod\", at = 90 }}\n{bob}");
    let mut upright = Bench::new(&upright);
    let [mode] = &upright.modes()[..] else {
        panic!()
    };
    close(mode.growth(), (9.81_f64 / 2.0).sqrt(), 1e-15);
    // It stands on its unstable place; a little beside it, it falls to the side to which it leans.
    upright.settle().unwrap();
    close(upright.stance.coordinates()[0], PI / 2.0, 1e-15);
    for (angle, rests) in [
        (91.0, 1.5 * PI),
        (89.0, -PI / 2.0),
        (0.0, -PI / 2.0),
        (200.0, 1.5 * PI),
    ] {
        let mut leans = Bench::new(&format!(
            "{PENDULUM}[drives]\nswing = {{ turns = \"rod\", at = {angle} }}\n{bob}"
        ));
        let there = leans.settle().unwrap();
        close(leans.stance.coordinates()[0], rests, 1e-13);
        assert!(there.imbalance() < 1e-12);
    }
}

#[test]
fn a_compound_pendulum_with_torsion_spring_and_friction() {
    // 2 kg, 0.3 kg m^2 at 0.6 m; 25 N m/rad, 0.4 N m s/rad in the damper, 0.1 in the pin.
    let mut bench = Bench::new(
        "gravity = [0, \"-9.81 m/s^2\"]\nunits = { angle = \"rad\" }\n[links]\nframe = { O = [0, 0] }\n\
         rod = { O = [0, 0], P = [1, 0], mass = 2, inertia = 0.3, center = [0.6, 0] }\n\
         [drives]\nswing = { turns = \"rod\", at = \"-90 deg\" }\n\
         [springs]\ncoil = { links = [\"frame\", \"rod\"], stiffness = \"25 N m/rad\", free = \"-90 deg\" }\n\
         [dampers]\noil = { links = [\"frame\", \"rod\"], damping = \"0.4 N m s\" }\n\
         [friction]\nO = { viscous = \"0.1 N m s\" }\n",
    );
    let inertia = 0.3 + 2.0 * 0.36;
    let stiffness = 25.0 + 2.0 * 9.81 * 0.6;
    let it = bench.linearised();
    close(it.mass[0], inertia, 1e-14);
    close(it.stiffness[0], stiffness, 1e-14);
    close(it.damping[0], 0.5, 1e-14);
    let [mode] = &bench.modes()[..] else { panic!() };
    let frequency = (stiffness / inertia).sqrt();
    close(mode.angular_frequency().unwrap(), frequency, 1e-14);
    close(
        mode.damping_ratio().unwrap(),
        0.5 / (2.0 * inertia * frequency),
        1e-13,
    );
}

#[test]
fn a_double_pendulum_swings_as_textbooks_say() {
    // Equal masses and lengths: w^2 = (2 -+ sqrt 2) g / l, shapes 1 : +-sqrt 2 in the rods' own angles.
    let mut bench = Bench::new(
        "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = { O = [0, 0] }\nupper = { O-P = 0.7 }\nlower = { P-Q = 0.7 }\n\
         [drives]\na = { turns = \"upper\", at = -90 }\nb = { turns = \"lower\", at = -90 }\n\
         [masses]\nm = { at = \"P\", mass = 1.3 }\nn = { at = \"Q\", mass = 1.3 }\n",
    );
    let found = bench.modes();
    for (mode, sign) in found.iter().zip([-1.0, 1.0]) {
        close(
            mode.square,
            (2.0 + sign * 2.0_f64.sqrt()) * 9.81 / 0.7,
            1e-14,
        );
        close(mode.shape[1] / mode.shape[0], -sign * 2.0_f64.sqrt(), 1e-13);
    }
}

#[test]
fn a_mass_on_springs_through_a_slider() {
    let text = |acts: &str| {
        format!(
            "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = {{ O = [0, 0], X = [0, -1] }}\nblock = {{ C = [0, 0], mass = 4, inertia = 1 }}\n\
             [joints]\nguide = {{ slider = \"block\", at = \"C\", on = \"O -> X\" }}\n[drives]\nfall = {{ slides = \"guide\", at = 0.5 }}\n\
             [springs]\ncoil = {{ between = \"O-C\", stiffness = 900, free = 0.3{acts} }}\n\
             [dampers]\noil = {{ between = \"O-C\", damping = 6, closing = 18 }}\n[friction]\nguide = {{ viscous = 2, coefficient = 0.1 }}\n"
        )
    };
    for acts in ["", ", acts = \"tension\""] {
        let mut bench = Bench::new(&text(acts));
        bench.settle().unwrap();
        close(
            bench.stance.coordinates()[0],
            0.3 + 4.0 * 9.81 / 900.0,
            1e-14,
        );
        let [mode] = &bench.modes()[..] else { panic!() };
        close(mode.square, 225.0, 1e-13);
        // The mean of both ways, and the guide's.
        close(
            mode.damping_ratio().unwrap(),
            14.0 / (2.0 * 4.0 * 15.0),
            1e-12,
        );
        assert_eq!(bench.lineariser.left_out().uneven_dampers, [0]);
        assert!(bench.lineariser.left_out().dry_friction);
    }
    // Pushed only, it falls on for ever.
    let mut falls = Bench::new(&text(", acts = \"compression\""));
    assert!(matches!(
        falls.settle(),
        Err(Unsettled::NoEnd | Unsettled::AtLimit)
    ));
}

#[test]
fn a_load_that_follows_position_speed_and_acceleration_counts_in_every_matrix() {
    let mut bench = Bench::new(
        "gravity = [0, 0]\nunits = { angle = \"rad\" }\n[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1, mass = 3, inertia = 0.5, center = \"P\" }\n\
         [drives]\nswing = { turns = \"rod\", at = 0.4 }\n\
         [loads]\nall = { torque = \"-7 N m * (angle(rod) - 0.4 rad) / 1 rad - 0.9 N m s * rate(angle(rod)) - 0.25 N m s^2 * rate(angle(rod), 2)\", on = \"rod\" }\n",
    );
    let it = bench.linearised();
    close(it.mass[0], 3.75, 1e-14);
    close(it.damping[0], 0.9, 1e-14);
    close(it.stiffness[0], 7.0, 1e-14);
    assert!(it.force[0].abs() < 1e-15);
}

#[test]
fn a_motor_that_never_lets_go_has_no_equilibrium() {
    let mut bench = Bench::new(
        "gravity = [0, 0]\n[links]\nframe = { O = [0, 0] }\nrod = { O-P = 1, mass = 3, inertia = 0.5 }\n\
         [drives]\nswing = { turns = \"rod\", at = 0 }\n[loads]\npush = { torque = \"1 N m\", on = \"rod\" }\n",
    );
    assert_eq!(bench.settle(), Err(Unsettled::NoEnd));
}

/// A random mechanism with masses, springs and dampers of all kinds, without what has no potential.
fn sprung(seed: u64) -> Option<(Arc<Motion>, Rng)> {
    let mut rng = Rng(seed ^ 0x51b2);
    let mut model = Case::of(&make(&recipe(seed)).spec).model;
    for link in &mut model.links {
        let mut number = |low: f64, high: f64| Expr::Const(rng.range(low, high));
        link.inertia = Some(Inertia {
            mass: Some(number(0.5, 2.0)),
            moment: Some(number(0.01, 0.05)),
            center: Center::Place(Place::Cartesian {
                x: number(-0.05, 0.05),
                y: number(-0.05, 0.05),
            }),
        });
    }
    let carried: Vec<LinkPointRef> = (0..)
        .zip(&model.points)
        .flat_map(|(p, point)| {
            let point_id = kempe_model::PointId(p);
            point.links.iter().map(move |link| LinkPointRef {
                link: *link,
                point: point_id,
            })
        })
        .collect();
    for k in 0..4 {
        let (a, b) = (
            carried[rng.below(carried.len())],
            carried[rng.below(carried.len())],
        );
        if a.link == b.link || a.point == b.point {
            continue;
        }
        let between = match rng.chance(0.3) {
            true => Between::Links(a.link, b.link),
            false => Between::Points(a, b),
        };
        model.actions.springs.push(Spring {
            name: format!("s{k}"),
            between: between.clone(),
            stiffness: Expr::Const(rng.range(20.0, 300.0)),
            free: Expr::Const(rng.range(0.0, 0.3)),
            preload: Expr::Const(rng.range(-5.0, 5.0)),
            acts: Acts::Both,
            stops: [None, None],
            stop_stiffness: None,
            span: 0..0,
        });
        model.actions.dampers.push(Damper {
            name: format!("d{k}"),
            between,
            damping: Expr::Const(rng.range(0.1, 3.0)),
            closing: None,
            span: 0..0,
        });
    }
    Some((Case::from_model(model).motion().ok()?, rng))
}

#[test]
fn stiffness_mass_and_damping_are_those_of_the_energies() {
    let (mut compared, mut of_several, mut entries, mut exact) = (0, 0, 0, 0);
    for seed in 0..140 {
        let Some((motion, mut rng)) = sprung(seed) else {
            continue;
        };
        for p in spread(&motion, 2) {
            let Some(mut bench) = Bench::on(motion.clone(), p) else {
                continue;
            };
            let it = bench.linearised();
            let n = it.size;
            let most = it
                .mass
                .iter()
                .chain(&it.stiffness_terms)
                .fold(0.0_f64, |m, x| m.max(x.abs()));
            // At limits coordinates of the drives do not say how the mechanism moves on.
            if !it.is_finite() || most > 1e4 || !bench.lineariser.springs_at_kinks().is_empty() {
                continue;
            }
            for i in 0..n {
                for j in 0..n {
                    let skew = (it.stiffness[i * n + j] - it.stiffness[j * n + i]).abs();
                    assert!(
                        skew <= 1e-12 * most.max(1.0),
                        "seed {seed}: {skew:e} of {most:e}"
                    );
                    // Second differences of the potential energy, of order 4, by the step that suits the mechanism best.
                    let off = |h: f64| {
                        let at = |a: f64, b: f64| {
                            let mut away = vec![0.0; n];
                            away[i] += a * h;
                            away[j] += b * h;
                            bench.potential(&away)
                        };
                        let cross = |s: f64| {
                            (at(s, s) - at(s, -s) - at(-s, s) + at(-s, -s)) / (4.0 * s * s * h * h)
                        };
                        ((4.0 * cross(0.5) - cross(1.0)) / 3.0 - it.stiffness[i * n + j]).abs()
                    };
                    let off = [4e-3, 1e-3, 2.5e-4, 6e-5]
                        .map(off)
                        .into_iter()
                        .fold(f64::INFINITY, f64::min);
                    // Differences of the forces found by virtual power, the other way to the same.
                    let by_force = |h: f64| {
                        let at = |x: f64| {
                            let mut q = bench.stance.coordinates().to_vec();
                            q[j] += x * h;
                            let source = solved(&motion, bench.stance.branch(), &q, &vec![0.0; n]);
                            let equations = source.forces.equations_of_motion(&source.instant);
                            equations.bias[i].value()
                        };
                        ((at(1.0) - at(-1.0)) / (2.0 * h) - it.stiffness[i * n + j]).abs()
                    };
                    let least = [1e-4, 1e-5, 1e-6]
                        .map(by_force)
                        .into_iter()
                        .fold(f64::INFINITY, f64::min);
                    assert!(
                        least <= 1e-4 * most.max(1.0),
                        "seed {seed}: {least} of {most}"
                    );
                    entries += 1;
                    exact += usize::from(off <= 1e-6 * most.max(1.0));
                }
            }
            // The kinetic energy and the power of the dampers at random speeds.
            let v: Vec<f64> = (0..n).map(|_| rng.range(-2.0, 2.0)).collect();
            let source = solved(
                &motion,
                bench.stance.branch(),
                bench.stance.coordinates(),
                &v,
            );
            let acting = &source.forces.acting;
            let square =
                |m: &[f64]| -> f64 { (0..n * n).map(|k| v[k / n] * m[k] * v[k % n]).sum() };
            let kinetic = energy::kinetic(acting, &source.instant).value();
            assert!((square(&it.mass) / 2.0 - kinetic).abs() <= 1e-10 * kinetic.max(1e-3));
            let geometry = &source.forces.design.geometry;
            let taken = energy::dissipation(acting, geometry, &source.instant).value();
            assert!(
                (square(&it.damping) - taken).abs() <= 1e-10 * taken.max(1e-3),
                "seed {seed}"
            );
            compared += 1;
            of_several += usize::from(n > 1);
        }
    }
    assert!(exact * 10 > entries * 9, "{exact} of {entries}");
    assert!(
        compared > 80 && of_several > 12,
        "{compared} compared, {of_several} of several drives"
    );
}

#[test]
fn equilibria_have_the_least_energy_around() {
    let (mut found, mut stable) = (0, 0);
    for seed in 0..60 {
        let Some((motion, _)) = sprung(seed) else {
            continue;
        };
        let Some(mut bench) = Bench::on(motion.clone(), motion.start) else {
            continue;
        };
        let before = bench.potential(&vec![0.0; bench.free.len()]);
        let Ok(it) = bench.settle() else { continue };
        // At limits coordinates of the drives do not say how the mechanism moves on.
        if it.mass.iter().any(|m| *m > 1e4) {
            continue;
        }
        assert!(it.imbalance() < 1e-10, "seed {seed}");
        found += 1;
        let n = it.size;
        let here = bench.potential(&vec![0.0; n]);
        assert!(
            here <= before + 1e-12 * before.abs().max(1.0),
            "seed {seed}: {here} over {before}"
        );
        if modes(&it).unwrap().iter().all(|m| m.square > 0.0) {
            stable += 1;
            for k in 0..n {
                for h in [-1e-5, 1e-5] {
                    let mut away = vec![0.0; n];
                    away[k] = h;
                    assert!(bench.potential(&away) > here, "seed {seed}");
                }
            }
        }
    }
    assert!(
        found > 15 && stable * 10 > found * 9,
        "{found} found, {stable} stable"
    );
}

/// A four-bar held up by a diagonal spring.
fn four_bar(k: f64) -> String {
    format!(
        "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = {{ A = [0, 0], D = [{}, 0] }}\ncrank = {{ A-B = {}, mass = 1, inertia = {} }}\n\
         coupler = {{ B-C = {}, mass = 2, inertia = {} }}\nrocker = {{ D-C = {}, mass = 1.5, inertia = {} }}\n\
         [assembly]\nC = \"left of B -> D\"\n[drives]\nmotor = {{ turns = \"crank\", at = 70 }}\n\
         [springs]\ndiagonal = {{ between = \"A-C\", stiffness = {}, free = {} }}\n\
         [dampers]\noil = {{ between = \"A-C\", damping = {} }}\n",
        0.5 * k,
        0.2 * k,
        0.01 * k * k,
        0.45 * k,
        0.03 * k * k,
        0.4 * k,
        0.02 * k * k,
        800.0 / k,
        0.35 * k,
        4.0 / k.sqrt()
    )
}

#[test]
fn a_sprung_four_bar_by_reduced_mass_and_energy_and_at_any_scale() {
    let mut bench = Bench::new(&four_bar(1.0));
    let it = bench.settle().unwrap();
    // Differences of the potential energy over the drive, of order 8, and the reduced mass from the kinetic energy.
    let h = 0.02;
    let at = |x: f64| bench.potential(&[x]);
    let weights = [
        -205.0 / 72.0,
        8.0 / 5.0,
        -1.0 / 5.0,
        8.0 / 315.0,
        -1.0 / 560.0,
    ];
    let second: f64 = (0..5)
        .map(|k| weights[k] * (at(k as f64 * h) + if k == 0 { 0.0 } else { at(-(k as f64) * h) }))
        .sum();
    let source = solved(
        &bench.motion,
        bench.stance.branch(),
        bench.stance.coordinates(),
        &[1.0],
    );
    let mass = 2.0 * energy::kinetic(&source.forces.acting, &source.instant).value();
    let [mode] = &modes(&it).unwrap()[..] else {
        panic!()
    };
    close(mode.square, second / (h * h) / mass, 1e-8);
    // Lengths by k, gravity kept: times go as the root of k.
    for k in [1e-3_f64, 1e3] {
        let mut scaled = Bench::new(&four_bar(k));
        let there = modes(&scaled.settle().unwrap()).unwrap();
        close(
            scaled.stance.coordinates()[0],
            bench.stance.coordinates()[0],
            1e-12,
        );
        close(there[0].square * k, mode.square, 1e-11);
        close(
            there[0].damping_ratio().unwrap(),
            mode.damping_ratio().unwrap(),
            1e-11,
        );
    }
}

/// The motion in time from `away` of the pose, at rest, until `time`: the first coordinate at even times.
fn swing(bench: &Bench, away: &[f64], times: &[f64]) -> Vec<f64> {
    let n = away.len();
    let mut start: Vec<f64> = (bench.stance.coordinates().iter().zip(away))
        .map(|(q, x)| q + x)
        .collect();
    start.extend(vec![0.0; n]);
    let mut rates = |_: f64, y: &[f64], rates: &mut [f64]| {
        let (q, v) = y.split_at(n);
        let source = solved(&bench.motion, bench.stance.branch(), q, v);
        let equations = source.forces.equations_of_motion(&source.instant);
        let nothing = vec![Number::from_f64(0.0); n];
        let Some(found) = equations.accelerations(&bench.free, &nothing, &nothing) else {
            return false;
        };
        rates[..n].copy_from_slice(v);
        (0..n).for_each(|k| rates[n + k] = found[k].value());
        true
    };
    let tolerance = Tolerance {
        relative: 1e-12,
        absolute: vec![1e-16],
    };
    let mut it =
        Integrator::with(Method::Explicit, &mut rates, 0.0, &start, 1e-2, tolerance).unwrap();
    let mut list = Vec::new();
    for time in times {
        while it.time() < *time {
            it.step(&mut rates, *time).unwrap();
        }
        list.push(it.state()[0] - bench.stance.coordinates()[0]);
    }
    list
}

#[test]
fn small_free_vibrations_in_time_are_those_of_the_modes() {
    let double = "gravity = [0, \"-9.81 m/s^2\"]\n[links]\nframe = { O = [0, 0], W = [1, -0.5] }\nupper = { O-P = 0.7, mass = 1, inertia = 0.04 }\n\
                  lower = { P-Q = 0.5, mass = 2, inertia = 0.05 }\n\
                  [drives]\na = { turns = \"upper\", at = -80 }\nb = { turns = \"lower\", at = -100 }\n\
                  [springs]\ns = { between = \"Q-W\", stiffness = 30, free = 0.6 }\n[dampers]\nd = { between = \"Q-W\", damping = 3 }\n";
    for text in [four_bar(1.0), double.to_owned()] {
        let mut bench = Bench::new(&text);
        let it = bench.settle().unwrap();
        let n = it.size;
        let modes = modes(&it).unwrap();
        let slowest = TAU / modes[0].square.sqrt();
        let step = slowest / 40.0;
        let times: Vec<f64> = (1..=60).map(|k| f64::from(k) * step).collect();
        let mut away = modes[0].shape.clone();
        away.iter_mut().for_each(|x| *x *= 1e-6);
        let found = swing(&bench, &away, &times);
        // What vibrates with the 2 n values of s satisfies a recurrence whose roots are exp(s step).
        let mut recurrence = vec![1.0];
        for mode in &modes {
            let [[re, im], [other, _]] = mode.rates;
            let (sum, product) = match im == 0.0 {
                true => (
                    (re * step).exp() + (other * step).exp(),
                    ((re + other) * step).exp(),
                ),
                false => (
                    2.0 * (re * step).exp() * (im * step).cos(),
                    (2.0 * re * step).exp(),
                ),
            };
            let mut next = vec![0.0; recurrence.len() + 2];
            for (k, x) in recurrence.iter().enumerate() {
                next[k] += x;
                next[k + 1] -= sum * x;
                next[k + 2] += product * x;
            }
            recurrence = next;
        }
        let size = found.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for window in found.windows(2 * n + 1) {
            let left: f64 = window
                .iter()
                .rev()
                .zip(&recurrence)
                .map(|(x, c)| x * c)
                .sum();
            assert!(left.abs() < 3e-6 * size, "{left:e} of {size:e}");
        }
    }
}

#[test]
fn vibrations_and_free_motion_need_the_same_mass() {
    // A double pendulum whose knee weighs next to nothing: in line, the upper bar moves hardly any mass that the lower one does not.
    for (knee, refused) in [(1e-14, true), (5e-13, true), (5e-12, false), (1e-3, false)] {
        let text = format!(
            r#"
            units = {{ length = "m" }}
            gravity = [0, "-9.81 m/s^2"]
            [links]
            frame = {{ O = [0, 0] }}
            upper = {{ O-P = 1 }}
            lower = {{ P-Q = 1 }}
            [drives]
            a = {{ turns = "upper", at = -90 }}
            b = {{ turns = "lower", at = -90 }}
            [masses]
            knee = {{ at = "P", mass = "{knee:e} kg" }}
            foot = {{ at = "Q", mass = "1 kg" }}
            "#
        );
        let mut bench = Bench::new(&text);
        let row = modes(&bench.linearised()).map(|_| ());
        let wanted = if refused {
            Err(NoModes::NoMass(1))
        } else {
            Ok(())
        };
        assert_eq!(row, wanted, "{knee:e}");
        let (branch, q) = (bench.stance.branch(), bench.stance.coordinates());
        let source = solved(&bench.motion, branch, q, &[0.0; 2]);
        let equations = source.forces.equations_of_motion(&source.instant);
        let nothing = [Number::from_f64(0.0); 2];
        let found = equations.accelerations(&bench.free, &nothing, &nothing);
        assert_eq!(found.is_none(), refused, "{knee:e}");
        let mut instant = Instant::new(bench.motion.mechanism(), 0);
        source.instant.value_into(&mut instant);
        let mut forces = Forces::new(bench.motion.design.clone()).unwrap();
        let moves = forces.let_go(&mut instant, &bench.free, &[0.0; 2], &mut LetGo::default());
        assert_eq!(moves.is_ok(), !refused, "{knee:e}");
    }
}
