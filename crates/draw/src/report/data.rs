//! The data behind a motion's page: its rows, their poses with just enough digits, and what the other files give.

use super::happenings::Along;
use super::motion_report::{Event, MotionReport};
use super::rows::Rows;
use super::{columns, json, plots, vectors};
use crate::context::{Anchor, Context};
use crate::stage::Stage;
use crate::view::Frame;

/// All of a motion as one JSON object.
pub(super) fn motion(
    motion: &MotionReport,
    rows: &Rows,
    stage: &Stage,
    shown: usize,
    happenings: &Along<'_>,
) -> String {
    let traces = motion
        .view
        .traces
        .iter()
        .zip(&stage.traces)
        .map(|(view, path)| {
            json::object(&[
                ("p", view.point.to_string()),
                ("c", json::string(&format!("var(--{})", path.token.name()))),
            ])
        });
    let gaps = motion.evidence.not_reached.iter().map(|gap| {
        json::array([
            gap.first.to_string(),
            gap.last.to_string(),
            json::string(&gap.reason),
        ])
    });
    let mut fields = vec![
        ("name", json::string(&motion.name)),
        ("all", rows.all.to_string()),
        ("row", json::array(rows.kept.iter().map(usize::to_string))),
    ];
    fields.extend(columns::columns(motion, rows));
    fields.extend(mechanism(stage, &motion.frames, rows, shown));
    fields.extend([
        ("shown", shown.to_string()),
        (
            "named",
            json::array(motion.view.points.iter().map(|n| json::string(n))),
        ),
        ("traces", json::array(traces)),
        ("arrow", super::loads::arrow()),
        ("loads", super::loads::loads(stage)),
        ("vectors", vectors::vectors(motion, rows, stage)),
        ("plots", plots::plots(motion, rows)),
        (
            "events",
            json::array(motion.events.iter().map(|e| event(e, rows))),
        ),
        ("gaps", json::array(gaps)),
        ("against", against(motion, rows, stage, shown)),
    ]);
    if !motion.happenings.is_empty() {
        fields.push(("happenings", happenings.json()));
    }
    json::object(&fields)
}

/// What moves the drawing of a mechanism: its sheet, where its links are row after row, its points on them, and what each part hangs on.
pub(super) fn mechanism(
    stage: &Stage,
    frames: &[Frame],
    rows: &Rows,
    shown: usize,
) -> Vec<(&'static str, String)> {
    let [width, height] = stage.size();
    let drawn = frames.get(shown);
    let anchors = stage.anchors();
    let anchors = anchors.iter().map(|a| anchor(*a, drawn, &stage.context));
    vec![
        (
            "size",
            json::array([json::decimal(width, 3), json::decimal(height, 3)]),
        ),
        ("links", links(frames, rows, &stage.context)),
        ("points", points(&stage.context)),
        ("anchors", json::array(anchors)),
    ]
}

/// The other design: what moves its outline, and its values; null where there is none.
fn against(motion: &MotionReport, rows: &Rows, stage: &Stage, shown: usize) -> String {
    let (Some(other), Some(ghost)) = (&motion.against, &stage.other) else {
        return "null".into();
    };
    let anchors = ghost.anchors();
    let drawn = other.frames.get(shown);
    let anchors = anchors.iter().map(|a| anchor(*a, drawn, &ghost.context));
    let values = other.values.iter().map(|values| match values {
        Some(values) => columns::values(rows, values),
        None => "null".into(),
    });
    let [width, height] = stage.size();
    json::object(&[
        (
            "size",
            json::array([json::decimal(width, 3), json::decimal(height, 3)]),
        ),
        ("links", links(&other.frames, rows, &ghost.context)),
        ("points", points(&ghost.context)),
        ("anchors", json::array(anchors)),
        ("values", json::array(values)),
    ])
}

/// For each link, x, y (mm on paper, y up) and angle of its first point, row after row; once for a link that stands still.
fn links(frames: &[Frame], rows: &Rows, context: &Context) -> String {
    let of_link = |link: usize| {
        let pose = |row: &usize| match frames.get(*row).and_then(|f| context.link_pose(f, link)) {
            Some([x, y, a]) => [
                json::decimal(x, 3),
                json::decimal(y, 3),
                json::decimal(a, 5),
            ]
            .join(","),
            None => "null,null,null".into(),
        };
        let mut poses: Vec<String> = rows.kept.iter().map(pose).collect();
        // a link that stands still is written once
        poses.dedup();
        if poses.len() == 1 {
            json::array(poses)
        } else {
            json::array(rows.kept.iter().map(pose))
        }
    };
    json::array((0..context.view.links.len()).map(of_link))
}

fn points(context: &Context) -> String {
    let point = |index: usize| match context.point_on_link(index) {
        Some((link, [x, y])) => {
            json::array([link.to_string(), json::decimal(x, 3), json::decimal(y, 3)])
        }
        None => "null".into(),
    };
    json::array((0..context.view.points.len()).map(point))
}

fn anchor(anchor: Anchor, drawn: Option<&Frame>, context: &Context) -> String {
    let parts = match anchor {
        Anchor::Point(p) => vec![json::string("p"), p.to_string()],
        Anchor::On(p, link, offset) => {
            vec![
                json::string("o"),
                p.to_string(),
                link.to_string(),
                json::decimal(offset, 5),
            ]
        }
        Anchor::Toward(p, q) => vec![json::string("t"), p.to_string(), q.to_string()],
        Anchor::Between(p, q) => {
            // the drawn pose has its stretch in it already
            let drawn = drawn.and_then(|f| context.place(f, anchor));
            let stretch = drawn.map_or(1.0, |place| place.stretch);
            vec![
                json::string("b"),
                p.to_string(),
                q.to_string(),
                json::decimal(stretch, 3),
            ]
        }
    };
    json::array(parts)
}

fn event(event: &Event, rows: &Rows) -> String {
    json::object(&[
        ("row", rows.nearest(event.row).to_string()),
        ("label", json::string(&event.label)),
        ("kind", json::string(plots::marker(event.kind))),
    ])
}
