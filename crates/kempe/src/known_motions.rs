//! The motions that a session knows: it follows a new one where none of them goes.

use std::sync::Arc;

use kempe_model::Law;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::trace::Path as _;
use kempe_motion::{Demand, EndReason, Motion};
use kempe_study::{Progress, cannot_move};

use crate::way::{Way, alone, covers, laws_cover};
use crate::{Error, Pose, Session};

/// How much farther than asked (in path scales: rad, or mechanism sizes) a motion is followed that continues from a pose:
/// whoever drags a drive soon asks for the next place.
const AHEAD: f64 = 0.25;

impl Session {
    /// The motion along a way, over a range of places: what is known already, where that covers it.
    pub(crate) fn motion_over(
        &mut self,
        way: Way,
        range: (f64, f64),
        progress: &mut dyn Progress,
    ) -> Result<Arc<Motion>, Error> {
        let drive = match way {
            Way::Drive(drive) if !laws_cover(&self.design, drive, range) => drive,
            _ => return self.known_motion(progress),
        };
        if let Some(known) = self.alone[drive]
            .as_ref()
            .filter(|m| covers(m, drive, range))
        {
            return Ok(known.clone());
        }
        let motion = alone(&self.design, drive, range, progress)
            .map_err(|diagnostic| self.compiled.error(diagnostic))?;
        self.alone[drive] = Some(motion.clone());
        Ok(motion)
    }

    /// The motion of one drive from a pose on, over a range of its coordinate, the others where the pose has them. No assembly
    /// is searched for: the branch is the pose's.
    pub(crate) fn motion_from(
        &self,
        pose: &Pose,
        drive: usize,
        (low, high): (f64, f64),
        progress: &mut dyn Progress,
    ) -> Result<Arc<Motion>, Error> {
        let known = &pose.motion;
        let own = matches!(known.path, DrivePath::Coordinate { drive: own, .. } if own == drive);
        let reached = known.reached();
        // It comes no farther where it has ended, but may do so on the other side.
        let ended = |end: EndReason| own && end != EndReason::Covered;
        let low = if ended(known.ends.0) {
            low.max(reached.0)
        } else {
            low
        };
        let high = if ended(known.ends.1) {
            high.min(reached.1)
        } else {
            high
        };
        if own && (low > high || known.reaches(low) && known.reaches(high)) {
            return Ok(known.clone());
        }
        // A motion of the drive is known: it goes on from its end, where it is regular even if the pose is not.
        let from = match own {
            true if high > reached.1 => reached.1,
            true => reached.0,
            false => pose.coordinates[drive],
        };
        let placed = match own {
            true => known.placed(from, &mut known.solver()),
            false => None,
        };
        let placed = placed.as_ref().unwrap_or(&pose.placed);
        let design = known.design.with_laws(|index| {
            Some(match index == drive {
                true => self.design.mechanism.model.drives[drive].law.clone(),
                false => Law::standing(pose.coordinates[index]),
            })
        });
        let path = DrivePath::of_drive(
            &design.mechanism.model,
            design.size(),
            drive,
            pose.coordinates.clone(),
        );
        let ahead = AHEAD * path.scale();
        let (first, last) = if own { reached } else { (from, from) };
        let range = (
            if low < first { low - ahead } else { first },
            if high > last { high + ahead } else { last },
        );
        let demand = Demand::from_pose(&design, path, range, from, placed);
        let mut motion = Motion::along(&design, demand, progress)
            .map_err(|error| self.compiled.error(cannot_move(&design, &error)))?;
        if own {
            // Directions count their turns from the start.
            motion.start = known.start;
        }
        Ok(Arc::new(motion))
    }
}
