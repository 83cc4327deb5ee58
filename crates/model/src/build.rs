//! Models built in Rust, without a file: the builder writes the language and hands it to the reader, which checks it as it
//! checks any file.
//!
//! # Example
//!
//! A slider-crank as a synthesis would hand it over:
//!
//! ```
//! use kempe_model::build::{Entry, ModelBuilder, link, slider, study, turns};
//!
//! let checked = ModelBuilder::new("slider-crank")
//!     .units("mm", "deg")
//!     .parameter("stroke", "80 mm")
//!     .link("frame", link().point("A", [0.0, 0.0]).point("E", [0.0, -7.5]).point("F", [300.0, -7.5]))
//!     .link("crank", link().distance("A", "B", "stroke/2"))
//!     .link("rod", link().distance("B", "C", 140))
//!     .link("piston", link().point("C", [0.0, 0.0]).with("mass", "0.4 kg"))
//!     .joint("bore", slider("piston", "C", ["E", "F"]))
//!     .drive("motor", turns("crank").speed("3000 rpm"))
//!     .near("C", [180.0, -7.5])
//!     .load("gas", Entry::new().with("force", ["-900 N", "0 N"]).with("at", "C"))
//!     .measure("lift", "x(C)")
//!     .study("turn", study("forces").with("rows", 181).with("columns", ["lift", "torque(motor)"]))
//!     .build()
//!     .unwrap();
//! assert_eq!(checked.model.joints.len(), 1);
//! ```
//!
//! What is wrong is told with the same diagnostics as of a file:
//!
//! ```
//! use kempe_model::build::{ModelBuilder, link, turns};
//! let error = ModelBuilder::new("broken")
//!     .link("frame", link().point("A", [0, 0]))
//!     .link("crank", link().distance("A", "B", "20 deg"))
//!     .drive("motor", turns("crnk").speed("1 rad/s"))
//!     .build()
//!     .unwrap_err();
//! let codes: Vec<&str> = error.diagnostics.iter().map(|d| d.code).collect();
//! assert_eq!(codes, ["unit-mismatch", "unknown-name"]);
//! assert!(error.to_string().contains("did you mean `crank`?"));
//! ```

use std::fmt;

use crate::diagnostic::Diagnostic;
use crate::item::{File, Item};
use crate::model::Model;
use crate::read::Checked;
use crate::tables::Tables;
use crate::write::ModelFile;

/// A value of the language: a number in the model's units, a text with a unit, an expression or a name, a pair, a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Value(Item);

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self(Item::Number(x))
    }
}

impl From<i32> for Value {
    fn from(x: i32) -> Self {
        Self(Item::Number(f64::from(x)))
    }
}

impl From<u32> for Value {
    fn from(x: u32) -> Self {
        Self(Item::Number(f64::from(x)))
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Self(Item::Flag(flag))
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self(Item::text(text))
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self(Item::Text(text))
    }
}

impl From<Entry> for Value {
    fn from(entry: Entry) -> Self {
        Self(Item::Table(entry.0))
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(values: Vec<T>) -> Self {
        Self(Item::List(values.into_iter().map(|v| v.into().0).collect()))
    }
}

impl<T: Into<Value>, const N: usize> From<[T; N]> for Value {
    fn from(values: [T; N]) -> Self {
        Vec::from(values).into()
    }
}

/// Of values of different kinds: `[0, "-100 N"]` is `Value::from((0, "-100 N"))`.
impl<A: Into<Value>, B: Into<Value>> From<(A, B)> for Value {
    fn from((a, b): (A, B)) -> Self {
        Self(Item::List(vec![a.into().0, b.into().0]))
    }
}

/// An entry of a section: its keys are those of the model file.
///
/// The functions of this module make entries of the usual kinds; what else a kind may have is added by
/// [`with`](Self::with).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry(Vec<(String, Item)>);

impl Entry {
    /// Without keys yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// With a key of the language: `.with("angle", "30 deg")`.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.0.push((key.to_owned(), value.into().0));
        self
    }

    /// Of a link: a point by its place in the link's own coordinates, `[x, y]`, or size and angle.
    #[must_use]
    pub fn point(self, name: &str, place: impl Into<Value>) -> Self {
        self.with(name, place)
    }

    /// Of a link: the distance of two of its points. The first distance between points without coordinates lays the link's
    /// x axis.
    #[must_use]
    pub fn distance(self, a: &str, b: &str, length: impl Into<Value>) -> Self {
        self.with(&format!("{a}-{b}"), length)
    }

    /// Of a link: a point with two distances lies on the left of the line between the other two points.
    #[must_use]
    pub fn left(self, point: &str, [from, to]: [&str; 2]) -> Self {
        self.with(point, format!("left of {from} -> {to}"))
    }

    /// See [`left`](Self::left).
    #[must_use]
    pub fn right(self, point: &str, [from, to]: [&str; 2]) -> Self {
        self.with(point, format!("right of {from} -> {to}"))
    }

    /// Of a drive: where it starts.
    #[must_use]
    pub fn from(self, coordinate: impl Into<Value>) -> Self {
        self.with("from", coordinate)
    }

