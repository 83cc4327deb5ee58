//! A motion: the branch through the chosen assembly, known all along the drives' path.
//!
//! It begins at an assembly (`start`), where the mechanism is drawn if that is elsewhere (`drawn`), and is followed from there both ways (`follow`), with restricted steps where branches come
//! near each other (`restriction`). Where modes change between nodes of the trace it is split (`modes`). From then on the branch is
//! known everywhere (`branch`), and rows are solved on any number (`solver`). That of a design much like one known is found from it
//! (`again`).

mod again;
mod branch;
mod counted;
mod drawn;
mod error;
mod follow;
mod modes;
mod placed;
mod restriction;
mod solver;
mod start;

pub use self::again::PutTogether;
pub use self::error::MotionError;
pub(crate) use self::follow::runs_away;
pub use self::follow::{EndReason, FAR, STEP_LIMIT, WHIRLING};
pub use self::modes::CROSSING;
pub use self::placed::Placed;
pub use self::restriction::MEETING;
pub(crate) use self::restriction::{Unlocated, restricting_steps};
pub use self::solver::Solver;
pub use self::start::SIZES;

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_mechanism::Mechanism;
use kempe_mechanism::pose::Pose;
use kempe_model::{SAME_END, StartsElsewhere};

use crate::assemble::Assemblies;
use crate::drive_path::DrivePath;
use crate::events::{Event, EventKind};
use crate::progress::{Progress, Silent};
use crate::trace::{Node, Path, unscale};

/// A motion may end this close to a limit (in path scales) and still count as reaching it.
pub const AT_LIMIT: f64 = 1e-12;

/// A place located this near (in path scales) beyond the demanded range lies at its end.
const AT_END: f64 = 1e-9;

/// A change point this near (in path scales) to the start is where the motion starts.
const AT_START: f64 = 1e-6;

/// What is asked of a motion.
#[derive(Clone, Debug)]
pub struct Demand {
    /// The drives' path.
    pub path: DrivePath,
    /// Range of the path parameter to cover.
    pub range: (f64, f64),
    /// Where it starts.
    pub start: f64,
    /// All assemblies at the start, where they are known already: finding them can take long.
    pub assemblies: Option<Assemblies>,
}

/// Why a drawing does not say which assembly is meant at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftDrawing {
    /// The drives that start elsewhere.
    pub elsewhere: Vec<StartsElsewhere>,
    /// How far these drives come on the way from the drawing to the start, and why no farther; `None` where the mechanism
    /// cannot be put together as it is drawn.
    pub ends: Option<(Vec<f64>, EndReason)>,
}

/// The branch of a motion, all along the path: what every row of a table is computed from. It lives once, shared by the
/// samplers, batches and proofs of it.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The design, the angles of its links counted as in the chosen assembly.
    pub design: Design<f64>,
    /// The drives' path.
    pub path: DrivePath,
    /// All assemblies at the anchor, the chosen one first.
    pub assemblies: Assemblies,
    /// Path parameter where the assembly was chosen: the start, or near it when the start is singular; where the mechanism is
    /// drawn when it starts elsewhere.
    pub anchor: f64,
    /// How many assemblies at the anchor fit the file's hints and lead to the pose at the start: more than one where the
    /// start is a change point and the hints do not tell which branch is meant.
    pub choices: usize,
    /// Path parameter where the motion starts.
    pub start: f64,
    /// Demanded range of the path parameter.
    pub demanded: (f64, f64),
    /// Why the drawing did not choose the assembly, where drives start elsewhere than drawn.
    pub left_drawing: Option<LeftDrawing>,
    /// The motion from whose start directions are counted, in a family of designs, and at whose places those of forces; by itself each counts from
    /// within half a turn.
    pub counts_as: Option<Arc<Self>>,
    /// Why the trace ended at its low and its high end.
    pub ends: (EndReason, EndReason),
    /// Dead points, change points and limits met within the demanded range, in order of the path parameter.
    pub events: Vec<Event>,
    /// All those on the trace, which goes a little beyond the demanded range.
    pub places: Vec<Event>,
    pub(crate) nodes: Vec<Node>,
    /// How many nodes the trace had from which they come.
    traced: usize,
    parameters: Vec<f64>,
    patches: Vec<Patch>,
    scale: f64,
    size: f64,
}

/// One stretch of the motion on which every assembly mode stays the same.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    /// The node where it begins.
    pub from: usize,
    /// Assembly mode of every step.
    pub signs: Vec<f64>,
}

impl Motion {
    /// Finds the assembly at the start and follows it over the demanded range of the drives.
    ///
    /// # Errors
    /// When it cannot start. A range that is cut short by a limit is not an error here: see [`Motion::ends`].
    pub fn new(design: &Design<f64>) -> Result<Arc<Self>, MotionError> {
        Self::with_progress(design, &mut Silent)
    }

