//! Comments that belong to what stands under them.

/// Where the lines of comments right above a line begin, not above `floor`, where what stands before ends.
pub(super) fn comments_above(text: &str, floor: usize, line: usize) -> usize {
    let mut start = line;
    while let Some(above) = text.get(floor..start).and_then(|t| t.strip_suffix('\n')) {
        let from = above.rfind('\n').map(|i| floor + i + 1);
        // the rest of a line is no line
        let whole = text
            .get(..floor)
            .is_some_and(|t| t.is_empty() || t.ends_with('\n'));
        let Some(from) = from.or_else(|| whole.then_some(floor)) else {
            break;
        };
        let comment = text.get(from..start).is_some_and(is_comment);
        if !comment {
            break;
        }
        start = from;
    }
    start
}

pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

pub(super) fn is_blank(line: &str) -> bool {
    line.trim().is_empty()
}
