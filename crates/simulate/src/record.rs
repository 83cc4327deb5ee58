//! What a simulation found, as laws of the drives.

use std::sync::Arc;

use kempe_dynamics::motor::Motor;
use kempe_dynamics::oil::Oil;
use kempe_integrate::Used;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{
    COEFFICIENTS, DriveId, Law, LawPiece, LinkId, Measure, Model, Polynomials, Pressed, Stretches,
};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{Demand, EndReason, Motion, MotionError, Placed, Progress};
use kempe_number::math;
use kempe_units::Expr;

use crate::happening::{Happening, Held};
use crate::lack::{Lack, Sought};
use crate::leap::Across;
use crate::plant::Tied;
use crate::touched::{Place, Touched};

/// Why a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It came to its end.
    Until,
    /// A condition that ends it holds.
    Condition(usize),
    /// The mechanism comes to where its coordinates cannot tell how it goes on: a limit of the coordinate that is let go.
    Limit(EndReason),
    /// Nothing is known of accelerations just ahead.
    NoWay(Lack),
    /// Something that it goes by has no value just ahead.
    NoValue(Sought),
    /// This stop is reached where nothing that is let go gives way.
    Unyielding(usize),
    /// The two points of the cylinder of this drive meet: it has no length there, and none beyond.
    NoLength(DriveId),
    /// No step is short enough: something runs away or jumps.
    TooShort,
    /// No step is short enough: this runs away.
    RunsAway(Sought),
    /// More steps than anybody waits for.
    TooManySteps,
    /// More events than anybody waits for.
    TooManyEvents,
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
    /// What stops push that bound more than coordinates of drives, by their place in the question.
    pub pressed: Vec<(usize, Pressed)>,
    /// When it ended, s.
    pub end: f64,
    /// Why.
    pub ending: Ending,
    /// Why it ends where a coordinate that is let go comes to a dead point of its own, if it does.
    pub tied: Option<Tied>,
    /// Which conditions that were to end it held all the time, by their place in the question: they count from where they do not.
    pub held_throughout: Vec<bool>,
    /// What happened on the way, in order.
    pub happenings: Vec<Happening>,
    /// When stops or friction held it, in order.
    pub held: Vec<Held>,
    /// Touches of bodies in joints with play that give, in order.
    pub touched: Vec<Touched>,
    /// The places with play that resist at once, as stops behind those of the question.
    pub rigid: Vec<Place>,
    /// How many stops the question has.
    pub(crate) rigid_from: usize,
    /// Steps, and by which method.
    pub used: Used,
    /// How often accelerations were asked for.
    pub evaluations: usize,
    /// Steps across change points, where several drives move.
    pub across: Across,
    /// The motion on which the pose of the start was found: the assembly that was chosen, and what it has to say.
    pub first: Arc<Motion>,
    /// The coordinates of a spanning tree, where those told the place on the way.
    pub tree: Option<Tree>,
    /// What told the place, where that was not the drives that are let go all the time.
    pub(crate) pilots: Option<Pilots>,
    /// Inner states, in the order of the model's; none of what nothing followed.
    pub inner: Vec<Option<Law>>,
    /// What the drives that are let go give by themselves.
    pub(crate) machines: Vec<Machine>,
    pub(crate) design: Design<f64>,
    pub(crate) placed: Placed,
    /// Times, s, with the poses there, by which a motion is known for the one that was found.
    pub(crate) known: Vec<(f64, Vec<Pose<f64>>)>,
}

/// What coordinates of a spanning tree told the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tree {
    /// How many they are.
    pub coordinates: usize,
    /// How many conditions kept the loops closed that were cut.
    pub ties: usize,
    /// By how much they were off at most at the end of a step, in mechanism sizes or rad, before they were closed again.
    pub off: f64,
}

/// Coordinates that told the place in the stead of drives that are let go.
#[derive(Clone, Debug)]
pub(crate) struct Pilots {
    /// The mechanism whose place they tell: see [`Mechanism::piloted`].
    pub mechanism: Arc<Mechanism>,
    /// Laws of its drives behind the model's own.
    pub laws: Vec<Law>,
    /// The links whose angles told.
    pub links: Vec<LinkId>,
    /// How many there are.
    pub count: usize,
}

