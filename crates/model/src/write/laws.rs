//! How a drive moves.

use kempe_units::{Dimension, Expr};

use crate::drive::{Drive, LawPiece};
use crate::ids::Scalar;
use crate::item::Item;
use crate::read::laws::rate;
use crate::write::spelling::Writer;

impl Writer<'_> {
    /// The keys of a drive that say how it moves.
    pub fn law(&mut self, drive: &Drive, entries: &mut Vec<(String, Item)>) {
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        let from = self.scalar(&drive.law.from, drive.dimension);
        let to = |to: &Scalar| self.scalar(to, drive.dimension);
        let second = |duration: &Scalar| self.scalar(duration, Dimension::TIME);
        match drive.law.pieces.as_slice() {
            [LawPiece::Dwell { duration }] if is_zero(duration) => put("at", from),
            [LawPiece::Table { times, values, .. }] => {
                put("law", self.measured(drive, times, values));
            }
            pieces if (pieces.iter()).any(|p| matches!(p, LawPiece::Polynomials(_))) => {
                let parameters = self.model.parameter_values();
                let times = drive.law.knots(&parameters);
                let at = |t: &f64| drive.law.at(*t, &parameters);
                let values: Vec<f64> = times.iter().map(at).collect();
                put("law", self.measured(drive, &times, &values));
            }
            [LawPiece::ConstantSpeed { to: end, speed }] => {
                put("from", from);
                put("to", to(end));
                put("speed", self.scalar(speed, rate(drive.dimension, 1)));
            }
            [
                LawPiece::ConstantAcceleration {
                    to: end,
                    acceleration,
                },
            ] => {
                put("from", from);
                put("to", to(end));
                put(
                    "acceleration",
                    self.scalar(acceleration, rate(drive.dimension, 2)),
                );
            }
            [
                LawPiece::Rise {
                    to: end,
                    duration,
                    by,
                },
            ] => {
                put("from", from);
                put("to", to(end));
                put("law", Item::text(by.name()));
                put("in", second(duration));
            }
            pieces => {
                put("from", from);
                let mut here = &drive.law.from;
                let pieces = pieces
                    .iter()
                    .map(|piece| self.piece(piece, &mut here, drive.dimension));
                put("law", Item::List(pieces.collect()));
            }
        }
    }

    fn piece<'l>(&self, piece: &'l LawPiece, here: &mut &'l Scalar, dimension: Dimension) -> Item {
        let mut entries = Vec::new();
        let mut put = |key: &str, item: Item| entries.push((key.to_owned(), item));
        let mut end = |put: &mut dyn FnMut(&str, Item), to: &'l Scalar| {
            let (key, value) = by_how_much(here, to);
            put(key, self.scalar(value, dimension));
            *here = to;
        };
        match piece {
            LawPiece::Dwell { duration } => put("dwell", self.scalar(duration, Dimension::TIME)),
            LawPiece::Rise { to, duration, by } => {
                end(&mut put, to);
                put("in", self.scalar(duration, Dimension::TIME));
                put("by", Item::text(by.name()));
            }
            LawPiece::ConstantSpeed { to, speed } => {
                end(&mut put, to);
                put("speed", self.scalar(speed, rate(dimension, 1)));
            }
            LawPiece::ConstantAcceleration { to, acceleration } => {
                end(&mut put, to);
                put(
                    "acceleration",
                    self.scalar(acceleration, rate(dimension, 2)),
                );
            }
            // measured points are a law of their own
            LawPiece::Table { .. } | LawPiece::Polynomials(_) => {}
        }
        Item::Table(entries)
    }

    /// Points of a drive, in a table beside the file.
    fn measured(&mut self, drive: &Drive, times: &[f64], values: &[f64]) -> Item {
        let head = value_head(drive.dimension);
        let table = self.table(&drive.name, &[("t [s]", times), (&head, values)]);
        Item::Table(vec![("table".to_owned(), table)])
    }

    /// Enters a table beside the file; its name there.
    pub fn table(&mut self, name: &str, columns: &[(&str, &[f64])]) -> Item {
        let mut one = crate::Tables::new();
        one.insert_columns("", columns);
        let text = one.get("").unwrap_or_default().to_owned();
        let names = (1..).map(|i: u32| match i {
            1 => format!("{name}.csv"),
            i => format!("{name}-{i}.csv"),
        });
        let free = |name: &String| self.tables.get(name).is_none_or(|known| known == text);
        let name = names.into_iter().find(free).unwrap_or_default();
        self.tables.insert(name.clone(), text);
        Item::Text(name)
    }
}

/// The head of a column of drive coordinates.
fn value_head(dimension: Dimension) -> String {
    let unit = kempe_units::Unit::for_display(dimension, &[]);
    format!("value [{unit}]")
}

fn is_zero(scalar: &Scalar) -> bool {
    matches!(scalar, Expr::Const(x) if *x == 0.0)
}

/// Whether a piece leads by so much further or back from where it starts, or to a place.
fn by_how_much<'s>(here: &Scalar, to: &'s Scalar) -> (&'static str, &'s Scalar) {
    match to {
        Expr::Add(start, by) if **start == *here => ("rise", by),
        Expr::Sub(start, by) if **start == *here => ("fall", by),
        to => ("to", to),
    }
}
