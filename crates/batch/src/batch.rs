//! What is asked of many poses: the motion, and the points and bodies whose places are told.

use std::sync::Arc;

use kempe_mechanism::plan::Step;
use kempe_mechanism::structure::{BodyId, Marker};
use kempe_model::PointId;
use kempe_motion::Motion;
use kempe_number::InstructionSet;

use crate::error::BatchError;
use crate::kept::Kept;
use crate::order::Order;
use crate::stretch::{ModeStretch, stretches};

/// Columns of a body: x, y, and its direction.
pub(super) const PARTS: usize = 4;

/// Finds chosen points of a mechanism at many poses. Storage for many designs is kept from call to call; a copy begins without any.
///
/// # Example
/// ```
/// use kempe_batch::{Batch, Designs, Layout};
/// use kempe_mechanism::{Design, Mechanism};
/// use kempe_motion::Motion;
///
/// let file = r#"
/// [parameters]
/// a = "20 mm"
/// [links]
/// frame = { A = [0, 0], D = ["60 mm", 0] }
/// crank = { A-B = "a" }
/// coupler = { B-C = "50 mm" }
/// rocker = { D-C = "40 mm" }
/// [drives]
/// motor = { turns = "crank", from = "0 deg", to = "360 deg", speed = "1 rad/s" }
/// "#;
/// let model = kempe_model::Model::from_toml(file, "four-bar", &mut |_| Err("no tables".into())).unwrap().model;
/// let mechanism = Mechanism::new(&model);
/// let parameters: Vec<f64> = model.parameter_values();
/// let design = Design::new(&mechanism, &parameters);
/// let motion = Motion::new(&design).unwrap();
///
/// let joint = model.points.iter().position(|p| p.name == "C").unwrap();
/// let batch = Batch::new(&motion, &[kempe_model::PointId(joint as u32)]).unwrap();
/// let mut places = [0.0; 6];
/// assert_eq!(batch.sweep(&[0.0, 1.0, 2.0], &mut places), Ok(3)); // x, x, x, y, y, y
///
/// // Two designs at one place; the second cannot be assembled there.
/// let designs = Designs { values: &[0.025, 0.200], count: 2, layout: Layout::ByParameter };
/// let mut places = [0.0; 4];
/// assert_eq!(batch.designs(designs, &[1.0], &mut places), Ok(1));
/// assert!(places[0].is_finite() && places[1].is_nan());
/// ```
#[derive(Clone, Debug)]
pub struct Batch {
    pub(crate) motion: Arc<Motion>,
    pub(crate) markers: Vec<Marker>,
    pub(crate) bodies: Vec<usize>,
    /// Steps of the plan whose determinants are told.
    pub(crate) determinants: Vec<usize>,
    pub(crate) set: InstructionSet,
    pub(crate) stretches: Vec<ModeStretch>,
    pub(crate) needs_guess: bool,
    pub(crate) order: Order,
    pub(crate) kept: Kept,
}

impl Batch {
    /// Prepares for points of the motion's mechanism.
    ///
    /// # Errors
    /// [`BatchError::NoSuchPoint`].
    pub fn new(motion: &Arc<Motion>, points: &[PointId]) -> Result<Self, BatchError> {
        Self::with_bodies(motion, points, &[])
    }

    /// Prepares for points and for whole poses of moving bodies: behind the columns of the points come four for each body, the place of
    /// its origin and its direction as a unit vector.
    ///
    /// # Errors
    /// [`BatchError::NoSuchPoint`].
    pub fn with_bodies(
        motion: &Arc<Motion>,
        points: &[PointId],
        bodies: &[BodyId],
    ) -> Result<Self, BatchError> {
        let bodies: Vec<usize> = bodies.iter().map(|body| body.index()).collect();
        let mechanism = motion.mechanism();
        let markers: Vec<Marker> = (points.iter())
            .map(|&p| mechanism.any_marker(p).ok_or(BatchError::NoSuchPoint(p)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            motion: motion.clone(),
            set: InstructionSet::detect(),
            stretches: stretches(motion),
            needs_guess: motion.mechanism().plan.steps.iter().any(Step::needs_guess),
            order: Order::new(mechanism, &markers, &bodies),
            markers,
            bodies,
            determinants: Vec::new(),
            kept: Kept::default(),
        })
    }

    /// Tells behind everything else the determinant of every step of the plan that vanishes where assemblies meet, one column each:
    /// a signed length or area, smooth along a motion. Sweeps know none of Newton groups.
    pub fn with_determinants(mut self) -> Self {
        let steps = self.motion.mechanism().plan.steps.iter().enumerate();
        let telling = steps.filter(|(_, step)| step.tells_modes());
        self.determinants = telling.map(|(index, _)| index).collect();
        self.kept = Kept::default();
        self
    }

    /// How many of the columns, the last ones, are determinants.
    pub fn determinants(&self) -> usize {
        self.determinants.len()
    }

    /// Uses these vector instructions at most. The results are the same.
    pub fn with_instructions(mut self, set: InstructionSet) -> Self {
        self.set = set;
        self
    }

    /// Columns of positions: two for each point, four for each body, and the determinants that are told.
    pub fn columns(&self) -> usize {
        2 * self.markers.len() + PARTS * self.bodies.len() + self.determinants.len()
    }
}
