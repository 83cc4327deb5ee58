//! One table of the file, `name = { … }`, read by what the table of keys knows of its kind.

use kempe_units::{Dimension, Expr, nearest};

use crate::diagnostic::Diagnostic;
use crate::ids::{FRAME, LinkId, LinkPointRef, PointId, Scalar, Span};
use crate::keys::{Kind, Quantity, Sign, Takes};
use crate::node::{Key, Node, Table, Text, Value};
use crate::read::context::Context;

/// A table of a known kind: only keys that the kind has can be read from it.
pub(crate) struct Entry<'d> {
    table: &'d Table,
    pub kind: &'static Kind,
    /// Where to tell what is missing.
    pub span: &'d Span,
    /// What it is: ``spring `return` ``.
    pub place: String,
    /// A whole one of its kind.
    pub example: &'static str,
    /// Whether unknown keys of it are told.
    keys_told: bool,
    /// Whether it is about what turns: values have the dimensions that go with it.
    pub turning: bool,
}

impl<'d> Entry<'d> {
    /// An entry of a section, with unknown keys told.
    pub fn new(
        cx: &mut Context<'_>,
        (key, node): &'d (Key, Node),
        kind: &'static Kind,
    ) -> Option<Self> {
        let place = format!("{} `{}`", kind.what, key.name);
        Self::inner(cx, node, &key.span, place, kind)
    }

    /// A table inside of an entry, with unknown keys told.
    pub fn inner(
        cx: &mut Context<'_>,
        node: &'d Node,
        span: &'d Span,
        place: String,
        kind: &'static Kind,
    ) -> Option<Self> {
        let table = cx.table(node, &place, kind.example)?;
        cx.unknown_keys(table, &place, &kind.names());
        let keys_told = true;
        Some(Self {
            keys_told,
            ..Self::of(table, span, place, kind)
        })
    }

    /// The same of a table whose unknown keys are told otherwise.
    pub fn of(table: &'d Table, span: &'d Span, place: String, kind: &'static Kind) -> Self {
        Self {
            table,
            kind,
            span,
            place,
            example: kind.example,
            keys_told: false,
            turning: false,
        }
    }

