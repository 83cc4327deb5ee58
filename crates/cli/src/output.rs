//! Writing results so that nothing is lost: each file appears whole or not at all, a failed run leaves an earlier result as it
//! was, and nothing is replaced but what Kempe itself wrote.
//!
//! A folder has a lock (`lock.rs`) and a list of Kempe's own files in it (`record.rs`). All files of a run are first written
//! under hidden names (`hidden.rs`) and forced to the disk; only when every one is there does the list say what is about to
//! appear, and they are renamed, one after the other. What stood there before keeps a second name until all are renamed; it is
//! put back where one of them fails, and by the next run where the process is killed in between.

mod folder;
mod hidden;
mod lock;
mod parts;
mod record;
mod shard;
mod stand;
mod unwritten;

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use kempe_model::Diagnostic;

use crate::read::plain;
use folder::{folder_of, remove_folders, sync_folder};
use lock::Lock;
use record::{Appearing, Mark, RECORD, Record};
use unwritten::{cannot_write, not_had, unreadable_list};

pub use parts::{Kept, folder_name};
pub use shard::Shard;
pub use stand::{Stands, may_replace};

/// How long a run waits for a folder where another one writes: no longer than that one would take for a single file.
const RUN_WAITS: Duration = Duration::from_secs(1);

/// How long a single file waits.
const FILE_WAITS: Duration = Duration::from_secs(10);

/// A folder that a run writes to, and no other run as long as it does.
pub struct Output {
    folder: PathBuf,
    inputs: Vec<PathBuf>,
    record: Record,
    waiting: Vec<Waiting>,
    /// Folders in it from which old files go.
    renewed: Vec<String>,
    /// Files in it that go.
    outdated: Vec<String>,
    /// Folders that were made for this run, the outermost first.
    made: Vec<PathBuf>,
    lock: Option<Lock>,
}

/// A file that is about to appear.
struct Waiting {
    name: String,
    mark: Mark,
    /// Where it is.
    hidden: PathBuf,
    /// Where it will be.
    path: PathBuf,
    /// The second name of what it replaces.
    kept: Option<PathBuf>,
}

impl Output {
    /// A folder for the results of a run, made if it is not there. What killed runs left in it is removed.
    ///
    /// # Errors
    ///
    /// `folder-busy` where another run writes to it, `cannot-write`.
    pub fn folder(folder: &Path, inputs: &[PathBuf]) -> Result<Self, Box<Diagnostic>> {
        if folder.as_os_str().is_empty() {
            let diagnostic =
                Diagnostic::error("cannot-write", "the folder for the results has no name");
            return Err(Box::new(diagnostic.help("name one: --out results")));
        }
        if fs::metadata(folder).is_ok_and(|m| !m.is_dir()) {
            let message = format!(
                "{} is no folder: nothing can be put into it",
                folder.display()
            );
            let diagnostic = Diagnostic::error("cannot-write", message);
            return Err(Box::new(
                diagnostic.help("give another name: --out results"),
            ));
        }
        if fs::metadata(folder).is_err() && fs::symlink_metadata(folder).is_ok() {
            let message = format!("{} is a link that leads nowhere", folder.display());
            let diagnostic = Diagnostic::error("cannot-write", message);
            return Err(Box::new(
                diagnostic.help("remove it, or give another name: --out results"),
            ));
        }
        let missing: Vec<&Path> = (folder.ancestors())
            .take_while(|a| !a.as_os_str().is_empty() && fs::symlink_metadata(a).is_err())
            .collect();
        let mut made: Vec<PathBuf> = missing.into_iter().map(Path::to_owned).collect();
        made.reverse();
        if let Err(error) = fs::create_dir_all(folder) {
            remove_folders(&made);
            return Err(cannot_write(folder, &error));
        }
        Self::open(folder, inputs, made, RUN_WAITS)
    }

    /// The folder of a single file, which is there.
    ///
    /// # Errors
    ///
    /// As of [`folder`](Self::folder).
    pub fn beside(path: &Path, inputs: &[PathBuf]) -> Result<Self, Box<Diagnostic>> {
        Self::open(&folder_of(path), inputs, Vec::new(), FILE_WAITS)
    }

    fn open(
        folder: &Path,
        inputs: &[PathBuf],
        made: Vec<PathBuf>,
        patience: Duration,
    ) -> Result<Self, Box<Diagnostic>> {
        let mut output = Self {
            folder: folder.to_owned(),
            inputs: inputs.to_vec(),
            record: Record::default(),
            waiting: Vec::new(),
            renewed: Vec::new(),
            outdated: Vec::new(),
            made,
            lock: None,
        };
        output.lock = Some(Lock::take(folder, patience).map_err(|taken| not_had(folder, taken))?);
        output.record = Record::read(folder).map_err(|error| unreadable_list(folder, &error))?;
        if !output.record.appearing.is_empty() {
            let taken_back = output.record.take_back(folder);
            taken_back.map_err(|error| cannot_write(folder, &error))?;
        }
        hidden::remove_leftovers(folder);
        Ok(output)
    }

