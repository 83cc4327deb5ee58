//! Finished parts of a sweep or of a search as files, so that nothing of long work is lost: `family.parts/0123456789abcdef-000007.part`.
//!
//! A part is written under a hidden name, forced to the disk and renamed. The first half of its name is a fingerprint of all that its
//! numbers depend on: the model and its tables, parameters set on the command line, the study and the program's version. So parts of
//! another model are never taken for one's own, and they are left alone. A part tells its number, and has a fingerprint of its own behind it.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use kempe_model::Diagnostic;
use kempe_study::Parts;

use super::folder::{folder_of, sync_folder};
use super::hidden;
use super::shard::Shard;
use super::stand::already_there;
use super::unwritten::cannot_write;
use crate::files::Loaded;
use crate::fingerprint::{NOTHING, continued, fnv1a64};
use crate::read::read_plain;

/// How a part begins.
const MAGIC: &str = "kempe-part 1";

/// Bytes of the fingerprint behind a part.
const CHECK: usize = 8;

/// The largest part that is read, bytes.
const MOST_BYTES: usize = 1 << 31;

/// The parts of one sweep, or of one search.
pub struct Kept {
    study: String,
    fingerprint: u64,
    /// How many parts there are; of a search at most.
    count: usize,
    /// Whether it is a search, of which nobody knows how many parts there will be: each goes on where the one before ends.
    search: bool,
    /// Where parts are written; none where they are only joined.
    folder: Option<PathBuf>,
    /// Where they are looked for besides.
    others: Vec<PathBuf>,
    shard: Option<Shard>,
    /// The only part there is: nothing is finished before it is.
    only: Option<Vec<u8>>,
    /// Parts of its own that could not be used.
    damaged: BTreeSet<PathBuf>,
}

/// A part that was read.
enum Found {
    Nothing,
    Damaged(PathBuf, String),
    Whole(Vec<u8>, Shard),
}

impl Kept {
    /// The parts of a study that are written to a folder for results, and are found there.
    pub fn in_folder(
        folder: &Path,
        loaded: &Loaded,
        study: &str,
        count: usize,
        shard: Option<Shard>,
    ) -> Self {
        Self {
            folder: Some(folder.join(folder_name(study))),
            shard,
            ..Self::joined(Vec::new(), loaded, study, count)
        }
    }

    /// What a search asked, of which there are so many parts at most, written to a folder for results and found there.
    pub fn of_search(folder: &Path, loaded: &Loaded, study: &str, most: usize) -> Self {
        Self {
            search: true,
            ..Self::in_folder(folder, loaded, study, most, None)
        }
    }

    /// The parts of a study that lie in several folders.
    pub fn joined(folders: Vec<PathBuf>, loaded: &Loaded, study: &str, count: usize) -> Self {
        Self {
            study: study.to_owned(),
            fingerprint: fingerprint(loaded, study),
            count,
            search: false,
            folder: None,
            others: folders,
            shard: None,
            only: None,
            damaged: BTreeSet::new(),
        }
    }

    /// The study.
    pub fn study(&self) -> &str {
        &self.study
    }

    /// How many parts there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether they are of a search.
    pub fn is_search(&self) -> bool {
        self.search
    }

    /// Where they are written.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Which parts are there, by their names alone.
    pub fn there(&self) -> Vec<usize> {
        let is_there = |part: &usize| {
            let mut places = self.places(*part);
            places.any(|path| fs::symlink_metadata(path).is_ok())
        };
        match self.search {
            true => (0..self.count).take_while(is_there).collect(),
            false => (0..self.count).filter(is_there).collect(),
        }
    }

    /// How many parts are there, in words: of how many, where that is known.
    pub fn there_of_all(&self) -> String {
        match (self.there().len(), self.search) {
            (1, true) => "1 part of the search".to_owned(),
            (there, true) => format!("{there} parts of the search"),
            (there, false) => format!("{there} of {} parts", self.count),
        }
    }

    /// How many parts are to be computed here.
    pub fn own(&self) -> Vec<usize> {
        (0..self.count)
            .filter(|part| self.computes(*part))
            .collect()
    }

    /// How many parts of other models, or of other versions of the program, lie beside these.
    pub fn strangers(&self) -> usize {
        let own = format!("{:016x}-", self.fingerprint);
        let folders = self.folder.iter().chain(&self.others);
        let entries = folders.filter_map(|folder| fs::read_dir(folder).ok());
        let names = entries.flatten().flatten();
        let names = names.filter_map(|entry| entry.file_name().into_string().ok());
        names
            .filter(|name| is_part(name) && !name.starts_with(&own))
            .count()
    }

