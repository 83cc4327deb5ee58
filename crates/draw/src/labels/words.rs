//! A line of text that is to be placed by the middle of the room it takes.

use super::room::Room;
use crate::scene::{Align, Point, Text};
use crate::text::{height, width};
use kempe_number::math::atan2;

/// A line of text with its size.
#[derive(Clone, Debug)]
pub(crate) struct Words {
    /// What it says.
    pub content: String,
    /// Font size, mm.
    pub size: f64,
    /// Half the width and height of its room, mm.
    pub half: Point,
    /// From its base line up to the middle of its room, mm.
    pub rise: f64,
}

impl Words {
    /// Measures a line of text.
    pub fn new(content: impl Into<String>, size: f64) -> Words {
        let content = content.into();
        let [below, above] = height(&content, size);
        Words {
            half: [width(&content, size) / 2.0, (above + below) / 2.0],
            rise: (above - below) / 2.0,
            content,
            size,
        }
    }

    /// The text in its room, with a rim.
    pub fn text(&self, room: &Room) -> Text {
        let [c, s] = room.along;
        let at = [
            room.middle[0] + s * self.rise,
            room.middle[1] - c * self.rise,
        ];
        Text {
            halo: true,
            turn: atan2(s, c).to_degrees(),
            ..Text::new(at, self.size, self.content.clone()).aligned(Align::Middle)
        }
    }
}
