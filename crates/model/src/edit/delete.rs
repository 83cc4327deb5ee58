//! Deleting a part, alone or with all that refers to it.

use std::collections::BTreeSet;
use std::fmt;

use crate::diagnostic::Diagnostic;
use crate::edit::TextEdit;
use crate::edit::rename::unknown;
use crate::model::Span;
use crate::outline::{Outline, Shape, ValueMark};
use crate::part::{Naming, Namings, Part, place_of};

/// Why a part is not deleted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DeleteError {
    /// The text has no such part.
    Unknown(Diagnostic),
    /// Others refer to it, here.
    InUse(Vec<Naming>),
}

impl fmt::Display for DeleteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(d) => f.write_str(&d.message),
            Self::InUse(by) => {
                let mut paths: Vec<String> = by.iter().map(|n| n.path.join(".")).collect();
                paths.dedup();
                write!(f, "it is used by {}", paths.join(", "))
            }
        }
    }
}

impl std::error::Error for DeleteError {}

/// What is deleted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Deletion {
    /// The edits of the text.
    pub edits: Vec<TextEdit>,
    /// The paths of the entries, keys and elements that go.
    pub paths: Vec<Vec<String>>,
    /// The parts that go.
    pub parts: Vec<Part>,
}

/// The edits that delete a part to which nothing else refers. A point goes with the keys of links that name it.
///
/// # Errors
///
/// [`DeleteError::InUse`] with every place that refers to the part, or to a point that only the deleted link has;
/// [`DeleteError::Unknown`] when there is no such part.
///
/// # Example
///
/// ```
/// use kempe_model::{DeleteError, Part, PartKind, apply, delete};
/// let text = "[parameters]\na = 1\nb = 2\n[links]\nframe = { A = [\"a\", 0] }\n";
/// let used = delete(text, &Part::new(PartKind::Parameter, "a")).unwrap_err();
/// assert_eq!(used.to_string(), "it is used by links.frame.A.0");
/// let edits = delete(text, &Part::new(PartKind::Parameter, "b")).unwrap();
/// assert_eq!(apply(text, &edits).unwrap(), text.replace("b = 2\n", ""));
/// ```
pub fn delete(text: &str, part: &Part) -> Result<Vec<TextEdit>, DeleteError> {
    let outline = Outline::new(text);
    let namings = Namings::new(text, &outline);
    let mut going = Going::new(&outline, &namings);
    going.part(part).map_err(DeleteError::Unknown)?;
    let users = going.users();
    if users.is_empty() {
        Ok(going.deletion(text).edits)
    } else {
        Err(DeleteError::InUse(users))
    }
}

/// The edits that delete a part and all that refers to it, directly or through others: entries whole, but of a link only the
/// keys, and of a study only the columns and plots, that name what goes.
///
/// What is left need not be a sound model: a link may have lost what places one of its points. The reader tells.
///
/// # Errors
///
/// `unknown-name` when there is no such part.
///
/// # Example
///
/// ```
/// use kempe_model::{Part, PartKind, apply, delete_with_dependants};
/// let text = "[parameters]\na = 1\n[measures]\nm = \"2 * a\"\nn = \"time\"\n[studies.s]\nkind = \"motion\"\ncolumns = [\"m\", \"n\"]\n";
/// let gone = delete_with_dependants(text, &Part::new(PartKind::Parameter, "a")).unwrap();
/// assert_eq!(
///     apply(text, &gone.edits).unwrap(),
///     "[parameters]\n[measures]\nn = \"time\"\n[studies.s]\nkind = \"motion\"\ncolumns = [\"n\"]\n",
/// );
/// ```
pub fn delete_with_dependants(text: &str, part: &Part) -> Result<Deletion, Diagnostic> {
    let outline = Outline::new(text);
    let namings = Namings::new(text, &outline);
    let mut going = Going::new(&outline, &namings);
    going.part(part)?;
    loop {
        let users = going.users();
        if users.is_empty() {
            return Ok(going.deletion(text));
        }
        for user in users {
            going.user(&user);
        }
    }
}

/// What goes so far.
struct Going<'o> {
    outline: &'o Outline,
    namings: &'o Namings,
    paths: BTreeSet<Vec<String>>,
    parts: BTreeSet<Part>,
}

impl<'o> Going<'o> {
    fn new(outline: &'o Outline, namings: &'o Namings) -> Self {
        Self {
            outline,
            namings,
            paths: BTreeSet::new(),
            parts: BTreeSet::new(),
        }
    }

    /// Deletes a part: everything that declares it.
    fn part(&mut self, part: &Part) -> Result<(), Diagnostic> {
        if !self.namings.declared(part) {
            return Err(unknown(self.namings, part));
        }
        self.parts.insert(part.clone());
        let declaring = self.namings.of(part).filter(|n| n.declares);
        self.paths.extend(declaring.map(|n| n.path.clone()));
        self.lost();
        Ok(())
    }

    fn goes(&self, path: &[String]) -> bool {
        (1..=path.len()).any(|n| path.get(..n).is_some_and(|p| self.paths.contains(p)))
    }

