//! One pose at given coordinates of the drives, reached from the start without leaving the branch.

use kempe_measure::CLOSURE_LIMIT;
use kempe_mechanism::Mechanism;
use kempe_model::{Diagnostic, Law, LawPiece, Model, MotionStudy, RiseLaw, Rows, Severity};
use kempe_motion::Silent;
use kempe_motion::temporary_drives::hold;
use kempe_units::{Dimension, Expr, Issue, Resolver, Span, check_as, nearest, parse};

use crate::along::{Along, Row};
use crate::findings_forces::nothing_acts;
use crate::missing::open_pose;
use crate::motion_findings::motion_findings;
use crate::prepared::{design, motion};
use crate::result::Frame;
use crate::rows::RowPlace;
use crate::run_motion::run_motion;
use crate::slot_ends::MOVE_ENDS;
use crate::unit::Units;

/// Where to look: a drive's coordinate, or a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// A drive, or `time`.
    pub name: String,
    /// SI.
    pub value: f64,
    /// As written, such as `motor=30deg`.
    pub text: String,
}

/// Names stand for nothing in a setting.
struct NoNames;

impl Resolver<()> for NoNames {
    fn name(&mut self, name: &str, span: Span) -> Result<((), Dimension), Issue> {
        Err(Issue::unknown_name(name, span, []))
    }
}

/// How far beyond the end a time may lie and still be the end, in parts of the duration.
const SAME_TIME: f64 = 1e-9;

/// A diagnostic that points into the text of a setting.
fn pointing(
    diagnostic: Diagnostic,
    text: &str,
    span: Span,
    label: impl Into<String>,
) -> Diagnostic {
    let before = diagnostic.labels.len();
    let mut diagnostic = diagnostic.at(span, label.into());
    for label in diagnostic.labels.iter_mut().skip(before) {
        label.source = Some(kempe_model::Source {
            name: "--at".to_owned(),
            text: text.to_owned(),
        });
    }
    diagnostic
}

impl Setting {
    /// A setting of a drive or of `time`, SI.
    pub fn new(name: &str, value: f64) -> Self {
        Self {
            name: name.to_owned(),
            value,
            text: format!("{name}={value}"),
        }
    }

    /// Reads settings that hold together: each drive once, or the time alone.
    ///
    /// # Errors
    ///
    /// Those of [`Setting::parse`]; `over-specified` where a drive is set twice, or a drive and the time.
    pub fn all<'t>(
        model: &Model,
        texts: impl Iterator<Item = &'t str>,
    ) -> Result<Vec<Self>, Diagnostic> {
        let mut known: Vec<Self> = Vec::new();
        for text in texts {
            let setting = Self::parse(model, text)?;
            let timed = |s: &Self| s.name == "time";
            let clash =
                (known.iter()).find(|s| s.name == setting.name || timed(s) || timed(&setting));
            if let Some(other) = clash {
                let (message, help) = if other.name == setting.name {
                    (
                        format!("`{}` is set twice", setting.name),
                        "leave one of them out",
                    )
                } else {
                    (
                        "a time and a drive are set: a time says where every drive stands"
                            .to_owned(),
                        "give the time, or places of the drives",
                    )
                };
                let diagnostic = Diagnostic::error("over-specified", message).help(help);
                let diagnostic = pointing(diagnostic, text, 0..text.len(), "");
                return Err(pointing(diagnostic, &other.text, 0..other.text.len(), ""));
            }
            known.push(setting);
        }
        Ok(known)
    }

    /// Reads `motor=30deg`, `lift = 400 mm` or `time=2s`; a bare number is in the file's unit.
    ///
    /// # Errors
    ///
    /// `unknown-name` for a drive that is not there, what is wrong with the value, and `not-on-the-motion` for a time
    /// before its start or after its end, labelled in `text`.
    pub fn parse(model: &Model, text: &str) -> Result<Self, Diagnostic> {
        let source = |d: Diagnostic, span: Span, label: String| pointing(d, text, span, label);
        let Some((name, number)) = text.split_once('=') else {
            let diagnostic =
                Diagnostic::error("syntax", "a drive and its coordinate were expected");
            return Err(source(diagnostic, 0..text.len(), String::new()).help("write motor=30deg"));
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
                let diagnostic =
                    Diagnostic::error("unknown-name", format!("there is no drive `{name}`"));
                return Err(source(diagnostic, 0..name.len(), String::new()).help(help));
            }
        };
        let unit = Units::of(model).unit(dimension);
        let checked =
            parse(number).and_then(|tree| check_as(&tree, &mut NoNames, dimension, &unit));
        match checked {
            Ok((expr, _)) => {
                let value = expr.eval(&mut |()| f64::NAN);
                if !value.is_finite() {
                    let diagnostic = Diagnostic::error("not-finite", "this value is not finite");
                    let diagnostic = diagnostic.help("look for a division by zero or an overflow");
                    return Err(source(diagnostic, offset..text.len(), String::new()));
                }
                if name == "time"
                    && let Some(diagnostic) = off_the_motion(model, value)
                {
                    return Err(source(diagnostic, offset..text.len(), String::new()));
                }
                Ok(Self {
                    name: name.to_owned(),
                    value,
                    text: text.to_owned(),
                })
            }
            Err(issues) => {
                let mut diagnostic = Diagnostic::error("syntax", "the value cannot be read");
                if let Some(issue) = issues.into_iter().next() {
                    let span = issue.span.start + offset..issue.span.end + offset;
                    diagnostic =
                        Diagnostic::error(issue.code, issue.message).maybe_help(issue.help);
                    diagnostic = source(diagnostic, span, issue.label);
                }
                Err(diagnostic)
            }
        }
    }
}

