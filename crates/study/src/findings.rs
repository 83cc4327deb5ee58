//! What is to be known of a mechanism before it moves, in the names and units of its file.

use std::cell::OnceCell;

use kempe_mechanism::Design;
use kempe_mechanism::mobility::Mobility;
use kempe_mechanism::structure::BodyId;
use kempe_model::{
    ContactStudy, CoordinateKind, Diagnostic, Drive, DriveKind, Joint, JointKind, Model, Rows,
    Severity, Study, StudyKind, value,
};
use kempe_motion::assemble::Assembly;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Findings, Motion};
use kempe_units::Dimension;
use serde::Serialize;

use crate::adjust::findings_of_adjustment;
use crate::along::not_answerable;
use crate::clearance::{findings_of_clearance, findings_of_contact, refuses};
use crate::designs::{findings_of_optimization, findings_of_sweep, findings_of_tolerance};
use crate::drawn::{self, DrawnLink};
use crate::explain::cannot_move;
use crate::findings_forces::{nothing_acts, on_links};
use crate::group_text::kind_text;
use crate::hints;
use crate::motion_findings::{motion_findings, of_freedoms, of_mechanism};
use crate::prepared::design;
use crate::simulation::findings_of_simulation;
use crate::synthesis::findings_of_synthesis;
use crate::unit::Units;
use crate::vibrations::findings_of_vibrations;
use crate::words::{list, source_name};
use kempe_motion::progress::{Progress, Silent};

/// The answer of `check`.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Title of the mechanism.
    pub title: String,
    /// The links that the file draws, by the distances of their points.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drawn: Vec<DrawnLink>,
    /// Links, the frame included.
    pub links: usize,
    /// Lower pairs; a multiple joint of k links counts k - 1.
    pub lower_pairs: usize,
    /// Higher pairs.
    pub higher_pairs: usize,
    /// Mobility by Chebyshev and Grübler.
    pub mobility_count: i64,
    /// Mobility by the rank of the constraint Jacobian at the start, when there is a pose.
    pub mobility_rank: Option<usize>,
    /// Constraints that say nothing new at the start.
    pub redundant: Option<usize>,
    /// Joints whose constraints are redundant whatever the dimensions.
    pub redundant_joints: Vec<String>,
    /// Links that turn without anything else moving.
    pub idle: Vec<String>,
    /// Drives.
    pub drives: Vec<String>,
    /// Assur groups in the order in which they are solved.
    pub groups: Vec<Group>,
    /// Four-bar loops.
    pub four_bars: Vec<Grashof>,
    /// Assemblies that agree with the file where one was chosen, at the start or as drawn; unknown where drives are missing.
    pub assemblies: Option<usize>,
    /// Assemblies that the file's sides reject.
    pub assemblies_rejected: usize,
    /// Whether all assemblies were found by complete methods.
    pub assemblies_complete: bool,
    /// How the one was chosen where several agree, and hints that decide nothing, in words.
    pub chosen: Vec<String>,
    /// How far the drive can go on its circuit, in words.
    pub reach: Option<String>,
    /// The same in SI: lowest and highest coordinate.
    pub reach_si: Option<(f64, f64)>,
    /// Dead points and change points, in words.
    pub events: Vec<String>,
    /// Where they are in SI, in the same order.
    pub events_si: Vec<f64>,
    /// What is assumed where the file says nothing.
    pub assumptions: Vec<String>,
    /// What a careful engineer would want to be told, and what is wrong.
    pub diagnostics: Vec<Diagnostic>,
}

/// A group of links that are solved together.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Group {
    /// Its links.
    pub links: Vec<String>,
    /// Its class.
    pub class: u32,
    /// Its kind.
    pub kind: String,
    /// Whether it is solved in closed form.
    pub closed_form: bool,
}

/// A four-bar loop.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Grashof {
    /// Its links, the frame first.
    pub links: Vec<String>,
    /// Its pins.
    pub pins: Vec<String>,
    /// Distances between the pins of each link, with units.
    pub lengths: Vec<String>,
    /// The same, m.
    pub lengths_si: Vec<f64>,
    /// Its type.
    pub kind: String,
}

/// Checks a model: mobility two ways, groups, assemblies, reach.
pub fn check(model: &Model) -> Report {
    check_with_progress(model, &mut Silent)
}

