//! What a careful engineer would want to be told about a row.

use kempe_model::PointId;
use kempe_motion::events::EventKind;
use kempe_motion::motion::EndReason;
use kempe_units::{Dimension, Unit, format_digits};

use super::{CLOSURE_LIMIT, Sample, Sampler};
use crate::force_source::ForceSource;

/// Digits of a place in a note.
const NOTE_DIGITS: usize = 12;

impl<F: ForceSource> Sampler<F> {
    /// What is to be said of a row that was reached. `still` are points that stand still whose curvature is asked for.
    pub(super) fn note(&self, p: f64, sample: &Sample, still: &[PointId]) -> Option<String> {
        if let Some(event) = self
            .motion()
            .bridge(p)
            .filter(|e| e.kind == EventKind::ChangePoint)
        {
            let at = self.place_text(event.at);
            let started = self.motion().start_crossing() == Some(event) && p == self.motion().start;
            return Some(match self.motion().choices {
                1 if started => format!(
                    "change point at {at}, where the motion starts: it follows the branch through it that fits the hints in \
                     [assembly], interpolated from both sides"
                ),
                n if started => format!(
                    "change point at {at}, where the motion starts: {n} branches through it fit the hints in [assembly], \
                     and it follows the first, interpolated from both sides; a side, or a near place a little further on, \
                     chooses"
                ),
                _ => format!(
                    "change point at {at}: the motion goes on smoothly, interpolated from both sides"
                ),
            });
        }
        if !(sample.closure <= CLOSURE_LIMIT) {
            return Some(format!(
                "does not close: residual {:e} of the mechanism's size",
                sample.closure
            ));
        }
        let singular = self.motion().limit_at(p).is_some() || sample.smallest_singular_value < 1e-9;
        if singular {
            return Some("limit of the drive: rates are not defined here".into());
        }
        let points = &self.motion().mechanism().model.points;
        let names: Vec<&str> = (still.iter())
            .filter_map(|p| Some(points.get(p.index())?.name.as_str()))
            .collect();
        (!names.is_empty()).then(|| {
            let stand = if names.len() == 1 { "stands" } else { "stand" };
            let names = names.join(", ");
            format!("{names} {stand} still: no curvature of path here")
        })
    }

    /// Why a path parameter was not reached.
    pub(super) fn why_unreached(&self, p: f64) -> String {
        let motion = self.motion();
        let (low, high) = motion.reached();
        let (reason, at) = if p > high {
            (motion.ends.1, high)
        } else {
            (motion.ends.0, low)
        };
        let at = self.place_text(at);
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

    /// A path parameter with its unit, as the file would say it.
    fn place_text(&self, p: f64) -> String {
        let model = &self.motion().mechanism().model;
        let dimension = match self.path_drive() {
            Some(drive) => model.drives.get(drive.index()).map(|d| d.dimension),
            None => None,
        };
        let unit = match dimension {
            Some(Dimension::ANGLE) => Unit::parse(&model.units.angle.name),
            Some(_) => Unit::parse(&model.units.length.name),
            None => Unit::parse("s"),
        };
        match unit {
            Ok(unit) => format_digits(p, &unit, NOTE_DIGITS),
            // A file's unit is one that was read; in SI at the worst.
            Err(_) => format!("{p} in SI"),
        }
    }
}
