//! All four-bars that pass the points, used or not, by their pivots.

use kempe_synthesis::{C, CouplerCurve, Linkage, PathLinkage};
use kempe_units::{Dimension, Unit};

use crate::table::{Column, Table};
use crate::unit::{Units, shown};

/// What the table is called.
const NAME: &str = "solutions";
/// Their coordinates: the fixed pivots and, where the first point is passed, the moving ones, in the letters of the linkage's file.
const PIVOTS: [&str; 8] = ["A_x", "A_y", "D_x", "D_y", "B_x", "B_y", "C_x", "C_y"];

/// Four-bars by their pivots, each in both ways to call its links where either may be the crank. `closure` is by how much the longest miss of
/// a link's length at the points is, in parts of the linkage.
pub(super) fn solutions(found: &[PathLinkage], either_way: bool, units: &Units) -> Table {
    let unit = units.unit(Dimension::LENGTH);
    let mut number = Column::new("four-bar", Unit::one());
    let mut pivots = PIVOTS.map(|name| Column::new(name, unit.clone()));
    let mut closure = Vec::new();
    for (index, path) in found.iter().enumerate() {
        let (Linkage::FourBar(bar), Some(first)) = (&path.linkage, path.poses.first()) else {
            continue;
        };
        let bars = match either_way {
            true => vec![*bar, bar.exchanged()],
            false => vec![*bar],
        };
        for bar in bars {
            let curve = CouplerCurve::of(&bar, first, C::new(0.0, 0.0));
            let places = curve.fixed.into_iter().chain(curve.moving);
            let values = places.flat_map(|p| [p.re, p.im]);
            number.values.push((index + 1) as f64);
            for (column, value) in pivots.iter_mut().zip(values) {
                column.values.push(shown(value, &unit));
            }
            closure.push(missed(path));
        }
    }
    let rows = number.values.len();
    let mut columns = vec![number];
    columns.extend(pivots);
    Table {
        name: NAME.to_owned(),
        columns,
        places: 1,
        closure,
        smallest_singular_value: vec![f64::NAN; rows],
        forces: None,
        balance: None,
        notes: vec![None; rows],
    }
}

/// The largest difference between a link's length and the distance of its pins at any of the points, in parts of the longest link.
fn missed(path: &PathLinkage) -> f64 {
    let Linkage::FourBar(bar) = &path.linkage else {
        return f64::NAN;
    };
    let size = bar.all_lengths().into_iter().fold(0.0, f64::max);
    let at = path.poses.iter().flat_map(|pose| {
        let moving = bar.places(pose);
        [0, 1].map(|k| ((moving[k] - bar.fixed[k]).norm() - bar.lengths[k]).abs())
    });
    at.fold(0.0, f64::max) / size
}
