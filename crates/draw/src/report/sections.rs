//! Chapters of findings, and they and the evidence as HTML.

use super::evidence::{Check, Evidence, NotReached};
use super::motion_report::{Event, MotionReport};
use crate::escape::escape;
use crate::scene::Scene;
use crate::svg;
use kempe_number::text::significant;

/// Most rows of a table that are written out.
const MOST_TABLE_ROWS: usize = 500;

/// A table of more columns takes the whole width of the page.
const WIDE: usize = 6;

/// Characters of a value that stays on one line.
const SHORT: usize = 24;

/// A chapter of findings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// What it holds, in order.
    pub blocks: Vec<Block>,
}

/// How serious a finding is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Level {
    /// Good to know.
    #[default]
    Note,
    /// A careful engineer would want to be told.
    Warning,
    /// Something failed.
    Error,
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Paragraph(String),
    /// A list.
    List(Vec<String>),
    /// Names with values.
    Facts(Vec<(String, String)>),
    /// A table.
    Table {
        /// Heads of the columns.
        head: Vec<String>,
        /// Rows of cells.
        rows: Vec<Vec<String>>,
    },
    /// Pictures side by side, each with what stands under it.
    Pictures(Vec<(String, Scene)>),
    /// A picture of its own, as wide as is good to read.
    Picture(Scene),
    /// A warning or an error.
    Finding {
        /// How serious.
        level: Level,
        /// Stable code.
        code: String,
        /// What was found.
        message: String,
        /// What to do about it; may be empty.
        help: String,
    },
}

/// A section with its heading.
pub(super) fn section(section: &Section, id: &str) -> String {
    let blocks: String = section.blocks.iter().map(block).collect();
    let is_wide = |block: &Block| match block {
        Block::Table { head, .. } => head.len() > WIDE,
        Block::Pictures(_) | Block::Picture(_) => true,
        _ => false,
    };
    let wide = match section.blocks.iter().any(is_wide) {
        true => " wide",
        false => "",
    };
    format!(
        "<section class=\"card{wide}\" id=\"{id}\"><h2>{}</h2>{blocks}</section>\n",
        escape(&section.title)
    )
}

fn block(block: &Block) -> String {
    match block {
        Block::Paragraph(text) => format!("<p>{}</p>", escape(text)),
        Block::List(items) => {
            format!(
                "<ul>{}</ul>",
                items
                    .iter()
                    .map(|i| format!("<li>{}</li>", escape(i)))
                    .collect::<String>()
            )
        }
        Block::Facts(facts) => self::facts(facts),
        Block::Table { head, rows } => table(head, rows),
        Block::Pictures(pictures) => {
            let picture = |(title, scene): &(String, Scene)| {
                let scene = svg::element(scene, "class=\"small\"");
                let title = escape(title);
                format!("<figure>{scene}<figcaption>{title}</figcaption></figure>")
            };
            let pictures: String = pictures.iter().map(picture).collect();
            format!("<div class=\"pictures\">{pictures}</div>")
        }
        Block::Picture(scene) => svg::element(scene, "class=\"own\""),
        Block::Finding {
            level,
            code,
            message,
            help,
        } => {
            let (class, word) = match level {
                Level::Note => ("note", "Note"),
                Level::Warning => ("warning", "Warning"),
                Level::Error => ("error", "Error"),
            };
            let code = if code.is_empty() {
                String::new()
            } else {
                format!(" <code>{}</code>", escape(code))
            };
            let help = if help.is_empty() {
                String::new()
            } else {
                format!("<p>{}</p>", escape(help))
            };
            format!(
                "<div class=\"finding {class}\"><p><strong>{word}</strong>{code} {}</p>{help}</div>",
                escape(message)
            )
        }
    }
}

fn facts(facts: &[(String, String)]) -> String {
    let fact = |(name, value): &(String, String)| {
        format!(
            "<div><dt>{}</dt><dd>{}</dd></div>",
            escape(name),
            escape(value)
        )
    };
    format!(
        "<dl class=\"facts\">{}</dl>",
        facts.iter().map(fact).collect::<String>()
    )
}

