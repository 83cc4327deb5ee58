//! Measures on every kind of number: lanes give the bits of each lane alone, intervals hold all values between.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use crate::support::generate::{make, recipe};
use crate::support::{Case, Rng, spread};
use kempe_measure::measure::{Along, History, measure, order_of};
use kempe_measure::{Abscissa, DesignsInLanes, ORDER, Series, State, is_of_poses};
use kempe_mechanism::{Branch, Design, PlanNumber, Pose};
use kempe_model::{Leaf, Measure, PoseMeasure};
use kempe_motion::Motion;
use kempe_number::{Interval, Jet, Lanes, Number};
use kempe_units::Expr;

const W: usize = 8;

/// Measures of all points and links of a mechanism, of its poses and of its motion in time.
fn measures(motion: &Motion) -> Vec<Measure> {
    use kempe_model::{DriveId, LinkId, PointId};
    let mechanism = motion.mechanism();
    let (points, links) = (mechanism.model.points.len(), mechanism.model.links.len());
    let point = |k: usize| PointId((k % points) as u32);
    let link = |k: usize| LinkId((k % links) as u32);
    let mut list = Vec::new();
    for k in 0..points.max(links) {
        let (p, q, r) = (point(k), point(k + 1), point(k + 3));
        let (a, b) = (link(k), link(k + 1));
        list.extend([
            PoseMeasure::X(p),
            PoseMeasure::Y(p),
            PoseMeasure::XOn(p, a),
            PoseMeasure::YOn(p, b),
            PoseMeasure::Angle(a),
            PoseMeasure::AngleBetween(a, b),
            PoseMeasure::Distance(p, q),
            PoseMeasure::InstantCenterX(a, b),
            PoseMeasure::InstantCenterY(a, b),
            PoseMeasure::Curvature(p),
            PoseMeasure::CurvatureCenterX(p),
            PoseMeasure::CurvatureCenterY(p),
            PoseMeasure::Speed(p),
            PoseMeasure::Acceleration(p),
            PoseMeasure::AngularSpeed(a),
            PoseMeasure::AngularAcceleration(b),
            PoseMeasure::TransmissionAngle {
                at: p,
                a: q,
                b: r,
                folded: k % 2 == 0,
            },
        ]);
    }
    let of = |pose: PoseMeasure| Expr::Leaf(Leaf::Pose(pose));
    let mut list: Vec<Measure> = list.into_iter().map(of).collect();
    let rate = |inner: &Measure| Expr::Leaf(Leaf::Rate(Box::new(inner.clone()), 1));
    let slope =
        |inner: &Measure| Expr::Leaf(Leaf::Coefficient(Box::new(inner.clone()), DriveId(0), 1));
    let derived: Vec<Measure> = list
        .iter()
        .take(9)
        .flat_map(|m| [rate(m), slope(m)])
        .collect();
    list.extend(derived);
    list.retain(|m| order_of(mechanism, m).is_ok());
    list
}

/// The state in which the coordinates run as these series.
fn state<B: Number>(motion: &Arc<Motion>, branch: &Branch, moving: &[Series<B>]) -> State<B>
where
    Series<B>: PlanNumber,
{
    let design = Arc::new(motion.design_on::<Series<B>>());
    State::moving(&design, branch, B::from_f64(0.3), moving)
}

/// Coordinates of the drives near a place of a motion, moving somehow.
fn near(motion: &Motion, p: f64, rng: &mut Rng, part: f64) -> Vec<Series<f64>> {
    let mut q = vec![0.0; motion.mechanism().model.drives.len()];
    motion.path.coordinates(p, &mut q);
    let size = motion.design.size();
    (motion.mechanism().model.drives.iter().zip(q))
        .map(|(drive, q)| {
            let unit = match drive.dimension {
                kempe_units::Dimension::ANGLE => 1.0,
                _ => size,
            };
            let mut number = |scale: f64| rng.range(-1.0, 1.0) * scale * unit;
            let rest = [number(1.0), number(1.0), number(1.0), number(1.0)];
            Jet::from_coefficients([q + number(part), rest[0], rest[1], rest[2], rest[3]])
        })
        .collect()
}

fn of<B: Number>(state: &State<B>, asked: &Measure) -> Series<B> {
    measure(state, &History::default(), None, asked, Along::Time)
}

