//! Reads a TOML text to a tree in which every key and value knows its place.

use toml::de::{DeTable, DeValue};

use crate::decimal::comma;
use crate::diagnostic::Diagnostic;
use crate::ids::Span;
use crate::mend::{Broken, tell, unclosed, without};
use crate::node::{Key, Node, Table, Text, Value};

/// Reads a TOML text. What is wrong with its syntax goes to `diagnostics`; the tree is what could be read anyway, and what could not
/// is told besides.
pub(crate) fn parse(text: &str, diagnostics: &mut Vec<Diagnostic>, broken: &mut Broken) -> Table {
    let twice = |e: &toml::de::Error| e.message().starts_with(DUPLICATE);
    let (mut root, mut errors) = DeTable::parse_recoverable(text);
    let mut rest;
    // what is not TOML is set aside, until the rest is
    for round in 0..=ROUNDS {
        if errors.iter().all(twice) {
            break;
        }
        if round == ROUNDS {
            broken.beyond_telling();
            break;
        }
        let open = match round {
            0 => unclosed(text),
            _ => Vec::new(),
        };
        let count = match open.len() {
            0 => errors.len(),
            open => open,
        };
        if count > MAX_SYNTAX_ERRORS {
            broken.beyond_telling();
        }
        for entry in open.iter().take(MAX_SYNTAX_ERRORS) {
            broken.add(text, entry.lines.clone());
            diagnostics.push(tell(entry, text));
        }
        let others = errors.iter().filter(|e| open.is_empty() && !twice(e));
        for error in others.take(MAX_SYNTAX_ERRORS) {
            let diagnostic = syntax_error(error, text);
            let at = diagnostic.start();
            // one error to an entry: the others follow from it
            if !broken.holds(at) {
                broken.add(text, at..at);
                diagnostics.push(diagnostic);
            }
        }
        let open = open.iter().map(|entry| &entry.lines);
        rest = without(text, broken.lines().iter().chain(open));
        (root, errors) = DeTable::parse_recoverable(&rest);
    }
    // where a section's name is broken, its entries stand in another one
    if !broken.in_doubt() {
        let doubles = errors.iter().filter(|e| twice(e)).take(MAX_SYNTAX_ERRORS);
        diagnostics.extend(doubles.map(|error| syntax_error(error, text)));
    }
    table(root.get_ref(), text)
}

/// A text is read so often at most, each time without the lines that could not be read before.
const ROUNDS: usize = 4;

/// How the message on a key that is given twice starts.
const DUPLICATE: &str = "duplicate key";

/// Syntax errors shown at most: after a few, the rest are consequences.
const MAX_SYNTAX_ERRORS: usize = 20;

fn table(source: &DeTable<'_>, text: &str) -> Table {
    let mut entries: Vec<(Key, Node)> = source
        .iter()
        .map(|(k, v)| {
            let key = Key {
                name: k.get_ref().to_string(),
                span: k.span(),
            };
            (key, node(v.get_ref(), v.span(), text))
        })
        .collect();
    entries.sort_by_key(|(k, _)| k.span.start);
    Table { entries }
}

fn node(value: &DeValue<'_>, span: Span, text: &str) -> Node {
    let value = match value {
        DeValue::String(s) => Value::Text(Text::new(s.to_string(), &span, text)),
        DeValue::Integer(i) => {
            let magnitude = i64::from_str_radix(i.as_str(), i.radix()).map(|i| i as f64);
            Value::Number(
                magnitude
                    .or_else(|_| i.as_str().parse())
                    .unwrap_or(f64::NAN),
            )
        }
        DeValue::Float(f) => Value::Number(f.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(b) => Value::Bool(*b),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(a) => Value::Array(
            a.iter()
                .map(|v| node(v.get_ref(), v.span(), text))
                .collect(),
        ),
        DeValue::Table(t) => Value::Table(table(t, text)),
    };
    Node { span, value }
}

fn syntax_error(error: &toml::de::Error, text: &str) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    let at = text.get(span.clone()).unwrap_or("");
    let message = error.message();
    if message.starts_with(DUPLICATE) {
        return Diagnostic::error("duplicate-name", format!("`{at}` is written twice"))
            .at(span, "the second one")
            .help("a name may be given once in a table: rename one of them, or join the two");
    }
    if let Some(d) = strange_sign(&span, text).or_else(|| comma(text, span.start)) {
        return d;
    }
    let quoted;
    let number = at.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '+');
    let help = if message.contains("carriage return") {
        "save the file with line ends of LF or CRLF: here is a CR alone"
    } else if message.contains("must be quoted") && number && at.len() < 40 {
        quoted = format!("a value with a unit is a string: \"{}\"", at.trim());
        &quoted
    } else if message.contains("recursion limit") {
        "this is nested deeper than any model needs"
    } else if message.contains("string") || message.contains("quote") {
        "strings stand between two double quotes, on one line: \"20 mm\""
    } else if message.contains("float") || message.contains("number") || message.contains("integer")
    {
        "a number is written like 20 or 0.5 or 1e-3; a number with a unit is a string: \"20 mm\""
    } else if message.contains("array") {
        "an array is written [0, 0], with commas between its values"
    } else if message.contains("table") {
        "an inline table is written { A-B = 20, B-C = 30 }, with commas between its entries"
    } else {
        "a line is `name = value`, where the value is a number, a \"string\", an [array] or a { table }"
    };
    Diagnostic::error("toml-syntax", format!("not TOML: {message}"))
        .at(span, "")
        .help(help)
}

