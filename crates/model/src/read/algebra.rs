//! Expressions made of expressions: what is computed of values that may follow parameters.

use kempe_units::{Builtin, Expr};

use crate::ids::Scalar;
use crate::link::Place;

pub(crate) fn plus(a: Scalar, b: Scalar) -> Scalar {
    Expr::Add(Box::new(a), Box::new(b))
}

pub(crate) fn minus(a: &Scalar, b: &Scalar) -> Scalar {
    if matches!(b, Expr::Const(0.0)) {
        return a.clone();
    }
    Expr::Sub(Box::new(a.clone()), Box::new(b.clone()))
}

pub(crate) fn times(a: Scalar, b: Scalar) -> Scalar {
    Expr::Mul(Box::new(a), Box::new(b))
}

pub(crate) fn over(a: Scalar, by: Scalar) -> Scalar {
    Expr::Div(Box::new(a), Box::new(by))
}

/// From one place to another.
pub(crate) fn way(from: &[Scalar; 2], to: &[Scalar; 2]) -> [Scalar; 2] {
    [
        minus(&to[0], &from[0]).fold(),
        minus(&to[1], &from[1]).fold(),
    ]
}

pub(crate) fn length([x, y]: &[Scalar; 2]) -> Scalar {
    Expr::Call(Builtin::Hypot, vec![x.clone(), y.clone()]).fold()
}

/// The direction of a vector, rad, from -180 to 180 degrees.
pub(crate) fn direction([x, y]: &[Scalar; 2]) -> Scalar {
    Expr::Call(Builtin::Atan2, vec![y.clone(), x.clone()]).fold()
}

pub(crate) fn dot(a: &[Scalar; 2], b: &[Scalar; 2]) -> Scalar {
    let part = |i: usize| times(a[i].clone(), b[i].clone());
    plus(part(0), part(1)).fold()
}

/// Positive where `b` points to the left of `a`.
pub(crate) fn cross(a: &[Scalar; 2], b: &[Scalar; 2]) -> Scalar {
    let (up, down) = (
        times(a[0].clone(), b[1].clone()),
        times(a[1].clone(), b[0].clone()),
    );
    minus(&up, &down).fold()
}

/// The angle from `from` to `to`, from -180 to 180 degrees.
pub(crate) fn turn(from: &Scalar, to: &Scalar) -> Scalar {
    if matches!(from, Expr::Const(x) if *x == 0.0) {
        return to.clone();
    }
    let difference = minus(to, from);
    let part = |function| Expr::Call(function, vec![difference.clone()]);
    Expr::Call(Builtin::Atan2, vec![part(Builtin::Sin), part(Builtin::Cos)]).fold()
}

/// The coordinates of a place; a corner of a triangle has none that are written down.
pub(crate) fn place_in_xy(place: &Place) -> Option<[Scalar; 2]> {
    match place {
        Place::Cartesian { x, y } => Some([x.clone(), y.clone()]),
        Place::Polar { radius, angle } => {
            let part = |function| {
                let part = Expr::Call(function, vec![angle.clone()]);
                times(radius.clone(), part).fold()
            };
            Some([part(Builtin::Cos), part(Builtin::Sin)])
        }
        Place::Triangle { .. } => None,
    }
}
