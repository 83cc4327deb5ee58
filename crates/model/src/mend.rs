//! What can be read of a file of which a part is not TOML or is misnamed, and what must not be said of the rest.
//!
//! A bracket that is not closed swallows the lines behind it. Where a line shows that a new entry or section begins, the entry before
//! it is set aside, and the rest of the file is read without it.

use std::collections::BTreeSet;

use crate::diagnostic::{Diagnostic, line_at};
use crate::ids::Span;

/// Something that is opened and not closed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unclosed {
    /// Where it is opened.
    pub at: Span,
    /// The lines of the entry that it is in.
    pub lines: Span,
}

/// Entries with a bracket or a string that is not closed, in the order of the file. Only for a text that is not TOML: rules of thumb
/// tell where the entry ends.
pub(crate) fn unclosed(text: &str) -> Vec<Unclosed> {
    let mut found = Vec::new();
    // open brackets, and the last sign that is not blank
    let mut open: Vec<(u8, usize)> = Vec::new();
    let mut last = b' ';
    let mut many_lines: Option<&str> = None;
    let mut start = 0;
    let mut behind = 0;
    for line in text.split_inclusive('\n') {
        if start < behind {
            // the rest of an entry that is set aside
            start += line.len();
            continue;
        }
        let entry = |open: &[(u8, usize)]| {
            open.first().map_or(start, |(_, at)| {
                text[..*at].rfind('\n').map_or(0, |i| i + 1)
            })
        };
        if let Some((bracket, at)) = open.last().copied()
            && many_lines.is_none()
            && begins_anew(line, bracket, last)
        {
            let lines = entry(&open)..start;
            found.push(Unclosed {
                at: at..at + 1,
                lines,
            });
            open.clear();
        }
        let mut at = 0;
        while let Some(sign) = line.as_bytes().get(at).copied() {
            if let Some(quotes) = many_lines {
                match line[at..].find(quotes) {
                    Some(end) => {
                        at += end + 3;
                        many_lines = None;
                        last = b'"';
                        continue;
                    }
                    None => break,
                }
            }
            match sign {
                b'#' => break,
                b'"' | b'\'' => {
                    let quotes = if sign == b'"' { "\"\"\"" } else { "'''" };
                    if line[at..].starts_with(quotes) {
                        many_lines = Some(quotes);
                        at += 3;
                        continue;
                    }
                    match closing_quote(&line.as_bytes()[at + 1..], sign) {
                        Some(length) => at += length + 1,
                        None => {
                            let lines = entry(&open)..next_entry(text, start + line.len());
                            let at = start + at;
                            behind = lines.end;
                            found.push(Unclosed {
                                at: at..at + 1,
                                lines,
                            });
                            open.clear();
                            last = b' ';
                            break;
                        }
                    }
                }
                b'[' | b'{' => open.push((sign, start + at)),
                b']' | b'}' => {
                    let fits = |bracket: u8| (bracket == b'[') == (sign == b']');
                    match open.last().copied() {
                        Some((bracket, opened)) if !fits(bracket) => {
                            let lines = entry(&open)..next_entry(text, start + line.len());
                            behind = lines.end;
                            found.push(Unclosed {
                                at: opened..opened + 1,
                                lines,
                            });
                            open.clear();
                            last = b' ';
                            break;
                        }
                        _ => open.pop(),
                    };
                }
                _ => {}
            }
            if !sign.is_ascii_whitespace() {
                last = sign;
            }
            at += 1;
        }
        start += line.len();
    }
    if let (Some((_, at)), Some((_, first)), None) = (open.last(), open.first(), many_lines) {
        let lines = text[..*first].rfind('\n').map_or(0, |i| i + 1)..text.len();
        found.push(Unclosed {
            at: *at..at + 1,
            lines,
        });
    }
    found
}

