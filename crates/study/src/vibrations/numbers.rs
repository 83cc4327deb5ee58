//! The numbers by which designs that vibrate differ.

use kempe_model::{Model, Rows, VibrationStudy};
use kempe_units::Unit;

use crate::result::{Scalar, StudyResult};
use crate::table::{Column, Table};

/// What is known of each mode: its column, and which of its values along a motion tell it.
const OF_MODE: [(&str, &[&str]); 3] = [
    ("frequency", &["min", "max"]),
    ("damping_ratio", &["min"]),
    ("growth", &["max"]),
];

/// About a pose the frequency, damping ratio and growth of every mode, and where what is let go stands; along a motion the least and the greatest
/// frequency, the least damping ratio and the greatest growth of every mode.
pub(crate) fn numbers_of_modes(
    model: &Model,
    study: &VibrationStudy,
    result: &StudyResult,
) -> Vec<Scalar> {
    let modes = 1..=study.release.len();
    if study.along.rows != Rows::Count(1) {
        let all = modes.flat_map(|mode| OF_MODE.map(|(name, of)| (format!("{name}_{mode}"), of)));
        let all = all.flat_map(|(name, of)| {
            let column = column(&result.table, &name);
            let number = |of: &&str| Scalar {
                name: format!("{of}({name})"),
                unit: column.map_or_else(Unit::one, |c| c.unit.clone()),
                value: column.map_or(f64::NAN, |c| of_rows(of, &c.values)),
            };
            of.iter().map(number).collect::<Vec<_>>()
        });
        return all.collect();
    }
    let of_mode = modes.flat_map(|mode| {
        OF_MODE.map(|(name, _)| {
            let column = column(&result.table, name);
            Scalar {
                name: format!("{name}_{mode}"),
                unit: column.map_or_else(Unit::one, |c| c.unit.clone()),
                value: column
                    .and_then(|c| c.values.get(mode - 1))
                    .copied()
                    .unwrap_or(f64::NAN),
            }
        })
    });
    let stands = study.release.iter().filter_map(|drive| {
        let name = &model.drives.get(drive.index())?.name;
        let known = [
            format!("{name} in equilibrium"),
            format!("{name} at the pose"),
        ];
        let found = result.scalars.iter().find(|s| known.contains(&s.name))?;
        Some(Scalar {
            name: name.clone(),
            ..found.clone()
        })
    });
    of_mode.chain(stands).collect()
}

fn column<'t>(table: &'t Table, name: &str) -> Option<&'t Column> {
    table.columns.iter().find(|c| c.name == name)
}

/// The least or the greatest of the values that are there.
fn of_rows(which: &str, values: &[f64]) -> f64 {
    let there = values.iter().copied().filter(|x| !x.is_nan());
    let least = which == "min";
    let found = there.reduce(|a, b| if least { a.min(b) } else { a.max(b) });
    found.unwrap_or(f64::NAN)
}
