//! Simulations: how a mechanism moves in time where drives are let go.
//!
//! What `kempe-simulate` finds are laws of the drives. The rows are those of a study of forces along the motion by these laws:
//! every measure is there, and inverse dynamics, which knows nothing of the simulation, must find that a drive that was let go
//! gives nothing.

mod balance;
mod happened;
mod how;
mod marks;
mod points;
mod question;
mod told;
mod why;

use std::sync::Arc;

use kempe_measure::Sampler;
use kempe_mechanism::Design;
use kempe_model::{Contact, Diagnostic, Model, MotionStudy, Rows, SimulateStudy};
use kempe_motion::Motion;
use kempe_motion::progress::Progress;
use kempe_simulate::{Ending, Question, Ready, Simulated, ready};
use kempe_units::{Dimension, Expr};

use crate::along::not_simulated;
use crate::explain::cannot_follow;
use crate::motion::rows_of;
use crate::motion_findings::{motion_findings, refused as refused_motion};
use crate::prepared::design;
use crate::result::StudyResult;
use crate::rows::count;
use crate::shows::Shows;

use self::balance::{balance, held_at, hidden, out_of_balance};
use self::happened::happened;
use self::how::how;
use self::marks::happenings;
use self::question::{idle_conditions, question, too_coarse, unfollowed};
pub(crate) use self::told::place_name;
use self::told::{Named, Told};
use self::why::{cavitation, early, explain};

/// The end of a simulation may have no pose: so much of its time before it there may be one.
const LAST_POSES: [f64; 4] = [0.0, 1e-9, 1e-6, 1e-3];

/// What moves as a simulation finds.
pub(crate) struct Moved {
    pub motion: Arc<Motion>,
    /// That it ended before it was to, and the part of its time that it does not come to.
    pub ended: Option<(Diagnostic, f64)>,
    /// What it is warned of besides, where that was asked for.
    pub told: Vec<Diagnostic>,
}

/// What a simulation of the model finds, without rows; what its rows are warned of where that is asked for.
///
/// # Errors
///
/// What keeps it from starting.
pub(crate) fn moved(
    model: &Model,
    (name, study): (&str, &SimulateStudy),
    warned: bool,
    progress: &mut dyn Progress,
) -> Result<Moved, Vec<Diagnostic>> {
    let prepared = Prepared::new(model, (name, study), &[], progress)?;
    let found = prepared.ready.simulate(progress);
    let motion = motion(&prepared.design, &found, progress)?;
    let told = Told::new(model, (name, study), &prepared.stops, &[]);
    let ended = early(&told, &found, || regular_at(&motion, found.end));
    let left = 1.0 - found.end / prepared.question.until;
    let told = match warned && ended.is_none() {
        true => rowed(&told, &prepared.question, &found, &motion, progress)?.diagnostics,
        false => Vec::new(),
    };
    Ok(Moved {
        ended: ended.map(|why| (why, left)),
        told,
        motion,
    })
}

/// The smallest singular value of the pose at the end of a simulation, or where it was known last.
fn regular_at(motion: &Arc<Motion>, end: f64) -> f64 {
    let Ok(mut sampler) = Sampler::new(motion, &[]) else {
        return f64::INFINITY;
    };
    let values = LAST_POSES.map(|before| {
        let sample = sampler.at_time(end * (1.0 - before));
        sample.smallest_singular_value
    });
    values
        .into_iter()
        .find(|x| x.is_finite())
        .unwrap_or(f64::INFINITY)
}

