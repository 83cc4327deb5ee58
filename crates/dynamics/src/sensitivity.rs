//! Exact derivatives of measures to the parameters of the design, those of forces among them.

use std::sync::Arc;

use kempe_measure::{
    Held, Sensitivities, Unprepared, Varying, sensitivities_at as measured_at, sensitivities_with,
};
use kempe_model::{Measure, ParameterId};
use kempe_motion::Motion;

use crate::sampler::ForceError;
use crate::source::Source;

/// The derivatives of measures at a place of a motion to parameters of the model: see [`kempe_measure::sensitivity`]. What
/// acts varies with the parameters too: masses, stiffnesses, loads, friction.
///
/// # Errors
/// Problems of what acts on the mechanism, or measures that cannot be evaluated.
pub fn sensitivities(
    motion: &Arc<Motion>,
    held: Held,
    measures: &[&Measure],
    parameters: &[ParameterId],
) -> Result<Sensitivities, ForceError> {
    let plain = Source::new(motion, &motion.design.parameters).map_err(ForceError::Problems)?;
    // The values are those of the plain source, in which there were no problems.
    let varying = |values: &[Varying]| Source::new(motion, values).ok();
    sensitivities_with(motion, held, measures, parameters, plain, varying)
        .map_err(|list| ForceError::Unprepared(Unprepared::Unmeasurable(list)))
}

/// As [`sensitivities`] at several places of the motion, in their order.
///
/// # Errors
/// As [`sensitivities`].
pub fn sensitivities_at(
    motion: &Arc<Motion>,
    held: &[Held],
    measures: &[&Measure],
    parameters: &[ParameterId],
) -> Result<Vec<Sensitivities>, ForceError> {
    let plain = Source::new(motion, &motion.design.parameters).map_err(ForceError::Problems)?;
    // The values are those of the plain source, in which there were no problems.
    let varying = |values: &[Varying]| Source::new(motion, values).ok();
    measured_at(motion, held, measures, parameters, plain, varying)
        .map_err(|list| ForceError::Unprepared(Unprepared::Unmeasurable(list)))
}