/// Why a time is not on the motion, if it is not.
fn off_the_motion(model: &Model, time: f64) -> Option<Diagnostic> {
    let parameters: Vec<f64> = model.parameter_values();
    let durations = model.drives.iter().map(|d| d.law.duration(&parameters));
    let duration = durations.fold(0.0, f64::max);
    if (0.0..=duration * (1.0 + SAME_TIME)).contains(&time) {
        return None;
    }
    let units = Units::of(model);
    let [time, duration] = units.texts([time, duration], Dimension::TIME);
    let message = format!("the motion does not pass {time}: it goes from 0 s to {duration}");
    Some(Diagnostic::error("not-on-the-motion", message).help("give a time between these"))
}

/// What keeps the drives from going to a place, told of the place that was asked for.
fn at_the_settings(diagnostics: Vec<Diagnostic>, settings: &[Setting]) -> Vec<Diagnostic> {
    let of_the_way = |d: &Diagnostic| {
        [
            "range-beyond-limit",
            "range-too-long",
            "motion-runs-away",
            "motion-stuck",
        ]
        .contains(&d.code)
    };
    let moved = diagnostics.into_iter().map(|mut d| {
        if !of_the_way(&d) || settings.is_empty() {
            return d;
        }
        d.severity = Severity::Error;
        d.labels.clear();
        settings.iter().fold(d, |d, setting| {
            pointing(d, &setting.text, 0..setting.text.len(), "")
        })
    });
    moved.collect()
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
        _ => format!("are {}", crate::words::list(&names)),
    }
}

