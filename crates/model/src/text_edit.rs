//! Changes of a text as data.

use std::fmt;

use crate::ids::Span;

/// A change of a text: what stands at `span` is replaced by `text`.
///
/// Edits of one change do not overlap; their places are those of the text before any of them. [`apply`] makes the new text,
/// an editor may apply them by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextEdit {
    /// Bytes of the text; empty where something is inserted.
    pub span: Span,
    /// What stands there afterwards.
    pub text: String,
}

impl TextEdit {
    /// The edit that replaces what stands at `span`.
    pub fn new(span: Span, text: impl Into<String>) -> Self {
        Self {
            span,
            text: text.into(),
        }
    }
}

/// Why edits do not fit a text.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EditError {
    /// A place is beyond the text's end, ends before it starts, or cuts a letter.
    NoSuchPlace(Span),
    /// Two edits change the same bytes.
    Overlap(Span, Span),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchPlace(span) => write!(f, "the text has no bytes {span:?}"),
            Self::Overlap(a, b) => write!(f, "the edits at {a:?} and {b:?} overlap"),
        }
    }
}

impl std::error::Error for EditError {}

/// The text after some edits, in whatever order they come. Every other byte stays.
///
/// # Errors
///
/// Where the edits do not fit the text or each other.
///
/// # Example
///
/// ```
/// use kempe_model::{TextEdit, apply};
/// let edits = [TextEdit::new(4..5, "25"), TextEdit::new(0..1, "b")];
/// assert_eq!(apply("a = 2 # mm", &edits).unwrap(), "b = 25 # mm");
/// assert!(apply("a = 2", &[TextEdit::new(4..9, "")]).is_err());
/// ```
pub fn apply(text: &str, edits: &[TextEdit]) -> Result<String, EditError> {
    let mut sorted: Vec<&TextEdit> = edits.iter().collect();
    sorted.sort_by_key(|e| (e.span.start, e.span.end));
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    let mut before: Option<&TextEdit> = None;
    for edit in sorted {
        let fits = text.get(edit.span.clone()).is_some();
        if !fits {
            return Err(EditError::NoSuchPlace(edit.span.clone()));
        }
        match (text.get(at..edit.span.start), before) {
            (Some(kept), _) => out.push_str(kept),
            (None, Some(other)) => {
                return Err(EditError::Overlap(other.span.clone(), edit.span.clone()));
            }
            (None, None) => return Err(EditError::NoSuchPlace(edit.span.clone())),
        }
        out.push_str(&edit.text);
        at = edit.span.end;
        before = Some(edit);
    }
    out.push_str(text.get(at..).unwrap_or(""));
    Ok(out)
}
