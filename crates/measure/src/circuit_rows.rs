//! Rows of a whole circuit, by arc length.

use kempe_model::Measure;
use kempe_motion::Progress;
use kempe_motion::circuit::Circuit;

use crate::force_source::NoForces;
use crate::prepare::Unprepared;
use crate::sampler::{Sample, Sampler};

/// Prepares measures for rows of a circuit: a sampler for each of its stretches.
///
/// # Errors
/// All measures that cannot be evaluated, or that `progress` stopped it.
pub fn circuit_samplers(
    circuit: &Circuit,
    measures: &[&Measure],
    progress: &mut dyn Progress,
) -> Result<Vec<Sampler>, Unprepared> {
    let stretches = circuit.stretches.iter();
    stretches
        .map(|s| Sampler::with_progress(&s.motion, measures, NoForces, progress))
        .collect()
}

/// The row at an arc length. Time does not run along a circuit: measures of speed are NaN.
pub fn circuit_row(circuit: &Circuit, samplers: &mut [Sampler], arc: f64) -> Option<Sample> {
    let (index, p) = circuit.locate(arc);
    let sampler = samplers.get_mut(index);
    sampler.map(|sampler| sampler.without_time(p))
}
