//! Runs the studies of a model: a pure function from a model to tables with their evidence.
//!
//! Nothing here touches files, clocks, threads or the terminal: a [`Progress`] hears how far a study has come and may
//! stop it, and the writers return bytes. The same model gives the same bytes.
//!
//! ```
//! use kempe_model::Model;
//! use kempe_study::{Silent, encode, run};
//!
//! let text = r#"
//!     units = { length = "mm", angle = "deg" }
//!     [links]
//!     frame   = { A = [0, 0], D = [60, 0] }
//!     crank   = { A-B = 20 }
//!     coupler = { B-C = 50 }
//!     rocker  = { D-C = 40 }
//!     [drives]
//!     motor = { turns = "crank", from = 0, to = 360, speed = "1 rad/s" }
//!     [assembly]
//!     C = "left of B -> D"
//!     [measures]
//!     swing = "angle(rocker)"
//! "#;
//! let model = Model::from_toml(text, "four-bar", &mut |_| Err("no files".into())).unwrap().model;
//! let result = run(&model, &model.studies[0], &mut Silent).unwrap();
//! let swing = result.table.column("swing").unwrap();
//! assert_eq!(swing.head(), "swing [deg]");
//! // Crank-rocker 20, 50, 40, 60 mm at 0 deg: cos(180 deg - swing) = (40^2 + 40^2 - 50^2) / (2 * 40 * 40).
//! assert!((swing.values[0] - 102.635_625_093_02).abs() < 1e-10);
//! assert!(encode::csv(&result.table).starts_with("time [s],motor [deg],swing [deg],closure [1]"));
//! ```

mod adjust;
mod along;
mod alternatives;
mod choice;
mod circuit;
mod clearance;
mod columns;
mod comparison;
mod designs;
mod dimensions;
mod drawn;
pub mod encode;
mod events;
mod explain;
mod extremes;
mod figures;
mod figures_against;
mod findings;
mod findings_forces;
mod findings_text;
mod force_columns;
mod force_notes;
mod gap;
mod group_text;
mod hints;
mod lone_points;
mod missing;
mod motion;
mod motion_findings;
mod named;
mod number_notes;
mod parameters_section;
mod plotted;
mod point_vectors;
mod pose;
mod prepared;
mod proof;
mod proved_numbers;
mod quantity;
mod report;
mod report_against;
mod report_designs;
mod report_motion;
mod report_origin;
mod report_shapes;
mod result;
mod room;
mod room_of_kinds;
mod rows;
mod run;
mod run_motion;
mod run_one;
mod sensitivities;
mod shows;
mod simulation;
mod sink;
mod slot_ends;
mod slots_along;
mod synthesis;
mod table;
mod unit;
pub mod verify;
mod vibrations;
mod view;
mod weak_between;
mod words;

pub use along::{Along, Row, RowForces, force_problems};
pub use comparison::{Axis, Comparison, Design, Kind, Pair, StudyPair, compare};
#[doc(hidden)]
pub use designs::{Otherwise, optimum_otherwise};
pub use designs::{Parts, compute_parts, most_parts, part_count};
#[cfg(feature = "parquet")]
pub use designs::{RowFiles, RowsError};
pub use dimensions::dimensions;
pub use explain::{beyond_limit, cannot_move};
pub use extremes::{Extreme, Extremes, extremes, without_rounding};
pub use figures::{MECHANISM, figures};
pub use figures_against::figures_against;
pub use findings::{Grashof, Group, Report as CheckReport, check, check_with_progress};
pub use kempe_motion::progress::{Done, Progress, Silent, Stage, Watch};
pub use motion_findings::motion_findings;
pub use named::study_named;
pub use number_notes::number_notes;
pub use pose::{Setting, ShownPose, loaded_at, pose_at};
pub use proof::{Proof, Unproved, prove};
pub use proved_numbers::ProvedNumber;
pub use quantity::Quantity;
pub use report::report;
pub use report_against::{of_other_design, outline};
pub use report_designs::design_picture;
pub use report_origin::{ReportAgainst, ReportOrigin};
pub use result::{
    Event, Figure, FoundDesign, Frame, Listing, ModeShape, Scalar, StudyOutcome, StudyResult,
};
pub use room::{Held, MAX_STUDY_BYTES};
pub use rows::RowPlace;
pub use run::{room_for, run, run_in_parts, run_with, study_bytes};
pub use run_motion::run_motion;
pub use sensitivities::{Derivative, MeasureSensitivity, Sensitivities, sensitivities};
pub use slot_ends::slot_note;
pub use table::{Column, ForceColumns, Table};
pub use unit::{Units, shown};
pub use view::{drawing_frames, drawn, mechanism_view};
