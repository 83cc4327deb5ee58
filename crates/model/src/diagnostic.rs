//! What the reader has to say about a model file: data, not text.
//!
//! The command line renders diagnostics in colour, the Studio underlines them in its editor and Python raises them as
//! exceptions; [`Diagnostic::render_plain`] is the plain form that all of them may fall back on.

use serde::Serialize;

use kempe_units::Issue;

use crate::codes::known;
use crate::ids::Span;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Severity {
    /// Something a careful engineer would want to be told; the model stands.
    Warning,
    /// There is no model.
    Error,
}

/// Something to say about a model file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// Stable kebab-case code, one of [`CODES`](crate::CODES) or [`LATER_CODES`](crate::LATER_CODES).
    pub code: &'static str,
    /// What is wrong, in one short sentence.
    pub message: String,
    /// Where; the primary label first.
    pub labels: Vec<Label>,
    /// What to do about it.
    pub help: Option<String>,
    /// Further facts.
    pub notes: Vec<String>,
}

/// A place with a word about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Label {
    /// Bytes of the model file, or of `source` when that is given.
    pub span: Span,
    /// What is to be seen there; may be empty.
    pub text: String,
    /// Whether the trouble is here, or this place only explains it.
    pub primary: bool,
    /// The text the span counts in when it is not the model file, such as a value given on the command line.
    pub source: Option<Source>,
}

/// A text other than the model file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Source {
    /// What it is called, such as `--set a`.
    pub name: String,
    /// What it says.
    pub text: String,
}

impl Diagnostic {
    /// What is wrong with an expression that stands in no file: a text by a name of its own.
    pub fn of_issue(issue: Issue, name: &str, text: &str) -> Self {
        let mut it = Self::error(issue.code, issue.message).maybe_help(issue.help);
        it.labels.push(Label {
            span: issue.span,
            text: issue.label,
            primary: true,
            source: Some(Source {
                name: name.to_owned(),
                text: text.to_owned(),
            }),
        });
        it
    }

    /// The same, weighed otherwise: what is an error for one who asks may be a warning for another.
    pub fn with_severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// An error without a place.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        debug_assert!(
            known(code),
            "`{code}` stands in no list of codes: see codes.rs"
        );
        Self {
            severity: Severity::Error,
            code,
            message: message.into(),
            labels: Vec::new(),
            help: None,
            notes: Vec::new(),
        }
    }

    /// A warning without a place.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(code, message)
        }
    }

    /// With the place of the trouble.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            span,
            text: text.into(),
            primary: true,
            source: None,
        });
        self
    }

    /// With a place that explains it.
    #[must_use]
    pub fn see(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            span,
            text: text.into(),
            primary: false,
            source: None,
        });
        self
    }

    /// With what to do about it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// With what to do about it, if that is known.
    #[must_use]
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    /// With a further fact.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The same without texts that no reader wants to see whole: what a file says may be megabytes long, or not show at all.
    #[must_use]
    pub(crate) fn tamed(mut self) -> Self {
        tame(&mut self.message);
        self.labels.iter_mut().for_each(|l| tame(&mut l.text));
        self.help.iter_mut().for_each(tame);
        self.notes.iter_mut().for_each(tame);
        self
    }

    /// Where the trouble is: the first primary label's start, for sorting.
    pub fn start(&self) -> usize {
        let primary = self
            .labels
            .iter()
            .find(|l| l.primary)
            .or(self.labels.first());
        primary.map_or(usize::MAX, |l| {
            if l.source.is_some() {
                usize::MAX
            } else {
                l.span.start
            }
        })
    }

    /// The diagnostic as plain text over the file `file_name` with the content `text`.
    ///
    /// ```text
    /// error[unit-mismatch]: length expected, found an angle
    ///   ┌ hitch.toml:9:25
    /// 9 │ arm = { C-B = 0.2, D = ["8 deg", "0.3 m"] }
    ///   │                         ^^^^^^^ this is an angle
    ///   = help: polar coordinates are [radius, angle]: write D = ["0.3 m", "8 deg"]
    /// ```
    pub fn render_plain(&self, file_name: &str, text: &str) -> String {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let mut out = format!("{severity}[{}]: {}\n", self.code, self.message);
        let width = self
            .labels
            .iter()
            .map(|l| line_of(l, text).number.to_string().len())
            .max()
            .unwrap_or(1);
        let pad = " ".repeat(width);
        // labels of one source in file order, the primary label's source first
        let mut labels: Vec<&Label> = self.labels.iter().collect();
        labels.sort_by_key(|l| (l.source.is_some(), l.span.start));
        let head = self
            .labels
            .iter()
            .find(|l| l.primary)
            .or(self.labels.first());
        let mut skip = 0;
        let mut shown: Option<(Option<&Source>, usize)> = None;
        for label in labels {
            let line = line_of(label, text);
            let name = label.source.as_ref().map_or(file_name, |s| s.name.as_str());
            if shown.is_none() || shown.map(|s| s.0) != Some(label.source.as_ref()) {
                let top = head.filter(|h| h.source == label.source).unwrap_or(label);
                let top_line = line_of(top, text);
                out += &format!("{pad} ┌ {name}:{}:{}\n", top_line.number, top_line.column);
            }
            let source = label.source.as_ref().map_or(text, |s| s.text.as_str());
            if shown != Some((label.source.as_ref(), line.number)) {
                skip = if line.content.chars().count() > WIDE {
                    line.column.saturating_sub(WIDE / 2)
                } else {
                    0
                };
                let shown: String = line.content.chars().skip(skip).take(WIDE).collect();
                let dots = if skip > 0 { "…" } else { "" };
                out += &format!(
                    "{:>width$} │ {dots}{}\n",
                    line.number,
                    shown.replace('\t', " ")
                );
            }
            shown = Some((label.source.as_ref(), line.number));
            let mark = if label.primary { "^" } else { "-" };
            let end = label.span.end.min(line.end).max(label.span.start);
            let count = source
                .get(label.span.start..end)
                .map_or(1, |s| s.chars().count())
                .clamp(1, WIDE / 2);
            let before = (line.column - 1).saturating_sub(skip) + usize::from(skip > 0);
            let caret = format!(
                "{}{} {}",
                " ".repeat(before),
                mark.repeat(count),
                label.text
            );
            out += &format!("{pad} │ {}\n", caret.trim_end());
        }
        for note in &self.notes {
            out += &format!("{pad} = note: {note}\n");
        }
        if let Some(help) = &self.help {
            out += &format!("{pad} = help: {help}\n");
        }
        out
    }
}

