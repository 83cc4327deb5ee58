//! Joints with play: let go with the drives, their bodies touch and part.

use kempe_dynamics::joint_contact::{JointContact, Resists};
use kempe_mechanism::{Design, NotReleased};
use kempe_model::{Contact, DriveId, DriveKind, Touching};
use kempe_number::{Jet, Number};

use crate::barrier::{Barrier, Opens};
use crate::plant::Plant;
use crate::question::Resistance;
use crate::start::Start;
use crate::touched::Place;

/// A design whose joints are let go where they have play, and whose bodies touch there: only what their contacts say rubs.
///
/// # Errors
/// A joint that cannot have play.
pub fn with_play(closed: &Design<f64>, contacts: &[Contact]) -> Result<Design<f64>, NotReleased> {
    let joints: Vec<_> = contacts.iter().map(|c| c.joint.into()).collect();
    let open = closed.mechanism.releasing(&joints)?;
    let mut design = Design::new(&open, &closed.parameters);
    design.count_turns(&closed.geometry.turns);
    Ok(design.with_model(|model| {
        let joints = contacts.iter().map(|contact| contact.joint);
        model.actions.smooth.extend(joints);
        model.actions.contacts = contacts.to_vec();
    }))
}

/// The coordinate of a row of a joint with play.
pub(crate) struct OpenRow {
    pub drive: DriveId,
    /// How far the joint may open, m.
    pub clearance: f64,
    /// Where it starts, and how fast.
    pub start: [f64; 2],
}

/// The start with the joints let go, in the middle of their play, and the coordinates of their rows.
pub(crate) fn opened(
    start: Start,
    contacts: &[Contact],
) -> Result<(Start, Vec<OpenRow>), NotReleased> {
    if contacts.is_empty() {
        return Ok((start, Vec::new()));
    }
    let design = with_play(&start.design, contacts)?;
    let drives = &design.mechanism.model.drives;
    let rows = drives.iter().enumerate().filter_map(|(index, drive)| {
        let DriveKind::Release { of, row } = drive.kind else {
            return None;
        };
        let contact = contacts.iter().find(|c| c.joint == of)?;
        Some(OpenRow {
            drive: DriveId(index as u32),
            clearance: contact.clearance,
            start: contact.start.get(usize::from(row)).copied()?,
        })
    });
    let rows: Vec<OpenRow> = rows.collect();
    let mut coordinates = start.coordinates;
    coordinates.resize(drives.len(), 0.0);
    let start = Start {
        coordinates,
        design,
        ..start
    };
    Ok((start, rows))
}

/// Stops of the contacts that resist at once, with the places that they stand for.
pub(crate) fn rigid_stops(contacts: &[JointContact]) -> Vec<(Place, Barrier)> {
    let stops = contacts.iter().enumerate().flat_map(|(contact, it)| {
        let restitution = match it.resists {
            Resists::AtOnce { restitution, .. } => Some(restitution),
            Resists::ByLaw { .. } => None,
        };
        let places = restitution.map(|restitution| {
            (0..it.places()).map(move |place| {
                let at = Place { contact, place };
                let barrier = Barrier {
                    opens: Opens::Joint(at),
                    resistance: Resistance::Rigid { restitution },
                    on_bodies: false,
                    on_drives: false,
                };
                (at, barrier)
            })
        });
        places.into_iter().flatten()
    });
    stops.collect()
}

/// A contact that begins with less than this part of the fastest before at its joint counts as that fast: it is rest, and what dissipates
/// by a law that divides by the speed would hold it as in pitch.
const SLOWEST: f64 = 1e-4;

impl Plant {
    /// How far a joint is open at a place, m, where its coordinates are these functions of something: `of` makes them of where they
    /// are and how fast they move.
    pub fn opening_in<T: Number>(
        &self,
        at: Place,
        y: &[f64],
        of: impl Fn(usize, [f64; 2]) -> T,
    ) -> T {
        let n = self.free.len();
        let unknown = || T::from_f64(f64::NAN);
        let Some(contact) = self.forces.acting.contacts.get(at.contact) else {
            return unknown();
        };
        let row = |drive: DriveId| {
            let index = self.free.iter().position(|free| *free == drive);
            index.map_or_else(unknown, |k| of(k, [y[k], y[n + k]]))
        };
        contact.gap(at.place, contact.along.map(row))
    }

