//! One pose: from scratch, and from the last one on.

use std::sync::Arc;

use kempe_measure::measure::visit_leaves;
use kempe_measure::{CLOSURE_LIMIT, Sampler};
use kempe_mechanism::Mechanism;
use kempe_mechanism::bordered::Bordered;
use kempe_mechanism::evidence::{closure, evidence};
use kempe_model::{Diagnostic, Leaf, Severity};
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Motion, Placed, Solver};
use kempe_study::{Along, RowPlace, beyond_limit, slot_note};

use crate::asked::{Asked, no_value};
use crate::block::{Heading, Value};
use crate::way::Way;
use crate::{Compiled, Error};

/// Where everything is: one place of a motion, with the branch that it lies on.
///
/// It owns what it needs, so that a program may keep it, hand it to another thread and [go on from it](crate::Session::pose_near).
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
pub(crate) enum Passed {
    /// When the drive's law passes it first, if it does.
    First,
    /// At a time, s.
    At(f64),
    /// Several drives were set: there is no motion through it.
    Never,
}

impl Pose {
    /// The pose at a path parameter of a motion.
    pub(crate) fn on(
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
