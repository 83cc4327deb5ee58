//! Editing one value of a model file while every other byte of it stays.

use crate::diagnostic::Diagnostic;
use crate::document::{self, Node, Table, Value};
use crate::model::Span;

/// The text with the value at `path` replaced by `new`, a TOML value such as `20`, `"25 mm"` or `[0, 1]`.
///
/// The path goes through tables by key and through arrays by index: `["links", "frame", "D", "0"]`. Comments, order, line ends and blanks stay
/// as they are. A path whose last part is not there yet is entered: at the end of its inline table, or as a line behind the last one
/// of its section.
///
/// # Errors
///
/// `toml-syntax` when the text or the new value is not TOML, `unknown-key` when the path leads nowhere.
///
/// # Example
///
/// ```
/// let text = "[parameters]\na = \"20 mm\" # the crank\n";
/// let edited = kempe_model::set_value(text, &["parameters", "a"], "\"25 mm\"").unwrap();
/// assert_eq!(edited, "[parameters]\na = \"25 mm\" # the crank\n");
/// ```
pub fn set_value(text: &str, path: &[&str], new: &str) -> Result<String, Diagnostic> {
    let new = new.trim();
    if let Err(error) = toml::de::DeValue::parse(new) {
        return Err(Diagnostic::error(
            "toml-syntax",
            format!("`{new}` is not a TOML value: {}", error.message()),
        )
        .help("a value is a number, a \"string\", an [array] or a { table }"));
    }
    let mut found = Vec::new();
    let (root, _) = document::parse(text, &mut found);
    if let Some(first) = found.into_iter().next() {
        return Err(first);
    }
    let edit = match locate(&root, path) {
        Ok(Place::Value(span)) => Edit {
            span,
            insert: new.to_owned(),
        },
        Ok(Place::Missing { table, header, key }) => entry(text, table, header, key, new),
        Err(part) => {
            return Err(Diagnostic::error(
                "unknown-key",
                format!("`{}` leads nowhere", path.join(".")),
            )
            .help(format!("there is no `{part}` in the file")));
        }
    };
    let (before, after) = (text.get(..edit.span.start), text.get(edit.span.end..));
    let edited = format!(
        "{}{}{}",
        before.unwrap_or(text),
        edit.insert,
        after.unwrap_or("")
    );
    // what was to be one value must not become several
    match toml::de::DeTable::parse(&edited) {
        Ok(_) => Ok(edited),
        Err(error) => Err(Diagnostic::error(
            "toml-syntax",
            format!("`{new}` does not fit there: {}", error.message()),
        )
        .help("a value in an inline table stands on one line")),
    }
}

struct Edit {
    span: Span,
    insert: String,
}

enum Place<'t> {
    Value(Span),
    Missing {
        table: &'t Table,
        header: Span,
        key: &'t str,
    },
}

