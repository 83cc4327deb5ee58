//! Lines of text.

use super::path::Point;
use super::style::Paint;
use crate::tokens::Token;

/// Where text stands from its point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Starts there.
    #[default]
    Start,
    /// Centred there.
    Middle,
    /// Ends there.
    End,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where its base line is held.
    pub at: Point,
    /// Font size, mm.
    pub size: f64,
    /// What it says.
    pub content: String,
    /// Which part of it is at the point.
    pub align: Align,
    /// Turned counter-clockwise by so many degrees.
    pub turn: f64,
    /// Colour.
    pub paint: Paint,
    /// Heavier.
    pub bold: bool,
    /// A rim in the colour of the paper, to stay readable over lines.
    pub halo: bool,
}

impl Text {
    /// Plain text in ink.
    pub fn new(at: Point, size: f64, content: impl Into<String>) -> Text {
        Text {
            at,
            size,
            content: content.into(),
            align: Align::Start,
            turn: 0.0,
            paint: Token::Ink.into(),
            bold: false,
            halo: false,
        }
    }

    /// The same, aligned otherwise.
    pub fn aligned(mut self, align: Align) -> Text {
        self.align = align;
        self
    }

    /// The same, in another colour.
    pub fn colored(mut self, token: Token) -> Text {
        self.paint = token.into();
        self
    }
}
