//! Two designs beside each other: their parameters, their numbers over the motion, and the extremes of their columns.

mod matched;
mod text;

use std::f64::consts::PI;

use kempe_model::{Diagnostic, Model};
use kempe_number::math::within_half_a_turn;
use kempe_units::{Dimension, Unit, format_digits};

use crate::extremes::{Extreme, Extremes, Sizes, extremes, extremes_of, without_rounding};
use crate::result::{Listing, StudyOutcome, StudyResult};
use crate::unit::{SHORT_DIGITS, Units};

pub(crate) use matched::Matched;

/// A design that was run.
#[derive(Clone, Copy, Debug)]
pub struct Design<'a> {
    /// What it is called, such as `four-bar.toml with a=25mm`.
    pub name: &'a str,
    /// Its model.
    pub model: &'a Model,
    /// Its studies with what became of them.
    pub outcomes: &'a [StudyOutcome<'a>],
}

impl<'a> Design<'a> {
    /// The result of a study of this name.
    pub fn result(&self, study: &str) -> Option<&'a StudyResult> {
        let outcome = self.outcomes.iter().find(|o| o.study.name == study)?;
        outcome.result.as_ref().ok()
    }

    /// Why a study of this name that was begun has no result.
    fn failure(&self, study: &str) -> Option<&'a [Diagnostic]> {
        let outcome = self.outcomes.iter().find(|o| o.study.name == study)?;
        outcome.result.as_ref().err().map(Vec::as_slice)
    }
}

/// Two designs beside each other. Differences are those of this design from the other one.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// What this design is called.
    pub this: String,
    /// What the other one is called.
    pub against: String,
    /// The parameters that differ, or that only one of both has.
    pub parameters: Vec<Pair>,
    /// The studies that ran, or were to run, of either.
    pub studies: Vec<StudyPair>,
}

/// A study of both designs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StudyPair {
    /// Its name.
    pub name: String,
    /// How many rows it has in this and in the other design, and how many of them were not reached; `None` where it did not run.
    pub rows: [Option<(usize, usize)>; 2],
    /// The quantity that the rows run along in this and in the other design.
    pub along: [Option<Axis>; 2],
    /// Its numbers over the motion, then the smallest and largest values of its columns.
    pub pairs: Vec<Pair>,
    /// What the other design's study tells in words, where this one's tells something else.
    pub told: Vec<Listing>,
    /// Why there is nothing to compare, where one of both has no such result; may be empty.
    pub note: String,
}

/// A quantity that rows run along.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
}

/// What a pair of numbers is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// A parameter.
    Parameter,
    /// A number over the whole motion.
    Number,
    /// The smallest value of a column in its rows.
    Smallest,
    /// The largest value of a column in its rows.
    Largest,
}

impl Kind {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Number => "number",
            Self::Smallest => "smallest",
            Self::Largest => "largest",
        }
    }
}

/// One number of both designs, in one unit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pair {
    /// What it is.
    pub kind: Kind,
    /// Name of the parameter, the number or the column.
    pub name: String,
    /// The unit of all its values: that of this design where it has one.
    pub unit: Unit,
    /// The value of this and of the other design; `None` where that has none, NaN where it is not known.
    pub values: [Option<f64>; 2],
    /// Of an extreme, where it stands in this and in the other design, each in the unit of its [`StudyPair::along`].
    pub places: [Option<f64>; 2],
    /// The size of the numbers it is one of: what is 1e-12 of it is rounding.
    pub size: f64,
    /// Why a value or the difference is missing, or how the difference is to be read; may be empty.
    pub note: String,
}

impl Pair {
    /// This design's value less the other one's, in the unit; `None` where one of both is missing or is not finite.
    pub fn difference(&self) -> Option<f64> {
        let [this, against] = self.values;
        let difference = this? - against?;
        difference.is_finite().then_some(difference)
    }

    /// The difference in parts of the other design's value. `None` where that has no meaning: the other one's is zero up to
    /// rounding or has another sign, or the value is an angle or a coordinate that is counted from anywhere.
    pub fn relative(&self) -> Option<f64> {
        let (difference, [this, against]) = (self.difference()?, self.values);
        let (this, against) = (self.plain(this?), self.plain(against?));
        let extreme = matches!(self.kind, Kind::Smallest | Kind::Largest);
        let counted = extreme && self.unit.dimension() == Dimension::ANGLE;
        (!counted && against != 0.0 && this * against >= 0.0).then(|| difference / against.abs())
    }

