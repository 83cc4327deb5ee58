//! Sweeps: a study run for given values of parameters.
//!
//! `designs.rs` says which designs these are, `question.rs` asks one of them (`whole.rs`, where the study that is run tells its numbers itself), `part.rs` holds what is known of some that follow each other, as
//! bytes that can be kept, and `parts.rs` goes from part to part. What is told of all of them, `told.rs` and `family.rs` make of the parts
//! alone, so that it is the same whether they were computed at once, in turns or by many machines.

mod answer;
mod designs;
mod drawn;
mod family;
mod listed;
mod part;
mod parts;
mod question;
#[cfg(feature = "parquet")]
mod rows;
mod told;
mod whole;

use kempe_batch::Executor;
use kempe_model::{Diagnostic, Model, Study, StudyKind, SweepStudy};
use kempe_motion::{Done, Progress, Silent, Stage};
use kempe_units::Unit;

use super::kept_parts::Parts;
use super::over::{study_of, valueless};
use super::warned::warned;
use crate::explain::stopped;
use crate::result::{Scalar, StudyResult};
use crate::room::{Held, has_room};
use crate::table::Table;
use part::{Part, append};
use parts::{Layout, computed};
use question::{DRAWN, Question};
use told::{Own, derivatives, tornado};
use whole::is_of_designs;

pub(crate) use listed::listed;
#[cfg(feature = "parquet")]
pub use rows::{RowFiles, RowsError};

/// Numbers about that a study of many designs tells.
const NUMBERS_OF_LONG: usize = 256;
/// So many of the first designs are listed, and of the rest so many of which there is something to say.
const LISTED: [usize; 2] = [40, 10];

/// What is to be told of a sweep before its designs; `check` and `run` say the same.
pub(crate) fn findings_of_sweep(
    model: &Model,
    name: &str,
    study: &SweepStudy,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    if is_over_designs(model, study) {
        // What that study itself says before its designs is told with it; it takes too long to be run for more.
        return has_room(model, name, bytes_of_sweep(model, study))
            .err()
            .unwrap_or_default();
    }
    let begun = has_room(model, name, bytes_of_sweep(model, study))
        .and_then(|()| Question::new(model, name, study, progress))
        .and_then(|question| begin(question, progress));
    begun.map_or_else(|told| told, |begun| begun.told)
}

/// A sweep whose own design was moved.
struct Begun<'m> {
    question: Question<'m>,
    own: Own,
    told: Vec<Diagnostic>,
}

fn begin<'m>(
    mut question: Question<'m>,
    progress: &mut dyn Progress,
) -> Result<Begun<'m>, Vec<Diagnostic>> {
    let mut told = question.begin(progress)?;
    let own = Own::of(&question);
    told.extend(own.told(&question));
    Ok(Begun {
        question,
        own,
        told,
    })
}

/// A sweep: all its designs, those of kept parts without being computed.
pub(crate) fn sweep(
    model: &Model,
    name: &str,
    study: &SweepStudy,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let question = Question::new(model, name, study, progress)?;
    let Begun {
        question,
        own,
        told: mut diagnostics,
    } = begin(question, progress)?;
    let layout = Layout::of(&question);
    let mut table = question.table();
    let mut curves = Vec::new();
    for number in 0..layout.count() {
        let (part, goes_on) = of_part(&question, &layout, number, (executor, parts), progress)
            .map_err(|d| vec![*d])?;
        append(&mut table, &part.designs);
        curves.extend(part.curves);
        if !goes_on {
            break;
        }
    }
    if table.rows() == 0 && question.designs.count() > 0 {
        return Err(vec![stopped(Stage::Rows)]);
    }
    let demanded_rows = question.designs.count();
    diagnostics.extend(no_values(&question, &table));
    diagnostics.extend(some_without(&question, &table));
    let notes = table.notes.iter().map(Option::as_deref);
    let of = (question.name.as_str(), &question.study.over);
    let values = |design: usize| question.designs.values(design);
    diagnostics.extend(warned(of, &question.bench, (notes, table.rows()), values));
    let mut figures = family::figures(&question, &table, &curves);
    let title = match question.designs.one_at_a_time() {
        true => "designs, the first as in the file",
        false => "designs",
    };
    let mut listings = vec![listed(&table, title.to_owned(), LISTED)];
    listings.extend(derivatives(&question, &own, &table));
    if question.designs.one_at_a_time() {
        let (told, drawn) = tornado(&question, &table);
        listings.extend(told);
        figures.splice(0..0, drawn);
    }
    listings.extend(family::left_out(&question));
    if parts.rows() && layout.has_rows() && !layout.row_room() {
        listings.push(rows_left_out());
    }
    // One parameter is what the designs go along.
    let along = match question.designs.own.len() {
        1 if !question.designs.one_at_a_time() => 1,
        _ => 0,
    };
    Ok(StudyResult {
        beside: Vec::new(),
        name: name.to_owned(),
        scalars: counts(&table),
        table,
        figures,
        listings,
        contacts: Vec::new(),
        happenings: Vec::new(),
        frames: Vec::new(),
        shapes: Vec::new(),
        designs: Vec::new(),
        events: Vec::new(),
        along,
        assemblies: (0, 0),
        diagnostics,
        demanded_rows,
        stopped_at: None,
    })
}

