//! Rows of a motion with its forces: measures, poses and evidence at any place or time.

use std::fmt;

use kempe_kinematics::{BodyId, Branch, Mechanism, Motion, Sample, Sampler, Unmeasurable};
use kempe_model::{DriveId, Measure};

use crate::equilibrium::FrictionOutcome;
use crate::forces::Forces;
use crate::instant::{Instant, Rates};
use crate::problem::Problem;
use crate::reaction::{Carrier, JointLoad};
use crate::source::Source;

/// A difference of the two routes, in parts of the terms of a drive's force, above which a row is marked.
pub const ROUTES_AGREE: f64 = 1e-9;
/// A condition of the equations above which a row is marked: from here on half of the digits are lost.
pub const ILL_CONDITIONED: f64 = 1e8;
/// A residual of the equilibrium, over its largest term, above which a row is marked.
pub const EQUILIBRIUM_LIMIT: f64 = 1e-9;
/// A torque that holds an idle body, over the largest torque of a drive, above which a row is marked.
pub const IDLE_LIMIT: f64 = 1e-9;

/// Why there are no forces.
#[derive(Clone, Debug)]
pub enum ForceError {
    /// What acts on the mechanism makes no sense.
    Problems(Vec<Problem>),
    /// Measures that cannot be evaluated.
    Unmeasurable(Vec<Unmeasurable>),
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

/// What a careful engineer would want to be told about the forces of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum ForceNote {
    /// The pose is singular: joint loads are not defined here.
    Singular,
    /// The pose is near a singular one.
    IllConditioned {
        /// Condition of the equations.
        condition: f64,
    },
    /// Equilibrium does not determine the loads of these joints.
    NotUnique(Vec<Carrier>),
    /// The two routes do not agree.
    RoutesDiffer {
        /// By how much, relative.
        difference: f64,
    },
    /// The equations were not solved to their rounding.
    Unbalanced {
        /// What is left, relative.
        residual: f64,
    },
    /// No finite force moves the mechanism against its friction.
    Jammed {
        /// Part of the friction at which it jams.
        part: f64,
    },
    /// Loads and friction did not become consistent.
    FrictionNotConverged {
        /// Last relative step.
        step: f64,
    },
    /// The load does not move this drive: friction holds it, and it must be driven both ways.
    SelfLocking(DriveId),
    /// Nothing moves at a joint with friction: its friction is not determined and counted as none.
    AtRest,
    /// Something would turn a body whose angle nothing determines.
    IdleBodyDriven {
        /// The body.
        body: BodyId,
        /// The torque that would turn it, N m.
        torque: f64,
    },
    /// The motor is too weak here.
    MotorTooWeak {
        /// The drive.
        drive: DriveId,
        /// What it lacks, N m.
        lacks: f64,
    },
    /// The cylinder cannot give this at its pressure.
    CylinderTooWeak {
        /// The drive.
        drive: DriveId,
        /// Pressure needed, Pa.
        pressure: f64,
        /// Pressure there is, Pa.
        highest: f64,
    },
    /// The pump does not move the cylinder this fast.
    FlowTooSmall {
        /// The drive.
        drive: DriveId,
        /// Flow needed, m^3/s.
        flow: f64,
        /// Flow there is, m^3/s.
        given: f64,
    },
    /// Without time there are no speeds and no forces.
    NoTime,
}

impl ForceNote {
    /// The note as a sentence.
    pub fn text(&self, mechanism: &Mechanism) -> String {
        let model = &mechanism.model;
        let drive = |d: &DriveId| {
            (model.drives.get(d.index())).map_or_else(String::new, |d| d.name.clone())
        };
        match self {
            Self::Singular => "singular pose: joint loads are not defined here".into(),
            Self::IllConditioned { condition } => {
                format!(
                    "near a singular pose: condition {condition:.1e}; joint loads grow without bound towards it"
                )
            }
            Self::NotUnique(carriers) => {
                let names: Vec<String> = carriers.iter().map(|c| c.name(mechanism)).collect();
                format!(
                    "overconstrained: equilibrium does not determine the loads of {}; the smallest are given",
                    names.join(", ")
                )
            }
            Self::RoutesDiffer { difference } => {
                format!("virtual power and equilibrium differ by {difference:.1e}")
            }
            Self::Unbalanced { residual } => {
                format!("equilibrium is not met: {residual:.1e} of the largest term is left")
            }
            Self::Jammed { part } => format!(
                "jammed: no finite force moves it; it jams already with {:.1} % of the friction",
                100.0 * part
            ),
            Self::FrictionNotConverged { step } => {
                format!("loads and friction did not become consistent: last step {step:.1e}")
            }
            Self::SelfLocking(d) => {
                format!("self-locking: friction holds {} against its load", drive(d))
            }
            Self::AtRest => "at rest: friction is not determined and counted as none".into(),
            Self::IdleBodyDriven { body, torque } => format!(
                "{} turns freely, and a torque of {torque:.3e} N m would turn it; it is held here",
                mechanism.body_name(*body)
            ),
            Self::MotorTooWeak { drive: d, lacks } => {
                format!("the motor of {} lacks {lacks:.4e} N m", drive(d))
            }
            Self::CylinderTooWeak {
                drive: d,
                pressure,
                highest,
            } => format!(
                "{} needs {:.2} bar and has {:.2} bar",
                drive(d),
                pressure * 1e-5,
                highest * 1e-5
            ),
            Self::FlowTooSmall {
                drive: d,
                flow,
                given,
            } => format!(
                "{} needs {:.2} l/min and the pump gives {:.2} l/min",
                drive(d),
                flow * 6e4,
                given * 6e4
            ),
            Self::NoTime => "no forces without time".into(),
        }
    }
}

