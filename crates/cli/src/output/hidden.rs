//! Files under names that nobody else uses: what is not finished yet, and what is about to be replaced.

use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::path::{Path, PathBuf};

/// How names begin that are Kempe's own.
const OWN: &str = ".kempe-";

/// A file that is being written.
pub const UNFINISHED: &str = "part";

/// The second name of a file that is about to be replaced.
pub const REPLACED: &str = "old";

/// How often another name is tried where one is taken.
const TRIES: usize = 16;

/// A name that is new with all likelihood: `.kempe-0123456789abcdef.part`.
pub fn name(ending: &str) -> String {
    // The only random numbers of the standard library.
    let random = RandomState::new().hash_one(std::process::id());
    format!("{OWN}{random:016x}.{ending}")
}

/// Makes a file that was not there; a link in its place is never followed.
pub fn create(folder: &Path) -> io::Result<(PathBuf, File)> {
    let mut tried = 0;
    loop {
        let path = folder.join(name(UNFINISHED));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((path, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tried < TRIES => {
                tried += 1;
            }
            Err(error) => return Err(error),
        }
    }
}

/// Removes what runs left that were killed. Whoever calls this holds the folder's lock, so that nobody is writing.
pub fn remove_leftovers(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        if entry.file_name().to_str().is_some_and(is_hidden) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a name is one of [`name`].
pub fn is_hidden(name: &str) -> bool {
    let inner = name.strip_prefix(OWN).and_then(|n| n.split_once('.'));
    inner.is_some_and(|(random, ending)| {
        random.len() == 16
            && random.bytes().all(|b| b.is_ascii_hexdigit())
            && [UNFINISHED, REPLACED].contains(&ending)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_and_no_other_is() {
        assert!(is_hidden(&name(UNFINISHED)) && is_hidden(&name(REPLACED)));
        assert_ne!(name(UNFINISHED), name(UNFINISHED));
        for other in [
            "turn.csv",
            ".kempe-files.json",
            ".kempe-lock",
            ".kempe-0123456789abcdef",
            ".kempe-0123456789abcdef.csv",
            ".kempe-0123456789abcdeg.part",
            ".kempe-0123456789abcde.part",
        ] {
            assert!(!is_hidden(other), "{other}");
        }
    }
}
