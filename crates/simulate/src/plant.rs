//! How what is let go accelerates, at any state.

use kempe_dynamics::amount::Amount;
use kempe_dynamics::wrench::Wrench;
use kempe_dynamics::{Forces, Instant, LetGo, Rates};
use kempe_integrate::System;
use kempe_linear::Lu;
use kempe_measure::State;
use kempe_measure::measure::{Along, History, measure};
use kempe_mechanism::Design;
use kempe_model::{DriveId, DriveKind, Law, Leaf, Measure, PlacedLaw, StandIn};
use kempe_number::{Jet, Number};

use crate::amounts::{Amounts, Known};
use crate::barrier::{Barrier, Gap, along};
use crate::inner::Inner;
use crate::lack::{Lack, Sought};
use crate::places::Places;
use crate::site::{Rub, Rubbing};
use crate::ties::{About, Ties};
use crate::unsimulated::Unsimulated;

/// Speeds on both sides of a break that differ by this part are the same.
const SMOOTH: f64 = 1e-9;
/// Corrections of what holds a rest where friction acts, at most.
const CORRECTIONS: usize = 100;
/// What holds a rest is settled when the gap's acceleration is this part of what it would be.
const SETTLED: f64 = 1e-13;

/// A drive whose speed jumps, and its speeds before and behind, SI.
pub(crate) type Jump = (DriveId, [f64; 2]);

/// What holds the mechanism besides its drives.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mode {
    /// Rigid stops on which it rests.
    pub resting: Vec<usize>,
    /// Rigid stops that are closed and stay so by what holds it on those: they say the same.
    pub beside: Vec<usize>,
    /// Soft stops that are touched.
    pub touched: Vec<usize>,
    /// Friction holds all of it.
    pub stuck: bool,
    /// How every place that rubs is looked at.
    pub rubs: Vec<Rub>,
}

/// How one coordinate of the state tells the place.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tells {
    /// 0 for the coordinate of the drive that is let go, from 1 on for links: see [`Mechanism::piloted`](kempe_mechanism::Mechanism).
    pub choice: f64,
    /// By how much the angle of a link is ahead of its body's, rad.
    pub ahead: f64,
}

/// Why no link's angle may tell the place in the stead of a coordinate that is let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tied {
    /// Joints with play are told by how far they stand open.
    Play,
    /// What oil gives goes by its own drive.
    Oil,
    /// So does what a throttled motor gives.
    Throttle,
    /// Something that acts, stops, switches or ends it asks for a derivative along the drive.
    Asked,
}

/// A motor of a drive that is let go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    /// Its place among the motors that act.
    pub motor: usize,
    /// The sense in which it turns.
    pub sense: f64,
    /// The place of its throttle among the plant's amounts.
    pub throttle: Option<usize>,
}

