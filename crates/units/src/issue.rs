//! What is wrong with a text, where, and what to do about it.

use std::fmt;
use std::ops::Range;

use crate::suggest::nearest;

/// A range of bytes in the text that was parsed.
pub type Span = Range<usize>;

/// A problem that [`parse`](crate::parse) found; the code is `syntax`, `unknown-unit`, `too-long` or `too-deep`.
pub type SyntaxError = Issue;

/// One problem with a text. The codes this crate gives:
///
/// | code | meaning |
/// |---|---|
/// | `syntax` | the text cannot be read |
/// | `too-long`, `too-deep` | the text is beyond [`MAX_LENGTH`](crate::MAX_LENGTH) or [`MAX_DEPTH`](crate::MAX_DEPTH) |
/// | `unknown-unit` | the name after a number is not a unit |
/// | `unknown-name` | no parameter, link, drive or measure has this name |
/// | `unknown-function` | neither a built-in function nor a measure |
/// | `unit-mismatch` | the dimensions do not fit together |
/// | `wrong-arguments` | a function got too few or too many arguments |
/// | `ambiguous-name` | a name could be a unit or a declared name |
/// | `not-a-value` | a point or a line stands where a value is needed |
/// | `bad-exponent` | a power whose exponent is not a fitting constant |
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issue {
    /// A stable kebab-case code.
    pub code: &'static str,
    /// Where, in bytes of the parsed text.
    pub span: Span,
    /// One sentence without a period that says what is wrong, both sides of a mismatch named.
    pub message: String,
    /// A few words to stand under the marked text; empty where the message says it all.
    pub label: String,
    /// What to write instead.
    pub help: Option<String>,
}

/// More names than this are not listed.
const MAX_KNOWN: usize = 24;

impl Issue {
    /// An issue without label or help.
    pub fn new(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            label: String::new(),
            help: None,
        }
    }

    /// The same issue with a label.
    #[must_use]
    pub fn with_label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same issue with a line of help.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same issue, its span moved by `by` bytes: for a text that stands inside a longer one.
    #[must_use]
    pub fn shifted(mut self, by: usize) -> Self {
        self.span = self.span.start + by..self.span.end + by;
        self
    }

    /// The `unknown-name` issue, with the nearest of `known` as help; a unit's name gets its own advice.
    pub fn unknown_name<'a>(
        name: &str,
        span: Span,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let issue = Self::new("unknown-name", span, format!("unknown name `{name}`"))
            .with_label("not declared");
        if crate::unit_table::find(name).is_some() {
            return issue.with_help(format!("a unit stands after a number: write `1 {name}`"));
        }
        let known: Vec<&str> = known.into_iter().collect();
        match nearest(name, known.iter().copied()) {
            Some(near) => issue.with_help(format!("did you mean `{near}`?")),
            None if known.is_empty() => {
                issue.with_help("nothing that may stand here has a name: write a value")
            }
            None if known.len() <= MAX_KNOWN => {
                issue.with_help(format!("known here: {}", known.join(", ")))
            }
            None => issue.with_help(format!(
                "{} names are known here, none of them near this one",
                known.len()
            )),
        }
    }
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match &self.help {
            Some(help) => write!(f, " ({help})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Issue {}
