//! Studies of what moves by itself.
//!
//! ```toml
//! [studies.swing]
//! kind     = "simulate"
//! release  = ["motor"]                  # drives let go; all unless said otherwise
//! start    = { motor = "30 deg", motor_rate = "2 rad/s" }
//! until    = "2 s"
//! step     = "1 ms"
//! stops    = { rocker = ["-10 deg", "95 deg"] }
//! end_when = "angle(rocker) <= 0 deg"
//! ```

use kempe_units::{Comparison, Dimension, Expr, check_condition, parse_condition};

use crate::bound::Keeps;
use crate::condition::Condition;
use crate::drive::DriveKind;
use crate::ids::{DriveId, Scalar, Span};
use crate::key_table::{COORDINATES, METHODS, STOP};
use crate::measure::{Leaf, Measure, PoseMeasure};
use crate::motion_study::{MotionStudy, Rows};
use crate::node::{Key, Node, Text, Value};
use crate::read::context::{Context, Meaning, MeasureState};
use crate::read::entry::{Entry, bounds_of, entries};
use crate::read::laws::length_of_cylinder;
use crate::read::measure_names::Measures;
use crate::read::nature::nature;
use crate::read::play_start::{self, RATE};
use crate::read::rows::{both_ways, count, few_enough};
use crate::simulate_study::{DriveStart, PlayStart, SimulateStudy, Stop, StopResistance};
use crate::study::StudyKind;

/// Rows of a table when the file does not say.
const DEFAULT_ROWS: usize = 501;

