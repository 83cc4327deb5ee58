//! Studies that optimise: the design that does something best, with what it hangs on.
//!
//! `designs.rs` has designs between their bounds (`choices.rs`) and what their numbers are worth (`worth.rs`), `problem.rs` puts them before the methods of `kempe-optimize`. `differences.rs` has derivatives where there are no exact ones, `pieces.rs` tells them where over a motion other peaks lie near the highest (`parts.rs`, `formula.rs`, `peaks.rs`), `alone.rs` and `poles.rs`
//! say which designs are none. `search.rs` runs a method as far as `effort.rs` says and has `optima.rs`, `front.rs` finds fronts of several goals from what `beginning.rs` begins with, `fit/` fits paths and motions, `discrete.rs` takes values of a catalogue, `several.rs` asks many designs at once, `journal.rs` keeps what was asked, `told/` says what was found.

mod alone;
mod beginning;
mod choices;
mod designs;
mod differences;
mod discrete;
mod effort;
mod fit;
mod formula;
mod front;
mod journal;
mod least;
mod optima;
mod parts;
mod peaks;
mod pieces;
mod poles;
mod problem;
mod search;
mod several;
mod told;
mod worth;

use kempe_batch::Executor;
use kempe_model::{Diagnostic, Model, OptimizeStudy, ParameterId, Severity, Study, StudyKind};
use kempe_motion::progress::{Progress, Silent, Stage};
use kempe_optimize::Problem;

use super::asked::{kept, numbers_of};
use super::bench::Bench;
use super::idle::idle_at_own;
use super::kept_parts::{Parts, Unkept};
use super::over::{softened, study_of};
use crate::explain::stopped;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::unit::Units;
pub(super) use designs::Designs;
use journal::Journal;
pub(super) use least::least;
pub(super) use pieces::Wanted;
use search::{Listener, On, search};
use several::Several;
pub(super) use told::COUNTS;
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
        .map(|limit| super::asked::limited_side(model, limit))
        .collect();
    if !study.over.asked.columns.is_empty() {
        let over = study_of(model, &study.over)?;
        told.extend(numbers_of(model, &study.over, over));
    }
    let beside = Bench::new(model, &study.over, ids, told)?;
    Ok((bench, beside))
}

/// What is to be told of a study before any design is tried; `check` and `run` say the same.
pub(crate) fn findings_of_optimization(
    model: &Model,
    study: &OptimizeStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let study = &fit::with_goal(study);
    match benches(model, study) {
        Ok((mut bench, _)) => before(&mut bench, study, progress),
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
    let own = own.unwrap_or_else(|told| told);
    let own: Vec<Diagnostic> = own.into_iter().map(softened).collect();
    let units = Units::of(bench.model);
    let problem = Designs::new(bench, study);
    let mut told = own;
    told.extend(told::outside(&problem, study, &units));
    let spans = study.vary.iter().map(|it| it.span.clone());
    match (&problem.fit, &study.fit) {
        (Some(fitted), Some(asked)) => {
            told.extend(fit::before(fitted, asked, study, problem.ranges()))
        }
        _ => told.extend(idle_at_own(bench, problem.ranges(), spans)),
    }
    told.extend(told::idle_method(study));
    told
}

/// A study that optimises.
pub(crate) fn optimization(
    model: &Model,
    name: &str,
    study: &OptimizeStudy,
    with: (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    optimum(model, name, study, with, None, progress)
}

/// The same otherwise, for the benchmark that holds both against each other: with differences in the place of exact derivatives, or with every design asked
/// alone.
///
/// # Errors
///
/// As of any study that is run.
#[doc(hidden)]
pub fn optimum_otherwise(
    model: &Model,
    study: &Study,
    otherwise: Otherwise,
    executor: &dyn Executor,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let StudyKind::Optimize(asked) = &study.kind else {
        return Err(Vec::new());
    };
    let with: (&dyn Executor, &mut dyn Parts) = (executor, &mut Unkept);
    let otherwise = Some(otherwise);
    optimum(model, &study.name, asked, with, otherwise, &mut Silent)
}

/// What a benchmark does otherwise.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Otherwise {
    /// Derivatives are differences.
    Differences,
    /// Every design is asked alone.
    Alone,
}

/// The designs of a study as a search asks them.
fn problem<'b, 'm>(
    bench: &'b Bench<'m>,
    study: &OptimizeStudy,
    otherwise: Option<Otherwise>,
) -> Designs<'b, 'm> {
    let mut problem = Designs::new(bench, study);
    problem.differences |= otherwise == Some(Otherwise::Differences);
    problem.several = (problem.fit.is_none() && otherwise != Some(Otherwise::Alone))
        .then(|| Several::new(bench, problem.ranges()))
        .flatten();
    problem
}

/// The optimum of a study.
fn optimum(
    model: &Model,
    name: &str,
    study: &OptimizeStudy,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    otherwise: Option<Otherwise>,
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
    let mut problem = problem(&bench, study, otherwise);
    let shape = [
        study.vary.len(),
        problem.objectives(),
        problem.constraints(),
    ];
    let alone = |failed: Box<Diagnostic>| vec![*failed];
    problem.journal = Journal::open(parts, shape).map_err(alone)?;
    problem.journal.watch = progress.watch();
    let mut listener = Listener::new(&problem, parts, progress);
    let watch = problem.journal.watch.clone();
    let (mut found, cut) = bench.watched(watch, || {
        let found = search(&problem, study, &On(executor), &mut listener);
        (found, bench.watch().stops())
    });
    if let Some(failed) = listener.failed {
        return Err(alone(failed));
    }
    if let Some(found) = &mut found {
        found.look(&problem);
    }
    let Some(mut found) = found.filter(|it| !cut || it.has_any()) else {
        return Err([diagnostics, vec![stopped(Stage::Searching)]].concat());
    };
    if cut {
        found.stop();
    }
    let teller = Teller::new(&bench, &beside, study, name);
    let told = teller.result(&problem, found, diagnostics.clone());
    let mut result = told.map_err(|refused| [diagnostics, refused].concat())?;
    if let (Some(fitted), Some(asked)) = (&problem.fit, &study.fit) {
        fit::tell(fitted, asked, &study.vary, &mut result);
    }
    Ok(result)
}

/// In how many parts at most a study is kept that looks for something: how many there will be is not known before. None of any other study.
pub fn most_parts(study: &Study) -> Option<usize> {
    matches!(study.kind, StudyKind::Optimize(_)).then_some(journal::MOST_PARTS)
}
