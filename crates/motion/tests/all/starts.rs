//! Motions that start on a change point, or so near to one that the closed forms cannot tell, and what lies just beyond the
//! range that a file demands.
#![allow(clippy::unwrap_used, clippy::disallowed_methods)]

use std::f64::consts::{FRAC_PI_2, PI};

use crate::support::Case;
use kempe_measure::{RowNote, Sample, Sampler};
use kempe_model::Measure;
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Motion, check};
use kempe_number::{Jet, Number};

/// Degrees, as they stand in the files.
const DEG: f64 = PI / 180.0;

/// A four-bar with crank a, coupler b, rocker c, frame d, its crank driven between two angles in degrees; it measures the
/// rocker's angle and its two derivatives to the crank's.
fn four_bar([a, b, c, d]: [i32; 4], from: f64, to: f64, hint: &str) -> Case {
    Case::read(
        &format!(
            "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [{d}, 0] }}
crank = {{ A-B = {a} }}
rod = {{ B-C = {b} }}
rocker = {{ D-C = {c} }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {to:e}, speed = \"60 rpm\" }}
[assembly]
{hint}
[measures]
angle = \"angle(rocker)\"
slope = \"d(angle, motor)\"
bend = \"d(angle, motor, 2)\"
"
        ),
        "four-bar.toml",
    )
}

/// A slider-crank with crank and rod of one length: where the crank stands across the way, the block may go on or stay at
/// the crank's pivot. It measures where the block is, and its derivative.
fn isosceles(from: f64, to: f64, hint: &str) -> Case {
    Case::read(
        &format!(
            "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], F = [100, 0] }}
crank = {{ A-B = 50 }}
rod = {{ B-C = 50 }}
block = {{ C = [0, 0] }}
[joints]
way = {{ slider = \"block\", at = \"C\", on = \"A -> F\" }}
[drives]
motor = {{ turns = \"crank\", from = {from:e}, to = {to:e}, speed = 1 }}
[assembly]
{hint}
[measures]
place = \"x(C)\"
slope = \"d(x(C), motor)\"
"
        ),
        "isosceles.toml",
    )
}

/// The row at a place of the drive.
fn row(case: &Case, motion: &std::sync::Arc<Motion>, at: f64) -> Sample {
    let measures: Vec<&Measure> = case.model.measures.iter().map(|m| &m.measure).collect();
    Sampler::new(motion, &measures).unwrap().at_parameter(at)
}

fn change_points(motion: &std::sync::Arc<Motion>) -> Vec<f64> {
    let events = motion.events.iter();
    let crossings = events.filter(|e| e.kind == EventKind::ChangePoint);
    crossings.map(|e| e.at).collect()
}

/// The slopes of both branches through the pose of a four-bar with all links along the frame, each pointing along it (1) or
/// against it (-1) as `s` says for crank, coupler and rocker.
///
/// With the deviations p, q, r of the three angles the loop says a p' + b q' = c r' (lengths with their signs) along the
/// branches, and to second order a p'^2 + b q'^2 = c r'^2: a quadratic in r' for p' = 1.
fn slopes([a, b, c, _]: [i32; 4], s: [f64; 3]) -> [f64; 2] {
    let (a, b, c) = (
        f64::from(a) * s[0],
        f64::from(b) * s[1],
        f64::from(c) * s[2],
    );
    // a + (c r - a)^2 / b = c r^2.
    let (square, linear, constant) = (c * c / b - c, -2.0 * a * c / b, a + a * a / b);
    let root = (linear * linear - 4.0 * square * constant).sqrt();
    [
        (-linear - root) / (2.0 * square),
        (-linear + root) / (2.0 * square),
    ]
}

/// Every four-bar of these lengths that stands in line at 0 or 180 deg, started there without a hint: the rows lie on one
/// of the two branches through it, with its derivatives, and the change point is told.
#[test]
fn flat_four_bars_start_on_one_of_the_branches_through_the_pose() {
    let lengths = [20, 30, 40, 50, 70];
    let mut tried = 0;
    let all = lengths.iter().flat_map(|a| lengths.map(|b| (*a, b)));
    let all = all.flat_map(|(a, b)| lengths.map(|c| (a, b, c)));
    for (a, b, c, d) in all.flat_map(|(a, b, c)| lengths.map(|d| (a, b, c, d))) {
        let mut sorted = [a, b, c, d];
        sorted.sort_unstable();
        let distinct = sorted.windows(2).all(|w| w[0] < w[1]);
        if !distinct || sorted[0] + sorted[3] != sorted[1] + sorted[2] {
            continue;
        }
        for (from, crank) in [(0.0, 1.0), (180.0, -1.0)] {
            // From A along the frame: B, then C by coupler and rocker.
            let signs = [-1.0, 1.0].iter().flat_map(|q| [(*q, -1.0), (*q, 1.0)]);
            let flat = signs.into_iter().find(|(q, r)| {
                f64::from(a) * crank + f64::from(b) * q == f64::from(d) + f64::from(c) * r
            });
            let Some((coupler, rocker)) = flat else {
                continue;
            };
            let l = [a, b, c, d];
            let label = format!("{l:?} from {from}");
            let expected = slopes(l, [crank, coupler, rocker]);
            tried += 1;
            for to in [from + 10.0, from - 10.0] {
                let case = four_bar(l, from, to, "");
                let motion = case.must_move();
                assert_eq!(
                    motion.ends,
                    (EndReason::Covered, EndReason::Covered),
                    "{label}"
                );
                assert_eq!(change_points(&motion), [from * DEG], "{label}");
                assert_eq!(motion.choices, 2, "{label}");
                let first = row(&case, &motion, from * DEG);
                let note = first.note.unwrap();
                assert!(
                    matches!(note, RowNote::StartsOnChangePoint { choices: 2, .. }),
                    "{label}: {note:?}"
                );
                let text = note.text(motion.mechanism());
                assert!(text.contains("2 branches"), "{label}: {text}");
                let (angle, slope) = (first.values[0], first.values[1]);
                assert!((angle.cos() - rocker).abs() < 1e-15, "{label}: {angle}");
                assert!(angle.sin().abs() < 1e-10, "{label}: {angle}");
                let off = expected
                    .map(|e| (slope - e).abs())
                    .into_iter()
                    .fold(1.0, f64::min);
                assert!(off < 1e-7, "{label}: {slope} of {expected:?}");
                // The rows go on as the first ones say.
                let h = (to - from).signum() * 1e-3;
                let next = row(&case, &motion, from * DEG + h);
                let guess = angle + slope * h + 0.5 * first.values[2] * h * h;
                assert!((next.values[0] - guess).abs() < 1e-5, "{label}");
            }
        }
    }
    assert_eq!(tried, 48);
}

/// The hints decide where they can: each side has its own branch.
#[test]
fn hints_choose_the_branch_at_a_flat_start() {
    for l in [[50, 20, 40, 70], [40, 20, 30, 50]] {
        let mut found = Vec::new();
        for side in ["left", "right"] {
            let hint = format!("C = \"{side} of B -> D\"");
            let case = four_bar(l, 0.0, 10.0, &hint);
            let motion = case.must_move();
            assert_eq!(motion.choices, 1, "{l:?}");
            let first = row(&case, &motion, 0.0);
            let note = first.note.unwrap();
            assert!(
                matches!(note, RowNote::StartsOnChangePoint { choices: 1, .. }),
                "{l:?}"
            );
            let text = note.text(motion.mechanism());
            assert!(text.contains("fits the hints"), "{l:?}: {text}");
            found.push(first.values[1]);
        }
        let mut expected = slopes(l, [1.0, -1.0, -1.0]);
        found.sort_by(f64::total_cmp);
        expected.sort_by(f64::total_cmp);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-8, "{l:?}: {found} {expected}");
        }
    }
}

/// However near to the change point a motion starts, on either side: its branch is 100 cos or 0 exactly, derivatives too,
/// and the change point is told where it lies in the range.
#[test]
fn starts_near_a_change_point_lose_no_digits() {
    for k in 0..=14 {
        for sign in [1.0, -1.0] {
            let away = match k {
                14 => 0.0,
                _ => sign * 10.0_f64.powi(-k - 1),
            };
            for to in [0.3, -0.3] {
                let (from, to) = (FRAC_PI_2 + away, FRAC_PI_2 + away + to);
                let case = isosceles(from, to, "");
                let motion = case.must_move();
                let inside = (FRAC_PI_2 - from) * (to - FRAC_PI_2) >= 0.0;
                if away.abs() > 1e-8 {
                    let expected = if inside { 1 } else { 0 };
                    assert_eq!(change_points(&motion).len(), expected, "{away:e} {to}");
                }
                for at in change_points(&motion) {
                    assert!((at - FRAC_PI_2).abs() < 2e-11, "{away:e}: {at}");
                }
                let mut moving = None;
                for i in 0..=8 {
                    let p = from + (to - from) * f64::from(i) / 8.0;
                    let row = row(&case, &motion, p);
                    let moves = *moving.get_or_insert(row.values[1].abs() > 0.05);
                    let expected = if moves {
                        [0.1 * p.cos(), -0.1 * p.sin()]
                    } else {
                        [0.0; 2]
                    };
                    for (value, expected) in row.values.iter().zip(expected) {
                        let off = (value - expected).abs();
                        assert!(off < 1e-10, "{away:e} at {p}: {value} {expected}");
                    }
                }
            }
        }
    }
}

/// The place that a hint tells at a start short of the change point is meant there, not behind it.
#[test]
fn a_hint_holds_at_the_start_and_not_behind_the_change_point() {
    for away in [1e-2, 1e-3, 1e-4, 1e-5] {
        let hint = "C = { near = [50, 0] }";
        let case = isosceles(FRAC_PI_2 - away, FRAC_PI_2 + 0.3, hint);
        let motion = case.must_move();
        let first = row(&case, &motion, FRAC_PI_2 - away);
        assert!((first.values[1] + 0.1).abs() < 1e-4, "{away:e}: {first:?}");
    }
}

/// What lies beyond the range is not met, however near: the end of the range counts.
#[test]
fn only_what_lies_in_the_demanded_range_is_met() {
    let flat = [20, 60, 20, 60];
    let hint = "C = \"right of D -> B\"";
    for (from, to, expected) in [
        (10.0, 170.0, &[][..]),
        (10.0, 179.99999, &[]),
        (10.0, 180.0, &[180.0]),
        (10.0, 190.0, &[180.0]),
        (170.0, 10.0, &[]),
        (179.0, 181.0, &[180.0]),
    ] {
        let case = four_bar(flat, from, to, hint);
        let motion = case.must_move();
        let expected: Vec<f64> = expected.iter().map(|at: &f64| at * DEG).collect();
        let met = change_points(&motion);
        assert_eq!(met.len(), expected.len(), "{from} to {to}: {met:?}");
        for (met, expected) in met.iter().zip(&expected) {
            assert!((met - expected).abs() < 1e-11, "{from} to {to}: {met}");
        }
        // Neither does the check of how far the drive can go tell them as met.
        let found = check(&case.design);
        assert_eq!(
            found.reach.unwrap().events.len(),
            expected.len(),
            "{from} to {to}"
        );
    }
    // Dead points of a slider-crank driven by its block, 40 mm and 100 mm: at 60 mm and 140 mm.
    for (from, to, expected) in [(61.0, 139.0, 0), (60.0, 139.0, 1), (60.0, 140.0, 2)] {
        let case = Case::read(&driven_by_its_block(from, to), "slider-crank.toml");
        assert_eq!(case.must_move().events.len(), expected, "{from} to {to}");
    }
}

/// A slider-crank with crank 40 mm and rod 100 mm, its block driven.
fn driven_by_its_block(from: f64, to: f64) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], E = [0, 0], F = [200, 0] }}
crank = {{ A-B = 40 }}
rod = {{ B-C = 100 }}
block = {{ C = [0, 0] }}
[joints]
guide = {{ slider = \"block\", at = \"C\", on = \"E -> F\" }}
[drives]
push = {{ slides = \"block\", from = {from}, to = {to}, speed = 10 }}
[assembly]
B = \"left of A -> C\"
"
    )
}

/// A parallelogram that two drives move, the second another crank, from one stretched pose to the other: along time the motion
/// begins and ends right on change points, as along a drive's coordinate. Source: a parallelogram's coupler keeps its direction.
#[test]
fn two_drives_begin_and_end_on_change_points() {
    for law in ["speed = 10", "law = \"3-4-5\", in = \"4 s\""] {
        let drive = |link: &str| format!("{{ turns = \"{link}\", from = 0, to = 360, {law} }}");
        let text = format!(
            "units = {{ length = \"m\", angle = \"deg\" }}
[links]
frame = {{ A = [0, 0], D = [1.3, 0], F = [3, 1] }}
crank = {{ A-B = 0.7 }}
rod = {{ B-C = 1.3 }}
rocker = {{ D-C = 0.7 }}
other = {{ F-G = 0.2 }}
[drives]
m = {}
n = {}
[assembly]
C = {{ near = [2, 0.01] }}
[measures]
x = \"x(C)\"
y = \"y(C)\"
u = \"rate(x)\"
v = \"rate(y)\"
",
            drive("crank"),
            drive("other")
        );
        let case = Case::read(&text, "two.toml");
        let motion = case.must_move();
        let covered = (EndReason::Covered, EndReason::Covered);
        assert_eq!(motion.ends, covered, "{law}");
        assert_eq!(motion.reached(), motion.demanded, "{law}");
        // A law that starts from rest stays at the first one for some time, where the closed forms have lost half of their digits.
        let from_rest = !law.contains("speed");
        if !from_rest {
            assert_eq!(change_points(&motion).len(), 3);
        }
        let tolerance = if from_rest { 1e-6 } else { 1e-9 };
        let end = motion.demanded.1;
        for part in [0.0, 1e-5, 0.01, 0.3, 0.5, 0.9, 1.0 - 1e-5, 1.0] {
            let drive = &motion.mechanism().model.drives[0].law;
            let q: Jet<f64, 2> = drive.at(Jet::variable(part * end), &[]);
            let (s, c) = q.sin_cos();
            let expected = [
                c.value() * 0.7 + 1.3,
                s.value() * 0.7,
                c.derivative(1) * 0.7,
                s.derivative(1) * 0.7,
            ];
            let found = row(&case, &motion, part * end).values;
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < tolerance,
                    "{law}, {part}: {found} is not {expected}"
                );
            }
        }
    }
}
