//! Numbers with their names and units: what every answer is made of.

use kempe_model::Diagnostic;
use kempe_study::{Quantity, Units, shown};
use kempe_units::{Dimension, Unit};

/// What is measured, and in which units it is told.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Heading {
    /// The measure as written, or a name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// The file's unit for it.
    pub unit: Unit,
    /// Its SI unit.
    pub si: Unit,
}

impl Heading {
    pub(crate) fn of(quantity: &Quantity, units: &Units) -> Self {
        Self {
            unit: quantity.unit(units),
            ..Self::new(&quantity.name, quantity.dimension, units)
        }
    }

    pub(crate) fn new(name: &str, dimension: Dimension, units: &Units) -> Self {
        Self {
            name: name.to_owned(),
            dimension,
            unit: units.unit(dimension),
            si: Unit::for_display(dimension, &[]),
        }
    }
}

/// One value with its unit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Value {
    /// What it is.
    pub heading: Heading,
    /// In SI.
    pub si: f64,
    /// What is to be told of the numbers over the motion in it: that one is infinite, or how many of its digits hold.
    pub warnings: Vec<Diagnostic>,
}

impl Value {
    /// In the file's unit.
    pub fn in_unit(&self) -> f64 {
        shown(self.si, &self.heading.unit)
    }
}

/// A column: one contiguous block of numbers in SI, one a row.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Block {
    /// What it is.
    pub heading: Heading,
    /// In SI; NaN where there is no value, and then the row has its reason.
    pub values: Vec<f64>,
}

impl Block {
    pub(crate) fn new(heading: Heading, room: usize) -> Self {
        Self {
            heading,
            values: Vec::with_capacity(room),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.heading.name
    }

    /// The values in the file's unit.
    pub fn in_unit(&self) -> Vec<f64> {
        (self.values.iter())
            .map(|si| shown(*si, &self.heading.unit))
            .collect()
    }
}

/// `count` numbers from `first` to `last`, evenly, both included.
///
/// ```
/// assert_eq!(kempe::linspace(0.0, 1.0, 5), [0.0, 0.25, 0.5, 0.75, 1.0]);
/// assert_eq!(kempe::linspace(0.3, 0.9, 3)[2], 0.9);
/// ```
pub fn linspace(first: f64, last: f64, count: usize) -> Vec<f64> {
    let steps = count.saturating_sub(1).max(1);
    (0..count)
        .map(|k| match k {
            k if k == steps => last,
            k => first + (last - first) * (k as f64 / steps as f64),
        })
        .collect()
}
