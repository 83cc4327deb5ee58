//! How measures change with the parameters, in the units of the file.

use std::fmt::Write as _;

use kempe_measure::Held;
use kempe_model::{Diagnostic, Model, ParameterId};
use kempe_motion::drive_path::DrivePath;
use kempe_units::{Dimension, Unit, format_digits};
use serde::Serialize;

use crate::along::force_problems;
use crate::motion_findings::motion_findings;
use crate::number_notes::number_notes;
use crate::pose::Setting;
use crate::prepared::{design, motion};
use crate::unit::Units;
use kempe_motion::progress::Progress;

/// Digits that the text shows.
const DIGITS: usize = 8;

/// Derivatives of the model's measures to its parameters at one place.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivities {
    /// Where, such as `motor = 30 deg`.
    pub place: String,
    /// One entry for each measure that has a value.
    pub measures: Vec<MeasureSensitivity>,
    /// Measures left out, with the reason.
    pub left_out: Vec<(String, String)>,
    /// What is to be told of the mechanism and its motion.
    pub diagnostics: Vec<Diagnostic>,
}

/// A measure with its derivatives.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureSensitivity {
    /// Its name.
    pub name: String,
    /// Its value, in `unit`.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// Derivatives, one for each parameter.
    pub derivatives: Vec<Derivative>,
}

/// A derivative to a parameter; the drive's place is held.
#[derive(Clone, Debug, Serialize)]
pub struct Derivative {
    /// The parameter.
    pub parameter: String,
    /// The derivative, in `unit`; NaN (null in JSON) where there is none.
    pub value: f64,
    /// Where there is none because the measure changes otherwise as the parameter grows than as it shrinks: both, in `unit`, if they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sides: Option<[f64; 2]>,
    /// Unit of the derivative, such as `deg/mm`.
    pub unit: String,
}

/// Differentiates every measure of the model to every parameter, exactly, at the place of `setting`: a coordinate of the
/// moving drive or a time, the start without one.
///
/// # Errors
///
/// `nothing-to-differentiate` without measures or parameters, `not-the-path` when the setting is of another drive than
/// the one that moves alone, `not-reached`; and what keeps the motion from starting.
pub fn sensitivities(
    model: &Model,
    setting: Option<&Setting>,
    progress: &mut dyn Progress,
) -> Result<Sensitivities, Vec<Diagnostic>> {
    let measures =
        "name what is asked for: [measures] with a line such as swing = \"angle(rocker)\"";
    let parameters = "name what it depends on: [parameters] with a line such as a = \"20 mm\", and \"a\" where it is used";
    let lacks = match (model.measures.is_empty(), model.parameters.is_empty()) {
        (true, true) => Some((
            "no [measures] and no [parameters]",
            format!("{measures}; and {parameters}"),
        )),
        (true, false) => Some(("no [measures]", measures.to_owned())),
        (false, true) => Some(("no [parameters]", parameters.to_owned())),
        (false, false) => None,
    };
    if let Some((lacks, help)) = lacks {
        let message =
            format!("sensitivities are those of [measures] to [parameters]: the file has {lacks}");
        return Err(vec![
            Diagnostic::error("nothing-to-differentiate", message).help(help),
        ]);
    }
    let design = design(model);
    let motion = motion(&design, progress)?;
    let units = Units::of(model);
    let drive = match motion.path {
        DrivePath::Coordinate { drive, .. } => model.drives.get(drive),
        DrivePath::Time { .. } => None,
    };
    let path_name = drive.map_or("time", |d| d.name.as_str());
    let held = match setting {
        None => Held::Path(motion.start),
        Some(setting) if setting.name == "time" => Held::Time(setting.value),
        Some(setting) if setting.name == path_name => Held::Path(setting.value),
        Some(setting) => {
            let diagnostic = Diagnostic::error(
                "not-the-path",
                format!("`{}` does not move the mechanism alone", setting.name),
            );
            return Err(vec![
                diagnostic.help(format!("give a place of `{path_name}`")),
            ]);
        }
    };
    let ids: Vec<ParameterId> = (0..model.parameters.len() as u32)
        .map(ParameterId)
        .collect();
    let is_settled = |id: &ParameterId| model.settled_by(*id).is_some();
    let settled: Vec<ParameterId> = ids.iter().copied().filter(is_settled).collect();
    let mut left_out = Vec::new();
    let mut asked: Vec<_> = model.measures.iter().collect();
    let found = loop {
        let measures: Vec<_> = asked.iter().map(|m| &m.measure).collect();
        let found = if asked.iter().any(|m| m.needs_forces) {
            match kempe_dynamics::sensitivities(&motion, held, &measures, &ids) {
                Ok(found) => Ok(found),
                Err(error) => Err(error.unmeasurable().map_err(force_problems)?),
            }
        } else {
            kempe_measure::sensitivities(&motion, held, &measures, &ids)
        };
        match found {
            Ok(found) => break found,
            Err(problems) => {
                // From the last on, so that the places before stay.
                for problem in problems.iter().rev() {
                    let measure = asked.remove(problem.index);
                    left_out.insert(0, (measure.name.clone(), problem.reason.to_string()));
                }
            }
        }
    };
    let (name, at, dimension) = match (held, drive) {
        (Held::Path(_), Some(drive)) => (path_name, found.parameter, drive.dimension),
        _ => ("time", found.time, Dimension::TIME),
    };
    let place = format!("{name} = {}", units.text(at, dimension));
    if !motion.covers(found.parameter) {
        let reached = motion.reached();
        let place = format!("{name} = {}", units.place_text(at, dimension, reached));
        let along = drive.map_or(Dimension::TIME, |d| d.dimension);
        let range = units.range_text(reached, along);
        let diagnostic =
            Diagnostic::error("not-reached", format!("the motion does not reach {place}"));
        return Err(vec![diagnostic.note(format!("it goes from {range}"))]);
    }
    let rows = asked
        .iter()
        .zip(found.values.iter().zip(&found.derivatives));
    let measures = rows
        .enumerate()
        .filter_map(|(index, (named, (value, slopes)))| {
            let unit = units.of_measure(&named.measure, named.dimension);
            if !value.is_finite() {
                left_out.push((named.name.clone(), "it has no finite value here".to_owned()));
                return None;
            }
            let derivatives = model.parameters.iter().zip(slopes).enumerate().map(
                |(which, (parameter, slope))| {
                    let per = units.unit(parameter.dimension);
                    let shown = |slope: f64| unit.from_si(slope) * per.to_si(1.0);
                    let mut sides = found.one_sided.iter();
                    let side = sides.find(|it| (it.measure, it.parameter) == (index, which));
                    let side = side.filter(|it| it.slope.is_finite() && it.other.is_finite());
                    let is_settled = named.needs_forces && settled.contains(&ids[which]);
                    Derivative {
                        parameter: parameter.name.clone(),
                        value: if is_settled { f64::NAN } else { shown(*slope) },
                        sides: side.map(|it| [it.slope, it.other].map(shown)),
                        unit: unit_per(&unit, &per),
                    }
                },
            );
            Some(MeasureSensitivity {
                name: named.name.clone(),
                value: unit.from_si(*value),
                unit: unit.text().to_owned(),
                derivatives: derivatives.collect(),
            })
        });
    let measures = measures.collect();
    let mut diagnostics = motion_findings(&motion);
    let numbers = asked.iter().zip(found.notes);
    let numbers = numbers.map(|(named, notes)| (named.name.as_str(), notes));
    diagnostics.extend(number_notes(None, &motion, numbers));
    if asked.iter().any(|named| named.needs_forces) {
        diagnostics.extend(settled.iter().map(|id| of_settled(model, *id)));
    }
    Ok(Sensitivities {
        place,
        measures,
        left_out,
        diagnostics,
    })
}