    /// Whether files of these names may be written, so that a refusal comes before the work.
    ///
    /// # Errors
    ///
    /// `own-input`, `file-exists`, `cannot-write`.
    pub fn may_write<'n>(
        &self,
        names: impl IntoIterator<Item = &'n str>,
    ) -> Result<(), Box<Diagnostic>> {
        let mut names = names.into_iter();
        names.try_for_each(|name| stand::may_write(&self.folder, name, &self.inputs, &self.record))
    }

    /// The files of the folder that Kempe wrote and somebody changed.
    pub fn changed(&self) -> impl Iterator<Item = &str> {
        self.record.changed(&self.folder)
    }

    /// Writes a file under a hidden name.
    ///
    /// # Errors
    ///
    /// As of [`may_write`](Self::may_write); `cannot-write` where two files of different bytes would have one name.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Box<Diagnostic>> {
        self.add_with(name, |file| file.write_all(bytes).map(|()| true))
    }

    /// As [`add`](Self::add); the bytes come one after the other. Where there are none to be written, there is no file.
    ///
    /// # Errors
    ///
    /// As of [`add`](Self::add).
    pub fn add_with(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut File) -> io::Result<bool>,
    ) -> Result<(), Box<Diagnostic>> {
        self.may_write([name])?;
        let path = stand::place_in(&self.folder, name);
        let lower = name.to_lowercase();
        // Many disks do not know capitals apart.
        let twin = (self.waiting.iter()).find(|w| w.name.to_lowercase() == lower);
        let twin = twin.map(|twin| (twin.name.clone(), twin.mark.clone()));
        let is_twin = |twin: &str| {
            let message = format!("two results would be written to {}", path.display());
            let diagnostic = Diagnostic::error("cannot-write", message)
                .note(format!("the other one is called {twin}"));
            Box::new(diagnostic.help("give the studies or their measures other names"))
        };
        if let Some((other, _)) = twin.as_ref().filter(|(other, _)| other != name) {
            return Err(is_twin(other));
        }
        let failed = |error: io::Error| cannot_write(&path, &error);
        if let Some((inner, _)) = name.split_once('/') {
            self.make_inner(inner).map_err(failed)?;
        }
        let (hidden, mut file) = hidden::create(&self.folder).map_err(failed)?;
        let written = write(&mut file)
            .and_then(|any| file.sync_all().map(|()| any))
            .and_then(|any| match any {
                true => Mark::of_file(&hidden).map(Some),
                false => Ok(None),
            });
        match written {
            Ok(Some(mark)) => match twin {
                None => self.waiting.push(Waiting {
                    name: name.to_owned(),
                    mark,
                    hidden,
                    path,
                    kept: None,
                }),
                // One table may go with many designs; what holds something else is another result.
                Some((other, known)) => {
                    let _ = fs::remove_file(&hidden);
                    if known != mark {
                        return Err(is_twin(&other));
                    }
                }
            },
            other => {
                let _ = fs::remove_file(&hidden);
                other.map_err(failed)?;
            }
        }
        Ok(())
    }

    /// Makes a folder in this one, which goes again where nothing comes into it.
    fn make_inner(&mut self, inner: &str) -> io::Result<()> {
        let path = self.folder.join(inner);
        match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_dir() => return Ok(()),
            Ok(_) => return Err(io::Error::other("it is no folder")),
            Err(_) => {}
        }
        fs::create_dir(&path)?;
        self.made.push(path);
        Ok(())
    }

    /// Of a folder in this one nothing of earlier runs is to stay but what this run writes anew: what Kempe wrote goes once all has
    /// appeared, unless somebody changed it.
    pub fn renew(&mut self, inner: &str) {
        self.renewed.push(inner.to_owned());
    }

    /// A file of an earlier run that is not to stay beside what this one writes: it goes once all has appeared, unless somebody
    /// changed it.
    pub fn outdate(&mut self, name: String) {
        self.outdated.push(name);
    }

    /// Removes what earlier runs wrote into folders that are renewed, and files that are outdated.
    fn remove_old(&mut self) {
        let mut old = Vec::new();
        for inner in &self.renewed {
            let own = self.record.files_in(inner).filter(|name| {
                self.waiting.iter().all(|w| w.name != *name)
                    && self.record.owner(&self.folder, name) == record::Owner::Kempe
            });
            old.extend(own.map(|name| self.folder.join(name)));
        }
        let outdated = self
            .outdated
            .iter()
            .filter(|name| self.record.owner(&self.folder, name.as_str()) == record::Owner::Kempe);
        old.extend(outdated.map(|name| self.folder.join(name)));
        for path in old {
            let _ = fs::remove_file(&path);
            // A folder in this one that is empty now.
            if let Some(inner) = path.parent().filter(|inner| *inner != self.folder) {
                let _ = fs::remove_dir(inner);
            }
        }
    }

    /// Lets all files appear. On an error none of them does, and what was there before is put back.
    ///
    /// # Errors
    ///
    /// As of [`add`](Self::add).
    pub fn publish(mut self) -> Result<Vec<PathBuf>, Box<Diagnostic>> {
        // Somebody may have put a file there in the meantime.
        self.may_write(self.waiting.iter().map(|w| w.name.as_str()))?;
        for waiting in &mut self.waiting {
            let there = fs::symlink_metadata(&waiting.path).is_ok();
            waiting.kept = there.then(|| self.folder.join(hidden::name(hidden::REPLACED)));
            let kept = waiting.kept.as_deref().and_then(Path::file_name);
            let entry = Appearing {
                mark: waiting.mark.clone(),
                kept: kept.map(|k| k.to_string_lossy().into_owned()),
            };
            self.record.appearing.insert(waiting.name.clone(), entry);
        }
        let record = self.record.write(&self.folder);
        record.map_err(|error| cannot_write(&self.folder.join(RECORD), &error))?;
        for index in 0..self.waiting.len() {
            if let Err(error) = self.waiting[index].appear() {
                let path = self.waiting[index].path.clone();
                return Err(self.taken_back(index, &path, &error));
            }
        }
        self.remove_old();
        self.record.appeared();
        if let Err(error) = self.record.write(&self.folder) {
            let all = self.waiting.len();
            return Err(self.taken_back(all, &self.folder.join(RECORD), &error));
        }
        self.made.clear();
        let waiting = std::mem::take(&mut self.waiting);
        for kept in waiting.iter().filter_map(|w| w.kept.as_deref()) {
            let _ = fs::remove_file(kept);
        }
        sync_folder(&self.folder);
        Ok(waiting.into_iter().map(|w| w.path).collect())
    }

    /// Puts back what the first files replaced, after one at `path` could not appear.
    fn taken_back(&mut self, first: usize, path: &Path, error: &io::Error) -> Box<Diagnostic> {
        let appeared = self.waiting[..first].iter_mut().rev();
        let kept: Vec<String> = appeared
            .filter_map(Waiting::take_back)
            .map(|kept| kept.display().to_string())
            .collect();
        if kept.is_empty() {
            if let Ok(mut before) = Record::read(&self.folder) {
                before.appearing.clear();
                let _ = before.write(&self.folder);
            }
            return cannot_write(path, error);
        }
        let message = format!("{} cannot be written: {}", path.display(), plain(error));
        let note = "earlier results could not all be put back; they are kept as";
        Box::new(
            Diagnostic::error("cannot-write", message).note(format!("{note} {}", kept.join(", "))),
        )
    }
}

