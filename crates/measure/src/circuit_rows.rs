//! Rows of a whole circuit, by arc length, and numbers over it.

use kempe_model::{Leaf, Measure, Statistic};
use kempe_motion::Progress;
use kempe_motion::circuit::Circuit;
use kempe_number::Number;

use crate::clock::Clock;
use crate::force_source::NoForces;
use crate::measure::{needs_time, visit_leaves};
use crate::prepare::Unprepared;
use crate::sampler::{Sample, Sampler};

/// Prepares measures for rows of a circuit at these arc lengths: a sampler for each of its stretches. Numbers over the motion are
/// those over the whole circuit; means, time ratios and numbers of what needs time are NaN.
///
/// # Errors
/// All measures that cannot be evaluated, or that `progress` stopped it.
pub fn circuit_samplers(
    circuit: &Circuit,
    measures: &[&Measure],
    arcs: &[f64],
    progress: &mut dyn Progress,
) -> Result<Vec<Sampler>, Unprepared> {
    let mut rows: Vec<Vec<f64>> = vec![Vec::new(); circuit.stretches.len()];
    for arc in arcs {
        let (stretch, place) = circuit.locate(*arc);
        rows[stretch].push(place);
    }
    let stretches = circuit.stretches.iter().zip(rows);
    let samplers = stretches.map(|(stretch, mut rows)| {
        let motion = &stretch.motion;
        let clock = Clock::new(motion.clone());
        rows.iter_mut().for_each(|p| *p = clock.time_at(*p));
        Sampler::with_rows(motion, measures, NoForces, &rows, progress)
    });
    let mut samplers = samplers.collect::<Result<Vec<_>, _>>()?;
    over_circuit(&mut samplers);
    Ok(samplers)
}

/// Makes numbers over each of the stretches numbers over all of them. Nothing is told of those that have no value there.
fn over_circuit(samplers: &mut [Sampler]) {
    let Some(first) = samplers.first() else {
        return;
    };
    for index in 0..first.measurer.statistics.len() {
        let whole = whole(samplers, index).unwrap_or(f64::NAN);
        for sampler in samplers.iter_mut() {
            let (statistic, measure, value) = &mut sampler.measurer.statistics[index];
            *value = whole;
            if whole.is_nan() {
                (sampler.notes).retain(|(s, m, _)| s != statistic || m != measure);
            }
        }
    }
}

/// A number over all the stretches; `None` where it needs time, or each stretch has taken its own of a number within it.
fn whole(samplers: &[Sampler], index: usize) -> Option<f64> {
    let first = samplers.first()?;
    let (statistic, measure, _) = &first.measurer.statistics[index];
    let mechanism = first.motion().mechanism();
    let mut nested = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        nested |= matches!(leaf, Leaf::Over(..));
    });
    if nested || needs_time(mechanism, measure) {
        return None;
    }
    let mut own = samplers.iter().map(|s| s.measurer.statistics[index].2);
    match statistic {
        Statistic::Min => Some(own.fold(f64::INFINITY, Number::min)),
        Statistic::Max => Some(own.fold(f64::NEG_INFINITY, Number::max)),
        Statistic::Range => {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for sampler in samplers {
                let ((_, least), (_, most)) = sampler.extremes(measure)?;
                (low, high) = (low.min(least), high.max(most));
            }
            Some(high - low)
        }
        Statistic::At { drive, .. } => {
            drive.as_ref()?;
            own.find(|x| !x.is_nan())
        }
        Statistic::Mean | Statistic::TimeRatio => None,
    }
}

/// The row at an arc length. Time does not run along a circuit: measures of speed are NaN.
pub fn circuit_row(circuit: &Circuit, samplers: &mut [Sampler], arc: f64) -> Option<Sample> {
    let (index, p) = circuit.locate(arc);
    let sampler = samplers.get_mut(index);
    sampler.map(|sampler| sampler.without_time(p))
}
