//! Which quantities a motion study reports.

use kempe_model::{FRAME, Leaf, LinkId, Measure, Model, MotionStudy, Plot, PointId, PoseMeasure};
use kempe_units::{Dimension, Expr};

/// A quantity to evaluate.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub name: String,
    pub measure: Measure,
    pub dimension: Dimension,
}

/// Everything to evaluate for a study, each measure once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked {
    pub columns: Vec<Quantity>,
    pub curves: Vec<Quantity>,
    pub scalars: Vec<Quantity>,
}

impl Asked {
    /// What a study asks for; without columns of its own, all named measures; without those, where everything is.
    pub fn of(model: &Model, study: &MotionStudy) -> Self {
        let named = || {
            model.measures.iter().map(|m| Quantity {
                name: m.name.clone(),
                measure: m.measure.clone(),
                dimension: m.dimension,
            })
        };
        let mut asked = Self {
            scalars: named().filter(|q| is_constant(model, &q.measure)).collect(),
            ..Self::default()
        };
        for column in &study.columns {
            asked.add(Quantity {
                name: column.name.clone(),
                measure: column.measure.clone(),
                dimension: column.dimension,
            });
        }
        if study.columns.is_empty() {
            named()
                .filter(|q| !is_constant(model, &q.measure))
                .for_each(|q| asked.add(q));
        }
        if asked.columns.is_empty() && model.measures.is_empty() {
            places(model).into_iter().for_each(|q| asked.add(q));
        }
        for plot in &study.plots {
            if let Plot::Column(column) = plot {
                asked.curves.push(Quantity {
                    name: column.name.clone(),
                    measure: column.measure.clone(),
                    dimension: column.dimension,
                });
            }
        }
        asked
    }

    fn add(&mut self, quantity: Quantity) {
        if self.columns.iter().all(|c| c.name != quantity.name) {
            self.columns.push(quantity);
        }
    }

    /// All measures, columns first.
    pub fn all(&self) -> impl Iterator<Item = &Quantity> {
        self.columns.iter().chain(&self.curves).chain(&self.scalars)
    }
}

/// Whether a measure is one number over the whole motion.
fn is_constant(model: &Model, measure: &Measure) -> bool {
    measure.leaves().all(|leaf| match leaf {
        Leaf::Parameter(_) | Leaf::Over(..) => true,
        Leaf::Named(index) => model
            .measures
            .get(*index)
            .is_some_and(|m| is_constant(model, &m.measure)),
        _ => false,
    })
}

/// Coordinates of all moving points and angles of all moving links.
fn places(model: &Model) -> Vec<Quantity> {
    let mut all = Vec::new();
    let pose = |name: String, measure: PoseMeasure, dimension: Dimension| Quantity {
        name,
        measure: Expr::Leaf(Leaf::Pose(measure)),
        dimension,
    };
    for (index, point) in model.points.iter().enumerate() {
        let id = PointId(index as u32);
        if !point.links.contains(&FRAME) {
            let name = &point.name;
            all.push(pose(
                format!("x({name})"),
                PoseMeasure::X(id),
                Dimension::LENGTH,
            ));
            all.push(pose(
                format!("y({name})"),
                PoseMeasure::Y(id),
                Dimension::LENGTH,
            ));
        }
    }
    for (index, link) in model.links.iter().enumerate().skip(1) {
        let id = LinkId(index as u32);
        all.push(pose(
            format!("angle({})", link.name),
            PoseMeasure::Angle(id),
            Dimension::ANGLE,
        ));
    }
    all
}