    /// Whether the values differ by more than rounding, or one of them is missing.
    pub fn differs(&self) -> bool {
        match self.values {
            [Some(this), Some(against)] if this.is_nan() && against.is_nan() => false,
            [Some(this), Some(against)] if this == against => false,
            _ => self.difference().is_none_or(|d| self.plain(d) != 0.0),
        }
    }

    /// A value or a difference of it as people read it: rounding is 0.
    fn plain(&self, value: f64) -> f64 {
        without_rounding(value, self.size)
    }
}

impl StudyPair {
    /// Whether anything differs.
    pub fn differs(&self) -> bool {
        let told = !self.note.is_empty() || !self.told.is_empty();
        told || self.pairs.iter().any(Pair::differs)
    }
}

impl Comparison {
    /// Whether anything differs by more than rounding: a parameter, a number, an extreme, or what only one of both has.
    pub fn differs(&self) -> bool {
        !self.parameters.is_empty() || self.studies.iter().any(StudyPair::differs)
    }
}

/// Sets two designs beside each other. Studies, parameters and quantities belong together by their names; the other design's
/// values are converted into the units of this one's.
pub fn compare(this: &Design<'_>, against: &Design<'_>) -> Comparison {
    let mut names: Vec<&str> = Vec::new();
    let ran = this.outcomes.iter().chain(against.outcomes);
    let mut all: Vec<&str> = ran.map(|o| o.study.name.as_str()).collect();
    // Where all of this design is asked for, what the other one has besides is told.
    let asked = |name: &str| this.outcomes.iter().any(|o| o.study.name == name);
    if this.model.studies.iter().all(|s| asked(&s.name)) {
        all.extend(against.model.studies.iter().map(|s| s.name.as_str()));
    }
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let study = |name: &&str| study_pair(name, this, against);
    Comparison {
        this: this.name.to_owned(),
        against: against.name.to_owned(),
        parameters: parameters(this.model, against.model),
        studies: names.iter().map(study).collect(),
    }
}

/// A value with its unit.
type Told = (f64, Unit);

/// What only one of both has.
const ONLY: [&str; 2] = ["only in this design", "only in the other design"];

/// Puts two values into one unit.
fn pair(kind: Kind, name: &str, told: [Option<Told>; 2], sizes: [f64; 2]) -> Pair {
    let mut note = String::new();
    let (unit, values, size) = match told {
        [Some((this, unit)), Some((against, other))] if unit.dimension() == other.dimension() => {
            let converted = |value| converted(value, &other, &unit);
            let (against, size) = (converted(against), converted(sizes[1]));
            (unit, [Some(this), Some(against)], sizes[0].max(size))
        }
        [Some((this, unit)), Some((_, other))] => {
            note = format!("of another kind in the other design, in {}", or_one(&other));
            (unit, [Some(this), None], sizes[0])
        }
        [Some((this, unit)), None] => {
            note = ONLY[0].to_owned();
            (unit, [Some(this), None], sizes[0])
        }
        [None, Some((against, unit))] => {
            note = ONLY[1].to_owned();
            (unit, [None, Some(against)], sizes[1])
        }
        [None, None] => (Unit::one(), [None, None], 0.0),
    };
    if let ([Some(this), Some(against)], "") = (values, note.as_str()) {
        note = hint(kind, [this, against], &unit);
    }
    Pair {
        kind,
        name: name.to_owned(),
        unit,
        values,
        places: [None, None],
        size,
        note,
    }
}