impl Simulated {
    /// What motor and oil of a drive that was let go (by its place among those) give, N m or N, at a time, s, and a speed of its
    /// coordinate, rad/s or m/s; `throttled` is the value of its [throttle](Self::throttle).
    pub fn gives(&self, place: usize, [time, speed]: [f64; 2], throttled: f64) -> f64 {
        let Some(machine) = self.machines.get(place) else {
            return 0.0;
        };
        // What tells the place in a drive's stead has none: its motor turns the links.
        let motor = machine.motor.as_ref().filter(|_| self.pilots.is_none());
        let motor = motor.map_or(0.0, |(motor, sense)| {
            let part = motor.throttle.as_ref().map_or(1.0, |it| it.of(throttled));
            sense * motor.gives(part, sense * speed)
        });
        let oil = machine.oil.as_ref().map_or(0.0, |(oil, first)| {
            let pressure = |place: usize| match self.inner.get(place) {
                Some(Some(law)) => law.at(time, &[]),
                _ => f64::NAN,
            };
            let sense = match machine.seals.and_then(|place| self.inner.get(place)) {
                Some(Some(law)) => law.at(time, &[]),
                _ if speed == 0.0 => 0.0,
                _ => speed.signum(),
            };
            let seals = oil.friction * sense;
            oil.push([pressure(*first), pressure(*first + 1)], speed) - seals
        });
        motor + oil
    }

    /// What the throttle of the motor of a drive that was let go goes by; none where it has none.
    pub fn throttle(&self, place: usize) -> Option<&Measure> {
        let (motor, _) = self.machines.get(place)?.motor.as_ref()?;
        motor.throttle.as_ref().map(|throttle| &throttle.measure)
    }

    /// The place with play for which a stop stands; none of those of the question.
    pub fn place_of(&self, stop: usize) -> Option<Place> {
        self.rigid.get(stop.checked_sub(self.rigid_from)?).copied()
    }

    /// The coordinates that tell the place along the motion that was found: nothing gives anything along them but motors. They are
    /// those of the drives that were let go, or drives behind the model's own.
    pub fn telling(&self) -> Vec<DriveId> {
        match &self.pilots {
            None => self.free.clone(),
            Some(pilots) => {
                let first = self.laws.len();
                (first..first + pilots.count)
                    .map(|k| DriveId(k as u32))
                    .collect()
            }
        }
    }

    /// When which links' angles told the place in the stead of the drives that are let go: times, s, with what told from then on, for
    /// each drive a link or none where it told itself. Nothing where none ever did.
    pub fn told_by(&self) -> Vec<(f64, Vec<Option<LinkId>>)> {
        let Some(pilots) = &self.pilots else {
            return Vec::new();
        };
        let choices = pilots.laws.get(pilots.count..).unwrap_or(&[]);
        let mut times: Vec<f64> = vec![0.0];
        times.extend(choices.iter().flat_map(|law| law.breaks(&[])));
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut told: Vec<(f64, Vec<Option<LinkId>>)> = Vec::new();
        for pair in times.windows(2) {
            let at = |law: &Law| law.at(0.5 * (pair[0] + pair[1]), &[]).round() as usize;
            let link = |law: &Law| {
                at(law)
                    .checked_sub(1)
                    .and_then(|k| pilots.links.get(k).copied())
            };
            let links: Vec<Option<LinkId>> = choices.iter().map(link).collect();
            if told.last().is_none_or(|(_, last)| *last != links) {
                told.push((pair[0], links));
            }
        }
        told
    }

    /// How inner states of a model that has not all of them go, as they were found.
    pub fn inner_laws_of(&self, model: &Model) -> Vec<Option<Law>> {
        let own = &self.design.mechanism.model;
        let law = |state| self.inner.get(own.inner_place(state)?)?.clone();
        model.inner_states().into_iter().map(law).collect()
    }

