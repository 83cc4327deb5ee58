//! Where an entry goes that a table has not yet.

use crate::edit::brackets::comma;
use crate::ids::Span;
use crate::item::key;
use crate::outline::{Header, Outline};
use crate::text_edit::TextEdit;

/// A table of a text, however it is written.
#[derive(Clone, Debug, Default)]
pub(super) struct Place {
    /// Names down to it, without the places in arrays of tables.
    pub names: Vec<String>,
    /// The bytes that the reader gives for it.
    pub span: Span,
    /// The innermost table between braces on the way, itself included: how many names lead to it, and its bytes.
    pub braces: Option<(usize, Span)>,
}

/// The edit that enters `name = new` in a table of a text that is TOML.
pub(super) fn entry(text: &str, place: &Place, name: &str, new: &str) -> TextEdit {
    let outline = Outline::new(text);
    let names = &place.names;
    // what is written from `depth` names on
    let from = |depth: usize| {
        let above = names.iter().skip(depth).map(|name| key(name) + ".");
        format!("{}{} = {new}", above.collect::<String>(), key(name))
    };
    if let Some((depth, braces)) = &place.braces {
        return in_braces(text, &outline, braces, &from(*depth));
    }
    let of_its_own = |h: &&Header| h.path == *names;
    let headers = outline.headers.iter().filter(of_its_own);
    // of an array of tables each has one
    let header = (headers.clone().find(|h| h.span.contains(&place.span.start)))
        .or_else(|| headers.clone().next());
    if let Some(header) = header {
        let mut last = outline.statements.iter().map(|(_, lines)| lines);
        let last = last.rfind(|lines| header.span.contains(&lines.start));
        let at = last.map_or_else(|| line_end(text, header.span.start), |lines| lines.end);
        return line(text, at, &from(names.len()));
    }
    if names.is_empty() {
        let first = outline.headers.first().map_or(text.len(), |h| h.span.start);
        let mut last = outline.statements.iter().map(|(_, lines)| lines);
        let last = last.rfind(|lines| lines.start < first);
        return line(text, last.map_or(0, |lines| lines.end), &from(0));
    }
    // a table of dotted keys has the new one beside them
    let beside = outline.statements.iter().rev().find_map(|(index, lines)| {
        let path = &outline.values.get(*index)?.path;
        let before = outline.headers.iter().rev();
        let mut before = before.skip_while(|h| h.span.start > lines.start);
        let depth = before.next().map_or(0, |h| h.path.len());
        let within = path.len() > names.len() && path.starts_with(names);
        (within && depth < names.len()).then_some((depth, lines.end))
    });
    match beside {
        Some((depth, at)) => line(text, at, &from(depth)),
        None => section(text, names, &from(names.len())),
    }
}

/// The edit that makes a section with an entry at the end of the text.
pub(super) fn section(text: &str, names: &[String], entry: &str) -> TextEdit {
    let ending = ending(text);
    let gap = match (text.is_empty(), text.ends_with('\n')) {
        (true, _) => String::new(),
        (false, true) => ending.to_owned(),
        (false, false) => ending.repeat(2),
    };
    let names: Vec<String> = names.iter().map(|name| key(name)).collect();
    let header = names.join(".");
    let lines = format!("{gap}[{header}]{ending}{entry}{ending}");
    TextEdit::new(text.len()..text.len(), lines)
}

/// The edit that puts an entry on a line of its own at a place between lines, or at the end.
fn line(text: &str, at: usize, entry: &str) -> TextEdit {
    let ending = ending(text);
    let mark = '\u{feff}';
    let at = match text.starts_with(mark) {
        true => at.max(mark.len_utf8()),
        false => at,
    };
    let before = text.get(..at).unwrap_or("");
    let open = !before.is_empty() && !before.ends_with(['\n', mark]);
    let gap = if open { ending } else { "" };
    TextEdit::new(at..at, format!("{gap}{entry}{ending}"))
}

/// The edit that puts an entry behind the last one of the braces.
fn in_braces(text: &str, outline: &Outline, braces: &Span, entry: &str) -> TextEdit {
    let inside = outline.values.iter();
    let inside = inside.filter(|v| braces.start < v.span.start && v.whole.end < braces.end);
    let Some(last) = inside.map(|v| v.whole.end).max() else {
        let at = braces.start + 1;
        let closes = text.get(at..).is_some_and(|rest| rest.starts_with('}'));
        let blank = if closes { " " } else { "" };
        return TextEdit::new(at..at, format!(" {entry}{blank}"));
    };
    let comma = comma(text, last..braces.end);
    let behind = comma.map_or(last, |comma| comma + 1);
    let rest = text.get(behind..braces.end).unwrap_or("");
    let Some(line) = rest.lines().next().filter(|line| line.len() < rest.len()) else {
        let comma = if comma.is_some() { "" } else { "," };
        return TextEdit::new(behind..behind, format!("{comma} {entry}"));
    };
    // on a line of its own, so that a comment stays with the entry before
    let start = text.get(..last).and_then(|before| before.rfind('\n'));
    let start = text.get(start.map_or(0, |i| i + 1)..).unwrap_or("");
    let blanks = start.len() - start.trim_start_matches([' ', '\t']).len();
    let indent = start.get(..blanks).unwrap_or("");
    let ending = ending(text);
    let end = behind + line.len();
    match comma {
        Some(_) => TextEdit::new(end..end, format!("{ending}{indent}{entry},")),
        None => TextEdit::new(last..end, format!(",{line}{ending}{indent}{entry}")),
    }
}

/// The byte behind a line.
fn line_end(text: &str, from: usize) -> usize {
    let rest = text.get(from..).unwrap_or("");
    rest.find('\n').map_or(text.len(), |i| from + i + 1)
}

fn ending(text: &str) -> &'static str {
    match text.contains("\r\n") {
        true => "\r\n",
        false => "\n",
    }
}
