//! The tests of `kempe-synthesis`, one program: each file is a room of its own.

mod alt_burmester;
mod curve;
mod defects;
mod dwell;
mod function;
mod hostile;
mod motion;
mod nearest_curve;
mod path;
mod rates_and_strokes;

#[path = "../support/mod.rs"]
mod support;
