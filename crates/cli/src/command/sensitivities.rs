//! `kempe sensitivities`: how the measures change with the parameters.

use kempe_study::Setting;
use serde_json::json;

use crate::arguments::Sensitivities;
use crate::exit::Exit;
use crate::files::load;
use crate::interrupt;
use crate::progress::Bar;
use crate::say::{Speaker, print_json, put};

/// Runs `kempe sensitivities`.
pub fn sensitivities(arguments: &Sensitivities) -> Exit {
    let mut speaker = Speaker::new(arguments.json, false).strictly(arguments.model.strict);
    let fail = |speaker: &Speaker, exit| {
        speaker.print_failure();
        exit
    };
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => return fail(&speaker, exit),
    };
    let model = &loaded.checked.model;
    let setting = match arguments
        .at
        .as_deref()
        .map(|text| Setting::parse(model, text))
    {
        Some(Err(diagnostic)) => {
            speaker.tell(&[diagnostic]);
            return fail(&speaker, Exit::Usage);
        }
        Some(Ok(setting)) => Some(setting),
        None => None,
    };
    interrupt::listen();
    let mut bar = Bar::new("sensitivities", arguments.json);
    let found = kempe_study::sensitivities(model, setting.as_ref(), &mut bar);
    drop(bar);
    match found {
        Ok(found) if arguments.json => {
            speaker.tell(&found.diagnostics);
            let mut value = serde_json::to_value(&found).unwrap_or_default();
            value["file"] = json!(loaded.name);
            value["diagnostics"] = speaker.diagnostics();
            print_json(&value);
            speaker.exit()
        }
        Ok(found) => {
            put(&found.to_text());
            speaker.tell(&found.diagnostics);
            speaker.exit()
        }
        Err(diagnostic) => {
            speaker.tell(&diagnostic);
            // a file that names nothing to differentiate is wrong, whatever its mechanism does
            let of_file = diagnostic
                .iter()
                .all(|d| d.code == "nothing-to-differentiate");
            let exit = if interrupt::stopped() {
                Exit::Interrupted
            } else if of_file {
                Exit::Usage
            } else {
                Exit::CannotSolve
            };
            fail(&speaker, exit)
        }
    }
}