#[test]
fn lanes_have_the_bits_of_each_alone() {
    let mut compared = 0;
    for seed in 0..60 {
        let case = Case::of(&make(&recipe(seed)).spec);
        let Ok(motion) = case.motion() else { continue };
        let mut rng = Rng(seed ^ 0x1a9e);
        let p = spread(&motion, 3)[1];
        let mut branch = Branch::neutral(motion.mechanism());
        motion.branch_at(p, &mut branch);
        let alone: Vec<Vec<Series<f64>>> =
            (0..W).map(|_| near(&motion, p, &mut rng, 1e-3)).collect();
        let moving: Vec<Series<Lanes<W>>> = (0..alone[0].len())
            .map(|drive| {
                Jet::from_coefficients(std::array::from_fn(|k| {
                    Lanes::from_fn(|lane| alone[lane][drive].coefficient(k))
                }))
            })
            .collect();
        let together = state(&motion, &branch, &moving);
        let alone: Vec<State<f64>> = alone.iter().map(|q| state(&motion, &branch, q)).collect();
        // Newton groups are solved to rounding, in other steps; measures of the same poses are the same.
        let groups = !motion.mechanism().plan.newton_blocks.is_empty();
        for asked in measures(&motion) {
            let found = of(&together, &asked);
            for (lane, state) in alone.iter().enumerate() {
                let wanted = of(state, &asked);
                for k in 0..ORDER {
                    let (a, b) = (found.coefficient(k).lane(lane), wanted.coefficient(k));
                    let same = a == b || (a.is_nan() && b.is_nan());
                    if groups {
                        continue;
                    }
                    assert!(same, "seed {seed} {asked:?} lane {lane} order {k}: {a} {b}");
                    compared += usize::from(b.is_finite());
                }
            }
        }
    }
    assert!(compared > 100_000, "{compared}");
}

/// The hull of numbers, coefficient by coefficient.
fn hull(parts: impl Iterator<Item = Series<f64>> + Clone) -> Series<Interval> {
    Jet::from_coefficients(std::array::from_fn(|k| {
        let values = parts.clone().map(|x| x.coefficient(k));
        let low = values.clone().fold(f64::INFINITY, f64::min);
        Interval::new(low, values.fold(f64::NEG_INFINITY, f64::max))
    }))
}

#[test]
fn intervals_hold_what_lies_between() {
    let (mut compared, mut narrow) = (0, 0);
    for seed in 0..60 {
        let case = Case::of(&make(&recipe(seed)).spec);
        let Ok(motion) = case.motion() else { continue };
        let mut rng = Rng(seed ^ 0x17e7);
        let p = spread(&motion, 3)[1];
        let mut branch = Branch::neutral(motion.mechanism());
        motion.branch_at(p, &mut branch);
        let part = [1e-6, 1e-3, 3e-2][rng.below(3)];
        let base = near(&motion, p, &mut rng, 0.0);
        let samples: Vec<State<f64>> = (0..12)
            .map(|_| -> Vec<Series<f64>> {
                let mut beside = |x: f64| x * (1.0 + part * rng.range(-1.0, 1.0));
                let series = base.iter().map(|q| q.coefficients().map(&mut beside));
                series.map(Jet::from_coefficients).collect()
            })
            .map(|q| state(&motion, &branch, &q))
            .filter(|s| {
                s.poses
                    .iter()
                    .all(|pose| pose.x.is_finite() && pose.c.is_finite())
            })
            .collect();
        let Some(one) = samples.first() else { continue };
        let drives = one.coordinates.len();
        let poses_of =
            |part: fn(&State<f64>) -> &[Pose<Series<f64>>]| -> Vec<Pose<Series<Interval>>> {
                (0..one.poses.len())
                    .map(|body| {
                        let of = |pick: fn(&Pose<Series<f64>>) -> Series<f64>| {
                            hull(samples.iter().map(move |s| pick(&part(s)[body])))
                        };
                        Pose {
                            x: of(|pose| pose.x),
                            y: of(|pose| pose.y),
                            c: of(|pose| pose.c),
                            s: of(|pose| pose.s),
                        }
                    })
                    .collect()
            };
        let boxed = State {
            design: Arc::new(motion.design_on::<Series<Interval>>()),
            time: Interval::new(0.3, 0.3),
            abscissa: Abscissa::time(Interval::new(0.3, 0.3), 1.0),
            poses: poses_of(|s| &s.poses),
            coordinates: (0..drives)
                .map(|d| hull(samples.iter().map(|s| s.coordinates[d])))
                .collect(),
            near: branch.near.clone(),
            inner: Vec::new(),
            alone: (0..drives)
                .map(|d| match d {
                    0 => Some(poses_of(|s| s.alone[0].as_deref().unwrap())),
                    _ => None,
                })
                .collect(),
        };
        for asked in measures(&motion) {
            let bounds = of(&boxed, &asked);
            for sample in &samples {
                let value = of(sample, &asked);
                for k in 0..ORDER {
                    let (bounds, value) = (bounds.coefficient(k), value.coefficient(k));
                    // Where some value between might not be there, no bounds are told.
                    if !value.is_finite() || bounds.is_empty() {
                        continue;
                    }
                    assert!(
                        bounds.contains(value),
                        "seed {seed} {asked:?} order {k}: {value} not in {bounds:?}"
                    );
                    compared += 1;
                    narrow += usize::from(bounds.hi() - bounds.lo() < value.abs());
                }
            }
        }
    }
    assert!(
        compared > 100_000 && narrow > compared / 4,
        "{narrow} of {compared}"
    );
}

