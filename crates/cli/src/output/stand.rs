//! What stands where a file is to appear, and whether it may go.

use std::fs;
use std::path::{Path, PathBuf};

use kempe_model::Diagnostic;

use super::folder::folder_of;
use super::record::{Owner, Record};
use super::unwritten::{cannot_write, unreadable_list};

/// A file that is to appear, by its folder and its name.
pub struct Stands {
    folder: PathBuf,
    name: String,
}

impl Stands {
    /// The place of a file.
    ///
    /// # Errors
    ///
    /// `cannot-write`, where the path names no file.
    pub fn at(path: &Path) -> Result<Self, Box<Diagnostic>> {
        match path.file_name().and_then(|n| n.to_str()) {
            Some(name) => Ok(Self {
                folder: folder_of(path),
                name: name.to_owned(),
            }),
            None => {
                let message = format!("{} is no name of a file", path.display());
                let diagnostic = Diagnostic::error("cannot-write", message);
                Err(Box::new(diagnostic.help("give a name in plain letters")))
            }
        }
    }

    /// The file's name in its folder.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Whether a single file may be written, so that a refusal comes before the work.
///
/// # Errors
///
/// `own-input`, `file-exists`, `cannot-write`.
pub fn may_replace(place: &Stands, inputs: &[PathBuf]) -> Result<(), Box<Diagnostic>> {
    let folder = &place.folder;
    match fs::metadata(folder) {
        Ok(metadata) if metadata.is_dir() => {}
        _ => {
            let message = format!("there is no folder {}", folder.display());
            let diagnostic = Diagnostic::error("cannot-write", message);
            return Err(Box::new(diagnostic.help("make it, or give another name")));
        }
    }
    let record = Record::read(folder).map_err(|error| unreadable_list(folder, &error))?;
    may_write(folder, &place.name, inputs, &record)
}

/// Whether a file may be written: nothing stands there, or what Kempe wrote and nobody changed, and what is read least of all.
pub(super) fn may_write(
    folder: &Path,
    name: &str,
    inputs: &[PathBuf],
    record: &Record,
) -> Result<(), Box<Diagnostic>> {
    let path = place_in(folder, name);
    if let Some(input) = inputs.iter().find(|input| is_same(&path, input)) {
        let message = format!(
            "{} would be replaced, but the model is read from it",
            path.display()
        );
        let mut diagnostic = Diagnostic::error("own-input", message);
        if **input != *path {
            diagnostic = diagnostic.note(format!("it is the same file as {}", input.display()));
        }
        return Err(Box::new(diagnostic.help("write to another folder")));
    }
    let metadata = match fs::symlink_metadata(&path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(cannot_write(&path, &error)),
    };
    let refuse = |code: &'static str, what: &str| {
        let message = format!("{} {what}", path.display());
        let diagnostic = Diagnostic::error(code, message).note(
            "Kempe replaces nothing but files that it wrote itself, and that are as it wrote them",
        );
        Err(Box::new(
            diagnostic.help("move it away, or write to another place"),
        ))
    };
    if metadata.is_dir() {
        return refuse("cannot-write", "is a folder");
    }
    if metadata.is_symlink() {
        return refuse("file-exists", "is a link");
    }
    if !metadata.is_file() {
        return refuse("file-exists", "is not a plain file");
    }
    match record.owner(folder, name) {
        Owner::Kempe => Ok(()),
        Owner::Changed => refuse("file-exists", "was changed since Kempe wrote it"),
        Owner::Somebody => refuse(
            "file-exists",
            "is already there, and Kempe did not write it",
        ),
    }
}

/// A file of a folder, as a person would write it.
pub(super) fn place_in(folder: &Path, name: &str) -> PathBuf {
    match folder == Path::new(".") {
        true => PathBuf::from(name),
        false => folder.join(name),
    }
}

/// A file that must be new is there.
pub(super) fn already_there(path: &Path) -> Box<Diagnostic> {
    let message = format!("{} is already there", path.display());
    Box::new(Diagnostic::error("file-exists", message).help("give another name"))
}

/// Whether two paths are one file, by other ways, links or names that differ in capitals alone.
fn is_same(path: &Path, other: &Path) -> bool {
    same_file(path, other) || same_name(path, other)
}

#[cfg(unix)]
fn same_file(path: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    match (fs::metadata(path), fs::metadata(other)) {
        (Ok(one), Ok(two)) => (one.dev(), one.ino()) == (two.dev(), two.ino()),
        _ => false,
    }
}

#[cfg(not(unix))]
fn same_file(path: &Path, other: &Path) -> bool {
    match (path.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(two)) => one == two,
        _ => false,
    }
}

/// The same folder, and names that a disk may not know apart.
fn same_name(path: &Path, other: &Path) -> bool {
    let folders = (
        folder_of(path).canonicalize(),
        folder_of(other).canonicalize(),
    );
    let lower = |path: &Path| path.file_name().map(|n| n.to_string_lossy().to_lowercase());
    matches!(folders, (Ok(one), Ok(two)) if one == two) && lower(path) == lower(other)
}
