//! The one error of this crate.

use std::fmt;

use kempe_model::Diagnostic;

/// Why something cannot be done: diagnostics over the model file, each with a stable code, the place, the cause and what to
/// do about it.
///
/// ```
/// let error = "[links]\nframe = { A = [0, 0], B = [1, 0] ".parse::<kempe::Model>().unwrap_err();
/// assert_eq!(error.code(), "toml-syntax");
/// assert!(error.to_string().contains("model:2:"));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Error {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Error {
    /// What is wrong, in the order of the file.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The code of the first error, such as `cannot-assemble`.
    pub fn code(&self) -> &'static str {
        self.diagnostics.first().map_or("", |d| d.code)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let diagnostic = self.diagnostics.iter();
        let lines: Vec<String> = diagnostic
            .map(|d| d.render_plain(&self.name, &self.text))
            .collect();
        f.write_str(lines.join("\n").trim_end())
    }
}

impl std::error::Error for Error {}
