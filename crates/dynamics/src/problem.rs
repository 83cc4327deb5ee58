//! Why forces cannot be computed for a model.

use std::fmt;

use kempe_model::Span;

/// Something in what acts on a mechanism that makes forces meaningless, with its place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// A stable code.
    pub code: &'static str,
    /// A sentence for the user.
    pub message: String,
    /// Where it stands in the file.
    pub span: Span,
    /// What to do about it, where the sentence does not tell.
    pub remedy: Option<&'static str>,
}

impl Problem {
    pub(crate) fn new(code: &'static str, span: &Span, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            span: span.clone(),
            remedy: None,
        }
    }

    pub(crate) fn remedy(mut self, remedy: &'static str) -> Self {
        self.remedy = Some(remedy);
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Problem {}
