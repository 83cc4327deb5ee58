//! What a position solve works on: a design, a branch, and the state it fills.

use std::sync::Arc;

use kempe_model::DriveKind;
use kempe_number::Number;

use crate::Mechanism;
use crate::closed_form::{DYAD_CONSTANTS, dyad_constants};
use crate::constraint::{Input, Situation};
use crate::geometry::Geometry;
use crate::known::Known;
use crate::newton::{ON_STACK, SpanningTree};
use crate::plan::{DyadBody, Step};
use crate::pose::Pose;
use crate::qr::Qr;
use crate::structure::Marker;

/// A design: a mechanism with dimensions on one kind of number (several designs at once in lanes), and what the plan's closed
/// forms prepare from them.
#[derive(Clone, Debug)]
pub struct Design<T> {
    /// The mechanism, shared.
    pub mechanism: Arc<Mechanism>,
    /// Values of the parameters, SI, in the model's order.
    pub parameters: Vec<T>,
    /// Where points and lines lie in their bodies.
    pub geometry: Geometry<T>,
    /// Constants of every dyad.
    pub constants: Vec<[T; DYAD_CONSTANTS]>,
    /// Plain dimensions behind `geometry`, one per lane: where Newton's method starts.
    pub plain: Vec<Geometry<f64>>,
}

impl<T: Number> Design<T> {
    /// Prepares a design from parameter values (SI, in the model's order).
    pub fn new(mechanism: &Arc<Mechanism>, parameters: &[T]) -> Self {
        let geometry = Geometry::new(mechanism, parameters);
        let plain = vec![geometry.value()];
        Self::from_geometry(mechanism, parameters, geometry, plain)
    }

    /// A design of a geometry already evaluated for these parameters; `plain` are the plain ones, one per lane.
    pub fn from_geometry(
        mechanism: &Arc<Mechanism>,
        parameters: &[T],
        geometry: Geometry<T>,
        plain: Vec<Geometry<f64>>,
    ) -> Self {
        let mut it = Self {
            geometry,
            constants: vec![[T::zero(); DYAD_CONSTANTS]; mechanism.plan.dyads],
            plain,
            mechanism: mechanism.clone(),
            parameters: parameters.to_vec(),
        };
        it.prepare();
        it
    }

    /// Counts the angles of links by whole turns: see [`Geometry::count_turns`].
    pub fn count_turns(&mut self, turns: &[f64]) {
        self.geometry.count_turns(&self.mechanism, turns);
        for plain in &mut self.plain {
            plain.count_turns(&self.mechanism, turns);
        }
    }

    /// Evaluates the dimensions anew for other parameter values, in the same storage; not the plain ones.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn update(&mut self, parameters: &[T]) {
        self.parameters.copy_from_slice(parameters);
        self.geometry.update(&self.mechanism, parameters);
        self.prepare();
    }

    /// Fills the closed forms' constants from the geometry.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn prepare(&mut self) {
        let geometry = &self.geometry;
        for step in &self.mechanism.plan.steps {
            if let Step::Dyad(dyad) = step {
                let own =
                    |body: DyadBody| (geometry.marker(body.outer), geometry.marker(body.inner));
                self.constants[dyad.constants] = dyad_constants(own(dyad.a), own(dyad.b));
            }
        }
    }
}

impl Design<f64> {
    /// A characteristic length of the mechanism, m: see [`Geometry::size`].
    pub fn size(&self) -> f64 {
        self.geometry.size(&self.mechanism)
    }

    /// The same design as constants of a richer number.
    #[inline(never)]
    pub fn lift<T: Number>(&self) -> Design<T> {
        Design {
            mechanism: self.mechanism.clone(),
            parameters: self.parameters.iter().map(|x| T::from_f64(*x)).collect(),
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
    pub fn neutral(mechanism: &Mechanism) -> Self {
        let plan = &mechanism.plan;
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
    pub fn new(mechanism: &Mechanism) -> Self {
        let plan = &mechanism.plan;
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
    pub fn without_determinants(mut self) -> Self {
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
pub fn input_of<T: Number>(drive: &kempe_model::Drive, value: T) -> Input<T> {
    match drive.kind {
        DriveKind::Turn { .. } => Input::turn(value),
        DriveKind::Cylinder { .. } | DriveKind::Slide { .. } => Input::length(value),
    }
}
