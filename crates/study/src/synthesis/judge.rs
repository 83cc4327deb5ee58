//! What a linkage does when it is moved, and whether that is wanted.

use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, Model, NamedMeasure, Statistic, StudyKind};
use kempe_motion::progress::Silent;
use kempe_units::{Dimension, Expr, Unit};

use super::asked::{Questions, read};
use super::candidate::{Candidate, LINK_RATIO, Order, Rejected, apart, dimensions_in_words};
use crate::columns::is_of_whole_motion;
use crate::motion::run_along_with;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::unit::{Units, shown};

/// A linkage that is accepted.
pub(super) struct Judged {
    /// It by its dimensions.
    pub what: String,
    pub candidate: Candidate,
    pub model: Model,
    /// How it moves.
    pub motion: StudyResult,
    /// What it is ordered by.
    pub rank: f64,
    /// What is told of it.
    pub values: Vec<Value>,
}

/// A number with its name.
pub(super) struct Value {
    pub name: String,
    pub unit: Unit,
    pub value: f64,
}

/// What is missed beyond this, rad, in parts of the linkage's longest link, or of the largest rate, is not what was asked.
const MISSED: f64 = 1e-7;

/// A linkage whose links differ by more has one that is as good as none.
const MOST_RATIO: f64 = 1e5;

/// Moves a linkage and looks whether it does what is asked, or why it is of no use.
pub(super) fn judge(
    candidate: Candidate,
    questions: &Questions<'_>,
    units: &Units,
) -> Result<Judged, Box<Rejected>> {
    let what = dimensions_in_words(&candidate.lengths(), units);
    let reject = |why: String| {
        let what = what.clone();
        Box::new(Rejected { what, why })
    };
    let lengths = candidate.links();
    let [shortest, longest] = [f64::min, f64::max].map(|pick| lengths.iter().copied().reduce(pick));
    if let (Some(shortest), Some(longest)) = (shortest, longest)
        && !(longest < MOST_RATIO * shortest)
    {
        return Err(reject(format!(
            "its shortest link is nothing beside its longest: 1 : {}",
            kempe_number::text::significant(longest / shortest, 3)
        )));
    }
    let request = questions.request;
    let file = candidate.file(&request.title, request, &questions.parameters);
    let model = read(&file).map_err(|wrong| {
        let first = wrong.first();
        reject(first.map_or_else(String::new, |d| d.message.clone()))
    })?;
    let numbers = Numbers::of(&model, &candidate, questions);
    let numbers = numbers.map_err(|_| reject("it cannot be measured as asked".to_owned()))?;
    let (motion, values) = moved(&model, candidate.study(), &numbers.all)
        .map_err(|why| reject(format!("it cannot be moved through what is asked: {why}")))?;
    for (condition, text) in numbers.conditions.iter().zip(&questions.study.accept) {
        let [left, above] = [condition, &(condition + 1)].map(|k| values[*k]);
        if !(above >= 0.0) {
            let Quantity {
                name, dimension, ..
            } = &numbers.all[*condition];
            let value = units.text(left, *dimension);
            return Err(reject(format!("{name} = {value}: not {}", text.text)));
        }
    }
    let missed = missed(&candidate, &model, &numbers, &values, units).map_err(reject)?;
    let mut told: Vec<Value> = Vec::new();
    let mut tell = |name: &str, si: f64, dimension: Dimension| {
        if told.iter().all(|v| v.name != name) {
            let unit = units.unit(dimension);
            told.push(Value {
                name: name.to_owned(),
                value: shown(si, &unit),
                unit,
            });
        }
    };
    for (name, length) in candidate.lengths() {
        tell(name, length, Dimension::LENGTH);
    }
    for (name, si, dimension) in candidate.told() {
        tell(name, *si, *dimension);
    }
    for k in numbers
        .conditions
        .iter()
        .copied()
        .chain(numbers.told.clone())
    {
        let Quantity {
            name, dimension, ..
        } = &numbers.all[k];
        tell(name, values[k], *dimension);
    }
    if !candidate.wanted().is_empty() {
        tell("miss", missed, Dimension::NONE);
    }
    let rank = match (&questions.study.rank, candidate.order()) {
        (None, Order::Known(own)) => own,
        _ => values[numbers.told.start],
    };
    Ok(Judged {
        what,
        candidate,
        model,
        motion,
        rank,
        values: told,
    })
}

/// Numbers over the motion that are asked of a linkage.
struct Numbers {
    all: Vec<Quantity>,
    /// Of each condition its left side; the next number is how far it is kept.
    conditions: Vec<usize>,
    /// The one that linkages are ordered by, and those that are told besides.
    told: std::ops::Range<usize>,
    /// What it must do.
    wanted: std::ops::Range<usize>,
}

