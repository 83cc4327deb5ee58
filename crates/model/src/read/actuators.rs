//! `[cylinders]` and `[motors]`: the machines behind drives, by the drive's name.
//!
//! ```toml
//! [cylinders]
//! lift = { bore = "80 mm", rod = "40 mm", supply = "180 bar", relief = "210 bar", back = "5 bar", flow = "20 L/min" }
//! [motors]
//! motor = { curve = [["0 rpm", "12 N m"], ["3000 rpm", "0 N m"]] }
//! ```
//!
//! A cylinder may also have the `friction` of its seals, and `count` when several act side by side. A motor's curve is
//! straight between its pairs of speed and torque, at the drive.

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::drive::DriveKind;
use crate::ids::{DriveId, Scalar};
use crate::key_table::{CYLINDER, MOTOR};
use crate::load::{HydraulicCylinder, Motor};
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::entry::Entry;
use crate::read::oil;

/// A file has at most so many of each: as many as drives.
const MAX: usize = 1_000;

/// A curve has at most so many pairs.
const MAX_PAIRS: usize = 10_000;

/// Reads all cylinders.
pub(crate) fn read_cylinders(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "cylinders") {
        let cylinder = read_cylinder(cx, entry);
        if cylinder.is_none() {
            cx.broken_cylinders.insert(entry.0.name.clone());
        }
        cx.model.actions.cylinders.extend(cylinder);
    }
}

/// Reads all motors.
pub(crate) fn read_motors(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "motors") {
        let motor = read_motor(cx, entry);
        cx.model.actions.motors.extend(motor);
    }
}

/// The drive that an entry is named after.
fn drive(cx: &mut Context<'_>, key: &Key, cylinder: bool) -> Option<DriveId> {
    let name = key.name.as_str();
    let fits = |kind: &DriveKind| match kind {
        DriveKind::Cylinder { .. } => cylinder,
        DriveKind::Turn { .. } => !cylinder,
        DriveKind::Slide { .. } | DriveKind::Release { .. } | DriveKind::StandIn(_) => false,
    };
    let section = if cylinder { "cylinders" } else { "motors" };
    if let Some((Meaning::Drive(i), declared)) = cx.names.get(name) {
        let declared = declared.clone();
        let id = cx.drives.get(*i).copied().flatten()?;
        let kind = cx.model.drives.get(id.index()).map(|d| &d.kind)?;
        if fits(kind) {
            return Some(id);
        }
        let is = what_it_is(kind);
        let help = if cylinder {
            "cylinders stand behind drives such as lift = { cylinder = \"A-B\", … }"
        } else {
            "motors stand behind drives such as motor = { turns = \"crank\", … }"
        };
        cx.push(
            Diagnostic::error(
                "wrong-drive",
                format!("[{section}] names the drive `{name}`, which {is}"),
            )
            .at(key.span.clone(), "")
            .see(declared, format!("`{name}` {is}"))
            .help(help),
        );
        return None;
    }
    let fitting: Vec<String> = cx
        .model
        .drives
        .iter()
        .filter(|d| fits(&d.kind))
        .map(|d| d.name.clone())
        .collect();
    let mut d = cx.no_such(
        "drive",
        name,
        key.span.clone(),
        fitting.iter().map(String::as_str),
    );
    if fitting.is_empty() {
        d = d.help(if cylinder {
            "the file has no drive that is a cylinder; declare it: lift = { cylinder = \"A-B\", … } under [drives]"
        } else {
            "the file has no drive that turns; declare it: motor = { turns = \"crank\", … } under [drives]"
        });
    }
    cx.push(d.note(format!("an entry of [{section}] has the name of its drive")));
    None
}

/// A drive in words: `turns a link`.
pub(crate) fn what_it_is(kind: &DriveKind) -> &'static str {
    match kind {
        DriveKind::Turn { .. } => "turns a link",
        DriveKind::Cylinder { .. } => "is a cylinder",
        DriveKind::Slide { .. } => "slides along a line",
        DriveKind::Release { .. } => "lets go of a joint",
        DriveKind::StandIn(_) => "stands in for a drive",
    }
}