/// As [`check`]; `progress` hears how far it has come (no rows). Stopped, it tells what it found until then, with the
/// diagnostic `stopped`.
pub fn check_with_progress(model: &Model, progress: &mut dyn Progress) -> Report {
    let design = design(model);
    let mechanism = &design.mechanism;
    let found = kempe_motion::check_with_progress(&design, progress);
    let units = Units::of(model);
    let bodies = |list: &[BodyId]| {
        list.iter()
            .map(|b| mechanism.body_name(*b))
            .collect::<Vec<_>>()
    };
    let point = |index: usize| {
        model
            .points
            .get(index)
            .map_or(String::new(), |p| p.name.clone())
    };
    let elsewhere: Vec<String> = (model.starting_elsewhere(&design.parameters).iter())
        .filter_map(|e| {
            let drive = model.drives.get(e.drive.index())?;
            let drawn = units.text(e.drawn, drive.dimension);
            Some(format!("{} = {drawn}", drive.name))
        })
        .collect();
    let moving = found.motion.as_ref().and_then(|motion| match motion.path {
        DrivePath::Coordinate { drive, .. } => model.drives.get(drive),
        DrivePath::Time { .. } => None,
    });
    let mut report = Report {
        title: model.title.clone(),
        drawn: drawn::links(&design, &units),
        links: found.mobility.links,
        lower_pairs: found.mobility.lower_pairs,
        higher_pairs: found.mobility.higher_pairs,
        mobility_count: found.mobility.count,
        mobility_rank: found.mobility.by_rank,
        redundant: found.mobility.redundant_rows,
        redundant_joints: found
            .redundant
            .iter()
            .map(|s| source_name(model, *s))
            .collect(),
        idle: bodies(&found.idle),
        drives: model.drives.iter().map(|d| d.name.clone()).collect(),
        groups: found
            .groups
            .iter()
            .map(|g| Group {
                links: bodies(&g.bodies),
                class: g.class,
                kind: kind_text(model, g),
                closed_form: g.closed_form,
            })
            .collect(),
        four_bars: found
            .four_bars
            .iter()
            .map(|f| Grashof {
                links: bodies(&f.bodies),
                pins: f.pins.iter().map(|p| point(p.index())).collect(),
                lengths: f
                    .lengths
                    .iter()
                    .map(|l| units.text(*l, Dimension::LENGTH))
                    .collect(),
                lengths_si: f.lengths.to_vec(),
                kind: f.kind.name().to_owned(),
            })
            .collect(),
        assemblies: found.searched.then_some(found.assemblies.list.len()),
        assemblies_rejected: found.assemblies.rejected,
        assemblies_complete: found.assemblies.complete,
        chosen: chosen(&design, &found, &elsewhere, &units),
        reach: None,
        reach_si: found.reach.as_ref().map(|r| r.range),
        events: Vec::new(),
        events_si: Vec::new(),
        assumptions: assumptions(model, &units),
        diagnostics: Vec::new(),
    };
    if let Some(reach) = &found.reach {
        let (name, dimension) = moving.map_or(("time", Dimension::TIME), |d| {
            (d.name.as_str(), d.dimension)
        });
        report.reach = Some(if reach.full_turn {
            format!("{name} turns fully")
        } else {
            let range = units.range_text(reach.range, dimension);
            let why = match reach.ends {
                (EndReason::Limit, EndReason::Limit) => ", limits on both sides",
                (EndReason::Runaway, EndReason::Limit) => {
                    ", a part runs away to infinity at the low end, a limit at the high end"
                }
                (EndReason::Limit, EndReason::Runaway) => {
                    ", a limit at the low end, a part runs away to infinity at the high end"
                }
                (EndReason::Limit, _) => " and more, a limit at the low end",
                (_, EndReason::Limit) => " and less, a limit at the high end",
                (EndReason::Runaway, _) | (_, EndReason::Runaway) => {
                    ", where a part runs away to infinity"
                }
                (EndReason::Stuck, _) | (_, EndReason::Stuck) => {
                    ", where it could be followed no further"
                }
                _ => "",
            };
            format!("{name} {range}{why}")
        });
        for event in reach
            .events
            .iter()
            .filter(|e| e.kind != EventKind::ModeChange)
        {
            let what = match event.kind {
                EventKind::Limit => "limit of the drive",
                _ => "change point",
            };
            report.events_si.push(event.at);
            report.events.push(format!(
                "{what} at {name} = {}",
                units.place_text(event.at, dimension, reach.range)
            ));
        }
    }
    report.diagnostics = diagnostics(model, &design, &found, progress);
    report
}

