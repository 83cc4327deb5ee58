//! Rows of a whole circuit, by arc length, and numbers over it.

use kempe_model::{Leaf, Measure, Statistic};
use kempe_motion::Progress;
use kempe_motion::circuit::Circuit;
use kempe_number::Number;

use crate::clock::Clock;
use crate::force_source::NoForces;
use crate::measure::{Moment, visit_leaves};
use crate::prepare::Unprepared;
use crate::sampler::{Sample, Sampler};
use crate::states_along::PathPlace;

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

/// Makes numbers over each of the stretches numbers over all of them.
fn over_circuit(samplers: &mut [Sampler]) {
    let Some(first) = samplers.first() else {
        return;
    };
    for index in 0..first.measurer.statistics.len() {
        let whole = whole(samplers, index);
        for sampler in samplers.iter_mut() {
            sampler.measurer.statistics[index].2 = whole;
        }
    }
}

/// A number over all the stretches.
fn whole(samplers: &mut [Sampler], index: usize) -> f64 {
    let (statistic, measure, _) = samplers[0].measurer.statistics[index].clone();
    let mut nested = false;
    let mechanism = samplers[0].motion().mechanism().clone();
    visit_leaves(&mechanism, &measure, &mut |leaf| {
        nested |= matches!(leaf, Leaf::Over(..));
    });
    // Of a number within it each stretch has taken its own.
    if nested || needs_time(&mut samplers[0], &measure) {
        return f64::NAN;
    }
    let mut own = samplers.iter().map(|s| s.measurer.statistics[index].2);
    let extremes = || {
        let of = |s: &Sampler| {
            let known = s.known.iter().find(|known| known.measure == measure);
            known.and_then(|known| known.found)
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for sampler in samplers.iter() {
            let ((_, least), (_, most)) = of(sampler)?;
            (low, high) = (low.min(least), high.max(most));
        }
        Some(high - low)
    };
    match statistic {
        Statistic::Min => own.fold(f64::INFINITY, Number::min),
        Statistic::Max => own.fold(f64::NEG_INFINITY, Number::max),
        Statistic::Range => extremes().unwrap_or(f64::NAN),
        Statistic::At { .. } => own.find(|x| !x.is_nan()).unwrap_or(f64::NAN),
        Statistic::Mean | Statistic::TimeRatio => f64::NAN,
    }
}

/// Whether a measure has a value only where time runs.
fn needs_time(sampler: &mut Sampler, measure: &Measure) -> bool {
    let middle = sampler.clock().parameter_at(0.5 * sampler.duration());
    let half = 0.5 * sampler.duration();
    let asked = sampler.asked(&[measure]);
    let [timeless, timed] = [f64::NAN, half].map(|time| {
        let place = PathPlace { time, path: middle };
        let value = |moment: &Moment<'_, f64>| moment.value(measure);
        let found = sampler.measurer.find(place);
        found.then(|| sampler.with_moment(place, false, &asked.lengths, value))
    });
    let has_value = |value: Option<f64>| value.is_some_and(|x| !x.is_nan());
    has_value(timed) && !has_value(timeless)
}

/// The row at an arc length. Time does not run along a circuit: measures of speed are NaN.
pub fn circuit_row(circuit: &Circuit, samplers: &mut [Sampler], arc: f64) -> Option<Sample> {
    let (index, p) = circuit.locate(arc);
    let sampler = samplers.get_mut(index);
    sampler.map(|sampler| sampler.without_time(p))
}
