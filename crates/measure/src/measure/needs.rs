//! What a measure asks for: the leaves inside it, and how often it must be differentiated.

use kempe_mechanism::Mechanism;
use kempe_model::{
    DriveId, ForceMeasure, Leaf, Measure, Model, Nature, PointId, PoseMeasure, Statistic,
};
use kempe_motion::motion::Motion;
use kempe_units::Expr;

use crate::state::ORDER;

/// Why a measure has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoMeasure {
    /// It needs derivatives of this order, beyond what the series carry.
    Order(u32),
    /// A force inside a kinematic coefficient.
    ForceByDrive,
    /// A rate in time inside a kinematic coefficient.
    RateByDrive,
    /// A length of path inside a kinematic coefficient.
    PathLengthByDrive,
    /// A speed or an acceleration inside a kinematic coefficient.
    SpeedByDrive,
    /// A pressure or a switch inside a kinematic coefficient.
    StateByDrive,
    /// A pressure or a switch that no simulation has followed.
    OnlySimulated,
}

impl std::fmt::Display for NoMeasure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Order(order) => {
                let highest = ORDER - 1;
                return write!(f, "needs derivatives of order {order}; the highest available is {highest}");
            }
            Self::ForceByDrive => "a force has no derivative to a drive",
            Self::RateByDrive => {
                "a rate in time has no derivative to a drive: take rate() of the coefficient instead"
            }
            Self::PathLengthByDrive => {
                "a length of path depends on the whole way since the start, not on where a drive is: divide its rate() by \
                 that of the drive"
            }
            Self::StateByDrive => "a pressure or a switch has no derivative to a drive",
            Self::OnlySimulated => {
                "only a simulation follows a pressure or a switch, and a pressure only where it lets the cylinder's drive go"
            }
            Self::SpeedByDrive => "a speed or acceleration in time has no derivative to a drive",
        })
    }
}

/// How often a measure must be differentiated to be evaluated.
///
/// # Errors
/// Why it cannot be: a rate inside a kinematic coefficient, or an order beyond what the series carry.
pub fn order_of(mechanism: &Mechanism, measure: &Measure) -> Result<u32, NoMeasure> {
    let mut known = vec![[None; 2]; mechanism.model.measures.len()];
    let order = depth(mechanism, measure, false, &mut known)?;
    if order as usize >= ORDER {
        return Err(NoMeasure::Order(order));
    }
    Ok(order)
}

/// The same without the bound. Named measures are looked at once, outside and inside of a coefficient: `known`.
fn depth(
    mechanism: &Mechanism,
    measure: &Measure,
    in_coefficient: bool,
    known: &mut [[Option<u32>; 2]],
) -> Result<u32, NoMeasure> {
    let mut deepest = 0;
    for leaf in measure.leaves() {
        let own = match leaf {
            Leaf::Inner(_) if in_coefficient => return Err(NoMeasure::StateByDrive),
            Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time | Leaf::Inner(_) => 0,
            Leaf::Force(_) if in_coefficient => {
                return Err(NoMeasure::ForceByDrive);
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
                return Err(NoMeasure::RateByDrive);
            }
            Leaf::Rate(inner, order) => order + depth(mechanism, inner, false, known)?,
            Leaf::Coefficient(inner, _, order) => order + depth(mechanism, inner, true, known)?,
            Leaf::Over(_, inner) => {
                depth(mechanism, inner, false, known)?;
                0
            }
            Leaf::Pose(PoseMeasure::PathLength(_)) if in_coefficient => {
                return Err(NoMeasure::PathLengthByDrive);
            }
            Leaf::Pose(pose) if in_coefficient && matches!(pose.nature(), Nature::InTime(_)) => {
                return Err(NoMeasure::SpeedByDrive);
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

/// Whether a measure has a value only where time runs.
pub(crate) fn needs_time(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut needs = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        needs |= match leaf {
            Leaf::Time | Leaf::Rate(..) | Leaf::Force(_) | Leaf::Inner(_) => true,
            Leaf::Pose(pose) => matches!(pose.nature(), Nature::InTime(_)),
            _ => false,
        };
    });
    needs
}

/// Whether a measure asks for a pressure or a switch that no simulation has followed.
pub fn asks_unknown_state(model: &Model, measure: &Measure) -> bool {
    let mut asks = false;
    leaves_of(model, measure, &mut |leaf| {
        asks |= matches!(leaf, Leaf::Inner(state) if model.inner_law(*state).is_none());
    });
    asks
}

/// Calls `f` for every leaf of a measure, as [`visit_parts`] comes to them.
pub fn visit_leaves(mechanism: &Mechanism, measure: &Measure, f: &mut impl FnMut(&Leaf)) {
    leaves_of(&mechanism.model, measure, f);
}

fn leaves_of(model: &Model, measure: &Measure, f: &mut impl FnMut(&Leaf)) {
    visit_parts(model, measure, &mut |part| {
        if let Expr::Leaf(leaf) = part {
            f(leaf);
        }
    });
}

/// Calls `f` for every expression that a measure is made of, inside rates, coefficients, statistics and named measures as well, the inner
/// ones first. A named measure is looked into once.
pub fn visit_parts<'m>(model: &'m Model, measure: &'m Measure, f: &mut impl FnMut(&'m Measure)) {
    let mut seen = vec![false; model.measures.len()];
    visit_unseen(model, measure, &mut seen, f);
}

