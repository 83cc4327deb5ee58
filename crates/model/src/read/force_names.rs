//! What the names and functions of force measures mean.

use kempe_units::{Dimension, Issue, nearest};

use crate::measure::{ForceMeasure, JointRef, Leaf};
use crate::model::{DriveId, DriveKind, JointKind, LinkId};
use crate::read::actuators::what_it_is;
use crate::read::context::Meaning;
use crate::read::measure_names::{Call, Found, Measures};
use crate::read::value::ALREADY_TOLD;

/// Force measures that ask about the whole mechanism, and so have no arguments.
const BARE: &[(&str, ForceMeasure, Dimension)] = &[
    (
        "kinetic_energy",
        ForceMeasure::KineticEnergy,
        Dimension::ENERGY,
    ),
    (
        "potential_energy",
        ForceMeasure::PotentialEnergy,
        Dimension::ENERGY,
    ),
    (
        "shaking_force",
        ForceMeasure::ShakingForce,
        Dimension::FORCE,
    ),
    (
        "shaking_force_x",
        ForceMeasure::ShakingForceX,
        Dimension::FORCE,
    ),
    (
        "shaking_force_y",
        ForceMeasure::ShakingForceY,
        Dimension::FORCE,
    ),
    (
        "shaking_moment",
        ForceMeasure::ShakingMoment,
        Dimension::TORQUE,
    ),
];

/// The force measure that a name without brackets is.
pub(crate) fn bare(name: &str) -> Option<(Leaf, Dimension)> {
    let (_, measure, dimension) = BARE.iter().find(|(bare, ..)| *bare == name)?;
    Some((Leaf::Force(measure.clone()), *dimension))
}

/// The names of [`bare`].
pub(crate) fn bare_names<'n>() -> impl Iterator<Item = &'n str> {
    BARE.iter().map(|(name, ..)| *name)
}

impl Measures<'_, '_> {
    /// The force measure that a call is; `None` for other functions.
    pub(crate) fn force(&self, call: &Call<'_>) -> Option<Found<(Leaf, Dimension)>> {
        use ForceMeasure as F;
        let of = |measure: Found<F>, dimension: Dimension| {
            Some(measure.map(|m| (Leaf::Force(m), dimension)))
        };
        let (force, torque) = (Dimension::FORCE, Dimension::TORQUE);
        let joint = |own: bool| self.joint(call, own);
        match call.function {
            "torque" => of(self.effort(call, true), torque),
            "force" => of(self.effort(call, false), force),
            "reaction" => of(joint(false).map(F::Reaction), force),
            "reaction_x" => of(joint(false).map(F::ReactionX), force),
            "reaction_y" => of(joint(false).map(F::ReactionY), force),
            "reaction_angle" => of(joint(false).map(F::ReactionAngle), Dimension::ANGLE),
            "reaction_along" => of(joint(true).map(F::ReactionAlong), force),
            "reaction_across" => of(joint(true).map(F::ReactionAcross), force),
            "reaction_moment" => of(self.moment(call).map(F::ReactionMoment), torque),
            "power" => of(
                self.only_drive(call).map(|(id, _)| F::Power(id)),
                Dimension::POWER,
            ),
            "reduced_mass" => Some(self.only_drive(call).map(|(id, is)| {
                let dimension = if is == Dimension::ANGLE {
                    Dimension::INERTIA
                } else {
                    Dimension::MASS
                };
                (Leaf::Force(F::ReducedMass(id)), dimension)
            })),
            "reduced_load" => Some(self.only_drive(call).map(|(id, is)| {
                let dimension = if is == Dimension::ANGLE {
                    torque
                } else {
                    force
                };
                (Leaf::Force(F::ReducedLoad(id)), dimension)
            })),
            "pressure" => of(
                self.hydraulic(call, false).map(F::Pressure),
                Dimension::PRESSURE,
            ),
            "capacity" => Some(self.capacity(call)),
            "spring_force" => Some(self.acting(call, "spring", &self.0.springs, F::Spring)),
            "damper_force" => Some(self.acting(call, "damper", &self.0.dampers, F::Damper)),
            "load" => Some(self.acting(call, "load", &self.0.loads, F::Load)),
            "load_x" => Some(self.component(call, F::LoadX)),
            "load_y" => Some(self.component(call, F::LoadY)),
            name if bare(name).is_some() => Some(Err(vec![
                Issue::new(
                    "wrong-arguments",
                    call.span.clone(),
                    format!("`{name}` is one of the whole mechanism and takes no arguments"),
                )
                .with_help(format!("write {name}, without brackets")),
            ])),
            _ => None,
        }
    }

    fn only_drive(&self, call: &Call<'_>) -> Found<(DriveId, Dimension)> {
        match call.arguments {
            [drive] => self.drive(drive),
            _ => self.wrong(call),
        }
    }

