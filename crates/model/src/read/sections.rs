//! The file's sections, in the order in which they build on each other.

use kempe_units::{Unit, nearest};

use crate::diagnostic::Diagnostic;
use crate::drive::DriveKind;
use crate::ids::{FRAME, LinkId};
use crate::key_table::{FILE, UNITS};
use crate::keys::{self, Takes};
use crate::model::UnitName;
use crate::node::{Key, Node, Table, Value};
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::{
    actuators, assembly, clearance, controls, drawn, drives, friction, joints, links, loads,
    masses, measures, names, parameters, places, springs, studies, switches, synthesis,
};
use crate::study::StudyKind;

/// Reads the whole file.
pub(crate) fn read(cx: &mut Context<'_>, root: &Table, overrides: &[(String, String)]) {
    let known = FILE.names();
    cx.unknown_keys(root, "the file", &known);
    for (key, node) in &root.entries {
        let name = key.name.as_str();
        if !known.contains(&name)
            && nearest(name, known.iter().copied()).is_some()
            && let Value::Table(table) = &node.value
        {
            let within = table
                .entries
                .iter()
                .flat_map(|(_, node)| match &node.value {
                    Value::Table(table) => table.entries.as_slice(),
                    _ => &[],
                });
            let entries = table.entries.iter().chain(within);
            cx.broken
                .skip_section(entries.map(|(key, _)| key.name.as_str()));
        }
    }
    let file = Entry::of(root, &(0..0), "the file".to_owned(), &FILE);
    if let Some(node) = file.get("title")
        && let Some(text) = cx.text(node, "`title`", file.example_of("title"))
    {
        cx.model.title = text.content.clone();
    }
    if let Some((key, node)) = file.entry("units") {
        units(cx, key, node);
    }
    let sections = names::collect(cx, &file);
    parameters::read(cx, sections.of("parameters"), overrides);
    let whole = file
        .get("links")
        .is_none_or(|n| matches!(n.value, Value::Table(_)));
    places::read(cx, sections.of("places"));
    // a file that asks for linkages alone has a frame without points
    if file.has("links") || file.has("places") || !synthesis::alone(sections.of("studies")) {
        links::read(cx, sections.of("links"), sections.first_link, whole);
    }
    places::frame_as_drawn(cx);
    joints::read(cx, sections.of("joints"));
    drives::read(cx, sections.of("drives"));
    assembly::read(cx, sections.of("assembly"));
    drawn::single_points(cx);
    drawn::assemble(cx, &file);
    loose_links(cx);
    if let Some(node) = file.get("gravity") {
        masses::read_gravity(cx, node);
    }
    masses::read(cx, sections.of("masses"));
    masses::without_inertia(cx);
    springs::read_springs(cx, sections.of("springs"));
    springs::read_dampers(cx, sections.of("dampers"));
    friction::read(cx, sections.of("friction"));
    clearance::read(cx, sections.of("clearance"));
    actuators::read_cylinders(cx, sections.of("cylinders"));
    actuators::read_motors(cx, sections.of("motors"));
    loads::declare(cx, sections.of("loads"));
    switches::declare(cx, sections.of("switches"));
    measures::read(cx, sections.of("measures"));
    loads::read(cx, sections.of("loads"));
    switches::read(cx, sections.of("switches"));
    controls::read(cx, sections.of("cylinders"), sections.of("motors"));
    studies::read(cx, sections.of("studies"));
    let asked = (cx.model.studies.iter()).any(|s| !matches!(s.kind, StudyKind::Motion(_)))
        || cx.model.measures.iter().any(|m| m.needs_forces);
    if asked {
        cx.found.append(&mut cx.of_forces);
    }
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
        // what is wrong with its points has been told
        if link.points.is_empty() {
            continue;
        }
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

fn units(cx: &mut Context<'_>, key: &Key, node: &Node) {
    let Some(table) = Entry::inner(cx, node, &key.span, "`units`".to_owned(), &UNITS) else {
        return;
    };
    for (i, key) in UNITS.keys().enumerate() {
        let Some(unit) = unit_of(cx, &table, key) else {
            continue;
        };
        let name = unit_name(&unit);
        match key.name {
            "length" => cx.model.units.length = name,
            "angle" => cx.model.units.angle = name,
            _ => cx.model.units.more.push(name),
        }
        match cx.preferred.get_mut(i).filter(|_| i < 2) {
            Some(own) => *own = unit,
            None => cx.preferred.push(unit),
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
fn unit_of(cx: &mut Context<'_>, table: &Entry<'_>, row: &keys::Key) -> Option<Unit> {
    let (key, example) = (row.name, row.example);
    let Takes::Unit(dimension) = row.takes else {
        return None;
    };
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
