//! The tests of `kempe-number`, one program: each file is a room of its own.

mod complex;
mod interval;
mod jet;
mod sin_cos;
