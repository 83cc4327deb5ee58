//! The data behind a motion's page: poses, columns and plots, with just enough digits.

use super::{Event, MOST_ROWS, MotionReport, json};
use crate::context::Anchor;
use crate::plot::{Curve, MarkerKind, PlotPicture, PlotSpec, Scale};
use crate::stage::Stage;

/// Significant digits of measures.
const DIGITS: usize = 7;

/// The rows of a motion that the page carries.
pub(super) struct Rows {
    /// How many the motion has.
    pub all: usize,
    /// Those that are kept.
    pub kept: Vec<usize>,
}

impl Rows {
    pub fn of(motion: &MotionReport) -> Rows {
        let columns = motion.columns.iter().map(|c| c.values.len());
        let all = columns.fold(
            motion.frames.len().min(motion.drive.values.len()),
            usize::min,
        );
        let stride = all.div_ceil(MOST_ROWS).max(1);
        let mut kept: Vec<usize> = (0..all).step_by(stride).collect();
        if kept.last().is_some_and(|last| last + 1 < all) {
            kept.push(all - 1);
        }
        Rows { all, kept }
    }

    /// The kept row nearest to a row.
    pub fn nearest(&self, row: usize) -> usize {
        let after = self
            .kept
            .partition_point(|k| *k < row)
            .min(self.kept.len().saturating_sub(1));
        let before = after.saturating_sub(1);
        let gap = |k: usize| self.kept.get(k).map_or(usize::MAX, |r| r.abs_diff(row));
        if gap(before) < gap(after) {
            before
        } else {
            after
        }
    }

    fn column(&self, values: &[f64]) -> String {
        json::array(
            self.kept
                .iter()
                .map(|&row| json::number(values.get(row).copied().unwrap_or(f64::NAN), DIGITS)),
        )
    }
}

/// All of a motion as one JSON object.
pub(super) fn motion(
    motion: &MotionReport,
    rows: &Rows,
    stage: &Stage,
    shown: usize,
    plots: &[PlotPicture],
) -> String {
    let column = |c: &super::Column| {
        json::object(&[
            ("name", json::string(&c.name)),
            ("unit", json::string(&c.unit)),
            ("v", rows.column(&c.values)),
        ])
    };
    let [width, height] = stage.size();
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
    let pictures = motion
        .plots
        .iter()
        .zip(plots)
        .map(|(spec, picture)| plot(motion, rows, spec, picture));
    json::object(&[
        ("name", json::string(&motion.name)),
        ("all", rows.all.to_string()),
        ("row", json::array(rows.kept.iter().map(usize::to_string))),
        ("time", rows.column(&motion.time)),
        ("drive", column(&motion.drive)),
        ("cols", json::array(motion.columns.iter().map(column))),
        (
            "size",
            json::array([json::decimal(width, 3), json::decimal(height, 3)]),
        ),
        ("shown", shown.to_string()),
        ("links", links(motion, rows, stage)),
        ("points", points(motion, stage)),
        (
            "anchors",
            json::array(
                stage
                    .anchors()
                    .iter()
                    .map(|a| anchor(*a, motion, stage, shown)),
            ),
        ),
        ("traces", json::array(traces)),
        ("loads", super::loads::loads(stage)),
        ("plots", json::array(pictures)),
        (
            "events",
            json::array(motion.events.iter().map(|e| event(e, rows))),
        ),
        ("gaps", json::array(gaps)),
    ])
}

/// For each link, x, y (mm on paper, y up) and angle of its first point, row after row; once for a link that stands still.
fn links(motion: &MotionReport, rows: &Rows, stage: &Stage) -> String {
    let of_link = |link: usize| {
        let pose = |row: &usize| match motion
            .frames
            .get(*row)
            .and_then(|f| stage.link_pose(f, link))
        {
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
    json::array((0..motion.view.links.len()).map(of_link))
}

fn points(motion: &MotionReport, stage: &Stage) -> String {
    let point = |index: usize| match stage.point_on_link(index) {
        Some((link, [x, y])) => {
            json::array([link.to_string(), json::decimal(x, 3), json::decimal(y, 3)])
        }
        None => "null".into(),
    };
    json::array((0..motion.view.points.len()).map(point))
}

fn anchor(anchor: Anchor, motion: &MotionReport, stage: &Stage, shown: usize) -> String {
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
            let drawn = motion
                .frames
                .get(shown)
                .and_then(|f| stage.context.place(f, anchor));
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
    let kind = match event.kind {
        MarkerKind::DeadPoint => "dead",
        MarkerKind::ChangePoint => "change",
        MarkerKind::Limit => "limit",
        MarkerKind::Event => "event",
    };
    json::object(&[
        ("row", rows.nearest(event.row).to_string()),
        ("label", json::string(&event.label)),
        ("kind", json::string(kind)),
    ])
}

fn plot(motion: &MotionReport, rows: &Rows, spec: &PlotSpec, picture: &PlotPicture) -> String {
    let scale = |s: &Scale| {
        let ends = [s.low, s.high].map(|v| json::number(v, 9));
        let places = [s.from, s.to].map(|v| json::decimal(v, 3));
        json::array(
            ends.into_iter()
                .chain(places)
                .chain([u8::from(s.log).to_string()]),
        )
    };
    // values that the page has already are named, not repeated
    let values = |values: &[f64]| -> String {
        if values.len() < rows.all || rows.all == 0 {
            return "null".into();
        }
        let values = &values[..rows.all];
        let equal = |other: &[f64]| {
            other.len() >= rows.all
                && other
                    .iter()
                    .zip(values)
                    .all(|(a, b)| a.to_bits() == b.to_bits())
        };
        if equal(&motion.drive.values) {
            return json::string("drive");
        }
        if equal(&motion.time) {
            return json::string("time");
        }
        match motion.columns.iter().position(|c| equal(&c.values)) {
            Some(index) => index.to_string(),
            None => rows.column(values),
        }
    };
    let curve = |(index, c): (usize, &Curve)| {
        let exact = c.x.len() == rows.all && c.y.len() == rows.all;
        let data = |v: &[f64]| if exact { values(v) } else { "null".into() };
        json::object(&[
            ("label", json::string(&c.label)),
            (
                "c",
                json::string(&format!(
                    "var(--{})",
                    crate::tokens::Token::Series(index).name()
                )),
            ),
            ("x", data(&c.x)),
            ("y", data(&c.y)),
        ])
    };
    json::object(&[
        ("x", scale(&picture.x)),
        ("y", scale(&picture.y)),
        ("h", json::decimal(picture.scene.height, 3)),
        ("w", json::decimal(picture.scene.width, 3)),
        (
            "curves",
            json::array(spec.curves.iter().enumerate().map(curve)),
        ),
        ("path", spec.is_plane().to_string()),
        ("vector", spec.hodograph.is_some().to_string()),
    ])
}
