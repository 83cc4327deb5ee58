//! Editing a model file while every other byte of it stays: edits are places with what stands there afterwards.

mod brackets;
mod comments;
pub(crate) mod delete;
mod enter;
mod only_change;
mod removal;
pub(crate) mod rename;

use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::Diagnostic;
use crate::document;
use crate::ids::Span;
use crate::item::key;
use crate::mend::Broken;
use crate::text_edit::TextEdit;
use enter::Place;
use only_change::only_change;

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
/// as they are. A path whose last part is not there yet is entered: at the end of its inline table, as a line behind the last one
/// of its section, beside the dotted keys that its table is written with, or under a header of its own at the end of the text.
///
/// # Errors
///
/// `toml-syntax` when the text or the new value is not TOML, `unknown-key` when the path leads nowhere.
pub fn value_edit(text: &str, path: &[&str], new: &str) -> Result<TextEdit, Diagnostic> {
    let value = a_value(new)?;
    let new = new.trim();
    let root = read(text)?;
    let edit = match locate(text, &root, path) {
        Ok(Target::Value(span)) => TextEdit::new(span, new),
        Ok(Target::Missing(place, key)) => enter::entry(text, &place, key, new),
        Err(part) => {
            return Err(Diagnostic::error(
                "unknown-key",
                format!("`{}` leads nowhere", path.join(".")),
            )
            .help(format!("there is no `{part}` in the file")));
        }
    };
    checked(text, &root, edit, path, &value, new)
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
    let value = a_value(new)?;
    let root = read(text)?;
    match root.get(section).map(|known| known.get_ref()) {
        None => {
            let new = new.trim();
            let entry = format!("{} = {new}", key(name));
            let edit = enter::section(text, &[section.to_owned()], &entry);
            checked(text, &root, edit, &[section, name], &value, new)
        }
        Some(DeValue::Table(table)) if table.get(name).is_some() => {
            let message = format!("[{section}] has an entry `{name}`");
            let place = table
                .get_key_value(name)
                .map_or(0..0, |(key, _)| key.span());
            Err(Diagnostic::error("name-clash", message)
                .at(place, "")
                .help("give the new one another name, or change this one"))
        }
        Some(_) => value_edit(text, &[section, name], new),
    }
}

/// A TOML value.
fn a_value(new: &str) -> Result<DeValue<'_>, Diagnostic> {
    let new = new.trim();
    match DeValue::parse(new) {
        Ok(value) => Ok(value.into_inner()),
        Err(error) => Err(Diagnostic::error(
            "toml-syntax",
            format!("`{new}` is not a TOML value: {}", error.message()),
        )
        .help("a value is a number, a \"string\", an [array] or a { table }")),
    }
}

/// The tree of a text that is TOML.
fn read(text: &str) -> Result<DeTable<'_>, Diagnostic> {
    DeTable::parse(text)
        .map(toml::Spanned::into_inner)
        .map_err(|error| {
            let mut found = Vec::new();
            document::parse(text, &mut found, &mut Broken::default());
            let first = found.into_iter().next();
            first.unwrap_or_else(|| Diagnostic::error("toml-syntax", error.message().to_owned()))
        })
}

