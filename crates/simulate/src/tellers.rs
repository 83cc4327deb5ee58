//! What tells the place of the mechanism: the coordinates that are let go, and, where one of them comes to its own dead point, the
//! angle of a link in its stead.
//!
//! A dead point is one of a coordinate, not of the mechanism: beyond it the coordinate goes back while the mechanism goes on. The
//! equations of motion do not care which coordinates tell the place. So well before a dead point the coordinate is exchanged for the
//! angle of the link that turns fastest by it, at the same pose and with the same speeds (E. J. Haug and R. A. Wehage, "Generalized
//! coordinate partitioning", ASME J. Mech. Des. 104, 1982, choose anew in the same way). Then that link turns as fast as any, and is
//! kept until it comes near a dead point of its own.

use std::sync::Arc;

use kempe_dynamics::Forces;
use kempe_mechanism::constraint::MOST_PILOTS;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{DriveId, FRAME, LinkId};
use kempe_motion::{Motion, Placed, Progress};

use crate::places::Places;
use crate::plant::{Plant, Tells};
use crate::start::Start;

/// A coordinate is exchanged where some link turns at least so many times as fast as it, in rad and mechanism sizes ...
const STEEP: f64 = 4.0;
/// ... and comes to a dead point of the coordinate within this angle of its own, rad, if it goes on as it does: near enough that few
/// simulations change what tells the place, and so far that no step needs be short for it.
pub(crate) const NEAR: f64 = 0.25;
/// A link that turns at least at this part of the fastest one's speed tells as well.
const AS_WELL: f64 = 0.5;

/// At least at so much of the fastest one's speed turns a link that is to tell the place from here to there.
const WELL_ENOUGH: f64 = 0.2;

/// What tells the place, by coordinate that is let go.
pub(crate) struct Tellers {
    /// The design as it was given, with the file's laws.
    design: Design<f64>,
    first: Arc<Motion>,
    free: Vec<DriveId>,
    driven: Vec<DriveId>,
    /// The sense in which the motor of each turns it.
    senses: Vec<f64>,
    /// The link whose angle tells in its stead; none where it tells itself.
    links: Vec<Option<LinkId>>,
    /// All links whose angles told, in the order in which they did first.
    used: Vec<LinkId>,
}

/// What became of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exchanged {
    /// It tells the place well.
    Not,
    /// A link's angle tells it from here on.
    Done,
    /// It does not, and nothing else could be found that does.
    Failed,
}

impl Tellers {
    /// The coordinates that are let go tell themselves. `first` is the motion that found the start.
    pub fn new(
        design: Design<f64>,
        first: Arc<Motion>,
        [free, driven]: [Vec<DriveId>; 2],
        senses: Vec<f64>,
    ) -> Self {
        Self {
            links: vec![None; free.len()],
            used: Vec::new(),
            design,
            first,
            free,
            driven,
            senses,
        }
    }

    /// The links whose angles told, in the order in which they are chosen from 1 on.
    pub fn used(&self) -> &[LinkId] {
        &self.used
    }

    /// The mechanism in which any of them may tell the place: see [`Mechanism::piloted`].
    pub fn piloted(&self) -> Arc<Mechanism> {
        let drives = self.free.iter().copied().zip(self.senses.iter().copied());
        let drives: Vec<(DriveId, f64)> = drives.collect();
        self.design.mechanism.piloted(&drives, &self.used)
    }

    /// Exchanges a coordinate that comes to its dead point `within` an angle of the link that turns fastest, rad: the plant is that of
    /// the same mechanism at the same pose then, and the state `y` that of its coordinates. Where the angle is finite, the plant was
    /// looked at in this state last.
    pub fn exchange(
        &mut self,
        plant: &mut Plant,
        (time, y): (f64, &mut [f64]),
        within: f64,
        progress: &mut dyn Progress,
    ) -> Exchanged {
        // Coordinates of a spanning tree have no dead points.
        if plant.ties.is_some()
            || plant.tied().is_some()
            || plant.mode.stuck
            || (within.is_finite() && poor(plant, within).is_none())
        {
            return Exchanged::Not;
        }
        // Where friction jams the coordinate there are no accelerations along it, but there is a pose.
        if !plant.look(time, y) {
            return Exchanged::Not;
        }
        let Some((place, turning)) = poor(plant, within) else {
            return Exchanged::Not;
        };
        let known = self.used.len();
        match self.instead(plant, place, &turning) {
            Some(link) => {
                let before = self.links[place].replace(link);
                match self.plant(plant, (time, y), place, progress) {
                    Some(new) => {
                        *plant = new;
                        Exchanged::Done
                    }
                    None => {
                        self.links[place] = before;
                        self.used.truncate(known);
                        Exchanged::Failed
                    }
                }
            }
            None => Exchanged::Failed,
        }
    }

