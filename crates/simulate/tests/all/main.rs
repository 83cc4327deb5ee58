//! The tests of `kempe-simulate`, one program: each file is a room of its own.

mod absolute;
mod benchmarks;
mod block;
mod change_points;
mod clearance;
mod dead_points;
mod hydraulics;
mod properties;
mod rigid;
mod rubbing;
mod spanning_tree;

#[path = "../common/mod.rs"]
mod common;
#[path = "../../../integrate/tests/support/known.rs"]
mod known;
#[path = "../../../motion/tests/support/mod.rs"]
mod mechanisms;
