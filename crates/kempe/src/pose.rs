//! One pose: from scratch, and from the last one on.

use std::sync::Arc;

use kempe_measure::measure::visit_leaves;
use kempe_measure::{CLOSURE_LIMIT, Sampler};
use kempe_mechanism::Mechanism;
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::evidence::{closure, evidence};
use kempe_model::{Diagnostic, Law, LawPiece, Leaf, RiseLaw, Severity};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Motion, Placed, Solver};
use kempe_study::{Along, Progress, RowPlace, Silent, beyond_limit, cannot_move, slot_note};
use kempe_units::Expr;

use crate::block::{Heading, Value};
use crate::session::Asked;
use crate::sweep::no_value;
use crate::way::{Way, on_the_motion};
use crate::{Compiled, Error, Session};

/// Where everything is: one place of a motion, with the branch that it lies on.
///
/// It owns what it needs, so that a program may keep it, hand it to another thread and [go on from it](Session::pose_near).
#[derive(Clone, Debug)]
pub struct Pose {
    pub(crate) compiled: Compiled,
    pub(crate) motion: Arc<Motion>,
    /// The path parameter.
    pub(crate) at: f64,
    passed: Passed,
    pub(crate) placed: Placed,
    pub(crate) coordinates: Vec<f64>,
    closure: f64,
}

/// When the motion is at a pose: what speeds and forces need.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Passed {
    /// When the drive's law passes it first, if it does.
    First,
    /// At a time, s.
    At(f64),
    /// Several drives were set: there is no motion through it.
    Never,
}

impl Pose {
    /// The pose at a path parameter of a motion.
    fn on(
        compiled: &Compiled,
        motion: &Arc<Motion>,
        at: f64,
        passed: Passed,
    ) -> Result<Self, Diagnostic> {
        let mut solver: Solver<f64> = motion.solver();
        let Some(placed) = motion.placed(at, &mut solver) else {
            return Err(unreached(compiled, motion, at));
        };
        motion.path.coordinates(at, &mut solver.coordinates);
        let mut it = Self {
            compiled: compiled.clone(),
            motion: motion.clone(),
            at,
            passed,
            placed,
            coordinates: std::mem::take(&mut solver.coordinates),
            closure: f64::NAN,
        };
        it.fill(&mut solver);
        it.closure = closure(&motion.design, &solver.branch, &solver.state, motion.size());
        match it.closure <= CLOSURE_LIMIT || motion.bridge(at).is_some() {
            true => Ok(it),
            false => Err(unreached(compiled, motion, at)),
        }
    }

    /// Fills a solver with this pose.
    fn fill(&self, solver: &mut Solver<f64>) {
        (solver.state).set_inputs(self.motion.mechanism(), &self.coordinates);
        solver.state.poses.clone_from(&self.placed.poses);
        solver.branch.near.clone_from(&self.placed.near);
    }

    /// When the motion passes here first, s; NaN where it does not.
    pub(crate) fn time(&self) -> f64 {
        match self.passed {
            Passed::At(time) => time,
            Passed::First => {
                let sampler = Sampler::new(&self.motion, &[]);
                sampler.map_or(f64::NAN, |sampler| sampler.time_at(self.at))
            }
            Passed::Never => f64::NAN,
        }
    }

    /// What a row of the motion would say of this pose.
    pub(crate) fn row_note(&self) -> Option<String> {
        let mut sampler = Sampler::new(&self.motion, &[]).ok()?;
        let note = sampler.without_time(self.at).note?;
        Some(note.text(self.motion.mechanism()))
    }

    /// x and y of a point, m.
    ///
    /// # Errors
    ///
    /// `unknown-name`.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.45)])?;
    /// assert!((p.point("M")?[1] - 0.263_578_352_4).abs() < 1e-10);
    /// # Ok(())
    /// # }
    /// ```
    pub fn point(&self, name: &str) -> Result<[f64; 2], Error> {
        let id = self.compiled.point(name)?;
        Ok(self.point_by(id))
    }

