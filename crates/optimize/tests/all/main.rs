//! The tests of `kempe-optimize`, one program: each file is a room of its own.

mod global;
mod hock_schittkowski;
mod inside;
mod least_squares;
mod pareto;
mod quadratic;
mod sqp;
mod steering;

#[path = "../support/mod.rs"]
mod support;
