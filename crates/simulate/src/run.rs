//! From step to step and from event to event.

mod begin;
mod events;
mod rests;

use std::sync::Arc;

use kempe_integrate::{Integrator, Stopped, Tolerance, Used};
use kempe_mechanism::evidence::NEARLY_SINGULAR;
use kempe_mechanism::pose::Pose;
use kempe_model::{COEFFICIENTS, Measure, SAME_END};
use kempe_motion::{Done, Progress, Stage};

pub use self::begin::{Ready, ready, simulate};

use crate::first::first;
use crate::happening::{Happened, Happening, Held};
use crate::lack::{Lack, Sought};
use crate::leap::{Ahead, Approach};
use crate::plant::{Mode, Plant};
use crate::question::Question;
use crate::record::{Ending, Record, Simulated};
use crate::sharp::Sharp;
use crate::step::Step;
use crate::step_limits::StepLimits;
use crate::tellers::{Exchanged, NEAR, Tellers};
use crate::toggle::{Toggle, Toggled};
use crate::tree::Telling;
use crate::unsimulated::Unsimulated;

/// Most steps and events: what is kept of a step or of a stretch between two events takes some hundred bytes.
const STEPS: usize = 1_000_000;
const EVENTS: usize = 20_000;
/// Most events in a time that is none, such as the accumulation of a bouncing ball; and that time, as a part of the whole.
const AT_ONCE: usize = 500;
const NO_TIME: f64 = 1e-12;
/// So many steps without an event that together are this part of the whole time lead nowhere.
const MANY: usize = 2_000;
const HARDLY: f64 = 1e-8;
/// The same where the pose is nearly singular besides: what is let go comes to its dead point.
const SLOWLY: f64 = 1e-3;
/// So many times in the whole time a stop closes again by 1/e on which it rests and that errors open.
const BACK: f64 = 10.0;
/// So many steps that together are this part of the whole time lead nowhere where loops that were cut hardly close any more.
const SOME: usize = 100;
const CRAWLS: f64 = 1e-6;
/// Parts of the whole time in which something that is held is looked at.
const LOOKS: f64 = 500.0;
/// A step whose speed in the middle is off by this part of the fastest there, or by so many tolerances, misses something inside, such
/// as a force that begins or ends: it is taken again by halves, so often at most, and none that is such a part of the whole time.
const MISSED: f64 = 1e-10;
const MISSED_TOLERANCES: f64 = 100.0;
const HALVINGS: usize = 6;
const SHORT: f64 = 1e-6;
/// A step goes on to where it may go at most, where no more than this part of it would be left.
const LEFT: f64 = 1e-2;
/// Just behind the start, as a part of the whole time.
const BEGINS: f64 = 1e-6;
/// What has grown to so many times its value at the start where no step is short enough any more runs away.
const RUNS_AWAY: f64 = 1e6;
/// How long steps are before any was made, as a part of the whole time.
const USUAL: f64 = 0.1;
/// A stop that is open by this much (in path scales, or of its play) is touched.
const TOUCHED: f64 = 1e-9;

/// What is followed beside the drives: the work, the pressures, the parts of friction, the switches, what stops push.
fn beside(plant: &Plant, y: &[f64]) -> Vec<f64> {
    let (pressures, work) = split(plant, y);
    let switches = plant.inner.switches();
    let pushes = vec![0.0; plant.on_bodies().count()];
    [work, pressures, &plant.friction_values(), switches, &pushes].concat()
}

/// The pressures and the work of a state.
fn split<'y>(plant: &Plant, y: &'y [f64]) -> (&'y [f64], &'y [f64]) {
    y[2 * plant.free.len()..].split_at(plant.inner.pressures())
}

/// What tells values of a state.
type Tells = fn(&mut Plant, f64, &[f64]) -> Option<Vec<f64>>;

/// What became of a step.
enum Added {
    /// It was taken.
    Done,
    /// What lies between its ends was missed.
    Missed,
    /// What tells the place does not tell all of it.
    Untold,
    /// There is no state in it.
    NoWay,
}

