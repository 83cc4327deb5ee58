//! A checked expression: names resolved to leaves, constants in SI, ready to run on any number.

use crate::Builtin;

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
    /// The expressions this one is made of, in order.
    pub fn children(&self) -> Vec<&Self> {
        match self {
            Self::Const(_) | Self::Leaf(_) => Vec::new(),
            Self::Neg(a) | Self::Powi(a, _) | Self::Powf(a, _) => vec![a],
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => vec![a, b],
            Self::Call(_, arguments) => arguments.iter().collect(),
        }
    }

    /// The same expression with each leaf replaced by what `f` makes of it.
    pub fn map_leaves<M>(&self, f: &mut impl FnMut(&L) -> M) -> Expr<M> {
        self.substitute(&mut |leaf| Expr::Leaf(f(leaf)))
    }

    /// The same expression with each leaf replaced by an expression: a parameter by its value, say.
    pub fn substitute<M>(&self, f: &mut impl FnMut(&L) -> Expr<M>) -> Expr<M> {
        match self {
            Self::Const(value) => Expr::Const(*value),
            Self::Leaf(leaf) => f(leaf),
            Self::Neg(a) => Expr::Neg(Box::new(a.substitute(f))),
            Self::Add(a, b) => Expr::Add(Box::new(a.substitute(f)), Box::new(b.substitute(f))),
            Self::Sub(a, b) => Expr::Sub(Box::new(a.substitute(f)), Box::new(b.substitute(f))),
            Self::Mul(a, b) => Expr::Mul(Box::new(a.substitute(f)), Box::new(b.substitute(f))),
            Self::Div(a, b) => Expr::Div(Box::new(a.substitute(f)), Box::new(b.substitute(f))),
            Self::Powi(a, n) => Expr::Powi(Box::new(a.substitute(f)), *n),
            Self::Powf(a, p) => Expr::Powf(Box::new(a.substitute(f)), *p),
            Self::Call(builtin, arguments) => Expr::Call(
                *builtin,
                arguments
                    .iter()
                    .map(|argument| argument.substitute(f))
                    .collect(),
            ),
        }
    }

    /// The leaves, in the order of writing, each as often as it occurs.
    pub fn leaves(&self) -> Leaves<'_, L> {
        Leaves { stack: vec![self] }
    }

    /// The SI value, if no leaf occurs; NaN where it is undefined.
    pub fn as_constant(&self) -> Option<f64> {
        if self.leaves().next().is_some() {
            return None;
        }
        Some(self.eval(&mut |_| f64::NAN))
    }

    /// The same expression with every part without leaves replaced by its value. A part whose value is not finite
    /// stays, for [`eval_f64_checked`](Self::eval_f64_checked) to report. The result evaluates to the same bits.
    #[must_use]
    pub fn fold(&self) -> Self
    where
        L: Clone,
    {
        if matches!(self, Self::Const(_) | Self::Leaf(_)) {
            return self.clone();
        }
        let fold = |a: &Self| Box::new(a.fold());
        let folded = match self {
            Self::Const(_) | Self::Leaf(_) => self.clone(),
            Self::Neg(a) => Self::Neg(fold(a)),
            Self::Add(a, b) => Self::Add(fold(a), fold(b)),
            Self::Sub(a, b) => Self::Sub(fold(a), fold(b)),
            Self::Mul(a, b) => Self::Mul(fold(a), fold(b)),
            Self::Div(a, b) => Self::Div(fold(a), fold(b)),
            Self::Powi(a, n) => Self::Powi(fold(a), *n),
            Self::Powf(a, p) => Self::Powf(fold(a), *p),
            Self::Call(builtin, arguments) => {
                Self::Call(*builtin, arguments.iter().map(Self::fold).collect())
            }
        };
        if folded
            .children()
            .iter()
            .all(|child| matches!(child, Self::Const(_)))
        {
            let value = folded.eval(&mut |_| f64::NAN);
            if value.is_finite() {
                return Self::Const(value);
            }
        }
        folded
    }
}

/// Iterates over the leaves of an expression; made by [`Expr::leaves`].
#[derive(Clone, Debug)]
pub struct Leaves<'a, L> {
    stack: Vec<&'a Expr<L>>,
}

impl<'a, L> Iterator for Leaves<'a, L> {
    type Item = &'a L;
    fn next(&mut self) -> Option<&'a L> {
        while let Some(expr) = self.stack.pop() {
            if let Expr::Leaf(leaf) = expr {
                return Some(leaf);
            }
            self.stack.extend(expr.children().into_iter().rev());
        }
        None
    }
}
