//! What a simulation found, as laws of the drives.

use std::sync::Arc;

use kempe_dynamics::motor::Motor;
use kempe_dynamics::oil::Oil;
use kempe_integrate::Used;
use kempe_mechanism::Design;
use kempe_model::{COEFFICIENTS, Law, LawPiece, Measure, Polynomials};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{Demand, EndReason, Motion, MotionError, Placed, Progress};
use kempe_units::Expr;

use crate::happening::{Happening, Held};

/// Why a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It came to its end.
    Until,
    /// A condition that ends it holds.
    Condition(usize),
    /// The mechanism comes to where its coordinates cannot tell how it goes on: a limit of the coordinate that is let go.
    Limit(EndReason),
    /// No pose, or no acceleration, was found just ahead.
    NoWay,
    /// No step is short enough: something runs away or jumps.
    TooShort,
    /// More steps or events than anybody waits for.
    TooMany,
    /// It was stopped from outside.
    Stopped,
}

/// What a simulation found.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// How every drive moves, SI.
    pub laws: Vec<Law>,
    /// Work done on the mechanism by all but weights and springs since the start, J.
    pub work: Law,
    /// When it ended, s.
    pub end: f64,
    /// Why.
    pub ending: Ending,
    /// What happened on the way, in order.
    pub happenings: Vec<Happening>,
    /// When stops or friction held it, in order.
    pub held: Vec<Held>,
    /// Steps, and by which method.
    pub used: Used,
    /// How often accelerations were asked for.
    pub evaluations: usize,
    /// The motion on which the pose of the start was found: the assembly that was chosen, and what it has to say.
    pub first: Arc<Motion>,
    /// Inner states, in the order of the model's; none of what nothing followed.
    pub inner: Vec<Option<Law>>,
    /// What the drives that are let go give by themselves.
    pub(crate) machines: Vec<Machine>,
    pub(crate) design: Design<f64>,
    pub(crate) placed: Placed,
}

impl Simulated {
    /// What motor and oil of a drive that was let go (by its place among those) give, N m or N, at a time, s, and a speed of its
    /// coordinate, rad/s or m/s; `throttled` is the value of its [throttle](Self::throttle).
    pub fn gives(&self, place: usize, [time, speed]: [f64; 2], throttled: f64) -> f64 {
        let Some(machine) = self.machines.get(place) else {
            return 0.0;
        };
        let motor = machine.motor.as_ref().map_or(0.0, |(motor, sense)| {
            let part = motor.throttle.as_ref().map_or(1.0, |it| it.of(throttled));
            part * sense * motor.turns_with(sense * speed)
        });
        let oil = machine.oil.as_ref().map_or(0.0, |(oil, first)| {
            let pressure = |place: usize| match self.inner.get(place) {
                Some(Some(law)) => law.at(time, &[]),
                _ => f64::NAN,
            };
            let seals = if speed == 0.0 {
                0.0
            } else {
                oil.friction * speed.signum()
            };
            oil.push([pressure(*first), pressure(*first + 1)], speed) - seals
        });
        motor + oil
    }

    /// What the throttle of the motor of a drive that was let go goes by; none where it has none.
    pub fn throttle(&self, place: usize) -> Option<&Measure> {
        let (motor, _) = self.machines.get(place)?.motor.as_ref()?;
        motor.throttle.as_ref().map(|throttle| &throttle.measure)
    }

    /// The motion that was found, for everything that looks along motions.
    ///
    /// # Errors
    /// Where it cannot be followed.
    pub fn motion(&self, progress: &mut dyn Progress) -> Result<Arc<Motion>, MotionError> {
        let design = self.design.with_laws(|index| self.laws.get(index).cloned());
        let design = design.with_inner_laws(self.inner.clone());
        let (model, parameters) = (&design.mechanism.model, &design.parameters);
        let path = DrivePath::new(model, parameters, design.size());
        let range = path.range(model, parameters);
        let start = path.start(model, parameters);
        let demand = Demand::from_pose(&design, path, range, start, &self.placed);
        Motion::along(&design, demand, progress).map(Arc::new)
    }
}