/// Why two values have no difference, or how theirs is to be read.
fn hint(kind: Kind, [this, against]: [f64; 2], unit: &Unit) -> String {
    let without = |value: f64, whose: &str| match value {
        v if v.is_nan() => Some(format!("no value in {whose}")),
        v if v.is_infinite() => Some(format!("infinite in {whose}")),
        _ => None,
    };
    let lacks = [
        without(this, "this design"),
        without(against, "the other design"),
    ];
    let lacks: Vec<String> = lacks.into_iter().flatten().collect();
    if !lacks.is_empty() {
        return lacks.join(", ");
    }
    let apart = unit.to_si(this) - unit.to_si(against);
    let angle = kind != Kind::Parameter && unit.dimension() == Dimension::ANGLE;
    if !angle || apart.abs() <= PI {
        return String::new();
    }
    let rest = within_half_a_turn(apart);
    let rest = format_digits(rest + 0.0, unit, SHORT_DIGITS);
    format!("{rest} apart but for whole turns, which each design counts from its own start")
}

/// A value in another unit of its dimension; in the same one it stays as it is, to the bit.
pub(crate) fn converted(value: f64, from: &Unit, to: &Unit) -> f64 {
    match from == to {
        true => value,
        false => to.from_si(from.to_si(value)),
    }
}

fn or_one(unit: &Unit) -> &str {
    match unit.text() {
        "" => "plain numbers",
        text => text,
    }
}

/// The names of both lists, those of the first one first.
fn both_names<'n>(
    this: impl Iterator<Item = &'n str>,
    against: impl Iterator<Item = &'n str>,
) -> Vec<&'n str> {
    let mut names: Vec<&str> = this.collect();
    for name in against {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The parameters that differ.
fn parameters(this: &Model, against: &Model) -> Vec<Pair> {
    let told = |model: &Model, name: &str| -> Option<Told> {
        let index = model.parameters.iter().position(|p| p.name == name)?;
        let unit = Units::of(model).unit(model.parameters.get(index)?.dimension);
        let si = model.parameter_values().get(index).copied()?;
        Some((crate::unit::shown(si, &unit), unit))
    };
    let own = |model: &'_ Model| -> Vec<String> {
        model.parameters.iter().map(|p| p.name.clone()).collect()
    };
    let (of_this, of_against) = (own(this), own(against));
    let names = both_names(
        of_this.iter().map(String::as_str),
        of_against.iter().map(String::as_str),
    );
    let pairs = names.into_iter().map(|name| {
        let both = [told(this, name), told(against, name)];
        let sizes = [0, 1].map(|k: usize| both[k].as_ref().map_or(0.0, |(v, _)| v.abs()));
        pair(Kind::Parameter, name, both, sizes)
    });
    pairs.filter(Pair::differs).collect()
}

fn study_pair(name: &str, this: &Design<'_>, against: &Design<'_>) -> StudyPair {
    let results = [this.result(name), against.result(name)];
    let rows = results.map(|r| r.map(|r| (r.table.rows(), r.table.unreached())));
    let mut along = results.map(|r| {
        r.and_then(StudyResult::abscissa).map(|column| Axis {
            name: column.name.clone(),
            unit: column.unit.clone(),
        })
    });
    let mut pairs: Vec<Pair> = Vec::new();
    let mut note = String::new();
    match results {
        [Some(one), Some(two)] => {
            pairs.extend(numbers(one, two));
            pairs.extend(columns(one, two));
        }
        _ => note = missing(name, this, against),
    }
    if let [Some(one), Some(two)] = &mut along
        && one.name == two.name
        && one.unit.dimension() == two.unit.dimension()
    {
        let of_other = pairs.iter_mut().filter_map(|p| p.places[1].as_mut());
        of_other.for_each(|at| *at = converted(*at, &two.unit, &one.unit));
        two.unit = one.unit.clone();
    }
    let listings = results.map(|result| result.map_or(&[][..], |r| r.listings.as_slice()));
    let told = match listings {
        [this, against] if this != against => against.to_vec(),
        _ => Vec::new(),
    };
    StudyPair {
        name: name.to_owned(),
        rows,
        along,
        pairs,
        told,
        note,
    }
}

/// Why a study cannot be compared.
fn missing(name: &str, this: &Design<'_>, against: &Design<'_>) -> String {
    let has = |design: &Design<'_>| design.model.studies.iter().any(|s| s.name == name);
    let said = [(this, "this design"), (against, "the other design")].map(|(design, whose)| {
        let why = match design.result(name) {
            Some(_) => return None,
            None => match design.failure(name) {
                Some(found) if found.iter().any(|d| d.code == "stopped") => "it was stopped in",
                Some(_) => "it could not run in",
                None if has(design) => "it was not run in",
                None => "there is no such study in",
            },
        };
        Some(format!("{why} {whose}"))
    });
    let said: Vec<String> = said.into_iter().flatten().collect();
    format!("not compared: {}", said.join(", "))
}

