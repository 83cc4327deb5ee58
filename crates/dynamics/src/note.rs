//! What is to be told about the forces of a row.

use kempe_mechanism::{BodyId, Mechanism};
use kempe_model::{Chamber, DriveId, DriveKind, InnerState};

use crate::equilibrium::FrictionOutcome;
use crate::forces::Forces;
use crate::instant::{Instant, Rates};
use crate::reaction::Carrier;

/// A difference of the two routes, in parts of the terms of a drive's force, above which a row is marked.
pub const ROUTES_AGREE: f64 = 1e-9;
/// A condition of the equations above which a row is marked: from here on half of the digits are lost.
pub const ILL_CONDITIONED: f64 = 1e8;
/// A residual of the equilibrium, over its largest term, above which a row is marked.
pub const EQUILIBRIUM_LIMIT: f64 = 1e-9;
/// A torque that holds an idle body, over the largest torque of a drive, above which a row is marked.
pub const IDLE_LIMIT: f64 = 1e-9;
/// An effort that is this part of what it would be without friction is none: what a simulation lets go gives no more.
const GIVES: f64 = 1e-6;

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
    /// A pinion moves across its rack: their teeth would part or jam, and the force that parts them does work.
    TeethPart(Carrier),
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
    /// A load has no value here.
    NoLoad {
        /// Its place in the model's actions.
        load: usize,
    },
    /// Without time there are no speeds and no forces.
    NoTime,
}

impl ForceNote {
    /// A stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Singular => "singular-pose",
            Self::IllConditioned { .. } => "nearly-singular",
            Self::NotUnique(_) => "reactions-not-unique",
            Self::RoutesDiffer { .. } => "routes-differ",
            Self::Unbalanced { .. } => "not-balanced",
            Self::Jammed { .. } => "jammed",
            Self::FrictionNotConverged { .. } => "friction-not-converged",
            Self::SelfLocking(_) => "self-locking",
            Self::AtRest => "friction-at-rest",
            Self::TeethPart(_) => "teeth-part",
            Self::IdleBodyDriven { .. } => "idle-body-driven",
            Self::MotorTooWeak { .. } => "motor-too-weak",
            Self::CylinderTooWeak { .. } => "cylinder-too-weak",
            Self::FlowTooSmall { .. } => "flow-too-small",
            Self::NoLoad { .. } => "load-without-value",
            Self::NoTime => "no-time",
        }
    }

    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Singular | Self::IllConditioned { .. } => {
                "keep the drive away from that place, or let another drive or spring carry the mechanism through it"
            }
            Self::NotUnique(_) => {
                "take out what is said twice, such as a parallel link, if the load of each joint is wanted; their sum is right"
            }
            Self::RoutesDiffer { .. } | Self::Unbalanced { .. } => {
                "do not rely on these rows: look for loads of very different size, or a pose near a singular one"
            }
            Self::Jammed { .. } | Self::SelfLocking(_) => {
                "lessen the friction, or let the load act under a better angle"
            }
            Self::FrictionNotConverged { .. } => {
                "do not rely on these rows: lessen the friction, or take smaller steps in what loads depend on"
            }
            Self::AtRest => "give the drive a speed, so that friction knows its way",
            Self::TeethPart(_) => {
                "guide the pinion's centre along the rack's x axis, or leave the pressure angle out"
            }
            Self::IdleBodyDriven { .. } => {
                "hold the link by another joint, or leave out what turns it"
            }
            Self::MotorTooWeak { .. } => "choose a stronger motor, a lower speed or a smaller load",
            Self::CylinderTooWeak { .. } => {
                "choose a larger bore or a higher supply pressure, or a smaller load"
            }
            Self::FlowTooSmall { .. } => "choose a larger flow, a smaller bore or a lower speed",
            Self::NoLoad { .. } => {
                "give the load a value everywhere: look for a quotient by zero, or a root or an arc of a number outside its range"
            }
            Self::NoTime => "ask for forces where the drives move in time",
        }
    }

    /// How bad it is among notes of its code; 0 where there is no more or less.
    pub fn severity(&self) -> f64 {
        match self {
            Self::IllConditioned { condition } => *condition,
            Self::RoutesDiffer { difference } => *difference,
            Self::Unbalanced { residual } => *residual,
            Self::Jammed { part } => -part,
            Self::FrictionNotConverged { step } => *step,
            Self::IdleBodyDriven { torque, .. } => torque.abs(),
            Self::MotorTooWeak { lacks, .. } => *lacks,
            Self::CylinderTooWeak { pressure, .. } => *pressure,
            Self::FlowTooSmall { flow, .. } => *flow,
            Self::Singular
            | Self::NotUnique(_)
            | Self::SelfLocking(_)
            | Self::AtRest
            | Self::TeethPart(_)
            | Self::NoLoad { .. }
            | Self::NoTime => 0.0,
        }
    }

    /// The drive that it is about, where it is about one.
    pub fn drive(&self) -> Option<DriveId> {
        match *self {
            Self::SelfLocking(drive)
            | Self::MotorTooWeak { drive, .. }
            | Self::CylinderTooWeak { drive, .. }
            | Self::FlowTooSmall { drive, .. } => Some(drive),
            _ => None,
        }
    }

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
            Self::TeethPart(carrier) => format!(
                "the pinion of {} moves across its rack, where teeth would part or jam: do not rely on these forces",
                carrier.name(mechanism)
            ),
            Self::IdleBodyDriven { body, torque } => format!(
                "{} turns freely, and a torque of {torque:.3e} N m would turn it; it is held here",
                mechanism.body_name(*body)
            ),
            Self::MotorTooWeak { drive: d, lacks } => {
                format!(
                    "{} needs {} N m more than its motor gives",
                    drive(d),
                    short(*lacks)
                )
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
                "{} needs {:.2} L/min and the pump gives {:.2} L/min",
                drive(d),
                flow * 6e4,
                given * 6e4
            ),
            Self::NoLoad { load } => {
                let named = model.actions.loads.get(*load);
                format!(
                    "the load `{}` is infinite or not a number here, and with it all forces",
                    named.map_or("", |l| l.name.as_str())
                )
            }
            Self::NoTime => "no forces without time".into(),
        }
    }
}

