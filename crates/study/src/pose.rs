//! One pose at given coordinates of the drives, reached from the start without leaving the branch.

use kempe_model::{Diagnostic, Law, LawPiece, Model, MotionStudy, RiseLaw, Rows};
use kempe_units::{Dimension, Expr, Issue, Resolver, Span, check_as, nearest, parse};

use crate::along::{Along, Row};
use crate::motion::run_motion;
use crate::prepared::Prepared;
use crate::progress::Silent;
use crate::result::Frame;
use crate::rows::RowPlace;
use crate::unit::Units;

/// Where to look: a drive's coordinate, or a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// A drive, or `time`.
    pub name: String,
    /// SI.
    pub value: f64,
}

/// Names stand for nothing in a setting.
struct NoNames;

impl Resolver<()> for NoNames {
    fn name(&mut self, name: &str, span: Span) -> Result<((), Dimension), Issue> {
        Err(Issue::unknown_name(name, span, []))
    }
}

impl Setting {
    /// Reads `motor=30deg`, `lift = 400 mm` or `time=2s`; a bare number is in the file's unit.
    ///
    /// # Errors
    ///
    /// `unknown-name` for a drive that is not there, and what is wrong with the value, labelled in `text`.
    pub fn parse(model: &Model, text: &str) -> Result<Self, Diagnostic> {
        let source = |d: Diagnostic, span: Span, label: String| {
            let mut d = d.at(span, label);
            for label in &mut d.labels {
                label.source = Some(kempe_model::Source {
                    name: "--at".to_owned(),
                    text: text.to_owned(),
                });
            }
            d
        };
        let Some((name, number)) = text.split_once('=') else {
            let told = Diagnostic::error("syntax", "a drive and its coordinate were expected");
            return Err(source(told, 0..text.len(), String::new()).help("write motor=30deg"));
        };
        let offset = name.len() + 1;
        let name = name.trim();
        let dimension = match model.drives.iter().find(|d| d.name == name) {
            Some(drive) => drive.dimension,
            None if name == "time" => Dimension::TIME,
            None => {
                let known = model.drives.iter().map(|d| d.name.as_str()).chain(["time"]);
                let help = match nearest(name, known) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("there {}", drives_text(model)),
                };
                let told = Diagnostic::error("unknown-name", format!("there is no drive `{name}`"));
                return Err(source(told, 0..name.len(), String::new()).help(help));
            }
        };
        let unit = Units::of(model).unit(dimension);
        let checked =
            parse(number).and_then(|tree| check_as(&tree, &mut NoNames, dimension, &unit));
        match checked {
            Ok((expr, _)) => Ok(Self {
                name: name.to_owned(),
                value: expr.eval(&mut |()| f64::NAN),
            }),
            Err(issues) => {
                let mut told = Diagnostic::error("syntax", "the value cannot be read");
                if let Some(issue) = issues.into_iter().next() {
                    let span = issue.span.start + offset..issue.span.end + offset;
                    told = Diagnostic::error(issue.code, issue.message).maybe_help(issue.help);
                    told = source(told, span, issue.label);
                }
                Err(told)
            }
        }
    }
}

fn drives_text(model: &Model) -> String {
    let names: Vec<String> = model
        .drives
        .iter()
        .map(|d| format!("`{}`", d.name))
        .collect();
    match names.len() {
        0 => "are no drives".to_owned(),
        1 => format!("is {}", names[0]),
        _ => format!("are {}", crate::explain::list(&names)),
    }
}

/// The pose with the drives at the given coordinates; drives that are not named stay at their start.
///
/// The drives go there from their start, all at once, so that the branch is that of the motion.
///
/// # Errors
///
/// Those of [`run`](crate::run); `range-beyond-limit` when the place cannot be reached.
pub fn pose_at(model: &Model, settings: &[Setting]) -> Result<(Frame, String), Vec<Diagnostic>> {
    let parameters: Vec<f64> = model.parameter_values();
    let units = Units::of(model);
    let mut moved = model.clone();
    moved.measures.clear();
    let study = |rows| MotionStudy {
        rows,
        columns: Vec::new(),
        plots: Vec::new(),
        circuit: false,
    };
    let time = settings.iter().rev().find(|s| s.name == "time");
    if let (Some(time), true) = (time, settings.iter().all(|s| s.name == "time")) {
        return pose_at_time(model, time.value);
    }
    let mut label: Vec<String> = Vec::new();
    for drive in &mut moved.drives {
        let start = drive.law.at(time.map_or(0.0, |t| t.value), &parameters);
        let own = settings.iter().rev().find(|s| s.name == drive.name);
        let target = own.map_or(start, |s| s.value);
        let from = drive.law.at(0.0, &parameters);
        label.push(format!(
            "{} = {}",
            drive.name,
            units.text(target, drive.dimension)
        ));
        let piece = if target == from {
            LawPiece::Dwell {
                duration: Expr::Const(1.0),
            }
        } else {
            LawPiece::Rise {
                to: Expr::Const(target),
                duration: Expr::Const(1.0),
                by: RiseLaw::Polynomial345,
            }
        };
        drive.law = Law {
            pieces: vec![piece],
            from: Expr::Const(from),
        };
    }
    let result = run_motion(&moved, "pose", &study(Rows::Count(2)), &mut Silent)?;
    let last = result.frames.into_iter().next_back();
    let reached = result.table.closure.last().is_some_and(|c| c.is_finite());
    match last {
        Some(frame) if reached => Ok((frame, label.join(", "))),
        _ => Err(result.warnings),
    }
}