/// A mechanism with what is let go.
pub(crate) struct Plant {
    pub places: Places,
    pub forces: Forces<f64>,
    /// Drives that are let go.
    pub free: Vec<DriveId>,
    /// Drives that keep laws by which they move.
    pub driven: Vec<DriveId>,
    /// Which of these are lengths of cylinders.
    pub cylinders: Vec<usize>,
    /// Sizes of the coordinates that are let go: 1 rad, or the mechanism's.
    pub scales: Vec<f64>,
    pub stops: Vec<Barrier>,
    pub mode: Mode,
    /// Where the stretch at hand ends, s: laws are looked at before.
    pub end: f64,
    /// How fast a stop closes again on which it rests and that errors open, 1/s.
    pub back: f64,
    /// Whether something goes by derivatives along drives that are let go.
    pub asked_along: bool,
    /// Why no accelerations were known where they were asked for last, if they were not.
    pub lack: Option<Lack>,
    /// What the amounts are of.
    pub sought: Vec<Sought>,
    /// Whether anything does work but weights and springs.
    pub works: bool,
    /// Coordinates of all drives in time, as last taken.
    pub coordinates: Vec<Rates>,
    /// Forces along the coordinates that are let go.
    pub given: Vec<f64>,
    /// What the stops on which it rests push.
    pub pushes: Vec<f64>,
    /// Stops that push on bodies when it is next found what acts, with what, and the gradients of their gaps.
    bearing: Vec<(usize, f64, Vec<f64>)>,
    /// Power of what soft stops push on bodies, W.
    pub(crate) pressing: f64,
    pub let_go: LetGo,
    pub(crate) instant: Instant<f64>,
    /// Drives that keep their laws, with where the pieces of these lie.
    kept: Vec<(DriveId, PlacedLaw)>,
    /// Drives that keep laws by which they move, with the times at which these end, s.
    law_ends: Vec<(DriveId, f64)>,
    /// How the coordinates that are let go tell the place.
    pub tells: Vec<Tells>,
    /// Drives in whose stead links tell, with their coordinates, as last known.
    followed: Vec<(DriveId, f64)>,
    /// How many drives the model has of its own.
    own: usize,
    /// What loads vary with, then openings of valves and throttles of motors.
    pub amounts: Amounts,
    /// Pressures and switches.
    pub inner: Inner,
    /// Motors of the drives that are let go.
    pub motors: Vec<Option<Turned>>,
    /// What rubs.
    pub rubbing: Rubbing,
    /// What keeps loops closed, where the coordinates are those of a spanning tree.
    pub ties: Option<Box<Ties>>,
    /// Where the coordinates of a spanning tree start.
    pub begins: Vec<f64>,
    /// Whether the state last taken is one of the mechanism: loops may not close near it.
    closes: bool,
    storage: Vec<Wrench<f64>>,
}

impl Plant {
    pub fn new(
        design: &Design<f64>,
        forces: Forces<f64>,
        places: Places,
        moving: [Vec<DriveId>; 2],
        scales: Vec<f64>,
        stops: Vec<Barrier>,
    ) -> Self {
        let own = moving[0].clone();
        Self::letting_go(&own, design, forces, places, moving, (scales, stops))
    }

    /// The same where other coordinates than those of the drives that are let go, `own`, may tell the place.
    pub fn letting_go(
        own: &[DriveId],
        design: &Design<f64>,
        forces: Forces<f64>,
        places: Places,
        [free, driven]: [Vec<DriveId>; 2],
        (scales, stops): (Vec<f64>, Vec<Barrier>),
    ) -> Self {
        let model = &design.mechanism.model;
        let parameters = &design.parameters;
        let acting = &forces.acting;
        let of_loads = acting.amounts.len();
        let mut amounts = acting.amounts.clone();
        let mut sought = vec![Sought::Load(0); of_loads];
        for (index, load) in acting.loads.iter().enumerate() {
            sought[load.amounts()].fill(Sought::Load(index));
        }
        let mut place = |amount: Option<&Amount<f64>>, of: Sought| {
            amounts.push(amount?.clone());
            sought.push(of);
            Some(amounts.len() - 1)
        };
        let motors: Vec<Option<Turned>> = (own.iter())
            .map(|drive| {
                let motor = acting.motors.iter().position(|m| m.drive == *drive)?;
                let law = &model.drives.get(drive.index())?.law;
                Some(Turned {
                    motor,
                    sense: motor_sense(law, parameters),
                    throttle: place(
                        acting.motors[motor].throttle.as_ref(),
                        Sought::Throttle(*drive),
                    ),
                })
            })
            .collect();
        let inner = Inner::new(model, &acting.oils, own, |oil| {
            let of = Sought::Valve(oil.drive);
            [
                place(Some(&oil.valve.0), of),
                place(oil.valve.1.as_ref(), of),
            ]
        });
        let amounts = Amounts::new(&design.mechanism, parameters, amounts);
        let works = !acting.loads.is_empty()
            || !acting.dampers.is_empty()
            || !acting.friction.is_empty()
            || !acting.turning.is_empty()
            || !acting.contacts.is_empty()
            || motors.iter().any(Option::is_some)
            || !inner.moved.is_empty()
            || !driven.is_empty()
            || !stops.is_empty();
        Self {
            instant: Instant::new(&design.mechanism, of_loads),
            coordinates: vec![Rates::zero(); model.drives.len()],
            given: vec![0.0; free.len()],
            pushes: Vec::new(),
            bearing: Vec::new(),
            pressing: 0.0,
            let_go: LetGo::default(),
            kept: (0..model.drives.len() as u32)
                .map(DriveId)
                .filter(|drive| !free.contains(drive))
                .map(|drive| (drive, model.drives[drive.index()].law.placed(parameters)))
                .collect(),
            law_ends: (driven.iter())
                .map(|drive| (*drive, model.drives[drive.index()].law.duration(parameters)))
                .collect(),
            tells: vec![Tells::default(); free.len()],
            followed: Vec::new(),
            own: model.drives.len(),
            cylinders: (own.iter().enumerate())
                .filter(|(_, drive)| {
                    let kind = model.drives.get(drive.index()).map(|drive| &drive.kind);
                    let kind = match kind {
                        Some(DriveKind::StandIn(StandIn::Follows { of, .. })) => Some(&**of),
                        kind => kind,
                    };
                    matches!(kind, Some(DriveKind::Cylinder { .. }))
                })
                .map(|(k, _)| k)
                .collect(),
            storage: vec![[0.0; 3]; model.links.len()],
            mode: Mode::default(),
            end: f64::INFINITY,
            back: 0.0,
            asked_along: false,
            rubbing: Rubbing::default(),
            ties: None,
            begins: Vec::new(),
            closes: true,
            lack: None,
            sought,
            motors,
            amounts,
            inner,
            places,
            forces,
            free,
            driven,
            scales,
            stops,
            works,
        }
    }