/// Why forces have no derivative to a parameter.
fn of_settled(model: &Model, id: ParameterId) -> Diagnostic {
    let parameter = &model.parameters[id.index()];
    let message = format!(
        "how forces change with `{}` is not known: the period of a table depends on it",
        parameter.name
    );
    Diagnostic::warning("settled-parameter", message)
        .at(parameter.span.clone(), "")
        .help("compare files with two values of it: --set tells them apart")
}

/// The unit of a derivative, such as `deg/mm`.
pub(crate) fn unit_per(unit: &Unit, per: &Unit) -> String {
    match (unit.text(), per.text()) {
        (own, "") => own.to_owned(),
        (own, per) => {
            let own = if own.is_empty() { "1" } else { own };
            match per.contains([' ', '/']) {
                true => format!("{own}/({per})"),
                false => format!("{own}/{per}"),
            }
        }
    }
}

impl Sensitivities {
    /// The derivatives as plain text.
    pub fn to_text(&self) -> String {
        let one = kempe_units::Unit::one();
        let number = |x: f64| match x.is_finite() {
            true => format_digits(x, &one, DIGITS),
            false => "none here".to_owned(),
        };
        let mut out = format!("At {}\n", self.place);
        for measure in &self.measures {
            let _ = writeln!(
                out,
                "\n{} = {} {}",
                measure.name,
                number(measure.value),
                measure.unit
            );
            let width = measure
                .derivatives
                .iter()
                .map(|d| d.parameter.chars().count());
            let width = width.max().unwrap_or(0);
            for d in &measure.derivatives {
                let value = match d.sides {
                    None => format!("{} {}", number(d.value), d.unit),
                    Some([grows, shrinks]) => format!(
                        "{} {} as it grows, {} as it shrinks",
                        number(grows),
                        d.unit,
                        number(shrinks)
                    ),
                };
                let line = format!("  per {:width$}  {value}", d.parameter);
                let _ = writeln!(out, "{}", line.trim_end());
            }
        }
        for (name, reason) in &self.left_out {
            let _ = writeln!(out, "\n{name}: left out, {reason}");
        }
        out
    }
}
