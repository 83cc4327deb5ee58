//! What may stand at a place of a text that somebody is typing.

mod cursor;
mod keys;
mod values;

pub use cursor::{Completion, CompletionKind};

use crate::outline::{Outline, Shape};
use cursor::{Cursor, Known};

/// What may stand at a byte of a text: sections, keys of an entry, names of parts, measures, functions, units, words.
///
/// All that may stand there is given, in the order of the language and the text, whatever has been typed of it: an editor
/// filters by what stands before the cursor. The text may have errors, on the cursor's line too.
///
/// # Example
///
/// ```
/// use kempe_model::complete;
/// let text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 20 }\n[joints]\n[measures]\nh = \"2 * y(";
/// let labels: Vec<String> = complete(text, text.len()).into_iter().map(|c| c.label).collect();
/// assert_eq!(labels, ["A", "B"]);
/// let keys = complete("[springs]\nback = { between = \"A-B\", st", 36);
/// assert!(keys.iter().any(|c| c.label == "stiffness"));
/// assert!(keys.iter().all(|c| c.label != "between"));
/// ```
pub fn complete(text: &str, offset: usize) -> Vec<Completion> {
    let offset = text.floor_char_boundary(offset.min(text.len()));
    let outline = Outline::new(text);
    let cursor = Cursor {
        text,
        offset,
        outline: &outline,
        known: Known::new(text, &outline),
    };
    at_cursor(&cursor)
}

fn at_cursor(cursor: &Cursor<'_>) -> Vec<Completion> {
    let line_start = cursor.before().rfind('\n').map_or(0, |i| i + 1);
    let line = cursor.text.get(line_start..cursor.offset).unwrap_or("");
    let holder = cursor.holder();
    if let Some(value) = cursor.string() {
        return cursor.in_string(value);
    }
    // a comment says nothing
    if line.contains('#') {
        return Vec::new();
    }
    if let Some(holder) = holder {
        let since = cursor.since_comma(holder);
        return match (holder.shape, since.contains('=')) {
            (Shape::Table, false) => {
                let written = since.rsplit('\n').next().unwrap_or(since);
                cursor.keys_behind(&holder.path, written)
            }
            _ => Vec::new(),
        };
    }
    if line.trim_start().starts_with('[') && !line.contains(']') {
        return cursor.headers(line);
    }
    if line.contains('=') {
        return Vec::new();
    }
    // the header of this very line does not count
    let header = cursor.outline.headers.iter().rev();
    let mut header = header.filter(|h| h.span.start < line_start);
    let path = header.next().map_or(&[][..], |h| &h.path);
    cursor.keys_behind(path, line)
}
