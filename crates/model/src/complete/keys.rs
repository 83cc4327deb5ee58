//! Sections and keys that may stand at a place.

use crate::complete::cursor::{Completion, CompletionKind, Cursor};
use crate::outline::ValueMark;
use crate::part::{PartKind, place_of};
use crate::read::{
    actuators, choices, drives, friction, joints, law_table, laws, links, loads, masses, sections,
    springs, studies,
};

impl Cursor<'_> {
    /// The names that a header may have.
    pub(super) fn headers(&self, line: &str) -> Vec<Completion> {
        // behind `[studies.` comes a name of one's own
        if line.contains('.') {
            return Vec::new();
        }
        let values = ["title", "units", "gravity"];
        let sections = sections::FILE_KEYS.iter().filter(|k| !values.contains(k));
        sections
            .map(|key| self.one(CompletionKind::Section, key, key, ""))
            .collect()
    }

    /// The keys that the table of a path may have and has not yet; `inline` where it stands between braces.
    pub(super) fn keys(&self, path: &[String], inline: Option<&ValueMark>) -> Vec<Completion> {
        let has = |key: &str| {
            let mut keys = self.outline.keys.iter();
            keys.any(|k| {
                k.path.len() == path.len() + 1
                    && k.path.starts_with(path)
                    && k.path.last().is_some_and(|last| last == key)
                    && !(k.span.start <= self.offset && self.offset <= k.span.end)
            })
        };
        let (section, _) = place_of(path);
        let mut found = match (section, path.len()) {
            ("assembly", 1) => self.parts(&[PartKind::Point, PartKind::Link]),
            ("friction", 1) => {
                let mut found = self.parts(&[PartKind::Point, PartKind::Joint]);
                found.push(self.one(
                    CompletionKind::Word,
                    "all",
                    "all",
                    "every pin and slider that has no entry of its own",
                ));
                found
            }
            ("cylinders" | "motors", 1) => self.parts(&[PartKind::Drive]),
            ("links", 2) => self.parts(&[PartKind::Point]),
            _ => Vec::new(),
        };
        let insert = |key: &str| match (inline, path.is_empty()) {
            (None, true) if !["title", "units", "gravity"].contains(&key) => format!("[{key}]"),
            _ => format!("{key} = "),
        };
        let kind = match path.is_empty() {
            true => CompletionKind::Section,
            false => CompletionKind::Key,
        };
        for key in keys_of(path, &has) {
            found.push(self.one(kind, key, &insert(key), ""));
        }
        found.retain(|c| !has(&c.label));
        found
    }
}

/// The keys of the language for the table of a path, given which keys it has. The one place that asks the reader's lists.
fn keys_of(path: &[String], has: &dyn Fn(&str) -> bool) -> Vec<&'static str> {
    let (section, _) = place_of(path);
    let key = path.get(2).map_or("", String::as_str);
    let list = |keys: &[&'static str]| keys.to_vec();
    // of one kind if its key is there, else of all
    let of_kinds = |kinds: &[(&'static str, &[&'static str])]| {
        let kind = kinds.iter().find(|(kind, _)| has(kind));
        let mut keys: Vec<&'static str> = match kind {
            Some((_, keys)) => keys.to_vec(),
            None => kinds.iter().flat_map(|(_, keys)| *keys).copied().collect(),
        };
        let mut known = std::collections::BTreeSet::new();
        keys.retain(|key| known.insert(*key));
        keys
    };
    match (section, path.len()) {
        ("", 0) => list(sections::FILE_KEYS),
        ("units", 1) => list(sections::UNIT_KEYS),
        ("links", 2) => list(links::LINK_KEYS),
        ("links", 3) if key == "bar" => list(masses::BAR_KEYS),
        ("joints", 2) => {
            let kinds: Vec<(&str, &[&str])> = joints::JOINT_KEYS
                .iter()
                .map(|(kind, keys, _)| (*kind, *keys))
                .collect();
            of_kinds(&kinds)
        }
        ("drives", 2) => {
            let mut kinds = drives::DRIVE_KINDS.iter().map(|(kind, _)| *kind);
            let mut keys = match kinds.clone().find(|kind| has(kind)) {
                Some("turns") => vec!["relative_to"],
                Some(_) => Vec::new(),
                None => kinds.by_ref().collect(),
            };
            keys.extend(laws::LAW_KEYS);
            keys
        }
        ("drives", 3) if key == "law" => list(law_table::TABLE_KEYS),
        ("drives", 4) if key == "law" => list(laws::PIECE_KEYS),
        ("assembly", 2) => vec!["near"],
        ("loads", 2) => of_kinds(&[("force", loads::FORCE_KEYS), ("torque", loads::TORQUE_KEYS)]),
        ("loads", 3 | 4) => list(loads::LOAD_TABLE_KEYS),
        ("masses", 2) => list(masses::MASS_KEYS),
        ("springs", 2) => list(springs::SPRING_KEYS),
        ("dampers", 2) => list(springs::DAMPER_KEYS),
        ("friction", 2) => list(friction::FRICTION_KEYS),
        ("cylinders", 2) => list(actuators::CYLINDER_KEYS),
        ("motors", 2) => list(actuators::MOTOR_KEYS),
        ("studies", 2) => match (has("on") || has("goal"), has("spring") || has("wanted")) {
            (true, _) => list(choices::BALANCE_KEYS),
            (_, true) => list(choices::SPRING_KEYS),
            _ => {
                let kinds = studies::KINDS.iter();
                let kinds: Vec<(&str, &[&str])> = kinds.map(|(k, keys, _)| (*k, *keys)).collect();
                of_kinds(&kinds)
            }
        },
        _ => Vec::new(),
    }
}
