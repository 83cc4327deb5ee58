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
        let path = above(line.trim_start().trim_start_matches('['));
        if !path.is_empty() {
            // behind `[studies.` comes a name of one's own
            return self.names_there(&path);
        }
        let sections = FILE.keys().filter(|key| has_header(key));
        sections
            .map(|key| self.one(CompletionKind::Section, key.name, key.name, key.about))
            .collect()
    }

    /// The keys that may stand at the end of what is written in the table of a path, behind `vary.` those of that table.
    pub(super) fn keys_behind(&self, path: &[String], written: &str) -> Vec<Completion> {
        self.keys(&[path, &above(written)].concat())
    }

    /// The names of parts that the table of a path may have as keys and has not yet.
    fn names_there(&self, path: &[String]) -> Vec<Completion> {
        let there = self.keys_there(path);
        let mut found = self.parts(named(path));
        let all = match path {
            [section] if section == "friction" => Some(&FRICTION_OF_ALL),
            [section] if section == "clearance" => Some(&clearance::OF_ALL),
            _ => None,
        };
        found.extend(all.map(|all| self.one(CompletionKind::Word, all.name, all.name, all.about)));
        found.retain(|c| !there.contains(c.label.as_str()));
        found
    }

    /// The keys that the table of a path may have and has not yet.
    fn keys(&self, path: &[String]) -> Vec<Completion> {
        let there = self.keys_there(path);
        let mut found = self.names_there(path);
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

/// The kinds of part whose names are keys of the table of a path.
fn named(path: &[String]) -> &'static [PartKind] {
    use PartKind as P;
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    match path.as_slice() {
        ["places"] => &[P::Point],
        ["assembly"] => &[P::Point, P::Link],
        ["friction" | "clearance"] => &[P::Point, P::Joint],
        ["cylinders" | "motors"] | ["studies", _, "at"] | ["studies", _, "fit", "timing"] => {
            &[P::Drive]
        }
        ["studies", _, "start"] => &[P::Drive, P::Point, P::Joint],
        ["studies", _, "stops"] => &[P::Link, P::Drive, P::Measure],
        ["studies", _, "vary" | "bounds"] => &[P::Parameter],
        // in a row, or as columns of a table
        ["studies", _, "deviations"] | ["studies", _, "match", _] => {
            &[P::Drive, P::Link, P::Measure]
        }
        _ => &[],
    }
}

/// The names before the last point of keys that are being written.
fn above(written: &str) -> Vec<String> {
    let mut names: Vec<&str> = written.split('.').collect();
    names.pop();
    let name = |name: &str| name.trim().trim_matches(['"', '\'']).to_owned();
    names.into_iter().map(name).collect()
}

/// Whether a key of the file is written as a header, `[links]`.
fn has_header(key: &Key) -> bool {
    matches!(key.takes, Takes::Entries(_) | Takes::Values(_))
}
