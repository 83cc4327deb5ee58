//! Poses from several coordinates, by the plan: on the branch of the start, whose modes stay what they are.

use std::sync::Arc;

use kempe_dynamics::{Instant, Rates};
use kempe_measure::{Series, State};
use kempe_mechanism::evidence::is_finite;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_model::DriveId;
use kempe_number::{Jet, Number};

use crate::start::Start;

/// Poses from several coordinates.
pub(crate) struct Several {
    /// Drives that move.
    moving: Vec<DriveId>,
    branch: Branch,
    design: Design<Rates>,
    solved: Configuration<Rates>,
    alone: Configuration<Rates>,
    one: Vec<Rates>,
    rich: Arc<Design<Series<f64>>>,
}

impl Several {
    pub fn new(start: &Start, moving: Vec<DriveId>) -> Self {
        let mechanism = &start.design.mechanism;
        let (poses, near) = (&start.placed.poses, &start.placed.near);
        let branch = start.design.branch_through(poses, near, &start.coordinates);
        Self {
            moving,
            branch,
            design: start.design.lift(Rates::from_f64),
            solved: Configuration::new(mechanism).without_determinants(),
            alone: Configuration::new(mechanism).without_determinants(),
            one: vec![Rates::zero(); mechanism.model.drives.len()],
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
        for drive in &self.moving {
            for (one, q) in self.one.iter_mut().zip(coordinates) {
                *one = Jet::constant(q.value());
            }
            self.one[drive.index()] = Jet::variable(coordinates[drive.index()].value());
            self.alone.set_inputs(mechanism, &self.one);
            self.design.solve(&self.branch, &mut self.alone);
            out.set_coefficients(*drive, &self.alone);
        }
        true
    }

    /// Takes the pose last found for the one that guesses and angles go on from.
    pub fn accept(&mut self) {
        let branch = &mut self.branch;
        for (body, pose) in self.solved.poses.iter().enumerate().skip(1) {
            let pose = pose.value();
            if is_finite(&pose) {
                branch.near[body] = pose.angle_near(branch.near[body]);
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
