//! Sweeps: a study run for given values of parameters, a row for each design.
//!
//! `order.rs` says which designs there are and in which order, `family.rs` plots curves of several of them in one picture, `effects.rs` tells what each parameter
//! does, exactly and by the values that were tried.

mod effects;
mod family;
mod order;

use kempe_model::{Diagnostic, Model, ParameterId, SweepStudy};
use kempe_motion::progress::{Done, Progress, Silent, Stage};
use kempe_units::Unit;

use super::asked::numbers_of;
use super::bench::{Answer, Bench, Refused};
use super::idle::idle_at_own;
use super::study_of;
use crate::clearance::refuses;
use crate::explain::stopped;
use crate::result::StudyResult;
use crate::table::{Column, Table};
use crate::unit::{Units, shown};
use effects::effects;
use family::Families;
use order::Order;

/// So many designs one sweep has at most.
const MOST_DESIGNS: usize = 1_000_000;

fn bench<'m>(model: &'m Model, study: &SweepStudy) -> Result<Bench<'m>, Vec<Diagnostic>> {
    let over = study_of(model, &study.over)?;
    let ids: Vec<ParameterId> = study.vary.iter().map(|it| it.parameter).collect();
    Bench::new(
        model,
        &study.over,
        ids,
        numbers_of(model, &study.over, over),
    )
}

/// What is to be told of a sweep before its rows; `check` and `run` say the same.
pub(crate) fn findings_of_sweep(model: &Model, study: &SweepStudy) -> Vec<Diagnostic> {
    match bench(model, study) {
        Ok(mut bench) => before(&mut bench, study, &mut Silent),
        Err(told) => told,
    }
}

fn before(
    bench: &mut Bench<'_>,
    study: &SweepStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let own = bench.begin(progress);
    let mut told = own.unwrap_or_else(|told| told.into_iter().map(super::softened).collect());
    let count = Order::count(study);
    if count.is_none_or(|count| count > MOST_DESIGNS) {
        let message = match count {
            Some(count) => format!("a sweep of {count} designs"),
            None => "a sweep of more designs than can be counted".to_owned(),
        };
        told.push(
            Diagnostic::error("too-large", message)
                .at(study.over.span.clone(), "")
                .help(format!("a sweep has at most {MOST_DESIGNS} designs: fewer values, or combine = \"one at a time\"")),
        );
    }
    if !refuses(&told) {
        let order = Order::new(bench, study);
        let spans = study.vary.iter().map(|it| it.span.clone());
        told.extend(idle_at_own(bench, &order.ends(), spans));
    }
    told
}

/// A sweep.
pub(crate) fn sweep(
    model: &Model,
    name: &str,
    study: &SweepStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let mut bench = bench(model, study)?;
    let mut diagnostics = before(&mut bench, study, progress);
    if refuses(&diagnostics) {
        return Err(diagnostics);
    }
    let units = Units::of(model);
    let order = Order::new(&bench, study);
    let mut families = Families::new(&bench, study, order.designs.len());
    let mut answers: Vec<Result<Answer, Refused>> = Vec::with_capacity(order.designs.len());
    for (k, values) in order.designs.iter().enumerate() {
        answers.push(families.answer(k, values));
        let done = Done::Of(k + 1, order.designs.len());
        if progress.reached(Stage::Rows, done).is_break() {
            break;
        }
    }
    if answers.is_empty() {
        return Err(vec![stopped(Stage::Rows)]);
    }
    let failed = answers.iter().filter(|answer| answer.is_err()).count();
    if failed > 0 {
        let first = answers.iter().position(Result::is_err).unwrap_or(0);
        let why = answers[first]
            .as_ref()
            .err()
            .map_or("", |refused| refused.why.as_str());
        diagnostics.push(
            Diagnostic::warning(
                "rows-not-reached",
                format!(
                    "{failed} of {} designs of study `{name}` do not move as `{}` asks",
                    answers.len(),
                    study.over.name
                ),
            )
            .note(format!("design {}: {why}", first + 1)),
        );
    }
    let mut result = StudyResult {
        name: name.to_owned(),
        demanded_rows: order.designs.len(),
        table: table(name, &bench, &order, &answers, &units),
        beside: Vec::new(),
        scalars: Vec::new(),
        figures: families.figures(&order, &units),
        listings: effects(&bench, study, &order, &answers, &units),
        contacts: Vec::new(),
        frames: Vec::new(),
        shapes: Vec::new(),
        designs: Vec::new(),
        events: Vec::new(),
        along: 0,
        assemblies: (0, 0),
        diagnostics,
    };
    if let Some(figures) = order.over_one(&bench, &result.table) {
        result.figures.splice(0..0, figures);
    }
    Ok(result)
}

/// A row for each design: its values, its numbers, or why it has none.
fn table(
    name: &str,
    bench: &Bench<'_>,
    order: &Order,
    answers: &[Result<Answer, Refused>],
    units: &Units,
) -> Table {
    let rows = answers.len();
    let mut number = Column::new("design", Unit::one());
    number.values = (1..=rows).map(|k| k as f64).collect();
    let mut columns = vec![number];
    for (k, id) in bench.varied.iter().enumerate() {
        let parameter = &bench.model.parameters[id.index()];
        let unit = units.unit(parameter.dimension);
        let mut column = Column::new(&parameter.name, unit.clone());
        column.values = order
            .designs
            .iter()
            .take(rows)
            .map(|design| shown(design[k], &unit))
            .collect();
        columns.push(column);
    }
    for (k, quantity) in bench.numbers.iter().enumerate() {
        let unit = quantity.unit(units);
        let mut column = Column::new(&quantity.name, unit.clone());
        let value = |answer: &Result<Answer, Refused>| {
            answer.as_ref().map_or(f64::NAN, |all| all.numbers[k])
        };
        column.values = answers
            .iter()
            .map(|answer| shown(value(answer), &unit))
            .collect();
        columns.push(column);
    }
    let evidence = |of: fn(&Answer) -> f64| -> Vec<f64> {
        answers
            .iter()
            .map(|answer| answer.as_ref().map_or(f64::NAN, of))
            .collect()
    };
    Table {
        name: name.to_owned(),
        places: 1 + bench.varied.len(),
        closure: evidence(|answer| answer.closure),
        smallest_singular_value: evidence(|answer| answer.smallest_singular_value),
        forces: None,
        balance: None,
        notes: (answers.iter())
            .map(|answer| answer.as_ref().err().map(|refused| refused.why.clone()))
            .collect(),
        columns,
    }
}
