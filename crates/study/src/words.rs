//! Names and lists of them, as sentences say them.

use kempe_mechanism::constraint::Source;
use kempe_model::Model;

/// `a`, `b` and `c`.
pub(crate) fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// How many more there are than are told: `and 12 more`.
pub(crate) fn and_more(count: usize) -> String {
    format!("and {count} more")
}

/// The first rows of a list of words whose first column is short, and how many more there are.
pub(crate) fn cut(mut rows: Vec<Vec<String>>, most: usize) -> Vec<Vec<String>> {
    let more = rows.len().saturating_sub(most);
    if more > 0 {
        rows.truncate(most);
        rows.push(vec!["…".to_owned(), and_more(more)]);
    }
    rows
}

pub(crate) fn source_name(model: &Model, source: Source) -> String {
    match source {
        Source::Pin { point, .. } => model
            .points
            .get(point.index())
            .map_or(String::new(), |p| format!("pin {}", p.name)),
        Source::Joint(joint) => model
            .joints
            .get(joint.index())
            .map_or(String::new(), |j| j.name.clone()),
        Source::Drive(drive) => model
            .drives
            .get(drive.index())
            .map_or(String::new(), |d| d.name.clone()),
    }
}