/// A simulation on its way.
struct Run {
    question: Question,
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
    limits: StepLimits,
    sharp: Sharp,
    approach: Approach,
    /// Times, s, behind change points and at the end, with the poses there: of several branches they tell the one.
    known: Vec<(f64, Vec<Pose<f64>>)>,
    /// What loads, valves and throttles gave at the start.
    at_start: Vec<f64>,
}

impl Run {
    /// All stretches between breaks of laws.
    fn whole(&mut self, breaks: &[f64], progress: &mut dyn Progress) -> Ending {
        let (mut events, mut at_once, mut since) = (0, 0, 0.0);
        for end in breaks {
            if self.time > 0.0 && !self.follow_jump(*end) {
                return self.no_way_at_once();
            }
            self.plant.end = *end;
            // What is left behind an event is nothing where it is less than the end of a law is known to.
            let nothing = match *end == self.question.until {
                true => SAME_END * end,
                false => 0.0,
            };
            while self.time < *end - nothing {
                // What tells the place may change as often as it likes.
                events += usize::from(!std::mem::take(&mut self.exchanged));
                if self.time > since + NO_TIME * self.question.until {
                    (at_once, since) = (0, self.time);
                }
                at_once += 1;
                if events > EVENTS || at_once > AT_ONCE {
                    return Ending::TooManyEvents;
                }
                let done = Done::Part(self.time / self.question.until);
                if progress.reached(Stage::Simulating, done).is_break() {
                    return Ending::Stopped;
                }
                if let Some(ending) = self.stretch(*end, progress) {
                    return ending;
                }
            }
        }
        Ending::Until
    }

    /// Follows a jump in the speeds of drives that keep their laws, at the time at hand, where the next stretch ends at `end`:
    /// the links that hang on them are jerked along.
    fn follow_jump(&mut self, end: f64) -> bool {
        let Some((work, jumps)) = self.plant.jerk(self.time, end, &mut self.y) else {
            return false;
        };
        // What moves on alone takes no work, and slides all the same on what is stopped beneath it.
        if jumps.is_empty() {
            return true;
        }
        for (drive, [before, after]) in jumps {
            if self.plant.is_own(drive) {
                self.tell(Happened::Jumps {
                    drive,
                    before,
                    after,
                });
            }
        }
        if let Some(sum) = self.y.last_mut() {
            *sum += work;
        }
        // What it lay on it may be thrown against, or off.
        let before = self.plant.mode.resting.clone();
        match before.first().copied() {
            Some(stop) => {
                let struck = self.strikes(stop);
                let known = struck.is_some();
                self.settle(struck.unwrap_or_default(), &before) && known
            }
            None => self.rub(true, None, &[]),
        }
    }

    /// Decides what holds it at the start.
    fn begin(&mut self) -> Result<(), Unsimulated> {
        for (armed, condition) in self.conditions.iter_mut().zip(&self.ends) {
            *armed = (self.plant.value(condition, 0.0, &self.y)).is_some_and(|x| x < 0.0);
        }
        if !self.rub(true, None, &[]) {
            return Err(self.plant.lacks());
        }
        let mut rates = vec![0.0; self.y.len()];
        if !self.plant.accelerate(0.0, &self.y, &mut rates) {
            return Err(self.plant.lacks());
        }
        self.at_start.clone_from(&self.plant.amounts.values);
        if let Some(sought) = self.without_value_from_start(&rates) {
            return Err(Unsimulated::NoValue(sought));
        }
        let n = self.plant.free.len();
        for (at, speed) in self.plant.pressed(TOUCHED, &self.y, &rates[n..2 * n]) {
            if !self.meets(at, speed) {
                return Err(self.plant.lacks());
            }
        }
        match self.rest_at_start() {
            true => Ok(()),
            false => Err(self.plant.lacks()),
        }
    }

    /// A condition that has no value at the start, where these are the rates, nor just behind it: right there it may have none.
    fn without_value_from_start(&mut self, rates: &[f64]) -> Option<Sought> {
        let soon = BEGINS * self.question.until;
        let along = self.y.iter().zip(rates);
        let then: Vec<f64> = along.map(|(y, rate)| y + soon * rate).collect();
        let now = self.y.clone();
        (0..self.ends.len())
            .find(|k| {
                let measure = self.ends[*k].clone();
                let mut lost = |time: f64, y: &[f64]| {
                    let value = self.plant.value(&measure, time, y);
                    value.is_some_and(|x| !x.is_finite())
                };
                lost(0.0, &now) && lost(soon, &then)
            })
            .and_then(|k| self.sought(k))
    }

