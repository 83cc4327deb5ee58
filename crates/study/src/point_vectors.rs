//! Velocities and accelerations of the points of a study, for its report.

use kempe_draw::LoadUnit;
use kempe_draw::report::{PointVectors, VectorKind};
use kempe_measure::PointRates;
use kempe_model::Model;
use kempe_units::Dimension;

use crate::result::StudyResult;
use crate::unit::Units;

/// The vectors of all points in every row: to time, or along a circuit to the coordinate of the drive that moves. None where
/// several drives move and time does not.
pub(crate) fn point_vectors(model: &Model, result: &StudyResult) -> Vec<PointVectors> {
    let Some((abscissa, per)) = abscissa(model, result) else {
        return Vec::new();
    };
    let units = Units::of(model);
    let vectors = |kind, dimension, of: fn(&PointRates) -> [f64; 2]| {
        let unit = units.unit(dimension);
        PointVectors {
            kind,
            per: per.clone(),
            unit: LoadUnit::new(unit.text(), unit.to_si(1.0)),
            rows: (result.frames.iter())
                .map(|frame| frame.rates.iter().map(of).collect())
                .collect(),
        }
    };
    let first = Dimension::LENGTH / abscissa;
    vec![
        vectors(VectorKind::Velocity, first, |r| r.velocity),
        vectors(VectorKind::Acceleration, first / abscissa, |r| {
            r.acceleration
        }),
    ]
}

/// To what the derivatives of a study's rows are taken: its dimension, and in words.
fn abscissa(model: &Model, result: &StudyResult) -> Option<(Dimension, String)> {
    let first = result.table.columns.first()?;
    if first.unit.dimension() == Dimension::TIME {
        return Some((Dimension::TIME, "in time".to_owned()));
    }
    let drives = model.drives.iter().zip(result.table.columns.iter().skip(1));
    let mut moving = drives.filter(|(_, column)| {
        let mut values = column.values.iter().filter(|v| v.is_finite());
        let start = values.next();
        values.any(|v| Some(v) != start)
    });
    let (drive, _) = moving.next()?;
    let alone = moving.next().is_none();
    alone.then(|| (drive.dimension, format!("derivative to {}", drive.name)))
}