/// The pose with the drives at the given coordinates; drives that are not named stay at their start.
///
/// The drives go there from their start, all at once, so that the branch is that of the motion.
///
/// # Errors
///
/// Those of [`run`](crate::run); `range-beyond-limit` when the place cannot be reached.
pub fn pose_at(model: &Model, settings: &[Setting]) -> Result<ShownPose, Vec<Diagnostic>> {
    let parameters: Vec<f64> = model.parameter_values();
    let units = Units::of(model);
    let held;
    let model = match with_held(model, &parameters) {
        Some(with_drives) => {
            held = with_drives;
            &held
        }
        None => model,
    };
    let mut moved = model.clone();
    moved.measures.clear();
    let study = |rows| MotionStudy {
        rows,
        columns: Vec::new(),
        plots: Vec::new(),
        circuit: false,
    };
    if let Some(time) = settings.iter().find(|s| s.name == "time") {
        return pose_at_time(model, time.value);
    }
    let mut label: Vec<String> = Vec::new();
    for drive in &mut moved.drives {
        let from = drive.law.at(0.0, &parameters);
        let own = settings.iter().find(|s| s.name == drive.name);
        let target = own.map_or(from, |s| s.value);
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
    let result = run_motion(&moved, "pose", &study(Rows::Count(2)), &mut Silent)
        .map_err(|diagnostics| at_the_settings(diagnostics, settings))?;
    let last = result.frames.into_iter().next_back();
    let reached = result.table.closure.last().is_some_and(|c| c.is_finite());
    match last {
        Some(frame) if reached => Ok(ShownPose {
            frame,
            label: label.join(", "),
            diagnostics: result.diagnostics,
        }),
        _ => Err(at_the_settings(result.diagnostics, settings)),
    }
}

/// Where the drives stand at the start: `motor = 30 deg`.
fn start_text(model: &Model, units: &Units) -> String {
    let parameters: Vec<f64> = model.parameter_values();
    let places = model.drives.iter().map(|drive| {
        let start = drive.law.at(0.0, &parameters);
        format!("{} = {}", drive.name, units.text(start, drive.dimension))
    });
    places.collect::<Vec<_>>().join(", ")
}

/// The model with its missing drives held, where it lacks some and a pose was found.
fn with_held(model: &Model, parameters: &[f64]) -> Option<Model> {
    let mechanism = Mechanism::new(model);
    let lacks = model.drives.is_empty() || !mechanism.plan.decomposition.undetermined.is_empty();
    let held = lacks.then(|| hold(&mechanism, parameters, &mut Silent))??;
    Some(held.model)
}

/// The pose of the motion at a time, s.
fn pose_at_time(model: &Model, time: f64) -> Result<ShownPose, Vec<Diagnostic>> {
    let label = format!("time = {}", Units::of(model).text(time, Dimension::TIME));
    on_motion(model, &|_| Ok(RowPlace::Time(time)), false, &label)
}

/// A pose to be shown.
#[derive(Clone, Debug)]
pub struct ShownPose {
    /// The pose and, where forces were asked for, what acts in it.
    pub frame: Frame,
    /// Where it is.
    pub label: String,
    /// What is to be told about the mechanism, and about the forces there.
    pub diagnostics: Vec<Diagnostic>,
}

/// The forces of the motion at a coordinate of the drive that moves, or at a time; at the start when nothing is said.
///
/// Forces depend on speeds, so only places of the motion have them: the first time that it passes.
///
/// # Errors
///
/// Those of [`run`](crate::run); `not-reached` and `not-on-the-motion` when the motion does not come there.
pub fn loaded_at(model: &Model, settings: &[Setting]) -> Result<ShownPose, Vec<Diagnostic>> {
    let units = Units::of(model);
    let label = match settings {
        [] => start_text(model, &units),
        [one] => {
            let drive = model.drives.iter().find(|d| d.name == one.name);
            let dimension = drive.map_or(Dimension::TIME, |d| d.dimension);
            format!("{} = {}", one.name, units.text(one.value, dimension))
        }
        _ => return Err(vec![not_on_motion(model)]),
    };
    let place = |along: &Along| match settings {
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
    let mut loaded = on_motion(model, &place, true, &label)?;
    loaded.diagnostics.extend(nothing_acts(model));
    Ok(loaded)
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
    place: &dyn Fn(&Along) -> Result<RowPlace, Vec<Diagnostic>>,
    forces: bool,
    label: &str,
) -> Result<ShownPose, Vec<Diagnostic>> {
    let design = design(model);
    let motion = motion(&design, &mut Silent)?;
    let mut along = Along::new(model, &motion, &[], forces)?;
    let at = place(&along)?;
    let Row {
        sample,
        forces,
        slots,
    } = along.row(at);
    if !sample.closure.is_finite() {
        let reason = sample.note.map_or_else(
            || "no pose was found".to_owned(),
            |note| note.text(motion.mechanism()),
        );
        return Err(vec![Diagnostic::error(
            "not-reached",
            format!("{label}: {reason}"),
        )]);
    }
    let (arrows, notes) = forces.map_or_else(Default::default, |f| (f.arrows, f.notes));
    let mut diagnostics = motion_findings(&motion);
    if sample.closure > CLOSURE_LIMIT {
        diagnostics.push(open_pose(label, sample.closure));
    }
    diagnostics.extend(notes.iter().map(|n| {
        Diagnostic::warning(n.code(), format!("{label}: {}", n.text(&design.mechanism)))
            .help(n.remedy())
    }));
    diagnostics.extend(slots.map(|note| {
        Diagnostic::warning("leaves-slot", format!("{label}: {note}")).help(MOVE_ENDS)
    }));
    Ok(ShownPose {
        frame: Frame {
            links: sample.links,
            points: sample.points,
            rates: sample.rates,
            arrows,
        },
        label: label.to_owned(),
        diagnostics,
    })
}
