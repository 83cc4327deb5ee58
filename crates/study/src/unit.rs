//! The units results are shown in: lengths and angles in the file's, angular rates in radians.

use kempe_model::Model;
use kempe_units::{Dimension, Unit, format_digits};

/// Digits to which places on a motion are located.
const PLACE_DIGITS: i32 = 14;
/// Digits of what people read in a picture or a list.
pub(crate) const SHORT_DIGITS: usize = 6;

/// Chooses units for results.
#[derive(Clone, Debug)]
pub struct Units {
    length: Unit,
    angle: Unit,
    preferred: Vec<Unit>,
}

impl Units {
    /// The units of a model's results.
    pub fn of(model: &Model) -> Self {
        let parse = |name: &str, or: &str| {
            Unit::parse(name)
                .or_else(|_| Unit::parse(or))
                .unwrap_or_else(|_| Unit::one())
        };
        let length = parse(&model.units.length.name, "m");
        let angle = parse(&model.units.angle.name, "rad");
        let rad = parse("rad", "rad");
        let mut preferred = vec![length.clone(), rad];
        let more = model.units.more.iter();
        preferred.extend(more.filter_map(|unit| Unit::parse(&unit.name).ok()));
        Self {
            preferred,
            length,
            angle,
        }
    }

    /// The unit of a dimension: lengths and angles in the file's units; rates of angles and derivatives to angles in
    /// radians (`rad/s`, `mm/rad`); force-like quantities in the file's units for them, or in SI.
    pub fn unit(&self, dimension: Dimension) -> Unit {
        if dimension == Dimension::ANGLE {
            return self.angle.clone();
        }
        if dimension == Dimension::LENGTH {
            return self.length.clone();
        }
        // A derivative to an angle, or of an angle to a length, keeps its radian in sight.
        let derivative = dimension.mass == 0
            && dimension.angle != 0
            && (dimension.angle < 0 || dimension.length <= 0)
            && dimension.angle % 6 == 0
            && dimension.length % 6 == 0
            && dimension.time % 6 == 0;
        if derivative {
            let text = [
                (self.length.text(), dimension.length),
                ("rad", dimension.angle),
                ("s", dimension.time),
            ]
            .iter()
            .filter(|(_, sixths)| *sixths != 0)
            .map(|(unit, sixths)| format!("{unit}^{}", sixths / 6))
            .collect::<Vec<_>>()
            .join(" ");
            if let Ok(unit) = Unit::parse(&text) {
                return unit;
            }
        }
        Unit::for_display(dimension, &self.preferred)
    }

    /// A value with its unit, to 12 digits: `117.512206517 deg`.
    pub fn text(&self, si: f64, dimension: Dimension) -> String {
        // A rounded negative zero is a zero.
        format_digits(si + 0.0, &self.unit(dimension), 12)
    }

    /// A value with its unit, in as many digits as people read in a picture or a list.
    pub fn short(&self, si: f64, dimension: Dimension) -> String {
        format_digits(si + 0.0, &self.unit(dimension), SHORT_DIGITS)
    }

    /// A located place with its unit, to the digits that rounding leaves it: `117.51220651664 deg`. They are counted from
    /// the size of `range`, what the place was looked for in, so that a place at 0 is 0.
    pub fn place_text(&self, si: f64, dimension: Dimension, range: (f64, f64)) -> String {
        let unit = self.unit(dimension);
        let [at, low, high] = [si, range.0, range.1].map(|v| unit.from_si(v));
        let size = [low, high].into_iter().filter(|v| v.is_finite());
        let size = size.fold(at.abs(), |size, v| size.max(v.abs()));
        let decimals = PLACE_DIGITS - 1 - kempe_number::text::decade(size);
        let rounded = match usize::try_from(decimals) {
            Ok(decimals) => format!("{at:.decimals$}").parse().unwrap_or(at),
            Err(_) => at,
        };
        format_digits(unit.to_si(rounded) + 0.0, &unit, PLACE_DIGITS as usize)
    }
}