impl Carrier {
    /// The joint's or drive's name in the file.
    pub fn name(&self, mechanism: &Mechanism) -> String {
        let model = &mechanism.model;
        let name = match self {
            Self::Pin(p) => model.points.get(p.index()).map(|p| &p.name),
            Self::Joint(j) => model.joints.get(j.index()).map(|j| &j.name),
            Self::Drive(d) => model.drives.get(d.index()).map(|d| &d.name),
        };
        name.cloned().unwrap_or_default()
    }
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
pub struct ForceSampler<'a> {
    sampler: Sampler<'a, Source<'a>>,
}

impl fmt::Display for ForceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Problems(list) => {
                for problem in list {
                    writeln!(f, "{problem}")?;
                }
            }
            Self::Unmeasurable(list) => {
                for it in list {
                    writeln!(f, "measure {}: {}", it.index, it.reason)?;
                }
            }
        }
        Ok(())
    }
}

impl std::error::Error for ForceError {}

impl<'a> ForceSampler<'a> {
    /// Prepares measures for evaluation along a motion; statistics over the motion are computed here.
    ///
    /// # Errors
    /// Problems of what acts on the mechanism, or measures that cannot be evaluated.
    pub fn new(motion: &'a Motion<'a>, measures: &[&Measure]) -> Result<Self, ForceError> {
        let mechanism = motion.mechanism;
        let parameters: Vec<Rates> = mechanism.model.parameter_values();
        let geometry = kempe_kinematics::Geometry::new(mechanism, &parameters);
        let mut forces = Forces::new(mechanism, motion.plan, geometry, &parameters)
            .map_err(ForceError::Problems)?;
        let mut start = Branch::neutral(mechanism, motion.plan);
        motion.branch_at(motion.start, &mut start);
        for spring in &mut forces.acting.springs {
            spring.align(&forces.geometry, &start.near);
        }
        let sampler = Sampler::with_forces(motion, measures, Source::new(forces))
            .map_err(ForceError::Unmeasurable)?;
        Ok(Self { sampler })
    }

