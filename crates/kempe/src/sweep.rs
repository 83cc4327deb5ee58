//! Measures at many places of a motion, as columns.

use std::borrow::Borrow;
use std::sync::Arc;

use kempe_measure::Sample;
use kempe_model::Diagnostic;
use kempe_motion::Motion;
use kempe_study::{Along, Done, ForceColumns, Progress, RowPlace, Silent, Stage};
use kempe_units::Dimension;

use crate::asked::{Asked, no_value};
use crate::block::{Block, Heading};
use crate::way::{Way, extent, on_the_motion};
use crate::{Compiled, Error, Pose, Session};

/// Measures at many places: columns of one length, with the evidence of every row.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sweep {
    /// The places: coordinates of the drive, or times.
    pub along: Block,
    /// When the motion passes them first, s; NaN where the drive's law does not, and then nothing is known of speeds and forces.
    pub time: Block,
    /// One column for each measure.
    pub columns: Vec<Block>,
    /// Largest closure residual of each row, in mechanism sizes (directions in rad); NaN where it was not reached.
    pub closure: Vec<f64>,
    /// Smallest singular value of each row's constraint Jacobian, lengths counted in mechanism sizes: zero at a singular pose.
    pub smallest_singular_value: Vec<f64>,
    /// How far the forces of each row can be trusted; `None` where no measure asks for them.
    pub forces: Option<ForceColumns>,
    /// What is to be told about each row; always something where the row was not reached or a value is NaN.
    pub notes: Vec<Option<String>>,
    /// What is to be told of numbers over the motion among the measures: that one is infinite, or how many of its digits hold.
    pub warnings: Vec<Diagnostic>,
    /// Rows that were asked for: there are fewer where the sweep was stopped.
    pub asked: usize,
}

impl Sweep {
    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.notes.len()
    }

    /// The column of a measure, as it was asked for.
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let t = s.sweep("lift", [0.38], &["angle(arm)"])?;
    /// let angle = t.column("angle(arm)").unwrap();
    /// assert_eq!((angle.heading.unit.text(), angle.heading.si.text()), ("deg", "rad"));
    /// assert!((angle.in_unit()[0] + 24.907_171_907_568).abs() < 1e-11);
    /// assert!(t.column("angle(leg)").is_none());
    /// # Ok(())
    /// # }
    /// ```
    pub fn column(&self, measure: &str) -> Option<&Block> {
        self.columns.iter().find(|c| c.name() == measure)
    }

    /// Whether a row was reached.
    pub fn reached(&self, row: usize) -> bool {
        self.closure.get(row).is_some_and(|c| c.is_finite())
    }

    /// Why a row was not reached, or why a value of it is missing.
    pub fn reason(&self, row: usize) -> Option<&str> {
        let lacks = |c: &Block| c.values.get(row).is_some_and(|v| v.is_nan());
        let missing = !self.reached(row) || self.columns.iter().any(lacks);
        self.notes.get(row)?.as_deref().filter(|_| missing)
    }

    /// Whether it was stopped before its last row.
    pub fn interrupted(&self) -> bool {
        self.rows() < self.asked
    }
}

impl Session {
    /// Measures at places of a drive (SI), or of `time` (s) where every drive moves by its law.
    ///
    /// Measures are whatever the language knows, named in the file or not, forces among them. One drive moves and the others
    /// stay where their laws start (those of the only drive that moves are rows of the file's own motion). Speeds and forces
    /// are those with which the drive's law first passes a place. Rows do not depend on each other. A place beyond a limit is
    /// no error: its row says why it was not reached.
    ///
    /// # Errors
    ///
    /// `unknown-name` and what is wrong with a measure; `not-finite` for a place; why the motion cannot start.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// use kempe::linspace;
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let t = s.sweep("lift", linspace(0.38, 0.52, 29), &["y(M)", "force(lift)", "reaction(K)"])?;
    /// assert!((t.columns[0].values[28] - 0.539_700_898_6).abs() < 1e-10);
    /// assert_eq!(t.columns[1].heading.unit.text(), "N");
    /// assert!(t.forces.unwrap().route_difference.iter().all(|d| *d < 1e-9));
    ///
    /// // The cylinder cannot be drawn out so far.
    /// let t = s.sweep("lift", [0.5, 0.9], &["y(M)"])?;
    /// assert!(t.reached(0) && t.columns[0].values[1].is_nan());
    /// assert!(t.reason(1).unwrap().starts_with("not reached: the drive's limit is at"));
    ///
    /// // Half way through the motion.
    /// let t = s.sweep("time", [3.5], &["lift"])?;
    /// assert!((t.columns[0].values[0] - 0.45).abs() < 1e-15);
    /// # Ok(())
    /// # }
    /// ```
    pub fn sweep<M: AsRef<str>>(
        &mut self,
        along: &str,
        places: impl IntoIterator<Item = impl Borrow<f64>>,
        measures: impl IntoIterator<Item = M>,
    ) -> Result<Sweep, Error> {
        self.sweep_with(along, places, measures, &mut Silent)
    }

