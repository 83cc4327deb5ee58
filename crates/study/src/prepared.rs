//! A model made ready to move: what every study starts from.

use kempe_kinematics::{Design, Mechanism, Motion, Plan};
use kempe_model::{Diagnostic, Model};

use crate::explain::cannot_move;
use crate::progress::{Ear, Progress};

/// The mechanism of a model with its plan and its dimensions.
pub(crate) struct Prepared {
    pub mechanism: Mechanism,
    pub plan: Plan,
    /// Values of the parameters, SI.
    pub parameters: Vec<f64>,
    pub design: Design<f64>,
}

impl Prepared {
    /// Takes a model apart.
    pub fn new(model: &Model) -> Self {
        let mechanism = Mechanism::new(model);
        let plan = Plan::new(&mechanism);
        let parameters: Vec<f64> = model.parameter_values();
        let design = Design::new(&mechanism, &plan, &parameters);
        Self {
            mechanism,
            plan,
            parameters,
            design,
        }
    }

    /// The motion that the drives' laws demand, or why there is none.
    pub fn motion(&self, progress: &mut dyn Progress) -> Result<Motion<'_>, Vec<Diagnostic>> {
        let (mechanism, plan, design) = (&self.mechanism, &self.plan, &self.design);
        Motion::watched(
            mechanism,
            plan,
            design,
            &self.parameters,
            &mut Ear(progress),
        )
        .map_err(|error| vec![cannot_move(mechanism, plan, design, &error)])
    }
}
