//! A sampler made: what its measures need beyond the poses along the path is found before the first row.

use std::sync::Arc;

use crate::measure::asks_unknown_state;
use kempe_mechanism::Mechanism;
use kempe_mechanism::bordered::Bordered;
use kempe_model::Measure;
use kempe_motion::motion::Motion;
use kempe_motion::progress::{Progress, Silent};

use crate::force_source::{ForceSource, NoForces};
use crate::measure::needs::Needs;
use crate::measure::{NoMeasure, order_of};
use crate::measurer::Measurer;
use crate::path_length::Swept;
use crate::sampler::{CountedForces, Sampler};
use crate::statistics::{over_motion, rounds};

/// A measure that cannot be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmeasurable {
    /// Which of the measures asked for.
    pub index: usize,
    /// Why.
    pub reason: NoMeasure,
}

/// Why a sampler is not ready.
#[derive(Clone, Debug, PartialEq)]
pub enum Unprepared {
    /// Measures that cannot be evaluated.
    Unmeasurable(Vec<Unmeasurable>),
    /// It was told to stop.
    Stopped,
}

impl Sampler {
    /// Prepares measures for evaluation along a motion; statistics over the motion are computed here.
    ///
    /// # Errors
    /// All measures that cannot be evaluated, each with its reason.
    pub fn new(motion: &Arc<Motion>, measures: &[&Measure]) -> Result<Self, Vec<Unmeasurable>> {
        Self::with_forces(motion, measures, NoForces)
    }
}

/// Which of the measures a mechanism cannot answer, whatever its dimensions and wherever it goes.
pub fn unmeasurable(mechanism: &Mechanism, measures: &[&Measure]) -> Vec<Unmeasurable> {
    let problem = |(index, measure): (usize, &&Measure)| {
        let unknown =
            || asks_unknown_state(&mechanism.model, measure).then_some(NoMeasure::OnlySimulated);
        let reason = order_of(mechanism, measure).err().or_else(unknown)?;
        Some(Unmeasurable { index, reason })
    };
    measures.iter().enumerate().filter_map(problem).collect()
}

impl<F: ForceSource> Sampler<F> {
    /// As [`Sampler::new`], with a source of forces.
    ///
    /// # Errors
    /// All measures that cannot be evaluated, each with its reason.
    pub fn with_forces(
        motion: &Arc<Motion>,
        measures: &[&Measure],
        forces: F,
    ) -> Result<Self, Vec<Unmeasurable>> {
        Self::with_progress(motion, measures, forces, &mut Silent).map_err(
            |problem| match problem {
                Unprepared::Unmeasurable(list) => list,
                // Silent, it is never stopped.
                Unprepared::Stopped => Vec::new(),
            },
        )
    }

    /// As [`Sampler::with_forces`]; `progress` hears how far the statistics over the motion have come.
    ///
    /// # Errors
    /// As [`Sampler::with_forces`], and [`Unprepared::Stopped`].
    pub fn with_progress(
        motion: &Arc<Motion>,
        measures: &[&Measure],
        forces: F,
        progress: &mut dyn Progress,
    ) -> Result<Self, Unprepared> {
        Self::with_rows(motion, measures, forces, &[], progress)
    }

    /// As [`Sampler::with_progress`]; statistics over the motion look at the times of its rows, s, too: no row lies beyond an
    /// extreme.
    ///
    /// # Errors
    /// As [`Sampler::with_progress`].
    pub fn with_rows(
        motion: &Arc<Motion>,
        measures: &[&Measure],
        forces: F,
        rows: &[f64],
        progress: &mut dyn Progress,
    ) -> Result<Self, Unprepared> {
        let mut rows: Vec<f64> = rows.iter().copied().filter(|t| t.is_finite()).collect();
        rows.sort_by(f64::total_cmp);
        let mechanism = motion.mechanism();
        let problems = unmeasurable(mechanism, measures);
        if !problems.is_empty() {
            return Err(Unprepared::Unmeasurable(problems));
        }
        let mut it = Self {
            measurer: Measurer::new(motion, &motion.design.parameters, forces),
            rows,
            known: Vec::new(),
            notes: Vec::new(),
            closely: Vec::new(),
            measures: measures.iter().map(|m| (*m).clone()).collect(),
            lengths: Vec::new(),
            curved: Vec::new(),
            plain: motion.solver(),
            system: Bordered::new(mechanism),
            counted: None,
        };
        it.prepare(progress).ok_or(Unprepared::Stopped)?;
        Ok(it)
    }

    /// Finds out what the measures need beyond the poses along the path. `None` when stopped.
    fn prepare(&mut self, progress: &mut dyn Progress) -> Option<()> {
        let motion = self.motion().clone();
        // What the forces ask for comes first: measures of forces need its statistics.
        let inputs = self.measurer.forces.measures().iter();
        let needs = Needs::of(&motion, inputs.chain(&self.measures));
        self.measurer.take_up(&needs);
        self.counted = CountedForces::of(&motion, &needs.forces).map(Box::new);
        self.curved = needs.curved;
        self.curved.retain(|p| !motion.mechanism().is_fixed(*p));
        for point in needs.lengths {
            self.lengths
                .push(Swept::with_progress(&motion, point, progress)?);
        }
        for round in rounds(self, needs.statistics) {
            let found = over_motion(self, &round, progress)?;
            self.known.extend(found.known);
            self.closely.extend(found.closely);
            self.closely.sort_by(f64::total_cmp);
            self.notes
                .extend(found.notes.into_iter().map(|(number, note)| {
                    let (statistic, measure) = &round[number];
                    (statistic.clone(), measure.clone(), note)
                }));
            let values = round.into_iter().zip(found.values);
            (self.measurer.statistics)
                .extend(values.map(|((s, measure), value)| (s, measure, value)));
        }
        Some(())
    }
}
