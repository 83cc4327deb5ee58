//! Following the motion: continuation along the arc, by the plan (`by_plan`) or, near where branches meet and at limits, with all
//! constraints at once.
//!
//! The step depends on the mechanism alone, never on the rows that a study wants, so the branch that comes out cannot
//! depend on them either. Every step is accepted only if the cubic through its ends, with their tangents, agrees with a
//! corrected point in the middle: a jump to another branch would show there.

mod acceptance;
mod by_plan;
mod cubic;
mod node;
mod plan_steps;
mod restriction;
mod step;

pub(crate) use self::acceptance::hides_limits;
pub use self::acceptance::{MIDDLE_TOLERANCE, TURN_LIMIT};
pub use self::cubic::{Cubic, distance, interval};
pub use self::cubic::{chord, hermite};
pub use self::node::Node;
pub(crate) use self::step::WIGGLE;

pub(crate) use self::by_plan::is_steady;
use self::node::norm;
use self::plan_steps::PlanSteps;
use self::restriction::StepRestrictions;
pub(crate) use self::restriction::apart;
use kempe_mechanism::Design;
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::constraint::{Input, Situation};
use kempe_mechanism::pose::Pose;
use kempe_model::DriveKind;

/// Part of a unit of travel that may be left over by the redundant constraints.
const LOCKED: f64 = 1e-6;
/// A correction below this (in mechanism sizes and rad) ends Newton's method.
const CORRECTED: f64 = 1e-13;
/// Least and most (in mechanism sizes and rad) that rounding leaves over of a point: most where two branches meet, at the root of the
/// rounding itself.
const LEFT_OVER: (f64, f64) = (1e-11, 1e-8);
/// Residual, as a part of the largest unknown (at least 1), that rounding leaves on the curve.
const ROUNDING: f64 = 1e-15;
/// Corrections before a point is given up.
const CORRECTIONS: usize = 8;
/// A path through the space of drive coordinates.
pub trait Path {
    /// Drive coordinates at the path parameter, and their derivatives to it.
    fn at(&self, p: f64, coordinates: &mut [f64], rates: &mut [f64]);
    /// Size of a typical change of the parameter: 1 for an angle, a mechanism size for a length.
    fn scale(&self) -> f64;
    /// Where the drives' rates jump, rising; the rates at such a place are those behind it.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
    /// The drive whose coordinate the parameter is, where it is one.
    fn drive(&self) -> Option<usize> {
        None
    }
}

/// Follows the solution curve of a mechanism along a path of its drives.
pub struct Follower<'a, P> {
    design: &'a Design<f64>,
    path: &'a P,
    /// Mechanism size, m.
    pub size: f64,
    /// The systems of all constraints; not where the plan leads all the way.
    system: Option<Bordered>,
    step: Vec<f64>,
    poses: Vec<Pose<f64>>,
    near: Vec<f64>,
    inputs: Vec<Input<f64>>,
    coordinates: Vec<f64>,
    rates: Vec<f64>,
    restrictions: StepRestrictions,
    determined: Option<f64>,
    by_plan: PlanSteps,
    /// The parameter is a distance.
    is_distance: bool,
}

/// What a follower has stored, for another one of the same mechanism.
pub(crate) struct Storage {
    system: Option<Bordered>,
    by_plan: PlanSteps,
}

impl<'a, P: Path> Follower<'a, P> {
    /// A follower for a design.
    pub fn new(design: &'a Design<f64>, path: &'a P) -> Self {
        let storage = Storage {
            system: None,
            by_plan: PlanSteps::new(design),
        };
        Self::reusing(storage, design, path)
    }

