//! Which files of a folder Kempe wrote: a list in the folder, with the length and a fingerprint of each. Only a file that is
//! still what the list says is ever replaced.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::hidden;
use crate::fingerprint;
use crate::read::{Unread, read_plain};

/// The file with the list.
pub const RECORD: &str = ".kempe-files.json";

/// What the list says of itself.
const ABOUT: &str = "files that Kempe wrote in this folder; it replaces these alone, and only while they are as it wrote them";

/// The largest list that is read, bytes.
const MOST_BYTES: usize = 16 << 20;

/// Bytes that are looked at together.
const BLOCK: usize = 1 << 16;

/// What a file holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    bytes: u64,
    fnv1a64: u64,
}

/// A file that takes its place, while a run publishes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Appearing {
    /// What it will hold.
    pub mark: Mark,
    /// The second name of the file that it replaces.
    pub kept: Option<String>,
}

/// The list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Record {
    files: BTreeMap<String, Mark>,
    /// What a run was about to let appear; empty when it is done.
    pub appearing: BTreeMap<String, Appearing>,
}

/// Whose a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Kempe wrote it, and it is as it was.
    Kempe,
    /// Kempe wrote it, and somebody changed it.
    Changed,
    /// Kempe did not write it.
    Somebody,
}

impl Mark {
    /// The mark of these bytes.
    #[cfg(test)]
    pub fn of(bytes: &[u8]) -> Self {
        Self {
            bytes: bytes.len() as u64,
            fnv1a64: fingerprint::fnv1a64(bytes),
        }
    }

    /// Whether a file holds what the mark says.
    pub fn is_of(&self, path: &Path) -> bool {
        let length = fs::symlink_metadata(path).map(|m| m.len());
        length.is_ok_and(|l| l == self.bytes) && Self::of_file(path).is_ok_and(|mark| mark == *self)
    }

    /// The mark of a file, which may be larger than what there is room for.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        let mut file = fs::File::open(path)?;
        let mut block = vec![0; BLOCK];
        let mut mark = Self {
            bytes: 0,
            fnv1a64: fingerprint::NOTHING,
        };
        loop {
            let read = file.read(&mut block)?;
            let Some(bytes) = block.get(..read).filter(|b| !b.is_empty()) else {
                return Ok(mark);
            };
            mark.bytes += read as u64;
            mark.fnv1a64 = fingerprint::continued(mark.fnv1a64, bytes);
        }
    }

    fn json(&self) -> Value {
        json!({ "bytes": self.bytes, "fnv1a64": format!("{:016x}", self.fnv1a64) })
    }

    fn parse(value: &Value) -> Option<Self> {
        Some(Self {
            bytes: value.get("bytes")?.as_u64()?,
            fnv1a64: u64::from_str_radix(value.get("fnv1a64")?.as_str()?, 16).ok()?,
        })
    }
}

