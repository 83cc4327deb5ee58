//! Exact synthesis of planar linkages: from what they are to do, all that do it.
//!
//! | file | for |
//! | --- | --- |
//! | `motion.rs`, `sliders.rs` | dyads that guide a body through two to five poses |
//! | `burmester_curve.rs` | the curves of all pivots of four poses |
//!
//! Lengths are in any one unit, angles in rad, counter-clockwise positive; plane vectors are complex numbers.

mod burmester_curve;
mod conics;
mod displacements;
mod dyad;
mod error;
mod kernel;
mod motion;
mod polynomial;
mod pose;
mod sliders;

pub use kempe_linear::C;

pub use burmester_curve::{BurmesterCurve, CurveDrawing, CurvePiece, CurvePoint};
pub use dyad::{Dyad, DyadSolution};
pub use error::SynthesisError;
pub use motion::{DyadCondition, dyads};
pub use pose::{Line, Pose, image_pole, pole};
pub use sliders::{SliderCondition, fixed_guides, moving_guides};
