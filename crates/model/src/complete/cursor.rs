//! Where a cursor stands in a text, and the parts that it knows.

use std::collections::{BTreeMap, BTreeSet};

use crate::ids::Span;
use crate::outline::{Outline, Shape, ValueMark};
use crate::part::{Naming, Namings, Part, PartKind, is_drawn_place};
use crate::text_edit::TextEdit;

/// What a completion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CompletionKind {
    /// A section of the file.
    Section,
    /// A key of an entry.
    Key,
    /// The name of a part.
    Part(PartKind),
    /// A measure of the mechanism.
    Measure,
    /// A function of numbers.
    Function,
    /// A unit.
    Unit,
    /// One of the words that a key may have.
    Word,
}

/// Something that may stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Completion {
    /// The name or word.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// The edit that enters it in place of the word at the cursor.
    pub edit: TextEdit,
    /// What it means, in one sentence; may be empty.
    pub doc: String,
}

/// A cursor in a text.
pub(super) struct Cursor<'t> {
    pub text: &'t str,
    pub offset: usize,
    pub outline: &'t Outline,
    pub known: Known,
}

impl Cursor<'_> {
    pub fn before(&self) -> &str {
        self.text.get(..self.offset).unwrap_or("")
    }

    /// The string in which the cursor stands.
    pub fn string(&self) -> Option<&ValueMark> {
        let raw = |v: &ValueMark| self.text.get(v.span.clone()).unwrap_or("");
        let holds = |v: &&ValueMark| {
            let quoted = raw(v).starts_with(['"', '\'']);
            let open = v.shape == Shape::Bare;
            quoted
                && v.span.start < self.offset
                && (self.offset < v.span.end || (open && self.offset == v.span.end))
        };
        self.outline.values.iter().rev().find(holds)
    }

    /// The innermost brackets around the cursor.
    pub fn holder(&self) -> Option<&ValueMark> {
        let holds = |v: &&ValueMark| {
            let raw = self.text.get(v.span.clone()).unwrap_or("");
            let close = match v.shape {
                Shape::Array => ']',
                Shape::Table => '}',
                _ => return false,
            };
            let open = raw.len() == 1 || !raw.ends_with(close);
            let line_ends = |span: &Span| {
                // what is not closed goes on to the end of its line
                let rest = self.text.get(span.end..self.offset);
                open && rest.is_some_and(|rest| rest.trim_matches([' ', '\t', ',']).is_empty())
            };
            v.span.start < self.offset && (self.offset < v.span.end || line_ends(&v.span))
        };
        self.outline.values.iter().rev().find(holds)
    }

    /// What stands before the cursor since the last entry of the brackets.
    pub fn since_comma(&self, holder: &ValueMark) -> &str {
        let within =
            |v: &&ValueMark| holder.span.start < v.span.start && v.path.len() > holder.path.len();
        let ended = self.outline.values.iter().filter(within);
        let ended = ended.map(|v| v.span.end).filter(|end| *end < self.offset);
        let from = ended.max().unwrap_or(holder.span.start + 1);
        let since = self.text.get(from..self.offset).unwrap_or("");
        since.rsplit(',').next().unwrap_or(since)
    }

    /// The word in which the cursor stands.
    pub fn word(&self) -> Span {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let before = self.before();
        let start = before.trim_end_matches(is_name).len();
        let after = self.text.get(self.offset..).unwrap_or("");
        let end = self.offset + (after.len() - after.trim_start_matches(is_name).len());
        start..end
    }

    pub fn one(&self, kind: CompletionKind, label: &str, insert: &str, doc: &str) -> Completion {
        Completion {
            label: label.to_owned(),
            kind,
            edit: TextEdit::new(self.word(), insert),
            doc: doc.to_owned(),
        }
    }

    /// The names of the parts of some kinds.
    pub fn parts(&self, kinds: &[PartKind]) -> Vec<Completion> {
        let parts = self.known.parts.iter();
        parts
            .filter(|(part, _)| kinds.contains(&part.kind))
            .map(|(part, doc)| {
                self.one(CompletionKind::Part(part.kind), &part.name, &part.name, doc)
            })
            .collect()
    }
}

/// The parts of a text with a word about each.
pub(super) struct Known {
    pub parts: Vec<(Part, String)>,
    /// The points of each link, in the order of writing.
    pub points: BTreeMap<String, Vec<String>>,
}

impl Known {
    pub fn new(text: &str, outline: &Outline) -> Self {
        let namings = Namings::new(text, outline);
        let mut parts: Vec<(Part, String)> = Vec::new();
        let mut known: BTreeSet<&Part> = BTreeSet::new();
        let mut points: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut links: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        let values: BTreeMap<&[String], &ValueMark> = outline
            .values
            .iter()
            .map(|v| (v.path.as_slice(), v))
            .collect();
        let offered = |n: &&Naming| n.declares || is_drawn_place(&n.path);
        for naming in namings.all.iter().filter(offered) {
            let name = naming.part.name.as_str();
            if let (PartKind::Point, [section, link, ..]) =
                (naming.part.kind, naming.path.as_slice())
                && section == "links"
            {
                let on = links.entry(name).or_default();
                if !on.contains(&link.as_str()) {
                    on.push(link);
                    points
                        .entry(link.clone())
                        .or_default()
                        .push(name.to_owned());
                }
            }
            if known.insert(&naming.part) {
                let written = values.get(naming.path.as_slice());
                let written = written.and_then(|v| text.get(v.span.clone()));
                let doc = first_line(naming.part.kind.word(), written.unwrap_or(""));
                parts.push((naming.part.clone(), doc));
            }
        }
        for (part, doc) in parts.iter_mut().filter(|(p, _)| p.kind == PartKind::Point) {
            let on = links.get(part.name.as_str()).cloned().unwrap_or_default();
            *doc = match on.as_slice() {
                [] => "point that no link names".to_owned(),
                on => format!("point of {}", on.join(", ")),
            };
        }
        Self { parts, points }
    }
}

/// A part in its file's words, cut where they get long.
fn first_line(word: &str, written: &str) -> String {
    const SHOWN: usize = 80;
    let line = written.lines().next().unwrap_or("");
    let shown: String = line.chars().take(SHOWN).collect();
    match shown.is_empty() {
        true => word.to_owned(),
        false => format!("{word}: {shown}"),
    }
}

/// Of those with one label the first.
pub(super) fn once(mut found: Vec<Completion>) -> Vec<Completion> {
    let mut known = BTreeSet::new();
    found.retain(|c| known.insert(c.label.clone()));
    found
}
