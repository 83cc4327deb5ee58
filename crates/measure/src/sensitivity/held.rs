//! What stays while a parameter changes.

/// What stays while a parameter changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The path parameter: the coordinate of the only moving drive (SI), or time when several move.
    Path(f64),
    /// Time, s.
    Time(f64),
    /// None: the place is the end of a law's piece, or of the motion, that is nearest to this time, s, and goes with it.
    Break(f64),
    /// None: the place is the local extreme of one of the measures, by its index, that was found at this time, s, and goes with it. Of the other measures
    /// no derivatives are taken.
    Extreme {
        /// Of which measure.
        of: usize,
        /// When, s.
        time: f64,
    },
}