/// An assembly this near to the drawing, in sizes of the mechanism, is the drawn one but for digits that were left out.
const AS_DRAWN: f64 = 1e-6;

/// How the assembly was chosen where several agree with the file, and which hints decide nothing.
/// `elsewhere` tells the drives that start elsewhere than drawn, with where they are drawn.
fn chosen(
    design: &Design<f64>,
    found: &Findings,
    elsewhere: &[String],
    units: &Units,
) -> Vec<String> {
    // the hints that counted
    let design = found.motion.as_ref().map_or(design, |m| &m.design);
    let (mechanism, assemblies) = (&*design.mechanism, &found.assemblies);
    let followed = match elsewhere.is_empty() {
        true => String::new(),
        false => format!(", followed from {} to the start", list(elsewhere)),
    };
    let mut words = Vec::new();
    if let [first, ..] = assemblies.list.as_slice()
        && assemblies.list.len() > 1
    {
        let alike = hints::as_near(design, assemblies).len();
        let off = |a: &Assembly| hints::off(design, units, &a.poses);
        let model = &mechanism.model;
        let drawn = !model.assembly.is_empty() && drawn::gives_hint(model, 0);
        words.push(match assemblies.list.get(alike) {
            Some(_) if alike == 1 && drawn && first.distance <= AS_DRAWN * design.size() => {
                format!("the one that is drawn{followed}")
            }
            None => "the first of them: nothing in [assembly] decides".to_owned(),
            Some(next) if alike == 1 => format!(
                "the nearest to [assembly]: {} off; in the next {}",
                off(first),
                off(next)
            ),
            Some(next) => format!(
                "the first of {alike} that are as near to [assembly]: {} off; in the next {}",
                off(first),
                off(next)
            ),
        });
    }
    let idle = hints::idle(design, assemblies).into_iter();
    // what is drawn need not decide
    let idle = idle.filter(|(index, _)| !drawn::gives_hint(&mechanism.model, *index));
    words.extend(idle.map(|(index, why)| {
        format!(
            "{} decides nothing: {why}",
            hints::text(&mechanism.model, index)
        )
    }));
    words
}

/// What Kempe takes for granted where the file is silent.
fn assumptions(model: &Model, units: &Units) -> Vec<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let mut assumed = vec![format!(
        "bare numbers: lengths in {0}, angles in {1}, speeds in {0}/s and {1}/s",
        model.units.length.name, model.units.angle.name
    )];
    for drive in &model.drives {
        let way = law_text(drive, &parameters, units);
        let time = match drive.law.duration(&parameters) {
            0.0 => String::new(),
            time => format!(" in {}", units.text(time, Dimension::TIME)),
        };
        let on = match &drive.kind {
            DriveKind::Cylinder { a, b } => on_links(model, &[a, b]),
            _ => String::new(),
        };
        assumed.push(format!("drive {}{on}: {way}{time}", drive.name));
    }
    assumed.extend(crate::findings_forces::assumptions(model, units));
    let endless = model.joints.iter().filter(|joint| {
        matches!(
            joint.kind,
            JointKind::Slider { .. } | JointKind::Slot { .. }
        )
    });
    let endless: Vec<String> = endless.map(|joint| format!("`{}`", joint.name)).collect();
    if !endless.is_empty() {
        assumed.push(format!(
            "straight slots and guides: {} without ends, beyond the points that name their line too",
            endless.join(", ")
        ));
    }
    assumed.extend(teeth(model));
    if model.assembly.is_empty() && model.links.len() > 1 {
        assumed.push("assembly: the first found, as the file names none".to_owned());
    }
    assumed.extend(model.studies.iter().map(|study| {
        format!(
            "study {}: {}",
            study.name,
            study_text(model, study, &parameters, units)
        )
    }));
    assumed
}

/// What is taken of the teeth of gears and racks.
fn teeth(model: &Model) -> Option<String> {
    let told = |joint: &Joint| Some(joint.kind.teeth()?.pressure_angle.is_some());
    let told: Vec<bool> = model.joints.iter().filter_map(told).collect();
    let across = match told.contains(&false) {
        true => "; without a pressure angle they push along the tangent of the pitch circles alone",
        false => "",
    };
    (!told.is_empty()).then(|| format!("teeth: without backlash{across}"))
}

