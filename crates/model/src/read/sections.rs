//! The file's sections, in the order in which they build on each other.

use kempe_units::{Dimension, Unit};

use crate::diagnostic::Diagnostic;
use crate::document::{Node, Table, Value};
use crate::model::{DriveKind, FRAME, LinkId, UnitName};
use crate::read::context::Context;
use crate::read::{
    actuators, assembly, drives, friction, joints, links, loads, masses, measures, names,
    parameters, springs, studies,
};

/// Keys of a file.
pub(crate) const FILE_KEYS: &[&str] = &[
    "title",
    "units",
    "gravity",
    "parameters",
    "links",
    "joints",
    "drives",
    "assembly",
    "loads",
    "masses",
    "springs",
    "dampers",
    "friction",
    "cylinders",
    "motors",
    "clearance",
    "measures",
    "studies",
];

/// Sections of the language that this version has not got.
pub(crate) const ANNOUNCED_SECTIONS: &[&str] = &["clearance"];

/// Reads the whole file.
pub(crate) fn read(cx: &mut Context<'_>, root: &Table, overrides: &[(String, String)]) {
    cx.unknown_keys(root, "the file", FILE_KEYS);
    if let Some(node) = root.get("title")
        && let Some(text) = cx.text(node, "`title`", "\"Crank-rocker\"")
    {
        cx.model.title = text.content.clone();
    }
    if let Some(node) = root.get("units") {
        units(cx, node);
    }
    for (key, _) in root
        .entries
        .iter()
        .filter(|(k, _)| ANNOUNCED_SECTIONS.contains(&k.name.as_str()))
    {
        cx.push(
            Diagnostic::warning(
                "section-not-available",
                format!(
                    "[{}] is skipped: this version does not compute with it",
                    key.name
                ),
            )
            .at(key.span.clone(), "")
            .help("the motion of the file does not depend on it"),
        );
    }
    let sections = names::collect(cx, root);
    parameters::read(cx, &sections.parameters, overrides);
    let whole = root
        .get("links")
        .is_none_or(|n| matches!(n.value, Value::Table(_)));
    links::read(cx, &sections.links, whole);
    joints::read(cx, &sections.joints);
    drives::read(cx, &sections.drives);
    assembly::read(cx, &sections.assembly);
    loose_links(cx);
    if let Some(node) = root.get("gravity") {
        masses::read_gravity(cx, node);
    }
    masses::read(cx, &sections.masses);
    masses::without_inertia(cx);
    springs::read_springs(cx, &sections.springs);
    springs::read_dampers(cx, &sections.dampers);
    friction::read(cx, &sections.friction);
    actuators::read_cylinders(cx, &sections.cylinders);
    actuators::read_motors(cx, &sections.motors);
    loads::declare(cx, &sections.loads);
    measures::read(cx, &sections.measures);
    loads::read(cx, &sections.loads);
    studies::read(cx, &sections.studies);
}

/// Warns of links that nothing holds.
fn loose_links(cx: &mut Context<'_>) {
    let mut held = vec![false; cx.model.links.len()];
    let mut hold = |link: LinkId| {
        if let Some(flag) = held.get_mut(link.index()) {
            *flag = true;
        }
    };
    hold(FRAME);
    for point in cx.model.points.iter().filter(|p| p.links.len() > 1) {
        point.links.iter().for_each(|l| hold(*l));
    }
    for joint in &cx.model.joints {
        let (a, b) = joint.kind.links();
        hold(a);
        hold(b);
    }
    for drive in &cx.model.drives {
        if let DriveKind::Cylinder { a, b } = drive.kind {
            hold(a.link);
            hold(b.link);
        }
    }
    // a broken joint may hold any of them
    if cx.joints.iter().any(Option::is_none) {
        return;
    }
    for (i, _) in held.iter().enumerate().filter(|(_, held)| !**held) {
        let Some(link) = cx.model.links.get(i) else {
            continue;
        };
        let warning = Diagnostic::warning(
            "loose-link",
            format!("nothing holds link `{}`", link.name),
        )
        .at(
            link.span.clone(),
            "no point of it is on another link, and no joint names it",
        )
        .help("a point named on two links is a pin between them; or add a joint under [joints]");
        cx.push(warning);
    }
}

/// Keys of `units`.
pub(crate) const UNIT_KEYS: &[&str] = &[
    "length", "angle", "force", "torque", "pressure", "power", "mass",
];

/// Units besides those of length and angle, with an example each.
const MORE_UNITS: &[(&str, Dimension, &str)] = &[
    ("force", Dimension::FORCE, "\"kN\""),
    ("torque", Dimension::TORQUE, "\"kN m\""),
    ("pressure", Dimension::PRESSURE, "\"bar\""),
    ("power", Dimension::POWER, "\"kW\""),
    ("mass", Dimension::MASS, "\"t\""),
];

fn units(cx: &mut Context<'_>, node: &Node) {
    let Some(table) = cx.table(
        node,
        "`units`",
        "units = { length = \"mm\", angle = \"deg\" }",
    ) else {
        return;
    };
    cx.unknown_keys(table, "`units`", UNIT_KEYS);
    if let Some(unit) = unit_of(cx, table, "length", Dimension::LENGTH, "\"mm\"") {
        cx.model.units.length = unit_name(&unit);
        cx.preferred[0] = unit;
    }
    if let Some(unit) = unit_of(cx, table, "angle", Dimension::ANGLE, "\"deg\"") {
        cx.model.units.angle = unit_name(&unit);
        cx.preferred[1] = unit;
    }
    for (key, dimension, example) in MORE_UNITS {
        if let Some(unit) = unit_of(cx, table, key, *dimension, example) {
            cx.model.units.more.push(unit_name(&unit));
            cx.preferred.push(unit);
        }
    }
}

fn unit_name(unit: &Unit) -> UnitName {
    UnitName {
        name: unit.text().to_owned(),
        factor: unit.factor(),
    }
}

/// A unit of the file, when it is given and sound.
fn unit_of(
    cx: &mut Context<'_>,
    table: &Table,
    key: &str,
    dimension: Dimension,
    example: &str,
) -> Option<Unit> {
    let node = table.get(key)?;
    let text = cx.text(node, &format!("the unit of {key}"), example)?;
    match Unit::parse(&text.content) {
        Err(issue) => {
            cx.issues(text, vec![issue]);
            None
        }
        Ok(unit) if unit.dimension() != dimension => {
            cx.push(
                Diagnostic::error("unit-mismatch", format!("a unit of {key} expected"))
                    .at(
                        node.span.clone(),
                        format!("this is a unit of {}", unit.dimension()),
                    )
                    .help(format!("write {key} = {example}")),
            );
            None
        }
        Ok(unit) => Some(unit),
    }
}