fn visit_unseen<'m>(
    model: &'m Model,
    measure: &'m Measure,
    seen: &mut [bool],
    f: &mut impl FnMut(&'m Measure),
) {
    match measure {
        Expr::Leaf(Leaf::Named(index)) => {
            let named = model.measures.get(*index);
            if let (Some(named), Some(false)) = (named, seen.get(*index)) {
                seen[*index] = true;
                visit_unseen(model, &named.measure, seen, f);
            }
        }
        Expr::Leaf(
            Leaf::Rate(inner, _)
            | Leaf::Coefficient(inner, _, _)
            | Leaf::Over(_, inner)
            | Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, _)),
        ) => visit_unseen(model, inner, seen, f),
        _ => {
            for part in measure.children() {
                visit_unseen(model, part, seen, f);
            }
        }
    }
    f(measure);
}

/// What measures need beyond the poses along the path.
#[derive(Debug, Default)]
pub(crate) struct Needs {
    /// Statistics; one that another contains stands before it.
    pub statistics: Vec<(Statistic, Measure)>,
    /// Directions between points.
    pub directions: Vec<(PointId, PointId)>,
    /// Directions of forces.
    pub forces: Vec<ForceMeasure>,
    /// Points whose lengths of path are asked for.
    pub lengths: Vec<PointId>,
    /// Points whose curvature of path is asked for.
    pub curved: Vec<PointId>,
    /// Drives whose kinematic coefficients are asked for.
    pub drives: Vec<DriveId>,
}

impl Needs {
    /// What these measures need of a motion.
    pub fn of<'m>(motion: &Motion, measures: impl Iterator<Item = &'m Measure>) -> Self {
        let mut it = Self::default();
        for measure in measures {
            visit_leaves(motion.mechanism(), measure, &mut |leaf| match leaf {
                Leaf::Over(statistic, inner) => {
                    let entry = (statistic.clone(), (**inner).clone());
                    if !it.statistics.contains(&entry) {
                        it.statistics.push(entry);
                    }
                }
                Leaf::Pose(PoseMeasure::Direction(a, b)) if !it.directions.contains(&(*a, *b)) => {
                    it.directions.push((*a, *b));
                }
                Leaf::Force(force) if force.is_direction() && !it.forces.contains(force) => {
                    it.forces.push(force.clone());
                }
                Leaf::Pose(
                    PoseMeasure::Curvature(p)
                    | PoseMeasure::CurvatureCenterX(p)
                    | PoseMeasure::CurvatureCenterY(p),
                ) if !it.curved.contains(p) => it.curved.push(*p),
                Leaf::Pose(PoseMeasure::PathLength(p)) if !it.lengths.contains(p) => {
                    it.lengths.push(*p);
                }
                Leaf::Coefficient(_, drive, _)
                | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => {
                    it.drives.push(*drive);
                }
                _ => {}
            });
        }
        it
    }
}
