//! `[studies.NAME]`: what is asked of the model.

use std::collections::BTreeMap;

use crate::diagnostic::Diagnostic;
use crate::key_table::{DRIVES, STUDIES};
use crate::motion_study::{Column, MotionStudy, Plot, Rows};
use crate::node::{Key, Node, Table, Value};
use crate::read::column::column;
use crate::read::context::Context;
use crate::read::entry::{Entry, entries};
use crate::read::names::long_name;
use crate::read::plots::plot;
use crate::read::rows::{default_rows, rows};
use crate::read::{adjust, choices, clearance, designs, simulate, synthesis, vibrations};
use crate::study::{Study, StudyKind};

/// Rows along a circuit when the file does not say.
const CIRCUIT_ROWS: usize = 361;

/// Reads all studies; without any, there is one motion study called `motion`.
pub(crate) fn read(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    tell_clashes(cx, entries);
    // Studies of many designs come later: they run others. Sweeps come last: they run any but sweeps.
    let mut kinds: Vec<Option<StudyKind>> = vec![None; entries.len()];
    let order = |node: &Node| match kind_of(node) {
        Some("sweep") => 2,
        Some(kind) if designs::KINDS.contains(&kind) => 1,
        _ => 0,
    };
    for turn in 0..3 {
        let known = kinds.clone();
        let mut others = designs::Others::default();
        for ((key, node), kind) in entries.iter().zip(&known) {
            match order(node) < turn {
                true => others.own.push((&key.name, kind.as_ref())),
                false => others.of_designs.push(&key.name),
            }
        }
        for (i, entry) in entries.iter().enumerate() {
            if order(&entry.1) == turn {
                kinds[i] = read_study(cx, entry, &others);
            }
        }
    }
    for ((key, _), kind) in entries.iter().zip(kinds) {
        if let Some(kind) = kind {
            cx.model.studies.push(Study {
                name: key.name.clone(),
                kind,
                span: key.span.clone(),
            });
        }
    }
    if entries.is_empty() && !cx.model.drives.is_empty() {
        let kind = StudyKind::Motion(MotionStudy {
            rows: default_rows(cx),
            columns: Vec::new(),
            plots: Vec::new(),
            circuit: false,
        });
        cx.model.studies.push(Study {
            name: "motion".to_owned(),
            kind,
            span: 0..0,
        });
    }
}

/// Names that stand for devices on Windows, whatever ending they have.
const DEVICES: &[&str] = &["con", "prn", "aux", "nul"];

/// Devices that are numbered from 0 to 9.
const NUMBERED_DEVICES: &[&str] = &["com", "lpt"];

/// Why a study's name cannot be a file's name too, as a remedy.
pub(crate) fn no_file_name(name: &str) -> Option<String> {
    let known = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(known) {
        return Some("its name becomes a file's name: letters, digits, _ and -".to_owned());
    }
    if name.starts_with('-') {
        let rest = name.trim_start_matches('-');
        let such = if rest.is_empty() { "turn" } else { rest };
        return Some(format!(
            "on the command line it would be an option: write `{such}`"
        ));
    }
    let small = name.to_lowercase();
    let numbered = NUMBERED_DEVICES.iter().any(|device| {
        let number = small.strip_prefix(device);
        number.is_some_and(|n| n.len() == 1 && n.chars().all(|c| c.is_ascii_digit()))
    });
    (numbered || DEVICES.contains(&small.as_str())).then(|| {
        format!("its name becomes a file's name, and Windows has a device called so: write `{name}_study`")
    })
}

/// Studies whose files would be the same where capitals do not count in file names.
fn tell_clashes(cx: &mut Context<'_>, entries: &[&(Key, Node)]) {
    let mut known: BTreeMap<String, &Key> = BTreeMap::new();
    for (key, _) in entries {
        match known.entry(key.name.to_lowercase()) {
            std::collections::btree_map::Entry::Vacant(place) => {
                place.insert(key);
            }
            std::collections::btree_map::Entry::Occupied(other) => cx.push(
                Diagnostic::error(
                    "name-clash",
                    format!(
                        "studies `{}` and `{}` write the same files",
                        other.get().name,
                        key.name
                    ),
                )
                .at(key.span.clone(), "")
                .see(
                    other.get().span.clone(),
                    "this one differs in capitals only",
                )
                .help("file names differ by more than capitals: rename one of them"),
            ),
        }
    }
}

/// The word behind `kind` of a study.
fn kind_of(node: &Node) -> Option<&str> {
    let Value::Table(table) = &node.value else {
        return None;
    };
    match table.entry("kind").map(|(_, node)| &node.value) {
        Some(Value::Text(text)) => Some(text.content.trim()),
        _ => None,
    }
}

/// Whether a study of many designs runs a synthesis, which needs no mechanism.
fn is_over_synthesis(table: &Table, others: &designs::Others<'_>) -> bool {
    let over = table.entry("over").map(|(_, node)| &node.value);
    let Some(Value::Text(over)) = over else {
        return false;
    };
    let own = others.own.iter();
    let mut own = own.filter(|(name, _)| *name == over.content.trim());
    own.any(|(_, kind)| matches!(kind, Some(StudyKind::Synthesize(_))))
}

