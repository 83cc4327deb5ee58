//! The plant of a mechanism in coordinates of a spanning tree, and where it starts.

use kempe_dynamics::Forces;
use kempe_linear::Span;
use kempe_mechanism::constraint::{Constraint, Source};
use kempe_mechanism::structure::BodyId;
use kempe_mechanism::{Design, Input, NotCut, Situation};
use kempe_model::{DriveId, DriveKind, FRAME, LinkId};
use kempe_units::Dimension;

use crate::barrier::Barrier;
use crate::lack::Lack;
use crate::places::Places;
use crate::plant::{Plant, Tells};
use crate::start::Start;
use crate::ties::{self, Ties};
use crate::unsimulated::{NoTree, Unsimulated};
use crate::vector::dot;

/// A speed that is to be had and that is missed by this part of it cannot be had.
const MISSED: f64 = 1e-6;

/// The drives that are let go: the sense in which the motor of each turns it, and the size of its coordinate.
pub(crate) struct LetGoDrives {
    pub free: Vec<DriveId>,
    pub senses: Vec<f64>,
    pub scales: Vec<f64>,
}

/// The plant of a design from a start, where drives keep their laws or are let go.
///
/// # Errors
/// Why there is none.
pub(crate) fn in_tree(
    design: &Design<f64>,
    (from, closed): (Start, Forces<f64>),
    own: LetGoDrives,
    driven: Vec<DriveId>,
    stops: Vec<Barrier>,
) -> Result<Plant, Unsimulated> {
    let refuse = |why| Err(Unsimulated::NoTree(why));
    let acting = &closed.acting;
    if !acting.contacts.is_empty() {
        return refuse(NoTree::Play);
    }
    let seals = acting.oils.iter();
    let mut seals = seals.filter(|oil| own.free.contains(&oil.drive));
    if !acting.friction.is_empty() || seals.any(|oil| oil.friction != 0.0) {
        return refuse(NoTree::Friction);
    }
    let free = own.free.iter().copied().zip(own.senses.iter().copied());
    let free: Vec<(DriveId, f64)> = free.collect();
    let mechanism = &design.mechanism;
    let cut = match mechanism.cut_open(&free) {
        Ok(cut) => cut,
        Err(why) => return refuse(NoTree::Cut(why)),
    };
    let mut open = Design::new(&cut.mechanism, &design.parameters);
    open.count_turns(&design.geometry.turns);
    let mut forces = Forces::new(open.clone()).map_err(Unsimulated::Problems)?;
    // Springs about pins count turns as they did.
    forces.acting.springs.clone_from(&acting.springs);
    let coordinates = coordinates_at(&open, &from);
    let follows = |drive: &DriveId| cut.follow.contains(drive);
    let tree = own.free.iter().filter(|drive| !follows(drive));
    let tree: Vec<DriveId> = tree.chain(&cut.coordinates).copied().collect();
    let angle =
        |body: BodyId| from.placed.poses[body.index()].angle_near(from.placed.near[body.index()]);
    let known = own.free.iter().map(|drive| {
        if let Some(place) = tree.iter().position(|it| it == drive) {
            return Some(ties::Own::Coordinate(place));
        }
        let mut constraints = mechanism.constraints.iter();
        let (constraint, _) = constraints.find(|(_, from)| *from == Source::Drive(*drive))?;
        match constraint {
            Constraint::Distance(it) => Some(ties::Own::Length([it.a, it.b])),
            Constraint::Direction(it) => {
                let more = coordinates[drive.index()] - (angle(it.a) - angle(it.b));
                Some(ties::Own::Angle([it.a, it.b], more))
            }
            _ => None,
        }
    });
    let known: Vec<Option<ties::Own>> = known.collect();
    if let Some(place) = known.iter().position(Option::is_none) {
        return refuse(NoTree::Cut(NotCut::Closes(own.free[place])));
    }
    let ties = Ties::new(
        cut.ties,
        (own.free.clone(), known.into_iter().flatten().collect()),
        own.scales,
        design.size(),
    );
    let scales =
        tree.iter().map(
            |drive| match cut.mechanism.model.drives[drive.index()].dimension {
                Dimension::ANGLE => 1.0,
                _ => design.size(),
            },
        );
    let scales: Vec<f64> = scales.collect();
    // Those that keep a law do so as ever: what follows stands near where it was last.
    let stand = cut
        .follow
        .iter()
        .filter(|drive| own.free.contains(drive) || drive.index() >= mechanism.model.drives.len());
    let stand: Vec<(DriveId, f64)> = stand
        .map(|drive| (*drive, coordinates[drive.index()]))
        .collect();
    let moving: Vec<DriveId> = tree.iter().chain(&driven).copied().collect();
    let from = Start {
        design: open.clone(),
        coordinates,
        ..from
    };
    let places = Places::by_plan(&from, moving);
    let own_drives = mechanism.model.drives.len();
    let tells = vec![Tells::default(); own.free.len()];
    // Motors push along their drives, whether these are coordinates or follow.
    forces.acting.turning.clear();
    let moving = [tree, driven];
    let mut plant = Plant::letting_go(&own.free, &open, forces, places, moving, (scales, stops))
        .telling(tells, stand, own_drives);
    plant.tie(ties, &from.coordinates);
    Ok(plant)
}