/// What a drive that was let go gives by itself.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    /// Its motor and the sense in which that turns.
    pub motor: Option<(Motor<f64>, f64)>,
    /// Its oil and the place of its first pressure among the inner states.
    pub oil: Option<(Oil<f64>, usize)>,
}

/// Without a jump between.
#[derive(Default)]
struct Stretch {
    times: Vec<f64>,
    /// By drive: coordinate, speed and acceleration at the times.
    ends: Vec<Vec<[f64; 3]>>,
    /// By drive: accelerations at the quarters of every step.
    quarters: Vec<Vec<[f64; 3]>>,
    /// By what is followed beside the drives: its values in every step.
    beside: Vec<Vec<[f64; COEFFICIENTS]>>,
}

/// Collects what is found.
pub(crate) struct Record {
    start: Vec<f64>,
    /// Where begins what is followed beside the drives.
    beside: Vec<f64>,
    stretches: Vec<Stretch>,
}

impl Record {
    pub fn new(start: Vec<f64>, beside: Vec<f64>) -> Self {
        Self {
            start,
            beside,
            stretches: Vec::new(),
        }
    }

    /// Begins a stretch at a time.
    pub fn begin(&mut self, time: f64, states: &[[f64; 3]]) {
        self.stretches.push(Stretch {
            times: vec![time],
            ends: states.iter().map(|state| vec![*state]).collect(),
            quarters: vec![Vec::new(); states.len()],
            beside: vec![Vec::new(); self.beside.len()],
        });
    }

    /// Adds a step: the accelerations at its quarters, the state at its end, and what is followed beside the drives at equal parts of
    /// it.
    pub fn add(
        &mut self,
        time: f64,
        quarters: &[Vec<[f64; 3]>; 3],
        end: &[[f64; 3]],
        beside: &[[f64; COEFFICIENTS]],
    ) {
        let Some(stretch) = self.stretches.last_mut() else {
            return;
        };
        stretch.times.push(time);
        for (all, values) in stretch.beside.iter_mut().zip(beside) {
            all.push(*values);
        }
        for (drive, end) in end.iter().enumerate() {
            stretch.ends[drive].push(*end);
            stretch.quarters[drive].push([0, 1, 2].map(|k| quarters[k][drive][2]));
        }
    }

    /// The laws of all drives, and of what is followed beside them.
    pub fn laws(self, end: f64) -> (Vec<Law>, Vec<Law>) {
        let stretches: Vec<Stretch> = (self.stretches.into_iter())
            .filter(|s| s.times.len() > 1)
            .collect();
        let local = |stretch: &Stretch| -> Vec<f64> {
            let first = stretch.times[0];
            stretch.times.iter().map(|t| t - first).collect()
        };
        let laws = self.start.iter().enumerate();
        let laws = laws.map(|(drive, start)| {
            let of = |stretch: &Stretch| {
                Polynomials::through(
                    &local(stretch),
                    &stretch.ends[drive],
                    &stretch.quarters[drive],
                )
            };
            law(*start, end, stretches.iter().filter_map(of))
        });
        let beside = self.beside.iter().enumerate().map(|(place, start)| {
            let of = |stretch: &Stretch| {
                Polynomials::at_equal_parts(&local(stretch), &stretch.beside[place])
            };
            law(*start, end, stretches.iter().filter_map(of))
        });
        (laws.collect(), beside.collect())
    }
}

/// A law of polynomials until `end`; one that stands still where there are none or where they do.
fn law(start: f64, end: f64, pieces: impl Iterator<Item = Polynomials>) -> Law {
    let pieces: Vec<Polynomials> = pieces.collect();
    if pieces.iter().all(|p| p.is_constant(start)) {
        return Law {
            from: Expr::Const(start),
            pieces: vec![LawPiece::Dwell {
                duration: Expr::Const(end),
            }],
        };
    }
    Law {
        from: Expr::Const(start),
        pieces: pieces.into_iter().map(LawPiece::Polynomials).collect(),
    }
}
