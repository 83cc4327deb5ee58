//! All four-bars whose coupler takes M poses and passes 10 - 2 M points further: Alt's nine points (M = 1) and its kin with two to four poses.
//!
//! | file | for |
//! | --- | --- |
//! | `given.rs`, `equations.rs` | the problem in isotropic coordinates, and its linear systems, solved place by place |
//! | `flock.rs`, `tracker.rs`, `follow.rs` | solutions led from data to other data: in lanes, each lane by its own steps; all of them, on threads |
//! | `double.rs` | twice the digits, for paths that need them |
//! | `class.rs` | what relabelling and cognates leave alone: by it solutions are told apart |
//! | `monodromy.rs`, `starts.rs` | all solutions of generic data, found from a single one; as bytes |
//! | `solve.rs` | all solutions of given data, led there from generic ones |
//! | `real.rs`, `certify.rs` | which are linkages, and the proof that they exist |
//!
//! Lengths are in any one unit, angles in rad.

mod certify;
mod class;
mod double;
mod equations;
mod flock;
mod follow;
mod given;
mod monodromy;
mod real;
mod solve;
mod starts;
mod tracker;

pub use certify::{Bounds, Proved};
pub use class::{Class, cognate};
pub use equations::{PIVOTS, State, UNKNOWNS, correction, residuals, with_turns};
pub use follow::{Progress, follow_all};
pub use given::{Given, Kind, PLACES, TURNS};
pub use monodromy::{Found, made_up, monodromy};
pub use real::real;
pub use solve::{Solved, solve};
pub use starts::StartSet;
pub use tracker::{CARES, Care, End};
