//! Exact synthesis of planar linkages: from what they are to do, all that do it.
//!
//! | file | for |
//! | --- | --- |
//! | `motion.rs`, `sliders.rs`, `timed.rs` | dyads that guide a body through two to five poses |
//! | `guidance_fit.rs` | dyads that come near to six and more |
//! | `four_bar_fit.rs` | four-bars that do, as a whole |
//! | `burmester_curve.rs` | the curves of all pivots of four poses |
//! | `linkage.rs`, `four_bar.rs`, `slider_crank.rs`, `defects.rs` | pairs of dyads, how their links turn, and whether they pass the poses on one circuit, on one branch and in order |
//! | `function.rs` and its folder | four-bars and slider-cranks that turn or slide as a crank's angle asks: exactly, or in least squares |
//! | `path.rs` and its folder, `cognates.rs` | four-bars whose coupler point passes points; the three of one curve |
//! | `dwell.rs`, `stretches.rs`, `nearest_curve.rs` | levers and sliders that rest while a point goes along an arc or a line |
//! | `bloch.rs`, `dead_centres.rs` | four-bars by rates at a pose; crank-rockers and slider-cranks by stroke and time ratio |
//!
//! Lengths are in any one unit, angles in rad, counter-clockwise positive; plane vectors are complex numbers.

mod bloch;
mod burmester_curve;
mod cognates;
mod conics;
mod dead_centres;
mod defects;
mod displacements;
mod dwell;
mod dyad;
mod error;
mod four_bar;
mod four_bar_fit;
mod function;
mod guidance_fit;
mod kernel;
mod linkage;
mod motion;
mod nearest_curve;
mod newton;
mod one_dimension;
mod path;
mod polynomial;
mod pose;
mod slider_crank;
mod sliders;
mod stretches;
mod timed;

pub use kempe_linear::C;

pub use bloch::{LinkRates, VectorLoop, bloch};
pub use burmester_curve::{BurmesterCurve, CurveDrawing, CurvePiece, CurvePoint};
pub use cognates::{CouplerCurve, ParallelMotion};
pub use dead_centres::{
    CrankRocker, LONGEST_COUPLER, SliderCrankChoice, StrokeSliderCrank, best_crank_rocker,
    best_stroke_slider_crank, crank_rockers, imbalance, stroke_slider_crank, time_ratio,
};
pub use defects::{Passage, passage};
pub use dwell::{DwellLever, DwellSlider, DwellSlot, Rest};
pub use dyad::{Dyad, DyadSolution};
pub use error::{OnCurve, SynthesisError};
pub use four_bar::{Driver, FourBar, Grashof, Turning};
pub use four_bar_fit::{PivotBoxes, fit_four_bars};
pub use function::{
    DialZeros, Dials, Fit, FunctionFourBar, InvertedSliderFunction, PrecisionPoint, SliderFit,
    SliderFunction, SliderPoint, TwoLengths, chebyshev_spacing, fit_driven_function,
    fit_driven_slider_function, fit_function, fit_lengths, fit_slider_function, functions,
    inverted_slider_functions, slider_functions, two_lengths,
};
pub use guidance_fit::{DyadFit, fit_dyads};
pub use linkage::{Linkage, pairs};
pub use motion::{DyadCondition, dyads};
pub use nearest_curve::{NearestCircle, NearestLine, nearest_circle, nearest_line};
pub use one_dimension::golden;
pub use path::{
    FourBarThrough, FourBarsThrough, GroundPivotPaths, PathLinkage, four_bars_through,
    paths_with_crank, paths_with_ground_pivots, timed_paths,
};
pub use pose::{Line, Pose, image_pole, pole};
pub use slider_crank::{InvertedSliderCrank, SliderCrank};
pub use sliders::{SliderCondition, fixed_guides, moving_guides};
pub use stretches::{Stretch, Way, stretches};
pub use timed::timed_dyad;
