//! Poses from several coordinates, by the plan: on the branch of the start, whose modes stay what they are.

use std::sync::Arc;

use kempe_dynamics::{Instant, Rates};
use kempe_measure::{Series, State};
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::constraint::{Constraint, Joint, Situation};
use kempe_mechanism::evidence::{evidence, is_finite};
use kempe_mechanism::pose::Pose;
use kempe_mechanism::structure::BodyId;
use kempe_mechanism::{Branch, Configuration, Design};
use kempe_model::DriveId;
use kempe_number::math;
use kempe_number::{Dual, Jet, Number};
use kempe_units::Dimension;

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
    plain: Design<f64>,
    /// Poses with all determinants.
    plainly: Configuration<f64>,
    /// The branch on which it goes on behind a change point, and when it comes to that, s.
    behind: Option<(f64, Branch)>,
    /// Whether branches cross at the start.
    pub at_change_point: bool,
}

/// Beside the start is so far from it, in rad or mechanism sizes; assemblies meet where a determinant is so many times less than there.
const BESIDE: f64 = 1e-3;
const MEETS: f64 = 1e-4;
/// On both sides of it a determinant is no more different than this.
const BOTH: f64 = 1e-2;

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

/// The branch on which it is at a time, s, where it goes over to another one at some time.
fn at_time<'b>(branch: &'b Branch, behind: Option<&'b (f64, Branch)>, time: f64) -> &'b Branch {
    let behind = behind.filter(|(at, _)| time > *at);
    behind.map_or(branch, |(_, branch)| branch)
}

/// All rows of some constraints.
fn rows_of<T: Number>(constraints: &[Constraint], at: &Situation<'_, T>) -> Vec<T> {
    let rows = constraints.iter().flat_map(|it| {
        let all = at.residual(it);
        all.into_iter().take(it.rows())
    });
    rows.collect()
}

impl Several {
    pub fn new(start: &Start, moving: Vec<DriveId>) -> Self {
        let mechanism = &start.design.mechanism;
        let (poses, near) = (&start.placed.poses, &start.placed.near);
        let branch = start.design.branch_through(poses, near, &start.coordinates);
        let mut it = Self {
            moving,
            here: branch.clone(),
            branch,
            design: start.design.lift(Rates::constant),
            solved: Configuration::new(mechanism).without_determinants(),
            slopes: Slopes::new(&start.design),
            bends: Alone::new(&start.design),
            rich: Arc::new(start.design.lift(Series::from_f64)),
            plain: start.design.clone(),
            plainly: Configuration::new(mechanism),
            behind: None,
            at_change_point: false,
        };
        it.at_change_point = it.starts_at_change_point(start);
        it
    }

    /// Of every step of the plan.
    fn determinants_at(&mut self, coordinates: &[f64]) -> Vec<f64> {
        (self.plainly).set_inputs(&self.plain.mechanism, coordinates);
        self.plain.solve(&self.branch, &mut self.plainly);
        self.plainly.determinants.clone()
    }

    /// Whether assemblies meet at the start, and on all sides of it there are both.
    fn starts_at_change_point(&mut self, start: &Start) -> bool {
        let size = |determinant: &f64| match determinant.is_nan() {
            // Where they meet rounding may leave none, as beyond a dead point there is none.
            true => 0.0,
            false => determinant.abs(),
        };
        let now = self.determinants_at(&start.coordinates);
        // On both sides along one drive, and on any side at all.
        let (mut beside, mut largest) = (vec![0.0_f64; now.len()], vec![0.0_f64; now.len()]);
        for drive in self.moving.clone() {
            let little = match start.design.mechanism.model.drives[drive.index()].dimension {
                Dimension::ANGLE => BESIDE,
                _ => BESIDE * start.design.size(),
            };
            let [up, down] = [little, -little].map(|way| {
                let mut there = start.coordinates.clone();
                there[drive.index()] += way;
                self.determinants_at(&there)
            });
            for (k, (up, down)) in up.iter().zip(&down).enumerate() {
                let (up, down) = (size(up), size(down));
                beside[k] = beside[k].max(up.min(down));
                largest[k] = largest[k].max(up.max(down));
            }
        }
        let mut steps = self.plain.mechanism.plan.steps.iter().enumerate();
        steps.any(|(k, step)| {
            let crosses = beside[k] > BOTH * largest[k] && size(&now[k]) <= MEETS * beside[k];
            step.tells_modes() && crosses
        })
    }

