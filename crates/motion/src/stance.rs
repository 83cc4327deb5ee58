//! A pose that goes to other coordinates of the drives, in steps, without leaving its branch: no path is known beforehand.

use std::sync::Arc;

use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::evidence::{Evidence, closure, evidence, is_finite};
use kempe_mechanism::{Branch, Configuration, Design, Pose};
use kempe_number::Jet;
use kempe_units::Dimension;

use crate::motion::{Motion, Solver};

/// A drive goes this far in a step at most, rad or mechanism sizes.
const STEP: f64 = 0.1;
/// A body that goes farther in one step, in rad or mechanism sizes, may have come to another branch.
const FAR: f64 = 0.25;
/// Steps become no smaller than this part of the largest one.
const LEAST: f64 = 1e-3;
/// Rates that change in one step by more than this part of the largest may be those of another branch: the two cross there.
const STEADY: f64 = 0.3;
/// Loops of a pose are open by no more, mechanism sizes or rad.
const CLOSED: f64 = 1e-9;

/// Poses with their rates; the length is that of the traces' series, so that the plan is compiled once for both.
type Series = Jet<f64, 3>;

/// A mechanism standing at coordinates of its drives.
#[derive(Clone, Debug)]
pub struct Stance {
    /// The design.
    pub design: Design<f64>,
    coordinates: Vec<f64>,
    branch: Branch,
    state: Configuration<f64>,
    size: f64,
    rich: Arc<Design<Series>>,
}

/// Where a step may lead.
struct Reached {
    state: Configuration<f64>,
    signs: Vec<f64>,
    /// How much the largest rate changes on the way, of itself; infinite where there are no rates.
    jump: f64,
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
            rich: Arc::new(design.lift(Series::constant)),
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
            let smallest = step / 2.0 < LEAST * whole;
            if self.step(&at, smallest) {
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

    /// Goes to coordinates close by. False, and where it was, where the branch does not lead there, or so unevenly that another may cross it on the way:
    /// that is taken of the smallest steps alone.
    fn step(&mut self, to: &[f64], smallest: bool) -> bool {
        let way: Vec<f64> = (to.iter().zip(&self.coordinates))
            .map(|(to, from)| to - from)
            .collect();
        let rates = self.rates(&self.branch, &self.state.poses, &self.coordinates, &way);
        // The signs of closed forms change where their bodies cross, and the mechanism goes on as it went.
        let ahead: Vec<Pose<f64>> = (self.state.poses.iter().zip(&rates).zip(&self.branch.near))
            .map(|((pose, [x, y, angle]), near)| {
                let turned = pose.angle_near(*near) + angle;
                match (x + y + turned).is_finite() {
                    true => {
                        Pose::from_angle(pose.x + x * self.size, pose.y + y * self.size, turned)
                    }
                    false => *pose,
                }
            })
            .collect();
        let through = self.design.branch_through(&ahead, &self.branch.near, to);
        let mut reached = self.reached(self.branch.clone(), to, &way, &rates);
        if through.signs != self.branch.signs {
            let other = self.reached(through, to, &way, &rates);
            reached = match (reached, other) {
                (Some(kept), Some(other)) if other.jump < kept.jump => Some(other),
                (kept, other) => kept.or(other),
            };
        }
        let Some(reached) = reached.filter(|it| smallest || it.jump <= STEADY) else {
            return false;
        };
        self.state = reached.state;
        self.branch.signs = reached.signs;
        for (body, pose) in self.state.poses.iter().enumerate() {
            self.branch.near[body] = pose.angle_near(self.branch.near[body]);
        }
        self.branch.guess.clone_from(&self.state.poses);
        self.coordinates.copy_from_slice(to);
        true
    }

    /// What a branch leads to at coordinates close by, where it is there.
    fn reached(
        &self,
        branch: Branch,
        to: &[f64],
        way: &[f64],
        rates: &[[f64; 3]],
    ) -> Option<Reached> {
        let mut state = self.state.clone();
        state.set_inputs(&self.design.mechanism, to);
        self.design.solve(&branch, &mut state);
        let closes = || closure(&self.design, &branch, &state, self.size) <= CLOSED;
        if !self.is_near(&state.poses) || !closes() {
            return None;
        }
        let after = self.rates(&branch, &state.poses, to, way);
        let pairs = || rates.iter().flatten().zip(after.iter().flatten());
        let largest = pairs().fold(0.0_f64, |most, (a, b)| most.max(a.abs()).max(b.abs()));
        let change = pairs().fold(0.0_f64, |most, (a, b)| most.max((b - a).abs()));
        let unknown = pairs().any(|(a, b)| !(a - b).is_finite());
        Some(Reached {
            jump: match (unknown, largest > 0.0) {
                (true, _) => f64::INFINITY,
                (false, true) => change / largest,
                (false, false) => 0.0,
            },
            signs: branch.signs,
            state,
        })
    }

    /// What x, y (mechanism sizes) and angle (rad) of every body change by at a pose for such a change of the coordinates, to first order.
    fn rates(
        &self,
        branch: &Branch,
        poses: &[Pose<f64>],
        at: &[f64],
        way: &[f64],
    ) -> Vec<[f64; 3]> {
        let mechanism = &self.design.mechanism;
        let mut state: Configuration<Series> = Configuration::new(mechanism);
        for (rich, plain) in state.poses.iter_mut().zip(poses) {
            *rich = plain.map(Series::constant);
        }
        let inputs: Vec<Series> = (at.iter().zip(way))
            .map(|(at, way)| Series::from_coefficients([*at, *way, 0.0]))
            .collect();
        state.set_inputs(mechanism, &inputs);
        self.rich.solve(branch, &mut state);
        let rates = |pose: &Pose<Series>| {
            let [x, y, c, s] = [pose.x, pose.y, pose.c, pose.s].map(|part| part.coefficient(1));
            let turning = pose.c.coefficient(0) * s - pose.s.coefficient(0) * c;
            [x / self.size, y / self.size, turning]
        };
        state.poses.iter().map(rates).collect()
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
