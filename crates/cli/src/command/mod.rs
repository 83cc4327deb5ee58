//! The verbs, one a file.

pub mod check;
pub mod draw;
pub mod lists;
pub mod merge;
pub mod new;
pub mod run;
pub mod sensitivities;
pub mod verify;