fn motion(
    design: &Design<f64>,
    found: &Simulated,
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Vec<Diagnostic>> {
    (found.motion(progress)).map_err(|error| vec![cannot_follow(design, &error)])
}

/// What is to be told of a simulation, where joints have contacts also of these, before anything moves: what keeps it from starting, and
/// what it is warned of.
pub(crate) fn findings_of_simulation(
    model: &Model,
    name: &str,
    study: &SimulateStudy,
    contacts: &[Contact],
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    match Prepared::new(model, (name, study), contacts, progress) {
        Ok(prepared) => prepared.findings,
        Err(refused) => refused,
    }
}

/// A simulation that can begin.
struct Prepared {
    design: Design<f64>,
    question: Question,
    /// What stops it, as the question has them.
    stops: Vec<Named>,
    ready: Ready,
    /// What is to be told of the mechanism, whatever moves it.
    findings: Vec<Diagnostic>,
}

impl Prepared {
    fn new(
        model: &Model,
        (name, study): (&str, &SimulateStudy),
        contacts: &[Contact],
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let design = design(model);
        let mut refused = unfollowed(&design, name, study);
        refused.extend(not_simulated(&design.mechanism, study));
        refused.extend(too_coarse(name, study, &design.parameters));
        if !refused.is_empty() {
            return Err(refused);
        }
        let (mut question, stops) = question(study, &design);
        question.contacts = contacts.to_vec();
        let told = Told::new(model, (name, study), &stops, contacts);
        let ready =
            ready(&design, &question, progress).map_err(|error| explain(&design, &told, error))?;
        let mut findings = motion_findings(ready.first());
        findings.extend(idle_conditions(&design.mechanism, name, study));
        match refused_motion(ready.first()) {
            true => Err(findings),
            false => Ok(Self {
                design,
                question,
                stops,
                ready,
                findings,
            }),
        }
    }
}

/// A simulation, where joints have contacts also of these.
pub(crate) fn simulation(
    model: &Model,
    name: &str,
    study: &SimulateStudy,
    contacts: &[Contact],
    progress: &mut dyn Progress,
) -> Result<(StudyResult, Simulated), Vec<Diagnostic>> {
    let Prepared {
        design,
        question,
        mut stops,
        ready,
        findings: mut diagnostics,
    } = Prepared::new(model, (name, study), contacts, progress)?;
    let found = ready.simulate(progress);
    stops.extend((found.rigid.iter()).map(|at| Named::of_place(model, contacts, *at)));
    let was_stopped = found.ending == Ending::Stopped;
    let progress = &mut Shows::new(progress, was_stopped);
    let motion = motion(&design, &found, progress)?;
    let told = Told::new(model, (name, study), &stops, contacts);
    let mut result = rowed(&told, &question, &found, &motion, progress)
        .map_err(|refused| [diagnostics.clone(), refused].concat())?;
    diagnostics.append(&mut result.diagnostics);
    result.listings.push(how(model, &question, &found, &result));
    result.listings.extend(happened(&told, &found));
    result.happenings = happenings(&told, &found);
    if was_stopped {
        let all = count(
            model,
            &in_time(&study.along, question.until).rows,
            &model.parameter_values(),
            question.until,
        );
        result.demanded_rows = all as usize;
        // Contacts have rows of their own.
        let [end, until] = [found.end, question.until].map(|t| told.units.text(t, Dimension::TIME));
        result.stopped_at = Some(format!("{end} of {until}"));
    }
    result.diagnostics = diagnostics;
    Ok((result, found))
}

/// The rows of what was simulated, with how well they balance, and what is to be told of them and of how it ended.
fn rowed(
    told: &Told<'_>,
    question: &Question,
    found: &Simulated,
    motion: &Arc<Motion>,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let hidden = hidden(&found.telling(), found);
    let along = in_time(&told.study.along, question.until);
    let shown = found.mechanism();
    let asked = (true, 0, &hidden[..]);
    let (mut result, values) = rows_of(motion, &shown, told.name, &along, asked, progress)?;
    let times = result.table.columns.first().map(|c| c.si());
    let times = times.unwrap_or_default();
    let balance = balance(question, found, &times, &values);
    let told_of = &mut result.diagnostics;
    told_of.extend(out_of_balance(
        told.name,
        &told.units,
        &balance,
        &times,
        question.tolerance,
    ));
    told_of.extend(early(told, found, || regular_at(motion, found.end)));
    told_of.extend(cavitation(told, found));
    result.table.balance = Some(balance);
    for (note, time) in result.table.notes.iter_mut().zip(&times) {
        let held = held_at(found, *time).map(|held| told.what_holds(held));
        let pushes = told.pushes(found, *time);
        let all: Vec<String> = (note.take().into_iter().chain(held).chain(pushes)).collect();
        *note = (!all.is_empty()).then(|| all.join("; "));
    }
    Ok(result)
}

/// The rows of a study in time: so many over the whole time asked for, however early it ends.
pub(crate) fn in_time(study: &MotionStudy, until: f64) -> MotionStudy {
    let mut study = study.clone();
    if let Rows::Count(rows) = study.rows
        && rows > 1
    {
        study.rows = Rows::TimeStep(Expr::Const(until / (rows - 1) as f64));
    }
    study
}
