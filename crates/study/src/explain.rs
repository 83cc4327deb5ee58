//! Why there is no motion, or less than was asked for, in the words of the file.

use kempe_mechanism::plan::{Condition, Step, Swing};
use kempe_mechanism::structure::BodyId;
use kempe_mechanism::{Design, Mechanism};
use kempe_model::{Diagnostic, Drive, LinkId, Model};
use kempe_motion::assemble::Assemblies;
use kempe_motion::check::mobility_standing;
use kempe_motion::drive_path::DrivePath;
use kempe_motion::{EndReason, Motion, MotionError, SIZES, Stage};
use kempe_units::Dimension;

use crate::gap::{Gap, gap};
use crate::hints;
use crate::lone_points::with_lone_points;
use crate::unit::{Units, shown};
use crate::words::{list, source_name};

/// A motion along time that stops this near to a break of a law, as a part of its time, stops there.
const AT_BREAK: f64 = 1e-6;

/// Two of these bodies' links that share two points and so turn as one link, if there are such.
fn joined_twice(mechanism: &Mechanism, bodies: &[BodyId]) -> Option<String> {
    let model = &mechanism.model;
    let loose = |link: &LinkId| bodies.contains(&mechanism.body_of(*link));
    let links: Vec<LinkId> = (0..model.links.len() as u32)
        .map(LinkId)
        .filter(loose)
        .collect();
    for (k, b) in links.iter().enumerate() {
        for a in &links[..k] {
            let shared = model
                .points
                .iter()
                .filter(|p| p.links.contains(a) && p.links.contains(b));
            let names: Vec<String> = shared.map(|p| p.name.clone()).collect();
            if names.len() > 1 {
                let [a, b] = [a, b].map(|link| &model.links[link.index()].name);
                return Some(format!(
                    "`{a}` and `{b}` share {}: they turn as one link",
                    list(&names)
                ));
            }
        }
    }
    None
}

/// A motion that does not start, as a diagnostic over the model file.
pub fn cannot_move(design: &Design<f64>, error: &MotionError) -> Diagnostic {
    let mechanism = &*design.mechanism;
    let plan = &mechanism.plan;
    let model = &mechanism.model;
    match error {
        MotionError::NoDrive if model.links.len() == 1 => Diagnostic::error(
            "no-mechanism",
            "the file asks for linkages, and has none of its own",
        )
        .help("run it with --out results: the linkages found are model files there"),
        MotionError::NoDrive => Diagnostic::error("no-drive", "nothing moves the mechanism")
            .help("say what moves: [drives] motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }"),
        MotionError::Undetermined { bodies } => {
            let names: Vec<String> = bodies.iter().map(|b| format!("`{}`", mechanism.body_name(*b))).collect();
            let mut diagnostic = Diagnostic::error(
                "undetermined",
                format!("no drive determines where {} {}", list(&names), if names.len() == 1 { "is" } else { "are" }),
            );
            for link in model.links.iter().zip(&mechanism.seats).filter(|(_, seat)| bodies.contains(&seat.body)) {
                diagnostic = diagnostic.at(link.0.span.clone(), "free");
            }
            for (_, point) in &plan.decomposition.as_one {
                let name = &model.points[point.index()].name;
                diagnostic = diagnostic.note(format!(
                    "they hold each other and turn as one about {name}: a drive between them cannot move them"
                ));
            }
            if let Some(twice) = joined_twice(mechanism, bodies) {
                diagnostic = diagnostic.note(twice);
            }
            let otherwise = "every freedom needs a drive: add one, or a joint that holds the links";
            with_lone_points(diagnostic, model, mechanism, bodies, otherwise)
        }
        MotionError::CannotAssemble { at, assemblies } => {
            let place = start_text(mechanism, *at);
            let open = assemblies.open.as_ref().map(|open| gap(design, *at, open));
            match assemblies.rejected {
                0 => not_closed(design, &place, open),
                _ => against_sides(design, (&place, assemblies), open),
            }
        }
        MotionError::Entangled { at } => entangled(&match model.drives.as_slice() {
            [_] => start_text(mechanism, *at),
            _ => at_time(model, *at),
        })
        .help("change a length a little, or keep the drive away from that place"),
        MotionError::Stopped { stage } => stopped(*stage),
        MotionError::Scale { size } => Diagnostic::error(
            "scale",
            format!("the mechanism measures {size:.1e} m: lengths of this size cannot be computed with"),
        )
        .note(format!("products of lengths must neither overflow nor vanish: from {:e} m to {:e} m there is room", SIZES.0, SIZES.1))
        .help(format!(
            "check the units: a bare length is in {}",
            model.units.length.name
        )),
        MotionError::Locked { at, assemblies } => {
            let drive = if model.drives.len() == 1 { "drive" } else { "drives" };
            let diagnostic = Diagnostic::error(
                "locked",
                format!("{} the mechanism is locked: the {drive} cannot move it in any direction", start_text(mechanism, *at)),
            );
            let diagnostic = match surplus_note(mechanism) {
                None => diagnostic.help("start the drive elsewhere: here it stands at a dead point"),
                Some(note) => {
                    let diagnostic = match gives(design, assemblies) {
                        true => diagnostic.note("its links give by a hair, as bars in line do: a freedom by rank from which no motion follows"),
                        false => diagnostic,
                    };
                    diagnostic
                        .note(note)
                        .help("leave out a drive or a joint that is one too many")
                }
            };
            model.drives.iter().fold(diagnostic, |d, drive| d.at(drive.span.clone(), ""))
        }
    }
}

