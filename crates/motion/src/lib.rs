//! Planar mechanisms in motion: assemblies, following, limits, dead points, change points, circuits.

pub mod assemble;
pub mod bridge;
pub mod check;
pub mod circuit;
pub mod drive_path;
pub mod events;
pub mod four_bar;
pub mod motion;
pub mod progress;
#[doc(hidden)]
pub mod stance;
pub mod temporary_drives;
#[doc(hidden)]
pub mod trace;

pub use check::{Findings, Reach, check, check_with_progress};
pub use motion::{
    Demand, EndReason, LeftDrawing, Motion, MotionError, Placed, PutTogether, SIZES, Solver,
};
pub use progress::{Done, Progress, Silent, Stage, Watch};
pub use stance::Stance;
