//! Forces on every kind of number: lanes give the bits of each lane alone, intervals hold all values between.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use crate::acted::{PARAMETERS, act, measures};
use crate::mechanisms::generate::{make, recipe};
use crate::mechanisms::{Case, Rng, spread};
use kempe_dynamics::equilibrium::Pace;
use kempe_dynamics::{ForceNumber, FrictionOutcome, Rates, Source};
use kempe_measure::measure::{Along, History, measure};
use kempe_measure::{Abscissa, ForceSource, Series, State};
use kempe_mechanism::{Branch, Pose};
use kempe_motion::Motion;
use kempe_number::{Interval, Jet, Lanes, Number};

const W: usize = 8;
/// Coefficients of forces that are known.
const KNOWN: usize = 3;

/// A random mechanism at a place of its motion.
struct Bench {
    motion: Arc<Motion>,
    branch: Branch,
    /// Where the drives stand.
    q: Vec<f64>,
    /// In what their coordinates are counted.
    units: Vec<f64>,
}

impl Bench {
    fn new(seed: u64) -> Option<Self> {
        let spec = make(&recipe(seed)).spec;
        let mut model = Case::of(&spec).model;
        act(&mut model, &mut Rng(seed ^ 0xf0_2ce5), spec.size());
        let motion = Case::from_model(model).motion().ok()?;
        Some(Self::at(motion, spec.size()))
    }

    fn at(motion: Arc<Motion>, size: f64) -> Self {
        let p = spread(&motion, 3)[1];
        let mut branch = Branch::neutral(motion.mechanism());
        motion.branch_at(p, &mut branch);
        let mut q = vec![0.0; motion.mechanism().model.drives.len()];
        motion.path.coordinates(p, &mut q);
        let drives = motion.mechanism().model.drives.iter();
        let units = drives.map(|drive| match drive.dimension {
            kempe_units::Dimension::ANGLE => 1.0,
            _ => size,
        });
        Self {
            units: units.collect(),
            branch,
            q,
            motion,
        }
    }

    /// Coordinates about here that move somehow.
    fn moving(&self, rng: &mut Rng) -> Vec<Series<f64>> {
        (self.q.iter().zip(&self.units))
            .map(|(q, unit)| {
                let mut number = |part: f64| rng.range(-part, part) * unit;
                let rest = [number(1.0), number(1.0), number(1.0), number(1.0)];
                Jet::from_coefficients([q + number(1e-3), rest[0], rest[1], rest[2], rest[3]])
            })
            .collect()
    }

    /// The state of a design in which the coordinates run as these series.
    fn state(&self, parameters: &[f64], moving: &[Series<f64>]) -> State<f64> {
        let design = self.motion.design_of(parameters).lift(Series::constant);
        State::moving(&Arc::new(design), &self.branch, 0.3, moving)
    }

    /// The forces of a state.
    fn forces<B: ForceNumber>(&self, parameters: &[B], state: &State<B>) -> Source<B> {
        let design = self.motion.design_of(parameters).lift(Rates::constant);
        let mut source = Source::of(design, &self.branch.near).unwrap();
        source.forces.equilibrium.pace = Pace {
            speeds: self.units.clone(),
            frequency: 0.5,
        };
        let amounts: Vec<Series<B>> = (source.measures().iter())
            .map(|m| measure(state, &History::default(), None, m, Along::Time))
            .collect();
        source.solve(state, &amounts);
        source
    }
}