    /// That all parts are there, to be joined.
    ///
    /// # Errors
    ///
    /// `part-missing`, `part-damaged`.
    pub fn all_there(&self, file: &str) -> Result<(), Box<Diagnostic>> {
        let mut shards = BTreeSet::new();
        let mut missing = Vec::new();
        for part in 0..self.count {
            match self.find(part) {
                Found::Whole(_, shard) => {
                    shards.insert(shard.of);
                }
                Found::Damaged(path, why) => return Err(damaged(&path, &why)),
                Found::Nothing => missing.push(part),
            }
        }
        if missing.is_empty() {
            return Ok(());
        }
        let message = format!(
            "{} of {} parts of `{}` are missing",
            missing.len(),
            self.count,
            self.study
        );
        let mut diagnostic = Diagnostic::error("part-missing", message);
        let mut help = format!(
            "compute them: kempe run {file} {} --out FOLDER --shard K/N, with the parameters that are set here",
            self.study
        );
        if let (Some(of), true) = (shards.first(), shards.len() == 1) {
            let lacking: BTreeSet<usize> = missing.iter().map(|part| part % of + 1).collect();
            let named: Vec<String> = lacking.iter().map(|own| format!("{own}/{of}")).collect();
            diagnostic =
                diagnostic.note(format!("they are those of the shards {}", named.join(", ")));
            help = help.replace("K/N", &named[0]);
        }
        let strangers = self.strangers();
        if strangers > 0 {
            diagnostic = diagnostic.note(format!(
                "{strangers} parts that are there were made of another model file, with other parameters set, or by another version of Kempe"
            ));
        }
        Err(Box::new(diagnostic.help(help)))
    }

    /// Removes the parts of this sweep, whose results are whole, and the folder where nothing else is in it.
    pub fn remove(&self) {
        let Some(folder) = &self.folder else {
            return;
        };
        for part in self.there() {
            let _ = fs::remove_file(folder.join(self.name(part)));
        }
        hidden::remove_leftovers(folder);
        let _ = fs::remove_dir(folder);
    }

    fn name(&self, part: usize) -> String {
        format!("{:016x}-{part:06}.part", self.fingerprint)
    }

    /// Where a part may lie.
    fn places(&self, part: usize) -> impl Iterator<Item = PathBuf> + '_ {
        let name = self.name(part);
        let folders = self.folder.iter().chain(&self.others);
        folders.map(move |folder| folder.join(&name))
    }

    fn head(&self, part: usize) -> String {
        format!("{MAGIC} {:016x} {part} of {}", self.fingerprint, self.count)
    }

    /// The first whole one of a part's files.
    fn find(&self, part: usize) -> Found {
        let mut found = Found::Nothing;
        for path in self.places(part) {
            if fs::symlink_metadata(&path).is_err() {
                continue;
            }
            let read = read_plain(&path, MOST_BYTES);
            match read.map_err(|unread| unread.reason()) {
                Ok(bytes) => match self.content(part, bytes) {
                    Some((bytes, shard)) => return Found::Whole(bytes, shard),
                    None => found = Found::Damaged(path, "it is not as it was written".to_owned()),
                },
                Err(why) => found = Found::Damaged(path, why),
            }
        }
        found
    }

    /// What a part's file holds, where it is whole.
    fn content(&self, part: usize, mut bytes: Vec<u8>) -> Option<(Vec<u8>, Shard)> {
        let length = bytes.len().checked_sub(CHECK)?;
        let check = u64::from_le_bytes(bytes.get(length..)?.try_into().ok()?);
        bytes.truncate(length);
        if fnv1a64(&bytes) != check {
            return None;
        }
        let end = bytes.iter().position(|byte| *byte == b'\n')?;
        let line = std::str::from_utf8(bytes.get(..end)?).ok()?;
        let (head, shard) = line.split_once(", shard ")?;
        let shard = Shard::parse(shard)
            .ok()
            .filter(|_| head == self.head(part))?;
        bytes.drain(..=end);
        Some((bytes, shard))
    }

    fn write(&self, folder: &Path, part: usize, bytes: &[u8]) -> Result<(), Box<Diagnostic>> {
        let path = folder.join(self.name(part));
        let failed = |error: io::Error| cannot_write(&path, &error);
        if !folder.is_dir() {
            fs::create_dir_all(folder).map_err(failed)?;
            sync_folder(&folder_of(folder));
        }
        match fs::symlink_metadata(&path) {
            Ok(metadata) if !metadata.is_file() || !begins_as_part(&path) => {
                return Err(already_there(&path));
            }
            _ => {}
        }
        let shard = self.shard.unwrap_or(Shard { own: 1, of: 1 });
        let head = format!("{}, shard {shard}\n", self.head(part));
        let check = continued(fnv1a64(head.as_bytes()), bytes);
        let (hidden, mut file) = hidden::create(folder).map_err(failed)?;
        let written = (file.write_all(head.as_bytes()))
            .and_then(|()| file.write_all(bytes))
            .and_then(|()| file.write_all(&check.to_le_bytes()))
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&hidden, &path));
        if written.is_err() {
            let _ = fs::remove_file(&hidden);
        }
        written.map_err(failed)?;
        sync_folder(folder);
        Ok(())
    }

    /// Parts of its own that could not be used, and were computed again.
    pub fn damaged(&self) -> impl Iterator<Item = &Path> {
        self.damaged.iter().map(PathBuf::as_path)
    }
}

