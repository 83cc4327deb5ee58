//! What play at the joints does: the motion with it beside the motion without, row by row.

mod columns;
mod contact;
mod findings;
mod joints;
mod prepared;
mod summary;

use kempe_dynamics::clearance::{Clearances, NoClearances, NotSettled};
use kempe_model::{ClearanceRates, ClearanceStudy, Diagnostic, Measure, Model};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_units::Dimension;

use crate::along::{Along, Row, RowForces, force_problems, times};
use crate::columns::Asked;
use crate::events::events;
use crate::explain::stopped;
use crate::missing::{Lack, open_warning, without_value};
use crate::motion::abscissa;
use crate::motion_findings::{motion_findings, refused};
use crate::prepared::motion;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::rows::places_along;
use crate::sink::RowSink;
use crate::table::Column;
use crate::unit::Units;

pub(crate) use self::columns::COLUMNS;
use self::columns::{Deviations, Found};
pub(crate) use self::contact::{contact, findings_of_contact};
use self::findings::{Prepared, repeat_each_other};
pub(crate) use self::findings::{findings_of_clearance, refuses};
pub(crate) use self::joints::{Joints, clearance_of, joint_name, not_released};

/// Runs a study of clearance called `name`.
pub(crate) fn clearance(
    model: &Model,
    name: &str,
    study: &ClearanceStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let Prepared {
        design,
        joints,
        asked,
        findings,
    } = Prepared::new(model, name, study);
    let model = &design.mechanism.model;
    let nothing_found = refuses(&findings);
    let motion = match motion(&design, progress) {
        Ok(motion) => motion,
        Err(refused) => return Err([refused, findings].concat()),
    };
    let diagnostics = [motion_findings(&motion), findings].concat();
    if refused(&motion) || nothing_found {
        return Err(diagnostics);
    }
    let mut diagnostics = diagnostics;
    let parameters = &design.parameters;
    let units = Units::of(model);
    let mut deviations = Deviations::new(&design.mechanism, &units, &asked, &joints.plays);
    let quantities: Vec<&Quantity> = deviations.quantities().collect();
    let measures: Vec<Measure> = quantities.iter().map(|q| q.measure.clone()).collect();
    let turning = study.rates == ClearanceRates::Turning;
    let clearances =
        Clearances::new(&motion, &joints.plays, turning, &measures).map_err(|error| match error {
            NoClearances::NotReleased(why) => vec![not_released(&design.mechanism, why)],
            NoClearances::Problems(problems) => force_problems(problems),
        });
    let mut clearances = clearances.map_err(|refused| [diagnostics.clone(), refused].concat())?;
    let places = places_along(&motion, &study.along, parameters);
    let mut sampler = Along::with_progress(model, &motion, &quantities, true, &places, progress)
        .map_err(|refused| [diagnostics.clone(), refused].concat())?;
    let instants = times(&motion, &places);
    diagnostics.extend(idle_joints(
        &mut clearances,
        &instants,
        &joints,
        name,
        progress,
    )?);
    let first = Column::new("time", units.unit(Dimension::TIME));
    let mut rows = RowSink::new(name, model, &units, &Asked::default(), first);
    let mut frames = Vec::with_capacity(places.len());
    let mut parameters_met = Vec::with_capacity(places.len());
    let mut told: Vec<Option<String>> = Vec::new();
    let mut repeated = vec![false; joints.plays.len()];
    for (done, place) in places.iter().enumerate() {
        let mut row = sampler.row(*place);
        let ideal = std::mem::take(&mut row.sample.values);
        let mut found = Found::nothing(&measures, &joints.plays);
        let reached = row
            .note(&design.mechanism)
            .filter(|_| !row.sample.closure.is_finite());
        let mut alone = true;
        let why = match reached {
            Some(note) => Some(note),
            None => {
                let why = with_play(&mut clearances, &mut row, &measures, &mut found).err();
                for (joint, repeated) in repeated.iter_mut().enumerate() {
                    *repeated |= clearances.is_undetermined(joint);
                }
                // That joints repeat each other is told once for all rows.
                alone = !matches!(why, Some(NotSettled::Undetermined(j)) if clearances.is_undetermined(j));
                why.map(|why| why.text(&joints.names))
            }
        };
        deviations.push(&ideal, &found);
        parameters_met.push(row.sample.parameter);
        let time = row.sample.time;
        frames.push(rows.push(&design.mechanism, time, row));
        if let (Some(why), Some(note)) = (&why, rows.table.notes.last_mut()) {
            *note = Some(why.clone());
        }
        told.push(why.filter(|_| alone));
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, places.len()))
            .is_break()
        {
            break;
        }
    }
    let repeat = repeat_each_other(name, &joints, &repeated);
    let first_order = repeat.is_none();
    diagnostics.extend(repeat);
    let along = abscissa(&motion, parameters);
    diagnostics.extend(rows.force_warnings(&design.mechanism, along));
    let met = events(&motion, &parameters_met);
    let figures = deviations.figures(&study.along.plots);
    let (columns, summary) = deviations.finished();
    let own = rows.table.columns.len();
    (rows.table.columns).extend(summary.iter().map(|d| d.value.clone()));
    diagnostics.extend(without_value(&rows, along, |_| Lack::Somewhere));
    rows.table.columns.truncate(own);
    let mut table = rows.table;
    diagnostics.extend(summary::not_settled(&table, along, &told, first_order));
    diagnostics.extend(open_warning(name, &table, along));
    table.columns.extend(columns);
    Ok(StudyResult {
        name: name.to_owned(),
        events: met,
        scalars: summary::scalars(&summary, &table, along),
        beside: Vec::new(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        listings: summary::listings(&summary, &table, along, &joints),
        shapes: Vec::new(),
        designs: Vec::new(),
        figures,
        table,
        frames,
        along,
        assemblies: (motion.assemblies.list.len(), motion.assemblies.rejected),
        diagnostics,
        demanded_rows: places.len(),
        stopped_at: None,
    })
}

