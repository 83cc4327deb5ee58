//! What is to be told of a mechanism and its motion, whoever found it: `check`, `run`, `draw` and all others say the same.

use kempe_mechanism::Design;
use kempe_mechanism::mobility::Mobility;
use kempe_model::{Diagnostic, HintKind};
use kempe_motion::assemble::{Assemblies, Found, Shortfall, found_near};
use kempe_motion::check::mobility_at_start;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{EndReason, Motion};
use kempe_number::math::hypot;
use kempe_units::Dimension;

use crate::drawn::gives_hint;
use crate::explain::beyond_limit;
use crate::lone_points::with_lone_points;
use crate::unit::Units;
use crate::words::{and_more, list};
use crate::{alternatives, findings_forces, hints};

/// A `near` angle that is missed by more than this, rad, was not meant: an eighth of a turn.
const FAR_ANGLE: f64 = std::f64::consts::FRAC_PI_4;
/// A `near` place that is missed by more than this part of the mechanism's size was not meant.
const FAR_PLACE: f64 = 0.25;

/// Everything to be told of a motion and its mechanism before rows are asked for.
pub fn motion_findings(motion: &Motion) -> Vec<Diagnostic> {
    let mut findings = of_mechanism(motion);
    findings.extend(of_range(motion));
    findings
}

/// [`motion_findings`] wherever the drives go.
pub(crate) fn of_mechanism(motion: &Motion) -> Vec<Diagnostic> {
    let design = &motion.design;
    let mut findings = findings_forces::problems(design);
    findings.extend(of_freedoms(design, &mobility_at_start(motion)));
    findings.extend(left_drawing(motion));
    findings.extend(of_assemblies(design, &motion.assemblies));
    findings
}

/// What the freedoms of a mechanism, counted and by rank, do not agree in.
pub(crate) fn of_freedoms(design: &Design<f64>, mobility: &Mobility) -> Vec<Diagnostic> {
    let mechanism = &*design.mechanism;
    let idle = &mechanism.plan.decomposition.idle;
    let mut findings = Vec::new();
    if let Some(rank) = mobility.by_rank {
        let drives = mechanism.model.drives.len();
        let free = rank.saturating_sub(idle.len());
        if free < drives {
            findings.push(
                Diagnostic::warning(
                    "overdriven",
                    format!(
                        "{} {free} {} at the start",
                        match drives {
                            1 => "1 drive moves".to_owned(),
                            n => format!("{n} drives move"),
                        },
                        if free == 1 { "freedom" } else { "freedoms" }
                    ),
                )
                .help("drives that depend on each other must agree exactly: leave one out"),
            );
        }
        if mobility.count != rank as i64 {
            let redundant = mobility.redundant_rows.unwrap_or(0);
            findings.push(
                Diagnostic::warning(
                    "overconstrained",
                    format!(
                        "by count the mobility is {}, by the rank of its constraints {rank}: {redundant} of them repeat others",
                        mobility.count
                    ),
                )
                .note(match mobility.misfit {
                    Some(misfit) => format!(
                        "they miss each other by {misfit:.1e} of the mechanism's size: exactly as its dimensions are, it is locked"
                    ),
                    None => "it moves because of its special dimensions; real links of other lengths would jam".to_owned(),
                })
                .help("where that is not meant, take out the link or joint that repeats others; their loads are told together only"),
            );
        }
    }
    if !idle.is_empty() {
        let names: Vec<String> = idle
            .iter()
            .map(|b| format!("`{}`", mechanism.body_name(*b)))
            .collect();
        let mut finding = Diagnostic::warning(
            "idle-freedom",
            format!(
                "{} can turn by {} without moving anything else",
                list(&names),
                if names.len() == 1 {
                    "itself"
                } else {
                    "themselves"
                }
            ),
        );
        let links = mechanism.model.links.iter().zip(&mechanism.seats);
        for (link, _) in links.filter(|(_, seat)| idle.contains(&seat.body)) {
            finding = finding.at(link.span.clone(), "turns by itself");
        }
        let otherwise = "where that is not meant, name a pin of it on the link that should hold it, or add a joint";
        findings.push(with_lone_points(
            finding,
            &mechanism.model,
            mechanism,
            idle,
            otherwise,
        ));
    }
    findings
}

