//! Dimensions, units and the expression language.

mod dimension;
mod expr;

pub use dimension::Dimension;
pub use expr::{Builtin, Expr};
