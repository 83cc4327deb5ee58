//! Coordinates of a spanning tree against minimal ones: two ways to the same motion.
#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;

use crate::common::{Free, at};
use crate::properties::{Acted, MADE, Wanted, acted};
use kempe_dynamics::ForceSampler;
use kempe_mechanism::{Design, NotCut};
use kempe_model::{DriveId, Leaf, Measure, PointId, PoseMeasure};
use kempe_motion::{Done, Silent, Stage};
use kempe_number::math;
use kempe_simulate::{
    Coordinates, Ending, Happened, Happening, NoTree, Question, Resistance, Simulated, Stop,
    Unsimulated, simulate,
};
use kempe_units::Expr;

const PENDULUM: &str = include_str!("../../../../examples/benchmarks/pendulum.toml");
const CART: &str = include_str!("../../../../examples/benchmarks/cart-pole.toml");
const ROCKER: &str = include_str!("../../../../examples/benchmarks/crank-rocker.toml");
const SLIDER: &str = include_str!("../../../../examples/benchmarks/free-slider-crank.toml");
const ANDREWS: &str = include_str!("../../../../examples/benchmarks/andrews.toml");
const HYDRAULIC: &str = include_str!("../../../../examples/benchmarks/hydraulic-arm.toml");
const TWO: &str = include_str!("../../../../examples/benchmarks/n-four-bar-2.toml");
const FORTY: &str = include_str!("../../../../examples/benchmarks/n-four-bar-40.toml");

/// What both find.
fn both(free: &mut Free) -> [Simulated; 2] {
    let found = [Coordinates::Minimal, Coordinates::SpanningTree].map(|coordinates| {
        free.question.coordinates = coordinates;
        free.run()
    });
    assert!(found[0].tree.is_none());
    let tree = found[1].tree.unwrap();
    assert!(tree.off < 1e-11, "{tree:?}");
    found
}

/// How far drives are apart at most, in rad and m; and their speeds.
fn apart([a, b]: &[Simulated; 2]) -> [f64; 2] {
    assert_eq!(a.ending, b.ending);
    assert!((a.end - b.end).abs() < 1e-9 * a.end);
    let mut most = [0.0_f64; 2];
    for drive in 0..a.laws.len() {
        for k in 0..=200 {
            let time = a.end.min(b.end) * f64::from(k) / 200.0;
            let (a, b) = (at(a, drive, time), at(b, drive, time));
            for k in 0..2 {
                most[k] = math::max(most[k], (a[k] - b[k]).abs());
            }
        }
    }
    most
}

#[test]
fn benchmarks_agree() {
    // The cart and its pole are thrown about: what they do grows from rounding.
    for (text, until, speed, [place, rate]) in [
        (PENDULUM, 10.0, 0.0, [1e-12, 1e-11]),
        (CART, 10.0, 0.0, [1e-7, 1e-5]),
        (ROCKER, 2.0, 1.0, [1e-9, 1e-8]),
        (SLIDER, 2.0, 1.0, [1e-10, 1e-9]),
        (ANDREWS, 0.03, 0.0, [1e-10, 1e-7]),
        (TWO, 10.0, -1.0, [1e-7, 1e-6]),
        (FORTY, 1.0, -1.0, [1e-8, 1e-7]),
    ] {
        let mut free = Free::new(text, until);
        free.question.start[0][1] = speed;
        let two = both(&mut free);
        assert_eq!(two[1].ending, Ending::Until);
        let off = apart(&two);
        assert!(off[0] < place && off[1] < rate, "{off:?}");
    }
}

