//! How measures change with parameters.

use kempe_measure::{Held, Unmeasurable, sensitivities};
use kempe_model::{Diagnostic, ParameterId};
use kempe_motion::drive_path::DrivePath;
use kempe_study::{Progress, Silent, force_problems, number_notes};

use crate::block::Heading;
use crate::way::{Way, on_the_motion};
use crate::{Error, Session};

/// Measures with their derivatives to parameters, SI.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Derivatives {
    /// The measures.
    pub measures: Vec<Heading>,
    /// Their values.
    pub values: Vec<f64>,
    /// The parameters.
    pub parameters: Vec<Heading>,
    /// d(measure)/d(parameter), all parameters of the first measure, then those of the second; NaN where there is none.
    pub derivatives: Vec<f64>,
    /// What is to be told of numbers over the motion among the measures.
    pub warnings: Vec<Diagnostic>,
    /// By measure: why it has no value, or no derivative to some parameter.
    pub notes: Vec<Option<String>>,
}

impl Derivatives {
    /// The derivative of a measure to a parameter, each by its place in what was asked; NaN where there is none.
    pub fn get(&self, measure: usize, parameter: usize) -> f64 {
        let width = self.parameters.len();
        match parameter < width {
            true => (self.derivatives.get(measure * width + parameter)).map_or(f64::NAN, |d| *d),
            false => f64::NAN,
        }
    }
}

impl Session {
    /// Exact derivatives of measures to parameters at the place where the motion starts, which is held; those of numbers over
    /// the motion are the same anywhere. Where a parameter moves the start, [`derivatives_at`](Self::derivatives_at) time 0
    /// goes with it. Parameters built on the one that is varied follow it, unless they were set.
    ///
    /// # Errors
    ///
    /// As [`derivatives_at`](Self::derivatives_at).
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// let lever: kempe::Model = r#"
    ///     [parameters]
    ///     a = "20 mm"
    ///     [links]
    ///     frame = { A = [0, 0] }
    ///     lever = { A-B = "a" }
    ///     [drives]
    ///     hand = { turns = "lever", from = 0, to = 90, speed = "1 rad/s" }
    /// "#.parse()?;
    /// let mut s = lever.compile()?.session();
    /// let j = s.derivatives(&["range(y(B))", "x(B)^2"], &["a"])?;
    /// assert!((j.get(0, 0) - 1.0).abs() < 1e-15);
    /// assert!((j.get(1, 0) - 0.04).abs() < 1e-16);
    /// # Ok(())
    /// # }
    /// ```
    pub fn derivatives<M: AsRef<str>, P: AsRef<str>>(
        &mut self,
        measures: impl IntoIterator<Item = M>,
        parameters: impl IntoIterator<Item = P>,
    ) -> Result<Derivatives, Error> {
        self.differentiate(None, measures, parameters, &mut Silent)
    }

    /// As [`derivatives`](Self::derivatives), and as [`derivatives_at`](Self::derivatives_at) where `at` names a drive (or
    /// `time`) and a place; `progress` hears how far the motion has come and may stop it.
    ///
    /// # Errors
    ///
    /// As there, and `stopped`.
    pub fn derivatives_with<M: AsRef<str>, P: AsRef<str>>(
        &mut self,
        at: Option<(&str, f64)>,
        measures: impl IntoIterator<Item = M>,
        parameters: impl IntoIterator<Item = P>,
        progress: &mut dyn Progress,
    ) -> Result<Derivatives, Error> {
        let place = match at {
            Some((along, place)) => Some((Way::named(&self.compiled, along)?, place)),
            None => None,
        };
        self.differentiate(place, measures, parameters, progress)
    }

    /// Exact derivatives at a place of the drive that moves (its coordinate is held, SI) or at a `time` (held, s).
    ///
    /// # Errors
    ///
    /// `unknown-name` and what is wrong with a measure, what is wrong with what acts, `not-the-path` for a drive that does not
    /// move alone, `not-reached`, `not-on-the-motion`, and why the motion cannot start.
    ///
    /// # Example
    ///
    /// ```
    /// # fn main() -> Result<(), kempe::Error> {
    /// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/seeds/tractor-hitch.toml");
    /// let mut s = kempe::Model::from_path(path)?.compile()?.session();
    /// // The piston's force of massless links grows with the weight as the transfer function says.
    /// let j = s.derivatives_at("lift", 0.45, &["push"], &["weight"])?;
    /// assert!((j.get(0, 0) - 4.183_850_347_69).abs() < 1e-11);
    /// // Forces have derivatives as well: those of new designs.
    /// let j = s.derivatives_at("lift", 0.45, &["force(lift)"], &["weight"])?;
    /// let weight = s.value("weight")?;
    /// let mut force = |weight: f64| -> Result<f64, kempe::Error> {
    ///     s.set("weight", weight)?;
    ///     Ok(s.sweep("lift", [0.45], ["force(lift)"])?.columns[0].values[0])
    /// };
    /// let difference = (force(weight + 1.0)? - force(weight - 1.0)?) / 2.0;
    /// assert!((j.get(0, 0) / difference - 1.0).abs() < 1e-9);
    /// # Ok(())
    /// # }
    /// ```
    pub fn derivatives_at<M: AsRef<str>, P: AsRef<str>>(
        &mut self,
        along: &str,
        place: f64,
        measures: impl IntoIterator<Item = M>,
        parameters: impl IntoIterator<Item = P>,
    ) -> Result<Derivatives, Error> {
        let way = Way::named(&self.compiled, along)?;
        self.differentiate(Some((way, place)), measures, parameters, &mut Silent)
    }

