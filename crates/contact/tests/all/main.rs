//! The tests of `kempe-contact`, one program: each file is a room of its own.

mod clearance;
mod friction;
mod geometry;
mod impact;

#[path = "../../../integrate/tests/support/known.rs"]
mod known;
#[path = "../support/mod.rs"]
mod support;
