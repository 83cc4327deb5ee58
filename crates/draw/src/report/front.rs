//! A front of designs in the page: its picture and its table, and what the script needs to show the one that is chosen.

use super::content::{FrontDesign, FrontReport};
use super::motion_report::{Column, MotionReport};
use super::rows::Rows;
use super::{data, json, sections};
use crate::escape::escape;
use crate::plot::PlotSpec;
use crate::stage::{DrawOptions, Stage};
use crate::svg;
use crate::view::Frame;
use kempe_number::text::significant;

/// Width and height of the picture, mm.
const PLOT: [f64; 2] = [140.0, 90.0];
/// Width and height of a mechanism, mm.
const STAGE: [f64; 2] = [110.0, 80.0];
/// Poses that the page carries of each design.
const POSES: usize = 61;
/// Significant digits of the table.
const DIGITS: usize = 6;

pub(super) struct Built {
    pub html: String,
    pub json: String,
}

/// A front with everything that is known of its designs. `motions` are those of the page.
pub(super) fn build(front: &FrontReport, index: usize, motions: &[MotionReport]) -> Built {
    let picture = PlotSpec::draw(&front.plot, PLOT[0], PLOT[1]);
    let name = escape(&front.name);
    let about = match front.about.is_empty() {
        true => String::new(),
        false => format!("<p>{}</p>", escape(&front.about)),
    };
    let html = format!(
        "<section class=\"card front\" data-front=\"{index}\"><h2>{name}: front</h2>{about}\n\
         <div class=\"bench\"><div><figure class=\"plot\">{}</figure></div>\n\
         <div class=\"chosen\" aria-live=\"polite\"></div></div>\n{}</section>\n",
        svg::element(&picture.scene, "class=\"still\""),
        table(front),
    );
    let column = |c: &Column| {
        json::object(&[
            ("name", json::string(&c.name)),
            ("unit", json::string(&c.unit)),
            (
                "v",
                json::array(c.values.iter().map(|v| json::number(*v, DIGITS))),
            ),
        ])
    };
    let own = front.own.as_ref().map_or("null".into(), |own| {
        json::array(own.iter().map(|v| json::number(*v, DIGITS)))
    });
    let designs = front.designs.iter().map(|design| {
        let tab = motions.iter().position(|m| m.name == design.motion);
        json::object(&[
            ("name", json::string(&design.name)),
            ("file", json::string(&design.file)),
            ("tab", tab.map_or("null".into(), |tab| tab.to_string())),
            ("stage", stage(design)),
        ])
    });
    Built {
        html,
        json: json::object(&[
            ("name", json::string(&front.name)),
            ("cols", json::array(front.columns.iter().map(column))),
            (
                "goals",
                json::array(front.goals.iter().map(usize::to_string)),
            ),
            ("own", own),
            ("designs", json::array(designs)),
        ]),
    }
}

/// The table, a row for each design, with its file.
fn table(front: &FrontReport) -> String {
    let mut head: Vec<String> = front.columns.iter().map(Column::head).collect();
    let filed = front.designs.iter().any(|d| !d.file.is_empty());
    let noted = front.designs.iter().any(|d| !d.note.is_empty());
    head.extend(filed.then(|| "file".to_owned()));
    head.extend(noted.then(|| "note".to_owned()));
    let row = |(k, design): (usize, &FrontDesign)| {
        let value = |c: &Column| {
            c.values
                .get(k)
                .map_or(String::new(), |v| significant(*v, DIGITS))
        };
        let mut row: Vec<String> = front.columns.iter().map(value).collect();
        row.extend(filed.then(|| design.file.clone()));
        row.extend(noted.then(|| design.note.clone()));
        row
    };
    let rows: Vec<Vec<String>> = front.designs.iter().enumerate().map(row).collect();
    sections::table(&head, &rows)
}

/// The mechanism of a design and what moves it; null where nothing of it moves.
fn stage(design: &FrontDesign) -> String {
    let Some((view, frames)) = &design.moving else {
        return "null".into();
    };
    let stride = frames.len().div_ceil(POSES).max(1);
    let last = frames.len().checked_sub(1);
    let kept = (0..frames.len()).step_by(stride);
    let kept = kept.chain(last.filter(|last| last % stride != 0));
    let frames: Vec<Frame> = kept.map(|row| frames[row].clone()).collect();
    let options = DrawOptions {
        width: STAGE[0],
        max_height: STAGE[1],
        title: false,
        caption: false,
        steady: true,
        ..DrawOptions::default()
    };
    let rows = Rows {
        all: frames.len(),
        kept: (0..frames.len()).collect(),
    };
    let stage = Stage::new(view, &frames, options);
    let mut fields = vec![
        (
            "svg",
            json::string(&svg::element(&stage.scene(0), "class=\"drawing\"")),
        ),
        ("poses", frames.len().to_string()),
    ];
    fields.extend(data::mechanism(&stage, &frames, &rows, 0));
    json::object(&fields)
}
