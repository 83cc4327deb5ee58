//! What tolerances do: parameters that differ from piece to piece, and the numbers of a study.
//!
//! The file's own design comes first (`ready.rs`), with what is followed along its motion (`followed.rs`). The linear answer comes from the exact derivatives of the numbers (`linear.rs`), the sampled one from pieces that are drawn as evenly as
//! can be (`sobol.rs`, `spread.rs`). Numbers of poses are taken for many pieces at once, on the branch of the file's own design (`../lanes`);
//! the rest by moving piece after piece (`sampled.rs`). Some
//! pieces are moved either way (`checked.rs`): what lanes miss by more than a small part of a number's deviation, they do not tell. `summary.rs` makes few
//! numbers of many, `told/` says them.

mod answers;
mod checked;
mod direction_numbers;
mod effects;
mod followed;
mod linear;
mod play;
mod ready;
mod ridge;
mod rounding;
mod sampled;
mod sobol;
mod source;
mod spread;
mod summary;
mod told;
mod worst;

use kempe_batch::Executor;
use kempe_model::{Diagnostic, Model, StudyKind, ToleranceStudy};
use kempe_motion::progress::{Done, Progress, Silent, Stage};

use self::checked::check;
pub(crate) use self::followed::CURVES;
use self::followed::{curves, own_motion};
use self::ready::{Ready, of_own, played};
pub(crate) use self::sampled::KEPT;
use self::sampled::{Pieces, Question, path_places};
use self::sobol::Sobol;
use self::source::{Source, deviations};
use self::spread::Deviation;
use self::told::Teller;
use self::worst::Worsts;
use super::bench::Bench;
use super::lanes::{InLanes, Reach};
use super::warned::{Counted, Tally, may_warn, of_rows};
use crate::explain::stopped;
use crate::result::StudyResult;
use crate::rows::{RowPlace, places_along};

/// Pieces with normal parameters lie hardly farther out than so many times their ends.
const FAR_OUT: f64 = 2.5;
const REACH: Reach = Reach {
    far_out: FAR_OUT,
    swift: 1.0,
};
/// So many pieces are looked at for what their rows warn of.
const WARNED: usize = 32;

/// What is to be told of a study before any piece is drawn; `check` and `run` say the same.
pub(crate) fn findings_of_tolerance(
    model: &Model,
    study: &ToleranceStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    match played(model, study) {
        Ok(played) => match Ready::new(model, played.as_ref(), study, progress) {
            Ok(ready) => ready.told,
            Err(told) => told,
        },
        Err(told) => told,
    }
}

/// What tolerances do to a study's numbers.
pub(crate) fn tolerance(
    model: &Model,
    name: &str,
    study: &ToleranceStudy,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let played = played(model, study)?;
    let mut ready = Ready::new(model, played.as_ref(), study, progress)?;
    let curves = curves(model, &study.over, &ready.bench.over.kind);
    let mut base = own_motion(model, name, &ready.bench, &curves, progress)?;
    if base.interrupted() {
        return Err(vec![stopped(Stage::Rows)]);
    }
    // The file's own design was told of already.
    for it in &ready.told {
        if !base.diagnostics.contains(it) {
            base.diagnostics.push(it.clone());
        }
    }
    let own = ready.bench.own_values();
    let told = |why: String| vec![of_own(study, why)];
    let motion = (ready.bench)
        .motion(&own, progress)
        .map_err(|refused| match refused.lack {
            lack if lack.is_infinite() => vec![stopped(Stage::Following)],
            _ => told(refused.why),
        })?;
    ready.bench.keep_apart(&motion);
    let bench = &ready.bench;
    let along = bench.over.kind.along();
    let rows: Vec<RowPlace> = match &bench.over.kind {
        StudyKind::Simulate(_) => {
            let times = base.table.columns.first().map(|c| c.si());
            let times = times.unwrap_or_default().into_iter();
            times.map(RowPlace::Time).collect()
        }
        _ => places_along(&motion, along, &motion.design.parameters),
    };
    let ends: Vec<[f64; 2]> = deviations(&ready.sources).map(|it| it.ends).collect();
    let lanes = match &bench.over.kind {
        // Joints that stand open are drives that stand elsewhere.
        _ if played.is_some() => None,
        StudyKind::Simulate(_) => None,
        _ => {
            let places = path_places(&motion, &rows);
            InLanes::new(bench, &motion, &curves, &places, (&ends, REACH))
        }
    };
    let mut question = Question {
        bench,
        sources: &ready.sources,
        sobol: Sobol::new(ready.sources.len(), study.seed as u64),
        samples: study.samples,
        curves: &curves,
        rows: &rows,
        may_be_unsound: may_be_unsound(bench, &own, &ready.sources),
        lanes,
        own,
    };
    let missed = check(&mut question, &ready.linear, motion.size());
    let pieces = question.answer(executor, progress);
    if pieces.count == 0 {
        return Err(vec![stopped(Stage::Rows)]);
    }
    let worst = worst(&ready, &question, (&pieces, motion.size()), progress);
    let teller = Teller {
        ready: &ready,
        study,
        question: &question,
        size: motion.size(),
        pieces: &pieces,
        worst: &worst,
        missed: &missed,
    };
    teller.tell(&mut base);
    base.diagnostics.extend(warned(&question, (name, study)));
    Ok(base)
}

