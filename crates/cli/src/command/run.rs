//! `kempe run`: the studies of a model, as tables, figures and a report.

mod against;
mod choose;
mod resume;
mod shard;
mod summary;
mod write;

use std::path::{Path, PathBuf};

use kempe_batch::Threads;
use kempe_model::{Diagnostic, Model, Study};
use kempe_study::{StudyOutcome, encode, of_other_design, room_for, study_bytes};

use crate::arguments::Run;
use crate::clock;
use crate::exit::Exit;
use crate::files::{Loaded, load};
use crate::interrupt;
use crate::names;
use crate::output::{Kept, Output};
use crate::progress::Bar;
use crate::say::{Speaker, complain, print_json, put};
use against::{Against, studies_of_other};
use choose::chosen;
pub use choose::nothing_to_run;
use resume::{computed_again, goes_on, kept, resuming};
pub use shard::no_parts;
use summary::{against_json, compared, summary, summary_json};
use write::{REPORT, Results, known_names, known_names_against};

/// The studies of a run together hold at most so many bytes.
const MAX_RUN_BYTES: u64 = 4 << 30;

/// Why parts are not kept, or not found.
const UNKEPT: [&str; 4] = [
    "cannot-write",
    "file-exists",
    "part-damaged",
    "part-missing",
];

/// Runs `kempe run`.
pub fn run(arguments: &Run) -> Exit {
    run_from(arguments, None)
}

/// Runs `kempe run`, or joins the parts of a study that are in these folders.
pub fn run_from(arguments: &Run, joined: Option<&[PathBuf]>) -> Exit {
    let mut speaker =
        Speaker::new(arguments.json, arguments.quiet).strictly(arguments.model.strict);
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => return speaker.failed(exit),
    };
    if let Some(shard) = arguments.shard {
        return shard::run(arguments, shard, &loaded, &threads(), &mut speaker);
    }
    let other = match against::other(arguments, &loaded, &mut speaker) {
        Ok(other) => other,
        Err(exit) => return speaker.failed(exit),
    };
    let prepared = match prepared(arguments, &loaded, other.as_ref(), &mut speaker) {
        Ok(prepared) => prepared,
        Err(diagnostics) => {
            speaker.tell(&diagnostics);
            return speaker.failed(Exit::Usage);
        }
    };
    let (studies, output) = (prepared.studies, prepared.output);
    let quiet = arguments.quiet || arguments.json;
    let mut kept = match output.is_some() {
        true => match kept(arguments, joined, &loaded, &studies) {
            Ok(kept) => kept,
            Err(diagnostics) => {
                speaker.tell(&diagnostics);
                return speaker.failed(Exit::Usage);
            }
        },
        false => Vec::new(),
    };
    if let Err(refused) = goes_on(arguments, &kept) {
        speaker.tell(&[*refused]);
        return speaker.failed(Exit::Usage);
    }
    interrupt::listen();
    if !quiet {
        kept.iter().for_each(|kept| complain(&resuming(kept)));
    }
    let outcomes = run_all(&loaded, &studies, ("", &mut kept), quiet, &mut speaker);
    if !quiet {
        kept.iter().for_each(|kept| complain(&computed_again(kept)));
    }
    let other_outcomes = match &other {
        Some(other) if !interrupt::stopped() => {
            speaker.turn_to_other(&other.name, &other.text, &other.set);
            let outcomes = run_all(
                other,
                &prepared.of_other,
                (" (against)", &mut Vec::new()),
                quiet,
                &mut speaker,
            );
            speaker.turn_back(&loaded.name, &loaded.text);
            outcomes
        }
        _ => Vec::new(),
    };
    let against = other
        .as_ref()
        .map(|other| Against::of(&loaded, &outcomes, other, &other_outcomes));
    let has_rows = |name: &str| {
        let mut of_it = outcomes.iter().filter(|o| o.study.name == name);
        of_it.any(|o| o.result.is_ok())
    };
    let (finished, missing): (Vec<&str>, Vec<&str>) =
        (studies.iter().map(|s| s.name.as_str())).partition(|name| has_rows(name));
    let proof = (arguments.certify && !interrupt::stopped())
        .then(|| kempe_study::prove(&loaded.checked.model, &mut Bar::new("proof", quiet)).ok())
        .flatten();
    let mut stopped = interrupt::stopped();
    let mut files = Vec::new();
    if let (Some(output), false) = (output, finished.is_empty()) {
        let folder = arguments.out.as_deref().unwrap_or(Path::new(""));
        if arguments.model.strict && speaker.exit() != Exit::Ok {
            speaker.tell(&[warned(folder)]);
        } else if !missing.is_empty() && !stopped {
            speaker.tell(&[nothing_written(&loaded, folder, &finished, &missing)]);
        } else {
            // Stopped, it is not begun anew: the report says so.
            let check = kempe_study::check_with_progress(
                &loaded.checked.model,
                &mut Bar::new("check", quiet),
            );
            stopped = interrupt::stopped();
            let results = Results {
                loaded: &loaded,
                outcomes: &outcomes,
                check,
                against: against.as_ref(),
                proof: proof.as_ref(),
                stopped: stopped.then_some(missing),
                date: arguments.date.then(clock::now),
            };
            match results.write(output, &mut kept, &mut Bar::new("report", quiet)) {
                Ok(written) => {
                    files = written.files;
                    stopped = written.stopped;
                    if !stopped {
                        kept.iter().for_each(Kept::remove);
                    }
                }
                Err(diagnostic) => {
                    speaker.tell(&[*diagnostic]);
                    return speaker.failed(Exit::Usage);
                }
            }
            if stopped {
                speaker.insist(&partial_result(folder, &files, &kept));
            }
        }
    }
    if arguments.json {
        let with_tables = arguments.out.is_none();
        let mut value = summary_json(&loaded, &outcomes, &files, stopped, with_tables, &speaker);
        if let Some(proof) = &proof {
            value["proof"] = serde_json::to_value(proof).unwrap_or_default();
        }
        if let Some(against) = &against {
            value["against"] = against_json(against, with_tables);
            value["comparison"] = encode::comparison_json(&against.comparison);
        }
        print_json(&value);
    } else if !arguments.quiet {
        put(&summary(
            &outcomes,
            arguments.out.as_deref(),
            &files,
            stopped,
        ));
        if let Some(proof) = &proof {
            put(&proof.to_text());
        }
        if let Some(against) = &against {
            put(&compared(&against.comparison));
        }
    }
    // A part that cannot be kept is no fault of the mechanism.
    let errors = outcomes.iter().filter_map(|o| o.result.as_ref().err());
    let unkept = errors.flatten().any(|d| UNKEPT.contains(&d.code));
    match proof {
        _ if stopped => Exit::Interrupted,
        _ if unkept => Exit::Usage,
        Some(proof) if !proof.is_whole() => speaker.exit().max(Exit::Finding),
        _ => speaker.exit(),
    }
}

