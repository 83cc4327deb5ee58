//! What play at the joints does: the motion with it beside the motion without, row by row.

mod columns;
mod contact;
mod joints;
mod summary;

use kempe_dynamics::clearance::{Clearances, NoClearances, NotSettled};
use kempe_measure::measure::History;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{
    ClearanceRates, ClearanceStudy, Diagnostic, Leaf, Measure, Model, PointId,
    PoseMeasure,
};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_units::{Dimension, Expr};

use crate::along::{Along, Row, RowForces, force_problems, times};
use crate::columns::{Asked, is_of_whole_motion};
use crate::events::events;
use crate::findings_forces::something_acts;
use crate::missing::{Lack, open_warning, without_value};
use crate::motion::abscissa;
use crate::motion_findings::{motion_findings, refused};
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::rows::places_along;
use crate::run::nothing_acts;
use crate::sink::RowSink;
use crate::table::Column;
use crate::unit::Units;

pub(crate) use self::columns::{COLUMNS, not_at_an_instant};
use self::columns::{Deviations, Found};
pub(crate) use self::contact::contact;
use self::joints::Joints;
pub(crate) use self::joints::{given, joint_name, not_released};

/// Runs a study of clearance called `name`.
pub(crate) fn clearance(
    model: &Model,
    name: &str,
    study: &ClearanceStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let model = &without_friction(model, name, &mut diagnostics);
    let design = design(model);
    let motion = motion(&design, progress)?;
    let found = motion_findings(&motion);
    if refused(&motion) {
        return Err(found);
    }
    diagnostics.splice(0..0, found);
    if !something_acts(model) {
        diagnostics.push(nothing_acts());
    }
    let parameters = &design.parameters;
    let joints = Joints::new(&design.mechanism, parameters);
    let turning = study.rates == ClearanceRates::Turning;
    let mut clearances =
        Clearances::new(&motion, &joints.plays, turning).map_err(|error| match error {
            NoClearances::NotReleased(why) => vec![not_released(&design.mechanism, why)],
            NoClearances::Problems(problems) => force_problems(problems),
        })?;
    diagnostics.extend(joints.left_out(model));

    let asked = Asked::of_clearance(&design.mechanism, &study.along);
    let problems = not_at_an_instant(&design.mechanism, &asked);
    if !problems.is_empty() {
        return Err(problems);
    }
    let units = Units::of(model);
    let mut deviations = Deviations::new(&design.mechanism, &units, &asked, &joints);
    let followed = clearances.followed().to_vec();
    if let Some(refused) = whole_motion_load(&design.mechanism, &followed) {
        return Err(vec![refused]);
    }
    let measures: Vec<Measure> = deviations.quantities().map(|q| q.measure.clone()).collect();
    let directions = directions(&design.mechanism, measures.iter().chain(&followed));
    let quantities: Vec<&Quantity> = deviations.quantities().chain(&directions).collect();
    let places = places_along(&motion, &study.along, parameters);
    let mut sampler = Along::with_progress(model, &motion, &quantities, true, &places, progress)?;
    let instants = places.iter().filter_map(|place| {
        let time = *times(&motion, std::slice::from_ref(place)).first()?;
        let values = sampler.values(*place);
        Some((time, history(&directions, &values[measures.len()..])))
    });
    diagnostics.extend(idle_joints(&mut clearances, instants, &joints, name));
    let first = Column::new("time", units.unit(Dimension::TIME));
    let mut rows = RowSink::new(name, model, &units, &Asked::default(), first);
    let mut frames = Vec::with_capacity(places.len());
    let mut parameters_met = Vec::with_capacity(places.len());
    let mut told: Vec<Option<String>> = Vec::new();
    for (done, place) in places.iter().enumerate() {
        let mut row = sampler.row(*place);
        let values = std::mem::take(&mut row.sample.values);
        let (ideal, near) = values.split_at(measures.len());
        let history = history(&directions, near);
        let mut found = Found::nothing(&measures, &joints);
        let reached = row
            .note(&design.mechanism)
            .filter(|_| !row.sample.closure.is_finite());
        let why = match reached {
            Some(note) => Some(note),
            None => with_play(&mut clearances, &mut row, &measures, history, &mut found)
                .err()
                .map(|why| why.text(&joints.names)),
        };
        deviations.push(ideal, &found);
        parameters_met.push(row.sample.parameter);
        let time = row.sample.time;
        frames.push(rows.push(&design.mechanism, time, row));
        if let (Some(why), Some(note)) = (&why, rows.table.notes.last_mut()) {
            *note = Some(why.clone());
        }
        told.push(why);
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, places.len()))
            .is_break()
        {
            break;
        }
    }
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
    diagnostics.extend(summary::not_settled(&table, along, &told));
    diagnostics.extend(open_warning(name, &table, along));
    let place = table.columns.get(along).cloned();
    table.columns.extend(columns);
    Ok(StudyResult {
        name: name.to_owned(),
        events: met,
        scalars: summary::scalars(&summary, place.as_ref()),
        listings: summary::listings(&summary, place.as_ref(), &joints),
        shapes: Vec::new(),
        figures,
        table,
        frames,
        along,
        assemblies: (motion.assemblies.list.len(), motion.assemblies.rejected),
        diagnostics,
        demanded_rows: places.len(),
    })
}