/// The pose of the motion at a time, s.
fn pose_at_time(model: &Model, time: f64) -> Result<(Frame, String), Vec<Diagnostic>> {
    let label = format!("time = {}", Units::of(model).text(time, Dimension::TIME));
    let on_motion = on_motion(model, &|_| Ok(RowPlace::Time(time)), false, &label)?;
    Ok((on_motion.frame, label))
}

/// A row of the motion with its forces.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The pose and what acts in it.
    pub frame: Frame,
    /// Where it is.
    pub label: String,
    /// What is to be told about the forces there.
    pub warnings: Vec<Diagnostic>,
}

/// The forces of the motion at a coordinate of the drive that moves, or at a time; at the start when nothing is said.
///
/// Forces depend on speeds, so only places of the motion have them: the first time that it passes.
///
/// # Errors
///
/// Those of [`run`](crate::run); `not-reached` and `not-on-the-motion` when the motion does not come there.
pub fn loaded_at(model: &Model, settings: &[Setting]) -> Result<Loaded, Vec<Diagnostic>> {
    let units = Units::of(model);
    let label = match settings {
        [] => "start".to_owned(),
        [one] => {
            let drive = model.drives.iter().find(|d| d.name == one.name);
            let dimension = drive.map_or(Dimension::TIME, |d| d.dimension);
            format!("{} = {}", one.name, units.text(one.value, dimension))
        }
        _ => return Err(vec![not_on_motion(model)]),
    };
    let place = |along: &Along<'_>| match settings {
        [one] if one.name != "time" => {
            let moving = along.path_drive().and_then(|d| model.drives.get(d.index()));
            if moving.is_some_and(|d| d.name == one.name) {
                Ok(RowPlace::Drive(one.value))
            } else {
                Err(vec![not_on_motion(model)])
            }
        }
        [one] => Ok(RowPlace::Time(one.value)),
        _ => Ok(RowPlace::Time(0.0)),
    };
    on_motion(model, &place, true, &label)
}

fn not_on_motion(model: &Model) -> Diagnostic {
    Diagnostic::error(
        "not-on-the-motion",
        "forces depend on speeds: they are known on the motion, not at any setting of the drives",
    )
    .help(match model.drives.as_slice() {
        [one] => format!("give a place of `{}`, or a time: --at time=0.5s", one.name),
        _ => "several drives move: give a time, --at time=0.5s".to_owned(),
    })
}

/// A row of the motion.
fn on_motion(
    model: &Model,
    place: &dyn Fn(&Along<'_>) -> Result<RowPlace, Vec<Diagnostic>>,
    forces: bool,
    label: &str,
) -> Result<Loaded, Vec<Diagnostic>> {
    let prepared = Prepared::new(model);
    let motion = prepared.motion(&mut Silent)?;
    let mut along = Along::new(model, &motion, &[], forces)?;
    let at = place(&along)?;
    let Row { sample, forces } = along.row(at);
    if !sample.closure.is_finite() {
        let reason = sample
            .note
            .unwrap_or_else(|| "no pose was found".to_owned());
        return Err(vec![Diagnostic::error(
            "not-reached",
            format!("{label}: {reason}"),
        )]);
    }
    let (arrows, notes) = forces.map_or_else(Default::default, |f| (f.arrows, f.notes));
    let warnings = notes.iter().map(|n| {
        Diagnostic::warning(
            n.code(),
            format!("{label}: {}", n.text(&prepared.mechanism)),
        )
    });
    Ok(Loaded {
        frame: Frame {
            links: sample.links,
            points: sample.points,
            arrows,
        },
        label: label.to_owned(),
        warnings: warnings.collect(),
    })
}