    /// What a drive must give: a torque where it turns, a force elsewhere.
    fn effort(&self, call: &Call<'_>, turning: bool) -> Found<ForceMeasure> {
        let [node] = call.arguments else {
            return self.wrong(call);
        };
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
            return self.wrong(call);
        };
        let (has, write) = if turning {
            ("force", "force")
        } else {
            ("torque", "torque")
        };
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
            .with_help(format!("write {write}({name})")),
        ])
    }

    /// A joint and the link on which its reaction acts; with `own` the link must be named.
    pub(crate) fn joint(&self, call: &Call<'_>, own: bool) -> Found<JointRef> {
        let cx = self.0;
        let (node, link) = match call.arguments {
            [node] if !own => (node, None),
            [node, link] => (node, Some(link)),
            _ => return self.wrong(call),
        };
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
                    return Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")]);
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
    fn joint_at(&self, point: crate::model::PointId) -> Option<&str> {
        let mut joints = self.0.model.joints.iter();
        let found = joints.find(|j| match j.kind {
            JointKind::Slider { at, .. } => at.point == point,
            JointKind::Slot { pin, .. } | JointKind::ArcSlot { pin, .. } => pin.point == point,
            _ => false,
        })?;
        Some(&found.name)
    }

    /// The cylinder that ends at a point.
    fn cylinder_at(&self, point: crate::model::PointId) -> Option<&str> {
        let mut drives = self.0.model.drives.iter();
        let found = drives.find(|d| {
            matches!(d.kind, DriveKind::Cylinder { a, b } if a.point == point || b.point == point)
        })?;
        Some(&found.name)
    }

    /// A joint that carries a moment.
    fn moment(&self, call: &Call<'_>) -> Found<JointRef> {
        let found = self.joint(call, false)?;
        let carries = match found {
            JointRef::Pin(..) => false,
            JointRef::Joint(id, _) => {
                let joint = self.0.model.joints.get(id.index());
                joint.is_some_and(|j| j.kind.holds_angle())
            }
        };
        match call.arguments {
            [node, ..] if !carries => self.argument(
                node,
                "a slider, a weld or a belt",
                "pins, slots, gears and racks carry no moment".to_owned(),
            ),
            _ => Ok(found),
        }
    }

    /// A cylinder with its entry under `[cylinders]`; with `limited`, one whose pressure has a limit.
    fn hydraulic(&self, call: &Call<'_>, limited: bool) -> Found<DriveId> {
        let (id, _) = self.only_drive(call)?;
        let cx = self.0;
        let Some(drive) = cx.model.drives.get(id.index()) else {
            return self.wrong(call);
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
                return Err(vec![Issue::new(ALREADY_TOLD, call.span.clone(), "")]);
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

    /// What a cylinder or a motor can give.
    fn capacity(&self, call: &Call<'_>) -> Found<(Leaf, Dimension)> {
        let (id, _) = self.only_drive(call)?;
        let motors = &self.0.model.actions.motors;
        if motors.iter().any(|m| m.drive == id) {
            return Ok((Leaf::Force(ForceMeasure::Capacity(id)), Dimension::TORQUE));
        }
        let id = self.hydraulic(call, true)?;
        Ok((Leaf::Force(ForceMeasure::Capacity(id)), Dimension::FORCE))
    }

    /// A spring, a damper or a load, by its name.
    fn acting(
        &self,
        call: &Call<'_>,
        what: &str,
        declared: &std::collections::BTreeMap<String, Option<(usize, Dimension)>>,
        measure: impl Fn(usize) -> ForceMeasure,
    ) -> Found<(Leaf, Dimension)> {
        let [node] = call.arguments else {
            return self.wrong(call);
        };
        let Some(name) = node.as_name() else {
            return self.argument(
                node,
                &format!("a {what}"),
                format!("name a {what} of [{what}s]"),
            );
        };
        match declared.get(name) {
            Some(Some((i, dimension))) => Ok((Leaf::Force(measure(*i)), *dimension)),
            Some(None) => Err(vec![Issue::new(ALREADY_TOLD, node.span.clone(), "")]),
            None => {
                let mut issue = Issue::new(
                    "unknown-name",
                    node.span.clone(),
                    format!("there is no {what} `{name}`"),
                )
                .with_label("not declared");
                let known: Vec<&str> = declared.keys().map(String::as_str).collect();
                issue.help = Some(match nearest(name, known.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if known.is_empty() => format!("the file has no {what}s"),
                    None => {
                        let first: Vec<&str> = known.iter().take(12).copied().collect();
                        format!("the {what}s are {}", first.join(", "))
                    }
                });
                Err(vec![issue])
            }
        }
    }

    /// A component of a force load.
    fn component(
        &self,
        call: &Call<'_>,
        measure: impl Fn(usize) -> ForceMeasure,
    ) -> Found<(Leaf, Dimension)> {
        let found = self.acting(call, "load", &self.0.loads, measure)?;
        if found.1 != Dimension::FORCE {
            let help = "a torque has one value: load(…)".to_owned();
            return match call.arguments {
                [node] => self.argument(node, "a force", help),
                _ => self.wrong(call),
            };
        }
        Ok(found)
    }
}
