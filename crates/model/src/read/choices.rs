//! Studies that choose something: counterweights, a spring.
//!
//! ```toml
//! [studies.quiet]
//! kind   = "balance"
//! goal   = "shaking force"          # or "statics"
//! on     = ["crank", "rocker"]      # links pinned to the frame
//! radius = "60 mm"                  # of the counterweights, from those pins
//!
//! [studies.assist]
//! kind      = "spring"
//! spring    = "back"
//! drive     = "motor"
//! wanted    = "0 N m"               # what the drive is to give
//! stiffness = ["0 N/mm", "5 N/mm"]
//! preload   = [0, "200 N"]
//! ```

use kempe_units::{Dimension, Expr};

use crate::diagnostic::Diagnostic;
use crate::document::Node;
use crate::measure::{Leaf, Measure};
use crate::model::{
    BalanceGoal, BalanceStudy, DriveId, FRAME, LinkId, MotionStudy, PointId, Scalar, SpringStudy,
    StudyKind,
};
use crate::read::context::{Context, Meaning};
use crate::read::entry::{Entry, link_of};
use crate::read::measures::measure_text;
use crate::read::nature::nature;

/// Keys of a study of counterweights.
pub(crate) const BALANCE_KEYS: &[&str] = &["kind", "step", "rows", "goal", "on", "radius"];

/// Keys of a study that chooses a spring.
pub(crate) const SPRING_KEYS: &[&str] = &[
    "kind",
    "step",
    "rows",
    "spring",
    "drive",
    "wanted",
    "stiffness",
    "preload",
];

/// What counterweights may be for.
pub(crate) const GOALS: &[(&str, BalanceGoal)] = &[
    ("shaking force", BalanceGoal::ShakingForce),
    ("statics", BalanceGoal::Statics),
];

/// A study of counterweights.
pub(crate) fn balance(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    let goal = entry.choice(cx, "goal", GOALS);
    let radius = entry.required_positive(cx, "radius", Dimension::LENGTH, false);
    let node = entry.required(cx, "on")?;
    let place = format!("`on` of {}", entry.place);
    let mut on = Vec::new();
    for node in cx.array(node, &place, "[\"crank\"]")? {
        let link = link_of(cx, node, &place)?;
        let pivot = pivot(cx, link, node)?;
        if on.iter().any(|(known, _)| *known == link) {
            let name = cx.link_name(link).to_owned();
            cx.push(
                Diagnostic::error("over-specified", format!("{place} names `{name}` twice"))
                    .at(node.span.clone(), "named before")
                    .help("leave one of the two out: a link carries one counterweight"),
            );
        } else {
            on.push((link, pivot));
        }
    }
    if on.is_empty() {
        cx.push(
            Diagnostic::error("missing-key", format!("{place} names no link"))
                .at(node.span.clone(), "")
                .help("say which links may carry a counterweight: on = [\"crank\"]"),
        );
        return None;
    }
    Some(StudyKind::Balance(BalanceStudy {
        along,
        goal: goal?.unwrap_or(BalanceGoal::ShakingForce),
        on,
        radius: radius?,
    }))
}

/// The pin of a link on the frame.
fn pivot(cx: &mut Context<'_>, link: LinkId, node: &Node) -> Option<PointId> {
    let mut points = (0..cx.model.points.len() as u32).map(PointId);
    let found = points.find(|p| {
        let carriers = cx.carriers(*p);
        link != FRAME && carriers.contains(&link) && carriers.contains(&FRAME)
    });
    if found.is_none() {
        let name = cx.link_name(link).to_owned();
        cx.push(
            Diagnostic::error(
                "no-common-point",
                format!("`{name}` is not pinned to the frame"),
            )
            .at(node.span.clone(), "")
            .help("a counterweight turns about a pin of its link on the frame"),
        );
    }
    found
}

/// A study that chooses a spring.
pub(crate) fn spring(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    let chosen = spring_named(cx, entry);
    let drive = drive_named(cx, entry);
    let (spring, tension) = chosen?;
    let (drive, coordinate) = drive?;
    let effort = if coordinate == Dimension::ANGLE {
        Dimension::TORQUE
    } else {
        Dimension::FORCE
    };
    let wanted = wanted(cx, entry, effort);
    let stretch = if tension == Dimension::TORQUE {
        Dimension::ANGLE
    } else {
        Dimension::LENGTH
    };
    let stiffness = bounds(cx, entry, "stiffness", tension / stretch);
    let preload = bounds(cx, entry, "preload", tension);
    Some(StudyKind::Spring(SpringStudy {
        along,
        spring,
        drive,
        wanted: wanted?,
        stiffness: stiffness?.unwrap_or([Some(Expr::Const(0.0)), None]),
        preload: preload?.unwrap_or([None, None]),
    }))
}

