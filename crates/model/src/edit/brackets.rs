//! What stands between brackets, with its commas and comments.

use crate::edit::comments::comments_above;
use crate::ids::Span;
use crate::outline::ValueMark;

/// The places between the brackets of `holder` that go, with their commas and comments; `behind` are the values behind the
/// holder.
///
/// To an entry belong the comments on the lines right above it, and the one at the end of its line when no other entry of the
/// line stays.
pub(super) fn taken_out(
    text: &str,
    holder: &ValueMark,
    behind: &[ValueMark],
    goes: &dyn Fn(&[String]) -> bool,
) -> Vec<Span> {
    let close = holder.span.end;
    let inside = behind.iter().take_while(|v| v.whole.end <= close);
    // those that no other holds
    let mut held: Vec<(&Span, bool)> = Vec::new();
    for value in inside {
        let end = held.last().map_or(0, |(last, _)| last.end);
        if end <= value.whole.start {
            held.push((&value.whole, goes(&value.path)));
        }
    }
    let mut gone: Vec<Span> = Vec::new();
    for (i, (entry, _)) in held.iter().enumerate().filter(|(_, (_, goes))| *goes) {
        let before = held.get(..i).unwrap_or(&[]);
        let floor = before
            .last()
            .map_or(holder.span.start, |(last, _)| last.end);
        let blanks = text.get(floor..entry.start).unwrap_or("");
        let line = blanks.trim_end_matches([' ', '\t']);
        if line.ends_with('\n') {
            let line = floor + line.len();
            let start = comments_above(text, floor, line);
            gone.push(start + indent(text, start)..line + indent(text, line));
        }
        gone.push((*entry).clone());
        let comma = comma(text, entry.end..close);
        gone.extend(comma.map(|at| at..at + 1));
        if let Some(comment) = comment_behind(text, entry.end..close) {
            let line = text.get(..entry.end).and_then(|t| t.rfind('\n'));
            let on_line = |other: &&&(&Span, bool)| line.is_none_or(|line| line < other.0.end);
            if before.iter().rev().take_while(|o| on_line(&o)).all(|o| o.1) {
                gone.push(comment);
            }
        }
    }
    // the last that stays has no comma when the last of all had none
    if let Some((last, true)) = held.last()
        && comma(text, last.end..close).is_none()
        && let Some((last, _)) = held.iter().rfind(|(_, goes)| !goes)
    {
        gone.extend(comma(text, last.end..close).map(|at| at..at + 1));
    }
    tidy(text, holder.span.start + 1, close, gone)
}

/// Stretches that have but blanks between them as one, with the blanks and line ends that nothing needs without them.
fn tidy(text: &str, open: usize, close: usize, mut gone: Vec<Span>) -> Vec<Span> {
    let part = |from: usize, to: usize| text.get(from..to).unwrap_or("");
    gone.sort_by_key(|span| span.start);
    let mut joined: Vec<Span> = Vec::new();
    for span in gone {
        match joined.last_mut() {
            Some(last) if part(last.end, span.start).trim().is_empty() => {
                last.end = last.end.max(span.end);
            }
            _ => joined.push(span),
        }
    }
    for span in &mut joined {
        let before = part(open, span.start).trim_end_matches([' ', '\t']);
        let from = open + before.len();
        let to = span.end + indent(part(0, close), span.end);
        let behind = part(to, close);
        let line_end = match behind {
            _ if behind.starts_with('\n') => 1,
            _ if behind.starts_with("\r\n") => 2,
            _ => 0,
        };
        *span = match (before.ends_with('\n'), line_end) {
            (true, 1..) => from..to + line_end,
            (false, 1..) => from..to,
            _ if from < span.start || span.start == open => span.start..to,
            _ => span.clone(),
        };
    }
    joined
}

/// The comma behind a value, with blanks, lines and comments before it.
pub(super) fn comma(text: &str, behind: Span) -> Option<usize> {
    let mut at = behind.start;
    loop {
        let rest = text.get(at..behind.end)?;
        let written = rest.trim_start();
        at += rest.len() - written.len();
        match written.as_bytes().first()? {
            b',' => return Some(at),
            b'#' => at += written.find('\n')?,
            _ => return None,
        }
    }
}

/// The comment behind a value on its line.
fn comment_behind(text: &str, behind: Span) -> Option<Span> {
    let rest = text.get(behind.clone())?;
    let comment = rest.trim_start_matches([' ', '\t', ',']);
    let start = behind.start + rest.len() - comment.len();
    let line = comment.lines().next().filter(|c| c.starts_with('#'))?;
    Some(start..start + line.len())
}

/// How many blanks stand at a place.
fn indent(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or("");
    rest.len() - rest.trim_start_matches([' ', '\t']).len()
}
