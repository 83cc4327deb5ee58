//! What the names and functions of a measure mean.

use kempe_units::{Dimension, Expr, Issue, Kind, Node, Resolver, check, check_as, nearest};

use crate::measure::{Leaf, Measure, PoseMeasure, Statistic};
use crate::model::{
    DriveId, DriveKind, FRAME, JointKind, Line, LinkId, LinkPointRef, PointId, Span,
};
use crate::read::context::{Context, Meaning, MeasureState};
use crate::read::force_names::{bare, bare_names};
use crate::read::laws::rate;
use crate::read::nature::nature;
use crate::read::value::ALREADY_TOLD;
use crate::registry::Registry;

/// Names of a measure.
pub(crate) struct Measures<'c, 'a>(pub &'c Context<'a>);

pub(crate) type Found<T> = Result<T, Vec<Issue>>;

/// A call that is being resolved.
pub(crate) struct Call<'n> {
    pub function: &'n str,
    pub arguments: &'n [Node],
    pub span: Span,
}

impl Resolver<Leaf> for Measures<'_, '_> {
    fn name(&mut self, name: &str, span: Span) -> Result<(Leaf, Dimension), Issue> {
        if name == "time" {
            return Ok((Leaf::Time, Dimension::TIME));
        }
        if let Some(found) = bare(name) {
            return Ok(found);
        }
        let cx = self.0;
        let wrong = |what: &str, help: String| {
            Err(Issue::new(
                "not-a-value",
                span.clone(),
                format!("`{name}` is {what}, not a value"),
            )
            .with_help(help))
        };
        match cx.names.get(name).map(|(m, _)| *m) {
            Some(Meaning::Parameter(id)) => cx
                .parameter(id, span)
                .map(|(id, d)| (Leaf::Parameter(id), d)),
            Some(Meaning::Drive(i)) => match self.drive_by_number(i) {
                Some((id, dimension)) => Ok((Leaf::Drive(id), dimension)),
                None => Err(Issue::new(ALREADY_TOLD, span, "")),
            },
            Some(Meaning::Measure(i)) => match cx.measures.get(i) {
                Some(MeasureState::Sound(place, dimension)) => {
                    Ok((Leaf::Named(*place), *dimension))
                }
                _ => Err(Issue::new(ALREADY_TOLD, span, "")),
            },
            Some(Meaning::Link(_)) => {
                wrong("a link", format!("ask something of it: `angle({name})`"))
            }
            Some(Meaning::Joint(_)) => {
                wrong("a joint", format!("ask something of it: `travel({name})`"))
            }
            None => {
                let values = cx
                    .names
                    .iter()
                    .filter(|(_, (m, _))| !matches!(m, Meaning::Link(_) | Meaning::Joint(_)));
                Err(Issue::unknown_name(
                    name,
                    span,
                    values
                        .map(|(n, _)| n.as_str())
                        .chain(["time"])
                        .chain(bare_names()),
                ))
            }
        }
    }

    fn call(
        &mut self,
        function: &str,
        arguments: &[Node],
        span: Span,
    ) -> Option<Result<(Leaf, Dimension), Vec<Issue>>> {
        let entry = Registry::find(function)?;
        // `min(a, b)` is the smaller of two, not a question about the motion
        if matches!(function, "min" | "max") && arguments.len() > 1 {
            return None;
        }
        Some(self.resolve(&Call {
            function: entry.name,
            arguments,
            span,
        }))
    }

    fn declared(&self, name: &str) -> bool {
        let meaning = self.0.names.get(name).map(|(m, _)| *m);
        matches!(
            meaning,
            Some(Meaning::Parameter(_) | Meaning::Drive(_) | Meaning::Measure(_))
        )
    }

    fn functions(&self) -> Vec<String> {
        Registry::all().iter().map(|m| m.name.to_owned()).collect()
    }
}

impl Measures<'_, '_> {
    fn drive_by_number(&self, i: usize) -> Option<(DriveId, Dimension)> {
        let id = self.0.drives.get(i).copied().flatten()?;
        Some((id, self.0.model.drives.get(id.index())?.dimension))
    }

