//! Sections and keys that may stand at a place.

use std::collections::BTreeSet;

use crate::complete::cursor::{Completion, CompletionKind, Cursor, once};
use crate::key_path::{Kinds, takes_at};
use crate::key_table::{FILE, FRICTION_OF_ALL, clearance};
use crate::keys::{Key, Kind, Need, Takes};
use crate::outline::string;
use crate::part::{PartKind, place_of};
use crate::read::names::is_point_name;

impl Cursor<'_> {
    /// The names that a header may have.
    pub(super) fn headers(&self, line: &str) -> Vec<Completion> {
        // behind `[studies.` comes a name of one's own
        if line.contains('.') {
            return Vec::new();
        }
        let sections = FILE.keys().filter(|key| has_header(key));
        sections
            .map(|key| self.one(CompletionKind::Section, key.name, key.name, key.about))
            .collect()
    }

    /// The keys that the table of a path may have and has not yet.
    pub(super) fn keys(&self, path: &[String]) -> Vec<Completion> {
        let there = self.keys_there(path);
        let (section, _) = place_of(path);
        let mut found = match (section, path.len()) {
            ("places", 1) => self.parts(&[PartKind::Point]),
            ("assembly", 1) => self.parts(&[PartKind::Point, PartKind::Link]),
            ("friction" | "clearance", 1) => {
                let mut found = self.parts(&[PartKind::Point, PartKind::Joint]);
                let all = match section {
                    "friction" => &FRICTION_OF_ALL,
                    _ => &clearance::OF_ALL,
                };
                found.push(self.one(CompletionKind::Word, all.name, all.name, all.about));
                found
            }
            ("cylinders" | "motors", 1) => self.parts(&[PartKind::Drive]),
            ("studies", 3) if path.last().is_some_and(|key| key == "at") => {
                self.parts(&[PartKind::Drive])
            }
            _ => Vec::new(),
        };
        for takes in self.takes_at(path) {
            let Takes::Table(kind) = takes else { continue };
            if !kind.points.is_empty() {
                found.extend(self.parts(&[PartKind::Point]));
            }
            // of those of which there is one alone, one may be there
            let one_of = |key: &Key| key.need == Need::OneOf;
            let chosen = kind
                .keys()
                .any(|key| one_of(key) && there.contains(key.name));
            for key in kind.keys().filter(|key| !(chosen && one_of(key))) {
                let (what, insert) = match (path.is_empty(), has_header(key)) {
                    (true, true) => (CompletionKind::Section, format!("[{}]", key.name)),
                    (true, false) => (CompletionKind::Section, format!("{} = ", key.name)),
                    (false, _) => (CompletionKind::Key, format!("{} = ", key.name)),
                };
                found.push(self.one(what, key.name, &insert, key.about));
            }
        }
        found.retain(|c| !there.contains(c.label.as_str()));
        once(found)
    }

    /// What the value of a path may be, as far as its entries tell of which kinds they are.
    pub(super) fn takes_at(&self, path: &[String]) -> Vec<Takes> {
        takes_at(path, &|entry, kinds| self.kinds_of(entry, kinds))
    }

    /// The kinds of which an entry is, or which it may be as far as it is written.
    fn kinds_of(&self, entry: &[String], kinds: &[&'static Kind]) -> Kinds {
        let there = self.keys_there(entry);
        let mut path = entry.to_vec();
        path.push("kind".to_owned());
        let word = self.outline.value(&path);
        let word = word.and_then(|value| string(self.text, value));
        let diagnostic = |kind: &Kind| match place_of(entry) {
            ("friction" | "clearance", name) if is_point_name(name) => kind.name == "pin",
            ("friction" | "clearance", name) if name == FRICTION_OF_ALL.name => kind.name == name,
            ("friction" | "clearance", _) => kind.name == "joint",
            _ => {
                let of_word = word.as_ref().is_some_and(|w| w.content.trim() == kind.name);
                of_word || there.contains(kind.name)
            }
        };
        if let Some(kind) = kinds.iter().find(|kind| diagnostic(kind)) {
            return vec![kind];
        }
        // those that know the most of the keys
        let knows = |kind: &Kind| kind.keys().filter(|k| there.contains(k.name)).count();
        let most = kinds.iter().map(|kind| knows(kind)).max();
        let kinds = kinds.iter().copied();
        kinds.filter(|kind| Some(knows(kind)) == most).collect()
    }

    /// The keys that the table of a path has, besides the one at the cursor.
    fn keys_there(&self, path: &[String]) -> BTreeSet<&str> {
        let keys = self.outline.keys.iter();
        keys.filter(|k| !(k.span.start <= self.offset && self.offset <= k.span.end))
            .filter_map(|k| k.path.split_last())
            .filter(|(_, table)| *table == path)
            .map(|(name, _)| name.as_str())
            .collect()
    }
}

/// Whether a key of the file is written as a header, `[links]`.
fn has_header(key: &Key) -> bool {
    matches!(key.takes, Takes::Entries(_) | Takes::Values(_))
}