    fn point_by(&self, id: kempe_model::PointId) -> [f64; 2] {
        let design = &self.motion.design;
        (design.mechanism.any_marker(id)).map_or([f64::NAN; 2], |marker| {
            self.placed.poses[marker.body.index()].place(design.geometry.marker(marker))
        })
    }

    /// x and y of all points, m, in the order of [`Compiled::points`].
    pub fn points(&self) -> Vec<[f64; 2]> {
        let count = self.compiled.data().points.len() as u32;
        let ids = (0..count).map(kempe_model::PointId);
        ids.map(|id| self.point_by(id)).collect()
    }

    /// The angle of a link from the frame's x axis, rad, its turns counted along the motion.
    ///
    /// # Errors
    ///
    /// `unknown-name`.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.45)])?;
    /// assert!((p.angle("arm")?.to_degrees() + 3.717_790_741_208).abs() < 1e-11);
    /// # Ok(())
    /// # }
    /// ```
    pub fn angle(&self, link: &str) -> Result<f64, Error> {
        let id = self.compiled.link(link)?;
        Ok(self.link_by(id.index())[2])
    }

    fn link_by(&self, index: usize) -> [f64; 3] {
        let design = &self.motion.design;
        let body = design.mechanism.seats[index].body.index();
        let (pose, seat) = (&self.placed.poses[body], &design.geometry.seats[index]);
        let [x, y] = pose.place([seat.x, seat.y]);
        let angle = pose.angle_near(self.placed.near[body]) + design.geometry.seat_angles[index];
        [x, y, angle]
    }

    /// x, y (m) and angle (rad) of all links, in the order of [`Compiled::links`].
    pub fn links(&self) -> Vec<[f64; 3]> {
        let count = self.compiled.data().links.len();
        (0..count).map(|index| self.link_by(index)).collect()
    }

    /// The coordinate of a drive, SI.
    ///
    /// # Errors
    ///
    /// `unknown-name`.
    pub fn coordinate(&self, drive: &str) -> Result<f64, Error> {
        let id = self.compiled.drive(drive)?;
        Ok(self.coordinates[id.index()])
    }

    /// Coordinates of all drives, SI, in the order of [`Compiled::drives`].
    pub fn coordinates(&self) -> &[f64] {
        &self.coordinates
    }

    /// Largest closure residual of all joints and drives, in mechanism sizes (directions in rad).
    pub fn closure(&self) -> f64 {
        self.closure
    }