    /// A follower with the storage of another one that has not stepped by the plan.
    pub(crate) fn reusing(storage: Storage, design: &'a Design<f64>, path: &'a P) -> Self {
        let mechanism = &*design.mechanism;
        let drives = mechanism.model.drives.len();
        let own = path
            .drive()
            .and_then(|drive| mechanism.model.drives.get(drive));
        let is_distance = own.is_some_and(|own| matches!(own.kind, DriveKind::Cylinder { .. }));
        Self {
            design,
            path,
            size: design.size(),
            system: storage.system,
            step: Vec::new(),
            poses: vec![Pose::identity(); mechanism.bodies],
            near: vec![0.0; mechanism.bodies],
            inputs: vec![Input::length(0.0); drives],
            coordinates: vec![0.0; drives],
            rates: vec![0.0; drives],
            restrictions: StepRestrictions::default(),
            determined: None,
            by_plan: storage.by_plan,
            is_distance,
        }
    }

    /// Whether a step goes through a distance of nothing: behind it lies another branch, which a step may reach where its points only come near
    /// each other.
    fn turns_inside_out(&self, from: &Node, to: &Node) -> bool {
        let last = from.z.len() - 1;
        self.is_distance && from.z[last] > 0.0 && to.z[last] <= 0.0
    }

    /// What it has stored.
    pub(crate) fn into_storage(self) -> Storage {
        Storage {
            system: self.system,
            by_plan: self.by_plan,
        }
    }

    fn system(&mut self) -> &mut Bordered {
        let mechanism = &self.design.mechanism;
        self.system.get_or_insert_with(|| Bordered::new(mechanism))
    }

    /// The largest residual at a point, in mechanism sizes and rad.
    pub fn residual(&mut self, z: &[f64]) -> f64 {
        self.linearise(z);
        self.system().largest_residual()
    }

    /// How many unknowns, the path parameter included.
    pub fn unknowns(&self) -> usize {
        3 * (self.design.mechanism.bodies - 1) + 1
    }

    /// Where the drives' rates jump, and the scale of the path parameter.
    pub fn breaks(&self) -> (Vec<f64>, f64) {
        (self.path.breaks(), self.path.scale())
    }

    /// Path parameter at scaled unknowns.
    pub fn parameter(&self, z: &[f64]) -> f64 {
        z[z.len() - 1] * self.path.scale()
    }

    /// Scaled unknowns of a pose with unwrapped angles `near`.
    pub fn scaled(&self, poses: &[Pose<f64>], near: &[f64], p: f64) -> Vec<f64> {
        let mut z = Vec::with_capacity(self.unknowns());
        for (pose, near) in poses.iter().zip(near).skip(1) {
            z.extend([
                pose.x / self.size,
                pose.y / self.size,
                pose.angle_near(*near),
            ]);
        }
        z.push(p / self.path.scale());
        z
    }

    /// Poses and unwrapped angles of scaled unknowns.
    pub fn unscaled(&self, z: &[f64], poses: &mut [Pose<f64>], near: &mut [f64]) {
        unscale(z, self.size, poses, near);
    }

    /// Sets the drives' coordinates and rates at a path parameter.
    fn set_coordinates(&mut self, p: f64) {
        self.path.at(p, &mut self.coordinates, &mut self.rates);
    }

    /// Fills and factors the Jacobian and residuals at a point.
    fn linearise(&mut self, z: &[f64]) {
        let p = self.parameter(z);
        let (mut poses, mut near) = (
            std::mem::take(&mut self.poses),
            std::mem::take(&mut self.near),
        );
        self.unscaled(z, &mut poses, &mut near);
        self.set_coordinates(p);
        for ((input, drive), &value) in self
            .inputs
            .iter_mut()
            .zip(&self.design.mechanism.model.drives)
            .zip(&self.coordinates)
        {
            *input = kempe_mechanism::configuration::input_of(drive, value);
        }
        let scale = self.path.scale();
        self.rates.iter_mut().for_each(|rate| *rate *= scale);
        let situation = Situation {
            geometry: &self.design.geometry,
            inputs: &self.inputs,
            poses: &poses,
            near: &near,
        };
        let mechanism = &*self.design.mechanism;
        (self.system.get_or_insert_with(|| Bordered::new(mechanism))).fill(
            mechanism,
            &situation,
            self.size,
            &self.rates,
        );
        (self.poses, self.near) = (poses, near);
    }