    /// As [`Motion::new`]; `progress` hears how far it has come and may stop it.
    ///
    /// # Errors
    /// As [`Motion::new`], and [`MotionError::Stopped`].
    pub fn with_progress(
        design: &Design<f64>,
        progress: &mut dyn Progress,
    ) -> Result<Arc<Self>, MotionError> {
        let demand = Self::demand(design);
        let stands = demand.range.0 == demand.range.1 && design.mechanism.model.drives.len() > 1;
        let found = match Self::along(design, demand, progress) {
            // Drives that depend on each other stand together where none of them can be moved alone.
            Err(MotionError::Locked { .. }) if stands => {
                let (model, parameters) = (&design.mechanism.model, &design.parameters);
                let path = DrivePath::in_time(model, parameters, design.size());
                Self::along(design, Self::demand_on(design, path), progress)
            }
            found => found,
        };
        found.map(Arc::new)
    }

    /// What the laws of a design ask of its motion.
    pub fn demand(design: &Design<f64>) -> Demand {
        let (model, parameters) = (&design.mechanism.model, &design.parameters);
        Self::demand_on(design, DrivePath::new(model, parameters, design.size()))
    }

    fn demand_on(design: &Design<f64>, path: DrivePath) -> Demand {
        let (model, parameters) = (&design.mechanism.model, &design.parameters);
        Demand {
            range: path.range(model, parameters),
            start: path.start(model, parameters),
            assemblies: None,
            path,
        }
    }

    /// A motion over given nodes, rising in the path parameter; it covers just them.
    pub(crate) fn of_nodes(
        design: Design<f64>,
        path: DrivePath,
        assemblies: Assemblies,
        nodes: Vec<Node>,
    ) -> Self {
        let scale = path.scale();
        let at = |node: Option<&Node>| {
            node.and_then(|n| n.z.last())
                .map_or(f64::NAN, |z| z * scale)
        };
        let demanded = (at(nodes.first()), at(nodes.last()));
        Self {
            assemblies,
            anchor: demanded.0,
            choices: 1,
            left_drawing: None,
            counts_as: None,
            start: demanded.0,
            demanded,
            ends: (EndReason::Covered, EndReason::Covered),
            events: Vec::new(),
            places: Vec::new(),
            parameters: Vec::new(),
            patches: Vec::new(),
            traced: nodes.len(),
            nodes,
            scale,
            size: design.size(),
            design,
            path,
        }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Arc<Mechanism> {
        &self.design.mechanism
    }

    /// The range that was reached of the demanded one.
    pub fn reached(&self) -> (f64, f64) {
        let (first, last) = (self.parameters.first(), self.parameters.last());
        let (first, last) = (
            first.copied().unwrap_or(self.start),
            last.copied().unwrap_or(self.start),
        );
        (self.demanded.0.max(first), self.demanded.1.min(last))
    }

    /// What the trace meets within a range of the path parameter, its ends included.
    pub(crate) fn met(&self, (low, high): (f64, f64)) -> Vec<Event> {
        let margin = AT_END * self.scale;
        let within = |e: &&Event| low - margin <= e.at && e.at <= high + margin;
        self.places.iter().filter(within).cloned().collect()
    }

    /// How far beyond its ends the motion still counts as reaching.
    pub fn margin(&self) -> f64 {
        AT_LIMIT * self.scale
    }

    /// Whether a path parameter lies on the motion.
    pub fn reaches(&self, p: f64) -> bool {
        let tolerance = self.margin();
        let (Some(first), Some(last)) = (self.parameters.first(), self.parameters.last()) else {
            return false;
        };
        p >= first - tolerance && p <= last + tolerance
    }

    /// Whether a path parameter lies within what was [reached](Self::reached) of the demanded range, but for rounding: the trace goes on beyond it.
    pub fn covers(&self, p: f64) -> bool {
        let (low, high) = self.reached();
        let rounding = self.margin().max(SAME_END * (high - low));
        low - rounding <= p && p <= high + rounding
    }

    /// The change point at which the motion starts, if it does.
    pub fn start_crossing(&self) -> Option<&Event> {
        let margin = AT_START * self.scale;
        (self.places.iter())
            .find(|e| e.kind == EventKind::ChangePoint && (e.at - self.start).abs() <= margin)
    }

    /// Size of the mechanism, m: the scale of closure residuals.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Path parameter and poses of a node of the trace, with unwrapped body angles.
    pub fn node(&self, index: usize) -> (f64, Vec<Pose<f64>>, Vec<f64>) {
        let mut poses = vec![Pose::identity(); self.mechanism().bodies];
        let mut near = vec![0.0; self.mechanism().bodies];
        unscale(&self.nodes[index].z, self.size, &mut poses, &mut near);
        (self.parameters[index], poses, near)
    }

    /// Path parameters of all nodes, rising.
    pub fn node_parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// How many nodes the trace needed.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The node at a limit, when `p` is one to within [`AT_LIMIT`]. There the closed forms may miss the pose by a
    /// rounding error; the trace does not.
    pub fn limit_at(&self, p: f64) -> Option<usize> {
        [0, self.nodes.len().saturating_sub(1)]
            .into_iter()
            .find(|&index| {
                let (Some(node), Some(at)) = (self.nodes.get(index), self.parameters.get(index))
                else {
                    return false;
                };
                node.parameter_rate() == 0.0 && (p - at).abs() <= AT_LIMIT * self.scale
            })
    }

    /// The change point within whose bridge `p` lies, if any.
    pub fn bridge(&self, p: f64) -> Option<&Event> {
        self.places
            .iter()
            .find(|e| e.kind != EventKind::Limit && (p - e.at).abs() < 0.5 * e.bridge)
    }
}
