//! Names of points: which have one, and how much of the joint below they keep clear of.

use super::names::around_disc;
use super::wanted::{Choice, Spot, Wanted, leader};
use super::words::Words;
use crate::context::{Anchor, Context};
use crate::scene::{Item, Point};
use crate::symbols::PIN;
use crate::text::shortened;
use crate::tokens::Token;

/// Font size, mm.
const SIZE: f64 = 3.6;
/// Longest name, mm.
const LONGEST: f64 = 30.0;
/// From the symbol of a joint to its name, mm.
const GAP: f64 = 0.65;
/// How far the corners of a slider's block are from its pin, about, mm.
const BLOCK: f64 = 3.2;

/// A point with its name.
pub(crate) struct Named {
    /// The point.
    pub index: usize,
    /// Its name.
    words: Words,
    token: Token,
    /// Radius of its symbol, mm.
    rim: f64,
}

/// The points whose names are shown.
pub(crate) fn named(context: &Context) -> Vec<Named> {
    let points = context.view.points.iter().enumerate();
    let named = points.filter_map(|(index, name)| {
        let role = context.roles.point(index);
        if name.is_empty() || role.carriers.is_empty() || role.only_guides() {
            return None;
        }
        let rings = role.carriers.len().saturating_sub(2).min(4) as f64;
        Some(Named {
            index,
            words: Words::new(shortened(name, SIZE, LONGEST), SIZE),
            token: match role.carriers == [0] {
                true => Token::Muted,
                false => Token::Ink,
            },
            rim: match role.slides {
                true => BLOCK,
                false => PIN + 0.8 * rings,
            },
        })
    });
    named.collect()
}

impl Named {
    /// Where the name may stand when its point lies there: at most so many ways.
    pub fn wanted(&self, places: &[Option<Point>], most: usize) -> Wanted {
        Wanted {
            choices: self.choices(places).take(most).collect(),
            optional: false,
        }
    }

    fn choices(&self, places: &[Option<Point>]) -> impl Iterator<Item = Choice> {
        around_disc(places, [self.rim + GAP, self.rim + 0.3], self.words.half)
    }

    /// What moves with the point when the name has been given that place.
    pub fn items(&self, choice: usize) -> Option<(Anchor, Vec<Item>)> {
        let spot = self.choices(&[Some([0.0; 2])]).nth(choice)?.spots.pop()??;
        Some((Anchor::Point(self.index), self.drawn(&spot)))
    }

    /// The name at a place.
    pub fn drawn(&self, spot: &Spot) -> Vec<Item> {
        let mut items: Vec<Item> = (spot.lines.iter())
            .map(|line| leader(*line, Token::Muted))
            .collect();
        items.push(Item::Text(self.words.text(&spot.room).colored(self.token)));
        items
    }
}