/// The worst cases of the numbers that are told, sought from the file's own design and from the pieces that come nearest.
fn worst(
    ready: &Ready<'_>,
    question: &Question<'_, '_>,
    (pieces, size): (&Pieces, f64),
    progress: &mut dyn Progress,
) -> Worsts {
    let ends = pieces.numbers.iter().take(ready.shown).map(|values| {
        let finite = || (0..values.len()).filter(|piece| values[*piece].is_finite());
        let low = finite().min_by(|a, b| values[*a].total_cmp(&values[*b]));
        let high = finite().max_by(|a, b| values[*a].total_cmp(&values[*b]));
        [low, high].map(|piece| match piece {
            Some(piece) => question.values(piece),
            None => question.own.clone(),
        })
    });
    let ends: Vec<[Vec<f64>; 2]> = ends.collect();
    let slopes = ready.linear.iter().map(|it| it.slope.as_slice());
    let search = worst::Search::new(
        &ready.bench,
        &ready.sources,
        &question.own,
        slopes.collect(),
        (size, pieces.count),
    );
    ready.bench.watched(progress.watch(), || {
        let done = |number| Done::Of(number, ready.shown);
        search.all(&ends, |number| {
            progress
                .reached(Stage::Measuring, done(number))
                .is_continue()
        })
    })
}

/// What some of the pieces warn of, the first ones: for each code of how many it is told.
fn warned(question: &Question<'_, '_>, (name, study): (&str, &ToleranceStudy)) -> Vec<Diagnostic> {
    let bench = question.bench;
    if !may_warn(bench.model, &bench.over.kind) {
        return Vec::new();
    }
    let count = WARNED.min(question.samples);
    let mut tally = Tally::default();
    for piece in 0..count {
        let Ok((motion, told)) = bench.told_motion(&question.values(piece), &mut Silent) else {
            continue;
        };
        let of_rows = match bench.over.kind {
            StudyKind::Simulate(_) => Vec::new(),
            _ => of_rows(bench, &motion),
        };
        for warning in told.into_iter().chain(of_rows) {
            tally.take(piece, warning.code, &warning.message);
        }
    }
    let of_study = format!("study `{}`: ", bench.over.name);
    let warning = |it: Counted| {
        let text = it.text.strip_prefix(&of_study).unwrap_or(&it.text);
        let message = format!(
            "study `{name}`: {} of the first {count} pieces are warned of `{}`, first number {}: {text}",
            it.count,
            it.code,
            it.first + 1
        );
        Diagnostic::warning("pieces-warned", message)
            .at(study.over.span.clone(), "")
            .note("such pieces count as moving, and as good where they keep all limits")
            .help("make a limit of it, `limits = [...]`, to have it counted in all pieces")
    };
    tally.counted().into_iter().map(warning).collect()
}

/// Whether pieces may have dimensions that make no sense: then all are looked at.
fn may_be_unsound(bench: &Bench<'_>, own: &[f64], sources: &[Source]) -> bool {
    let deviations: Vec<&Deviation> = deviations(sources).collect();
    let far = |k: usize, end: usize| own[k] + FAR_OUT * deviations[k].ends[end];
    let sound = |values: &[f64]| bench.design(values).is_ok();
    let one_by_one = (0..deviations.len()).all(|k| {
        [0, 1].into_iter().all(|end| {
            let mut values = own.to_vec();
            values[k] = far(k, end);
            sound(&values)
        })
    });
    let together = |end: usize| {
        let mut values = own.to_vec();
        for (k, value) in values.iter_mut().enumerate().take(deviations.len()) {
            *value = far(k, end);
        }
        values
    };
    !(one_by_one && sound(&together(0)) && sound(&together(1)))
}
