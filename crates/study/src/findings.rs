//! What is to be known of a mechanism before it moves, in the names and units of its file.

use kempe_mechanism::Design;
use kempe_mechanism::structure::BodyId;
use kempe_model::{Diagnostic, Drive, Model, Rows, Severity, Study, StudyKind, value};
use kempe_motion::assemble::{Assemblies, Assembly, Shortfall};
use kempe_motion::events::EventKind;
use kempe_motion::{EndReason, Findings};
use kempe_units::Dimension;
use serde::Serialize;

use crate::explain::cannot_move;
use crate::findings_text::kind_text;
use crate::prepared::design;
use crate::unit::Units;
use crate::words::{list, source_name};
use crate::{alternatives, hints};
use kempe_motion::progress::{Progress, Silent};

/// The answer of `check`.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Title of the mechanism.
    pub title: String,
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
    /// Assemblies at the start that agree with the file; unknown where drives are missing.
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
    let single = (model.drives.len() == 1).then(|| &model.drives[0]);
    let mut report = Report {
        title: model.title.clone(),
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
                kind: f.kind.name().to_owned(),
            })
            .collect(),
        assemblies: found.searched.then_some(found.assemblies.list.len()),
        assemblies_rejected: found.assemblies.rejected,
        assemblies_complete: found.assemblies.complete,
        chosen: chosen(&design, &found.assemblies, &units),
        reach: None,
        reach_si: found.reach.as_ref().map(|r| r.range),
        events: Vec::new(),
        assumptions: assumptions(model, &units),
        diagnostics: Vec::new(),
    };
    if let Some(reach) = &found.reach {
        let (name, dimension) = single.map_or(("time", Dimension::TIME), |d| {
            (d.name.as_str(), d.dimension)
        });
        report.reach = Some(if reach.full_turn {
            format!("{name} turns fully")
        } else {
            let range = crate::explain::reach_text(model, reach.range, dimension);
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
            report.events.push(format!(
                "{what} at {name} = {}",
                units.place_text(event.at, dimension, reach.range)
            ));
        }
    }
    report.diagnostics = diagnostics(model, &design, &found);
    report
}

/// How the assembly was chosen where several agree with the file, and which hints decide nothing.
fn chosen(design: &Design<f64>, assemblies: &Assemblies, units: &Units) -> Vec<String> {
    let mechanism = &*design.mechanism;
    let mut words = Vec::new();
    if let [first, second, ..] = assemblies.list.as_slice() {
        let text = |a: &Assembly| units.text(a.distance, Dimension::LENGTH);
        let decided = hints::near_decides(design, assemblies);
        words.push(match decided {
            true => format!(
                "the nearest to [assembly], {} from it; the next is {} away",
                text(first),
                text(second)
            ),
            false => "the first of them: nothing in [assembly] decides".to_owned(),
        });
    }
    let idle = hints::idle(design, assemblies).into_iter();
    words.extend(idle.map(|(index, why)| {
        format!(
            "{} decides nothing: {why}",
            hints::text(&mechanism.model, index)
        )
    }));
    words
}

/// Whether the file leaves open which assembly is meant.
fn open_choice(design: &Design<f64>, assemblies: &Assemblies) -> bool {
    let mechanism = &*design.mechanism;
    let hints = &mechanism.model.assembly;
    let idle = hints::idle(design, assemblies).len();
    idle == hints.len() || !hints::near_decides(design, assemblies)
}

