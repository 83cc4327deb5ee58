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
//! let motion = model.run_first()?;
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
//! assert!(model.with("a", "25 mm")?.run_first()?.scalars[0].value > 75.0);
//! # Ok(())
//! # }
//! ```
//!
//! A program that asks more than the file does compiles the model and asks a [`Session`]: any measure at any place, other
//! values of the parameters, derivatives, poses dragged on from the last one, many designs at once.
//!
//! ```
//! # fn main() -> Result<(), kempe::Error> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
//! use kempe::{Designs, Model, linspace};
//!
//! let hitch = Model::from_path(path)?.compile()?;
//! let mut s = hitch.session();
//! s.set_text("weight", "12 kN")?; // or in SI: s.set("weight", 12_000.0)
//! let t = s.sweep("lift", linspace(0.38, 0.52, 50), &["y(M)", "force(lift)", "reaction(K)"])?;
//! assert!(t.columns[1].values.iter().all(|force| *force > 0.0));
//! let j = s.derivatives(&["max(push)"], &["weight", "pace"])?;
//! assert!((j.get(0, 0) - 5.687_030_329_81).abs() < 1e-9 && j.get(0, 1) == 0.0);
//!
//! let p = s.pose([("lift", 0.40)])?;
//! let p = s.pose_near(&p, "lift", 0.41)?; // microseconds from the last pose, for dragging
//! assert!(p.point("M")?[1] > 0.1);
//!
//! let designs = Designs::from_columns([("weight", linspace(8e3, 12e3, 3))])?;
//! let v = s.many(&designs, [0.38, 0.45], &["y(S)", "push"])?;
//! assert_eq!(v.missing, [0, 0]);
//! # Ok(())
//! # }
//! ```
//!
//! A file may ask for linkages; what a study finds are models again:
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/function-generator.toml");
//! let result = kempe::Model::from_path(path)?.run("crank-first")?;
//! let best: kempe::Model = result.designs[0].file.toml.parse()?;
//! assert_eq!(best.run("motion")?.table.rows(), 181);
//! # Ok(())
//! # }
//! ```
//!
//! Everything that comes back is owned, and `Send + Sync`. Lengths are in metres and angles in radians wherever no unit stands beside them; tables carry their units. The same
//! model gives the same bytes on every machine.
//!
//! The parts that this crate puts together are there under their own names: [`number`], [`units`], [`model`],
//! [`mechanism`], [`homotopy`], [`motion`], [`measure`], [`proof`], [`dynamics`], [`simulate`], [`synthesis`], [`study`], [`draw`].

mod asked;
mod block;
mod closing;
mod compiled;
mod derivatives;
mod equations;
mod error;
mod executor;
mod facade;
mod known_motions;
mod many;
mod motion_data;
mod pose;
mod posing;
mod session;
mod sweep;
mod way;

pub use block::{Block, Heading, Value, linspace};
pub use compiled::Compiled;
pub use derivatives::Derivatives;
pub use error::Error;
pub use facade::Model;
pub use kempe_motion::EndReason;
pub use kempe_motion::events::EventKind;
pub use kempe_study::{
    CheckReport, Column, Done, ForceColumns, Progress, Silent, Stage, StudyResult, Table,
};
pub use many::{Designs, Many};
pub use motion_data::{AssemblyData, MotionData, MotionEvent};
pub use pose::Pose;
pub use session::Session;
pub use sweep::Sweep;

pub use kempe_batch as batch;
pub use kempe_draw as draw;
pub use kempe_dynamics as dynamics;
pub use kempe_homotopy as homotopy;
pub use kempe_measure as measure;
pub use kempe_mechanism as mechanism;
pub use kempe_model as model;
pub use kempe_motion as motion;
pub use kempe_number as number;
pub use kempe_proof as proof;
pub use kempe_simulate as simulate;
pub use kempe_study as study;
pub use kempe_synthesis as synthesis;
pub use kempe_units as units;

/// What most programs need.
pub mod prelude {
    pub use crate::{
        Block, CheckReport, Column, Compiled, Derivatives, Designs, Done, Error, Many, Model, Pose,
        Progress, Session, Silent, StudyResult, Sweep, Table, linspace,
    };
    pub use kempe_model::Diagnostic;
}
