//! The arguments of force measures: drives that give, joints that carry, springs, dampers and loads.

use std::collections::BTreeMap;

use kempe_units::{Dimension, Issue, Node, nearest};

use crate::drive::DriveKind;
use crate::ids::{DriveId, LinkId};
use crate::joint::JointKind;
use crate::measure::{ForceMeasure, JointRef};
use crate::read::actuators::what_it_is;
use crate::read::arguments::already_told;
use crate::read::context::{Meaning, plural};
use crate::read::measure_names::{Call, Found, Measures};

impl Measures<'_, '_> {
    /// What a drive must give: a torque where it turns, a force elsewhere.
    pub(crate) fn effort(
        &self,
        call: &Call<'_>,
        node: &Node,
        turning: bool,
    ) -> Found<ForceMeasure> {
        if let Some(point) = node.as_point() {
            return self.argument(
                node,
                "a drive",
                format!("the force at a joint is reaction({point})"),
            );
        }
        if let Some(name) = node.as_name() {
            let help = match self.0.names.get(name).map(|(m, _)| *m) {
                Some(Meaning::Joint(_)) => {
                    Some(format!("the force at a joint is reaction({name})"))
                }
                None if self.0.springs.contains_key(name) => {
                    Some(format!("that of a spring is spring_force({name})"))
                }
                _ => None,
            };
            if let Some(help) = help {
                return self.argument(node, "a drive", help);
            }
        }
        let (id, dimension) = self.drive(node)?;
        if (dimension == Dimension::ANGLE) == turning {
            return Ok(ForceMeasure::Drive(id));
        }
        let Some(drive) = self.0.model.drives.get(id.index()) else {
            return already_told(node);
        };
        let has = if turning { "force" } else { "torque" };
        let name = &drive.name;
        Err(vec![
            Issue::new(
                "wrong-drive",
                call.span.clone(),
                format!(
                    "`{name}` {}: it has a {has}, no {}",
                    what_it_is(&drive.kind),
                    call.function
                ),
            )
            .with_help(format!("write {has}({name})")),
        ])
    }

