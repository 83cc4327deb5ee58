//! From step to step and from event to event.

mod events;

use std::sync::Arc;

use kempe_dynamics::{Forces, Problem};
use kempe_integrate::{Integrator, Stopped, Tolerance, Used};
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::{Design, Mechanism, NotReleased};
use kempe_model::{COEFFICIENTS, DriveId, Law, Leaf, Measure, Model, PoseMeasure};
use kempe_motion::{Done, MotionError, Placed, Progress, Stage};
use kempe_units::Dimension;

use crate::contact::Barrier;
use crate::happening::{Happened, Happening, Held};
use crate::joints::{Place, opened, rigid_stops, touched};
use crate::places::Places;
use crate::plant::{Mode, Plant, motor_sense};
use crate::question::Question;
use crate::record::{Ending, Machine, Pilots, Record, Simulated};
use crate::rubbing::places_that_rub;
use crate::start::{NoStart, start};
use crate::tellers::{Exchanged, NEAR, Tellers};
use crate::toggle::Toggle;
use crate::watch::first;

/// Most steps and events: what is kept of a step or of a stretch between two events takes some hundred bytes.
const STEPS: usize = 1_000_000;
const EVENTS: usize = 20_000;
/// Most events in a time that is none, such as the accumulation of a bouncing ball; and that time, as a part of the whole.
const AT_ONCE: usize = 500;
const NO_TIME: f64 = 1e-12;
/// So many steps without an event that together are this part of the whole time lead nowhere.
const MANY: usize = 2_000;
const HARDLY: f64 = 1e-8;
/// So many times in the whole time a stop closes again by 1/e on which it rests and that errors open.
const BACK: f64 = 10.0;
/// Parts of the whole time in which something that is held is looked at.
const LOOKS: f64 = 500.0;
/// A step whose speed in the middle is off by this part of the fastest there, or by so many tolerances, misses something inside, such
/// as a force that begins or ends: it is taken again by halves, so often at most, and none that is such a part of the whole time.
const MISSED: f64 = 1e-10;
const MISSED_TOLERANCES: f64 = 100.0;
const HALVINGS: usize = 6;
const SHORT: f64 = 1e-6;
/// A stop that is open by this much (in path scales, or of its play) is touched.
const TOUCHED: f64 = 1e-9;

/// Why there is no simulation.
#[derive(Debug)]
pub enum Unsimulated {
    /// The mechanism does not come to the start.
    Start(NoStart),
    /// It cannot move there.
    Motion(MotionError),
    /// What acts on it makes no sense.
    Problems(Vec<Problem>),
    /// Nothing that is let go moves mass there, or friction jams.
    NoMass,
    /// It starts beyond this stop, by so much.
    BeyondStop(usize, f64),
    /// A joint with play starts with its bodies in each other, so deep, m.
    BeyondPlay(Place, f64),
    /// A joint cannot have play.
    NoPlay(NotReleased),
}

