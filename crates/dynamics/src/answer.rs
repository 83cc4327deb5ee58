//! Force measures evaluated.

use kempe_model::{DriveId, ForceMeasure, JointRef};
use kempe_number::Number;

use crate::cylinder::Cylinder;
use crate::equilibrium::STILL;
use crate::forces::Forces;
use crate::instant::Instant;
use crate::load::Load;
use crate::number::{ForceNumber, PlainNumber};
use crate::reaction::Reaction;
use crate::shaking::shaking;
use crate::vector::length;
use crate::{energy, reduced};

/// A load at an instant: a force along the frame's axes, N, or a torque, N m.
enum LoadValue<T> {
    Force([T; 2]),
    Torque(T),
}

impl<T: Copy> LoadValue<T> {
    fn component(&self, axis: usize) -> Option<T> {
        match self {
            Self::Force(force) => force.get(axis).copied(),
            Self::Torque(_) => None,
        }
    }
}

impl<T: ForceNumber> Forces<T> {
    /// The value of a force measure at the instant last solved, SI. NaN where it has none.
    pub fn answer(&self, at: &Instant<T>, measure: &ForceMeasure) -> T {
        let nothing = T::from_f64(f64::NAN);
        let reaction = |joint: &JointRef| self.reaction(at, *joint);
        let along = |joint: &JointRef, axis: usize| {
            reaction(joint).map(|r| self.in_axes_of(at, r.link, r.force)[axis])
        };
        let drive = |drive: &DriveId| self.drives.get(drive.index());
        let found = match measure {
            ForceMeasure::Drive(d) => drive(d).map(|f| f.value),
            ForceMeasure::Reaction(joint) => reaction(joint).map(|r| Reaction::size(&r)),
            ForceMeasure::ReactionX(joint) => reaction(joint).map(|r| r.force[0]),
            ForceMeasure::ReactionY(joint) => reaction(joint).map(|r| r.force[1]),
            ForceMeasure::ReactionAngle(joint) => {
                reaction(joint).map(|r| r.force[1].atan2(r.force[0]))
            }
            ForceMeasure::ReactionAlong(joint) => along(joint, 0),
            ForceMeasure::ReactionAcross(joint) => along(joint, 1),
            ForceMeasure::ReactionMoment(joint) => reaction(joint).map(|r| r.moment),
            ForceMeasure::Power(d) => drive(d).map(|f| f.value * at.drive_speeds[d.index()]),
            ForceMeasure::KineticEnergy => Some(energy::kinetic(&self.acting, at)),
            ForceMeasure::PotentialEnergy => {
                Some(energy::potential(&self.acting, &self.design.geometry, at))
            }
            ForceMeasure::ShakingForceX => Some(shaking(&self.acting, at)[0]),
            ForceMeasure::ShakingForceY => Some(shaking(&self.acting, at)[1]),
            ForceMeasure::ShakingForce => {
                let [x, y, _] = shaking(&self.acting, at);
                Some(length([x, y]))
            }
            ForceMeasure::ShakingMoment => Some(shaking(&self.acting, at)[2]),
            ForceMeasure::ReducedMass(d) => {
                drive(d).map(|_| reduced::mass(&self.acting, at, d.index())[0])
            }
            ForceMeasure::ReducedLoad(d) => {
                // Its own motor is no load of it.
                let own = self.acting.turns(*d, at);
                drive(d).map(|_| reduced::load(&self.applied_on_bodies, at, d.index()) - own)
            }
            ForceMeasure::Pressure(d) => self.cylinder(*d).and_then(|c| {
                let force = drive(d)?.value;
                Some(c.pressure(force, self.drive_direction(at, *d)))
            }),
            ForceMeasure::Capacity(d) => match self.acting.motors.iter().find(|m| m.drive == *d) {
                Some(motor) => {
                    let speed = at.drive_speeds[d.index()];
                    let torque = motor.torque(speed);
                    // A start from rest may be a little slower than that, by rounding.
                    Some((speed + self.still(*d)).choose(torque, -torque))
                }
                None => self.cylinder(*d).and_then(|c| {
                    let force = drive(d)?.value;
                    c.capacity(force, self.drive_direction(at, *d))
                }),
            },
            ForceMeasure::Spring(index) => {
                (self.acting.springs.get(*index)).map(|s| s.tension(&self.design.geometry, at))
            }
            ForceMeasure::Damper(index) => {
                (self.acting.dampers.get(*index)).map(|d| d.tension_at(&self.design.geometry, at))
            }
            ForceMeasure::Load(index) => self.load(at, *index).map(|load| match load {
                LoadValue::Force(force) => length(force),
                LoadValue::Torque(torque) => torque,
            }),
            ForceMeasure::LoadX(index) => self.load(at, *index).and_then(|load| load.component(0)),
            ForceMeasure::LoadY(index) => self.load(at, *index).and_then(|load| load.component(1)),
        };
        found.unwrap_or(nothing)
    }

    fn load(&self, at: &Instant<T>, index: usize) -> Option<LoadValue<T>> {
        let load = self.acting.loads.get(index)?;
        Some(match *load {
            Load::Torque { amount, .. } => LoadValue::Torque(at.amounts[amount]),
            Load::Force { .. } => {
                LoadValue::Force(load.force(&self.design.mechanism, &self.design.geometry, at)?)
            }
        })
    }

    /// The hydraulic cylinder behind a drive.
    pub fn cylinder(&self, drive: DriveId) -> Option<&Cylinder<T>> {
        self.acting.cylinders.iter().find(|c| c.drive == drive)
    }

    /// The sense in which a drive moves: -1, 0 or 1; of an interval that may move either way all between.
    pub fn drive_direction(&self, at: &Instant<T>, drive: DriveId) -> T::Plain {
        let speed = at.drive_speeds[drive.index()].plain();
        let still = T::Plain::from_f64(self.still(drive));
        speed.direction(T::Plain::zero(), [still, T::Plain::zero()])
    }

    /// A speed of a drive that is none.
    fn still(&self, drive: DriveId) -> f64 {
        let usual = self.equilibrium.pace.speeds.get(drive.index());
        STILL * usual.copied().unwrap_or(0.0)
    }
}