    /// The same where links tell the place in the stead of the drives `followed`, whose coordinates are known; of its drives the first
    /// `own` are the model's.
    pub fn telling(mut self, tells: Vec<Tells>, followed: Vec<(DriveId, f64)>, own: usize) -> Self {
        (self.tells, self.followed, self.own) = (tells, followed, own);
        let follows = |drive: &DriveId| self.followed.iter().any(|(it, _)| it == drive);
        self.kept.retain(|(drive, _)| !follows(drive));
        self
    }

    /// What makes the coordinates that are let go tell the place themselves, if something does.
    pub fn tied(&self) -> Option<Tied> {
        let throttled = |turned: &Turned| turned.throttle.is_some();
        let actions = &self.forces.design.mechanism.model.actions;
        let ties = [
            (!actions.contacts.is_empty(), Tied::Play),
            (!self.inner.moved.is_empty(), Tied::Oil),
            (self.motors.iter().flatten().any(throttled), Tied::Throttle),
            (self.asked_along, Tied::Asked),
        ];
        ties.into_iter().find(|(is, _)| *is).map(|(_, tied)| tied)
    }

    /// Looks at the pose of a state and how it moves, whatever acts: false where there is none.
    pub fn look(&mut self, time: f64, y: &[f64]) -> bool {
        self.take(time, y);
        self.instant.time = time;
        if self.ties.is_some() {
            return self.look_tied(time);
        }
        (self.places).instant(time, &self.coordinates, &mut self.instant)
    }

    /// Finds how the coefficients of what is let go change along their own coordinates, in the state last looked at.
    pub fn bend(&mut self) {
        if self.ties.is_some() {
            return;
        }
        self.places
            .bend(&self.free, &self.coordinates, &mut self.instant);
    }

    /// Whether one coordinate moves, and nothing else: on a stop it stands still.
    pub fn is_alone(&self) -> bool {
        self.free.len() == 1 && self.driven.is_empty()
    }

    /// Whether nothing holds it, and nothing rubs that is looked at by itself: how it accelerates in a state does not hang on what was
    /// looked at before.
    pub fn is_as_it_moves(&self) -> bool {
        !self.mode.stuck && self.mode.resting.is_empty() && self.mode.rubs.is_empty()
    }

    /// The instant last looked at.
    pub fn instant(&self) -> &Instant<f64> {
        &self.instant
    }

