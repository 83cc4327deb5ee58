//! The unit that a quantity is shown in.

use crate::Dimension;
use crate::unit::{MAX_UNIT_POWER, Unit};
use crate::unit_table::find;

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

impl Unit {
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
        if let Some(unit) = preferred.iter().find(|unit| unit.dimension() == dimension) {
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
                .find(|unit| unit.dimension() == base && find(unit.text()).is_some())
                .map_or(si, |unit| unit.text());
            text.push_str(&format!("{symbol}^{power} "));
        }
        // The text of products and negative powers is put into its common form by parsing.
        Self::parse(text.trim_end()).unwrap_or_else(|_| Self::one())
    }
}
