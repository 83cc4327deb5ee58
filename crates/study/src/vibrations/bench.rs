//! A mechanism whose drives stand where a study of vibrations wants them, and its forces made linear there.

use std::sync::Arc;

use kempe_dynamics::modes::Mode;
use kempe_dynamics::{Linearised, Lineariser, NoModes, Unsettled, modes, settle};
use kempe_measure::PointRates;
use kempe_mechanism::Design;
use kempe_model::{Diagnostic, DriveId, Law, Model, VibrationStudy, value};
use kempe_motion::{Motion, Progress, Stage, Stance};
use kempe_units::{Dimension, Unit};

use crate::along::force_problems;
use crate::explain::stopped;
use crate::motion_findings::motion_findings;
use crate::prepared::{design, motion};
use crate::result::Frame;
use crate::unit::Units;
use crate::words::list;

/// Forces that are out of balance by more than this part of their terms are told.
pub(super) const IN_BALANCE: f64 = 1e-6;

/// A pose whose smallest singular value is less is singular.
const SINGULAR: f64 = 1e-7;

/// What a study of vibrations works on.
pub(super) struct Bench<'m> {
    pub model: &'m Model,
    pub name: &'m str,
    pub study: &'m VibrationStudy,
    pub units: Units,
    pub design: Design<f64>,
    pub motion: Arc<Motion>,
    pub stance: Stance,
    pub lineariser: Lineariser,
    /// What is to be told of the mechanism.
    pub found: Vec<Diagnostic>,
    /// What is to be told of the study.
    pub diagnostics: Vec<Diagnostic>,
}

/// The forces about a pose, and how it was found.
pub(super) struct About {
    pub linearised: Linearised,
    pub modes: Vec<Mode>,
    /// Why it is no pose of equilibrium, where one was looked for.
    pub unsettled: Option<Unsettled>,
}

/// Why there are no modes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Failure {
    /// The work was stopped.
    Stopped,
    /// The mechanism has none there.
    NoModes(NoModes),
}

impl<'m> Bench<'m> {
    /// Puts the mechanism together at the start of its drives and brings it to where the study begins.
    pub fn new(
        model: &'m Model,
        name: &'m str,
        study: &'m VibrationStudy,
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let own = design(model);
        let parameters = own.parameters.clone();
        // The way of the drives does not count here: the mechanism is led from their start to wherever a row is.
        let start = |k: usize| model.drives[k].law.at(0.0, &parameters);
        let standing = own.with_laws(|k| Some(Law::standing(start(k))));
        let motion = motion(&standing, progress)?;
        let lost = || vec![not_there(model, name, "its drives' start")];
        let stance = Stance::on(&motion, motion.start).ok_or_else(lost)?;
        let lineariser =
            Lineariser::new(&motion.design, &stance.branch().near).map_err(force_problems)?;
        let mut it = Self {
            model,
            name,
            study,
            units: Units::of(model),
            found: motion_findings(&motion),
            diagnostics: Vec::new(),
            design: own,
            motion,
            stance,
            lineariser,
        };
        let mut to = it.stance.coordinates().to_vec();
        for (drive, at) in &study.at {
            to[drive.index()] = value(at, &it.design.parameters);
        }
        if !it.stance.go(&to) {
            let places = study
                .at
                .iter()
                .map(|(drive, _)| it.place(*drive, to[drive.index()]));
            return Err(vec![not_there(
                model,
                name,
                &list(&places.collect::<Vec<_>>()),
            )]);
        }
        it.tell_left_out();
        Ok(it)
    }

    /// The drives that are let go.
    pub fn free(&self) -> &[DriveId] {
        &self.study.release
    }

    /// Where a drive stands, in words: `motor = 30 deg`.
    pub fn place(&self, drive: DriveId, at: f64) -> String {
        let drive = &self.model.drives[drive.index()];
        format!("{} = {}", drive.name, self.units.text(at, drive.dimension))
    }

    /// The unit of a drive's coordinate.
    pub fn unit(&self, drive: DriveId) -> Unit {
        self.units.unit(self.model.drives[drive.index()].dimension)
    }