    fn resolve(&mut self, call: &Call<'_>) -> Found<(Leaf, Dimension)> {
        use PoseMeasure as P;
        if let Some(found) = self.force(call) {
            return found;
        }
        let a = call.arguments;
        let pose = |measure: P, dimension: Dimension| Ok((Leaf::Pose(measure), dimension));
        let (length, angle) = (Dimension::LENGTH, Dimension::ANGLE);
        match (call.function, a) {
            ("x", [p]) => pose(P::X(self.point(p)?), length),
            ("y", [p]) => pose(P::Y(self.point(p)?), length),
            ("x", [p, l]) => pose(P::XOn(self.point(p)?, self.link(l)?), length),
            ("y", [p, l]) => pose(P::YOn(self.point(p)?, self.link(l)?), length),
            ("angle", [l]) if l.as_line().is_some() => {
                let (from, to) = self.line(l)?;
                pose(P::Direction(from, to), angle)
            }
            ("angle", [l]) => pose(P::Angle(self.link(l)?), angle),
            ("angle", [l, other]) => pose(P::AngleBetween(self.link(l)?, self.link(other)?), angle),
            ("angle", [p, q, r]) => {
                let (a, at, b) = (self.point(p)?, self.point(q)?, self.point(r)?);
                pose(
                    P::TransmissionAngle {
                        at,
                        a,
                        b,
                        folded: false,
                    },
                    angle,
                )
            }
            ("distance", [pair]) if pair.as_pair().is_some() => {
                let Kind::Binary { left, right, .. } = &pair.kind else {
                    return self.wrong(call);
                };
                pose(P::Distance(self.point(left)?, self.point(right)?), length)
            }
            ("distance", [p, line]) if line.as_line().is_some() => {
                let point = self.point(p)?;
                let (from, to) = self.line(line)?;
                pose(
                    P::DistanceToLine(point, self.link_of_line(from, to, line)?),
                    length,
                )
            }
            ("distance", [p, q]) => pose(P::Distance(self.point(p)?, self.point(q)?), length),
            ("travel", [slider]) => {
                let (point, line) = self.guide(slider)?;
                pose(P::Travel(point, line), length)
            }
            ("length", [drive]) => pose(self.cylinder(drive)?, length),
            ("transmission_angle", [p]) => {
                let at = self.point(p)?;
                let (a, b) = self.transmission(at, p)?;
                pose(
                    P::TransmissionAngle {
                        at,
                        a,
                        b,
                        folded: true,
                    },
                    angle,
                )
            }
            ("transmission_angle", [p, q, r]) => {
                let (at, a, b) = (self.point(p)?, self.point(q)?, self.point(r)?);
                pose(
                    P::TransmissionAngle {
                        at,
                        a,
                        b,
                        folded: true,
                    },
                    angle,
                )
            }
            ("speed", [p]) => pose(P::Speed(self.point(p)?), Dimension::SPEED),
            ("acceleration", [p]) => pose(P::Acceleration(self.point(p)?), Dimension::ACCELERATION),
            ("angular_speed", [l]) => {
                pose(P::AngularSpeed(self.link(l)?), Dimension::ANGULAR_SPEED)
            }
            ("angular_acceleration", [l]) => pose(
                P::AngularAcceleration(self.link(l)?),
                Dimension::ANGULAR_ACCELERATION,
            ),
            ("instant_center_x", [l, rest @ ..]) if rest.len() < 2 => pose(
                P::InstantCenterX(self.link(l)?, self.link_or_frame(rest)?),
                length,
            ),
            ("instant_center_y", [l, rest @ ..]) if rest.len() < 2 => pose(
                P::InstantCenterY(self.link(l)?, self.link_or_frame(rest)?),
                length,
            ),
            ("curvature", [p]) => pose(P::Curvature(self.point(p)?), Dimension::CURVATURE),
            ("curvature_center_x", [p]) => pose(P::CurvatureCenterX(self.point(p)?), length),
            ("curvature_center_y", [p]) => pose(P::CurvatureCenterY(self.point(p)?), length),
            ("path_length", [p]) => pose(P::PathLength(self.point(p)?), length),
            ("mechanical_advantage", [m, drive]) => {
                let (measure, of) = check(m, self)?;
                self.of_the_pose(&measure, m)?;
                let (drive, per) = self.drive(drive)?;
                pose(P::MechanicalAdvantage(Box::new(measure), drive), per / of)
            }
            ("rate", [m, rest @ ..]) if rest.len() < 2 => {
                let (measure, of) = check(m, self)?;
                let order = self.order(rest)?;
                Ok((Leaf::Rate(Box::new(measure), order), rate(of, order as i32)))
            }
            ("d", [m, drive, rest @ ..]) if rest.len() < 2 => {
                let (measure, of) = check(m, self)?;
                self.of_the_pose(&measure, m)?;
                let (drive, per) = self.drive(drive)?;
                let order = self.order(rest)?;
                let per = per.powi(order as i32).unwrap_or(per);
                Ok((Leaf::Coefficient(Box::new(measure), drive, order), of / per))
            }
            ("min", [m]) => self.over(Statistic::Min, m),
            ("max", [m]) => self.over(Statistic::Max, m),
            ("mean", [m]) => self.over(Statistic::Mean, m),
            ("range", [m]) => self.over(Statistic::Range, m),
            ("stroke", [m]) => self.stroke(m),
            ("time_ratio", [m]) => {
                let (measure, _) = check(m, self)?;
                Ok((
                    Leaf::Over(Statistic::TimeRatio, Box::new(measure)),
                    Dimension::NONE,
                ))
            }
            ("at", [m, drive, value]) => self.at(m, drive, value),
            _ => self.wrong(call),
        }
    }

