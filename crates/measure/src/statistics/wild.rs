//! Which measures can change faster than what they are of, and which have no jump and no kink wherever their bounds are finite.

use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, PoseMeasure};
use kempe_units::{Builtin, Expr};

/// Whether a measure can have peaks or poles that the poses and drives do not show: those that quotients, roots and functions
/// make. Sums and products change as fast as what is in them.
pub(super) fn is_wild(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut known = vec![None; mechanism.model.measures.len()];
    wild(mechanism, measure, &mut known)
}

/// The same; of named measures what is known already is kept.
fn wild(mechanism: &Mechanism, measure: &Measure, known: &mut [Option<bool>]) -> bool {
    match measure {
        Expr::Const(_) => false,
        Expr::Leaf(leaf) => wild_leaf(mechanism, leaf, known),
        Expr::Div(a, b) => !is_constant(b) || wild(mechanism, a, known),
        Expr::Powi(_, exponent) if *exponent < 0 => true,
        Expr::Powf(..) | Expr::Call(..) => true,
        Expr::Neg(_) | Expr::Add(..) | Expr::Sub(..) | Expr::Mul(..) | Expr::Powi(..) => {
            let mut parts = measure.children().into_iter();
            parts.any(|part| wild(mechanism, part, known))
        }
    }
}

fn wild_leaf(mechanism: &Mechanism, leaf: &Leaf, known: &mut [Option<bool>]) -> bool {
    match leaf {
        // Forces are not bounded here; a number over the motion is the same everywhere.
        Leaf::Parameter(_)
        | Leaf::Drive(_)
        | Leaf::Time
        | Leaf::Inner(_)
        | Leaf::Force(_)
        | Leaf::Over(..) => false,
        Leaf::Named(index) => {
            if let Some(found) = known[*index] {
                return found;
            }
            let named = mechanism.model.measures.get(*index);
            let found = named.is_some_and(|named| wild(mechanism, &named.measure, known));
            known[*index] = Some(found);
            found
        }
        Leaf::Rate(inner, _) | Leaf::Coefficient(inner, ..) => wild(mechanism, inner, known),
        Leaf::Pose(pose) => !matches!(
            pose,
            PoseMeasure::X(_)
                | PoseMeasure::Y(_)
                | PoseMeasure::XOn(..)
                | PoseMeasure::YOn(..)
                | PoseMeasure::Angle(_)
                | PoseMeasure::AngleBetween(..)
                | PoseMeasure::DistanceToLine(..)
                | PoseMeasure::Travel(..)
                | PoseMeasure::AngularSpeed(_)
                | PoseMeasure::AngularAcceleration(_)
                | PoseMeasure::PathLength(_)
        ),
    }
}

/// Whether a measure has all its derivatives wherever it and they are bounded: no jump, no kink, nothing folded.
pub(super) fn is_smooth(mechanism: &Mechanism, measure: &Measure) -> bool {
    use Builtin::{Abs, Atan2, Max, Min};
    let own = match measure {
        Expr::Call(builtin, _) => !matches!(builtin, Abs | Min | Max | Atan2),
        Expr::Leaf(Leaf::Named(index)) => {
            let named = mechanism.model.measures.get(*index);
            named.is_some_and(|named| is_smooth(mechanism, &named.measure))
        }
        Expr::Leaf(Leaf::Rate(inner, _)) => is_smooth(mechanism, inner),
        Expr::Leaf(Leaf::Pose(pose)) => matches!(
            pose,
            PoseMeasure::X(_)
                | PoseMeasure::Y(_)
                | PoseMeasure::XOn(..)
                | PoseMeasure::YOn(..)
                | PoseMeasure::Angle(_)
                | PoseMeasure::AngleBetween(..)
                | PoseMeasure::Distance(..)
                | PoseMeasure::DistanceToLine(..)
                | PoseMeasure::Travel(..)
                | PoseMeasure::Speed(_)
                | PoseMeasure::Acceleration(_)
                | PoseMeasure::AngularSpeed(_)
                | PoseMeasure::AngularAcceleration(_)
        ),
        Expr::Leaf(leaf) => matches!(
            leaf,
            Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time | Leaf::Over(..)
        ),
        _ => true,
    };
    let parts = measure.children();
    own && parts.into_iter().all(|part| is_smooth(mechanism, part))
}

fn is_constant(measure: &Measure) -> bool {
    match measure {
        Expr::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
        _ => measure.children().into_iter().all(is_constant),
    }
}