    /// What a drive gives: a torque or a force.
    pub fn effort(&self, drive: DriveId) -> Dimension {
        match self.model.drives[drive.index()].dimension {
            Dimension::ANGLE => Dimension::TORQUE,
            _ => Dimension::FORCE,
        }
    }

    /// The forces made linear about the pose as it stands.
    pub fn here(&mut self, time: f64) -> Linearised {
        let (branch, coordinates) = (self.stance.branch(), self.stance.coordinates());
        self.lineariser
            .at(branch, coordinates, time, &self.study.release)
    }

    /// The modes about the pose to which what is let go sinks from here; about the one that stands where none is found, or none
    /// is to be looked for.
    pub fn settled(&mut self, time: f64, progress: &mut dyn Progress) -> Result<About, Failure> {
        let mut unsettled = None;
        if self.study.settles {
            let before = self.stance.clone();
            let free = &self.study.release;
            match settle(&mut self.stance, &mut self.lineariser, time, free, progress) {
                Ok(_) => {}
                Err(Unsettled::Stopped) => return Err(Failure::Stopped),
                Err(Unsettled::NoModes(why)) => {
                    self.stance = before;
                    return Err(Failure::NoModes(why));
                }
                Err(why) => {
                    self.stance = before;
                    unsettled = Some(why);
                }
            }
        }
        let linearised = self.here(time);
        let modes = modes(&linearised).map_err(Failure::NoModes)?;
        Ok(About {
            linearised,
            modes,
            unsettled,
        })
    }

    /// Everything that is to be told.
    pub fn told(self) -> Vec<Diagnostic> {
        let mut all = self.found;
        all.extend(self.diagnostics);
        all
    }

    /// Whether a pose is one of equilibrium.
    pub fn is_balanced(&self, it: &Linearised) -> bool {
        it.imbalance() <= IN_BALANCE
    }

    /// The pose as it stands.
    pub fn frame(stance: &Stance) -> Frame {
        let (links, points) = stance.places();
        let nothing = PointRates {
            velocity: [f64::NAN; 2],
            acceleration: [f64::NAN; 2],
        };
        Frame {
            rates: vec![nothing; points.len()],
            links,
            points,
            arrows: Vec::new(),
        }
    }

    /// Why there are no modes, as a diagnostic over the model file.
    pub fn failed(&self, why: Failure) -> Diagnostic {
        match why {
            Failure::Stopped => stopped(Stage::Settling),
            Failure::NoModes(NoModes::NoMass(place)) => {
                let drive = self.free().get(place).map(|d| &self.model.drives[d.index()]);
                let name = drive.map_or("", |d| d.name.as_str());
                let more = match place {
                    0 => "",
                    _ => " that the drives let go before it do not move",
                };
                let message = format!("study `{}`: `{name}` moves no mass{more}", self.name);
                let found = Diagnostic::error("no-mass", message)
                    .note("without mass there is no vibration; at a dead point a drive does not move the mechanism as it should")
                    .help("give links mass = \"1 kg\" and inertia, hold the drive, or let go another one");
                match drive {
                    Some(drive) => found.at(drive.span.clone(), "moves no mass"),
                    None => found,
                }
            }
            Failure::NoModes(NoModes::NoValue)
                if !(self.stance.evidence().smallest_singular_value > SINGULAR) =>
            {
                Diagnostic::error(
                    "singular-pose",
                    format!("study `{}`: the pose is singular: a dead point or a change point", self.name),
                )
                .note("there what is let go does not tell how the mechanism moves")
                .help("give a pose a little beside it under `at`, or let another drive go, one whose coordinate goes on there")
            }
            Failure::NoModes(NoModes::NoValue) => Diagnostic::error(
                "load-without-value",
                format!("study `{}`: a force has no finite value in this pose", self.name),
            )
            .help("look for a load that asks for a number over the motion or has a quotient by zero; or keep away from a dead point"),
        }
    }

