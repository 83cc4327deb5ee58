//! `kempe merge`: parts of a sweep that several machines computed, as one result.

use std::path::{Path, PathBuf};

use kempe_model::Diagnostic;

use crate::arguments::{Merge, ModelFile, Run};
use crate::command::run::{no_parts, run_from};
use crate::exit::Exit;
use crate::files::load;
use crate::output::folder_name;
use crate::say::Speaker;

/// Runs `kempe merge`.
pub fn merge(arguments: &Merge) -> Exit {
    // What is wrong with the model is told once, when it is run.
    let mut silent = Speaker::new(true, true);
    if let Ok(loaded) = load(&arguments.model, &mut silent) {
        let known = loaded.checked.model.studies.iter();
        let mut known = known.filter(|study| study.name == arguments.study);
        let refused = match known.next() {
            Some(study) => no_parts(&[study]),
            None => None,
        };
        let folders = arguments.parts.iter().find(|folder| !folder.is_dir());
        let refused = refused.or_else(|| folders.map(|folder| no_folder(folder)));
        if let Some(refused) = refused {
            let mut speaker = Speaker::new(arguments.json, arguments.quiet);
            speaker.name_file(&loaded.name, &loaded.text);
            speaker.tell(&[refused]);
            return speaker.failed(Exit::Usage);
        }
    }
    let run = Run {
        model: ModelFile {
            file: arguments.model.file.clone(),
            set: arguments.model.set.clone(),
            strict: arguments.model.strict,
            allow_outside: arguments.model.allow_outside,
        },
        studies: vec![arguments.study.clone()],
        out: Some(arguments.out.clone()),
        against: None,
        against_set: Vec::new(),
        resume: false,
        certify: false,
        shard: None,
        date: arguments.date,
        json: arguments.json,
        quiet: arguments.quiet,
    };
    let folders = arguments.parts.iter();
    let folders: Vec<PathBuf> = folders
        .map(|folder| parts_in(folder, &arguments.study))
        .collect();
    run_from(&run, Some(&folders))
}

/// The folder of a study's parts: in the one that a shard was written to, or itself.
fn parts_in(folder: &Path, study: &str) -> PathBuf {
    let inner = folder.join(folder_name(study));
    match inner.is_dir() {
        true => inner,
        false => folder.to_owned(),
    }
}

fn no_folder(folder: &Path) -> Diagnostic {
    let message = format!("there is no folder {}", folder.display());
    Diagnostic::error("no-file", message).help(
        "name the folders to which the shards were written: kempe run … --out FOLDER --shard 1/4",
    )
}
