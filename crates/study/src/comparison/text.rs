//! A comparison in words: tables for terminals and pages.

use kempe_draw::report::{Block, Section};
use kempe_number::text::significant;

use super::{Axis, Comparison, Kind, Pair, StudyPair};
use crate::extremes::without_rounding;
use crate::result::Listing;
use crate::unit::SHORT_DIGITS;

/// Digits of a relative difference.
const PERCENT_DIGITS: usize = 3;

impl Comparison {
    /// What is beside what, in one line.
    pub fn headline(&self) -> String {
        format!("this: {}; against: {}", self.this, self.against)
    }

    /// What is to be said where all is the same.
    pub fn sameness(&self) -> Option<&'static str> {
        (!self.differs()).then_some("nothing differs: all numbers and extremes are the same")
    }

    /// The parameters that differ; `None` where none does.
    pub fn parameters_listing(&self) -> Option<Listing> {
        listing("Parameters that differ", "parameter", &self.parameters)
    }

    /// All of it as sections of a report.
    pub fn sections(&self) -> Vec<Section> {
        let mut first = vec![Block::Facts(vec![
            ("This".to_owned(), self.this.clone()),
            ("Against".to_owned(), self.against.clone()),
        ])];
        first.extend(
            self.sameness()
                .map(|text| Block::Paragraph(format!("{text}."))),
        );
        first.extend(self.parameters_listing().map(table));
        first.push(Block::Paragraph(
            "Differences are this design less the other one, in % of the other one's value."
                .to_owned(),
        ));
        let overview = Section {
            title: "Comparison".to_owned(),
            blocks: first,
        };
        let of_study = |study: &StudyPair| Section {
            title: format!("Comparison: {}", study.name),
            blocks: std::iter::once(Block::Paragraph(study.headline()))
                .chain(study.listings().into_iter().map(table))
                .collect(),
        };
        std::iter::once(overview)
            .chain(self.studies.iter().map(of_study))
            .collect()
    }
}

impl StudyPair {
    /// How many rows both have, or why there is nothing to compare.
    pub fn headline(&self) -> String {
        if !self.note.is_empty() {
            return self.note.clone();
        }
        let rows = self.rows.map(|rows| match rows {
            Some((all, 0)) => format!("{all} rows"),
            Some((all, missed)) => format!("{all} rows, {missed} not reached"),
            None => "no rows".to_owned(),
        });
        format!("{}, against {}", rows[0], rows[1])
    }

    /// Its numbers over the motion and the extremes of its columns, as tables.
    pub fn listings(&self) -> Vec<Listing> {
        let of = |kinds: &[Kind]| -> Vec<Pair> {
            let own = self.pairs.iter().filter(|p| kinds.contains(&p.kind));
            own.cloned().collect()
        };
        let numbers = of(&[Kind::Number]);
        let mut all: Vec<Listing> = Vec::new();
        all.extend(listing(
            "Numbers over the motion",
            "over the motion",
            &numbers,
        ));
        all.extend(self.extremes_listing(&of(&[Kind::Smallest, Kind::Largest])));
        all.extend(self.told.iter().map(|listing| Listing {
            title: format!("Of the other design: {}", listing.title),
            ..listing.clone()
        }));
        all
    }

    fn extremes_listing(&self, pairs: &[Pair]) -> Option<Listing> {
        let at = |axis: &Option<Axis>| match axis {
            Some(axis) => format!("at {}", headed(&axis.name, axis.unit.text())),
            None => "at".to_owned(),
        };
        let [at_this, at_against] = [at(&self.along[0]), at(&self.along[1])];
        let head = ["in the rows", "", "this", &at_this, "against", &at_against];
        let mut head = head.map(str::to_owned).to_vec();
        head.extend(DIFFERENCE.map(str::to_owned));
        let row = |pair: &Pair| {
            let [this, against] = [0, 1].map(|k: usize| shown(pair, pair.values[k]));
            let [here, there] = [0, 1].map(|k: usize| {
                pair.places[k].map_or_else(String::new, |v| significant(v, SHORT_DIGITS))
            });
            let kind = pair.kind.name().to_owned();
            let mut row = vec![name(pair), kind, this, here, against, there];
            row.extend(difference(pair));
            row
        };
        finished("Smallest and largest values in the rows", head, pairs, row)
    }
}

/// The heads of a difference.
const DIFFERENCE: [&str; 2] = ["difference", "in %"];

/// Pairs without places as a table.
fn listing(title: &str, first: &str, pairs: &[Pair]) -> Option<Listing> {
    let head = [first, "this", "against", DIFFERENCE[0], DIFFERENCE[1]];
    let row = |pair: &Pair| {
        let [this, against] = [0, 1].map(|k: usize| shown(pair, pair.values[k]));
        let mut row = vec![name(pair), this, against];
        row.extend(difference(pair));
        row
    };
    finished(title, head.map(str::to_owned).to_vec(), pairs, row)
}

/// A table of pairs; the reasons of missing values have a column where there are any.
fn finished(
    title: &str,
    mut head: Vec<String>,
    pairs: &[Pair],
    row: impl Fn(&Pair) -> Vec<String>,
) -> Option<Listing> {
    let noted = pairs.iter().any(|p| !p.note.is_empty());
    let row = |pair: &Pair| {
        let mut row = row(pair);
        row.extend(noted.then(|| pair.note.clone()));
        row
    };
    head.extend(noted.then(String::new));
    (!pairs.is_empty()).then(|| Listing {
        title: title.to_owned(),
        head,
        rows: pairs.iter().map(row).collect(),
    })
}

fn table(listing: Listing) -> Block {
    Block::Table {
        head: listing.head,
        rows: listing.rows,
    }
}

fn name(pair: &Pair) -> String {
    headed(&pair.name, pair.unit.text())
}

/// A name with its unit, where it has one.
fn headed(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

fn shown(pair: &Pair, value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| {
        significant(without_rounding(v, pair.size), SHORT_DIGITS)
    })
}

/// The difference, and in % where that has a meaning.
fn difference(pair: &Pair) -> [String; 2] {
    // Rounding is told as 0.
    let percent = |relative: f64| match pair.differs() {
        true => significant(100.0 * relative, PERCENT_DIGITS),
        false => "0".to_owned(),
    };
    let relative = pair.relative().map(percent);
    [shown(pair, pair.difference()), relative.unwrap_or_default()]
}
