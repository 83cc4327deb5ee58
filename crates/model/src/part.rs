//! The parts of a model that have a name, and where a text names them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use kempe_units::{Kind, Node, parse_argument, parse_condition};

use crate::ids::Span;
use crate::key_path::{is_index, takes_at};
use crate::keys::{Named, Takes};
use crate::node::Text;
use crate::outline::{KeyMark, Outline, Shape, ValueMark, string};
use crate::read::names::{LISTED, is_point_name, pair_of};
use crate::read::play_start::RATE;
use crate::registry::{Argument, Registry};

/// The kinds of part that have a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum PartKind {
    /// Of `[parameters]`.
    Parameter,
    /// Of `[links]`.
    Link,
    /// A point of links.
    Point,
    /// Of `[joints]`.
    Joint,
    /// Of `[drives]`.
    Drive,
    /// Of `[measures]`.
    Measure,
    /// Of `[studies]`.
    Study,
    /// Of `[loads]`.
    Load,
    /// Of `[masses]`.
    Mass,
    /// Of `[springs]`.
    Spring,
    /// Of `[dampers]`.
    Damper,
    /// Of `[switches]`.
    Switch,
}

impl PartKind {
    /// In words: `link`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Link => "link",
            Self::Point => "point",
            Self::Joint => "joint",
            Self::Drive => "drive",
            Self::Measure => "measure",
            Self::Study => "study",
            Self::Load => "load",
            Self::Mass => "mass",
            Self::Spring => "spring",
            Self::Damper => "damper",
            Self::Switch => "switch",
        }
    }

    /// The kinds of part that an argument of a measure may name.
    pub(crate) fn that_may_be(argument: Argument) -> &'static [Self] {
        match argument {
            Argument::Point(_) | Argument::Line => &[Self::Point],
            Argument::Link | Argument::OtherLink => &[Self::Link],
            Argument::Slider => &[Self::Joint, Self::Link],
            Argument::Joint => &[Self::Joint],
            Argument::Drive => &[Self::Drive],
            Argument::Spring => &[Self::Spring],
            Argument::Damper => &[Self::Damper],
            Argument::Load => &[Self::Load],
            Argument::Switch => &[Self::Switch],
            Argument::Measure | Argument::Order | Argument::Time | Argument::Value => &[],
        }
    }

    /// Whether its names share one space with those of parameters, links, joints, drives and measures.
    pub(crate) fn is_common(self) -> bool {
        COMMON.contains(&self)
    }
}

/// The kinds whose names share one space.
const COMMON: [PartKind; 5] = [
    PartKind::Parameter,
    PartKind::Link,
    PartKind::Joint,
    PartKind::Drive,
    PartKind::Measure,
];

/// Sections whose entries are parts.
const SECTIONS: &[(&str, PartKind)] = &[
    ("parameters", PartKind::Parameter),
    ("links", PartKind::Link),
    ("joints", PartKind::Joint),
    ("drives", PartKind::Drive),
    ("measures", PartKind::Measure),
    ("studies", PartKind::Study),
    ("loads", PartKind::Load),
    ("masses", PartKind::Mass),
    ("springs", PartKind::Spring),
    ("dampers", PartKind::Damper),
    ("switches", PartKind::Switch),
];

/// A part by its kind and name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Part {
    /// What it is.
    pub kind: PartKind,
    /// Its name.
    pub name: String,
}

impl Part {
    /// The part of a kind and name.
    pub fn new(kind: PartKind, name: impl Into<String>) -> Self {
        Self {
            kind,
            name: name.into(),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} `{}`", self.kind.word(), self.name)
    }
}

/// A place of a text that names a part.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Naming {
    /// The part.
    pub part: Part,
    /// The name as written.
    pub span: Span,
    /// The path of the key or the value in which it stands.
    pub path: Vec<String>,
    /// Whether the part is described here: its entry, or what says of a point that a link has it.
    pub declares: bool,
    /// The key in which the name stands, if it stands in one.
    pub(crate) key: Option<Span>,
}

/// What a text names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Namings {
    /// In the order of writing.
    pub all: Vec<Naming>,
    /// Values that would name something if they could be read.
    pub unread: Vec<Span>,
}

