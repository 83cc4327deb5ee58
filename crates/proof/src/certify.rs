//! Proofs that poses exist and are the only ones: of one pose, and of a whole motion.
//!
//! A [`Certificate`] is a proof by interval arithmetic about the mechanism whose dimensions are exactly the numbers
//! the model holds in SI (`f64`), at exactly the drive coordinate asked for. Rounding is enclosed, so nothing rests on
//! a tolerance.
//!
//! * [`Certifier::pose`] runs the plan on intervals. A closed form has two assemblies, told apart by the sign of its
//!   determinant: where the radicand's interval is positive the pose on the branch exists and is the only one with that
//!   sign. A Newton block is proved by Krawczyk's operator (module `krawczyk`): its pose is the only one in a box.
//! * [`Certifier::near`] proves the pose next to a given one, all bodies at once, whatever the plan.
//! * [`Certifier::motion`] covers the motion by stretches of the path parameter. For each it proves that in a tube about
//!   the tangent at the stretch's middle there is exactly one pose for every parameter, and that it moves smoothly with
//!   it (the Jacobian is regular in all of the tube). Where the pose at a common end of two stretches is proved to lie
//!   in both tubes, both hold one and the same branch.
//!
//! * [`Certifier::largest`] bounds what is measured along a proved motion, by branch and bound.
//!
//! At change points and limits the Jacobian is singular and nothing can be proved by these means: a neighbourhood is
//! left over and reported as a [`Gap`].
//!
//! Redundant constraints agree on paper and not in floating-point dimensions, so their agreement can not be proved. The
//! proof is then about the other constraints; how many were left out is counted, and that their residuals may vanish is
//! checked.

mod cell;
mod cover;
mod extreme;
mod found;
mod pose;

pub use self::cover::{Subdivision, certify_motion};
pub use self::found::{Cell, Certificate, CertifiedMotion, Gap};

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_mechanism::blocks::Row;
use kempe_mechanism::geometry::Geometry;
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::BodyId;
use kempe_motion::bridge::SideSeries;
use kempe_motion::motion::{Motion, Solver};
use kempe_number::{Interval, Number};

use crate::krawczyk::{Curve, Middle, System};
use crate::not_proved::NotProved;

/// The pose proved may differ this much from the one followed (mechanism sizes and rad), or it is another one.
const SAME: f64 = 1e-6;
/// Redundant constraints agree within this residual, in mechanism sizes: dimensions that agree on paper miss by a few
/// roundings.
const AGREED: f64 = 1e-12;

/// Proves poses of a motion.
pub struct Certifier {
    motion: Arc<Motion>,
    design: Design<Interval>,
    rich: Geometry<Curve>,
    side: Design<SideSeries>,
    system: System,
    idle: Vec<BodyId>,
    surplus: Vec<Row>,
    knots: Vec<f64>,
    plain: Solver<f64>,
    wide: Solver<Interval>,
}

/// Proves the pose of a motion at a path parameter, or says why it can not: see [`Certifier::pose`].
pub fn certify_pose(motion: &Arc<Motion>, p: f64) -> Certificate {
    Certifier::new(motion).pose(Interval::from_f64(p))
}

impl Certifier {
    /// Prepares the dimensions as intervals.
    pub fn new(motion: &Arc<Motion>) -> Self {
        let mechanism = motion.mechanism();
        let decomposition = &mechanism.plan.decomposition;
        let given = motion.design.parameters.iter();
        let parameters: Vec<Interval> = given.map(|x| Interval::from_f64(*x)).collect();
        let design = motion.design_of(&parameters);
        Self {
            // Not computed as series: a triangle whose points lie in line would divide by the interval of its height, which
            // holds zero.
            rich: design.geometry.map(Curve::constant),
            design,
            side: motion.design_on(),
            system: System::whole(mechanism),
            idle: decomposition.idle.clone(),
            surplus: decomposition.surplus.clone(),
            knots: motion.path.knots(),
            plain: motion.solver(),
            wide: motion.solver(),
            motion: motion.clone(),
        }
    }

    /// Fills the branch, the coordinates and the poses that are known beforehand.
    fn prepare(&mut self, p: Interval) -> Result<(), NotProved> {
        let motion = &*self.motion.clone();
        if !(motion.reaches(p.lo()) && motion.reaches(p.hi())) {
            return Err(NotProved::NotReached);
        }
        if self.knots.iter().any(|b| p.lo() < *b && *b < p.hi()) {
            return Err(NotProved::Break);
        }
        motion.branch_at(p.midpoint(), &mut self.plain.branch);
        motion.path.coordinates(p, &mut self.wide.coordinates);
        self.wide
            .state
            .set_inputs(motion.mechanism(), &self.wide.coordinates);
        self.wide.state.poses.fill(Pose::identity());
        Ok(())
    }

    /// Whether there are redundant rows, and whether they may hold.
    fn check_redundant(&self) -> Result<(), NotProved> {
        let mechanism = self.motion.mechanism();
        let situation = self.wide.state.situation(&self.design, &self.plain.branch);
        for row in &self.surplus {
            let residual = situation.residual(&mechanism.constraints[row.constraint].0)[row.row];
            if residual.mig() > AGREED * self.motion.size() {
                return Err(NotProved::Contradiction {
                    constraint: row.constraint,
                });
            }
        }
        match self.surplus.len() {
            0 => Ok(()),
            rows => Err(NotProved::Redundant { rows }),
        }
    }
}

/// Whether two poses are one, but for idle angles.
fn same_but(idle: &[BodyId], a: &Middle, b: &Middle, size: f64) -> bool {
    a.iter().zip(b).enumerate().all(|(body, (a, b))| {
        let turned = idle.iter().any(|i| i.index() == body) || (a[2] - b[2]).abs() < SAME;
        turned && (a[0] - b[0]).abs() < SAME * size && (a[1] - b[1]).abs() < SAME * size
    })
}