impl Parts for Kept {
    fn kept(&mut self, part: usize) -> Result<Option<Vec<u8>>, Box<Diagnostic>> {
        if part == 0 && self.only.is_some() {
            return Ok(self.only.clone());
        }
        match (self.find(part), &self.folder) {
            (Found::Whole(bytes, _), _) => Ok(Some(bytes)),
            (Found::Damaged(path, _), Some(_)) => {
                self.damaged.insert(path);
                Ok(None)
            }
            (Found::Damaged(path, why), None) => Err(damaged(&path, &why)),
            (Found::Nothing, Some(_)) => Ok(None),
            (Found::Nothing, None) => {
                let message = format!("part {} of `{}` is gone", part + 1, self.study);
                Err(Box::new(Diagnostic::error("part-missing", message)))
            }
        }
    }

    fn keep(&mut self, part: usize, bytes: Vec<u8>) -> Result<(), Box<Diagnostic>> {
        match &self.folder {
            Some(folder) if self.count > 1 || self.shard.is_some() => {
                self.write(folder, part, &bytes)
            }
            _ => {
                self.only = Some(bytes);
                Ok(())
            }
        }
    }

    fn computes(&self, part: usize) -> bool {
        self.shard.is_none_or(|shard| shard.has(part))
    }
}

/// The folder of a study's parts. No study has a dot in its name.
pub fn folder_name(study: &str) -> String {
    format!("{study}.parts")
}

/// The fingerprint of all that the numbers of a study depend on.
fn fingerprint(loaded: &Loaded, study: &str) -> u64 {
    let more = |hash: u64, text: &str| {
        // With the length, so that no two lists of texts read alike.
        let hash = continued(hash, &(text.len() as u64).to_le_bytes());
        continued(hash, text.as_bytes())
    };
    let own = [env!("CARGO_PKG_VERSION"), study, &loaded.text];
    let set = loaded.set.iter().flat_map(|(name, value)| [name, value]);
    let all = own.into_iter().chain(set.map(String::as_str));
    let hash = all.fold(NOTHING, more);
    continued(hash, &loaded.tables.to_le_bytes())
}

/// Whether a file's name is that of a part.
fn is_part(name: &str) -> bool {
    let parts = name.strip_suffix(".part").and_then(|n| n.split_once('-'));
    parts.is_some_and(|(hash, number)| {
        hash.len() == 16
            && hash.bytes().all(|b| b.is_ascii_hexdigit())
            && number.bytes().all(|b| b.is_ascii_digit())
    })
}

/// Whether a file begins as parts do, however it goes on: nothing else is replaced. What is empty is what a disk lost.
fn begins_as_part(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| {
        io::Read::read_to_end(&mut io::Read::take(file, MAGIC.len() as u64), &mut start)
    });
    read.is_ok() && MAGIC.as_bytes().starts_with(&start)
}

fn damaged(path: &Path, why: &str) -> Box<Diagnostic> {
    let message = format!("{} cannot be used: {why}", path.display());
    Box::new(
        Diagnostic::error("part-damaged", message)
            .help("remove it, and compute its shard again: finished parts are kept"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parts_are_known() {
        assert!(is_part("0123456789abcdef-000007.part"));
        for other in [".kempe-0123456789abcdef.part", "notes.part", "a-1.part"] {
            assert!(!is_part(other), "{other}");
        }
    }
}
