//! Gears and racks inside larger blocks: every assembly is found, without hints.
#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::support::{Case, Rng, V, add, norm, polar, sub};
use kempe_mechanism::evidence::closure;
use kempe_motion::Stage;
use kempe_motion::assemble::{Shortfall, all_assemblies, find_assemblies};
use kempe_motion::progress::Done;

/// A geared five-bar whose couplers are held at an angle to each other, so that they tie the tips of the two geared
/// cranks like one bar: lengths of cranks, couplers and frame, angle between the couplers, teeth and phase.
struct Geared {
    cranks: [f64; 2],
    couplers: [f64; 2],
    frame: f64,
    between: f64,
    teeth: [u32; 2],
    internal: bool,
    phase: f64,
}

impl Geared {
    fn case(&self) -> Case {
        let ([a, b], [p, q], [m, n]) = (self.cranks, self.couplers, self.teeth);
        Case::read(
            &format!(
                "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [{}, 0] }}
left = {{ A-B = {a} }}
right = {{ D-C = {b} }}
first = {{ B-P = {p} }}
second = {{ P-C = {q} }}
[joints]
mesh = {{ gears = [\"left\", \"right\"], arm = \"frame\", teeth = [{m}, {n}], internal = {}, phase = {:e} }}
[drives]
fold = {{ turns = \"second\", relative_to = \"first\", from = {:e}, to = {:e}, speed = \"1 rad/s\" }}
",
                self.frame,
                self.internal,
                self.phase,
                self.between,
                self.between + 0.01
            ),
            "geared",
        )
    }

    /// The left crank's angles at which the tips are as far apart as the couplers hold them, by a fine scan.
    fn scanned(&self) -> usize {
        let [m, n] = self.teeth.map(f64::from);
        let n = if self.internal { -n } else { n };
        let bar: V = add(
            polar(self.couplers[0], 0.0),
            polar(self.couplers[1], self.between),
        );
        let gap = |left: f64| {
            // m left + n right = m phase, the right angle counted from zero.
            let right = m * (self.phase - left) / n;
            let (b, c) = (
                polar(self.cranks[0], left),
                add([self.frame, 0.0], polar(self.cranks[1], right)),
            );
            (right.abs() < PI).then(|| norm(sub(c, b)) - norm(bar))
        };
        let steps = 200_000;
        let at = |k: usize| -PI + 2.0 * PI * (k as f64 + 0.5) / steps as f64;
        (1..steps)
            .filter(|k| matches!((gap(at(k - 1)), gap(at(*k))), (Some(a), Some(b)) if a * b < 0.0))
            .count()
    }
}

#[test]
fn geared_five_bars_have_all_the_assemblies_that_a_scan_finds() {
    let mut rng = Rng(11);
    let mut total = 0;
    for round in 0..60 {
        let mut geared = Geared {
            cranks: [rng.range(15.0, 40.0), rng.range(15.0, 40.0)],
            couplers: [rng.range(20.0, 60.0), rng.range(20.0, 60.0)],
            frame: rng.range(30.0, 80.0),
            between: rng.range(-2.5, 2.5),
            teeth: [12 + rng.below(30) as u32, 12 + rng.below(30) as u32],
            internal: rng.chance(0.4),
            phase: rng.range(-3.0, 3.0),
        };
        if geared.internal && geared.teeth[0] == geared.teeth[1] {
            // A ring has more teeth than a wheel beside its axis.
            geared.teeth[0] += 1;
        }
        let case = geared.case();
        let start = [geared.between];
        let found = all_assemblies(&case.design, &start);
        assert_eq!(found.list.len(), geared.scanned(), "{round}: {}", case.text);
        if !found.list.is_empty() {
            assert_eq!(found.shortfall, Some(Shortfall::Scanned), "{round}");
        }
        total += found.list.len();
    }
    assert!(total > 60, "{total}");
}

/// The gear stands in the middle of a loop of ten links with three further drives; none of 400 random starts led to the
/// pose from which the dimensions were measured.
#[test]
fn a_gear_in_a_loop_without_hints_is_assembled() {
    let case = Case::read(include_str!("../models/gear-in-loop.toml"), "gear-in-loop");
    let motion = case.must_move();
    assert_eq!(motion.assemblies.list.len(), 4);
    let mut state: kempe_mechanism::Configuration<f64> =
        kempe_mechanism::Configuration::new(&case.mechanism);
    let start: Vec<f64> = (case.model.drives.iter())
        .map(|d| d.law.at(0.0, &case.parameters))
        .collect();
    state.set_inputs(&case.mechanism, &start);
    for assembly in &motion.assemblies.list {
        state.poses.clone_from(&assembly.poses);
        let residual = closure(&case.design, &assembly.branch, &state, motion.size());
        assert!(residual < 1e-12, "{residual:e}");
    }
}

/// A rack that the loop's wheel moves is placed after the loop: curves that close in the loop are not followed for as long
/// as the rack runs on.
#[test]
fn what_comes_after_a_gear_loop_is_no_work_in_it() {
    let case = Case::read(include_str!("../models/rack-after-loop.toml"), "rack-after");
    let start: Vec<f64> = (case.model.drives.iter())
        .map(|d| d.law.at(0.0, &case.parameters))
        .collect();
    let mut label = 0;
    let mut progress = |_: Stage, _: Done| {
        label += 1;
        ControlFlow::Continue(())
    };
    let found = find_assemblies(&case.design, &start, &mut progress);
    assert_eq!(found.unwrap().list.len(), 2);
    assert!(label < 20_000, "{label}");
}

/// The angles that a gear ties count from the hints: the same five-bar with its wheel hinted a turn further on has another
/// phase for the same pose.
#[test]
fn a_hint_tells_from_where_a_gear_counts_its_turns() {
    let text = |phase: f64, hint: &str| {
        format!(
            "units = {{ length = \"mm\", angle = \"rad\" }}
[links]
frame = {{ A = [0, 0], D = [50, 0] }}
left = {{ A-B = 20 }}
right = {{ D-C = 20 }}
first = {{ B-P = 40 }}
second = {{ P-C = 40 }}
[joints]
mesh = {{ gears = [\"left\", \"right\"], arm = \"frame\", teeth = [20, 30], phase = {phase:e} }}
[drives]
motor = {{ turns = \"left\", from = 0.3, to = 0.4, speed = \"1 rad/s\" }}
[assembly]
P = \"left of A -> D\"
{hint}
"
        )
    };
    let plain = Case::read(&text(0.7, ""), "plain");
    // 20 (0.3) + 30 (right) = 20 phase: a whole turn of the right wheel is 1.5 turns of phase.
    let further = Case::read(&text(0.7 + 3.0 * PI, "right = { near = 6.5 }"), "further");
    let (a, b) = (plain.must_move(), further.must_move());
    let (a, b) = (&a.assemblies.list[0], &b.assemblies.list[0]);
    for (p, q) in a.poses.iter().zip(&b.poses) {
        assert!((p.x - q.x).abs() < 1e-15 && (p.s - q.s).abs() < 1e-14);
    }
    let turned: f64 = (b.branch.near.iter().zip(&a.branch.near))
        .map(|(b, a)| b - a)
        .sum();
    assert!((turned - 2.0 * PI).abs() < 1e-12, "{turned}");
}
