//! What is to be told of a row.

use kempe_model::PointId;
use kempe_motion::events::EventKind;

use super::{CLOSURE_LIMIT, Sample, Sampler};
use crate::force_source::ForceSource;
use crate::row_note::{NotedPlace, RowNote};

/// Smallest singular value below which a pose counts as a limit: rates mean nothing there.
const SINGULAR: f64 = 1e-9;

impl<F: ForceSource> Sampler<F> {
    /// What is to be said of a row that was reached. `still` are points that stand still whose curvature is asked for.
    pub(super) fn note(&self, p: f64, sample: &Sample, still: Vec<PointId>) -> Option<RowNote> {
        let motion = self.motion();
        let bridge = motion.bridge(p);
        if let Some(event) = bridge.filter(|e| e.kind == EventKind::ChangePoint) {
            let place = self.place(event.at);
            let started = motion.start_crossing() == Some(event) && p == motion.start;
            return Some(match started {
                true => RowNote::StartsOnChangePoint {
                    place,
                    choices: motion.choices,
                },
                false => RowNote::ChangePoint(place),
            });
        }
        if !(sample.closure <= CLOSURE_LIMIT) {
            return Some(RowNote::Open(sample.closure));
        }
        if motion.limit_at(p).is_some() || sample.smallest_singular_value < SINGULAR {
            return Some(RowNote::AtLimit);
        }
        (!still.is_empty()).then_some(RowNote::Still(still))
    }

    /// Why a path parameter was not reached.
    pub(super) fn why_unreached(&self, p: f64) -> RowNote {
        let motion = self.motion();
        let (low, high) = motion.reached();
        let (reason, at) = if p > high {
            (motion.ends.1, high)
        } else {
            (motion.ends.0, low)
        };
        RowNote::NotReached(reason, self.place(at))
    }

    fn place(&self, at: f64) -> NotedPlace {
        NotedPlace {
            drive: self.path_drive(),
            at,
        }
    }
}
