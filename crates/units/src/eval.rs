//! Expressions to values, on any number.

use std::fmt;

use kempe_number::{Number, powi};

use crate::{Builtin, Expr};

impl<L> Expr<L> {
    /// The value on the number `T`, each leaf's value asked of `leaf`, which is called in the order of writing.
    ///
    /// Only operations of [`Number`] are used: `tan x = sin x / cos x`, `asin x = atan2(x, sqrt((1 - x)(1 + x)))`,
    /// `acos x = atan2(sqrt((1 - x)(1 + x)), x)`, `hypot(x, y) = sqrt(x^2 + y^2)`, whole powers by repeated squaring,
    /// powers of one half by the square root, other powers `x^p = exp(p ln x)`.
    ///
    /// Where the value is undefined the result is NaN or infinite, as the number type says it.
    pub fn eval<T: Number>(&self, leaf: &mut impl FnMut(&L) -> T) -> T {
        match self {
            Self::Const(value) => T::from_f64(*value),
            Self::Leaf(name) => leaf(name),
            Self::Neg(a) => -a.eval(leaf),
            // A constant operand goes in as a plain number, which is cheaper on rich number types.
            Self::Add(a, b) => match (&**a, &**b) {
                (_, Self::Const(b)) => a.eval(leaf) + *b,
                (Self::Const(a), _) => b.eval(leaf) + *a,
                _ => a.eval(leaf) + b.eval(leaf),
            },
            Self::Sub(a, b) => match &**b {
                Self::Const(b) => a.eval(leaf) - *b,
                _ => a.eval(leaf) - b.eval(leaf),
            },
            Self::Mul(a, b) => match (&**a, &**b) {
                (_, Self::Const(b)) => a.eval(leaf) * *b,
                (Self::Const(a), _) => b.eval(leaf) * *a,
                _ => a.eval(leaf) * b.eval(leaf),
            },
            Self::Div(a, b) => match &**b {
                Self::Const(b) => a.eval(leaf) / *b,
                _ => a.eval(leaf) / b.eval(leaf),
            },
            Self::Powi(a, n) => powi(a.eval(leaf), *n),
            Self::Powf(a, p) => powf(a.eval(leaf), *p),
            Self::Call(builtin, arguments) => call(*builtin, arguments, leaf),
        }
    }

    /// The value on `f64`, or the first part of the expression that has none.
    ///
    /// # Errors
    ///
    /// The innermost part whose value is not finite though its operands' are, and why.
    ///
    /// # Example
    ///
    /// ```
    /// use kempe_units::{Builtin, EvalFault, Expr};
    /// let root = Expr::Call(Builtin::Sqrt, vec![Expr::Leaf("x")]);
    /// assert_eq!(root.eval_f64_checked(&mut |_| 4.0), Ok(2.0));
    /// let error = root.eval_f64_checked(&mut |_| -4.0).unwrap_err();
    /// assert_eq!(error.fault, EvalFault::NegativeRoot);
    /// assert_eq!(error.to_string(), "the square root of a negative number in `sqrt(x)`");
    /// ```
    pub fn eval_f64_checked<'a>(
        &'a self,
        leaf: &mut impl FnMut(&'a L) -> f64,
    ) -> Result<f64, EvalError<'a, L>> {
        let fault = |fault| Err(EvalError { expr: self, fault });
        let children = self.children();
        let mut operands = Vec::with_capacity(children.len());
        for child in children {
            operands.push(child.eval_f64_checked(leaf)?);
        }
        let value = match (self, operands.as_slice()) {
            (Self::Const(value), _) => *value,
            (Self::Leaf(name), _) => leaf(name),
            (Self::Neg(_), [a]) => -a,
            (Self::Add(..), [a, b]) => a + b,
            (Self::Sub(..), [a, b]) => a - b,
            (Self::Mul(..), [a, b]) => a * b,
            (Self::Div(..), [_, b]) if *b == 0.0 => return fault(EvalFault::DivisionByZero),
            (Self::Div(..), [a, b]) => a / b,
            (Self::Powi(_, n), [a]) if *n < 0 && *a == 0.0 => {
                return fault(EvalFault::DivisionByZero);
            }
            (Self::Powi(_, n), [a]) => powi(*a, *n),
            (Self::Powf(..), [a]) if *a < 0.0 => return fault(EvalFault::NegativePower),
            (Self::Powf(_, p), [a]) if *p < 0.0 && *a == 0.0 => {
                return fault(EvalFault::DivisionByZero);
            }
            (Self::Powf(_, p), [a]) => powf(*a, *p),
            (Self::Call(Builtin::Sqrt, _), [a]) if *a < 0.0 => {
                return fault(EvalFault::NegativeRoot);
            }
            (Self::Call(Builtin::Ln, _), [a]) if *a <= 0.0 => return fault(EvalFault::Logarithm),
            (Self::Call(Builtin::Asin | Builtin::Acos, _), [a]) if a.abs() > 1.0 => {
                return fault(EvalFault::ArcFunction);
            }
            (Self::Call(builtin, _), values) => {
                let constants: Vec<Expr<L>> =
                    values.iter().map(|value| Self::Const(*value)).collect();
                call(*builtin, &constants, &mut |_| f64::NAN)
            }
            _ => f64::NAN,
        };
        match value.is_finite() {
            true => Ok(value),
            false if matches!(self, Self::Leaf(_)) => fault(EvalFault::Leaf),
            false => fault(EvalFault::Overflow),
        }
    }
}

