//! What tolerances do: parameters that differ from piece to piece, and the numbers of a study.
//!
//! The linear answer comes from the exact derivatives of the numbers (`linear.rs`), the sampled one from pieces that are drawn as evenly as
//! can be (`sobol.rs`, `spread.rs`). Numbers of poses are taken for many pieces at once, on the branch of the file's own design (`../lanes`);
//! the rest by moving piece after piece (`sampled.rs`). Some
//! pieces are moved either way (`checked.rs`): what lanes miss by more than a small part of a number's deviation, they do not tell. `summary.rs` makes few
//! numbers of many, `told.rs` says them.

mod answers;
mod checked;
mod direction_numbers;
mod effects;
mod linear;
mod play;
mod ridge;
mod sampled;
mod sobol;
mod source;
mod spread;
mod summary;
mod told;
mod worst;

use kempe_batch::Executor;
use kempe_model::{
    Diagnostic, Leaf, Model, MotionStudy, OverStudy, ParameterId, Plot, PointId, PoseMeasure,
    StudyKind, ToleranceStudy, Toleranced,
};
use kempe_motion::progress::{Done, Progress, Silent, Stage};
use kempe_units::{Dimension, Expr};

use self::checked::check;
use self::linear::Linear;
use self::play::Played;
pub(crate) use self::sampled::KEPT;
use self::sampled::{Pieces, Question, path_places};
use self::sobol::Sobol;
use self::source::{Kind, Play, Source};
use self::spread::Deviation;
use self::told::Teller;
use self::worst::Worsts;
use super::asked::{kept, limited_side, numbers_of};
use super::bench::{Bench, crosses};
use super::idle::idle;
use super::lanes::{InLanes, Reach};
use super::optimize::{Designs, Wanted};
use super::over::study_of;
use super::warned::{Counted, Tally, may_warn, of_rows};
use crate::clearance::refuses;
use crate::columns::Asked;
use crate::explain::stopped;
use crate::motion::run_along;
use crate::prepared::design;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::rows::{RowPlace, places_along};
use crate::simulation::{findings_of_simulation, simulation};

/// With fewer pieces than this their deviation is hardly known.
const FEW: usize = 30;
/// Measures that are followed along the motion where none is asked for.
pub(crate) const CURVES: usize = 3;
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

/// The joints with play, where they count.
///
/// # Errors
/// Why they cannot.
fn played(model: &Model, study: &ToleranceStudy) -> Result<Option<Played>, Vec<Diagnostic>> {
    let Some(asked) = &study.clearance else {
        return Ok(None);
    };
    let over = study_of(model, &study.over)?;
    let varied: Vec<ParameterId> = study.vary.iter().map(|it| it.parameter).collect();
    let played = Played::new(model, &over.kind, asked, &varied)?;
    let all = study.vary.len() + played.joints.len();
    if all > Sobol::MOST {
        let message = format!(
            "{all} parameters and joints differ, more than the {} that are told apart",
            Sobol::MOST
        );
        let error = Diagnostic::error("bad-choice", message).at(asked.clone(), "");
        return Err(vec![error.help("leave out those that hardly count")]);
    }
    Ok(Some(played))
}

/// A limit of the study: where its number and how far it is kept stand among the numbers of the bench.
struct Limited {
    limited: usize,
    kept: usize,
    /// What is rounding of it, SI.
    rounding: f64,
}

impl Limited {
    /// Whether a piece keeps it that is so far from it.
    fn keeps(&self, margin: f64) -> bool {
        margin >= -self.rounding
    }
}

/// What a number is made of as far as that is known: the mechanism's size of a length, one of an angle.
fn scale_of(dimension: Dimension, size: f64) -> f64 {
    match dimension {
        Dimension::LENGTH => size,
        Dimension::ANGLE => 1.0,
        _ => 0.0,
    }
}

