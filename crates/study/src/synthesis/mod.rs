//! Studies that ask for linkages: all that do it, which of them can be used, and why the others cannot.
//!
//! A task becomes candidates (`function.rs`, `rates.rs`, `dead_centres.rs`), each right where it is asked; every candidate becomes a model
//! file (`file.rs`), is moved as any other model, and is judged by what it then does (`judge.rs`).

mod asked;
mod beside;
mod candidate;
mod cognates;
mod dead_centres;
mod dwell;
mod file;
mod function;
mod judge;
mod motion;
mod own_linkage;
mod passing;
mod path;
mod point_way;
mod rates;
mod refused;
mod solutions;

use kempe_model::{
    Diagnostic, DwellOutput, LinkageKind, Model, Stroke, SynthesisTask, SynthesizeStudy,
    WantedFunction,
};
use kempe_motion::progress::{Done, Progress, Stage};
use kempe_synthesis::Linkage;
use kempe_units::Unit;

use crate::clearance::refuses;
use crate::explain::stopped;
use crate::result::{FoundDesign, Listing, Scalar, StudyResult};
use crate::table::{Column, Table};
use crate::unit::{Units, number_text};
use asked::Questions;
use candidate::{Candidate, Found};
use judge::{Judged, judge};

fn kinds(linkage: LinkageKind) -> &'static str {
    match linkage {
        LinkageKind::FourBar => "four-bars",
        LinkageKind::SliderCrank => "slider-cranks",
        LinkageKind::InvertedSliderCrank => "inverted slider-cranks",
    }
}

/// What a study asks for, in words, for `check`.
pub(crate) fn in_words(study: &SynthesizeStudy) -> String {
    let kept = format!("at most {} kept", study.keep);
    let task = match &study.task {
        SynthesisTask::Function(task) => {
            let what = kinds(task.linkage);
            match &task.wanted {
                WantedFunction::Pairs(pairs) => format!("{what} through {} pairs", pairs.len()),
                WantedFunction::Curve(curve) => {
                    format!("{what} for {}, met in {} places", curve.text, curve.points)
                }
            }
        }
        SynthesisTask::Rates(_) => "the four-bar of given rates at one pose".to_owned(),
        SynthesisTask::DeadCentres(task) => match task.stroke {
            Stroke::Swing { .. } => "crank-rockers by swing and time ratio".to_owned(),
            Stroke::Travel { .. } => "slider-cranks by stroke and time ratio".to_owned(),
        },
        SynthesisTask::Path(task) => {
            format!(
                "four-bars of which a point passes {} points",
                task.points.len()
            )
        }
        SynthesisTask::Dwell(task) => {
            let what = match task.output {
                DwellOutput::Lever => "levers at a rod",
                DwellOutput::Slider => "sliders at a rod",
                DwellOutput::Slot => "slotted levers",
            };
            format!("{what} that rest while the drive goes on")
        }
        SynthesisTask::Cognates(task) => match task.parallel {
            true => {
                "six-bars in which a body goes along a coupler curve without turning".to_owned()
            }
            false => "the other four-bars of a coupler curve".to_owned(),
        },
        SynthesisTask::Motion(task) => {
            let what = task.linkage.map_or("linkages", kinds);
            format!(
                "{what} that guide a body through {} poses",
                task.poses.len()
            )
        }
    };
    format!("{task}, {kept}")
}

/// What is to be told of a study before any linkage is moved; `check` and `run` say the same.
pub(crate) fn findings_of_synthesis(model: &Model, study: &SynthesizeStudy) -> Vec<Diagnostic> {
    match candidates(model, study) {
        Ok((found, told)) => {
            let sample = found.candidates.first();
            let more = sample.map_or_else(Vec::new, |sample| {
                Questions::new(model, study, sample)
                    .err()
                    .unwrap_or_default()
            });
            [told, more].concat()
        }
        Err(told) => told,
    }
}

