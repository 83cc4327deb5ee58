//! What a study of clearance tells at once: the largest and the mean deviation of each quantity, what is to be expected to first
//! order, and where no pose with play was found.

use kempe_model::Diagnostic;
use kempe_number::text::significant;

use super::columns::Deviation;
use super::joints::Joints;
use crate::extremes::Sizes;
use crate::force_notes::place;
use crate::result::{Listing, Scalar};
use crate::table::{Column, Table};
use crate::unit::number_text;

/// Digits of what people read.
const DIGITS: usize = 4;

/// Of each quantity the largest deviation from the ideal motion, its place and the mean, over the rows that have one.
pub(super) fn scalars(all: &[Deviation], table: &Table, along: usize) -> Vec<Scalar> {
    let (along, in_table) = (table.columns.get(along), Sizes::of(&table.columns));
    let mut list = Vec::new();
    for it in all {
        let (name, column) = (&it.quantity.name, &it.deviation);
        let sizes: Vec<f64> = column.values.iter().map(|x| x.abs()).collect();
        let known: Vec<f64> = sizes.iter().copied().filter(|x| x.is_finite()).collect();
        let Some((row, most)) = in_table.largest(column, &sizes) else {
            continue;
        };
        let scalar = |name: String, value: f64| Scalar {
            name,
            unit: column.unit.clone(),
            value,
        };
        list.push(scalar(format!("largest deviation of {name}"), most));
        if let Some(along) = along {
            list.push(Scalar {
                name: format!("{} at the largest deviation of {name}", along.name),
                unit: along.unit.clone(),
                value: along.values.get(row).copied().unwrap_or(f64::NAN),
            });
        }
        let mean = known.iter().sum::<f64>() / known.len() as f64;
        list.push(scalar(format!("mean deviation of {name}"), mean));
    }
    list
}

/// What the clearances can do at most to each quantity of the pose, to first order, and which joints do it.
pub(super) fn listings(
    all: &[Deviation],
    table: &Table,
    along: usize,
    joints: &Joints,
) -> Vec<Listing> {
    let (along, in_table) = (table.columns.get(along), Sizes::of(&table.columns));
    let rows: Vec<Vec<String>> = (all.iter())
        .filter_map(|it| {
            let first = it.first_order.as_ref()?;
            let (row, worst) = in_table.largest(&first.worst, &first.worst.values)?;
            let at = |column: &Column| column.values.get(row).copied().unwrap_or(f64::NAN);
            let mut parts: Vec<(f64, &str)> = (first.parts.get(row)?.iter())
                .zip(&joints.names)
                .map(|(part, name)| (100.0 * part / worst, name.as_str()))
                .collect();
            // Equal parts stay in the order of the joints.
            parts.sort_by(|a, b| b.0.total_cmp(&a.0));
            let parts = parts.iter().filter(|(share, _)| *share >= 0.5);
            let parts: Vec<String> = parts
                .map(|(share, name)| format!("{name} {share:.0} %"))
                .collect();
            Some(vec![
                first.worst.head().replace(" worst case", ""),
                significant(worst, DIGITS),
                significant(at(&first.rms), DIGITS),
                along.map_or(String::new(), |along| number_text(at(along))),
                parts.join(", "),
            ])
        })
        .collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let at = along.map_or(String::new(), |along| format!("at {}", along.head()));
    let head = [
        "",
        "worst case",
        "root mean square",
        &at,
        "parts of the worst case",
    ];
    vec![Listing {
        title: "To first order, whatever the directions of the clearances".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
    }]
}

/// Where no pose with play was found: a warning for each stretch of rows. `first_order` says whether the columns to first order
/// are known.
pub(super) fn not_settled(
    table: &Table,
    along: usize,
    told: &[Option<String>],
    first_order: bool,
) -> Vec<Diagnostic> {
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    for row in (0..told.len()).filter(|row| told[*row].is_some()) {
        match stretches.last_mut() {
            Some((_, last)) if *last + 1 == row => *last = row,
            _ => stretches.push((row, row)),
        }
    }
    let warning = |(first, last): (usize, usize)| {
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for reason in told[first..=last].iter().flatten() {
            match reasons.iter_mut().find(|(known, _)| known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        let rows = match last - first {
            0 => format!("row at {}", place(table, along, first)),
            _ => format!(
                "{} rows from {} to {}",
                last - first + 1,
                place(table, along, first),
                place(table, along, last)
            ),
        };
        let message = format!(
            "study `{}`: no settled contact in the {rows}: {}",
            table.name,
            reasons.first().map_or("", |(reason, _)| reason)
        );
        let more = reasons.iter().skip(1).take(MOST_REASONS);
        let warning = more.fold(
            Diagnostic::warning("clearance-not-settled", message),
            |warning, (reason, count)| warning.note(format!("in {count} of these rows {reason}")),
        );
        warning.help(match first_order {
            true => "see the column `note`, row by row; the columns to first order hold whatever the contacts do, away from a singular pose",
            false => "see the column `note`, row by row",
        })
    };
    let shown = stretches.iter().copied().take(MOST_STRETCHES).map(warning);
    let mut list: Vec<Diagnostic> = shown.collect();
    if let (Some((from, _)), Some((_, to))) = (stretches.get(MOST_STRETCHES), stretches.last()) {
        list.push(
            Diagnostic::warning(
                "clearance-not-settled",
                format!(
                    "study `{}`: no settled contact in {} further stretches of rows, from {} to {}",
                    table.name,
                    stretches.len() - MOST_STRETCHES,
                    place(table, along, *from),
                    place(table, along, *to)
                ),
            )
            .help("see the column `note`, row by row"),
        );
    }
    list
}

/// Stretches that are told one by one.
const MOST_STRETCHES: usize = 3;

/// Further reasons that are told of a stretch.
const MOST_REASONS: usize = 3;
