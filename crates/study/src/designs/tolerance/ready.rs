//! A study of tolerances whose own design moves: what differs, the numbers that are asked, and their linear answer.

use kempe_model::{Diagnostic, Model, ParameterId, StudyKind, ToleranceStudy, Toleranced};
use kempe_motion::progress::{Progress, Silent, Stage};

use super::linear::Linear;
use super::play::Played;
use super::rounding::{ROUNDING, scale_of};
use super::sobol::Sobol;
use super::source::{Kind, Play, Source, deviations};
use super::spread::Deviation;
use crate::clearance::refuses;
use crate::designs::asked::{kept, limited_side, numbers_of};
use crate::designs::bench::{Bench, crosses};
use crate::designs::idle::idle;
use crate::designs::optimize::{Designs, Wanted};
use crate::designs::over::study_of;
use crate::explain::stopped;
use crate::prepared::design;
use crate::quantity::Quantity;
use crate::simulation::findings_of_simulation;

/// With fewer pieces than this their deviation is hardly known.
const FEW: usize = 30;

/// The joints with play, where they count.
///
/// # Errors
/// Why they cannot.
pub(super) fn played(
    model: &Model,
    study: &ToleranceStudy,
) -> Result<Option<Played>, Vec<Diagnostic>> {
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
pub(super) struct Limited {
    pub limited: usize,
    pub kept: usize,
    /// What is rounding of it, SI.
    rounding: f64,
}

impl Limited {
    /// Whether a piece keeps it that is so far from it.
    pub fn keeps(&self, margin: f64) -> bool {
        margin >= -self.rounding
    }
}

/// A study whose own design moves, with the linear answer.
pub(super) struct Ready<'m> {
    pub bench: Bench<'m>,
    /// What differs: parameters, and then joints with play.
    pub sources: Vec<Source>,
    /// What these are called.
    pub names: Vec<String>,
    /// So many of the bench's numbers are told, the first ones.
    pub shown: usize,
    pub limits: Vec<Limited>,
    /// By number.
    pub linear: Vec<Linear>,
    pub told: Vec<Diagnostic>,
}

impl<'m> Ready<'m> {
    pub fn new(
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
                rounding: ROUNDING * scale,
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

/// Why the file's own design has no numbers.
pub(super) fn of_own(study: &ToleranceStudy, why: String) -> Diagnostic {
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