/// Bytes up to and with the quote that closes a string of one line, behind the one that opens it.
fn closing_quote(rest: &[u8], quote: u8) -> Option<usize> {
    let mut at = 0;
    while let Some(sign) = rest.get(at).copied() {
        match sign {
            b'\n' => return None,
            b'\\' if quote == b'"' => at += 1,
            _ if sign == quote => return Some(at),
            _ => {}
        }
        at += 1;
    }
    None
}

/// Where the next entry or section begins, at this line or behind it: the lines up to there go on with one that is broken.
pub(crate) fn next_entry(text: &str, mut at: usize) -> usize {
    for line in text.get(at..).unwrap_or("").split_inclusive('\n') {
        if begins_anew(line, b'[', b' ') {
            break;
        }
        at += line.len();
    }
    at
}

/// Where the entry begins that a line goes on with: a line that is indented and begins nothing itself.
fn entry_of(text: &str, mut at: usize) -> usize {
    let start = at;
    loop {
        let line = text.get(at..).and_then(|rest| rest.lines().next());
        let line = line.unwrap_or("");
        if begins_anew(line, b'[', b' ') {
            return at;
        }
        if at == 0 || !(line.starts_with([' ', '\t']) || line.is_empty()) {
            return start;
        }
        at = text[..at - 1].rfind('\n').map_or(0, |i| i + 1);
    }
}

/// Whether a line within a bracket can only be a new section or entry; `last` is the sign before it.
pub(crate) fn begins_anew(line: &str, bracket: u8, last: u8) -> bool {
    let line = line.trim();
    if is_header(line) {
        return true;
    }
    let Some((key, _)) = line.split_once('=') else {
        return false;
    };
    let key = key.trim();
    let is_key = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_alphanumeric() || "_-. ".contains(c));
    // arrays hold no entries; tables do, behind a comma
    is_key && (bracket == b'[' || !matches!(last, b',' | b'{'))
}

/// Whether a line is `[links]` or `[studies.turn]`.
fn is_header(line: &str) -> bool {
    let Some(rest) = line.strip_prefix('[') else {
        return false;
    };
    let Some((name, rest)) = rest.split_once(']') else {
        return false;
    };
    let rest = rest.trim_start();
    let words = ["true", "false", "inf", "nan"];
    (rest.is_empty() || rest.starts_with('#'))
        && name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && !words.contains(&name)
        && name
            .chars()
            .all(|c| c.is_alphanumeric() || "_-. ".contains(c))
}

