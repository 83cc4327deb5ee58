//! `[switches]`: what goes on and off where something passes a place, in simulations.
//!
//! ```toml
//! [switches]
//! top   = { on = "y(P) <= 100 mm", off = "y(P) >= 400 mm", starts = "on" }
//! teeth = { on = "angle(wheel) >= 30 deg", every = "30 deg" }              # counts the teeth that have passed
//! ```

use kempe_units::Dimension;

use crate::condition::Condition;
use crate::key_table::{ON_OFF, SWITCH};
use crate::node::{Key, Node};
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::simulate::condition;
use crate::read::springs::plain_name;
use crate::switch::Switch;

/// A file has at most so many.
const MAX: usize = 1_000;

/// Makes the switches known to measures, before they are read.
pub(crate) fn declare(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for (index, (key, _)) in entries.iter().enumerate() {
        let place = Some((index, Dimension::NONE));
        cx.switches.insert(key.name.clone(), place);
    }
}

/// Reads all switches.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    for entry in cx.limited(entries, MAX, "switches") {
        plain_name(cx, &entry.0, "a switch");
        let switch = read_switch(cx, entry);
        cx.model.actions.switches.extend(switch);
    }
}

fn read_switch(cx: &mut Context<'_>, entry: &(Key, Node)) -> Option<Switch> {
    let (key, _) = entry;
    let entry = Entry::new(cx, entry, &SWITCH)?;
    let on = entry.required(cx, "on");
    let on = on.and_then(|node| told(cx, &entry, "on", node));
    let off = match entry.get("off") {
        Some(node) => told(cx, &entry, "off", node).map(Some),
        None => Some(None),
    };
    let starts = entry.choice(cx, "starts", &ON_OFF);
    let (on, off) = (on?, off?);
    let every = match entry.get("every") {
        Some(node) => {
            let place = entry.place_of("every");
            Some(cx.positive(node, on.dimension, &place, false)?)
        }
        None => None,
    };
    let reverse = ["off", "starts"].into_iter().find(|key| entry.has(key));
    if let (Some(_), Some(key)) = (&every, reverse) {
        entry.contradiction(
            cx,
            &[key, "every"],
            "it counts, or it goes on and off",
            &format!(
                "leave `{key}` out: what counts begins with what has passed and goes on from there"
            ),
        );
        return None;
    }
    if off.as_ref().is_some_and(|off| off.above == on.above) {
        entry.contradiction(
            cx,
            &["off", "on"],
            "it goes on and off where the same comes to hold",
            "leave `off` out: it goes off where `on` holds no more; or name another place",
        );
        return None;
    }
    Some(Switch {
        name: key.name.clone(),
        on,
        off,
        every,
        starts: starts?,
        span: key.span.clone(),
    })
}

fn told(cx: &mut Context<'_>, entry: &Entry<'_>, key: &str, node: &Node) -> Option<Condition> {
    let text = cx.text(node, &entry.place_of(key), entry.example_of(key))?;
    condition(cx, node, text)
}
