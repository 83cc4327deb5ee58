//! Forces of one instant, by both routes.

use kempe_mechanism::constraint::Joint;
use kempe_mechanism::{BodyId, Design, Mechanism};
use kempe_model::{DriveId, DriveKind, LinkId, StandIn};
use kempe_number::Number as _;
use kempe_units::Dimension;

use crate::acting::Acting;
use crate::equilibrium::Equilibrium;
pub use crate::equilibrium::FrictionOutcome;
use crate::instant::{Instant, Rates};
use crate::joint_contact;
use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;
use crate::virtual_power::{self, ByPower};
use crate::weld::Weld;
use crate::wrench::{self, Wrench};

/// Part of the largest load in which the difference of both routes is counted at least.
pub const FLOOR: f64 = 1e-3;

/// Friction that is less than what the load gains over this way of the drive, by its rate there (in rad, or in mechanism
/// sizes), holds it only where it is about to change its sense: any friction does.
const SENSE_CHANGES: f64 = 0.25;

/// What a joint or drive does to one of its links.
#[derive(Clone, Copy, Debug)]
pub struct LinkLoad<T> {
    /// The link.
    pub link: LinkId,
    /// Its body.
    pub body: BodyId,
    /// Force and moment about the body's origin, friction included.
    pub wrench: Wrench<T>,
}

/// What a drive gives, both ways.
#[derive(Clone, Copy, Debug)]
pub struct DriveForce<T: ForceNumber> {
    /// By virtual power.
    pub by_power: ByPower<T>,
    /// By equilibrium.
    pub by_equilibrium: T,
    /// The answer: by virtual power; rates that it does not know by equilibrium.
    pub value: T,
}

/// Forces of a mechanism at one instant, with storage that is reused from instant to instant: [`Forces::solve`]
/// allocates nothing.
#[derive(Clone, Debug)]
pub struct Forces<T: ForceNumber> {
    /// The design.
    pub design: Design<T>,
    /// What acts on it.
    pub acting: Acting<T>,
    /// Equilibrium of all bodies.
    pub equilibrium: Equilibrium<T>,
    /// Welds whose loads can be told.
    pub welds: Vec<Weld>,
    /// What every constraint does to its links.
    pub sides: Vec<Vec<LinkLoad<T>>>,
    /// What every drive gives.
    pub drives: Vec<DriveForce<T>>,
    /// Weights, loads, springs and dampers on every link, about its body's origin.
    pub applied: Vec<Wrench<T>>,
    /// `m a` and `J alpha` of every link, about its body's origin.
    pub inertial: Vec<Wrench<T>>,
    /// Weights, loads, springs and dampers on every body.
    pub applied_on_bodies: Vec<Wrench<T>>,
    /// What contacts in joints with play do to every body.
    pub by_contacts: Vec<Wrench<T>>,
    /// `m a` less what is applied and what contacts do, friction included after a solve, of every body.
    pub(crate) needed: Vec<Wrench<T>>,
    /// Constraint of every drive.
    drive_constraints: Vec<Option<usize>>,
}

impl<T: ForceNumber> Forces<T> {
    /// Prepares the forces of a design.
    ///
    /// # Errors
    /// All problems of what acts on the mechanism.
    pub fn new(design: Design<T>) -> Result<Self, Vec<Problem>> {
        let mechanism = &design.mechanism.clone();
        let parameters = &design.parameters;
        let acting = Acting::new(mechanism, &design.geometry, parameters)?;
        let size = |lane: usize| {
            let geometry = design.geometry.map(|x| x.value_in(lane));
            geometry.size(mechanism)
        };
        let zero = [T::zero(); 3];
        let (links, bodies) = (mechanism.model.links.len(), mechanism.bodies);
        let sides = (mechanism.constraints.iter())
            .map(|(constraint, _)| {
                (constraint.links(mechanism).into_iter())
                    .map(|link| LinkLoad {
                        link,
                        body: mechanism.body_of(link),
                        wrench: zero,
                    })
                    .collect()
            })
            .collect();
        let drives = mechanism.model.drives.len();
        let nothing = DriveForce {
            by_power: ByPower {
                value: T::zero(),
                scale: T::Plain::zero(),
            },
            by_equilibrium: T::zero(),
            value: T::zero(),
        };
        Ok(Self {
            equilibrium: Equilibrium::new(mechanism, size, acting.friction.len()),
            welds: Weld::all(mechanism),
            sides,
            drives: vec![nothing; drives],
            applied: vec![zero; links],
            inertial: vec![zero; links],
            applied_on_bodies: vec![zero; bodies],
            by_contacts: vec![zero; bodies],
            needed: vec![zero; bodies],
            drive_constraints: (0..drives)
                .map(|d| {
                    let drive = Some(DriveId(d as u32));
                    mechanism
                        .constraints
                        .iter()
                        .position(|(c, _)| c.drive() == drive)
                })
                .collect(),
            acting,
            design,
        })
    }

