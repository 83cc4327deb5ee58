//! The state of a mechanism: where everything is, how it moves, and when.

use std::sync::Arc;

use kempe_mechanism::{BodyId, Mechanism, PlanNumber, Pose};
use kempe_mechanism::{Branch, Design};
use kempe_model::DriveId;
use kempe_number::{Jet, Number};

/// Coefficients carried by a series: position and four derivatives.
pub const ORDER: usize = 5;

/// A series in an abscissa of a path, in time or in one drive.
pub type Series<B> = Jet<B, ORDER>;

/// What a series runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The path parameter: the coordinate of the only moving drive, or time when several move.
    Path,
    /// Time.
    Time,
    /// One drive, the others at rest.
    Drive(DriveId),
}

/// What the series of a state run along.
#[derive(Clone, Debug)]
pub struct Abscissa<B> {
    /// The drive whose coordinate it is; `None` where it is time itself.
    pub drive: Option<DriveId>,
    /// It as a series in time. Without a finite rate the state has no time: then only values of geometry are known.
    pub clock: Series<B>,
    /// Which way the motion runs along it: 1 or -1. At rest the clock does not tell.
    pub heading: f64,
    /// A typical change of it: below a small part of this, in mechanism sizes, nothing moves.
    pub unit: f64,
}

impl<B: Number> Abscissa<B> {
    /// Time itself, at a time, s; `unit` is a typical duration, s.
    pub fn time(time: B, unit: f64) -> Self {
        Self {
            drive: None,
            clock: Series::variable(time),
            heading: 1.0,
            unit,
        }
    }
}

/// Where everything is, how it moves, and when: all that measures and forces look at. Whoever finds states (a motion along
/// the drives' path, a simulation in time, a dragged pose) need not know what they are asked for.
#[derive(Clone, Debug)]
pub struct State<B> {
    /// The design, as constants of the series.
    pub design: Arc<Design<Series<B>>>,
    /// Time, s.
    pub time: B,
    /// What the series below run along.
    pub abscissa: Abscissa<B>,
    /// Poses of the bodies along the abscissa.
    pub poses: Vec<Pose<Series<B>>>,
    /// Coordinates of the drives along the abscissa, SI.
    pub coordinates: Vec<Series<B>>,
    /// Angles of the bodies to within half a turn, rad.
    pub near: Vec<f64>,
    /// For drives that measures or forces ask for, the poses along that drive alone, all others at rest: its kinematic
    /// coefficients. Not needed for the drive of the abscissa.
    pub alone: Vec<Option<Vec<Pose<Series<B>>>>>,
    /// The model's inner states in time, where anything follows them.
    pub inner: Vec<Series<B>>,
}

impl<B: Number> State<B> {
    /// Storage for states of a design, at rest at the frame's pose.
    pub(crate) fn empty(design: Arc<Design<Series<B>>>, abscissa: Abscissa<B>) -> Self {
        let (bodies, drives) = (design.mechanism.bodies, design.mechanism.model.drives.len());
        Self {
            time: abscissa.clock.coefficient(0),
            abscissa,
            poses: vec![Pose::identity(); bodies],
            coordinates: vec![Series::zero(); drives],
            near: vec![0.0; bodies],
            alone: vec![None; drives],
            inner: Vec::new(),
            design,
        }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Arc<Mechanism> {
        &self.design.mechanism
    }

    /// The pose of a body in time: place, and direction as a unit vector; their coefficients are speeds and, doubled,
    /// accelerations.
    pub fn pose(&self, body: BodyId) -> Pose<Series<B>> {
        let (pose, clock) = (&self.poses[body.index()], &self.abscissa.clock);
        Pose {
            x: pose.x.compose(clock),
            y: pose.y.compose(clock),
            c: pose.c.compose(clock),
            s: pose.s.compose(clock),
        }
    }

    /// The coordinate of a drive in time, SI.
    pub fn coordinate(&self, drive: DriveId) -> Series<B> {
        self.coordinates[drive.index()].compose(&self.abscissa.clock)
    }

    /// The poses along one drive, the others at rest, where they are known.
    pub fn along(&self, drive: DriveId) -> Option<&[Pose<Series<B>>]> {
        if self.abscissa.drive == Some(drive) {
            return Some(&self.poses);
        }
        self.alone.get(drive.index())?.as_deref()
    }
}

impl<B: Number> State<B>
where
    Series<B>: PlanNumber,
{
    /// The state in which the coordinates of the drives (SI) run as these series in time, on a branch; with the motion that
    /// every drive alone would give. Where the mechanism cannot be assembled the poses are NaN.
    pub fn moving(
        design: &Arc<Design<Series<B>>>,
        branch: &Branch,
        time: B,
        coordinates: &[Series<B>],
    ) -> Self {
        let mut it = Self::empty(design.clone(), Abscissa::time(time, 1.0));
        it.near.copy_from_slice(&branch.near);
        it.coordinates.copy_from_slice(coordinates);
        let mut solved = kempe_mechanism::Configuration::new(it.mechanism());
        let mut solve = |coordinates: &[Series<B>]| {
            solved.set_inputs(&design.mechanism, coordinates);
            design.solve(branch, &mut solved);
            solved.poses.clone()
        };
        it.poses = solve(coordinates);
        for drive in 0..coordinates.len() {
            let mut one: Vec<Series<B>> = (coordinates.iter())
                .map(|q| Series::constant(q.coefficient(0)))
                .collect();
            one[drive] = Series::variable(coordinates[drive].coefficient(0));
            it.alone[drive] = Some(solve(&one));
        }
        it
    }
}
