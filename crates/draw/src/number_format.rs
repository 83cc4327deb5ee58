//! Numbers as text, the same on every target: short, without a negative zero, never `NaN`.

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
/// A value that is not finite becomes `n/a`.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "n/a".into();
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

/// `10^power`, correctly rounded.
pub fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::INFINITY)
}

/// Text with `&`, `<`, `>`, quotes and control characters made safe for HTML and SVG, in text and in attributes.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
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
        assert_eq!(significant(f64::INFINITY, 4), "n/a");
        assert_eq!((decade(999.0), decade(1e-3), decade(0.0)), (2, -3, 0));
        assert_eq!(power_of_ten(-7), 1e-7);
    }
}