/// All that do what is asked, and what is to be told of the request; errors where it cannot be answered.
fn candidates(
    model: &Model,
    study: &SynthesizeStudy,
) -> Result<(Found, Vec<Diagnostic>), Vec<Diagnostic>> {
    let place = study.span.clone();
    let found = match &study.task {
        SynthesisTask::Function(task) => function::candidates(model, task),
        SynthesisTask::Rates(task) => rates::candidates(model, task, place),
        SynthesisTask::DeadCentres(task) => dead_centres::candidates(model, task, place),
        SynthesisTask::Motion(task) => motion::candidates(model, task),
        SynthesisTask::Path(task) => path::candidates(model, task),
        SynthesisTask::Dwell(task) => dwell::candidates(model, task, &place),
        SynthesisTask::Cognates(task) => cognates::candidates(model, task, &place),
    };
    let mut found = found.map_err(|refused| vec![*refused])?;
    let none = found.candidates.is_empty() && found.rejected.is_empty();
    let mut told = std::mem::take(&mut found.warnings);
    if none && found.counted == 0 {
        told.push(none_does(&found, told.is_empty()));
    }
    Ok((found, told))
}

/// A study that asks for linkages.
pub(crate) fn synthesis(
    model: &Model,
    name: &str,
    study: &SynthesizeStudy,
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let (found, mut diagnostics) = candidates(model, study)?;
    let units = Units::of(model);
    let mut accepted: Vec<Judged> = Vec::new();
    let mut rejected = found.rejected;
    let questions = match found.candidates.first() {
        Some(sample) => Some(Questions::new(model, study, sample)?),
        None => None,
    };
    let all = found.candidates.len();
    for (done, candidate) in found.candidates.into_iter().enumerate() {
        let Some(questions) = &questions else {
            break;
        };
        match judge(candidate, questions, &units) {
            Ok(judged) => accepted.push(judged),
            Err(why) => rejected.push(*why),
        }
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, all))
            .is_break()
        {
            if accepted.is_empty() {
                return Err(vec![stopped(Stage::Rows)]);
            }
            break;
        }
    }
    accepted.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    let unused = rejected.len() + found.counted;
    let counts = found.counts.iter().copied();
    let scalars = counts.chain([
        ("linkages", accepted.len() + unused),
        ("accepted", accepted.len()),
    ]);
    let scalars = scalars.map(|(name, count)| Scalar {
        name: name.to_owned(),
        unit: Unit::one(),
        value: count as f64,
    });
    let scalars: Vec<Scalar> = scalars.collect();
    if accepted.is_empty() && unused > 0 {
        diagnostics.push(none_accepted(unused));
    }
    let left_out = accepted.len().saturating_sub(study.keep);
    accepted.truncate(study.keep);
    debug_assert!(!refuses(&diagnostics));
    let table = table(name, &accepted);
    let kept: Vec<&Linkage> = (accepted.iter())
        .filter_map(|judged| match &judged.candidate {
            Candidate::Linkage(it) => Some(&it.linkage),
            Candidate::Beside(_) => None,
        })
        .collect();
    let figures = motion::picture(model, &found.guided, &kept);
    let figures = figures.or(found.figure);
    let mut listings = Vec::new();
    if !accepted.is_empty() {
        listings.push(listed(&table));
    }
    if left_out > 0 {
        listings.push(Listing {
            title: format!(
                "accepted, but beyond the {} that are kept: {left_out}",
                study.keep
            ),
            head: Vec::new(),
            rows: Vec::new(),
        });
    }
    listings.extend(found.tried);
    if !rejected.is_empty() {
        let more = rejected.len().saturating_sub(LISTED);
        let rows = rejected.into_iter().take(LISTED);
        let rows = rows.map(|r| vec![r.what, r.why]);
        let rest = (more > 0).then(|| vec![format!("and {more} more"), String::new()]);
        let rows = rows.chain(rest);
        listings.push(Listing {
            title: "found, but not accepted".to_owned(),
            head: vec!["linkage".to_owned(), "why".to_owned()],
            rows: rows.collect(),
        });
    }
    let demanded_rows = table.rows();
    let digits = accepted.len().to_string().len().max(2);
    let designs = accepted.into_iter().enumerate().filter_map(|(i, judged)| {
        let number = format!("{:0digits$}", i + 1);
        let title = format!("{}: {name} {number}", model.title);
        let parameters = &questions.as_ref()?.parameters;
        let file = judged.candidate.file(&title, model, parameters);
        Some(FoundDesign {
            title: format!("{number}: {}", judged.what),
            name: number,
            file,
            model: Model {
                title,
                ..judged.model
            },
            motion: Some(Box::new(judged.motion)),
        })
    });
    Ok(StudyResult {
        name: name.to_owned(),
        table,
        scalars,
        figures: figures.into_iter().collect(),
        listings,
        beside: found.solutions.into_iter().collect(),
        contacts: Vec::new(),
        happenings: Vec::new(),
        frames: Vec::new(),
        shapes: Vec::new(),
        designs: designs.collect(),
        events: Vec::new(),
        along: 0,
        assemblies: (0, 0),
        diagnostics,
        demanded_rows,
        stopped_at: None,
    })
}