/// Simulates a design.
///
/// # Errors
/// Why it cannot begin. What ends it early is told with what was found until then.
pub fn simulate(
    design: &Design<f64>,
    question: &Question,
    progress: &mut dyn Progress,
) -> Result<Simulated, Unsimulated> {
    let model = &design.mechanism.model;
    let parameters = design.parameters.clone();
    let mut coordinates: Vec<f64> = (model.drives.iter())
        .map(|d| d.law.at(0.0, &parameters))
        .collect();
    for (drive, [q, _]) in question.free.iter().zip(&question.start) {
        coordinates[drive.index()] = *q;
    }
    let from = start(design, &coordinates, progress).map_err(Unsimulated::Start)?;
    // Laws are those of the file: what was found may stand still.
    let laws = |index: usize| model.drives.get(index).map(|d| d.law.clone());
    let (mut from, rows) = opened(from, &question.contacts).map_err(Unsimulated::NoPlay)?;
    let mut design = from.design.with_laws(laws);
    let model = &design.mechanism.model.clone();
    coordinates.resize(model.drives.len(), 0.0);
    for row in &rows {
        coordinates[row.drive.index()] = row.start[0];
    }
    let question = &Question {
        free: (question.free.iter().copied())
            .chain(rows.iter().map(|row| row.drive))
            .collect(),
        start: (question.start.iter().copied())
            .chain(rows.iter().map(|row| row.start))
            .collect(),
        ..question.clone()
    };
    let (mut placed, first_motion) = (from.placed.clone(), from.first.clone());
    let driven: Vec<DriveId> = (0..model.drives.len() as u32)
        .map(DriveId)
        .filter(|drive| {
            let law = &model.drives[drive.index()].law;
            !question.free.contains(drive) && law.duration(&parameters) > 0.0
        })
        .collect();
    let moving: Vec<DriveId> = question.free.iter().chain(&driven).copied().collect();
    let mut forces = Forces::new(design.clone()).map_err(Unsimulated::Problems)?;
    // Places that rub slide each in its own sense, which the motion that is found keeps.
    let followed = places_that_rub(&forces.acting, &question.free);
    if followed > 0 {
        let follow = |model: &mut Model| model.actions.followed_friction = followed;
        (from.design, design) = (from.design.with_model(follow), design.with_model(follow));
        forces = Forces::new(design.clone()).map_err(Unsimulated::Problems)?;
    }
    for spring in &mut forces.acting.springs {
        spring.align(&forces.design.geometry, &placed.near);
    }
    let (rigid, barriers): (Vec<Place>, Vec<Barrier>) =
        rigid_stops(&forces.acting.contacts).into_iter().unzip();
    let stops = question.stops.iter().map(Barrier::of).chain(barriers);
    let places = Places::new(from, &moving, progress).map_err(Unsimulated::Motion)?;
    let mut breaks: Vec<f64> = (driven.iter())
        .flat_map(|drive| model.drives[drive.index()].law.breaks(&parameters))
        .filter(|t| 0.0 < *t && *t < question.until)
        .chain([question.until])
        .collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let play = |drive: &DriveId| {
        let row = rows.iter().find(|row| row.drive == *drive);
        row.map(|row| row.clearance)
    };
    let scales: Vec<f64> = (question.free.iter())
        .map(|drive| match model.drives[drive.index()].dimension {
            Dimension::ANGLE => 1.0,
            // What has play is hardly ever off by more.
            _ => play(drive).unwrap_or_else(|| design.size()),
        })
        .collect();
    let senses = question.free.iter().map(|drive| {
        let law = model.drives.get(drive.index()).map(|d| &d.law);
        law.map_or(1.0, |law| motor_sense(law, &parameters))
    });
    let tellers = Tellers::new(
        design.clone(),
        first_motion.clone(),
        [question.free.clone(), driven.clone()],
        senses.collect(),
    );
    let mut plant = Plant::new(
        &design,
        forces,
        places,
        [question.free.clone(), driven],
        scales,
        stops.collect(),
    );
    plant.back = BACK / question.until;
    if followed > 0 {
        plant.follow_friction();
    }
    let mut y: Vec<f64> = (question.start.iter().map(|s| s[0]))
        .chain(question.start.iter().map(|s| s[1]))
        .chain(vec![0.0; plant.inner.pressures() + 1])
        .collect();
    // What was placed is the pose in the middle of all play.
    if rows.iter().any(|row| row.start[0] != 0.0) {
        if let Some((place, by)) = plant.beyond_play(TOUCHED, &y) {
            return Err(Unsimulated::BeyondPlay(place, by));
        }
        if !plant.look(0.0, &y) {
            return Err(Unsimulated::NoMass);
        }
        let instant = plant.instant();
        placed = Placed {
            poses: instant.poses.clone(),
            near: instant.angles.clone(),
        };
    }
    // Switches may go by pressures, and pressures by loads that are switched.
    Toggle::all(&mut plant, &y);
    if !plant.pressures_at_start(&mut y) {
        return Err(Unsimulated::NoMass);
    }
    let toggles = Toggle::all(&mut plant, &y);
    let asked = (question.stops.iter().map(|stop| &stop.gap))
        .chain(&question.end_when)
        .chain(toggles.iter().flat_map(Toggle::measures))
        .chain(plant.amounts.measures());
    plant.asked_along = asked
        .into_iter()
        .any(|what| asks_along(&design.mechanism, what, &question.free));
    let mut run = Run {
        record: Record::new(coordinates, beside(&plant, &y)),
        time: 0.0,
        y,
        ends: (question.end_when.iter())
            .chain(toggles.iter().map(|toggle| &toggle.awaits))
            .cloned()
            .collect(),
        conditions: vec![false; question.end_when.len() + toggles.len()],
        toggles,
        happenings: Vec::new(),
        held: Vec::new(),
        steps: 0,
        integrator: None,
        earlier: (Used::default(), 0),
        resized: false,
        exchanged: false,
        question,
        tellers,
        plant,
    };
    let ending = run.whole(&breaks, progress)?;
    let acting = &run.plant.forces.acting;
    let mut machines: Vec<Machine> = (run.plant.motors.iter())
        .map(|it| Machine {
            motor: it.map(|it| (acting.motors[it.motor].clone(), it.sense)),
            oil: None,
            seals: None,
        })
        .collect();
    for moved in &run.plant.inner.moved {
        machines[moved.free].oil = Some((acting.oils[moved.oil].clone(), moved.place));
    }
    for (moved, place) in run.plant.seals() {
        machines[moved.free].seals = Some(place);
    }
    let end = run.time;
    let (used, evaluations) = run.effort();
    let mut laws = run.record.laws(end);
    let links = run.tellers.used();
    let pilots = (!links.is_empty()).then(|| Pilots {
        mechanism: run.tellers.piloted(),
        count: laws.places.len(),
        laws: [laws.places, laws.choices].concat(),
        links: links.to_vec(),
    });
    let work = laws.beside.remove(0);
    let inner = &run.plant.inner;
    let mut inner_laws: Vec<Option<Law>> = vec![None; inner.values.len()];
    let pressures = inner.moved.iter().flat_map(|m| [m.place, m.place + 1]);
    let friction = run.plant.friction_places();
    let switches = inner.values.len() - inner.switches().len()..inner.values.len();
    for (place, law) in pressures.chain(friction).chain(switches).zip(laws.beside) {
        inner_laws[place] = Some(law);
    }
    Ok(Simulated {
        tied: run.plant.tied(),
        free: question.free.clone(),
        rubbing: run.plant.what_rubs(),
        touched: touched(&run.plant.forces.acting.contacts, &laws.drives, end),
        rigid_from: question.stops.len(),
        rigid,
        laws: laws.drives,
        work,
        end,
        ending,
        happenings: run.happenings,
        held: run.held,
        used,
        evaluations,
        first: first_motion,
        pilots,
        inner: inner_laws,
        machines,
        design,
        placed,
    })
}

