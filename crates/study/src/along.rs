//! What is evaluated along a motion: the motion alone, or its forces too.

use std::sync::Arc;

use kempe_dynamics::{ForceArrow, ForceError, ForceEvidence, ForceNote, ForceSampler};
use kempe_measure::force_source::NoForces;
use kempe_measure::{Sample, Sampler};
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, DriveId, Model};
use kempe_motion::{Motion, Unwatched, Watch};

use crate::columns::Quantity;
use crate::motion::unprepared;
use crate::rows::RowPlace;

/// Evaluates quantities along a motion.
pub enum Along {
    /// Of the motion alone.
    Motion(Box<Sampler>),
    /// Of its forces too.
    Forces(Box<ForceSampler>),
}

/// A row with the forces in it, where they were asked for.
#[derive(Clone, Debug)]
pub struct Row {
    /// Values, poses and their evidence.
    pub sample: Sample,
    /// The forces; `None` where they were not asked for.
    pub forces: Option<RowForces>,
}

/// Forces of a row.
#[derive(Clone, Debug)]
pub struct RowForces {
    /// `None` where no pose was reached.
    pub evidence: Option<ForceEvidence>,
    /// What is to be told about them.
    pub notes: Vec<ForceNote>,
    /// What acts on the links, to be drawn.
    pub arrows: Vec<ForceArrow>,
}

impl Row {
    /// What is to be told about the row and its forces, such as why it was not reached.
    pub fn note(&self, mechanism: &Mechanism) -> Option<String> {
        let of_forces = self.forces.iter().flat_map(|forces| &forces.notes);
        let told: Vec<String> = (self.sample.note.iter().cloned())
            .chain(of_forces.map(|note| note.text(mechanism)))
            .collect();
        (!told.is_empty()).then(|| told.join("; "))
    }
}

impl Along {
    /// Prepares quantities for evaluation; with their forces where `forces` says so.
    ///
    /// # Errors
    ///
    /// `not-measurable`, and what is wrong with what acts on the mechanism.
    pub fn new(
        model: &Model,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        forces: bool,
    ) -> Result<Self, Vec<Diagnostic>> {
        Self::watched(model, motion, quantities, forces, &mut Unwatched)
    }

    /// As [`Along::new`]; `watch` hears how far the statistics have come and may stop them.
    ///
    /// # Errors
    ///
    /// As [`Along::new`], and `stopped`.
    pub fn watched(
        model: &Model,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        forces: bool,
        watch: &mut dyn Watch,
    ) -> Result<Self, Vec<Diagnostic>> {
        let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
        if !forces {
            return match Sampler::watched(motion, &measures, NoForces, watch) {
                Ok(sampler) => Ok(Self::Motion(Box::new(sampler))),
                Err(problem) => Err(unprepared(model, quantities, problem)),
            };
        }
        ForceSampler::watched(motion, &measures, watch)
            .map(|sampler| Self::Forces(Box::new(sampler)))
            .map_err(|error| match error {
                ForceError::Unprepared(problem) => unprepared(model, quantities, problem),
                ForceError::Problems(problems) => {
                    let told = problems
                        .into_iter()
                        .map(|p| Diagnostic::error(p.code, p.message).at(p.span, ""));
                    told.collect()
                }
            })
    }

    /// The row at a place.
    pub fn row(&mut self, place: RowPlace) -> Row {
        match self {
            Self::Motion(sampler) => Row {
                sample: match place {
                    RowPlace::Drive(p) => sampler.at_parameter(p),
                    RowPlace::Time(t) => sampler.at_time(t),
                },
                forces: None,
            },
            Self::Forces(sampler) => {
                let found = match place {
                    RowPlace::Drive(p) => sampler.at_parameter(p),
                    RowPlace::Time(t) => sampler.at_time(t),
                };
                let arrows = match found.evidence {
                    Some(_) => sampler.arrows(),
                    None => Vec::new(),
                };
                Row {
                    sample: found.sample,
                    forces: Some(RowForces {
                        evidence: found.evidence,
                        notes: found.notes,
                        arrows,
                    }),
                }
            }
        }
    }

    /// The drive that the rows go by; none where several move.
    pub fn path_drive(&self) -> Option<DriveId> {
        match self {
            Self::Motion(sampler) => sampler.path_drive(),
            Self::Forces(sampler) => sampler.path_drive(),
        }
    }
}
