//! Dimensions, units and the expression language of Kempe's model files.
//!
//! A text goes through three steps, each of which reports all it finds:
//!
//! 1. [`parse`] turns it into a tree of [`Node`]s with byte spans. Units are read here ([`Unit`]).
//! 2. [`check`] (or [`check_as`], where a dimension is expected) resolves names through a [`Resolver`], checks
//!    every [`Dimension`] and turns constants to SI. The result is an [`Expr`].
//! 3. [`Expr::eval`] runs it on any [`Number`](kempe_number::Number).
//!
//! # Example
//!
//! ```
//! use kempe_units::{Dimension, Issue, Node, Resolver, Span, Unit, check_as, parse};
//!
//! /// A file with one parameter, `crank`.
//! struct File;
//! impl Resolver<&'static str> for File {
//!     fn name(&mut self, name: &str, span: Span) -> Result<(&'static str, Dimension), Issue> {
//!         match name {
//!             "crank" => Ok(("crank", Dimension::LENGTH)),
//!             _ => Err(Issue::unknown_name(name, span, ["crank"])),
//!         }
//!     }
//! }
//!
//! let node = parse("2*crank + 5 mm").unwrap();
//! let (length, _) = check_as(&node, &mut File, Dimension::LENGTH, &Unit::parse("mm").unwrap()).unwrap();
//! assert_eq!(length.eval(&mut |_| 0.02), 0.045);
//!
//! let node = parse("2*crank + 5 deg").unwrap();
//! let issues = check_as(&node, &mut File, Dimension::LENGTH, &Unit::parse("mm").unwrap()).unwrap_err();
//! assert_eq!(issues[0].message, "a length plus an angle");
//! ```

mod builtin;
mod check;
mod dimension;
mod display_unit;
mod eval;
mod expr;
mod issue;
mod lexer;
mod parser;
mod spell;
mod suggest;
mod syntax;
mod text;
mod unit;
mod unit_table;

pub use builtin::Builtin;
pub use check::{CheckedCondition, Resolver, check, check_as, check_condition};
pub use dimension::Dimension;
pub use eval::{EvalError, EvalFault};
pub use expr::{Expr, Leaves};
pub use issue::{Issue, Span, SyntaxError};
pub use parser::{MAX_DEPTH, MAX_LENGTH, parse, parse_argument, parse_condition};
pub use spell::{Freedom, Natural, Spelling};
pub use suggest::nearest;
pub use syntax::{BinaryOp, CONSTANTS, Comparison, Condition, JoinedUnit, Kind, Node, Quantity};
pub use unit::{Unit, format_digits};
pub use unit_table::{UNITS, UnitDefinition};
