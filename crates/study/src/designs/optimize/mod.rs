//! Studies that optimise: the design that does something best, with what it hangs on.
//!
//! `problem.rs` puts designs before the methods of `kempe-optimize`, `pieces.rs` tells them where over a motion other peaks lie near the highest, `search.rs`
//! runs a method, `fit/` fits paths and motions, `discrete.rs` takes values of a catalogue, `told.rs` says what was found.

mod discrete;
mod fit;
mod pieces;
mod problem;
mod search;
mod told;

use kempe_model::{Diagnostic, Model, OptimizeStudy, ParameterId, Severity};
use kempe_motion::progress::{Progress, Silent, Stage};
use kempe_optimize::Problem;

use super::asked::{kept, numbers_of};
use super::bench::Bench;
use super::idle::idle_at_own;
use super::study_of;
use crate::explain::stopped;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::unit::Units;
use problem::Designs;
use search::search;
use told::Teller;

/// The bench of a study, and a second one for what is told of designs besides.
fn benches<'m>(
    model: &'m Model,
    study: &OptimizeStudy,
) -> Result<(Bench<'m>, Bench<'m>), Vec<Diagnostic>> {
    let ids: Vec<ParameterId> = study.vary.iter().map(|it| it.parameter).collect();
    let goals = study.goals.iter().map(|goal| Quantity {
        name: goal.number.name.clone(),
        measure: goal.number.measure.clone(),
        dimension: goal.number.dimension,
    });
    let limits = study.subject_to.iter().map(|limit| kept(model, limit));
    let bench = Bench::new(
        model,
        &study.over,
        ids.clone(),
        goals.chain(limits).collect(),
    )?;
    let sides = study.subject_to.iter();
    let mut told: Vec<Quantity> = sides
        .map(|limit| super::asked::left_side(model, limit))
        .collect();
    if !study.over.asked.columns.is_empty() {
        let over = study_of(model, &study.over)?;
        told.extend(numbers_of(model, &study.over, over));
    }
    let beside = Bench::new(model, &study.over, ids, told)?;
    Ok((bench, beside))
}

/// What is to be told of a study before any design is tried; `check` and `run` say the same.
pub(crate) fn findings_of_optimization(model: &Model, study: &OptimizeStudy) -> Vec<Diagnostic> {
    let study = &fit::with_goal(study);
    match benches(model, study) {
        Ok((mut bench, _)) => before(&mut bench, study, &mut Silent),
        Err(told) => told,
    }
}

/// What is to be told before any design is tried.
fn before(
    bench: &mut Bench<'_>,
    study: &OptimizeStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let own = bench.begin(progress);
    let own = own.unwrap_or_else(|told| told.into_iter().map(super::softened).collect());
    let units = Units::of(bench.model);
    let problem = Designs::new(bench, study);
    let mut told = own;
    told.extend(told::outside(&problem, study, &units));
    let spans = study.vary.iter().map(|it| it.span.clone());
    match (&problem.fit, &study.fit) {
        (Some(fitted), Some(asked)) => {
            told.extend(fit::before(fitted, asked, study, problem.bounds()))
        }
        _ => told.extend(idle_at_own(bench, problem.bounds(), spans)),
    }
    told.extend(told::idle_method(study));
    told
}

/// A study that optimises.
pub(crate) fn optimization(
    model: &Model,
    name: &str,
    study: &OptimizeStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let study = &fit::with_goal(study);
    let (mut bench, mut beside) = benches(model, study)?;
    let diagnostics = before(&mut bench, study, progress);
    if diagnostics
        .iter()
        .any(|told| told.severity == Severity::Error)
    {
        return Err(diagnostics);
    }
    // What was found of the file's own motion helps there, too.
    beside.share(&bench);
    let mut problem = Designs::new(&bench, study);
    let Some(found) = search(&mut problem, study, progress) else {
        return Err([diagnostics, vec![stopped(Stage::Trying)]].concat());
    };
    let teller = Teller::new(&bench, &beside, study, name);
    let told = teller.result(&mut problem, found, diagnostics.clone());
    let mut result = told.map_err(|refused| [diagnostics, refused].concat())?;
    if let (Some(fitted), Some(asked)) = (&problem.fit, &study.fit) {
        fit::tell(fitted, asked, &study.vary, &mut result);
    }
    Ok(result)
}
