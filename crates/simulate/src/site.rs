//! Places that rub: what each of them is, and how it is looked at.

use kempe_dynamics::Acting;
use kempe_mechanism::structure::Source;
use kempe_model::DriveId;

use crate::touched::Place;

/// What rubs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rubs {
    /// A joint.
    Joint(Source),
    /// A place of a joint with play.
    Contact(Place),
    /// The seals of the cylinder of a drive.
    Seals(DriveId),
}

/// What a place is to the plant.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Acts {
    /// A joint: its place among the friction that acts, and that of its part among the amounts.
    Joint(usize, usize),
    /// A place of a joint with play whose bodies give.
    Contact(Place),
    /// One whose bodies do not, and its stop.
    Rigid(Place, usize),
    /// The seals of a cylinder, by its place among those that oil moves.
    Seals(usize),
}

/// How a place that rubs is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rub {
    /// It slides in this sense.
    Slides(f64),
    /// Friction holds it.
    Held,
    /// Nothing that is let go moves it.
    Idle,
    /// Its bodies do not touch.
    Apart,
}

/// A place that rubs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub what: Acts,
    /// The place of its part among the inner states.
    pub inner: usize,
    /// Speed that counts as 1/s: 1 of what turns, the mechanism's size of what slides.
    pub size: f64,
    /// The fastest that it was seen to slide.
    pub fastest: f64,
    /// What it resists with while it is held, N m or N.
    pub resists: f64,
}

/// The places that rub.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rubbing {
    pub sites: Vec<Site>,
}

/// How many places rub where these drives are let go.
pub(crate) fn places_that_rub(acting: &Acting<f64>, free: &[DriveId]) -> usize {
    let joints = acting.friction.iter().filter(|f| f.is_dry());
    let contacts = acting.contacts.iter().filter(|c| c.sticks());
    let seals = acting
        .oils
        .iter()
        .filter(|oil| oil.friction > 0.0 && free.contains(&oil.drive));
    joints.count() + contacts.map(|c| c.places()).sum::<usize>() + seals.count()
}