fn spring_named(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<(usize, Dimension)> {
    let node = entry.required(cx, "spring")?;
    let text = cx.text(node, &format!("`spring` of {}", entry.place), "\"back\"")?;
    let name = text.content.trim();
    match cx.springs.get(name) {
        Some(found) => *found,
        None => {
            let springs: Vec<&str> = cx.springs.keys().map(String::as_str).collect();
            let help = match kempe_units::nearest(name, springs.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if !springs.is_empty() => {
                    format!(
                        "the springs are {}",
                        springs.get(..12).unwrap_or(&springs).join(", ")
                    )
                }
                None => "describe its ends under [springs]; stiffness and preload are chosen here"
                    .to_owned(),
            };
            cx.push(
                Diagnostic::error("unknown-name", format!("there is no spring `{name}`"))
                    .at(node.span.clone(), "not declared")
                    .help(help),
            );
            None
        }
    }
}

fn drive_named(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<(DriveId, Dimension)> {
    let found = |cx: &Context<'_>, id: DriveId| {
        let drive = cx.model.drives.get(id.index())?;
        Some((id, drive.dimension))
    };
    let Some(node) = entry.table.get("drive") else {
        if cx.model.drives.len() == 1 {
            return found(cx, DriveId(0));
        }
        entry.required(cx, "drive");
        return None;
    };
    let text = cx.text(node, &format!("`drive` of {}", entry.place), "\"motor\"")?;
    let name = text.content.trim();
    if let Some(Meaning::Drive(i)) = cx.names.get(name).map(|(meaning, _)| *meaning) {
        let id = cx.drives.get(i).copied().flatten()?;
        return found(cx, id);
    }
    let drives = cx.model.drives.iter().map(|d| d.name.as_str());
    let help = match kempe_units::nearest(name, drives) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "name the drive that the spring is to help".to_owned(),
    };
    cx.push(
        Diagnostic::error("unknown-name", format!("there is no drive `{name}`"))
            .at(node.span.clone(), "not declared")
            .help(help),
    );
    None
}

/// What the drive is to give: nothing unless said otherwise.
fn wanted(cx: &mut Context<'_>, entry: &Entry<'_>, effort: Dimension) -> Option<Measure> {
    let Some(node) = entry.table.get("wanted") else {
        return Some(Expr::Const(0.0));
    };
    let crate::document::Value::Text(text) = &node.value else {
        return cx.scalar(node, effort).map(constant);
    };
    let (measure, dimension) = measure_text(cx, text)?;
    if !dimension.compatible(effort) {
        cx.push(
            Diagnostic::error(
                "unit-mismatch",
                format!("{effort} expected, found {}", dimension.with_article()),
            )
            .at(node.span.clone(), "")
            .help(
                "say what the drive is to give: wanted = \"0 N m\", or a measure along the motion",
            ),
        );
        return None;
    }
    if nature(&measure, &cx.natures).forces {
        cx.push(
            Diagnostic::error(
                "force-depends-on-force",
                "the wanted effort asks for a force",
            )
            .at(node.span.clone(), "")
            .help("give it over drives, time and measures of the motion"),
        );
        return None;
    }
    Some(measure)
}

/// An expression over parameters as a measure.
fn constant(scalar: Scalar) -> Measure {
    scalar.map_leaves(&mut |id| Leaf::Parameter(*id))
}

/// Two bounds, `"none"` for no bound; the outer `None` when they are wrong.
fn bounds(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
    dimension: Dimension,
) -> Option<Option<[Option<Scalar>; 2]>> {
    let Some(node) = entry.table.get(key) else {
        return Some(None);
    };
    let (low, high) = entry.two(cx, node, key)?;
    let mut bound = |node: &Node| match &node.value {
        crate::document::Value::Text(text) if text.content.trim() == "none" => Some(None),
        _ => cx.scalar(node, dimension).map(Some),
    };
    let (low, high) = (bound(low)?, bound(high)?);
    if let (Some(low), Some(high)) = (&low, &high)
        && cx.number(low) > cx.number(high)
    {
        cx.push(
            Diagnostic::error(
                "contradictory-values",
                format!(
                    "{}: the lower bound of the {key} lies above the upper one",
                    entry.place
                ),
            )
            .at(node.span.clone(), "")
            .help("write the smaller one first"),
        );
        return None;
    }
    Some(Some([low, high]))
}