/// The edit if the text is TOML afterwards and differs in this value alone: what was to be one value must not become several.
fn checked(
    text: &str,
    before: &DeTable<'_>,
    edit: TextEdit,
    path: &[&str],
    value: &DeValue<'_>,
    new: &str,
) -> Result<TextEdit, Diagnostic> {
    let edited = edited(text, &edit);
    let (message, help) = match DeTable::parse(&edited) {
        Ok(after) if only_change(before, after.get_ref(), path, value) => return Ok(edit),
        Ok(_) => (
            "it would change other values".to_owned(),
            "write it into the file by hand",
        ),
        Err(error) => (
            error.message().to_owned(),
            "a value in an inline table stands on one line",
        ),
    };
    let message = format!("`{new}` does not fit there: {message}");
    Err(Diagnostic::error("toml-syntax", message).help(help))
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

/// What a path leads to.
enum Target<'p> {
    Value(Span),
    /// A table that has not yet the key.
    Missing(Place, &'p str),
}

/// The place of a path; the part that is missing when it leads nowhere.
fn locate<'p>(text: &str, root: &DeTable<'_>, path: &[&'p str]) -> Result<Target<'p>, String> {
    let Some((last, way)) = path.split_last() else {
        return Err(String::new());
    };
    let is_inline = |span: &Span| text.get(span.clone()).is_some_and(|t| t.starts_with('{'));
    let mut place = Place::default();
    let mut here = Here::Table(root);
    for part in way {
        let node = here.get(part).ok_or_else(|| (*part).to_owned())?;
        if matches!(here, Here::Table(_)) {
            place.names.push((*part).to_owned());
        }
        place.span = node.span();
        here = match node.get_ref() {
            DeValue::Table(table) => Here::Table(table),
            DeValue::Array(items) => Here::Array(items),
            _ => return Err((*part).to_owned()),
        };
        if matches!(here, Here::Table(_)) && is_inline(&place.span) {
            place.braces = Some((place.names.len(), place.span.clone()));
        }
    }
    match (here.get(last), here) {
        // a table under a [header] or of dotted keys is not one value
        (Some(node), _) if node.get_ref().is_table() && !is_inline(&node.span()) => {
            Err((*last).to_owned())
        }
        (Some(node), _) => Ok(Target::Value(node.span())),
        (None, Here::Table(_)) => Ok(Target::Missing(place, last)),
        (None, Here::Array(_)) => Err((*last).to_owned()),
    }
}

/// What holds others.
#[derive(Clone, Copy)]
enum Here<'t, 'i> {
    Table(&'t DeTable<'i>),
    Array(&'t DeArray<'i>),
}

impl<'t, 'i> Here<'t, 'i> {
    fn get(self, part: &str) -> Option<&'t toml::Spanned<DeValue<'i>>> {
        match self {
            Self::Table(table) => table.get(part),
            Self::Array(items) => items.get(part.parse::<usize>().ok()?),
        }
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
    fn an_entry_goes_into_the_table_of_its_path() {
        for (text, path, new, wanted) in [
            (
                "[links]\nframe = { A = [0, 0] }\n[studies.turn]\nkind = \"motion\"\n",
                &["studies", "again"][..],
                "{ kind = \"forces\" }",
                "[links]\nframe = { A = [0, 0] }\n[studies.turn]\nkind = \"motion\"\n\n[studies]\nagain = { kind = \"forces\" }\n",
            ),
            (
                "[drives]\nmotor.turns = \"crank\"\nmotor.speed = 1 # rad/s\nother.turns = \"b\"\n",
                &["drives", "motor", "to"],
                "90",
                "[drives]\nmotor.turns = \"crank\"\nmotor.speed = 1 # rad/s\nmotor.to = 90\nother.turns = \"b\"\n",
            ),
            (
                "[links]\nframe.A = [0, 0]\ncrank.A-B = 1\n",
                &["links", "frame", "D"],
                "[1, 0]",
                "[links]\nframe.A = [0, 0]\nframe.D = [1, 0]\ncrank.A-B = 1\n",
            ),
            (
                "a.b.c = 1\r\n[d]\r\n",
                &["a", "b", "e f"],
                "2",
                "a.b.c = 1\r\na.b.\"e f\" = 2\r\n[d]\r\n",
            ),
            (
                "a = { b.c = 1, d = 2 }",
                &["a", "b", "e"],
                "3",
                "a = { b.c = 1, d = 2, b.e = 3 }",
            ),
            (
                "[a.b.c]\nd = 1",
                &["a", "b", "e"],
                "2",
                "[a.b.c]\nd = 1\n\n[a.b]\ne = 2\n",
            ),
            (
                "[[a]]\nb = 1\n[[a]]\nb = 2\n",
                &["a", "0", "c"],
                "3",
                "[[a]]\nb = 1\nc = 3\n[[a]]\nb = 2\n",
            ),
            (
                "a = [{ b = 1 }, {}]",
                &["a", "1", "c"],
                "3",
                "a = [{ b = 1 }, { c = 3 }]",
            ),
            ("\u{feff}[a]\n", &["b"], "1", "\u{feff}b = 1\n[a]\n"),
            ("[a]", &["a", "b"], "1", "[a]\nb = 1\n"),
        ] {
            assert_eq!(set_value(text, path, new).as_deref(), Ok(wanted), "{text}");
        }
    }

    #[test]
    fn in_braces_over_lines_an_entry_has_a_line_and_leaves_comments() {
        let add = |text: &str| set_value(text, &["a", "d"], "3").unwrap();
        assert_eq!(
            add("a = {\n  b = 1, # one\n  c = 2, # two\n}\n"),
            "a = {\n  b = 1, # one\n  c = 2, # two\n  d = 3,\n}\n"
        );
        assert_eq!(
            add("a = { b = 1, # one\r\n      c = [2,\r\n      5] # two\r\n}\r\n"),
            "a = { b = 1, # one\r\n      c = [2,\r\n      5], # two\r\n      d = 3\r\n}\r\n"
        );
        assert_eq!(add("a = { # none\n}"), "a = { d = 3 # none\n}");
        assert_eq!(
            add("a = { b = 1\n# x\n, c = 2 }"),
            "a = { b = 1\n# x\n, c = 2, d = 3 }"
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
            (&["links", "bar"], "[parameters]"),
            (&["nowhere", "a"], "3"),
            (&[], "3"),
        ] {
            assert!(set_value(FILE, path, new).is_err(), "{path:?}");
        }
        // of an array of tables the last alone goes on at the end
        let text = "[[a]]\n[a.b.c]\n[[a]]\n";
        assert!(set_value(text, &["a", "0", "b", "d"], "1").is_err());
        assert!(set_value("[a]\n[b]\n", &["a"], "[c]").is_err());
    }
}
