//! Writing results so that each file appears whole or not at all, and a failed run leaves an earlier result as it was.
//!
//! All files of a run are first written beside their places under other names and forced to the disk; only when every
//! one is there are they renamed, one after the other, the last one being the report that points to the others.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Files that are about to appear.
pub struct Batch {
    waiting: Vec<(PathBuf, PathBuf)>,
    made: Option<PathBuf>,
}

impl Batch {
    /// Files that need no folder of their own.
    pub fn new() -> Self {
        Self {
            waiting: Vec::new(),
            made: None,
        }
    }

    /// Files in a folder, which is made if it is not there.
    ///
    /// # Errors
    ///
    /// Those of the file system.
    pub fn in_folder(folder: &Path) -> io::Result<Self> {
        let made = (!folder.exists()).then(|| folder.to_owned());
        fs::create_dir_all(folder)?;
        Ok(Self {
            waiting: Vec::new(),
            made,
        })
    }

    /// Writes a file under another name in its folder.
    ///
    /// # Errors
    ///
    /// Those of the file system.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if path.is_dir() {
            return Err(io::Error::other(format!("{} is a folder", path.display())));
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let hidden = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
        let mut file = File::create(&hidden)?;
        self.waiting.push((hidden, path.to_owned()));
        file.write_all(bytes)?;
        file.sync_all()
    }

    /// Lets all files appear. On an error the ones that have not appeared are taken back.
    ///
    /// # Errors
    ///
    /// Those of the file system.
    pub fn publish(mut self) -> io::Result<Vec<PathBuf>> {
        let mut published = Vec::new();
        while !self.waiting.is_empty() {
            let (hidden, path) = self.waiting.remove(0);
            if let Err(error) = fs::rename(&hidden, &path) {
                let _ = fs::remove_file(&hidden);
                return Err(error);
            }
            published.push(path);
        }
        self.made = None;
        if let Some(folder) = published.first().and_then(|p| p.parent()) {
            sync_folder(folder);
        }
        Ok(published)
    }
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
        for (hidden, _) in &self.waiting {
            let _ = fs::remove_file(hidden);
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
    fn a_folder_made_for_nothing_is_taken_back() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("results");
        let batch = Batch::in_folder(&out).unwrap();
        assert!(out.exists());
        drop(batch);
        assert!(!out.exists());
    }
}