    /// The unit tangent at a point, on the side of `toward`. `None` where it is not unique.
    pub fn tangent(&mut self, z: &[f64], toward: &[f64]) -> Option<Vec<f64>> {
        self.linearise(z);
        let mut t = Vec::new();
        let system = self.system();
        system.solve(false, toward, 1.0, &mut t);
        // With redundant constraints the least squares leave a rest where there is no way to move at all.
        let rest = system.rest();
        let length = norm(&t);
        if !length.is_finite() || length == 0.0 || rest > LOCKED {
            return None;
        }
        for value in &mut t {
            *value /= length;
        }
        Some(t)
    }

    /// Smallest over largest pivot of the bordered Jacobian at the point last linearised: how well the tangent is
    /// determined.
    pub fn conditioning(&self) -> f64 {
        self.system.as_ref().map_or(0.0, Bordered::conditioning)
    }

    /// [`Follower::conditioning`] at a node that the trace last began at or stepped to.
    pub fn determined(&mut self, at: &Node) -> f64 {
        if let Some(determined) = self.determined {
            return determined;
        }
        let tangent = self.tangent(&at.z, &at.tangent);
        tangent.map_or(0.0, |_| self.conditioning())
    }

    /// Corrects a point within the hyperplane across `border` through it. Returns the length of the first correction.
    pub fn correct(&mut self, z: &mut [f64], border: &[f64]) -> Option<f64> {
        let mut first = None;
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.linearise(z);
            let residual = self.system().largest_residual();
            let mut step = std::mem::take(&mut self.step);
            self.system().solve(true, border, 0.0, &mut step);
            let length = norm(&step);
            for (z, d) in z.iter_mut().zip(&step) {
                *z -= d;
            }
            self.step = step;
            // What rounding leaves over, and more of it near singular poses; where branches come near each other, as much as it may
            // ever be for a point that is on the curve.
            let size = z.iter().fold(1.0, |most: f64, z| most.max(z.abs()));
            let floor = match residual <= ROUNDING * size {
                true => LEFT_OVER.1,
                false => (1e-15 / self.conditioning()).clamp(LEFT_OVER.0, LEFT_OVER.1),
            };
            if !length.is_finite() || (length > 0.5 * last && length > 10.0 * floor) {
                return None;
            }
            first.get_or_insert(length);
            if length <= CORRECTED || (length > 0.1 * last && length < floor) {
                return first;
            }
            last = length;
        }
        None
    }

    /// Restricts the steps near a place between branches from now on; `residual` is the largest there, in mechanism sizes and rad.
    pub fn restrict(&mut self, z: Vec<f64>, residual: f64) {
        self.restrictions.add(z, residual);
    }

    /// The start of a trace: corrects `z` at fixed path parameter and finds the tangent with the parameter growing
    /// (`direction` > 0) or shrinking. `None` at a singular pose.
    pub fn start(&mut self, mut z: Vec<f64>, direction: f64) -> Option<Node> {
        let mut border = vec![0.0; z.len()];
        let last = z.len() - 1;
        border[last] = direction.signum();
        self.correct(&mut z, &border)?;
        let tangent = self.tangent(&z, &border)?;
        let determined = self.conditioning();
        self.determined = Some(determined);
        (determined > 1e-9 && tangent[last].abs() > 1e-7).then_some(Node::new(z, tangent))
    }
}

/// Poses and unwrapped angles of scaled unknowns, for a mechanism of a size, m.
pub(crate) fn unscale(z: &[f64], size: f64, poses: &mut [Pose<f64>], near: &mut [f64]) {
    for (body, part) in z.chunks_exact(3).enumerate() {
        poses[body + 1] = Pose::from_angle(part[0] * size, part[1] * size, part[2]);
        near[body + 1] = part[2];
    }
}
