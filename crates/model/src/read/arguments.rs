//! The arguments of measures: points, links, lines, drives, sliders.

use kempe_units::{Dimension, Issue, Kind, Node};

use crate::drive::DriveKind;
use crate::ids::{DriveId, Line, LinkId, LinkPointRef, PointId};
use crate::joint::JointKind;
use crate::measure::PoseMeasure;
use crate::read::context::{Meaning, near_or_all};
use crate::read::measure_names::{Found, Measures};
use crate::read::value::ALREADY_TOLD;

/// Derivatives go up to this order.
const MAX_ORDER: f64 = 4.0;

/// What follows from something already told.
pub(crate) fn already_told<T>(node: &Node) -> Found<T> {
    Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")])
}

impl Measures<'_, '_> {
    pub(crate) fn drive_by_number(&self, i: usize) -> Option<(DriveId, Dimension)> {
        let id = self.0.drives.get(i).copied().flatten()?;
        Some((id, self.0.model.drives.get(id.index())?.dimension))
    }

    /// What a name stands for.
    pub(crate) fn meaning(&self, node: &Node) -> Option<Meaning> {
        let (meaning, _) = self.0.names.get(node.as_name()?)?;
        Some(*meaning)
    }

    pub(crate) fn argument<T>(&self, node: &Node, wanted: &str, help: String) -> Found<T> {
        Err(vec![
            Issue::new(
                "wrong-arguments",
                node.span.clone(),
                format!("{wanted} expected"),
            )
            .with_help(help),
        ])
    }