    /// The smallest singular value of the pose at these coordinates.
    pub fn smallest_singular_value(&mut self, coordinates: &[Rates]) -> f64 {
        let there: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
        self.determinants_at(&there);
        let mut system = Bordered::new(&self.plain.mechanism);
        let size = self.plain.size();
        let found = evidence(&self.plain, &self.branch, &self.plainly, size, &mut system);
        found.smallest_singular_value
    }

    /// How long it is, s, until a step of the plan comes to where its assemblies meet if it goes on as it does at these coordinates: by
    /// how its determinant changes within `just`, s. None where none does.
    pub fn meets_in(&mut self, coordinates: &[Rates], just: f64) -> Option<f64> {
        let steps = &self.plain.mechanism.plan.steps;
        if !steps.iter().any(|step| step.tells_modes()) {
            return None;
        }
        let [before, now] = [-just, 0.0].map(|time| {
            let there = coordinates.iter();
            let there = there.map(|q| q.value() + time * q.coefficient(1));
            self.determinants_at(&there.collect::<Vec<f64>>())
        });
        let steps = &self.plain.mechanism.plan.steps;
        let steps = steps.iter().zip(before.iter().zip(&now));
        let ways = steps.filter(|(step, (before, now))| {
            step.tells_modes() && *before * *now > 0.0 && now.abs() < before.abs()
        });
        ways.map(|(_, (before, now))| just * now / (before - now))
            .reduce(f64::min)
    }

    /// Takes what the bodies come to behind a change point for the branch on which it goes on from the time `at` on, s: poses with their
    /// angles, rad, near those at these coordinates. How far these are, in mechanism sizes and rad; none where there are none.
    pub fn branch_on(
        &mut self,
        at: f64,
        poses: &[Pose<f64>],
        angles: &[f64],
        coordinates: &[Rates],
    ) -> Option<f64> {
        let coordinates: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
        let branch = self.plain.branch_through(poses, angles, &coordinates);
        (self.plainly).set_inputs(&self.plain.mechanism, &coordinates);
        self.plain.solve(&branch, &mut self.plainly);
        let size = self.plain.size();
        let off = self.plainly.poses.iter().zip(poses);
        let off = off.map(|(a, b)| a.apart(b, size));
        let off = off.fold(0.0, math::max);
        self.behind = Some((at, branch));
        off.is_finite().then_some(off)
    }

    /// It goes on the branch on which it is, whatever was taken for one behind a change point.
    pub fn stay_on_branch(&mut self) {
        self.behind = None;
    }

    /// It goes on from a time, s: for good on the branch behind a change point where that lies before, else on the one on which it was.
    /// Whether it went over to another.
    pub fn decide(&mut self, time: f64) -> bool {
        let behind = self.behind.take().filter(|(at, _)| time > *at);
        let goes_over = behind.is_some();
        if let Some((_, behind)) = behind {
            self.branch = behind;
        }
        goes_over
    }

    /// The instant at a time and coordinates that run as these series in it; false where no pose is known.
    pub fn instant(&mut self, time: f64, coordinates: &[Rates], out: &mut Instant<f64>) -> bool {
        let mechanism = &self.design.mechanism;
        self.solved.set_inputs(mechanism, coordinates);
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        self.design.solve(branch, &mut self.solved);
        if !self
            .solved
            .poses
            .iter()
            .all(|pose| is_finite(&pose.value()))
        {
            return false;
        }
        out.set_in_time(&self.solved, &branch.near, coordinates);
        self.here.signs.clone_from(&branch.signs);
        for (guess, pose) in self.here.guess.iter_mut().zip(&self.solved.poses) {
            *guess = pose.value();
        }
        for drives in self.moving.chunks(AT_ONCE) {
            let along = self.slopes.solve(&self.here, coordinates, drives);
            out.set_coefficients(drives, along);
        }
        true
    }

