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

use crate::bound::Keeps;
use crate::diagnostic::Diagnostic;
use crate::ids::{DriveId, FRAME, LinkId, PointId, Scalar};
use crate::key_table::GOALS;
use crate::measure::{Leaf, Measure};
use crate::motion_study::MotionStudy;
use crate::node::Node;
use crate::read::context::Context;
use crate::read::entry::{Entry, link_of};
use crate::read::measures::measure_text;
use crate::read::nature::nature;
use crate::read::simulate::drive_of;
use crate::study::{BalanceGoal, BalanceStudy, SpringStudy, StudyKind};

/// A study of counterweights.
pub(crate) fn balance(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    let goal = entry.choice(cx, "goal", &GOALS);
    let radius = entry.needed(cx, "radius");
    let node = entry.required(cx, "on")?;
    let place = entry.place_of("on");
    let mut on = Vec::new();
    for node in cx.array(node, &place, entry.example_of("on"))? {
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
        return cx.refuse(
            "missing-key",
            format!("{place} names no link"),
            &node.span,
            "say which links may carry a counterweight: on = [\"crank\"]",
        );
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
    entry: &mut Entry<'_>,
    along: MotionStudy,
) -> Option<StudyKind> {
    let chosen = spring_named(cx, entry);
    let drive = drive_named(cx, entry);
    let (spring, tension) = chosen?;
    let (drive, coordinate) = drive?;
    entry.turning = coordinate == Dimension::ANGLE;
    let wanted = wanted(cx, entry);
    entry.turning = tension == Dimension::TORQUE;
    let stiffness = bounds(cx, entry, "stiffness");
    let preload = bounds(cx, entry, "preload");
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
    let text = entry.text(cx, "spring", node)?;
    let name = text.content.trim();
    if let Some(found) = cx.springs.get(name) {
        return *found;
    }
    let springs = cx.springs.keys().map(String::as_str);
    let mut d = cx.no_such("spring", name, node.span.clone(), springs);
    if cx.springs.is_empty() {
        d = d.help("describe its ends under [springs]; stiffness and preload are chosen here");
    }
    cx.push(d);
    None
}

pub(crate) fn drive_named(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<(DriveId, Dimension)> {
    let found = |cx: &Context<'_>, id: DriveId| {
        let drive = cx.model.drives.get(id.index())?;
        Some((id, drive.dimension))
    };
    if !entry.has("drive") && cx.model.drives.len() == 1 {
        return found(cx, DriveId(0));
    }
    if !entry.has("drive") && cx.drives.len() == 1 {
        // the only drive is wrong, and told to be
        return None;
    }
    let node = entry.required(cx, "drive")?;
    let text = entry.text(cx, "drive", node)?;
    let id = drive_of(cx, text.content.trim(), node.span.clone())?;
    found(cx, id)
}

/// What the drive is to give: nothing unless said otherwise.
fn wanted(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Measure> {
    let effort = entry.dimension("wanted");
    let Some(node) = entry.get("wanted") else {
        return Some(Expr::Const(0.0));
    };
    let crate::node::Value::Text(text) = &node.value else {
        return cx.scalar(node, effort).map(constant);
    };
    let (measure, dimension) = measure_text(cx, text)?;
    if !dimension.compatible(effort) {
        return cx.refuse(
            "unit-mismatch",
            format!("{effort} expected, found {}", dimension.with_article()),
            &node.span,
            "say what the drive is to give: wanted = \"0 N m\", or a measure along the motion",
        );
    }
    if nature(&measure, &cx.natures).forces {
        return cx.refuse(
            "force-depends-on-force",
            "the wanted effort asks for a force",
            &node.span,
            "give it over drives, time and measures of the motion",
        );
    }
    Some(measure)
}

/// An expression over parameters as a measure.
fn constant(scalar: Scalar) -> Measure {
    scalar.map_leaves(&mut |id| Leaf::Parameter(*id))
}

/// Two bounds in order.
fn bounds(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    key: &str,
) -> Option<Option<[Option<Scalar>; 2]>> {
    let Some([low, high]) = entry.bounds(cx, key)? else {
        return Some(None);
    };
    if let (Some(low), Some(high)) = (&low, &high)
        && cx.number(low) > cx.number(high)
    {
        entry.contradiction(
            cx,
            &[key],
            &format!("the lower bound of the {key} lies above the upper one"),
            "write the smaller one first",
        );
        return None;
    }
    if let (Some(low), Some(high), Some(node)) = (&low, &high, entry.get(key)) {
        let what = format!("{}: the room between the bounds of the {key}", entry.place);
        cx.apart(
            [low, high],
            &node.span,
            &what,
            Dimension::NONE,
            Keeps::NotNegative,
        );
    }
    Some(Some([low, high]))
}
