//! What the reader knows while it reads, and the small questions every section asks.

use std::collections::{BTreeMap, BTreeSet};

use kempe_units::{Unit, nearest};

use crate::diagnostic::Diagnostic;
use crate::ids::{DriveId, FRAME, JointId, LinkId, ParameterId, PointId, Span};
use crate::mend::Broken;
use crate::model::{FileUnits, Model, UnitName};
use crate::node::{Key, Node, Table, Text, Value};
use crate::read::nature::Nature;

/// Asks for a file beside the model file by its name as written.
pub(crate) type Files<'a> = &'a mut dyn FnMut(&str) -> Result<String, String>;

/// What a small-letter name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Parameter(ParameterId),
    Link(LinkId),
    /// By file order; see [`Context::joint`].
    Joint(usize),
    /// By file order; see [`Context::drive`].
    Drive(usize),
    /// By file order; see [`Context::measure`].
    Measure(usize),
}

impl Meaning {
    /// In words.
    pub fn what(self) -> &'static str {
        match self {
            Self::Parameter(_) => "a parameter",
            Self::Link(_) => "a link",
            Self::Joint(_) => "a joint",
            Self::Drive(_) => "a drive",
            Self::Measure(_) => "a measure",
        }
    }
}

/// The reader's state.
pub(crate) struct Context<'a> {
    pub files: Files<'a>,
    /// All that is to be said so far.
    pub found: Vec<Diagnostic>,
    /// What is to be said where forces are asked for.
    pub of_forces: Vec<Diagnostic>,
    /// What could not be read, or not as what it is meant to be.
    pub broken: Broken,
    /// The file's units: of length, of angle, and those it names besides.
    pub preferred: Vec<Unit>,
    /// Small-letter names: what they mean and where they are declared.
    pub names: BTreeMap<String, (Meaning, Span)>,
    /// Points by name.
    pub points: BTreeMap<String, PointId>,
    /// Which parameters have a sound value.
    pub sound: Vec<bool>,
    /// The parameters' values.
    pub values: Vec<f64>,
    /// Joints in file order: their place in the model, when they are sound.
    pub joints: Vec<Option<JointId>>,
    /// Drives in file order: their place in the model, when they are sound.
    pub drives: Vec<Option<DriveId>>,
    /// Springs by name: their place in the model and what they give, when they are sound.
    pub springs: BTreeMap<String, Option<(usize, kempe_units::Dimension)>>,
    /// Dampers by name, likewise.
    pub dampers: BTreeMap<String, Option<(usize, kempe_units::Dimension)>>,
    /// Loads by name and whether they are forces or torques; they are read after the measures that they may follow.
    pub loads: BTreeMap<String, Option<(usize, kempe_units::Dimension)>>,
    /// Switches by name, likewise: numbers.
    pub switches: BTreeMap<String, Option<(usize, kempe_units::Dimension)>>,
    /// Entries of `[cylinders]` that are not sound.
    pub broken_cylinders: BTreeSet<String>,
    /// Whether the file has clearances, sound or not.
    pub clearances_given: bool,
    /// Rows of tables read so far.
    pub table_rows: usize,
    /// Measures in file order.
    pub measures: Vec<MeasureState>,
    /// What they ask for, in the order of the model.
    pub natures: Vec<Nature>,
    /// Points whose place is broken, already told.
    pub broken_places: BTreeSet<PointId>,
    /// The model as far as it is read.
    pub model: Model,
}

/// What is known of a named measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MeasureState {
    /// Its place in the model and its dimension.
    Sound(usize, kempe_units::Dimension),
    /// It has an error of its own, already told.
    Broken,
}

