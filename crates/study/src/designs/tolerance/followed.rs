//! What is followed along the motion of the file's own design.

use kempe_model::{
    Diagnostic, Leaf, Model, MotionStudy, OverStudy, Plot, PointId, PoseMeasure, StudyKind,
};
use kempe_motion::progress::Progress;
use kempe_units::{Dimension, Expr};

use crate::columns::Asked;
use crate::designs::bench::Bench;
use crate::motion::run_along;
use crate::quantity::Quantity;
use crate::result::StudyResult;
use crate::simulation::simulation;

/// Measures that are followed along the motion where none is asked for.
pub(crate) const CURVES: usize = 3;

/// What is followed along the motion: what is plotted, or what the study that is run plots or tabulates.
pub(super) fn curves(model: &Model, over: &OverStudy, kind: &StudyKind) -> Vec<Quantity> {
    let along = kind.along();
    let of = |plots: &[Plot]| {
        let mut found: Vec<Quantity> = Vec::new();
        let mut add = |q: Quantity| {
            if found.iter().all(|known| known.measure != q.measure) {
                found.push(q);
            }
        };
        for plot in plots {
            match plot {
                Plot::Curves(columns) => columns.iter().for_each(|c| {
                    add(Quantity {
                        name: c.name.clone(),
                        measure: c.measure.clone(),
                        dimension: c.dimension,
                    });
                }),
                Plot::Path(point) => coordinates(model, *point).into_iter().for_each(&mut add),
                Plot::Hodograph(_) => {}
            }
        }
        found
    };
    let own = of(&over.asked.plots);
    if !own.is_empty() {
        return own;
    }
    let mut found = of(&along.plots);
    if found.is_empty() {
        found = Asked::of_motion(model, along).columns;
    }
    found.retain(|q| !crate::columns::is_number(model, &q.measure));
    found.truncate(CURVES);
    found
}

/// Both coordinates of a point.
fn coordinates(model: &Model, point: PointId) -> [Quantity; 2] {
    let name = model.points.get(point.index()).map_or("", |p| &p.name);
    let one = |axis: &str, pose: PoseMeasure| Quantity {
        name: format!("{axis}({name})"),
        measure: Expr::Leaf(Leaf::Pose(pose)),
        dimension: Dimension::LENGTH,
    };
    [
        one("x", PoseMeasure::X(point)),
        one("y", PoseMeasure::Y(point)),
    ]
}

/// The motion of the file's own design with what is followed along it.
pub(super) fn own_motion(
    model: &Model,
    name: &str,
    bench: &Bench<'_>,
    curves: &[Quantity],
    progress: &mut dyn Progress,
) -> Result<StudyResult, Vec<Diagnostic>> {
    let columns = curves.iter().map(|q| kempe_model::Column {
        name: q.name.clone(),
        measure: q.measure.clone(),
        dimension: q.dimension,
    });
    let along = MotionStudy {
        rows: bench.over.kind.along().rows.clone(),
        columns: columns.collect(),
        plots: Vec::new(),
        circuit: false,
    };
    match &bench.over.kind {
        StudyKind::Simulate(it) => {
            let it = kempe_model::SimulateStudy {
                along,
                ..it.clone()
            };
            simulation(model, name, &it, &[], progress).map(|(result, _)| result)
        }
        StudyKind::Forces(_) => run_along(model, name, &along, true, progress),
        _ => run_along(model, name, &along, false, progress),
    }
}
