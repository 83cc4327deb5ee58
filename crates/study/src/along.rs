//! What is evaluated along a motion: the motion alone, or its forces too.

use std::sync::Arc;

use kempe_dynamics::{
    ForceArrow, ForceError, ForceEvidence, ForceNote, ForceSampler, Problem, only_simulated,
};
use kempe_measure::force_source::NoForces;
use kempe_measure::measure::{NoMeasure, visit_leaves};
use kempe_measure::{Sample, Sampler, StatisticNote, Unmeasurable, Unprepared, unmeasurable};
use kempe_mechanism::Mechanism;
use kempe_model::{
    Diagnostic, DriveId, InnerState, Leaf, Measure, Model, SimulateStudy, Study, StudyKind,
};
use kempe_motion::{Motion, Progress, Silent, Stage};

use crate::columns::Asked;
use crate::explain::stopped;
use crate::number_notes::number_notes;
use crate::quantity::Quantity;
use crate::rows::{RowPlace, path_drive};
use crate::slot_ends::slot_note;

/// What acts on the mechanism makes no sense, as diagnostics over the model file.
pub fn force_problems(problems: Vec<Problem>) -> Vec<Diagnostic> {
    let diagnostics = problems.into_iter();
    diagnostics
        .map(|p| {
            let error = Diagnostic::error(p.code, p.message).at(p.span, "");
            match p.remedy {
                Some(remedy) => error.help(remedy),
                None => error,
            }
        })
        .collect()
}

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
    /// Which pins are beyond the ends of their curved slots.
    pub slots: Option<String>,
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
        let diagnostics: Vec<String> = (self.sample.note.iter().map(|note| note.text(mechanism)))
            .chain(of_forces.map(|note| note.text(mechanism)))
            .chain(self.slots.clone())
            .collect();
        (!diagnostics.is_empty()).then(|| diagnostics.join("; "))
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
        Self::with_progress(model, motion, quantities, forces, &[], &mut Silent)
    }

    /// As [`Along::new`], with the places of the rows that will be asked for; `progress` hears how far the statistics have come
    /// and may stop them.
    ///
    /// # Errors
    ///
    /// As [`Along::new`], and `stopped`.
    pub fn with_progress(
        model: &Model,
        motion: &Arc<Motion>,
        quantities: &[&Quantity],
        forces: bool,
        rows: &[RowPlace],
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
        let rows = times(motion, rows);
        if !forces {
            return match Sampler::with_rows(motion, &measures, NoForces, &rows, progress) {
                Ok(sampler) => Ok(Self::Motion(Box::new(sampler))),
                Err(problem) => Err(unprepared(model, quantities, problem)),
            };
        }
        ForceSampler::with_rows(motion, &measures, &rows, progress)
            .map(|sampler| Self::Forces(Box::new(sampler)))
            .map_err(|error| match error {
                ForceError::Unprepared(problem) => unprepared(model, quantities, problem),
                ForceError::Problems(problems) => force_problems(problems),
            })
    }

    /// The row at a place.
    pub fn row(&mut self, place: RowPlace) -> Row {
        let mut row = self.row_of(place);
        let motion = match self {
            Self::Motion(sampler) => sampler.motion(),
            Self::Forces(sampler) => sampler.motion(),
        };
        let model = &motion.mechanism().model;
        row.slots = slot_note(model, &motion.design.parameters, &row.sample.points);
        row
    }

    fn row_of(&mut self, place: RowPlace) -> Row {
        match self {
            Self::Motion(sampler) => Row {
                sample: match place {
                    RowPlace::Drive(p) => sampler.at_parameter(p),
                    RowPlace::Time(t) => sampler.at_time(t),
                },
                forces: None,
                slots: None,
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
                    slots: None,
                }
            }
        }
    }

    /// The values (SI) of the row at a place alone; NaN where it is not reached.
    pub fn values(&mut self, place: RowPlace) -> Vec<f64> {
        match (self, place) {
            (Self::Motion(sampler), RowPlace::Drive(p)) => sampler.values_at_parameter(p),
            (Self::Motion(sampler), RowPlace::Time(t)) => sampler.values_at_time(t),
            (Self::Forces(sampler), RowPlace::Drive(p)) => sampler.values_at_parameter(p),
            (Self::Forces(sampler), RowPlace::Time(t)) => sampler.values_at_time(t),
        }
    }

    /// When the row at a place is, s; NaN where the motion does not pass it in time.
    pub fn time_at(&self, place: RowPlace) -> f64 {
        match (self, place) {
            (_, RowPlace::Time(t)) => t,
            (Self::Motion(sampler), RowPlace::Drive(p)) => sampler.time_at(p),
            (Self::Forces(sampler), RowPlace::Drive(p)) => sampler.time_at(p),
        }
    }

    /// What is to be told of the numbers over the motion that a measure contains.
    fn notes_of(&self, measure: &Measure) -> Vec<StatisticNote> {
        match self {
            Self::Motion(sampler) => sampler.notes_of(measure),
            Self::Forces(sampler) => sampler.notes_of(measure),
        }
    }

    /// What is to be told of the numbers over the motion in the quantities that it was made for, and of which study they are.
    pub fn number_warnings(
        &self,
        study: Option<&str>,
        quantities: &[&Quantity],
    ) -> Vec<Diagnostic> {
        let motion = match self {
            Self::Motion(sampler) => sampler.motion(),
            Self::Forces(sampler) => sampler.motion(),
        };
        let numbers = quantities.iter();
        let numbers = numbers.map(|q| (q.name.as_str(), self.notes_of(&q.measure)));
        number_notes(study, motion, numbers)
    }

    /// The drive that the rows go by; none where several move.
    pub fn path_drive(&self) -> Option<DriveId> {
        match self {
            Self::Motion(sampler) => sampler.path_drive(),
            Self::Forces(sampler) => sampler.path_drive(),
        }
    }
}