/// A mechanism that has no assembly at all.
fn not_closed(design: &Design<f64>, place: &str, gap: Option<Gap>) -> Diagnostic {
    let mechanism = &*design.mechanism;
    let gap = gap.unwrap_or_default();
    let diagnostic = Diagnostic::error(
        "cannot-assemble",
        format!("{place} the mechanism cannot be assembled: {}", gap.message),
    );
    let diagnostic = match surplus_note(mechanism) {
        None => diagnostic.help(gap.remedy()),
        Some(note) => diagnostic.note(note).help(
            "leave out a drive or a joint that is one too many, or make the lengths agree exactly",
        ),
    };
    let diagnostic = at_links(diagnostic, mechanism, &gap);
    let drives = mechanism.model.drives.iter();
    drives.fold(diagnostic, |d, drive| {
        d.see(drive.span.clone(), "where it starts")
    })
}

/// A mechanism with assemblies of which none agrees with the file's sides: they may contradict each other, or lengths not reach on these sides.
fn against_sides(
    design: &Design<f64>,
    (place, assemblies): (&str, &Assemblies),
    gap: Option<Gap>,
) -> Diagnostic {
    let mechanism = &*design.mechanism;
    let without = match assemblies.rejected {
        1 => "is one without it".to_owned(),
        n => format!("are {n} without it"),
    };
    let message = format!("{place} no assembly agrees with [assembly], though there {without}");
    let diagnostic = Diagnostic::error("cannot-assemble", message);
    let agrees = assemblies.open.as_ref().is_some_and(|open| open.agrees);
    let gap = gap.filter(|_| agrees);
    let diagnostic = match &gap {
        None => {
            diagnostic.help("change a side, or leave the sides out to see what `kempe check` finds")
        }
        Some(gap) => diagnostic
            .note(format!("on the sides asked for {}", gap.message))
            .help(format!("change a side, or {}", gap.remedy())),
    };
    let diagnostic = match hints::nearest(design, assemblies) {
        Some(lies) => diagnostic.note(format!("the one that agrees with most of them has {lies}")),
        None => diagnostic,
    };
    let against = hints::contradiction(design, assemblies);
    let label = match against.len() {
        1 => "no assembly agrees with this",
        _ => "no assembly agrees with these together",
    };
    let labelled = against.iter().enumerate();
    let diagnostic = labelled.fold(diagnostic, |d, (k, index)| {
        let span = mechanism.model.assembly[*index].span.clone();
        d.at(span, if k == 0 { label } else { "" })
    });
    gap.iter()
        .fold(diagnostic, |d, gap| at_links(d, mechanism, gap))
}

/// Underlines the links that do not meet.
fn at_links(diagnostic: Diagnostic, mechanism: &Mechanism, gap: &Gap) -> Diagnostic {
    let links = mechanism.model.links.iter();
    let links = links.filter(|link| gap.links.contains(&link.name));
    links.fold(diagnostic, |d, link| d.at(link.span.clone(), ""))
}

/// By how much a mechanism that cannot be assembled does not meet, in its sizes, where that is known.
pub(crate) fn open_by(design: &Design<f64>, error: &MotionError) -> Option<f64> {
    match error {
        MotionError::CannotAssemble { at, assemblies } if assemblies.rejected == 0 => {
            gap(design, *at, assemblies.open.as_ref()?).by
        }
        _ => None,
    }
}

/// Whether a locked mechanism has a freedom of first order.
fn gives(design: &Design<f64>, assemblies: &Assemblies) -> bool {
    let rank = mobility_standing(design, assemblies).by_rank;
    rank.is_some_and(|rank| rank > 0)
}