    /// Smallest singular value of the constraint Jacobian, lengths counted in mechanism sizes: zero at a singular pose.
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.45)])?;
    /// assert!(p.closure() < 1e-12 && p.smallest_singular_value() > 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    pub fn smallest_singular_value(&self) -> f64 {
        let motion = &*self.motion;
        let mut solver: Solver<f64> = motion.solver();
        self.fill(&mut solver);
        let mut system = Bordered::new(motion.mechanism());
        let (branch, state) = (&solver.branch, &solver.state);
        evidence(&motion.design, branch, state, motion.size(), &mut system).smallest_singular_value
    }

    /// What a careful engineer would want to be told about this pose: that it is a limit of the drive, that branches cross, or that a pin is beyond the end of
    /// its curved slot.
    pub fn note(&self) -> Option<String> {
        let model = &self.motion.mechanism().model;
        let slots = slot_note(model, &self.motion.design.parameters, &self.points());
        let notes: Vec<String> = self.note_of_path().into_iter().chain(slots).collect();
        (!notes.is_empty()).then(|| notes.join("; "))
    }

    fn note_of_path(&self) -> Option<String> {
        if self.motion.limit_at(self.at).is_some() {
            return Some("limit of the drive: it can go no farther".to_owned());
        }
        let crossing =
            (self.motion.bridge(self.at)).filter(|e| e.kind == EventKind::ChangePoint)?;
        let place = place_text(&self.compiled, &self.motion, crossing.at);
        Some(format!(
            "change point at {place}: branches cross, and the motion goes on smoothly"
        ))
    }

    /// The value of a measure here.
    ///
    /// Speeds and forces are those of the motion through the pose: by the file's laws, or of the drive that moved here alone by
    /// its law, and so are numbers over the motion. Where several drives were set there are none.
    ///
    /// # Errors
    ///
    /// What is wrong with the text; `not-on-the-motion` for forces where there is no motion; `no-value` with the reason.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.38)])?;
    /// let push = p.measure("-reduced_load(lift)")?;
    /// assert!((push.si - 29_188.298_883_1).abs() < 1e-6);
    /// assert_eq!(push.heading.unit.text(), "N");
    /// assert_eq!(p.measure("sqrt(y(Q) - 1 m)").unwrap_err().code(), "no-value");
    /// # Ok(())
    /// # }
    /// ```
    pub fn measure(&self, text: &str) -> Result<Value, Error> {
        let model = &self.motion.mechanism().model;
        let asked = Asked::of(&self.compiled, model, [text])?;
        let quantities: Vec<_> = asked.quantities.iter().collect();
        let (si, note, time, warnings) = match self.passed {
            Passed::Never => {
                if let Some(what) = of_a_motion(&asked, self.motion.mechanism()) {
                    let message =
                        format!("{what} known on a motion, not where several drives were set");
                    let help =
                        "sweep over time, or move one drive from here: pose_near, sweep_from";
                    let diagnostic = Diagnostic::error("not-on-the-motion", message).help(help);
                    return Err(self.compiled.error(diagnostic));
                }
                let measures: Vec<_> = quantities.iter().map(|q| &q.measure).collect();
                let mut sampler = Sampler::new(&self.motion, &measures).map_err(|problems| {
                    let diagnostic = problems.iter().map(|p| {
                        Diagnostic::error("not-measurable", format!("`{text}`: {}", p.reason))
                    });
                    self.compiled.errors(diagnostic.collect())
                })?;
                let mut sample = sampler.without_time(self.at);
                asked.without_time(&mut sample);
                let note = (sample.note).map(|note| note.text(self.motion.mechanism()));
                let value = sample.values.first().copied();
                (value, note, sample.time, Vec::new())
            }
            passed => {
                let forces = asked.any_forces();
                let mut along = Along::new(model, &self.motion, &quantities, forces)
                    .map_err(|diagnostics| self.compiled.errors(diagnostics))?;
                let row = along.row(match passed {
                    Passed::At(time) => RowPlace::Time(time),
                    _ => RowPlace::Drive(self.at),
                });
                let note = row.note(self.motion.mechanism());
                let mut sample = row.sample;
                asked.without_time(&mut sample);
                let warnings = along.number_warnings(None, &quantities);
                (sample.values.first().copied(), note, sample.time, warnings)
            }
        };
        let si = si.unwrap_or(f64::NAN);
        if si.is_nan() {
            let reason = note.unwrap_or_else(|| no_value(text, time));
            return Err(self.compiled.error(Diagnostic::error("no-value", reason)));
        }
        let heading = Heading::of(quantities[0], self.compiled.units());
        Ok(Value {
            heading,
            si,
            warnings,
        })
    }
}

/// What of the measures is known on a motion alone, if anything.
fn of_a_motion(asked: &Asked, mechanism: &Mechanism) -> Option<&'static str> {
    let mut over = false;
    for quantity in &asked.quantities {
        visit_leaves(mechanism, &quantity.measure, &mut |leaf| {
            over |= matches!(leaf, Leaf::Over(..));
        });
    }
    match (asked.any_forces(), over) {
        (true, _) => Some("forces depend on speeds: they are"),
        (false, true) => Some("numbers over the motion are"),
        (false, false) => None,
    }
}