impl Waiting {
    /// Takes its place; what is there keeps a second name. On an error everything is as before.
    fn appear(&mut self) -> io::Result<()> {
        let Some(kept) = &self.kept else {
            return appear_new(&self.hidden, &self.path);
        };
        // With a second name the file is never missing; where there are none, it makes room.
        if fs::hard_link(&self.path, kept).is_err() {
            fs::rename(&self.path, kept)?;
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

impl Drop for Output {
    /// What did not appear is taken back.
    fn drop(&mut self) {
        for waiting in &self.waiting {
            let _ = fs::remove_file(&waiting.hidden);
        }
        self.lock = None;
        remove_folders(&self.made);
    }
}

/// Writes a file that must be new.
///
/// # Errors
///
/// `file-exists`, `cannot-write`.
pub fn create(path: &Path, bytes: &[u8]) -> Result<(), Box<Diagnostic>> {
    let folder = folder_of(path);
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::AlreadyExists => stand::already_there(path),
        _ => cannot_write(path, &error),
    };
    let (hidden, mut file) = hidden::create(&folder).map_err(failed)?;
    let written = file
        .write_all(bytes)
        .and_then(|()| file.sync_all())
        .and_then(|()| appear_new(&hidden, path));
    let _ = fs::remove_file(&hidden);
    written.map_err(failed)
}

/// Gives a file its name, which nobody has: a second name is never given to two files, where a rename would replace the first.
fn appear_new(hidden: &Path, path: &Path) -> io::Result<()> {
    match fs::hard_link(hidden, path) {
        Ok(()) => fs::remove_file(hidden),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(error),
        // A file system without second names.
        Err(_) if fs::symlink_metadata(path).is_err() => fs::rename(hidden, path),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests;
