//! What is to be told of a number over a motion.

/// What a careful engineer would want to be told of a number over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StatisticNote {
    /// What it is of is infinite somewhere.
    Infinite {
        /// When, s.
        time: f64,
    },
    /// The integral does not exist: what it is of runs away too fast.
    Diverges {
        /// When, s.
        time: f64,
    },
    /// The integral did not settle.
    Unsettled {
        /// So many digits hold.
        digits: u32,
    },
    /// What it is of changes faster than it was looked at: narrow peaks may be missed.
    TooFast,
}