    /// Whether a measure has a derivative to a drive.
    fn of_the_pose(&self, measure: &Measure, node: &Node) -> Found<()> {
        if !nature(measure, &self.0.natures).forces {
            return Ok(());
        }
        Err(vec![
            Issue::new(
                "no-derivative",
                node.span.clone(),
                "a force or an energy has no derivative to a drive",
            )
            .with_label("asks for a force")
            .with_help("its derivative in time is rate(…)"),
        ])
    }

    /// The function is known and called in a way it is not.
    pub(crate) fn wrong<T>(&self, call: &Call<'_>) -> Found<T> {
        let signatures = Registry::find(call.function).map_or(&[] as &[&str], |m| m.signatures);
        let count = call.arguments.len();
        let plural = if count == 1 { "argument" } else { "arguments" };
        Err(vec![
            Issue::new(
                "wrong-arguments",
                call.span.clone(),
                format!("`{}` with {count} {plural}", call.function),
            )
            .with_help(format!("write it as {}", signatures.join(" or "))),
        ])
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

    pub(crate) fn point(&self, node: &Node) -> Found<PointId> {
        let Some(name) = node.as_point() else {
            return self.argument(
                node,
                "a point",
                "points start with a capital letter".to_owned(),
            );
        };
        match self.0.points.get(name) {
            Some(id) => Ok(*id),
            None => {
                let mut issue = Issue::new(
                    "unknown-name",
                    node.span.clone(),
                    format!("there is no point `{name}`"),
                )
                .with_label("not declared");
                let near = nearest(name, self.0.points.keys().map(String::as_str));
                issue.help = Some(match near {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!(
                        "the points are {}",
                        self.0
                            .points
                            .keys()
                            .take(20)
                            .map(String::as_str)
                            .collect::<Vec<_>>()
                            .join(", ")
                    ),
                });
                Err(vec![issue])
            }
        }
    }

    pub(crate) fn link(&self, node: &Node) -> Found<LinkId> {
        let cx = self.0;
        let Some(name) = node.as_name() else {
            return self.argument(node, "a link", "name a link of the file".to_owned());
        };
        match cx.names.get(name) {
            Some((Meaning::Link(id), _)) => Ok(*id),
            other => {
                let what =
                    other.map_or(String::new(), |(m, _)| format!("`{name}` is {}", m.what()));
                let mut issue = Issue::new(
                    "unknown-name",
                    node.span.clone(),
                    format!("there is no link `{name}`"),
                )
                .with_label(what);
                let links = cx.model.links.iter().map(|l| l.name.as_str());
                issue.help = Some(match nearest(name, links.clone()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => {
                        let links: Vec<&str> = links.take(20).collect();
                        format!("the links are {}", links.join(", "))
                    }
                });
                Err(vec![issue])
            }
        }
    }

    fn link_or_frame(&self, rest: &[Node]) -> Found<LinkId> {
        rest.first().map_or(Ok(FRAME), |node| self.link(node))
    }

    fn line(&self, node: &Node) -> Found<(PointId, PointId)> {
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
    fn link_of_line(&self, from: PointId, to: PointId, node: &Node) -> Found<Line> {
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
        let cx = self.0;
        let Some(name) = node.as_name() else {
            return self.argument(node, "a drive", "name a drive of the file".to_owned());
        };
        if let Some((Meaning::Drive(i), _)) = cx.names.get(name) {
            return self
                .drive_by_number(*i)
                .ok_or_else(|| vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")]);
        }
        let mut issue = Issue::new(
            "unknown-name",
            node.span.clone(),
            format!("there is no drive `{name}`"),
        );
        if let Some((meaning, _)) = cx.names.get(name) {
            issue = issue.with_label(format!("`{name}` is {}", meaning.what()));
        }
        let drives: Vec<&str> = cx
            .names
            .iter()
            .filter(|(_, (m, _))| matches!(m, Meaning::Drive(_)))
            .map(|(n, _)| n.as_str())
            .collect();
        issue.help = match nearest(name, drives.iter().copied()) {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None if drives.is_empty() => Some("the file has no drives".to_owned()),
            None => Some(format!("the drives are {}", drives.join(", "))),
        };
        Err(vec![issue])
    }

    /// The point and the line of a slider or slot, by the name of the joint, of the slider or of the drive.
    fn guide(&self, node: &Node) -> Found<(LinkPointRef, Line)> {
        let cx = self.0;
        let help =
            "name a slider, its joint, the joint of a pin in a slot, or the drive that slides it";
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
                _ => return Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")]),
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
                None => return Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")]),
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
            None if cx.joints.iter().any(Option::is_none) => {
                Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")])
            }
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

    fn cylinder(&self, node: &Node) -> Found<PoseMeasure> {
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

    fn order(&self, rest: &[Node]) -> Found<u32> {
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

    fn over(&mut self, statistic: Statistic, node: &Node) -> Found<(Leaf, Dimension)> {
        let (measure, dimension) = check(node, self)?;
        Ok((Leaf::Over(statistic, Box::new(measure)), dimension))
    }

    /// The range of a measure, of a slider's travel or of a cylinder's length.
    fn stroke(&mut self, node: &Node) -> Found<(Leaf, Dimension)> {
        let meaning = node
            .as_name()
            .and_then(|name| self.0.names.get(name))
            .map(|(m, _)| *m);
        if !matches!(meaning, Some(Meaning::Link(_) | Meaning::Joint(_))) {
            return self.over(Statistic::Range, node);
        }
        let (point, line) = self.guide(node)?;
        let travel: Measure = Expr::Leaf(Leaf::Pose(PoseMeasure::Travel(point, line)));
        Ok((
            Leaf::Over(Statistic::Range, Box::new(travel)),
            Dimension::LENGTH,
        ))
    }

    fn at(&mut self, measure: &Node, drive: &Node, place: &Node) -> Found<(Leaf, Dimension)> {
        let (measure, dimension) = check(measure, self)?;
        let (drive, of) = match drive.as_name() {
            Some("time") => (None, Dimension::TIME),
            _ => self.drive(drive).map(|(id, of)| (Some(id), of))?,
        };
        let unit = self.0.bare_unit(of);
        let parameters = &mut crate::read::value::Parameters(self.0);
        let (scalar, _) = check_as(place, parameters, of, &unit)?;
        let value = self.0.settle(&scalar);
        if !value.is_finite() {
            return self.argument(
                place,
                "a finite value",
                "look for a division by zero".to_owned(),
            );
        }
        Ok((
            Leaf::Over(Statistic::At { drive, value }, Box::new(measure)),
            dimension,
        ))
    }
}

/// Derivatives go up to this order.
const MAX_ORDER: f64 = 4.0;