/// Where the rows stand: every so many seconds, or so many in all.
pub(crate) fn rows(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Rows> {
    let place = &entry.place;
    match (entry.get("step"), entry.entry("rows")) {
        (None, None) => Some(Rows::Count(DEFAULT_ROWS)),
        (Some(_), Some((key, _))) => {
            both_ways(cx, key, place);
            None
        }
        (None, Some((_, node))) => count(cx, node, place),
        (Some(node), None) => {
            let step = cx.positive(node, Dimension::TIME, &entry.place_of("step"), false)?;
            let until = entry
                .get("until")
                .map(|until| cx.scalar(until, Dimension::TIME));
            // What is wrong with `until` is told where it is read.
            let until = until.flatten().map_or(0.0, |until| cx.number(&until));
            let rows = until / cx.number(&step);
            few_enough(cx, node, place, rows).then_some(Rows::TimeStep(step))
        }
    }
}

/// A study of what moves by itself.
pub(crate) fn simulate(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    in_time(cx, entry, along, true).map(StudyKind::Simulate)
}

/// How something moves in time; `all` tells whether all drives are let go, or none, where the study does not say.
pub(crate) fn in_time(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
    all: bool,
) -> Option<SimulateStudy> {
    let until = entry.needed(cx, "until");
    let tolerance = entry.value(cx, "tolerance");
    let method = entry.choice(cx, "method", &METHODS);
    // Joints with play are open anyway.
    let coordinates = match all {
        true => entry.choice(cx, "coordinates", &COORDINATES),
        false => Some(None),
    };
    let released = match all || entry.has("release") {
        true => released(cx, entry),
        false => Some(Vec::new()),
    };
    let start = match &released {
        // Drives keep their laws unless it is said otherwise where joints have play.
        Some(released) => start(cx, entry, released, !all),
        None => None,
    };
    let stops = stops(cx, entry);
    let end_when: Option<Vec<Condition>> = (entries(cx, entry, "end_when").into_iter())
        .map(|node| {
            let text = cx.text(
                node,
                &entry.place_of("end_when"),
                entry.example_of("end_when"),
            );
            text.and_then(|text| condition(cx, node, text))
        })
        .collect();
    let (start, plays) = start?;
    Some(SimulateStudy {
        along,
        released: released?,
        start,
        plays,
        until: until?,
        stops: stops?,
        end_when: end_when?,
        tolerance: tolerance?,
        method: method?,
        coordinates: coordinates?,
    })
}

/// The drives that are let go.
pub(crate) fn released(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Vec<DriveId>> {
    if !entry.has("release") {
        // A drive that is broken has been told.
        return cx.drives.iter().copied().collect();
    }
    let mut list: Vec<DriveId> = Vec::new();
    for node in entries(cx, entry, "release") {
        let place = entry.place_of("release");
        let text = cx.text(node, &place, "\"motor\"")?;
        let name = text.content.trim();
        let drive = drive_of(cx, name, node.span.clone())?;
        if list.contains(&drive) {
            return cx.refuse(
                "over-specified",
                format!("{place} names `{name}` twice"),
                &node.span,
                "leave one of the two out",
            );
        }
        list.push(drive);
    }
    if list.is_empty() {
        let (key, _) = entry.entry("release")?;
        return cx.refuse(
            "missing-key",
            format!("{} lets nothing go", entry.place),
            &key.span,
            "name what is let go, release = [\"motor\"], or leave `release` out: then all drives are",
        );
    }
    Some(list)
}

/// A drive by its name.
pub(crate) fn drive_of(cx: &mut Context<'_>, name: &str, span: Span) -> Option<DriveId> {
    if let Some(Meaning::Drive(i)) = cx.names.get(name).map(|(meaning, _)| *meaning) {
        return cx.drives.get(i).copied().flatten();
    }
    let drives = cx.model.drives.iter().map(|d| d.name.as_str());
    let d = cx.no_such("drive", name, span, drives);
    cx.push(d);
    None
}

/// Where and how fast drives start, and the bodies of joints where these may have play.
fn start(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    released: &[DriveId],
    have_play: bool,
) -> Option<(Vec<DriveStart>, Vec<PlayStart>)> {
    let (mut list, mut plays) = (Vec::new(), Vec::new());
    let Some(node) = entry.get("start") else {
        return Some((list, plays));
    };
    let table = cx.table(node, &entry.place_of("start"), entry.example_of("start"))?;
    let mut sound = true;
    for (key, node) in &table.entries {
        let read = match have_play && play_start::names(cx, &key.name) {
            true => play_start::read(cx, key, node, &mut plays),
            false => start_of(cx, key, node, released, &mut list),
        };
        sound &= read.is_some();
    }
    sound.then_some((list, plays))
}

fn start_of(
    cx: &mut Context<'_>,
    key: &Key,
    node: &Node,
    released: &[DriveId],
    list: &mut Vec<DriveStart>,
) -> Option<()> {
    let is_drive =
        |cx: &Context<'_>, name: &str| matches!(cx.names.get(name), Some((Meaning::Drive(_), _)));
    let rate_of = key.name.strip_suffix(RATE);
    let (name, is_rate) = match rate_of {
        Some(name) if !is_drive(cx, &key.name) => (name, true),
        _ => (key.name.as_str(), false),
    };
    let drive = drive_of(cx, name, key.span.clone())?;
    if !released.contains(&drive) {
        let names = released
            .iter()
            .filter_map(|id| cx.model.drives.get(id.index()));
        let names = names.map(|own| own.name.as_str()).chain([name]);
        let all: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
        let all = all.join(", ");
        return cx.refuse(
            "contradictory-values",
            format!("drive `{name}` keeps its law: it starts where that does"),
            &key.span,
            format!("let it go too, release = [{all}], or leave its start out"),
        );
    }
    let value = match is_rate {
        true => {
            let coordinate = cx.model.drives.get(drive.index())?.dimension;
            cx.scalar(node, coordinate / Dimension::TIME)?
        }
        false => coordinate(cx, drive, name, node)?,
    };
    let place = match list.iter().position(|s| s.drive == drive) {
        Some(place) => place,
        None => {
            list.push(DriveStart {
                drive,
                at: None,
                rate: None,
            });
            list.len() - 1
        }
    };
    let known = list.get_mut(place)?;
    *(if is_rate {
        &mut known.rate
    } else {
        &mut known.at
    }) = Some(value);
    Some(())
}

/// A coordinate of a drive that a study names.
pub(crate) fn coordinate(
    cx: &mut Context<'_>,
    drive: DriveId,
    name: &str,
    node: &Node,
) -> Option<Scalar> {
    let named = cx.model.drives.get(drive.index())?;
    let is_length = matches!(named.kind, DriveKind::Cylinder { .. });
    let value = cx.scalar(node, named.dimension)?;
    if is_length {
        length_of_cylinder(cx, &format!("drive `{name}`"), &value, &node.span)?;
    }
    Some(value)
}

fn stops(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Vec<Stop>> {
    let Some(node) = entry.get("stops") else {
        return Some(Vec::new());
    };
    let table = cx.table(node, &entry.place_of("stops"), entry.example_of("stops"))?;
    let stops: Vec<Option<Stop>> = table.entries.iter().map(|e| stop(cx, e)).collect();
    stops.into_iter().collect()
}

fn stop(cx: &mut Context<'_>, (key, node): &(Key, Node)) -> Option<Stop> {
    let (what, dimension) = stopped(cx, key)?;
    let is_angle = dimension == Dimension::ANGLE;
    if !is_angle && dimension != Dimension::LENGTH {
        return cx.refuse(
            "unit-mismatch",
            format!("`{}` is no angle and no length: nothing stops it", key.name),
            &key.span,
            "stop the angle of a link, the coordinate of a drive, or a measure of an angle or a length",
        );
    }
    let place = format!("the stop of `{}`", key.name);
    let (between, resistance) = match &node.value {
        // the bounds alone need no table
        Value::Array(_) => {
            let between = bounds_of(cx, node, dimension, &place, STOP.example)?;
            (between, StopResistance::Rigid { restitution: None })
        }
        _ => {
            let mut entry = Entry::inner(cx, node, &key.span, place.clone(), &STOP)?;
            entry.turning = is_angle;
            entry.required(cx, "between")?;
            let (between, resistance) = (entry.bounds(cx, "between"), resistance(cx, &entry));
            (between??, resistance?)
        }
    };
    let dimension = match is_angle {
        true => Dimension::ANGLE,
        false => Dimension::LENGTH,
    };
    in_order(cx, node, (&place, dimension), &between)?;
    Some(Stop {
        name: key.name.clone(),
        what,
        is_angle,
        between,
        resistance,
    })
}

fn in_order(
    cx: &mut Context<'_>,
    node: &Node,
    (place, dimension): (&str, Dimension),
    between: &[Option<Scalar>; 2],
) -> Option<()> {
    match between {
        [None, None] => cx.refuse(
            "missing-key",
            format!("{place} has no bound"),
            &node.span,
            "give the least value, the largest, or both",
        ),
        [Some(low), Some(high)] if cx.number(low) >= cx.number(high) => cx.refuse(
            "contradictory-values",
            format!("{place} leaves no room: its least value is not below its largest"),
            &node.span,
            "the least value stands first",
        ),
        [Some(low), Some(high)] => {
            let what = format!("{place}: the room between its least and largest value");
            cx.apart([low, high], &node.span, &what, dimension, Keeps::Positive);
            Some(())
        }
        _ => Some(()),
    }
}

/// The part of the speed that an impact gives back.
pub(crate) fn restitution(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Option<Scalar>> {
    let restitution = entry.value(cx, "restitution")?;
    let above_one = restitution.as_ref().is_some_and(|e| cx.number(e) > 1.0);
    if let (Some(scalar), Some(node)) = (&restitution, entry.get("restitution")) {
        let what = format!("the restitution of {}", entry.place);
        cx.bound(scalar, &node.span, &what, Dimension::NONE, Keeps::AtMostOne);
    }
    match entry.get("restitution").filter(|_| above_one) {
        None => Some(restitution),
        Some(node) => cx.refuse(
            "out-of-range",
            format!(
                "the restitution of {} is above 1: an impact would give energy",
                entry.place
            ),
            &node.span,
            "write a number from 0, which stays, to 1, which loses nothing",
        ),
    }
}

/// How a stop resists: at once, or as a spring.
fn resistance(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<StopResistance> {
    let restitution = restitution(cx, entry)?;
    let stiffness = entry.value(cx, "stiffness")?;
    let damping = entry.value(cx, "damping")?;
    if restitution.is_some() && stiffness.is_some() {
        entry.contradiction(
            cx,
            &["restitution", "stiffness"],
            "it resists at once, or as a spring",
            "leave one of them out; what a spring loses is its damping",
        );
        return None;
    }
    entry.idle(cx, &["damping"], "stiffness");
    Some(match stiffness {
        Some(stiffness) => StopResistance::Soft { stiffness, damping },
        None => StopResistance::Rigid { restitution },
    })
}

/// What a stop bounds: the angle of a link, the coordinate of a drive, a named measure.
fn stopped(cx: &mut Context<'_>, key: &Key) -> Option<(Measure, Dimension)> {
    match cx.names.get(&key.name).map(|(meaning, _)| *meaning) {
        Some(Meaning::Link(link)) => Some((
            Expr::Leaf(Leaf::Pose(PoseMeasure::Angle(link))),
            Dimension::ANGLE,
        )),
        Some(Meaning::Drive(i)) => {
            let drive = cx.drives.get(i).copied().flatten()?;
            let dimension = cx.model.drives.get(drive.index())?.dimension;
            Some((Expr::Leaf(Leaf::Drive(drive)), dimension))
        }
        Some(Meaning::Measure(i)) => match cx.measures.get(i) {
            Some(MeasureState::Sound(index, dimension)) => {
                let measure = Expr::Leaf(Leaf::Named(*index));
                let dimension = *dimension;
                if nature(&measure, &cx.natures).pressure {
                    return cx.refuse(
                        "bad-choice",
                        format!("`{}` goes by a pressure, which no stop holds", key.name),
                        &key.span,
                        "stop the angle of a link, the coordinate of a drive, or a measure of where things are",
                    );
                }
                of_the_pose(cx, &measure, &key.span)?;
                Some((measure, dimension))
            }
            _ => None,
        },
        _ => {
            let links = cx.model.links.iter().skip(1).map(|l| l.name.as_str());
            let drives = cx.model.drives.iter().map(|d| d.name.as_str());
            let measures = cx.model.measures.iter().map(|m| m.name.as_str());
            let names = links.chain(drives).chain(measures);
            let d = cx.no_such("link, drive or measure", &key.name, key.span.clone(), names);
            cx.push(d);
            None
        }
    }
}

/// Refuses what is not known at an instant of a motion that is still to be found.
fn of_the_pose(cx: &mut Context<'_>, measure: &Measure, span: &Span) -> Option<()> {
    let nature = nature(measure, &cx.natures);
    let (code, what) = match (nature.forces, nature.motion) {
        (true, _) => ("force-in-condition", "a force"),
        (_, true) => ("not-at-one-instant", "a number over the whole motion"),
        _ if nature.inner_rate => ("not-at-one-instant", "the rate of a pressure or a switch"),
        _ if asks_path(cx, measure) => ("not-at-one-instant", "a length of path"),
        _ => return Some(()),
    };
    cx.refuse(
        code,
        format!("this asks for {what}, which is not known while the motion is being found"),
        span,
        "stop and end it by where things are and how fast they move",
    )
}

/// Whether a measure asks how far a point has come, itself or by another measure, which stands before it.
fn asks_path(cx: &Context<'_>, measure: &Measure) -> bool {
    measure.leaves().any(|leaf| match leaf {
        Leaf::Pose(PoseMeasure::PathLength(_)) => true,
        Leaf::Rate(inner, _) => asks_path(cx, inner),
        Leaf::Named(index) => {
            let named = cx.model.measures.get(*index);
            named.is_some_and(|named| asks_path(cx, &named.measure))
        }
        _ => false,
    })
}

/// `angle(rocker) <= 0 deg`.
pub(crate) fn condition(cx: &mut Context<'_>, node: &Node, text: &Text) -> Option<Condition> {
    let checked = parse_condition(&text.content)
        .and_then(|condition| check_condition(&condition, &mut Measures(cx)));
    let condition = match checked {
        Ok(condition) => condition,
        Err(issues) => {
            cx.issues(text, issues);
            return None;
        }
    };
    let (small, large) = match condition.comparison {
        Comparison::Less | Comparison::LessEqual => (condition.left, condition.right),
        Comparison::Greater | Comparison::GreaterEqual => (condition.right, condition.left),
    };
    let above = Expr::Sub(Box::new(large), Box::new(small));
    of_the_pose(cx, &above, &node.span)?;
    Some(Condition {
        text: text.content.trim().to_owned(),
        above,
        dimension: condition.dimension,
    })
}
