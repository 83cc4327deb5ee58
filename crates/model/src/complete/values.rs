//! What may stand in a string: names of parts, words, expressions.

use kempe_units::{Builtin, UNITS};

use crate::complete::cursor::{Completion, CompletionKind, Cursor};
use crate::model::RiseLaw;
use crate::outline::{ValueMark, string};
use crate::part::{PartKind, place_of};
use crate::read::force_names::bare_names;
use crate::read::{choices, springs, studies};
use crate::registry::Registry;

/// What a value's text is made of.
enum Role {
    /// One of some words.
    Words(Vec<&'static str>),
    /// Names of parts.
    Parts(Vec<PartKind>),
    /// Points, of the link that a key of the same entry names.
    PointsOf(&'static [&'static str]),
    /// A side of a line.
    Side,
    /// A unit alone.
    Unit,
    /// An expression over parameters.
    Scalar,
    /// An expression over the mechanism.
    Measure,
    /// Something of one's own: a title, a file.
    Own,
}

impl Cursor<'_> {
    pub(super) fn in_string(&self, value: &ValueMark) -> Vec<Completion> {
        let content = self.content(value);
        match role(&value.path) {
            Role::Own => Vec::new(),
            Role::Words(words) => words
                .into_iter()
                .map(|word| {
                    let mut one = self.one(CompletionKind::Word, word, word, "");
                    // words may have blanks and signs: the whole text is one
                    one.edit.span = self.inner(value);
                    one
                })
                .collect(),
            Role::Parts(kinds) => self.parts(&kinds),
            Role::PointsOf(keys) => self.points_of(&value.path, keys),
            Role::Side => {
                let mut found = Vec::new();
                if !content.contains(" of ") {
                    for side in ["left of ", "right of "] {
                        found.push(self.one(
                            CompletionKind::Word,
                            side.trim_end(),
                            side,
                            "as seen by somebody walking along the line",
                        ));
                    }
                    return found;
                }
                self.parts(&[PartKind::Point])
            }
            Role::Unit => self.units(),
            Role::Scalar => self.expression(content, false),
            Role::Measure => self.expression(content, true),
        }
    }

    /// The text of a string up to the cursor.
    fn content(&self, value: &ValueMark) -> &str {
        let from = self.inner(value).start;
        self.text.get(from..self.offset).unwrap_or("")
    }

    /// The place between the quotes.
    fn inner(&self, value: &ValueMark) -> std::ops::Range<usize> {
        let raw = self.text.get(value.span.clone()).unwrap_or("");
        let quotes = ["\"\"\"", "'''"].iter().any(|q| raw.starts_with(q));
        let quotes = if quotes { 3 } else { 1 };
        let closed = value.shape == crate::outline::Shape::Text;
        let start = (value.span.start + quotes).min(self.offset);
        let end = value.span.end - if closed { quotes } else { 0 };
        start..end.max(self.offset)
    }

    /// Points of the link that one of some keys of the entry names; all where none does.
    fn points_of(&self, path: &[String], keys: &[&str]) -> Vec<Completion> {
        let entry = path.get(..2).unwrap_or(path);
        let named = keys.iter().find_map(|key| {
            let sibling: Vec<String> = entry.iter().cloned().chain([(*key).to_owned()]).collect();
            let link = string(self.text, self.outline.value(&sibling)?)?;
            self.known.points.get(link.content.trim())
        });
        let mut points = self.parts(&[PartKind::Point]);
        if let Some(named) = named {
            points.retain(|c| named.contains(&c.label));
        }
        points
    }

    fn units(&self) -> Vec<Completion> {
        let one = |unit: &kempe_units::UnitDefinition| {
            self.one(CompletionKind::Unit, unit.symbol, unit.symbol, unit.doc)
        };
        UNITS.iter().map(one).collect()
    }

    fn expression(&self, content: &str, measures: bool) -> Vec<Completion> {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let before = content.trim_end_matches(is_name);
        let word = content.get(before.len()..).unwrap_or("");
        // behind a number stands its unit; digits just before the cursor are the number itself
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            return Vec::new();
        }
        if ends_in_number(before) {
            return self.units();
        }
        if measures && let Some((function, argument)) = call(before) {
            return self.argument(function, argument, before);
        }
        self.values(measures)
    }

    /// Everything that has a value.
    fn values(&self, measures: bool) -> Vec<Completion> {
        let mut found = match measures {
            true => self.parts(&[PartKind::Parameter, PartKind::Drive, PartKind::Measure]),
            false => self.parts(&[PartKind::Parameter]),
        };
        if measures {
            found.push(self.one(
                CompletionKind::Word,
                "time",
                "time",
                "since the start of the motion",
            ));
            for entry in Registry::all() {
                let brackets = if bare_names().any(|name| name == entry.name) {
                    ""
                } else {
                    "("
                };
                let insert = format!("{}{brackets}", entry.name);
                found.push(self.one(CompletionKind::Measure, entry.name, &insert, entry.doc));
            }
        }
        for builtin in Builtin::ALL {
            let known = found.iter().any(|c| c.label == builtin.name());
            if !known {
                let insert = format!("{}(", builtin.name());
                found.push(self.one(
                    CompletionKind::Function,
                    builtin.name(),
                    &insert,
                    builtin.usage(),
                ));
            }
        }
        found.push(self.one(CompletionKind::Word, "pi", "pi", "3.14159…"));
        found
    }

    /// What may be an argument of a function, by how the function is called.
    fn argument(&self, function: &str, argument: usize, before: &str) -> Vec<Completion> {
        if matches!(function, "path" | "hodograph") {
            return self.parts(&[PartKind::Point, PartKind::Joint, PartKind::Link]);
        }
        let Some(entry) = Registry::find(function) else {
            return self.values(true);
        };
        // behind `A ->` comes the line's other end
        if before.trim_end().ends_with("->") {
            return self.parts(&[PartKind::Point]);
        }
        let mut kinds: Vec<PartKind> = Vec::new();
        let mut values = false;
        for signature in entry.signatures {
            let inner = signature.split_once('(').map_or("", |(_, rest)| rest);
            let inner = inner.trim_end_matches(')');
            let Some(name) = inner.split(',').nth(argument).map(str::trim) else {
                continue;
            };
            kinds.extend_from_slice(match name {
                "link" | "other" => &[PartKind::Link],
                "drive" => &[PartKind::Drive],
                "slider" => &[PartKind::Joint, PartKind::Link],
                "joint" => &[PartKind::Joint],
                "spring" => &[PartKind::Spring],
                "damper" => &[PartKind::Damper],
                "load" => &[PartKind::Load],
                "n" | "time" => &[],
                name if name.starts_with(char::is_uppercase) => &[PartKind::Point],
                _ => {
                    values = true;
                    &[]
                }
            });
        }
        match values {
            true => self.values(true),
            false => self.parts(&kinds),
        }
    }
}

