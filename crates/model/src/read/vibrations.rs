//! Studies of natural vibrations.
//!
//! ```toml
//! [studies.modes]
//! kind    = "vibrations"
//! release = ["swing"]               # drives that are let go; all without it
//! at      = { lift = "120 mm" }     # where drives stand; at their start without it
//!
//! [studies.over]
//! kind    = "vibrations"
//! release = ["swing"]
//! rows    = 61                      # the frequencies along the motion of the drives that are held
//! ```

use crate::diagnostic::Diagnostic;
use crate::ids::{DriveId, Scalar, Span};
use crate::motion_study::{MotionStudy, Rows};
use crate::node::Key;
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::rows::rows;
use crate::read::simulate::{coordinate, drive_of, released};
use crate::study::{StudyKind, VibrationStudy};

pub(crate) fn read(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<StudyKind> {
    let release = released(cx, entry);
    let settles = match entry.has("equilibrium") {
        true => entry.flag(cx, "equilibrium"),
        false => Some(true),
    };
    let moving = match entry.has("moving") {
        true => entry.flag(cx, "moving"),
        false => Some(false),
    };
    let asked: Vec<&Key> = entry.given(&["step", "rows", "moving"]).collect();
    let rows = match entry.has("step") || entry.has("rows") {
        true => rows(cx, entry),
        false => Some(Rows::Count(1)),
    };
    let at = places(cx, entry);
    let (release, settles, moving, mut rows, at) = (release?, settles?, moving?, rows?, at?);
    let moves = |cx: &Context<'_>, drive: DriveId| {
        let law = cx.model.drives.get(drive.index()).map(|d| &d.law);
        law.is_some_and(|law| law.duration(&cx.values) > 0.0)
            && !(settles && release.contains(&drive))
    };
    let mut drives = (0..cx.model.drives.len() as u32).map(DriveId);
    if !drives.any(|drive| moves(cx, drive)) {
        for key in asked {
            cx.push(
                Diagnostic::warning(
                    "idle-key",
                    format!("`{}` of {} means nothing here", key.name, entry.place),
                )
                .at(key.span.clone(), "no drive that is held moves")
                .help("say under `release` which drives are let go, so that another moves by its law; or leave it out"),
            );
        }
        rows = Rows::Count(1);
    } else if moving && rows == Rows::Count(1) {
        for key in asked.iter().filter(|key| key.name == "moving") {
            cx.push(
                Diagnostic::warning(
                    "idle-key",
                    format!("`moving` of {} means nothing here", entry.place),
                )
                .at(key.span.clone(), "about one pose everything rests")
                .help("say along which rows of the motion: `rows = 61` or `step = \"5 ms\"`"),
            );
        }
    }
    let moving = moving && rows != Rows::Count(1);
    if rows != Rows::Count(1)
        && let Some((drive, _, key)) = at.iter().find(|(drive, ..)| moves(cx, *drive))
    {
        let name = cx.model.drives.get(drive.index()).map_or("", |d| &d.name);
        let message = format!(
            "{} holds `{name}`, which moves by its law",
            entry.place_of("at")
        );
        cx.push(
            Diagnostic::error("over-specified", message)
                .at(
                    key.clone(),
                    "along the motion it stands elsewhere in every row",
                )
                .help("leave it out, or leave out `step` and `rows` for one pose alone"),
        );
        return None;
    }
    Some(StudyKind::Vibrations(VibrationStudy {
        along: MotionStudy {
            rows,
            columns: Vec::new(),
            plots: Vec::new(),
            circuit: false,
        },
        release,
        at: at.into_iter().map(|(drive, at, _)| (drive, at)).collect(),
        settles,
        moving,
    }))
}

/// Where drives stand that do not stand at their start, each with its place in the file.
fn places(cx: &mut Context<'_>, entry: &Entry<'_>) -> Option<Vec<(DriveId, Scalar, Span)>> {
    let Some(node) = entry.get("at") else {
        return Some(Vec::new());
    };
    let table = cx.table(node, &entry.place_of("at"), entry.example_of("at"))?;
    let mut found = Vec::new();
    let mut whole = true;
    for (key, node) in &table.entries {
        let place = drive_of(cx, &key.name, key.span.clone()).and_then(|drive| {
            let at = coordinate(cx, drive, &key.name, node)?;
            Some((drive, at, key.span.clone()))
        });
        whole &= place.is_some();
        found.extend(place);
    }
    whole.then_some(found)
}
