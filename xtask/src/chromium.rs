//! The browser in which the report is tested.

use crate::shell::{answers, apt_install};

/// Variables that say where it is, and names under which it is installed; `crates/cli/tests/browser` looks there, too.
const VARIABLES: [&str; 2] = ["CHROMIUM", "CHROME"];
const NAMES: [&str; 6] = [
    "chromium",
    "chromium-browser",
    "google-chrome-stable",
    "google-chrome",
    "chrome",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];

/// Sees to it that there is one, by installing it where that is possible.
///
/// # Errors
///
/// What to install.
pub fn ready() -> Result<(), String> {
    let named = VARIABLES
        .into_iter()
        .filter_map(|v| Some((v, std::env::var(v).ok()?)));
    if let Some((variable, program)) = named.into_iter().find(|(_, program)| !program.is_empty()) {
        return match answers(&program, &["--version"]) {
            true => Ok(()),
            false => Err(format!(
                "{variable} says that the browser is {program}, which does not answer --version"
            )),
        };
    }
    let there = || NAMES.iter().any(|name| answers(name, &["--version"]));
    if there() || (apt_install(&["chromium"]).is_ok() && there()) {
        return Ok(());
    }
    Err(
        "Chromium is missing, in which the report is tested. Install it and try again:\n       \
         apt-get install --yes chromium   (Debian, as root)\n       \
         or say where it is: CHROMIUM=/path/to/chromium"
            .into(),
    )
}
