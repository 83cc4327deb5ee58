//! A pose that goes to other coordinates of the drives, in steps, without leaving its branch: no path is known beforehand.

use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::evidence::{Evidence, evidence, is_finite};
use kempe_mechanism::{Branch, Configuration, Design, Pose};
use kempe_units::Dimension;

use crate::motion::{Motion, Solver};

/// A drive goes this far in a step at most, rad or mechanism sizes.
const STEP: f64 = 0.1;
/// A body that goes farther in one step, in rad or mechanism sizes, may have come to another branch.
const FAR: f64 = 0.25;
/// Steps become no smaller than this part of the largest one.
const LEAST: f64 = 1e-3;

/// A mechanism standing at coordinates of its drives.
#[derive(Clone, Debug)]
pub struct Stance {
    /// The design.
    pub design: Design<f64>,
    coordinates: Vec<f64>,
    branch: Branch,
    state: Configuration<f64>,
    size: f64,
}

impl Stance {
    /// The pose of a motion at a path parameter; `None` where it has none.
    pub fn on(motion: &Motion, p: f64) -> Option<Self> {
        let mut solver: Solver<f64> = motion.solver();
        let placed = motion.placed(p, &mut solver)?;
        let mut coordinates = vec![0.0; motion.mechanism().model.drives.len()];
        motion.path.coordinates(p, &mut coordinates);
        let design = motion.design.clone();
        let branch = design.branch_through(&placed.poses, &placed.near, &coordinates);
        let mut state = Configuration::new(motion.mechanism());
        state.set_inputs(motion.mechanism(), &coordinates);
        state.poses = placed.poses;
        Some(Self {
            size: design.size(),
            design,
            coordinates,
            branch,
            state,
        })
    }

    /// Coordinates of the drives, SI.
    pub fn coordinates(&self) -> &[f64] {
        &self.coordinates
    }

    /// The branch through the pose.
    pub fn branch(&self) -> &Branch {
        &self.branch
    }

    /// Poses of the bodies.
    pub fn poses(&self) -> &[Pose<f64>] {
        &self.state.poses
    }

    /// Changes of the drives' coordinates in rad and mechanism sizes.
    pub fn in_sizes(&self, change: &[f64]) -> Vec<f64> {
        let drives = self.design.mechanism.model.drives.iter();
        let scale = |dimension| match dimension {
            Dimension::ANGLE => 1.0,
            _ => 1.0 / self.size,
        };
        let scales = drives.map(|d| scale(d.dimension));
        scales.zip(change).map(|(scale, x)| scale * x).collect()
    }

    /// How far the pose can be trusted.
    pub fn evidence(&self) -> Evidence {
        let mut system = Bordered::new(&self.design.mechanism);
        evidence(
            &self.design,
            &self.branch,
            &self.state,
            self.size,
            &mut system,
        )
    }

    /// x, y and angle of every link, and the place of every point of the model, SI.
    pub fn places(&self) -> (Vec<[f64; 3]>, Vec<[f64; 2]>) {
        let (mechanism, geometry) = (&self.design.mechanism, &self.design.geometry);
        let links = mechanism.seats.iter().enumerate().map(|(index, seat)| {
            let body = seat.body.index();
            let (pose, local) = (&self.state.poses[body], &geometry.seats[index]);
            let [x, y] = pose.place([local.x, local.y]);
            let angle = pose.angle_near(self.branch.near[body]) + geometry.seat_angles[index];
            [x, y, angle]
        });
        let points = (0..mechanism.model.points.len() as u32).map(|point| {
            let marker = mechanism.any_marker(kempe_model::PointId(point));
            marker.map_or([f64::NAN; 2], |marker| {
                self.state.poses[marker.body.index()].place(geometry.marker(marker))
            })
        });
        (links.collect(), points.collect())
    }

    /// Goes to other coordinates of the drives, all at once along the straight way there. False, and where it was, where the
    /// branch ends before: at a limit, or a place through which it cannot be followed.
    pub fn go(&mut self, to: &[f64]) -> bool {
        let before = self.clone();
        let way: Vec<f64> = to
            .iter()
            .zip(&before.coordinates)
            .map(|(b, a)| b - a)
            .collect();
        let farthest = self
            .in_sizes(&way)
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        if !farthest.is_finite() {
            return false;
        }
        let whole = (STEP / farthest).min(1.0);
        let (mut done, mut step) = (0.0, whole);
        while done < 1.0 {
            let share = if done + step > 1.0 - LEAST * whole {
                1.0
            } else {
                done + step
            };
            let at: Vec<f64> = match share {
                1.0 => to.to_vec(),
                _ => (way.iter().zip(&before.coordinates))
                    .map(|(way, from)| from + share * way)
                    .collect(),
            };
            if self.step(&at) {
                done = share;
                step = (2.0 * step).min(whole);
            } else {
                step /= 2.0;
                if step < LEAST * whole {
                    *self = before;
                    return false;
                }
            }
        }
        true
    }

    fn step(&mut self, to: &[f64]) -> bool {
        let mut state = self.state.clone();
        state.set_inputs(&self.design.mechanism, to);
        self.design.solve(&self.branch, &mut state);
        if !self.is_near(&state.poses) {
            // The signs of closed forms change where their bodies cross, and the mechanism goes on.
            let near = &self.branch.near;
            let through = (self.design).branch_through(&self.state.poses, near, to);
            self.design.solve(&through, &mut state);
            if !self.is_near(&state.poses) {
                return false;
            }
            self.branch.signs = through.signs;
        }
        for (body, pose) in state.poses.iter().enumerate() {
            self.branch.near[body] = pose.angle_near(self.branch.near[body]);
        }
        self.branch.guess.clone_from(&state.poses);
        self.coordinates.copy_from_slice(to);
        self.state = state;
        true
    }

    /// Whether poses are known and no body of theirs is far from where it stands.
    fn is_near(&self, poses: &[Pose<f64>]) -> bool {
        let bodies = poses.iter().zip(&self.state.poses);
        bodies.zip(&self.branch.near).all(|((to, from), near)| {
            let turned = to.angle_near(*near) - from.angle_near(*near);
            let gone = [to.x - from.x, to.y - from.y].map(|x| x.abs() / self.size);
            is_finite(to) && turned.abs() <= FAR && gone.iter().all(|x| *x <= FAR)
        })
    }
}
