//! The pose that a simulation starts from.

use std::sync::Arc;

use kempe_mechanism::Design;
use kempe_model::{DriveId, Law};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{Demand, Motion, MotionError, Placed, Progress};

/// A pose with the design whose angles are counted as there.
pub(crate) struct Start {
    pub design: Design<f64>,
    pub placed: Placed,
    /// Coordinates of all drives, SI.
    pub coordinates: Vec<f64>,
    /// The motion from where the file's laws start, or what of it stands there.
    pub first: Arc<Motion>,
}

/// Why there is no pose to start from.
#[derive(Debug)]
pub enum NoStart {
    /// The mechanism cannot be put together, or cannot move there.
    Motion(MotionError),
    /// This drive does not come to where it is to start, but to this coordinate, SI.
    NotReached(DriveId, f64),
}

/// The pose at these coordinates: the assembly that the file means where its laws start, and from there one drive after the
/// other.
pub(crate) fn start(
    design: &Design<f64>,
    coordinates: &[f64],
    progress: &mut dyn Progress,
) -> Result<Start, NoStart> {
    let drives = &design.mechanism.model.drives;
    let mut now: Vec<f64> = drives
        .iter()
        .map(|d| d.law.at(0.0, &design.parameters))
        .collect();
    let mut design = design.with_laws(|index| Some(Law::standing(now[index])));
    let mut found: Option<Placed> = None;
    let mut first: Option<Arc<Motion>> = None;
    let others = (0..now.len()).filter(|drive| now[*drive] != coordinates[*drive]);
    let mut moves: Vec<usize> = others.collect();
    if moves.is_empty() {
        moves.push(0);
    }
    for drive in moves {
        let (from, to) = (
            now.get(drive).copied().unwrap_or(0.0),
            coordinates.get(drive).copied().unwrap_or(0.0),
        );
        let path = DrivePath::of_drive(&design.mechanism.model, design.size(), drive, now.clone());
        let range = (from.min(to), from.max(to));
        let demand = match &found {
            Some(placed) => Demand::from_pose(&design, path, range, from, placed),
            None => Demand {
                path,
                range,
                start: from,
                assemblies: None,
            },
        };
        let motion = Motion::along(&design, demand, progress).map_err(NoStart::Motion)?;
        let Some(placed) = motion.placed(to, &mut motion.solver()) else {
            let (low, high) = motion.reached();
            return Err(NoStart::NotReached(
                DriveId(drive as u32),
                to.clamp(low, high),
            ));
        };
        if let Some(now) = now.get_mut(drive) {
            *now = to;
        }
        let standing = now.clone();
        design = motion
            .design
            .with_laws(|index| Some(Law::standing(standing[index])));
        found = Some(placed);
        first.get_or_insert(Arc::new(motion));
    }
    let (Some(placed), Some(first)) = (found, first) else {
        return Err(NoStart::NotReached(DriveId(0), f64::NAN));
    };
    Ok(Start {
        design,
        placed,
        coordinates: now,
        first,
    })
}

/// The motion of one drive over a range on from a start.
pub(crate) fn along(
    start: &Start,
    drive: usize,
    range: (f64, f64),
    progress: &mut dyn Progress,
) -> Result<Arc<Motion>, MotionError> {
    let path = DrivePath::of_drive(
        &start.design.mechanism.model,
        start.design.size(),
        drive,
        start.coordinates.clone(),
    );
    let from = start.coordinates[drive];
    let demand = Demand::from_pose(&start.design, path, range, from, &start.placed);
    Motion::along(&start.design, demand, progress).map(Arc::new)
}
