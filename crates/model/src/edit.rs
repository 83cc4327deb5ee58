//! Editing a model file while every other byte of it stays: edits are places with what stands there afterwards.

pub(crate) mod delete;
pub(crate) mod rename;

use crate::diagnostic::Diagnostic;
use crate::document;
use crate::ids::Span;
use crate::item::key;
use crate::mend::Broken;
use crate::node::{Node, Table, Value};
use crate::outline::Outline;
use crate::text_edit::TextEdit;

/// The text with the value at `path` replaced by `new`, a TOML value such as `20`, `"25 mm"` or `[0, 1]`: what
/// [`value_edit`] gives, applied.
///
/// # Errors
///
/// Those of [`value_edit`].
///
/// # Example
///
/// ```
/// let text = "[parameters]\na = \"20 mm\" # the crank\n";
/// let edited = kempe_model::set_value(text, &["parameters", "a"], "\"25 mm\"").unwrap();
/// assert_eq!(edited, "[parameters]\na = \"25 mm\" # the crank\n");
/// ```
pub fn set_value(text: &str, path: &[&str], new: &str) -> Result<String, Diagnostic> {
    let edit = value_edit(text, path, new)?;
    Ok(edited(text, &edit))
}

/// The edit that replaces the value at `path` by `new`, a TOML value such as `20`, `"25 mm"` or `[0, 1]`.
///
/// The path goes through tables by key and through arrays by index: `["links", "frame", "D", "0"]`. Comments, order, line ends and blanks stay
/// as they are. A path whose last part is not there yet is entered: at the end of its inline table, or as a line behind the last one
/// of its section.
///
/// # Errors
///
/// `toml-syntax` when the text or the new value is not TOML, `unknown-key` when the path leads nowhere.
pub fn value_edit(text: &str, path: &[&str], new: &str) -> Result<TextEdit, Diagnostic> {
    let new = a_value(new)?;
    let root = read(text)?;
    let edit = match locate(&root, path) {
        Ok(Target::Value(span)) => TextEdit::new(span, new),
        Ok(Target::Missing { table, header, key }) => entry(text, table, header, key, new),
        Err(part) => {
            return Err(Diagnostic::error(
                "unknown-key",
                format!("`{}` leads nowhere", path.join(".")),
            )
            .help(format!("there is no `{part}` in the file")));
        }
    };
    still_toml(text, edit, new)
}

/// The edit that adds an entry `name = new` to a section, which is made at the end of the text when it is not there.
///
/// # Errors
///
/// `name-clash` when the section has the name, `toml-syntax` when the text or the new value is not TOML.
///
/// # Example
///
/// ```
/// use kempe_model::{add_entry, apply};
/// let text = "[links]\nframe = { A = [0, 0] }\n";
/// let edit = add_entry(text, "loads", "hook", "{ force = [0, \"-5 N\"], at = \"A\" }").unwrap();
/// let edited = apply(text, &[edit]).unwrap();
/// assert!(edited.ends_with("\n[loads]\nhook = { force = [0, \"-5 N\"], at = \"A\" }\n"));
/// ```
pub fn add_entry(text: &str, section: &str, name: &str, new: &str) -> Result<TextEdit, Diagnostic> {
    let new = a_value(new)?;
    let root = read(text)?;
    let known = root.entry(section);
    if let Some((_, node)) = known
        && let Value::Table(table) = &node.value
        && let Some((key, _)) = table.entry(name)
    {
        let message = format!("[{section}] has an entry `{name}`");
        return Err(Diagnostic::error("name-clash", message)
            .at(key.span.clone(), "")
            .help("give the new one another name, or change this one"));
    }
    let of_its_own = match known {
        None => false,
        // one that only `[section.name]` makes has no lines of its own
        Some((_, node)) => {
            is_written_inline(text, &node.span)
                || Outline::new(text)
                    .headers
                    .iter()
                    .any(|h| h.path == [section])
        }
    };
    if of_its_own {
        return value_edit(text, &[section, name], new);
    }
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let gap = match (text.is_empty(), text.ends_with('\n')) {
        (true, _) => String::new(),
        (false, true) => line_end.to_owned(),
        (false, false) => line_end.repeat(2),
    };
    let (section, name) = (key(section), key(name));
    let entry = format!("{gap}[{section}]{line_end}{name} = {new}{line_end}");
    still_toml(text, TextEdit::new(text.len()..text.len(), entry), new)
}

/// The text of a TOML value.
fn a_value(new: &str) -> Result<&str, Diagnostic> {
    let new = new.trim();
    match toml::de::DeValue::parse(new) {
        Ok(_) => Ok(new),
        Err(error) => Err(Diagnostic::error(
            "toml-syntax",
            format!("`{new}` is not a TOML value: {}", error.message()),
        )
        .help("a value is a number, a \"string\", an [array] or a { table }")),
    }
}

/// The tree of a text that is TOML.
fn read(text: &str) -> Result<Table, Diagnostic> {
    let mut found = Vec::new();
    let root = document::parse(text, &mut found, &mut Broken::default());
    match found.into_iter().next() {
        Some(first) => Err(first),
        None => Ok(root),
    }
}

fn edited(text: &str, edit: &TextEdit) -> String {
    let (before, after) = (text.get(..edit.span.start), text.get(edit.span.end..));
    format!(
        "{}{}{}",
        before.unwrap_or(text),
        edit.text,
        after.unwrap_or("")
    )
}

/// The edit if the text is TOML afterwards: what was to be one value must not become several.
fn still_toml(text: &str, edit: TextEdit, new: &str) -> Result<TextEdit, Diagnostic> {
    match toml::de::DeTable::parse(&edited(text, &edit)) {
        Ok(_) => Ok(edit),
        Err(error) => Err(Diagnostic::error(
            "toml-syntax",
            format!("`{new}` does not fit there: {}", error.message()),
        )
        .help("a value in an inline table stands on one line")),
    }
}

fn is_written_inline(text: &str, span: &Span) -> bool {
    text.get(span.clone())
        .is_some_and(|raw| raw.starts_with('{'))
}

enum Target<'t> {
    Value(Span),
    Missing {
        table: &'t Table,
        header: Span,
        key: &'t str,
    },
}

/// The place of a path; the part that is missing when it leads nowhere.
fn locate<'t>(root: &'t Table, path: &[&'t str]) -> Result<Target<'t>, String> {
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
            _ => Ok(Target::Value(node.span.clone())),
        },
        (None, Some(table)) => Ok(Target::Missing {
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
fn entry(text: &str, table: &Table, header: Span, key: &str, new: &str) -> TextEdit {
    let key = crate::item::key(key);
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
        return TextEdit::new(at..at, insert);
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
        _ if last == 0 => TextEdit::new(0..0, format!("{key} = {new}{line_end}")),
        Some(i) => TextEdit::new(
            last + i + 1..last + i + 1,
            format!("{key} = {new}{line_end}"),
        ),
        None => TextEdit::new(
            text.len()..text.len(),
            format!("{line_end}{key} = {new}{line_end}"),
        ),
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
