//! Proofs about poses and motions: what is proved holds the truth, and what is not true is not proved.
#![allow(clippy::excessive_precision, reason = "all digits of the reference")]
#![allow(clippy::unwrap_used)]

#[path = "../../motion/tests/support/mod.rs"]
mod support;

use std::ops::ControlFlow;

use kempe_mechanism::Pose;
use kempe_motion::Motion;
use kempe_number::{Interval, Number};
use kempe_proof::{Certifier, NotProved, Subdivision, certify_motion, certify_pose};
use support::generate::{make, recipe};
use support::{Case, spread};

fn on(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Largest distance of a plain pose from the boxes, in mechanism sizes and as numbers. NaN for empty boxes.
fn outside(boxes: &[Pose<Interval>], poses: &[Pose<f64>], size: f64) -> f64 {
    let mut worst = 0.0_f64;
    for (wide, plain) in boxes.iter().zip(poses) {
        let parts = [
            (wide.x, plain.x, size),
            (wide.y, plain.y, size),
            (wide.c, plain.c, 1.0),
            (wide.s, plain.s, 1.0),
        ];
        for (interval, value, unit) in parts {
            if interval.is_empty() {
                return f64::NAN;
            }
            worst = worst.max((interval - value).mig() / unit);
        }
    }
    worst
}

fn plain(motion: &Motion, p: f64) -> Vec<Pose<f64>> {
    let mut solver = motion.solver();
    motion.solve(&motion.design, p, &mut solver);
    solver.state.poses
}

/// Crank angle; direction (cosine, sine) of coupler and rocker.
const CRANK_ROCKER: [(f64, [[f64; 2]; 2]); 3] = [
    (
        0.3,
        [
            [0.735_486_660_930_365_4, 0.677_539_202_993_820_6],
            [-0.102_973_429_274_240_07, 0.994_684_107_072_945_6],
        ],
    ),
    (
        2.0,
        [
            [0.948_044_307_198_874_9, 0.318_138_321_470_088_43],
            [-0.523_018_034_274_977_4, 0.852_321_615_250_451_4],
        ],
    ),
    (
        4.75,
        [
            [0.524_624_185_279_743_9, 0.851_333_932_261_345_3],
            [-0.825_418_691_956_331_7, 0.564_521_020_838_992_7],
        ],
    ),
];

/// Crank angle; x, y, cosine and sine of the plate.
const TRIAD: [(f64, [f64; 4]); 2] = [
    (
        0.5,
        [
            -0.012_376_227_250_447_36,
            0.036_326_083_340_348_67,
            0.965_195_787_596_735_2,
            0.261_528_376_291_212_3,
        ],
    ),
    (
        3.0,
        [
            -0.052_930_897_207_446_54,
            0.036_786_250_966_432_05,
            0.994_925_482_518_765_2,
            0.100_614_532_920_459_9,
        ],
    ),
];

/// Source: computed with mpmath to 40 digits from the same dimensions in floating point.
#[test]
fn enclosures_hold_values_of_high_precision() {
    let case = Case::example("seeds/crank-rocker");
    assert_eq!(case.parameters, [0.02, 0.05, 0.04, 0.06]);
    let motion = case.must_move();
    for (p, [coupler, rocker]) in CRANK_ROCKER {
        let certificate = certify_pose(&motion, p);
        assert!(
            certificate.exists && certificate.unique,
            "{:?}",
            certificate.reason
        );
        assert!(certificate.widest < 1e-13);
        for (body, [c, s]) in [(2, coupler), (3, rocker)] {
            let pose = &certificate.poses[body];
            assert!(holds(pose.c, c) && holds(pose.s, s), "{p} {pose:?}");
        }
    }
    let case = Case::example("gallery/class-iii");
    let motion = case.must_move();
    let plate = case
        .model
        .links
        .iter()
        .position(|l| l.name == "plate")
        .unwrap();
    for (p, [x, y, c, s]) in TRIAD {
        let certificate = certify_pose(&motion, p);
        assert!(
            certificate.exists && certificate.unique,
            "{:?}",
            certificate.reason
        );
        assert!(certificate.widest < 1e-12);
        let pose = &certificate.poses[case.mechanism.seats[plate].body.index()];
        assert!(
            holds(pose.x, x) && holds(pose.y, y) && holds(pose.c, c) && holds(pose.s, s),
            "{p} {pose:?}"
        );
    }
}

/// Whether an interval holds a decimal number, which lies within half a unit of its nearest double.
fn holds(interval: Interval, decimal: f64) -> bool {
    interval.lo() <= decimal.next_up() && decimal.next_down() <= interval.hi()
}

#[test]
fn the_crank_rocker_is_proved_all_round() {
    for file in ["seeds/crank-rocker", "seeds/crank-rocker-below"] {
        let case = Case::example(file);
        let motion = case.must_move();
        let proof = certify_motion(&motion, Subdivision::default(), on);
        assert!(proof.finished && proof.fraction == 1.0 && proof.gaps.is_empty());
        // One smooth branch without a break, and nothing else within a tenth of the mechanism's size.
        assert_eq!(proof.runs, [proof.range]);
        assert!(proof.cells.len() < 40 && proof.cells.iter().all(|c| c.tube >= 0.03));
    }
}

#[test]
fn the_door_lock_is_proved_but_for_its_change_point() {
    let case = Case::example("seeds/door-lock");
    let motion = case.must_move();
    let subdivision = Subdivision {
        narrowest: 1e-7,
        ..Subdivision::default()
    };
    let proof = certify_motion(&motion, subdivision, on);
    assert_eq!((proof.gaps.len(), proof.runs.len()), (1, 2));
    let at = 117.512_206_516_641_08_f64.to_radians();
    assert!(proof.gaps[0].from < at && at < proof.gaps[0].to);
    let width = proof.gaps[0].to - proof.gaps[0].from;
    assert!(width < 1e-6, "{width:e}");
    assert!(proof.fraction > 1.0 - 1e-6);
}

#[test]
fn gallery_motions_are_proved_and_hold_the_plain_poses() {
    for file in [
        "seeds/crank-rocker",
        "seeds/door-lock",
        "seeds/slider-crank",
        "gallery/class-iii",
        "gallery/stephenson-ii",
        "gallery/geared-five-bar",
        "gallery/jansen",
        "gallery/rack-steering",
        "gallery/excavator",
        "gallery/parallelogram",
        "gallery/belt-leg",
        "gallery/cam-slot-latch",
        "gallery/curved-slot-follower",
        "gallery/groove-cam",
        "gallery/overhead-door",
    ] {
        let case = Case::example(file);
        let motion = case.must_move();
        let size = motion.size();
        let proof = certify_motion(&motion, Subdivision::default(), on);
        assert!(
            proof.fraction > 1.0 - 1e-5,
            "{file} {} {:?}",
            proof.fraction,
            proof.gaps
        );
        for cell in &proof.cells {
            assert!(!cell.poses.iter().any(|p| p.x.is_empty() || p.c.is_empty()));
            for part in [0.0, 0.21, 0.77, 1.0] {
                let p = cell.from + part * (cell.to - cell.from);
                let off = outside(&cell.poses, &plain(&motion, p), size);
                // Next to a change point the plain pose is no better than this.
                let slack = if motion.bridge(p).is_some() {
                    1e-6
                } else {
                    1e-11
                };
                assert!(off <= slack, "{file} {p}: {off:e}");
            }
        }
        // Cells and gaps follow each other without a hole.
        let mut ends: Vec<(f64, f64)> = proof.cells.iter().map(|c| (c.from, c.to)).collect();
        ends.extend(proof.gaps.iter().map(|g| (g.from, g.to)));
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(ends.windows(2).all(|w| w[0].1 == w[1].0), "{file}");
        assert_eq!((ends[0].0, ends[ends.len() - 1].1), proof.range);
    }
}

#[test]
fn what_is_not_a_pose_is_not_proved() {
    for file in [
        "seeds/crank-rocker",
        "seeds/door-lock",
        "gallery/class-iii",
        "gallery/geared-five-bar",
    ] {
        let case = Case::example(file);
        let motion = case.must_move();
        let (low, high) = motion.reached();
        let p = low + 0.37 * (high - low);
        let mut certifier = Certifier::new(&motion);
        let truth = plain(&motion, p);
        let right = certifier.near(p, &truth);
        assert!(right.exists && right.unique, "{file} {:?}", right.reason);
        assert!(outside(&right.poses, &truth, motion.size()) < 1e-12);
        for body in 1..truth.len() {
            let mut wrong = truth.clone();
            wrong[body] = wrong[body].moved(0.0, 0.0, 1e-3);
            let certificate = certifier.near(p, &wrong);
            assert!(
                !certificate.exists && !certificate.unique,
                "{file} body {body}"
            );
            assert!(certificate.reason.is_some() && certificate.poses[body].x.is_empty());
        }
        // A pose of another moment.
        let certificate = certifier.near(p, &plain(&motion, p + 1e-3));
        assert!(!certificate.unique, "{file}");
        // Every other assembly is proved as well, away from this one.
        let mut coordinates = vec![0.0; case.model.drives.len()];
        motion.path.coordinates(p, &mut coordinates);
        let all = kempe_motion::assemble::all_assemblies(&case.design, &coordinates);
        let mut met = 0;
        for assembly in &all.list {
            let other = certifier.near(p, &assembly.poses);
            assert!(other.unique, "{file} {:?}", other.reason);
            met += usize::from(outside(&other.poses, &truth, motion.size()) < 1e-9);
        }
        assert_eq!(met, 1, "{file}");
        let beyond = certify_pose(&motion, high + 1.0);
        assert_eq!(beyond.reason, Some(NotProved::NotReached));
    }
}

#[test]
fn limits_and_redundancy_are_told() {
    // The crane's rocker is driven beyond where it can go.
    let text = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { A = [0, 0], D = [60, 0] }\n\
        crank = { A-B = 20 }\ncoupler = { B-C = 50 }\nrocker = { D-C = 40 }\n\
        [drives]\nmotor = { turns = \"rocker\", from = 120, to = 270, speed = \"1 rad/s\" }\n\
        [assembly]\nB = \"left of A -> C\"\n";
    let case = Case::read(text, "limit");
    let motion = case.must_move();
    let proof = certify_motion(&motion, Subdivision::default(), on);
    assert!(proof.fraction > 0.999, "{}", proof.fraction);
    assert!(!proof.gaps.is_empty());
    assert!(
        proof.gaps.iter().all(|g| g.event.is_some()),
        "{:?}",
        proof.gaps
    );

    let case = Case::example("gallery/three-crank");
    let motion = case.must_move();
    let certificate = certify_pose(&motion, 0.7);
    assert!(certificate.unique && !certificate.exists);
    assert!(matches!(
        certificate.reason,
        Some(NotProved::Redundant { rows: 1 })
    ));
    let proof = certify_motion(&motion, Subdivision::default(), on);
    assert!(proof.redundant == 1 && proof.fraction > 0.999);
}

#[test]
fn a_pose_over_an_interval_holds_every_pose_in_it() {
    for file in ["seeds/crank-rocker", "seeds/door-lock", "gallery/class-iii"] {
        let case = Case::example(file);
        let motion = case.must_move();
        let mut certifier = Certifier::new(&motion);
        let (from, to) = (0.7, 0.7005);
        let certificate = certifier.pose(Interval::new(from, to));
        assert!(
            certificate.exists && certificate.unique,
            "{file} {:?}",
            certificate.reason
        );
        for k in 0..=10 {
            let p = from + (to - from) * f64::from(k) / 10.0;
            assert!(
                outside(&certificate.poses, &plain(&motion, p), motion.size()) < 1e-14,
                "{file}"
            );
            let point = certifier.pose(Interval::from_f64(p));
            assert!(point.poses.iter().zip(&certificate.poses).all(|(a, b)| {
                !a.x.intersect(b.x).is_empty() && !a.s.intersect(b.s).is_empty()
            }));
        }
        // Far too wide an interval says so. The dyad of a crank-rocker closes at every crank angle, and even one interval
        // of a whole turn tells it.
        let (low, high) = motion.reached();
        let wide = certifier.pose(Interval::new(low, high));
        assert_eq!(wide.unique, file == "seeds/crank-rocker", "{file}");
        assert_eq!(wide.unique, wide.reason.is_none());
    }
}

/// A beam whose pins lie exactly in line: its height is a root of what holds zero, and its rate must not be divided by it.
#[test]
fn a_flat_triangle_is_proved() {
    let text = |height: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [200, -50], U = [420, 0], V = [420, 100] }}
back = {{ A-B = 200 }}
beam = {{ B-C = 200, B-P = 400, C-P = {height}, P = \"right of B -> C\" }}
arm = {{ D-C = 60 }}
piston = {{ P = [0, 0] }}
[drives]
motor = {{ turns = \"arm\", from = 0, to = 60, speed = \"10 deg/s\" }}
"
        )
    };
    for height in ["200", "201"] {
        let case = Case::read(&text(height), "beam.toml");
        let motion = case.must_move();
        let proof = certify_motion(&motion, Subdivision::default(), on);
        assert!(
            proof.fraction == 1.0 && proof.gaps.is_empty(),
            "{height}: {:?}",
            proof.gaps
        );
        assert!(proof.cells.len() < 300, "{height}: {}", proof.cells.len());
    }
}

/// Where nothing can be proved, as where rounding leaves a length open by as much as it is, the work is bounded and all of the range
/// is told as not proved.
#[test]
fn what_cannot_be_proved_is_given_up_soon() {
    let case = Case::read(
        "units = { length = \"m\", angle = \"deg\" }
[parameters]
far = \"1e14 m\"
[links]
frame = { A = [0, 0], D = [0.06, 0] }
crank = { A-B = \"far + 0.02 m - far\" }
coupler = { B-C = 0.05 }
rocker = { D-C = 0.04 }
[drives]
motor = { turns = \"crank\", from = 0, to = 360, speed = \"60 rpm\" }
",
        "rounded.toml",
    );
    let motion = case.must_move();
    let mut progress = 0;
    let proof = certify_motion(&motion, Subdivision::default(), |_| {
        progress += 1;
        ControlFlow::Continue(())
    });
    assert!(
        proof.finished && proof.fraction.to_bits() == 0,
        "{}",
        proof.fraction
    );
    let (first, last) = (proof.gaps.first().unwrap(), proof.gaps.last().unwrap());
    assert_eq!((first.from, last.to), proof.range);
    assert!(progress < 10_000, "{progress}");
}

#[test]
fn work_can_be_stopped() {
    let case = Case::example("seeds/crank-rocker");
    let motion = case.must_move();
    let mut progress = Vec::new();
    let proof = certify_motion(&motion, Subdivision::default(), |part| {
        progress.push(part);
        if part > 0.5 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert!(!proof.finished && proof.fraction > 0.4 && proof.fraction < 0.9);
    assert!(progress.windows(2).all(|w| w[0] < w[1]));
}

#[test]
fn random_mechanisms_are_enclosed() {
    // Without and with a slot along a smooth curve, whose bends cost an interval more of its width.
    let (mut proved, mut tried) = ([0; 2], [0; 2]);
    for seed in 0..60 {
        let spec = make(&recipe(seed)).spec;
        let curved = |j: &support::SJoint| matches!(j, support::SJoint::Curve { .. });
        let kind = usize::from(spec.joints.iter().any(curved));
        let case = Case::of(&spec);
        let Ok(motion) = case.motion() else { continue };
        let mut certifier = Certifier::new(&motion);
        for p in spread(&motion, 4) {
            let truth = plain(&motion, p);
            let certificate = certifier.pose(Interval::from_f64(p));
            tried[kind] += 1;
            if !certificate.unique {
                continue;
            }
            proved[kind] += 1;
            let off = outside(&certificate.poses, &truth, motion.size());
            assert!(off <= 1e-9, "seed {seed} at {p}: {off:e}");
            // All bodies at once say the same.
            let near = certifier.near(p, &truth);
            if near.unique {
                for (a, b) in near.poses.iter().zip(&certificate.poses) {
                    let common = [(a.x, b.x), (a.y, b.y), (a.c, b.c), (a.s, b.s)];
                    assert!(
                        common.iter().all(|(a, b)| !a.intersect(*b).is_empty()),
                        "seed {seed}"
                    );
                }
            }
        }
    }
    assert!(
        tried[0] > 100 && proved[0] * 10 > tried[0] * 9 && proved[1] * 10 > tried[1] * 6,
        "{proved:?} of {tried:?}"
    );
}
