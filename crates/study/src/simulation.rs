//! Simulations: how a mechanism moves in time where drives are let go.
//!
//! What `kempe-simulate` finds are laws of the drives. The rows are those of a study of forces along the motion by these laws:
//! every measure is there, and inverse dynamics, which knows nothing of the simulation, must find that a drive that was let go
//! gives nothing.

mod balance;
mod question;
mod why;
mod words;

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_model::{Contact, Diagnostic, Model, MotionStudy, Rows, SimulateStudy, StudyKind};
use kempe_motion::Motion;
use kempe_motion::progress::Progress;
use kempe_simulate::{Ending, Question, Simulated, simulate};
use kempe_units::Expr;

use crate::explain::cannot_move;
use crate::motion::rows_of;
use crate::motion_findings::{motion_findings, refused};
use crate::prepared::design;
use crate::result::StudyResult;
use crate::rows::count;
use crate::shows::Shows;
use crate::unit::Units;

use self::balance::{balance, held_at, hidden, out_of_balance};
use self::question::{Named, question, unfollowed, with_strokes};
use self::why::{cavitation, early, explain};
pub(crate) use self::words::place_name;
use self::words::{happened, how, what_holds};

/// The motion that a simulation of the model finds.
///
/// # Errors
///
/// That there is no such simulation, and what keeps it from starting.
pub(crate) fn simulated_motion(
    model: &Model,
    name: &str,
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Vec<Diagnostic>> {
    let named = model.studies.iter().find(|s| s.name == name);
    let Some(StudyKind::Simulate(study)) = named.map(|s| &s.kind) else {
        let message = format!("there is no simulation called `{name}`");
        return Err(vec![Diagnostic::error("unknown-name", message)]);
    };
    let run = Run::new(model, &with_strokes(model, study), &[], progress)?;
    run.motion(progress)
}

/// A simulation that was run.
struct Run {
    design: Design<f64>,
    question: Question,
    /// What stops it, as the question has them.
    stops: Vec<Named>,
    found: Simulated,
    /// What is to be told of the mechanism, whatever moves it.
    findings: Vec<Diagnostic>,
}

impl Run {
    fn new(
        model: &Model,
        study: &SimulateStudy,
        contacts: &[Contact],
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let design = design(model);
        let unknown = unfollowed(&design, study);
        if !unknown.is_empty() {
            return Err(unknown);
        }
        let (mut question, mut stops) = question(study, model, &design.parameters);
        question.contacts = contacts.to_vec();
        let found = simulate(&design, &question, progress)
            .map_err(|error| explain(&design, &stops, contacts, error))?;
        let rigid = found.rigid.iter();
        stops.extend(rigid.map(|at| Named {
            owner: String::new(),
            text: place_name(model, contacts, *at),
            is_angle: false,
        }));
        let findings = motion_findings(&found.first);
        if refused(&found.first) {
            return Err(findings);
        }
        Ok(Self {
            design,
            question,
            stops,
            found,
            findings,
        })
    }

    fn motion(&self, progress: &mut dyn Progress) -> Result<Arc<Motion>, Vec<Diagnostic>> {
        (self.found.motion(progress)).map_err(|error| vec![cannot_move(&self.design, &error)])
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
    let study = &with_strokes(model, study);
    let run = Run::new(model, study, contacts, progress)?;
    let was_stopped = run.found.ending == Ending::Stopped;
    let progress = &mut Shows::new(progress, was_stopped);
    let motion = run.motion(progress)?;
    let Run {
        question,
        stops,
        found,
        findings: mut diagnostics,
        ..
    } = run;
    let hidden = hidden(&found.telling(), &found);
    let along = in_time(&study.along, question.until);
    let (mut result, values) = rows_of(
        &motion,
        &found.mechanism(),
        name,
        &along,
        (true, 0, &hidden),
        progress,
    )?;
    diagnostics.append(&mut result.diagnostics);
    let units = Units::of(model);
    let times = result
        .table
        .columns
        .first()
        .map(|c| c.si())
        .unwrap_or_default();
    let balance = balance(&question, &found, &times, &values);
    diagnostics.extend(out_of_balance(
        name,
        &units,
        &balance,
        &times,
        question.tolerance,
    ));
    diagnostics.extend(early(model, &units, &found));
    diagnostics.extend(cavitation(model, &units, study, &found));
    result.table.balance = Some(balance);
    for (note, time) in result.table.notes.iter_mut().zip(&times) {
        let held = held_at(&found, *time).map(|held| what_holds(held, &stops));
        let all: Vec<String> = note.take().into_iter().chain(held).collect();
        *note = (!all.is_empty()).then(|| all.join("; "));
    }
    result.listings.push(how(model, &question, &found, &result));
    result
        .listings
        .extend(happened(model, &units, study, &stops, &found));
    if was_stopped {
        let all = count(
            model,
            &along.rows,
            &model.parameter_values(),
            question.until,
        );
        result.demanded_rows = (all as usize).max(result.table.rows() + 1);
    }
    result.diagnostics = diagnostics;
    Ok((result, found))
}

/// The rows of a study in time: so many over the whole time asked for, however early it ends.
fn in_time(study: &MotionStudy, until: f64) -> MotionStudy {
    let mut study = study.clone();
    if let Rows::Count(rows) = study.rows
        && rows > 1
    {
        study.rows = Rows::TimeStep(Expr::Const(until / (rows - 1) as f64));
    }
    study
}
