//! `kempe new`: a file to start from.

use std::path::PathBuf;

use kempe_model::starter;

use crate::arguments::New;
use crate::exit::Exit;
use crate::output::create;
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
    let text = starter.text.replace("FILE", &shown.to_string());
    if let Err(diagnostic) = create(&path, text.as_bytes()) {
        speaker.tell(&[*diagnostic]);
        return Exit::Usage;
    }
    put(&format!(
        "{shown}: {}\n\n  kempe check {shown}\n  kempe run {shown} --out results\n",
        starter.doc
    ));
    Exit::Ok
}