    /// As [`sweep`](Self::sweep); `progress` hears how far it has come and may stop it.
    ///
    /// # Errors
    ///
    /// As there, and `stopped` before the first row.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// use kempe::{Done, Stage, linspace};
    /// use std::ops::ControlFlow::{Break, Continue};
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// let mut ten = |_: Stage, done: Done| match done {
    ///     Done::Of(rows, _) if rows >= 10 => Break(()),
    ///     _ => Continue(()),
    /// };
    /// let t = s.sweep_with("lift", linspace(0.38, 0.52, 1000), &["y(M)"], &mut ten)?;
    /// assert!(t.interrupted() && t.rows() == 10);
    /// # Ok(())
    /// # }
    /// ```
    pub fn sweep_with<M: AsRef<str>>(
        &mut self,
        along: &str,
        places: impl IntoIterator<Item = impl Borrow<f64>>,
        measures: impl IntoIterator<Item = M>,
        progress: &mut dyn Progress,
    ) -> Result<Sweep, Error> {
        let way = Way::named(&self.compiled, along)?;
        let places: Vec<f64> = places.into_iter().map(|p| *p.borrow()).collect();
        let asked = self.quantities(measures)?;
        let range = extent(&self.compiled, &places)?;
        let motion = self.motion_over(way, range, progress)?;
        rows(&self.compiled, &motion, way, &places, &asked, progress)
    }

    /// As [`sweep_with`](Self::sweep_with) from a pose on: one drive moves, and the others stay where the pose has them.
    ///
    /// # Errors
    ///
    /// As there; `another-design` when parameters were set since the pose was found.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/luffing-crane.toml");
    /// # let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// # let drive = s.compiled().drives().next().unwrap().to_owned();
    /// let p = s.start()?;
    /// let here = p.coordinate(&drive)?;
    /// let t = s.sweep_from(&p, &drive, [here], &[&drive], &mut kempe::Silent)?;
    /// assert_eq!(t.columns[0].values, [here]);
    /// # Ok(())
    /// # }
    /// ```
    pub fn sweep_from<M: AsRef<str>>(
        &self,
        pose: &Pose,
        drive: &str,
        places: impl IntoIterator<Item = impl Borrow<f64>>,
        measures: impl IntoIterator<Item = M>,
        progress: &mut dyn Progress,
    ) -> Result<Sweep, Error> {
        self.of_this_design(pose)?;
        let drive = self.compiled.drive(drive)?.index();
        let places: Vec<f64> = places.into_iter().map(|p| *p.borrow()).collect();
        let asked = self.quantities(measures)?;
        let range = extent(&self.compiled, &places)?;
        let motion = self.motion_from(pose, drive, range, progress)?;
        rows(
            &self.compiled,
            &motion,
            Way::Drive(drive),
            &places,
            &asked,
            progress,
        )
    }
}

/// Rows of a motion along a way.
pub(crate) fn rows(
    compiled: &Compiled,
    motion: &Arc<Motion>,
    way: Way,
    places: &[f64],
    asked: &Asked,
    progress: &mut dyn Progress,
) -> Result<Sweep, Error> {
    let (mechanism, units) = (motion.mechanism(), compiled.units());
    let quantities: Vec<_> = asked.quantities.iter().collect();
    let forces = asked.any_forces();
    let rows = way.rows(places);
    let mut along = along(compiled, motion, &rows, asked, progress)?;
    let (name, dimension) = way.places(compiled);
    let column = |heading: Heading| Block::new(heading, places.len());
    let mut sweep = Sweep {
        along: column(Heading::new(name, dimension, units)),
        time: column(Heading::new("time", Dimension::TIME, units)),
        columns: (quantities.iter())
            .map(|q| column(Heading::of(q, units)))
            .collect(),
        closure: Vec::with_capacity(places.len()),
        smallest_singular_value: Vec::with_capacity(places.len()),
        forces: forces.then(ForceColumns::default),
        notes: Vec::with_capacity(places.len()),
        warnings: along.number_warnings(None, &quantities),
        asked: places.len(),
    };
    for (done, place) in places.iter().enumerate() {
        sweep.along.values.push(*place);
        match beyond(motion, way, *place) {
            Some(reason) => sweep.push_unreached(reason),
            None => {
                let mut row = along.row(rows[done]);
                let note = row.note(mechanism);
                asked.without_time(&mut row.sample);
                sweep.push(row, note);
            }
        }
        if progress
            .reached(Stage::Rows, Done::Of(done + 1, places.len()))
            .is_break()
        {
            break;
        }
    }
    Ok(sweep)
}

