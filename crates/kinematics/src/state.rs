//! What a position solve works on: a design, a branch, and the state it fills.

use kempe_model::DriveKind;
use kempe_number::Number;

use crate::closed_form::{DYAD_CONSTANTS, dyad_constants};
use crate::constraint::{Input, Situation};
use crate::geometry::Geometry;
use crate::known::Known;
use crate::mechanism::{Marker, Mechanism};
use crate::newton::{ON_STACK, SpanningTree};
use crate::plan::{DyadBody, Plan, Step};
use crate::pose::Pose;
use crate::qr::Qr;

/// The dimensions of one design (or several in lanes), with what the plan's closed forms prepare from them.
#[derive(Clone, Debug)]
pub struct Design<T> {
    /// Dimensions.
    pub geometry: Geometry<T>,
    /// Constants of every dyad.
    pub constants: Vec<[T; DYAD_CONSTANTS]>,
    /// Plain dimensions behind `geometry`, one per lane: where Newton's method starts.
    pub plain: Vec<Geometry<f64>>,
}

impl<T: Number> Design<T> {
    /// Prepares a design from parameter values (SI, in the model's order).
    pub fn new(mechanism: &Mechanism, plan: &Plan, parameters: &[T]) -> Self {
        let geometry = Geometry::new(mechanism, parameters);
        let plain = vec![geometry.value()];
        Self::from_geometry(plan, geometry, plain)
    }

    pub(crate) fn from_geometry(
        plan: &Plan,
        geometry: Geometry<T>,
        plain: Vec<Geometry<f64>>,
    ) -> Self {
        let mut it = Self {
            geometry,
            constants: vec![[T::zero(); DYAD_CONSTANTS]; plan.dyads],
            plain,
        };
        it.prepare(plan);
        it
    }

    /// Counts the angles of links by whole turns: see [`Geometry::count_turns`].
    pub(crate) fn count_turns(&mut self, mechanism: &Mechanism, turns: &[f64]) {
        self.geometry.count_turns(mechanism, turns);
        for plain in &mut self.plain {
            plain.count_turns(mechanism, turns);
        }
    }

    /// Evaluates the dimensions anew for other parameter values, in the same storage; not the plain ones.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn update(&mut self, mechanism: &Mechanism, plan: &Plan, parameters: &[T]) {
        self.geometry.update(mechanism, parameters);
        self.prepare(plan);
    }

    /// Fills the closed forms' constants from the geometry.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn prepare(&mut self, plan: &Plan) {
        let geometry = &self.geometry;
        for step in &plan.steps {
            if let Step::Dyad(dyad) = step {
                let own =
                    |body: DyadBody| (geometry.marker(body.outer), geometry.marker(body.inner));
                self.constants[dyad.constants] = dyad_constants(own(dyad.a), own(dyad.b));
            }
        }
    }
}

impl Design<f64> {
    /// The same design as constants of a richer number.
    #[inline(never)]
    pub fn lift<T: Number>(&self) -> Design<T> {
        Design {
            geometry: self.geometry.map(T::from_f64),
            constants: self.constants.iter().map(|c| c.map(T::from_f64)).collect(),
            plain: vec![self.geometry.clone()],
        }
    }
}

/// Which of the assemblies: the sign of every closed form and a place to start for every Newton block.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Assembly mode of every step; 0 where there is no choice.
    pub signs: Vec<f64>,
    /// A pose near the one wanted (only bodies of Newton blocks need one).
    pub guess: Vec<Pose<f64>>,
    /// Angle of every body to within half a turn, rad.
    pub near: Vec<f64>,
}

impl Branch {
    /// A branch with every mode at +1 and every guess at the frame's pose.
    pub fn neutral(mechanism: &Mechanism, plan: &Plan) -> Self {
        Self {
            signs: vec![1.0; plan.steps.len()],
            guess: vec![Pose::identity(); mechanism.bodies],
            near: vec![0.0; mechanism.bodies],
        }
    }
}