    /// Warns of what a linear description leaves out everywhere.
    fn tell_left_out(&mut self) {
        let left_out = self.lineariser.left_out().clone();
        let mut found = Vec::new();
        if left_out.dry_friction {
            found.push(
                Diagnostic::warning(
                    "dry-friction-left-out",
                    format!(
                        "study `{}`: dry friction is left out: it is not linear",
                        self.name
                    ),
                )
                .note("small vibrations stick where it is; viscous friction is counted")
                .help("describe what damps by `viscous`, or by a damper"),
            );
        }
        let actions = &self.model.actions;
        for drive in &self.study.release {
            let motor = actions.motors.iter().find(|it| it.drive == *drive);
            let cylinder = actions.cylinders.iter().find(|it| it.drive == *drive);
            let (what, span) = match (motor, cylinder) {
                (Some(motor), _) => ("the motor", &motor.span),
                (_, Some(cylinder)) if cylinder.oil.is_some() => ("the oil", &cylinder.span),
                (_, Some(cylinder)) if value(&cylinder.friction, &self.design.parameters) > 0.0 => {
                    ("the friction of the seals", &cylinder.span)
                }
                _ => continue,
            };
            let name = &self.model.drives[drive.index()].name;
            let message = format!(
                "study `{}`: {what} of `{name}` is left out: the drive is let go",
                self.name
            );
            found.push(
                Diagnostic::warning("machine-left-out", message)
                    .at(span.clone(), "")
                    .note("it vibrates as if nothing moved that drive")
                    .help("simulate it, hold the drive, or describe what the machine does there by a spring, a damper or a load"),
            );
        }
        for damper in left_out.uneven_dampers {
            let Some(damper) = self.model.actions.dampers.get(damper) else {
                continue;
            };
            found.push(
                Diagnostic::warning(
                    "uneven-damper",
                    format!(
                        "study `{}`: `{}` damps differently both ways: the mean of both is counted",
                        self.name, damper.name
                    ),
                )
                .at(damper.span.clone(), "")
                .note("over a cycle of vibration the mean takes the same energy")
                .help("leave out `closing` to have it damp alike both ways"),
            );
        }
        self.diagnostics.extend(found);
    }

    /// Warns of springs at the pose last made linear whose law has a kink there. `place` says where it is.
    pub fn tell_kinks(&mut self, place: &str) {
        for spring in self.lineariser.springs_at_kinks() {
            let Some(spring) = self.model.actions.springs.get(spring) else {
                continue;
            };
            let known = |d: &Diagnostic| {
                d.code == "spring-at-kink" && d.labels.iter().any(|l| l.span == spring.span)
            };
            if self.diagnostics.iter().any(known) {
                continue;
            }
            let message = format!(
                "study `{}`: {place} `{}` is just where it goes slack, meets a stop or has no length",
                self.name, spring.name
            );
            self.diagnostics.push(
                Diagnostic::warning("spring-at-kink", message)
                    .at(spring.span.clone(), "")
                    .note("the stiffness of one side is counted: it vibrates otherwise")
                    .help("move its free length or its stop a little"),
            );
        }
    }
}

fn not_there(model: &Model, name: &str, place: &str) -> Diagnostic {
    let found = Diagnostic::error(
        "pose-not-reached",
        format!("study `{name}`: the mechanism cannot be led to {place}"),
    )
    .note("the drives go there from their start all at once, on the branch that [assembly] chose")
    .help("give another pose under `at`, or start the drives nearer to it");
    match model.studies.iter().find(|s| s.name == name) {
        Some(study) => found.at(study.span.clone(), "this study"),
        None => found,
    }
}

/// Why no equilibrium was found, in words.
pub(super) fn why_unsettled(why: Unsettled) -> &'static str {
    match why {
        Unsettled::AtLimit => {
            "what is let go sinks to a limit, where the mechanism goes no farther, or to a change point"
        }
        Unsettled::NoEnd => "what is let go is driven on and on",
        Unsettled::NoRest => "forces jump where they should balance",
        Unsettled::AtChangePoint => {
            "it would rest at a change point, where branches cross and it goes on by neither alone"
        }
        Unsettled::NoModes(_) | Unsettled::Stopped => "it was not looked for to the end",
    }
}
