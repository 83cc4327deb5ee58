//! A motion's part of the page: stage, controls, read-out, plots, evidence.

use super::happenings::Along;
use super::motion_report::{Column, Event, MotionReport};
use super::rows::Rows;
use super::{data, loads, sections, vectors};
use crate::context::complete;
use crate::escape::escape;
use crate::ghost::Outline;
use crate::plot::PlotPicture;
use crate::stage::{DrawOptions, Stage};
use crate::svg;
use kempe_number::text::significant;

/// Width of the stage and size of a plot, mm; the page scales them. The stage is small, so that its texts are large.
const STAGE: [f64; 2] = [150.0, 132.0];
const PLOT: [f64; 2] = [104.0, 66.0];
/// Height of a plot with equal axes, mm.
const PATH_PLOT_HEIGHT: f64 = 84.0;

pub(super) struct Built {
    pub html: String,
    pub json: String,
}

pub(super) fn build(motion: &MotionReport, index: usize) -> Built {
    let rows = Rows::of(motion);
    // the stage knows only the poses that the page carries
    let frames: Vec<_> = rows
        .kept
        .iter()
        .filter_map(|&row| motion.frames.get(row).cloned())
        .collect();
    let options = DrawOptions {
        width: STAGE[0],
        max_height: STAGE[1],
        title: false,
        caption: false,
        steady: true,
        ..DrawOptions::default()
    };
    let others: Vec<_> = (motion.against.iter())
        .flat_map(|other| {
            let frame = |row: &usize| other.frames.get(*row).cloned().unwrap_or_default();
            rows.kept.iter().map(frame)
        })
        .collect();
    let outline = motion.against.as_ref().map(|other| Outline {
        name: &other.name,
        view: &other.view,
        frames: &others,
    });
    let stage = Stage::with_outline(&motion.view, &frames, outline, options);
    let whole = |row: &usize| (frames.get(*row)).is_some_and(|f| complete(&motion.view, f));
    let both = |row: &usize| {
        let other = outline.zip(others.get(*row));
        whole(row) && other.is_none_or(|(o, f)| complete(o.view, f))
    };
    let all = 0..frames.len();
    let shown = (all.clone().find(both).or_else(|| all.clone().find(whole))).unwrap_or(0);
    let shown_row = rows.kept.get(shown).copied().unwrap_or(0);
    let pictures: Vec<PlotPicture> = motion
        .plots
        .iter()
        .map(|plot| {
            plot.draw(
                PLOT[0],
                if plot.is_plane() {
                    PATH_PLOT_HEIGHT
                } else {
                    PLOT[1]
                },
            )
        })
        .collect();
    let plots: String = pictures
        .iter()
        .enumerate()
        .map(|(number, picture)| plot_figure(picture, number))
        .collect();
    let summary = if motion.summary.is_empty() {
        String::new()
    } else {
        format!("<p>{}</p>", escape(&motion.summary))
    };
    let happenings = Along::of(motion, &rows);
    let html = format!(
        "<section class=\"motion\" id=\"motion-{index}\" role=\"tabpanel\" aria-label=\"{name}\" data-motion=\"{index}\">\n\
         <h2>{name}</h2>{summary}\n<div class=\"bench\">\n<div class=\"left\">\n<figure class=\"card stage\">\n{drawing}\
         {against}<figcaption class=\"status\" aria-live=\"polite\"></figcaption>\n{controls}</figure>\n{readout}</div>\n\
         <div class=\"plots\">{plots}</div>\n</div>\n\
         <div class=\"card evidence\"><h3>Evidence</h3>{evidence}</div>\n</section>\n",
        name = escape(&motion.name),
        against = against_line(motion),
        drawing = svg::element(&stage.scene(shown), "class=\"drawing\""),
        controls = controls(
            motion,
            &rows,
            &happenings,
            &[loads::switches(&stage), vectors::switches(motion, &rows)].concat()
        ),
        readout = readout(motion, &rows, shown_row),
        evidence = sections::evidence(motion, rows.all),
    );
    Built {
        html,
        json: data::motion(motion, &rows, &stage, shown_row, &happenings),
    }
}

/// What the dashed outline is.
fn against_line(motion: &MotionReport) -> String {
    let Some(other) = &motion.against else {
        return String::new();
    };
    format!(
        "<p class=\"against\"><svg viewBox=\"0 0 28 8\" aria-hidden=\"true\"><path d=\"M1 4h26\"/></svg> \
         Dashed: {} <span class=\"muted\">({})</span></p>\n",
        escape(&other.name),
        escape(&other.matched)
    )
}

/// A plot as it stands before the script draws it for the width it has.
fn plot_figure(picture: &PlotPicture, number: usize) -> String {
    format!(
        "<figure class=\"card plot\" data-plot=\"{number}\">{}</figure>\n",
        svg::element(&picture.scene, "class=\"still\"")
    )
}

/// A button with an icon drawn in a 16 x 16 box.
fn button(action: &str, label: &str, icon: &str) -> String {
    format!(
        "<button type=\"button\" data-do=\"{action}\" aria-label=\"{label}\" title=\"{label}\">\
         <svg viewBox=\"0 0 16 16\" aria-hidden=\"true\"><path d=\"{icon}\"/></svg></button>"
    )
}