    /// The mechanism that was asked about, its drives moving as was found.
    pub fn mechanism(&self) -> Arc<Mechanism> {
        let design = self.design.with_laws(|index| self.laws.get(index).cloned());
        design.with_inner_laws(self.inner.clone()).mechanism
    }

    /// The motion that was found, for everything that looks along motions.
    ///
    /// # Errors
    /// Where it cannot be followed.
    pub fn motion(&self, progress: &mut dyn Progress) -> Result<Arc<Motion>, MotionError> {
        let design = match &self.pilots {
            None => self.design.clone(),
            Some(pilots) => {
                let mut design = Design::new(&pilots.mechanism, &self.design.parameters);
                design.count_turns(&self.design.geometry.turns);
                design
            }
        };
        let more = self.pilots.iter().flat_map(|pilots| &pilots.laws);
        let laws: Vec<&Law> = self.laws.iter().chain(more).collect();
        let design = design.with_model(|model| {
            for (drive, law) in model.drives.iter_mut().zip(laws) {
                drive.law = law.clone();
            }
            for (index, contact) in model.actions.contacts.iter_mut().enumerate() {
                let own = self.touched.iter().filter(|t| t.at.contact == index);
                contact.touches = own.map(Touched::acting).collect();
            }
            let pressed = self.pressed.iter().map(|(_, pressed)| pressed.clone());
            model.actions.pressed = pressed.collect();
        });
        let design = design.with_inner_laws(self.inner.clone());
        let (model, parameters) = (&design.mechanism.model, &design.parameters);
        let path = DrivePath::new(model, parameters, design.size());
        let range = path.range(model, parameters);
        let start = path.start(model, parameters);
        let in_time = matches!(path, DrivePath::Time { .. });
        let demand = Demand::from_pose(&design, path, range, start, &self.placed);
        let motion = Motion::along(&design, demand, progress)?;
        // What follows laws alone may come to another branch than what follows accelerations.
        let mut solver = motion.solver();
        let elsewhere = |(time, poses): &&(f64, Vec<Pose<f64>>)| {
            let placed = motion.placed(*time, &mut solver);
            let all = placed.iter().flat_map(|it| it.poses.iter().zip(poses));
            all.map(|(a, b)| a.apart(b, motion.size()))
                .fold(0.0, math::max)
                > ELSEWHERE
        };
        match self.known.iter().filter(|_| in_time).find(elsewhere) {
            Some((at, _)) => Err(MotionError::Entangled { at: *at }),
            None => Ok(Arc::new(motion)),
        }
    }
}

/// What a drive that was let go gives by itself.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    /// Its motor and the sense in which that turns.
    pub motor: Option<(Motor<f64>, f64)>,
    /// Its oil and the place of its first pressure among the inner states.
    pub oil: Option<(Oil<f64>, usize)>,
    /// The place among the inner states of the part of its seals' friction that acts, where that is followed.
    pub seals: Option<usize>,
}

