//! Random mechanisms on which masses, weights, springs, dampers and loads act: what they do in time against inverse dynamics, against
//! themselves backwards, against their energy, and against the tolerance that was asked for.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use crate::common::{at, weigh};
use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, norm, sub};
use std::ops::ControlFlow;

use kempe_dynamics::ForceSampler;
use kempe_mechanism::Design;
use kempe_model::{
    Acts, Amount, Between, Damper, DriveId, DriveKind, FRAME, ForceMeasure, JointKind, Leaf, Link,
    LinkId, LinkPointRef, Load, LoadKind, Measure, PoseMeasure, Spring,
};
use kempe_motion::{Done, Silent, Stage};
use kempe_number::Jet;
use kempe_number::math::{cos, ln};
use kempe_simulate::{Ending, Method, Question, Simulated, simulate};
use kempe_units::{Dimension, Expr};

const G: f64 = 9.81;
/// Those that take more steps than these start beside a dead point, where some links are thrown about. Where loads go by time alone, there
/// are five hundred at least.
const STEPS: usize = 700;
/// How many are made.
pub const MADE: u64 = 64;

/// A random mechanism with what acts on it.
pub struct Acted {
    pub case: Case,
    pub size: f64,
    /// How long something of its size takes to fall by half of it or so, s.
    pub time: f64,
    rng: Rng,
}

/// How a random mechanism is to be.
#[derive(Clone, Copy)]
pub struct Wanted {
    /// Part of the stroke of its first drive.
    pub stroke: f64,
    /// In times to fall.
    pub takes: f64,
    pub damped: bool,
}

/// Everything in units of its own size; none where loads repeat each other and have no values of their own.
pub fn acted(seed: u64, wanted: Wanted) -> Option<Acted> {
    let mut rng = Rng(seed ^ 0x000f_a115);
    let mut spec = make(&recipe(seed)).spec;
    let size = spec.size();
    let time = (size / G).sqrt();
    let law = [None, Some("cycloidal"), Some("4-5-6-7")][rng.below(3)];
    for drive in &mut spec.drives {
        drive.to = drive.from + wanted.stroke * (drive.to - drive.from);
        drive.time = wanted.takes * time;
        drive.law = law;
    }
    let mut model = Case::of(&spec).model;
    weigh(&mut model, size, |low, high| rng.range(low, high));
    let bodies = Case::from_model(model.clone()).mechanism;
    let links = model.links.len();
    // Two points of different bodies that are not near each other.
    let pair = |rng: &mut Rng| {
        let mut end = || {
            let link = rng.below(links);
            let points = &model.links[link].points;
            let point = points[rng.below(points.len())].point;
            let place = spec.links[link].point(&model.points[point.index()].name);
            let link = LinkId(link as u32);
            (
                LinkPointRef { link, point },
                spec.links[link.index()].world(place.unwrap()),
            )
        };
        let (a, b) = (end(), end());
        let apart = norm(sub(a.1, b.1));
        let has = |link: &Link, point| link.points.iter().any(|it| it.point == point);
        let rigid = |link: &Link| has(link, a.0.point) && has(link, b.0.point);
        let moves = bodies.body_of(a.0.link) != bodies.body_of(b.0.link);
        (moves && apart > 0.3 * size && !model.links.iter().any(rigid)).then_some((a.0, b.0, apart))
    };
    let (mut springs, mut dampers, mut loads) = (Vec::new(), Vec::new(), Vec::new());
    let mut spring = |between, unit: f64, free: f64, rng: &mut Rng| {
        springs.push(Spring {
            name: format!("s{}", springs.len()),
            between,
            stiffness: Expr::Const(rng.range(0.2, 3.0) * unit),
            free: Expr::Const(free),
            preload: Expr::Const(0.0),
            stops: [None, None],
            stop_stiffness: None,
            acts: Acts::Both,
            span: 0..0,
        });
    };
    let mut damper = |between, unit: f64, rng: &mut Rng| {
        dampers.push(Damper {
            name: format!("d{}", dampers.len()),
            between,
            damping: Expr::Const(rng.range(0.05, 0.3) * unit),
            closing: None,
            span: 0..0,
        });
    };
    for _ in 0..2 {
        if let Some((a, b, apart)) = pair(&mut rng) {
            let free = apart * rng.range(0.5, 1.5);
            spring(Between::Points(a, b), G / size, free, &mut rng);
            let turning = Between::Links(a.link, b.link);
            spring(turning.clone(), G * size, rng.range(-1.0, 1.0), &mut rng);
            if wanted.damped {
                damper(turning, G * size * time, &mut rng);
            }
        }
        if let (true, Some((a, b, _))) = (wanted.damped, pair(&mut rng)) {
            damper(Between::Points(a, b), G / size * time, &mut rng);
        }
        if let Some((at, _, _)) = pair(&mut rng) {
            let mut part = || Amount::Measure(Expr::Const(rng.range(-3.0, 3.0) * G));
            let components = [part(), part()];
            let axes = FRAME;
            loads.push(LoadKind::Force {
                at,
                components,
                axes,
            });
        }
    }
    model.actions.springs = springs;
    model.actions.dampers = dampers;
    model.actions.loads = named(loads);
    let case = Case::from_model(model);
    let plan = &case.mechanism.plan;
    let repeats = !plan.decomposition.surplus.is_empty()
        || plan.blocks.iter().any(|block| !block.surplus.is_empty());
    (!repeats).then_some(Acted {
        case,
        size,
        time,
        rng,
    })
}

