//! What the rows of a design warn of, beside what its motion and its numbers tell.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, StudyKind};
use kempe_motion::{Motion, Silent};
use kempe_units::Dimension;

use super::bench::Bench;
use crate::along::Along;
use crate::columns::Asked;
use crate::motion::abscissa;
use crate::rows::places_along;
use crate::sink::RowSink;
use crate::slot_ends::{has_ends, left_slots};
use crate::table::Column;
use crate::unit::Units;

/// Whether rows may warn of anything: forces, and pins that leave their slots.
pub(super) fn may_warn(model: &Model, kind: &StudyKind) -> bool {
    matches!(kind, StudyKind::Forces(_)) || has_ends(model) && matches!(kind, StudyKind::Motion(_))
}

/// What the rows of a motion warn of, as the study that is run would; nothing where there are none.
pub(super) fn of_rows(bench: &Bench<'_>, motion: &Arc<Motion>) -> Vec<Diagnostic> {
    let (model, study) = (bench.model, bench.over.kind.along());
    let parameters = &motion.design.parameters;
    let (units, asked) = (Units::of(model), Asked::default());
    let time = Column::new("time", units.unit(Dimension::TIME));
    let mut sink = RowSink::new(&bench.over.name, model, &units, &asked, time);
    let places = places_along(motion, study, parameters);
    let forces = matches!(bench.over.kind, StudyKind::Forces(_));
    let along = Along::with_progress(model, motion, &[], forces, &places, &mut Silent);
    let Ok(mut along) = along else {
        return Vec::new();
    };
    let mut frame = |place| {
        let row = along.row(place);
        sink.push(motion.mechanism(), row.sample.time, row)
    };
    let frames: Vec<_> = places.iter().map(|place| frame(*place)).collect();
    let by = abscissa(motion, parameters);
    let mut told = sink.force_warnings(motion.mechanism(), by);
    told.extend(left_slots(model, parameters, (&frames, &sink.table), by));
    told
}