/// Leaves joints without play at which no force acts at any of the times, s; a warning names them. Where no force acts at all,
/// all stay.
fn idle_joints(
    clearances: &mut Clearances,
    times: &[f64],
    joints: &Joints,
    name: &str,
    progress: &mut dyn Progress,
) -> Result<Option<Diagnostic>, Vec<Diagnostic>> {
    let mut idle = vec![true; joints.plays.len()];
    let mut rows = 0;
    for (done, time) in times.iter().enumerate() {
        if clearances.go_to(*time).is_ok() {
            rows += 1;
            let joints = idle.iter_mut().enumerate();
            joints.for_each(|(joint, idle)| *idle &= clearances.is_idle(joint));
        }
        if idle.iter().all(|idle| !idle) {
            return Ok(None);
        }
        let done = Done::Of(done + 1, times.len());
        if progress.reached(Stage::Measuring, done).is_break() {
            return Err(vec![stopped(Stage::Measuring)]);
        }
    }
    if rows == 0 || idle.iter().all(|idle| *idle) {
        return Ok(None);
    }
    let named = idle.iter().zip(&joints.names).filter(|(idle, _)| **idle);
    let names: Vec<&str> = named.map(|(_, name)| name.as_str()).collect();
    for (joint, _) in idle.iter().enumerate().filter(|(_, idle)| **idle) {
        clearances.leave_closed(joint);
    }
    let warning = Diagnostic::warning(
        "clearance-idle",
        format!(
            "study `{name}`: no force ever holds a contact at {}: what hangs there is where it is without that clearance",
            names.join(", ")
        ),
    );
    Ok(Some(
        warning
            .note("the columns to first order count it")
            .help("links without a mass carry nothing: mass = \"1 kg\" says otherwise"),
    ))
}

/// Finds the state with play at a row and puts it in place of the one without. What does not ask for forces is found first.
fn with_play(
    clearances: &mut Clearances,
    row: &mut Row,
    measures: &[Measure],
    found: &mut Found,
) -> Result<(), NotSettled> {
    let there = clearances.go_to(row.sample.time);
    if there.is_ok() {
        found.slopes = (measures.iter()).map(|m| clearances.slopes(m)).collect();
    }
    let settled = there.and_then(|()| clearances.settle());
    match settled {
        Ok(()) => {
            row.sample.put(clearances.state());
            let evidence = clearances.evidence();
            row.sample.closure = evidence.closure;
            row.sample.smallest_singular_value = evidence.smallest_singular_value;
            let (evidence, notes) = clearances.force_evidence();
            let arrows = row.forces.take().map_or_else(Vec::new, |f| f.arrows);
            row.forces = Some(RowForces {
                evidence: Some(evidence),
                notes,
                arrows,
            });
            found.values = (measures.iter()).map(|m| clearances.value(m)).collect();
        }
        Err(_) => {
            row.sample.closure = f64::NAN;
            row.sample.smallest_singular_value = f64::NAN;
            if let Some(forces) = &mut row.forces {
                forces.evidence = None;
                forces.notes.clear();
            }
        }
    }
    settled
}