    /// Takes the coordinates of a state; those let go do not accelerate.
    pub fn take(&mut self, time: f64, y: &[f64]) {
        let n = self.free.len();
        let time = if time < self.end {
            time
        } else {
            self.end.next_down()
        };
        let drives = &self.forces.design.mechanism.model.drives;
        for (kept, placed) in &self.kept {
            let law = &drives[kept.index()].law;
            self.coordinates[kept.index()] = law.at_placed(Jet::variable(time), placed);
        }
        // Where its law ends a drive stands from then on.
        for (drive, end) in &self.law_ends {
            if time >= *end {
                let q = &mut self.coordinates[drive.index()];
                *q = Rates::constant(q.value());
            }
        }
        for (drive, q) in &self.followed {
            self.coordinates[drive.index()] = Rates::constant(*q);
        }
        for (k, drive) in self.free.iter().enumerate() {
            let v = if self.mode.stuck { 0.0 } else { y[n + k] };
            self.coordinates[drive.index()] = Rates::from_coefficients([y[k], v, 0.0]);
        }
        self.inner.take(&y[2 * n..]);
        if let (Some(ties), Some(several)) = (&mut self.ties, self.places.several()) {
            let about = About {
                free: &self.free,
                driven: &self.driven,
                scales: &self.scales,
            };
            let (coordinates, instant) = (&mut self.coordinates, &mut self.instant);
            self.closes = ties.close((time, y), &about, several, coordinates, instant);
        }
    }

    /// Takes the coordinates of a state with the speeds that it has, whatever friction is looked at.
    pub fn take_as_it_is(&mut self, time: f64, y: &[f64]) {
        self.take(time, y);
        if self.ties.is_some() {
            return;
        }
        let speeds = y.iter().skip(self.free.len());
        for (drive, (q, v)) in self.free.iter().zip(y.iter().zip(speeds)) {
            self.coordinates[drive.index()] = Rates::from_coefficients([*q, *v, 0.0]);
        }
    }

    /// Rates of a state: speeds, accelerations, and the power of all that does work. False where they are not known, for what is lacking.
    pub fn accelerate(&mut self, time: f64, y: &[f64], rates: &mut [f64]) -> bool {
        let found = self.rates_of(time, y, rates);
        self.lack = found.err();
        found.is_ok()
    }

    /// Why nothing may begin, where no accelerations were known just now.
    pub fn lacks(&self) -> Unsimulated {
        match self.lack {
            Some(Lack::Value(sought)) => Unsimulated::NoValue(sought),
            lack => Unsimulated::Lacks(lack.unwrap_or(Lack::Pose)),
        }
    }

