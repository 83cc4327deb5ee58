//! Smallest and largest value of a measure, as whoever found them hands them on.

use kempe_model::Measure;

/// A time with a value.
pub(crate) type At = (f64, f64);

/// The extremes of a measure over the motion.
#[derive(Clone, Debug)]
pub(crate) struct Extremes {
    pub measure: Measure,
    /// Its smallest and largest value with their times, of samples only where no statistic asks for the one; `None` where it has no value somewhere, or was not asked for them.
    pub found: Option<(At, At)>,
    /// Times at which it is as small, and as large, but for rounding.
    pub rivals: [Vec<f64>; 2],
    /// When it is smallest, and largest, as its time ratio counts, where one is asked for.
    pub strokes: Option<[f64; 2]>,
}
