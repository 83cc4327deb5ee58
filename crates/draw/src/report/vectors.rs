//! Velocities and accelerations of the points behind a motion's page: what the script needs to draw and to tell them.

use kempe_number::math::hypot;
use kempe_number::text::significant;

use super::motion_report::{MotionReport, PointVectors, VectorKind};
use super::rows::Rows;
use super::{base64, json};
use crate::escape::escape;
use crate::loads::Quantity;
use crate::stage::Stage;
use crate::tokens::Token;

/// A point whose largest vector is below this part of the largest of all stands still: it is what rounding left of none.
const STILL: f64 = 1e-9;
/// What is larger than so many times the usual is drawn broken: near a dead point velocities grow without bound.
const FAR: f64 = 3.0;
/// Longest arrow as a part of the sheet's smaller side.
const LONGEST: f64 = 0.25;
/// The arrows are not made shorter than this to keep them on the sheet, mm.
const LEAST_LONGEST: f64 = 12.0;
/// From the points to the edge of the sheet there is at least so much room, mm.
const ROOM: f64 = 9.0;

impl VectorKind {
    /// A stable name for switches, colours and keys.
    fn name(self) -> &'static str {
        match self {
            VectorKind::Velocity => "velocity",
            VectorKind::Acceleration => "acceleration",
        }
    }

    fn title(self) -> &'static str {
        match self {
            VectorKind::Velocity => "Velocity",
            VectorKind::Acceleration => "Acceleration",
        }
    }
}

impl PointVectors {
    /// The scale for the kept rows, in the unit; `None` where nothing moves.
    fn scale(&self, rows: &Rows) -> Option<Quantity> {
        let sizes = |row: &usize| {
            let of_row = self.rows.get(*row).map_or(&[][..], Vec::as_slice);
            of_row.iter().map(|v| self.size(v)).collect::<Vec<f64>>()
        };
        Quantity::within(rows.kept.iter().map(sizes), 0.0, FAR)
    }

    fn size(&self, [x, y]: &[f64; 2]) -> f64 {
        hypot(*x, *y) / self.unit.size()
    }

    fn at(&self, row: usize, point: usize) -> [f64; 2] {
        let found = self.rows.get(row).and_then(|r| r.get(point));
        let [x, y] = found.copied().unwrap_or([f64::NAN; 2]);
        [x / self.unit.size(), y / self.unit.size()]
    }

    /// The points that move, but for those that only give a curve its shape.
    fn moving(&self, rows: &Rows, scale: &Quantity, stage: &Stage) -> Vec<usize> {
        let points = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let moves = |point: &usize| {
            let mut sizes = rows.kept.iter().map(|row| {
                let [x, y] = self.at(*row, *point);
                hypot(x, y)
            });
            sizes.any(|size| size.is_finite() && size > STILL * scale.largest)
        };
        let shown = |point: &usize| !stage.context.roles.point(*point).only_shapes();
        (0..points).filter(shown).filter(moves).collect()
    }
}

/// All vectors of a motion as a JSON array.
pub(super) fn vectors(motion: &MotionReport, rows: &Rows, stage: &Stage) -> String {
    let one = |it: &PointVectors| Some(vector(it, rows, stage, &it.scale(rows)?));
    json::array(motion.vectors.iter().filter_map(one))
}

fn vector(it: &PointVectors, rows: &Rows, stage: &Stage, scale: &Quantity) -> String {
    let points = it.moving(rows, scale, stage);
    let track = |point: &usize| {
        let mut bytes = Vec::with_capacity(8 * rows.kept.len());
        for row in &rows.kept {
            for v in it.at(*row, *point) {
                bytes.extend((v as f32).to_le_bytes());
            }
        }
        json::object(&[
            ("p", point.to_string()),
            ("v", json::string(&base64::encoded(&bytes))),
        ])
    };
    json::object(&[
        ("kind", json::string(it.kind.name())),
        ("unit", json::string(&it.unit.name)),
        (
            "c",
            json::string(&format!("var(--{})", token(it.kind).name())),
        ),
        ("full", json::number(scale.full, 9)),
        ("mm", json::decimal(longest(it, rows, stage, scale), 3)),
        ("tracks", json::array(points.iter().map(track))),
    ])
}

fn token(kind: VectorKind) -> Token {
    match kind {
        VectorKind::Velocity => Token::Velocity,
        VectorKind::Acceleration => Token::Acceleration,
    }
}

/// The length of the longest arrow, mm: such that all stay on the sheet, where that does not make them too short.
fn longest(it: &PointVectors, rows: &Rows, stage: &Stage, scale: &Quantity) -> f64 {
    let [width, height] = stage.size();
    let mut long = LONGEST * width.min(height);
    for (frame, row) in stage.context.frames.iter().zip(&rows.kept) {
        for point in 0..frame.points.len() {
            let Some(at) = stage.context.paper(frame, point) else {
                continue;
            };
            let v = it.at(*row, point);
            let size = hypot(v[0], v[1]);
            let Some((share, _)) = scale.share(size).filter(|(share, _)| *share > 0.0) else {
                continue;
            };
            for (at, v, side) in [(at[0], v[0], width), (at[1], v[1], height)] {
                let room = if v > 0.0 { side - at } else { at };
                let along = share * v.abs() / size;
                if along > 0.0 {
                    long = long.min(room.max(ROOM) / along);
                }
            }
        }
    }
    long.max(LEAST_LONGEST)
}

/// A switch for each kind of vector that occurs; off until somebody asks.
pub(super) fn switches(motion: &MotionReport, rows: &Rows) -> String {
    let switch = |it: &PointVectors| {
        let scale = it.scale(rows)?;
        let outside = if scale.capped() {
            ", larger ones broken"
        } else {
            ""
        };
        Some(format!(
            "<label title=\"Longest arrow: {} {}{outside}\"><input type=\"checkbox\" data-vector=\"{}\"> {} <span class=\"muted\">({}, up to {} {})</span></label>\n",
            significant(scale.full, 3),
            escape(&it.unit.name),
            it.kind.name(),
            it.kind.title(),
            escape(&it.per),
            significant(scale.largest, 3),
            escape(&it.unit.name),
        ))
    };
    let all: String = motion.vectors.iter().filter_map(switch).collect();
    match all.is_empty() {
        true => all,
        false => {
            format!("<fieldset class=\"row roles\"><legend>Points</legend>\n{all}</fieldset>\n")
        }
    }
}
