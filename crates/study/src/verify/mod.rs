//! Validation cases: a model, places and measures, and the reference values they are held to.
//!
//! A case is a TOML file:
//!
//! ```toml
//! title  = "Crank-rocker"
//! model  = "../examples/seeds/crank-rocker.toml"   # from this file
//! source = "S. Author, Journal 1 (1990) 2, table 3"
//! study  = "swing"                                 # whose motion, of a simulation, or whose columns; the drives' laws without it
//! set    = { a = "20 mm" }                         # parameters, if others than the file's
//!
//! [[table]]                                        # a reference table: head and rows as `kempe run` writes them
//! file = "crank-rocker.csv"                        # from this file; or rows = """…""" right here
//!
//! [[value]]                                        # one number
//! measure = "range(angle(rocker))"
//! expect  = "60.032348552120 deg"
//!
//! [[value]]
//! at      = "motor = 90 deg"
//! measure = "y(C)"
//! expect  = "37.742 mm"
//! source  = "closed form"
//!
//! [[value]]                                        # of a study of clearance that loses contact: how many contacts (or "contacts at B")
//! measure = "contacts"
//! expect  = "25"
//!
//! [[value]]                                        # the second of them (or "contact at B = 2"): its time, speed, speed after, until, lasts,
//! at      = "contact = 2"                          # largest force or deepest, as the study lists them, or a measure just before it
//! measure = "speed"
//! expect  = "2.267401295 m/s"
//!
//! [[value]]                                        # where a limit or change point is: the nearest one counts
//! event   = "change-point"
//! expect  = "117.5122065166410849 deg"
//!
//! [[value]]                                        # a number of `kempe check --json`
//! check   = "mobility_rank"
//! expect  = 1
//!
//! [[value]]                                        # of a case of another study: its columns and numbers, not measures
//! at      = "lock = -40 deg"
//! measure = "th2 deviation"
//! expect  = "-8.32e-5 rad"
//! ```
//!
//! The first column of a table is a drive or `time`; the others are measures. A reference written with a decimal point is
//! as good as its digits; one without is exact. A value passes when it differs by no more than half a unit of the last
//! digit written, which is the reference's rounding, and `tolerance` besides, which is ours (relative, 1e-12 unless said
//! otherwise; for tables relative to the largest value of the column, since a zero crossing has no relative error).
//! Angles are compared modulo whole turns.

mod case;
mod compare;
mod of_study;
mod quantity;

pub use case::{Case, CaseError, Expected, Target};
pub use compare::{Comparison, compare};
