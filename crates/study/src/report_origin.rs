//! What a report is of: where its model comes from, and the other design that is set beside it.

use kempe_model::Diagnostic;

use crate::comparison::{Comparison, Design};

/// Where a report comes from.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReportOrigin<'a> {
    /// The model file's name.
    pub file_name: &'a str,
    /// The model file's text.
    pub text: &'a str,
    /// Parameters that were given other values than the file's, with these values as written.
    pub set: &'a [(String, String)],
    /// The program's name and version.
    pub generator: &'a str,
    /// When it was written, for those who want it in the page; may be empty.
    pub date: &'a str,
}

impl ReportOrigin<'_> {
    /// What the design is called: `four-bar.toml with a=25mm`.
    pub fn design_name(&self) -> String {
        let set: Vec<String> = (self.set.iter())
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        match set.is_empty() {
            true => self.file_name.to_owned(),
            false => format!("{} with {}", self.file_name, set.join(", ")),
        }
    }
}

/// Another design to set beside that of a report.
#[derive(Clone, Copy, Debug)]
pub struct ReportAgainst<'a> {
    /// The other design.
    pub design: Design<'a>,
    /// Where it comes from.
    pub origin: &'a ReportOrigin<'a>,
    /// Warnings of reading its file.
    pub warnings: &'a [Diagnostic],
    /// Both beside each other.
    pub comparison: &'a Comparison,
}