fn named(loads: Vec<LoadKind>) -> Vec<Load> {
    let load = |(k, kind)| Load {
        name: format!("f{k}"),
        kind,
        span: 0..0,
    };
    loads.into_iter().enumerate().map(load).collect()
}

impl Acted {
    /// A radian, or the size.
    pub fn unit(&self, drive: usize) -> f64 {
        match self.case.model.drives[drive].dimension == Dimension::ANGLE {
            true => 1.0,
            false => self.size,
        }
    }

    /// All drives let go where their laws start, with some speed.
    pub fn question(&mut self, until: f64, tolerance: f64) -> Question {
        let drives = self.case.model.drives.len();
        let start = (0..drives).map(|drive| {
            let speed = 0.3 * self.unit(drive) * self.rng.range(-1.0, 1.0) / self.time;
            let law = &self.case.model.drives[drive].law;
            [law.at(0.0, &self.case.parameters), speed]
        });
        question((0..drives).collect(), start.collect(), until, tolerance)
    }
}

fn question(drives: Vec<usize>, start: Vec<[f64; 2]>, until: f64, tolerance: f64) -> Question {
    Question {
        free: drives
            .into_iter()
            .map(|drive| DriveId(drive as u32))
            .collect(),
        start,
        until,
        tolerance,
        method: Method::Choose,
        stops: Vec::new(),
        end_when: Vec::new(),
        coordinates: kempe_simulate::Coordinates::Minimal,
        contacts: Vec::new(),
    }
}

