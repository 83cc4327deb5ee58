//! What may stand in a string: names of parts, words, expressions.

use kempe_units::{Builtin, UNITS};

use crate::complete::cursor::{Completion, CompletionKind, Cursor, once};
use crate::key_table::SIDES;
use crate::keys::{Named, Takes};
use crate::outline::{ValueMark, string};
use crate::part::{PartKind, place_of};
use crate::read::names::is_point_name;
use crate::registry::{Argument, Registry};

impl Cursor<'_> {
    pub(super) fn in_string(&self, value: &ValueMark) -> Vec<Completion> {
        let content = self.content(value);
        let takes = self.takes_at(&value.path);
        let mut found = Vec::new();
        for one in &takes {
            found.extend(match one {
                Takes::Words(words) => self.words(words, value),
                Takes::Name(named) => self.names(*named, &value.path),
                Takes::Line | Takes::PointPair => self.parts(&[PartKind::Point]),
                Takes::Side => self.side(content, &value.path),
                Takes::Unit(_) => self.units(),
                _ => Vec::new(),
            });
        }
        let is_measure = takes.iter().any(|t| matches!(t, Takes::Measure));
        let is_value = |t: &Takes| matches!(t, Takes::Value(_) | Takes::AnyValue);
        if is_measure || takes.iter().any(is_value) {
            found.extend(self.expression(content, is_measure));
        }
        once(found)
    }

    fn words(&self, words: &[&str], value: &ValueMark) -> Vec<Completion> {
        let one = |word: &&str| {
            let mut one = self.one(CompletionKind::Word, word, word, "");
            // words may have blanks and signs: the whole text is one
            one.edit.span = self.inner(value);
            one
        };
        words.iter().map(one).collect()
    }

    fn names(&self, named: Named, path: &[String]) -> Vec<Completion> {
        let (section, _) = place_of(path);
        let key = path.get(2).map_or("", String::as_str);
        match (named, section, key) {
            (Named::Point, "joints", "at") => self.points_of(path, "slider"),
            (Named::Point, "joints", "center") => self.points_of(path, "pinion"),
            (Named::Point, "loads" | "masses", "at") => self.points_of(path, "on"),
            (Named::Point, ..) => self.parts(&[PartKind::Point]),
            (Named::Link, ..) => self.parts(&[PartKind::Link]),
            (Named::Slider, ..) => self.parts(&[PartKind::Joint, PartKind::Link]),
            (Named::Parameter, ..) => self.parts(&[PartKind::Parameter]),
            (Named::Drive, ..) => self.parts(&[PartKind::Drive]),
            (Named::Spring, ..) => self.parts(&[PartKind::Spring]),
            (Named::Study, ..) => self.parts(&[PartKind::Study]),
            (Named::File | Named::Column, ..) => Vec::new(),
        }
    }

    /// A side of a line, of a point.
    fn side(&self, content: &str, path: &[String]) -> Vec<Completion> {
        if !path.last().is_some_and(|name| is_point_name(name)) {
            return Vec::new();
        }
        if content.contains(" of ") {
            return self.parts(&[PartKind::Point]);
        }
        let words = SIDES.iter().map(|(word, _)| *word);
        let words = words.filter(|word| word.ends_with(" of"));
        let doc = "as seen by somebody walking along the line";
        words
            .map(|word| self.one(CompletionKind::Word, word, &format!("{word} "), doc))
            .collect()
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

    /// Points of the link that a key of the entry names; all where it names none.
    fn points_of(&self, path: &[String], key: &str) -> Vec<Completion> {
        let mut sibling = path.get(..2).unwrap_or(path).to_vec();
        sibling.push(key.to_owned());
        let link = self.outline.value(&sibling);
        let link = link.and_then(|value| string(self.text, value));
        let on_link = link.and_then(|link| self.known.points.get(link.content.trim()));
        let mut points = self.parts(&[PartKind::Point]);
        if let Some(on_link) = on_link {
            points.retain(|c| on_link.contains(&c.label));
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
                let brackets = match entry.arguments().next() {
                    None => "",
                    Some(_) => "(",
                };
                let insert = format!("{}{brackets}", entry.name);
                found.push(self.one(CompletionKind::Measure, entry.name, &insert, entry.doc));
            }
        }
        for builtin in Builtin::ALL {
            let insert = format!("{}(", builtin.name());
            let function = CompletionKind::Function;
            found.push(self.one(function, builtin.name(), &insert, builtin.usage()));
        }
        found.push(self.one(CompletionKind::Word, "pi", "pi", "3.14159…"));
        once(found)
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
        let wanted = entry.arguments().filter_map(|all| all.get(argument));
        let wanted: Vec<Argument> = wanted.copied().collect();
        if wanted.contains(&Argument::Measure) {
            return self.values(true);
        }
        if wanted.contains(&Argument::Value) {
            return self.values(false);
        }
        let kinds = wanted.into_iter().flat_map(PartKind::that_may_be);
        let kinds: Vec<PartKind> = kinds.copied().collect();
        self.parts(&kinds)
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