/// A study whose own design moves, with the linear answer.
struct Ready<'m> {
    bench: Bench<'m>,
    /// What differs: parameters, and then joints with play.
    sources: Vec<Source>,
    /// What these are called.
    names: Vec<String>,
    /// So many of the bench's numbers are told, the first ones.
    shown: usize,
    limits: Vec<Limited>,
    /// By number.
    linear: Vec<Linear>,
    told: Vec<Diagnostic>,
}

impl<'m> Ready<'m> {
    fn new(
        model: &'m Model,
        played: Option<&'m Played>,
        study: &ToleranceStudy,
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        // The same but for joints that stand open by no length in its own design.
        let model = played.map_or(model, |it| &it.model);
        let over = study_of(model, &study.over)?;
        let mut numbers = numbers_of(model, &study.over, over);
        let mut place = |q: Quantity| {
            let known = numbers
                .iter()
                .position(|own| own.measure == q.measure || own.name == q.name);
            known.unwrap_or_else(|| {
                numbers.push(q);
                numbers.len() - 1
            })
        };
        let sides = study.limits.iter().map(|limit| limited_side(model, limit));
        let sides: Vec<usize> = sides.map(&mut place).collect();
        let shown = numbers.len();
        let size = design(model).size();
        let mut limits = Vec::new();
        for (limit, limited) in study.limits.iter().zip(sides) {
            numbers.push(kept(model, limit));
            let kept = numbers.len() - 1;
            let scale = scale_of(limit.condition.dimension, size);
            limits.push(Limited {
                limited,
                kept,
                rounding: told::ROUNDING * scale,
            });
        }
        let varied = study.vary.iter().map(|it| it.parameter);
        let opened = played.iter().flat_map(|it| it.parameters.iter().copied());
        let varied: Vec<ParameterId> = varied.chain(opened).collect();
        let mut bench = Bench::new(model, &study.over, varied, numbers)?.of_pieces();
        let mut told = match &over.kind {
            StudyKind::Simulate(it) => findings_of_simulation(model, &over.name, it, &[], progress),
            _ => bench.begin(progress)?,
        };
        told.extend(played.iter().flat_map(|it| it.told.iter().cloned()));
        if refuses(&told) {
            return Err(told);
        }
        let own = bench.own_values();
        let parameters = model.parameter_values();
        let parameter = |(first, (it, own)): (usize, (&Toleranced, &f64))| {
            let kind = Kind::Parameter(Deviation::new(&it.spread, &parameters, *own));
            Source { first, kind }
        };
        let alone: Vec<Source> = (study.vary.iter().zip(&own))
            .enumerate()
            .map(parameter)
            .collect();
        let differ: Vec<&Deviation> = deviations(&alone).collect();
        let among = |play: &Play| (play.clone()).among(&own, &differ, |v| bench.parameters(v));
        let joints = played.iter().flat_map(|it| &it.joints).map(|it| Source {
            first: study.vary.len() + it.first,
            kind: match &it.kind {
                Kind::Round(play) => Kind::Round(among(play)),
                Kind::Across(play) => Kind::Across(among(play)),
                Kind::Parameter(deviation) => Kind::Parameter(*deviation),
            },
        });
        let joints: Vec<Source> = joints.collect();
        let sources = [alone, joints].concat();
        let names = sources.iter().map(|it| {
            let id = bench.varied[it.first];
            let name = &model.parameters[id.index()].name;
            name.clone()
        });
        let names = names.collect();
        let linear = bench.watched(progress.watch(), || linear(&bench, &own, &sources));
        if progress.watch().stops() {
            return Err(vec![stopped(Stage::Measuring)]);
        }
        let linear = linear.map_err(|why| vec![of_own(study, why)])?;
        let it = Self {
            bench,
            sources,
            names,
            shown,
            limits,
            linear,
            told: Vec::new(),
        };
        told.extend(it.findings(study));
        Ok(Self { told, ..it })
    }