pub(super) fn table(head: &[String], rows: &[Vec<String>]) -> String {
    // A head stands above its numbers.
    let numbers = |column: usize| {
        let mut cells = (rows.iter()).filter_map(|r| r.get(column).filter(|c| !c.is_empty()));
        let first = cells.next();
        (first.into_iter().chain(cells)).all(|c| c.parse::<f64>().is_ok()) && first.is_some()
    };
    let heads: String = (head.iter().enumerate())
        .map(|(column, h)| match numbers(column) {
            true => format!("<th scope=\"col\" class=\"number\">{}</th>", escape(h)),
            false => format!("<th scope=\"col\">{}</th>", escape(h)),
        })
        .collect();
    let cell = |c: &String| {
        let starts_with_number = || {
            let first = c.split(' ').next();
            first.is_some_and(|word| word.parse::<f64>().is_ok())
        };
        let class = if c.parse::<f64>().is_ok() {
            " class=\"number\""
        } else if c.chars().count() <= SHORT && starts_with_number() {
            // a comparison breaks at the sign of an exponent otherwise
            " class=\"whole\""
        } else {
            ""
        };
        format!("<td{class}>{}</td>", escape(c))
    };
    let row = |r: &Vec<String>| format!("<tr>{}</tr>", r.iter().map(cell).collect::<String>());
    let body: String = rows.iter().take(MOST_TABLE_ROWS).map(row).collect();
    let more = rows.len().saturating_sub(MOST_TABLE_ROWS);
    let rest = if more > 0 {
        format!("<p class=\"muted\">{more} more rows are not shown</p>")
    } else {
        String::new()
    };
    let table = format!("<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>");
    format!("<div class=\"scroll\" tabindex=\"0\">{table}</div>{rest}")
}

/// Closure, distance from singular poses, and the caller's checks in one table.
fn checks(evidence: &Evidence) -> String {
    let mut all = Vec::new();
    if let Some((residual, limit)) = evidence.residual {
        let sign = if residual <= limit { "≤" } else { "> limit" };
        let worst = format!(
            "{} {sign} {}",
            significant(residual, 3),
            significant(limit, 3)
        );
        let meaning = "the loops close, relative to the mechanism's size";
        all.push(Check::new("Largest closure residual", worst, "", meaning));
    }
    if let Some(value) = evidence.singular_value {
        let name = "Smallest singular value of the constraint Jacobian";
        let meaning = "distance from a singular pose; 0 at one";
        all.push(Check::new(name, significant(value, 4), "", meaning));
    }
    all.extend(evidence.checks.iter().cloned());
    if all.is_empty() {
        return String::new();
    }
    let placed = all.iter().any(|c| !c.place.is_empty());
    let mut head = vec!["Check", "Worst value", "Where", "Meaning"];
    let row = |c: &Check| {
        let cells = [&c.name, &c.worst, &c.place, &c.meaning];
        cells.map(String::clone).to_vec()
    };
    let mut rows: Vec<Vec<String>> = all.iter().map(row).collect();
    if !placed {
        head.remove(2);
        rows.iter_mut().for_each(|row| drop(row.remove(2)));
    }
    let head: Vec<String> = head.into_iter().map(String::from).collect();
    table(&head, &rows)
}

/// The evidence of a motion.
pub(super) fn evidence(motion: &MotionReport, rows: usize) -> String {
    let evidence = &motion.evidence;
    let missing: usize = evidence
        .not_reached
        .iter()
        .map(|g| (g.last + 1).saturating_sub(g.first))
        .sum();
    let mut known = vec![(
        "Rows".to_string(),
        format!("{rows}, of which {} reached", rows.saturating_sub(missing)),
    )];
    if !evidence.scaling.is_empty() {
        known.push(("Scaling of the Jacobian".into(), evidence.scaling.clone()));
    }
    known.extend(evidence.facts.iter().cloned());
    let mut out = facts(&known);
    out.push_str(&checks(evidence));
    if evidence
        .residual
        .is_some_and(|(residual, limit)| residual > limit || residual.is_nan())
    {
        out.push_str(&block(&Block::Finding {
            level: Level::Error,
            code: String::new(),
            message: "The loops do not close within the limit.".into(),
            help: String::new(),
        }));
    }
    if !motion.events.is_empty() {
        let head = ["Event", "Where", "Row"].map(String::from);
        let row = |e: &Event| vec![e.label.clone(), e.place.clone(), (e.row + 1).to_string()];
        let rows: Vec<_> = motion.events.iter().map(row).collect();
        out.push_str(&format!(
            "<h4>Dead points, change points and limits</h4>{}",
            table(&head, &rows)
        ));
    }
    if !evidence.not_reached.is_empty() {
        let head = ["Rows", "Reason"].map(String::from);
        let span = |g: &NotReached| match (g.first + 1, g.last + 1) {
            (a, b) if a == b => a.to_string(),
            (a, b) => format!("{a} to {b}"),
        };
        let rows: Vec<_> = evidence
            .not_reached
            .iter()
            .map(|g| vec![span(g), g.reason.clone()])
            .collect();
        out.push_str(&format!("<h4>Rows not reached</h4>{}", table(&head, &rows)));
    }
    out
}
