//! What is told of a number, and how.

use kempe_number::text::significant;
use kempe_units::Unit;

use crate::designs::tolerance::linear::Linear;
use crate::designs::tolerance::rounding::ROUNDING;
use crate::designs::tolerance::summary::Summary;
use crate::designs::tolerance::worst::Worst;
use crate::quantity::Quantity;
use crate::unit::{SHORT_DIGITS, shown};

/// Digits of parts and of ratios.
pub(super) const FEW_DIGITS: usize = 4;
/// A parameter with less than this part of the variance is nothing beside the others.
pub(super) const NOTHING: f64 = 1e-4;

/// What is told of a number.
pub(super) struct Told<'t> {
    pub quantity: &'t Quantity,
    pub unit: Unit,
    pub linear: &'t Linear,
    pub sampled: Option<Summary>,
    pub worst: Option<&'t Worst>,
    /// The mechanism's size for a length, one for an angle; of other numbers it is not known what they are made of.
    pub scale: f64,
}

/// What is rounding of a number of this scale.
pub(super) fn rounding(linear: &Linear, sampled: Option<&Summary>, scale: f64) -> f64 {
    let mean = sampled.map_or(0.0, |it| it.mean.abs());
    ROUNDING * linear.own.abs().max(mean).max(scale)
}

impl Told<'_> {
    /// What is rounding of it.
    pub fn rounding(&self) -> f64 {
        rounding(self.linear, self.sampled.as_ref(), self.scale)
    }

    /// A value or a difference, nothing where it is rounding.
    fn above_rounding(&self, si: f64) -> f64 {
        let rounding = self.rounding();
        match si.abs() <= rounding && rounding.is_finite() {
            true => 0.0,
            false => si,
        }
    }

    pub fn value(&self, si: f64) -> f64 {
        shown(self.above_rounding(si), &self.unit)
    }

    /// A difference of two values.
    pub fn difference(&self, si: f64) -> f64 {
        self.unit.from_si(self.above_rounding(si)) - self.unit.from_si(0.0)
    }

    pub fn text(&self, si: f64) -> String {
        with_unit(self.value(si), &self.unit)
    }

    pub fn difference_text(&self, si: f64) -> String {
        with_unit(self.difference(si), &self.unit)
    }
}

pub(super) fn with_unit(value: f64, unit: &Unit) -> String {
    let text = format!("{} {}", significant(value, SHORT_DIGITS), unit.text());
    text.trim_end().to_owned()
}

pub(super) fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, FEW_DIGITS))
}
