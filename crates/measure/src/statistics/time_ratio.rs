//! Durations of both strokes of a cycle.

use std::f64::consts::TAU;

use kempe_model::LawPiece;
use kempe_motion::drive_path::{WHOLE, is_cycle};
use kempe_number::Number;
use kempe_units::Dimension;

use crate::force_source::ForceSource;
use crate::sampler::Sampler;

/// Duration of the slower stroke over that of the faster, from the time between both extremes and the duration of the
/// motion; NaN where the motion is no cycle. Over several turns the cycle is one of them.
pub(crate) fn time_ratio<T: Number, F: ForceSource>(
    sampler: &Sampler<F>,
    between: T,
    duration: T,
) -> T {
    if !is_cycle(&sampler.motion().mechanism().model, sampler.parameters()) {
        return T::from_f64(f64::NAN);
    }
    let cycle = duration / whole_turns(sampler);
    let between = between.abs();
    let stroke = between - cycle * (between.value() / cycle.value()).floor();
    let back = cycle - stroke;
    stroke.max(back) / stroke.min(back)
}

/// How many whole turns the only moving drive makes one way; 1 for any other motion.
fn whole_turns<F: ForceSource>(sampler: &Sampler<F>) -> f64 {
    let Some(drive) = sampler.path_drive() else {
        return 1.0;
    };
    let model = &sampler.motion().mechanism().model;
    let Some(drive) = model.drives.get(drive.index()) else {
        return 1.0;
    };
    let turns = match drive.law.pieces.as_slice() {
        [LawPiece::ConstantSpeed { .. }] if drive.dimension == Dimension::ANGLE => {
            let (low, high) = drive.law.extent(sampler.parameters());
            (high - low) / TAU
        }
        _ => 1.0,
    };
    let whole = turns.round();
    if whole >= 1.0 && (turns - whole).abs() <= WHOLE {
        whole
    } else {
        1.0
    }
}