/// The error of a sign that looks like one of TOML and is none, on the line up to the end of what could not be read.
fn strange_sign(span: &Span, text: &str) -> Option<Diagnostic> {
    let start = text.get(..span.start)?.rfind('\n').map_or(0, |i| i + 1);
    let end = text.ceil_char_boundary(span.end.max(span.start + 1).min(text.len()));
    let (at, sign) = text
        .get(start..end)?
        .char_indices()
        .find(|(_, c)| is_quote(*c) || is_strange_blank(*c) || is_hidden(*c))?;
    let at = start + at;
    let place = at..at + sign.len_utf8();
    let code = format!("U+{:04X}", u32::from(sign));
    let d = if is_hidden(sign) {
        Diagnostic::error("toml-syntax", "not TOML: a sign that does not show")
            .at(place, code)
            .help("leave it out; a model file is plain text with line ends of LF or CRLF")
    } else if is_quote(sign) {
        let message = format!("not TOML: `{sign}` is not the quote of a string");
        Diagnostic::error("toml-syntax", message)
            .at(place, code)
            .help("strings stand between two plain double quotes, on one line: \"20 mm\"")
    } else {
        let message = "not TOML: a blank that is not one of TOML's";
        Diagnostic::error("toml-syntax", message)
            .at(place, code)
            .help("it may come from a copied text: type a plain blank instead")
    };
    Some(d)
}

/// A sign of control that TOML does not know.
fn is_hidden(c: char) -> bool {
    c.is_control() && !matches!(c, '\t' | '\n' | '\r')
}

/// A quote of print.
fn is_quote(c: char) -> bool {
    "“”„‟‘’‚‛«»‹›´`".contains(c)
}

/// A blank besides those of the keyboard, or a sign without width.
fn is_strange_blank(c: char) -> bool {
    (c.is_whitespace() && !c.is_ascii())
        || matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_of(source: &str) -> (Text, String) {
        let root = parse(source, &mut Vec::new(), &mut Broken::default());
        match &root.entries[0].1.value {
            Value::Text(t) => (t.clone(), source.to_owned()),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn string_places_survive_escapes() {
        for source in [
            "a = \"1\\u00b0 + zz\"",
            "a = '1° + zz'",
            "a = \"1\\t\\\\ + zz\"",
            "a = \"\"\"\r\n1 \\\n   + zz\"\"\"",
            "a = \"\\x41\\U0001F600 zz\"",
        ] {
            let (text, source) = text_of(source);
            let inner = text.content.find("zz").expect("there");
            assert_eq!(
                source.get(text.span(inner..inner + 2)),
                Some("zz"),
                "{source}"
            );
        }
    }

    #[test]
    fn a_broken_line_does_not_hide_the_others() {
        let mut diagnostics = Vec::new();
        let text = "a = 1\nb = \nc = 3\nc = 4\n[d]\ne = \"x\n f = 2\n";
        let root = parse(text, &mut diagnostics, &mut Broken::default());
        assert!(diagnostics.len() >= 3, "{diagnostics:#?}");
        assert!(root.get("a").is_some() && root.get("d").is_some());
    }

    #[test]
    fn deep_nesting_is_refused_without_a_stack_overflow() {
        let mut diagnostics = Vec::new();
        let deep = format!("a = {}{}", "[".repeat(200_000), "]".repeat(200_000));
        parse(&deep, &mut diagnostics, &mut Broken::default());
        assert!(!diagnostics.is_empty());
    }
}
