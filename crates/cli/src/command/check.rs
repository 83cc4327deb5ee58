//! `kempe check`: what is to be known of a mechanism before it moves.

use serde_json::json;

use crate::arguments::Check;
use crate::exit::Exit;
use crate::files::load;
use crate::interrupt;
use crate::progress::Bar;
use crate::say::{Speaker, print_json, put};

/// Runs `kempe check`.
pub fn check(arguments: &Check) -> Exit {
    let mut speaker = Speaker::new(arguments.json, false);
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => {
            speaker.print_failure();
            return exit;
        }
    };
    interrupt::listen();
    let mut bar = Bar::new("check", arguments.json);
    let report = kempe_study::check_watched(&loaded.checked.model, &mut bar);
    drop(bar);
    if arguments.json {
        speaker.tell(&report.diagnostics);
        let mut value = serde_json::to_value(&report).unwrap_or_default();
        value["file"] = json!(loaded.name);
        value["diagnostics"] = speaker.told();
        print_json(&value);
    } else {
        put(&report.to_text());
        if report.has_findings() {
            eprintln!();
        }
        speaker.tell(&report.diagnostics);
    }
    if interrupt::stopped() {
        Exit::Interrupted
    } else if report.has_errors() {
        Exit::CannotSolve
    } else if report.has_findings() || !loaded.checked.warnings.is_empty() {
        Exit::Finding
    } else {
        Exit::Ok
    }
}
