//! Writing results so that each file appears whole or not at all, and a failed run leaves an earlier result as it was.
//!
//! All files of a run are first written beside their places under other names and forced to the disk; only when every
//! one is there are they renamed, one after the other, the last one being the report that points to the others. What
//! stood there before keeps a second name until all are renamed, and is put back where one of them fails.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Unfinished files of this age are litter: whoever wrote them was ended. A batch takes seconds.
const LITTER_AGE: Duration = Duration::from_secs(3600);

/// Endings of the files of a run.
const ENDINGS: &[&str] = &["csv", "parquet", "svg", "html"];

/// Files that are about to appear.
pub struct Batch {
    waiting: Vec<Waiting>,
    made: Option<PathBuf>,
}

/// A file that is about to appear.
struct Waiting {
    /// Where it is.
    hidden: PathBuf,
    /// Where it will be.
    path: PathBuf,
    /// The second name of what it replaces.
    kept: Option<PathBuf>,
}

/// Why files did not appear.
#[derive(Debug)]
pub struct Unpublished {
    /// What went wrong.
    pub error: io::Error,
    /// Earlier files that could not be put back, under the names by which they are kept.
    pub kept: Vec<PathBuf>,
}

impl From<Unpublished> for io::Error {
    fn from(unpublished: Unpublished) -> Self {
        unpublished.error
    }
}

impl Batch {
    /// Files that need no folder of their own.
    pub fn new() -> Self {
        Self {
            waiting: Vec::new(),
            made: None,
        }
    }

    /// Files in a folder, which is made if it is not there. What earlier runs left unfinished in it is removed.
    ///
    /// # Errors
    ///
    /// Those of the file system.
    pub fn in_folder(folder: &Path) -> io::Result<Self> {
        let made = (!folder.exists()).then(|| folder.to_owned());
        fs::create_dir_all(folder)?;
        if made.is_none() {
            remove_litter(folder, LITTER_AGE);
        }
        Ok(Self {
            waiting: Vec::new(),
            made,
        })
    }

    /// Writes a file under another name in its folder.
    ///
    /// # Errors
    ///
    /// Those of the file system, and a path that was added already.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if path.is_dir() {
            return Err(io::Error::other(format!("{} is a folder", path.display())));
        }
        if self.waiting.iter().any(|w| w.path == path) {
            return Err(io::Error::other("it would be written twice"));
        }
        let hidden = beside(path, "part");
        let mut file = File::create(&hidden)?;
        self.waiting.push(Waiting {
            hidden,
            path: path.to_owned(),
            kept: None,
        });
        file.write_all(bytes)?;
        file.sync_all()
    }

    /// Lets all files appear. On an error none of them does, and what was there before is put back.
    ///
    /// # Errors
    ///
    /// Those of the file system.
    pub fn publish(mut self) -> Result<Vec<PathBuf>, Unpublished> {
        for index in 0..self.waiting.len() {
            if let Err(error) = self.waiting[index].appear() {
                let appeared = self.waiting[..index].iter_mut().rev();
                let kept = appeared.filter_map(Waiting::take_back).collect();
                return Err(Unpublished { error, kept });
            }
        }
        self.made = None;
        let waiting = std::mem::take(&mut self.waiting);
        for kept in waiting.iter().filter_map(|w| w.kept.as_deref()) {
            let _ = fs::remove_file(kept);
        }
        let published: Vec<PathBuf> = waiting.into_iter().map(|w| w.path).collect();
        if let Some(folder) = published.first().and_then(|p| p.parent()) {
            sync_folder(folder);
        }
        Ok(published)
    }
}

impl Waiting {
    /// Takes its place; what is there keeps a second name. On an error everything is as before.
    fn appear(&mut self) -> io::Result<()> {
        if self.path.is_dir() {
            return Err(io::Error::other(format!(
                "{} is a folder",
                self.path.display()
            )));
        }
        if fs::symlink_metadata(&self.path).is_ok() {
            let kept = beside(&self.path, "old");
            let _ = fs::remove_file(&kept);
            // With a second name the file is never missing; where there are none, it makes room.
            if fs::hard_link(&self.path, &kept).is_err() {
                fs::rename(&self.path, &kept)?;
            }
            self.kept = Some(kept);
        }
        fs::rename(&self.hidden, &self.path).inspect_err(|_| {
            if let Some(kept) = self.kept.take() {
                // Two names of one file are left alone by a rename.
                let _ = fs::rename(&kept, &self.path);
                let _ = fs::remove_file(&kept);
            }
        })
    }

