//! One entry of a section, `name = { … }`, and what every section asks of it.

use kempe_units::Dimension;

use crate::diagnostic::Diagnostic;
use crate::document::{Key, Node, Table};
use crate::model::{FRAME, LinkId, LinkPointRef, PointId, Scalar};
use crate::read::context::Context;

/// A table with what messages about it need.
pub(crate) struct Entry<'d> {
    pub key: &'d Key,
    pub table: &'d Table,
    /// What it is: ``spring `return` ``.
    pub place: String,
    /// A whole entry of its kind.
    pub example: &'static str,
}

impl<'d> Entry<'d> {
    /// The entry, with unknown keys told.
    pub fn new(
        cx: &mut Context<'_>,
        (key, node): &'d (Key, Node),
        what: &str,
        example: &'static str,
        known: &[&str],
    ) -> Option<Self> {
        let place = format!("{what} `{}`", key.name);
        let table = cx.table(node, &place, example)?;
        cx.unknown_keys(table, &place, known);
        Some(Self {
            key,
            table,
            place,
            example,
        })
    }

    /// The value of a key that must be there.
    pub fn required(&self, cx: &mut Context<'_>, key: &str) -> Option<&'d Node> {
        cx.required(
            self.table,
            key,
            &self.place,
            &self.key.span,
            &format!("… as in {}", self.example),
        )
    }

    /// A link that must be named.
    pub fn link(&self, cx: &mut Context<'_>, key: &str) -> Option<LinkId> {
        let node = self.required(cx, key)?;
        link_of(cx, node, &format!("`{key}` of {}", self.place))
    }

    /// A value that may be given; the outer `None` when it is wrong.
    pub fn scalar(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        dimension: Dimension,
    ) -> Option<Option<Scalar>> {
        match self.table.get(key) {
            Some(node) => cx.scalar(node, dimension).map(Some),
            None => Some(None),
        }
    }

    /// A value that may be given and is positive (or, with `zero`, not negative); the outer `None` when it is wrong.
    pub fn positive(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        dimension: Dimension,
        zero: bool,
    ) -> Option<Option<Scalar>> {
        match self.table.get(key) {
            Some(node) => cx
                .positive(node, dimension, &format!("`{key}` of {}", self.place), zero)
                .map(Some),
            None => Some(None),
        }
    }

    /// A value that must be given and is positive (or, with `zero`, not negative).
    pub fn required_positive(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        dimension: Dimension,
        zero: bool,
    ) -> Option<Scalar> {
        let node = self.required(cx, key)?;
        cx.positive(node, dimension, &format!("`{key}` of {}", self.place), zero)
    }

    /// An array of two that must be there.
    pub fn pair(&self, cx: &mut Context<'_>, key: &str) -> Option<(&'d Node, &'d Node)> {
        let node = self.required(cx, key)?;
        self.two(cx, node, key)
    }

    /// The two values of an array.
    pub fn two(
        &self,
        cx: &mut Context<'_>,
        node: &'d Node,
        key: &str,
    ) -> Option<(&'d Node, &'d Node)> {
        let place = format!("`{key}` of {}", self.place);
        match cx.array(node, &place, self.example)? {
            [a, b] => Some((a, b)),
            items => {
                let count = items.len();
                cx.push(
                    Diagnostic::error(
                        "wrong-type",
                        format!("{place} has two entries, found {count}"),
                    )
                    .at(node.span.clone(), "")
                    .help(format!("write it like {}", self.example)),
                );
                None
            }
        }
    }

    /// Warns of keys that mean nothing without another.
    pub fn idle(&self, cx: &mut Context<'_>, keys: &[&str], without: &str) {
        if self.table.get(without).is_some() {
            return;
        }
        for (key, _) in keys.iter().filter_map(|key| self.table.entry(key)) {
            cx.push(
                Diagnostic::warning(
                    "idle-key",
                    format!("`{}` of {} means nothing here", key.name, self.place),
                )
                .at(
                    key.span.clone(),
                    format!("means nothing without `{without}`"),
                )
                .help(format!("add `{without}`, or leave `{}` out", key.name)),
            );
        }
    }

    /// Tells that two values cannot both be right.
    pub fn contradiction(&self, cx: &mut Context<'_>, keys: [&str; 2], message: &str, help: &str) {
        let mut d = Diagnostic::error("contradictory-values", format!("{}: {message}", self.place))
            .help(help);
        for (i, node) in keys.iter().filter_map(|k| self.table.get(k)).enumerate() {
            d = if i == 0 {
                d.at(node.span.clone(), "")
            } else {
                d.see(node.span.clone(), "")
            };
        }
        cx.push(d);
    }

    /// One of some words.
    pub fn choice<T: Copy>(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        words: &[(&str, T)],
    ) -> Option<Option<T>> {
        let Some(node) = self.table.get(key) else {
            return Some(None);
        };
        let example = format!("{:?}", words.first().map_or("", |w| w.0));
        let text = cx.text(node, &format!("`{key}` of {}", self.place), &example)?;
        let word = text.content.trim();
        let found = words.iter().find(|(name, _)| *name == word).map(|w| w.1);
        if found.is_none() {
            let known: Vec<String> = words.iter().map(|(name, _)| format!("{name:?}")).collect();
            let help = match kempe_units::nearest(word, words.iter().map(|w| w.0)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("write {key} = {}", known.join(" or ")),
            };
            cx.push(
                Diagnostic::error(
                    "bad-choice",
                    format!("`{key}` of {} cannot be `{word}`", self.place),
                )
                .at(node.span.clone(), "")
                .help(help),
            );
        }
        found.map(Some)
    }
}

/// A link by its name in a string.
pub(crate) fn link_of(cx: &mut Context<'_>, node: &Node, place: &str) -> Option<LinkId> {
    let text = cx.text(node, place, "\"crank\"")?;
    let span = text.span(0..text.content.len());
    let name = text.content.clone();
    cx.link(name.trim(), span)
}

/// Checks that a point is on a link.
pub(crate) fn on_link(
    cx: &mut Context<'_>,
    point: PointId,
    link: LinkId,
    node: &Node,
) -> Option<LinkPointRef> {
    if cx.carriers(point).binary_search(&link).is_ok() {
        return Some(LinkPointRef { link, point });
    }
    let (name, link_name) = (
        cx.point_name(point).to_owned(),
        cx.link_name(link).to_owned(),
    );
    cx.push(
        Diagnostic::error(
            "point-not-on-link",
            format!("{name} is not a point of link `{link_name}`"),
        )
        .at(node.span.clone(), "")
        .help(points_help(cx, point, link)),
    );
    None
}

/// The links that carry a point and the points of a link, for help where one is not on the other.
fn points_help(cx: &Context<'_>, point: PointId, link: LinkId) -> String {
    const SHOWN: usize = 8;
    let list = |names: Vec<&str>| {
        let more = if names.len() > SHOWN { ", …" } else { "" };
        format!("{}{more}", names.get(..SHOWN).unwrap_or(&names).join(", "))
    };
    let carriers = cx
        .carriers(point)
        .iter()
        .map(|l| cx.link_name(*l))
        .collect();
    // links are read after their points are known, so that a link's own list may not be there yet
    let points = cx.model.points.iter().filter(|p| p.links.contains(&link));
    let points: Vec<&str> = points.map(|p| p.name.as_str()).collect();
    let carriers = format!("{} is on {}", cx.point_name(point), list(carriers));
    match points.is_empty() {
        true => carriers,
        false => format!("{carriers}; `{}` has {}", cx.link_name(link), list(points)),
    }
}

/// The link that something at a point acts on when none is named: the first-named that moves, or else the frame.
pub(crate) fn moving_carrier(cx: &Context<'_>, point: PointId) -> Option<LinkId> {
    let carriers = cx.carriers(point);
    carriers
        .iter()
        .find(|l| **l != FRAME)
        .or(carriers.first())
        .copied()
}