    fn rates_of(&mut self, time: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Lack> {
        let n = self.free.len();
        rates[..n].copy_from_slice(&y[n..2 * n]);
        // It stands still, and not only but for rounding.
        let rests = self.is_alone() && !self.mode.resting.is_empty();
        if self.mode.stuck || rests {
            rates.fill(0.0);
            self.take(time, y);
            if self.inner.moved.is_empty() {
                return Ok(());
            }
            self.amounts_at(time)?;
            return self.pressure_rates(&mut rates[2 * n..]);
        }
        self.held(time, y)?;
        rates[n..2 * n].copy_from_slice(&self.let_go.accelerations);
        self.pressure_rates(&mut rates[2 * n..])?;
        if self.ties.is_some() {
            rates[..n].copy_from_slice(&self.speeds());
        }
        rates[2 * n + self.inner.pressures()] = match (self.works, &self.ties) {
            (true, None) => self.power(&y[n..2 * n]),
            // What goes with drives that keep laws, those do.
            (true, Some(ties)) => {
                let own = ties.beside_driven(&self.speeds(), &self.driven_speeds());
                self.power(&own)
            }
            (false, _) => 0.0,
        };
        match rates.iter().all(|r| r.is_finite()) {
            true => Ok(()),
            false => Err(Lack::Force),
        }
    }

    /// Accelerations and pushes where the stops hold on which it rests.
    pub(crate) fn held(&mut self, time: f64, y: &[f64]) -> Result<(), Lack> {
        if self.has_rigid_friction() {
            // What pushes here is not known yet, nor what rubs by it.
            self.pushes.clear();
            self.take_senses();
        }
        if self.holds_somewhere() {
            return self.hold_still(time, y);
        }
        self.let_go_at(time, y, &[])?;
        match self.mode.resting.is_empty() {
            true => Ok(()),
            false => self.hold(time, y),
        }
    }

    /// What a stop pushes on which it rests, by its place among those: nothing where that is not known.
    pub fn pushed(&mut self, place: usize, time: f64, y: &[f64]) -> Option<f64> {
        let known = self.held(time, y).is_ok();
        self.pushes.get(place).copied().filter(|_| known)
    }

    /// Accelerations where stops besides push along the coordinates.
    pub(crate) fn let_go_at(&mut self, time: f64, y: &[f64], pushes: &[f64]) -> Result<(), Lack> {
        self.act(time, y, pushes)?;
        let (forces, instant) = (&mut self.forces, &mut self.instant);
        let found = match &self.ties {
            None => forces.let_go(instant, &self.free, &self.given, &mut self.let_go),
            Some(ties) => {
                let directions = ties.directions(&self.scales);
                let ways = (ties.asked.as_slice(), directions.as_slice());
                forces.let_go_tied(instant, &self.free, &self.given, ways, &mut self.let_go)
            }
        };
        found.map_err(Lack::of)
    }

    /// Finds what acts along the coordinates at a state, where stops besides push.
    pub(crate) fn act(&mut self, time: f64, y: &[f64], pushes: &[f64]) -> Result<(), Lack> {
        let posed = self.look(time, y);
        let law = |drive: &&DriveId| !self.coordinates[drive.index()].value().is_finite();
        if let Some(drive) = self.driven.iter().find(law) {
            return Err(Lack::Value(Sought::Law(*drive)));
        }
        if !posed {
            return Err(Lack::Pose);
        }
        self.amounts_at(time)?;
        if self.ties.is_some() {
            self.give_tied(pushes);
        }
        let own = match self.ties {
            None => self.motors.as_slice(),
            Some(_) => &[],
        };
        for (given, (k, motor)) in self.given.iter_mut().zip(own.iter().enumerate()) {
            let push = pushes.get(k).copied().unwrap_or(0.0);
            let speed = self.coordinates[self.free[k].index()].coefficient(1);
            let turns = |turned: &Turned| {
                let (motor, sense) = (&self.forces.acting.motors[turned.motor], turned.sense);
                let throttle = turned
                    .throttle
                    .map_or(1.0, |place| self.amounts.values[place]);
                sense * motor.gives(throttle, sense * speed)
            };
            *given = push + motor.as_ref().map_or(0.0, turns);
        }
        self.push_by_oil();
        self.instant.pressed.clear();
        self.pressing = 0.0;
        let bearing = std::mem::take(&mut self.bearing);
        match (self.mode.touched.is_empty() || self.push(time, y))
            && (bearing.into_iter()).all(|it| self.press(it, time))
        {
            true => Ok(()),
            false => Err(Lack::Pose),
        }
    }

    /// Changes the speeds of what is let go as jumps in the speeds of drives that keep their laws do, from before a time to behind
    /// it, where the next stretch ends at `end`: by impulses of those drives alone. The work that they do, J, and
    /// the speeds before and behind of drives whose speeds jump; none where none does.
    pub fn jerk(&mut self, time: f64, end: f64, y: &mut [f64]) -> Option<(f64, Vec<Jump>)> {
        let n = self.free.len();
        let mut rates = vec![0.0; y.len()];
        let mut state = |it: &mut Self, y: &[f64]| -> Option<(Vec<f64>, f64)> {
            it.accelerate(time, y, &mut rates).then(|| {
                (
                    it.driven_speeds(),
                    kempe_dynamics::energy::kinetic(&it.forces.acting, &it.instant),
                )
            })
        };
        // Laws are looked at before where a stretch ends, and behind where the next begins.
        let (before, kinetic) = state(self, y)?;
        self.end = end;
        let (behind, _) = state(self, y)?;
        let jumps: Vec<f64> = behind.iter().zip(&before).map(|(b, a)| b - a).collect();
        let both = before.iter().copied().zip(behind.iter().copied());
        let told = self.driven.iter().zip(both);
        let told =
            told.filter(|(_, (before, behind))| (behind - before).abs() > SMOOTH * before.abs());
        let told: Vec<Jump> = told.map(|(drive, (a, b))| (*drive, [a, b])).collect();
        if told.is_empty() {
            return Some((0.0, told));
        }
        // Speeds that close again at once, before masses change them by what the loops carry.
        self.keep_closed(y);
        let mut impulses = (self.forces).carried(&self.instant, &self.free, &self.driven, &jumps);
        self.let_go.respond(&mut impulses);
        for (v, change) in y[n..2 * n].iter_mut().zip(&impulses) {
            *v -= change;
        }
        let (_, after) = state(self, y)?;
        Some((after - kinetic, told))
    }

    /// Finds what loads, valves and motors go by, at the state last taken.
    fn amounts_at(&mut self, time: f64) -> Result<(), Lack> {
        let state = match self.amounts.ask_pose() {
            true => Some(self.state(time).ok_or(Lack::Pose)?),
            false => None,
        };
        let design = &self.forces.design;
        let known = Known {
            time,
            parameters: &design.parameters,
            coordinates: &|drive| self.coordinates[drive].coefficient(0),
            inner: &self.inner.values,
        };
        (self.amounts).find(&design.mechanism.model, &known, state.as_ref());
        let of_loads = self.instant.amounts.len();
        (self.instant.amounts).copy_from_slice(&self.amounts.values[..of_loads]);
        let lost = self.amounts.values.iter().position(|x| !x.is_finite());
        match lost.and_then(|amount| self.sought.get(amount)) {
            Some(sought) => Err(Lack::Value(*sought)),
            None => Ok(()),
        }
    }

    /// The state last taken, for measures; rates of inner states are not known in it.
    pub fn state(&mut self, time: f64) -> Option<State<f64>> {
        if !self.closes {
            return None;
        }
        let mut state = self.places.state(time, &self.coordinates)?;
        state.inner = self.inner.series();
        Some(state)
    }

    /// Lets the stops on which it rests push so that none of their gaps accelerates.
    fn hold(&mut self, time: f64, y: &[f64]) -> Result<(), Lack> {
        let stops = self.mode.resting.clone();
        let gaps: Option<Vec<Gap>> = stops.iter().map(|s| self.gap(*s, time, y)).collect();
        let gaps = gaps.ok_or(Lack::Pose)?;
        let rubs = self.rubs_rigidly();
        let matrix = match rubs {
            false => self.yielding(&gaps),
            true => self.yielding_with_friction(&gaps)?,
        };
        let mut factors = Lu::new(gaps.len());
        if !factors.factor(|row, column| matrix[row][column]) {
            return Err(Lack::Rest);
        }
        // What errors open comes back slowly, unless nothing can.
        let back = if self.is_alone() { 0.0 } else { self.back };
        let opening = |it: &Self| -> Vec<f64> {
            let of = |gap: &Gap| {
                gap.opening(&it.let_go.accelerations) + back * (2.0 * gap.rate + back * gap.open)
            };
            gaps.iter().map(of).collect()
        };
        self.pushes = vec![0.0; gaps.len()];
        let scale: f64 = opening(self).iter().map(|x| x.abs()).fold(0.0, f64::max);
        for _ in 0..CORRECTIONS {
            let mut more: Vec<f64> = opening(self).iter().map(|x| -x).collect();
            if more.iter().all(|x| x.abs() <= SETTLED * scale) {
                break;
            }
            factors.solve(&mut more);
            for (push, more) in self.pushes.iter_mut().zip(more) {
                *push += more;
            }
            if rubs {
                self.take_senses();
            }
            let mut pushes = self.pushes.clone();
            for ((push, stop), gap) in pushes.iter_mut().zip(&stops).zip(&gaps) {
                if self.carry(*stop) {
                    let push = std::mem::take(push);
                    self.bearing.push((*stop, push, gap.gradient.clone()));
                }
            }
            let along = along(&gaps, &pushes, self.free.len());
            self.let_go_at(time, y, &along)?;
        }
        Ok(())
    }

    /// How fast the drives go that keep their laws, at the state last taken.
    pub(crate) fn driven_speeds(&self) -> Vec<f64> {
        let speed = |drive: &DriveId| self.coordinates[drive.index()].coefficient(1);
        self.driven.iter().map(speed).collect()
    }

    /// Whether a drive is one of the model's own.
    pub fn is_own(&self, drive: DriveId) -> bool {
        drive.index() < self.own
    }

    /// Power of all that does work but weights and springs, W.
    fn power(&mut self, speeds: &[f64]) -> f64 {
        let along = self.given.iter().zip(speeds).map(|(q, v)| q * v);
        let mut power: f64 = along.sum();
        for drive in &self.driven {
            let speed = self.coordinates[drive.index()].coefficient(1);
            let given = (self.forces).given_by(&self.instant, *drive, &self.free, &self.let_go);
            power += given * speed;
        }
        let (forces, storage) = (&self.forces, &mut self.storage);
        power + self.pressing + forces.power_from_outside(&self.instant, storage)
    }

    /// Coordinate, speed and acceleration at a state with these rates: of every drive of the model, and behind them of the coordinates
    /// that tell the place.
    pub fn drives_at(&mut self, time: f64, y: &[f64], rates: &[f64]) -> Vec<[f64; 3]> {
        let n = self.free.len();
        if self.ties.is_some() {
            return self.drives_tied(time, y, rates);
        }
        self.take(time, y);
        let mut all: Vec<[f64; 3]> = (self.coordinates.iter())
            .map(|q| [0, 1, 2].map(|k| q.derivative(k)))
            .collect();
        for (k, drive) in self.free.iter().enumerate() {
            all[drive.index()] = [y[k], y[n + k], rates[n + k]];
        }
        if !self.followed.is_empty() {
            self.follow(time, &mut all);
        }
        all.truncate(self.own);
        let tells = self.tells.iter().enumerate();
        all.extend(tells.map(|(k, it)| [y[k] - it.ahead, y[n + k], rates[n + k]]));
        all
    }

    /// How many drives the model has of its own.
    pub(crate) fn own_drives(&self) -> usize {
        self.own
    }

    /// Whether the loops close in the state last taken.
    pub(crate) fn is_closed(&self) -> bool {
        self.closes
    }

    /// Takes the coordinates of drives that are let go for those near which they are from here on, where they follow.
    pub(crate) fn remember(&mut self, states: &[[f64; 3]]) {
        let Some(ties) = &self.ties else { return };
        for (drive, known) in &mut self.followed {
            let own = ties.drives.iter().position(|own| own == drive);
            let now = own.and_then(|k| states.get(k)).map(|state| state[0]);
            *known = now.filter(|q| q.is_finite()).unwrap_or(*known);
        }
    }

    /// Finds the coordinates of the drives that follow the others in `all`, which are as they move at a time.
    fn follow(&mut self, time: f64, all: &mut [[f64; 3]]) {
        for drive in &self.free {
            let [q, v, a] = all[drive.index()];
            self.coordinates[drive.index()] = Rates::from_coefficients([q, v, 0.5 * a]);
        }
        let state = self.places.state(time, &self.coordinates);
        let history = History::default();
        for (drive, known) in &mut self.followed {
            let found = state.as_ref().map(|state| {
                let coordinate = Measure::Leaf(Leaf::Drive(*drive));
                measure(state, &history, None, &coordinate, Along::Time)
            });
            all[drive.index()] = match found {
                Some(q) => [0, 1, 2].map(|k| q.derivative(k)),
                None => [f64::NAN; 3],
            };
            if all[drive.index()][0].is_finite() {
                *known = all[drive.index()][0];
            }
        }
    }
}

impl System for Plant {
    fn rates(&mut self, time: f64, y: &[f64], rates: &mut [f64]) -> bool {
        self.accelerate(time, y, rates)
    }
}

/// The sense in which a motor turns its drive: the way that its law goes.
pub(crate) fn motor_sense(law: &Law, parameters: &[f64]) -> f64 {
    if law.way(parameters) < 0.0 { -1.0 } else { 1.0 }
}
