//! The two points between which a spring, a damper or a cylinder acts, each with the link that it acts on there.

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, LinkPointRef, PointId};
use crate::node::Value;
use crate::read::carrier::{carrier, not_named};
use crate::read::context::Context;
use crate::read::entry::{Entry, carriers_of, link_of};

/// The ends at two points that no link has in common: on a link that `on` names, or else on the frame, which anchors what
/// ends at it, or else on the link that [`carrier`] finds, with a warning where another could be meant.
pub(crate) fn ends(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    points: [PointId; 2],
) -> Option<([LinkPointRef; 2], Option<Diagnostic>)> {
    let named = named(cx, entry, points)?;
    let mut taken = Vec::new();
    let mut end = |point: PointId| {
        let given = named.iter().find(|(_, p)| *p == point);
        let link = match given {
            Some((link, _)) => *link,
            None if cx.carriers(point).contains(&FRAME) => FRAME,
            None => {
                let found = carrier(cx, point)?;
                let link = found.link;
                taken.push(found);
                link
            }
        };
        Some(LinkPointRef { link, point })
    };
    let [a, b] = points;
    let ends = [end(a)?, end(b)?];
    let warning = not_named(cx, &entry.place, entry.span, &taken);
    Some((ends, warning))
}

/// The links that `on` names, each with the point where it carries an end.
fn named(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    points: [PointId; 2],
) -> Option<Vec<(LinkId, PointId)>> {
    let Some(node) = entry.get("on") else {
        return Some(Vec::new());
    };
    let place = entry.place_of("on");
    let nodes = match &node.value {
        Value::Text(_) => std::slice::from_ref(node),
        _ => cx.array(node, &place, entry.example_of("on"))?,
    };
    let mut named: Vec<(LinkId, PointId)> = Vec::new();
    for node in nodes {
        let link = link_of(cx, node, &place)?;
        let carried = |point: &PointId| cx.carriers(*point).binary_search(&link).is_ok();
        let Some(point) = points.into_iter().find(carried) else {
            let [a, b] = points.map(|p| cx.point_name(p).to_owned());
            let message = format!(
                "neither {a} nor {b} is a point of link `{}`",
                cx.link_name(link)
            );
            let help = points.map(|p| carriers_of(cx, p)).join("; ");
            return cx.refuse("point-not-on-link", message, &node.span, help);
        };
        if named.iter().any(|(_, p)| *p == point) {
            let message = format!("{place} names two links at {}", cx.point_name(point));
            let help = "it acts on one of them: leave the other out";
            return cx.refuse("over-specified", message, &node.span, help);
        }
        named.push((link, point));
    }
    Some(named)
}
