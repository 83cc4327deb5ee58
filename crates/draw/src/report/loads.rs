//! The forces behind a motion's page: what the script needs to draw them at any row, and the switches of their roles.

use super::json;
use crate::loads::{self, LoadSheet, LoadView, Shape};
use crate::stage::Stage;
use crate::tokens::Token;

/// All loads of a motion as a JSON object; `null` when there are none.
pub(super) fn loads(stage: &Stage) -> String {
    let Some(sheet) = &stage.loads else {
        return "null".into();
    };
    let sizes = [("rim", loads::RIM), ("text", loads::LABEL_SIZE)];
    let tracks = 0..sheet.tracks.len();
    let mut fields = lengths(&sizes);
    fields.push((
        "tracks",
        json::array(tracks.map(|number| track(stage, sheet, number))),
    ));
    json::object(&fields)
}

/// The sizes that all arrows share, as a JSON object.
pub(super) fn arrow() -> String {
    json::object(&lengths(&[
        ("head", loads::HEAD),
        ("half", loads::HALF_HEAD),
        ("gap", loads::BREAK),
    ]))
}

fn lengths(sizes: &[(&'static str, f64)]) -> Vec<(&'static str, String)> {
    let sizes = sizes.iter();
    sizes
        .map(|(name, mm)| (*name, json::decimal(*mm, 3)))
        .collect()
}

/// A load through the motion: its look, its point (x and y row after row, once when it stands still), the arrow (the
/// same way), the angle of the moment, and the rows where it is off the scale.
fn track(stage: &Stage, sheet: &LoadSheet, number: usize) -> String {
    let track = &sheet.tracks[number];
    let (words, stance) = (&sheet.words[number], &sheet.stances[number]);
    let frames = stage.context.frames;
    let at = |load: &LoadView| stage.context.fit.paper(load.at);
    let (mut points, mut arrows, mut turns, mut broken) = (vec![], vec![], vec![], vec![]);
    for row in 0..frames.len() {
        let load = track
            .load(frames, row)
            .and_then(|load| Some((load, at(load)?)));
        let place = load.map_or([f64::NAN; 2], |(_, p)| p);
        points.push(place.map(|v| json::decimal(v, 2)).join(","));
        let shapes = load.map_or([None; 2], |(load, _)| sheet.shapes(load, [0.0; 2]));
        let mut off = false;
        let (mut arrow, mut turn) = ([f64::NAN; 2], f64::NAN);
        for shape in shapes.into_iter().flatten() {
            match shape {
                Shape::Force { vector, broken, .. } => (arrow, off) = (vector, off || broken),
                Shape::Moment { sweep, broken, .. } => (turn, off) = (sweep, off || broken),
            }
        }
        arrows.push(arrow.map(|v| json::decimal(v, 2)).join(","));
        turns.push(json::decimal(turn, 3));
        if off {
            broken.push(row.to_string());
        }
    }
    let stroke = loads::Stroke::of(track.role);
    let dash: Vec<String> = stroke.dash.iter().map(|d| json::decimal(*d, 2)).collect();
    let stands = [stance.turn, stance.gap, stance.share].map(|v| json::decimal(v, 3));
    let room = [words.half[0], words.half[1], words.rise].map(|v| json::decimal(v, 3));
    json::object(&[
        ("role", json::string(track.role.name())),
        (
            "c",
            json::string(&format!("var(--{})", Token::Load(track.role).name())),
        ),
        ("w", json::decimal(stroke.width, 2)),
        ("dash", json::string(&dash.join(" "))),
        ("open", stroke.open.to_string()),
        ("label", json::string(&track.label)),
        ("room", json::array(room)),
        ("stands", json::array(stands)),
        ("r", json::decimal(loads::moment_radius(track.role), 2)),
        ("p", once(points)),
        ("f", once(arrows)),
        ("m", once(turns)),
        ("broken", json::array(broken)),
    ])
}

/// An array of rows; one row when all are the same.
fn once(mut rows: Vec<String>) -> String {
    if rows.windows(2).all(|pair| pair[0] == pair[1]) {
        rows.truncate(1);
    }
    json::array(rows)
}

/// A switch for each role that occurs.
pub(super) fn switches(stage: &Stage) -> String {
    let Some(sheet) = &stage.loads else {
        return String::new();
    };
    let switch = |role: &crate::loads::LoadRole| {
        format!(
            "<label><input type=\"checkbox\" data-role=\"{}\" checked> {}</label>\n",
            role.name(),
            role.title()
        )
    };
    format!(
        "<fieldset class=\"row roles\"><legend>Forces</legend>\n{}</fieldset>\n",
        sheet.roles.iter().map(switch).collect::<String>()
    )
}
