//! One run at a time writes to a folder.
//!
//! The lock is the operating system's, on a file in the folder: it goes with its process, however that ends, so that a file left
//! by a run that was killed holds nobody up. The file's text says who holds it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::clock;

/// The file that is locked.
pub const LOCK: &str = ".kempe-lock";

/// How long to wait before the lock is tried again.
const PAUSE: Duration = Duration::from_millis(20);

/// As much as is read of who holds a lock, bytes.
const MOST_SAID: u64 = 200;

/// A folder that nobody else writes to.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    _file: File,
}

/// Why a folder is not to be had.
#[derive(Debug)]
pub enum Taken {
    /// Another process has it: which, and since when.
    By(String),
    /// The lock cannot be made.
    Failed(io::Error),
}

impl From<io::Error> for Taken {
    fn from(error: io::Error) -> Self {
        Self::Failed(error)
    }
}

impl Lock {
    /// Takes a folder's lock, and waits for it as long as `patience`.
    pub fn take(folder: &Path, patience: Duration) -> Result<Self, Taken> {
        let path = folder.join(LOCK);
        let begun = Instant::now();
        loop {
            let Some(mut file) = open(&path)? else {
                continue;
            };
            match file.try_lock() {
                // Whoever had it may have removed the file in between.
                Ok(()) if !is_at(&file, &path) => continue,
                Ok(()) => {}
                Err(TryLockError::WouldBlock) if begun.elapsed() < patience => {
                    std::thread::sleep(PAUSE);
                    continue;
                }
                Err(TryLockError::WouldBlock) => return Err(Taken::By(holder(&mut file))),
                // A file system without locks: the run goes on as if it were alone.
                Err(TryLockError::Error(error)) if without_locks(&error) => {}
                Err(TryLockError::Error(error)) => return Err(Taken::Failed(error)),
            }
            let lock = Self {
                path,
                _file: file.try_clone()?,
            };
            file.set_len(0)?;
            write!(
                file,
                "process {}, since {}",
                std::process::id(),
                clock::now()
            )?;
            return Ok(lock);
        }
    }
}

impl Drop for Lock {
    /// The file goes while it is still locked.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// The file of the lock, made if it is not there; `None` where it went away in between. No link is followed.
fn open(path: &Path) -> io::Result<Option<File>> {
    let mut options = OpenOptions::new();
    options.read(true).write(true);
    match options.clone().create_new(true).open(path) {
        Ok(file) => return Ok(Some(file)),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(error),
    }
    match fs::symlink_metadata(path) {
        Ok(metadata) if !metadata.is_file() => {
            let message = format!("{} is not a plain file", path.display());
            return Err(io::Error::other(message));
        }
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    }
    match options.open(path) {
        Ok(file) => Ok(Some(file)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Whether an open file is still the one of that name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(there)) => (open.dev(), open.ino()) == (there.dev(), there.ino()),
        _ => false,
    }
}

/// Files that are open cannot be removed elsewhere.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// What Linux answers where a network's file system has no locks.
#[cfg(target_os = "linux")]
const NO_LOCKS: Option<i32> = Some(37);
#[cfg(not(target_os = "linux"))]
const NO_LOCKS: Option<i32> = None;

fn without_locks(error: &io::Error) -> bool {
    let number = error.raw_os_error();
    error.kind() == io::ErrorKind::Unsupported || (number.is_some() && number == NO_LOCKS)
}

/// Who holds a lock, from its file.
fn holder(file: &mut File) -> String {
    let mut said = Vec::new();
    // Elsewhere than on Unix a locked file may not be read.
    let _ = file.take(MOST_SAID).read_to_end(&mut said);
    let said = String::from_utf8_lossy(&said);
    let line: String = said.chars().filter(|c| !c.is_control()).collect();
    if line.is_empty() {
        return "a process that has not said its name yet".to_owned();
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_one_hears_who_holds_it_and_gets_it_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let first = Lock::take(folder.path(), Duration::ZERO).unwrap();
        match Lock::take(folder.path(), Duration::ZERO) {
            Err(Taken::By(who)) => {
                let own = format!("process {}, since 20", std::process::id());
                assert!(who.starts_with(&own), "{who}");
            }
            other => panic!("{other:?}"),
        }
        drop(first);
        assert!(!folder.path().join(LOCK).exists());
        let _again = Lock::take(folder.path(), Duration::ZERO).unwrap();
    }

    #[test]
    fn a_file_that_nobody_locks_holds_nobody_up() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(
            folder.path().join(LOCK),
            "process 1, since 1970-01-01 00:00:00 UTC, and much more text",
        )
        .unwrap();
        let _lock = Lock::take(folder.path(), Duration::ZERO).unwrap();
        let said = fs::read_to_string(folder.path().join(LOCK)).unwrap();
        assert!(said.ends_with(" UTC"), "{said}");
    }

    #[test]
    fn many_take_turns() {
        let folder = tempfile::tempdir().unwrap();
        let inside = std::sync::atomic::AtomicUsize::new(0);
        let one = || {
            for _ in 0..20 {
                let _lock = Lock::take(folder.path(), Duration::from_secs(60)).unwrap();
                use std::sync::atomic::Ordering::SeqCst;
                assert_eq!(inside.fetch_add(1, SeqCst), 0);
                std::thread::yield_now();
                inside.fetch_sub(1, SeqCst);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(one);
            }
        });
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_its_place_is_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let precious = folder.path().join("precious");
        fs::write(&precious, "mine").unwrap();
        std::os::unix::fs::symlink(&precious, folder.path().join(LOCK)).unwrap();
        let taken = Lock::take(folder.path(), Duration::ZERO);
        assert!(matches!(taken, Err(Taken::Failed(_))), "{taken:?}");
        assert_eq!(fs::read(&precious).unwrap(), b"mine");
    }
}