    /// What a condition is of, for what has no value: nothing that the file told of, where it watches for a vacuum.
    fn sought(&self, condition: usize) -> Option<Sought> {
        match condition.checked_sub(self.question.end_when.len()) {
            None => Some(Sought::Condition(condition)),
            Some(toggle) => match self.toggles.get(toggle)?.what {
                Toggled::Switch(switch) => Some(Sought::Switch(switch)),
                Toggled::Vacuum(..) => None,
            },
        }
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
        self.close();
        let Some(mut it) = self.integrator_here() else {
            return Some(self.no_way_at_once());
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
        let mut ahead = Ahead::Nothing;
        let mut since = (self.steps, began);
        let mut crawls = since;
        let ending = loop {
            if self.time >= end {
                break None;
            }
            let mut next = end.min(self.limits.after(self.time));
            next = next.min(self.time + std::mem::replace(&mut part, f64::INFINITY));
            if is_held {
                next = next.min(self.time + until / LOOKS);
            }
            if self.sharp.is_there() {
                let plant = &mut self.plant;
                let longest = (self.sharp).longest(plant, self.time, &self.y, it.rates());
                // What would be left is no step of its own.
                if next - (self.time + longest) > LEFT * longest {
                    next = self.time + longest;
                }
            }
            let conditions = self.conditions.clone();
            let mut leap = None;
            match std::mem::replace(&mut ahead, Ahead::Nothing) {
                Ahead::Nothing => {}
                Ahead::Slowly(until) => next = next.min(until),
                Ahead::Leap { at, until } => {
                    let end = end.min(self.limits.after(self.time));
                    let tolerance = Tolerance {
                        relative: self.question.tolerance,
                        absolute: self.absolute(),
                    };
                    leap = (self.approach).leap(&mut it, &mut self.plant, [at, end], &tolerance);
                    next = next.min(until);
                }
            }
            let leaps = leap.is_some();
            if !leaps && let Err(reason) = it.step(&mut self.plant, next) {
                // Wherever its dead point is, it cannot tell how to go on.
                let lack = self.plant.lack;
                let exchanged = self.exchange(f64::INFINITY, progress);
                break (exchanged != Exchanged::Done).then(|| self.no_way(reason, lack));
            }
            self.steps += 1;
            let made: &mut dyn Step = match &mut leap {
                Some(leap) => leap,
                None => &mut it,
            };
            let watched = first(
                made,
                &mut self.plant,
                &self.ends,
                &mut self.conditions,
                &mut found,
            );
            let to = watched.map_or(made.time(), |event| event.time);
            if to > self.time {
                let short = leaps || to - self.time <= SHORT * until;
                let last = short || halvings >= HALVINGS;
                let added = match !short && self.passes(made, to, &mut found) {
                    true => Added::Missed,
                    false => self.add(made, to, &mut found, last),
                };
                match added {
                    Added::Done => halvings = 0,
                    Added::Untold if self.tells_all_step() => {
                        self.conditions = conditions;
                        break None;
                    }
                    Added::Missed | Added::Untold => {
                        self.conditions = conditions;
                        (halvings, part) = (halvings + 1, 0.5 * (to - self.time));
                        if it.restart(&mut self.plant, self.time, &self.y) {
                            continue;
                        }
                        break Some(self.no_way_at_once());
                    }
                    Added::NoWay => {
                        let ending = self.no_way_at_once();
                        let exchanged = self.exchange(f64::INFINITY, progress);
                        break (exchanged != Exchanged::Done).then_some(ending);
                    }
                }
            }
            // An event may come before the change point that the step leads across.
            if self.plant.places.decide(self.time) {
                self.was_here();
            }
            if let Some(event) = watched {
                break self.happens(event);
            }
            if self
                .plant
                .places
                .go_on(self.time, &self.plant.coordinates, progress)
                .is_err()
            {
                break Some(Ending::NoWay(Lack::Pose));
            }
            if leaps {
                if !it.restart(&mut self.plant, self.time, &self.y) {
                    break Some(self.no_way_at_once());
                }
            } else {
                ahead = self.approach.ahead(&it, &mut self.plant);
            }
            if self.steps > STEPS {
                break Some(Ending::TooManySteps);
            }
            if self.plant.ties.is_some() && self.steps >= crawls.0 + SOME {
                if self.time - crawls.1 < CRAWLS * until && self.is_singular() {
                    break Some(self.too_short());
                }
                crawls = (self.steps, self.time);
            }
            if self.steps >= since.0 + MANY {
                let goes_on = self.time - since.1;
                if goes_on < HARDLY * until || goes_on < SLOWLY * until && self.is_singular() {
                    break Some(self.too_short());
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

    /// Whether the pose at hand is nearly singular.
    fn is_singular(&mut self) -> bool {
        self.plant.take(self.time, &self.y);
        if let Some(ties) = &self.plant.ties {
            return ties.least_part() <= NEARLY_SINGULAR;
        }
        (self.plant.places).is_nearly_singular(&self.plant.coordinates)
    }

    /// Keeps the pose at the time at hand.
    fn was_here(&mut self) {
        if self.plant.look(self.time, &self.y) {
            let poses = self.plant.instant().poses.clone();
            self.known.push((self.time, poses));
        }
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

    /// What errors of all that is followed are allowed where it vanishes: of the work, any.
    fn absolute(&self) -> Vec<f64> {
        let (relative, until) = (self.question.tolerance, self.question.until);
        (self.plant.scales.iter().map(|s| relative * s))
            .chain(self.plant.scales.iter().map(|s| relative * s / until))
            .chain(
                self.plant.inner.moved.iter().flat_map(|moved| {
                    [relative * self.plant.forces.acting.oils[moved.oil].scale(); 2]
                }),
            )
            .chain([f64::INFINITY])
            .collect()
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
        let (relative, absolute) = (self.question.tolerance, self.absolute());
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

    /// Whether the last step up to a time passes by what acts in some places alone.
    fn passes(&mut self, it: &mut dyn Step, to: f64, found: &mut [f64]) -> bool {
        if !self.sharp.is_there() {
            return false;
        }
        match to == it.time() {
            true => found.copy_from_slice(it.state()),
            false if !it.between(&mut self.plant, to, found) => return false,
            false => {}
        }
        let from = (self.time, self.y.as_slice());
        self.sharp.passes(&mut self.plant, from, (to, found))
    }

    /// Records the part of the last step up to a time, and goes there; or stays, where the step missed what happens inside.
    fn add(&mut self, it: &mut dyn Step, to: f64, found: &mut [f64], last: bool) -> Added {
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
        // What accelerations alone tell, each from its place on.
        let mut told: Vec<(usize, Tells)> = Vec::new();
        if self.plant.holds_somewhere() || self.plant.rubs_rigidly() {
            told.push((1 + self.plant.inner.pressures(), Plant::friction_parts));
        }
        if self.plant.presses_on_bodies() {
            let first = values.len() - self.plant.on_bodies().count();
            told.push((first, Plant::pushes_on_bodies));
        }
        for (first, tell) in told {
            for k in 0..COEFFICIENTS {
                let time = from + k as f64 / (COEFFICIENTS - 1) as f64 * (to - from);
                if !it.between(&mut self.plant, time, found) {
                    return Added::NoWay;
                }
                let Some(parts) = tell(&mut self.plant, time, found) else {
                    return Added::NoWay;
                };
                for (values, part) in values[first..].iter_mut().zip(parts) {
                    values[k] = part;
                }
            }
        }
        let mut rates = vec![0.0; found.len()];
        let mut at = |time: f64, run: &mut Self| -> Option<Vec<[f64; 3]>> {
            let at_end = time == it.time();
            if at_end {
                found.copy_from_slice(it.state());
            } else if !it.between(&mut run.plant, time, found) {
                return None;
            }
            let moves = run.plant.is_as_it_moves();
            let known = match moves {
                true if it.slopes(time, &mut rates) => run.plant.look(time, found),
                true if at_end => {
                    rates.copy_from_slice(it.rates());
                    run.plant.look(time, found)
                }
                _ => run.plant.accelerate(time, found, &mut rates),
            };
            known.then(|| run.plant.drives_at(time, found, &rates))
        };
        let mut quarters: [Vec<[f64; 3]>; 3] = Default::default();
        let mut telling = Vec::new();
        self.plant.telling_from(from, &self.y);
        for (quarter, part) in quarters.iter_mut().zip([0.25, 0.5, 0.75]) {
            match at(from + part * (to - from), self) {
                Some(states) => *quarter = states,
                None => return Added::NoWay,
            }
            telling.push(self.plant.telling_now(from + part * (to - from)));
        }
        let Some(end) = at(to, self) else {
            return Added::NoWay;
        };
        telling.push(self.plant.telling_now(to));
        if telling.iter().any(|it| *it != Telling::Well) && !last {
            return Added::Untold;
        }
        // No link tells how it goes on across.
        if telling.contains(&Telling::NotAcross) {
            return Added::NoWay;
        }
        let slow = |scale: &f64| scale / self.question.until;
        let slow: Vec<f64> = self.plant.told_scales().iter().map(slow).collect();
        let missed = self.record.missed(to, &quarters, &end, &slow);
        if !last && missed > MISSED.max(MISSED_TOLERANCES * self.question.tolerance) {
            return Added::Missed;
        }
        self.record.add(to, &quarters, &end, &values);
        self.time = to;
        self.y.copy_from_slice(found);
        self.plant.took();
        Added::Done
    }

    /// Puts a state whose loops close in the place of the one at hand, which is near it.
    fn close(&mut self) {
        if self.plant.ties.is_some() {
            self.plant.take(self.time, &self.y);
            self.plant.keep_closed(&mut self.y);
        }
    }

    /// Lets other links tell the place along the motion that is found, at the state at hand, where there are such that tell it through the
    /// step that was made.
    fn tells_all_step(&mut self) -> bool {
        let told = self.plant.look(self.time, &self.y) && self.tellers.retell(&mut self.plant);
        self.exchanged |= told;
        told
    }

    /// Why there is no step, where nothing was known of accelerations because of a lack.
    fn no_way(&mut self, reason: Stopped, lack: Option<Lack>) -> Ending {
        self.plant.take(self.time, &self.y);
        match (self.plant.places.end_at(&self.plant.coordinates), lack) {
            (_, Some(Lack::Value(sought))) => Ending::NoValue(sought),
            (Some(end), _) => Ending::Limit(end),
            (None, Some(lack)) if reason == Stopped::NoRates => Ending::NoWay(lack),
            _ => self.too_short(),
        }
    }

    /// Why nothing is known of what comes, where nothing was known of accelerations just now.
    fn no_way_at_once(&self) -> Ending {
        match self.plant.lack {
            Some(Lack::Value(sought)) => Ending::NoValue(sought),
            lack => Ending::NoWay(lack.unwrap_or(Lack::Pose)),
        }
    }

    /// Why no step is short enough: what grew most beyond what it was at the start, if anything did by far.
    fn too_short(&mut self) -> Ending {
        let mut rates = vec![0.0; self.y.len()];
        self.plant.accelerate(self.time, &self.y, &mut rates);
        let grown = self.plant.amounts.values.iter().zip(&self.at_start);
        let grown = grown.map(|(now, before)| (now / before).abs());
        let most = (grown.enumerate())
            .filter(|(_, grown)| RUNS_AWAY < *grown && grown.is_finite())
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match most
            .and_then(|(amount, _)| self.plant.sought.get(amount))
            .copied()
        {
            Some(sought) => Ending::RunsAway(sought),
            // The loops close no farther.
            None if self.plant.ties.is_some() && self.is_singular() => Ending::NoWay(Lack::Pose),
            None => Ending::TooShort,
        }
    }
}

/// Shared by threads, as everything that is computed.
const _: fn() = || {
    fn shared<T: Send + Sync>() {}
    shared::<Arc<Simulated>>();
};