/// Where everything is, and the storage a solve needs.
#[derive(Clone, Debug)]
pub struct State<T> {
    /// Coordinates of the drives.
    pub inputs: Vec<Input<T>>,
    /// Poses of the bodies.
    pub poses: Vec<Pose<T>>,
    /// Determinant of every step: vanishes where assemblies meet.
    pub determinants: Vec<T>,
    pub(crate) scratch: Scratch<T>,
}

/// Storage of the Newton blocks.
#[derive(Clone, Debug)]
pub(crate) struct Scratch<T> {
    pub poses: Vec<Pose<f64>>,
    pub inputs: Vec<Input<f64>>,
    pub rhs: Vec<f64>,
    pub wide_rhs: Vec<T>,
    pub points: Vec<[f64; 2]>,
    pub wide_points: Vec<[T; 2]>,
    /// Whether determinants of Newton blocks are wanted: they cost as much as a step.
    pub determinants: bool,
    /// The dimensions of one lane; none on numbers without lanes.
    pub geometry: Option<Geometry<f64>>,
    pub qr: Qr,
}

impl<T: Number> State<T> {
    /// Storage for a mechanism and its plan.
    pub fn new(mechanism: &Mechanism, plan: &Plan) -> Self {
        let rows = plan
            .newton_blocks
            .iter()
            .map(|b| b.rows.len())
            .max()
            .unwrap_or(0);
        // Elimination on the stack always takes whole sizes.
        let rows = if rows > 0 { rows.max(ON_STACK) } else { 0 };
        let columns = plan.newton_blocks.iter().map(|b| b.size).max().unwrap_or(0);
        let trees = plan.newton_blocks.iter().filter_map(|b| b.tree.as_ref());
        let points = trees.map(SpanningTree::points).max().unwrap_or(0);
        let drives = mechanism.model.drives.len();
        Self {
            inputs: vec![Input::length(T::zero()); drives],
            poses: vec![Pose::identity(); mechanism.bodies],
            determinants: vec![T::one(); plan.steps.len()],
            scratch: Scratch {
                poses: vec![Pose::identity(); mechanism.bodies],
                inputs: vec![Input::length(0.0); drives],
                rhs: vec![0.0; rows],
                wide_rhs: vec![T::zero(); rows],
                points: vec![[0.0; 2]; points],
                wide_points: vec![[T::zero(); 2]; points],
                determinants: true,
                geometry: (T::IN_LANES && !plan.newton_blocks.is_empty())
                    .then(|| Geometry::new(mechanism, &mechanism.model.parameter_values())),
                qr: Qr::with_capacity(rows, columns),
            },
        }
    }

    /// The same storage for whom the determinants of Newton blocks are of no use: they become NaN.
    pub(crate) fn without_determinants(mut self) -> Self {
        self.scratch.determinants = false;
        self
    }

    /// Sets the drives' coordinates (SI).
    #[inline]
    pub fn set_inputs(&mut self, mechanism: &Mechanism, coordinates: &[T]) {
        for ((input, drive), &value) in self
            .inputs
            .iter_mut()
            .zip(&mechanism.model.drives)
            .zip(coordinates)
        {
            *input = input_of(drive, value);
        }
    }

    /// A marker in the frame, m.
    #[inline(always)]
    pub fn place(&self, design: &Design<T>, marker: Marker) -> [T; 2] {
        Known::new(design, marker).place(&self.poses)
    }

    /// What the constraints see of this state.
    pub fn situation<'a>(&'a self, design: &'a Design<T>, branch: &'a Branch) -> Situation<'a, T> {
        Situation {
            geometry: &design.geometry,
            inputs: &self.inputs,
            poses: &self.poses,
            near: &branch.near,
        }
    }
}

/// A drive's coordinate as the constraints see it.
#[inline(always)]
pub(crate) fn input_of<T: Number>(drive: &kempe_model::Drive, value: T) -> Input<T> {
    match drive.kind {
        DriveKind::Turn { .. } => Input::turn(value),
        DriveKind::Cylinder { .. } | DriveKind::Slide { .. } => Input::length(value),
    }
}
