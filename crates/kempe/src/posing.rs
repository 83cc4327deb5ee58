//! Poses that a session is asked for.

use std::sync::Arc;

use kempe_model::{Diagnostic, Law, LawPiece, RiseLaw};
use kempe_motion::Motion;
use kempe_study::{Progress, Silent, cannot_move};
use kempe_units::Expr;

use crate::pose::Passed;
use crate::way::{Way, on_the_motion};
use crate::{Error, Pose, Session};

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

    /// As [`pose`](Self::pose) without places: where the motion starts.
    ///
    /// # Errors
    ///
    /// Why it cannot start: `cannot-assemble`, `locked`, …
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// assert_eq!(s.start()?.coordinate("lift")?, 0.38);
    /// # Ok(())
    /// # }
    /// ```
    pub fn start(&mut self) -> Result<Pose, Error> {
        self.pose_with([], &mut Silent)
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
