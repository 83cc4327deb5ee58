//! The tests of `kempe-motion`, one program: each file is a room of its own.

mod circuits;
mod drawn_wheels;
mod drives;
mod gear_loops;
mod large_blocks;
mod limits;
mod newton;
mod progress;
mod prop_assemblies;
mod prop_trace;
mod stance;
mod starts;
mod welds;

#[path = "../support/mod.rs"]
mod support;