/// From where to where a law goes, the way that it goes.
fn law_text(drive: &Drive, parameters: &[f64], units: &Units) -> String {
    let law = &drive.law;
    let (low, high) = law.extent(parameters);
    if low == high {
        return format!("held at {}", units.text(low, drive.dimension));
    }
    let end = law.duration(parameters);
    let ends = [law.at(0.0, parameters), law.at(end, parameters), low, high];
    let [first, last, least, most] = units.texts(ends, drive.dimension);
    match ends {
        [a, b, ..] if (a, b) == (low, high) || (a, b) == (high, low) => {
            format!("{first} to {last}")
        }
        _ => format!("{first} to {last}, between {least} and {most}"),
    }
}

/// What a study is, and where its rows stand.
fn study_text(model: &Model, study: &Study, parameters: &[f64], units: &Units) -> String {
    let kind = match &study.kind {
        StudyKind::Motion(motion) if motion.circuit => "the whole circuit",
        StudyKind::Motion(_) => "motion",
        StudyKind::Forces(_) => "forces",
        StudyKind::Balance(_) => "counterweights",
        StudyKind::Spring(_) => "a spring",
        StudyKind::Simulate(_) => "a simulation",
        StudyKind::Clearance(_) => "clearance",
        StudyKind::Contact(_) => "clearance in which contact is lost",
        StudyKind::Vibrations(_) => "natural vibrations",
        StudyKind::Adjust(asked) => return crate::adjust::in_words(model, asked),
        StudyKind::Synthesize(asked) => return crate::synthesis::in_words(asked),
        StudyKind::Sweep(asked) => {
            let ids: Vec<_> = asked.vary.iter().map(|it| it.parameter).collect();
            return crate::designs::in_words(model, "a sweep", &asked.over, &ids, None);
        }
        StudyKind::Tolerance(asked) => {
            let ids: Vec<_> = asked.vary.iter().map(|it| it.parameter).collect();
            let play = asked.clearance.as_ref().map(|_| "the play of joints");
            return crate::designs::in_words(model, "tolerances", &asked.over, &ids, play);
        }
        StudyKind::Optimize(asked) => {
            let ids: Vec<_> = asked.vary.iter().map(|it| it.parameter).collect();
            return crate::designs::in_words(model, "an optimum", &asked.over, &ids, None);
        }
    };
    let along = study.kind.along();
    let moving = |d: &&Drive| {
        let (low, high) = d.law.extent(parameters);
        low < high
    };
    let rows = match &along.rows {
        Rows::DriveStep(step) => {
            let drive = model.drives.iter().find(moving).or(model.drives.first());
            let (name, dimension) = drive.map_or(("time", Dimension::TIME), |d| {
                (d.name.as_str(), d.dimension)
            });
            format!(
                "a row every {} of {name}",
                units.text(value(step, parameters), dimension)
            )
        }
        Rows::TimeStep(step) => {
            let step = units.text(value(step, parameters), Dimension::TIME);
            format!("a row every {step}")
        }
        Rows::Count(1) if matches!(study.kind, StudyKind::Vibrations(_)) => {
            "about one pose".to_owned()
        }
        Rows::Count(1) => "1 row".to_owned(),
        Rows::Count(count) if along.circuit => format!("{count} rows evenly along the arc"),
        Rows::Count(count) => format!("{count} rows evenly in time"),
    };
    match &study.kind {
        StudyKind::Simulate(simulated)
        | StudyKind::Contact(ContactStudy {
            motion: simulated, ..
        }) => {
            let free: Vec<String> = (simulated.released.iter())
                .filter_map(|drive| model.drives.get(drive.index()))
                .map(|drive| drive.name.clone())
                .collect();
            let until = units.text(value(&simulated.until, parameters), Dimension::TIME);
            let rows = match simulated.coordinates {
                Some(CoordinateKind::SpanningTree) => {
                    format!("in coordinates of a spanning tree, {rows}")
                }
                _ => rows,
            };
            match free.is_empty() {
                true => format!("{kind} of {until}, {rows}"),
                false => format!("{kind} of {until}, {} let go, {rows}", list(&free)),
            }
        }
        _ => format!("{kind}, {rows}"),
    }
}

fn diagnostics(
    model: &Model,
    design: &Design<f64>,
    found: &Findings,
    progress: &mut dyn Progress,
) -> Vec<Diagnostic> {
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    let mut tell = |told: Vec<Diagnostic>| {
        for it in told {
            if !diagnostics.contains(&it) {
                diagnostics.push(it);
            }
        }
    };
    let laws = OfLaws {
        model,
        design,
        found,
        motion: OnceCell::new(),
        mechanism: OnceCell::new(),
    };
    // Without a study it is asked how the drives' laws move it.
    if model.studies.is_empty() {
        tell(laws.motion().to_vec());
    }
    for study in &model.studies {
        tell(of_study(&laws, study, progress));
    }
    diagnostics
}

