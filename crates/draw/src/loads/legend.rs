//! What the arrows mean: a force and a moment of round size, the roles, and what is not drawn as it is.

use super::arrow::{HEAD, TURN};
use super::{LoadRole, Quantity, Shape};
use crate::scene::{Group, Item, Layer, Text};
use crate::text::{shortened, width as text_width};
use crate::tokens::Token;
use crate::view::LoadUnit;
use kempe_number::text::{decade, power_of_ten};

/// Font size, mm.
const SIZE: f64 = 3.0;
/// Height of a line, mm.
const LINE: f64 = 5.8;
/// From the edge of the sheet to the text, mm.
const EDGE: f64 = 6.0;
/// Between two entries, mm.
const BETWEEN: f64 = 5.0;
/// Radius of the sample of a moment, mm.
const RADIUS: f64 = 2.5;

/// One sample with its text.
enum Entry {
    Force(f64, String),
    Moment(f64, String),
    Role(LoadRole),
    Note(String),
}

/// The legend: entries in lines.
pub(crate) struct Legend {
    lines: Vec<Vec<(f64, Entry)>>,
    width: f64,
}

impl Legend {
    /// Lays the legend out for a sheet of the given width, mm; forces and moments each with the unit that tells them.
    pub fn new(
        force: (&Option<Quantity>, &LoadUnit),
        moment: (&Option<Quantity>, &LoadUnit),
        length: f64,
        roles: &[LoadRole],
        labels: bool,
        not_finite: usize,
        width: f64,
    ) -> Legend {
        let mut samples = Vec::new();
        let ((force, in_force), (moment, in_moment)) = (force, moment);
        if let Some(q) = force {
            let round = below(0.75 * q.full, in_force);
            let text = in_force.text(round, 3);
            samples.push(Entry::Force(round / q.full * length, text));
        }
        if let Some(q) = moment {
            let round = below(0.75 * q.full, in_moment);
            let text = in_moment.text(round, 3);
            samples.push(Entry::Moment(round / q.full * TURN, text));
        }
        if force.is_some() && labels {
            samples.push(Entry::Note(
                "acting on the body named, tail at the point".into(),
            ));
        }
        let roles = roles.iter().map(|role| Entry::Role(*role)).collect();
        let quantities = [(force, in_force), (moment, in_moment)];
        let mut notes: Vec<Entry> = quantities
            .iter()
            .filter_map(|(q, u)| broken(q, u))
            .collect();
        notes.extend(dropped(&quantities));
        if not_finite > 0 {
            notes.push(Entry::Note(format!("not finite, not drawn: {not_finite}")));
        }
        let mut lines: Vec<Vec<(f64, Entry)>> = vec![Vec::new()];
        let mut x = EDGE;
        for section in [samples, roles, notes] {
            // what belongs together stands on one line where it has the room
            let whole: f64 = section.iter().map(|e| e.width(width) + BETWEEN).sum();
            let mut fresh = x + whole - BETWEEN > width - EDGE;
            for entry in section {
                let wide = entry.width(width);
                if (fresh || x + wide > width - EDGE) && x > EDGE {
                    lines.push(Vec::new());
                    x = EDGE;
                }
                fresh = false;
                if let Some(line) = lines.last_mut() {
                    line.push((x, entry));
                }
                x += wide + BETWEEN;
            }
        }
        Legend { lines, width }
    }

    /// Height, mm.
    pub fn height(&self) -> f64 {
        LINE * self.lines.len() as f64 + 1.0
    }

    /// The legend with its lower edge at a height, mm.
    pub fn group(&self, bottom: f64) -> Group {
        let top = bottom + self.height() - LINE;
        let line = |(number, line): (usize, &Vec<(f64, Entry)>)| {
            let y = top - LINE * number as f64;
            line.iter()
                .flat_map(|(x, entry)| entry.items(*x, y, self.width))
                .collect::<Vec<Item>>()
        };
        Group::new(
            Layer::LoadLegend,
            self.lines.iter().enumerate().flat_map(line).collect(),
        )
    }
}

