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
    /// The drive comes to the place asked for more than once, and it has another value there: that of the first time is told.
    PassedAgain {
        /// When it is there first, s.
        first: f64,
        /// When it is there with another value, s.
        again: f64,
    },
    /// What it is of is as small, or as large, twice, and the time ratio hangs on which is meant: it counts from the first time.
    ExtremeAgain {
        /// Whether it is largest then.
        largest: bool,
        /// When it is so first, s.
        first: f64,
        /// When it is so again, s.
        again: f64,
        /// The ratio by that.
        other: f64,
    },
    /// What it is of changes faster than it was looked at: narrow peaks may be missed.
    TooFast,
}
