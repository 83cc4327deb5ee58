//! Renaming a part wherever a text names it.

use crate::diagnostic::Diagnostic;
use crate::item::{is_bare, quoted};
use crate::key_table::adjust::TABLE;
use crate::outline::{Outline, ValueMark};
use crate::part::{Naming, Namings, Part, PartKind};
use crate::read::names::{COLUMNS, MAX_NAME, is_point_name, is_reserved, is_small_name};
use crate::read::studies::no_file_name;
use crate::text_edit::{TextEdit, apply};

/// The edits that give a part another name wherever the text names it: its entry, expressions and arguments of measures,
/// lines and sides, hints, friction, columns and plots of studies.
///
/// Only names change; every other byte stays. The text may have errors elsewhere, but what may name the part must be
/// readable, and afterwards the text names the same parts at the same places.
///
/// # Errors
///
/// `unknown-name` when the text has no such part, `bad-name` when the new name cannot name it or would be read as a unit
/// somewhere, `name-clash` when it is taken, `table-column` when a table beside the file may name the part by a head, `toml-syntax` when something that may name the part cannot be read.
///
/// # Example
///
/// ```
/// use kempe_model::{Part, PartKind, apply, rename};
/// let text = "[links]\nframe = { A = [0, 0], D = [60, 0] }\nrod = { A-B = 20 } # from A\n[measures]\nh = \"y(B) + distance(A, B)\"\n";
/// let edits = rename(text, &Part::new(PartKind::Point, "B"), "Tip").unwrap();
/// assert_eq!(
///     apply(text, &edits).unwrap(),
///     "[links]\nframe = { A = [0, 0], D = [60, 0] }\nrod = { A-Tip = 20 } # from A\n[measures]\nh = \"y(Tip) + distance(A, Tip)\"\n",
/// );
/// ```
pub fn rename(text: &str, part: &Part, to: &str) -> Result<Vec<TextEdit>, Diagnostic> {
    let outline = Outline::new(text);
    let namings = Namings::new(text, &outline);
    if !namings.declared(part) {
        return Err(unknown(&namings, part));
    }
    if part.name == to {
        return Ok(Vec::new());
    }
    no_head(&outline, part)?;
    // A parameter that is a key somewhere varies in a study, and has a column there.
    let is_key = |n: &Naming| n.part == *part && !n.declares && n.key.is_some();
    let has_column = match part.kind {
        PartKind::Drive | PartKind::Measure => true,
        PartKind::Parameter => namings.all.iter().any(is_key),
        _ => false,
    };
    fits(part, to, has_column)?;
    free(&namings, part, to)?;
    readable(text, &namings, part)?;
    let mut edits: Vec<TextEdit> = Vec::new();
    for naming in namings.of(part) {
        let edit = one(text, naming, to);
        // a key that gets quotes is one edit, whatever it names
        if edits.last().is_none_or(|last| last.span != edit.span) {
            edits.push(edit);
        }
    }
    same_names(text, &namings, part, to, &edits)?;
    Ok(edits)
}

pub(super) fn unknown(namings: &Namings, part: &Part) -> Diagnostic {
    let of_kind = namings
        .all
        .iter()
        .filter(|n| n.declares && n.part.kind == part.kind);
    let near = kempe_units::nearest(&part.name, of_kind.map(|n| n.part.name.as_str()));
    Diagnostic::error("unknown-name", format!("there is no {part}"))
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// Whether a name may name a part of its kind.
fn fits(part: &Part, to: &str, has_column: bool) -> Result<(), Diagnostic> {
    let small = "a name starts with a small letter and goes on with letters, digits and _";
    let help = if to.len() > MAX_NAME {
        format!("a name has at most {MAX_NAME} bytes")
    } else if part.kind == PartKind::Link && (part.name == "frame" || to == "frame") {
        "the link that stands still is called `frame`, and no other".to_owned()
    } else if part.kind == PartKind::Study {
        match no_file_name(to) {
            None => return Ok(()),
            Some(help) => help,
        }
    } else if part.kind == PartKind::Point {
        match is_point_name(to) {
            true => return Ok(()),
            false => {
                "a point's name starts with a capital letter and goes on with letters, digits and _"
                    .to_owned()
            }
        }
    } else if !is_small_name(to) {
        small.to_owned()
    } else if part.kind.is_common() && is_reserved(to) {
        format!("`{to}` already means something in every file")
    } else if has_column && COLUMNS.contains(&to) {
        format!("tables have a column `{to}` of their own")
    } else {
        return Ok(());
    };
    let message = format!("`{to}` cannot name a {}", part.kind.word());
    Err(Diagnostic::error("bad-name", message).help(help))
}

/// Whether no other part has the name already.
fn free(namings: &Namings, part: &Part, to: &str) -> Result<(), Diagnostic> {
    let one_space = |a: PartKind, b: PartKind| a == b || (a.is_common() && b.is_common());
    let same = |name: &str| match part.kind {
        // files differ by more than capitals
        PartKind::Study => name.to_lowercase() == to.to_lowercase(),
        _ => name == to,
    };
    let other = namings.all.iter().find(|n| {
        n.declares && n.part != *part && one_space(n.part.kind, part.kind) && same(&n.part.name)
    });
    match other {
        None => Ok(()),
        Some(other) => Err(Diagnostic::error(
            "name-clash",
            format!("there is a {} already", other.part),
        )
        .at(other.span.clone(), "")
        .help("choose another name, or rename this one first")),
    }
}

/// Whether everything can be read that may name the part.
fn readable(text: &str, namings: &Namings, part: &Part) -> Result<(), Diagnostic> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let may_name = |written: &str| {
        let mut words = written.split(|c| !is_name(c));
        words.any(|word| word == part.name)
    };
    let unread = namings.unread.iter();
    let mut unread = unread.filter(|span| text.get((*span).clone()).is_some_and(may_name));
    match unread.next() {
        None => Ok(()),
        Some(span) => Err(Diagnostic::error(
            "toml-syntax",
            format!("this may name {part}, and cannot be read"),
        )
        .at(span.clone(), "")
        .help("mend it first")),
    }
}