/// A part that was kept, or is computed and kept as far as it is whole, and whether to go on.
fn of_part(
    question: &Question<'_>,
    layout: &Layout,
    number: usize,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<(Part, bool), Box<Diagnostic>> {
    let designs = layout.designs(number);
    let rows = parts.rows() && layout.row_room();
    if let Some(bytes) = parts.kept(number)?
        && let Some(part) = Part::from_bytes(question, designs.start, designs.len(), &bytes)
        && part.rows.is_some() == rows
    {
        let done = Done::Of(designs.end, question.designs.count());
        let goes_on = progress.reached(Stage::Rows, done).is_continue();
        return Ok((part, goes_on));
    }
    let all = designs.len();
    let (mut part, goes_on) = computed(question, designs, rows, executor, progress);
    if part.designs.rows() == all {
        parts.keep(number, part.to_bytes())?;
    }
    part.rows = None;
    Ok((part, goes_on))
}

/// That no design has any values.
fn no_values(question: &Question<'_>, table: &Table) -> Option<Diagnostic> {
    let count = table.rows();
    if count == 0 || table.unreached() < count {
        return None;
    }
    let message = format!(
        "study `{}`: none of its {count} designs has values",
        question.name
    );
    let error = Diagnostic::error("no-answer", message).at(question.study.over.span.clone(), "");
    let error = match table.notes.iter().flatten().next() {
        Some(note) => error.note(format!("the first: {note}")),
        None => error,
    };
    Some(error.help("vary within what the mechanism can do: `kempe check` tells how it moves"))
}

/// Numbers that some designs lack which have others.
fn some_without(question: &Question<'_>, table: &Table) -> Vec<Diagnostic> {
    let (rows, unreached) = (table.rows(), table.unreached());
    let numbers = table.columns.iter().skip(table.places);
    let missing = numbers.map(|column| {
        let without = column.values.iter().filter(|x| x.is_nan()).count();
        (&column.name, without.saturating_sub(unreached))
    });
    missing
        .filter(|(_, missing)| *missing > 0 && unreached < rows)
        .map(|(name, missing)| {
            let of = format!("{rows} designs");
            valueless(name, (missing, &of), &question.study.over)
        })
        .collect()
}

/// How many designs there are, and how many of them have no values.
fn counts(table: &Table) -> Vec<Scalar> {
    let counts = [
        ("designs", table.rows()),
        ("designs without values", table.unreached()),
    ];
    let scalar = |(name, count): (&str, usize)| Scalar {
        name: name.to_owned(),
        unit: Unit::one(),
        value: count as f64,
    };
    counts.into_iter().map(scalar).collect()
}

fn rows_left_out() -> crate::result::Listing {
    crate::result::Listing {
        title: "the rows of the designs would take more than 64 GiB: they are in no file; take fewer of them in the study that is run"
            .to_owned(),
        head: Vec::new(),
        rows: Vec::new(),
    }
}

/// Whether a sweep runs a study that itself is one of many designs.
fn is_over_designs(model: &Model, study: &SweepStudy) -> bool {
    study_of(model, &study.over).is_ok_and(|over| is_of_designs(&over.kind))
}

/// In how many parts a study is computed; none of one that is computed as a whole.
///
/// # Errors
///
/// What of it no design can answer.
pub fn part_count(model: &Model, study: &Study) -> Result<Option<usize>, Vec<Diagnostic>> {
    let StudyKind::Sweep(asked) = &study.kind else {
        return Ok(None);
    };
    if is_over_designs(model, asked) {
        let designs = designs::Designs::new(model, asked).count();
        return Ok(Some(Layout::of_long(designs).count()));
    }
    let question = Question::new(model, &study.name, asked, &mut Silent)?;
    Ok(Some(Layout::of(&question).count()))
}

/// Computes the parts of a sweep that are not kept yet and are to be computed here: whether all of them are finished, and what is to be told
/// of the sweep before its designs.
///
/// # Errors
///
/// What of it no design can answer; why a part cannot be kept.
pub fn compute_parts(
    model: &Model,
    study: &Study,
    (executor, parts): (&dyn Executor, &mut dyn Parts),
    progress: &mut dyn Progress,
) -> Result<(bool, Vec<Diagnostic>), Vec<Diagnostic>> {
    let StudyKind::Sweep(asked) = &study.kind else {
        return Ok((true, Vec::new()));
    };
    has_room(model, &study.name, bytes_of_sweep(model, asked))?;
    let question = Question::new(model, &study.name, asked, progress)?;
    let Begun { question, told, .. } = begin(question, progress)?;
    let layout = Layout::of(&question);
    for number in (0..layout.count())
        .filter(|it| parts.computes(*it))
        .collect::<Vec<_>>()
    {
        let found = of_part(&question, &layout, number, (executor, parts), progress);
        let (_, goes_on) = found.map_err(|d| vec![*d])?;
        if !goes_on {
            return Ok((false, told));
        }
    }
    Ok((true, told))
}

/// What a sweep will hold: the numbers of all designs, and the curves of some.
pub(crate) fn bytes_of_sweep(model: &Model, study: &SweepStudy) -> Held {
    let designs = designs::Designs::new(model, study);
    let count = designs.count() as f64;
    let number = size_of::<f64>();
    if is_over_designs(model, study) {
        return Held {
            rows: count,
            row: NUMBERS_OF_LONG * number,
        };
    }
    let Ok(question) = Question::new(model, "", study, &mut Silent) else {
        return Held {
            rows: 1.0,
            row: number,
        };
    };
    let columns = question.table().with_evidence().len();
    let rows = question.most_rows();
    let curves = count.min(DRAWN as f64) * rows * (3 * question.curves() * number) as f64;
    Held {
        rows: count,
        row: columns * number
            + size_of::<Option<String>>()
            + (curves / count.max(1.0)).ceil() as usize,
    }
}