/// Why there are no rows, as diagnostics over the model file.
pub(crate) fn unprepared(
    model: &Model,
    quantities: &[&Quantity],
    problem: Unprepared,
) -> Vec<Diagnostic> {
    match problem {
        Unprepared::Unmeasurable(problems) => not_measurable(model, quantities, &problems),
        Unprepared::Stopped => vec![stopped(Stage::Measuring)],
    }
}

/// What a study along the drives' laws asks for that no motion of the mechanism can answer, as diagnostics over the model file.
pub(crate) fn not_answerable(mechanism: &Mechanism, study: &Study) -> Vec<Diagnostic> {
    let asked = match &study.kind {
        StudyKind::Motion(along) => Asked::of_motion(&mechanism.model, along),
        StudyKind::Forces(along) => Asked::of_forces(mechanism, along),
        StudyKind::Clearance(play) => Asked::of_clearance(mechanism, &play.along),
        // They ask for columns of their own, which every mechanism answers, or refuse what they do not know themselves.
        StudyKind::Balance(_)
        | StudyKind::Spring(_)
        | StudyKind::Vibrations(_)
        | StudyKind::Simulate(_)
        | StudyKind::Contact(_)
        | StudyKind::Adjust(_)
        | StudyKind::Sweep(_)
        | StudyKind::Tolerance(_)
        | StudyKind::Optimize(_)
        | StudyKind::Synthesize(_) => Asked::default(),
    };
    let mut found = unanswered(mechanism, &asked, |_| true);
    if !matches!(
        study.kind,
        StudyKind::Motion(_)
            | StudyKind::Simulate(_)
            | StudyKind::Contact(_)
            | StudyKind::Sweep(_)
            | StudyKind::Tolerance(_)
            | StudyKind::Optimize(_)
            | StudyKind::Synthesize(_)
    ) {
        found.extend(
            only_simulated(mechanism)
                .err()
                .map_or_else(Vec::new, force_problems),
        );
    }
    found
}

/// What a simulation asks for that none can answer, as diagnostics over the model file.
pub(crate) fn not_simulated(mechanism: &Mechanism, study: &SimulateStudy) -> Vec<Diagnostic> {
    let asked = Asked::of_forces(mechanism, &study.along);
    unanswered(mechanism, &asked, |measure| {
        !is_followed(mechanism, study, measure)
    })
}

/// What of this no motion of the mechanism can answer, as diagnostics over the model file.
pub(crate) fn not_answered(mechanism: &Mechanism, asked: &Asked) -> Vec<Diagnostic> {
    unanswered(mechanism, asked, |_| true)
}

/// What of it no motion of the mechanism can answer; what only a simulation follows where `unknown` says so.
fn unanswered(
    mechanism: &Mechanism,
    asked: &Asked,
    unknown: impl Fn(&Measure) -> bool,
) -> Vec<Diagnostic> {
    let quantities: Vec<&Quantity> = asked.all().collect();
    let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
    let mut problems = unmeasurable(mechanism, &measures);
    problems.retain(|p| {
        p.reason != NoMeasure::OnlySimulated || measures.get(p.index).is_none_or(|m| unknown(m))
    });
    not_measurable(&mechanism.model, &quantities, &problems)
}

/// Whether a simulation follows all pressures and switches that a measure asks for.
pub(crate) fn is_followed(mechanism: &Mechanism, study: &SimulateStudy, measure: &Measure) -> bool {
    let mut followed = true;
    visit_leaves(mechanism, measure, &mut |leaf| {
        followed &= match leaf {
            Leaf::Inner(InnerState::Pressure(drive, _)) => study.released.contains(drive),
            _ => true,
        };
    });
    followed
}

/// Measures that the mechanism cannot answer, as diagnostics over the model file.
fn not_measurable(
    model: &Model,
    quantities: &[&Quantity],
    problems: &[Unmeasurable],
) -> Vec<Diagnostic> {
    let diagnostics = problems.iter().map(|problem| {
        let name = quantities.get(problem.index).map_or("", |q| &q.name);
        let what = Diagnostic::error(
            "not-measurable",
            format!("`{name}` cannot be evaluated: {}", problem.reason),
        )
        .help("ask for less of it: a derivative of lower order, or something that this motion has");
        match model.measures.iter().find(|m| m.name == name) {
            Some(named) => what.at(named.span.clone(), ""),
            None => what,
        }
    });
    diagnostics.collect()
}

/// Times of rows, s; of those at a coordinate the first time at which the drive is there.
pub(crate) fn times(motion: &Motion, rows: &[RowPlace]) -> Vec<f64> {
    let drive = motion.mechanism().model.drives.get(path_drive(motion));
    let time = |row: &RowPlace| match row {
        RowPlace::Time(time) => Some(*time),
        RowPlace::Drive(p) => drive?.law.first_time(*p, &motion.design.parameters),
    };
    rows.iter().filter_map(time).collect()
}
