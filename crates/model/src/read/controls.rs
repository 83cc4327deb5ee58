//! What controls cylinders and motors in a simulation, and may go by measures of the motion: openings of valves, throttles.

use kempe_units::Dimension;

use crate::amount::Amount;
use crate::ids::DriveId;
use crate::key_table::{CYLINDER, MOTOR, OIL};
use crate::node::{Key, Node, Value};
use crate::read::context::{Context, Meaning};
use crate::read::entry::Entry;
use crate::read::loads::amount;

/// Reads the valves of cylinders and the throttles of motors that are sound otherwise.
pub(crate) fn read(cx: &mut Context<'_>, cylinders: &[&(Key, Node)], motors: &[&(Key, Node)]) {
    for (key, node) in cylinders.iter().copied() {
        let Some(drive) = drive(cx, key) else {
            continue;
        };
        let cylinders = &cx.model.actions.cylinders;
        let Some(at) = cylinders
            .iter()
            .position(|c| c.drive == drive && c.oil.is_some())
        else {
            continue;
        };
        let Some(valve) = valve(cx, key, node) else {
            continue;
        };
        let cylinder = cx.model.actions.cylinders.get_mut(at);
        if let Some(oil) = cylinder.and_then(|c| c.oil.as_mut()) {
            oil.valve = valve;
        }
    }
    for (key, node) in motors.iter().copied() {
        let Some(drive) = drive(cx, key) else {
            continue;
        };
        let motors = &cx.model.actions.motors;
        let Some(at) = motors.iter().position(|m| m.drive == drive) else {
            continue;
        };
        let Value::Table(table) = &node.value else {
            continue;
        };
        let place = format!("{} `{}`", MOTOR.what, key.name);
        let entry = Entry::of(table, &key.span, place, &MOTOR);
        let Some(throttle) = entry.get("throttle") else {
            continue;
        };
        let throttle = amount(cx, &entry, throttle, Dimension::NONE);
        if let Some(motor) = cx.model.actions.motors.get_mut(at) {
            motor.throttle = throttle;
        }
    }
}

/// The sound drive of a name.
fn drive(cx: &Context<'_>, key: &Key) -> Option<DriveId> {
    match cx.names.get(&key.name) {
        Some((Meaning::Drive(i), _)) => cx.drives.get(*i).copied().flatten(),
        _ => None,
    }
}

/// The openings to both sides of a cylinder whose other keys are read.
fn valve(cx: &mut Context<'_>, key: &Key, node: &Node) -> Option<(Amount, Option<Amount>)> {
    let Value::Table(table) = &node.value else {
        return None;
    };
    let place = format!("{} `{}`", CYLINDER.what, key.name);
    let (oil_key, oil) = Entry::of(table, &key.span, place.clone(), &CYLINDER).entry("oil")?;
    let Value::Table(table) = &oil.value else {
        return None;
    };
    let entry = Entry::of(table, &oil_key.span, format!("{} {place}", OIL.what), &OIL);
    let node = entry.get("valve")?;
    match &node.value {
        Value::Array(_) => {
            let (bore, ring) = entry.two(cx, node, "valve")?;
            let [bore, ring] = [bore, ring].map(|node| amount(cx, &entry, node, Dimension::NONE));
            Some((bore?, Some(ring?)))
        }
        _ => Some((amount(cx, &entry, node, Dimension::NONE)?, None)),
    }
}