/// What Kempe takes for granted where the file is silent.
fn assumptions(model: &Model, units: &Units) -> Vec<String> {
    let parameters: Vec<f64> = model.parameter_values();
    let mut assumed = vec![format!(
        "bare numbers: lengths in {0}, angles in {1}, speeds in {0}/s and {1}/s",
        model.units.length.name, model.units.angle.name
    )];
    for drive in &model.drives {
        let law = &drive.law;
        let (low, high) = law.extent(&parameters);
        assumed.push(format!(
            "drive {}: {} to {} in {}",
            drive.name,
            units.text(low, drive.dimension),
            units.text(high, drive.dimension),
            units.text(law.duration(&parameters), Dimension::TIME)
        ));
    }
    assumed.extend(crate::findings_forces::assumptions(model, units));
    if model.assembly.is_empty() {
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

/// What a study is, and where its rows stand.
fn study_text(model: &Model, study: &Study, parameters: &[f64], units: &Units) -> String {
    let kind = match &study.kind {
        StudyKind::Motion(motion) if motion.circuit => "the whole circuit",
        StudyKind::Motion(_) => "motion",
        StudyKind::Forces(_) => "forces",
        StudyKind::Balance(_) => "counterweights",
        StudyKind::Spring(_) => "a spring",
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
        Rows::Count(1) => "1 row".to_owned(),
        Rows::Count(count) if along.circuit => format!("{count} rows evenly along the arc"),
        Rows::Count(count) => format!("{count} rows evenly in time"),
    };
    format!("{kind}, {rows}")
}

fn diagnostics(model: &Model, design: &Design<f64>, found: &Findings) -> Vec<Diagnostic> {
    let mechanism = &*design.mechanism;
    let mut diagnostics = crate::findings_forces::problems(design);
    if let Some(problem) = &found.problem {
        let problem = cannot_move(design, problem);
        // A file need not say what moves it: only what asks for a motion cannot do without.
        diagnostics.push(match problem.code {
            "no-drive" if found.mobility.by_rank == Some(0) => {
                Diagnostic::warning("no-drive", "nothing can move: the links hold each other")
                    .help("a mechanism has a joint more, or a link less")
            }
            "no-drive" => problem.with_severity(Severity::Warning),
            _ => problem,
        });
    }
    let whole = found.problem.is_none() || !found.searched;
    if let (Some(rank), true) = (found.mobility.by_rank, whole) {
        let free = rank.saturating_sub(found.idle.len());
        if free < found.drives {
            diagnostics.push(
                Diagnostic::warning(
                    "overdriven",
                    format!("{} drives move {free} freedoms at the start", found.drives),
                )
                .help("drives that depend on each other must agree exactly: leave one out"),
            );
        }
        if found.mobility.count != rank as i64 {
            let redundant = found.mobility.redundant_rows.unwrap_or(0);
            diagnostics.push(
                Diagnostic::warning(
                    "overconstrained",
                    format!(
                        "by count the mobility is {}, by the rank of its constraints {rank}: {redundant} of them repeat others",
                        found.mobility.count
                    ),
                )
                .note("it moves because of its special dimensions; real links of other lengths would jam"),
            );
        }
    }
    if !found.idle.is_empty() {
        let names: Vec<String> = found
            .idle
            .iter()
            .map(|b| format!("`{}`", mechanism.body_name(*b)))
            .collect();
        diagnostics.push(Diagnostic::warning(
            "idle-freedom",
            format!(
                "{} can turn by itself without moving anything else",
                list(&names)
            ),
        ));
    }
    let open = open_choice(design, &found.assemblies);
    if found.assemblies.list.len() > 1 && open {
        let agree = match model.assembly.is_empty() {
            true => "fit the file",
            false => "agree with the file",
        };
        let warning = Diagnostic::warning(
            "several-assemblies",
            format!(
                "{} assemblies {agree}: the first was chosen",
                found.assemblies.list.len()
            ),
        );
        let lines = alternatives::hints(design, &found.assemblies.list);
        let help = match (lines.is_empty(), model.assembly.is_empty()) {
            (true, _) => {
                "say under [assembly] near which angle a link is meant: rocker = { near = \"30 deg\" }"
            }
            (false, true) => "write the line of the one that is meant under [assembly]",
            (false, false) => "write the line of the one that is meant under [assembly] too",
        };
        let lines = lines.into_iter().enumerate();
        let warning = lines.fold(warning, |diagnostic, (k, line)| match k {
            0 => diagnostic.note(format!("the first: {line}")),
            _ => diagnostic.note(format!("number {}: {line}", k + 1)),
        });
        let idle = hints::idle(design, &found.assemblies).into_iter();
        let warning = idle.fold(warning, |diagnostic, (index, why)| {
            let span = model.assembly[index].span.clone();
            diagnostic.at(span, format!("decides nothing: {why}"))
        });
        diagnostics.push(warning.help(help));
    }
    // Where hints have chosen one, what may be missing is not it.
    if let (Some(shortfall), None, true) = (found.assemblies.shortfall, &found.problem, open) {
        let why = match shortfall {
            Shortfall::Searched => "a group was searched by trial",
            Shortfall::Scanned => {
                "a group with a gear, belt or rack was followed along its curves, and a short one can be overlooked"
            }
            Shortfall::LostPath => {
                "positions of a group coincide at this start, or so nearly that not all could be told apart, as where links lie in line"
            }
            Shortfall::Exhausted => "a group has more of them than could be followed",
            Shortfall::TooMany => "there are too many to list",
        };
        diagnostics.push(
            Diagnostic::warning(
                "assemblies-incomplete",
                format!("some assemblies may be missing: {why}"),
            )
            .help("say where points of the one that is meant are, [assembly] C = { near = [x, y] }: it is looked for there too; or start the drive a little elsewhere"),
        );
    }
    if let Some(reach) = &found.reach {
        let parameters: Vec<f64> = model.parameter_values();
        if let [drive] = model.drives.as_slice() {
            let (low, high) = drive.law.extent(&parameters);
            let slack = 1e-12 * (high - low).abs().max(reach.range.1 - reach.range.0);
            let [below, above] = [reach.ends.0, reach.ends.1].map(|end| end == EndReason::Limit);
            let beyond =
                (below && low < reach.range.0 - slack) || (above && high > reach.range.1 + slack);
            if beyond {
                diagnostics.push(
                    Diagnostic::error(
                        "range-beyond-limit",
                        format!(
                            "drive `{}` is asked for {}, but can only go {}",
                            drive.name,
                            crate::explain::reach_text(model, (low, high), drive.dimension),
                            crate::explain::reach_text(model, reach.range, drive.dimension)
                        ),
                    )
                    .at(
                        drive.span.clone(),
                        "the demanded range goes further than the mechanism",
                    ),
                );
            }
        }
    }
    diagnostics
}