/// A simulation of what comes to its end in so many steps.
fn short(design: &Design<f64>, question: &Question) -> Result<Simulated, Unsimulated> {
    let mut steps = 0;
    let mut enough = |stage: Stage, _: Done| {
        steps += usize::from(stage == Stage::Simulating);
        match steps > 500 {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    simulate(design, question, &mut enough)
}

/// What both find of a question; nothing where minimal coordinates do not come to the end, or the tree is refused for a pin on a smooth
/// curve.
fn both_of(it: &Acted, mut question: Question) -> Option<[Simulated; 2]> {
    let design = &it.case.design;
    question.coordinates = Coordinates::Minimal;
    let minimal = short(design, &question).ok()?;
    if minimal.ending != Ending::Until {
        return None;
    }
    question.coordinates = Coordinates::SpanningTree;
    match short(design, &question) {
        Ok(tree) => Some([minimal, tree]),
        Err(Unsimulated::NoTree(NoTree::Cut(NotCut::OnCurve(_)))) => None,
        Err(why) => panic!("{why:?}"),
    }
}

/// How far points are apart at most along the motions that were found, in sizes of the mechanism; nothing where one of the motions cannot
/// be followed.
fn points_apart(it: &Acted, [minimal, tree]: &[Simulated; 2]) -> Option<f64> {
    let points = (0..it.case.model.points.len() as u32).map(PointId);
    let asked: Vec<Measure> = points
        .flat_map(|point| [PoseMeasure::X(point), PoseMeasure::Y(point)])
        .map(|it| Expr::Leaf(Leaf::Pose(it)))
        .collect();
    let asked: Vec<&Measure> = asked.iter().collect();
    let of = |found: &Simulated| {
        let motion = found.motion(&mut Silent).ok()?;
        ForceSampler::new(&motion, &asked).ok()
    };
    let (mut of_minimal, mut of_tree) = (of(minimal)?, of(tree)?);
    let end = math::min(minimal.end, tree.end);
    let mut most = 0.0_f64;
    for k in 0..=100 {
        let time = end * f64::from(k) / 100.0;
        let minimal = of_minimal.values_at_time(time);
        if minimal.iter().any(|x| x.is_nan()) {
            return None;
        }
        for (a, b) in minimal.iter().zip(of_tree.values_at_time(time)) {
            most = math::max(most, (a - b).abs() / it.size);
        }
    }
    Some(most)
}

#[test]
fn random_mechanisms_agree() {
    let (mut done, mut kept, mut told) = (0, 0, 0);
    for seed in 0..MADE {
        for keeps in [false, true] {
            let wanted = Wanted {
                stroke: 1.0,
                takes: 1.0,
                damped: seed % 2 == 0,
            };
            let Some(mut it) = acted(seed, wanted) else {
                continue;
            };
            let mut question = it.question(2.0 * it.time, 1e-13);
            if keeps && question.free.len() > 1 {
                question.free.remove(0);
                question.start.remove(0);
            } else if keeps {
                continue;
            }
            let Some(two) = both_of(&it, question) else {
                continue;
            };
            assert_eq!(two[1].ending, Ending::Until, "{seed} {keeps}");
            let Some(off) = points_apart(&it, &two) else {
                continue;
            };
            assert!(off < 1e-9, "{seed} {keeps}: {off:e}");
            done += 1;
            kept += usize::from(keeps);
            told += usize::from(!two[1].told_by().is_empty());
        }
    }
    assert!(
        done >= 40 && kept >= 8 && told >= 15,
        "{done} {kept} {told}"
    );
}

/// Stops on both sides of where each drive starts, rigid and soft ones.
#[test]
fn random_mechanisms_between_stops_agree() {
    let (mut done, mut kept, mut struck, mut rested) = (0, 0, 0, 0);
    for seed in 0..MADE {
        let wanted = Wanted {
            stroke: 1.0,
            takes: 1.0,
            damped: true,
        };
        let Some(mut it) = acted(seed, wanted) else {
            continue;
        };
        let mut question = it.question(3.0 * it.time, 1e-13);
        if seed % 2 == 0 && question.free.len() > 1 {
            question.free.remove(0);
            question.start.remove(0);
        }
        let keeps = question.free.len() < it.case.model.drives.len();
        for (place, drive) in question.free.clone().into_iter().enumerate() {
            let start = question.start[place][0];
            let unit = it.unit(drive.index());
            let coordinate = || Box::new(Expr::Leaf(Leaf::Drive(drive)));
            let at = |by: f64| Box::new(Expr::Const(start + by * unit));
            let resistance = match seed % 3 {
                0 => Resistance::Rigid { restitution: 0.5 },
                1 => Resistance::Rigid { restitution: 0.0 },
                _ => Resistance::Soft {
                    stiffness: 1000.0 * 9.81 * it.size / unit / unit,
                    damping: 0.0,
                },
            };
            for gap in [
                Expr::Sub(coordinate(), at(-0.04)),
                Expr::Sub(at(0.06), coordinate()),
            ] {
                question.stops.push(Stop { gap, resistance });
            }
        }
        let Some(two) = both_of(&it, question) else {
            continue;
        };
        let counts = two.each_ref().map(|found| found.happenings.len());
        assert_eq!(two[1].ending, Ending::Until, "{seed}");
        let Some(off) = points_apart(&it, &two) else {
            continue;
        };
        assert!(off < 1e-8, "{seed}: {off:e}");
        done += 1;
        kept += usize::from(keeps);
        struck += usize::from(counts[0] > 0);
        let rests = |it: &Happening| matches!(it.what, Happened::Rests { .. });
        rested += usize::from(two[1].happenings.iter().any(rests));
    }
    let counts = [done, kept, struck, rested];
    assert!(
        counts
            .iter()
            .zip([20, 5, 20, 8])
            .all(|(is, least)| *is >= least),
        "{counts:?}"
    );
}

#[test]
fn what_is_no_tree_is_refused() {
    let mut refused = 0;
    for seed in 0..MADE {
        let wanted = Wanted {
            stroke: 1.0,
            takes: 1.0,
            damped: false,
        };
        let Some(mut it) = acted(seed, wanted) else {
            continue;
        };
        let mut question = it.question(it.time, 1e-13);
        question.coordinates = Coordinates::SpanningTree;
        let found = short(&it.case.design, &question);
        refused += usize::from(matches!(
            found,
            Err(Unsimulated::NoTree(NoTree::Cut(NotCut::OnCurve(_))))
        ));
    }
    assert!(refused > 5);
}

/// Three equal cranks carry one bar: the third says nothing new, and all that it carries is not known, but how it moves is.
const CRANKS: &str = r#"
[links]
frame = { A = [0, 0], B = [0.3, 0], C = [0.8, 0] }
a = { A-D = 0.2, mass = "1 kg", inertia = "0.01 kg m^2" }
b = { B-E = 0.2, mass = "2 kg", inertia = "0.02 kg m^2" }
c = { C-F = 0.2, mass = "1 kg", inertia = "0.01 kg m^2" }
bar = { D = [0, 0], E = [0.3, 0], F = [0.8, 0], mass = "3 kg", inertia = "0.1 kg m^2", center = [0.5, 0.1] }
[drives]
crank = { turns = "a", at = "70 deg" }
[assembly]
D = { near = [0.0684, 0.1879] }
E = { near = [0.3684, 0.1879] }
F = { near = [0.8684, 0.1879] }
"#;

/// A crank turned by a motor through a belt of its own speed, beside a cylinder that keeps its law.
const PRESS: &str = r#"
[links]
frame = { A = [0, 0], G = [0.6, 0], H = [0, -0.4] }
crank = { A-B = 0.1, mass = "2 kg", inertia = "0.02 kg m^2" }
rod = { B-C = 0.35, mass = "1 kg", inertia = "0.01 kg m^2", center = [0.15, 0] }
block = { C = [0, 0], mass = "3 kg" }
arm = { H-K = 0.3, L = [0.15, 0.02], mass = "2 kg", inertia = "0.02 kg m^2" }
[joints]
bore = { slider = "block", at = "C", on = "A -> G" }
[drives]
motor = { turns = "crank", from = "20 deg", to = "380 deg", speed = "200 deg/s" }
lift = { cylinder = "A-L", from = 0.42, to = 0.5, in = "0.6 s", law = "cycloidal" }
[motors.motor]
curve = [["0 rpm", "4 N m"], ["300 rpm", "0 N m"]]
[assembly]
C = { near = [0.44, 0] }
K = { near = [0.3, -0.4] }
"#;

/// What is let go of a model, the others keeping their laws.
fn released(text: &str, until: f64, released: &[u32]) -> Free {
    let mut free = Free::new(text, until);
    let all = std::mem::take(&mut free.question.start);
    free.question.free = released.iter().map(|drive| DriveId(*drive)).collect();
    free.question.start = released.iter().map(|drive| all[*drive as usize]).collect();
    free
}

#[test]
fn what_repeats_itself_is_tied_once() {
    let two = both(&mut Free::new(CRANKS, 3.0));
    let off = apart(&two);
    assert!(off[0] < 1e-7 && off[1] < 1e-6, "{off:?}");
    let tree = two[1].tree.unwrap();
    assert_eq!((tree.coordinates, tree.ties), (4, 4));
}

/// Gears on an arm that moves, too: the arm stands at the start while a wheel turns, which it does but for rounding.
#[test]
fn a_gear_on_an_arm_may_turn_at_the_start() {
    let text = r#"
units = { length = "mm", angle = "deg" }
[links]
frame = { A = [0, 0] }
arm = { A-B = 200, mass = "2 kg", inertia = "0.01 kg m^2", center = [90, 5] }
sun = { A = [0, 0], W = [30, 0], mass = "1 kg", inertia = "0.002 kg m^2", center = "A" }
planet = { B = [0, 0], V = [50, 0], mass = "1.5 kg", inertia = "0.003 kg m^2", center = [10, 5] }
[joints]
mesh = { gears = ["sun", "planet"], teeth = [30, 60], arm = "arm" }
[drives]
lift = { turns = "arm", at = 20 }
spin = { turns = "sun", at = 0 }
"#;
    for speed in [20.0, -0.3, 1e-3] {
        let mut free = Free::new(text, 0.5);
        free.question.start[1][1] = speed;
        let off = apart(&both(&mut free));
        assert!(off[0] < 1e-9 && off[1] < 1e-8, "{speed}: {off:?}");
    }
}

#[test]
fn motors_turn_beside_drives_that_keep_laws() {
    let two = both(&mut released(PRESS, 1.0, &[0]));
    assert_eq!(two[0].ending, Ending::Until);
    let off = apart(&two);
    assert!(off[0] < 1e-9 && off[1] < 1e-8, "{off:?}");
    let work = two
        .each_ref()
        .map(|found| -> f64 { found.work.at(found.end, &[]) });
    assert!((work[0] - work[1]).abs() < 1e-8 * work[0].abs(), "{work:?}");
}

#[test]
fn oil_pushes_along_what_follows() {
    let two = both(&mut Free::new(HYDRAULIC, 0.25));
    let off = apart(&two);
    assert!(off[0] < 1e-10 && off[1] < 1e-8, "{off:?}");
    for place in 0..2 {
        for k in 0..=50 {
            let time = 0.25 * f64::from(k) / 50.0;
            let pressure =
                |found: &Simulated| -> f64 { found.inner[place].as_ref().unwrap().at(time, &[]) };
            let [a, b] = two.each_ref().map(pressure);
            assert!((a - b).abs() < 1.0, "{a} {b}");
        }
    }
    let work = two
        .each_ref()
        .map(|found| -> f64 { found.work.at(found.end, &[]) });
    assert!((work[0] - work[1]).abs() < 1e-8 * work[0].abs(), "{work:?}");
}

/// A crank-rocker whose rocker is let go, with a motor that is throttled: what that gives goes by the rocker alone.
const THROTTLED: &str = r#"
[links]
frame = { A = [0, 0], D = [0.1, 0] }
crank = { A-B = 0.03, mass = "0.5 kg", inertia = "2e-4 kg m^2" }
coupler = { B-C = 0.09, mass = "0.8 kg", inertia = "7e-4 kg m^2" }
rocker = { D-C = 0.07, mass = "0.6 kg", inertia = "4e-4 kg m^2" }
[drives]
swing = { turns = "rocker", from = "100 deg", to = "140 deg", speed = "10 deg/s" }
[motors.swing]
curve = [["0 rpm", "5 N m"], ["3000 rpm", "0 N m"]]
throttle = "0.5 + 0.1 * time / 1 s"
[assembly]
B = "left of A -> C"
C = "left of B -> D"
[measures]
along = "d(x(B), swing) - 1 m"
"#;

#[test]
fn what_goes_by_its_own_drive_ends_at_its_dead_point() {
    let mut free = Free::new(THROTTLED, 2.0);
    let found = both(&mut free);
    let [a, b] = &found;
    assert_eq!(a.tied, b.tied);
    assert!(a.ending != Ending::Until && b.ending != Ending::Until);
    assert!((a.end - b.end).abs() < 1e-3, "{} {}", a.end, b.end);
    let until = 0.99 * a.end.min(b.end);
    for k in 0..=50 {
        let time = until * f64::from(k) / 50.0;
        let [a, b] = [a, b].map(|found| at(found, 0, time));
        assert!((a[0] - b[0]).abs() < 1e-9, "{a:?} {b:?}");
    }
    assert!(b.motion(&mut Silent).is_ok());
    // Derivatives along drives are those of the closed mechanism.
    free.question.end_when.push(free.measure("along"));
    let refused = simulate(&free.design, &free.question, &mut Silent);
    assert!(matches!(refused, Err(Unsimulated::NoTree(NoTree::Along))));
}
