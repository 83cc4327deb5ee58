//! Puts labels where they are in nobody's way: names of points and of arrows, dimensions, names along a curve.
//!
//! Each label has choices in order of preference. What a choice covers of the picture and of other labels costs; from the
//! first choices on, labels are put elsewhere one by one as long as that makes things better.

mod conflict;
mod extent;
mod names;
mod place;
mod points;
mod room;
mod surroundings;
mod wanted;
mod words;

pub(crate) use names::{around_disc, beside};
pub(crate) use place::{most_choices, place};
pub(crate) use points::{Named, named};
pub(crate) use room::Room;
pub(crate) use surroundings::Surroundings;
pub(crate) use wanted::{Choice, Spot, Wanted, leader};
pub(crate) use words::Words;