fn controls(motion: &MotionReport, rows: &Rows, happenings: &Along<'_>, roles: &str) -> String {
    let last = rows.kept.len().saturating_sub(1);
    let mark = |event: &Event| {
        let share = if last > 0 {
            rows.nearest(event.row) as f64 / last as f64
        } else {
            0.0
        };
        format!(
            "<i style=\"left:{}%\" title=\"{}\"></i>",
            significant(100.0 * share, 5),
            escape(&event.label)
        )
    };
    let (happened, legend) = happenings.marks();
    let marks: String = motion.events.iter().take(200).map(mark).collect();
    let marks = happened + &marks;
    let legend = match legend.is_empty() {
        true => legend,
        false => format!("<p class=\"muted happened\">{}</p>\n", legend.trim_end()),
    };
    let number = |input: &str, column: Option<&Column>| {
        let Some(column) = column else {
            return String::new();
        };
        format!(
            "<label>{} <input type=\"number\" step=\"any\" data-in=\"{input}\"> {}</label>\n",
            escape(&column.name),
            escape(&column.unit)
        )
    };
    let clock = motion.columns.first().filter(|_| motion.drive != 0);
    format!(
        "<div class=\"controls\" role=\"group\" aria-label=\"Playback\">\n<div class=\"scrub\"><div class=\"marks\" aria-hidden=\"true\">{marks}</div>\
         <input type=\"range\" min=\"0\" max=\"{last}\" value=\"0\" step=\"1\" data-in=\"row\" aria-label=\"Position in the motion\"></div>\n{legend}\
         <div class=\"row\"><span class=\"buttons\">{}{}{}{}{}</span>\n{}{}</div>\n\
         <div class=\"row\"><label>Speed <select data-in=\"speed\"><option value=\"0.1\">0.1×</option><option value=\"0.25\">0.25×</option>\
         <option value=\"0.5\">0.5×</option><option value=\"1\" selected>1×</option><option value=\"2\">2×</option>\
         <option value=\"4\">4×</option></select></label>\n\
         <label>At the end <select data-in=\"mode\"><option value=\"loop\">start again</option><option value=\"pingpong\">go back</option>\
         <option value=\"once\">stop</option></select></label>\n\
         <label><input type=\"checkbox\" data-in=\"labels\" checked> Labels</label>\n\
         <label><input type=\"checkbox\" data-in=\"traces\" checked> Traces</label>{other}</div>\n{roles}\
         <p class=\"muted rate\"></p></div>\n",
        button("first", "To the start", "M3 3h2v10H3zM13 3v10L6 8z"),
        button("back", "One step back", "M11 3v10L4 8z"),
        button("play", "Play or pause", "M4 2.5v11L13 8z"),
        button("on", "One step on", "M5 3v10l7-5z"),
        button("last", "To the end", "M11 3h2v10h-2zM3 3v10l7-5z"),
        number("drive", motion.drive()),
        number("time", clock),
        other = match &motion.against {
            Some(_) =>
                "\n<label><input type=\"checkbox\" data-in=\"other\" checked> Other design</label>",
            None => "",
        },
    )
}

fn readout(motion: &MotionReport, rows: &Rows, row: usize) -> String {
    let value = |values: &[f64]| significant(values.get(row).copied().unwrap_or(f64::NAN), 6);
    let other = |index: usize| match &motion.against {
        Some(other) => {
            let values = other.values.get(index).and_then(Option::as_deref);
            let text = values.map_or_else(String::new, value);
            format!("<td class=\"number\" data-other>{text}</td>")
        }
        None => String::new(),
    };
    let line = |(index, column): (usize, &Column)| {
        format!(
            "<tr data-column=\"{index}\"><th scope=\"row\">{}</th><td class=\"number\">{}</td>{}<td>{}</td></tr>",
            escape(&column.name),
            value(&column.values),
            other(index),
            escape(&column.unit)
        )
    };
    let (here, there) = match motion.against {
        Some(_) => ("This", "<th scope=\"col\" class=\"number\">Against</th>"),
        None => ("Value", ""),
    };
    let columns = motion.columns.iter().chain(&motion.more);
    let lines: String = columns.enumerate().map(line).collect();
    let some = match rows.kept.len() < rows.all {
        true => format!(
            " <span class=\"muted\">This page has {} of {} rows; {}.csv of the run has all.</span>",
            rows.kept.len(),
            rows.all,
            escape(&motion.name)
        ),
        false => String::new(),
    };
    format!(
        "<div class=\"card readout\"><table><caption>Values at this row</caption><thead><tr><th scope=\"col\">Measure</th>\
         <th scope=\"col\" class=\"number\">{here}</th>{there}<th scope=\"col\">Unit</th></tr></thead><tbody>{lines}</tbody></table>\
         <div class=\"moving\" hidden></div>\n\
         <p class=\"tools\"><button type=\"button\" data-do=\"csv\">Save the table as CSV</button>{some}</p></div>\n"
    )
}