/// A number to four digits, in plain notation where that is readable.
fn short(x: f64) -> String {
    let size = x.abs();
    if !(1e-3..1e6).contains(&size) {
        return format!("{x:.3e}");
    }
    let whole = kempe_number::math::log10(size).floor() as i32;
    let decimals = usize::try_from(3 - whole).unwrap_or(0);
    format!("{x:.decimals$}")
}

/// What is to be told about the forces of an instant, whose equations are conditioned like this.
pub(crate) fn notes(forces: &Forces<Rates>, at: &Instant<Rates>, condition: f64) -> Vec<ForceNote> {
    use kempe_number::Number as _;
    let equilibrium = &forces.equilibrium;
    let plain = &equilibrium.lanes[0];
    let mut notes = Vec::new();
    let without_value = forces.acting.loads.iter().position(|load| {
        at.amounts[load.amounts()]
            .iter()
            .any(|a| !a.value().is_finite())
    });
    if let Some(load) = without_value {
        notes.push(ForceNote::NoLoad { load });
        return notes;
    }
    if plain.singular {
        notes.push(ForceNote::Singular);
        return notes;
    }
    if !(condition <= ILL_CONDITIONED) {
        notes.push(ForceNote::IllConditioned { condition });
    }
    match plain.friction {
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
    let difference = forces.route_difference(0);
    if !(difference <= ROUTES_AGREE) {
        notes.push(ForceNote::RoutesDiffer { difference });
    }
    if !(plain.residual <= EQUILIBRIUM_LIMIT) {
        notes.push(ForceNote::Unbalanced {
            residual: plain.residual,
        });
    }
    if equilibrium.rests(&forces.acting.friction) {
        notes.push(ForceNote::AtRest);
    }
    for constraint in equilibrium.parting(&forces.acting.friction) {
        let source = &forces.design.mechanism.constraints[constraint].1;
        notes.push(ForceNote::TeethPart(Carrier::of(source)));
    }
    for (index, drive) in forces.drives.iter().enumerate() {
        let speed = at.drive_speeds[index].value();
        let gives = drive.value.value();
        let smoothly = forces.frictionless(index, 0);
        let braked =
            smoothly * speed < 0.0 && gives * speed > 0.0 && gives.abs() > GIVES * smoothly.abs();
        // What tells the place of a drive that is let go moves nothing.
        let kind = forces.design.mechanism.model.drives.get(index);
        let drives = !kind.is_some_and(|d| matches!(d.kind, DriveKind::StandIn(_)));
        // What the masses do on their way is no load: friction holds what pushes at rest too.
        if braked && drives && forces.holds_at_rest(at, index) {
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
    notes.extend(not_unique_note(forces));
    notes
}

/// A motor or a cylinder that lacks less than this part of the most it can give does give enough.
const ENOUGH: f64 = 1e-6;

fn actuator_notes(forces: &Forces<Rates>, at: &Instant<Rates>, notes: &mut Vec<ForceNote>) {
    use kempe_number::Number as _;
    for motor in &forces.acting.motors {
        let Some(drive) = forces.drives.get(motor.drive.index()) else {
            continue;
        };
        let speed = at.drive_speeds[motor.drive.index()];
        let margin = motor.margin(drive.value, speed).value();
        let most = motor.curve.iter().map(|(_, torque)| torque.value().abs());
        if margin < -ENOUGH * most.fold(0.0, f64::max) {
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
        // What a simulation moved by its oil gives what that gives.
        let model = &forces.design.mechanism.model;
        if model
            .inner_law(InnerState::Pressure(id, Chamber::Bore))
            .is_some()
        {
            continue;
        }
        let direction = forces.drive_direction(at, id);
        let pressure = cylinder.pressure(drive.value, direction).value();
        if let Some(highest) = cylinder.highest.map(|p| p.value())
            && pressure > highest * (1.0 + ENOUGH)
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

/// Which joints' loads are not unique; asked of the row at hand, as it may change along the motion.
fn not_unique_note(forces: &Forces<Rates>) -> Option<ForceNote> {
    if forces.equilibrium.redundant_rows() == 0 {
        return None;
    }
    let mut carriers: Vec<Carrier> = Vec::new();
    for constraint in forces.equilibrium.not_unique() {
        let carrier = Carrier::of(&forces.design.mechanism.constraints[constraint].1);
        if !carriers.contains(&carrier) {
            carriers.push(carrier);
        }
    }
    (!carriers.is_empty()).then_some(ForceNote::NotUnique(carriers))
}