impl Record {
    /// The list of a folder, empty where there is none.
    ///
    /// # Errors
    ///
    /// Where it cannot be read, or is not Kempe's.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let path = folder.join(RECORD);
        match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => return Err(error),
            Ok(metadata) if !metadata.is_file() => {
                return Err(io::Error::other("it is not a plain file"));
            }
            Ok(_) => {}
        }
        let bytes = read_plain(&path, MOST_BYTES).map_err(|unread| match unread {
            Unread::Failed(error) => error,
            other => io::Error::other(other.reason()),
        })?;
        let parsed: Option<Value> = serde_json::from_slice(&bytes).ok();
        parsed
            .as_ref()
            .and_then(Self::parse)
            .ok_or_else(|| io::Error::other("it is not a list that Kempe wrote"))
    }

    fn parse(value: &Value) -> Option<Self> {
        let mut record = Self::default();
        for (name, entry) in value.get("files")?.as_object()? {
            record.files.insert(name.clone(), Mark::parse(entry)?);
        }
        let none = Map::new();
        let appearing = match value.get("appearing") {
            Some(value) => value.as_object()?,
            None => &none,
        };
        for (name, entry) in appearing {
            let kept = match entry.get("kept") {
                // Nothing but a name of this folder is ever renamed.
                Some(kept) => Some(kept.as_str().filter(|k| hidden::is_hidden(k))?.to_owned()),
                None => None,
            };
            let mark = Mark::parse(entry).filter(|_| is_plain_name(name))?;
            (record.appearing).insert(name.clone(), Appearing { mark, kept });
        }
        Some(record)
    }

    /// Writes the list; files that are gone leave it.
    pub fn write(&mut self, folder: &Path) -> io::Result<()> {
        self.files
            .retain(|name, _| fs::symlink_metadata(folder.join(name)).is_ok());
        let path = folder.join(RECORD);
        if self.files.is_empty() && self.appearing.is_empty() && !path.exists() {
            return Ok(());
        }
        let files = self.files.iter().map(|(n, mark)| (n.clone(), mark.json()));
        let mut value = json!({ "about": ABOUT, "files": files.collect::<Map<_, _>>() });
        if !self.appearing.is_empty() {
            let entries = self.appearing.iter().map(|(name, entry)| {
                let mut value = entry.mark.json();
                if let Some(kept) = &entry.kept {
                    value["kept"] = json!(kept);
                }
                (name.clone(), value)
            });
            value["appearing"] = Value::Object(entries.collect());
        }
        let text = serde_json::to_string_pretty(&value)? + "\n";
        let (hidden, mut file) = hidden::create(folder)?;
        let written = file
            .write_all(text.as_bytes())
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&hidden, &path));
        written.inspect_err(|_| {
            let _ = fs::remove_file(&hidden);
        })
    }

    /// Whose a file of the folder is.
    pub fn owner(&self, folder: &Path, name: &str) -> Owner {
        match self.files.get(name) {
            None => Owner::Somebody,
            Some(mark) if mark.is_of(&folder.join(name)) => Owner::Kempe,
            Some(_) => Owner::Changed,
        }
    }

    /// The files that somebody changed since Kempe wrote them.
    pub fn changed<'r>(&'r self, folder: &'r Path) -> impl Iterator<Item = &'r str> {
        let names = self.files.keys().map(String::as_str);
        names.filter(move |name| {
            fs::symlink_metadata(folder.join(name)).is_ok()
                && self.owner(folder, name) == Owner::Changed
        })
    }

    /// The files right in a folder of this one.
    pub fn files_in<'r>(&'r self, inner: &'r str) -> impl Iterator<Item = &'r str> {
        let names = self.files.keys().map(String::as_str);
        names.filter(move |name| name.split_once('/').is_some_and(|(own, _)| own == inner))
    }

    /// All that was about to appear has appeared.
    pub fn appeared(&mut self) {
        let appearing = std::mem::take(&mut self.appearing);
        let marks = appearing
            .into_iter()
            .map(|(name, entry)| (name, entry.mark));
        self.files.extend(marks);
    }

    /// Takes back what a run that was killed had begun to publish, so that the result before it stands whole. What somebody
    /// changed since is left as it is.
    pub fn take_back(&mut self, folder: &Path) -> io::Result<()> {
        for (name, entry) in std::mem::take(&mut self.appearing) {
            let path = folder.join(&name);
            let kept: Option<PathBuf> = entry.kept.map(|kept| folder.join(kept));
            let kept = kept.filter(|kept| kept.exists());
            let there = fs::symlink_metadata(&path).is_ok();
            let new = there && entry.mark.is_of(&path);
            match kept {
                Some(kept) if new || !there => fs::rename(&kept, &path)?,
                None if new && self.files.get(&name) != Some(&entry.mark) => {
                    fs::remove_file(&path)?;
                }
                _ => {}
            }
        }
        self.write(folder)
    }
}

/// Whether a name is one of a file right in the folder, or in a folder right in it: `turn.csv`, `generator/01.toml`.
fn is_plain_name(name: &str) -> bool {
    let parts: Vec<_> = Path::new(name).components().collect();
    let normal = |part: &std::path::Component<'_>| matches!(part, std::path::Component::Normal(_));
    let written = parts.iter().map(|part| part.as_os_str().to_string_lossy());
    (1..=2).contains(&parts.len())
        && parts.iter().all(normal)
        && written.collect::<Vec<_>>().join("/") == name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_reads_back_and_forgets_what_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let mut record = Record::default();
        for (name, text) in [("a.csv", "one"), ("b \"\n.svg", "two")] {
            fs::write(at.join(name), text).unwrap();
            let entry = Appearing {
                mark: Mark::of(text.as_bytes()),
                kept: None,
            };
            record.appearing.insert(name.to_owned(), entry);
        }
        record.write(at).unwrap();
        assert_eq!(Record::read(at).unwrap(), record);
        record.appeared();
        record.write(at).unwrap();
        assert_eq!(Record::read(at).unwrap(), record);
        assert_eq!(record.owner(at, "a.csv"), Owner::Kempe);
        assert_eq!(record.owner(at, "c.csv"), Owner::Somebody);
        fs::write(at.join("a.csv"), "One").unwrap();
        assert_eq!(record.owner(at, "a.csv"), Owner::Changed);
        fs::remove_file(at.join("a.csv")).unwrap();
        record.write(at).unwrap();
        assert_eq!(Record::read(at).unwrap().files.len(), 1);
    }

    #[test]
    fn lists_that_kempe_did_not_write_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        for text in [
            "",
            "[]",
            "{}",
            r#"{"files": {"a": 3}}"#,
            r#"{"files": {}, "appearing": {"../a": {"bytes": 1, "fnv1a64": "0"}}}"#,
            r#"{"files": {}, "appearing": {"..": {"bytes": 1, "fnv1a64": "0"}}}"#,
            r#"{"files": {}, "appearing": {"a/../b": {"bytes": 1, "fnv1a64": "0"}}}"#,
            r#"{"files": {}, "appearing": {"a/b/c": {"bytes": 1, "fnv1a64": "0"}}}"#,
            r#"{"files": {}, "appearing": {"a": {"bytes": 1, "fnv1a64": "0", "kept": "b"}}}"#,
        ] {
            fs::write(at.join(RECORD), text).unwrap();
            assert!(Record::read(at).is_err(), "{text}");
        }
    }
}