/// The text without these entries: blanks stand in their place, so that every other byte keeps its own.
pub(crate) fn without<'a>(text: &str, entries: impl IntoIterator<Item = &'a Span>) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for lines in entries {
        for byte in bytes.get_mut(lines.clone()).into_iter().flatten() {
            if !matches!(byte, b'\n' | b'\r') {
                *byte = b' ';
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_default()
}

/// The parts of a file that could not be read, or not as what they are meant to be.
#[derive(Clone, Debug, Default)]
pub(crate) struct Broken {
    /// Whole lines.
    lines: Vec<Span>,
    /// Tables of their own, `[studies.turn]`, with a broken line; any of their keys may be missing for it.
    tables: Vec<Span>,
    /// Names that stand on broken lines.
    words: BTreeSet<String>,
    /// The line of a section's name is broken: what follows stands in no section, or in another one.
    header: bool,
    /// Names that are told to be wrong where they are declared.
    misnamed: BTreeSet<String>,
    /// A section is misspelt, so that all it says is lost.
    section: bool,
    /// No link stands for the frame, so that its points are lost.
    frame: bool,
    /// A link has not the points that it should have.
    points: bool,
}

impl Broken {
    /// Sets lines aside, with those behind them that go on with the same entry; answers which.
    pub fn add(&mut self, text: &str, lines: Span) -> Span {
        let start = text
            .get(..lines.start)
            .map_or(0, |before| before.rfind('\n').map_or(0, |i| i + 1));
        let whole = lines.end > start && text.as_bytes().get(lines.end - 1) == Some(&b'\n');
        let line_end = || {
            let rest = text.get(lines.end..).and_then(|rest| rest.find('\n'));
            rest.map_or(text.len(), |i| lines.end + i + 1)
        };
        let start = entry_of(text, start);
        let end = next_entry(text, if whole { lines.end } else { line_end() });
        let here = text.get(start..end).unwrap_or("");
        self.words.extend(words(here).map(str::to_owned));
        let first = here.lines().next().unwrap_or("");
        let first = first.split('#').next().unwrap_or("").trim();
        self.header |= (first.starts_with('[') || first.ends_with(']')) && !first.contains('=');
        self.lines.push(start..end);
        let (mut at, mut header, mut next) = (0, None, text.len());
        for line in text.split_inclusive('\n') {
            if is_header(line.trim()) {
                if at > start {
                    next = at;
                    break;
                }
                header = Some((at, line.trim().trim_start_matches('[')));
            }
            at += line.len();
        }
        if let Some((at, name)) = header
            && name.split(']').next().unwrap_or("").contains('.')
        {
            self.tables.push(at..next);
        }
        start..end
    }

    /// What is set aside.
    pub fn lines(&self) -> &[Span] {
        &self.lines
    }

    /// Whether it is not sure in which section an entry stands.
    pub fn in_doubt(&self) -> bool {
        self.header
    }

    /// More is broken than is set aside here: nothing is sure that may follow from it.
    pub fn beyond_telling(&mut self) {
        self.header = true;
    }

    /// A name is wrong where it is declared: those who use it as it is are not wrong besides.
    pub fn misname(&mut self, name: &str) {
        self.misnamed.extend(words(name).map(str::to_owned));
    }

    /// A section with these names is skipped for its own.
    pub fn skip_section<'n>(&mut self, names: impl Iterator<Item = &'n str>) {
        self.section = true;
        self.words.extend(names.flat_map(words).map(str::to_owned));
    }

    /// No link stands for the frame.
    pub fn lose_frame(&mut self) {
        self.frame = true;
    }

    /// The points of a link could not be placed.
    pub fn lose_points(&mut self) {
        self.points = true;
    }

    /// Whether lines could not be read.
    pub fn has_lines(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Whether a byte stands on a line that could not be read.
    pub fn holds(&self, at: usize) -> bool {
        self.lines.iter().any(|lines| lines.contains(&at))
    }

    /// Whether something said of the rest may be true only because of what could not be read. In doubt it may: the reader tells it
    /// again, if it is true, once the file is TOML.
    pub fn may_cause(&self, d: &Diagnostic, text: &str) -> bool {
        let at = d.start();
        if at < text.len() && self.holds(at) {
            return true;
        }
        if OF_A_TEXT.contains(&d.code) {
            return false;
        }
        if OF_NAMES.contains(&d.code) && self.mention(&self.misnamed, d, text) {
            return true;
        }
        if (self.frame || self.points) && OF_POINTS.contains(&d.code)
            || self.frame && d.message.starts_with("there is no point `")
        {
            return true;
        }
        if self.lines.is_empty() && !self.section {
            return false;
        }
        let in_table = || self.tables.iter().any(|t| t.contains(&at));
        self.header
            || match d.code {
                code if OF_AN_ENTRY.contains(&code) => false,
                code if OF_A_TABLE.contains(&code) => in_table(),
                code if OF_NAMES.contains(&code) => {
                    in_table() || self.mention(&self.words, d, text)
                }
                _ => true,
            }
    }

    /// Whether a diagnostic names one of some words.
    fn mention(&self, some: &BTreeSet<String>, d: &Diagnostic, text: &str) -> bool {
        let places = d.labels.iter().filter(|l| l.source.is_none());
        let marked = places.filter_map(|l| text.get(l.span.clone()));
        marked
            .chain([d.message.as_str()])
            .flat_map(words)
            .any(|word| some.contains(word))
    }
}

/// The names in a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    text.split(move |c| !is_name(c)).filter(|w| !w.is_empty())
}

/// Codes of what is wrong with a text by itself, whatever stands around it.
const OF_A_TEXT: &[&str] = &[
    "bad-exponent",
    "syntax",
    "too-deep",
    "too-long",
    "unknown-function",
    "unknown-unit",
];

/// Codes of what is wrong with an entry by itself, where its section is sure.
const OF_AN_ENTRY: &[&str] = &[
    "bad-choice",
    "bad-name",
    "bad-size",
    "duplicate-name",
    "unit-mismatch",
    "unknown-key",
    "unknown-study",
    "wrong-arguments",
    "wrong-type",
];

/// Codes of what is wrong with the entries of one table together.
const OF_A_TABLE: &[&str] = &["empty-link", "not-placed", "side-missing"];

/// Codes of what names something, and so may miss what stands on a broken line.
const OF_NAMES: &[&str] = &["not-a-value", "unknown-name"];

/// Codes of what is said of points and of the links that carry them, where names are right.
const OF_POINTS: &[&str] = &[
    "ambiguous-transmission",
    "loose-link",
    "no-common-link",
    "no-common-point",
    "not-a-pin",
    "not-a-slider",
    "point-not-on-link",
    "same-link",
];

/// The error of what is not closed.
pub(crate) fn tell(unclosed: &Unclosed, text: &str) -> Diagnostic {
    let sign = text.get(unclosed.at.clone()).unwrap_or("");
    let (what, close) = match sign {
        "[" => ("bracket", "]"),
        "{" => ("bracket", "}"),
        quote => ("string", quote),
    };
    let line = line_at(text, unclosed.at.start).number;
    let end = unclosed.lines.end.saturating_sub(1).max(unclosed.at.start);
    let last = line_at(text, end).number;
    let place = match last > line {
        true => format!("; nothing up to line {last} does"),
        false => String::new(),
    };
    Diagnostic::error(
        "toml-syntax",
        format!("not TOML: this {what} is not closed"),
    )
    .at(unclosed.at.clone(), format!("opened here{place}"))
    .help(format!("close it with `{close}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(text: &str) -> Vec<(&str, &str)> {
        let found = unclosed(text);
        let marked = found
            .iter()
            .map(|u| (&text[u.at.clone()], &text[u.lines.clone()]));
        marked.collect()
    }

    #[test]
    fn an_entry_ends_where_another_begins() {
        let text = "a = { b = 1, c = [2, 3\nd = 4\n";
        assert_eq!(marked(text), [("[", "a = { b = 1, c = [2, 3\n")]);
        let text = "[links]\na = { b = 1\n[drives]\nc = 2\n";
        assert_eq!(marked(text), [("{", "a = { b = 1\n")]);
        assert_eq!(marked("a = [1,\n2\n"), [("[", "a = [1,\n2\n")]);
        let text = "a = { b = [0, 0 }\nc = 1\n";
        assert_eq!(marked(text), [("[", "a = { b = [0, 0 }\n")]);
        let text = "a = { b = \"20 }\nc = \"x\"\n";
        assert_eq!(marked(text), [("\"", "a = { b = \"20 }\n")]);
    }

    #[test]
    fn what_is_closed_is_left_alone() {
        for text in [
            "a = [\n  [1, 2],\n  [3],\n]\n",
            "a = {\n  b = 1,\n  c = 2 # [x\n}\n[links]\n",
            "a = \"\"\"\n[x]\nb = \"[\n\"\"\"\n",
            "a = [\n  \"b = c\",\n  { d = 1 },\n]\n",
            "a = '[\\'\nb = \"\\\"[\"\n",
            "a = { b = [ { c = 1 },\n { d = 2 } ] }\n",
        ] {
            assert_eq!(marked(text), [], "{text}");
        }
    }

    #[test]
    fn hostile_texts_are_walked_once() {
        let text = "[".repeat(100_000) + &"\na = {".repeat(1000) + "\"ä\n'";
        assert!(!unclosed(&text).is_empty());
        let open = unclosed(&text);
        assert_eq!(
            without(&text, open.iter().map(|u| &u.lines)).len(),
            text.len()
        );
    }
}