/// What gives the rows of a motion.
fn along(
    compiled: &Compiled,
    motion: &Arc<Motion>,
    rows: &[RowPlace],
    asked: &Asked,
    progress: &mut dyn Progress,
) -> Result<Along, Error> {
    let quantities: Vec<_> = asked.quantities.iter().collect();
    let (model, forces) = (&motion.mechanism().model, asked.any_forces());
    Along::with_progress(model, motion, &quantities, forces, rows, progress)
        .map_err(|diagnostics| compiled.errors(diagnostics))
}

/// Why there is no row at a place that lies beyond the laws of drives.
fn beyond(motion: &Motion, way: Way, place: f64) -> Option<String> {
    let refused = match way {
        Way::Time => on_the_motion(&motion.design, place).err(),
        Way::Drive(_) => None,
    };
    refused.map(|diagnostic| format!("not reached: {}", diagnostic.message))
}

/// Measures at places of a motion without the evidence of the rows: by place their values, or why some of them are missing.
pub(crate) fn values(
    compiled: &Compiled,
    motion: &Arc<Motion>,
    way: Way,
    places: &[f64],
    asked: &Asked,
) -> Result<Vec<Valued>, Error> {
    let rows = way.rows(places);
    let mut along = along(compiled, motion, &rows, asked, &mut Silent)?;
    let timed = asked.timed.contains(&true);
    let valued = rows.iter().zip(places).map(|(row, place)| {
        if let Some(reason) = beyond(motion, way, *place) {
            let values = vec![f64::NAN; asked.quantities.len()];
            let reason = Some(reason);
            return Valued { values, reason };
        }
        if !timed || along.time_at(*row).is_finite() {
            let values = along.values(*row);
            if !values.iter().any(|value| value.is_nan()) {
                let reason = None;
                return Valued { values, reason };
            }
        }
        // The row with all that is known of it says what is wrong.
        let mut whole = along.row(*row);
        let note = whole.note(motion.mechanism());
        asked.without_time(&mut whole.sample);
        let sample = whole.sample;
        let names = asked
            .quantities
            .iter()
            .map(|quantity| quantity.name.as_str());
        let lacks = without_value(names, &sample);
        let reached = sample.closure.is_finite();
        Valued {
            reason: note.filter(|_| lacks.is_some() || !reached).or(lacks),
            values: sample.values,
        }
    });
    Ok(valued.collect())
}

/// Values at a place, and why some are missing.
pub(crate) struct Valued {
    pub values: Vec<f64>,
    pub reason: Option<String>,
}

impl Sweep {
    fn push_unreached(&mut self, reason: String) {
        let evidence = [&mut self.closure, &mut self.smallest_singular_value];
        let blocks = self.columns.iter_mut().chain([&mut self.time]);
        let columns = blocks.map(|block| &mut block.values).chain(evidence);
        columns.for_each(|column| column.push(f64::NAN));
        if let Some(forces) = &mut self.forces {
            forces.route_difference.push(f64::NAN);
            forces.residual.push(f64::NAN);
            forces.condition.push(f64::NAN);
        }
        self.notes.push(Some(reason));
    }

    fn push(&mut self, row: kempe_study::Row, note: Option<String>) {
        let sample = row.sample;
        let note = note.or_else(|| without_value(self.columns.iter().map(Block::name), &sample));
        self.time.values.push(sample.time);
        for (column, value) in self.columns.iter_mut().zip(&sample.values) {
            column.values.push(*value);
        }
        self.closure.push(sample.closure);
        self.smallest_singular_value
            .push(sample.smallest_singular_value);
        if let Some(columns) = &mut self.forces {
            let evidence = row.forces.and_then(|f| f.evidence);
            let of = |f: fn(&kempe_dynamics::ForceEvidence) -> f64| {
                evidence.as_ref().map_or(f64::NAN, f)
            };
            columns.route_difference.push(of(|e| e.route_difference));
            columns.residual.push(of(|e| e.residual));
            columns.condition.push(of(|e| e.condition));
        }
        self.notes.push(note);
    }
}

impl Asked {
    /// Where no law passes a place, what asks for time has no value.
    pub(crate) fn without_time(&self, sample: &mut Sample) {
        if sample.time.is_finite() {
            return;
        }
        let values = sample.values.iter_mut().zip(&self.timed);
        for (value, _) in values.filter(|(_, timed)| **timed) {
            *value = f64::NAN;
        }
    }
}

/// Which measures of these names have no value at a row, and why.
fn without_value<'n>(names: impl Iterator<Item = &'n str>, sample: &Sample) -> Option<String> {
    let both = names.zip(&sample.values);
    let lacking = both.filter(|(_, value)| value.is_nan());
    let names: Vec<&str> = lacking.map(|(name, _)| name).collect();
    (!names.is_empty()).then(|| no_value(&names.join(", "), sample.time))
}
