//! What every symbol is made of: rigid parts, the widths of lines and bars, the colours of links.

use crate::context::Anchor;
use crate::scene::{Item, Layer};
use crate::tokens::Token;

/// Half the width of a bar, mm.
pub(crate) const BAR: f64 = 1.7;
/// Radius of a pin, mm.
pub(crate) const PIN: f64 = 1.25;
/// Width of outlines, mm.
pub(crate) const LINE: f64 = 0.35;

/// A rigid piece of the drawing, in mm from its anchor.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it belongs to.
    pub layer: Layer,
    /// To what it is fixed.
    pub anchor: Anchor,
    /// What it holds.
    pub items: Vec<Item>,
}

impl Part {
    pub(crate) fn new(layer: Layer, anchor: Anchor, items: Vec<Item>) -> Part {
        Part {
            layer,
            anchor,
            items,
        }
    }
}

/// The colour of a link: the frame's own, or the next of the series.
pub(crate) fn link_token(link: usize) -> Token {
    if link == 0 {
        Token::Ground
    } else {
        Token::Series(link - 1)
    }
}