    /// The link whose angle tells in the stead of a coordinate by which the bodies turn so: one that told before where it does as well
    /// as any. What tells for others stands still while this one goes.
    fn instead(&mut self, plant: &Plant, place: usize, turning: &[f64]) -> Option<LinkId> {
        let mechanism = &self.design.mechanism;
        let speed = |link: LinkId| turning[mechanism.body_of(link).index()].abs();
        let faster = |best: Option<LinkId>, link: LinkId| match best {
            Some(best) if speed(best) >= speed(link) => Some(best),
            _ => Some(link),
        };
        let links = (0..mechanism.model.links.len() as u32).map(LinkId);
        let any = links.filter(|link| *link != FRAME).fold(None, faster)?;
        let known = self.used.iter().copied().fold(None, faster);
        // What turns no faster than the coordinate goes would be no better.
        let better = |link: LinkId| speed(link) * plant.scales[place] > 1.0;
        match known.filter(|link| better(*link)) {
            Some(known) if speed(known) >= AS_WELL * speed(any) => Some(known),
            _ if self.used.len() < MOST_PILOTS && better(any) => {
                self.used.push(any);
                Some(any)
            }
            known => known,
        }
    }

    /// Lets a link tell the place in the stead of the drive that told it poorly last, along the motion that is found, at the instant that the
    /// plant looked at last: one that turns as well as any here and there. Whether there is one. The plant has coordinates of its own.
    pub fn retell(&mut self, plant: &mut Plant) -> bool {
        if plant.tied().is_some() {
            return false;
        }
        let Some((place, there)) = plant.ties.as_mut().and_then(|ties| ties.poor.take()) else {
            return false;
        };
        let Some(here) = plant.turnings().and_then(|all| all.into_iter().nth(place)) else {
            return false;
        };
        let fastest = |turns: &[f64]| turns.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let (most_here, most_there) = (fastest(&here), fastest(&there));
        let mechanism = &self.design.mechanism;
        let well = |link: LinkId| {
            let body = mechanism.body_of(link).index();
            (here[body].abs() / most_here).min(there[body].abs() / most_there)
        };
        let better = |best: Option<LinkId>, link: LinkId| match best {
            Some(best) if well(best) >= well(link) => Some(best),
            _ => Some(link),
        };
        let links = (0..mechanism.model.links.len() as u32).map(LinkId);
        let any = links.filter(|link| *link != FRAME).fold(None, better);
        let known = self.used.iter().copied().fold(None, better);
        let as_well =
            known.filter(|known| any.is_none_or(|any| well(*known) >= AS_WELL * well(any)));
        let chosen = match (as_well, any) {
            (Some(known), _) => known,
            (None, Some(any)) if self.used.len() < MOST_PILOTS => any,
            _ => return false,
        };
        let body = mechanism.body_of(chosen);
        let tells = plant
            .ties
            .as_mut()
            .and_then(|ties| ties.pilots.get_mut(place));
        if !(well(chosen) >= WELL_ENOUGH) || tells.as_deref() == Some(&Some(body)) {
            return false;
        }
        let index = self.used.iter().position(|used| *used == chosen);
        let index = index.unwrap_or_else(|| {
            self.used.push(chosen);
            self.used.len() - 1
        });
        if let Some(tells) = tells {
            *tells = Some(body);
        }
        if let Some(ties) = &mut plant.ties {
            ties.turned = None;
        }
        plant.tells[place].choice = 1.0 + index as f64;
        true
    }

