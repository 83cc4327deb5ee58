//! Units made of the table's: products, quotients and powers, and values written in them.

use kempe_number::text::{rounded, shortest};
use std::fmt;
use std::str::FromStr;

use crate::issue::SyntaxError;
use crate::unit_table::{UnitDefinition, find};
use crate::{Dimension, parser};

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
    /// The unit written `text`: `mm`, `rad/s`, `N m`, `kg*mm^2`, `kg mm²`, `1/s`, or `1` for plain numbers.
    ///
    /// # Errors
    ///
    /// An issue `unknown-unit` or `syntax`, its span in `text`.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::{Dimension, Unit};
    /// let unit = Unit::parse("kg*mm²").unwrap();
    /// assert_eq!(unit.text(), "kg mm^2");
    /// assert_eq!(unit.dimension(), Dimension::INERTIA);
    /// assert_eq!(unit.to_si(500.0), 5e-4);
    /// ```
    pub fn parse(text: &str) -> Result<Self, SyntaxError> {
        parser::parse_unit_alone(text)
    }

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

    /// The unit a table or a message shows a quantity of `dimension` in, given the `preferred` units of the file
    /// (at most one per dimension, say `mm` and `deg`; the first of several wins).
    ///
    /// A preferred unit of just this dimension is taken first; then the unit mechanics uses (N, N m, W, kg m^2, …,
    /// which do not change with the preferred length); else a product of base units, each the preferred one of its
    /// dimension or kg, m, rad, s: `mm/s`, `deg/s^2`. There is no unit for broken exponents: the answer is
    /// [`Unit::one`], and the SI value is shown.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::{Dimension, Unit};
    /// let file = [Unit::parse("mm").unwrap(), Unit::parse("deg").unwrap()];
    /// assert_eq!(Unit::for_display(Dimension::ANGULAR_SPEED, &file).text(), "deg/s");
    /// assert_eq!(Unit::for_display(Dimension::SPEED, &file).text(), "mm/s");
    /// assert_eq!(Unit::for_display(Dimension::TORQUE, &file).text(), "N m");
    /// assert_eq!(Unit::for_display(Dimension::ANGULAR_MOMENTUM, &file).text(), "N m s");
    /// ```
    pub fn for_display(dimension: Dimension, preferred: &[Self]) -> Self {
        if let Some(unit) = preferred.iter().find(|unit| unit.dimension == dimension) {
            return unit.clone();
        }
        if let Some((_, text)) = MECHANICS.iter().find(|(named, _)| *named == dimension) {
            return Self::parse(text).unwrap_or_else(|_| Self::one());
        }
        let shown = dimension.without_idle_angle();
        if shown != dimension {
            return Self::for_display(shown, preferred);
        }
        let bases = [
            (Dimension::MASS, "kg", dimension.mass),
            (Dimension::LENGTH, "m", dimension.length),
            (Dimension::ANGLE, "rad", dimension.angle),
            (Dimension::TIME, "s", dimension.time),
        ];
        let mut text = String::new();
        for (base, si, sixths) in bases {
            if sixths == 0 {
                continue;
            }
            let power = sixths / 6;
            if sixths % 6 != 0 || i32::from(power).abs() > MAX_UNIT_POWER {
                return Self::one();
            }
            let symbol = preferred
                .iter()
                .find(|unit| unit.dimension == base && find(&unit.text).is_some())
                .map_or(si, |unit| unit.text.as_str());
            text.push_str(&format!("{symbol}^{power} "));
        }
        // The text of products and negative powers is put into its common form by parsing.
        Self::parse(text.trim_end()).unwrap_or_else(|_| Self::one())
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

/// Units with a name or a usual product, for display.
const MECHANICS: &[(Dimension, &str)] = &[
    (Dimension::FORCE, "N"),
    (Dimension::TORQUE, "N m"),
    (Dimension::POWER, "W"),
    (Dimension::PRESSURE, "Pa"),
    (Dimension::INERTIA, "kg m^2"),
    (Dimension::STIFFNESS, "N/m"),
    (Dimension::TORSIONAL_STIFFNESS, "N m/rad"),
    (Dimension::DAMPING, "N s/m"),
    (Dimension::TORSIONAL_DAMPING, "N m s/rad"),
    (Dimension::MOMENTUM, "N s"),
    (Dimension::ANGULAR_MOMENTUM, "N m s"),
    (Dimension::DENSITY, "kg/m^3"),
    (Dimension::LINEAR_DENSITY, "kg/m"),
    (Dimension::FREQUENCY, "Hz"),
];

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.text)
    }
}

impl FromStr for Unit {
    type Err = SyntaxError;
    fn from_str(text: &str) -> Result<Self, SyntaxError> {
        Self::parse(text)
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
