//! The small phrases of the language: `A -> B`, `left of A -> B`.

use kempe_units::nearest;

use crate::diagnostic::Diagnostic;
use crate::ids::{Line, LinkId, PointId, Span};
use crate::link::Side;
use crate::node::Text;
use crate::read::context::Context;
use crate::read::names::is_point_name;

/// A directed line with the places of its points in the file.
#[derive(Clone, Debug)]
pub(crate) struct LinePhrase {
    pub from: PointId,
    pub to: PointId,
    pub span: Span,
}

/// A word of a text with its place in the content.
struct Word<'t> {
    text: &'t str,
    span: Span,
}

impl<'t> Word<'t> {
    fn trimmed(content: &'t str, span: Span) -> Self {
        let raw = content.get(span.clone()).unwrap_or("");
        let start = span.start + (raw.len() - raw.trim_start().len());
        let text = raw.trim();
        Self {
            text,
            span: start..start + text.len(),
        }
    }
}

impl Context<'_> {
    /// A directed line `A -> B`.
    pub fn line_phrase(&mut self, text: &Text) -> Option<LinePhrase> {
        self.line_in(text, 0..text.content.len())
    }

    /// A directed line and the link that carries it; where several do, not `not` if it can be helped.
    pub fn line(&mut self, text: &Text, not: Option<LinkId>) -> Option<Line> {
        let phrase = self.line_phrase(text)?;
        let link = self.common_link(phrase.from, phrase.to, not, phrase.span)?;
        Some(Line {
            link,
            from: phrase.from,
            to: phrase.to,
        })
    }

    /// A side of a directed line: `left of A -> B`.
    pub fn side_phrase(&mut self, text: &Text) -> Option<(Side, LinePhrase)> {
        let content = text.content.as_str();
        let (side, rest) = match content.split_once(" of ") {
            Some((side, rest)) => (side.trim(), content.len() - rest.len()),
            None => ("", 0),
        };
        let side = match side {
            "left" => Side::Left,
            "right" => Side::Right,
            other => {
                let mut d = Diagnostic::error("bad-side", "a side of a line expected")
                    .at(text.span(0..content.len()), "")
                    .help("write \"left of A -> B\" or \"right of A -> B\": the side of somebody walking from A to B");
                if let Some(near) = nearest(other, ["left", "right"]) {
                    d = d.note(format!("`{other}` should perhaps be `{near}`"));
                }
                self.push(d);
                return None;
            }
        };
        Some((side, self.line_in(text, rest..content.len())?))
    }

    fn line_in(&mut self, text: &Text, span: Span) -> Option<LinePhrase> {
        let content = text.content.as_str();
        let part = content.get(span.clone()).unwrap_or("");
        let Some(arrow) = part.find("->").map(|i| span.start + i) else {
            let mut d = Diagnostic::error("bad-line", "a directed line expected")
                .at(text.span(span.clone()), "no `->` here")
                .help("write \"A -> B\": the line from point A to point B");
            if let Some((a, b)) = part.split_once('-') {
                d = d.note(format!(
                    "a pair `A-B` is a distance; a line has a direction: `{} -> {}`",
                    a.trim(),
                    b.trim()
                ));
            }
            self.push(d);
            return None;
        };
        let from = Word::trimmed(content, span.start..arrow);
        let to = Word::trimmed(content, arrow + 2..span.end);
        let from_point = self.point_word(text, &from);
        let to_point = self.point_word(text, &to);
        let phrase = LinePhrase {
            from: from_point?,
            to: to_point?,
            span: text.span(from.span.start..to.span.end),
        };
        if phrase.from == phrase.to {
            self.push(
                Diagnostic::error("bad-line", "a line from a point to itself")
                    .at(phrase.span, "has no direction")
                    .help("name two points"),
            );
            return None;
        }
        Some(phrase)
    }

    /// A point by its name.
    fn point_word(&mut self, text: &Text, word: &Word<'_>) -> Option<PointId> {
        let span = text.span(word.span.clone());
        if !is_point_name(word.text) {
            self.push(
                Diagnostic::error("bad-line", "a point expected")
                    .at(
                        span,
                        if word.text.is_empty() {
                            "nothing here"
                        } else {
                            "not the name of a point"
                        },
                    )
                    .help("points start with a capital letter: A, B1, Hook"),
            );
            return None;
        }
        self.point(word.text, span)
    }

    /// A string that is nothing but a point's name.
    pub fn point_text(&mut self, text: &Text) -> Option<PointId> {
        let word = Word::trimmed(&text.content, 0..text.content.len());
        self.point_word(text, &word)
    }

    /// A pair `A-B` of two points.
    pub fn pair_phrase(&mut self, text: &Text) -> Option<(PointId, PointId)> {
        let content = text.content.as_str();
        let Some(dash) = content.find('-').filter(|_| !content.contains("->")) else {
            self.push(
                Diagnostic::error("bad-line", "a pair of points expected")
                    .at(text.span(0..content.len()), "")
                    .help("write \"A-B\": the distance of the points A and B"),
            );
            return None;
        };
        let a = Word::trimmed(content, 0..dash);
        let b = Word::trimmed(content, dash + 1..content.len());
        let (a, b) = (self.point_word(text, &a), self.point_word(text, &b));
        Some((a?, b?))
    }
}
