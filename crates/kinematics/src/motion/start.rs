//! Where a motion starts, and how it is followed from there to both ends of its range.

use super::care::{Unlocated, with_care};
use super::follow::follow_both;
use super::{Demand, Motion, MotionError};
use crate::assemble::{Assemblies, find_assemblies};
use crate::mechanism::Mechanism;
use crate::plan::Plan;
use crate::state::Design;
use crate::trace::{Follower, Path};
use crate::watch::{Stage, Watch};

/// Sizes of mechanisms, m, whose lengths can be squared and multiplied with room to spare.
pub const SIZES: (f64, f64) = (1e-100, 1e100);
/// Where a motion starts at a singular pose, its branch is looked for at these parts of the range instead.
const ANCHORS: [f64; 6] = [0.0, 0.0137, 0.0411, 0.1234, 0.3719, 0.7183];

impl<'m> Motion<'m> {
    /// Follows the branch through the assembly meant by the file's hints over a demanded range.
    ///
    /// # Errors
    /// As [`Motion::watched`].
    pub fn along(
        mechanism: &'m Mechanism,
        plan: &'m Plan,
        design: &'m Design<f64>,
        demand: Demand,
        watch: &mut dyn Watch,
    ) -> Result<Self, MotionError> {
        let Demand {
            path,
            range: demanded,
            start,
            assemblies: mut known,
        } = demand;
        check(mechanism, plan, design)?;
        let scale = path.scale();
        let mut follower = Follower::new(mechanism, plan, &design.geometry, &path);

        let far = if (start - demanded.0).abs() > (demanded.1 - start).abs() {
            demanded.0
        } else {
            demanded.1
        };
        let mut coordinates = vec![0.0; mechanism.model.drives.len()];
        let mut nothing: Option<Assemblies> = None;
        for part in ANCHORS {
            let anchor = start + part * (far - start);
            path.coordinates(anchor, &mut coordinates);
            let assemblies = match known.take().filter(|_| anchor == start) {
                Some(known) => known,
                None => find_assemblies(mechanism, plan, design, &coordinates, watch).ok_or(
                    MotionError::Stopped {
                        stage: Stage::Assembling,
                    },
                )?,
            };
            let Some(chosen) = assemblies.list.first() else {
                nothing.get_or_insert(assemblies);
                // A start right at a limit may miss closure by a rounding error: look a little inside.
                if part > ANCHORS[1] {
                    break;
                } else {
                    continue;
                }
            };
            let z = follower.scaled(&chosen.poses, &chosen.branch.near, anchor);
            let (Some(up), Some(down)) = (follower.start(z.clone(), 1.0), follower.start(z, -1.0))
            else {
                continue;
            };
            // The share of the range that lies above it.
            let whole = (demanded.1 - demanded.0).max(f64::MIN_POSITIVE);
            let share = ((demanded.1 - anchor) / whole).clamp(0.0, 1.0);
            return with_care(&mut follower, |follower| {
                let range = (demanded.0 / scale, demanded.1 / scale);
                let (nodes, ends) = follow_both(follower, [&down, &up], range, share, watch)
                    .ok_or(Unlocated::Stopped(Stage::Following))?;
                let assemblies = assemblies.clone();
                let mut motion =
                    Self::of_nodes(mechanism, plan, design, path.clone(), assemblies, nodes);
                motion.anchor = anchor;
                motion.start = start;
                motion.demanded = demanded;
                motion.ends = ends;
                motion.find_events(follower, watch)?;
                Ok(motion)
            });
        }
        match nothing {
            Some(assemblies) => Err(MotionError::CannotAssemble {
                at: start,
                assemblies: Box::new(assemblies),
            }),
            None => Err(MotionError::Locked { at: start }),
        }
    }
}

/// Whether a mechanism can be moved at all.
fn check(mechanism: &Mechanism, plan: &Plan, design: &Design<f64>) -> Result<(), MotionError> {
    if mechanism.model.drives.is_empty() {
        return Err(MotionError::NoDrive);
    }
    if !plan.decomposition.undetermined.is_empty() {
        let mut bodies: Vec<_> = plan
            .decomposition
            .undetermined
            .iter()
            .map(|u| u.body())
            .collect();
        bodies.dedup();
        return Err(MotionError::Undetermined { bodies });
    }
    let size = design.geometry.size(mechanism);
    if !(SIZES.0..=SIZES.1).contains(&size) {
        return Err(MotionError::Scale { size });
    }
    Ok(())
}
