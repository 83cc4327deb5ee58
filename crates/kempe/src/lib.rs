//! A workbench for planar linkages: describe a mechanism once, then ask it anything.
//!
//! ```
//! use kempe::prelude::*;
//!
//! # fn main() -> Result<(), kempe::Error> {
//! let model: Model = r#"
//!     units = { length = "mm", angle = "deg" }
//!     [parameters]
//!     a = "20 mm"
//!     [links]
//!     frame   = { A = [0, 0], D = [60, 0] }
//!     crank   = { A-B = "a" }
//!     coupler = { B-C = 50, P = [25, 0] }
//!     rocker  = { D-C = 40 }
//!     [drives]
//!     motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
//!     [assembly]
//!     C = "left of B -> D"
//!     [measures]
//!     swing = "angle(rocker)"
//!     play  = "range(swing)"
//! "#
//! .parse()?;
//!
//! // The rocker of the crank-rocker 20, 50, 40, 60 mm (closed form of Freudenstein, 1955).
//! let motion = model.motion()?;
//! let swing = motion.table.column("swing").unwrap();
//! assert_eq!(swing.head(), "swing [deg]");
//! assert!((swing.values[60] - 97.562_217_639_34).abs() < 1e-10);
//! assert!((motion.scalars[0].value - 60.032_348_552_12).abs() < 1e-10);
//! assert!(motion.table.worst_closure() < 1e-12);
//!
//! // One pose, SI.
//! let pose = model.pose("motor = 60 deg")?;
//! let [x, y] = pose.point("P").unwrap();
//! assert!((x - 0.032_367_945_446_74).abs() < 1e-13 && (y - 0.028_486_304_800_13).abs() < 1e-13);
//!
//! // Another design: with a = 25 mm the play grows.
//! assert!(model.with("a", "25 mm")?.motion()?.scalars[0].value > 75.0);
//! # Ok(())
//! # }
//! ```
//!
//! Lengths are in metres and angles in radians wherever no unit stands beside them; tables carry their units. The same
//! model gives the same bytes on every machine.
//!
//! The parts that this crate puts together are there under their own names: [`number`], [`units`], [`model`],
//! [`mechanism`], [`homotopy`], [`motion`], [`measure`], [`proof`], [`dynamics`], [`study`], [`draw`].

mod error;
mod facade;

pub use error::Error;
pub use facade::{Model, Pose};
pub use kempe_study::{CheckReport, Column, StudyResult, Table};

pub use kempe_draw as draw;
pub use kempe_dynamics as dynamics;
pub use kempe_homotopy as homotopy;
pub use kempe_measure as measure;
pub use kempe_mechanism as mechanism;
pub use kempe_model as model;
pub use kempe_motion as motion;
pub use kempe_number as number;
pub use kempe_proof as proof;
pub use kempe_study as study;
pub use kempe_units as units;

/// What most programs need.
pub mod prelude {
    pub use crate::{CheckReport, Column, Error, Model, Pose, StudyResult, Table};
    pub use kempe_model::Diagnostic;
    pub use kempe_study::{Flow, Progress};
}
