//! The tests of `kempe-units`, one program: each file is a room of its own.

mod check;
mod eval;
mod prop_language;
mod syntax;
mod units;
