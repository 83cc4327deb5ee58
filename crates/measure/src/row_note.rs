//! What a careful engineer would want to be told about a row.

use kempe_mechanism::Mechanism;
use kempe_model::{DriveId, PointId};
use kempe_motion::motion::EndReason;
use kempe_units::{Dimension, Unit, format_digits};

/// Digits of a place in a note.
const NOTE_DIGITS: usize = 12;

/// A place on a path: its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotedPlace {
    /// The drive whose coordinate the parameter is; time without one.
    pub drive: Option<DriveId>,
    /// The parameter, SI.
    pub at: f64,
}

/// What is to be told of a row.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RowNote {
    /// Branches meet here; the row is interpolated from both sides.
    ChangePoint(NotedPlace),
    /// The same where the motion starts.
    StartsOnChangePoint {
        /// Where.
        place: NotedPlace,
        /// How many branches fit the file's hints.
        choices: usize,
    },
    /// A joint stands open by this part of the mechanism's size.
    Open(f64),
    /// A limit of the drive: rates are not defined.
    AtLimit,
    /// Points that stand still, whose curvature of path is asked for.
    Still(Vec<PointId>),
    /// The motion ended before, there.
    NotReached(EndReason, NotedPlace),
    /// No pose was found where the motion should have one.
    NoPose,
}

impl RowNote {
    /// The note as a sentence.
    pub fn text(&self, mechanism: &Mechanism) -> String {
        let place = |place: &NotedPlace| place.text(mechanism);
        match self {
            Self::ChangePoint(at) => format!(
                "change point at {}: the motion goes on smoothly, interpolated from both sides",
                place(at)
            ),
            Self::StartsOnChangePoint {
                place: at,
                choices: 1,
            } => format!(
                "change point at {}, where the motion starts: it follows the branch through it that fits the hints in \
                 [assembly], interpolated from both sides",
                place(at)
            ),
            Self::StartsOnChangePoint { place: at, choices } => format!(
                "change point at {}, where the motion starts: {choices} branches through it fit the hints in [assembly], \
                 and it follows the first, interpolated from both sides; a side, or a near place a little further on, \
                 chooses",
                place(at)
            ),
            Self::Open(closure) => {
                format!("does not close: residual {closure:e} of the mechanism's size")
            }
            Self::AtLimit => "limit of the drive: rates are not defined here".into(),
            Self::Still(points) => {
                let names: Vec<&str> = (points.iter())
                    .filter_map(|p| Some(mechanism.model.points.get(p.index())?.name.as_str()))
                    .collect();
                let stand = if names.len() == 1 { "stands" } else { "stand" };
                let names = names.join(", ");
                format!("{names} {stand} still: no curvature of path here")
            }
            Self::NotReached(reason, at) => {
                let at = place(at);
                match reason {
                    EndReason::Limit => format!("not reached: the drive's limit is at {at}"),
                    EndReason::TooLong => {
                        format!("beyond {at}: the range is longer than can be followed")
                    }
                    EndReason::Stuck => {
                        format!("not reached: the motion could not be followed beyond {at}")
                    }
                    EndReason::Runaway => {
                        format!("not reached: a part runs away to infinity beyond {at}")
                    }
                    EndReason::Covered => "not reached: outside the motion".into(),
                }
            }
            Self::NoPose => "no pose was found here".into(),
        }
    }
}

impl NotedPlace {
    /// The place with its unit, as the file would say it.
    fn text(&self, mechanism: &Mechanism) -> String {
        let model = &mechanism.model;
        let dimension = (self.drive)
            .and_then(|drive| model.drives.get(drive.index()))
            .map(|drive| drive.dimension);
        let unit = match dimension {
            Some(Dimension::ANGLE) => Unit::parse(&model.units.angle.name),
            Some(_) => Unit::parse(&model.units.length.name),
            None => Unit::parse("s"),
        };
        match unit {
            Ok(unit) => format_digits(self.at, &unit, NOTE_DIGITS),
            // A file's unit is one that was read; in SI at the worst.
            Err(_) => format!("{} in SI", self.at),
        }
    }
}