impl Namings {
    pub fn new(text: &str, outline: &Outline) -> Self {
        let mut finder = Finder {
            text,
            common: BTreeMap::new(),
            points: BTreeSet::new(),
            out: Self::default(),
        };
        for key in &outline.keys {
            finder.declare(key);
        }
        for key in &outline.keys {
            finder.key(key);
        }
        for value in &outline.values {
            finder.value(value);
        }
        finder.out.all.sort_by_key(|n| n.span.start);
        finder.out
    }

    /// The places that name a part.
    pub fn of<'n>(&'n self, part: &'n Part) -> impl Iterator<Item = &'n Naming> {
        self.all.iter().filter(move |n| n.part == *part)
    }

    pub fn declared(&self, part: &Part) -> bool {
        self.of(part).any(|n| n.declares)
    }
}

/// The parts of a text in the order in which they are declared, each with the place of its (first) name.
///
/// The text may have errors: what can be found line by line is found.
///
/// # Example
///
/// ```
/// use kempe_model::{PartKind, parts};
/// let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = \n[drives]\nmotor = { turns = \"cr";
/// let found = parts(text);
/// let links: Vec<&str> = found.iter().filter(|p| p.0.kind == PartKind::Link).map(|p| p.0.name.as_str()).collect();
/// assert_eq!(links, ["frame", "crank"]);
/// assert_eq!(&text[found[1].1.clone()], "A");
/// ```
pub fn parts(text: &str) -> Vec<(Part, Span)> {
    let namings = Namings::new(text, &Outline::new(text));
    let mut known = BTreeSet::new();
    let declared = namings.all.into_iter().filter(|n| n.declares);
    declared
        .filter(|n| known.insert(n.part.clone()))
        .map(|n| (n.part, n.span))
        .collect()
}

/// All places of a text that name a part, in the order of writing.
///
/// # Example
///
/// ```
/// use kempe_model::{Part, PartKind, namings};
/// let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n[measures]\nh = \"2 * y(B)\"\n";
/// let b = namings(text, &Part::new(PartKind::Point, "B"));
/// assert_eq!(b.len(), 2);
/// assert_eq!(b[1].path, ["measures", "h"]);
/// ```
pub fn namings(text: &str, part: &Part) -> Vec<Naming> {
    let namings = Namings::new(text, &Outline::new(text));
    namings.of(part).cloned().collect()
}

/// Whether a path is that of a point's place in `[places]`, which goes with the point.
pub(crate) fn is_drawn_place(path: &[String]) -> bool {
    matches!(path, [section, _] if section == "places")
}

/// The section and entry of a path, as far as it goes.
pub(crate) fn place_of(path: &[String]) -> (&str, &str) {
    let part = |i: usize| path.get(i).map_or("", String::as_str);
    (part(0), part(1))
}

struct Finder<'t> {
    text: &'t str,
    /// Names of the space that parameters, links, joints, drives and measures share.
    common: BTreeMap<String, PartKind>,
    /// Names of points.
    points: BTreeSet<String>,
    out: Namings,
}

