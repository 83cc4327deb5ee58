//! What a key of the model file is: the rows of the table that the reader, the schema, help and the docs share.

use kempe_units::Dimension;

/// A key of the model file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As it is written.
    pub name: &'static str,
    /// What stands behind the `=`.
    pub takes: Takes,
    /// Whether it must be there.
    pub need: Need,
    /// A value of it, as TOML; of a section, a line of it.
    pub example: &'static str,
    /// What it says, in one sentence.
    pub about: &'static str,
}

/// Whether a key must be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// It must.
    Required,
    /// It may be left out.
    Optional,
    /// One of the keys of its kind that are marked so must be there, and one alone.
    OneOf,
}

/// What a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Takes {
    /// Any string.
    Text,
    /// A name of something.
    Name(Named),
    /// The name of a unit of a dimension.
    Unit(Dimension),
    /// `true` or `false`.
    Flag,
    /// A whole number from 1 to this one.
    Count(usize),
    /// A value: a bare number in the file's unit, or a string with a unit or an expression over parameters.
    Value(Quantity),
    /// A value whose dimension is seen from its text.
    AnyValue,
    /// `[x, y]`, or `[size, angle]`, of a dimension.
    Pair(Dimension),
    /// A directed line, `A -> B`.
    Line,
    /// A pair of points, `A-B`.
    PointPair,
    /// A side of a directed line, `left of A -> B`.
    Side,
    /// A measure of the motion.
    Measure,
    /// What acts at every instant: a value, a measure of the motion, or a table with these keys.
    Amount(&'static Kind),
    /// One of some words.
    Words(&'static [&'static str]),
    /// Two of a kind in brackets.
    Two(&'static Takes),
    /// At least so many in brackets.
    List(&'static Takes, usize),
    /// Any of these.
    AnyOf(&'static [Takes]),
    /// A table with these keys.
    Table(&'static Kind),
    /// Names of the user's choice, each with such a value.
    Values(&'static Takes),
    /// Names of the user's choice, each with a table of one of these kinds.
    Entries(&'static [&'static Kind]),
}

/// What a name is the name of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// A point.
    Point,
    /// A link.
    Link,
    /// A link that slides, or the joint that guides it.
    Slider,
    /// A parameter.
    Parameter,
    /// A drive.
    Drive,
    /// A spring.
    Spring,
    /// A study.
    Study,
    /// A file beside the model.
    File,
    /// A column of a file.
    Column,
}

/// The dimension of a value, and which sizes it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Its dimension; of what acts along a line where [`turning`](Self::turning) is another.
    pub dimension: Dimension,
    /// Its dimension where the entry is about what turns.
    pub turning: Dimension,
    /// Which sizes it may have.
    pub sign: Sign,
}

/// Which sizes a value may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Any.
    Any,
    /// Zero or more.
    NotNegative,
    /// More than zero.
    Positive,
}

/// A kind of table: an entry of a section, or a table inside one.
#[derive(Debug)]
pub struct Kind {
    /// What it is: `spring`.
    pub what: &'static str,
    /// Which kind of several it is: of a joint or drive the key that makes it one, of a study the word behind `kind`.
    pub name: &'static str,
    /// Its keys, in groups that kinds may share.
    pub groups: &'static [&'static [Key]],
    /// Keys with names of the user's choice: `P` stands for a point, `A-B` for a pair of points.
    pub points: &'static [Key],
    /// The key whose value may stand alone for the whole table: `["A", "B"]` for `{ points = ["A", "B"] }`.
    pub alone: Option<&'static str>,
    /// A whole one, as TOML.
    pub example: &'static str,
    /// What it is, in one sentence.
    pub about: &'static str,
}

impl Kind {
    /// Its keys, in the order of the reference.
    pub fn keys(&self) -> impl Iterator<Item = &'static Key> + Clone + use<> {
        self.groups.iter().copied().flatten()
    }

    /// The key of a name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys().find(|key| key.name == name)
    }

    /// An example of the value of a key.
    pub fn example_of(&self, key: &str) -> &'static str {
        self.key(key).map_or("", |row| row.example)
    }

    /// The key whose value may stand for the whole table.
    pub fn alone(&self) -> Option<&'static Key> {
        self.alone.and_then(|name| self.key(name))
    }

    /// The names of its keys.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        self.keys().map(|key| key.name).collect()
    }
}

impl Quantity {
    /// The dimension for something that turns or does not.
    pub fn of(self, turning: bool) -> Dimension {
        if turning {
            self.turning
        } else {
            self.dimension
        }
    }
}

impl Takes {
    /// What is to be written, in words: `a length, positive`.
    pub fn in_words(&self) -> String {
        match self {
            Self::Text => "a string".to_owned(),
            Self::Name(named) => named.in_words().to_owned(),
            Self::Unit(dimension) => format!("a unit of {dimension}"),
            Self::Flag => "true or false".to_owned(),
            Self::Count(most) => format!("a whole number from 1 to {most}"),
            Self::Value(quantity) => quantity.in_words(),
            Self::AnyValue => "a value".to_owned(),
            Self::Pair(Dimension::LENGTH) => "[x, y] or [radius, angle]".to_owned(),
            Self::Pair(dimension) => format!("[x, y] or [size, angle] of {dimension}"),
            Self::Line => "a line, A -> B".to_owned(),
            Self::PointPair => "two points, A-B".to_owned(),
            Self::Side => "left of A -> B, or right of A -> B".to_owned(),
            Self::Measure => "a measure".to_owned(),
            Self::Amount(_) => {
                "a value, a measure of the motion, or a table from a file".to_owned()
            }
            Self::Words(words) => words.join(", "),
            Self::Two(one) => format!("two in brackets: {}", one.in_words()),
            Self::List(one, least) => format!("{least} or more in brackets: {}", one.in_words()),
            Self::AnyOf(some) => {
                let some: Vec<String> = some.iter().map(Self::in_words).collect();
                some.join("; or ")
            }
            Self::Table(kind) => {
                let keys: Vec<&str> = kind.names();
                format!("{{ {} }}", keys.join(", "))
            }
            Self::Values(one) => format!("names, each with {}", one.in_words()),
            Self::Entries(_) => "names, each with a table".to_owned(),
        }
    }
}

impl Named {
    /// `the name of a link`.
    fn in_words(self) -> &'static str {
        match self {
            Self::Point => "the name of a point",
            Self::Link => "the name of a link",
            Self::Slider => "the name of a slider, or of the joint that guides it",
            Self::Parameter => "the name of a parameter",
            Self::Drive => "the name of a drive",
            Self::Spring => "the name of a spring",
            Self::Study => "the name of a study",
            Self::File => "the name of a file beside the model",
            Self::Column => "the name of a column of the file",
        }
    }
}

impl Quantity {
    fn in_words(self) -> String {
        let mut words = self.dimension.with_article();
        if self.turning != self.dimension {
            words += &format!(", {} where it turns", self.turning.with_article());
        }
        words
            + match self.sign {
                Sign::Any => "",
                Sign::NotNegative => ", not negative",
                Sign::Positive => ", positive",
            }
    }
}