/// Why the drawing does not say which assembly is meant.
fn left_drawing(motion: &Motion) -> Option<Diagnostic> {
    let left = motion.left_drawing.as_ref()?;
    let model = &motion.mechanism().model;
    let units = Units::of(model);
    let drives: Vec<_> = (left.elsewhere.iter())
        .filter_map(|e| Some((e, model.drives.get(e.drive.index())?)))
        .collect();
    let elsewhere: Vec<String> = drives
        .iter()
        .map(|(e, drive)| {
            let [start, drawn] = units.texts([e.start, e.drawn], drive.dimension);
            format!("`{}` starts at {start} and is drawn at {drawn}", drive.name)
        })
        .collect();
    let why = match &left.ends {
        None => "as it is drawn it cannot be put together".to_owned(),
        Some((at, reason)) => {
            let at: Vec<String> = (drives.iter().zip(at))
                .map(|((_, drive), x)| units.text(*x, drive.dimension))
                .collect();
            let at = list(&at);
            match reason {
                EndReason::Limit => {
                    format!("the assembly that is drawn goes only to {at}, a limit")
                }
                _ => format!("the assembly that is drawn could be followed only to {at}"),
            }
        }
    };
    let mut finding =
        Diagnostic::warning("not-as-drawn", format!("drive {}: {why}", list(&elsewhere)));
    for (_, drive) in drives {
        finding = finding.at(drive.span.clone(), "does not start as drawn");
    }
    Some(finding.help(
        "leave out where it starts, draw it there, or say under [assembly] which one is meant",
    ))
}

/// Whether it is clear which assembly is meant, and whether the file gets the one that it asks for.
fn of_assemblies(design: &Design<f64>, assemblies: &Assemblies) -> Vec<Diagnostic> {
    let mut findings = missed_hints(design, assemblies);
    let model = &design.mechanism.model;
    let idle = hints::idle(design, assemblies);
    let alike = hints::as_near(design, assemblies);
    if alike.len() > 1 {
        findings.push(several(design, assemblies, alike.len(), &idle));
    }
    // Where hints have chosen one, what may be missing is not it.
    let open = alike.len() > 1 || idle.len() == model.assembly.len();
    if let (Some(shortfall), true) = (assemblies.shortfall, open) {
        findings.push(incomplete(shortfall));
    }
    findings
}

/// More than one assembly is as good as the file's hints can tell.
fn several(
    design: &Design<f64>,
    assemblies: &Assemblies,
    alike: usize,
    idle: &[(usize, String)],
) -> Diagnostic {
    let model = &design.mechanism.model;
    let total = assemblies.list.len();
    let message = if alike < total {
        format!("{alike} of {total} assemblies are as near to [assembly]: the first was chosen")
    } else if model.assembly.is_empty() {
        format!("{alike} assemblies fit the file: the first was chosen")
    } else {
        format!("{alike} assemblies agree with the file: the first was chosen")
    };
    let lines = alternatives::hints(design, &assemblies.list[..alike]);
    let help = match (lines.is_empty(), model.assembly.is_empty()) {
        (true, _) => {
            "no point and no angle tells them apart at the start: start the drive a little elsewhere"
        }
        (false, true) => "write the line of the one that is meant under [assembly]",
        (false, false) => "write the line of the one that is meant under [assembly] too",
    };
    let mut warning = Diagnostic::warning("several-assemblies", message);
    for (k, line) in lines.iter().enumerate() {
        warning = warning.note(match k {
            0 => format!("the first: {line}"),
            _ => format!("number {}: {line}", k + 1),
        });
    }
    if !lines.is_empty() && lines.len() < alike {
        warning = warning.note(and_more(alike - lines.len()));
    }
    for (index, why) in idle.iter().filter(|(index, _)| !gives_hint(model, *index)) {
        let span = model.assembly[*index].span.clone();
        warning = warning.at(span, format!("decides nothing: {why}"));
    }
    warning.help(help)
}

