//! Studies that choose something that acts on the mechanism, and show the motion with it.
//!
//! What one unit of a counterweight or of a spring does along the motion is asked of the same force sampler that shows
//! the result, on the bare mechanism with nothing else on it; both are linear, so a least-squares choice is exact.

mod balance;
mod spring;

pub(crate) use balance::balance;
pub(crate) use spring::spring;

use kempe_model::{
    Actions, Column as Asked, Diagnostic, DriveId, DriveKind, ForceMeasure, Leaf, Measure, Model,
    MotionStudy,
};
use kempe_motion::Stage;
use kempe_units::{Dimension, Expr};

use crate::along::Along;
use crate::explain::stopped;
use crate::prepared::{design, motion};
use crate::quantity::Quantity;
use crate::result::{Figure, StudyResult};
use crate::rows::{RowPlace, places_along};
use crate::table::Column;
use kempe_motion::progress::{Done, Progress};

/// The mechanism with nothing on it but gravity.
fn bare(model: &Model) -> Model {
    let mut bare = model.clone();
    for link in &mut bare.links {
        link.inertia = None;
    }
    bare.actions = Actions {
        gravity: model.actions.gravity.clone(),
        ..Actions::default()
    };
    bare
}

/// A measure that is asked for.
fn force(name: &str, measure: ForceMeasure, dimension: Dimension) -> Quantity {
    Quantity {
        name: name.to_owned(),
        measure: Expr::Leaf(Leaf::Force(measure)),
        dimension,
    }
}

/// What a drive must give.
fn effort(model: &Model, drive: DriveId) -> Quantity {
    let known = model.drives.get(drive.index());
    let name = known.map_or("", |d| d.name.as_str());
    match known.map(|d| &d.kind) {
        Some(DriveKind::Turn { .. }) => force(
            &format!("torque({name})"),
            ForceMeasure::Drive(drive),
            Dimension::TORQUE,
        ),
        _ => force(
            &format!("force({name})"),
            ForceMeasure::Drive(drive),
            Dimension::FORCE,
        ),
    }
}

/// Values of quantities (SI) at the rows of a study: one list for each quantity.
fn values(
    model: &Model,
    study: &MotionStudy,
    quantities: &[Quantity],
    progress: &mut dyn Progress,
) -> Result<Vec<Vec<f64>>, Vec<Diagnostic>> {
    let design = design(model);
    let motion = motion(&design, progress)?;
    let asked: Vec<&Quantity> = quantities.iter().collect();
    let mut along = Along::with_progress(model, &motion, &asked, true, &[], progress)?;
    let places: Vec<RowPlace> = places_along(&motion, study, &design.parameters);
    let mut lists = vec![Vec::with_capacity(places.len()); quantities.len()];
    let count = places.len();
    for (done, place) in places.into_iter().enumerate() {
        let part = Done::Of(done, count);
        if progress.reached(Stage::Trying, part).is_break() {
            return Err(vec![stopped(Stage::Trying)]);
        }
        for (list, value) in lists.iter_mut().zip(along.values(place)) {
            list.push(value);
        }
    }
    Ok(lists)
}

/// The study that shows what was chosen: each quantity as a column called `NAME after`.
fn shown_by(study: &MotionStudy, quantities: &[Quantity]) -> MotionStudy {
    let columns = quantities.iter().map(|q| Asked {
        name: after(&q.name),
        measure: q.measure.clone(),
        dimension: q.dimension,
    });
    MotionStudy {
        rows: study.rows.clone(),
        columns: columns.collect(),
        plots: Vec::new(),
        circuit: false,
    }
}

fn after(name: &str) -> String {
    format!("{name} after")
}

/// Puts the values from before in front of those from after, with a picture of both (and of `wanted`).
fn set_beside(result: &mut StudyResult, quantities: &[Quantity], before: &[Vec<f64>]) {
    result.figures.clear();
    for (quantity, values) in quantities.iter().zip(before) {
        let columns = &mut result.table.columns;
        let Some(place) = columns.iter().position(|c| c.name == after(&quantity.name)) else {
            continue;
        };
        let Some(now) = columns.get(place).cloned() else {
            continue;
        };
        let rows = now.values.len();
        let mut old = Column::new(format!("{} before", quantity.name), now.unit.clone());
        old.values = values
            .iter()
            .take(rows)
            .map(|v| old.unit.from_si(*v))
            .collect();
        columns.insert(place, old.clone());
        result.figures.push(Figure::Curves {
            curves: vec![old, now],
            limits: Vec::new(),
        });
    }
}

/// Weights of rows in a sum of squares, 1 in all: the first and the last count half, so that the rows of a full turn
/// count evenly.
fn weights(rows: usize) -> Vec<f64> {
    let whole = 1.0 / rows.saturating_sub(1).max(1) as f64;
    let end = |row: usize| rows > 1 && (row == 0 || row + 1 == rows);
    (0..rows)
        .map(|row| if end(row) { whole / 2.0 } else { whole })
        .collect()
}

/// A constant in the model.
fn constant<L>(value: f64) -> Expr<L> {
    Expr::Const(value)
}

/// A measure that is the same everywhere.
fn is_zero(measure: &Measure) -> bool {
    matches!(measure, Expr::Const(x) if *x == 0.0)
}
