//! The motion of a session as data: how far it goes, what it meets, how else the mechanism could be put together.

use kempe_mechanism::Design;
use kempe_model::{Diagnostic, PointId};
use kempe_motion::EndReason;
use kempe_motion::assemble::Assembly;
use kempe_motion::drive_path::{DrivePath, duration};
use kempe_motion::events::EventKind;
use kempe_study::{Progress, Silent, motion_findings};

use crate::block::Heading;
use crate::way::Way;
use crate::{Error, Session};

/// The motion by the file's laws.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MotionData {
    /// What it runs along: the only drive that moves, or time. All places below are of it, SI.
    pub along: Heading,
    /// Where it starts.
    pub start: f64,
    /// The range that the laws demand.
    pub demanded: (f64, f64),
    /// The range of it that was reached.
    pub reached: (f64, f64),
    /// Why it ends at the low and at the high end.
    pub ends: (EndReason, EndReason),
    /// How long it takes, s.
    pub duration: f64,
    /// Limits and change points on its way, in order.
    pub events: Vec<MotionEvent>,
    /// Where the assembly was chosen: the start, or near it where that is singular.
    pub chosen_at: f64,
    /// Ways to put the mechanism together there that agree with the file's hints, the one taken first; then those that do not.
    pub assemblies: Vec<AssemblyData>,
    /// Whether it is known that these are all.
    pub complete: bool,
    /// What a careful engineer would want to be told of the mechanism and its motion, as `kempe check` and every study tell it: hints that are missed,
    /// several assemblies that fit, redundant constraints, a range that is not covered.
    pub warnings: Vec<Diagnostic>,
}

/// What a motion meets.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MotionEvent {
    /// What it is.
    pub kind: EventKind,
    /// Where, SI.
    pub at: f64,
    /// Where, in the file's unit: `lock = 117.512 deg`.
    pub place: String,
}

/// One way to put a mechanism together.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AssemblyData {
    /// Whether it agrees with the sides that the file names.
    pub agrees: bool,
    /// x and y of all points, m, in the order of [`Compiled::points`](crate::Compiled::points).
    pub points: Vec<[f64; 2]>,
    /// Angles of all links, rad, to within whole turns.
    pub angles: Vec<f64>,
}

impl Session {
    /// The motion by the file's laws, as data: its range, what it meets, and the assemblies where one was chosen: at its start, or as
    /// drawn.
    ///
    /// # Errors
    ///
    /// Why it cannot start: `cannot-assemble`, `locked`, `branches-entangled`.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let motion = s.motion()?;
    /// assert_eq!((motion.along.name.as_str(), motion.reached), ("lift", (0.38, 0.52)));
    /// assert!((motion.duration - 7.0).abs() < 1e-12);
    /// // Three dyads: up to eight ways to put it together, of which the file's sides leave one.
    /// assert!(motion.complete && motion.assemblies.iter().filter(|a| a.agrees).count() == 1);
    /// assert!(motion.warnings.is_empty());
    /// # Ok(())
    /// # }
    /// ```
    pub fn motion(&mut self) -> Result<MotionData, Error> {
        self.motion_with(&mut Silent)
    }

    /// As [`motion`](Self::motion); `progress` hears how far it has come and may stop it.
    ///
    /// # Errors
    ///
    /// As there, and `stopped`.
    pub fn motion_with(&mut self, progress: &mut dyn Progress) -> Result<MotionData, Error> {
        let motion = self.known_motion(progress)?;
        let units = self.compiled.units();
        let way = match motion.path {
            DrivePath::Coordinate { drive, .. } => Way::Drive(drive),
            DrivePath::Time { .. } => Way::Time,
        };
        let (name, dimension) = way.places(&self.compiled);
        let events = motion
            .events
            .iter()
            .filter(|e| e.kind != EventKind::ModeChange);
        let events = events.map(|event| {
            let place = units.place_text(event.at, dimension, motion.demanded);
            MotionEvent {
                kind: event.kind,
                at: event.at,
                place: format!("{name} = {place}"),
            }
        });
        let found = &motion.assemblies;
        let shown = |list: &[Assembly], agrees: bool| -> Vec<AssemblyData> {
            let list = list.iter();
            list.map(|a| assembly(&motion.design, a, agrees)).collect()
        };
        let mut assemblies = shown(&found.list, true);
        assemblies.extend(shown(&found.others, false));
        Ok(MotionData {
            along: Heading::new(name, dimension, units),
            start: motion.start,
            demanded: motion.demanded,
            reached: motion.reached(),
            ends: motion.ends,
            duration: duration(&self.design.mechanism.model, &self.design.parameters),
            events: events.collect(),
            chosen_at: motion.anchor,
            assemblies,
            complete: found.complete,
            warnings: motion_findings(&motion),
        })
    }
}

fn assembly(design: &Design<f64>, of: &Assembly, agrees: bool) -> AssemblyData {
    let (mechanism, geometry) = (&design.mechanism, &design.geometry);
    let points = (0..mechanism.model.points.len() as u32).map(|index| {
        mechanism
            .any_marker(PointId(index))
            .map_or([f64::NAN; 2], |m| {
                of.poses[m.body.index()].place(geometry.marker(m))
            })
    });
    let angles = mechanism.seats.iter().zip(&geometry.seat_angles);
    let angles = angles.map(|(seat, angle)| of.poses[seat.body.index()].angle_near(0.0) + angle);
    AssemblyData {
        agrees,
        points: points.collect(),
        angles: angles.collect(),
    }
}