    /// Enters the parts all of whose declarations go.
    fn lost(&mut self) {
        let declared = self.namings.all.iter().filter(|n| n.declares);
        let stay: BTreeSet<&Part> = declared
            .clone()
            .filter(|n| !self.goes(&n.path))
            .map(|n| &n.part)
            .collect();
        let lost: Vec<Part> = declared
            .map(|n| &n.part)
            .filter(|p| !stay.contains(p))
            .cloned()
            .collect();
        self.parts.extend(lost);
    }

    /// Where what stays names what goes.
    fn users(&self) -> Vec<Naming> {
        let all = self.namings.all.iter();
        all.filter(|n| self.parts.contains(&n.part) && !self.goes(&n.path))
            .cloned()
            .collect()
    }

    /// Deletes what names something that goes.
    fn user(&mut self, user: &Naming) {
        let (section, _) = place_of(&user.path);
        let within = |n: usize| {
            user.path
                .get(..n.min(user.path.len()))
                .unwrap_or(&[])
                .to_vec()
        };
        let list = user.path.get(2).map_or("", String::as_str);
        let path = match section {
            "links" if user.path.len() > 2 => within(3),
            "studies" if matches!(list, "columns" | "plot" | "on") && user.path.len() > 3 => {
                // the last of a list takes the list with it, and a study of no link is none
                let stays = |i: &ValueMark| {
                    i.path.len() == 4 && i.path.starts_with(&within(3)) && !self.goes(&i.path)
                };
                match (
                    self.outline.values.iter().filter(|v| stays(v)).count(),
                    list,
                ) {
                    (0 | 1, "on") => within(2),
                    (0 | 1, _) => within(3),
                    _ => within(4),
                }
            }
            "studies" if matches!(list, "columns" | "plot") => within(3),
            _ => within(2),
        };
        self.paths.insert(path);
        self.lost();
    }

    fn deletion(&self, text: &str) -> Deletion {
        let outermost = |path: &Vec<String>| {
            let above = path.len().saturating_sub(1);
            !path.get(..above).is_some_and(|above| self.goes(above))
        };
        let paths: Vec<Vec<String>> = self
            .paths
            .iter()
            .filter(|p| outermost(p))
            .cloned()
            .collect();
        Deletion {
            edits: removals(text, self.outline, &paths),
            paths,
            parts: self.parts.iter().cloned().collect(),
        }
    }
}

/// The edits that take out what stands at the paths: whole lines of entries and sections, and what stands between brackets
/// with one comma.
fn removals(text: &str, outline: &Outline, paths: &[Vec<String>]) -> Vec<TextEdit> {
    let goes = |path: &[String]| paths.iter().any(|p| path.starts_with(p));
    let mut lines: Vec<Span> = Vec::new();
    let headers = outline.headers.iter().filter(|h| goes(&h.path));
    lines.extend(headers.map(|h| h.span.clone()));
    let mut taken: Vec<usize> = Vec::new();
    for (index, span) in &outline.statements {
        let statement = outline.values.get(*index);
        if statement.is_some_and(|v| goes(&v.path)) {
            taken.push(*index);
            if !lines
                .iter()
                .any(|l| l.start <= span.start && span.end <= l.end)
            {
                lines.push(span.clone());
            }
        }
    }
    let mut spans = lines.clone();
    for holder in &outline.values {
        if !matches!(holder.shape, Shape::Array | Shape::Table) || goes(&holder.path) {
            continue;
        }
        spans.extend(between_commas(text, outline, holder, &goes));
    }
    spans.sort_by_key(|s| s.start);
    spans
        .into_iter()
        .map(|span| TextEdit::new(span, ""))
        .collect()
}

/// The places between the brackets of `holder` that go, each with a comma.
fn between_commas(
    text: &str,
    outline: &Outline,
    holder: &ValueMark,
    goes: &dyn Fn(&[String]) -> bool,
) -> Vec<Span> {
    let inside = |v: &&ValueMark| {
        holder.span.start < v.whole.start
            && v.whole.end <= holder.span.end
            && v.path.len() > holder.path.len()
    };
    // those that no other holds
    let mut held: Vec<&ValueMark> = Vec::new();
    for value in outline.values.iter().filter(inside) {
        if held
            .last()
            .is_none_or(|last| last.whole.end <= value.whole.start)
        {
            held.push(value);
        }
    }
    let mut spans = Vec::new();
    let mut i = 0;
    while i < held.len() {
        if !goes(&held[i].path) {
            i += 1;
            continue;
        }
        let run = held[i..].iter().take_while(|v| goes(&v.path)).count();
        let (first, last) = (&held[i].whole, &held[i + run - 1].whole);
        spans.push(match (i.checked_sub(1), held.get(i + run)) {
            (Some(before), _) => held[before].whole.end..last.end,
            (None, Some(after)) => first.start..after.whole.start,
            (None, None) => {
                // a comma behind the last one goes too
                let rest = text.get(last.end..holder.span.end).unwrap_or("");
                let comma = rest.trim_start().starts_with(',');
                let end = match comma {
                    true => last.end + rest.find(',').unwrap_or(0) + 1,
                    false => last.end,
                };
                first.start..end
            }
        });
        i += run;
    }
    spans
}