/// So many linkages that are not accepted are listed one by one.
const LISTED: usize = 60;

/// A row for each linkage: its number, its dimensions and what is asked of it.
fn table(name: &str, accepted: &[Judged]) -> Table {
    let mut number = Column::new("linkage", Unit::one());
    number.values = (1..=accepted.len()).map(|i| i as f64).collect();
    let mut columns = vec![number];
    // Linkages of several kinds have each their own dimensions: what one has not is left empty.
    let mut told: Vec<&judge::Value> = Vec::new();
    for value in accepted.iter().flat_map(|j| &j.values) {
        if told.iter().all(|known| known.name != value.name) {
            told.push(value);
        }
    }
    for value in told {
        let mut column = Column::new(&value.name, value.unit.clone());
        let own = |j: &Judged| {
            j.values
                .iter()
                .find(|v| v.name == value.name)
                .map(|v| v.value)
        };
        column.values = accepted
            .iter()
            .map(|j| own(j).unwrap_or(f64::NAN))
            .collect();
        columns.push(column);
    }
    Table {
        name: name.to_owned(),
        columns,
        places: 1,
        closure: accepted
            .iter()
            .map(|j| j.motion.table.worst_closure())
            .collect(),
        smallest_singular_value: (accepted.iter())
            .map(|j| j.motion.table.least_singular_value())
            .collect(),
        forces: None,
        balance: None,
        notes: vec![None; accepted.len()],
    }
}

/// A table as words.
fn listed(table: &Table) -> Listing {
    let row = |row: usize| {
        let values = table.columns.iter().map(|c| c.values.get(row));
        values
            .map(|v| v.map_or_else(String::new, |v| number_text(*v)))
            .collect()
    };
    Listing {
        title: "linkages, the best first".to_owned(),
        head: table.columns.iter().map(Column::head).collect(),
        rows: (0..table.rows()).map(row).collect(),
    }
}

fn none_does(found: &Found, is_sure: bool) -> Diagnostic {
    let message = match is_sure {
        true => "no linkage of this kind does what is asked",
        false => "no linkage is found that does what is asked",
    };
    Diagnostic::warning("no-linkage", message)
        .note(found.searched.clone())
        .help("change the data a little, or leave more of them open")
}

fn none_accepted(found: usize) -> Diagnostic {
    let message = match found {
        1 => "one linkage is found, and it is not accepted".to_owned(),
        _ => format!("{found} linkages are found, and none is accepted"),
    };
    Diagnostic::warning("none-accepted", message)
        .help("the reasons are listed; change the data, or ask for less under `accept`")
}
