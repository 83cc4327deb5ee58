//! A model made ready to move: what every study starts from.

use std::sync::Arc;

use kempe_mechanism::{Design, Mechanism};
use kempe_model::{Diagnostic, Model};
use kempe_motion::Motion;

use crate::explain::cannot_move;
use kempe_motion::progress::Progress;

/// The design that a model describes: its mechanism with the values of its parameters.
pub(crate) fn design(model: &Model) -> Design<f64> {
    Design::new(&Mechanism::new(model), &model.parameter_values())
}

/// The motion that the drives' laws demand of a design, or why there is none.
pub(crate) fn motion(
    design: &Design<f64>,
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, Vec<Diagnostic>> {
    Motion::with_progress(design, progress).map_err(|error| vec![cannot_move(design, &error)])
}
