//! Reference values as they are written: a number with its digits and its unit.

use kempe_units::{Dimension, Unit};

/// A reference value.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// In its unit.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
    /// Half a unit of the last digit written; zero for numbers without a decimal point.
    pub half_digit: f64,
    /// As written, without the unit.
    pub text: String,
}

impl Reference {
    /// Reads `60.032348552120 deg`, `1.5e-3` or `14375`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let end = text
            .char_indices()
            .find(|(i, c)| {
                let exponent = matches!(c, 'e' | 'E')
                    && text[i + 1..]
                        .starts_with(|d: char| d.is_ascii_digit() || d == '-' || d == '+');
                !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.') || exponent)
            })
            .map_or(text.len(), |(i, _)| i);
        let (number, unit) = text.split_at(end);
        let unit = match unit.trim() {
            "" => Unit::one(),
            unit => Unit::parse(unit).map_err(|_| format!("`{unit}` is no unit"))?,
        };
        Self::new(number, unit)
    }

    /// A number as written, in a unit.
    pub fn new(number: &str, unit: Unit) -> Result<Self, String> {
        let number = number.trim();
        let value: f64 = number
            .parse()
            .map_err(|_| format!("`{number}` is no number"))?;
        if !value.is_finite() {
            return Err(format!("`{number}` is no reference"));
        }
        let (mantissa, exponent) = match number.split_once(['e', 'E']) {
            Some((m, e)) => (m, e.parse::<i32>().unwrap_or(0)),
            None => (number, 0),
        };
        let half_digit = mantissa.split_once('.').map_or(0.0, |(_, decimals)| {
            let digits = decimals.len() as i32;
            format!("0.5e{}", exponent - digits).parse().unwrap_or(0.0)
        });
        Ok(Self {
            value,
            unit,
            half_digit,
            text: number.to_owned(),
        })
    }
}

/// Whether ours can be given in the unit of a reference; or what both are.
pub(super) fn dimension_fits(dimension: Dimension, unit: &Unit) -> Result<(), String> {
    // Derivatives to angles and angular rates may be given with or without the radian.
    let bare = |d: Dimension| Dimension { angle: 0, ..d };
    let same = if dimension == Dimension::ANGLE || unit.dimension() == Dimension::ANGLE {
        dimension == unit.dimension()
    } else {
        bare(dimension) == bare(unit.dimension())
    };
    same.then_some(()).ok_or_else(|| {
        format!(
            "ours is {}, the reference {}",
            dimension.with_article(),
            unit.dimension().with_article()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_tell_how_good_a_reference_is() {
        let read = |t: &str| {
            let r = Reference::parse(t).unwrap();
            (r.value, r.unit.text().to_owned(), r.half_digit)
        };
        assert_eq!(read("60.0323 deg"), (60.0323, "deg".into(), 0.5e-4));
        assert_eq!(
            read("-7.401341942e-03"),
            (-7.401341942e-3, String::new(), 0.5e-12)
        );
        assert_eq!(read("14375 mm/s"), (14375.0, "mm/s".into(), 0.0));
        assert_eq!(read("0"), (0.0, String::new(), 0.0));
        assert!(Reference::parse("abc").is_err());
        assert!(Reference::parse("1.0 furlongs").is_err());
        assert!(Reference::parse("").is_err());
    }
}
