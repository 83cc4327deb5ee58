//! On which link something acts at a point that several links carry.

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, PointId, Span};
use crate::joint::JointKind;
use crate::read::context::Context;

/// The link on which something acts at a point.
pub(crate) struct Carrier {
    pub point: PointId,
    pub link: LinkId,
    /// Others that could be meant.
    others: Vec<LinkId>,
}

/// The link that something at a point acts on when none is named: a slider whose pin it is, or else the first-named that
/// moves, or else the frame.
pub(crate) fn carrier(cx: &Context<'_>, point: PointId) -> Option<Carrier> {
    let alone = |link: LinkId| Carrier {
        point,
        link,
        others: Vec::new(),
    };
    let carriers = cx.carriers(point);
    let moving: Vec<LinkId> = carriers.iter().copied().filter(|l| *l != FRAME).collect();
    let slides = |link: &LinkId| {
        (cx.model.joints.iter()).any(|joint| {
            matches!(&joint.kind, JointKind::Slider { at, .. } if at.link == *link && at.point == point)
        })
    };
    let sliders: Vec<LinkId> = moving.iter().copied().filter(slides).collect();
    if let [slider] = sliders.as_slice() {
        return Some(alone(*slider));
    }
    let first = moving.first().or(carriers.first()).copied()?;
    // A joint that could not be read may tell which.
    if cx.joints.contains(&None) {
        return Some(alone(first));
    }
    let others = moving.iter().copied().filter(|l| !welded(cx, first, *l));
    Some(Carrier {
        others: others.collect(),
        ..alone(first)
    })
}

/// As [`carrier`], with a warning of something (`what`) where another link could be meant.
pub(crate) fn moving_carrier(
    cx: &mut Context<'_>,
    point: PointId,
    what: &str,
    span: &Span,
) -> Option<LinkId> {
    let found = carrier(cx, point)?;
    let link = found.link;
    let warning = not_named(cx, what, span, &[found]);
    cx.found.extend(warning);
    Some(link)
}

/// A warning where other links could be meant by something (`what`) at these points.
pub(crate) fn not_named(
    cx: &Context<'_>,
    what: &str,
    span: &Span,
    carriers: &[Carrier],
) -> Option<Diagnostic> {
    let unsure: Vec<&Carrier> = carriers.iter().filter(|c| !c.others.is_empty()).collect();
    let link = |id: &LinkId| cx.link_name(*id).to_owned();
    let (first, more) = unsure.split_first()?;
    let warning = |message| Diagnostic::warning("link-not-named", message).at(span.clone(), "");
    if more.is_empty() {
        let point = cx.point_name(first.point);
        let all = std::iter::once(&first.link).chain(&first.others);
        let all: Vec<String> = all.map(|id| format!("on = \"{}\"", link(id))).collect();
        let name = link(&first.link);
        return Some(
            warning(format!(
                "{what} is taken to be on `{name}`: {point} is a point of other links too"
            ))
            .note(format!(
                "what the pin {point} carries depends on which of its links it acts on"
            ))
            .help(format!("say which is meant: {}", all.join(" or "))),
        );
    }
    let each = |text: &dyn Fn(&Carrier) -> String, between: &str| {
        let texts: Vec<String> = unsure.iter().map(|c| text(c)).collect();
        texts.join(between)
    };
    let at = |c: &Carrier| cx.point_name(c.point).to_owned();
    let taken = each(&|c| format!("`{}` at {}", link(&c.link), at(c)), " and on ");
    let named = each(&|c| format!("\"{}\"", link(&c.link)), ", ");
    let others = each(
        &|c| {
            let others: Vec<String> = c.others.iter().map(link).collect();
            format!("{} at {}", others.join(" or "), at(c))
        },
        ", ",
    );
    Some(
        warning(format!(
            "{what} is taken to be on {taken}, which are points of other links too"
        ))
        .note(format!(
            "what the pins {} carry depends on which of their links it acts on",
            each(&at, " and ")
        ))
        .help(format!("say which are meant: on = [{named}], or {others}")),
    )
}

/// Whether welds hold two links together.
pub(crate) fn welded(cx: &Context<'_>, a: LinkId, b: LinkId) -> bool {
    let mut held = vec![a];
    let mut next = 0;
    while let Some(link) = held.get(next).copied() {
        next += 1;
        for joint in &cx.model.joints {
            let JointKind::Weld { a, b, .. } = joint.kind else {
                continue;
            };
            for (one, other) in [(a, b), (b, a)] {
                if one == link && !held.contains(&other) {
                    held.push(other);
                }
            }
        }
    }
    held.contains(&b)
}
