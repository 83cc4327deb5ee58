//! Numbers with a comma in the place of the point, `20,5`, where TOML or a list cannot mean them.

use crate::diagnostic::{Diagnostic, line_at};
use crate::ids::Span;
use crate::node::{Node, Value};

/// What to write in the place of a number with a comma.
pub(crate) fn remedy(written: &str) -> String {
    let (number, unit) = match written.find(|c: char| c.is_whitespace()) {
        Some(end) => written.split_at(end),
        None => (written, ""),
    };
    let number = number.replacen(',', ".", 1);
    match unit.trim() {
        "" => format!("decimals have a point: {number}"),
        unit => format!(
            "decimals have a point, and a number with its unit is a string: \"{number} {unit}\""
        ),
    }
}

/// The error of a number with a comma on the line of a byte, in a text that is not TOML there.
pub(crate) fn comma(text: &str, at: usize) -> Option<Diagnostic> {
    let line = line_at(text, at);
    let start = line.end - line.content.len();
    let span = find(line.content)?;
    let written = line.content.get(span.clone())?;
    let number = written.split_whitespace().next().unwrap_or(written);
    let help = remedy(written);
    Some(
        Diagnostic::error(
            "toml-syntax",
            format!("not TOML: `{number}` is not a number"),
        )
        .at(
            start + span.start..start + span.end,
            "a comma parts one value from the next",
        )
        .help(help),
    )
}

/// The first number with a comma that parts no two values, with a unit that stands behind it.
fn find(line: &str) -> Option<Span> {
    let bytes = line.as_bytes();
    let digits = |from: usize| {
        let rest = bytes.get(from..).unwrap_or(&[]);
        rest.iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let (mut quote, mut open, mut value) = (None, Vec::new(), false);
    let mut at = 0;
    while let Some(sign) = bytes.get(at).copied() {
        match (quote, sign) {
            (Some(b'"'), b'\\') => at += 1,
            (Some(q), _) => quote = (q != sign).then_some(q),
            (None, b'"' | b'\'') => quote = Some(sign),
            (None, b'#') => return None,
            (None, b'[' | b'{') => open.push(sign),
            (None, b']' | b'}') => drop(open.pop()),
            (None, b'=') => value = true,
            (None, b'0'..=b'9') => {
                let whole = digits(at);
                let part = digits(at + whole + 1);
                let mut end = at + whole + 1 + part;
                if value && bytes.get(at + whole) == Some(&b',') && part > 0 {
                    // a list may mean two numbers, unless the second would begin with a nought
                    let list = open.last() == Some(&b'[');
                    let nought = part > 1 && bytes.get(at + whole + 1) == Some(&b'0');
                    if let Some(b'e' | b'E') = bytes.get(end) {
                        let signed = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
                        let from = end + 1 + usize::from(signed);
                        end = from + digits(from);
                    }
                    let rest = line.get(end..)?;
                    let key = rest.trim_start().starts_with(['=', '.', '-']);
                    if !key && (!list || nought) {
                        let unit = rest.find([',', ']', '}', '#', '"', '\'', '=']);
                        let unit = rest.get(..unit.unwrap_or(rest.len()))?.trim_end();
                        let from = at
                            - usize::from(at > 0 && matches!(bytes.get(at - 1), Some(b'-' | b'+')));
                        return Some(from..end + unit.len());
                    }
                }
                // the rest of a number, or of a name that ends with digits
                at += whole - 1;
            }
            (None, _) if sign.is_ascii_alphabetic() || sign == b'_' => {
                let rest = bytes.get(at..).unwrap_or(&[]);
                let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
                at += rest.iter().take_while(|b| word(b)).count() - 1;
            }
            _ => {}
        }
        at += 1;
    }
    None
}

/// A number that a list with too many entries holds as two: where the two stand, and the number as it is meant.
pub(crate) fn torn(items: &[Node]) -> Option<(Span, String)> {
    let whole = |node: &Node| match node.value {
        Value::Number(x) if x.fract() == 0.0 && x.abs() < 1e15 => Some(x),
        _ => None,
    };
    items.windows(2).find_map(|pair| {
        let [a, b] = pair else { return None };
        let (x, y) = (whole(a)?, whole(b).filter(|y| *y >= 0.0)?);
        let tight = a.span.end + 1 == b.span.start;
        tight.then(|| (a.span.start..b.span.end, format!("{x}.{y}")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> Option<&str> {
        find(line).map(|span| &line[span])
    }

    #[test]
    fn commas_in_numbers_are_seen() {
        assert_eq!(found("crank = { A-B = 20,5 }"), Some("20,5"));
        assert_eq!(found("a = 20,5"), Some("20,5"));
        assert_eq!(found("a = -20,05e-3 # x"), Some("-20,05e-3"));
        assert_eq!(found("{ A-B = 20,5 mm, C-D = 3 }"), Some("20,5 mm"));
        assert_eq!(found("{ A-B = 1, C-D = 3,25, x = 1 }"), Some("3,25"));
        assert_eq!(found("A = [20,05, 3]"), Some("20,05"));
        assert_eq!(
            found("m = { from = 0, to = 360,5, speed = \"1,5\" }"),
            Some("360,5")
        );
    }

    #[test]
    fn commas_between_values_are_left() {
        assert_eq!(found("A = [20,5]"), None);
        assert_eq!(found("a = { b = 1,c = 2 }"), None);
        assert_eq!(found("a = { b = 20,5 = 3 }"), None);
        assert_eq!(found("a = \"20,5 mm\""), None);
        assert_eq!(found("a = 3 # 20,5"), None);
        assert_eq!(found("a1,2 = 3"), None);
    }
}
