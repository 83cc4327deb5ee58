//! Reading files that a user names: plain files, and no more of them than is taken.

use std::fs::{self, File, FileType};
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};

use kempe_model::{MAX_FILE_BYTES, MAX_TABLE_BYTES};

use crate::fingerprint;

/// All tables of a model together have at most so many bytes.
const MAX_ALL_BYTES: usize = 512 << 20;

/// Why a file is not read.
#[derive(Debug)]
pub enum Unread {
    /// The operating system says so.
    Failed(io::Error),
    /// It is none that has an end: what it is.
    NotPlain(&'static str),
    /// It has more bytes than this.
    TooLarge(usize),
}

impl Unread {
    /// The reason in words.
    pub fn reason(&self) -> String {
        match self {
            Self::Failed(error) => plain(error),
            Self::NotPlain(what) => format!("it is {what}, not a plain file"),
            Self::TooLarge(limit) => format!("it has more than {} MiB", limit >> 20),
        }
    }
}

/// The bytes of a plain file that has no more than `limit`. Nothing else is opened: a pipe may never say anything, and a device
/// may never end.
pub fn read_plain(path: &Path, limit: usize) -> Result<Vec<u8>, Unread> {
    let plain_file = |metadata: &fs::Metadata| match metadata.is_file() {
        true => Ok(()),
        false => Err(Unread::NotPlain(kind(metadata.file_type()))),
    };
    plain_file(&fs::metadata(path).map_err(Unread::Failed)?)?;
    let file = File::open(path).map_err(Unread::Failed)?;
    let metadata = file.metadata().map_err(Unread::Failed)?;
    plain_file(&metadata)?;
    if metadata.len() > limit as u64 {
        return Err(Unread::TooLarge(limit));
    }
    // Some systems' files tell no length.
    let mut bytes = Vec::new();
    (file.take(limit as u64 + 1).read_to_end(&mut bytes)).map_err(Unread::Failed)?;
    if bytes.len() > limit {
        return Err(Unread::TooLarge(limit));
    }
    Ok(bytes)
}

#[cfg(unix)]
fn kind(of: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match of {
        _ if of.is_dir() => "a folder",
        _ if of.is_fifo() => "a pipe",
        _ if of.is_socket() => "a socket",
        _ if of.is_char_device() || of.is_block_device() => "a device",
        _ => "something else",
    }
}

#[cfg(not(unix))]
fn kind(of: FileType) -> &'static str {
    match of.is_dir() {
        true => "a folder",
        false => "something else",
    }
}

/// Bytes as text, or where they are none.
pub fn text(bytes: Vec<u8>) -> Result<String, String> {
    let line = |at: usize| {
        let before = bytes.get(..at).unwrap_or(&[]);
        before.iter().filter(|b| **b == b'\n').count() + 1
    };
    // Text of two bytes a letter has them in plenty.
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        return Err(format!(
            "line {} has a byte of zero, which no text has: save it as UTF-8",
            line(at)
        ));
    }
    if let Err(error) = std::str::from_utf8(&bytes) {
        return Err(format!(
            "line {} is not UTF-8 text: save it as UTF-8",
            line(error.valid_up_to())
        ));
    }
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// Reads a file that a person named: a case of `verify`, or its model.
pub fn read_named(path: &Path) -> Result<String, String> {
    let bytes = read_plain(path, MAX_FILE_BYTES).map_err(|unread| unread.reason())?;
    text(bytes)
}

/// Reads the tables that a model names.
pub struct Tables {
    folder: PathBuf,
    outside: bool,
    left: usize,
    /// The files that were read.
    pub read: Vec<PathBuf>,
    /// A fingerprint of what was read, in its order.
    pub hash: u64,
}

impl Tables {
    /// Tables beside and below a folder; with `outside` anywhere.
    pub fn of(folder: &Path, outside: bool) -> Self {
        Self {
            folder: folder.to_owned(),
            outside,
            left: MAX_ALL_BYTES,
            read: Vec::new(),
            hash: fingerprint::NOTHING,
        }
    }

    /// The text of a table.
    ///
    /// # Errors
    ///
    /// The reason in words.
    pub fn read(&mut self, name: &str) -> Result<String, String> {
        let path = self.folder.join(name);
        if !self.outside && !is_below(&self.folder, name) {
            return Err(
                "it lies outside the folder of the file that names it: copy it there, or allow it \
                 with --allow-outside"
                    .to_owned(),
            );
        }
        let bytes = read_plain(&path, MAX_TABLE_BYTES).map_err(|unread| match unread {
            Unread::TooLarge(_) => {
                format!("{}: leave out rows between others", unread.reason())
            }
            unread => unread.reason(),
        })?;
        self.left = self.left.checked_sub(bytes.len()).ok_or_else(|| {
            let limit = MAX_ALL_BYTES >> 20;
            format!("all tables together have more than {limit} MiB: leave out rows between others")
        })?;
        if !self.read.contains(&path) {
            self.read.push(path);
            self.hash = fingerprint::continued(self.hash, &(bytes.len() as u64).to_le_bytes());
            self.hash = fingerprint::continued(self.hash, &bytes);
        }
        text(bytes)
    }
}

/// Whether a name leads to a file in the folder or below it, links included. A file that is not there is in no other place.
fn is_below(folder: &Path, name: &str) -> bool {
    let inward = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !Path::new(name).components().all(inward) {
        return false;
    }
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    match (folder.canonicalize(), folder.join(name).canonicalize()) {
        (Ok(folder), Ok(file)) => file.starts_with(folder),
        _ => true,
    }
}

/// An error of the operating system without its number.
pub fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error")
        .next()
        .unwrap_or(&text)
        .to_lowercase()
}
