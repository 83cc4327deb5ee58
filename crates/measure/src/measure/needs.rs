//! What a measure asks for: the leaves inside it, and how often it must be differentiated.

use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, Nature, PoseMeasure};

use super::ORDER;

/// How often a measure must be differentiated to be evaluated, or why it cannot be.
///
/// # Errors
/// A sentence for the user: a rate inside a kinematic coefficient, or an order beyond what the series carry.
pub fn order_of(mechanism: &Mechanism, measure: &Measure) -> Result<u32, String> {
    let mut known = vec![[None; 2]; mechanism.model.measures.len()];
    let order = depth(mechanism, measure, false, &mut known)?;
    if order as usize >= ORDER {
        return Err(format!(
            "needs derivatives of order {order}; the highest available is {}",
            ORDER - 1
        ));
    }
    Ok(order)
}

/// The same without the bound. Named measures are looked at once, outside and inside of a coefficient: `known`.
fn depth(
    mechanism: &Mechanism,
    measure: &Measure,
    in_coefficient: bool,
    known: &mut [[Option<u32>; 2]],
) -> Result<u32, String> {
    let mut deepest = 0;
    for leaf in measure.leaves() {
        let own = match leaf {
            Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time => 0,
            Leaf::Force(_) if in_coefficient => {
                return Err("a force has no derivative to a drive".into());
            }
            Leaf::Force(_) => Nature::Forces.order(),
            Leaf::Named(index) => match mechanism.model.measures.get(*index) {
                Some(named) => match known[*index][usize::from(in_coefficient)] {
                    Some(depth) => depth,
                    None => {
                        let found = depth(mechanism, &named.measure, in_coefficient, known)?;
                        known[*index][usize::from(in_coefficient)] = Some(found);
                        found
                    }
                },
                None => 0,
            },
            Leaf::Rate(_, _) if in_coefficient => {
                return Err("a rate in time has no derivative to a drive: take rate() of the coefficient instead".into());
            }
            Leaf::Rate(inner, order) => order + depth(mechanism, inner, false, known)?,
            Leaf::Coefficient(inner, _, order) => order + depth(mechanism, inner, true, known)?,
            Leaf::Over(_, inner) => {
                depth(mechanism, inner, false, known)?;
                0
            }
            Leaf::Pose(PoseMeasure::PathLength(_)) if in_coefficient => {
                return Err("a length of path depends on the whole way since the start, not on where a drive is: divide its rate() by that of the drive".into());
            }
            Leaf::Pose(pose) if in_coefficient && matches!(pose.nature(), Nature::InTime(_)) => {
                return Err("a speed or acceleration in time has no derivative to a drive".into());
            }
            Leaf::Pose(pose) => {
                let inner = match pose {
                    PoseMeasure::MechanicalAdvantage(inner, _) => {
                        depth(mechanism, inner, true, known)?
                    }
                    _ => 0,
                };
                inner + pose.nature().order()
            }
        };
        deepest = deepest.max(own);
    }
    Ok(deepest)
}

/// Calls `f` for every leaf of a measure, inside rates, coefficients, statistics and named measures as well, the inner
/// leaves first. A named measure is looked into once.
pub fn visit_leaves(mechanism: &Mechanism, measure: &Measure, f: &mut impl FnMut(&Leaf)) {
    let mut seen = vec![false; mechanism.model.measures.len()];
    visit_unseen(mechanism, measure, &mut seen, f);
}

fn visit_unseen(
    mechanism: &Mechanism,
    measure: &Measure,
    seen: &mut [bool],
    f: &mut impl FnMut(&Leaf),
) {
    for leaf in measure.leaves() {
        match leaf {
            Leaf::Named(index) => {
                let named = mechanism.model.measures.get(*index);
                if let (Some(named), Some(false)) = (named, seen.get(*index)) {
                    seen[*index] = true;
                    visit_unseen(mechanism, &named.measure, seen, f);
                }
            }
            Leaf::Rate(inner, _)
            | Leaf::Coefficient(inner, _, _)
            | Leaf::Over(_, inner)
            | Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, _)) => {
                visit_unseen(mechanism, inner, seen, f);
            }
            _ => {}
        }
        f(leaf);
    }
}