    /// How every drive that moves, alone, moves the bodies at a time and coordinates where the links are as they were last or near that; false
    /// where no pose is known.
    pub fn slopes_at(&mut self, time: f64, coordinates: &[Rates], out: &mut Instant<f64>) -> bool {
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        for drives in self.moving.chunks(AT_ONCE) {
            let along = self.slopes.solve(branch, coordinates, drives);
            out.set_coefficients(drives, along);
        }
        let poses = &self.slopes.solved.poses;
        for (out, pose) in out.poses.iter_mut().zip(poses) {
            *out = pose.map(|x| x.re);
        }
        out.near.copy_from_slice(&branch.near);
        out.poses.iter().all(is_finite)
    }

    /// The poses of an instant at a time, and how they move, with all but the coefficients: false where no pose is known.
    pub fn moving_at(&mut self, time: f64, coordinates: &[Rates], out: &mut Instant<f64>) -> bool {
        (self.solved).set_inputs(&self.design.mechanism, coordinates);
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        self.design.solve(branch, &mut self.solved);
        out.set_in_time(&self.solved, &branch.near, coordinates);
        let mut poses = self.solved.poses.iter();
        poses.all(|pose| is_finite(&pose.value()))
    }

    /// Rows of constraints, as series in time, at the poses [last found](Self::moving_at).
    pub fn series_of(&self, time: f64, constraints: &[Constraint]) -> Vec<Rates> {
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        rows_of(constraints, &self.solved.situation(&self.design, branch))
    }

    /// Rows of constraints at a time and coordinates.
    pub fn rows_at(
        &mut self,
        time: f64,
        coordinates: &[Rates],
        constraints: &[Constraint],
    ) -> Vec<f64> {
        let there: Vec<f64> = coordinates.iter().map(|q| q.value()).collect();
        (self.plainly).set_inputs(&self.plain.mechanism, &there);
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        self.plain.solve(branch, &mut self.plainly);
        rows_of(constraints, &self.plainly.situation(&self.plain, branch))
    }

    /// Hands out the derivatives of rows of constraints to the poses of bodies, and to coordinates of drives that they hold: at what was
    /// [last looked at](Self::rows_at).
    pub fn gradients_of(
        &self,
        time: f64,
        constraints: &[Constraint],
        mut to_body: impl FnMut(usize, BodyId, [f64; 3]),
        mut to_drive: impl FnMut(usize, DriveId, f64),
    ) {
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        let at = self.plainly.situation(&self.plain, branch);
        let mut first = 0;
        for it in constraints {
            let own = at.gradients(it, |g| to_body(first + g.row, g.body, g.to));
            if let Some(drive) = it.drive() {
                to_drive(first, drive, own);
            }
            first += it.rows();
        }
    }

    /// How the coefficients of a drive change along its own coordinate, at the instant last found, which was at these coordinates.
    pub fn bend(&mut self, drive: DriveId, coordinates: &[Rates], out: &mut Instant<f64>) {
        let alone = self.bends.solve(&self.here, coordinates, drive);
        out.set_coefficient_rates(drive, alone);
    }

    /// Takes the pose last found, at a time, s, for the one that guesses and angles go on from.
    pub fn accept(&mut self, time: f64) {
        self.decide(time);
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
        let branch = at_time(&self.branch, self.behind.as_ref(), time);
        let state = State::moving(&self.rich, branch, time, &rich);
        let found = state.poses.iter().all(|pose| is_finite(&pose.value()));
        found.then_some(state)
    }
}