/// What comes to its end in a few hundred steps with its own coordinates telling the place all the way.
fn run(design: &Design<f64>, question: &Question) -> Option<Simulated> {
    let mut steps = 0;
    let mut enough = |stage: Stage, _: Done| {
        steps += usize::from(stage == Stage::Simulating);
        match steps > STEPS {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let found = simulate(design, question, &mut enough).ok()?;
    (found.ending == Ending::Until && found.told_by().is_empty()).then_some(found)
}

/// A polynomial in time through values of a function at so many places in a range, by Newton's differences, and the most by which it
/// misses the function between them.
fn polynomial(f: &mut dyn FnMut(f64) -> f64, until: f64, places: usize) -> (Measure, f64) {
    let time = |x: f64| 0.5 * until * (1.0 + 0.5 * x);
    // Chebyshev's places in [-2, 2], each as far as can be from those before it.
    let mut left: Vec<f64> = (0..places)
        .map(|k| 2.0 * cos(std::f64::consts::PI * (k as f64 + 0.5) / places as f64))
        .collect();
    let mut at: Vec<f64> = Vec::new();
    while !left.is_empty() {
        let room = |x: f64| at.iter().map(|y| ln((x - y).abs())).sum::<f64>();
        let best = (0..left.len())
            .max_by(|a, b| room(left[*a]).total_cmp(&room(left[*b])))
            .unwrap();
        at.push(left.swap_remove(best));
    }
    let mut c: Vec<f64> = at.iter().map(|x| f(time(*x))).collect();
    for order in 1..places {
        for k in (order..places).rev() {
            c[k] = (c[k] - c[k - 1]) / (at[k] - at[k - order]);
        }
    }
    let mut off = 0.0_f64;
    for k in 0..=2 * places {
        let t = until * k as f64 / (2 * places) as f64;
        let x = 2.0 * (2.0 * t / until - 1.0);
        let is = (0..places - 1)
            .rev()
            .fold(c[places - 1], |sum, k| c[k] + (x - at[k]) * sum);
        let gap = (is - f(t)).abs();
        off = if gap <= off { off } else { gap };
    }
    let x = || {
        let scaled = Expr::Mul(
            Box::new(Expr::Const(4.0 / until)),
            Box::new(Expr::Leaf(Leaf::Time)),
        );
        Expr::Sub(Box::new(scaled), Box::new(Expr::Const(2.0)))
    };
    let nest = |sum: Measure, k: usize| {
        let from = Expr::Sub(Box::new(x()), Box::new(Expr::Const(at[k])));
        let more = Expr::Mul(Box::new(from), Box::new(sum));
        Expr::Add(Box::new(Expr::Const(c[k])), Box::new(more))
    };
    let all = (0..places - 1).rev().fold(Expr::Const(c[places - 1]), nest);
    (all, off)
}

/// What gives a force or torque along a drive's coordinate; none where it slides on what moves.
fn along(case: &Case, drive: usize, amount: &Measure) -> Option<Vec<LoadKind>> {
    let product = |a: Measure, b: Measure| Expr::Mul(Box::new(a), Box::new(b));
    let pose = |it: PoseMeasure| Expr::Leaf(Leaf::Pose(it));
    let force = |at: LinkPointRef, components: [Measure; 2]| LoadKind::Force {
        at,
        components: components.map(Amount::Measure),
        axes: FRAME,
    };
    match case.model.drives[drive].kind {
        DriveKind::Turn { link, relative_to } => Some(vec![LoadKind::Torque {
            on: link,
            against: relative_to,
            amount: Amount::Measure(amount.clone()),
        }]),
        DriveKind::Cylinder { a, b } => {
            let length = || pose(PoseMeasure::Distance(a.point, b.point));
            let parts = |sign: f64| {
                [PoseMeasure::X, PoseMeasure::Y].map(|of| {
                    let apart = Expr::Sub(Box::new(pose(of(b.point))), Box::new(pose(of(a.point))));
                    let way = Expr::Div(Box::new(apart), Box::new(length()));
                    product(Expr::Const(sign), product(amount.clone(), way))
                })
            };
            Some(vec![force(b, parts(1.0)), force(a, parts(-1.0))])
        }
        DriveKind::Slide { joint } => {
            let (pin, line) = match case.model.joints[joint.index()].kind {
                JointKind::Slider { at, on, .. } => (at, on),
                JointKind::Slot { pin, on } => (pin, on),
                _ => return None,
            };
            if line.link != FRAME {
                return None;
            }
            let apart = [PoseMeasure::X, PoseMeasure::Y]
                .map(|of| Expr::Sub(Box::new(pose(of(line.to))), Box::new(pose(of(line.from)))));
            let length = || pose(PoseMeasure::Distance(line.from, line.to));
            let parts = apart
                .map(|it| product(amount.clone(), Expr::Div(Box::new(it), Box::new(length()))));
            Some(vec![force(pin, parts)])
        }
        _ => None,
    }
}

/// The most by which a released mechanism is off its laws.
struct Driven {
    place: f64,
    rate: f64,
    drives: usize,
    links: usize,
    slides: bool,
}

/// What a mechanism asks of its drives along their laws is given back as loads that know of nothing but time, and all drives are let go:
/// how far it is off its laws then. None where it does not come through, or asks for what is no polynomial.
fn driven(seed: u64, stroke: f64) -> Option<Driven> {
    let takes = 1.5;
    let it = acted(
        seed,
        Wanted {
            stroke,
            takes,
            damped: true,
        },
    )?;
    let case = &it.case;
    let until = takes * it.time;
    let motion = case.motion().ok()?;
    // The others keep their laws.
    let nothing = Expr::Const(0.0);
    let drives: Vec<usize> = (0..case.model.drives.len())
        .filter(|drive| along(case, *drive, &nothing).is_some())
        .collect();
    let asked: Vec<Measure> = (drives.iter())
        .map(|drive| Expr::Leaf(Leaf::Force(ForceMeasure::Drive(DriveId(*drive as u32)))))
        .collect();
    let asked: Vec<&Measure> = asked.iter().collect();
    let mut sampler = ForceSampler::new(&motion, &asked).ok()?;
    let before = case.model.actions.loads.iter();
    let mut loads: Vec<LoadKind> = before.map(|load| load.kind.clone()).collect();
    for (k, drive) in drives.iter().enumerate() {
        let mut asked = |time: f64| sampler.values_at_time(time)[k];
        let (amount, off) = polynomial(&mut asked, until, 48);
        // NaN where it does not come through.
        if !(off < 1e-10 * G * it.size / it.unit(*drive)) {
            return None;
        }
        loads.extend(along(case, *drive, &amount)?);
    }
    let mut model = case.model.clone();
    model.actions.loads = named(loads);
    let released = Case::from_model(model);
    let law = |drive: usize, time: f64| -> [f64; 2] {
        let q: Jet<f64, 2> = case.model.drives[drive].law.at(Jet::variable(time), &[]);
        [q.derivative(0), q.derivative(1)]
    };
    let start = drives.iter().map(|drive| law(*drive, 0.0)).collect();
    let found = run(
        &released.design,
        &question(drives.clone(), start, until, 1e-12),
    )?;
    let mut told = Driven {
        place: 0.0,
        rate: 0.0,
        drives: drives.len(),
        links: case.model.links.len(),
        slides: (case.model.joints.iter()).any(|it| matches!(it.kind, JointKind::Slider { .. })),
    };
    for k in 1..100 {
        let time = until * f64::from(k) / 100.0;
        for drive in &drives {
            let (is, law) = (at(&found, *drive, time), law(*drive, time));
            let unit = it.unit(*drive);
            told.place = told.place.max((is[0] - law[0]).abs() / unit);
            told.rate = told.rate.max((is[1] - law[1]).abs() / unit * it.time);
        }
    }
    Some(told)
}

#[test]
fn what_inverse_dynamics_asks_moves_released_drives_by_their_laws() {
    let (mut done, mut whole, mut several, mut six_bars, mut sliders) = (0, 0, 0, 0, 0);
    for seed in 0..MADE {
        // As far as it comes.
        let strokes = [1.0, 0.6, 0.36, 0.22];
        let told = (strokes.iter()).find_map(|stroke| Some((*stroke, driven(seed, *stroke)?)));
        let Some((stroke, told)) = told else {
            continue;
        };
        assert!(told.place < 1e-11, "{seed}: {:e}", told.place);
        assert!(told.rate < 1e-10, "{seed}: {:e}", told.rate);
        done += 1;
        whole += usize::from(stroke == 1.0);
        several += usize::from(told.drives > 1);
        six_bars += usize::from(told.links >= 6);
        sliders += usize::from(told.slides);
    }
    assert!(done >= 30 && whole >= 15 && several >= 10 && six_bars >= 12 && sliders >= 15);
}

/// Backwards from where it came to, everything comes back.
#[test]
fn what_keeps_its_energy_goes_back_the_way_it_came() {
    let (mut done, mut several) = (0, 0);
    for seed in 0..MADE {
        let wanted = Wanted {
            stroke: 1.0,
            takes: 1.0,
            damped: false,
        };
        let Some(mut it) = acted(seed, wanted) else {
            continue;
        };
        let until = it.time;
        let there = it.question(until, 1e-12);
        let Some(found) = run(&it.case.design, &there) else {
            continue;
        };
        let drives = there.free.len();
        let ends = (0..drives).map(|drive| {
            let [q, v] = at(&found, drive, until);
            [q, -v]
        });
        let back = question((0..drives).collect(), ends.collect(), until, 1e-12);
        let Some(back) = run(&it.case.design, &back) else {
            continue;
        };
        for drive in 0..drives {
            let unit = it.unit(drive);
            for k in 0..20 {
                let time = until * f64::from(k) / 20.0;
                let (there, back) = (at(&found, drive, time), at(&back, drive, until - time));
                let off = (there[0] - back[0]).abs() / unit;
                assert!(off < 1e-10, "{seed}: {off:e}");
                let off = (there[1] + back[1]).abs() / unit * it.time;
                assert!(off < 1e-9, "{seed}: {off:e}");
            }
        }
        done += 1;
        several += usize::from(drives > 1);
    }
    assert!(done >= 20 && several >= 5, "{done} {several}");
}

/// Kinetic energy and that of weights and springs, less what loads and dampers worked, stays what it was.
#[test]
fn energy_is_what_loads_and_dampers_leave() {
    let (mut done, mut several, mut worked) = (0, 0, 0);
    for seed in 0..MADE {
        let wanted = Wanted {
            stroke: 1.0,
            takes: 1.0,
            damped: true,
        };
        let Some(mut it) = acted(seed, wanted) else {
            continue;
        };
        let until = it.time;
        let question = it.question(until, 1e-12);
        let Some(found) = run(&it.case.design, &question) else {
            continue;
        };
        let Ok(motion) = found.motion(&mut Silent) else {
            continue;
        };
        let energies = [ForceMeasure::KineticEnergy, ForceMeasure::PotentialEnergy]
            .map(|it| Expr::Leaf(Leaf::Force(it)));
        let mut sampler = ForceSampler::new(&motion, &[&energies[0], &energies[1]]).unwrap();
        let mut energy = |time: f64| {
            let values = sampler.values_at_time(time);
            let work: f64 = found.work.at(time, &[]);
            [values[0], values[1], work]
        };
        let [first, stored, _] = energy(0.0);
        let (mut most, mut off, mut work) = (first, 0.0_f64, 0.0_f64);
        for k in 1..=100 {
            let [kinetic, potential, given] = energy(until * f64::from(k) / 100.0);
            most = most.max(kinetic);
            work = work.max(given.abs());
            let gap = (kinetic + potential - given - first - stored).abs();
            off = if gap <= off { off } else { gap };
        }
        assert!(off < 1e-9 * most, "{seed}: {:e}", off / most);
        done += 1;
        several += usize::from(question.free.len() > 1);
        worked += usize::from(work > 0.05 * most);
    }
    assert!(done >= 25 && several >= 5 && worked >= 15);
}

/// The slope of the line that fits these best, by least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let about = |k: usize| {
        let parts = points.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k]));
        parts.sum::<f64>()
    };
    about(1) / about(0)
}

