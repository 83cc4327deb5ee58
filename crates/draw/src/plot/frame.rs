//! The frame of a plot.

/// The inside of the axes: left, bottom, right, top, mm.
pub(super) type Frame = [f64; 4];