    /// A joint and the link on which its reaction acts.
    pub(crate) fn joint(
        &self,
        call: &Call<'_>,
        node: &Node,
        link: Option<&Node>,
    ) -> Found<JointRef> {
        let cx = self.0;
        let named = link.map(|node| self.link(node)).transpose()?;
        let joins = |links: &[LinkId], what: &str| -> Found<()> {
            let (Some(node), Some(named)) = (link, named) else {
                return Ok(());
            };
            if links.contains(&named) {
                return Ok(());
            }
            let names: Vec<&str> = links.iter().take(8).map(|l| cx.link_name(*l)).collect();
            let message = format!("`{}` is no link of {what}", cx.link_name(named));
            Err(vec![
                Issue::new("point-not-on-link", node.span.clone(), message)
                    .with_help(format!("its links are {}", names.join(", "))),
            ])
        };
        if node.as_point().is_some() {
            let point = self.point(node)?;
            let links = cx.carriers(point);
            let name = cx.point_name(point);
            if links.len() < 2 {
                let help = match (self.joint_at(point), self.cylinder_at(point)) {
                    (Some(joint), _) => format!(
                        "the reaction there is that of the joint: {}({joint})",
                        call.function
                    ),
                    (None, Some(drive)) => format!(
                        "it is an end of the cylinder `{drive}`, which pushes there with force({drive})"
                    ),
                    (None, None) => {
                        "a point that two links carry is a pin; of another joint, name the joint"
                            .to_owned()
                    }
                };
                return Err(vec![
                    Issue::new(
                        "not-a-pin",
                        node.span.clone(),
                        format!("{name} is no pin: only one link carries it"),
                    )
                    .with_help(help),
                ]);
            }
            joins(links, name)?;
            return Ok(JointRef::Pin(point, named));
        }
        let Some(name) = node.as_name() else {
            return self.argument(
                node,
                "a pin or a joint",
                "name the point of a pin, or a joint of [joints]".to_owned(),
            );
        };
        match cx.names.get(name).map(|(m, _)| *m) {
            Some(Meaning::Joint(i)) => {
                let Some(id) = cx.joints.get(i).copied().flatten() else {
                    return already_told(node);
                };
                if let Some(joint) = cx.model.joints.get(id.index()) {
                    let (a, b) = joint.kind.links();
                    let mut links = vec![a, b];
                    if let JointKind::Gears { arm, .. } | JointKind::Belt { arm, .. } = joint.kind {
                        links.push(arm);
                    }
                    joins(&links, &format!("joint `{name}`"))?;
                }
                Ok(JointRef::Joint(id, named))
            }
            other => {
                let mut issue = Issue::new(
                    "unknown-name",
                    node.span.clone(),
                    format!("there is no joint `{name}`"),
                );
                if let Some(meaning) = other {
                    issue = issue.with_label(format!("`{name}` is {}", meaning.what()));
                }
                let joints = cx.model.joints.iter().map(|j| j.name.as_str());
                issue.help = Some(match nearest(name, joints) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "name the point of a pin, such as reaction(B), or a joint of [joints]"
                        .to_owned(),
                });
                Err(vec![issue])
            }
        }
    }

    /// The joint that guides a point.
    fn joint_at(&self, point: crate::ids::PointId) -> Option<&str> {
        let mut joints = self.0.model.joints.iter();
        let found = joints.find(|j| match j.kind {
            JointKind::Slider { at, .. } => at.point == point,
            JointKind::Slot { pin, .. }
            | JointKind::ArcSlot { pin, .. }
            | JointKind::CurveSlot { pin, .. } => pin.point == point,
            _ => false,
        })?;
        Some(&found.name)
    }

    /// The cylinder that ends at a point.
    fn cylinder_at(&self, point: crate::ids::PointId) -> Option<&str> {
        let mut drives = self.0.model.drives.iter();
        let found = drives.find(|d| {
            matches!(d.kind, DriveKind::Cylinder { a, b } if a.point == point || b.point == point)
        })?;
        Some(&found.name)
    }

    /// A joint that carries a moment.
    pub(crate) fn moment(
        &self,
        call: &Call<'_>,
        node: &Node,
        link: Option<&Node>,
    ) -> Found<JointRef> {
        let found = self.joint(call, node, link)?;
        let carries = match found {
            JointRef::Pin(..) => false,
            JointRef::Joint(id, _) => {
                let joint = self.0.model.joints.get(id.index());
                joint.is_some_and(|j| j.kind.holds_angle())
            }
        };
        if carries {
            return Ok(found);
        }
        let help = "pins, slots, gears and racks carry no moment".to_owned();
        self.argument(node, "a slider, a weld or a belt", help)
    }

    /// A cylinder with its entry under `[cylinders]`; with `limited`, one whose pressure has a limit.
    pub(crate) fn hydraulic(&self, call: &Call<'_>, node: &Node, limited: bool) -> Found<DriveId> {
        let (id, _) = self.drive(node)?;
        let cx = self.0;
        let Some(drive) = cx.model.drives.get(id.index()) else {
            return already_told(node);
        };
        let name = &drive.name;
        if !matches!(drive.kind, DriveKind::Cylinder { .. }) {
            return Err(vec![
                Issue::new(
                    "wrong-drive",
                    call.span.clone(),
                    format!(
                        "`{name}` {}: it has no {}",
                        what_it_is(&drive.kind),
                        call.function
                    ),
                )
                .with_help("name a drive that is a cylinder"),
            ]);
        }
        let Some(cylinder) = cx.model.actions.cylinders.iter().find(|c| c.drive == id) else {
            if cx.broken_cylinders.contains(name) {
                return already_told(node);
            }
            return Err(vec![
                Issue::new(
                    "missing-key",
                    call.span.clone(),
                    format!("the {} of `{name}` needs its bore and rod", call.function),
                )
                .with_help(format!(
                    "add them: [cylinders] {name} = {{ bore = \"80 mm\", rod = \"40 mm\", supply = \"180 bar\" }}"
                )),
            ]);
        };
        if limited && cylinder.supply.is_none() && cylinder.relief.is_none() {
            return Err(vec![
                Issue::new(
                    "missing-key",
                    call.span.clone(),
                    format!("the capacity of `{name}` needs a pressure"),
                )
                .with_help(format!(
                    "give the cylinder `{name}` a supply or relief pressure: supply = \"180 bar\""
                )),
            ]);
        }
        Ok(id)
    }

    /// A cylinder whose oil is told.
    pub(crate) fn with_oil(&self, call: &Call<'_>, node: &Node) -> Found<DriveId> {
        let id = self.hydraulic(call, node, false)?;
        let mut cylinders = self.0.model.actions.cylinders.iter();
        if cylinders.any(|c| c.drive == id && c.oil.is_some()) {
            return Ok(id);
        }
        let name = node.as_name().unwrap_or("lift");
        Err(vec![
            Issue::new(
                "missing-key",
                call.span.clone(),
                format!("the {} of `{name}` is that of its oil, of which nothing is told", call.function),
            )
            .with_help(format!("add `oil` to [cylinders.{name}]; what a given motion asks of it is pressure({name})")),
        ])
    }

    /// A motor or a cylinder that can give so much and no more, and whether it is a motor.
    pub(crate) fn capacity(&self, call: &Call<'_>, node: &Node) -> Found<(DriveId, bool)> {
        let (id, _) = self.drive(node)?;
        let mut motors = self.0.model.actions.motors.iter();
        if motors.any(|m| m.drive == id) {
            return Ok((id, true));
        }
        Ok((self.hydraulic(call, node, true)?, false))
    }

    /// A spring, a damper or a load, by its name, and what it gives.
    pub(crate) fn acting(
        &self,
        node: &Node,
        what: &str,
        declared: &BTreeMap<String, Option<(usize, Dimension)>>,
    ) -> Found<(usize, Dimension)> {
        let Some(name) = node.as_name() else {
            let help = format!("name a {what} of [{}]", plural(what));
            return self.argument(node, &format!("a {what}"), help);
        };
        match declared.get(name) {
            Some(Some(found)) => Ok(*found),
            Some(None) => already_told(node),
            None => self.no_such(node, what, declared.keys().map(String::as_str)),
        }
    }
}
