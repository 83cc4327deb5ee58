//! The one error of this crate.

use std::fmt;

use kempe_model::{Diagnostic, Severity};

/// Why something cannot be done: diagnostics over the model file, each with a stable code, the place, the cause and what to
/// do about it.
///
/// ```
/// let error = "[links]\nframe = { A = [0, 0], B = [1, 0] ".parse::<kempe::Model>().unwrap_err();
/// assert_eq!(error.code(), "toml-syntax");
/// assert!(error.to_string().contains("model:2:"));
/// ```
#[derive(Clone)]
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

    /// The code of the first error, such as `cannot-assemble`; what is only warned of may stand before it.
    pub fn code(&self) -> &'static str {
        let mut errors = (self.diagnostics.iter()).filter(|d| d.severity == Severity::Error);
        errors
            .next()
            .or(self.diagnostics.first())
            .map_or("", |d| d.code)
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

/// As it is displayed: who unwraps an error reads it.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}
