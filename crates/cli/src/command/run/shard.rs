//! `kempe run --shard`: of sweeps, the parts that are one machine's.

use std::path::Path;

use kempe_batch::Threads;
use kempe_model::{Diagnostic, Study, StudyKind};
use kempe_study::{compute_parts, part_count};
use serde_json::{Value, json};

use super::choose::chosen;
use super::resume::{computed_again, goes_on, resuming};
use crate::arguments::Run;
use crate::exit::Exit;
use crate::files::Loaded;
use crate::interrupt;
use crate::output::{Kept, Shard};
use crate::progress::Bar;
use crate::say::{Speaker, complain, print_json, put};

/// Computes the parts of sweeps that are a shard's, and leaves them in the folder.
pub fn run(
    arguments: &Run,
    shard: Shard,
    loaded: &Loaded,
    threads: &Threads,
    speaker: &mut Speaker,
) -> Exit {
    let folder = arguments.out.as_deref().unwrap_or(Path::new(""));
    let model = &loaded.checked.model;
    let studies = chosen(model, &arguments.studies, &loaded.name).map_err(|d| *d);
    let studies = studies.and_then(|mut studies| {
        if arguments.studies.is_empty() && studies.iter().any(|study| is_sweep(study)) {
            studies.retain(|study| is_sweep(study));
        }
        match no_parts(&studies) {
            None => Ok(studies),
            Some(refused) => Err(refused),
        }
    });
    let studies = match studies {
        Ok(studies) => studies,
        Err(refused) => {
            speaker.tell(&[refused]);
            return speaker.failed(Exit::Usage);
        }
    };
    interrupt::listen();
    let quiet = arguments.quiet || arguments.json;
    let mut all = Vec::new();
    for study in &studies {
        match part_count(model, study) {
            Ok(count) => {
                let count = count.unwrap_or(0);
                all.push(Kept::in_folder(
                    folder,
                    loaded,
                    &study.name,
                    count,
                    Some(shard),
                ));
            }
            Err(refused) => {
                speaker.tell(&refused);
                return speaker.failed(speaker.exit());
            }
        }
    }
    if let Err(refused) = goes_on(arguments, &all) {
        speaker.tell(&[*refused]);
        return speaker.failed(Exit::Usage);
    }
    let mut said = Vec::new();
    for (study, mut kept) in studies.into_iter().zip(all) {
        if !quiet {
            complain(&resuming(&kept));
        }
        let mut bar = Bar::new(&study.name, quiet);
        let done = compute_parts(model, study, (threads, &mut kept), &mut bar);
        drop(bar);
        if !quiet {
            complain(&computed_again(&kept));
        }
        match done {
            Ok((_, told)) => speaker.tell(&told),
            Err(refused) => {
                let unwritten = |d: &Diagnostic| ["cannot-write", "file-exists"].contains(&d.code);
                let exit = refused.iter().any(unwritten).then_some(Exit::Usage);
                speaker.tell(&refused);
                return speaker.failed(exit.unwrap_or_else(|| speaker.exit()));
            }
        }
        match arguments.json {
            true => said.push(told_json(&kept)),
            false if quiet => {}
            false => put(&told(&kept, shard, loaded)),
        }
        if interrupt::stopped() {
            break;
        }
    }
    if arguments.json {
        print_json(&json!({
            "file": loaded.name,
            "title": model.title,
            "shard": shard.to_string(),
            "partial": interrupt::stopped(),
            "studies": said,
            "diagnostics": speaker.diagnostics(),
        }));
    }
    match interrupt::stopped() {
        true => Exit::Interrupted,
        false => speaker.exit(),
    }
}

/// How many parts of the shard are there, and how many of all.
fn counts(kept: &Kept) -> [usize; 3] {
    let (there, own) = (kept.there(), kept.own());
    let finished = own.iter().filter(|part| there.contains(part)).count();
    [finished, own.len(), there.len()]
}

fn told(kept: &Kept, shard: Shard, loaded: &Loaded) -> String {
    let [finished, own, there] = counts(kept);
    let (study, count) = (kept.study(), kept.count());
    let folder = kept.folder().unwrap_or(Path::new("")).display();
    let next = match (finished == own, there == count) {
        (false, _) => "the same command goes on from there".to_owned(),
        (true, false) => {
            format!(
                "when all shards are done: kempe merge {} {study} FOLDERS --out DIR",
                loaded.name
            )
        }
        (true, true) => format!(
            "all {count} parts are there: kempe merge {} {study} {folder} --out DIR",
            loaded.name
        ),
    };
    format!("{study}: {finished} of {own} parts of shard {shard} are in {folder}\n  {next}\n")
}

fn told_json(kept: &Kept) -> Value {
    let [finished, own, there] = counts(kept);
    json!({
        "study": kept.study(),
        "parts": kept.count(),
        "parts_of_shard": own,
        "parts_finished": finished,
        "parts_there": there,
        "folder": kept.folder().map(|folder| folder.display().to_string()),
    })
}

fn is_sweep(study: &Study) -> bool {
    matches!(study.kind, StudyKind::Sweep(_))
}

/// Why there are no shards of a study, where one of these is no sweep.
pub fn no_parts(studies: &[&Study]) -> Option<Diagnostic> {
    let other = studies.iter().find(|study| !is_sweep(study))?;
    let message = format!("study `{}` is no sweep: it has no parts", other.name);
    Some(
        Diagnostic::error("no-parts", message)
            .at(other.span.clone(), "this study")
            .help("name studies of kind = \"sweep\"; the others are run as a whole"),
    )
}
