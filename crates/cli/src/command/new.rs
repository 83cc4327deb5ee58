//! `kempe new`: a file to start from.

use std::path::PathBuf;

use kempe_model::{Diagnostic, STARTERS, Starter, starter};
use kempe_units::nearest;

use crate::arguments::New;
use crate::exit::Exit;
use crate::output::create;
use crate::say::{Speaker, put};

/// Runs `kempe new`.
pub fn new(arguments: &New) -> Exit {
    let mut speaker = Speaker::new(false, false);
    let name = arguments.name.as_deref();
    let is_file = name.is_some_and(|n| n.extension().is_some_and(|e| e == "toml"));
    let named = name.filter(|_| !is_file).map(|n| n.to_string_lossy());
    let kind = match (arguments.kind.as_deref(), &named) {
        (Some(kind), _) => kind,
        (None, Some(named)) => named.as_ref(),
        (None, None) if is_file => STARTERS[0].name,
        (None, None) => {
            put(&format!("{}\n  kempe new KIND\n", kinds()));
            return Exit::Ok;
        }
    };
    let Some(starter) = starter(kind) else {
        speaker.tell(&[unknown(kind)]);
        return Exit::Usage;
    };
    let mut path = (arguments.name.clone()).unwrap_or_else(|| PathBuf::from(starter.name));
    if !is_file {
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

/// All kinds, a line each.
fn kinds() -> String {
    let width = STARTERS.iter().map(|s| s.name.len()).max().unwrap_or(0);
    let line = |s: &Starter| format!("  {:width$}  {}\n", s.name, s.doc);
    STARTERS.iter().map(line).collect()
}

fn unknown(kind: &str) -> Diagnostic {
    let mut diagnostic = Diagnostic::error("unknown-name", format!("there is no kind `{kind}`"));
    for starter in STARTERS {
        diagnostic = diagnostic.note(format!("{}: {}", starter.name, starter.doc));
    }
    let near = nearest(kind, STARTERS.iter().map(|s| s.name));
    let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    diagnostic.help(format!(
        "{near}a file of your own name ends in .toml: kempe new press.toml --kind {}",
        STARTERS[0].name
    ))
}
