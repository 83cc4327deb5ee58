//! The page: template, style and script put together.

use std::ops::ControlFlow;

use super::content::Report;
use super::sections::Section;
use super::{front, motion, sections};
use crate::escape::escape;
use crate::tokens;

const TEMPLATE: &str = include_str!("template.html");
const STYLE: &str = include_str!("style.css");
/// In the order in which each needs those before it.
const SCRIPTS: [&str; 18] = [
    include_str!("script/numbers.js"),
    include_str!("script/elements.js"),
    include_str!("script/arrows.js"),
    include_str!("script/contacts.js"),
    include_str!("script/pose.js"),
    include_str!("script/loads.js"),
    include_str!("script/vectors.js"),
    include_str!("script/axes.js"),
    include_str!("script/chart.js"),
    include_str!("script/limits.js"),
    include_str!("script/hodograph.js"),
    include_str!("script/save.js"),
    include_str!("script/plots.js"),
    include_str!("script/enlarge.js"),
    include_str!("script/choose.js"),
    include_str!("script/pace.js"),
    include_str!("script/player.js"),
    include_str!("script/front.js"),
];

impl Report {
    /// The whole report as HTML text. All texts are escaped; the same report gives the same bytes.
    pub fn to_html(&self) -> String {
        page(self, &mut |_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// As [`to_html`](Self::to_html); `drawn` hears how many of its [`parts`](Self::parts) are drawn, and may stop it: then there is
    /// no page.
    pub fn to_html_with(&self, drawn: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Option<String> {
        page(self, drawn)
    }

    /// How many parts are drawn one after the other: motions and fronts.
    pub fn parts(&self) -> usize {
        self.motions.len() + self.fronts.len()
    }
}

/// The page; none where `drawn`, which hears how many parts are, stops it.
fn page(report: &Report, drawn: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Option<String> {
    let mut tabs = String::new();
    let mut panels = String::new();
    let mut data = Vec::new();
    for (index, study) in report.motions.iter().enumerate() {
        let first = index == 0;
        tabs.push_str(&format!(
            "<button role=\"tab\" id=\"tab-{index}\" aria-controls=\"motion-{index}\" aria-selected=\"{first}\"{}>{}</button>",
            if first { "" } else { " tabindex=\"-1\"" },
            escape(&study.name)
        ));
        let built = motion::build(study, index);
        panels.push_str(&built.html);
        data.push(built.json);
        if drawn(data.len()).is_break() {
            return None;
        }
    }
    let (mut fronts, mut front_data) = (Vec::new(), Vec::new());
    for (index, front) in report.fronts.iter().enumerate() {
        let built = front::build(front, index, &report.motions);
        fronts.push(built.html);
        front_data.push(built.json);
        if drawn(data.len() + fronts.len()).is_break() {
            return None;
        }
    }
    if report.motions.len() < 2 {
        tabs.clear();
    } else {
        tabs = format!("<div class=\"tabs\" role=\"tablist\" aria-label=\"Studies\">{tabs}</div>");
    }
    let written = |list: &[Section], name: &str| -> String {
        let numbered = list.iter().enumerate();
        let one = |(i, s)| sections::section(s, &format!("{name}-{i}"));
        numbered.map(one).collect()
    };
    let first = match report.first.as_slice() {
        [] => String::new(),
        list => format!("<div class=\"sections\">\n{}</div>", written(list, "first")),
    };
    let findings = written(&report.sections, "section");
    let title = if report.title.is_empty() {
        &report.file_name
    } else {
        &report.title
    };
    let generator = match report.date.as_str() {
        "" => report.generator.clone(),
        date => format!("{}, {date}", report.generator),
    };
    let value = |key: &str| match key {
        "title" => escape(title),
        "file" => escape(&report.file_name),
        "source" => source(report),
        "generator" => escape(&generator),
        "light" => tokens::css(false),
        "dark" => tokens::css(true),
        "style" => STYLE.to_string(),
        "first" => first.clone(),
        "tabs" => tabs.clone(),
        "fronts" => fronts.concat(),
        "front_data" => format!("[{}]", front_data.join(",\n")),
        "motions" => panels.clone(),
        "sections" => findings.clone(),
        "data" => format!("[{}]", data.join(",\n")),
        "other_key" => match report.motions.iter().any(|m| m.against.is_some()) {
            true => ", <kbd>O</kbd> other design".to_owned(),
            false => String::new(),
        },
        "script" => SCRIPTS.concat(),
        _ => String::new(),
    };
    Some(fill(TEMPLATE, value))
}

/// The text of the model and of the other one, closed.
fn source(report: &Report) -> String {
    let file = |what: &str, name: &str, text: &str| match text {
        "" => String::new(),
        text => format!(
            "<details class=\"card source\"><summary>{what}: {}</summary><pre tabindex=\"0\">{}</pre></details>\n",
            escape(name),
            escape(text)
        ),
    };
    let mut out = file("The model", &report.file_name, &report.source);
    if let Some((name, text)) = &report.other_source {
        out.push_str(&file("The other model", name, text));
    }
    out
}

/// Puts values in place of `{{key}}`, once: what a value holds is not looked at again.
fn fill(template: &str, value: impl Fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        out.push_str(before);
        let Some((key, tail)) = after.split_once("}}") else {
            break;
        };
        out.push_str(&value(key));
        rest = tail;
    }
    out.push_str(rest);
    out
}
