//! Why a state has no accelerations, and what has no value there.

use kempe_dynamics::NotLetGo;
use kempe_model::DriveId;

use crate::touched::Place;

/// Something by which a simulation goes and that may have no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sought {
    /// How far a stop is open, by its place in the question.
    Stop(usize),
    /// A condition that ends the motion, by its place in the question.
    Condition(usize),
    /// What turns a switch of the model.
    Switch(usize),
    /// A load of the model.
    Load(usize),
    /// The throttle of the motor of a drive.
    Throttle(DriveId),
    /// The valve of the cylinder of a drive.
    Valve(DriveId),
    /// The law of a drive that keeps it.
    Law(DriveId),
}

/// Why nothing is known of how what is let go accelerates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// The links do not close there, or not on this branch; or it stands at a dead point of what is let go.
    Pose,
    /// Something is infinite, or no number.
    Value(Sought),
    /// On one side of the cylinder of this drive there is no oil left.
    Oil(DriveId),
    /// Nothing that is let go moves any mass.
    Mass,
    /// A force is infinite, or has no direction.
    Force,
    /// Friction jams it, or lets it move in more than one way.
    Friction,
    /// What slides at this place of a joint with play wedges itself: no push there holds the bodies apart, or no one alone.
    Wedged(Place),
    /// The stops on which it rests repeat each other, so that what each of them pushes is not known.
    Rest,
}

impl Lack {
    pub(crate) fn of(why: NotLetGo) -> Self {
        match why {
            NotLetGo::Singular => Self::Pose,
            NotLetGo::NoMass => Self::Mass,
            NotLetGo::Friction => Self::Friction,
            NotLetGo::NotFinite => Self::Force,
        }
    }
}