/// The place of a path; the part that is missing when it leads nowhere.
fn locate<'t>(root: &'t Table, path: &[&'t str]) -> Result<Place<'t>, String> {
    let Some((last, way)) = path.split_last() else {
        return Err(String::new());
    };
    let whole = Node {
        span: 0..0,
        value: Value::Bool(false),
    };
    let mut here: (&Node, Option<&'t Table>) = (&whole, Some(root));
    let mut node: &'t Node;
    let mut span = 0..0;
    let mut items: Option<&'t [Node]> = None;
    for part in way {
        node = step(here.1, items, part).ok_or_else(|| (*part).to_owned())?;
        span = node.span.clone();
        items = None;
        here.1 = match &node.value {
            Value::Table(table) => Some(table),
            Value::Array(list) => {
                items = Some(list);
                None
            }
            _ => return Err((*part).to_owned()),
        };
    }
    match (step(here.1, items, last), here.1) {
        (Some(node), _) => match &node.value {
            // a table under a [header] is not one value
            Value::Table(table) if !is_inline(table, &node.span) => Err((*last).to_owned()),
            _ => Ok(Place::Value(node.span.clone())),
        },
        (None, Some(table)) => Ok(Place::Missing {
            table,
            header: span,
            key: last,
        }),
        (None, None) => Err((*last).to_owned()),
    }
}

fn step<'t>(table: Option<&'t Table>, items: Option<&'t [Node]>, part: &str) -> Option<&'t Node> {
    match (table, items) {
        (Some(table), _) => table.get(part),
        (None, Some(items)) => items.get(part.parse::<usize>().ok()?),
        (None, None) => None,
    }
}

/// Whether a table is written between braces: its entries lie in its span. Of a table under a header, the span is the header's.
fn is_inline(table: &Table, span: &Span) -> bool {
    table
        .entries
        .iter()
        .all(|(k, _)| span.start <= k.span.start && k.span.end <= span.end)
}

/// The edit that enters a key that is not there yet.
fn entry(text: &str, table: &Table, header: Span, key: &str, new: &str) -> Edit {
    let bare = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare {
        key.to_owned()
    } else {
        toml::Value::String(key.to_owned()).to_string()
    };
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let written = text.get(header.clone()).unwrap_or("");
    if written.starts_with('{') {
        let inner_end = header.end.saturating_sub(1);
        // behind the last entry, before the blanks and the brace
        let body = text.get(header.start + 1..inner_end).unwrap_or("");
        let at = header.start + 1 + body.trim_end().len();
        let insert = match (table.entries.is_empty(), body.trim_end().ends_with(',')) {
            (true, _) => format!(" {key} = {new}{}", if body.is_empty() { " " } else { "" }),
            (false, true) => format!(" {key} = {new}"),
            (false, false) => format!(", {key} = {new}"),
        };
        return Edit {
            span: at..at,
            insert,
        };
    }
    // behind the line of the last plain entry, or of the header
    let plain = table.entries.iter().filter(|(_, node)| match &node.value {
        Value::Table(t) => is_inline(t, &node.span) && !t.entries.is_empty(),
        _ => true,
    });
    let last = plain
        .map(|(_, node)| node.span.end)
        .max()
        .unwrap_or(header.end);
    let rest = text.get(last..).unwrap_or("");
    match rest.find('\n') {
        _ if last == 0 => Edit {
            span: 0..0,
            insert: format!("{key} = {new}{line_end}"),
        },
        Some(i) => Edit {
            span: last + i + 1..last + i + 1,
            insert: format!("{key} = {new}{line_end}"),
        },
        None => Edit {
            span: text.len()..text.len(),
            insert: format!("{line_end}{key} = {new}{line_end}"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "# top\r\n[parameters]\r\na = \"20 mm\"\t# the crank \r\n  b=3\r\n\r\n[links]\r\nframe = { A = [0, 0], D = [ \"d\" , 0 ] } # ground\r\n[links.bar]\r\nA-B = 2 # é\r\n";

    #[test]
    fn every_other_byte_stays() {
        for (path, new, old) in [
            (&["parameters", "a"][..], "\"25 mm\"", "\"20 mm\""),
            (&["parameters", "b"], "4.5", "3"),
            (&["links", "frame", "D", "0"], "\"2*d\"", "\"d\""),
            (&["links", "bar", "A-B"], "7", "2 # é"),
        ] {
            let edited = set_value(FILE, path, new).unwrap();
            let at = FILE.find(old).unwrap();
            let old = old.trim_end_matches(" # é");
            assert_eq!(
                edited,
                format!("{}{new}{}", &FILE[..at], &FILE[at + old.len()..])
            );
        }
    }

    #[test]
    fn a_missing_entry_is_entered() {
        let edited = set_value(FILE, &["parameters", "c"], "1").unwrap();
        assert_eq!(edited, FILE.replace("  b=3\r\n", "  b=3\r\nc = 1\r\n"));
        let edited = set_value(FILE, &["links", "frame", "E"], "[1, 2]").unwrap();
        assert_eq!(edited, FILE.replace(" ] } #", " ], E = [1, 2] } #"));
        let edited = set_value(FILE, &["links", "bar", "mass"], "\"1 kg\"").unwrap();
        assert!(edited.ends_with("A-B = 2 # é\r\nmass = \"1 kg\"\r\n"));
        assert_eq!(
            set_value("", &["title"], "\"x\"").unwrap(),
            "title = \"x\"\n"
        );
        assert_eq!(
            set_value("a = {}", &["a", "b"], "1").unwrap(),
            "a = { b = 1 }"
        );
    }

    #[test]
    fn what_cannot_be_done_is_refused() {
        for (path, new) in [
            (&["parameters", "a"][..], "1\nx = 2"),
            (&["parameters", "a"], "3 mm"),
            (&["parameters", "a", "b"], "3"),
            (&["links", "frame", "D", "9"], "3"),
            (&["links"], "3"),
            (&["nowhere", "a"], "3"),
            (&[], "3"),
        ] {
            assert!(set_value(FILE, path, new).is_err(), "{path:?}");
        }
    }
}
