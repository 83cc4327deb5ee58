//! Units made of the table's: products, quotients and powers, and values written in them.

use kempe_number::text::{rounded, shortest};
use std::fmt;

use crate::Dimension;
use crate::unit_table::UnitDefinition;

/// The largest whole power of a unit.
pub(crate) const MAX_UNIT_POWER: i32 = 12;

/// A unit: a product of powers of the table's units, such as `kg mm^2` or `m/s^2`.
///
/// Its text is in one form whatever was written: factors in the order of writing, divisions after products. Parsing
/// the text gives the same unit again.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    text: String,
    dimension: Dimension,
    numerator: f64,
    denominator: f64,
}

impl Unit {
    /// The unit of plain numbers.
    pub fn one() -> Self {
        Self::from_factors(&[])
    }

    /// The product of powers of the table's units.
    pub(crate) fn from_factors(factors: &[(&'static UnitDefinition, i32)]) -> Self {
        let mut unit = Self {
            text: String::new(),
            dimension: Dimension::NONE,
            numerator: 1.0,
            denominator: 1.0,
        };
        let has_product = factors.iter().any(|(_, power)| *power > 0);
        let products = factors.iter().filter(|(_, power)| *power > 0);
        let divisions = factors.iter().filter(|(_, power)| *power < 0);
        for (definition, power) in products.chain(divisions) {
            let separator = match (unit.text.is_empty(), *power < 0 && has_product) {
                (true, _) => "",
                (false, true) => "/",
                (false, false) => " ",
            };
            let shown = if has_product { power.abs() } else { *power };
            unit.text.push_str(separator);
            unit.text.push_str(definition.symbol);
            if shown != 1 {
                unit.text.push_str(&format!("^{shown}"));
            }
            for _ in 0..power.abs() {
                let (up, down) = (definition.numerator, definition.denominator);
                if *power > 0 {
                    unit.numerator *= up;
                    unit.denominator *= down;
                    unit.dimension = unit.dimension * definition.dimension;
                } else {
                    unit.numerator *= down;
                    unit.denominator *= up;
                    unit.dimension = unit.dimension / definition.dimension;
                }
            }
        }
        unit
    }

    /// The unit as text, in the form that [`Unit`] describes; empty for plain numbers.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it measures.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// One of the unit in SI.
    pub fn factor(&self) -> f64 {
        self.numerator / self.denominator
    }

    /// The SI value of `value` of the unit: two roundings at most, one where the factor is 1 over a whole number.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.numerator / self.denominator
    }

    /// The value in this unit of the SI value `si`.
    pub fn from_si(&self, si: f64) -> f64 {
        si * self.denominator / self.numerator
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.text)
    }
}

/// The value `si` in `unit`, rounded to `digits` significant digits (at least one, at most 17), without idle zeros.
///
/// # Example
///
/// ```
/// use kempe_units::{Unit, format_digits};
/// assert_eq!(format_digits(0.12, &Unit::parse("mm").unwrap(), 12), "120 mm");
/// assert_eq!(format_digits(0.5235987755982988, &Unit::parse("deg").unwrap(), 6), "30 deg");
/// ```
pub fn format_digits(si: f64, unit: &Unit, digits: usize) -> String {
    let number = shortest(rounded(unit.from_si(si), digits));
    if unit.text.is_empty() {
        number
    } else {
        format!("{number} {unit}")
    }
}
