//! Circuits: rows along the arc of everything that can be reached without taking the mechanism apart.

use kempe_kinematics::circuit::Circuit;
use kempe_kinematics::{Design, Mechanism, Plan};
use kempe_model::{Diagnostic, Model, MotionStudy, Rows};
use kempe_units::Unit;

use crate::along::Row;
use crate::columns::{Asked, Quantity};
use crate::explain::cannot_move;
use crate::motion::{events, not_measurable, unreached_warning};
use crate::progress::{Flow, Progress};
use crate::result::{Event, StudyResult};
use crate::sink::RowSink;
use crate::table::Column;
use crate::unit::Units;

/// Rows of a circuit when the study does not say how many.
const DEFAULT_ROWS: usize = 361;

/// Runs a study that traces a whole circuit. Rows stand evenly along the arc; time does not run.
pub(crate) fn run_circuit(
    model: &Model,
    name: &str,
    study: &MotionStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let mechanism = Mechanism::new(model);
    let plan = Plan::new(&mechanism);
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &plan, &parameters);
    let circuit = Circuit::new(&mechanism, &plan, &design, &parameters)
        .map_err(|error| vec![cannot_move(&mechanism, &plan, &design, &error)])?;
    let asked = Asked::of_motion(model, study);
    let quantities: Vec<&Quantity> = asked.all().collect();
    let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
    let mut samplers = circuit
        .samplers(&measures)
        .map_err(|problems| not_measurable(model, &quantities, &problems))?;

    let count = match study.rows {
        Rows::Count(count) => count.max(2),
        _ => DEFAULT_ROWS,
    };
    let units = Units::of(model);
    let arc = Column::new("arc", Unit::one());
    let mut rows = RowSink::new(name, model, &units, &asked, arc);
    let mut frames = Vec::with_capacity(count);
    let mut stretch_of: Vec<(usize, f64)> = Vec::with_capacity(count);
    for done in 0..count {
        let arc = circuit.length * (done as f64 / (count - 1) as f64);
        let Some(sample) = circuit.row(&mut samplers, arc) else {
            break;
        };
        stretch_of.push((circuit.locate(arc).0, sample.parameter));
        let row = Row {
            sample,
            forces: None,
        };
        frames.push(rows.push(&mechanism, arc, row));
        if progress.tick(done + 1, count) == Flow::Stop {
            break;
        }
    }
    let mut warnings = Vec::new();
    if rows.table.unreached() > 0 {
        warnings.push(unreached_warning(name, &rows.table));
    }
    if !circuit.closed {
        warnings.push(Diagnostic::warning(
            "circuit-open",
            format!("the circuit of study `{name}` does not come back to its start"),
        ));
    }
    let mut met: Vec<Event> = Vec::new();
    for (index, stretch) in circuit.stretches.iter().enumerate() {
        // Rows of other stretches are out of the question for an event of this one.
        let own: Vec<f64> = stretch_of
            .iter()
            .map(|(s, p)| if *s == index { *p } else { f64::INFINITY })
            .collect();
        for event in events(&stretch.motion, &units, &own) {
            if met
                .iter()
                .all(|e| e.place != event.place || e.row.abs_diff(event.row) > 2)
            {
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
        listings: Vec::new(),
        along: 0,
        assemblies: (circuit.assemblies.list.len(), circuit.assemblies.rejected),
        warnings,
        demanded_rows: count,
    })
}