/// Leaves joints without play at which no force acts in any row; a warning names them. Where no force acts at all, all stay.
fn idle_joints(
    clearances: &mut Clearances,
    instants: impl Iterator<Item = (f64, History<f64>)>,
    joints: &Joints,
    name: &str,
) -> Option<Diagnostic> {
    let mut idle = vec![true; joints.plays.len()];
    let mut rows = 0;
    for (time, history) in instants {
        if idle.iter().all(|idle| !idle) {
            return None;
        }
        if clearances.go_to(time, history).is_ok() {
            rows += 1;
            let joints = idle.iter_mut().enumerate();
            joints.for_each(|(joint, idle)| *idle &= clearances.is_idle(joint));
        }
    }
    if rows == 0 || idle.iter().all(|idle| *idle) {
        return None;
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
    Some(
        warning
            .note("the columns to first order count it")
            .help("links without a mass carry nothing: mass = \"1 kg\" says otherwise"),
    )
}

/// Finds the state with play at a row and puts it in place of the one without. What does not ask for forces is found first.
fn with_play(
    clearances: &mut Clearances,
    row: &mut Row,
    measures: &[Measure],
    history: History<f64>,
    found: &mut Found,
) -> Result<(), NotSettled> {
    let there = clearances.go_to(row.sample.time, history);
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

/// The model without friction, where it has some: a warning says so.
fn without_friction(model: &Model, name: &str, diagnostics: &mut Vec<Diagnostic>) -> Model {
    let mut smooth = model.clone();
    let Some(first) = model.actions.friction.first() else {
        return smooth;
    };
    diagnostics.push(
        Diagnostic::warning(
            "friction-left-out",
            format!("study `{name}`: friction is left out, in the motion with clearance and in the ideal one"),
        )
        .at(first.span.clone(), "")
        .note("the link in a clearance lies along the force between smooth surfaces")
        .help("see what friction asks of the drives in a study of forces"),
    );
    smooth.actions.friction.clear();
    smooth
}

/// That a load follows more of the motion than an instant.
fn whole_motion_load(mechanism: &Mechanism, followed: &[Measure]) -> Option<Diagnostic> {
    let mut followed = followed.iter();
    let whole = followed.any(|m| is_of_whole_motion(mechanism, m));
    whole.then(|| {
        let message = "a load follows how far a point has gone, which is not known with clearance";
        Diagnostic::error("not-measurable", message)
            .help("let loads follow drives, time, and what has a value at every instant")
    })
}

/// The directions between points that measures ask for, as quantities.
fn directions<'m>(
    mechanism: &Mechanism,
    measures: impl Iterator<Item = &'m Measure>,
) -> Vec<Quantity> {
    let mut list: Vec<(PointId, PointId)> = Vec::new();
    for measure in measures {
        visit_leaves(mechanism, measure, &mut |leaf| {
            if let Leaf::Pose(PoseMeasure::Direction(a, b)) = leaf
                && !list.contains(&(*a, *b))
            {
                list.push((*a, *b));
            }
        });
    }
    let quantity = |(a, b): (PointId, PointId)| Quantity {
        name: String::new(),
        measure: Expr::Leaf(Leaf::Pose(PoseMeasure::Direction(a, b))),
        dimension: Dimension::ANGLE,
    };
    list.into_iter().map(quantity).collect()
}

/// Directions count turns as they do without clearance.
fn history(directions: &[Quantity], near: &[f64]) -> History<f64> {
    let pairs = directions.iter().zip(near);
    let pairs = pairs.filter_map(|(quantity, near)| match &quantity.measure {
        Expr::Leaf(Leaf::Pose(PoseMeasure::Direction(a, b))) => Some(((*a, *b), *near)),
        _ => None,
    });
    History {
        directions: pairs.collect(),
        ..History::default()
    }
}