/// Whether a measure asks for a derivative along one of these drives, itself or by another measure.
fn asks_along(mechanism: &Mechanism, measure: &Measure, drives: &[DriveId]) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= match leaf {
            Leaf::Coefficient(_, drive, _)
            | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => drives.contains(drive),
            _ => false,
        };
    });
    found
}

/// What is followed beside the drives: the work, the pressures, the parts of friction, the switches.
fn beside(plant: &Plant, y: &[f64]) -> Vec<f64> {
    let (pressures, work) = split(plant, y);
    let switches = plant.inner.switches();
    [work, pressures, &plant.friction_values(), switches].concat()
}

/// The pressures and the work of a state.
fn split<'y>(plant: &Plant, y: &'y [f64]) -> (&'y [f64], &'y [f64]) {
    y[2 * plant.free.len()..].split_at(plant.inner.pressures())
}

/// What became of a step.
enum Added {
    /// It was taken.
    Done,
    /// What lies between its ends was missed.
    Missed,
    /// There is no state in it.
    NoWay,
}

/// A simulation on its way.
struct Run<'q> {
    question: &'q Question,
    plant: Plant,
    record: Record,
    time: f64,
    /// Coordinates that are let go, their speeds, pressures of cylinders, and the work done.
    y: Vec<f64>,
    /// What is waited for: conditions that end it, and what turns each toggle next.
    ends: Vec<Measure>,
    /// Which of them did not hold yet, so that they may come to.
    conditions: Vec<bool>,
    toggles: Vec<Toggle>,
    happenings: Vec<Happening>,
    held: Vec<Held>,
    steps: usize,
    /// It goes on from event to event with the method that was found to suit.
    integrator: Option<Integrator>,
    /// Steps and evaluations of integrators before that, for coordinates of other sizes.
    earlier: (Used, usize),
    /// Whether what tells the place was exchanged last.
    exchanged: bool,
    /// Whether coordinates have other sizes than those for which the integrator was made.
    resized: bool,
    tellers: Tellers,
}

