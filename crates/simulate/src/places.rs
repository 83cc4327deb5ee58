//! Poses from coordinates.

use kempe_dynamics::{Instant, Rates};
use kempe_measure::{Series, State};
use kempe_mechanism::evidence::NEARLY_SINGULAR;
use kempe_mechanism::pose::Pose;
use kempe_model::DriveId;
use kempe_motion::{EndReason, MotionError, Progress};
use kempe_number::Number;

use crate::curve::Curve;
use crate::several::Several;
use crate::start::Start;

/// How poses are found from coordinates.
pub(crate) enum Places {
    /// One coordinate moves, along its followed motion.
    Curve(Box<Curve>, DriveId),
    /// Several move, by the plan.
    Several(Box<Several>),
}

impl Places {
    /// For these drives that move.
    pub fn new(
        start: Start,
        moving: &[DriveId],
        progress: &mut dyn Progress,
    ) -> Result<Self, MotionError> {
        match moving {
            [drive] => {
                Curve::new(start, *drive, progress).map(|c| Self::Curve(Box::new(c), *drive))
            }
            _ => Ok(Self::Several(Box::new(Several::new(
                &start,
                moving.to_vec(),
            )))),
        }
    }

    /// For drives that move, of whatever number, by the plan.
    pub fn by_plan(start: &Start, moving: Vec<DriveId>) -> Self {
        Self::Several(Box::new(Several::new(start, moving)))
    }

    /// As several, where they are.
    pub fn several(&mut self) -> Option<&mut Several> {
        match self {
            Self::Curve(..) => None,
            Self::Several(several) => Some(several),
        }
    }

    /// Whether branches cross at the start.
    pub fn start_at_change_point(&self) -> bool {
        match self {
            Self::Curve(curve, _) => curve.starts_at_change_point(),
            Self::Several(several) => several.at_change_point,
        }
    }

    /// How long it is, s, until the branch on which it is comes to an end by itself, at a change point or a dead point, if it goes on as it
    /// does at these coordinates, by what changes within `just`, s. None where it does not, or passes it.
    pub fn meets_in(&mut self, coordinates: &[Rates], just: f64) -> Option<f64> {
        match self {
            Self::Curve(..) => None,
            Self::Several(several) => several.meets_in(coordinates, just),
        }
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
        match self {
            Self::Curve(..) => None,
            Self::Several(several) => several.branch_on(at, poses, angles, coordinates),
        }
    }

    /// It goes on the branch on which it is, whatever was taken for one behind a change point.
    pub fn stay_on_branch(&mut self) {
        if let Self::Several(several) = self {
            several.stay_on_branch();
        }
    }

    /// Whether the pose at these coordinates is nearly singular, as far as that is not passed anyway.
    pub fn is_nearly_singular(&mut self, coordinates: &[Rates]) -> bool {
        match self {
            Self::Curve(..) => false,
            Self::Several(several) => {
                several.smallest_singular_value(coordinates) <= NEARLY_SINGULAR
            }
        }
    }

    /// It goes on from a time, s: for good on the branch behind a change point where that lies before, else on the one on which it was.
    /// Whether it went over to another.
    pub fn decide(&mut self, time: f64) -> bool {
        match self {
            Self::Curve(..) => false,
            Self::Several(several) => several.decide(time),
        }
    }

    /// The instant at a time and coordinates that run as these series in it; false where no pose is known.
    pub fn instant(&mut self, time: f64, coordinates: &[Rates], out: &mut Instant<f64>) -> bool {
        match self {
            Self::Curve(curve, drive) => {
                let q = &coordinates[drive.index()];
                curve.instant(q.value(), q.coefficient(1), out)
            }
            Self::Several(several) => several.instant(time, coordinates, out),
        }
    }

    /// How the coefficients of these drives change along their own coordinates, at the instant last found, which was at these
    /// coordinates.
    pub fn bend(&mut self, drives: &[DriveId], coordinates: &[Rates], out: &mut Instant<f64>) {
        match self {
            // Known with the instant.
            Self::Curve(..) => {}
            Self::Several(several) => {
                for drive in drives {
                    several.bend(*drive, coordinates, out);
                }
            }
        }
    }

    /// The state at a time, for measures.
    pub fn state(&mut self, time: f64, coordinates: &[Rates]) -> Option<State<f64>> {
        match self {
            Self::Curve(curve, drive) => {
                let [q, v, a] = *coordinates[drive.index()].coefficients();
                let mut state = curve.state(time, [q, v, 2.0 * a])?;
                // Others stand, or follow: about where, is told.
                for (index, q) in coordinates.iter().enumerate() {
                    if index != drive.index() {
                        state.coordinates[index] = Series::constant(q.value());
                    }
                }
                Some(state)
            }
            Self::Several(several) => several.state(time, coordinates),
        }
    }

    /// Goes on from these coordinates at a time, s: what is known of the branch is made long enough.
    pub fn go_on(
        &mut self,
        time: f64,
        coordinates: &[Rates],
        progress: &mut dyn Progress,
    ) -> Result<(), MotionError> {
        match self {
            Self::Curve(curve, drive) => curve.follow(coordinates[drive.index()].value(), progress),
            Self::Several(several) => {
                several.accept(time);
                Ok(())
            }
        }
    }

    /// Why there is nothing beyond these coordinates, where that is known.
    pub fn end_at(&self, coordinates: &[Rates]) -> Option<EndReason> {
        match self {
            Self::Curve(curve, drive) => curve.end_at(coordinates[drive.index()].value()),
            Self::Several(_) => None,
        }
    }
}