/// What a run begins with.
struct Prepared<'l> {
    /// The studies that are asked for.
    studies: Vec<&'l Study>,
    /// Those of the other design.
    of_other: Vec<&'l Study>,
    /// The place for the results.
    output: Option<Output>,
}

/// The studies that are asked for and the place for their results, or why it is not begun.
fn prepared<'l>(
    arguments: &Run,
    loaded: &'l Loaded,
    other: Option<&'l Loaded>,
    speaker: &mut Speaker,
) -> Result<Prepared<'l>, Vec<Diagnostic>> {
    let model = &loaded.checked.model;
    let alone = |diagnostic: Box<Diagnostic>| vec![*diagnostic];
    let studies = chosen(model, &arguments.studies, &loaded.name).map_err(alone)?;
    let of_other = other.map_or_else(Vec::new, |other| studies_of_other(&studies, other, speaker));
    let rooms = |loaded: &Loaded, studies: &[&Study]| -> Vec<Diagnostic> {
        let rooms = studies.iter().map(|s| room_for(&loaded.checked.model, s));
        rooms.filter_map(Result::err).flatten().collect()
    };
    let mut too_large = rooms(loaded, &studies);
    let mut held: Vec<(&Model, &Study)> = studies.iter().map(|s| (model, *s)).collect();
    if let Some(other) = other {
        let found = rooms(other, &of_other);
        too_large.extend(found.iter().map(|d| of_other_design(d, &other.origin())));
        held.extend(of_other.iter().map(|s| (&other.checked.model, *s)));
    }
    if !too_large.is_empty() {
        return Err(too_large);
    }
    have_room(&held).map_err(alone)?;
    let output = folder(
        arguments,
        loaded,
        &studies,
        other.zip(Some(of_other.as_slice())),
    );
    Ok(Prepared {
        output: output.map_err(alone)?,
        studies,
        of_other,
    })
}

/// The folder for the results, after a look at what stands there: a refusal comes before the work.
fn folder(
    arguments: &Run,
    loaded: &Loaded,
    studies: &[&Study],
    other: Option<(&Loaded, &[&Study])>,
) -> Result<Option<Output>, Box<Diagnostic>> {
    let Some(folder) = &arguments.out else {
        return Ok(None);
    };
    let mut inputs = loaded.inputs.clone();
    inputs.extend(other.iter().flat_map(|(other, _)| other.inputs.clone()));
    let output = Output::folder(folder, &inputs)?;
    let mut names = known_names(&loaded.checked.model, studies);
    if let Some((_, studies)) = other {
        names.extend(known_names_against(&loaded.checked.model, studies));
    }
    let partial: Vec<String> = names.iter().map(|n| names::of_run(n, true)).collect();
    // What the other pictures are called, the run alone tells; those that somebody touched are looked at before.
    let touched = output.changed().filter(|name| {
        let mut of_study = studies.iter();
        of_study.any(|s| name.starts_with(&s.name) && name.ends_with(".svg"))
    });
    let known = names.iter().chain(&partial).map(String::as_str);
    output.may_write(known.chain(touched))?;
    Ok(Some(output))
}