/// What holds the links besides what decides where they are; `None` when nothing does.
fn surplus_note(mechanism: &Mechanism) -> Option<String> {
    let parts = &mechanism.plan.decomposition;
    let surplus = parts
        .blocks
        .iter()
        .flat_map(|b| &b.surplus)
        .chain(&parts.surplus);
    let mut named: Vec<String> = surplus
        .filter_map(|row| mechanism.constraints.get(row.constraint))
        .map(|(_, source)| format!("`{}`", source_name(&mechanism.model, *source)))
        .collect();
    named.dedup();
    (!named.is_empty()).then(|| {
        format!(
            "by count the links are fixed more often than they can move: without {} the rest decides everything",
            list(&named)
        )
    })
}

/// Work that was stopped before its first row.
pub(crate) fn stopped(stage: Stage) -> Diagnostic {
    Diagnostic::error(
        "stopped",
        format!("stopped while {}: there are no rows yet", stage.text()),
    )
}

/// What was simulated, but is no motion that could be followed.
pub(crate) fn cannot_follow(design: &Design<f64>, error: &MotionError) -> Diagnostic {
    match error {
        MotionError::Entangled { at } => entangled(&at_time(&design.mechanism.model, *at))
            .help("change a length a little, or start farther from the dead point or change point"),
        _ => cannot_move(design, error),
    }
}

fn entangled(at: &str) -> Diagnostic {
    let message = format!(
        "{at} branches come so near each other that the motion could not be kept on one of them"
    );
    Diagnostic::error("branches-entangled", message)
}

fn at_time(model: &Model, time: f64) -> String {
    format!("at time = {}", Units::of(model).text(time, Dimension::TIME))
}

/// `at motor = 0 deg`, or where it starts.
fn start_text(mechanism: &Mechanism, at: f64) -> String {
    let model = &mechanism.model;
    match model.drives.as_slice() {
        [drive] => format!(
            "at {} = {}",
            drive.name,
            Units::of(model).text(at, drive.dimension)
        ),
        _ => "where the drives start".to_owned(),
    }
}

/// A demanded range that is not covered. `missed` are the ends that are not reached, with the reason.
pub fn beyond_limit(motion: &Motion, missed: &[(EndReason, f64)]) -> Diagnostic {
    let model = &motion.mechanism().model;
    let units = Units::of(model);
    let (low, high) = motion.reached();
    let (name, dimension, span) = match motion.path {
        DrivePath::Coordinate { drive, .. } => match model.drives.get(drive) {
            Some(d) => (
                format!("drive `{}`", d.name),
                d.dimension,
                Some(d.span.clone()),
            ),
            None => ("the motion".to_owned(), Dimension::TIME, None),
        },
        DrivePath::Time { .. } => ("the motion".to_owned(), Dimension::TIME, None),
    };
    let ends: Vec<String> = missed
        .iter()
        .map(|(_, at)| {
            let limit = if *at > high { high } else { low };
            let by = units.text((*at - limit).abs(), dimension);
            match units.texts([*at, limit], dimension) {
                [at, limit] if at == limit => format!("{at} is beyond {limit} by {by}"),
                [at, limit] => format!("{at} is beyond {limit}"),
            }
        })
        .collect();
    let stuck = missed.iter().all(|(r, _)| *r == EndReason::Stuck);
    let limited = missed.iter().any(|(r, _)| *r == EndReason::Limit);
    let too_long = missed.iter().all(|(r, _)| *r == EndReason::TooLong);
    let (code, message) = if too_long {
        (
            "range-too-long",
            format!(
                "{name} has a longer way than can be followed: {}",
                list(&ends)
            ),
        )
    } else if !stuck && !limited {
        (
            "motion-runs-away",
            format!(
                "{name} cannot cover its range, as a part runs away to infinity on the way: {}",
                list(&ends)
            ),
        )
    } else if stuck {
        (
            "motion-stuck",
            format!(
                "{name} could not be followed over its whole range: {}",
                list(&ends)
            ),
        )
    } else {
        (
            "range-beyond-limit",
            format!("{name} cannot cover its range: {}, its limit", list(&ends)),
        )
    };
    let falls = falls(motion);
    let range = match falls {
        true => (high, low),
        false => (low, high),
    };
    let mut diagnostic = Diagnostic::error(code, message).note(format!(
        "from {} can be reached, on the circuit of this assembly",
        units.range_text(range, dimension)
    ));
    if too_long {
        return diagnostic.help("ask for a shorter range: every turn of a cycle is like the first");
    }
    if limited
        && let Some(group) = limiting_group(
            motion,
            if missed.iter().any(|(_, at)| *at > high) {
                high
            } else {
                low
            },
        )
    {
        diagnostic = diagnostic.note(format!("at the limit {group}"));
    }
    if let Some(span) = span {
        diagnostic = diagnostic.at(span, "the demanded range goes further than the mechanism");
        if !stuck {
            let unit = units.unit(dimension);
            let [a, b, low, high] =
                [motion.demanded.0, motion.demanded.1, low, high].map(|x| shown(x, &unit));
            let text = |x: f64| units.text(unit.to_si(x), dimension);
            let [first, last] = [inside(a, low, high, true), inside(b, low, high, false)].map(text);
            let (from, to) = match falls {
                true => (last, first),
                false => (first, last),
            };
            diagnostic = diagnostic.help(format!("ask for no more than \"{from}\" to \"{to}\""));
        } else {
            diagnostic = diagnostic.help("start the drive elsewhere or change a length a little: branches may meet where it stopped");
        }
    } else {
        let ends = missed
            .iter()
            .map(|(_, at)| if *at > high { high } else { low });
        let breaking = breaking_at(motion, &ends.collect::<Vec<_>>());
        for drive in breaking.iter().filter(|_| stuck) {
            diagnostic = diagnostic
                .at(drive.span.clone(), "its law starts, ends or changes there")
                .note(format!("the law of `{}` starts, ends or changes where branches meet: how the motion goes on there was not found", drive.name));
        }
        diagnostic = match stuck && !breaking.is_empty() {
            true => diagnostic.help("let the law go through that place, or start and end a little beside it"),
            false => diagnostic.help("the rows beyond carry the reason in their note; change the drives' laws or the lengths"),
        };
    }
    diagnostic
}

