//! Circuits: rows along the arc of everything that can be reached without taking the mechanism apart.

use kempe_measure::{circuit_row, circuit_samplers};
use kempe_model::{Diagnostic, Model, MotionStudy, Rows};
use kempe_motion::circuit::Circuit;
use kempe_units::Unit;

use crate::along::Row;
use crate::along::unprepared;
use crate::columns::Asked;
use crate::events::{events, place};
use crate::explain::cannot_move;
use crate::missing::{Lack, row_warnings, without_value};
use crate::motion_findings::of_mechanism;
use crate::number_notes::number_notes;
use crate::prepared::design;
use crate::quantity::Quantity;
use crate::result::{Event, StudyResult};
use crate::room::{Held, has_room, row_bytes};
use crate::sink::RowSink;
use crate::slot_ends::{left_slots, slot_note};
use crate::table::Column;
use crate::unit::Units;
use kempe_motion::progress::{Done, Progress, Stage};

/// Rows of a circuit when the study does not say how many.
const DEFAULT_ROWS: usize = 361;
/// What two stretches met at the same place, in parts of the size of the range: they end and begin there.
const SAME_PLACE: f64 = 1e-12;

/// Runs a study that traces a whole circuit. Rows stand evenly along the arc, or at steps of
/// the drive; time does not run.
pub(crate) fn run_circuit(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let design = design(model);
    let mechanism = &design.mechanism;
    let asked = Asked::of_motion(model, study);
    let circuit = Circuit::with_progress(&design, progress)
        .map_err(|error| vec![cannot_move(&design, &error)])?;
    let mut diagnostics = of_mechanism(&circuit.demanded);
    diagnostics.extend(begins_beside(name, &circuit));
    let evenly = |count: usize| -> Vec<f64> {
        (0..count)
            .map(|k| circuit.length * (k as f64 / (count - 1) as f64))
            .collect()
    };
    let arcs = match &study.rows {
        Rows::Count(count) => evenly((*count).max(2)),
        Rows::DriveStep(step) => {
            let step = kempe_model::value(step, &design.parameters).abs();
            if step > 0.0 {
                // Each stretch has its end besides.
                let steps = circuit.travel() / step + circuit.stretches.len() as f64 + 1.0;
                let row = row_bytes(model, &asked, study.plots.len(), false);
                has_room(model, name, Held { rows: steps, row })?;
                circuit.arcs_by_step(step)
            } else {
                evenly(DEFAULT_ROWS)
            }
        }
        Rows::TimeStep(_) => {
            diagnostics.push(
                Diagnostic::warning(
                    "circuit-without-time",
                    format!("study `{name}` asks for steps of time, but time does not run along a circuit"),
                )
                .help("give the step in the drive's unit, or say how many rows: rows = 361"),
            );
            evenly(DEFAULT_ROWS)
        }
    };
    let quantities: Vec<&Quantity> = asked.all().collect();
    let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
    let mut samplers = circuit_samplers(&circuit, &measures, &arcs, progress)
        .map_err(|problem| unprepared(model, &quantities, problem))?;
    let count = arcs.len();
    let units = Units::of(model);
    let arc = Column::new("arc", Unit::one());
    let mut rows = RowSink::new(name, model, &units, &asked, arc);
    let mut frames = Vec::with_capacity(count);
    let mut stretch_of: Vec<(usize, f64)> = Vec::with_capacity(count);
    for (done, arc) in arcs.into_iter().enumerate() {
        let Some(sample) = circuit_row(&circuit, &mut samplers, arc) else {
            break;
        };
        stretch_of.push((circuit.locate(arc).0, sample.parameter));
        let row = Row {
            slots: slot_note(model, &design.parameters, &sample.points),
            sample,
            forces: None,
        };
        frames.push(rows.push(mechanism, arc, row));
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, count))
            .is_break()
        {
            break;
        }
    }
    diagnostics.extend(row_warnings(name, &rows.table, 0));
    for (stretch, sampler) in circuit.stretches.iter().zip(&samplers) {
        let numbers = quantities.iter();
        let numbers = numbers.map(|q| (q.name.as_str(), sampler.notes_of(&q.measure)));
        let told = number_notes(Some(name), &stretch.motion, numbers);
        diagnostics.extend(told);
    }
    diagnostics.extend(without_value(&rows, 0, |_| Lack::Time));
    let of_rows = (&frames[..], &rows.table);
    diagnostics.extend(left_slots(model, &design.parameters, of_rows, 0));
    if !circuit.closed {
        diagnostics.push(Diagnostic::warning(
            "circuit-open",
            format!("the circuit of study `{name}` does not come back to its start"),
        )
        .help("it was followed as far as could be: look at its last row, where the mechanism may run away or stand still"));
    }
    let mut met: Vec<Event> = Vec::new();
    for (index, stretch) in circuit.stretches.iter().enumerate() {
        // Rows of other stretches are out of the question for an event of this one.
        let own: Vec<f64> = stretch_of
            .iter()
            .map(|(s, p)| if *s == index { *p } else { f64::INFINITY })
            .collect();
        let (low, high) = stretch.motion.reached();
        let near = SAME_PLACE * low.abs().max(high.abs());
        for event in events(&stretch.motion, &own) {
            let same =
                |e: &Event| (e.at - event.at).abs() <= near && e.row.abs_diff(event.row) <= 2;
            if !met.iter().any(same) {
                met.push(event);
            }
        }
    }
    met.sort_by_key(|e| e.row);
    Ok(StudyResult {
        name: name.to_owned(),
        events: met,
        scalars: rows.scalars.clone(),
        figures: rows.figures(&study.plots),
        table: rows.table,
        frames,
        beside: Vec::new(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        listings: Vec::new(),
        shapes: Vec::new(),
        designs: Vec::new(),
        along: 0,
        assemblies: (circuit.assemblies.list.len(), circuit.assemblies.rejected),
        diagnostics,
        demanded_rows: count,
        stopped_at: None,
    })
}

/// Told where branches cross at the start that is asked for, and the circuit is followed from a place beside it.
fn begins_beside(name: &str, circuit: &Circuit) -> Option<Diagnostic> {
    let (motion, begins) = (&circuit.demanded, circuit.start());
    if (begins - motion.start).abs() <= motion.margin() {
        return None;
    }
    let [begins, asked] = [begins, motion.start].map(|p| place(motion, p));
    Some(
        Diagnostic::warning(
            "circuit-begins-beside",
            format!("the circuit of study `{name}` begins at {begins}, beside the change point at {asked}"),
        )
        .help("where branches cross no direction of the circuit is told apart: start the drive a little further on"),
    )
}