    /// Puts back what was there before; where that fails, tells where it is kept.
    fn take_back(&mut self) -> Option<PathBuf> {
        match self.kept.take() {
            Some(kept) => fs::rename(&kept, &self.path).is_err().then_some(kept),
            None => {
                let _ = fs::remove_file(&self.path);
                None
            }
        }
    }
}

/// A name of this process beside a file's own.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.{ending}", std::process::id()))
}

/// Removes the unfinished files that a run left which was ended.
fn remove_litter(folder: &Path, age: Duration) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let unfinished = name.to_str().is_some_and(is_unfinished);
        let changed = entry.metadata().and_then(|m| m.modified()).ok();
        let old = changed
            .and_then(|t| t.elapsed().ok())
            .is_some_and(|t| t >= age);
        if unfinished && old {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file's name is that of an unfinished file of a run: `.turn.csv.4711.part`.
fn is_unfinished(name: &str) -> bool {
    let inner = name.strip_prefix('.').and_then(|n| n.strip_suffix(".part"));
    let Some((file, process)) = inner.and_then(|n| n.rsplit_once('.')) else {
        return false;
    };
    let ending = Path::new(file).extension().and_then(|e| e.to_str());
    !process.is_empty()
        && process.chars().all(|c| c.is_ascii_digit())
        && ending.is_some_and(|e| ENDINGS.contains(&e))
}

/// Makes renames in a folder last; not every system can.
fn sync_folder(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

impl Drop for Batch {
    /// What did not appear is taken back.
    fn drop(&mut self) {
        for waiting in &self.waiting {
            let _ = fs::remove_file(&waiting.hidden);
        }
        if let Some(folder) = &self.made {
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_together() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
        fs::write(&a, "old").unwrap();
        let mut batch = Batch::in_folder(folder.path()).unwrap();
        batch.add(&a, b"new").unwrap();
        batch.add(&b, b"new").unwrap();
        assert_eq!(fs::read(&a).unwrap(), b"old");
        assert!(!b.exists());
        batch.publish().unwrap();
        assert_eq!(
            (fs::read(&a).unwrap(), fs::read(&b).unwrap()),
            (b"new".to_vec(), b"new".to_vec())
        );
        assert_eq!(names(folder.path()), ["a.csv", "b.csv"]);
    }

    #[test]
    fn a_failure_leaves_the_earlier_result_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let a = folder.path().join("a.csv");
        fs::write(&a, "old").unwrap();
        fs::create_dir(folder.path().join("b.csv")).unwrap();
        let mut batch = Batch::in_folder(folder.path()).unwrap();
        batch.add(&a, b"new").unwrap();
        assert!(batch.add(&folder.path().join("b.csv"), b"new").is_err());
        drop(batch);
        assert_eq!(fs::read(&a).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.csv", "b.csv"]);
    }

    #[test]
    fn a_failure_halfway_puts_everything_back() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a.csv"), "old").unwrap();
        let mut batch = Batch::in_folder(folder.path()).unwrap();
        for name in ["a.csv", "b.csv", "c.csv"] {
            batch.add(&at(name), b"new").unwrap();
        }
        // The third cannot take its place any more.
        fs::create_dir(at("c.csv")).unwrap();
        assert!(batch.publish().unwrap_err().kept.is_empty());
        assert_eq!(fs::read(at("a.csv")).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.csv", "c.csv"]);
    }

    #[test]
    fn a_file_is_not_written_twice() {
        let folder = tempfile::tempdir().unwrap();
        let a = folder.path().join("a.csv");
        let mut batch = Batch::in_folder(folder.path()).unwrap();
        batch.add(&a, b"one").unwrap();
        assert!(batch.add(&a, b"two").is_err());
        drop(batch);
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn litter_of_a_run_that_was_ended_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let mine = [
            ".turn.csv.4711.part",
            "turn.csv",
            ".turn.csv.4711",
            ".x.bin.7.part",
        ];
        for name in mine {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_litter(folder.path(), LITTER_AGE);
        assert_eq!(
            names(folder.path()).len(),
            4,
            "another run may be writing it"
        );
        remove_litter(folder.path(), Duration::ZERO);
        assert_eq!(
            names(folder.path()),
            [".turn.csv.4711", ".x.bin.7.part", "turn.csv"]
        );
    }

    #[test]
    fn a_folder_made_for_nothing_is_taken_back() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("results");
        let batch = Batch::in_folder(&out).unwrap();
        assert!(out.exists());
        drop(batch);
        assert!(!out.exists());
    }
}
