//! The page: template, style and script put together.

use super::{Report, Section, motion, sections};
use crate::escape::escape;
use crate::tokens;

const TEMPLATE: &str = include_str!("template.html");
const STYLE: &str = include_str!("style.css");
const SCRIPTS: [&str; 4] = [
    include_str!("loads.js"),
    include_str!("pose.js"),
    include_str!("plots.js"),
    include_str!("player.js"),
];

pub(super) fn page(report: &Report) -> String {
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
    let value = |key: &str| match key {
        "title" => escape(title),
        "file" => escape(&report.file_name),
        "generator" => escape(&report.generator),
        "light" => tokens::css(false),
        "dark" => tokens::css(true),
        "style" => STYLE.to_string(),
        "first" => first.clone(),
        "tabs" => tabs.clone(),
        "motions" => panels.clone(),
        "sections" => findings.clone(),
        "data" => format!("[{}]", data.join(",\n")),
        "script" => SCRIPTS.concat(),
        _ => String::new(),
    };
    fill(TEMPLATE, value)
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