/// The value of `si` in `unit`, where rounding it to 15 digits loses nothing the rounded one: 30 for 30 degrees given in
/// radians, not 29.999999999999996.
pub fn shown(si: f64, unit: &Unit) -> f64 {
    let plain = unit.from_si(si);
    let round = rounded(plain);
    if (unit.to_si(round) - si).abs() <= 4.0 * f64::EPSILON * si.abs() {
        round
    } else {
        plain
    }
}

/// A number rounded to 15 significant digits.
pub(crate) fn rounded(value: f64) -> f64 {
    kempe_number::text::rounded(value, 15)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(length: &str, angle: &str) -> Units {
        let text = format!(
            "units = {{ length = \"{length}\", angle = \"{angle}\" }}\n[links]\nframe = {{ A = [0, 0] }}\ncrank = {{ A-B = 1 }}\n"
        );
        let model = Model::from_toml(&text, "x", &mut |_| Err(String::new())).unwrap();
        Units::of(&model.model)
    }

    #[test]
    fn columns_are_in_the_units_of_the_file_and_angular_rates_in_radians() {
        let mm = units("mm", "deg");
        let name = |d: Dimension| mm.unit(d).text().to_owned();
        let per_rad = |d: Dimension| d / Dimension::ANGLE;
        assert_eq!(name(Dimension::LENGTH), "mm");
        assert_eq!(name(Dimension::SPEED), "mm/s");
        assert_eq!(name(Dimension::ACCELERATION), "mm/s^2");
        assert_eq!(name(Dimension::ANGLE), "deg");
        assert_eq!(name(Dimension::ANGULAR_SPEED), "rad/s");
        assert_eq!(name(Dimension::ANGULAR_ACCELERATION), "rad/s^2");
        assert_eq!(name(per_rad(Dimension::LENGTH)), "mm/rad");
        assert_eq!(name(per_rad(per_rad(Dimension::LENGTH))), "mm/rad^2");
        assert_eq!(name(Dimension::ANGLE / Dimension::LENGTH), "rad/mm");
        assert_eq!(name(Dimension::CURVATURE), "mm^-1");
        assert_eq!(name(Dimension::NONE), "");
        assert_eq!(name(Dimension::FORCE), "N");
        assert_eq!(name(Dimension::TORQUE), "N m");
        assert_eq!(name(Dimension::TIME), "s");
        assert_eq!(
            name(Dimension::ANGULAR_SPEED * Dimension::LENGTH),
            "mm/s",
            "a speed, whatever it is made of"
        );
    }

    #[test]
    fn places_have_the_digits_of_their_range_and_zero_is_zero() {
        let mm = units("mm", "deg");
        let turn = std::f64::consts::TAU;
        let place = |deg: f64| mm.place_text(deg.to_radians(), Dimension::ANGLE, (0.0, turn));
        assert_eq!(place(4.972_161_733_623_2e-13), "0 deg");
        assert_eq!(place(-4.972_161_733_623_2e-13), "0 deg");
        assert_eq!(place(117.512_206_516_641_08), "117.51220651664 deg");
        assert_eq!(place(180.0), "180 deg");
        assert_eq!(place(-0.001), "-0.001 deg");
        assert_eq!(mm.text(-0.0, Dimension::LENGTH), "0 mm");
        let near = mm.place_text(1e-9, Dimension::LENGTH, (0.0, 1e-8));
        assert_eq!(near, "1e-6 mm");
    }

    #[test]
    fn round_values_are_shown_round() {
        let deg = Unit::parse("deg").unwrap();
        for k in 0..=3600 {
            let value = rounded(f64::from(k) * 0.1);
            assert_eq!(shown(deg.to_si(value), &deg), value);
        }
        let odd = deg.to_si(117.512_206_516_641_08);
        assert!((shown(odd, &deg) - 117.512_206_516_641_08).abs() < 1e-13);
        assert!(shown(f64::NAN, &deg).is_nan());
    }
}