    /// There is nothing of this kind and name; `known` are those that there are.
    pub(crate) fn no_such<'n, T>(
        &self,
        node: &Node,
        kind: &str,
        known: impl Iterator<Item = &'n str>,
    ) -> Found<T> {
        let name = node.as_name().or(node.as_point()).unwrap_or_default();
        let label = match self.meaning(node) {
            Some(meaning) => format!("`{name}` is {}", meaning.what()),
            None => "not declared".to_owned(),
        };
        let message = format!("there is no {kind} `{name}`");
        Err(vec![
            Issue::new("unknown-name", node.span.clone(), message)
                .with_label(label)
                .with_help(near_or_all(kind, name, known)),
        ])
    }

    pub(crate) fn point(&self, node: &Node) -> Found<PointId> {
        let Some(name) = node.as_point() else {
            let help = "points start with a capital letter".to_owned();
            return self.argument(node, "a point", help);
        };
        match self.0.points.get(name) {
            Some(id) => Ok(*id),
            None => self.no_such(node, "point", self.0.points.keys().map(String::as_str)),
        }
    }

    pub(crate) fn link(&self, node: &Node) -> Found<LinkId> {
        if node.as_name().is_none() {
            return self.argument(node, "a link", "name a link of the file".to_owned());
        }
        match self.meaning(node) {
            Some(Meaning::Link(id)) => Ok(id),
            _ => self.no_such(
                node,
                "link",
                self.0.model.links.iter().map(|l| l.name.as_str()),
            ),
        }
    }

    pub(crate) fn line(&self, node: &Node) -> Found<(PointId, PointId)> {
        let Kind::Line { from, to } = &node.kind else {
            return self.argument(node, "a directed line", "write A -> B".to_owned());
        };
        let (from, to) = (self.point(from)?, self.point(to)?);
        if from == to {
            return self.argument(
                node,
                "a line between two different points",
                "write A -> B".to_owned(),
            );
        }
        Ok((from, to))
    }

    /// The link that carries a line: the frame if it does, or else the first.
    pub(crate) fn link_of_line(&self, from: PointId, to: PointId, node: &Node) -> Found<Line> {
        let cx = self.0;
        match cx
            .carriers(from)
            .iter()
            .find(|l| cx.carriers(to).binary_search(l).is_ok())
        {
            Some(link) => Ok(Line {
                link: *link,
                from,
                to,
            }),
            None => {
                let (a, b) = (cx.point_name(from), cx.point_name(to));
                Err(vec![
                    Issue::new(
                        "no-common-link",
                        node.span.clone(),
                        format!("no link carries both {a} and {b}"),
                    )
                    .with_help("name two points of one link"),
                ])
            }
        }
    }

    pub(crate) fn drive(&self, node: &Node) -> Found<(DriveId, Dimension)> {
        if node.as_name().is_none() {
            return self.argument(node, "a drive", "name a drive of the file".to_owned());
        }
        match self.meaning(node) {
            Some(Meaning::Drive(i)) => self
                .drive_by_number(i)
                .map_or_else(|| already_told(node), Ok),
            _ => {
                let names = self.0.names.iter();
                let drives = names.filter(|(_, (m, _))| matches!(m, Meaning::Drive(_)));
                self.no_such(node, "drive", drives.map(|(name, _)| name.as_str()))
            }
        }
    }

    /// The point and the line of a slider or slot, by the name of the joint, of the slider or of the drive.
    pub(crate) fn guide(&self, node: &Node) -> Found<(LinkPointRef, Line)> {
        let cx = self.0;
        let help = "name a slider, its joint, the joint of a pin in a straight slot, or the drive that slides it";
        let Some(name) = node.as_name() else {
            return self.argument(node, "a slider", help.to_owned());
        };
        let of = |kind: &JointKind| match *kind {
            JointKind::Slider { at, on, .. } => Some((at, on)),
            JointKind::Slot { pin, on } => Some((pin, on)),
            _ => None,
        };
        let joints = &cx.model.joints;
        let found = match cx.names.get(name).map(|(m, _)| *m) {
            Some(Meaning::Joint(i)) => match cx.joints.get(i) {
                Some(Some(id)) => joints.get(id.index()).and_then(|j| of(&j.kind)),
                _ => return already_told(node),
            },
            Some(Meaning::Link(link)) => joints
                .iter()
                .filter_map(|j| of(&j.kind))
                .find(|(at, _)| at.link == link),
            Some(Meaning::Drive(i)) => match self
                .drive_by_number(i)
                .and_then(|(id, _)| cx.model.drives.get(id.index()))
            {
                Some(drive) => match drive.kind {
                    DriveKind::Slide { joint } => {
                        joints.get(joint.index()).and_then(|j| of(&j.kind))
                    }
                    _ => None,
                },
                None => return already_told(node),
            },
            _ => {
                let known = cx
                    .names
                    .iter()
                    .filter(|(_, (m, _))| matches!(m, Meaning::Joint(_) | Meaning::Link(_)));
                return Err(vec![Issue::unknown_name(
                    name,
                    node.span.clone(),
                    known.map(|(n, _)| n.as_str()),
                )]);
            }
        };
        match found {
            Some(found) => Ok(found),
            // a slider with a broken joint has been told
            None if cx.joints.iter().any(Option::is_none) => already_told(node),
            None => Err(vec![
                Issue::new(
                    "not-a-slider",
                    node.span.clone(),
                    format!("`{name}` does not slide along a line"),
                )
                .with_help(help),
            ]),
        }
    }

    pub(crate) fn cylinder(&self, node: &Node) -> Found<PoseMeasure> {
        let (id, _) = self.drive(node)?;
        match self.0.model.drives.get(id.index()).map(|d| &d.kind) {
            Some(DriveKind::Cylinder { a, b }) => Ok(PoseMeasure::Distance(a.point, b.point)),
            _ => self.argument(
                node,
                "a cylinder",
                "for two points write distance(A, B); for a slider travel(piston)".to_owned(),
            ),
        }
    }

    pub(crate) fn order(&self, rest: &[Node]) -> Found<u32> {
        let Some(node) = rest.first() else {
            return Ok(1);
        };
        match node.as_bare_number() {
            Some(n) if n == n.trunc() && (1.0..=MAX_ORDER).contains(&n) => Ok(n as u32),
            _ => self.argument(
                node,
                "the order of a derivative",
                format!("a whole number from 1 to {MAX_ORDER}"),
            ),
        }
    }
}
