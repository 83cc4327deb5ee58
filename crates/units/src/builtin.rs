//! The functions of the expression language that act on numbers alone.

/// A function of the expression language that acts on numbers alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Builtin {
    /// Sine of an angle.
    Sin,
    /// Cosine of an angle.
    Cos,
    /// Tangent of an angle.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc cosine.
    Acos,
    /// Arc tangent.
    Atan,
    /// `atan2(y, x)`.
    Atan2,
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Smallest of two or more.
    Min,
    /// Largest of two or more.
    Max,
    /// `hypot(x, y)`.
    Hypot,
}

impl Builtin {
    /// All of them, in the order of the reference.
    pub const ALL: [Self; 14] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Atan2,
        Self::Sqrt,
        Self::Abs,
        Self::Exp,
        Self::Ln,
        Self::Min,
        Self::Max,
        Self::Hypot,
    ];

    /// As written: `atan2`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Atan2 => "atan2",
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Min => "min",
            Self::Max => "max",
            Self::Hypot => "hypot",
        }
    }

    /// The function written `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|builtin| builtin.name() == name)
    }

    /// The call as a pattern, for help lines: `atan2(y, x)`.
    pub const fn usage(self) -> &'static str {
        match self {
            Self::Sin => "sin(angle)",
            Self::Cos => "cos(angle)",
            Self::Tan => "tan(angle)",
            Self::Asin => "asin(number)",
            Self::Acos => "acos(number)",
            Self::Atan => "atan(number)",
            Self::Atan2 => "atan2(y, x)",
            Self::Sqrt => "sqrt(x)",
            Self::Abs => "abs(x)",
            Self::Exp => "exp(number)",
            Self::Ln => "ln(number)",
            Self::Min => "min(x, y, …)",
            Self::Max => "max(x, y, …)",
            Self::Hypot => "hypot(x, y)",
        }
    }

    /// Whether it takes `count` arguments.
    pub const fn takes(self, count: usize) -> bool {
        match self {
            Self::Min | Self::Max => count >= 2,
            Self::Atan2 | Self::Hypot => count == 2,
            _ => count == 1,
        }
    }
}
