//! Motors of drives that are let go and hold nothing: a torque on what they turn, by its own speed.

use kempe_mechanism::{BodyId, Mechanism};
use kempe_model::{DriveId, DriveKind, LinkId, StandIn};

use crate::instant::Instant;
use crate::motor::Motor;
use crate::number::ForceNumber;
use crate::wrench::{self, Wrench};

/// A motor that turns one link against another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// The drive behind which it is.
    pub drive: DriveId,
    /// Its place among the motors.
    motor: usize,
    /// The sense in which it turns, 1 or -1.
    sense: f64,
    /// The link that it turns, and that against which, with their bodies.
    sides: [(LinkId, BodyId); 2],
}

impl Turning {
    /// All of a mechanism.
    pub(crate) fn all(mechanism: &Mechanism) -> Vec<Self> {
        let motors = mechanism.model.actions.motors.iter().enumerate();
        motors
            .filter_map(|(motor, it)| {
                let kind = &mechanism.model.drives.get(it.drive.index())?.kind;
                let DriveKind::StandIn(StandIn::Follows { of, sense }) = kind else {
                    return None;
                };
                let DriveKind::Turn { link, relative_to } = **of else {
                    return None;
                };
                Some(Self {
                    drive: it.drive,
                    motor,
                    sense: *sense,
                    sides: [link, relative_to].map(|link| (link, mechanism.body_of(link))),
                })
            })
            .collect()
    }

    /// The link that it turns, and that against which.
    pub fn links(&self) -> [LinkId; 2] {
        self.sides.map(|(link, _)| link)
    }

    /// How fast the drive's coordinate runs, rad/s.
    fn speed<T: ForceNumber>(&self, at: &Instant<T>) -> T {
        let [own, other] = self.sides.map(|(_, body)| at.velocities[body.index()][2]);
        own - other
    }

    /// What it gives along the drive's coordinate, N m.
    pub(crate) fn torque<T: ForceNumber>(&self, motors: &[Motor<T>], at: &Instant<T>) -> T {
        let Some(motor) = motors.get(self.motor) else {
            return T::zero();
        };
        motor.turns_with(self.speed(at) * self.sense) * self.sense
    }

    /// The power that it gives, W.
    pub(crate) fn power<T: ForceNumber>(&self, motors: &[Motor<T>], at: &Instant<T>) -> T {
        self.torque(motors, at) * self.speed(at)
    }

    /// Adds what it does to the links.
    pub(crate) fn act<T: ForceNumber>(
        &self,
        motors: &[Motor<T>],
        at: &Instant<T>,
        on_links: &mut [Wrench<T>],
    ) {
        let torque = self.torque(motors, at);
        let [own, other] = self.links();
        wrench::add(&mut on_links[own.index()], [T::zero(), T::zero(), torque]);
        wrench::add(
            &mut on_links[other.index()],
            [T::zero(), T::zero(), -torque],
        );
    }
}
