//! What a simulation found, as laws of the drives.

use std::sync::Arc;

use kempe_dynamics::motor::Motor;
use kempe_integrate::Used;
use kempe_mechanism::Design;
use kempe_model::{COEFFICIENTS, DriveId, Law, LawPiece, Polynomials};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{Demand, EndReason, Motion, MotionError, Placed, Progress};
use kempe_units::Expr;

use crate::happening::{Happening, Held};
use crate::joints::{Place, Touched};

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
    /// The coordinates that were let go: the question's drives, then the rows of joints with play.
    pub free: Vec<DriveId>,
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
    /// Touches of bodies in joints with play that give, in order.
    pub touched: Vec<Touched>,
    /// The places with play that resist at once, as stops behind those of the question: from `rigid_from` on.
    pub rigid: Vec<Place>,
    /// How many stops the question has.
    pub rigid_from: usize,
    /// Steps, and by which method.
    pub used: Used,
    /// How often accelerations were asked for.
    pub evaluations: usize,
    /// The motion on which the pose of the start was found: the assembly that was chosen, and what it has to say.
    pub first: Arc<Motion>,
    /// Motors of the drives that are let go, each with the sense in which it turns.
    pub(crate) motors: Vec<Option<(Motor<f64>, f64)>>,
    pub(crate) design: Design<f64>,
    pub(crate) placed: Placed,
}

impl Simulated {
    /// The torque, N m, that the motor of a drive that was let go (by its place among those) gives at a speed of its
    /// coordinate, rad/s; none without a motor.
    pub fn motor_torque(&self, place: usize, speed: f64) -> f64 {
        let motor = self.motors.get(place).and_then(Option::as_ref);
        motor.map_or(0.0, |(motor, sense)| {
            sense * motor.turns_with(sense * speed)
        })
    }

    /// The motion that was found, for everything that looks along motions.
    ///
    /// # Errors
    /// Where it cannot be followed.
    pub fn motion(&self, progress: &mut dyn Progress) -> Result<Arc<Motion>, MotionError> {
        let design = self.design.with_model(|model| {
            for (drive, law) in model.drives.iter_mut().zip(&self.laws) {
                drive.law = law.clone();
            }
            for (index, contact) in model.actions.contacts.iter_mut().enumerate() {
                let own = self.touched.iter().filter(|t| t.at.contact == index);
                contact.touches = own.map(|t| t.touching).collect();
            }
        });
        let (model, parameters) = (&design.mechanism.model, &design.parameters);
        let path = DrivePath::new(model, parameters, design.size());
        let range = path.range(model, parameters);
        let start = path.start(model, parameters);
        let demand = Demand::from_pose(&design, path, range, start, &self.placed);
        Motion::along(&design, demand, progress).map(Arc::new)
    }
}

/// Without a jump between.
#[derive(Default)]
struct Stretch {
    times: Vec<f64>,
    /// By drive: coordinate, speed and acceleration at the times.
    ends: Vec<Vec<[f64; 3]>>,
    /// By drive: accelerations at the quarters of every step.
    quarters: Vec<Vec<[f64; 3]>>,
    work: Vec<[f64; COEFFICIENTS]>,
}

/// Collects what is found.
pub(crate) struct Record {
    start: Vec<f64>,
    stretches: Vec<Stretch>,
}

impl Record {
    pub fn new(start: Vec<f64>) -> Self {
        Self {
            start,
            stretches: Vec::new(),
        }
    }

    /// Begins a stretch at a time.
    pub fn begin(&mut self, time: f64, states: &[[f64; 3]]) {
        self.stretches.push(Stretch {
            times: vec![time],
            ends: states.iter().map(|state| vec![*state]).collect(),
            quarters: vec![Vec::new(); states.len()],
            work: Vec::new(),
        });
    }

    /// Adds a step: the accelerations at its quarters, the state at its end, and the work at equal parts of it.
    pub fn add(
        &mut self,
        time: f64,
        quarters: &[Vec<[f64; 3]>; 3],
        end: &[[f64; 3]],
        work: [f64; COEFFICIENTS],
    ) {
        let Some(stretch) = self.stretches.last_mut() else {
            return;
        };
        stretch.times.push(time);
        stretch.work.push(work);
        for (drive, end) in end.iter().enumerate() {
            stretch.ends[drive].push(*end);
            stretch.quarters[drive].push([0, 1, 2].map(|k| quarters[k][drive][2]));
        }
    }

    /// The laws of all drives, and the work as one.
    pub fn laws(self, end: f64) -> (Vec<Law>, Law) {
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
        let of_work =
            |stretch: &Stretch| Polynomials::at_equal_parts(&local(stretch), &stretch.work);
        (
            laws.collect(),
            law(0.0, end, stretches.iter().filter_map(of_work)),
        )
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
