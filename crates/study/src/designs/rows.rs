//! The rows of a design's motion, as the study that is run has them.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, MotionStudy, StudyKind, value};
use kempe_motion::Motion;
use kempe_units::Dimension;

use super::asked::knows_forces;
use super::bench::{Bench, Refused};
use crate::along::Along;
use crate::columns::Asked;
use crate::quantity::Quantity;
use crate::rows::places_along;
use crate::simulation::in_time;
use crate::sink::RowSink;
use crate::slot_ends::has_ends;
use crate::slots_along::slots_left;
use crate::table::{Column, Table};
use crate::unit::Units;

/// The rows of a design's motion.
pub(super) struct DesignRows {
    pub table: Table,
    /// Its curves, by row.
    pub curves: Vec<Vec<f64>>,
    /// What is to be told of them.
    pub told: Vec<Diagnostic>,
}

/// What takes up the rows of designs, empty.
pub(super) fn sink(name: &str, model: &Model, units: &Units, asked: &Asked) -> RowSink {
    let time = Column::new("time", units.unit(Dimension::TIME));
    RowSink::new(name, model, units, asked, time)
}

/// The rows of a motion on the bench, told under a name, where a study has them, with its columns and curves, and forces beside them where
/// asked for; `by` is the column that the rows go by.
///
/// # Errors
///
/// What cannot be measured.
pub(super) fn rows_of(
    (bench, name): (&Bench<'_>, &str),
    motion: &Arc<Motion>,
    along: &MotionStudy,
    (asked, forces): (&Asked, bool),
    by: usize,
) -> Result<DesignRows, Refused> {
    let (model, parameters) = (bench.model, &motion.design.parameters);
    let units = Units::of(model);
    let timed;
    let along = match &bench.over.kind {
        StudyKind::Simulate(study) => {
            timed = in_time(along, value(&study.until, parameters));
            &timed
        }
        _ => along,
    };
    let places = places_along(motion, along, parameters);
    let quantities: Vec<&Quantity> = asked.all().collect();
    let needs = |q: &&Quantity| model.needs_forces(&q.measure);
    // What forces warn of is told whatever is asked for.
    let forces = matches!(bench.over.kind, StudyKind::Forces(_))
        || knows_forces(bench.over) && (forces || quantities.iter().any(needs));
    let watch = &mut bench.watch();
    let mut sampler = Along::with_progress(model, motion, &quantities, forces, &places, watch)
        .map_err(|told| Refused {
            lack: 2.0,
            why: told.first().map_or_else(String::new, |d| d.message.clone()),
        })?;
    let mut sink = sink(name, model, &units, asked);
    let mut curves = vec![Vec::with_capacity(places.len()); asked.curves.len()];
    let (slots, mut frames) = (has_ends(model), Vec::new());
    for place in places {
        let row = sampler.row(place);
        let own = row.sample.values.iter().skip(asked.columns.len());
        for ((values, value), q) in curves.iter_mut().zip(own).zip(&asked.curves) {
            values.push(q.unit(&units).from_si(*value));
        }
        let frame = sink.push(motion.mechanism(), row.sample.time, row);
        frames.extend(slots.then_some(frame));
    }
    let mut told = sink.force_warnings(motion.mechanism(), by);
    told.extend(slots_left(model, &sink.table.name, motion, &frames));
    Ok(DesignRows {
        table: sink.table,
        curves,
        told,
    })
}
