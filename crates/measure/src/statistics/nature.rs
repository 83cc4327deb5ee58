//! Which measures can change faster than what they are of, and which have no jump and no kink.

use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, PoseMeasure};
use kempe_units::{Builtin, Expr};

/// What the formula of a measure alone tells of how it goes between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Nature {
    /// It can have peaks or poles that the poses and drives do not show: those that quotients, roots and functions make. Sums
    /// and products change as fast as what is in them.
    pub wild: bool,
    /// It has all its derivatives wherever it and they are bounded: no jump, nothing folded, and no kink but that of a size, whose two sides tell of each other.
    pub smooth: bool,
}

const TAME: Nature = Nature {
    wild: false,
    smooth: true,
};

impl Nature {
    /// Of a measure.
    pub fn of(mechanism: &Mechanism, measure: &Measure) -> Self {
        let mut known = vec![None; mechanism.model.measures.len()];
        let own = nature(mechanism, measure, &mut known);
        Self {
            wild: own.wild && is_wild(mechanism, measure, &mut known),
            ..own
        }
    }

    fn with(self, other: Self) -> Self {
        Self {
            wild: self.wild || other.wild,
            smooth: self.smooth && other.smooth,
        }
    }
}

/// Whether a measure may turn back at once by what it is made of. A leaf alone does so only where it vanishes.
pub(crate) fn may_fold(mechanism: &Mechanism, measure: &Measure) -> bool {
    match measure {
        Expr::Neg(a) => may_fold(mechanism, a),
        Expr::Leaf(Leaf::Named(index)) => {
            let named = mechanism.model.measures.get(*index);
            named.is_none_or(|named| may_fold(mechanism, &named.measure))
        }
        Expr::Leaf(leaf) => matches!(leaf, Leaf::Rate(..) | Leaf::Coefficient(..)),
        _ => {
            let mut known = vec![None; mechanism.model.measures.len()];
            let own = nature(mechanism, measure, &mut known);
            own.wild || !own.smooth
        }
    }
}

/// Whether a measure can have peaks or poles of its own. A size, also one of a vector, has its extremes where its square has some: nothing about it is wild but what it
/// is of, however small it is.
fn is_wild(mechanism: &Mechanism, measure: &Measure, known: &mut [Option<Nature>]) -> bool {
    match measure {
        Expr::Leaf(Leaf::Named(index)) => {
            let named = mechanism.model.measures.get(*index);
            named.is_none_or(|named| is_wild(mechanism, &named.measure, known))
        }
        Expr::Leaf(Leaf::Pose(
            PoseMeasure::Distance(..) | PoseMeasure::Speed(_) | PoseMeasure::Acceleration(_),
        )) => false,
        Expr::Call(Builtin::Abs, parts) => {
            let mut parts = parts.iter();
            parts.any(|part| is_wild(mechanism, part, known))
        }
        Expr::Neg(a) => is_wild(mechanism, a, known),
        Expr::Add(a, b) | Expr::Sub(a, b) | Expr::Mul(a, b) if is_constant(a) => {
            is_wild(mechanism, b, known)
        }
        Expr::Add(a, b) | Expr::Sub(a, b) | Expr::Mul(a, b) | Expr::Div(a, b) if is_constant(b) => {
            is_wild(mechanism, a, known)
        }
        _ => nature(mechanism, measure, known).wild,
    }
}

/// Of named measures what is known already is kept.
fn nature(mechanism: &Mechanism, measure: &Measure, known: &mut [Option<Nature>]) -> Nature {
    let own = match measure {
        Expr::Leaf(leaf) => of_leaf(mechanism, leaf, known),
        Expr::Div(a, b) if is_constant(b) => return nature(mechanism, a, known),
        Expr::Div(..) | Expr::Powf(..) => Nature { wild: true, ..TAME },
        Expr::Powi(_, exponent) => Nature {
            wild: *exponent < 0,
            ..TAME
        },
        Expr::Call(builtin, _) => Nature {
            wild: true,
            smooth: !matches!(builtin, Builtin::Min | Builtin::Max | Builtin::Atan2),
        },
        Expr::Const(_) | Expr::Neg(_) | Expr::Add(..) | Expr::Sub(..) | Expr::Mul(..) => TAME,
    };
    let parts = measure.children().into_iter();
    parts.fold(own, |all, part| all.with(nature(mechanism, part, known)))
}

fn of_leaf(mechanism: &Mechanism, leaf: &Leaf, known: &mut [Option<Nature>]) -> Nature {
    let rough = Nature {
        smooth: false,
        ..TAME
    };
    match leaf {
        // A number over the motion is the same everywhere.
        Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time | Leaf::Over(..) => TAME,
        // Forces are not bounded here.
        Leaf::Inner(_) | Leaf::Force(_) => rough,
        Leaf::Named(index) => {
            if let Some(found) = known[*index] {
                return found;
            }
            let named = mechanism.model.measures.get(*index);
            let found = named.map_or(rough, |named| nature(mechanism, &named.measure, known));
            known[*index] = Some(found);
            found
        }
        Leaf::Rate(inner, _) => nature(mechanism, inner, known),
        Leaf::Coefficient(inner, ..) => nature(mechanism, inner, known).with(rough),
        Leaf::Pose(pose) => of_pose(pose),
    }
}

fn of_pose(pose: &PoseMeasure) -> Nature {
    let [wild, smooth] = match pose {
        PoseMeasure::X(_)
        | PoseMeasure::Y(_)
        | PoseMeasure::XOn(..)
        | PoseMeasure::YOn(..)
        | PoseMeasure::Angle(_)
        | PoseMeasure::AngleBetween(..)
        | PoseMeasure::DistanceToLine(..)
        | PoseMeasure::Travel(..)
        | PoseMeasure::AngularSpeed(_)
        | PoseMeasure::AngularAcceleration(_) => [false, true],
        PoseMeasure::Distance(..) | PoseMeasure::Speed(_) | PoseMeasure::Acceleration(_) => {
            [true, true]
        }
        PoseMeasure::PathLength(_) => [false, false],
        _ => [true, false],
    };
    Nature { wild, smooth }
}

fn is_constant(measure: &Measure) -> bool {
    match measure {
        Expr::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
        _ => measure.children().into_iter().all(is_constant),
    }
}