    /// How far a joint is open at a place, m, and how fast it opens, m/s, at a state.
    pub fn opening(&self, at: Place, y: &[f64]) -> [f64; 2] {
        let in_time = |_, [q, v]: [f64; 2]| Jet::<f64, 2>::from_coefficients([q, v]);
        *self.opening_in(at, y, in_time).coefficients()
    }

    /// A place whose bodies are deeper in each other than this part of their play, and how deep, m.
    pub fn beyond_play(&self, part: f64, y: &[f64]) -> Option<(Place, f64)> {
        let contacts = self.forces.acting.contacts.iter().enumerate();
        let places = contacts
            .flat_map(|(contact, it)| (0..it.places()).map(move |place| Place { contact, place }));
        let model = &self.forces.design.mechanism.model;
        let beyond = places.map(|at| (at, -self.opening(at, y)[0]));
        beyond.into_iter().find(|(at, deep)| {
            let contact = model.actions.contacts.get(at.contact);
            contact.is_some_and(|contact| *deep > part * contact.clearance)
        })
    }

    /// Every place of the contacts that give.
    pub fn contact_places(&self) -> Vec<Place> {
        let contacts = self.forces.acting.contacts.iter().enumerate();
        let give = contacts.filter(|(_, it)| matches!(it.resists, Resists::ByLaw { .. }));
        let places = give
            .flat_map(|(contact, it)| (0..it.places()).map(move |place| Place { contact, place }));
        places.collect()
    }

    /// Whether a place touches.
    pub fn is_touching(&self, at: Place) -> bool {
        let contact = self.forces.acting.contacts.get(at.contact);
        let touches = contact.and_then(|c| c.touches.get(at.place));
        let last = touches.and_then(|touches| touches.last());
        last.is_some_and(|touch| touch.to == f64::INFINITY)
    }

    /// The places at which bodies that give touch and come together, or are pressed, at a state that accelerates so: how fast, m/s.
    /// `part` of the play, and of the speeds, is none.
    pub fn pressed(&self, part: f64, y: &[f64], accelerations: &[f64]) -> Vec<(Place, f64)> {
        let model = &self.forces.design.mechanism.model;
        let n = self.free.len();
        let places = self.contact_places().into_iter().filter_map(|at| {
            let clearance = model.actions.contacts.get(at.contact)?.clearance;
            let gap = self.gap_at(at, y);
            let none = part * gap.scale(&y[n..2 * n]);
            let comes = gap.rate < -none || gap.rate <= none && gap.opening(accelerations) < 0.0;
            let speed = if gap.rate < -none { -gap.rate } else { 0.0 };
            (gap.open.abs() <= part * clearance && comes).then_some((at, speed))
        });
        places.collect()
    }

    /// Lets a place touch from a time on, whose bodies come together with a speed, m/s.
    pub fn touch(&mut self, at: Place, time: f64, speed: f64) {
        let contact = self.forces.acting.contacts.get(at.contact);
        let touches = contact.iter().flat_map(|c| c.touches.iter().flatten());
        let fastest = touches.map(|touch| touch.speed).fold(0.0, f64::max);
        if let Some(touches) = self.touches_of(at) {
            touches.push(Touching {
                place: at.place,
                from: time,
                to: f64::INFINITY,
                speed,
                counts_as: speed.max(SLOWEST * fastest),
            });
        }
    }

    /// Lets a place part at a time.
    pub fn part(&mut self, at: Place, time: f64) {
        if let Some(last) = self.touches_of(at).and_then(|touches| touches.last_mut()) {
            last.to = time;
        }
    }

    fn touches_of(&mut self, at: Place) -> Option<&mut Vec<Touching>> {
        let contact = self.forces.acting.contacts.get_mut(at.contact)?;
        contact.touches.get_mut(at.place)
    }
}
