//! Limit switches: what is on or off, and goes from one to the other where something passes a place.

use crate::condition::Condition;
use crate::ids::{Scalar, Span};

/// A switch.
#[derive(Clone, Debug, PartialEq)]
pub struct Switch {
    /// Name.
    pub name: String,
    /// It goes on when this comes to hold.
    pub on: Condition,
    /// It goes off when this comes to hold; without it, when `on` holds no more.
    pub off: Option<Condition>,
    /// It counts instead, one further each time that what `on` compares has grown by this, and never back.
    pub every: Option<Scalar>,
    /// Whether it is on at the start; where it is not said, whether `on` holds there and `off` does not.
    pub starts: Option<bool>,
    /// Where it stands in the file.
    pub span: Span,
}
