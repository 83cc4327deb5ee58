//! What a measure asks for: the leaves inside it, and how often it must be differentiated.

use kempe_model::{Leaf, Measure, PoseMeasure};

use super::ORDER;
use super::in_time::is_motion;
use crate::mechanism::Mechanism;

/// How often a measure must be differentiated to be evaluated, or why it cannot be.
///
/// # Errors
/// A sentence for the user: a rate inside a kinematic coefficient, or an order beyond what the series carry.
pub fn order_of(mechanism: &Mechanism, measure: &Measure) -> Result<u32, String> {
    let order = depth(mechanism, measure, false)?;
    if order as usize >= ORDER {
        return Err(format!(
            "needs derivatives of order {order}; the highest available is {}",
            ORDER - 1
        ));
    }
    Ok(order)
}

fn depth(mechanism: &Mechanism, measure: &Measure, in_coefficient: bool) -> Result<u32, String> {
    let mut deepest = 0;
    for leaf in measure.leaves() {
        let own = match leaf {
            Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time => 0,
            Leaf::Force(_) if in_coefficient => {
                return Err("a force has no derivative to a drive".into());
            }
            Leaf::Force(_) => 2,
            Leaf::Named(index) => match mechanism.model.measures.get(*index) {
                Some(named) => depth(mechanism, &named.measure, in_coefficient)?,
                None => 0,
            },
            Leaf::Rate(_, _) if in_coefficient => {
                return Err("a rate in time has no derivative to a drive: take rate() of the coefficient instead".into());
            }
            Leaf::Rate(inner, order) => order + depth(mechanism, inner, false)?,
            Leaf::Coefficient(inner, _, order) => order + depth(mechanism, inner, true)?,
            Leaf::Over(_, inner) => {
                depth(mechanism, inner, false)?;
                0
            }
            Leaf::Pose(PoseMeasure::PathLength(_)) if in_coefficient => {
                return Err("a length of path depends on the whole way since the start, not on where a drive is: divide its rate() by that of the drive".into());
            }
            Leaf::Pose(pose) if in_coefficient && is_motion(pose) => {
                return Err("a speed or acceleration in time has no derivative to a drive".into());
            }
            Leaf::Pose(pose) => match pose {
                PoseMeasure::Speed(_)
                | PoseMeasure::AngularSpeed(_)
                | PoseMeasure::InstantCenterX(..)
                | PoseMeasure::InstantCenterY(..) => 1,
                PoseMeasure::Acceleration(_)
                | PoseMeasure::AngularAcceleration(_)
                | PoseMeasure::Curvature(_)
                | PoseMeasure::CurvatureCenterX(_)
                | PoseMeasure::CurvatureCenterY(_) => 2,
                PoseMeasure::MechanicalAdvantage(inner, _) => 1 + depth(mechanism, inner, true)?,
                _ => 0,
            },
        };
        deepest = deepest.max(own);
    }
    Ok(deepest)
}

/// Calls `f` for every leaf of a measure, inside rates, coefficients, statistics and named measures as well.
pub fn visit_leaves(mechanism: &Mechanism, measure: &Measure, f: &mut impl FnMut(&Leaf)) {
    for leaf in measure.leaves() {
        f(leaf);
        match leaf {
            Leaf::Named(index) => {
                if let Some(named) = mechanism.model.measures.get(*index) {
                    visit_leaves(mechanism, &named.measure, f);
                }
            }
            Leaf::Rate(inner, _) | Leaf::Coefficient(inner, _, _) | Leaf::Over(_, inner) => {
                visit_leaves(mechanism, inner, f);
            }
            Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, _)) => {
                visit_leaves(mechanism, inner, f)
            }
            _ => {}
        }
    }
}