    /// A key and its value, if it is given.
    pub fn entry(&self, key: &str) -> Option<&'d (Key, Node)> {
        let known = self.kind.key(key).is_some();
        debug_assert!(known, "no `{key}` of {} in the table", self.kind.name);
        self.table.entry(key).filter(|_| known)
    }

    /// The value of a key, if it is given.
    pub fn get(&self, key: &str) -> Option<&'d Node> {
        self.entry(key).map(|(_, node)| node)
    }

    /// Whether a key is given.
    pub fn has(&self, key: &str) -> bool {
        self.entry(key).is_some()
    }

    /// Those of some keys that are given, in the order of the file.
    pub fn given<'k>(&self, keys: &'k [&str]) -> impl Iterator<Item = &'d Key> + use<'d, 'k> {
        debug_assert!(keys.iter().all(|key| self.kind.key(key).is_some()));
        let entries = self.table.entries.iter().map(|(key, _)| key);
        entries.filter(|key| keys.contains(&key.name.as_str()))
    }

    /// A key in words: `` `at` of joint `bore` ``.
    pub fn place_of(&self, key: &str) -> String {
        format!("`{key}` of {}", self.place)
    }

    /// The value of a key that must be there.
    pub fn required(&self, cx: &mut Context<'_>, key: &str) -> Option<&'d Node> {
        self.required_like(cx, key, &format!("… as in {}", self.example))
    }

    /// The same, with an example of the value.
    pub fn required_like(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        example: &str,
    ) -> Option<&'d Node> {
        let node = self.get(key);
        if node.is_none() && !self.misspelt(key) {
            cx.push(
                Diagnostic::error("missing-key", format!("{} has no `{key}`", self.place))
                    .at(self.span.clone(), format!("`{key}` is missing"))
                    .help(format!("add {key} = {example}")),
            );
        }
        node
    }

    /// Whether a key that is told to be unknown is likely this one.
    pub fn misspelt(&self, key: &str) -> bool {
        if !self.keys_told {
            return false;
        }
        let known = self.kind.names();
        let mut names = self.table.entries.iter().map(|(key, _)| key.name.as_str());
        names
            .any(|name| !known.contains(&name) && nearest(name, known.iter().copied()) == Some(key))
    }

    /// An example of the value of a key.
    pub fn example_of(&self, key: &str) -> &'static str {
        self.kind.example_of(key)
    }

    /// The string of a key.
    pub fn text(&self, cx: &mut Context<'_>, key: &str, node: &'d Node) -> Option<&'d Text> {
        cx.text(node, &self.place_of(key), self.example_of(key))
    }

    /// A link that must be named.
    pub fn link(&self, cx: &mut Context<'_>, key: &str) -> Option<LinkId> {
        let node = self.required(cx, key)?;
        link_of(cx, node, &self.place_of(key))
    }

    /// A link that may be named; the frame otherwise.
    pub fn link_or_frame(&self, cx: &mut Context<'_>, key: &str) -> Option<LinkId> {
        match self.get(key) {
            Some(_) => self.link(cx, key),
            None => Some(FRAME),
        }
    }

    /// A point that must be named.
    pub fn point(&self, cx: &mut Context<'_>, key: &str) -> Option<(PointId, &'d Node)> {
        let node = self.required(cx, key)?;
        let text = self.text(cx, key, node)?;
        Some((cx.point_text(text)?, node))
    }

    /// The value of a key of `true` or `false`; `false` without it.
    pub fn flag(&self, cx: &mut Context<'_>, key: &str) -> Option<bool> {
        match self.get(key) {
            Some(node) => cx.flag(node, &self.place_of(key)),
            None => Some(false),
        }
    }

    /// What a key measures.
    pub fn dimension(&self, key: &str) -> Dimension {
        let quantity = self.kind.key(key).and_then(|row| quantity(&row.takes));
        debug_assert!(quantity.is_some(), "`{key}` has no dimension in the table");
        quantity.map_or(Dimension::NONE, |quantity| quantity.of(self.turning))
    }

    /// A value that may be given; the outer `None` when it is wrong.
    pub fn value(&self, cx: &mut Context<'_>, key: &str) -> Option<Option<Scalar>> {
        let Some(node) = self.get(key) else {
            return Some(None);
        };
        let quantity = self.kind.key(key).and_then(|row| quantity(&row.takes))?;
        self.signed(cx, key, node, quantity.sign).map(Some)
    }

    /// A value that may be given, or this one.
    pub fn value_or(&self, cx: &mut Context<'_>, key: &str, default: f64) -> Option<Scalar> {
        let value = self.value(cx, key)?;
        Some(value.unwrap_or(Expr::Const(default)))
    }

    /// A value that must be given.
    pub fn needed(&self, cx: &mut Context<'_>, key: &str) -> Option<Scalar> {
        self.required(cx, key)?;
        self.value(cx, key)?
    }

    /// A value whose sign depends on more than its key.
    pub fn signed(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        node: &Node,
        sign: Sign,
    ) -> Option<Scalar> {
        let dimension = self.dimension(key);
        match sign {
            Sign::Any => cx.scalar(node, dimension),
            _ => {
                let zero = sign == Sign::NotNegative;
                cx.positive(node, dimension, &self.place_of(key), zero)
            }
        }
    }

    /// Two bounds, `"none"` where there is no bound; the outer `None` when they are wrong.
    pub fn bounds(&self, cx: &mut Context<'_>, key: &str) -> Option<Option<[Option<Scalar>; 2]>> {
        let Some(node) = self.get(key) else {
            return Some(None);
        };
        let place = self.place_of(key);
        bounds_of(cx, node, self.dimension(key), &place, self.example).map(Some)
    }

    /// Two links that must be named.
    pub fn two_links(
        &self,
        cx: &mut Context<'_>,
        key: &str,
    ) -> Option<((LinkId, LinkId), &'d Node)> {
        let node = self.required(cx, key)?;
        let (a, b) = self.two(cx, node, key)?;
        let place = self.place_of(key);
        let (a, b) = (link_of(cx, a, &place), link_of(cx, b, &place));
        Some(((a?, b?), node))
    }

    /// The two values of an array.
    pub fn two(
        &self,
        cx: &mut Context<'_>,
        node: &'d Node,
        key: &str,
    ) -> Option<(&'d Node, &'d Node)> {
        two_of(cx, node, &self.place_of(key), self.example)
    }

    /// Warns of keys that mean nothing without another.
    pub fn idle(&self, cx: &mut Context<'_>, keys: &[&str], without: &str) {
        if self.has(without) {
            return;
        }
        for (key, _) in keys.iter().filter_map(|key| self.entry(key)) {
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
    pub fn contradiction(&self, cx: &mut Context<'_>, keys: &[&str], message: &str, help: &str) {
        let mut d = Diagnostic::error("contradictory-values", format!("{}: {message}", self.place))
            .help(help);
        for (i, node) in keys.iter().filter_map(|k| self.get(k)).enumerate() {
            d = if i == 0 {
                d.at(node.span.clone(), "")
            } else {
                d.see(node.span.clone(), "")
            };
        }
        cx.push(d);
    }

    /// One of some words, if it is given.
    pub fn choice<T: Copy>(
        &self,
        cx: &mut Context<'_>,
        key: &str,
        words: &[(&str, T)],
    ) -> Option<Option<T>> {
        let Some(node) = self.get(key) else {
            return Some(None);
        };
        let text = self.text(cx, key, node)?;
        let word = text.content.trim();
        let found = words.iter().find(|(name, _)| *name == word).map(|w| w.1);
        if found.is_none() {
            let known: Vec<String> = words.iter().map(|(name, _)| format!("{name:?}")).collect();
            let help = match nearest(word, words.iter().map(|w| w.0)) {
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

/// The quantity of what a key takes, or of its parts.
fn quantity(takes: &Takes) -> Option<Quantity> {
    match takes {
        Takes::Value(quantity) => Some(*quantity),
        Takes::AnyOf(some) => some.iter().find_map(quantity),
        Takes::Two(one) | Takes::List(one, _) => quantity(one),
        _ => None,
    }
}

/// The two values of an array.
fn two_of<'n>(
    cx: &mut Context<'_>,
    node: &'n Node,
    place: &str,
    example: &str,
) -> Option<(&'n Node, &'n Node)> {
    match cx.array(node, place, example)? {
        [a, b] => Some((a, b)),
        items => {
            let help = format!("write it like {example}");
            cx.not_two(node, items, format!("{place} has two entries"), &help);
            None
        }
    }
}

/// Two bounds, `"none"` where there is no bound.
pub(crate) fn bounds_of(
    cx: &mut Context<'_>,
    node: &Node,
    dimension: Dimension,
    place: &str,
    example: &str,
) -> Option<[Option<Scalar>; 2]> {
    let (low, high) = two_of(cx, node, place, example)?;
    let mut bound = |node: &Node| match &node.value {
        Value::Text(text) if text.content.trim() == "none" => Some(None),
        _ => cx.scalar(node, dimension).map(Some),
    };
    let (low, high) = (bound(low), bound(high));
    Some([low?, high?])
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
    cx.refuse(
        "point-not-on-link",
        format!("{name} is not a point of link `{link_name}`"),
        &node.span,
        points_help(cx, point, link),
    )
}

fn some_of(names: Vec<&str>) -> String {
    const SHOWN: usize = 8;
    let more = if names.len() > SHOWN { ", …" } else { "" };
    format!("{}{more}", names.get(..SHOWN).unwrap_or(&names).join(", "))
}

/// The links that carry a point, in words.
pub(crate) fn carriers_of(cx: &Context<'_>, point: PointId) -> String {
    let carriers = cx.carriers(point).iter();
    let carriers = carriers.map(|l| cx.link_name(*l)).collect();
    format!("{} is on {}", cx.point_name(point), some_of(carriers))
}

/// The links that carry a point and the points of a link, for help where one is not on the other.
fn points_help(cx: &Context<'_>, point: PointId, link: LinkId) -> String {
    // links are read after their points are known, so that a link's own list may not be there yet
    let points = cx.model.points.iter().filter(|p| p.links.contains(&link));
    let points: Vec<&str> = points.map(|p| p.name.as_str()).collect();
    let carriers = carriers_of(cx, point);
    match points.is_empty() {
        true => carriers,
        false => format!(
            "{carriers}; `{}` has {}",
            cx.link_name(link),
            some_of(points)
        ),
    }
}

/// One value, or several in brackets.
pub(crate) fn entries<'d>(cx: &mut Context<'_>, entry: &Entry<'d>, key: &str) -> Vec<&'d Node> {
    let example = entry.example_of(key);
    match entry.get(key) {
        None => Vec::new(),
        // one alone needs no brackets
        Some(
            node @ Node {
                value: Value::Text(_),
                ..
            },
        ) => vec![node],
        Some(node) => {
            let items = cx.array(node, &entry.place_of(key), example);
            if items.is_some_and(<[Node]>::is_empty)
                && let Some((key, _)) = entry.entry(key)
            {
                cx.push(
                    Diagnostic::warning("idle-key", format!("`{}` names nothing", key.name))
                        .at(key.span.clone(), "counts as if it were not there")
                        .help(format!(
                            "leave it out, or name what is wanted: {} = {example}",
                            key.name
                        )),
                );
            }
            items.map_or(Vec::new(), |a| a.iter().collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::key_table::SPRING;

    /// A key that the table of keys does not have for a kind cannot be read, even where the file has it.
    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "no `bore` of spring"))]
    fn what_the_table_does_not_have_is_not_read() {
        let key = |name: &str| Key {
            name: name.to_owned(),
            span: 0..1,
        };
        let value = || Node {
            span: 0..1,
            value: Value::Number(1.0),
        };
        let table = Table {
            entries: vec![(key("free"), value()), (key("bore"), value())],
        };
        let entry = Entry::of(&table, &(0..1), String::new(), &SPRING);
        assert!(entry.has("free"));
        assert!(!entry.has("bore"));
    }
}
