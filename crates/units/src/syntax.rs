//! The tree of an expression as it was written, with byte spans.

use crate::Unit;
use crate::issue::Span;

/// Constants of the language.
pub const CONSTANTS: &[(&str, f64)] = &[("pi", std::f64::consts::PI)];

/// A part of an expression and where it stands. Brackets leave no node: they show in the shape of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// What it is.
    pub kind: Kind,
    /// Where it stands, without brackets around it.
    pub span: Span,
}

/// What a part of an expression is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A number without a unit.
    Number(f64),
    /// A number with its unit.
    Quantity(Quantity),
    /// A name that starts with a small letter: a parameter, link, drive, measure or constant.
    Name(String),
    /// A name that starts with a capital: a point.
    Point(String),
    /// A call.
    Call {
        /// The function's name.
        function: String,
        /// Where the name stands.
        function_span: Span,
        /// The arguments.
        arguments: Vec<Node>,
    },
    /// Negation.
    Neg(Box<Node>),
    /// Two operands. A pair of points `A-B` is a difference here: who reads it knows that both sides are points.
    Binary {
        /// The operator.
        op: BinaryOp,
        /// Left of it.
        left: Box<Node>,
        /// Right of it.
        right: Box<Node>,
    },
    /// The directed line `A -> B`; only as an argument.
    Line {
        /// The point it starts from.
        from: Box<Node>,
        /// The point it goes to.
        to: Box<Node>,
    },
}

/// A number with its unit, as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
    /// Where the unit stands.
    pub unit_span: Span,
    /// The names in the unit that follow a `*`, `·` or `/` and so could be read as something declared.
    pub joined: Vec<JoinedUnit>,
}

/// A unit's name behind `*`, `·` or `/`.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedUnit {
    /// As written.
    pub name: String,
    /// Where.
    pub span: Span,
    /// Whether the operator is a `/` without blanks around it, as in `mm/s`.
    pub tight_division: bool,
}

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// `+`.
    Add,
    /// `-`.
    Sub,
    /// `*`.
    Mul,
    /// `/`.
    Div,
    /// `^`.
    Pow,
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `<=`.
    LessEqual,
    /// `>=`.
    GreaterEqual,
    /// `<`.
    Less,
    /// `>`.
    Greater,
}

impl Comparison {
    /// As written: `<=`.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::LessEqual => "<=",
            Self::GreaterEqual => ">=",
            Self::Less => "<",
            Self::Greater => ">",
        }
    }

    /// Whether it holds; never with NaN.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::LessEqual => left <= right,
            Self::GreaterEqual => left >= right,
            Self::Less => left < right,
            Self::Greater => left > right,
        }
    }
}

/// A condition: two expressions and a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Left side.
    pub left: Node,
    /// The comparison.
    pub comparison: Comparison,
    /// Where the comparison stands.
    pub comparison_span: Span,
    /// Right side.
    pub right: Node,
}

impl Node {
    /// The node of `kind` at `span`.
    pub fn new(kind: Kind, span: Span) -> Self {
        Self { kind, span }
    }

    /// The name of the point, if this is one.
    pub fn as_point(&self) -> Option<&str> {
        match &self.kind {
            Kind::Point(name) => Some(name),
            _ => None,
        }
    }

    /// The name, if this is one that starts with a small letter.
    pub fn as_name(&self) -> Option<&str> {
        match &self.kind {
            Kind::Name(name) => Some(name),
            _ => None,
        }
    }

    /// The points of a pair `A-B`, if this is one.
    pub fn as_pair(&self) -> Option<(&str, &str)> {
        match &self.kind {
            Kind::Binary {
                op: BinaryOp::Sub,
                left,
                right,
            } => Some((left.as_point()?, right.as_point()?)),
            _ => None,
        }
    }

    /// The points of a directed line `A -> B`, if this is one.
    pub fn as_line(&self) -> Option<(&str, &str)> {
        match &self.kind {
            Kind::Line { from, to } => Some((from.as_point()?, to.as_point()?)),
            _ => None,
        }
    }

    /// The value of a bare number literal, possibly negated: `5`, `-0.4`.
    pub fn as_bare_number(&self) -> Option<f64> {
        match &self.kind {
            Kind::Number(value) => Some(*value),
            Kind::Neg(inner) => inner.as_bare_number().map(|value| -value),
            _ => None,
        }
    }

    /// All names that start with a small letter and are not called, in the order of writing: what a text depends on.
    pub fn names(&self) -> Vec<(&str, Span)> {
        let mut out = Vec::new();
        self.visit(&mut |node| {
            if let Some(name) = node.as_name() {
                out.push((name, node.span.clone()));
            }
        });
        out
    }

    /// Calls `f` on this node and all below it, in the order of writing.
    pub fn visit<'a>(&'a self, f: &mut impl FnMut(&'a Self)) {
        f(self);
        match &self.kind {
            Kind::Number(_) | Kind::Quantity(_) | Kind::Name(_) | Kind::Point(_) => {}
            Kind::Call { arguments, .. } => arguments.iter().for_each(|argument| argument.visit(f)),
            Kind::Neg(inner) => inner.visit(f),
            Kind::Binary { left, right, .. }
            | Kind::Line {
                from: left,
                to: right,
            } => {
                left.visit(f);
                right.visit(f);
            }
        }
    }
}
