//! What earlier runs left of long studies, to go on from.

use std::path::{Path, PathBuf};

use kempe_model::{Diagnostic, Study};
use kempe_study::{most_parts, part_count};

use crate::arguments::Run;
use crate::files::Loaded;
use crate::output::Kept;

/// Where the parts of the studies are that have parts.
pub(super) fn kept(
    arguments: &Run,
    joined: Option<&[PathBuf]>,
    loaded: &Loaded,
    studies: &[&Study],
) -> Result<Vec<Kept>, Vec<Diagnostic>> {
    let folder = arguments.out.as_deref().unwrap_or(Path::new(""));
    let mut all = Vec::new();
    for study in studies {
        if let (Some(most), None) = (most_parts(study), joined) {
            all.push(Kept::of_search(folder, loaded, &study.name, most));
            continue;
        }
        // What is wrong with it is told when it is run.
        let Ok(Some(count)) = part_count(&loaded.checked.model, study) else {
            continue;
        };
        all.push(match joined {
            None => Kept::in_folder(folder, loaded, &study.name, count, None),
            Some(folders) => {
                let kept = Kept::joined(folders.to_vec(), loaded, &study.name, count);
                kept.all_there(&loaded.name).map_err(|d| vec![*d])?;
                kept
            }
        });
    }
    Ok(all)
}

/// Whether there is something to go on from where that is asked for.
pub(super) fn goes_on(arguments: &Run, kept: &[Kept]) -> Result<(), Box<Diagnostic>> {
    if !arguments.resume || kept.iter().any(|it| !it.there().is_empty()) {
        return Ok(());
    }
    let folder = arguments.out.as_deref().unwrap_or(Path::new("")).display();
    let error = Diagnostic::error("part-missing", format!("nothing to resume in {folder}"));
    let error = match kept.iter().map(Kept::strangers).sum::<usize>() {
        0 if kept.is_empty() => error.note("only sweeps and studies that optimise leave parts"),
        0 => error.note("it has no parts of these studies: a run that ends by itself leaves none"),
        others => error.note(format!(
            "it has {others} parts of another file, of other values of parameters, or of another version"
        )),
    };
    Err(Box::new(error.help("begin anew without --resume")))
}

/// What is said of the parts that are found where a sweep or a search begins.
pub(super) fn resuming(kept: &Kept) -> String {
    let Some(folder) = kept.folder() else {
        return String::new();
    };
    let mut said = String::new();
    let there = kept.there().len();
    if there > 0 {
        said += &format!(
            "{}: resuming, {} {} there\n",
            kept.study(),
            kept.there_of_all(),
            if there == 1 && kept.is_search() {
                "is"
            } else {
                "are"
            }
        );
    }
    let strangers = kept.strangers();
    if strangers > 0 {
        said += &format!(
            "{}: {} holds {strangers} parts of another model, of other parameters or of another version: they are left as they are\n",
            kept.study(),
            folder.display()
        );
    }
    said
}

/// What is said of parts that could not be used.
pub(super) fn computed_again(kept: &Kept) -> String {
    let said = kept.damaged().map(|path| {
        format!(
            "{} was not as it was written: that part was computed again\n",
            path.display()
        )
    });
    said.collect()
}
