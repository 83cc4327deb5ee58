//! The tests of `kempe-alt-burmester`, one program: each file is a room of its own.

mod equations;
mod monodromy;
mod published;
