//! Taking entries and sections out of a text, with the comments that belong to them.

use std::collections::BTreeSet;

use crate::edit::brackets::taken_out;
use crate::edit::comments::{comments_above, is_blank, is_comment};
use crate::ids::Span;
use crate::outline::{Header, Outline, Shape};
use crate::text_edit::TextEdit;

/// The edits that take out what stands at the paths: whole lines of entries and sections, and what stands between brackets
/// with its commas. The comments right above what goes go with it; those with an empty line between stay.
pub(super) fn removals(
    text: &str,
    outline: &Outline,
    paths: &BTreeSet<Vec<String>>,
) -> Vec<TextEdit> {
    let goes = |path: &[String]| within(paths, path);
    let lines = Lines::new(text, outline);
    let headers = outline.headers.iter().enumerate();
    let mut spans: Vec<Span> = headers
        .filter(|(_, header)| goes(&header.path))
        .map(|(i, header)| lines.section(header, outline.headers.get(i + 1)))
        .collect();
    for (index, span) in &outline.statements {
        let statement = outline.values.get(*index);
        let before = (outline.headers).partition_point(|h| h.span.start < span.start);
        let header = before.checked_sub(1).and_then(|i| outline.headers.get(i));
        // what stands under a header that goes has gone
        let gone = header.is_some_and(|h| goes(&h.path));
        if !gone && statement.is_some_and(|v| goes(&v.path)) {
            spans.push(lines.above(span.start)..span.end);
        }
    }
    for (i, holder) in outline.values.iter().enumerate() {
        let held = outline.values.get(i + 1..).unwrap_or(&[]);
        if matches!(holder.shape, Shape::Array | Shape::Table) && !goes(&holder.path) {
            spans.extend(taken_out(text, holder, held, &goes));
        }
    }
    spans.sort_by_key(|s| s.start);
    spans
        .into_iter()
        .map(|span| TextEdit::new(span, ""))
        .collect()
}

/// Whether a path or one above it is among the paths.
pub(super) fn within(paths: &BTreeSet<Vec<String>>, path: &[String]) -> bool {
    (1..=path.len()).any(|n| path.get(..n).is_some_and(|p| paths.contains(p)))
}

/// A text by its lines.
struct Lines<'t> {
    text: &'t str,
    /// Those of entries and headers, in their order.
    written: Vec<Span>,
}

impl<'t> Lines<'t> {
    fn new(text: &'t str, outline: &Outline) -> Self {
        let of_header = |h: &Header| {
            let rest = text.get(h.span.clone()).unwrap_or("");
            let line = rest.find('\n').map_or(rest.len(), |i| i + 1);
            h.span.start..h.span.start + line
        };
        let headers = outline.headers.iter().map(of_header);
        let entries = outline.statements.iter().map(|(_, lines)| lines.clone());
        let mut written: Vec<Span> = headers.chain(entries).collect();
        written.sort_by_key(|lines| lines.start);
        Self { text, written }
    }

    /// Where the comments begin that belong to the entry or header of a line.
    fn above(&self, line: usize) -> usize {
        let before = self.written.partition_point(|lines| lines.start < line);
        let before = before.checked_sub(1).and_then(|i| self.written.get(i));
        comments_above(self.text, before.map_or(0, |lines| lines.end), line)
    }

    /// The lines of a section: those behind it with an empty line between stay, and the comments of the next header.
    fn section(&self, header: &Header, next: Option<&Header>) -> Span {
        let limit = next.map_or(self.text.len(), |next| self.above(next.span.start));
        let start = self.above(header.span.start);
        let last = self.written.partition_point(|l| l.start < header.span.end);
        let last = last.checked_sub(1).and_then(|i| self.written.get(i));
        let mut end = last.map_or(header.span.end, |lines| lines.end);
        let lines_from = |from: usize| {
            let rest = self.text.get(from..limit).unwrap_or("");
            rest.split_inclusive('\n').scan(from, |at, line| {
                *at += line.len();
                Some((*at, line))
            })
        };
        // what is no entry goes too
        let other = lines_from(end).filter(|(_, line)| !is_blank(line) && !is_comment(line));
        end = other.last().map_or(end, |(at, _)| at);
        let below = lines_from(end).take_while(|(_, line)| is_comment(line));
        end = below.last().map_or(end, |(at, _)| at);
        // one gap is left of two
        let before = self.text.get(..start).unwrap_or("");
        let gap = before.is_empty() || before.lines().next_back().is_some_and(is_blank);
        if gap {
            let blank = lines_from(end).take_while(|(_, line)| is_blank(line));
            end = blank.last().map_or(end, |(at, _)| at);
        }
        start..end
    }
}
