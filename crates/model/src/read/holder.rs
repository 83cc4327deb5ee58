//! In which of several links a pin sits fast, told by what depends on it.

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, PointId, Span};
use crate::read::carrier::welded;
use crate::read::context::Context;
use crate::read::entry::{Entry, link_of, on_link};

/// Reads the `holder` that an entry names of its pin.
pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>, pin: PointId) -> Option<()> {
    let Some(node) = entry.get("holder") else {
        return Some(());
    };
    let link = link_of(cx, node, &entry.place_of("holder"))?;
    on_link(cx, pin, link, node)?;
    let known = cx.model.points.get(pin.index())?.holder;
    if let Some(other) = known.filter(|other| *other != link) {
        let (point, other) = (cx.point_name(pin), cx.link_name(other));
        return cx.refuse(
            "contradictory-values",
            format!("the pin {point} sits fast in link `{other}` by another entry"),
            &node.span,
            "a pin has one holder: name it once, or the same",
        );
    }
    cx.model.points.get_mut(pin.index())?.holder = Some(link);
    Some(())
}

/// A warning where a pin may sit fast in any of several links, and friction there depends on which.
pub(crate) fn not_named(cx: &Context<'_>, pin: PointId, span: &Span) -> Option<Diagnostic> {
    let point = cx.model.points.get(pin.index())?;
    let mut apart: Vec<LinkId> = Vec::new();
    for link in &point.links {
        if !apart.iter().any(|other| welded(cx, *other, *link)) {
            apart.push(*link);
        }
    }
    let first = *apart.first()?;
    if apart.len() < 3 || point.holder.is_some() || welded(cx, first, FRAME) {
        return None;
    }
    let named = |link: &LinkId| format!("holder = \"{}\"", cx.link_name(*link));
    let named: Vec<String> = apart.iter().map(named).collect();
    let (name, link) = (&point.name, cx.link_name(first));
    let message =
        format!("the pin {name} is taken to sit fast in `{link}`, the first of its links");
    Some(
        Diagnostic::warning("link-not-named", message)
            .at(span.clone(), "")
            .note("the others turn on it: what rubs there depends on which link holds the pin")
            .help(format!(
                "say which does: {name} = {{ ..., {} }}",
                named.join(" or ")
            )),
    )
}
