//! Measures that were asked for by their texts.

use kempe_model::{Leaf, Measure, NamedMeasure, PoseMeasure};
use kempe_study::Quantity;

use crate::{Compiled, Error};

/// Measures that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub quantities: Vec<Quantity>,
    /// By measure: whether it asks for forces.
    pub forces: Vec<bool>,
    /// By measure: whether it asks when the motion is there: speeds, rates, forces.
    pub timed: Vec<bool>,
}

impl Asked {
    /// Reads measures of a model; all that is wrong with them is told.
    pub fn of<M: AsRef<str>>(
        compiled: &Compiled,
        model: &kempe_model::Model,
        measures: impl IntoIterator<Item = M>,
    ) -> Result<Self, Error> {
        let mut diagnostics = Vec::new();
        let mut it = Self {
            quantities: Vec::new(),
            forces: Vec::new(),
            timed: Vec::new(),
        };
        let mut known = vec![None; model.measures.len()];
        for text in measures {
            match model.measure(text.as_ref()) {
                Ok(NamedMeasure {
                    name,
                    measure,
                    dimension,
                    needs_forces,
                    ..
                }) => {
                    it.forces.push(needs_forces);
                    it.timed.push(asks_time(model, &measure, &mut known));
                    it.quantities.push(Quantity {
                        name,
                        measure,
                        dimension,
                    });
                }
                Err(problems) => diagnostics.extend(problems),
            }
        }
        match diagnostics.is_empty() {
            true => Ok(it),
            false => Err(compiled.errors(diagnostics)),
        }
    }

    pub fn any_forces(&self) -> bool {
        self.forces.contains(&true)
    }
}

/// Whether a measure asks when the motion is at a pose. Numbers over the whole motion do not. Named measures are looked into
/// once: `known`.
fn asks_time(model: &kempe_model::Model, measure: &Measure, known: &mut [Option<bool>]) -> bool {
    measure.leaves().any(|leaf| match leaf {
        Leaf::Time | Leaf::Rate(..) | Leaf::Force(_) | Leaf::Inner(_) => true,
        Leaf::Pose(pose) => matches!(
            pose,
            PoseMeasure::Speed(_)
                | PoseMeasure::Acceleration(_)
                | PoseMeasure::AngularSpeed(_)
                | PoseMeasure::AngularAcceleration(_)
                | PoseMeasure::PathLength(_)
        ),
        Leaf::Coefficient(inner, ..) => asks_time(model, inner, known),
        Leaf::Named(index) => match (known.get(*index), model.measures.get(*index)) {
            (Some(Some(known)), _) => *known,
            (Some(None), Some(named)) => {
                let found = asks_time(model, &named.measure, known);
                known[*index] = Some(found);
                found
            }
            _ => false,
        },
        Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Over(..) => false,
    })
}

/// Why a measure has no value at a pose that was reached.
pub(crate) fn no_value(names: &str, time: f64) -> String {
    match time.is_finite() {
        true => format!(
            "{names}: no value here (a quotient by zero, a root or arc of a number outside its range, or a place that a number \
             over the motion asks for and the motion does not pass)"
        ),
        false => format!(
            "{names}: no value here, as no law of the drives passes this place: nothing is known of speeds and forces"
        ),
    }
}
