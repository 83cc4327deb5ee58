//! Which quantities a motion study reports.

use kempe_measure::measure::{asks_unknown_state, visit_leaves};
use kempe_mechanism::Mechanism;
use kempe_model::{
    FRAME, ForceMeasure, Hodograph, Leaf, LinkId, Measure, Model, MotionStudy, Plot, PointId,
    PoseMeasure,
};
use kempe_units::{Dimension, Expr};

use crate::force_columns::standard;
use crate::quantity::Quantity;

/// Everything to evaluate for a study, each measure once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked {
    pub columns: Vec<Quantity>,
    pub curves: Vec<Quantity>,
    pub scalars: Vec<Quantity>,
    /// What the study itself looks at, and shows in no column.
    pub hidden: Vec<Quantity>,
}

impl Asked {
    /// What a study of motion asks for; without columns of its own, all named measures that need no forces; without
    /// measures, where everything is.
    pub fn of_motion(model: &Model, study: &MotionStudy) -> Self {
        let mut asked = Self::of(model, study, false);
        if asked.columns.is_empty() && study.columns.is_empty() {
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

    /// What a study of clearance asks for; without columns of its own, all named measures that have a value at every instant,
    /// without such, where everything is. Numbers over the motion are those of a motion, and this is beside one.
    pub fn of_clearance(mechanism: &Mechanism, study: &MotionStudy) -> Self {
        let model = &mechanism.model;
        let mut asked = Self::of(model, study, true);
        asked.scalars.clear();
        if study.columns.is_empty() {
            (asked.columns).retain(|q| !is_of_whole_motion(mechanism, &q.measure));
        }
        if asked.columns.is_empty() && study.columns.is_empty() {
            places(model).into_iter().for_each(|q| asked.add(q));
        }
        asked
    }

    fn of(model: &Model, study: &MotionStudy, forces: bool) -> Self {
        let constant = constants(model);
        let is_constant =
            |q: &Quantity| is_constant(&q.measure, &|index| constant.get(index).copied());
        let (scalars, others): (Vec<_>, Vec<_>) = named(model, forces).partition(is_constant);
        let mut asked = Self {
            scalars,
            ..Self::default()
        };
        for column in &study.columns {
            // Time and drives are the first columns of every table; along a circuit there is no time.
            let there = match column.measure {
                Expr::Leaf(Leaf::Drive(_)) => true,
                Expr::Leaf(Leaf::Time) => !study.circuit,
                _ => false,
            };
            let repeated = asked.columns.iter().any(|c| c.measure == column.measure);
            if there || repeated {
                continue;
            }
            asked.add(Quantity {
                name: column.name.clone(),
                measure: column.measure.clone(),
                dimension: column.dimension,
            });
        }
        if study.columns.is_empty() {
            others.into_iter().for_each(|q| asked.add(q));
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

    /// All measures, columns first and hidden ones last.
    pub fn all(&self) -> impl Iterator<Item = &Quantity> {
        let shown = self.columns.iter().chain(&self.curves);
        shown.chain(&self.scalars).chain(&self.hidden)
    }
}

/// Whether a measure asks for more of a motion than an instant: a number over it, or the way so far.
pub(crate) fn is_of_whole_motion(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= matches!(
            leaf,
            Leaf::Over(..) | Leaf::Pose(PoseMeasure::PathLength(_))
        );
    });
    found
}

/// Named measures, those of forces only with `forces`, those of pressures and switches where a simulation has followed them.
fn named(model: &Model, forces: bool) -> impl Iterator<Item = Quantity> {
    let known = model
        .measures
        .iter()
        .filter(move |m| forces || !m.needs_forces)
        .filter(|m| !asks_unknown_state(model, &m.measure));
    known.map(|m| Quantity {
        name: m.name.clone(),
        measure: m.measure.clone(),
        dimension: m.dimension,
    })
}

/// The named measures that are one number over the whole motion, those of forces among them.
pub(crate) fn numbers(model: &Model) -> Vec<Quantity> {
    let constant = constants(model);
    let is_number = |q: &Quantity| is_constant(&q.measure, &|index| constant.get(index).copied());
    named(model, true).filter(is_number).collect()
}

/// Whether a measure is one number over the whole motion, itself or by those that it names.
pub(crate) fn is_number(model: &Model, measure: &Measure) -> bool {
    let constant = constants(model);
    is_constant(measure, &|index| constant.get(index).copied())
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

/// Which of the named measures are one number over the whole motion.
fn constants(model: &Model) -> Vec<bool> {
    fn find(model: &Model, index: usize, known: &mut Vec<Option<bool>>) -> bool {
        if let Some(known) = known.get(index).copied().flatten() {
            return known;
        }
        let found = model.measures.get(index).is_some_and(|named| {
            let leaves = named.measure.leaves();
            let mut names = leaves.filter_map(|leaf| match leaf {
                Leaf::Named(other) => Some(*other),
                _ => None,
            });
            names.all(|other| find(model, other, known))
                && is_constant(&named.measure, &|_| Some(true))
        });
        if let Some(place) = known.get_mut(index) {
            *place = Some(found);
        }
        found
    }
    let mut known = vec![None; model.measures.len()];
    (0..model.measures.len())
        .map(|index| find(model, index, &mut known))
        .collect()
}

/// Whether a measure is one number over the whole motion, given which of the named ones are.
fn is_constant(measure: &Measure, named: &dyn Fn(usize) -> Option<bool>) -> bool {
    measure.leaves().all(|leaf| match leaf {
        Leaf::Parameter(_) | Leaf::Over(..) => true,
        Leaf::Named(index) => named(*index).unwrap_or(false),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_that_name_each_other_many_times_over_are_sorted_at_once() {
        // Looked at one by one, the last would be 2^60 measures.
        let mut text = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n[drives]\n\
                        motor = { turns = \"crank\", speed = 1 }\n[measures]\nm0 = \"max(x(B))\"\nn0 = \"x(B)\"\n"
            .to_owned();
        for k in 1..=60 {
            let before = k - 1;
            text += &format!(
                "m{k} = \"m{before} + m{before}\"\nn{k} = \"m{k} + n{before} + n{before}\"\n"
            );
        }
        let model = Model::from_toml(&text, "x", &mut |_| Err(String::new()));
        let constant = constants(&model.expect("a model").model);
        assert_eq!(constant.len(), 122);
        assert!(constant.chunks(2).all(|pair| pair == [true, false]));
    }
}