/// From which size on arrows are broken.
fn broken(quantity: &Option<Quantity>, unit: &LoadUnit) -> Option<Entry> {
    let q = quantity.as_ref().filter(|q| q.capped())?;
    let (over, largest) = (unit.text(q.full, 3), unit.text(q.largest, 3));
    Some(Entry::Note(format!("broken: over {over}, up to {largest}")))
}

/// Below which sizes there are no arrows.
fn dropped(quantities: &[(&Option<Quantity>, &LoadUnit)]) -> Option<Entry> {
    let least = |(q, unit): &(&Option<Quantity>, &LoadUnit)| {
        let q = q.as_ref().filter(|q| q.dropped)?;
        Some(unit.text(q.least * q.full, 2))
    };
    let all: Vec<String> = quantities.iter().filter_map(least).collect();
    (!all.is_empty()).then(|| Entry::Note(format!("not drawn: below {}", all.join(" or "))))
}

/// The largest of 1, 2, 5 times a power of ten of a unit up to a value, in SI as the value.
fn below(si: f64, unit: &LoadUnit) -> f64 {
    let value = si / unit.size();
    let power = power_of_ten(decade(value));
    let fits = |v: &f64| *v <= value * 1.0001;
    let rounds = [5.0, 2.0, 1.0].map(|m| m * power);
    rounds.into_iter().find(fits).unwrap_or(power) * unit.size()
}

impl Entry {
    fn text(&self) -> &str {
        match self {
            Entry::Force(_, text) | Entry::Moment(_, text) | Entry::Note(text) => text,
            Entry::Role(role) => role.title(),
        }
    }

    /// Width of the sample before the text, mm.
    fn sample(&self) -> f64 {
        match self {
            Entry::Force(length, _) => length + 1.6,
            Entry::Moment(..) => 2.0 * RADIUS + 2.2,
            Entry::Role(_) => 9.0 + 1.6,
            Entry::Note(_) => 0.0,
        }
    }

    fn width(&self, sheet: f64) -> f64 {
        (self.sample() + text_width(self.text(), SIZE)).min(sheet - 2.0 * EDGE)
    }

    fn items(&self, x: f64, y: f64, sheet: f64) -> Vec<Item> {
        let middle = y + 0.36 * SIZE;
        let arrow = |role: LoadRole, length: f64| {
            let shape = Shape::Force {
                tail: [x, middle],
                vector: [length.max(HEAD), 0.0],
                broken: false,
            };
            shape.items(role)
        };
        let mut items = match self {
            Entry::Force(length, _) => recolored(arrow(LoadRole::Reaction, *length)),
            Entry::Moment(sweep, _) => {
                let shape = Shape::Moment {
                    center: [x + RADIUS + 0.6, middle],
                    radius: RADIUS,
                    sweep: *sweep,
                    broken: false,
                };
                recolored(shape.items(LoadRole::Reaction))
            }
            Entry::Role(role) => arrow(*role, 9.0),
            Entry::Note(_) => Vec::new(),
        };
        let room = sheet - EDGE - x - self.sample();
        let text = shortened(self.text(), SIZE, room.max(8.0));
        let text = Text::new([x + self.sample(), y], SIZE, text).colored(Token::Muted);
        items.push(Item::Text(text));
        items
    }
}

/// In ink: a size that holds for every role.
fn recolored(items: Vec<Item>) -> Vec<Item> {
    let ink = |item| match item {
        Item::Shape { paths, mut style } => {
            for paint in [&mut style.fill, &mut style.stroke].into_iter().flatten() {
                paint.token = Token::Ink;
            }
            Item::Shape { paths, style }
        }
        other => other,
    };
    items.into_iter().map(ink).collect()
}