fn read_cylinder(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<HydraulicCylinder> {
    let (key, _) = entry;
    let drive = drive(cx, key, true);
    let entry = Entry::new(cx, entry, &CYLINDER)?;
    let bore = entry.needed(cx, "bore");
    let rod = entry.needed(cx, "rod");
    let supply = entry.value(cx, "supply");
    let relief = entry.value(cx, "relief");
    let back = entry.value(cx, "back");
    let flow = entry.value(cx, "flow");
    let friction = entry.value_or(cx, "friction", 0.0);
    let count = entry.value_or(cx, "count", 1.0);
    let (bore, rod, supply, relief, back) = (bore?, rod?, supply?, relief?, back?);
    if cx.number(&rod) >= cx.number(&bore) {
        entry.contradiction(
            cx,
            &["rod", "bore"],
            "the rod does not fit into the bore",
            "the rod is thinner than the bore; for a plunger write rod = 0",
        );
        return None;
    }
    for (key, limit) in [("supply", &supply), ("relief", &relief)] {
        let above = |back: &Scalar| {
            limit
                .as_ref()
                .is_some_and(|limit| cx.number(back) >= cx.number(limit))
        };
        if back.as_ref().is_some_and(above) {
            entry.contradiction(
                cx,
                &["back", key],
                &format!("the side that drains has as much pressure as `{key}` allows at all"),
                "`back` is the pressure in the return line, a few bar",
            );
            return None;
        }
    }
    let count = count?;
    let number = cx.number(&count);
    if number != number.round()
        && let Some(node) = entry.get("count")
    {
        let place = entry.place_of("count");
        cx.wrong_type(node, &place, "a whole number", "count = 2");
        return None;
    }
    let oil = oil::read(cx, &entry, supply.is_some());
    let oil = oil?;
    Some(HydraulicCylinder {
        drive: drive?,
        bore,
        rod,
        supply,
        relief,
        back: back.unwrap_or(kempe_units::Expr::Const(0.0)),
        flow: flow?,
        friction: friction?,
        count,
        oil,
        span: key.span.clone(),
    })
}

fn read_motor(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<Motor> {
    let (key, _) = entry;
    let drive = drive(cx, key, false);
    let entry = Entry::new(cx, entry, &MOTOR)?;
    let example = entry.example;
    let node = entry.required(cx, "curve")?;
    let pairs = cx.array(node, &entry.place_of("curve"), example)?;
    if pairs.len() < 2 || pairs.len() > MAX_PAIRS {
        let count = pairs.len();
        return cx.refuse(
            if count < 2 {
                "missing-key"
            } else {
                "too-large"
            },
            format!(
                "the curve of {} has too {} pairs",
                entry.place,
                if count < 2 { "few" } else { "many" }
            ),
            &node.span,
            format!("a curve has 2 to {MAX_PAIRS} pairs of speed and torque: {example}"),
        );
    }
    let mut curve: Vec<(Scalar, Scalar)> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        let Value::Array(_) = pair.value else {
            cx.wrong_type(pair, "a pair of the curve", "[speed, torque]", example);
            return None;
        };
        let (speed, torque) = entry.two(cx, pair, "curve")?;
        let (speed_read, torque_read) = (
            cx.scalar(speed, Dimension::ANGULAR_SPEED),
            cx.scalar(torque, Dimension::TORQUE),
        );
        let (speed_read, torque_read) = (speed_read?, torque_read?);
        if let Some((before, _)) = curve.last()
            && cx.number(&speed_read) <= cx.number(before)
        {
            cx.push(
                Diagnostic::error(
                    "contradictory-values",
                    format!("{}: the speeds of its curve do not rise", entry.place),
                )
                .at(speed.span.clone(), "not above the speed before")
                .help("write the pairs in the order of their speeds"),
            );
            return None;
        }
        curve.push((speed_read, torque_read));
    }
    Some(Motor {
        drive: drive?,
        curve,
        // it may go by measures, which are read later
        throttle: None,
        span: key.span.clone(),
    })
}
