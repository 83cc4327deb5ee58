//! Numbers as text, the same on every target: short, without a negative zero, never `NaN`.

use std::borrow::Cow;

/// Text for people to read: signs that a terminal obeys or that do not show, besides line ends and tabulators, are written out as
/// `\u{1b}`.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match is_hidden(c) {
            true => out.extend(c.escape_unicode()),
            false => out.push(c),
        }
    }
    Cow::Owned(out)
}

/// Whether a sign moves what is shown instead of being shown: control characters, and those that turn the direction of writing.
pub fn is_hidden(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || (c.is_control() && c != '\n' && c != '\t')
}

/// `value` with at most `decimals` digits after the point, trailing zeros dropped; 0 when not finite.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "0".into();
    }
    let mut text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" { "0".into() } else { text }
}

/// `value` with `digits` significant digits, in plain notation between 1e-4 and 1e6 and with an exponent elsewhere.
/// What is infinite says so, with its sign; what is no number becomes `n/a`.
pub fn significant(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "n/a".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { "infinite" } else { "-infinite" }.into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let exponent = decade(value);
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return fixed(value, decimals);
    }
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    match text.split_once('e') {
        Some((mantissa, power)) if mantissa.contains('.') => {
            format!(
                "{}e{power}",
                mantissa.trim_end_matches('0').trim_end_matches('.')
            )
        }
        _ => text,
    }
}

/// The decade of a number: the largest `k` with `10^k <= |value|`; 0 for zero and for what is not finite.
pub fn decade(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    format!("{value:e}")
        .split_once('e')
        .and_then(|(_, power)| power.parse().ok())
        .unwrap_or(0)
}

/// `value` in a unit with the SI prefix that leaves one to three digits before the point: `2.5 kN`, `20 mN m`. Beyond
/// the prefixes, with an exponent.
pub fn with_prefix(value: f64, unit: &str, digits: usize) -> String {
    let prefixes = [
        (-9, "n"),
        (-6, "µ"),
        (-3, "m"),
        (0, ""),
        (3, "k"),
        (6, "M"),
        (9, "G"),
        (12, "T"),
    ];
    // rounding may lead into the next decade
    let shown: f64 = format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value);
    let thousands = 3 * decade(shown).div_euclid(3);
    match prefixes.iter().find(|(power, _)| *power == thousands) {
        Some((power, prefix)) => {
            let scaled = format!("{shown:e}");
            let (mantissa, exponent) = scaled.split_once('e').unwrap_or((&scaled, "0"));
            let exponent: i32 = exponent.parse().unwrap_or(0);
            let text: f64 = format!("{mantissa}e{}", exponent - power)
                .parse()
                .unwrap_or(shown);
            format!("{} {prefix}{unit}", significant(text, digits))
        }
        None => format!("{} {unit}", significant(shown, digits)),
    }
}

/// `10^power`, correctly rounded.
pub fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::INFINITY)
}

/// The shortest text that reads back as `value`; never "5.0", and `e` notation where plain digits get long.
pub fn shortest(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// `value` rounded to `digits` significant digits (at least one, at most 17).
pub fn rounded(value: f64, digits: usize) -> f64 {
    let digits = digits.clamp(1, 17);
    // Most places on a motion are numbers of few digits: five before the point and ten halvings behind it are 15 at most.
    if digits >= 15 && value.abs() < 1e5 && (value * 1024.0).fract() == 0.0 {
        return value;
    }
    format!("{value:.*e}", digits - 1)
        .parse()
        .unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_odd() {
        assert_eq!(fixed(1.2300, 3), "1.23");
        assert_eq!(fixed(-0.0001, 3), "0");
        assert_eq!(fixed(100.0, 0), "100");
        assert_eq!(fixed(f64::NAN, 3), "0");
        assert_eq!(significant(123456.7, 4), "123457");
        assert_eq!(significant(0.00012345, 3), "0.000123");
        assert_eq!(significant(1.5e-9, 4), "1.5e-9");
        assert_eq!(significant(2e7, 4), "2e7");
        assert_eq!(significant(f64::NAN, 4), "n/a");
        assert_eq!(significant(f64::INFINITY, 4), "infinite");
        assert_eq!(significant(f64::NEG_INFINITY, 4), "-infinite");
        assert_eq!((decade(999.0), decade(1e-3), decade(0.0)), (2, -3, 0));
        assert_eq!(power_of_ten(-7), 1e-7);
        assert_eq!(with_prefix(500.0, "N", 3), "500 N");
        assert_eq!(with_prefix(2500.0, "N", 3), "2.5 kN");
        assert_eq!(with_prefix(0.02, "N m", 3), "20 mN m");
        assert_eq!(with_prefix(999.96, "N", 3), "1 kN");
        assert_eq!(with_prefix(1e20, "N", 3), "1e20 N");
        assert_eq!(with_prefix(0.0, "N", 3), "0 N");
    }
}