/// The numbers over the motion.
fn numbers(this: &StudyResult, against: &StudyResult) -> Vec<Pair> {
    let told = |result: &StudyResult, name: &str| -> Option<Told> {
        let scalar = result.scalars.iter().find(|s| s.name == name)?;
        Some((scalar.value, scalar.unit.clone()))
    };
    let names = both_names(
        this.scalars.iter().map(|s| s.name.as_str()),
        against.scalars.iter().map(|s| s.name.as_str()),
    );
    let pairs = names.into_iter().map(|name| {
        let both = [told(this, name), told(against, name)];
        let sizes = [0, 1].map(|k: usize| both[k].as_ref().map_or(0.0, |(v, _)| v.abs()));
        let finite = sizes.map(|s: f64| if s.is_finite() { s } else { 0.0 });
        pair(Kind::Number, name, both, finite)
    });
    pairs.collect()
}

/// The extremes of the columns; those of the drive and the time only where they differ.
fn columns(this: &StudyResult, against: &StudyResult) -> Vec<Pair> {
    let running = running(this, against);
    let told: Vec<String> = running.iter().map(|p| p.name.clone()).collect();
    let mut pairs: Vec<Pair> = running.into_iter().filter(Pair::differs).collect();
    let (one, two) = (extremes(this), extremes(against));
    let of = |list: &'_ [Extremes<'_>], name: &str| list.iter().position(|e| e.column.name == name);
    let names = both_names(
        one.iter().map(|e| e.column.name.as_str()),
        two.iter().map(|e| e.column.name.as_str()),
    );
    for name in names {
        let both = [
            of(&one, name).map(|k| &one[k]),
            of(&two, name).map(|k| &two[k]),
        ];
        // What both run along, or one of them, has been told.
        if !told.iter().any(|t| t == name) {
            pairs.extend(extreme_pairs(name, both));
        }
    }
    pairs
}

/// The ends of the time and of the columns that the rows of one of both run along, where both have them.
fn running(this: &StudyResult, against: &StudyResult) -> Vec<Pair> {
    let along = [this, against].map(|result| result.abscissa().map_or("", |c| &c.name));
    let names = both_names(std::iter::once("time"), along.into_iter());
    let designs = [this, against].map(|result| {
        let places = result.abscissa().map_or(&[][..], |c| &c.values);
        (result, places, Sizes::of(&result.table.columns))
    });
    let pairs = names.into_iter().flat_map(|name| {
        let both = designs.each_ref().map(|(result, along, sizes)| {
            let column = result.table.column(name)?;
            Some(extremes_of(column, &result.table, along, sizes))
        });
        match &both {
            [Some(_), Some(_)] => extreme_pairs(name, [both[0].as_ref(), both[1].as_ref()]),
            _ => Vec::new(),
        }
    });
    pairs.collect()
}

/// The smallest and the largest value of a column in both designs.
fn extreme_pairs(name: &str, both: [Option<&Extremes<'_>>; 2]) -> Vec<Pair> {
    type Which = fn(&Extremes<'_>) -> Option<Extreme>;
    let kinds: [(Kind, Which); 2] = [
        (Kind::Smallest, |e| e.smallest),
        (Kind::Largest, |e| e.largest),
    ];
    let one = |(kind, which): (Kind, Which)| {
        let told = both.map(|extremes| {
            let extremes = extremes?;
            let value = which(extremes).map_or(f64::NAN, |e| e.value);
            Some((value, extremes.column.unit.clone()))
        });
        let sizes = both.map(|e| e.and_then(which).map_or(0.0, |e| e.size));
        let places = both.map(|e| Some(which(e?)?.at));
        let pair = pair(kind, name, told, sizes);
        // A value that is not told has no place.
        let told = |k: usize| pair.values[k].and(places[k]);
        Pair {
            places: [told(0), told(1)],
            ..pair
        }
    };
    kinds.map(one).to_vec()
}
