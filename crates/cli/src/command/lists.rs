//! `kempe schema`, `kempe measures` and `kempe completions`: what the program knows.

use clap::CommandFactory;
use kempe_model::{Diagnostic, Registry};
use kempe_units::nearest;

use crate::arguments::{Arguments, Completions, Measures};
use crate::exit::Exit;
use crate::say::{Speaker, print_json, put};

/// Runs `kempe schema`.
pub fn schema() -> Exit {
    print_json(&kempe_model::schema());
    Exit::Ok
}

/// Runs `kempe measures`.
pub fn measures(arguments: &Measures) -> Exit {
    let mut entries = Registry::all().to_vec();
    if let Some(name) = &arguments.name {
        entries.retain(|e| e.name == name);
        if entries.is_empty() {
            let diagnostic =
                Diagnostic::error("unknown-name", format!("there is no measure `{name}`"));
            let near = nearest(name, Registry::all().iter().map(|e| e.name));
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "kempe measures lists them all".to_owned(),
            };
            let mut speaker = Speaker::new(arguments.json, false);
            speaker.tell(&[diagnostic.help(help)]);
            speaker.print_failure();
            return Exit::Usage;
        }
    }
    if arguments.json {
        print_json(&serde_json::to_value(&entries).unwrap_or_default());
        return Exit::Ok;
    }
    let mut out = String::new();
    if arguments.name.is_none() {
        out.push_str("What may be asked in [measures], in columns and in plots. Units and arithmetic go with them:\n\
                      \"angle(rocker) - 90 deg\", \"hypot(x(P), y(P)) / 2\".\n\n");
    }
    for entry in &entries {
        out.push_str(&format!(
            "{}\n    {} ({})\n    such as {}\n",
            entry.signatures().join("   "),
            entry.doc,
            entry.dimension(),
            entry.example
        ));
    }
    put(&out);
    Exit::Ok
}

/// Runs `kempe completions`.
pub fn completions(arguments: &Completions) -> Exit {
    let mut script: Vec<u8> = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut Arguments::command(),
        "kempe",
        &mut script,
    );
    put(&String::from_utf8_lossy(&script));
    Exit::Ok
}
