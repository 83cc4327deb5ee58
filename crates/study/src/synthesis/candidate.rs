//! A linkage that is right where it is asked, before anybody has looked how it moves there.

use kempe_model::{Diagnostic, DriveId, Model, ModelFile};
use kempe_synthesis::{Pose, Turning};
use kempe_units::Dimension;

use super::beside::Beside;
use super::file::{STUDY, file_of};
use super::own_linkage::{OwnLinkage, Wanted, links_of};
use crate::result::{Figure, Listing};
use crate::table::Table;
use crate::unit::Units;

/// What a task leads to.
#[derive(Default)]
pub(super) struct Found {
    /// All that are right where it is asked.
    pub candidates: Vec<Candidate>,
    /// Those that already their geometry rules out.
    pub rejected: Vec<Rejected>,
    /// How many there can be, and how they were looked for.
    pub searched: String,
    /// What was tried where not all linkages are known.
    pub tried: Option<Listing>,
    /// Linkages ruled out, or not looked at, that are only counted there.
    pub counted: usize,
    /// What became of the solutions that generic data have: names and numbers.
    pub counts: Vec<(&'static str, usize)>,
    /// All that solve the equations, used or not, where they are to be seen.
    pub solutions: Option<Table>,
    /// Poses that a body is guided through, where that is the task.
    pub guided: Vec<Pose>,
    /// What is drawn of the task itself.
    pub figure: Option<Figure>,
    /// What is to be known of the search.
    pub warnings: Vec<Diagnostic>,
}

/// A linkage that is of no use.
pub(super) struct Rejected {
    /// The linkage by its dimensions.
    pub what: String,
    /// Why.
    pub why: String,
}

/// What is right where it is asked, before anybody has looked how it moves.
pub(super) enum Candidate {
    /// A linkage of its own.
    Linkage(Box<OwnLinkage>),
    /// Links beside those of the request.
    Beside(Box<Beside>),
}

impl From<OwnLinkage> for Candidate {
    fn from(it: OwnLinkage) -> Self {
        Self::Linkage(Box::new(it))
    }
}

impl From<Beside> for Candidate {
    fn from(it: Beside) -> Self {
        Self::Beside(Box::new(it))
    }
}

impl Candidate {
    /// Its file under a title, with the parameters of the request that its measures name: their names, and what is written behind them.
    pub fn file(&self, title: &str, request: &Model, parameters: &[(String, String)]) -> ModelFile {
        match self {
            Self::Linkage(it) => file_of(it, request, parameters).titled(title).file(),
            Self::Beside(it) => it.titled(title),
        }
    }

    /// Its own parameters and links by their names in its file, for questions that name something else.
    pub fn names(&self) -> String {
        match self {
            Self::Linkage(_) => "points A to D (P, where one is guided), links `crank`, `coupler` and `rocker` (or `slider`, `lever`), the drive `motor`, and the measures `transmission_angle`, `link_ratio`, `full_turn` and, of four-bars, `grashof`".to_owned(),
            Self::Beside(it) => format!("all that this file names, and {}", it.names),
        }
    }

    /// The study of its file that moves it.
    pub fn study(&self) -> &str {
        match self {
            Self::Linkage(_) => STUDY,
            Self::Beside(it) => &it.study,
        }
    }

    /// The drive that moves it.
    pub fn driven(&self, model: &Model) -> Option<DriveId> {
        let id = match self {
            Self::Linkage(_) => DriveId(0),
            Self::Beside(it) => it.drive,
        };
        model.drives.get(id.index()).map(|_| id)
    }

    /// The lengths by which it is known, by their names in its file, m.
    pub fn lengths(&self) -> Vec<(&str, f64)> {
        match self {
            Self::Linkage(it) => it.lengths(),
            Self::Beside(it) => {
                let lengths = it.lengths.iter();
                lengths
                    .map(|(name, length)| (name.as_str(), *length))
                    .collect()
            }
        }
    }

    /// The lengths of its links, m.
    pub fn links(&self) -> Vec<f64> {
        links_of(&self.lengths())
    }

    /// Numbers that are told of it besides: name, value (SI), what it measures.
    pub fn told(&self) -> &[(String, f64, Dimension)] {
        match self {
            Self::Linkage(it) => &it.told,
            Self::Beside(it) => &it.told,
        }
    }

    /// Measures that are told of it, whatever is asked.
    pub fn columns(&self) -> &[String] {
        match self {
            Self::Linkage(_) => &[],
            Self::Beside(it) => &it.columns,
        }
    }

    /// What it must do, so that it can be held against what it does.
    pub fn wanted(&self) -> &[Wanted] {
        match self {
            Self::Linkage(it) => &it.wanted,
            Self::Beside(it) => &it.wanted,
        }
    }

    /// Whether whole turns of an angle that it must have count, as those of a dial do.
    pub fn counts_turns(&self) -> bool {
        matches!(self, Self::Linkage(it) if it.turned.is_some())
    }

    /// What it is ordered by where nothing else is said: a number that is known, or else a measure.
    pub fn order(&self) -> Order<'_> {
        match self {
            Self::Linkage(it) => match it.told.first() {
                Some((_, known, _)) => Order::Known(*known),
                None => Order::Measure(LINK_RATIO),
            },
            Self::Beside(it) => Order::Measure(&it.rank),
        }
    }
}

/// What linkages are ordered by.
pub(super) enum Order<'a> {
    Known(f64),
    Measure(&'a str),
}

/// The measure of a linkage by which it is ordered where nothing else is said.
pub(super) const LINK_RATIO: &str = "link_ratio";

/// Lengths in words: `crank 27.6 mm, coupler 57.2 mm`.
pub(super) fn dimensions_in_words(lengths: &[(&str, f64)], units: &Units) -> String {
    let all = lengths.iter().map(|(name, length)| {
        format!(
            "{} {}",
            name.trim_end_matches("_length"),
            units.text(*length, Dimension::LENGTH)
        )
    });
    all.collect::<Vec<_>>().join(", ")
}

/// Whether two values of a measure are one but for whole turns of an angle; what is between them.
pub(super) fn apart(a: f64, b: f64, dimension: Dimension) -> f64 {
    match dimension == Dimension::ANGLE {
        true => kempe_number::math::within_half_a_turn(a - b).abs(),
        false => (a - b).abs(),
    }
}

/// How far a crank is moved to either side of a place that stands alone, rad, where it can.
const AROUND: f64 = 0.35;
/// And in parts of the way to the next dead centre.
const PART: f64 = 0.9;

/// From where to where a crank is moved that is asked for at one angle (rad, counted as its turning is).
pub(super) fn around(angle: f64, turning: Turning) -> [f64; 2] {
    let room = match turning {
        Turning::Crank => AROUND,
        Turning::Rocker { middle, half } => {
            let off = kempe_number::math::within_half_a_turn(angle - middle);
            (PART * (half - off.abs()).max(0.0)).min(AROUND)
        }
    };
    [angle - room, angle + room]
}
