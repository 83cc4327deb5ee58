//! What is said where something cannot be written.

use std::io;
use std::path::Path;

use kempe_model::Diagnostic;

use super::lock::Taken;
use super::record::RECORD;
use crate::read::plain;

/// Why a file cannot be written.
pub(super) fn cannot_write(path: &Path, error: &io::Error) -> Box<Diagnostic> {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    let message = format!("{} cannot be written: {}", path.display(), plain(error));
    let diagnostic =
        Diagnostic::error("cannot-write", message).note("earlier results are as they were");
    Box::new(match error.kind() {
        StorageFull | QuotaExceeded | FileTooLarge => {
            diagnostic.help("make room on the disk, or write to another place")
        }
        _ => diagnostic.help("write to another place, or to one where you may write"),
    })
}

/// Why a folder is not to be had.
pub(super) fn not_had(folder: &Path, taken: Taken) -> Box<Diagnostic> {
    match taken {
        Taken::By(who) => {
            let message = format!("another run writes to {}: {who}", folder.display());
            Box::new(
                Diagnostic::error("folder-busy", message)
                    .help("wait until it is done, or write to another folder"),
            )
        }
        Taken::Failed(error) => cannot_write(folder, &error),
    }
}

/// Why nobody knows what Kempe wrote to a folder.
pub(super) fn unreadable_list(folder: &Path, error: &io::Error) -> Box<Diagnostic> {
    let path = folder.join(RECORD);
    let message = format!("{} cannot be read: {}", path.display(), plain(error));
    Box::new(
        Diagnostic::error("cannot-write", message)
            .note("it lists the files of the folder that Kempe wrote and may replace")
            .help("move it away, or write to another folder"),
    )
}