    /// The plant at a state that it shares with another, where the angle of the link now named tells in the stead of one coordinate.
    fn plant(
        &self,
        old: &mut Plant,
        (time, y): (f64, &mut [f64]),
        place: usize,
        progress: &mut dyn Progress,
    ) -> Option<Plant> {
        let n = self.free.len();
        let known = old.drives_at(time, y, &vec![0.0; y.len()]);
        let instant = old.instant();
        let placed = Placed {
            poses: instant.poses.clone(),
            near: instant.angles().collect(),
        };
        let own = self.design.mechanism.model.drives.len();
        let mut instead: Vec<(DriveId, LinkId, f64)> = Vec::new();
        let mut free = self.free.clone();
        let mut tells = vec![Tells::default(); n];
        let mut scales = old.scales.clone();
        let geometry = &self.design.geometry;
        let seat =
            |link: LinkId| geometry.seat_angles[link.index()] - geometry.seat_angles[FRAME.index()];
        let mut coordinates: Vec<f64> = known.iter().take(own).map(|q| q[0]).collect();
        let mut state = y.to_vec();
        for (k, link) in self.links.iter().enumerate() {
            let Some(link) = *link else { continue };
            free[k] = DriveId((own + instead.len()) as u32);
            instead.push((self.free[k], link, self.senses[k]));
            tells[k] = Tells {
                choice: 1.0 + self.used.iter().position(|used| *used == link)? as f64,
                ahead: seat(link),
            };
            if k == place {
                let body = self.design.mechanism.body_of(link);
                state[k] = instant.angle(body) + seat(link);
                state[n + k] = instant.velocities[body.index()][2];
                scales[k] = 1.0;
            }
            coordinates.push(state[k]);
        }
        let mechanism = self.design.mechanism.turned_by(&instead);
        let mut design = Design::new(&mechanism, &self.design.parameters);
        design.count_turns(&self.design.geometry.turns);
        let moving: Vec<DriveId> = free.iter().chain(&self.driven).copied().collect();
        let start = Start {
            design: design.clone(),
            placed,
            coordinates,
            first: self.first.clone(),
        };
        let places = Places::new(start, &moving, progress).ok()?;
        let mut forces = Forces::new(design.clone()).ok()?;
        // Springs about pins go on counting turns.
        forces.acting.springs.clone_from(&old.forces.acting.springs);
        let followed = instead
            .iter()
            .map(|(drive, ..)| (*drive, known[drive.index()][0]));
        let mut new = Plant::new(
            &design,
            forces,
            places,
            [free, self.driven.clone()],
            scales,
            old.stops.clone(),
        )
        .telling(tells, followed.collect(), own);
        new.mode = old.mode.clone();
        new.rubbing = old.rubbing.clone();
        new.inner = old.inner.clone();
        new.take_senses();
        new.end = old.end;
        new.back = old.back;
        let mut rates = vec![0.0; y.len()];
        if !new.accelerate(time, &state, &mut rates) {
            return None;
        }
        y.copy_from_slice(&state);
        Some(new)
    }
}

/// The coordinate, if any, that comes to a dead point of its own `within` an angle, rad: its place, and by how much every body turns by
/// it, in rad per rad or per m. Of several the one that is nearest.
fn poor(plant: &mut Plant, within: f64) -> Option<(usize, Vec<f64>)> {
    plant.bend();
    let instant = plant.instant();
    let mut worst: Option<(usize, f64)> = None;
    for (place, (drive, scale)) in plant.free.iter().zip(&plant.scales).enumerate() {
        let first = &instant.coefficients[drive.index()];
        let second = &instant.coefficient_rates[drive.index()];
        let fastest = first.iter().map(|k| k[2].abs()).fold(0.0, f64::max);
        if !(fastest * scale >= STEEP) {
            continue;
        }
        // Towards a dead point the rate of every link grows as one over its own way to there.
        let quick = first
            .iter()
            .zip(second)
            .filter(|(k, _)| k[2].abs() >= AS_WELL * fastest);
        let way = quick
            .map(|(k, bent)| k[2] * k[2] / bent[2].abs())
            .fold(f64::INFINITY, f64::min);
        if way <= within && worst.is_none_or(|(_, least)| way < least) {
            worst = Some((place, way));
        }
    }
    worst.map(|(place, _)| {
        let first = &instant.coefficients[plant.free[place].index()];
        (place, first.iter().map(|k| k[2]).collect())
    })
}
