//! Which two links a transmission angle is measured between.

use kempe_units::{Issue, Node};

use crate::drive::DriveKind;
use crate::ids::{FRAME, LinkId, PointId};
use crate::read::measure_names::{Found, Measures};

impl Measures<'_, '_> {
    /// The far ends of the two links whose angle at `at` is the transmission angle.
    ///
    /// A link counts when it has another pin; its end is its pin on the frame (the pivot it swings about), or else the first
    /// other pin in the order of its points.
    pub(crate) fn transmission(&self, at: PointId, node: &Node) -> Found<(PointId, PointId)> {
        let cx = self.0;
        let name = cx.point_name(at);
        let ends: Vec<(LinkId, PointId)> = cx
            .carriers(at)
            .iter()
            .filter_map(|link| Some((*link, self.far_pin(*link, at)?)))
            .collect();
        if let [(_, a), (_, b)] = ends.as_slice() {
            return Ok((*a, *b));
        }
        let known: Vec<&str> = ends.iter().map(|(_, p)| cx.point_name(*p)).collect();
        // Letters that stand for points which are to be named.
        let letters = ["P", "Q", "R"]
            .into_iter()
            .filter(|it| *it != name && !known.contains(it));
        let mut named = known.iter().copied().chain(letters);
        let [a, b] = [(); 2].map(|()| named.next().unwrap_or_default());
        let links: Vec<&str> = ends.iter().map(|(l, _)| cx.link_name(*l)).take(6).collect();
        let message = match links.as_slice() {
            [] => format!("{name} is no pin between two links that have other pins"),
            [one] => format!("of the links at {name} only `{one}` has another pin"),
            many => format!("{} links meet at {name}: {}", ends.len(), many.join(", ")),
        };
        Err(vec![
            Issue::new("ambiguous-transmission", node.span.clone(), message).with_help(format!(
                "name the far ends of the two that pass the motion on: transmission_angle({name}, {a}, {b}) is the angle at {name} between {a} and {b}"
            )),
        ])
    }

    /// The point that an angle is seen from and the two that it is seen towards.
    pub(crate) fn corner(&self, at: &Node, ends: [&Node; 2]) -> Found<(PointId, PointId, PointId)> {
        let vertex = self.point(at)?;
        let [a, b] = [self.point(ends[0])?, self.point(ends[1])?];
        let name = self.0.point_name(vertex);
        let none = |(end, node): (PointId, &Node)| {
            let message = format!(
                "the angle is seen from {name}: towards {name} itself there is no direction"
            );
            let issue = Issue::new("same-place", node.span.clone(), message);
            (end == vertex).then(|| issue.with_help("name another point there"))
        };
        let issues: Vec<Issue> = [(a, ends[0]), (b, ends[1])]
            .into_iter()
            .filter_map(none)
            .collect();
        match issues.is_empty() {
            true => Ok((vertex, a, b)),
            false => Err(issues),
        }
    }

    fn far_pin(&self, link: LinkId, at: PointId) -> Option<PointId> {
        let cx = self.0;
        let is_end = |p: PointId| {
            cx.carriers(p).len() > 1
                || cx.model.drives.iter().any(|d| matches!(d.kind, DriveKind::Cylinder { a, b } if a.point == p || b.point == p))
        };
        let points = &cx.model.links.get(link.index())?.points;
        let pins = || {
            points
                .iter()
                .map(|p| p.point)
                .filter(|p| *p != at && is_end(*p))
        };
        pins()
            .find(|p| link != FRAME && cx.carriers(*p).first() == Some(&FRAME))
            .or_else(|| pins().next())
    }
}