impl Run<'_> {
    /// All stretches between breaks of laws.
    fn whole(
        &mut self,
        breaks: &[f64],
        progress: &mut dyn Progress,
    ) -> Result<Ending, Unsimulated> {
        self.begin()?;
        let (mut events, mut at_once, mut since) = (0, 0, 0.0);
        for end in breaks {
            if self.time > 0.0 && !self.follow_jump(*end) {
                return Ok(Ending::NoWay);
            }
            self.plant.end = *end;
            while self.time < *end {
                // What tells the place may change as often as it likes.
                events += usize::from(!std::mem::take(&mut self.exchanged));
                if self.time > since + NO_TIME * self.question.until {
                    (at_once, since) = (0, self.time);
                }
                at_once += 1;
                if events > EVENTS || at_once > AT_ONCE {
                    return Ok(Ending::TooMany);
                }
                let done = Done::Part(self.time / self.question.until);
                if progress.reached(Stage::Simulating, done).is_break() {
                    return Ok(Ending::Stopped);
                }
                if let Some(ending) = self.stretch(*end, progress) {
                    return Ok(ending);
                }
            }
        }
        Ok(Ending::Until)
    }

    /// Follows a jump in the speeds of drives that keep their laws, at the time at hand, where the next stretch ends at `end`:
    /// the links that hang on them are jerked along.
    fn follow_jump(&mut self, end: f64) -> bool {
        let Some(work) = self.plant.jerk(self.time, end, &mut self.y) else {
            return false;
        };
        if let Some(sum) = self.y.last_mut() {
            *sum += work;
        }
        let jerked = work != 0.0;
        // What it lay on it may be thrown against, or off.
        let before = self.plant.mode.resting.clone();
        match before.first().copied().filter(|_| jerked) {
            Some(stop) => {
                let struck = self.strikes(stop);
                let known = struck.is_some();
                self.settle(struck.unwrap_or_default(), &before) && known
            }
            None => !jerked || self.rub(true, None, &[]),
        }
    }

    /// Decides what holds it at the start.
    fn begin(&mut self) -> Result<(), Unsimulated> {
        for stop in 0..self.plant.stops.len() {
            let gap = self.plant.gap(stop, 0.0, &self.y);
            let open = gap.map_or(f64::NAN, |gap| gap.open);
            if open < -TOUCHED * self.scale() {
                return Err(Unsimulated::BeyondStop(stop, -open));
            }
        }
        for (armed, condition) in self.conditions.iter_mut().zip(&self.ends) {
            *armed = (self.plant.value(condition, 0.0, &self.y)).is_some_and(|x| x < 0.0);
        }
        if !self.rub(true, None, &[]) {
            return Err(Unsimulated::NoMass);
        }
        let mut rates = vec![0.0; self.y.len()];
        if !self.plant.accelerate(0.0, &self.y, &mut rates) {
            return Err(Unsimulated::NoMass);
        }
        let n = self.plant.free.len();
        for (at, speed) in self.plant.pressed(TOUCHED, &self.y, &rates[n..2 * n]) {
            self.meets(at, speed);
        }
        self.rest(0.0, &[]);
        let rests = !self.plant.mode.resting.is_empty();
        match !rests || self.rub(false, None, &[]) {
            true => Ok(()),
            false => Err(Unsimulated::NoMass),
        }
    }

    fn scale(&self) -> f64 {
        self.plant.scales.iter().copied().fold(0.0, f64::max)
    }

    fn tell(&mut self, what: Happened) {
        self.happenings.push(Happening {
            time: self.time,
            what,
        });
    }

    /// From the time at hand to the next event, or to the end; why it ends, where it does.
    fn stretch(&mut self, end: f64, progress: &mut dyn Progress) -> Option<Ending> {
        let until = self.question.until;
        let Some(mut it) = self.integrator_here() else {
            return Some(Ending::NoWay);
        };
        let states = self.plant.drives_at(self.time, &self.y, it.rates());
        let choices = self.plant.tells.iter().map(|tells| tells.choice);
        self.record.begin(self.time, &states, choices.collect());
        let mut found = self.y.clone();
        let is_held = self.plant.mode.stuck || !self.plant.mode.resting.is_empty();
        let Mode {
            resting,
            touched,
            stuck,
            ..
        } = self.plant.mode.clone();
        let began = self.time;
        let (mut halvings, mut part) = (0, f64::INFINITY);
        let mut since = (self.steps, began);
        let ending = loop {
            if self.time >= end {
                break None;
            }
            let mut next = end.min(self.time + std::mem::replace(&mut part, f64::INFINITY));
            if is_held {
                next = next.min(self.time + until / LOOKS);
            }
            let conditions = self.conditions.clone();
            if let Err(reason) = it.step(&mut self.plant, next) {
                // Wherever its dead point is, it cannot tell how to go on.
                let exchanged = self.exchange(f64::INFINITY, progress);
                break (exchanged != Exchanged::Done).then(|| self.no_way(reason));
            }
            self.steps += 1;
            let watched = first(
                &mut it,
                &mut self.plant,
                &self.ends,
                &mut self.conditions,
                &mut found,
            );
            let to = watched.map_or(it.time(), |(time, _)| time);
            if to > self.time {
                let last = halvings == HALVINGS || to - self.time <= SHORT * until;
                match self.add(&mut it, to, &mut found, last) {
                    Added::Done => halvings = 0,
                    Added::Missed => {
                        self.conditions = conditions;
                        (halvings, part) = (halvings + 1, 0.5 * (to - self.time));
                        if it.restart(&mut self.plant, self.time, &self.y) {
                            continue;
                        }
                        break Some(Ending::NoWay);
                    }
                    Added::NoWay => {
                        let exchanged = self.exchange(f64::INFINITY, progress);
                        break (exchanged != Exchanged::Done).then_some(Ending::NoWay);
                    }
                }
            }
            if let Some((_, watch)) = watched {
                break self.happens(watch);
            }
            if self
                .plant
                .places
                .go_on(&self.plant.coordinates, progress)
                .is_err()
            {
                break Some(Ending::NoWay);
            }
            if self.steps > STEPS {
                break Some(Ending::TooMany);
            }
            if self.steps >= since.0 + MANY {
                if self.time - since.1 < HARDLY * until {
                    break Some(Ending::TooShort);
                }
                since = (self.steps, self.time);
            }
            if self.exchange(NEAR, progress) == Exchanged::Done {
                break None;
            }
            let done = Done::Part(self.time / until);
            if progress.reached(Stage::Simulating, done).is_break() {
                break Some(Ending::Stopped);
            }
        };
        self.integrator = Some(it);
        if is_held || !touched.is_empty() {
            let held = Held {
                from: began,
                to: self.time,
                stops: [resting, touched].concat(),
                by_friction: stuck,
            };
            match self.held.last_mut().filter(|last| last.goes_on_in(&held)) {
                Some(last) => last.to = held.to,
                None => self.held.push(held),
            }
        }
        ending
    }

    /// Exchanges what tells the place, where it comes to a dead point of its own within an angle, rad.
    fn exchange(&mut self, within: f64, progress: &mut dyn Progress) -> Exchanged {
        let scales = self.plant.scales.clone();
        let state = (self.time, self.y.as_mut_slice());
        let exchanged = (self.tellers).exchange(&mut self.plant, state, within, progress);
        self.resized |= scales != self.plant.scales;
        self.exchanged |= exchanged == Exchanged::Done;
        exchanged
    }

    /// Steps and evaluations of all integrators.
    fn effort(&self) -> (Used, usize) {
        let (earlier, evaluations) = self.earlier;
        match &self.integrator {
            Some(it) => {
                let used = it.used();
                let used = Used {
                    explicit: earlier.explicit + used.explicit,
                    implicit: earlier.implicit + used.implicit,
                    implicit_from: earlier.implicit_from.or(used.implicit_from),
                };
                (used, evaluations + it.evaluations())
            }
            None => self.earlier,
        }
    }

    /// The integrator at the state at hand.
    fn integrator_here(&mut self) -> Option<Integrator> {
        if std::mem::take(&mut self.resized) {
            self.earlier = self.effort();
            self.integrator = None;
        }
        let (time, y) = (self.time, self.y.as_slice());
        if let Some(mut known) = self.integrator.take() {
            return known.restart(&mut self.plant, time, y).then_some(known);
        }
        let (relative, until) = (self.question.tolerance, self.question.until);
        let absolute =
            (self.plant.scales.iter().map(|s| relative * s))
                .chain(self.plant.scales.iter().map(|s| relative * s / until))
                .chain(self.plant.inner.moved.iter().flat_map(|moved| {
                    [relative * self.plant.forces.acting.oils[moved.oil].scale(); 2]
                }))
                .chain([f64::INFINITY])
                .collect();
        let tolerance = Tolerance { relative, absolute };
        Integrator::with(
            self.question.method,
            &mut self.plant,
            time,
            y,
            1.0,
            tolerance,
        )
    }

    /// Records the part of the last step up to a time, and goes there; or stays, where the step missed what happens inside.
    fn add(&mut self, it: &mut Integrator, to: f64, found: &mut [f64], last: bool) -> Added {
        let from = self.time;
        let now = beside(&self.plant, &self.y);
        let mut values: Vec<[f64; COEFFICIENTS]> = now.iter().map(|x| [*x; COEFFICIENTS]).collect();
        if self.plant.works {
            for k in 1..COEFFICIENTS {
                let part = k as f64 / (COEFFICIENTS - 1) as f64;
                if !it.between(&mut self.plant, from + part * (to - from), found) {
                    return Added::NoWay;
                }
                // Switches stand still within a step.
                let (pressures, work) = split(&self.plant, found);
                for (values, there) in values.iter_mut().zip(work.iter().chain(pressures)) {
                    values[k] = *there;
                }
            }
        }
        if self.plant.holds_somewhere() {
            let first = 1 + self.plant.inner.pressures();
            for k in 0..COEFFICIENTS {
                let time = from + k as f64 / (COEFFICIENTS - 1) as f64 * (to - from);
                if !it.between(&mut self.plant, time, found) {
                    return Added::NoWay;
                }
                let Some(parts) = self.plant.friction_parts(time, found) else {
                    return Added::NoWay;
                };
                for (values, part) in values[first..].iter_mut().zip(parts) {
                    values[k] = part;
                }
            }
        }
        let mut rates = vec![0.0; found.len()];
        let mut at = |time: f64, run: &mut Self| -> Option<Vec<[f64; 3]>> {
            if time == it.time() {
                found.copy_from_slice(it.state());
            } else if !it.between(&mut run.plant, time, found) {
                return None;
            }
            if !run.plant.accelerate(time, found, &mut rates) {
                return None;
            }
            Some(run.plant.drives_at(time, found, &rates))
        };
        let mut quarters: [Vec<[f64; 3]>; 3] = Default::default();
        for (quarter, part) in quarters.iter_mut().zip([0.25, 0.5, 0.75]) {
            match at(from + part * (to - from), self) {
                Some(states) => *quarter = states,
                None => return Added::NoWay,
            }
        }
        let Some(end) = at(to, self) else {
            return Added::NoWay;
        };
        let slow = |scale: &f64| scale / self.question.until;
        let slow: Vec<f64> = self.plant.scales.iter().map(slow).collect();
        let missed = self.record.missed(to, &quarters, &end, &slow);
        if !last && missed > MISSED.max(MISSED_TOLERANCES * self.question.tolerance) {
            return Added::Missed;
        }
        self.record.add(to, &quarters, &end, &values);
        self.time = to;
        self.y.copy_from_slice(found);
        Added::Done
    }

    /// Why there is no step.
    fn no_way(&mut self, reason: Stopped) -> Ending {
        self.plant.take(self.time, &self.y);
        match (self.plant.places.end_at(&self.plant.coordinates), reason) {
            (Some(end), _) => Ending::Limit(end),
            (None, Stopped::NoRates) => Ending::NoWay,
            (None, Stopped::TooShort) => Ending::TooShort,
        }
    }
}

/// Shared by threads, as everything that is computed.
const _: fn() = || {
    fn shared<T: Send + Sync>() {}
    shared::<Arc<Simulated>>();
};
