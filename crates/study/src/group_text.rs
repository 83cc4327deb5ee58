//! Assur groups in words.

use kempe_mechanism::assur::{AssurGroup, GroupKind};
use kempe_model::Model;

/// What a group is, with its drives.
pub(crate) fn kind_text(model: &Model, group: &AssurGroup) -> String {
    let kind = match group.kind {
        GroupKind::PinInSlot => "pin in curved slot",
        GroupKind::LinkInSlot => "link and curved slot",
        GroupKind::Idle => "body with an idle turn",
        GroupKind::Turned if group.drives.is_empty() => "link turned with another",
        GroupKind::Turned | GroupKind::Link => "link",
        GroupKind::Gear => "gear",
        GroupKind::BeltWheel => "belt wheel",
        GroupKind::Pinion => "pinion",
        GroupKind::RedundantBar => "bar between two placed pins (redundant)",
        GroupKind::RrrOfCylinder => "RRR dyad of link and cylinder",
        GroupKind::RrrOfSlot => "RRR dyad of link and curved slot",
        GroupKind::RrpOfSlot => "RRP dyad of link and slot",
        GroupKind::RprOfSlot => "RPR dyad of link and slot",
        GroupKind::Slider => "slider",
        GroupKind::Rrr => "RRR dyad",
        GroupKind::Rrp => "RRP dyad",
        GroupKind::Rpr => "RPR dyad",
        GroupKind::Prp => "PRP dyad",
        GroupKind::Rpp => "RPP dyad",
        GroupKind::Pair => "pair of links",
        GroupKind::Larger(links) => {
            let class = roman(group.class);
            return with_drives(
                model,
                group,
                &format!("Assur group of class {class} with {links} links"),
            );
        }
        _ => "group",
    };
    with_drives(model, group, kind)
}

fn with_drives(model: &Model, group: &AssurGroup, kind: &str) -> String {
    let drives = group.drives.iter();
    let names: Vec<&str> = drives
        .filter_map(|drive| Some(model.drives.get(drive.index())?.name.as_str()))
        .collect();
    match names.as_slice() {
        [] => kind.to_owned(),
        names => format!("{kind} with drive {}", names.join(", ")),
    }
}

/// A group by its kind and class, and how it is solved.
pub(crate) fn group_text(class: u32, kind: &str, closed_form: bool) -> String {
    let by = if closed_form {
        "closed form"
    } else {
        "Newton's method"
    };
    format!("{kind}, class {}, {by}", roman(class))
}

fn roman(n: u32) -> String {
    let known = ["I", "II", "III", "IV", "V", "VI", "VII", "VIII"];
    let found = n.checked_sub(1).and_then(|k| known.get(k as usize));
    found.map_or_else(|| n.to_string(), |found| (*found).to_owned())
}
