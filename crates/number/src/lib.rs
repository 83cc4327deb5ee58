//! The numbers Kempe's plans run on.
//!
//! A formula written once over [`Number`] gives positions with `f64`, derivatives in the drive with [`Jet`],
//! derivatives to dimensions with [`Dual`], many designs at once with [`Lanes`] and guaranteed bounds with
//! [`Interval`]. [`math`] is the one place elementary functions come from, so that results have the same bits on
//! every target.

mod complex;
mod dispatch;
mod dual;
mod interval;
mod jet;
mod lanes;
pub mod math;
mod number;
mod operators;
mod piecewise;
mod polynomial;
mod power;
mod random;
pub mod text;

pub use complex::Complex;
pub use dispatch::InstructionSet;
pub use dual::Dual;
pub use interval::Interval;
pub use jet::Jet;
pub use lanes::{Lanes, Lanes4, Lanes8};
pub use number::Number;
pub use piecewise::piecewise;
pub use polynomial::polynomial_through;
pub use power::powi;
pub use random::Random;
