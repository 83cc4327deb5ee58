//! The designs of a sweep as a table of words.

use crate::result::Listing;
use crate::table::{Column, Table};
use crate::unit::number_text;

/// The first designs with their numbers, so many of them, and of the rest so many of which there is something to say, as why they have no values. The
/// table has all.
pub(crate) fn listed(table: &Table, title: String, [first, noted]: [usize; 2]) -> Listing {
    let is_noted = |row: &usize| table.notes.get(*row).is_some_and(Option::is_some);
    let mut shown: Vec<usize> = (0..table.rows().min(first)).collect();
    shown.extend((shown.len()..table.rows()).filter(is_noted).take(noted));
    let noted = shown.iter().any(is_noted);
    let mut head: Vec<String> = table.columns.iter().map(Column::head).collect();
    head.extend(noted.then(|| "note".to_owned()));
    let row = |row: &usize| {
        let values = table.columns.iter().map(|c| c.values.get(*row));
        let values = values.map(|v| match v {
            Some(v) if !v.is_nan() => number_text(*v),
            _ => String::new(),
        });
        let note = noted.then(|| table.notes.get(*row).cloned().flatten().unwrap_or_default());
        values.chain(note).collect()
    };
    let more = table.rows() - shown.len();
    let rest = (more > 0).then(|| vec![format!("and {more} more")]);
    Listing {
        title,
        head,
        rows: shown.iter().map(row).chain(rest).collect(),
    }
}