fn incomplete(shortfall: Shortfall) -> Diagnostic {
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
    Diagnostic::warning(
        "assemblies-incomplete",
        format!("some assemblies may be missing: {why}"),
    )
    .help("say where points of the one that is meant are, [assembly] C = { near = [x, y] }: it is looked for there too; or start the drive a little elsewhere")
}

/// Hints that ask for something near which no assembly is.
fn missed_hints(design: &Design<f64>, assemblies: &Assemblies) -> Vec<Diagnostic> {
    let Some(chosen) = assemblies.list.first() else {
        return Vec::new();
    };
    let model = &design.mechanism.model;
    let (units, size) = (Units::of(model), design.size());
    let found = found_near(design, &chosen.poses);
    let missed = found.into_iter().zip(&model.assembly);
    let missed = missed.filter_map(|(found, hint)| {
        let (name, asked, got) = match (&hint.kind, found?) {
            (HintKind::NearPlace { point, .. }, Found::Place { at, off })
                if hypot(off[0], off[1]) > FAR_PLACE * size =>
            {
                let place = |p: [f64; 2]| {
                    let [x, y] = p.map(|x| units.text(x, Dimension::LENGTH));
                    format!("[{x}, {y}]")
                };
                let asked = [at[0] - off[0], at[1] - off[1]];
                let name = model.points.get(point.index())?.name.clone();
                (name, place(asked), place(at))
            }
            (HintKind::NearAngle { link, .. }, Found::Angle { at, off })
                if off.abs() > FAR_ANGLE =>
            {
                let angle = |x: f64| units.text(x, Dimension::ANGLE);
                let name = model.links.get(link.index())?.name.clone();
                (name, angle(at - off), angle(at))
            }
            _ => return None,
        };
        Some(
            Diagnostic::warning(
                "hint-missed",
                format!("`{name}` is asked for near {asked}, and lies at {got}"),
            )
            .at(
                hint.span.clone(),
                match assemblies.list.len() {
                    1 => "the only assembly is not near this".to_owned(),
                    n => format!("the nearest of {n} assemblies is not near this"),
                },
            )
            .help(
                "change the hint, or the dimensions: at the start of the drives nothing lies there",
            ),
        )
    });
    missed.collect()
}

/// What keeps a motion from covering the range that its drives' laws demand: nothing where it is covered.
///
/// Rows beyond are left empty where several drives meet a limit on their way; where one drive alone is asked to go too far
/// the demand is wrong ([`refused`]).
fn of_range(motion: &Motion) -> Option<Diagnostic> {
    let missed = missed_ends(motion);
    (!missed.is_empty()).then(|| beyond_limit(motion, &missed))
}

/// In words, what keeps a motion from covering the range that is demanded.
pub(crate) fn beyond_ends(motion: &Motion) -> Option<String> {
    of_range(motion).map(|told| told.message)
}

/// The ends of the demanded range that are not reached, with the reason.
fn missed_ends(motion: &Motion) -> Vec<(EndReason, f64)> {
    let ends = [
        (motion.ends.0, motion.demanded.0),
        (motion.ends.1, motion.demanded.1),
    ];
    let missed =
        |(reason, at): &(EndReason, f64)| *reason != EndReason::Covered && !motion.reaches(*at);
    ends.into_iter().filter(missed).collect()
}

/// Whether a study of the motion is not run at all: one drive alone is asked to go beyond its limit.
pub(crate) fn refused(motion: &Motion) -> bool {
    matches!(motion.path, DrivePath::Coordinate { .. })
        && (missed_ends(motion).iter()).any(|(reason, _)| *reason == EndReason::Limit)
}
