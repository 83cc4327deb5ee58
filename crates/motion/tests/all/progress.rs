//! Long work tells how far it has come, stops when told, and comes to the same result with_progress or not.
#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;

use crate::support::Case;
use kempe_measure::force_source::NoForces;
use kempe_measure::{Sampler, Unprepared};
use kempe_motion::circuit::Circuit;
use kempe_motion::progress::Done;
use kempe_motion::{Motion, MotionError, Progress, Stage, check_with_progress};

const FOUR_BAR: &str = r#"
units = { length = "mm", angle = "deg" }
[links]
frame   = { A = [0, 0], D = [60, 0] }
crank   = { A-B = 20 }
coupler = { B-C = 50 }
rocker  = { D-C = 40 }
[drives]
motor = { turns = "crank", from = 0, to = 3600, speed = "1 rad/s" }
[assembly]
C = "left of B -> D"
[measures]
swing = "max(angle(rocker)) - mean(angle(rocker))"
way = "path_length(C)"
"#;

/// Stops the `after`-th time that it hears of a stage, and keeps the parts it heard of.
struct Stopping {
    at: Stage,
    after: usize,
    heard: Vec<f64>,
}

impl Progress for Stopping {
    fn reached(&mut self, stage: Stage, done: Done) -> ControlFlow<()> {
        if stage != self.at {
            return ControlFlow::Continue(());
        }
        self.heard.push(done.part().unwrap_or(f64::NAN));
        if self.heard.len() >= self.after {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

fn stopping(at: Stage, after: usize) -> Stopping {
    Stopping {
        at,
        after,
        heard: Vec::new(),
    }
}

#[test]
fn a_motion_stops_in_every_stage_as_soon_as_it_is_told() {
    let case = Case::read(FOUR_BAR, "four-bar");
    for at in [Stage::Assembling, Stage::Following, Stage::Locating] {
        let mut progress = stopping(at, 3);
        let motion = Motion::with_progress(&case.design, &mut progress);
        assert!(
            matches!(motion, Err(MotionError::Stopped { stage }) if stage == at),
            "{at:?}"
        );
        assert_eq!(
            progress.heard.len(),
            3,
            "{at:?}: nothing is asked after the stop"
        );
    }
}

#[test]
fn parts_of_a_stage_rise_from_zero_to_one() {
    let case = Case::read(FOUR_BAR, "four-bar");
    let mut progress = stopping(Stage::Following, usize::MAX);
    let motion = Motion::with_progress(&case.design, &mut progress).unwrap();
    assert_eq!(motion.nodes(), case.motion().unwrap().nodes());
    let heard = progress.heard;
    assert!(heard.iter().all(|p| (0.0..=1.0).contains(p)));
    assert!(heard.is_sorted() && heard[0] == 0.0 && *heard.last().unwrap() > 0.95);
}

#[test]
fn statistics_circuits_and_checks_stop_too() {
    let case = Case::read(FOUR_BAR, "four-bar");
    let motion = case.motion().unwrap();
    for named in &case.model.measures {
        let mut progress = stopping(Stage::Measuring, 5);
        let sampler = Sampler::with_progress(&motion, &[&named.measure], NoForces, &mut progress);
        assert_eq!(sampler.err(), Some(Unprepared::Stopped), "{}", named.name);
        assert_eq!(progress.heard.len(), 5);
    }
    // The motion that finds a circuit's start is followed first: its parts are known, those of the circuit not.
    let mut unknown = 0;
    let mut progress = |_: Stage, done: Done| {
        unknown += usize::from(done == Done::Unknown);
        if unknown > 20 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let circuit = Circuit::with_progress(&case.design, &mut progress);
    assert!(matches!(
        circuit,
        Err(MotionError::Stopped {
            stage: Stage::Following
        })
    ));

    let mut progress = stopping(Stage::Following, 1);
    let findings = check_with_progress(&case.design, &mut progress);
    assert!(matches!(
        findings.problem,
        Some(MotionError::Stopped { .. })
    ));
    assert_eq!(findings.four_bars.len(), 1, "what was found is kept");
}