impl Session {
    /// The pose with drives at these places (SI), or at a `time` (s); drives that are not named stay where their laws start.
    ///
    /// The drives go there from their start, all at once, so that the branch is that of the motion.
    ///
    /// # Errors
    ///
    /// `unknown-name`, `over-specified`; `range-beyond-limit` and why else the place cannot be reached.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.415)])?;
    /// assert!((p.point("S")?[1] - 0.717_008_393_7).abs() < 1e-10);
    /// assert_eq!(s.pose([("lift", 0.9)]).unwrap_err().code(), "range-beyond-limit");
    /// assert_eq!(s.pose([("time", 3.5)])?.coordinate("lift")?, 0.45);
    /// # Ok(())
    /// # }
    /// ```
    pub fn pose<'n>(
        &mut self,
        places: impl IntoIterator<Item = (&'n str, f64)>,
    ) -> Result<Pose, Error> {
        self.pose_with(places, &mut Silent)
    }

    /// As [`pose`](Self::pose); `progress` hears how far it has come and may stop it.
    ///
    /// # Errors
    ///
    /// As there, and `stopped`.
    pub fn pose_with<'n>(
        &mut self,
        places: impl IntoIterator<Item = (&'n str, f64)>,
        progress: &mut dyn Progress,
    ) -> Result<Pose, Error> {
        let mut set: Vec<(Way, f64)> = Vec::new();
        for (name, value) in places {
            let way = Way::named(&self.compiled, name)?;
            let clash =
                |(other, _): &(Way, f64)| *other == way || *other == Way::Time || way == Way::Time;
            if set.iter().any(clash) {
                let message = format!("`{name}` is set besides what says the same");
                let diagnostic = Diagnostic::error("over-specified", message);
                return Err(self
                    .compiled
                    .error(diagnostic.help("give the time alone, or every drive once")));
            }
            if !value.is_finite() {
                let diagnostic = Diagnostic::error("not-finite", format!("`{name}` is {value}"));
                return Err(self
                    .compiled
                    .error(diagnostic.help("give a finite place, in SI")));
            }
            set.push((way, value));
        }
        let (model, parameters) = (&self.design.mechanism.model, &self.design.parameters);
        // A drive that is set where its law starts does not move.
        set.retain(|(way, place)| match way {
            Way::Drive(drive) => model.drives[*drive].law.at(0.0, parameters) != *place,
            Way::Time => true,
        });
        let (motion, at, passed) = match set.as_slice() {
            [] => {
                let motion = self.known_motion(progress)?;
                let start = motion.start;
                (motion, start, Passed::At(0.0))
            }
            [(Way::Time, time)] => {
                on_the_motion(&self.design, *time)
                    .map_err(|diagnostic| self.compiled.error(diagnostic))?;
                let motion = self.known_motion(progress)?;
                let (model, parameters) = (&self.design.mechanism.model, &self.design.parameters);
                let at = motion.path.parameter_at(model, *time, parameters);
                (motion, at, Passed::At(*time))
            }
            [(way, place)] => {
                let motion = self.motion_over(*way, (*place, *place), progress)?;
                (motion, *place, Passed::First)
            }
            several => {
                let motion = self.together(several, progress)?;
                let end = motion.demanded.1;
                (motion, end, Passed::Never)
            }
        };
        Pose::on(&self.compiled, &motion, at, passed)
            .map_err(|diagnostic| self.compiled.error(diagnostic))
    }

    /// The motion of several drives from their start to their places, all at once, in a second.
    fn together(
        &self,
        places: &[(Way, f64)],
        progress: &mut dyn Progress,
    ) -> Result<Arc<Motion>, Error> {
        let (model, parameters) = (&self.design.mechanism.model, &self.design.parameters);
        let design = self.design.with_laws(|index| {
            let from = model.drives[index].law.at(0.0, parameters);
            let own = places.iter().find(|(way, _)| *way == Way::Drive(index));
            let duration = Expr::Const(1.0);
            let piece = match own {
                Some((_, to)) if *to != from => LawPiece::Rise {
                    to: Expr::Const(*to),
                    duration,
                    by: RiseLaw::Polynomial345,
                },
                _ => LawPiece::Dwell { duration },
            };
            Some(Law {
                from: Expr::Const(from),
                pieces: vec![piece],
            })
        });
        Motion::with_progress(&design, progress)
            .map_err(|error| self.compiled.error(cannot_move(&design, &error)))
    }