/// Errors fall as tolerances do, and the work for them grows with the root that the order of the method says.
#[test]
fn a_tenth_of_the_tolerance_is_a_tenth_of_the_error() {
    let (mut errors, mut works) = (Vec::new(), Vec::new());
    for seed in 0..MADE {
        let wanted = Wanted {
            stroke: 1.0,
            takes: 2.0,
            damped: true,
        };
        let Some(mut it) = acted(seed, wanted) else {
            continue;
        };
        let until = 2.0 * it.time;
        let mut question = it.question(until, 1e-13);
        question.method = Method::Explicit;
        let Some(exact) = run(&it.case.design, &question) else {
            continue;
        };
        let (mut error, mut work) = (Vec::new(), Vec::new());
        for exponent in 5..=11 {
            question.tolerance = kempe_number::powi(10.0, -exponent);
            let found = run(&it.case.design, &question).unwrap();
            let mut off = 0.0_f64;
            for drive in 0..question.free.len() {
                for k in 1..20 {
                    let time = until * f64::from(k) / 20.0;
                    let apart = at(&found, drive, time)[0] - at(&exact, drive, time)[0];
                    off = off.max(apart.abs() / it.unit(drive));
                }
            }
            assert!(off < 100.0 * question.tolerance, "{seed}: {off:e}");
            let digits = -f64::from(exponent);
            error.push([digits, ln(off.max(1e-18)) / ln(10.0)]);
            work.push([digits, ln(found.evaluations as f64) / ln(10.0)]);
        }
        // Where nothing moves but by a law, there is no error.
        if error[0][1] > -12.0 {
            let grows = slope(&error);
            assert!((0.6..1.4).contains(&grows), "{seed}: {grows} {error:?}");
            errors.push(grows);
            works.push(slope(&work[1..]));
        }
    }
    let middle = |all: &mut Vec<f64>| {
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let (count, error, work) = (errors.len(), middle(&mut errors), middle(&mut works));
    assert!(count >= 20, "{count}");
    assert!((0.9..1.1).contains(&error), "{error}");
    // Order 8, and what every step takes whatever its length.
    assert!((-0.125..-0.08).contains(&work), "{work}");
}