/// Designs in lanes against each design's own state on the same branch.
#[test]
fn designs_in_lanes_are_the_designs() {
    let text = "[parameters]
a = \"20 mm\"
c = \"40 mm\"
[links]
frame = { A = [0, 0], D = [\"60 mm\", 0] }
crank = { A-B = \"a\" }
coupler = { B-C = \"50 mm\", P = [\"20 mm\", \"15 mm\"] }
rocker = { D-C = \"c\" }
[drives]
motor = { turns = \"crank\", from = 0, to = 6, speed = \"1 rad/s\" }
[assembly]
C = \"left of B -> D\"
[measures]
m1 = \"angle(rocker)\"
m2 = \"d(y(P), motor, 2)\"
m3 = \"instant_center_x(coupler)\"
m4 = \"transmission_angle(C)\"
m5 = \"max(x(P), 2 * a) + abs(y(P))\"
no1 = \"speed(P)\"
no2 = \"curvature(P)\"
no3 = \"max(x(P))\"
no4 = \"angle(A -> P)\"
no5 = \"time * 1 m/s\"
";
    let case = Case::read(text, "lanes.toml");
    let motion = case.must_move();
    let model = &motion.mechanism().model;
    for named in &model.measures {
        let alone = named.name.starts_with('m');
        assert_eq!(
            is_of_poses(&motion, &named.measure),
            alone,
            "{}",
            named.name
        );
    }
    let asked: Vec<&Measure> = model.measures[..5].iter().map(|m| &m.measure).collect();
    lanes_are_the_designs(&motion, &asked, &[0.02, 0.04], [0.0, 0.7, 2.0, 4.5]);
}

/// The same of a Newton group too large to be solved in lanes: every lane has a Jacobian of its own.
#[test]
fn designs_of_large_groups_in_lanes_are_the_designs() {
    let text = include_str!("../../../../examples/gallery/scissor-lift.toml");
    let text = text.replace("[parameters]\n", "[parameters]\nreach = \"1600 mm\"\n");
    let text = text.replace("A-C = 1600", "A-C = \"reach\"");
    let case = Case::read(&text, "lanes.toml");
    let motion = case.must_move();
    let model = &motion.mechanism().model;
    let asked = ["height", "gain", "tilt"].map(|name| {
        let named = model.measures.iter().find(|m| m.name == name);
        &named.expect("a measure").measure
    });
    let first = &model.parameters[0].name;
    assert_eq!(first, "reach");
    let own: Vec<f64> = model.parameter_values();
    lanes_are_the_designs(&motion, &asked, &own, [1.06, 1.2, 1.3, 1.45]);
}

/// Measures of designs whose parameters lie about these, in lanes and alone; the first parameter far off breaks its own lane only.
fn lanes_are_the_designs(motion: &Arc<Motion>, asked: &[&Measure], about: &[f64], at: [f64; 4]) {
    let mut rng = Rng(4);
    let by = if about.len() == 2 { 0.1 } else { 0.002 };
    let parameters: Vec<[f64; W]> = (about.iter())
        .map(|size| std::array::from_fn(|_| size * rng.range(1.0 - by, 1.0 + by)))
        .collect();
    let lanes: Vec<Lanes<W>> = parameters.iter().map(|p| Lanes(*p)).collect();
    // A design that cannot be assembled is missing in its own lane only.
    let mut broken = lanes.clone();
    broken[0].0[3] = 30.0 * about[0];
    let mut together = DesignsInLanes::new(motion, asked.to_vec(), &lanes);
    let mut with_broken = DesignsInLanes::new(motion, asked.to_vec(), &broken);
    for p in at {
        let (found, less) = (together.at(p), with_broken.at(p));
        for lane in 0..W {
            let own: Vec<Series<f64>> = parameters
                .iter()
                .map(|x| Series::constant(x[lane]))
                .collect();
            let mut branch = Branch::neutral(motion.mechanism());
            motion.branch_at(p, &mut branch);
            let design: Arc<Design<Series<f64>>> = Arc::new(motion.design_of(&own));
            let mut state = State::moving(&design, &branch, 0.0, &[Series::variable(p)]);
            state.abscissa.drive = Some(kempe_model::DriveId(0));
            for (k, asked) in asked.iter().enumerate() {
                let wanted = measure(&state, &History::default(), None, asked, Along::Path);
                assert_eq!(
                    found[k].lane(lane),
                    wanted.coefficient(0),
                    "{asked:?} {lane} {p}"
                );
                match lane {
                    3 => assert!(less[k].lane(lane).is_nan()),
                    _ => assert_eq!(less[k].lane(lane), found[k].lane(lane)),
                }
            }
        }
    }
}
