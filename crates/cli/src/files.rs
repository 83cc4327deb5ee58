//! Reading model files.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use kempe_model::{Checked, Diagnostic, MAX_FILE_BYTES, Model};
use kempe_study::ReportOrigin;
use kempe_units::nearest;

use crate::arguments::ModelFile;
use crate::exit::Exit;
use crate::read::{Tables, Unread, read_plain};
use crate::say::Speaker;

/// A model with the text it was read from.
pub struct Loaded {
    /// The model and the warnings of reading it.
    pub checked: Checked,
    /// The file's text.
    pub text: String,
    /// The file's name as given.
    pub name: String,
    /// Parameters that the command line gave other values.
    pub set: Vec<(String, String)>,
    /// All files that the model was read from: its own, and its tables.
    pub inputs: Vec<PathBuf>,
    /// A fingerprint of its tables.
    pub tables: u64,
}

impl Loaded {
    /// Where the design comes from.
    pub fn origin(&self) -> ReportOrigin<'_> {
        ReportOrigin {
            file_name: &self.name,
            text: &self.text,
            set: &self.set,
            ..ReportOrigin::default()
        }
    }
}

/// Reads a model file, or says why not.
pub fn load(model: &ModelFile, speaker: &mut Speaker) -> Result<Loaded, Exit> {
    let loaded = read(model, speaker)?;
    speaker.tell(&loaded.checked.warnings);
    Ok(loaded)
}

/// Reads the other one of two designs. What reading the same text has told already is not told again.
pub fn load_other(model: &ModelFile, this: &Loaded, speaker: &mut Speaker) -> Result<Loaded, Exit> {
    let mut loaded = read(model, speaker)?;
    if loaded.text == this.text {
        let told = &this.checked.warnings;
        loaded.checked.warnings.retain(|w| !told.contains(w));
    }
    speaker.tell(&loaded.checked.warnings);
    Ok(loaded)
}

fn read(model: &ModelFile, speaker: &mut Speaker) -> Result<Loaded, Exit> {
    let name = model.file.display().to_string();
    let bytes = match read_plain(&model.file, MAX_FILE_BYTES) {
        Ok(bytes) => bytes,
        Err(unread) => {
            speaker.name_file(&name, "");
            speaker.tell(&[unreadable(&model.file, &unread)]);
            return Err(Exit::Usage);
        }
    };
    let text = String::from_utf8_lossy(&bytes).into_owned();
    speaker.name_file(&name, &text);
    let title = model
        .file
        .file_stem()
        .map_or(name.clone(), |s| s.to_string_lossy().into_owned());
    if let Some(diagnostic) = set_twice(&model.set) {
        speaker.tell(&[diagnostic]);
        return Err(Exit::Usage);
    }
    let folder = model.file.parent().unwrap_or(Path::new(""));
    let mut tables = Tables::of(folder, model.allow_outside);
    match Model::from_bytes(&bytes, &title, &mut |name| tables.read(name), &model.set) {
        Ok(checked) => {
            let hash = tables.hash;
            let mut inputs = tables.read;
            inputs.push(model.file.clone());
            Ok(Loaded {
                checked,
                text,
                name,
                set: model.set.clone(),
                inputs,
                tables: hash,
            })
        }
        Err(found) => {
            speaker.tell(&found);
            Err(Exit::Usage)
        }
    }
}

/// A parameter that the command line gives two values.
fn set_twice(set: &[(String, String)]) -> Option<Diagnostic> {
    let (index, (name, value)) = (set.iter().enumerate())
        .find(|(index, (name, _))| set.iter().take(*index).any(|(other, _)| other == name))?;
    let first = set.iter().take(index).find(|(other, _)| other == name);
    let first = first.map_or("", |(_, value)| value);
    let message = format!("parameter `{name}` is set twice, to {first} and to {value}");
    Some(Diagnostic::error("over-specified", message).help("leave one of them out"))
}

/// Why a file cannot be read; a missing one with the near name, if there is one.
fn unreadable(path: &Path, unread: &Unread) -> Diagnostic {
    let shown = path.display();
    match unread {
        Unread::Failed(error) if error.kind() == io::ErrorKind::NotFound => {
            let diagnostic = Diagnostic::error("no-file", format!("there is no file {shown}"));
            match near_file(path) {
                Some(near) => diagnostic.help(format!("did you mean {near}?")),
                None => diagnostic.help("kempe new writes a file to start from"),
            }
        }
        Unread::Failed(_) => {
            let message = format!("{shown} cannot be read: {}", unread.reason());
            Diagnostic::error("no-file", message)
        }
        Unread::NotPlain(what) => {
            let diagnostic = Diagnostic::error("no-file", format!("{shown} is {what}"));
            match path.is_dir() {
                true => diagnostic.help("name a model file in it"),
                false => diagnostic.help("write the model to a plain file and name that"),
            }
        }
        Unread::TooLarge(limit) => {
            let message = format!("{shown} has more than {} MiB", limit >> 20);
            Diagnostic::error("too-large", message)
                .note("no more of a model file is read")
                .help("put long lists of numbers into tables beside it: law = { table = \"measured.csv\" }")
        }
    }
}

/// A file in the same folder whose name is near.
pub fn near_file(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let mut names: Vec<String> = entries
        .filter_map(|e| e.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    let wanted = path.file_name()?.to_str()?;
    let with_ending = format!("{wanted}.toml");
    let near = names
        .iter()
        .find(|n| **n == with_ending)
        .map(String::as_str)
        .or_else(|| nearest(wanted, names.iter().map(String::as_str)))?;
    Some(path.with_file_name(near).display().to_string())
}