/// Poses that are so far apart, in mechanism sizes and rad, are on other branches.
const ELSEWHERE: f64 = 1e-5;
/// Roundings of the places at the ends of a step in the speed between them, at most.
const ROUNDINGS: f64 = 4.0;

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
    /// Which coordinates tell the place.
    choices: Vec<f64>,
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

    /// Begins a stretch at a time, with which coordinates tell the place.
    pub fn begin(&mut self, time: f64, states: &[[f64; 3]], choices: Vec<f64>) {
        self.stretches.push(Stretch {
            times: vec![time],
            ends: states.iter().map(|state| vec![*state]).collect(),
            quarters: vec![Vec::new(); states.len()],
            beside: vec![Vec::new(); self.beside.len()],
            choices,
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

    /// By how much the polynomials of such a step would miss speeds in its middle, as a part of the fastest of the same coordinate
    /// there: the worst of the coordinates that tell the place. Below the speeds `slow` of these, parts of those count.
    pub fn missed(
        &self,
        time: f64,
        quarters: &[Vec<[f64; 3]>; 3],
        end: &[[f64; 3]],
        slow: &[f64],
    ) -> f64 {
        let Some(stretch) = self.stretches.last() else {
            return 0.0;
        };
        let long = time - stretch.times.last().copied().unwrap_or(time);
        let told = (end.len() - slow.len()..end.len()).zip(slow);
        let of = |(column, slow): (usize, &f64)| {
            let Some(begin) = stretch.ends[column].last() else {
                return 0.0;
            };
            let ends = [*begin, end[column]];
            let middle = quarters[1][column][1];
            let accelerations = [0, 1, 2].map(|k| quarters[k][column][2]);
            let off = Polynomials::middle_rate(long, ends, accelerations) - middle;
            // What rounding of the places makes of it.
            let rounds = f64::EPSILON * (ends[0][0].abs() + ends[1][0].abs()) / long;
            let off = (off.abs() - ROUNDINGS * rounds).max(0.0);
            let speeds = [ends[0][1], middle, ends[1][1]].map(f64::abs);
            off / speeds.into_iter().fold(*slow, f64::max)
        };
        told.map(of).fold(0.0, f64::max)
    }

    /// The laws of all drives, of what tells the place, and of which does that; and of what is followed beside them.
    pub fn laws(self, end: f64) -> Laws {
        let stretches: Vec<Stretch> = (self.stretches.into_iter())
            .filter(|s| s.times.len() > 1)
            .collect();
        let local = |stretch: &Stretch| -> Vec<f64> {
            let first = stretch.times[0];
            stretch.times.iter().map(|t| t - first).collect()
        };
        let of = |column: usize, start: f64| {
            let of = |stretch: &Stretch| {
                Polynomials::through(
                    &local(stretch),
                    &stretch.ends[column],
                    &stretch.quarters[column],
                )
            };
            law(start, end, stretches.iter().filter_map(of))
        };
        let drives = self.start.iter().enumerate();
        let drives: Vec<Law> = drives.map(|(drive, start)| of(drive, *start)).collect();
        let told = stretches.first().map_or(0, |s| s.choices.len());
        let places = (0..told).map(|k| {
            let column = self.start.len() + k;
            let first = stretches.first().and_then(|s| s.ends[column].first());
            of(column, first.map_or(f64::NAN, |q| q[0]))
        });
        let choices = (0..told).map(|k| {
            let of = |stretch: &Stretch| {
                let steady = vec![[stretch.choices[k], 0.0, 0.0]; stretch.times.len()];
                let none = vec![[0.0; 3]; steady.len() - 1];
                Polynomials::through(&local(stretch), &steady, &none)
            };
            let first = stretches.first().map_or(0.0, |s| s.choices[k]);
            law(first, end, stretches.iter().filter_map(of))
        });
        let beside = self.beside.iter().enumerate().map(|(place, start)| {
            let of = |stretch: &Stretch| {
                Polynomials::at_equal_parts(&local(stretch), &stretch.beside[place])
            };
            law(*start, end, stretches.iter().filter_map(of))
        });
        Laws {
            beside: beside.collect(),
            drives,
            places: places.collect(),
            choices: choices.collect(),
        }
    }
}

/// What was collected, as laws.
pub(crate) struct Laws {
    /// Of the model's drives.
    pub drives: Vec<Law>,
    /// Of the coordinates that tell the place.
    pub places: Vec<Law>,
    /// Of which coordinates they are.
    pub choices: Vec<Law>,
    /// Of what is followed beside them.
    pub beside: Vec<Law>,
}

/// A law of polynomials until `end`; one that stands still where there are none or where they do.
fn law(start: f64, end: f64, pieces: impl Iterator<Item = Polynomials>) -> Law {
    let pieces: Vec<Polynomials> = pieces.collect();
    let moves = !pieces.iter().all(|p| p.is_constant(start));
    let piece = match Stretches::new(pieces).filter(|_| moves) {
        Some(found) => LawPiece::Polynomials(found),
        None => LawPiece::Dwell {
            duration: Expr::Const(end),
        },
    };
    Law {
        from: Expr::Const(start),
        pieces: vec![piece],
    }
}
