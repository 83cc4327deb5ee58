//! Studies that ask for outputs that rest while a mechanism moves on.
//!
//! ```toml
//! [studies.rest]
//! kind   = "synthesize"
//! task   = "dwell"
//! point  = "P"
//! dwell  = "120 deg"
//! output = "lever"          # or "slider", "slot"
//! swing  = "30 deg"
//! ```

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, PointId, Span};
use crate::key_table::synthesis::OUTPUTS;
use crate::read::choices::drive_named;
use crate::read::context::Context;
use crate::read::entry::Entry;
use crate::read::guidance::corners;
use crate::synthesis::{DwellOutput, DwellTask};

/// The study's point, and where it is named; none of the frame.
pub(crate) fn moving_point(
    cx: &mut Context<'_>,
    entry: &Entry<'_>,
    help: &str,
) -> Option<(PointId, Span)> {
    let (point, node) = entry.point(cx, "point")?;
    if cx.carriers(point).contains(&FRAME) {
        let name = cx.point_name(point).to_owned();
        return cx.refuse(
            "bad-choice",
            format!("`{name}` stands still"),
            &node.span,
            help,
        );
    }
    Some((point, node.span.clone()))
}

pub(crate) fn read(cx: &mut Context<'_>, entry: &mut Entry<'_>) -> Option<DwellTask> {
    let point = moving_point(
        cx,
        entry,
        "name a point of a link that moves: what it moves can then rest for a while",
    );
    let drive = drive_named(cx, entry);
    let output = entry.choice(cx, "output", &OUTPUTS);
    let output = output.map(|it| it.unwrap_or(DwellOutput::Lever));
    let pivots_in = corners(cx, entry, "pivots_in");
    let (point, place) = point?;
    let (drive, coordinate) = drive?;
    entry.turning = coordinate == Dimension::ANGLE;
    let dwell = entry.needed(cx, "dwell");
    let slides = output? == DwellOutput::Slider;
    let (own, other) = match slides {
        true => ("stroke", "swing"),
        false => ("swing", "stroke"),
    };
    if let (true, Some((key, _))) = (slides, entry.entry("pivots_in")) {
        cx.push(
            Diagnostic::warning("idle-key", "`pivots_in` means nothing here")
                .at(key.span.clone(), "a slider has no fixed pivot")
                .help("leave it out"),
        );
    }
    if let Some((key, _)) = entry.entry(other) {
        let word = crate::key_table::word_of(&OUTPUTS, &output?);
        cx.push(
            Diagnostic::error(
                "bad-choice",
                format!("the output is a {word}: `{other}` means nothing"),
            )
            .at(key.span.clone(), "")
            .help(format!("write {own} = {}", entry.example_of(own))),
        );
        return None;
    }
    let stroke = match output? {
        DwellOutput::Slot => entry.needed(cx, own).map(Some),
        _ => entry.value(cx, own),
    };
    let span_of = |key: &str| entry.get(key).map_or(0..0, |node| node.span.clone());
    Some(DwellTask {
        point,
        drive,
        dwell: dwell?,
        output: output?,
        stroke: stroke?,
        pivots_in: pivots_in?,
        spans: [place, span_of("dwell"), span_of(own)],
    })
}