    /// The motion.
    pub fn motion(&self) -> &'a Motion<'a> {
        self.sampler.motion()
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

    /// The loads of all joints and drives of the row last asked for: what arrows and hodographs are drawn from.
    pub fn joint_loads(&self) -> Vec<JointLoad> {
        self.solved()
            .map_or_else(Vec::new, |(forces, at)| forces.joint_loads(at))
    }

    /// Forces and instant of the row last asked for.
    pub fn solved(&self) -> Option<(&Forces<'a, Rates>, &Instant<Rates>)> {
        self.sampler.forces().map(|s| (&s.forces, &s.instant))
    }

    fn with_evidence(&self, sample: Sample) -> ForceSample {
        let found = self
            .solved()
            .filter(|_| sample.closure.is_finite() && sample.time.is_finite())
            .map(|(forces, at)| (evidence(forces, at), notes(forces, at)));
        let (evidence, mut notes) = match found {
            Some((evidence, notes)) => (Some(evidence), notes),
            None if sample.closure.is_finite() => (None, vec![ForceNote::NoTime]),
            None => (None, Vec::new()),
        };
        if evidence.is_some() {
            notes.extend(self.not_unique_note());
        }
        ForceSample {
            sample,
            evidence,
            notes,
        }
    }

    /// Which joints' loads are not unique; asked of the row at hand, as it may change along the motion.
    fn not_unique_note(&self) -> Option<ForceNote> {
        let (forces, _) = self.solved()?;
        if forces.equilibrium.redundant_rows() == 0 || forces.equilibrium.singular {
            return None;
        }
        let mut carriers: Vec<Carrier> = Vec::new();
        for constraint in forces.equilibrium.not_unique() {
            let carrier = Carrier::of(&forces.mechanism.constraints[constraint].1);
            if !carriers.contains(&carrier) {
                carriers.push(carrier);
            }
        }
        (!carriers.is_empty()).then_some(ForceNote::NotUnique(carriers))
    }
}

impl Carrier {
    fn of(source: &kempe_kinematics::mechanism::Source) -> Self {
        use kempe_kinematics::mechanism::Source as From;
        match *source {
            From::Pin { point, .. } => Self::Pin(point),
            From::Joint(id) => Self::Joint(id),
            From::Drive(id) => Self::Drive(id),
        }
    }
}

fn evidence(forces: &Forces<'_, Rates>, at: &Instant<Rates>) -> ForceEvidence {
    use kempe_number::Number as _;
    let equilibrium = &forces.equilibrium;
    ForceEvidence {
        route_difference: forces.route_difference(),
        residual: equilibrium.residual,
        condition: equilibrium.condition(),
        friction: equilibrium.friction,
        drive_power: (forces.drives.iter().zip(&at.drive_speeds))
            .map(|(drive, speed)| drive.value.value() * speed.value())
            .sum(),
        friction_power: equilibrium.friction_power(&forces.acting.friction).value(),
        damping_power: crate::energy::dissipation(&forces.acting, &forces.geometry, at).value(),
    }
}

fn notes(forces: &Forces<'_, Rates>, at: &Instant<Rates>) -> Vec<ForceNote> {
    use kempe_number::Number as _;
    let equilibrium = &forces.equilibrium;
    let mut notes = Vec::new();
    let condition = equilibrium.condition();
    if equilibrium.singular {
        notes.push(ForceNote::Singular);
        return notes;
    }
    if !(condition <= ILL_CONDITIONED) {
        notes.push(ForceNote::IllConditioned { condition });
    }
    match equilibrium.friction {
        FrictionOutcome::Jammed { part } => {
            notes.push(ForceNote::Jammed { part });
            return notes;
        }
        FrictionOutcome::NotConverged { step } => {
            notes.push(ForceNote::FrictionNotConverged { step });
            return notes;
        }
        FrictionOutcome::None | FrictionOutcome::Consistent { .. } => {}
    }
    let difference = forces.route_difference();
    if !(difference <= ROUTES_AGREE) {
        notes.push(ForceNote::RoutesDiffer { difference });
    }
    if !(equilibrium.residual <= EQUILIBRIUM_LIMIT) {
        notes.push(ForceNote::Unbalanced {
            residual: equilibrium.residual,
        });
    }
    if equilibrium.rests(&forces.acting.friction) {
        notes.push(ForceNote::AtRest);
    }
    for (index, drive) in forces.drives.iter().enumerate() {
        let speed = at.drive_speeds[index].value();
        if drive.frictionless * speed < 0.0 && drive.value.value() * speed > 0.0 {
            notes.push(ForceNote::SelfLocking(DriveId(index as u32)));
        }
    }
    let largest = (forces.drives.iter())
        .map(|d| d.by_power.scale)
        .fold(0.0, f64::max);
    for (torque, body) in (equilibrium.holding_torques().iter()).zip(equilibrium.idle_bodies()) {
        if torque.value().abs() > IDLE_LIMIT * largest {
            notes.push(ForceNote::IdleBodyDriven {
                body: *body,
                torque: torque.value(),
            });
        }
    }
    actuator_notes(forces, at, &mut notes);
    notes
}

fn actuator_notes(forces: &Forces<'_, Rates>, at: &Instant<Rates>, notes: &mut Vec<ForceNote>) {
    use kempe_number::Number as _;
    for motor in &forces.acting.motors {
        let Some(drive) = forces.drives.get(motor.drive.index()) else {
            continue;
        };
        let speed = at.drive_speeds[motor.drive.index()];
        let margin = motor.margin(drive.value, speed).value();
        if margin < 0.0 {
            notes.push(ForceNote::MotorTooWeak {
                drive: motor.drive,
                lacks: -margin,
            });
        }
    }
    for cylinder in &forces.acting.cylinders {
        let id = cylinder.drive;
        let Some(drive) = forces.drives.get(id.index()) else {
            continue;
        };
        let direction = forces.drive_direction(at, id);
        let pressure = cylinder.pressure(drive.value, direction).value();
        if let Some(highest) = cylinder.highest.map(|p| p.value())
            && pressure > highest
        {
            notes.push(ForceNote::CylinderTooWeak {
                drive: id,
                pressure,
                highest,
            });
        }
        let flow = cylinder.flow_at(at.drive_speeds[id.index()]).value();
        if let Some(given) = cylinder.flow.map(|q| q.value())
            && flow > given * (1.0 + 1e-9)
        {
            notes.push(ForceNote::FlowTooSmall {
                drive: id,
                flow,
                given,
            });
        }
    }
}