    /// The pose with one drive moved on from another pose (SI), on the same branch; the other drives stay where that pose has
    /// them. No assembly is searched for. On a motion that is known this takes microseconds; where it is not, the way there is
    /// followed first and known from then on to the pose that comes back.
    ///
    /// This is how a hand drags a drive, and how several drives are moved one by one.
    ///
    /// # Errors
    ///
    /// `unknown-name`; `range-beyond-limit` where the drive cannot go so far on this branch, `branches-entangled` and why else
    /// it cannot; `another-design` when parameters were set since the pose was found.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let p = s.pose([("lift", 0.40)])?;
    /// let p = s.pose_near(&p, "lift", 0.415)?;
    /// assert!((p.point("M")?[1] - 0.152_749_647_2).abs() < 1e-10);
    /// let error = s.pose_near(&p, "lift", 0.9).unwrap_err();
    /// assert_eq!(error.code(), "range-beyond-limit");
    /// # Ok(())
    /// # }
    /// ```
    pub fn pose_near(&self, pose: &Pose, drive: &str, place: f64) -> Result<Pose, Error> {
        self.of_this_design(pose)?;
        let drive = self.compiled.drive(drive)?.index();
        if !place.is_finite() {
            let diagnostic = Diagnostic::error("not-finite", format!("the place is {place}"));
            return Err(self
                .compiled
                .error(diagnostic.help("give a finite place, in SI")));
        }
        let motion = self.motion_from(pose, drive, (place, place), &mut Silent)?;
        Pose::on(&self.compiled, &motion, place, Passed::First)
            .map_err(|diagnostic| self.compiled.error(diagnostic))
    }

    /// Whether a pose is one of the design as it is set now.
    pub(crate) fn of_this_design(&self, pose: &Pose) -> Result<(), Error> {
        if pose.compiled.is(&self.compiled)
            && pose.motion.design.parameters == self.design.parameters
        {
            return Ok(());
        }
        let diagnostic = Diagnostic::error("another-design", "the pose is one of another design");
        Err(self.compiled.error(
            diagnostic.help(
                "find it anew: a pose holds for the parameters that were set when it was found",
            ),
        ))
    }
}

/// Why a motion does not come to a place.
fn unreached(compiled: &Compiled, motion: &Motion, at: f64) -> Diagnostic {
    let (low, high) = motion.reached();
    let reason = match at {
        at if at > high => motion.ends.1,
        at if at < low => motion.ends.0,
        _ => EndReason::Covered,
    };
    if let (DrivePath::Time { .. }, false) = (&motion.path, reason == EndReason::Covered) {
        let mut coordinates = vec![0.0; compiled.data().drives.len()];
        motion
            .path
            .coordinates(at.clamp(low, high), &mut coordinates);
        let drives = compiled.data().drives.iter().zip(&coordinates);
        let places: Vec<String> = drives
            .map(|(d, q)| format!("{} = {}", d.name, compiled.units().text(*q, d.dimension)))
            .collect();
        let message = format!(
            "on their way there the drives come no farther than {}",
            places.join(", ")
        );
        return Diagnostic::error("range-beyond-limit", message)
            .help("move them one by one on another way: pose_near");
    }
    if reason != EndReason::Covered {
        let diagnostic = beyond_limit(motion, &[(reason, at)]);
        return diagnostic.with_severity(Severity::Error);
    }
    let place = place_text(compiled, motion, at);
    Diagnostic::error("not-reached", format!("no pose was found at {place}"))
        .help("ask for a place a little beside it: here the mechanism is singular")
}

/// A place of a motion, with its unit.
fn place_text(compiled: &Compiled, motion: &Motion, at: f64) -> String {
    let way = match motion.path {
        DrivePath::Coordinate { drive, .. } => Way::Drive(drive),
        DrivePath::Time { .. } => Way::Time,
    };
    let (name, dimension) = way.places(compiled);
    let text = compiled.units().place_text(at, dimension, motion.demanded);
    format!("{name} = {text}")
}
