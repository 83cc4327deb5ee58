//! Rows of a motion with its forces: measures, poses and evidence at any place or time.

use std::fmt;
use std::sync::Arc;

use kempe_measure::{Sample, Sampler, StatisticNote, Unmeasurable, Unprepared};
use kempe_model::{DriveId, Measure};
use kempe_motion::{Motion, Progress, Silent};

use crate::equilibrium::FrictionOutcome;
use crate::forces::Forces;
use crate::instant::{Instant, Rates};
use crate::note::{ForceNote, notes};
use crate::problem::Problem;
use crate::reaction::JointLoad;
use crate::source::Source;

/// Why there are no forces.
#[derive(Clone, Debug)]
pub enum ForceError {
    /// What acts on the mechanism makes no sense.
    Problems(Vec<Problem>),
    /// Measures that cannot be evaluated, or work that was stopped.
    Unprepared(Unprepared),
}

/// How far the forces of a row can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceEvidence {
    /// Difference of virtual power and equilibrium, in parts of the terms of each drive's force; the largest.
    pub route_difference: f64,
    /// What is left of the worst body's equilibrium, over the largest term.
    pub residual: f64,
    /// Condition of the scaled equations.
    pub condition: f64,
    /// How friction ended.
    pub friction: FrictionOutcome,
    /// Power of all drives, W.
    pub drive_power: f64,
    /// Power that friction takes (never positive), W.
    pub friction_power: f64,
    /// Power that the dampers take (never negative), W.
    pub damping_power: f64,
}

/// A row of a motion with its forces.
#[derive(Clone, Debug)]
pub struct ForceSample {
    /// Measures, poses and their evidence.
    pub sample: Sample,
    /// Evidence of the forces; `None` where no pose was reached.
    pub evidence: Option<ForceEvidence>,
    /// What is to be told about the forces.
    pub notes: Vec<ForceNote>,
}

/// Evaluates measures of motion and forces along a motion.
pub struct ForceSampler {
    sampler: Sampler<Source<f64>>,
}

impl fmt::Display for ForceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Problems(list) => {
                for problem in list {
                    writeln!(f, "{problem}")?;
                }
            }
            Self::Unprepared(Unprepared::Stopped) => writeln!(f, "stopped")?,
            Self::Unprepared(Unprepared::Unmeasurable(list)) => {
                for it in list {
                    writeln!(f, "measure {}: {}", it.index, it.reason)?;
                }
            }
        }
        Ok(())
    }
}

impl std::error::Error for ForceError {}

impl ForceError {
    /// The measures that cannot be evaluated.
    ///
    /// # Errors
    /// The problems of what acts, where these are the reason. Nothing of either where the work was stopped.
    pub fn unmeasurable(self) -> Result<Vec<Unmeasurable>, Vec<Problem>> {
        match self {
            Self::Problems(problems) => Err(problems),
            Self::Unprepared(Unprepared::Unmeasurable(list)) => Ok(list),
            Self::Unprepared(Unprepared::Stopped) => Ok(Vec::new()),
        }
    }
}

impl ForceSampler {
    /// Prepares measures for evaluation along a motion; statistics over the motion are computed here.
    ///
    /// # Errors
    /// Problems of what acts on the mechanism, or measures that cannot be evaluated.
    pub fn new(motion: &Arc<Motion>, measures: &[&Measure]) -> Result<Self, ForceError> {
        Self::with_progress(motion, measures, &mut Silent)
    }

    /// As [`ForceSampler::new`]; `progress` hears how far the statistics over the motion have come and may stop them.
    ///
    /// # Errors
    /// As [`ForceSampler::new`], and that it was stopped.
    pub fn with_progress(
        motion: &Arc<Motion>,
        measures: &[&Measure],
        progress: &mut dyn Progress,
    ) -> Result<Self, ForceError> {
        Self::with_rows(motion, measures, &[], progress)
    }

    /// As [`ForceSampler::with_progress`]; statistics over the motion look at the times of its rows, s, too.
    ///
    /// # Errors
    /// As [`ForceSampler::with_progress`].
    pub fn with_rows(
        motion: &Arc<Motion>,
        measures: &[&Measure],
        rows: &[f64],
        progress: &mut dyn Progress,
    ) -> Result<Self, ForceError> {
        let source =
            Source::new(motion, &motion.design.parameters).map_err(ForceError::Problems)?;
        let sampler = Sampler::with_rows(motion, measures, source, rows, progress)
            .map_err(ForceError::Unprepared)?;
        Ok(Self { sampler })
    }

