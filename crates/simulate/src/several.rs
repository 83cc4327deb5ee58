//! Poses from several coordinates, by the plan: on the branch of the start, whose modes stay what they are.

use std::sync::Arc;

use kempe_dynamics::{Instant, Rates};
use kempe_measure::{Series, State};
use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_model::DriveId;
use kempe_number::{Dual, Jet, Number};

use crate::start::Start;

/// Poses from several coordinates.
pub(crate) struct Several {
    /// Drives that move.
    moving: Vec<DriveId>,
    branch: Branch,
    design: Design<Rates>,
    solved: Configuration<Rates>,
    /// The branch with the poses last solved for guesses.
    here: Branch,
    slopes: Slopes,
    bends: Alone,
    rich: Arc<Design<Series<f64>>>,
}

/// So many derivatives are found at once.
const AT_ONCE: usize = 3;

/// Poses with their derivatives to some coordinates.
struct Slopes {
    design: Design<Dual<f64, AT_ONCE>>,
    solved: Configuration<Dual<f64, AT_ONCE>>,
    coordinates: Vec<Dual<f64, AT_ONCE>>,
}

impl Slopes {
    fn new(design: &Design<f64>) -> Self {
        let mechanism = &design.mechanism;
        Self {
            design: design.lift(Dual::constant),
            solved: Configuration::new(mechanism).without_determinants(),
            coordinates: vec![Dual::constant(0.0); mechanism.model.drives.len()],
        }
    }

    /// About these coordinates, in those of at most so many drives.
    fn solve(
        &mut self,
        branch: &Branch,
        coordinates: &[Rates],
        drives: &[DriveId],
    ) -> &Configuration<Dual<f64, AT_ONCE>> {
        for (one, q) in self.coordinates.iter_mut().zip(coordinates) {
            *one = Dual::constant(q.value());
        }
        for (k, drive) in drives.iter().enumerate() {
            let at = &mut self.coordinates[drive.index()];
            *at = Dual::variable(at.re, k);
        }
        (self.solved).set_inputs(&self.design.mechanism, &self.coordinates);
        self.design.solve(branch, &mut self.solved);
        &self.solved
    }
}

/// Poses as series in one coordinate alone, the others at rest.
struct Alone {
    design: Design<Rates>,
    solved: Configuration<Rates>,
    coordinates: Vec<Rates>,
}

impl Alone {
    fn new(design: &Design<f64>) -> Self {
        let mechanism = &design.mechanism;
        Self {
            design: design.lift(Rates::constant),
            solved: Configuration::new(mechanism).without_determinants(),
            coordinates: vec![Rates::constant(0.0); mechanism.model.drives.len()],
        }
    }

    /// About these coordinates, in that of a drive.
    fn solve(
        &mut self,
        branch: &Branch,
        coordinates: &[Rates],
        drive: DriveId,
    ) -> &Configuration<Rates> {
        for (one, q) in self.coordinates.iter_mut().zip(coordinates) {
            *one = Jet::constant(q.value());
        }
        self.coordinates[drive.index()] = Jet::variable(coordinates[drive.index()].value());
        (self.solved).set_inputs(&self.design.mechanism, &self.coordinates);
        self.design.solve(branch, &mut self.solved);
        &self.solved
    }
}

impl Several {
    pub fn new(start: &Start, moving: Vec<DriveId>) -> Self {
        let mechanism = &start.design.mechanism;
        let (poses, near) = (&start.placed.poses, &start.placed.near);
        let branch = start.design.branch_through(poses, near, &start.coordinates);
        Self {
            moving,
            here: branch.clone(),
            branch,
            design: start.design.lift(Rates::constant),
            solved: Configuration::new(mechanism).without_determinants(),
            slopes: Slopes::new(&start.design),
            bends: Alone::new(&start.design),
            rich: Arc::new(start.design.lift(Series::from_f64)),
        }
    }

    /// The instant at coordinates that run as these series in time; false where no pose is known.
    pub fn instant(&mut self, coordinates: &[Rates], out: &mut Instant<f64>) -> bool {
        let mechanism = &self.design.mechanism;
        self.solved.set_inputs(mechanism, coordinates);
        self.design.solve(&self.branch, &mut self.solved);
        if !self
            .solved
            .poses
            .iter()
            .all(|pose| is_finite(&pose.value()))
        {
            return false;
        }
        out.set_in_time(&self.solved, &self.branch.near, coordinates);
        for (guess, pose) in self.here.guess.iter_mut().zip(&self.solved.poses) {
            *guess = pose.value();
        }
        for drives in self.moving.chunks(AT_ONCE) {
            let along = self.slopes.solve(&self.here, coordinates, drives);
            out.set_coefficients(drives, along);
        }
        true
    }

    /// How the coefficients of a drive change along its own coordinate, at the instant last found, which was at these coordinates.
    pub fn bend(&mut self, drive: DriveId, coordinates: &[Rates], out: &mut Instant<f64>) {
        let alone = self.bends.solve(&self.here, coordinates, drive);
        out.set_coefficient_rates(drive, alone);
    }

    /// Takes the pose last found for the one that guesses and angles go on from.
    pub fn accept(&mut self) {
        let branch = &mut self.branch;
        for (body, pose) in self.solved.poses.iter().enumerate().skip(1) {
            let pose = pose.value();
            if is_finite(&pose) {
                branch.near[body] = pose.angle_near(branch.near[body]);
                self.here.near[body] = branch.near[body];
                branch.guess[body] = pose;
            }
        }
    }

    /// The state at a time, for measures.
    pub fn state(&mut self, time: f64, coordinates: &[Rates]) -> Option<State<f64>> {
        let rich: Vec<Series<f64>> = (coordinates.iter())
            .map(|q| {
                let [q, v, a] = *q.coefficients();
                Series::from_coefficients([q, v, a, 0.0, 0.0])
            })
            .collect();
        let state = State::moving(&self.rich, &self.branch, time, &rich);
        let found = state.poses.iter().all(|pose| is_finite(&pose.value()));
        found.then_some(state)
    }
}