impl Numbers {
    fn of(
        model: &Model,
        candidate: &Candidate,
        questions: &Questions<'_>,
    ) -> Result<Self, Vec<kempe_model::Diagnostic>> {
        let mechanism = Mechanism::new(model);
        let whole = |measure: &Measure| is_of_whole_motion(&mechanism, measure);
        // What has a value at every instant is asked for where it is smallest, or largest.
        let over = |statistic: Statistic, it: NamedMeasure| match whole(&it.measure) {
            true => (it.name, it.measure),
            false => {
                let word = match statistic {
                    Statistic::Max => "max",
                    _ => "min",
                };
                let name = match is_constant(&it.measure) {
                    true => it.name,
                    false => format!("{word}({})", it.name),
                };
                (
                    name,
                    Expr::Leaf(Leaf::Over(statistic, Box::new(it.measure))),
                )
            }
        };
        let mut all: Vec<Quantity> = Vec::new();
        let mut ask = |(name, measure): (String, Measure), dimension: Dimension| {
            all.push(Quantity {
                name,
                measure,
                dimension,
            });
            all.len()
        };
        let study = questions.study;
        let mut conditions = Vec::new();
        for asked in &study.accept {
            let it = model.condition(&asked.text)?;
            let dimension = it.left.dimension;
            let statistic = match it.at_least {
                true => Statistic::Min,
                false => Statistic::Max,
            };
            let above = NamedMeasure {
                measure: it.above,
                ..it.left.clone()
            };
            conditions.push(ask(over(statistic, it.left), dimension) - 1);
            ask(over(Statistic::Min, above), dimension);
        }
        let first = all.len();
        let mut ask = |(name, measure): (String, Measure), dimension: Dimension| {
            all.push(Quantity {
                name,
                measure,
                dimension,
            });
            all.len()
        };
        let rank = match (&study.rank, candidate.order()) {
            (Some(asked), _) => asked.text.as_str(),
            (None, Order::Measure(own)) => own,
            (None, Order::Known(_)) => LINK_RATIO,
        };
        let own = candidate.columns().iter().map(String::as_str);
        let more = own.chain(study.columns.iter().map(|asked| asked.text.as_str()));
        let mut end = first;
        for text in std::iter::once(rank).chain(more) {
            let it = model.measure(text)?;
            let dimension = it.dimension;
            end = ask(over(Statistic::Min, it), dimension);
        }
        let parameters = model.parameter_values::<f64>();
        let driven = candidate.driven(model);
        let drive = driven.and_then(|id| model.drives.get(id.index()));
        let law = drive.map(|drive| &drive.law);
        let range = law.map_or((f64::NEG_INFINITY, f64::INFINITY), |law| {
            law.extent(&parameters)
        });
        let inside = INSIDE * (range.1 - range.0);
        let (low, high) = (range.0 + inside, range.1 - inside);
        for wanted in candidate.wanted() {
            let it = model.measure(&wanted.measure)?;
            let dimension = it.dimension;
            // An end of the range is where it should be but for rounding, and nothing is known beyond it.
            let at = Statistic::At {
                drive: driven,
                value: Expr::Const(wanted.at.clamp(low, high)),
            };
            ask(over(at, it), dimension);
        }
        let wanted = end..all.len();
        Ok(Self {
            all,
            conditions,
            told: first..end,
            wanted,
        })
    }
}

/// So far inside of the drive's range its ends are looked at, in parts of it.
const INSIDE: f64 = 1e-13;

/// How a linkage's file moves it, with numbers (SI) over its motion; or why it does not.
fn moved(
    model: &Model,
    study: &str,
    numbers: &[Quantity],
) -> Result<(StudyResult, Vec<f64>), String> {
    let own = model.studies.iter().find(|own| own.name == study);
    let Some(StudyKind::Motion(own)) = own.map(|own| &own.kind) else {
        return Err("its file asks for no motion".to_owned());
    };
    let ran = run_along_with(model, study, own, (false, numbers), &mut Silent);
    let (motion, values) = ran.map_err(|told| {
        let first = told.first();
        first.map_or_else(String::new, |d| d.message.clone())
    })?;
    if motion.table.unreached() > 0 {
        let note = motion.table.notes.iter().flatten().next();
        return Err(note
            .cloned()
            .unwrap_or_else(|| "not all of it is reached".to_owned()));
    }
    let last = |values: &Vec<f64>| values.last().copied().unwrap_or(f64::NAN);
    Ok((motion, values.iter().map(last).collect()))
}

/// By how much a linkage misses what it must do, or where it does something else.
fn missed(
    candidate: &Candidate,
    model: &Model,
    numbers: &Numbers,
    values: &[f64],
    units: &Units,
) -> Result<f64, String> {
    let longest = candidate.links().iter().fold(0.0, |m: f64, l| m.max(*l));
    let mut worst = 0.0_f64;
    for (wanted, k) in candidate.wanted().iter().zip(numbers.wanted.clone()) {
        let dimension = numbers.all[k].dimension;
        let size = wanted.scale.unwrap_or(match dimension {
            Dimension::LENGTH => longest,
            _ => 1.0,
        });
        let by = match candidate.counts_turns() {
            true => (values[k] - wanted.value).abs(),
            false => apart(values[k], wanted.value, dimension),
        } / size;
        worst = worst.max(by);
        if !(by <= MISSED) {
            let driven = candidate.driven(model);
            let drive = driven.and_then(|id| model.drives.get(id.index()));
            let at = drive.map_or_else(String::new, |drive| {
                let at = units.text(wanted.at, drive.dimension);
                format!(" ({} = {at})", drive.name)
            });
            return Err(format!(
                "moved there, {} is {} where it should be {}{at}",
                wanted.measure,
                units.text(values[k], dimension),
                units.text(wanted.value, dimension),
            ));
        }
    }
    Ok(worst)
}

fn is_constant(measure: &Measure) -> bool {
    let mut leaves = measure.leaves();
    leaves.all(|leaf| matches!(leaf, Leaf::Parameter(_)))
}