    /// The motion.
    pub fn motion(&self) -> &Arc<Motion> {
        self.sampler.motion()
    }

    /// What is to be told of the numbers over the motion that a measure contains.
    pub fn notes_of(&self, measure: &Measure) -> Vec<StatisticNote> {
        self.sampler.notes_of(measure)
    }

    /// The drive whose coordinate is the path parameter.
    pub fn path_drive(&self) -> Option<DriveId> {
        self.sampler.path_drive()
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.sampler.duration()
    }

    /// Times at which some drive's law goes from one piece to the next: forces may jump there.
    pub fn breaks(&self) -> Vec<f64> {
        self.sampler.breaks()
    }

    /// The first time at which a drive's coordinate takes a value, s.
    pub fn time_of(&self, drive: DriveId, value: f64) -> Option<f64> {
        self.sampler.time_of(drive, value)
    }

    /// When the motion passes a path parameter first, s; NaN where it does not.
    pub fn time_at(&self, p: f64) -> f64 {
        self.sampler.time_at(p)
    }

    /// The row at a path parameter: the first time the motion passes it.
    pub fn at_parameter(&mut self, p: f64) -> ForceSample {
        let sample = self.sampler.at_parameter(p);
        self.with_evidence(sample)
    }

    /// The row at a time, s.
    pub fn at_time(&mut self, t: f64) -> ForceSample {
        let sample = self.sampler.at_time(t);
        self.with_evidence(sample)
    }

    /// The measures (SI) of the row at a path parameter alone, without any evidence; NaN where it is not reached.
    pub fn values_at_parameter(&mut self, p: f64) -> Vec<f64> {
        self.sampler.values_at_parameter(p)
    }

    /// The measures (SI) of the row at a time, s, alone, without any evidence; NaN where it is not reached.
    pub fn values_at_time(&mut self, t: f64) -> Vec<f64> {
        self.sampler.values_at_time(t)
    }

    /// The loads of all joints and drives of the row last asked for: what arrows and hodographs are drawn from.
    pub fn joint_loads(&self) -> Vec<JointLoad> {
        let (forces, at) = self.solved();
        forces.joint_loads(at)
    }

    /// Everything that acts on the links of the row last asked for, to be drawn.
    pub fn arrows(&self) -> Vec<crate::arrow::ForceArrow> {
        let (forces, at) = self.solved();
        forces.arrows(at)
    }

    /// Forces and instant of the row last asked for.
    pub fn solved(&self) -> (&Forces<Rates>, &Instant<Rates>) {
        let source = self.sampler.forces();
        (&source.forces, &source.instant)
    }

    fn with_evidence(&self, sample: Sample) -> ForceSample {
        let (forces, at) = self.solved();
        let reached = sample.closure.is_finite();
        let (evidence, notes) = match reached && sample.time.is_finite() {
            true => {
                let evidence = evidence(forces, at);
                let notes = notes(forces, at, evidence.condition);
                (Some(evidence), notes)
            }
            false if reached => (None, vec![ForceNote::NoTime]),
            false => (None, Vec::new()),
        };
        ForceSample {
            sample,
            evidence,
            notes,
        }
    }
}

pub(crate) fn evidence(forces: &Forces<Rates>, at: &Instant<Rates>) -> ForceEvidence {
    use kempe_number::Number as _;
    let equilibrium = &forces.equilibrium;
    let plain = &equilibrium.lanes[0];
    ForceEvidence {
        route_difference: forces.route_difference(0),
        residual: plain.residual,
        condition: plain.condition(),
        friction: plain.friction,
        drive_power: (forces.drives.iter().zip(&at.drive_speeds))
            .map(|(drive, speed)| drive.value.value() * speed.value())
            .sum(),
        friction_power: equilibrium.friction_power(&forces.acting.friction).value(),
        damping_power: crate::energy::dissipation(&forces.acting, &forces.design.geometry, at)
            .value(),
    }
}