    fn differentiate<M: AsRef<str>, P: AsRef<str>>(
        &mut self,
        place: Option<(Way, f64)>,
        measures: impl IntoIterator<Item = M>,
        parameters: impl IntoIterator<Item = P>,
        progress: &mut dyn Progress,
    ) -> Result<Derivatives, Error> {
        let asked = self.quantities(measures)?;
        let ids = (parameters.into_iter())
            .map(|name| self.compiled.parameter(name.as_ref()))
            .collect::<Result<Vec<ParameterId>, Error>>()?;
        for id in &ids {
            self.may_be_set(*id)?;
        }
        let motion = self.known_motion(progress)?;
        let held = match (place, &motion.path) {
            (None, _) => Held::Path(motion.start),
            (Some((Way::Time, time)), _) => {
                on_the_motion(&self.design, time)
                    .map_err(|diagnostic| self.compiled.error(diagnostic))?;
                Held::Time(time)
            }
            (Some((Way::Drive(drive), at)), DrivePath::Coordinate { drive: own, .. })
                if drive == *own =>
            {
                Held::Path(at)
            }
            (Some((way, _)), _) => {
                let (name, _) = way.places(&self.compiled);
                let message = format!("`{name}` does not move the mechanism alone");
                let diagnostic = Diagnostic::error("not-the-path", message);
                return Err(self.compiled.error(diagnostic.help("give a time")));
            }
        };
        let wanted: Vec<_> = asked.quantities.iter().map(|q| &q.measure).collect();
        let unmeasurable = |problems: Vec<Unmeasurable>| {
            let diagnostic = problems.iter().map(|problem| {
                let name = &asked.quantities[problem.index].name;
                let message = format!("`{name}` cannot be evaluated: {}", problem.reason);
                Diagnostic::error("not-measurable", message)
            });
            self.compiled.errors(diagnostic.collect())
        };
        let found = if asked.any_forces() {
            kempe_dynamics::sensitivities(&motion, held, &wanted, &ids).map_err(
                |error| match error.unmeasurable() {
                    Ok(list) => unmeasurable(list),
                    Err(problems) => self.compiled.errors(force_problems(problems)),
                },
            )?
        } else {
            sensitivities(&motion, held, &wanted, &ids).map_err(unmeasurable)?
        };
        let units = self.compiled.units();
        if !motion.covers(found.parameter) {
            let (name, dimension) = match motion.path {
                DrivePath::Coordinate { drive, .. } => Way::Drive(drive),
                DrivePath::Time { .. } => Way::Time,
            }
            .places(&self.compiled);
            let reached = motion.reached();
            let place = units.place_text(found.parameter, dimension, reached);
            let message = format!("the motion does not reach {name} = {place}");
            let range = units.range_text(reached, dimension);
            let diagnostic = Diagnostic::error("not-reached", message);
            let diagnostic = diagnostic.help(format!("it goes from {range}"));
            return Err(self.compiled.error(diagnostic));
        }
        let declared = &self.compiled.data().parameters;
        let notes = found.values.iter().zip(&found.derivatives);
        let notes = notes.map(|(value, slopes)| {
            let note = match (value.is_nan(), slopes.iter().all(|d| d.is_finite())) {
                (true, _) => "it has no value here",
                (_, false) => {
                    "it has no derivative here: at limits, and where branches cross, nothing is differentiable"
                }
                _ => return None,
            };
            Some(note.to_owned())
        });
        let numbers = asked.quantities.iter().zip(found.notes);
        let numbers = numbers.map(|(q, notes)| (q.name.as_str(), notes));
        Ok(Derivatives {
            warnings: number_notes(None, &motion, numbers),
            notes: notes.collect(),
            measures: (asked.quantities.iter())
                .map(|q| Heading::of(q, units))
                .collect(),
            parameters: (ids.iter().map(|id| &declared[id.index()]))
                .map(|p| Heading::new(&p.name, p.dimension, units))
                .collect(),
            derivatives: (found.derivatives.iter().flatten())
                .map(|d| if d.is_finite() { *d } else { f64::NAN })
                .collect(),
            values: found.values,
        })
    }
}
