//! The tests of `kempe-linear`, one program: each file is a room of its own.

mod complementarity;
mod eigen;
mod singular;
