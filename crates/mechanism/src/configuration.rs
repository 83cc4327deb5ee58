//! What a position solve fills: the poses at given inputs, with its storage.

use kempe_linear::Qr;
use kempe_model::DriveId;
use kempe_number::Number;
use kempe_units::Dimension;

use crate::Mechanism;
use crate::branch::Branch;
use crate::constraint::{Input, Situation};
use crate::design::Design;
use crate::geometry::Geometry;
use crate::ids::{BodyId, LineRef, Marker};
use crate::local_marker::LocalMarker;
use crate::pose::Pose;
use crate::spanning_tree::{ON_STACK, SpanningTree};

/// Inputs and poses at one instant, and the storage a solve needs.
#[derive(Clone, Debug)]
pub struct Configuration<T> {
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
    /// Twice as many for numbers in lanes: what is solved lane by lane.
    pub lane_rhs: Vec<T>,
    pub points: Vec<[f64; 2]>,
    pub wide_points: Vec<[T; 2]>,
    /// Whether determinants of Newton blocks are wanted: they cost as much as a step.
    pub determinants: bool,
    /// The dimensions of one lane; none on numbers without lanes.
    pub geometry: Option<Geometry<f64>>,
    pub qr: Qr,
    /// One for each lane, of numbers in lanes that are solved lane by lane.
    pub lane_qrs: Vec<Qr>,
}

impl<T: Number> Configuration<T> {
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
        let (plain_bodies, plain_drives) = match plan.newton_blocks.is_empty() {
            true => (0, 0),
            false => (mechanism.bodies, drives),
        };
        Self {
            inputs: vec![Input::length(T::zero()); drives],
            poses: vec![Pose::identity(); mechanism.bodies],
            determinants: vec![T::one(); plan.steps.len()],
            scratch: Scratch {
                poses: vec![Pose::identity(); plain_bodies],
                inputs: vec![Input::length(0.0); plain_drives],
                rhs: vec![0.0; rows],
                wide_rhs: vec![T::zero(); rows],
                lane_rhs: vec![T::zero(); if T::IN_LANES { 2 * rows } else { 0 }],
                points: vec![[0.0; 2]; points],
                wide_points: vec![[T::zero(); 2]; points],
                determinants: true,
                geometry: (T::IN_LANES && !plan.newton_blocks.is_empty())
                    .then(|| Geometry::new(mechanism, &mechanism.model.parameter_values())),
                qr: Qr::with_capacity(rows, columns),
                lane_qrs: (0..if rows > 0 { T::LANE_COUNT } else { 0 })
                    .map(|_| Qr::with_capacity(rows, columns))
                    .collect(),
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
        LocalMarker::new(design, marker).place(&self.poses)
    }

    /// Origin and unit direction of a line in the frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn placed_line(&self, design: &Design<T>, line: LineRef) -> ([T; 2], [T; 2]) {
        let local = design.geometry.line(line);
        if line.body == BodyId::GROUND {
            return (local.origin, local.direction);
        }
        let pose = &self.poses[line.body.index()];
        (pose.place(local.origin), pose.turn(local.direction))
    }

    /// The turn by an angle constant and a drive, as a unit vector.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn turn_by(
        &self,
        design: &Design<T>,
        offset: u32,
        input: Option<DriveId>,
        reversed: bool,
    ) -> [T; 2] {
        let mut by = design.geometry.angles[offset as usize];
        if let Some(drive) = input {
            let q = &self.inputs[drive.index()];
            by = [by[0] * q.c - by[1] * q.s, by[1] * q.c + by[0] * q.s];
        }
        if reversed {
            by[1] = -by[1];
        }
        by
    }

    /// What the constraints see of this configuration.
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
    match drive.dimension {
        Dimension::ANGLE => Input::turn(value),
        _ => Input::length(value),
    }
}
