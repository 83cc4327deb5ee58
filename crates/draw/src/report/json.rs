//! JSON that is safe inside a `script` element.

use kempe_number::text::{fixed, significant};

/// A string literal. Nothing in it can end the script element or a line.
pub(super) fn string(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '<' | '>' | '&' | '\'' | '\u{2028}' | '\u{2029}' => {
                out.push_str(&format!("\\u{:04x}", c as u32))
            }
            c if c.is_control() => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// An array of ready elements.
pub(super) fn array(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(","))
}

/// A number with so many significant digits; `null` when it is not finite.
pub(super) fn number(value: f64, digits: usize) -> String {
    if value.is_finite() {
        significant(value, digits)
    } else {
        "null".into()
    }
}

/// A number with at most so many decimals; `null` when it is not finite.
pub(super) fn decimal(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        fixed(value, decimals)
    } else {
        "null".into()
    }
}

/// An object of ready values.
pub(super) fn object(fields: &[(&str, String)]) -> String {
    let field = |(name, value): &(&str, String)| format!("{}:{value}", string(name));
    format!(
        "{{{}}}",
        fields.iter().map(field).collect::<Vec<_>>().join(",")
    )
}
