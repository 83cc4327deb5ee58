//! What a measure asks for: one pose, the forces, or the whole motion.

use kempe_units::Expr;

use crate::ids::Scalar;
use crate::inner::InnerState;
use crate::measure::{Leaf, Measure, PoseMeasure};
use crate::model::Model;

/// What a measure asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Nature {
    /// The forces, in the measure itself or in one that it names.
    pub forces: bool,
    /// A number over the whole motion.
    pub motion: bool,
    /// A pressure or a switch.
    pub inner: bool,
    /// A pressure.
    pub pressure: bool,
    /// The rate of such.
    pub inner_rate: bool,
    /// Something of an instant that no number over the motion takes in.
    pub instant: bool,
}

impl Nature {
    fn and(self, other: Self) -> Self {
        Self {
            forces: self.forces || other.forces,
            motion: self.motion || other.motion,
            inner: self.inner || other.inner,
            pressure: self.pressure || other.pressure,
            inner_rate: self.inner_rate || other.inner_rate,
            instant: self.instant || other.instant,
        }
    }
}

/// What a measure asks for, given what the named ones do.
pub(crate) fn nature(measure: &Measure, named: &[Nature]) -> Nature {
    let of_an_instant = Nature {
        instant: true,
        ..Nature::default()
    };
    measure
        .leaves()
        .map(|leaf| match leaf {
            Leaf::Parameter(_) => Nature::default(),
            Leaf::Drive(_) | Leaf::Time => of_an_instant,
            Leaf::Named(i) => named.get(*i).copied().unwrap_or_default(),
            Leaf::Force(_) => Nature {
                forces: true,
                ..of_an_instant
            },
            Leaf::Inner(state) => Nature {
                inner: true,
                pressure: matches!(state, InnerState::Pressure(..)),
                ..of_an_instant
            },
            Leaf::Rate(inner, _) => {
                let within = nature(inner, named);
                Nature {
                    inner_rate: within.inner,
                    instant: true,
                    ..within
                }
            }
            Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, _))
            | Leaf::Coefficient(inner, _, _) => Nature {
                instant: true,
                ..nature(inner, named)
            },
            Leaf::Pose(_) => of_an_instant,
            Leaf::Over(_, inner) => Nature {
                motion: true,
                instant: false,
                ..nature(inner, named)
            },
        })
        .fold(Nature::default(), Nature::and)
}

/// The measure as a dimension of the design, if it depends on parameters only.
pub(crate) fn as_scalar(measure: &Measure) -> Option<Scalar> {
    let only_parameters = measure.leaves().all(|l| matches!(l, Leaf::Parameter(_)));
    only_parameters.then(|| {
        measure.substitute(&mut |leaf| match leaf {
            Leaf::Parameter(id) => Expr::Leaf(*id),
            _ => Expr::Const(f64::NAN),
        })
    })
}

impl Model {
    /// Whether a measure asks for forces, itself or by a measure that it names: only a study of forces knows it.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_model::Model;
    /// let text = r#"
    ///     [links]
    ///     frame = { A = [0, 0] }
    ///     crank = { A-B = 1, mass = 2, inertia = 0 }
    ///     [drives]
    ///     motor = { turns = "crank", speed = "1 rad/s" }
    ///     [measures]
    ///     effort = "abs(torque(motor))"
    ///     height = "y(B)"
    /// "#;
    /// let model = Model::from_toml(text, "pendulum", &mut |_| Err(String::new())).unwrap().model;
    /// assert!(model.needs_forces(&model.measures[0].measure));
    /// assert!(!model.needs_forces(&model.measures[1].measure));
    /// ```
    pub fn needs_forces(&self, measure: &Measure) -> bool {
        let named: Vec<Nature> = self
            .measures
            .iter()
            .map(|m| Nature {
                forces: m.needs_forces,
                ..Nature::default()
            })
            .collect();
        nature(measure, &named).forces
    }
}
