//! The tests of `kempe-integrate`, one program: each file is a room of its own.

mod exact;
mod stiff;

#[path = "../support/known.rs"]
mod known;
#[path = "../support/mod.rs"]
mod support;