    /// Of a drive or a piece of its law: where it ends.
    #[must_use]
    pub fn to(self, coordinate: impl Into<Value>) -> Self {
        self.with("to", coordinate)
    }

    /// Of a drive or a piece of its law: the constant speed at which it moves.
    #[must_use]
    pub fn speed(self, speed: impl Into<Value>) -> Self {
        self.with("speed", speed)
    }

    /// Of a drive: the law by which it moves from rest to rest, such as `"cycloidal"`, and how long it takes.
    #[must_use]
    pub fn law(self, law: &str, duration: impl Into<Value>) -> Self {
        self.with("law", law).with("in", duration)
    }

    /// Of a drive: the pieces of its motion, one after the other.
    #[must_use]
    pub fn pieces(self, pieces: impl IntoIterator<Item = Self>) -> Self {
        let pieces: Vec<Self> = pieces.into_iter().collect();
        self.with("law", pieces)
    }

    /// Of a drive: the table of its motion, with columns `t` and `value`.
    #[must_use]
    pub fn measured(self, table: &str) -> Self {
        self.with("law", Self::new().with("table", table))
    }

    /// Of a drive: where it is held.
    #[must_use]
    pub fn held_at(self, coordinate: impl Into<Value>) -> Self {
        self.with("at", coordinate)
    }
}

/// A link without points yet.
pub fn link() -> Entry {
    Entry::new()
}

/// A joint: a point of the link `slider` stays on the line of another link, and the link keeps its angle to it.
pub fn slider(slider: &str, at: &str, [from, to]: [&str; 2]) -> Entry {
    Entry::new()
        .with("slider", slider)
        .with("at", at)
        .with("on", format!("{from} -> {to}"))
}

/// A joint: a pin in a straight slot of another link.
pub fn pin_in_slot(pin: &str, [from, to]: [&str; 2]) -> Entry {
    Entry::new()
        .with("pin", pin)
        .with("on", format!("{from} -> {to}"))
}

/// A joint: a pin in a slot along an arc of this radius on another link, its centre on the left of the way unless `side` is given.
pub fn pin_on_arc(pin: &str, [from, to]: [&str; 2], radius: impl Into<Value>) -> Entry {
    let entry = Entry::new().with("pin", pin);
    let entry = entry.with("arc", format!("{from} -> {to}"));
    entry.with("radius", radius)
}

/// A joint: a pin in a slot along the smooth curve through points of another link.
pub fn pin_on_curve(pin: &str, through: &[&str]) -> Entry {
    Entry::new()
        .with("pin", pin)
        .with("through", through.to_vec())
}

/// A joint: two links made one at a point that they share.
pub fn weld(a: &str, b: &str) -> Entry {
    Entry::new().with("weld", [a, b])
}

/// A joint: two gears in mesh, by their teeth or radii; the frame carries their axes unless `arm` is given.
pub fn gears(a: &str, b: &str, teeth: impl Into<Value>) -> Entry {
    Entry::new().with("gears", [a, b]).with("teeth", teeth)
}

/// A joint: a belt over two wheels, by their radii; the frame carries their axes unless `arm` is given.
pub fn belt(a: &str, b: &str, radii: impl Into<Value>) -> Entry {
    Entry::new().with("belt", [a, b]).with("radii", radii)
}

/// A joint: a chain over two wheels, by their teeth and its pitch.
pub fn chain(a: &str, b: &str, teeth: impl Into<Value>, pitch: impl Into<Value>) -> Entry {
    let entry = Entry::new().with("belt", [a, b]);
    entry.with("teeth", teeth).with("pitch", pitch)
}

/// A joint: a pinion on a rack.
pub fn rack(rack: &str, pinion: &str, radius: impl Into<Value>) -> Entry {
    Entry::new()
        .with("rack", rack)
        .with("pinion", pinion)
        .with("radius", radius)
}

/// A drive that turns a link; how it moves is still to be said.
pub fn turns(link: &str) -> Entry {
    Entry::new().with("turns", link)
}

/// A drive that changes the distance of two points: a hydraulic cylinder.
pub fn cylinder(a: &str, b: &str) -> Entry {
    Entry::new().with("cylinder", format!("{a}-{b}"))
}

/// A drive that moves a slider along its line.
pub fn slides(slider: &str) -> Entry {
    Entry::new().with("slides", slider)
}

/// A study of a kind, such as `"motion"` or `"forces"`; the language tells which there are and what each is given.
pub fn study(kind: &str) -> Entry {
    Entry::new().with("kind", kind)
}

/// Builds a model step by step; the module tells how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelBuilder {
    file: File,
    units: Vec<(String, Item)>,
    tables: Tables,
}

impl ModelBuilder {
    /// A model with a title and nothing else, its bare numbers in m and deg.
    pub fn new(title: &str) -> Self {
        let mut builder = Self::default();
        let title = ("title".to_owned(), Item::text(title));
        builder.file.head.push(title);
        builder
    }