/// One state of several, its numbers put together coefficient by coefficient.
fn together<B: Number>(
    bench: &Bench,
    parameters: &[B],
    states: &[State<f64>],
    join: impl Fn(&dyn Fn(usize) -> f64) -> B,
) -> State<B> {
    let one = &states[0];
    let series = |of: &dyn Fn(&State<f64>) -> Series<f64>| -> Series<B> {
        Jet::from_coefficients(std::array::from_fn(|k| {
            join(&|s: usize| of(&states[s]).coefficient(k))
        }))
    };
    type Poses<N> = [Pose<Series<N>>];
    let poses = |of: &dyn Fn(&State<f64>) -> &Poses<f64>| -> Vec<Pose<Series<B>>> {
        (0..one.poses.len())
            .map(|body| Pose {
                x: series(&|s| of(s)[body].x),
                y: series(&|s| of(s)[body].y),
                c: series(&|s| of(s)[body].c),
                s: series(&|s| of(s)[body].s),
            })
            .collect()
    };
    let drives = 0..one.coordinates.len();
    State {
        design: Arc::new(bench.motion.design_of(parameters).lift(Series::constant)),
        time: B::from_f64(0.3),
        abscissa: Abscissa::time(B::from_f64(0.3), 1.0),
        poses: poses(&|s| &s.poses),
        coordinates: (drives.clone())
            .map(|d| series(&|s| s.coordinates[d]))
            .collect(),
        near: bench.branch.near.clone(),
        inner: Vec::new(),
        alone: drives
            .map(|d| Some(poses(&|s| s.alone[d].as_deref().unwrap())))
            .collect(),
    }
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// Lanes with friction that jams, poses that are not closed, singular poses and rest beside ordinary ones.
#[test]
fn lanes_have_the_bits_of_each_alone() {
    let (mut compared, mut jammed, mut singular, mut rubbing) = (0, 0, 0, 0);
    for seed in 0..80 {
        let Some(bench) = Bench::new(seed) else {
            continue;
        };
        let mut rng = Rng(seed ^ 0x1a9e);
        let mut moving: Vec<_> = (0..W).map(|_| bench.moving(&mut rng)).collect();
        let mut parameters: Vec<Vec<f64>> = (0..W)
            .map(|_| (0..PARAMETERS).map(|_| rng.range(0.8, 1.2)).collect())
            .collect();
        // Jams, mostly.
        parameters[1][0] = 40.0;
        parameters[6][0] = 15.0;
        // Stands still; and is about to move.
        for q in &mut moving[2] {
            *q = Series::constant(q.coefficient(0));
        }
        for q in &mut moving[3] {
            let c = q.coefficients();
            *q = Series::from_coefficients([c[0], 0.0, c[2], c[3], c[4]]);
        }
        let mut states: Vec<State<f64>> = (parameters.iter().zip(&moving))
            .map(|(parameters, moving)| bench.state(parameters, moving))
            .collect();
        for pose in &mut states[4].poses[1..] {
            pose.x = Series::from_f64(f64::NAN);
        }
        // All links lie in one line.
        for pose in &mut states[5].poses[1..] {
            *pose = Pose::identity();
        }
        let lanes: Vec<Lanes<W>> = (0..PARAMETERS)
            .map(|p| Lanes::from_fn(|lane| parameters[lane][p]))
            .collect();
        let all = together(&bench, &lanes, &states, |of| Lanes::from_fn(of));
        let all = bench.forces(&lanes, &all);
        let asked = measures(&bench.motion.mechanism().model);
        for lane in 0..W {
            let alone = bench.forces(&parameters[lane], &states[lane]);
            for asked in &asked {
                let (found, wanted) = (all.answer(asked), alone.answer(asked));
                for k in 0..KNOWN {
                    let (a, b) = (found.coefficient(k).lane(lane), wanted.coefficient(k));
                    assert!(
                        same(a, b),
                        "seed {seed} {asked:?} lane {lane} order {k}: {a} {b}"
                    );
                    compared += usize::from(b.is_finite());
                }
            }
            let (a, b) = (
                &all.forces.equilibrium.lanes[lane],
                &alone.forces.equilibrium.lanes[0],
            );
            assert_eq!((a.singular, a.friction), (b.singular, b.friction));
            assert!(same(a.residual, b.residual) && same(a.largest, b.largest));
            assert!(same(a.condition(), b.condition()));
            for drive in 0..bench.q.len() {
                let of = |source: &Source<f64>| source.forces.frictionless(drive, 0);
                assert!(same(all.forces.frictionless(drive, lane), of(&alone)));
            }
            let of = |source: &Source<f64>| source.forces.route_difference(0);
            assert!(same(all.forces.route_difference(lane), of(&alone)));
            jammed += usize::from(matches!(b.friction, FrictionOutcome::Jammed { .. }));
            rubbing += usize::from(matches!(b.friction, FrictionOutcome::Consistent { .. }));
            singular += usize::from(b.singular);
        }
    }
    assert!(compared > 100_000, "{compared}");
    assert!(
        jammed > 10 && singular > 10 && rubbing > 50,
        "{jammed} {singular} {rubbing}"
    );
}

/// In one lane the wheels of the belt leave no room for it: there it carries a torque alone.
#[test]
fn each_lane_has_a_belt_of_its_own() {
    let bench = Bench::at(Case::example("gallery/belt-leg").must_move(), 0.24);
    let mut rng = Rng(11);
    for tight in 0..W {
        let parameters: Vec<[f64; 2]> = (0..W)
            .map(|lane| {
                let thigh = if lane == tight { 0.005 } else { 0.22 };
                [thigh * rng.range(0.9, 1.1), 0.24 * rng.range(0.9, 1.1)]
            })
            .collect();
        let states: Vec<State<f64>> = (parameters.iter())
            .map(|own| bench.state(own, &bench.moving(&mut rng)))
            .collect();
        let lanes = [0, 1].map(|p| Lanes::<W>::from_fn(|lane| parameters[lane][p]));
        let all = together(&bench, &lanes, &states, |of| Lanes::from_fn(of));
        let all = bench.forces(&lanes, &all);
        for lane in 0..W {
            let alone = bench.forces(&parameters[lane], &states[lane]);
            for asked in measures(&bench.motion.mechanism().model) {
                let (found, wanted) = (all.answer(&asked), alone.answer(&asked));
                for k in 0..KNOWN {
                    let (a, b) = (found.coefficient(k).lane(lane), wanted.coefficient(k));
                    assert!(same(a, b), "{asked:?} lane {lane} order {k}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn equations_of_motion_in_lanes_are_those_of_each() {
    let mut compared = 0;
    for seed in 0..40 {
        let Some(bench) = Bench::new(seed) else {
            continue;
        };
        let mut rng = Rng(seed ^ 0xe0e);
        let parameters: Vec<Vec<f64>> = (0..W)
            .map(|_| (0..PARAMETERS).map(|_| rng.range(0.8, 1.2)).collect())
            .collect();
        let states: Vec<State<f64>> = (parameters.iter())
            .map(|own| bench.state(own, &bench.moving(&mut rng)))
            .collect();
        let lanes: Vec<Lanes<W>> = (0..PARAMETERS)
            .map(|p| Lanes::from_fn(|lane| parameters[lane][p]))
            .collect();
        let all = together(&bench, &lanes, &states, |of| Lanes::from_fn(of));
        let all = bench.forces(&lanes, &all);
        let mut equations = all.forces.equations_of_motion(&all.instant);
        let free: Vec<_> = (0..bench.q.len() as u32)
            .map(kempe_model::DriveId)
            .collect();
        // One lane moves no mass.
        for mass in &mut equations.mass {
            *mass = mass.with_lane(2, Rates::from_f64(0.0));
        }
        let nothing = vec![Rates::from_f64(0.0); free.len()];
        let found = equations.accelerations(&free, &nothing, &nothing);
        for lane in 0..W {
            let alone = bench.forces(&parameters[lane], &states[lane]);
            let own = alone.forces.equations_of_motion(&alone.instant);
            for (a, b) in equations.bias.iter().zip(&own.bias) {
                assert!(same(a.in_lane(lane).value(), b.value()));
            }
            let nothing = vec![Rates::from_f64(0.0); free.len()];
            let wanted = own.accelerations(&free, &nothing, &nothing);
            match (lane, &found, &wanted) {
                (2, Some(found), _) => assert!(found.iter().all(|a| a.in_lane(2).value().is_nan())),
                (2, None, _) => {}
                (_, Some(found), Some(wanted)) => {
                    for (a, b) in found.iter().zip(wanted) {
                        assert!(same(a.in_lane(lane).value(), b.value()), "seed {seed}");
                        compared += 1;
                    }
                }
                (_, Some(found), None) => {
                    assert!(found.iter().any(|a| a.in_lane(lane).value().is_nan()));
                }
                (_, None, wanted) => assert!(wanted.is_none()),
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn what_makes_no_sense_is_found_in_any_lane() {
    let bench = (0..).find_map(Bench::new).unwrap();
    let problems = |lane: usize, value: f64| {
        let parameters: Vec<Lanes<W>> = (0..PARAMETERS)
            .map(|_| Lanes::from_fn(|k| if k == lane { value } else { 1.0 }))
            .collect();
        let design = bench.motion.design_of(&parameters).lift(Rates::constant);
        match Source::of(design, &bench.branch.near) {
            Ok(_) => Vec::new(),
            Err(problems) => problems.iter().map(|p| p.code).collect::<Vec<_>>(),
        }
    };
    assert!(problems(5, 1.1).is_empty());
    for lane in 0..W {
        assert!(problems(lane, -1.0).contains(&"negative-mass"));
    }
}

/// The hull of numbers.
fn hull(count: usize, of: &dyn Fn(usize) -> f64) -> Interval {
    let values = (0..count).map(of);
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(f64::NEG_INFINITY, f64::max);
    Interval::new(low, high)
}

/// States that differ by a part, their forces, and the forces of their hull.
struct Boxed {
    samples: Vec<Source<f64>>,
    bounds: Source<Interval>,
}

/// `reverses`: the speeds of some states have the other sign.
fn boxed(bench: &Bench, seed: u64, part: f64, reverses: bool) -> Option<Boxed> {
    const SAMPLES: usize = 12;
    let mut rng = Rng(seed ^ 0x17e7);
    let base = bench.moving(&mut rng);
    let mut beside = |x: f64| x * (1.0 + part * rng.range(-1.0, 1.0));
    let mut samples = Vec::new();
    for sample in 0..SAMPLES {
        let parameters: Vec<f64> = (0..PARAMETERS).map(|_| beside(1.0)).collect();
        let moving: Vec<Series<f64>> = (base.iter())
            .map(|q| {
                let mut c = q.coefficients().map(&mut beside);
                if reverses {
                    c[1] *= sample as f64 / (SAMPLES as f64 - 1.0) * 1.5 - 0.5;
                }
                Jet::from_coefficients(c)
            })
            .collect();
        let state = bench.state(&parameters, &moving);
        let closed = |pose: &Pose<Series<f64>>| {
            pose.x.is_finite() && pose.c.is_finite() && pose.s.is_finite()
        };
        let alone = state.alone.iter().flatten().flatten();
        if !state.poses.iter().chain(alone).all(closed) {
            return None;
        }
        samples.push((parameters, state));
    }
    let (parameters, states): (Vec<_>, Vec<_>) = samples.into_iter().unzip();
    let boxes: Vec<Interval> = (0..PARAMETERS)
        .map(|p| hull(SAMPLES, &|s| parameters[s][p]))
        .collect();
    let all = together(bench, &boxes, &states, |of| hull(SAMPLES, of));
    let samples = parameters.iter().zip(&states);
    Some(Boxed {
        samples: samples
            .map(|(own, state)| bench.forces(own, state))
            .collect(),
        bounds: bench.forces(&boxes, &all),
    })
}

#[test]
fn intervals_hold_what_lies_between() {
    let (mut compared, mut narrow, mut rubbing, mut jammed) = (0, 0, 0, 0);
    for seed in 0..90 {
        let Some(bench) = Bench::new(seed) else {
            continue;
        };
        let reverses = seed % 3 == 0;
        let part = [1e-6, 1e-4, 1e-2][seed as usize / 3 % 3];
        let Some(it) = boxed(&bench, seed, part, reverses) else {
            continue;
        };
        let lambda = &it.bounds.forces.equilibrium.lambda;
        let is_proved = lambda.iter().all(|l| l.coefficient(0).is_finite());
        for sample in &it.samples {
            let plain = &sample.forces.equilibrium.lanes[0];
            match plain.friction {
                FrictionOutcome::Consistent { .. } => rubbing += usize::from(is_proved),
                FrictionOutcome::None => {}
                _ => {
                    assert!(!is_proved, "seed {seed}: bounds of what jams");
                    jammed += 1;
                }
            }
            assert!(!(plain.singular && is_proved), "seed {seed}");
        }
        for asked in measures(&bench.motion.mechanism().model) {
            let bounds = it.bounds.answer(&asked);
            for (index, sample) in it.samples.iter().enumerate() {
                let value = sample.answer(&asked);
                let largest = sample.forces.equilibrium.lanes[0].largest;
                for k in 0..KNOWN {
                    let (bounds, value) = (bounds.coefficient(k), value.coefficient(k));
                    if !value.is_finite() || bounds.is_empty() {
                        continue;
                    }
                    // The plain values are rounded.
                    let rounding = 1e-13 * (value.abs() + largest);
                    let wide = Interval::around(0.0, rounding) + bounds;
                    assert!(
                        wide.contains(value),
                        "seed {seed} {part:e} {asked:?} order {k} sample {index}: {value} not in {bounds:?}"
                    );
                    compared += 1;
                    narrow += usize::from(bounds.hi() - bounds.lo() < value.abs());
                }
            }
        }
    }
    assert!(compared > 100_000, "{compared}");
    assert!(narrow > compared / 5, "{narrow} of {compared}");
    assert!(rubbing > 100 && jammed > 5, "{rubbing} {jammed}");
}

#[test]
fn bounds_are_as_narrow_as_what_they_are_given() {
    let (mut of_points, mut wide_at_points, mut compared, mut slow) = (0, 0, 0, 0);
    for seed in 0..60 {
        let Some(bench) = Bench::new(seed) else {
            continue;
        };
        let boxes = [0.0, 1e-6, 1e-5].map(|part| boxed(&bench, seed, part, false));
        let [Some(point), Some(small), Some(large)] = boxes else {
            continue;
        };
        let plain = &point.samples[0].forces.equilibrium.lanes[0];
        if matches!(
            plain.friction,
            FrictionOutcome::Jammed { .. } | FrictionOutcome::NotConverged { .. }
        ) || plain.condition() > 1e4
        {
            continue;
        }
        for asked in measures(&bench.motion.mechanism().model) {
            let value = point.samples[0].answer(&asked);
            let [point, small, large] = [&point, &small, &large].map(|it| it.bounds.answer(&asked));
            for k in 0..KNOWN {
                if !value.coefficient(k).is_finite() {
                    continue;
                }
                let [point, small, large] = [point, small, large].map(|x| x.coefficient(k).width());
                let unit = value.coefficient(k).abs().max(plain.largest);
                of_points += 1;
                wide_at_points += usize::from(!(point < 1e-7 * unit));
                if large.is_finite() && large > 1e-8 * unit {
                    compared += 1;
                    slow += usize::from(!(small < 0.2 * large));
                }
            }
        }
    }
    assert!(
        of_points > 5_000 && wide_at_points < of_points / 50,
        "{wide_at_points} of {of_points}"
    );
    // Of pins and meshes that stand still bounds do not tell that they do.
    assert!(
        compared > 3_000 && slow < compared / 8,
        "{slow} of {compared}"
    );
}

/// A slider-crank, driven by its slider, with a torque on the crank: no force of the drive holds it at a dead point, and with
/// friction at its pins none moves it near one.
#[test]
fn a_singular_pose_has_no_bounds() {
    let text = "
gravity = 0
[links]
frame  = { A = [0, 0], E = [1, 0] }
crank  = { A-B = \"0.1 m\" }
rod    = { B-C = \"0.25 m\" }
piston = { C = [0, 0] }
[joints]
guide = { slider = \"piston\", at = \"C\", on = \"A -> E\" }
[loads]
brake = { torque = \"2 N m\", on = \"crank\" }
[drives]
press = { slides = \"piston\", from = 0.30, to = 0.31, speed = \"1 mm/s\" }
[assembly]
B = \"left of A -> C\"
";
    let rubbing = format!("{text}[friction]\nall = {{ coefficient = 0.1, radius = \"6 mm\" }}\n");
    for (text, speed) in [(text, 0.0), (&rubbing, 1.0), (&rubbing, -1.0)] {
        let case = Case::read(text, "press.toml");
        let found = near_a_dead_point(&Bench::at(case.must_move(), 0.1), speed);
        assert!(found[0] > 150 && found[1] > 15, "{found:?}");
        // Against the torque it jams.
        assert_eq!(found[2] > 10, speed < 0.0, "{found:?}");
    }
}

/// Looks at boxes of poses about a dead point of the slider-crank, its crank turning; counts those with bounds, those that
/// hold the dead point, and those in which some pose jams.
fn near_a_dead_point(bench: &Bench, speed: f64) -> [usize; 3] {
    let design = Arc::new(bench.motion.design_of(&[]).lift(Series::constant));
    let (a, b) = (0.1, 0.25);
    let posed = |angle: f64| -> State<f64> {
        let q: Series<f64> = Series::from_coefficients([angle, speed, 0.0, 0.0, 0.0]);
        let (s, c) = q.sin_cos();
        let sine = s * (-a / b);
        let cosine = (-sine.square() + 1.0).sqrt();
        let (zero, one) = (Series::zero(), Series::one());
        let place = |x, y, c, s| Pose { x, y, c, s };
        let x = c * a + cosine * b;
        let mut state = State::moving(&design, &bench.branch, 0.3, &[x]);
        state.poses = vec![
            Pose::identity(),
            place(zero, zero, c, s),
            place(c * a, s * a, cosine, sine),
            place(x, zero, one, zero),
        ];
        // Of how the drive moves it nothing is known.
        let unknown = Pose::identity().map(|_: Series<f64>| Series::from_f64(f64::NAN));
        state.alone = vec![Some(vec![unknown; 4])];
        state
    };
    // By virtual work, without friction.
    let holding = |angle: f64| {
        let (s, c) = kempe_number::math::sin_cos(angle);
        let sine = -a * s / b;
        -2.0 / (-a * s + a * c * sine / (1.0 - sine * sine).sqrt())
    };
    let asked = kempe_model::ForceMeasure::Drive(kempe_model::DriveId(0));
    let [mut bounded, mut singular, mut jammed] = [0; 3];
    let mut rng = Rng(5);
    for k in -30..=30 {
        let middle = 0.01 * f64::from(k);
        for radius in [1e-7, 1e-4, 3e-3, 2e-2, 6e-2] {
            let middle = middle + 0.9 * radius * rng.range(-1.0, 1.0);
            let (low, high) = (middle - radius, middle + radius);
            let mut angles: Vec<f64> = (0..20).map(|_| rng.range(low, high)).collect();
            angles.extend([low, high]);
            let has_dead_point = low <= 0.0 && 0.0 <= high;
            if has_dead_point {
                angles.push(0.0);
            }
            let states: Vec<_> = angles.iter().map(|q| posed(*q)).collect();
            let all = together(bench, &[], &states, |of| hull(states.len(), of));
            let all = bench.forces::<Interval>(&[], &all);
            let bounds = all.answer(&asked).coefficient(0);
            let forces = states.iter().map(|state| {
                let alone = bench.forces(&[], state);
                alone.answer(&asked).coefficient(0)
            });
            let forces: Vec<f64> = forces.collect();
            let jams = !has_dead_point && forces.iter().any(|f| !f.is_finite());
            if has_dead_point || jams {
                assert!(!bounds.is_finite(), "{middle} {radius} {bounds:?}");
            }
            singular += usize::from(has_dead_point);
            jammed += usize::from(jams);
            bounded += usize::from(bounds.is_finite());
            for (angle, force) in angles.iter().zip(forces).filter(|f| f.1.is_finite()) {
                let force = if speed == 0.0 { holding(*angle) } else { force };
                if *angle != 0.0 {
                    let rounding = Interval::around(0.0, 1e-11 * force.abs() / angle.abs());
                    assert!((bounds + rounding).contains(force), "{force} {bounds:?}");
                }
            }
            let far = middle.abs()
                > if speed == 0.0 {
                    4.0 * radius
                } else {
                    0.2 + radius
                };
            assert!(bounds.is_finite() || !far, "{middle} {radius}");
        }
    }
    [bounded, singular, jammed]
}

/// What equilibrium does not determine has no bounds; what the drive gives by virtual power has.
#[test]
fn loads_that_are_not_determined_have_no_bounds() {
    let case = Case::example("gallery/three-crank");
    let bench = Bench::at(case.must_move(), 0.12);
    let mut rng = Rng(8);
    let states: Vec<State<f64>> = (0..6)
        .map(|_| {
            let q = bench.q[0] + rng.range(0.0, 1e-3);
            let moving = Series::from_coefficients([q, 1.0 + rng.range(0.0, 1e-3), 0.3, 0.0, 0.0]);
            bench.state(&[], &[moving])
        })
        .collect();
    let all = together(&bench, &[], &states, |of| hull(states.len(), of));
    let all = bench.forces::<Interval>(&[], &all);
    let lambda = &all.forces.equilibrium.lambda;
    assert!(lambda.iter().all(|l| l.coefficient(0) == Interval::WHOLE));
    let torque = kempe_model::ForceMeasure::Drive(kempe_model::DriveId(0));
    for state in &states {
        let alone = bench.forces(&[], state);
        for k in 0..KNOWN {
            let bounds = all.answer(&torque).coefficient(k);
            assert!(bounds.contains(alone.answer(&torque).coefficient(k)));
            // Virtual power does not know the rates of a drive's coefficients along another path.
            assert!(k > 0 || bounds.width() < 1.0, "{bounds:?}");
        }
    }
}