/// Whether no table beside the file may name the part by a head, which no edit of the text reaches.
fn no_head(outline: &Outline, part: &Part) -> Result<(), Diagnostic> {
    if !matches!(
        part.kind,
        PartKind::Drive | PartKind::Link | PartKind::Measure
    ) {
        return Ok(());
    }
    let is_key = |path: &[String], last: &str| matches!(path, [studies, _, rows, key] if studies == "studies" && rows == "match" && key == last);
    let by_heads = outline.values.iter().find(|table| {
        let says_columns =
            |v: &ValueMark| is_key(&v.path, "columns") && v.path.get(..3) == table.path.get(..3);
        is_key(&table.path, "table") && !outline.values.iter().any(says_columns)
    });
    match by_heads {
        None => Ok(()),
        Some(table) => Err(Diagnostic::error(
            "table-column",
            format!(
                "{part} may be the head of a column of this table, which would then be left aside"
            ),
        )
        .at(table.span.clone(), "")
        .help(format!(
            "say under `columns` first of what its columns are: columns = {}",
            TABLE.example_of("columns")
        ))),
    }
}

fn one(text: &str, naming: &Naming, to: &str) -> TextEdit {
    let Some(key) = &naming.key else {
        return TextEdit::new(naming.span.clone(), to);
    };
    let raw = text.get(key.clone()).unwrap_or("");
    if raw.starts_with(['"', '\'']) || is_bare(to) {
        return TextEdit::new(naming.span.clone(), to);
    }
    // the key needs quotes from now on
    let within = |at: usize| at.saturating_sub(key.start);
    let (before, after) = (
        raw.get(..within(naming.span.start)),
        raw.get(within(naming.span.end)..),
    );
    let whole = format!("{}{to}{}", before.unwrap_or(""), after.unwrap_or(""));
    TextEdit::new(key.clone(), quoted(&whole))
}

/// Whether the text names the same parts at the same places afterwards: behind a number, a name may become a unit.
fn same_names(
    text: &str,
    before: &Namings,
    part: &Part,
    to: &str,
    edits: &[TextEdit],
) -> Result<(), Diagnostic> {
    let renamed = |p: &Part| match p == part {
        true => Part::new(part.kind, to),
        false => p.clone(),
    };
    let after = apply(text, edits)
        .map(|text| Namings::new(&text, &Outline::new(&text)))
        .unwrap_or_default();
    let wanted: Vec<(Part, bool)> = (before.all.iter())
        .map(|n| (renamed(&n.part), n.declares))
        .collect();
    let found: Vec<(Part, bool)> = after
        .all
        .iter()
        .map(|n| (n.part.clone(), n.declares))
        .collect();
    if found == wanted && after.unread.len() == before.unread.len() {
        return Ok(());
    }
    let differs = (wanted.iter().zip(&found)).position(|(wanted, found)| wanted != found);
    let at = before
        .all
        .get(differs.unwrap_or(found.len().min(wanted.len())));
    let mut finding =
        Diagnostic::error("bad-name", format!("`{to}` would mean something else here"))
            .help("choose a name that is no unit");
    if let Some(at) = at {
        finding = finding.at(at.span.clone(), "");
    }
    Err(finding)
}