    /// Takes up what acts at an instant and how the masses accelerate: what every body needs, without friction.
    pub(crate) fn take_up(&mut self, at: &Instant<T>) {
        self.acting.evaluate(
            &self.design.mechanism,
            &self.design.geometry,
            at,
            &mut self.applied,
            &mut self.inertial,
        );
        self.applied_on_bodies.fill([T::zero(); 3]);
        self.needed.fill([T::zero(); 3]);
        for (index, seat) in self.design.mechanism.seats.iter().enumerate() {
            let body = seat.body.index();
            let (applied, inertial) = (self.applied[index], self.inertial[index]);
            wrench::add(&mut self.applied_on_bodies[body], applied);
            wrench::add(&mut self.needed[body], inertial);
            wrench::add(&mut self.needed[body], wrench::opposite(applied));
        }
        self.by_contacts.fill([T::zero(); 3]);
        joint_contact::act(&self.acting.contacts, at, &mut self.by_contacts);
        for (needed, given) in self.needed.iter_mut().zip(&self.by_contacts) {
            wrench::add(needed, wrench::opposite(*given));
        }
    }

    /// Finds all forces of an instant.
    pub fn solve(&mut self, at: &Instant<T>) {
        self.take_up(at);
        self.equilibrium.solve(
            &self.design.mechanism,
            &self.design.geometry,
            &self.acting.friction,
            at,
            &self.needed,
        );
        self.share_out();
        for (index, (drive, constraint)) in self
            .drives
            .iter_mut()
            .zip(&self.drive_constraints)
            .enumerate()
        {
            // What holds nothing gives what its motor does.
            if holds_nothing(&self.design.mechanism, index) {
                let given = self.acting.turns(DriveId(index as u32), at);
                drive.by_power.value = given;
                (drive.by_equilibrium, drive.value) = (given, given);
                continue;
            }
            let by_power = virtual_power::project(&self.needed, &at.coefficients[index]);
            let row = constraint.map(|c| self.equilibrium.row(c));
            let by_equilibrium =
                row.map_or(T::from_f64(f64::NAN), |row| self.equilibrium.lambda[row]);
            *drive = DriveForce {
                by_power,
                by_equilibrium,
                value: by_power.value.completed(by_equilibrium),
            };
        }
        self.give_back(at);
    }

    /// Gives drives that are let go what is carried along their own coordinates, where these tell the place: what a stop does to them.
    fn give_back(&mut self, at: &Instant<T>) {
        for (index, drive) in self.design.mechanism.model.drives.iter().enumerate() {
            let DriveKind::StandIn(StandIn::Pilot { of, chosen, .. }) = &drive.kind else {
                continue;
            };
            if at.inputs[chosen.index()].value.value().round() == 0.0 {
                let carried = self.drives[index].value;
                let drive = &mut self.drives[of.index()];
                drive.by_power.value += carried;
                drive.by_equilibrium += carried;
                drive.value += carried;
            }
        }
    }

    /// `m a` less what is applied, of every body, about its origin; friction left out.
    pub(crate) fn needed_without_friction(&self) -> Vec<Wrench<T>> {
        let mut needed = vec![[T::zero(); 3]; self.applied_on_bodies.len()];
        let seats = self.design.mechanism.seats.iter();
        for (seat, (applied, inertial)) in seats.zip(self.applied.iter().zip(&self.inertial)) {
            let body = &mut needed[seat.body.index()];
            wrench::add(body, *inertial);
            wrench::add(body, wrench::opposite(*applied));
        }
        for (needed, given) in needed.iter_mut().zip(&self.by_contacts) {
            wrench::add(needed, wrench::opposite(*given));
        }
        needed
    }

    /// Gives every side of every joint its part, and takes friction off what the bodies need.
    fn share_out(&mut self) {
        let zero = [T::zero(); 3];
        for side in self.sides.iter_mut().flatten() {
            side.wrench = zero;
        }
        let (sides, needed) = (&mut self.sides, &mut self.needed);
        let mut give = |constraint: usize, body: BodyId, w: Wrench<T>| {
            if let Some(side) = sides[constraint].iter_mut().find(|s| s.body == body) {
                wrench::add(&mut side.wrench, w);
            }
        };
        self.equilibrium.each_reaction(&mut give);
        let frictions = &self.acting.friction;
        self.equilibrium
            .each_friction(frictions, |constraint, body, w| {
                give(constraint, body, w);
                wrench::add(&mut needed[body.index()], wrench::opposite(w));
            });
    }

