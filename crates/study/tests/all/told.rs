//! What a result tells.

use kempe_study::StudyResult;

/// One of its numbers by its whole name, in the file's units.
#[track_caller]
pub fn scalar(result: &StudyResult, name: &str) -> f64 {
    let found = result.scalars.iter().find(|s| s.name == name);
    let names = || result.scalars.iter().map(|s| s.name.as_str());
    match found {
        Some(found) => found.value,
        None => panic!("no {name} among {:?}", names().collect::<Vec<_>>()),
    }
}

/// One of its columns, in the file's units.
#[track_caller]
pub fn column(result: &StudyResult, name: &str) -> Vec<f64> {
    let names = || result.table.columns.iter().map(|c| c.name.as_str());
    match result.table.column(name) {
        Some(found) => found.values.clone(),
        None => panic!("no {name} among {:?}", names().collect::<Vec<_>>()),
    }
}
