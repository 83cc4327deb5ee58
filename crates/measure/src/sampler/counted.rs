//! Whole turns of directions of forces: a force may vanish and come back another way round, so they are not followed along a motion, but taken as
//! near as can be to where they are, at the same part of its time, on the motion that it is counted as.

use std::sync::Arc;

use kempe_model::{ForceMeasure, Leaf, Measure};
use kempe_motion::motion::Motion;
use kempe_motion::progress::Silent;

use super::Sampler;
use crate::force_source::ForceSource;

/// Directions of forces on the motion that another is counted as.
pub(crate) struct CountedForces<F> {
    sampler: Sampler<F>,
    measures: Vec<ForceMeasure>,
}

impl<F: ForceSource> CountedForces<F> {
    /// These directions, where the motion is counted as another.
    pub fn of(motion: &Motion, measures: &[ForceMeasure]) -> Option<Self> {
        if measures.is_empty() {
            return None;
        }
        let as_other: &Arc<Motion> = motion.counts_as.as_ref()?;
        let leaves = measures.iter().cloned();
        let asked: Vec<Measure> = leaves.map(|m| Measure::Leaf(Leaf::Force(m))).collect();
        let forces = F::of_motion(as_other)?;
        let asked: Vec<&Measure> = asked.iter().collect();
        let sampler = Sampler::with_rows(as_other, &asked, forces, &[], &mut Silent);
        Some(Self {
            sampler: sampler.ok()?,
            measures: measures.to_vec(),
        })
    }

    /// Where they are at a part of the motion's time, rad; at the nearest place that it reaches.
    fn at(&mut self, part: f64) -> Vec<(ForceMeasure, f64)> {
        let time = part * self.sampler.duration();
        let (low, high) = self.sampler.motion().reached();
        let p = self.sampler.clock().parameter_at(time).max(low).min(high);
        let values = self.sampler.values(p, time);
        let all = self.measures.iter().cloned().zip(values);
        all.filter(|(_, angle)| angle.is_finite()).collect()
    }
}

impl<F: ForceSource> Sampler<F> {
    /// About where directions of forces are at a time: what is not here has its principal value.
    pub(crate) fn directions_of_forces(&mut self, time: f64) -> Vec<(ForceMeasure, f64)> {
        let duration = self.duration();
        let part = if duration > 0.0 { time / duration } else { 0.0 };
        let counted = self.counted.as_mut().filter(|_| part.is_finite());
        counted.map_or_else(Vec::new, |counted| counted.at(part))
    }
}
