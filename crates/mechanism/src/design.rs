//! A mechanism with dimensions on one kind of number.

use std::sync::Arc;

use kempe_model::{Law, Model};
use kempe_number::Number;

use crate::Mechanism;
use crate::closed_form::{DYAD_CONSTANTS, dyad_constants};
use crate::geometry::Geometry;
use crate::plan::{DyadBody, Step};

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

    /// The same design on a richer number, of which `constant` makes constants: dimensions do not vary along a series, and
    /// nothing of them is computed on it.
    #[inline(never)]
    pub fn lift<R: Number>(&self, constant: impl Fn(T) -> R) -> Design<R> {
        Design {
            mechanism: self.mechanism.clone(),
            parameters: self.parameters.iter().map(|x| constant(*x)).collect(),
            geometry: self.geometry.map(&constant),
            constants: (self.constants.iter()).map(|c| c.map(&constant)).collect(),
            plain: vec![self.geometry.value()],
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
            if let Step::Dyad(dyad) = step.closed() {
                let own =
                    |body: DyadBody| (geometry.marker(body.outer), geometry.marker(body.inner));
                self.constants[dyad.constants] = dyad_constants(own(dyad.a), own(dyad.b));
            }
        }
    }
}

impl Design<f64> {
    /// The same design of a model whose laws and hints were changed: nothing else of it may be.
    pub fn with_model(&self, change: impl FnOnce(&mut Model)) -> Self {
        let mut mechanism = (*self.mechanism).clone();
        change(&mut mechanism.structure.model);
        Self {
            mechanism: Arc::new(mechanism),
            ..self.clone()
        }
    }

    /// The same design whose drives move by other laws, where there are some.
    pub fn with_laws(&self, law: impl Fn(usize) -> Option<Law>) -> Self {
        self.with_model(|model| {
            for (index, drive) in model.drives.iter_mut().enumerate() {
                if let Some(law) = law(index) {
                    drive.law = law;
                }
            }
        })
    }

    /// The same design whose inner states, in the order of [`Model::inner_states`], go by these laws.
    pub fn with_inner_laws(&self, laws: Vec<Option<Law>>) -> Self {
        self.with_model(|model| model.inner_laws = laws)
    }

    /// A characteristic length of the mechanism, m: see [`Geometry::size`].
    pub fn size(&self) -> f64 {
        self.geometry.size(&self.mechanism)
    }
}
