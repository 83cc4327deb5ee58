//! The mechanism as the user described it: plain data in SI, nothing computed.
//!
//! Every dimension is an expression over the parameters, so that one model serves a whole space of designs: evaluate
//! the parameters on any [`Number`](kempe_number::Number) and everything else follows.

use std::sync::Arc;

use kempe_units::Dimension;

use crate::bound::Bound;
use crate::drive::Drive;
use crate::hint::AssemblyHint;
use crate::ids::{ParameterId, Scalar, Span};
use crate::joint::Joint;
use crate::link::{Link, Point};
use crate::measure::NamedMeasure;
use crate::study::Study;
use crate::tables::Tables;

/// A mechanism with its drives, measures and studies.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The file's title, or its name.
    pub title: String,
    /// The file's own units, for showing lengths and angles back to the user.
    pub units: FileUnits,
    /// Parameters, each depending only on earlier ones.
    pub parameters: Vec<Parameter>,
    /// Links; the first is the frame.
    pub links: Vec<Link>,
    /// Named points in order of first appearance.
    pub points: Vec<Point>,
    /// Joints that shared names do not say, in file order.
    pub joints: Vec<Joint>,
    /// Drives in file order.
    pub drives: Vec<Drive>,
    /// What acts on it.
    pub actions: crate::load::Actions,
    /// Play at its joints, in file order.
    pub clearances: Vec<crate::clearance::Clearance>,
    /// Which assembly is meant.
    pub assembly: Vec<AssemblyHint>,
    /// Where the file draws points, and which links list them.
    pub drawing: crate::drawing::Drawing,
    /// Named measures in file order; a measure may use earlier and later ones but not itself.
    pub measures: Vec<NamedMeasure>,
    /// Studies in file order.
    pub studies: Vec<Study>,
    /// What the file's values must keep to, whatever the parameters are set to.
    pub bounds: Vec<Bound>,
    /// How its [inner states](Model::inner_states) go in time, where a simulation has found that: none in a model that was read.
    pub inner_laws: Vec<Option<crate::drive::Law>>,
    /// The text that says it all, but for [tables](Self::tables), where it was read from one that names none but beside it.
    pub source: Option<Arc<str>>,
    /// The tables that [the text](Self::source) names.
    pub tables: Arc<Tables>,
    /// Parameters whose values went into plain numbers when the file was read (the period of a table).
    pub settled: Vec<ParameterId>,
}

impl Model {
    /// The parameter whose value [went into a plain number](Self::settled) when the file was read, if that is this one or follows it.
    pub fn settled_by(&self, id: ParameterId) -> Option<ParameterId> {
        // A parameter depends on earlier ones only.
        let mut reached = vec![false; self.parameters.len()];
        for (index, parameter) in self.parameters.iter().enumerate() {
            let follows = |leaf: &ParameterId| reached.get(leaf.index()) == Some(&true);
            reached[index] = index == id.index() || parameter.value.leaves().any(follows);
        }
        let mut settled = self.settled.iter().copied();
        settled.find(|other| reached[other.index()])
    }
}

/// Units in which bare numbers of the file are read and results are shown: m and deg where the file names none.
///
/// Bare numbers of other dimensions are in the unit that results are shown in, made of these two with kg and s:
/// a bare speed in a file in mm is in mm/s, a bare moment of inertia always in kg m^2.
#[derive(Clone, Debug, PartialEq)]
pub struct FileUnits {
    /// Length unit, as written, such as `mm`.
    pub length: UnitName,
    /// Angle unit, as written, such as `deg`.
    pub angle: UnitName,
    /// Units of force, torque, pressure, power and mass, where the file names them.
    pub more: Vec<UnitName>,
}

/// A unit by the name the user wrote, with its size in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitName {
    /// As written.
    pub name: String,
    /// One of it, in SI.
    pub factor: f64,
}

/// A named dimension of the design.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Value, from earlier parameters.
    pub value: Scalar,
    /// Dimension.
    pub dimension: Dimension,
    /// Where it stands in the file (the value).
    pub span: Span,
}
