//! Measures of several designs at once, in the lanes of one number.

use std::sync::Arc;

use kempe_model::{DriveId, Leaf, Measure, Nature, PoseMeasure};
use kempe_motion::Motion;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::motion::Solver;
use kempe_motion::trace::Path;
use kempe_number::{Lanes, Number};

use crate::measure::{History, Moment, only_value, order_of, visit_leaves};
use crate::state::{Abscissa, Series, State};

/// Measures of `W` designs at once, at places of a motion, on the branch and with the drives that the motion's own design has
/// there: right as long as no limit or change point comes between a design and the motion's.
///
/// Lane k of a measure has the bits that the design of lane k gives alone on that branch.
pub struct DesignsInLanes<'m, const W: usize> {
    motion: &'m Arc<Motion>,
    measures: Vec<&'m Measure>,
    solver: Solver<Series<Lanes<W>>>,
    state: State<Lanes<W>>,
}

impl<'m, const W: usize> DesignsInLanes<'m, W> {
    /// Prepares for designs, by their parameter values (SI, in the model's order).
    pub fn new(
        motion: &'m Arc<Motion>,
        measures: Vec<&'m Measure>,
        parameters: &[Lanes<W>],
    ) -> Self {
        let design = motion.design_of(parameters).lift(Series::constant);
        let nothing = Lanes::from_f64(f64::NAN);
        let abscissa = Abscissa {
            drive: path_drive(motion),
            clock: only_value(nothing),
            heading: 1.0,
            unit: motion.path.scale(),
        };
        Self {
            state: State::empty(Arc::new(design), abscissa),
            solver: motion.solver(),
            motion,
            measures,
        }
    }

    /// The measures (SI) of all designs at a path parameter; NaN in the lanes of designs that do not close there.
    pub fn at(&mut self, p: f64) -> Vec<Lanes<W>> {
        let at = Series::variable(Lanes::from_f64(p));
        let design = self.state.design.clone();
        // The drives stand where the motion has them, whatever the laws of the designs are.
        self.motion.branch_at(p, &mut self.solver.branch);
        (self.motion.path).coordinates(at, &mut self.solver.coordinates);
        self.solver.run(self.motion, &design);
        self.state.poses.clone_from(&self.solver.state.poses);
        (self.state.coordinates).clone_from(&self.solver.coordinates);
        self.state.near.clone_from(&self.solver.branch.near);
        let history = History::default();
        let moment = Moment::new(&self.state, &history, &[], None);
        let closes = |lane: usize| {
            let mut poses = self.state.poses.iter();
            poses.all(|pose| {
                [pose.x, pose.c]
                    .iter()
                    .all(|part| part.coefficient(0).lane(lane).is_finite())
            })
        };
        let closed: [bool; W] = std::array::from_fn(closes);
        (self.measures.iter())
            .map(|measure| {
                let value = moment.value(measure);
                Lanes::from_fn(|k| if closed[k] { value.lane(k) } else { f64::NAN })
            })
            .collect()
    }
}

/// The drive that moves alone.
fn path_drive(motion: &Motion) -> Option<DriveId> {
    match motion.path {
        DrivePath::Coordinate { drive, .. } => Some(DriveId(drive as u32)),
        DrivePath::Time { .. } => None,
    }
}

/// Whether a measure is of the poses along a motion's path alone: neither of time nor of forces, and without a history.
pub fn is_of_poses(motion: &Motion, measure: &Measure) -> bool {
    let along = path_drive(motion);
    let mut alone = order_of(motion.mechanism(), measure).is_ok();
    visit_leaves(motion.mechanism(), measure, &mut |leaf| {
        alone &= match leaf {
            Leaf::Parameter(_) | Leaf::Named(_) | Leaf::Drive(_) => true,
            Leaf::Coefficient(_, drive, _)
            | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => along == Some(*drive),
            // Its sense asks which way the motion runs, and a direction for the turns it has made.
            Leaf::Pose(PoseMeasure::Curvature(_) | PoseMeasure::Direction(..)) => false,
            Leaf::Pose(pose) => match pose.nature() {
                Nature::InTime(_) | Nature::Forces => false,
                // Along a time path, with several drives, what is geometry of the path is not asked for.
                nature => along.is_some() || nature.order() == 0,
            },
            _ => false,
        };
    });
    alone
}