/// Coordinates of all drives of a mechanism whose loops are open at the start: behind those of the closed one.
fn coordinates_at(open: &Design<f64>, from: &Start) -> Vec<f64> {
    let mechanism = &open.mechanism;
    let geometry = &open.geometry;
    let seat =
        |link: LinkId| geometry.seat_angles[link.index()] - geometry.seat_angles[FRAME.index()];
    let mut all = from.coordinates.clone();
    all.resize(mechanism.model.drives.len(), 0.0);
    let inputs = vec![Input::length(0.0); all.len()];
    let at = Situation {
        geometry,
        inputs: &inputs,
        poses: &from.placed.poses,
        near: &from.placed.near,
    };
    for index in from.coordinates.len()..all.len() {
        all[index] = match &mechanism.model.drives[index].kind {
            DriveKind::Turn { link, .. } => at.angle(mechanism.body_of(*link)) + seat(*link),
            // How far the point is ahead of a coordinate of nothing.
            DriveKind::Slide { .. } => {
                let source = Source::Drive(DriveId(index as u32));
                let mut constraints = mechanism.constraints.iter();
                let own = constraints.find(|(_, from)| *from == source);
                own.map_or(0.0, |(constraint, _)| at.residual(constraint)[0])
            }
            _ => 0.0,
        };
    }
    all
}

impl Plant {
    /// Ties the plant, whose drives start at these coordinates.
    fn tie(&mut self, ties: Ties, coordinates: &[f64]) {
        self.begins = (self.free.iter())
            .map(|drive| coordinates[drive.index()])
            .collect();
        self.ties = Some(Box::new(ties));
    }

    /// The coordinates at the start and their speeds, where drives that are let go are and move like this.
    ///
    /// # Errors
    /// Where branches cross there, or the links cannot move so.
    pub(crate) fn start(&mut self, own: &[[f64; 2]]) -> Result<Vec<f64>, Unsimulated> {
        if self.ties.is_none() {
            let places = own.iter().map(|s| s[0]);
            return Ok(places.chain(own.iter().map(|s| s[1])).collect());
        }
        let n = self.free.len();
        let mut y = self.begins.clone();
        y.resize(2 * n, 0.0);
        if !self.look(0.0, &y) {
            return Err(Unsimulated::Lacks(Lack::Pose));
        }
        let rows: Vec<Vec<f64>> = (0..own.len()).map(|k| self.own_row(k)).collect();
        let (now, driven) = (self.speeds(), self.driven_speeds());
        // What goes with drives that keep laws goes anyway.
        let speeds: Vec<f64> = (rows.iter().zip(own).enumerate())
            .map(|(k, (row, [_, wanted]))| wanted - (self.own_state(k)[1] - dot(row, &now)))
            .collect();
        let Some(ties) = &self.ties else {
            return Ok(y);
        };
        if ties.freedoms(n) > own.len() {
            return Err(Unsimulated::AtChangePoint);
        }
        let found = ties.speeds(&rows, &speeds, &driven, &self.scales);
        // Speeds of nothing are so but for rounding of the others.
        let fastest = found.iter().zip(&self.scales);
        let fastest = fastest.fold(0.0_f64, |most, (x, scale)| most.max((x / scale).abs()));
        let missed = |((row, wanted), size): ((&Vec<f64>, &f64), &f64)| {
            !((dot(row, &found) - wanted).abs() <= MISSED * wanted.abs().max(fastest * size))
        };
        let mut all = rows.iter().zip(&speeds).zip(&ties.sizes);
        if all.any(missed) {
            return Err(Unsimulated::Lacks(Lack::Pose));
        }
        self.keep_closed(&mut y);
        y[n..2 * n].copy_from_slice(&found);
        Ok(y)
    }
}

impl Ties {
    /// The least speeds of the coordinates of these sizes with which loops stay closed and drives that are let go, whose rows are these, have
    /// these speeds, at the state closed last.
    fn speeds(&self, own: &[Vec<f64>], speeds: &[f64], driven: &[f64], scales: &[f64]) -> Vec<f64> {
        let (mut rows, mut products) = self.asks_of_speeds(driven);
        for ((row, speed), size) in own.iter().zip(speeds).zip(&self.sizes) {
            let sized = row.iter().zip(scales);
            rows.push(sized.map(|(x, scale)| x * scale / size).collect());
            products.push(speed / size);
        }
        let found = Span::of(&rows, scales.len()).shortest(&products);
        found
            .iter()
            .zip(scales)
            .map(|(x, scale)| x * scale)
            .collect()
    }
}
