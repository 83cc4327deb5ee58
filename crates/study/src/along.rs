//! What is evaluated along a motion: the motion alone, or its forces too.

use std::sync::Arc;

use kempe_dynamics::{ForceArrow, ForceError, ForceEvidence, ForceNote, ForceSampler};
use kempe_measure::force_source::NoForces;
use kempe_measure::{Sample, Sampler};
use kempe_model::{Diagnostic, DriveId, Model};
use kempe_motion::{Motion, Unwatched, Watch};

use crate::columns::Quantity;
use crate::motion::unprepared;
use crate::rows::{RowPlace, path_drive};

/// Evaluates quantities along a motion.
pub(crate) enum Along {
    Motion(Box<Sampler>),
    Forces(Box<ForceSampler>),
}

/// A row with the forces in it, where they were asked for.
pub(crate) struct Row {
    pub sample: Sample,
    pub forces: Option<RowForces>,
}

/// Forces of a row.
pub(crate) struct RowForces {
    /// `None` where no pose was reached.
    pub evidence: Option<ForceEvidence>,
    pub notes: Vec<ForceNote>,
    pub arrows: Vec<ForceArrow>,
}

impl Along {
    /// Prepares quantities for evaluation.
    pub fn new(
        model: &Model,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        forces: bool,
    ) -> Result<Self, Vec<Diagnostic>> {
        Self::watched(model, motion, quantities, forces, &[], &mut Unwatched)
    }

    /// As [`Along::new`], with the places of the rows that will be asked for; `watch` hears how far the statistics have come
    /// and may stop them.
    pub fn watched(
        model: &Model,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        forces: bool,
        rows: &[RowPlace],
        watch: &mut dyn Watch,
    ) -> Result<Self, Vec<Diagnostic>> {
        let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
        let rows = times(motion, rows);
        if !forces {
            return match Sampler::with_rows(motion, &measures, NoForces, &rows, watch) {
                Ok(sampler) => Ok(Self::Motion(Box::new(sampler))),
                Err(problem) => Err(unprepared(model, quantities, problem)),
            };
        }
        ForceSampler::with_rows(motion, &measures, &rows, watch)
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

/// Times of rows, s; of those at a coordinate the first time at which the drive is there.
fn times(motion: &Motion, rows: &[RowPlace]) -> Vec<f64> {
    let drive = motion.mechanism().model.drives.get(path_drive(motion));
    let time = |row: &RowPlace| match row {
        RowPlace::Time(time) => Some(*time),
        RowPlace::Drive(p) => drive?.law.first_time(*p, &motion.design.parameters),
    };
    rows.iter().filter_map(time).collect()
}