/// What is to be told of the motion that the drives' laws demand, found when it is asked for.
struct OfLaws<'a> {
    model: &'a Model,
    design: &'a Design<f64>,
    found: &'a Findings,
    motion: OnceCell<Vec<Diagnostic>>,
    mechanism: OnceCell<Vec<Diagnostic>>,
}

impl OfLaws<'_> {
    /// Of the motion and its range.
    fn motion(&self) -> &[Diagnostic] {
        self.motion
            .get_or_init(|| of_motion(self.model, self.design, self.found, motion_findings))
    }

    /// Of the mechanism, wherever the drives go.
    fn mechanism(&self) -> &[Diagnostic] {
        self.mechanism
            .get_or_init(|| of_motion(self.model, self.design, self.found, of_mechanism))
    }

    /// Why there is no motion, if there is none.
    fn lack(&self) -> Option<Diagnostic> {
        let problem = self.found.problem.as_ref();
        let problem = problem.filter(|_| self.found.motion.is_none())?;
        Some(cannot_move(self.design, problem))
    }
}

/// What is to be told of the motion that the drives' laws demand, or of why there is none; `of` tells it of one that there is.
fn of_motion(
    model: &Model,
    design: &Design<f64>,
    found: &Findings,
    of: impl Fn(&Motion) -> Vec<Diagnostic>,
) -> Vec<Diagnostic> {
    if let Some(motion) = &found.motion {
        return of(motion);
    }
    let mut diagnostics = crate::findings_forces::problems(design);
    if let Some(problem) = &found.problem {
        let problem = cannot_move(design, problem);
        // A file need not say what moves it: only what asks for a motion cannot do without.
        diagnostics.push(match problem.code {
            "no-drive" if found.mobility.by_rank == Some(0) => {
                Diagnostic::warning("no-drive", "nothing can move: the links hold each other")
                    .help("a mechanism has a joint more, or a link less")
            }
            "no-drive" if model.studies.is_empty() => problem.with_severity(Severity::Warning),
            _ => problem,
        });
    }
    diagnostics.extend(match found.searched {
        true => of_freedoms(
            design,
            &Mobility {
                by_rank: None,
                ..found.mobility
            },
        ),
        false => of_freedoms(design, &found.mobility),
    });
    diagnostics
}

/// What is to be told of a study before it is run.
fn of_study(laws: &OfLaws<'_>, study: &Study, progress: &mut dyn Progress) -> Vec<Diagnostic> {
    let (model, name) = (laws.model, study.name.as_str());
    let mut told = match &study.kind {
        // A circuit goes wherever it leads.
        StudyKind::Motion(motion) if motion.circuit => laws.mechanism().to_vec(),
        StudyKind::Motion(_) | StudyKind::Forces(_) => laws.motion().to_vec(),
        StudyKind::Balance(_) | StudyKind::Spring(_) => laws.motion().to_vec(),
        StudyKind::Clearance(play) => {
            let motion = laws.found.motion.as_ref();
            let own = findings_of_clearance(model, name, play, motion);
            [laws.motion().to_vec(), own].concat()
        }
        StudyKind::Simulate(it) => findings_of_simulation(model, name, it, &[], progress),
        StudyKind::Contact(play) => findings_of_contact(model, name, play, laws.lack(), progress),
        StudyKind::Vibrations(asked) => findings_of_vibrations(model, name, asked, progress),
        StudyKind::Adjust(asked) => {
            let own = findings_of_adjustment(model, asked);
            [laws.motion().to_vec(), own].concat()
        }
        StudyKind::Synthesize(asked) => findings_of_synthesis(model, asked),
        StudyKind::Sweep(asked) => findings_of_sweep(model, name, asked, progress),
        StudyKind::Tolerance(asked) => findings_of_tolerance(model, asked, progress),
        StudyKind::Optimize(asked) => findings_of_optimization(model, asked, progress),
    };
    if !refuses(&told) {
        if let StudyKind::Forces(_) = study.kind {
            told.extend(nothing_acts(model));
        }
        told.extend(not_answerable(&laws.design.mechanism, study));
    }
    told
}