    /// With another title.
    #[must_use]
    pub fn titled(mut self, title: &str) -> Self {
        self.file.head.retain(|(key, _)| key != "title");
        let title = ("title".to_owned(), Item::text(title));
        self.file.head.insert(0, title);
        self
    }

    /// The units of bare lengths and angles.
    #[must_use]
    pub fn units(self, length: &str, angle: &str) -> Self {
        self.unit("length", length).unit("angle", angle)
    }

    /// The unit of bare numbers of a quantity: `length`, `angle`, `force`, `torque`, `pressure`, `power` or `mass`.
    #[must_use]
    pub fn unit(mut self, quantity: &str, unit: &str) -> Self {
        self.units.push((quantity.to_owned(), Item::text(unit)));
        self
    }

    /// Gravity as `[x, y]`, as size and angle, or as a single value that points down.
    #[must_use]
    pub fn gravity(mut self, gravity: impl Into<Value>) -> Self {
        let gravity = ("gravity".to_owned(), gravity.into().0);
        self.file.head.push(gravity);
        self
    }

    /// A parameter: a plain number, or a text with a unit or an expression.
    #[must_use]
    pub fn parameter(self, name: &str, value: impl Into<Value>) -> Self {
        self.entry("parameters", name, value)
    }

    /// A link; `frame` is the one that stands still. Points named on two links are pins.
    #[must_use]
    pub fn link(self, name: &str, link: Entry) -> Self {
        self.entry("links", name, link)
    }

    /// A joint that shared points do not say.
    #[must_use]
    pub fn joint(self, name: &str, joint: Entry) -> Self {
        self.entry("joints", name, joint)
    }

    /// A drive.
    #[must_use]
    pub fn drive(self, name: &str, drive: Entry) -> Self {
        self.entry("drives", name, drive)
    }

    /// The assembly in which a point lies on the left of the line from one point to another.
    #[must_use]
    pub fn left_of(self, point: &str, [from, to]: [&str; 2]) -> Self {
        self.entry("assembly", point, format!("left of {from} -> {to}"))
    }

    /// See [`left_of`](Self::left_of).
    #[must_use]
    pub fn right_of(self, point: &str, [from, to]: [&str; 2]) -> Self {
        self.entry("assembly", point, format!("right of {from} -> {to}"))
    }

    /// The assembly in which a point is nearest to a place, or a link to an angle.
    #[must_use]
    pub fn near(self, name: &str, near: impl Into<Value>) -> Self {
        self.entry("assembly", name, Entry::new().with("near", near))
    }

    /// A load.
    #[must_use]
    pub fn load(self, name: &str, load: Entry) -> Self {
        self.entry("loads", name, load)
    }

    /// A point mass.
    #[must_use]
    pub fn mass(self, name: &str, on: &str, at: impl Into<Value>, mass: impl Into<Value>) -> Self {
        let entry = Entry::new().with("on", on).with("at", at);
        self.entry("masses", name, entry.with("mass", mass))
    }

    /// A spring.
    #[must_use]
    pub fn spring(self, name: &str, spring: Entry) -> Self {
        self.entry("springs", name, spring)
    }

    /// A measure: an expression over the mechanism.
    #[must_use]
    pub fn measure(self, name: &str, text: &str) -> Self {
        self.entry("measures", name, text)
    }

    /// A study.
    #[must_use]
    pub fn study(self, name: &str, study: Entry) -> Self {
        self.entry("studies", name, study)
    }

    /// An entry of any section of the language: `.entry("dampers", "oil", …)`.
    #[must_use]
    pub fn entry(mut self, section: &str, name: &str, value: impl Into<Value>) -> Self {
        let entry = (name.to_owned(), value.into().0);
        self.file.section(section).push(entry);
        self
    }

    /// A table that a law or a load names, as [`Tables::insert_columns`] takes it.
    #[must_use]
    pub fn table(mut self, name: &str, columns: &[(&str, &[f64])]) -> Self {
        self.tables.insert_columns(name, columns);
        self
    }

    /// The model as a file: what [`build`](Self::build) reads, and what its diagnostics point into.
    pub fn file(&self) -> ModelFile {
        let mut file = self.file.clone();
        if !self.units.is_empty() {
            let units = ("units".to_owned(), Item::Table(self.units.clone()));
            file.head.push(units);
        }
        ModelFile {
            toml: file.to_toml(),
            tables: self.tables.clone(),
        }
    }

    /// The model, with what a careful engineer would want to be told about it.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with it.
    pub fn build(&self) -> Result<Checked, BuildError> {
        let file = self.file();
        let read = Model::from_toml(&file.toml, "", &mut file.tables.files());
        read.map_err(|diagnostics| BuildError { file, diagnostics })
    }
}

/// What is wrong with a model that was built.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BuildError {
    /// The model as a file.
    pub file: ModelFile,
    /// What is wrong, with places in the file.
    pub diagnostics: Vec<Diagnostic>,
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let messages = self.diagnostics.iter();
        let messages: Vec<String> = messages
            .map(|d| d.render_plain("the model built", &self.file.toml))
            .collect();
        f.write_str(messages.join("\n").trim_end())
    }
}

impl std::error::Error for BuildError {}
