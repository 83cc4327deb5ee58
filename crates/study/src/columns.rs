//! Which quantities a motion study reports.

use kempe_kinematics::Mechanism;
use kempe_model::{
    FRAME, ForceMeasure, Hodograph, Leaf, LinkId, Measure, Model, MotionStudy, Plot, PointId,
    PoseMeasure,
};
use kempe_units::{Dimension, Expr, Unit};

use crate::force_columns::standard;
use crate::unit::Units;

/// A quantity to evaluate.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub name: String,
    pub measure: Measure,
    pub dimension: Dimension,
}

impl Quantity {
    /// The unit it is shown in. An energy and a torque have one dimension and two units.
    pub fn unit(&self, units: &Units) -> Unit {
        match self.measure {
            Expr::Leaf(Leaf::Force(
                ForceMeasure::KineticEnergy | ForceMeasure::PotentialEnergy,
            )) => Unit::parse("J").unwrap_or_else(|_| units.unit(self.dimension)),
            _ => units.unit(self.dimension),
        }
    }
}

/// Everything to evaluate for a study, each measure once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked {
    pub columns: Vec<Quantity>,
    pub curves: Vec<Quantity>,
    pub scalars: Vec<Quantity>,
}

impl Asked {
    /// What a study of motion asks for; without columns of its own, all named measures that need no forces; without
    /// measures, where everything is.
    pub fn of_motion(model: &Model, study: &MotionStudy) -> Self {
        let mut asked = Self::of(model, study, false);
        if asked.columns.is_empty() && model.measures.is_empty() {
            places(model).into_iter().for_each(|q| asked.add(q));
        }
        asked
    }

    /// What a study of forces asks for; without columns of its own, all named measures and everything that drives and
    /// joints carry.
    pub fn of_forces(mechanism: &Mechanism, study: &MotionStudy) -> Self {
        let mut asked = Self::of(&mechanism.model, study, true);
        if study.columns.is_empty() {
            standard(mechanism).into_iter().for_each(|q| asked.add(q));
        }
        asked
    }

    fn of(model: &Model, study: &MotionStudy, forces: bool) -> Self {
        let named = || {
            let known = model.measures.iter().filter(|m| forces || !m.needs_forces);
            known.map(|m| Quantity {
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
        for plot in &study.plots {
            match plot {
                Plot::Curves(columns) => asked.curves.extend(columns.iter().map(|c| Quantity {
                    name: c.name.clone(),
                    measure: c.measure.clone(),
                    dimension: c.dimension,
                })),
                Plot::Hodograph(hodograph) => {
                    asked.curves.extend(hodograph_axes(hodograph));
                }
                Plot::Path(_) => {}
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

/// The components of a joint's force.
fn hodograph_axes(hodograph: &Hodograph) -> [Quantity; 2] {
    let axis = |measure: ForceMeasure| Quantity {
        name: hodograph.name.clone(),
        measure: Expr::Leaf(Leaf::Force(measure)),
        dimension: Dimension::FORCE,
    };
    [
        axis(ForceMeasure::ReactionX(hodograph.joint)),
        axis(ForceMeasure::ReactionY(hodograph.joint)),
    ]
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