    fn findings(&self, study: &ToleranceStudy) -> Vec<Diagnostic> {
        let mut told = Vec::new();
        for (limit, own) in study.limits.iter().zip(&self.limits) {
            if !own.keeps(self.linear[own.kept].own) {
                let text = &limit.condition.text;
                let message = match self.linear[own.kept].own.is_nan() {
                    true => format!("the file's own design has no value that could keep {text}"),
                    false => format!("the file's own design does not keep {text}"),
                };
                told.push(
                    Diagnostic::warning("limit-not-kept", message)
                        .at(limit.span.clone(), "")
                        .help("change the design, or the limit"),
                );
            }
        }
        let own = self.bench.own_values();
        let around = own.iter().zip(deviations(&self.sources));
        let around: Vec<[f64; 2]> = around.map(|(x, it)| it.ends.map(|end| x + end)).collect();
        // What changes how much play there is changes what that does.
        let mut opens = vec![0.0; own.len()];
        for (k, ends) in around.iter().enumerate() {
            let mut plays = self.sources.iter().filter_map(Source::play);
            if plays.any(|it| it.hangs_on(k, *ends, &own, |v| self.bench.parameters(v))) {
                opens[k] = 1.0;
            }
        }
        let slopes = self.linear.iter().map(|it| it.slope.as_slice());
        let slopes: Vec<&[f64]> = slopes.chain([opens.as_slice()]).collect();
        let spans = study.vary.iter().map(|it| it.span.clone());
        told.extend(idle(&self.bench, &slopes, &around, spans));
        told.extend(self.number_warnings(&own));
        told.extend(self.alone(study, &own, around));
        if study.samples < FEW {
            let message = format!(
                "{} pieces are too few to tell how they differ",
                study.samples
            );
            told.push(
                Diagnostic::warning("few-pieces", message)
                    .at(study.over.span.clone(), "")
                    .help("draw more: samples = 1000"),
            );
        }
        told
    }

    /// What is told of an own design whose numbers no piece beside it has.
    fn alone(
        &self,
        study: &ToleranceStudy,
        own: &[f64],
        around: Vec<[f64; 2]>,
    ) -> Option<Diagnostic> {
        if !self.bench.has_slopes() || !crosses(&*self.bench.motion(own, &mut Silent).ok()?) {
            return None;
        }
        let numbers = self.bench.numbers.iter();
        let wanted = numbers.map(|it| Wanted::new(self.bench.mechanism(), it.clone(), 1.0));
        let wanted: Vec<Wanted> = wanted.collect();
        let goals = wanted.len();
        let designs = Designs::within(&self.bench, wanted, goals, around);
        let message = format!(
            "the file's own design of `{}` moves through a change point, and goes on there as no piece beside it does",
            self.bench.over.name
        );
        designs.is_alone(own).then(|| {
            Diagnostic::warning("alone-at-change-point", message)
                .at(study.over.span.clone(), "")
                .note("the linear answer, and a worst case that is the file's own design, hold of it alone")
                .help("go by the pieces, or choose dimensions away from the change point")
        })
    }

    /// What is to be told of the numbers of the file's own design.
    fn number_warnings(&self, own: &[f64]) -> Vec<Diagnostic> {
        let numbers: Vec<&Quantity> = self.bench.numbers.iter().take(self.shown).collect();
        let motion = self.bench.motion(own, &mut Silent);
        let along = motion.and_then(|it| self.bench.along(&it, &numbers, &mut Silent));
        let over = Some(self.bench.over.name.as_str());
        along.map_or_else(|_| Vec::new(), |it| it.number_warnings(over, &numbers))
    }
}

/// How parameters differ, without joints.
fn deviations(sources: &[Source]) -> impl Iterator<Item = &Deviation> {
    sources.iter().filter_map(|it| match &it.kind {
        Kind::Parameter(deviation) => Some(deviation),
        _ => None,
    })
}

/// Why the file's own design has no numbers.
fn of_own(study: &ToleranceStudy, why: String) -> Diagnostic {
    let error = Diagnostic::error("no-answer", why).at(study.over.span.clone(), "");
    error.help("the file's own design must move as the study asks")
}

