//! What measures need beyond the poses along the path, found before the first row.

use kempe_motion::progress::Progress;

use super::Sampler;
use crate::force_source::ForceSource;
use crate::measurer::Needs;
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
    pub(super) fn prepare(&mut self, progress: &mut dyn Progress) -> Option<()> {
        let motion = self.motion().clone();
        // What the forces ask for comes first: measures of forces need its statistics.
        let inputs = self.measurer.forces.measures().iter();
        let needs = Needs::of(&motion, inputs.chain(&self.measures));
        self.measurer.take_up(&needs);
        self.curved = needs.curved;
        self.curved.retain(|p| !motion.mechanism().is_fixed(*p));
        for point in needs.lengths {
            self.lengths
                .push(Swept::with_progress(&motion, point, progress)?);
        }
        for round in rounds(self, needs.statistics) {
            let (values, known) = over_motion(self, &round, progress)?;
            let found = round.into_iter().zip(values);
            (self.measurer.statistics)
                .extend(found.map(|((s, measure), value)| (s, measure, value)));
            self.known.extend(known);
        }
        Some(())
    }
}
