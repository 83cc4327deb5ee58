//! `kempe new`: a file to start from.

use std::path::PathBuf;

use kempe_model::{Diagnostic, starter};

use crate::arguments::New;
use crate::exit::Exit;
use crate::files::plain;
use crate::output::Batch;
use crate::say::{Speaker, put};

/// Runs `kempe new`.
pub fn new(arguments: &New) -> Exit {
    let mut speaker = Speaker::new(false, false);
    let Some(starter) = starter(&arguments.kind) else {
        return Exit::Usage;
    };
    let mut path = arguments
        .name
        .clone()
        .unwrap_or_else(|| PathBuf::from(starter.name));
    if path.extension().is_none_or(|e| e != "toml") {
        let mut name = path.into_os_string();
        name.push(".toml");
        path = PathBuf::from(name);
    }
    let shown = path.display();
    if path.exists() {
        let diagnostic = Diagnostic::error("file-exists", format!("{shown} is already there"));
        speaker.tell(&[diagnostic.help("give another name: kempe new NAME")]);
        return Exit::Usage;
    }
    let text = starter.text.replace("FILE", &shown.to_string());
    let mut batch = Batch::new();
    let written = batch.add(&path, text.as_bytes());
    if let Err(error) = written.and_then(|()| Ok(batch.publish()?)) {
        let diagnostic = Diagnostic::error(
            "cannot-write",
            format!("{shown} cannot be written: {}", plain(&error)),
        );
        speaker.tell(&[diagnostic]);
        return Exit::Usage;
    }
    put(&format!(
        "{shown}: {}\n\n  kempe check {shown}\n  kempe run {shown} --out results\n",
        starter.doc
    ));
    Exit::Ok
}
