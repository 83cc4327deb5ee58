//! The tests of `kempe-mechanism`, one program: each file is a room of its own.

mod curve;
mod pilots;