/// `x^p`: by the square root where `2 p` is a small whole number, else `exp(p ln x)`.
fn powf<T: Number>(x: T, p: f64) -> T {
    /// The largest power taken of a square root; beyond it the exponential is as good.
    const LARGEST: f64 = 64.0;
    let doubled = 2.0 * p;
    if doubled.fract() == 0.0 && doubled.abs() <= LARGEST {
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        return powi(x.sqrt(), doubled as i32);
    }
    (x.ln() * p).exp()
}

/// The value of a call; NaN where the arguments are too few, which no checked expression has.
fn call<L, T: Number>(
    builtin: Builtin,
    arguments: &[Expr<L>],
    leaf: &mut impl FnMut(&L) -> T,
) -> T {
    let missing = T::from_f64(f64::NAN);
    let mut values = arguments.iter();
    let mut next = || values.next().map(|argument| argument.eval(leaf));
    let x = next().unwrap_or(missing);
    match builtin {
        Builtin::Sin => x.sin_cos().0,
        Builtin::Cos => x.sin_cos().1,
        Builtin::Tan => {
            let (sin, cos) = x.sin_cos();
            sin / cos
        }
        Builtin::Asin => x.atan2(other_leg(x)),
        Builtin::Acos => other_leg(x).atan2(x),
        Builtin::Atan => x.atan2(T::one()),
        Builtin::Atan2 => x.atan2(next().unwrap_or(missing)),
        Builtin::Sqrt => x.sqrt(),
        Builtin::Abs => x.abs(),
        Builtin::Exp => x.exp(),
        Builtin::Ln => x.ln(),
        Builtin::Min => std::iter::from_fn(next).fold(x, T::min),
        Builtin::Max => std::iter::from_fn(next).fold(x, T::max),
        Builtin::Hypot => (x.square() + next().unwrap_or(missing).square()).sqrt(),
    }
}

/// `sqrt(1 - x^2)`, without cancellation near ±1.
fn other_leg<T: Number>(x: T) -> T {
    ((-x + 1.0) * (x + 1.0)).sqrt()
}

/// Why a part of an expression has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvalFault {
    /// The square root of a negative number.
    NegativeRoot,
    /// A division by zero, or a negative power of zero.
    DivisionByZero,
    /// The logarithm of a number that is not positive.
    Logarithm,
    /// `asin` or `acos` of a number outside of -1 … 1.
    ArcFunction,
    /// A broken power of a negative number.
    NegativePower,
    /// A leaf whose own value is not finite.
    Leaf,
    /// A value beyond the range of numbers.
    Overflow,
}

impl fmt::Display for EvalFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::NegativeRoot => "the square root of a negative number",
            Self::DivisionByZero => "a division by zero",
            Self::Logarithm => "the logarithm of a number that is not positive",
            Self::ArcFunction => "the arc sine or arc cosine of a number outside of -1 to 1",
            Self::NegativePower => "a broken power of a negative number",
            Self::Leaf => "a value that is not known",
            Self::Overflow => "a number beyond the range of numbers",
        })
    }
}

/// The part of an expression that has no value; made by [`Expr::eval_f64_checked`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvalError<'a, L> {
    /// The part.
    pub expr: &'a Expr<L>,
    /// Why.
    pub fault: EvalFault,
}

impl<L: fmt::Display> fmt::Display for EvalError<'_, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} in `{}`", self.fault, self.expr)
    }
}

impl<L: fmt::Debug + fmt::Display> std::error::Error for EvalError<'_, L> {}
