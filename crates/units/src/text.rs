//! Expressions back to text, with as few brackets as they need.

use std::fmt;

use crate::syntax::{BinaryOp, Condition, Kind, Node};
use crate::unit_table::find;
use crate::{Builtin, Expr};
use kempe_number::text::shortest;

/// How tightly a text holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Negation,
    Power,
    Atom,
}

/// Writes `inner`, in brackets if `bracketed`.
fn bracket(f: &mut fmt::Formatter<'_>, bracketed: bool, inner: &dyn fmt::Display) -> fmt::Result {
    if bracketed {
        write!(f, "({inner})")
    } else {
        write!(f, "{inner}")
    }
}

/// Writes a call.
fn list<T: fmt::Display>(f: &mut fmt::Formatter<'_>, name: &str, arguments: &[T]) -> fmt::Result {
    write!(f, "{name}(")?;
    for (i, argument) in arguments.iter().enumerate() {
        write!(f, "{}{argument}", if i == 0 { "" } else { ", " })?;
    }
    f.write_str(")")
}

impl BinaryOp {
    /// As written, with the blanks around it.
    const fn spaced(self) -> &'static str {
        match self {
            Self::Add => " + ",
            Self::Sub => " - ",
            Self::Mul => " * ",
            Self::Div => " / ",
            Self::Pow => "^",
        }
    }

    const fn level(self) -> Level {
        match self {
            Self::Add | Self::Sub => Level::Sum,
            Self::Mul | Self::Div => Level::Product,
            Self::Pow => Level::Power,
        }
    }
}

impl Node {
    fn level(&self) -> Level {
        match &self.kind {
            Kind::Binary { op, .. } => op.level(),
            Kind::Neg(_) => Level::Negation,
            Kind::Line { .. } => Level::Sum,
            _ => Level::Atom,
        }
    }

    /// Whether the text ends in a quantity's unit.
    fn ends_in_unit(&self) -> bool {
        match &self.kind {
            Kind::Quantity(_) => true,
            Kind::Neg(inner) => inner.ends_in_unit(),
            Kind::Binary { right, .. } => right.ends_in_unit(),
            _ => false,
        }
    }

    /// Whether the text starts with a name that a unit would go on with.
    fn starts_with_unit_name(&self) -> bool {
        match &self.kind {
            Kind::Name(name) | Kind::Point(name) => find(name).is_some(),
            Kind::Binary { left, .. } => left.starts_with_unit_name(),
            _ => false,
        }
    }
}

/// The text in one form: blanks around operators except `^`, brackets where needed. Parsing it gives the same tree.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Number(value) => f.write_str(&shortest(*value)),
            Kind::Quantity(quantity) => {
                write!(f, "{} {}", shortest(quantity.value), quantity.unit)
            }
            Kind::Name(name) | Kind::Point(name) => f.write_str(name),
            Kind::Call {
                function,
                arguments,
                ..
            } => list(f, function, arguments),
            Kind::Neg(inner) => {
                f.write_str("-")?;
                bracket(f, inner.level() < Level::Negation, inner)
            }
            Kind::Binary {
                op: BinaryOp::Pow,
                left,
                right,
            } => {
                // `5 mm^2` would raise the unit.
                bracket(
                    f,
                    left.level() < Level::Atom || matches!(left.kind, Kind::Quantity(_)),
                    left,
                )?;
                f.write_str("^")?;
                bracket(f, right.level() < Level::Power, right)
            }
            Kind::Binary { op, left, right } => {
                // `5 m / s` would take `s` for the second.
                let joins = op.level() == Level::Product
                    && right.level() > op.level()
                    && left.ends_in_unit()
                    && right.starts_with_unit_name();
                bracket(f, left.level() < op.level() || joins, left)?;
                f.write_str(op.spaced())?;
                bracket(f, right.level() <= op.level(), right)
            }
            Kind::Line { from, to } => write!(f, "{from} -> {to}"),
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} {} {}",
            self.left,
            self.comparison.symbol(),
            self.right
        )
    }
}

impl fmt::Display for Builtin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl<L> Expr<L> {
    fn level(&self) -> Level {
        match self {
            Self::Const(value) if value.is_sign_negative() => Level::Negation,
            Self::Const(_) | Self::Leaf(_) | Self::Call(..) => Level::Atom,
            Self::Neg(_) => Level::Negation,
            Self::Add(..) | Self::Sub(..) => Level::Sum,
            Self::Mul(..) | Self::Div(..) => Level::Product,
            Self::Powi(..) | Self::Powf(..) => Level::Power,
        }
    }
}

/// The formula in SI: constants are bare numbers, leaves as they show themselves.
impl<L: fmt::Display> fmt::Display for Expr<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let binary = |f: &mut fmt::Formatter<'_>, op: BinaryOp, a: &Self, b: &Self| {
            bracket(f, a.level() < op.level(), a)?;
            f.write_str(op.spaced())?;
            bracket(f, b.level() <= op.level(), b)
        };
        match self {
            Self::Const(value) => f.write_str(&shortest(*value)),
            Self::Leaf(leaf) => write!(f, "{leaf}"),
            Self::Neg(a) => {
                f.write_str("-")?;
                bracket(f, a.level() < Level::Negation, a)
            }
            Self::Add(a, b) => binary(f, BinaryOp::Add, a, b),
            Self::Sub(a, b) => binary(f, BinaryOp::Sub, a, b),
            Self::Mul(a, b) => binary(f, BinaryOp::Mul, a, b),
            Self::Div(a, b) => binary(f, BinaryOp::Div, a, b),
            Self::Powi(a, n) => {
                bracket(f, a.level() < Level::Atom, a)?;
                f.write_str("^")?;
                bracket(f, *n < 0, n)
            }
            Self::Powf(a, p) => {
                bracket(f, a.level() < Level::Atom, a)?;
                f.write_str("^")?;
                bracket(f, *p < 0.0, &shortest(*p))
            }
            Self::Call(builtin, arguments) => list(f, builtin.name(), arguments),
        }
    }
}