fn read_study(
    cx: &mut Context<'_>,
    entry: &(Key, Node),
    others: &designs::Others<'_>,
) -> Option<StudyKind> {
    let (key, node) = entry;
    let place = format!("study `{}`", key.name);
    if long_name(cx, &key.name, &key.span) {
        // The length is what is wrong, whatever else is.
    } else if let Some(help) = no_file_name(&key.name) {
        cx.push(
            Diagnostic::error("bad-name", format!("`{}` cannot name a study", key.name))
                .at(key.span.clone(), "")
                .help(help),
        );
    }
    let motion = STUDIES[0];
    let table = cx.table(node, &place, motion.example)?;
    let any = Entry::of(table, &key.span, place.clone(), motion);
    let kind = any.required_like(cx, "kind", any.example_of("kind"))?;
    let text = any.text(cx, "kind", kind)?;
    let name = text.content.trim();
    if name == synthesis::KIND {
        return synthesis::read(cx, entry);
    }
    let Some(known) = STUDIES.iter().find(|kind| kind.name == name) else {
        let of_motion = STUDIES.iter().map(|kind| kind.name);
        let of_motion = of_motion.filter(|name| !name.contains(' '));
        let kinds: Vec<&str> = of_motion.chain([synthesis::KIND]).collect();
        let near = kempe_units::nearest(name, kinds.iter().copied());
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the kinds are {}", kinds.join(", ")),
        };
        cx.push(
            Diagnostic::error(
                "unknown-study",
                format!("there is no kind of study `{name}`"),
            )
            .at(text.span(0..text.content.len()), "")
            .help(help),
        );
        of_unknown_kind(cx, entry, &place, near);
        return None;
    };
    if cx.drives.is_empty() && !(name == "sweep" && is_over_synthesis(table, others)) {
        let message = format!("{place} has nothing that moves");
        let help = format!("say what moves: [drives] {}", DRIVES[0].example);
        return cx.refuse("no-drive", message, &key.span, help);
    }
    let mut entry = Entry::new(cx, entry, known)?;
    if name == "vibrations" {
        return vibrations::read(cx, &entry);
    }
    if name == "adjust" {
        return adjust::read(cx, &entry, key);
    }
    if designs::KINDS.contains(&name) {
        return designs::read(cx, &entry, key, others);
    }
    let in_time = name == "simulate" || (name == "clearance" && clearance::loses_contact(&entry));
    let rows = match in_time {
        true => simulate::rows(cx, &entry),
        false => rows(cx, &entry),
    };
    let forces = name != "motion";
    let (columns, plots) = if known.key("columns").is_some() {
        (columns(cx, &entry, forces), plots(cx, &entry, forces))
    } else {
        Default::default()
    };
    let circuit = known.key("circuit").is_some() && entry.flag(cx, "circuit")?;
    // Along a circuit the drive turns back: rows stand evenly along the arc unless a step is asked for.
    let rows = match rows? {
        _ if circuit && !entry.has("step") && !entry.has("rows") => Rows::Count(CIRCUIT_ROWS),
        rows => rows,
    };
    let along = MotionStudy {
        rows,
        columns,
        plots,
        circuit,
    };
    match name {
        "motion" => Some(StudyKind::Motion(along)),
        "forces" => Some(StudyKind::Forces(along)),
        "balance" => choices::balance(cx, &entry, along),
        "simulate" => simulate::simulate(cx, &entry, along),
        "clearance" => clearance::study(cx, &entry, along),
        _ => choices::spring(cx, &mut entry, along),
    }
}

/// Tells what is wrong with a study whatever its kind may be; `near` is the kind that may be meant.
fn of_unknown_kind(
    cx: &mut Context<'_>,
    (key, node): &(Key, Node),
    place: &str,
    near: Option<&str>,
) {
    let Value::Table(table) = &node.value else {
        return;
    };
    let meant = STUDIES.iter().find(|kind| Some(kind.name) == near);
    let keys: Vec<&str> = match meant {
        Some(kind) => kind.names(),
        None => STUDIES.iter().flat_map(|kind| kind.names()).collect(),
    };
    cx.unknown_keys(table, place, &keys);
    // only one kind knows no forces; what asks for them is told once the kind is known
    let any = Entry::of(table, &key.span, place.to_owned(), STUDIES[0]);
    columns(cx, &any, true);
    plots(cx, &any, true);
    if !cx.drives.is_empty() {
        rows(cx, &any);
    }
}

fn columns(cx: &mut Context<'_>, entry: &Entry<'_>, forces: bool) -> Vec<Column> {
    let nodes = entries(cx, entry, "columns").into_iter();
    nodes.filter_map(|node| column(cx, node, forces)).collect()
}

fn plots(cx: &mut Context<'_>, entry: &Entry<'_>, forces: bool) -> Vec<Plot> {
    let nodes = entries(cx, entry, "plot").into_iter();
    nodes.filter_map(|node| plot(cx, node, forces)).collect()
}