/// What is quoted of a file in a sentence has at most so many characters.
const LONGEST_QUOTE: usize = 80;

/// A sentence has at most so many characters: beyond what a dozen names of the longest kind need.
const LONGEST_SENTENCE: usize = 1000;

/// Shortens words of more than [`LONGEST_QUOTE`] characters and a text of more than [`LONGEST_SENTENCE`], and makes signs visible that
/// do not show.
fn tame(text: &mut String) {
    let shows = |c: char| !c.is_control();
    let mut longest = 0;
    let mut run = 0;
    for c in text.chars() {
        run = if c.is_whitespace() { 0 } else { run + 1 };
        longest = longest.max(run);
    }
    let short = longest <= LONGEST_QUOTE && text.len() <= LONGEST_SENTENCE;
    if short && text.chars().all(shows) {
        return;
    }
    let mut out = String::new();
    let (mut run, mut length) = (0, 0);
    for c in text.chars() {
        run = if c.is_whitespace() { 0 } else { run + 1 };
        if length >= LONGEST_SENTENCE {
            out.push('…');
            break;
        }
        // a cut word keeps the quote that closes it
        if run > LONGEST_QUOTE && c != '`' {
            if run == LONGEST_QUOTE + 1 {
                out.push('…');
            }
            continue;
        }
        if shows(c) {
            out.push(c);
            length += 1;
        } else {
            let escaped = c.escape_debug().to_string();
            length += escaped.len();
            run += escaped.len() - 1;
            out.push_str(&escaped);
        }
    }
    *text = out;
}

/// A line with more characters than this is shown in part.
const WIDE: usize = 140;

/// The line of a label, in the file or in the text the label is about.
fn line_of<'a>(label: &'a Label, text: &'a str) -> LinePlace<'a> {
    line_at(
        label.source.as_ref().map_or(text, |s| s.text.as_str()),
        label.span.start,
    )
}

/// A line of a text, with the place of a byte in it.
pub(crate) struct LinePlace<'a> {
    /// Counted from 1.
    pub number: usize,
    /// Character of the line, counted from 1.
    pub column: usize,
    /// The line without its end.
    pub content: &'a str,
    /// Byte of the text where the line ends.
    pub end: usize,
}

/// The line that holds the byte `offset`; offsets past the end count as the end.
pub(crate) fn line_at(text: &str, offset: usize) -> LinePlace<'_> {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &text[..offset];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let end = text[offset..].find('\n').map_or(text.len(), |i| offset + i);
    let content = text[start..end].trim_end_matches('\r');
    LinePlace {
        number: before.bytes().filter(|b| *b == b'\n').count() + 1,
        column: text[start..offset].chars().count() + 1,
        content,
        end: start + content.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_text_has_place_caret_and_help() {
        let text = "[links]\narm = { D = [\"8 deg\", \"0.3 m\"] }\n";
        let start = text.find("\"8").expect("there");
        let d = Diagnostic::error("unit-mismatch", "length expected, found an angle")
            .at(start..start + 7, "this is an angle")
            .help("swap them");
        assert_eq!(
            d.render_plain("hitch.toml", text),
            "error[unit-mismatch]: length expected, found an angle\n  ┌ hitch.toml:2:14\n2 │ arm = { D = [\"8 deg\", \
             \"0.3 m\"] }\n  │              ^^^^^^^ this is an angle\n  = help: swap them\n"
        );
    }

    #[test]
    fn what_is_quoted_is_short_and_shows() {
        let long = format!("there is no link `{}` here", "x".repeat(300));
        let d = Diagnostic::error("unknown-name", long)
            .help(format!("its columns are {}", "\0".repeat(3_000_000)))
            .note("short `a b`")
            .tamed();
        assert_eq!(
            d.message,
            format!("there is no link `{}…` here", "x".repeat(79))
        );
        let help = d.help.expect("there");
        assert!(
            help.starts_with("its columns are \\0\\0") && help.chars().count() < 200,
            "{help}"
        );
        assert_eq!(d.notes, ["short `a b`"]);
    }

    #[test]
    fn places_beyond_the_end_and_inside_characters_are_harmless() {
        let d = Diagnostic::error("toml-syntax", "x")
            .at(1..900, "")
            .see(77..78, "end");
        assert!(d.render_plain("f", "é\r\nz").contains("f:1:1"));
        assert!(d.render_plain("f", "").contains("f:1:1"));
    }
}
