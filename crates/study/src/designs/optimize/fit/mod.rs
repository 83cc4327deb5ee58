//! Fits: designs whose point or link comes near to given places, in least squares.
//!
//! Where along its way each place is met is no unknown of the search: it follows from the design, and is eliminated from the residuals' derivatives
//! (variable projection: G. H. Golub and V. Pereyra 1973, in L. Kaufman's form of 1975). `way.rs` is the way of what is traced, `met.rs` where places of it are met; `order.rs` and `nearest.rs`
//! find where places are met that have no timing, `pace.rs` the others; `fitted.rs` has the misses of a design with their derivatives. `goal.rs` is the goal that stands for them, `search.rs` looks for designs, `sums.rs` is what it goes down, `begin.rs` says what cannot be fitted, `told.rs` what
//! is told besides.

mod begin;
mod fitted;
mod goal;
mod met;
mod nearest;
mod order;
mod pace;
mod search;
mod sums;
#[cfg(test)]
mod tests;
mod told;
mod way;

pub(super) use begin::before;
pub(super) use fitted::{Fitted, Pairing, sum};
pub(super) use goal::with_goal;
pub(super) use search::{fitted, led};
pub(super) use told::tell;
