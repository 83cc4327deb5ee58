//! The units results are shown in: lengths and angles in the file's, angular rates in radians.

use kempe_model::{ForceMeasure, Leaf, Measure, Model, Statistic};
use kempe_number::text;
use kempe_units::{Dimension, Expr, Unit, format_digits};

/// Digits of what people read in a picture or a list.
pub(crate) const SHORT_DIGITS: usize = 6;
/// Digits of numbers that somebody wrote into a file: what was computed has more.
const WRITTEN_DIGITS: usize = 9;
/// Digits that rounding leaves to what was computed.
const LONG_DIGITS: usize = 12;
/// What differs by less than this part of the largest beside it is the same.
const SAME: f64 = 1e-12;
/// What is less than this part of the largest beside it is 0: places on a motion are located to it.
const NOTHING: f64 = 1e-14;

/// Chooses units for results.
#[derive(Clone, Debug)]
pub struct Units {
    length: Unit,
    angle: Unit,
    preferred: Vec<Unit>,
    /// Which of the model's measures are energies, as [`is_energy`] knows it.
    energies: Vec<Option<bool>>,
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
            energies: energies(model),
        }
    }

    /// The unit of a measure of a dimension. An energy and a torque have one dimension and two units.
    pub fn of_measure(&self, measure: &Measure, dimension: Dimension) -> Unit {
        match dimension == Dimension::TORQUE && is_energy(measure, &self.energies) == Some(true) {
            true => Unit::parse("J").unwrap_or_else(|_| self.unit(dimension)),
            false => self.unit(dimension),
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

    /// A value with its unit, as people read it: `117.512 deg`. What has few digits, because somebody wrote it, keeps them.
    pub fn text(&self, si: f64, dimension: Dimension) -> String {
        text_in(si, &self.unit(dimension))
    }

    /// A value with its unit, as it is to be written into a file: `117.512206517 deg`.
    pub fn written(&self, si: f64, dimension: Dimension) -> String {
        format_digits(si + 0.0, &self.unit(dimension), LONG_DIGITS)
    }

    /// Values that are read beside each other, each with its unit: in so many digits that different ones differ. What is
    /// nothing beside the others is 0.
    pub fn texts<const N: usize>(&self, si: [f64; N], dimension: Dimension) -> [String; N] {
        texts_in(si, &self.unit(dimension))
    }

    /// A range with its unit: `0 deg to 117.512 deg`.
    pub fn range_text(&self, si: (f64, f64), dimension: Dimension) -> String {
        let [from, to] = self.texts([si.0, si.1], dimension);
        format!("{from} to {to}")
    }

    /// A located place with its unit: `117.512 deg`. `range` is what it was looked for in: beside it a place at 0 is 0, and a
    /// place near one of its ends does not read like it.
    pub fn place_text(&self, si: f64, dimension: Dimension, range: (f64, f64)) -> String {
        let [place, ..] = self.texts([si, range.0, range.1], dimension);
        place
    }
}

/// A value in a unit, as [`Units::text`] writes it.
pub(crate) fn text_in(si: f64, unit: &Unit) -> String {
    let [text] = texts_in([si], unit);
    text
}

/// Values in a unit, as [`Units::texts`] writes them.
fn texts_in<const N: usize>(si: [f64; N], unit: &Unit) -> [String; N] {
    let values = si.map(|x| unit.from_si(x));
    let finite = values.iter().filter(|v| v.is_finite());
    let size = finite.fold(0.0, |size: f64, v| size.max(v.abs()));
    values.map(|value| {
        if value.abs() <= NOTHING * size {
            return format_digits(0.0, unit, 1);
        }
        let differs = |digits: &usize| {
            let own = readable(value, *digits);
            let mut others = values.iter().filter(|v| (**v - value).abs() > SAME * size);
            others.all(|other| readable(*other, *digits) != own)
        };
        let digits = (SHORT_DIGITS..LONG_DIGITS).find(differs);
        let number = readable(value, digits.unwrap_or(LONG_DIGITS));
        format_digits(unit.to_si(number), unit, LONG_DIGITS)
    })
}

/// A number of a table as people read it, without its unit.
pub(crate) fn number_text(value: f64) -> String {
    text::significant(readable(value, SHORT_DIGITS), LONG_DIGITS)
}

/// A number in `digits` digits; where it has hardly more, as somebody may have written it, in all of them.
fn readable(value: f64, digits: usize) -> f64 {
    let long = text::rounded(value, LONG_DIGITS);
    match text::rounded(value, WRITTEN_DIGITS) == long {
        true => long,
        false => text::rounded(value, digits),
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

/// Which measures of a model are energies: those that name others as well.
fn energies(model: &Model) -> Vec<Option<bool>> {
    let mut known = vec![None; model.measures.len()];
    loop {
        let all = model.measures.iter();
        let found: Vec<Option<bool>> = all.map(|it| is_energy(&it.measure, &known)).collect();
        if found == known {
            return known;
        }
        known = found;
    }
}

/// Whether a measure of an energy's dimension is one, or what one comes to over a motion, where this is known of those with a
/// name. Nothing is known of numbers and parameters: they are what stands beside them.
fn is_energy(measure: &Measure, named: &[Option<bool>]) -> Option<bool> {
    let of = |part: &Measure| is_energy(part, named);
    let all = |parts: &[&Measure]| {
        let known: Vec<bool> = parts.iter().filter_map(|part| of(part)).collect();
        (!known.is_empty()).then(|| known.iter().all(|energy| *energy))
    };
    match measure {
        Expr::Const(_) | Expr::Leaf(Leaf::Parameter(_)) => None,
        Expr::Leaf(Leaf::Force(ForceMeasure::KineticEnergy | ForceMeasure::PotentialEnergy)) => {
            Some(true)
        }
        Expr::Leaf(Leaf::Named(index)) => named.get(*index).copied().flatten(),
        Expr::Leaf(Leaf::Over(Statistic::TimeRatio, _)) => Some(false),
        Expr::Leaf(Leaf::Over(_, within)) => of(within),
        Expr::Neg(part) => of(part),
        Expr::Mul(a, b) | Expr::Div(a, b) if of(b).is_none() => of(a),
        Expr::Mul(a, b) if of(a).is_none() => of(b),
        Expr::Add(..) | Expr::Sub(..) | Expr::Call(..) => all(&measure.children()),
        _ => Some(false),
    }
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
        assert_eq!(place(117.512_206_516_641_08), "117.512 deg");
        assert_eq!(place(359.999_999_99), "359.99999999 deg", "not the end");
        assert_eq!(place(3.0e-12), "0 deg");
        assert_eq!(place(180.0), "180 deg");
        assert_eq!(place(-0.001), "-0.001 deg");
        assert_eq!(mm.text(-0.0, Dimension::LENGTH), "0 mm");
        let near = mm.place_text(1e-9, Dimension::LENGTH, (0.0, 1e-8));
        assert_eq!(near, "1e-6 mm");
    }

    #[test]
    fn different_values_read_differently_and_what_was_written_stays() {
        let mm = units("mm", "deg");
        let range =
            |a: f64, b: f64| mm.range_text((a.to_radians(), b.to_radians()), Dimension::ANGLE);
        assert_eq!(range(-0.0, 117.512_206_517), "0 deg to 117.512 deg");
        assert_eq!(
            range(109.127_236_027, 228.943_762_433),
            "109.127 deg to 228.944 deg"
        );
        assert_eq!(
            range(228.943_762_433, 109.127_236_027),
            "228.944 deg to 109.127 deg"
        );
        assert_eq!(range(-2.597_835_160_91, -0.01), "-2.59784 deg to -0.01 deg");
        assert_eq!(range(133.263_293, 360.0), "133.263293 deg to 360 deg");
        assert_eq!(
            range(89.999_999_9, 90.000_000_123_4),
            "89.9999999 deg to 90 deg"
        );
        assert_eq!(range(3.0e-15, 360.0), "0 deg to 360 deg");
        let [a, b] = mm.texts(
            [90.0_f64, 90.000_000_34].map(f64::to_radians),
            Dimension::ANGLE,
        );
        assert_eq!((a.as_str(), b.as_str()), ("90 deg", "90.0000003 deg"));
        assert_eq!(mm.text(1.0 / 3.0, Dimension::LENGTH), "333.333 mm");
        assert_eq!(mm.text(f64::NAN, Dimension::LENGTH), "NaN mm");
        assert_eq!(
            mm.range_text((f64::NEG_INFINITY, 1.0), Dimension::LENGTH),
            "-inf mm to 1000 mm"
        );
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