impl Finder<'_> {
    fn declare(&mut self, key: &KeyMark) {
        if let [section, .., name] = key.path.as_slice()
            && ["links", "places"].contains(&section.as_str())
        {
            let single = is_point_name(name).then_some(name.as_str());
            let pair = pair_of(name).map(<[&str; 2]>::from);
            let named = single.into_iter().chain(pair.into_iter().flatten());
            self.points.extend(named.map(str::to_owned));
        }
        let [section, name] = key.path.as_slice() else {
            return;
        };
        let kind = SECTIONS.iter().find(|(known, _)| known == section);
        if let Some((_, kind)) = kind.filter(|(_, kind)| kind.is_common()) {
            self.common.entry(name.clone()).or_insert(*kind);
        }
    }

    fn push(&mut self, part: Part, span: Span, path: &[String], key: Option<(bool, Span)>) {
        self.out.all.push(Naming {
            part,
            span,
            path: path.to_vec(),
            declares: key.as_ref().is_some_and(|(declares, _)| *declares),
            key: key.map(|(_, span)| span),
        });
    }

    /// What a name of the common space stands for.
    fn common(&self, name: &str) -> Option<Part> {
        let kind = self.common.get(name)?;
        Some(Part::new(*kind, name))
    }

    fn key(&mut self, key: &KeyMark) {
        let raw = self.text.get(key.span.clone()).unwrap_or("");
        let quotes = usize::from(raw.starts_with(['"', '\'']));
        // where escapes stand the places in the name are not sure
        if raw.contains('\\') {
            return;
        }
        let within = |from: usize, name: &str| {
            let start = key.span.start + quotes + from;
            start..start + name.len()
        };
        let here = |declares: bool| Some((declares, key.span.clone()));
        match key.path.as_slice() {
            [section, name] => {
                let part = match section.as_str() {
                    "friction" | "clearance" | "assembly" | "places" if is_point_name(name) => {
                        Some(Part::new(PartKind::Point, name))
                    }
                    "friction" | "clearance" if name == "all" => None,
                    "friction" | "clearance" | "assembly" | "cylinders" | "motors" => {
                        self.common(name)
                    }
                    _ => {
                        let kind = SECTIONS.iter().find(|(known, _)| known == section);
                        kind.map(|(_, kind)| Part::new(*kind, name))
                    }
                };
                let Some(part) = part else { return };
                let entry = SECTIONS.iter().any(|(known, _)| known == section);
                self.push(part, within(0, name), &key.path, here(entry));
            }
            [section, _, of, name]
                if section == "studies" && ["at", "start", "stops"].contains(&of.as_str()) =>
            {
                // of how fast a drive starts, the drive; of how fast a journal does, its point
                let rate_of = name.strip_suffix(RATE).filter(|_| of == "start");
                let named = [Some(name.as_str()), rate_of].into_iter().flatten();
                let point = |name: &str| {
                    let known = of == "start" && self.points.contains(name);
                    known.then(|| Part::new(PartKind::Point, name))
                };
                let mut known = named
                    .filter_map(|name| Some((name, self.common(name).or_else(|| point(name))?)));
                if let Some((name, part)) = known.next() {
                    self.push(part, within(0, name), &key.path, here(false));
                }
            }
            [section, _, of, name]
                if section == "studies"
                    && ["deviations", "bounds", "vary"].contains(&of.as_str()) =>
            {
                self.named_key(name, within(0, name), key);
            }
            [section, _, of, _, name] if section == "studies" && of == "match" => {
                self.named_key(name, within(0, name), key);
            }
            [section, _, of, timing, name]
                if section == "studies" && of == "fit" && timing == "timing" =>
            {
                self.named_key(name, within(0, name), key);
            }
            [section, _, name] if section == "links" => {
                let single = is_point_name(name).then_some((0, name.as_str()));
                let pair = pair_of(name).map(|(a, b)| {
                    let dash = name.find('-').unwrap_or(0);
                    let behind = name.get(dash + 1..).unwrap_or("");
                    let blanks = behind.len() - behind.trim_start().len();
                    [
                        (name.len() - name.trim_start().len(), a),
                        (dash + 1 + blanks, b),
                    ]
                });
                for (from, name) in single.into_iter().chain(pair.into_iter().flatten()) {
                    let part = Part::new(PartKind::Point, name);
                    self.push(part, within(from, name), &key.path, here(true));
                }
            }
            _ => {}
        }
    }

    /// A key that is the name of something declared elsewhere.
    fn named_key(&mut self, name: &str, span: Span, key: &KeyMark) {
        if let Some(part) = self.common(name) {
            self.push(part, span, &key.path, Some((false, key.span.clone())));
        }
    }

    fn value(&mut self, value: &ValueMark) {
        // of whatever kind the entry is
        let takes = takes_at(&value.path, &|_, kinds| kinds.to_vec());
        let names = match takes.as_slice() {
            // a key of later versions
            [] => value.path.len() > 1,
            known => known.iter().any(may_name),
        };
        if !names {
            return;
        }
        if value.shape == Shape::Bare {
            // a string that is not closed
            let raw = self.text.get(value.span.clone()).unwrap_or("");
            if raw.starts_with(['"', '\'']) {
                self.out.unread.push(value.span.clone());
            }
            return;
        }
        let Some(text) = string(self.text, value) else {
            if value.shape == Shape::Text {
                self.out.unread.push(value.span.clone());
            }
            return;
        };
        // Springs and studies have names of their own.
        let own = takes.iter().find_map(|t| match t {
            Takes::Name(Named::Spring) => Some(PartKind::Spring),
            Takes::Name(Named::Study) => Some(PartKind::Study),
            _ => None,
        });
        if let Some(kind) = own {
            let name = text.content.trim().to_owned();
            let from = text.content.len() - text.content.trim_start().len();
            let span = text.span(from..from + name.len());
            self.push(Part::new(kind, name), span, &value.path, None);
            return;
        }
        let is_word =
            |t: &Takes| matches!(t, Takes::Words(words) if words.contains(&text.content.trim()));
        if takes.iter().any(is_word) {
            return;
        }
        let from = after_side(&text.content);
        let phrase = text.content.get(from..).unwrap_or("");
        match parse_argument(phrase) {
            Ok(tree) => self.tree(&tree, &text, from, &value.path),
            // goals of studies to come compare
            Err(_) => match parse_condition(phrase) {
                Ok(condition) => {
                    for side in [&condition.left, &condition.right] {
                        self.tree(side, &text, from, &value.path);
                    }
                }
                Err(_) => self.out.unread.push(value.span.clone()),
            },
        }
    }

    fn tree(&mut self, tree: &Node, text: &Text, from: usize, path: &[String]) {
        // arguments that are names of their own kind
        let mut own: Vec<(Span, Part)> = Vec::new();
        tree.visit(&mut |node| {
            if let Kind::Call {
                function,
                arguments,
                ..
            } = &node.kind
                && let Some(kind) = named_by(function)
                && let [argument] = arguments.as_slice()
                && let Some(name) = argument.as_name()
            {
                own.push((argument.span.clone(), Part::new(kind, name)));
            }
        });
        tree.visit(&mut |node| {
            let part = match &node.kind {
                Kind::Point(name) if lists_point(path) => {
                    let span = text.span(from + node.span.start..from + node.span.end);
                    self.out.all.push(Naming {
                        part: Part::new(PartKind::Point, name),
                        span,
                        path: path.to_vec(),
                        declares: true,
                        key: None,
                    });
                    None
                }
                Kind::Point(name) => Some(Part::new(PartKind::Point, name)),
                Kind::Name(name) => match own.iter().find(|(span, _)| *span == node.span) {
                    Some((_, part)) => Some(part.clone()),
                    None => self.common(name),
                },
                _ => None,
            };
            if let Some(part) = part {
                let span = text.span(from + node.span.start..from + node.span.end);
                self.push(part, span, path, None);
            }
        });
    }
}

