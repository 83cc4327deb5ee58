//! What a number cannot be below, by its form alone.
//!
//! A range or a distance is never less than nothing. Where a goal gets there, at a corner of all its pieces, no derivatives tell that it is
//! an optimum; its form does.

use kempe_mechanism::Mechanism;
use kempe_model::{ForceMeasure, Leaf, Measure, PoseMeasure, Statistic};
use kempe_number::Interval;

use super::parts::{MOST_LEAVES, written_out};

/// The least that a measure times a sign can be, whatever the mechanism; minus infinity where nothing is known.
pub(in crate::designs) fn least(mechanism: &Mechanism, measure: &Measure, sign: f64) -> f64 {
    let Some(out) = written_out(&mechanism.model, measure, &mut { MOST_LEAVES }) else {
        return f64::NEG_INFINITY;
    };
    let within = values(&out) * sign;
    match within.is_empty() {
        true => f64::NEG_INFINITY,
        false => within.lo(),
    }
}

/// Between what the values of a measure lie.
fn values(measure: &Measure) -> Interval {
    measure.eval(&mut of_leaf)
}

fn of_leaf(leaf: &Leaf) -> Interval {
    let from_nothing = Interval::new(0.0, f64::INFINITY);
    match leaf {
        Leaf::Over(Statistic::Range | Statistic::TimeRatio, _)
        | Leaf::Pose(
            PoseMeasure::Distance(..)
            | PoseMeasure::Speed(_)
            | PoseMeasure::Acceleration(_)
            | PoseMeasure::PathLength(_)
            | PoseMeasure::TransmissionAngle { .. },
        )
        | Leaf::Force(
            ForceMeasure::Reaction(_) | ForceMeasure::KineticEnergy | ForceMeasure::ShakingForce,
        ) => from_nothing,
        // Smallest, largest, mean and single values lie where all of them do.
        Leaf::Over(_, within) => values(within),
        _ => Interval::WHOLE,
    }
}
