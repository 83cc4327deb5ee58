//! What measures need beyond the poses along the path, found before the first row.

use kempe_model::{DriveId, Leaf, Measure, PointId, PoseMeasure, Statistic};
use kempe_motion::progress::Watch;

use super::Sampler;
use super::direction::Direction;
use crate::force_source::ForceSource;
use crate::measure::visit_leaves;
use crate::path_length::Swept;
use crate::statistics::{over_motion, rounds};

/// A measure that cannot be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmeasurable {
    /// Which of the measures asked for.
    pub index: usize,
    /// Why.
    pub reason: String,
}

/// Why a sampler is not ready.
#[derive(Clone, Debug, PartialEq)]
pub enum Unprepared {
    /// Measures that cannot be evaluated.
    Unmeasurable(Vec<Unmeasurable>),
    /// It was told to stop.
    Stopped,
}

impl<F: ForceSource> Sampler<F> {
    /// Finds out what the measures need beyond the poses along the path. `None` when stopped.
    pub(super) fn prepare(&mut self, watch: &mut dyn Watch) -> Option<()> {
        let mut statistics: Vec<(Statistic, Measure)> = Vec::new();
        let mut directions: Vec<(PointId, PointId)> = Vec::new();
        let mut swept: Vec<PointId> = Vec::new();
        let mut drives: Vec<DriveId> = Vec::new();
        let mut curved: Vec<PointId> = Vec::new();
        let motion = &*self.motion.clone();
        // What the forces ask for comes first: measures of forces need its statistics.
        let inputs = self.forces.as_ref().map_or(&[][..], F::measures);
        for measure in inputs.iter().chain(&self.measures) {
            visit_leaves(motion.mechanism(), measure, &mut |leaf| match leaf {
                Leaf::Over(statistic, inner) => {
                    let entry = (*statistic, (**inner).clone());
                    if !statistics.contains(&entry) {
                        statistics.push(entry);
                    }
                }
                Leaf::Pose(PoseMeasure::Direction(a, b)) if !directions.contains(&(*a, *b)) => {
                    directions.push((*a, *b));
                }
                Leaf::Pose(
                    PoseMeasure::Curvature(p)
                    | PoseMeasure::CurvatureCenterX(p)
                    | PoseMeasure::CurvatureCenterY(p),
                ) if !curved.contains(p) => curved.push(*p),
                Leaf::Pose(PoseMeasure::PathLength(p)) if !swept.contains(p) => swept.push(*p),
                Leaf::Coefficient(_, drive, _)
                | Leaf::Pose(PoseMeasure::MechanicalAdvantage(_, drive)) => {
                    drives.push(*drive);
                }
                _ => {}
            });
        }
        if self.forces.as_ref().is_some_and(F::needs_drives) {
            drives.extend((0..self.drives.len()).map(|d| DriveId(d as u32)));
        }
        for drive in drives {
            if Some(drive) != self.path_drive() {
                self.drives[drive.index()] = Some(Vec::new());
            }
        }
        curved.retain(|p| !motion.mechanism().is_fixed(*p));
        self.curved = curved;
        self.directions = (directions.into_iter())
            .map(|points| Direction::new(motion, points))
            .collect();
        for point in swept {
            self.swept.push(Swept::watched(motion, point, watch)?);
        }
        for round in rounds(self, statistics) {
            let (values, known) = over_motion(self, &round, watch)?;
            let found = round.into_iter().zip(values);
            (self.statistics).extend(found.map(|((s, measure), value)| (s, measure, value)));
            self.known.extend(known);
        }
        Some(())
    }
}