/// The drives whose laws are not smooth where a motion along time stopped.
fn breaking_at<'a>(motion: &'a Motion, stops: &[f64]) -> Vec<&'a Drive> {
    let parameters = &motion.design.parameters;
    let near = AT_BREAK * (motion.demanded.1 - motion.demanded.0);
    let breaks = |drive: &&Drive| {
        let breaks = drive.law.breaks(parameters);
        (breaks.iter()).any(|t| stops.iter().any(|stop| (t - stop).abs() <= near))
    };
    let drives = motion.mechanism().model.drives.iter();
    drives.filter(breaks).collect()
}

/// Whether a motion goes from the high end of its range to the low one.
fn falls(motion: &Motion) -> bool {
    let DrivePath::Coordinate { drive, .. } = motion.path else {
        return false;
    };
    let parameters = &motion.design.parameters;
    (motion.mechanism().model.drives.get(drive))
        .is_some_and(|drive| drive.law.way(parameters) < 0.0)
}

/// A demanded end (in the unit shown), or where it is not reached a round place a little inside the limit.
fn inside(demanded: f64, low: f64, high: f64, lower: bool) -> f64 {
    let margin = 1e-2 * (high - low).abs();
    let step = if margin > 0.0 {
        kempe_number::powi(10.0, kempe_number::math::log10(margin).floor() as i32)
    } else {
        return demanded;
    };
    let round = |x: f64| crate::unit::rounded(x * step);
    if lower && demanded < low {
        round((low / step).ceil())
    } else if !lower && demanded > high {
        round((high / step).floor())
    } else {
        demanded
    }
}

/// Which links stand in line at a limit.
fn limiting_group(motion: &Motion, at: f64) -> Option<String> {
    let near = |x: f64| (x - at).abs() <= 1e-9 * at.abs().max(1.0);
    let event = motion
        .events
        .iter()
        .find(|e| near(e.at) && !e.steps.is_empty())?;
    let block = motion.mechanism().plan.blocks.get(*event.steps.first()?)?;
    let mut bodies: Vec<_> = block.unknowns.iter().map(|u| u.body()).collect();
    bodies.dedup();
    bodies.sort_unstable();
    bodies.dedup();
    let names: Vec<String> = bodies
        .iter()
        .map(|b| format!("`{}`", motion.mechanism().body_name(*b)))
        .collect();
    match (
        motion.mechanism().plan.steps.get(*event.steps.first()?)?,
        names.len(),
    ) {
        (Step::Dyad { .. }, 2) => Some(format!("{} stand in line", list(&names))),
        (
            Step::Swing(Swing {
                condition: Condition::Radius { input, .. },
                ..
            }),
            1,
        ) => {
            let drive = motion.mechanism().model.drives.get(input.index())?;
            let cylinder = &drive.name;
            Some(format!(
                "{} and the cylinder `{cylinder}` stand in line",
                names[0]
            ))
        }
        (_, 0) => None,
        (_, 1) => Some(format!("{} cannot be placed any further", names[0])),
        _ => Some(format!("the group of {} reaches its end", list(&names))),
    }
}