/// The linear answers, by exact derivatives; of a simulation, which has none, by differences over a standard deviation.
fn linear(bench: &Bench<'_>, own: &[f64], sources: &[Source]) -> Result<Vec<Linear>, String> {
    if bench.has_slopes() {
        let found = bench.slopes(own).map_err(|refused| refused.why)?;
        let all = found.into_iter();
        return Ok(all
            .map(|it| Linear::new(it.value, it.slope, sources))
            .collect());
    }
    let middle = bench.numbers(own).map_err(|refused| refused.why)?;
    let mut slopes = vec![Vec::new(); middle.len()];
    for (k, deviation) in deviations(sources).enumerate() {
        let step = deviation.deviation();
        let beside = |sign: f64| {
            let mut values = own.to_vec();
            values[k] += sign * step;
            bench.numbers(&values).ok()
        };
        let ends = (beside(-1.0), beside(1.0));
        for (number, slope) in slopes.iter_mut().enumerate() {
            slope.push(match &ends {
                (Some(low), Some(high)) => (high[number] - low[number]) / (2.0 * step),
                _ => f64::NAN,
            });
        }
    }
    let pairs = middle.into_iter().zip(slopes);
    Ok(pairs
        .map(|(own, slope)| Linear::new(own, slope, sources))
        .collect())
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

/// What is followed along the motion: what is plotted, or what the study that is run plots or tabulates.
fn curves(model: &Model, over: &OverStudy, kind: &StudyKind) -> Vec<Quantity> {
    let along = kind.along();
    let of = |plots: &[Plot]| {
        let mut found: Vec<Quantity> = Vec::new();
        let mut add = |q: Quantity| {
            if found.iter().all(|known| known.measure != q.measure) {
                found.push(q);
            }
        };
        for plot in plots {
            match plot {
                Plot::Curves(columns) => columns.iter().for_each(|c| {
                    add(Quantity {
                        name: c.name.clone(),
                        measure: c.measure.clone(),
                        dimension: c.dimension,
                    });
                }),
                Plot::Path(point) => coordinates(model, *point).into_iter().for_each(&mut add),
                Plot::Hodograph(_) => {}
            }
        }
        found
    };
    let own = of(&over.asked.plots);
    if !own.is_empty() {
        return own;
    }
    let mut found = of(&along.plots);
    if found.is_empty() {
        found = Asked::of_motion(model, along).columns;
    }
    found.retain(|q| !crate::columns::is_number(model, &q.measure));
    found.truncate(CURVES);
    found
}

/// Both coordinates of a point.
fn coordinates(model: &Model, point: PointId) -> [Quantity; 2] {
    let name = model.points.get(point.index()).map_or("", |p| &p.name);
    let one = |axis: &str, pose: PoseMeasure| Quantity {
        name: format!("{axis}({name})"),
        measure: Expr::Leaf(Leaf::Pose(pose)),
        dimension: Dimension::LENGTH,
    };
    [
        one("x", PoseMeasure::X(point)),
        one("y", PoseMeasure::Y(point)),
    ]
}

/// The motion of the file's own design with what is followed along it.
fn own_motion(
    model: &Model,
    name: &str,
    bench: &Bench<'_>,
    curves: &[Quantity],
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let columns = curves.iter().map(|q| kempe_model::Column {
        name: q.name.clone(),
        measure: q.measure.clone(),
        dimension: q.dimension,
    });
    let along = MotionStudy {
        rows: bench.over.kind.along().rows.clone(),
        columns: columns.collect(),
        plots: Vec::new(),
        circuit: false,
    };
    match &bench.over.kind {
        StudyKind::Simulate(it) => {
            let it = kempe_model::SimulateStudy {
                along,
                ..it.clone()
            };
            simulation(model, name, &it, &[], progress).map(|(result, _)| result)
        }
        StudyKind::Forces(_) => run_along(model, name, &along, true, progress),
        _ => run_along(model, name, &along, false, progress),
    }
}