    /// The largest difference of both routes over all drives in a lane, in parts of the terms that make up each drive's
    /// force (at least of [`FLOOR`] of the largest load anywhere, so that a drive that gives nothing is not counted in
    /// rounding).
    pub fn route_difference(&self, lane: usize) -> f64 {
        let mut largest = 0.0_f64;
        for (drive, constraint) in self.drives.iter().zip(&self.drive_constraints) {
            let by_power = &drive.by_power;
            let (a, b) = (
                by_power.value.value_in(lane),
                drive.by_equilibrium.value_in(lane),
            );
            let floor = constraint.map_or(0.0, |c| FLOOR * self.equilibrium.largest_at(c, lane));
            let scale = by_power.scale.lane_value(lane).max(a.abs()).max(floor);
            let difference = (a - b).abs();
            let relative = if difference == 0.0 {
                0.0
            } else {
                difference / scale
            };
            if relative.is_nan() {
                return f64::NAN;
            }
            largest = largest.max(relative);
        }
        largest
    }

    /// What a drive would give without friction, in a lane, by equilibrium.
    pub fn frictionless(&self, drive: usize, lane: usize) -> f64 {
        let constraint = self.drive_constraints.get(drive).copied().flatten();
        constraint.map_or(f64::NAN, |constraint| {
            self.equilibrium.lanes[lane].frictionless[self.equilibrium.row(constraint)]
        })
    }

    /// Everything that joints, drives and friction do to a link, about its body's origin.
    pub fn joints_on(&self, link: LinkId) -> Wrench<T> {
        let mut sum = [T::zero(); 3];
        for side in self.sides.iter().flatten().filter(|s| s.link == link) {
            wrench::add(&mut sum, side.wrench);
        }
        sum
    }

    /// What a weld does to the link that hangs on it, about the body's origin: the equilibrium of everything that hangs.
    pub fn weld_on_child(&self, weld: &Weld) -> Wrench<T> {
        let mut sum = [T::zero(); 3];
        for link in &weld.part {
            wrench::add(&mut sum, self.inertial[link.index()]);
            wrench::add(&mut sum, wrench::opposite(self.applied[link.index()]));
            wrench::add(&mut sum, wrench::opposite(self.joints_on(*link)));
        }
        sum
    }
}

/// Whether a drive is let go and holds nothing, or is a mere number.
fn holds_nothing(mechanism: &Mechanism, drive: usize) -> bool {
    let drive = mechanism.model.drives.get(drive);
    let nothing = |kind: &DriveKind| {
        matches!(
            kind,
            DriveKind::StandIn(StandIn::Follows { .. } | StandIn::Choice)
        )
    };
    drive.is_some_and(|d| nothing(&d.kind))
}

/// Loads below this part of what friction takes are rounding: nothing is held at a dead point itself.
const NO_LOAD: f64 = 1e-9;
/// A drive that gives this part of what it would without friction gives nothing: it is let go, and friction holds or brakes the mechanism.
const GIVES_NOTHING: f64 = 1e-6;

impl Forces<Rates> {
    /// Whether friction holds a drive against what acts on the mechanism, masses at rest: without friction the drive would
    /// have to brake the motion at hand, with friction it has to drive it, and this is not only because the load is about
    /// to change its sense, where any friction is enough.
    pub(crate) fn holds_at_rest(&self, at: &Instant<Rates>, drive: usize) -> bool {
        let Some(constraint) = self.drive_constraints.get(drive).copied().flatten() else {
            return false;
        };
        let loads = self.applied_on_bodies.iter();
        let needed: Vec<Wrench<Rates>> = loads.map(|w| wrench::opposite(*w)).collect();
        let mut resting = self.equilibrium.clone();
        // What is viscous holds nothing.
        let mut frictions = self.acting.friction.clone();
        frictions
            .iter_mut()
            .for_each(|it| it.law.viscous = Rates::zero());
        resting.solve(
            &self.design.mechanism,
            &self.design.geometry,
            &frictions,
            at,
            &needed,
        );
        let (row, speed) = (resting.row(constraint), at.drive_speeds[drive].value());
        let (free, held) = (
            resting.lanes[0].frictionless[row],
            resting.lambda[row].value(),
        );
        let loaded = free.abs() > NO_LOAD * held.abs() && held.abs() > GIVES_NOTHING * free.abs();
        let holds = loaded && free * speed < 0.0 && held * speed > 0.0;
        let load = virtual_power::project(&needed, &at.coefficients[drive]).value;
        let per_drive = load.coefficient(1) / speed;
        let typical = match self.design.mechanism.model.drives[drive].dimension {
            Dimension::ANGLE => 1.0,
            _ => self.design.geometry.value().size(&self.design.mechanism),
        };
        let turns_about = (held - free).abs() < SENSE_CHANGES * typical * per_drive.abs();
        holds && !turns_about
    }
}
