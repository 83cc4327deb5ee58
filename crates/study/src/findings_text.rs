//! Check reports as text for the terminal and as sections of the HTML report.

use std::fmt::Write as _;

use kempe_draw::report::{Block, Level, Section};
use kempe_model::{Diagnostic, Severity};

use crate::findings::Report;
use crate::group_text::group_text;

impl Report {
    /// Whether there is something to repair or to think about.
    pub fn has_findings(&self) -> bool {
        !self.diagnostics.is_empty()
    }

    /// Whether the mechanism cannot move as the file asks.
    pub fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|d| d.severity == Severity::Error)
    }

    /// Whether the file has a mechanism, and not only a frame on which studies find some.
    fn has_mechanism(&self) -> bool {
        self.links > 1
    }

    fn facts(&self) -> Vec<(String, String)> {
        if !self.has_mechanism() {
            return Vec::new();
        }
        let mut facts = vec![(
            "Mobility by count".to_owned(),
            format!(
                "{} = 3 ({} - 1) - 2 x {} - {}  (Chebyshev–Grübler: {} links, {} lower and {} higher pairs)",
                self.mobility_count,
                self.links,
                self.lower_pairs,
                self.higher_pairs,
                self.links,
                self.lower_pairs,
                self.higher_pairs
            ),
        )];
        let rank = match (self.mobility_rank, self.redundant) {
            (Some(rank), Some(0)) => format!("{rank}, no constraint is redundant"),
            (Some(rank), Some(n)) => format!(
                "{rank}, {n} redundant constraint{}",
                if n == 1 { "" } else { "s" }
            ),
            (Some(rank), None) => rank.to_string(),
            (None, _) => "unknown: there is no pose".to_owned(),
        };
        facts.push(("Mobility by rank".to_owned(), rank));
        facts.push(("Drives".to_owned(), or_none(&self.drives)));
        if !self.idle.is_empty() {
            facts.push(("Idle freedoms".to_owned(), self.idle.join(", ")));
        }
        if !self.redundant_joints.is_empty() {
            facts.push(("Redundant".to_owned(), self.redundant_joints.join(", ")));
        }
        facts
    }

    fn motion_facts(&self) -> Vec<(String, String)> {
        if !self.has_mechanism() {
            return Vec::new();
        }
        let others = match self.assemblies_rejected {
            0 => String::new(),
            n => format!(", {n} more on other sides"),
        };
        let complete = if self.assemblies_complete {
            "all of them found"
        } else {
            "perhaps not all of them found"
        };
        let assemblies = match self.assemblies {
            Some(count) => format!("{count} fit the file{others} ({complete})"),
            None => {
                "unknown: they are counted at a place of the drives, and one is missing".to_owned()
            }
        };
        let mut facts = vec![("Assemblies".to_owned(), assemblies)];
        facts.extend((self.chosen.iter()).map(|c| ("Chosen".to_owned(), c.clone())));
        if let Some(reach) = &self.reach {
            facts.push(("Reach".to_owned(), reach.clone()));
        }
        facts.extend(self.events.iter().map(|e| ("Met".to_owned(), e.clone())));
        facts
    }

    /// The report as plain text, without its diagnostics.
    pub fn to_text(&self) -> String {
        let mut out = format!("{}\n", self.title);
        let mut put = |heading: &str, lines: Vec<(String, String)>| {
            if lines.is_empty() {
                return;
            }
            let _ = writeln!(out, "\n{heading}");
            let width = lines
                .iter()
                .map(|(k, _)| k.chars().count())
                .max()
                .unwrap_or(0);
            for (key, value) in lines {
                let _ = writeln!(out, "  {key:width$}  {value}");
            }
        };
        let drawn = self.drawn.iter();
        let drawn = drawn.map(|d| (d.link.clone(), d.lengths.join(", ")));
        put("Drawn as", drawn.collect());
        put("Freedoms", self.facts());
        let groups = self.groups.iter().map(|g| {
            (
                g.links.join(" + "),
                group_text(g.class, &g.kind, g.closed_form),
            )
        });
        put("Assur groups, in the order of solving", groups.collect());
        let loops = self.four_bars.iter().map(|f| {
            let sides: Vec<String> = f
                .links
                .iter()
                .zip(&f.lengths)
                .map(|(l, s)| format!("{l} {s}"))
                .collect();
            (
                f.pins.join("-"),
                format!("{}: {}", f.kind, sides.join(", ")),
            )
        });
        put("Four-bar loops", loops.collect());
        put("Motion", self.motion_facts());
        let assumed = self.assumptions.iter().map(|a| match a.split_once(": ") {
            Some((key, value)) => (key.to_owned(), value.to_owned()),
            None => (a.clone(), String::new()),
        });
        put("Taken as", assumed.collect());
        out
    }

    /// The findings as sections of the HTML report.
    pub fn sections(&self) -> Vec<Section> {
        let mut sections = Vec::new();
        if !self.has_mechanism() {
            sections.push(Section {
                title: "Taken as".to_owned(),
                blocks: vec![Block::List(self.assumptions.clone())],
            });
            return sections;
        }
        sections.push(Section {
            title: "Freedoms".to_owned(),
            blocks: vec![Block::Facts(self.facts())],
        });
        if !self.drawn.is_empty() {
            let facts = self.drawn.iter();
            let facts = facts.map(|d| (d.link.clone(), d.lengths.join(", ")));
            sections.push(Section {
                title: "Drawn as".to_owned(),
                blocks: vec![Block::Facts(facts.collect())],
            });
        }
        if !self.groups.is_empty() {
            let rows = self.groups.iter().map(|g| {
                let by = if g.closed_form {
                    "closed form"
                } else {
                    "Newton's method"
                };
                vec![
                    g.links.join(", "),
                    g.kind.clone(),
                    g.class.to_string(),
                    by.to_owned(),
                ]
            });
            sections.push(Section {
                title: "Assur groups".to_owned(),
                blocks: vec![Block::Table {
                    head: ["Links", "Kind", "Class", "Solved by"]
                        .map(String::from)
                        .to_vec(),
                    rows: rows.collect(),
                }],
            });
        }
        if !self.four_bars.is_empty() {
            let rows = self.four_bars.iter().map(|f| {
                let sides: Vec<String> = f
                    .links
                    .iter()
                    .zip(&f.lengths)
                    .map(|(l, s)| format!("{l} {s}"))
                    .collect();
                vec![f.pins.join("-"), sides.join(", "), f.kind.clone()]
            });
            sections.push(Section {
                title: "Four-bar loops".to_owned(),
                blocks: vec![Block::Table {
                    head: ["Pins", "Lengths", "Type"].map(String::from).to_vec(),
                    rows: rows.collect(),
                }],
            });
        }
        sections.push(Section {
            title: "Motion".to_owned(),
            blocks: vec![
                Block::Facts(self.motion_facts()),
                Block::List(self.assumptions.clone()),
            ],
        });
        sections
    }
}

/// Diagnostics as a section of the HTML report; nothing when there are none.
pub(crate) fn warnings_section(diagnostics: &[Diagnostic]) -> Option<Section> {
    let finding = |d: &Diagnostic| Block::Finding {
        level: match d.severity {
            Severity::Warning => Level::Warning,
            _ => Level::Error,
        },
        code: d.code.to_owned(),
        message: std::iter::once(d.message.as_str())
            .chain(d.notes.iter().map(String::as_str))
            .collect::<Vec<_>>()
            .join("; "),
        help: d.help.clone().unwrap_or_default(),
    };
    (!diagnostics.is_empty()).then(|| Section {
        title: "Warnings".to_owned(),
        blocks: diagnostics.iter().map(finding).collect(),
    })
}

fn or_none(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}