/// All studies of a run are held until the last one is done.
fn have_room(studies: &[(&Model, &Study)]) -> Result<(), Box<Diagnostic>> {
    let held = studies
        .iter()
        .map(|(model, study)| study_bytes(model, study).bytes());
    let all: f64 = held.sum();
    if all <= MAX_RUN_BYTES as f64 {
        return Ok(());
    }
    let gib = f64::from(1 << 30);
    let message = format!(
        "{} studies take {:.1} GiB together",
        studies.len(),
        all / gib
    );
    let diagnostic = Diagnostic::error("too-large", message)
        .note(format!("a run holds at most {} GiB", MAX_RUN_BYTES >> 30));
    Err(Box::new(diagnostic.help(
        "run them one after the other by their names, or ask for fewer rows",
    )))
}

/// Runs one study after the other, until it is told to stop. `whose` stands behind their names while they run.
/// Those of which parts are kept go on from there.
fn run_all<'m>(
    loaded: &'m Loaded,
    studies: &[&'m Study],
    (whose, kept): (&str, &mut Vec<Kept>),
    quiet: bool,
    speaker: &mut Speaker,
) -> Vec<StudyOutcome<'m>> {
    let mut outcomes = Vec::new();
    let threads = threads();
    let model = &loaded.checked.model;
    for study in studies {
        let mut bar = Bar::new(&format!("{}{whose}", study.name), quiet);
        let parts = kept.iter_mut().find(|kept| kept.study() == study.name);
        let result = match parts {
            Some(parts) => kempe_study::run_in_parts(model, study, (&threads, parts), &mut bar),
            None => kempe_study::run_with(model, study, &threads, &mut bar),
        };
        drop(bar);
        match &result {
            Ok(result) => speaker.tell(&result.diagnostics),
            Err(errors) => speaker.tell(errors),
        }
        let unkept = |d: &Diagnostic| UNKEPT.contains(&d.code);
        if let Err(errors) = &result
            && !interrupt::stopped()
            && !errors.iter().any(unkept)
        {
            // A search that came to its end without an answer has nothing to go on with.
            let searched = kept.iter().filter(|kept| kept.study() == study.name);
            searched
                .filter(|kept| kept.is_search())
                .for_each(Kept::remove);
        }
        outcomes.push(StudyOutcome { study, result });
        if interrupt::stopped() {
            break;
        }
    }
    outcomes
}

/// As many threads as the machine has.
fn threads() -> Threads {
    Threads(std::thread::available_parallelism().map_or(1, usize::from))
}

/// With `--strict` a warning keeps results from being written.
pub fn warned(target: &Path) -> Diagnostic {
    let message = format!(
        "nothing was written to {}: with --strict every warning is an error",
        target.display()
    );
    Diagnostic::error("not-written", message)
        .note("earlier results are as they were")
        .help("mend what is warned of, or leave out --strict")
}

/// What was finished of a run that was stopped stands beside the results of an earlier one.
fn partial_result(folder: &Path, files: &[PathBuf], kept: &[Kept]) -> Diagnostic {
    let report: PathBuf = folder.join(names::of_run(REPORT, true));
    let message = match files.contains(&report) {
        true => format!(
            "the run was stopped: what is finished is a partial result, {}",
            report.display()
        ),
        false => format!(
            "the run was stopped while its report was drawn: what is finished is a partial result in {}",
            folder.display()
        ),
    };
    let diagnostic = Diagnostic::warning("partial-result", message)
        .note("its files have .partial in their names and say so inside; those of earlier runs are as they were");
    let parts = kept.iter().filter(|kept| !kept.there().is_empty());
    let parts = parts.filter_map(|kept| {
        let folder = kept.folder()?.display();
        Some(format!("{} in {folder}", kept.there_of_all()))
    });
    let parts: Vec<String> = parts.collect();
    match parts.is_empty() {
        true => diagnostic.help("run it again for the whole"),
        false => diagnostic
            .note(format!("finished parts are kept: {}", parts.join(", ")))
            .help("run it again: it goes on from there"),
    }
}

/// A folder holds the results of one run: where a study could not run, nothing of the others is written either.
fn nothing_written(
    loaded: &Loaded,
    folder: &Path,
    finished: &[&str],
    missing: &[&str],
) -> Diagnostic {
    let names: Vec<String> = missing.iter().map(|name| format!("`{name}`")).collect();
    let message = format!(
        "nothing was written to {}: {} could not run",
        folder.display(),
        names.join(", ")
    );
    Diagnostic::warning("not-written", message)
        .note("earlier results are as they were")
        .help(format!(
            "run the others by themselves: kempe run {} {} --out {}",
            loaded.name,
            finished.join(" "),
            folder.display()
        ))
}
