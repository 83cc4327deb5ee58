//! The tests of `kempe-measure`, one program: each file is a room of its own.

mod any_number;
mod gallery;
mod narrow;
mod over_motion;
mod prop_motion;
mod prop_numbers;
mod prop_statistics;
mod seeds;
mod sensitivity;

#[path = "../../../motion/tests/support/mod.rs"]
mod support;
