//! A label to be placed, and the ways to put it.

use super::room::Room;
use crate::scene::{Item, Path, Point, Style};
use crate::tokens::Token;

/// A label in one pose: where its text stands, and the lines that come with it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spot {
    /// The room of its text.
    pub room: Room,
    /// A leader, or the lines of a dimension.
    pub lines: Vec<[Point; 2]>,
}

/// One way to put a label, in each pose that is looked at; `None` in a pose that does not show it.
#[derive(Clone, Debug)]
pub(crate) struct Choice {
    /// How much worse this is by itself than the best.
    pub dislike: f64,
    /// Where the label is in each pose.
    pub spots: Vec<Option<Spot>>,
}

/// A label to be placed.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    /// The ways to put it, the best first.
    pub choices: Vec<Choice>,
    /// It may be left out where it would touch another.
    pub optional: bool,
}

/// The thin line from a label to what it names.
pub(crate) fn leader([from, to]: [Point; 2], token: Token) -> Item {
    Item::path(Path::polyline(&[from, to]), Style::stroke(token, 0.2))
}
