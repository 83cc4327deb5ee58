//! What a run prints.

use std::path::{Path, PathBuf};

use kempe_number::text::significant;
use kempe_study::{
    Comparison, Extreme, Listing, StudyOutcome, StudyResult, encode, without_rounding,
};
use serde_json::{Value, json};

use super::against::Against;
use super::write::REPORT;
use crate::files::Loaded;
use crate::names;
use crate::say::Speaker;

/// Digits of what people read; files and JSON have all.
const DIGITS: usize = 6;

/// What a run found, for people.
pub fn summary(
    outcomes: &[StudyOutcome<'_>],
    folder: Option<&Path>,
    files: &[PathBuf],
    partial: bool,
) -> String {
    let mut out = String::new();
    for outcome in outcomes {
        let Ok(result) = &outcome.result else {
            out.push_str(&format!("{}: not run\n", outcome.study.name));
            continue;
        };
        let table = &result.table;
        let mut rows = match table.rows() {
            1 => "1 row".to_owned(),
            rows => format!("{rows} rows"),
        };
        if let Some(how_far) = result.how_far() {
            rows = match result.stopped_at {
                Some(_) => format!("{rows}, stopped at {how_far}"),
                None => format!("{how_far}, stopped"),
            };
        }
        out.push_str(&format!("{}: {rows}", result.name));
        if table.unreached() > 0 {
            out.push_str(&format!(", {} not reached", table.unreached()));
        }
        let closure = table.worst_closure();
        if closure.is_finite() {
            out.push_str(&format!(
                ", loops closed to {closure:.1e} of the mechanism's size"
            ));
        }
        if let Some((_, difference)) = table.worst_route_difference() {
            out.push_str(&format!(
                ", virtual power and Newton-Euler agree to {difference:.1e}"
            ));
        }
        out.push('\n');
        let width = result
            .scalars
            .iter()
            .map(|s| s.name.chars().count())
            .max()
            .unwrap_or(0);
        for scalar in &result.scalars {
            let value = significant(scalar.value, DIGITS);
            out.push_str(
                format!("  {:width$}  {value} {}", scalar.name, scalar.unit.text()).trim_end(),
            );
            out.push('\n');
        }
        if folder.is_none() && result.designs.is_empty() {
            out.push_str(&aligned(extremes(result).iter(), 2));
        }
        for listing in &result.listings {
            out.push_str(&format!("  {}\n", listing.title));
            let rows = std::iter::once(&listing.head).chain(&listing.rows);
            out.push_str(&aligned(rows.filter(|r| !r.is_empty()), 4));
        }
        for event in &result.events {
            out.push_str(&format!("  {}: {}\n", event.place, event.label));
        }
    }
    if folder.is_none() && outcomes.iter().any(|o| o.result.is_ok()) {
        out.push_str("nothing written: --out FOLDER keeps tables, pictures and a report\n");
    }
    if let (Some(folder), false) = (folder, files.is_empty()) {
        out.push_str(&format!(
            "{} files in {}: open ",
            files.len(),
            folder.display()
        ));
        out.push_str(&format!(
            "{}\n",
            folder.join(names::of_run(REPORT, partial)).display()
        ));
    }
    out
}

/// The smallest and largest value of every column in its rows, and where they stand.
fn extremes(result: &StudyResult) -> Vec<Vec<String>> {
    let Some(along) = result.abscissa() else {
        return Vec::new();
    };
    let at = format!("at {}", along.head());
    let head = ["in the rows", "smallest", &at, "largest", &at];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let columns = kempe_study::extremes(result);
    if columns.is_empty() {
        return Vec::new();
    }
    for extremes in columns {
        let mut row = vec![extremes.column.head()];
        let told = |e: Extreme| {
            let value = significant(without_rounding(e.value, e.size), DIGITS);
            [value, significant(e.at, DIGITS)]
        };
        for extreme in [extremes.smallest, extremes.largest] {
            row.extend(extreme.map_or(["n/a", ""].map(str::to_owned), told));
        }
        rows.push(row);
    }
    rows
}

/// Rows of words with their columns below each other.
fn aligned<'r>(rows: impl Iterator<Item = &'r Vec<String>>, indent: usize) -> String {
    let rows: Vec<&Vec<String>> = rows.collect();
    let columns = rows.iter().map(|r| r.len()).max().unwrap_or(0);
    let width = |k: usize| {
        rows.iter()
            .filter_map(|r| r.get(k))
            .map(|c| c.chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row
            .iter()
            .zip(&widths)
            .map(|(cell, w)| format!("{cell:w$}"));
        let text = cells.collect::<Vec<_>>().join("  ");
        format!("{:indent$}{}\n", "", text.trim_end())
    };
    rows.into_iter().map(line).collect()
}

/// Two designs beside each other, for people.
pub fn compared(comparison: &Comparison) -> String {
    let mut out = format!("{}\n", comparison.headline());
    let table = |listing: &Listing| {
        let rows = std::iter::once(&listing.head).chain(&listing.rows);
        aligned(rows, 2)
    };
    out.extend(comparison.parameters_listing().map(|l| table(&l)));
    for study in &comparison.studies {
        out.push_str(&format!("{}: {}\n", study.name, study.headline()));
        out.extend(study.listings().iter().map(table));
    }
    out.extend(comparison.sameness().map(|text| format!("{text}\n")));
    out
}

/// What became of the other design, for scripts.
pub fn against_json(against: &Against<'_>, with_tables: bool) -> Value {
    json!({
        "file": against.loaded.name,
        "title": against.loaded.checked.model.title,
        "studies": studies_json(against.outcomes, with_tables),
    })
}

fn studies_json(outcomes: &[StudyOutcome<'_>], with_tables: bool) -> Vec<Value> {
    let studies = outcomes.iter().map(|outcome| match &outcome.result {
        Ok(result) => encode::result(result, with_tables),
        Err(_) => json!({ "study": outcome.study.name, "failed": true }),
    });
    studies.collect()
}

/// What a run found, for scripts.
pub fn summary_json(
    loaded: &Loaded,
    outcomes: &[StudyOutcome<'_>],
    files: &[PathBuf],
    partial: bool,
    with_tables: bool,
    speaker: &Speaker,
) -> Value {
    json!({
        "file": loaded.name,
        "title": loaded.checked.model.title,
        "partial": partial,
        "studies": studies_json(outcomes, with_tables),
        "files": files.iter().map(|f| f.display().to_string()).collect::<Vec<_>>(),
        "diagnostics": speaker.diagnostics(),
    })
}