/// Whether a text ends in a number and blanks, so that a unit may follow.
fn ends_in_number(text: &str) -> bool {
    let text = text.trim_end();
    let number = text.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    number.len() < text.len() && !number.ends_with(is_name)
}

/// The function whose bracket is open at the end of a text, and the number of the argument there.
fn call(text: &str) -> Option<(&str, usize)> {
    let (mut depth, mut commas) = (0_usize, 0);
    for (at, sign) in text.char_indices().rev() {
        match sign {
            ')' => depth += 1,
            '(' if depth > 0 => depth -= 1,
            '(' => {
                let before = text.get(..at)?.trim_end();
                let is_name = |c: char| c.is_alphanumeric() || c == '_';
                let start = before.trim_end_matches(is_name).len();
                let name = before.get(start..)?;
                return (!name.is_empty()).then_some((name, commas));
            }
            ',' if depth == 0 => commas += 1,
            _ => {}
        }
    }
    None
}

/// What the value of a path is made of.
fn role(path: &[String]) -> Role {
    let (section, entry) = place_of(path);
    let is_index = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    let mut keys = path.iter().rev().filter(|part| !is_index(part));
    let key = keys.next().map_or("", String::as_str);
    let point = entry.starts_with(char::is_uppercase);
    match (section, key) {
        ("title", _) | (_, "table" | "argument") => Role::Own,
        ("drives" | "loads", "time" | "value") => Role::Own,
        ("units", _) => Role::Unit,
        ("studies", "kind") => Role::Words(studies::KINDS.iter().map(|k| k.0).collect()),
        ("studies", "goal") => Role::Words(choices::GOALS.iter().map(|g| g.0).collect()),
        ("springs", "acts") => Role::Words(springs::ACTS.iter().map(|a| a.0).collect()),
        ("drives", "law" | "by") => Role::Words(RiseLaw::ALL.iter().map(|l| l.name()).collect()),
        ("joints", "side") => Role::Words(vec!["left", "right"]),
        ("studies", "spring") => Role::Parts(vec![PartKind::Spring]),
        ("studies", "drive") => Role::Parts(vec![PartKind::Drive]),
        ("studies", "on") => Role::Parts(vec![PartKind::Link]),
        ("joints", "slider" | "rack" | "pinion" | "weld" | "gears" | "arm") => {
            Role::Parts(vec![PartKind::Link])
        }
        ("drives", "turns" | "relative_to") => Role::Parts(vec![PartKind::Link]),
        ("drives", "slides") => Role::Parts(vec![PartKind::Joint, PartKind::Link]),
        ("loads", "on" | "axes" | "against") | ("masses", "on") => {
            Role::Parts(vec![PartKind::Link])
        }
        ("springs" | "dampers", "links") => Role::Parts(vec![PartKind::Link]),
        ("joints", "at") => Role::PointsOf(&["slider"]),
        ("joints", "center") => Role::PointsOf(&["pinion"]),
        ("loads" | "masses", "at") => Role::PointsOf(&["on"]),
        ("joints", "pin" | "on") | ("drives", "cylinder") | ("springs" | "dampers", "between") => {
            Role::Parts(vec![PartKind::Point])
        }
        ("assembly", _) if point && path.len() == 2 => Role::Side,
        ("links", key)
            if key.starts_with(char::is_uppercase) && !key.contains('-') && path.len() == 3 =>
        {
            Role::Side
        }
        ("links", "center") if path.len() == 3 => Role::Parts(vec![PartKind::Point]),
        ("measures", _) | ("studies", "columns" | "plot" | "wanted") => Role::Measure,
        ("loads", "force" | "torque" | "over") => Role::Measure,
        _ => Role::Scalar,
    }
}
