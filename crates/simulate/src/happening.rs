//! What happens during a motion.

use crate::site::Rubs;
use crate::touched::Place;
use kempe_model::{Chamber, DriveId};

/// Something that happened at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening {
    /// When, s.
    pub time: f64,
    /// What.
    pub what: Happened,
}

/// What happened; stops by their place in the question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Happened {
    /// Something strikes a stop, with this speed of its gap before and after.
    Strikes {
        /// The stop.
        stop: usize,
        /// Rate of the gap before: negative.
        before: f64,
        /// After.
        after: f64,
    },
    /// Something touches a soft stop, with this speed.
    Touches {
        /// The stop.
        stop: usize,
        /// How fast its gap closes.
        speed: f64,
    },
    /// It comes to rest on a stop.
    Rests {
        /// The stop.
        stop: usize,
    },
    /// It leaves a stop on which it rested.
    Leaves {
        /// The stop.
        stop: usize,
    },
    /// The bodies of a joint with play come together, with this speed.
    Meets {
        /// Where.
        at: Place,
        /// How fast, m/s.
        speed: f64,
    },
    /// They part again, with this speed.
    Separates {
        /// Where.
        at: Place,
        /// How fast, m/s.
        speed: f64,
    },
    /// Friction holds it.
    Sticks,
    /// Friction lets it go.
    Slips,
    /// Friction holds one of the places that rub.
    Holds {
        /// Which.
        at: Rubs,
    },
    /// Friction lets one of the places go.
    LetsGo {
        /// Which.
        at: Rubs,
    },
    /// A switch goes on or off.
    Switches {
        /// Which of the model's.
        switch: usize,
        /// Whether it is on from here.
        on: bool,
    },
    /// A switch counts one further.
    Counts {
        /// Which of the model's.
        switch: usize,
        /// How far it is.
        to: f64,
    },
    /// The pressure in a cylinder falls below that of a vacuum, where its equations do not hold.
    Cavitates {
        /// The place of its drive among those that are let go.
        free: usize,
        /// The side.
        side: Chamber,
    },
    /// The speed of a drive that keeps its law jumps.
    Jumps {
        /// The drive.
        drive: DriveId,
        /// Its speed before, SI.
        before: f64,
        /// After.
        after: f64,
    },
    /// One of the conditions holds that end the motion.
    Ends {
        /// Which.
        condition: usize,
    },
}

/// A time in which something besides the drives holds or pushes.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Since when, s.
    pub from: f64,
    /// Until when, s.
    pub to: f64,
    /// The stops that do.
    pub stops: Vec<usize>,
    /// Whether friction holds it.
    pub by_friction: bool,
}

impl Held {
    /// Whether another time begins where it ends, in which the same holds.
    pub(crate) fn goes_on_in(&self, next: &Self) -> bool {
        let same = self.stops == next.stops && self.by_friction == next.by_friction;
        same && self.to == next.from
    }

    /// Whether a time lies in it, ends included.
    pub fn holds_at(&self, time: f64) -> bool {
        self.from <= time && time <= self.to
    }
}
