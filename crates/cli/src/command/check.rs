//! `kempe check`: what is to be known of a mechanism before it moves.

use kempe_study::room_for;
use serde_json::json;

use crate::arguments::Check;
use crate::exit::Exit;
use crate::files::load;
use crate::interrupt;
use crate::progress::Bar;
use crate::say::{Speaker, complain, print_json, put};

/// Runs `kempe check`.
pub fn check(arguments: &Check) -> Exit {
    let mut speaker = Speaker::new(arguments.json, false).strictly(arguments.model.strict);
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => {
            speaker.print_failure();
            return exit;
        }
    };
    let model = &loaded.checked.model;
    let rooms = model.studies.iter().map(|study| room_for(model, study));
    let too_large: Vec<_> = rooms.filter_map(Result::err).flatten().collect();
    if !too_large.is_empty() {
        speaker.tell(&too_large);
        speaker.print_failure();
        return Exit::Usage;
    }
    interrupt::listen();
    let mut bar = Bar::new("check", arguments.json);
    let report = kempe_study::check_with_progress(model, &mut bar);
    // A mechanism that cannot move is told so above; there is no motion to prove. Of one that moves less far than it should the
    // rest is proved.
    let proof = (arguments.certify && !interrupt::stopped())
        .then(|| kempe_study::prove(model, &mut bar).ok())
        .flatten();
    drop(bar);
    if arguments.json {
        speaker.tell(&report.diagnostics);
        let mut value = serde_json::to_value(&report).unwrap_or_default();
        value["file"] = json!(loaded.name);
        value["diagnostics"] = speaker.diagnostics();
        if let Some(proof) = &proof {
            value["proof"] = serde_json::to_value(proof).unwrap_or_default();
        }
        print_json(&value);
    } else {
        put(&report.to_text());
        if let Some(proof) = &proof {
            put(&proof.to_text());
        }
        if report.has_findings() {
            complain("\n");
        }
        speaker.tell(&report.diagnostics);
    }
    match proof {
        _ if interrupt::stopped() => Exit::Interrupted,
        Some(proof) if !proof.is_whole() => speaker.exit().max(Exit::Finding),
        _ => speaker.exit(),
    }
}
