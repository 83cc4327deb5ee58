//! Reading model files and the files they name.

use std::fs;
use std::io::{self, Read as _};
use std::path::Path;

use kempe_model::{Checked, Diagnostic, MAX_FILE_BYTES, Model};
use kempe_units::nearest;

use crate::arguments::ModelFile;
use crate::exit::Exit;
use crate::say::Speaker;

/// A model with the text it was read from.
pub struct Loaded {
    /// The model and the warnings of reading it.
    pub checked: Checked,
    /// The file's text.
    pub text: String,
    /// The file's name as given.
    pub name: String,
}

/// Reads a model file, or says why not.
pub fn load(model: &ModelFile, speaker: &mut Speaker) -> Result<Loaded, Exit> {
    let name = model.file.display().to_string();
    let bytes = match read_bytes(&model.file) {
        Ok(bytes) => bytes,
        Err(diagnostic) => {
            speaker.name_file(&name, "");
            speaker.tell(&[*diagnostic]);
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
    let folder = model.file.parent().unwrap_or(Path::new("")).to_owned();
    match Model::from_bytes(
        &bytes,
        &title,
        &mut |name| read_table(&folder, name),
        &model.set,
    ) {
        Ok(checked) => {
            speaker.tell(&checked.warnings);
            Ok(Loaded {
                checked,
                text,
                name,
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

/// The bytes of a file that is not too large.
fn read_bytes(path: &Path) -> Result<Vec<u8>, Box<Diagnostic>> {
    let refuse = |error: io::Error| Box::new(unreadable(path, &error));
    let file = fs::File::open(path).map_err(refuse)?;
    // devices have no size: what is read is what counts
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(refuse)?;
    if bytes.len() > MAX_FILE_BYTES {
        let message = format!("{} has more than {MAX_FILE_BYTES} bytes", path.display());
        return Err(Box::new(
            Diagnostic::error("too-large", message).help("no more of a file is read"),
        ));
    }
    Ok(bytes)
}

/// The text of a table that a model file names, from the file's folder.
pub fn read_table(folder: &Path, name: &str) -> Result<String, String> {
    let path = folder.join(name);
    // A pipe may never say anything.
    if path.exists() && !path.is_file() && !path.is_dir() {
        return Err(format!("{} is not a plain file", path.display()));
    }
    let bytes = read_bytes(&path).map_err(|diagnostic| diagnostic.message)?;
    String::from_utf8(bytes).map_err(|_| format!("{} is not UTF-8 text", path.display()))
}

/// Why a file cannot be read; a missing one with the near name, if there is one.
fn unreadable(path: &Path, error: &io::Error) -> Diagnostic {
    let shown = path.display();
    if error.kind() == io::ErrorKind::NotFound {
        let diagnostic = Diagnostic::error("no-file", format!("there is no file {shown}"));
        return match near_file(path) {
            Some(near) => diagnostic.help(format!("did you mean {near}?")),
            None => diagnostic.help("kempe new writes a file to start from"),
        };
    }
    if path.is_dir() {
        return Diagnostic::error("no-file", format!("{shown} is a folder"))
            .help("name a model file in it");
    }
    Diagnostic::error(
        "no-file",
        format!("{shown} cannot be read: {}", plain(error)),
    )
}

/// A file in the same folder whose name is near.
fn near_file(path: &Path) -> Option<String> {
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

/// An error of the operating system without its number.
pub fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error")
        .next()
        .unwrap_or(&text)
        .to_lowercase()
}