impl<'a> Context<'a> {
    pub fn new(name: &str, files: Files<'a>) -> Self {
        let units = FileUnits {
            length: UnitName {
                name: "m".into(),
                factor: 1.0,
            },
            angle: UnitName {
                name: "deg".into(),
                factor: 1.0f64.to_radians(),
            },
            more: Vec::new(),
        };
        let unit = |name: &str| Unit::parse(name).unwrap_or_else(|_| Unit::one());
        Self {
            files,
            found: Vec::new(),
            of_forces: Vec::new(),
            broken: Broken::default(),
            preferred: vec![unit("m"), unit("deg")],
            names: BTreeMap::new(),
            points: BTreeMap::new(),
            sound: Vec::new(),
            values: Vec::new(),
            joints: Vec::new(),
            drives: Vec::new(),
            springs: BTreeMap::new(),
            dampers: BTreeMap::new(),
            loads: BTreeMap::new(),
            switches: BTreeMap::new(),
            broken_cylinders: BTreeSet::new(),
            clearances_given: false,
            table_rows: 0,
            measures: Vec::new(),
            natures: Vec::new(),
            broken_places: BTreeSet::new(),
            model: Model {
                title: name.to_owned(),
                units,
                parameters: Vec::new(),
                links: Vec::new(),
                points: Vec::new(),
                joints: Vec::new(),
                drives: Vec::new(),
                actions: Default::default(),
                clearances: Vec::new(),
                assembly: Vec::new(),
                drawing: Default::default(),
                measures: Vec::new(),
                studies: Vec::new(),
                bounds: Vec::new(),
                inner_laws: Vec::new(),
                source: None,
                tables: Default::default(),
                settled: Vec::new(),
            },
        }
    }

    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.found.len() < MAX_DIAGNOSTICS {
            self.found.push(diagnostic.tamed());
        }
    }

    /// Tells an error whose place says it all.
    pub fn refuse<T>(
        &mut self,
        code: &'static str,
        message: impl Into<String>,
        at: &Span,
        help: impl Into<String>,
    ) -> Option<T> {
        self.push(
            Diagnostic::error(code, message)
                .at(at.clone(), "")
                .help(help),
        );
        None
    }

    /// Whether enough has been said.
    pub fn full(&self) -> bool {
        self.found.len() >= MAX_DIAGNOSTICS
    }

    /// The first `most` entries of a section, and an error when there are more.
    pub fn limited<'e, 'd>(
        &mut self,
        entries: &'e [&'d (Key, Node)],
        most: usize,
        what: &str,
    ) -> &'e [&'d (Key, Node)] {
        if let Some((key, _)) = entries.get(most) {
            let error = Diagnostic::error("too-large", format!("{} {what}", entries.len()))
                .at(key.span.clone(), "one too many")
                .help(format!("a model has at most {most} {what}"));
            self.push(error);
        }
        entries.get(..most).unwrap_or(entries)
    }

    /// The value as a table, or an error that says what `place` is.
    pub fn table<'n>(&mut self, node: &'n Node, place: &str, example: &str) -> Option<&'n Table> {
        match &node.value {
            Value::Table(table) => Some(table),
            _ => {
                self.wrong_type(node, place, "a table", example);
                None
            }
        }
    }

    /// The value as a string.
    pub fn text<'n>(&mut self, node: &'n Node, place: &str, example: &str) -> Option<&'n Text> {
        match &node.value {
            Value::Text(text) => Some(text),
            _ => {
                self.wrong_type(node, place, "a string", example);
                None
            }
        }
    }

    /// The value as true or false.
    pub fn flag(&mut self, node: &Node, place: &str) -> Option<bool> {
        match node.value {
            Value::Bool(b) => Some(b),
            _ => {
                self.wrong_type(node, place, "true or false", "true");
                None
            }
        }
    }

    /// The value as an array.
    pub fn array<'n>(&mut self, node: &'n Node, place: &str, example: &str) -> Option<&'n [Node]> {
        match &node.value {
            Value::Array(items) => Some(items),
            _ => {
                self.wrong_type(node, place, "an array", example);
                None
            }
        }
    }

    pub fn wrong_type(&mut self, node: &Node, place: &str, wanted: &str, example: &str) {
        let found = node.what();
        self.push(
            Diagnostic::error(
                "wrong-type",
                format!("{place} must be {wanted}, found {found}"),
            )
            .at(node.span.clone(), format!("this is {found}"))
            .help(format!("write it like {example}")),
        );
    }

    /// Reports keys of a table that are not among the known ones.
    pub fn unknown_keys(&mut self, table: &Table, place: &str, known: &[&str]) {
        for (key, _) in &table.entries {
            if !known.contains(&key.name.as_str()) && !self.full() {
                self.unknown_key(key, place, known);
            }
        }
    }

    pub fn unknown_key(&mut self, key: &Key, place: &str, known: &[&str]) {
        let help = match nearest(&key.name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known here: {}", known.join(", ")),
        };
        self.push(
            Diagnostic::error(
                "unknown-key",
                format!("unknown key `{}` in {place}", key.name),
            )
            .at(key.span.clone(), "not known here")
            .help(help),
        );
    }

    /// The point of a name.
    pub fn point(&mut self, name: &str, span: Span) -> Option<PointId> {
        let found = self.points.get(name).copied();
        if found.is_none() {
            let diagnostic =
                self.no_such("point", name, span, self.points.keys().map(String::as_str));
            self.push(diagnostic);
        }
        found
    }

    /// The link of a name.
    pub fn link(&mut self, name: &str, span: Span) -> Option<LinkId> {
        if let Some((Meaning::Link(id), _)) = self.names.get(name) {
            return Some(*id);
        }
        let mut diagnostic = self.no_such(
            "link",
            name,
            span,
            self.model.links.iter().map(|l| l.name.as_str()),
        );
        if let Some((meaning, declared)) = self.names.get(name) {
            diagnostic =
                diagnostic.see(declared.clone(), format!("`{name}` is {}", meaning.what()));
        }
        self.push(diagnostic);
        None
    }

    /// An `unknown-name` error with the near name.
    pub fn no_such<'n>(
        &self,
        kind: &str,
        name: &str,
        span: Span,
        known: impl Iterator<Item = &'n str>,
    ) -> Diagnostic {
        let help = near_or_all(kind, name, known);
        Diagnostic::error("unknown-name", format!("there is no {kind} `{name}`"))
            .at(span, "not declared")
            .help(help)
    }

    /// The links that carry a point.
    pub fn carriers(&self, point: PointId) -> &[LinkId] {
        self.model
            .points
            .get(point.index())
            .map_or(&[], |p| p.links.as_slice())
    }

    pub fn point_name(&self, point: PointId) -> &str {
        self.model
            .points
            .get(point.index())
            .map_or("?", |p| p.name.as_str())
    }

    pub fn link_name(&self, link: LinkId) -> &str {
        self.model
            .links
            .get(link.index())
            .map_or("?", |l| l.name.as_str())
    }

    /// The link that carries both points, preferring those not in `not`, then the frame, then the first.
    /// Told with `span` when there is none.
    pub fn common_link(
        &mut self,
        a: PointId,
        b: PointId,
        not: Option<LinkId>,
        span: Span,
    ) -> Option<LinkId> {
        let on_b = self.carriers(b);
        let both: Vec<LinkId> = self
            .carriers(a)
            .iter()
            .copied()
            .filter(|l| on_b.binary_search(l).is_ok())
            .collect();
        let free: Vec<LinkId> = both.iter().copied().filter(|l| Some(*l) != not).collect();
        let best = free
            .iter()
            .find(|l| **l == FRAME)
            .or(free.first())
            .or(both.first())
            .copied();
        if best.is_none() {
            let (a_name, b_name) = (self.point_name(a).to_owned(), self.point_name(b).to_owned());
            let on = |point: PointId| {
                let names: Vec<&str> = self
                    .carriers(point)
                    .iter()
                    .take(8)
                    .map(|l| self.link_name(*l))
                    .collect();
                names.join(", ")
            };
            let note = format!("{a_name} is on {}; {b_name} is on {}", on(a), on(b));
            self.push(
                Diagnostic::error(
                    "no-common-link",
                    format!("no link carries both {a_name} and {b_name}"),
                )
                .at(span, "a line of a link goes through two of its points")
                .help("name two points of the same link, or add one of them to the other's link")
                .note(note),
            );
        }
        best
    }
}

/// A file with more to say than this has one trouble, not many.
pub(crate) const MAX_DIAGNOSTICS: usize = 200;

/// More names than this are not listed.
const MAX_LISTED: usize = 20;

/// Help on a name that nothing has: the near one, or those that there are.
pub(crate) fn near_or_all<'n>(
    kind: &str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
) -> String {
    let known: Vec<&str> = known.collect();
    let all = plural(kind);
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => format!("the file has no {all}"),
        None if known.len() <= MAX_LISTED && kind.contains(' ') => {
            format!("there are {}", known.join(", "))
        }
        None if known.len() <= MAX_LISTED => format!("the {all} are {}", known.join(", ")),
        None => format!(
            "the file has {} {all}, none of them near this name",
            known.len()
        ),
    }
}

/// `loads`, `switches`, `studies`.
pub(crate) fn plural(kind: &str) -> String {
    match kind.strip_suffix('y') {
        Some(stem) => format!("{stem}ies"),
        None if kind.ends_with("ch") => format!("{kind}es"),
        None => format!("{kind}s"),
    }
}