/// Whether a path is that of a name in a link's list of points, alone or behind `points`.
fn lists_point(path: &[String]) -> bool {
    match path {
        [section, _, index] => section == "links" && is_index(index),
        [section, _, key, _] => section == "links" && key == LISTED,
        _ => false,
    }
}

/// The kind of part whose names a function takes, where they have a space of their own.
fn named_by(function: &str) -> Option<PartKind> {
    let mut arguments = Registry::find(function)?.arguments().flatten();
    let kinds = arguments.find_map(|one| PartKind::that_may_be(*one).first());
    kinds
        .copied()
        .filter(|kind| !kind.is_common() && *kind != PartKind::Point)
}

/// The byte behind `left of` or `right of`.
fn after_side(content: &str) -> usize {
    match content.split_once(" of ") {
        Some((side, rest)) if matches!(side.trim(), "left" | "right") => content.len() - rest.len(),
        _ => 0,
    }
}

/// Whether a text that is such a value may name parts: no word of the language or of a person, and no file.
fn may_name(takes: &Takes) -> bool {
    match takes {
        Takes::Text | Takes::Unit(_) | Takes::Words(_) => false,
        Takes::Name(named) => !matches!(named, Named::File | Named::Column),
        // no text
        Takes::Table(_) | Takes::List(..) | Takes::Two(_) => false,
        _ => true,
    }
}
