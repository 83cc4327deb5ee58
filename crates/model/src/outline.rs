//! The outline of a text: every key and value with its path and place, also where the text is not TOML on some line.
//!
//! The reader's tree keeps one place of each name. Who edits needs them all, as `[links.bar]` may be followed by
//! `[links.bar.more]`, and who types needs them while a line is half written. The outline is a walk over the text that
//! believes every line by itself: what does not end on its line and should is ended there.

use crate::ids::Span;
use crate::mend::begins_anew;
use crate::node::Text;

/// A key and where it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KeyMark {
    /// Names down to the key, places in arrays as numbers.
    pub path: Vec<String>,
    /// The key as written, with its quotes.
    pub span: Span,
}

/// What a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A string that is closed.
    Text,
    /// A number, a word, or what is no value.
    Bare,
    /// An array.
    Array,
    /// A table between braces.
    Table,
}

/// A value and where it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ValueMark {
    pub path: Vec<String>,
    /// The value as written, with quotes and brackets; empty where it is still to be written.
    pub span: Span,
    pub shape: Shape,
    /// From the key, if it has one of its own, to the end of the value.
    pub whole: Span,
}

/// A line `[links.bar]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Header {
    pub path: Vec<String>,
    /// From the start of its line up to the next header or the end.
    pub span: Span,
}

/// A text's keys and values in the order of writing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Outline {
    pub keys: Vec<KeyMark>,
    /// A container comes before what it holds.
    pub values: Vec<ValueMark>,
    pub headers: Vec<Header>,
    /// The lines of what stands in no brackets, `key = value`: the index of its value, and its lines.
    pub statements: Vec<(usize, Span)>,
}

impl Outline {
    pub fn new(text: &str) -> Self {
        let mut scan = Scan {
            text,
            at: 0,
            out: Self::default(),
        };
        scan.run();
        scan.out
    }

    /// The value of a path.
    pub fn value(&self, path: &[String]) -> Option<&ValueMark> {
        self.values.iter().find(|v| v.path == path)
    }
}

/// The string that a value is, with the way back to the text's bytes.
pub(crate) fn string(text: &str, value: &ValueMark) -> Option<Text> {
    if value.shape != Shape::Text {
        return None;
    }
    let raw = text.get(value.span.clone())?;
    let toml::de::DeValue::String(content) = toml::de::DeValue::parse(raw).ok()?.into_inner()
    else {
        return None;
    };
    Some(Text::new(content.to_string(), &value.span, text))
}

/// Brackets deeper than this are not looked into; no model needs as many.
const MAX_DEPTH: usize = 32;

struct Scan<'t> {
    text: &'t str,
    at: usize,
    out: Outline,
}

impl Scan<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn run(&mut self) {
        let mut prefix: Vec<String> = Vec::new();
        if self.rest().starts_with('\u{feff}') {
            self.at += '\u{feff}'.len_utf8();
        }
        while self.at < self.text.len() {
            let start = self.at;
            self.blanks();
            match self.peek() {
                None | Some(b'\n' | b'\r' | b'#') => {}
                Some(b'[') => {
                    while self.peek() == Some(b'[') {
                        self.at += 1;
                    }
                    prefix = self.keys(Vec::new());
                    if let Some(last) = self.out.headers.last_mut() {
                        last.span.end = start;
                    }
                    self.out.headers.push(Header {
                        path: prefix.clone(),
                        span: start..self.text.len(),
                    });
                }
                Some(_) => {
                    let from = self.at;
                    let path = self.keys(prefix.clone());
                    if self.peek() == Some(b'=') && path.len() > prefix.len() {
                        self.at += 1;
                        let index = self.out.values.len();
                        self.value(path, from, 0);
                        self.line_end(start);
                        self.out.statements.push((index, start..self.at));
                    }
                }
            }
            self.line_end(start);
        }
    }

    /// Goes behind the end of the line, unless one has been passed since `start`.
    fn line_end(&mut self, start: usize) {
        if self.at > start && self.text.as_bytes().get(self.at - 1) == Some(&b'\n') {
            return;
        }
        let length = self.rest().find('\n').map_or(self.rest().len(), |i| i + 1);
        self.at += length;
    }

    fn blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    /// Keys with points between them; the path that they lead to from `path`.
    fn keys(&mut self, mut path: Vec<String>) -> Vec<String> {
        loop {
            self.blanks();
            let start = self.at;
            let name = match self.peek() {
                Some(b'"' | b'\'') => {
                    self.quoted();
                    let raw = self.text.get(start..self.at).unwrap_or("");
                    key_name(raw)
                }
                _ => {
                    let bare = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
                    let length = self.rest().find(|c| !bare(c)).unwrap_or(self.rest().len());
                    self.at += length;
                    self.text.get(start..self.at).unwrap_or("").to_owned()
                }
            };
            if self.at == start {
                return path;
            }
            path.push(name);
            self.out.keys.push(KeyMark {
                path: path.clone(),
                span: start..self.at,
            });
            self.blanks();
            match self.peek() {
                Some(b'.') => self.at += 1,
                _ => return path,
            }
        }
    }

    /// Goes behind a string; one of a single line ends with its line. Whether it was closed.
    fn quoted(&mut self) -> bool {
        let quote = self.peek().unwrap_or(b'"');
        let three = if quote == b'"' { "\"\"\"" } else { "'''" };
        let many = self.rest().starts_with(three);
        self.at += if many { 3 } else { 1 };
        while let Some(sign) = self.peek() {
            if sign == b'\\' && quote == b'"' {
                self.at = (self.at + 2).min(self.text.len());
                continue;
            }
            if many && self.rest().starts_with(three) {
                self.at += 3;
                // two quotes may stand before the closing three
                while self.peek() == Some(quote) {
                    self.at += 1;
                }
                return true;
            }
            if !many && sign == quote {
                self.at += 1;
                return true;
            }
            if !many && (sign == b'\n' || sign == b'\r') {
                return false;
            }
            self.at += 1;
        }
        false
    }

    /// A value that belongs to what starts at `from`.
    fn value(&mut self, path: Vec<String>, from: usize, depth: usize) {
        self.blanks();
        let start = self.at;
        let index = self.out.values.len();
        let shape = match self.peek() {
            Some(b'"' | b'\'') => Shape::Text,
            Some(b'[') if depth < MAX_DEPTH => Shape::Array,
            Some(b'{') if depth < MAX_DEPTH => Shape::Table,
            _ => Shape::Bare,
        };
        self.out.values.push(ValueMark {
            path: path.clone(),
            span: start..start,
            shape,
            whole: from..start,
        });
        let mut shape = shape;
        match shape {
            Shape::Text => {
                if !self.quoted() {
                    shape = Shape::Bare;
                }
            }
            Shape::Bare => self.bare(),
            Shape::Array | Shape::Table => self.bracket(&path, shape, depth),
        }
        let end = self.at;
        if let Some(mark) = self.out.values.get_mut(index) {
            mark.span.end = end;
            mark.whole.end = end;
            mark.shape = shape;
        }
    }

    /// Goes behind what is neither string nor bracket.
    fn bare(&mut self) {
        let start = self.at;
        let ends = |c: char| matches!(c, ',' | ']' | '}' | '#' | '\n' | '\r');
        self.at += self.rest().find(ends).unwrap_or(self.rest().len());
        let written = self.text.get(start..self.at).unwrap_or("");
        self.at = start + written.trim_end().len();
    }

    /// What stands between brackets, and the bracket that closes them if it is there.
    fn bracket(&mut self, path: &[String], shape: Shape, depth: usize) {
        let (open, close) = match shape {
            Shape::Array => (b'[', b']'),
            _ => (b'{', b'}'),
        };
        self.at += 1;
        let mut last = open;
        let mut count = 0;
        loop {
            self.blanks();
            let start = self.at;
            match self.peek() {
                None => return,
                Some(b'#') => {
                    self.at += self.rest().find('\n').unwrap_or(self.rest().len());
                }
                Some(b'\n' | b'\r') => {
                    let end = self.at;
                    while matches!(self.peek(), Some(b'\n' | b'\r')) {
                        self.at += 1;
                    }
                    let line = self.rest().lines().next().unwrap_or("");
                    if begins_anew(line, open, last) {
                        // the entry ends before this line
                        self.at = end;
                        return;
                    }
                }
                Some(b',') => {
                    self.at += 1;
                    last = b',';
                }
                Some(sign) if sign == close => {
                    self.at += 1;
                    return;
                }
                // a bracket of the other kind closes what is around this one
                Some(b']' | b'}') => return,
                Some(_) => {
                    let mut path = path.to_vec();
                    if shape == Shape::Array {
                        path.push(count.to_string());
                        count += 1;
                        self.value(path, start, depth + 1);
                    } else {
                        let above = path.len();
                        let path = self.keys(path);
                        if self.peek() == Some(b'=') && path.len() > above {
                            self.at += 1;
                            self.value(path, start, depth + 1);
                        }
                    }
                    last = b' ';
                    if self.at == start {
                        // a sign that is nothing here
                        let sign = self.rest().chars().next();
                        self.at += sign.map_or(1, char::len_utf8);
                    }
                }
            }
        }
    }
}

/// The name that a quoted key says.
fn key_name(raw: &str) -> String {
    match toml::de::DeValue::parse(raw).map(toml::Spanned::into_inner) {
        Ok(toml::de::DeValue::String(name)) => name.to_string(),
        _ => raw.trim_matches(['"', '\'']).to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::parse;
    use crate::mend::Broken;
    use crate::node::{Node, Table, Value};

    /// Paths and places of the reader's tree, of what is no table under a header.
    fn tree(table: &Table, path: &[String], out: &mut Vec<(Vec<String>, Span)>) {
        for (key, node) in &table.entries {
            let path: Vec<String> = path.iter().cloned().chain([key.name.clone()]).collect();
            leaf(node, &path, out);
        }
    }

    fn leaf(node: &Node, path: &[String], out: &mut Vec<(Vec<String>, Span)>) {
        match &node.value {
            Value::Table(table) => tree(table, path, out),
            Value::Array(items) => {
                for (i, item) in items.iter().enumerate() {
                    let path: Vec<String> = path.iter().cloned().chain([i.to_string()]).collect();
                    leaf(item, &path, out);
                }
            }
            _ => out.push((path.to_vec(), node.span.clone())),
        }
    }

    fn as_the_reader(text: &str) {
        let mut found = Vec::new();
        let root = parse(text, &mut found, &mut Broken::default());
        assert!(found.is_empty(), "{found:?}");
        let mut wanted = Vec::new();
        tree(&root, &[], &mut wanted);
        wanted.sort_by_key(|(_, span)| span.start);
        let outline = Outline::new(text);
        let values = outline.values.iter();
        let leaves = values.filter(|v| matches!(v.shape, Shape::Text | Shape::Bare));
        let found: Vec<_> = leaves.map(|v| (v.path.clone(), v.span.clone())).collect();
        assert_eq!(found, wanted, "{text}");
        for key in &outline.keys {
            let raw = &text[key.span.clone()];
            assert_eq!(Some(&key_name_of(raw)), key.path.last(), "{raw}");
        }
    }

    fn key_name_of(raw: &str) -> String {
        match raw.starts_with(['"', '\'']) {
            true => key_name(raw),
            false => raw.to_owned(),
        }
    }

    #[test]
    fn sound_texts_are_seen_as_the_reader_sees_them() {
        for starter in crate::STARTERS {
            as_the_reader(starter.text);
            as_the_reader(&starter.text.replace('\n', "\r\n"));
        }
        as_the_reader(
            "a = 1 # x = [\n[b.\"c d\".e]\nf.g = { h = [1, { i = '''x\n]''' }], \"j.k\" = \"\\\"]\" } # }\n[b]\nl = [\n  1, # ]\n  2,\n]\nm = \"\"\"\"x\"\"\"\"\"\n n=inf",
        );
        as_the_reader("\u{feff}[a]\n'é' = \"ü\"\n");
        as_the_reader("");
    }

    #[test]
    fn every_example_is_seen_as_the_reader_sees_it() {
        let mut seen = 0;
        for folder in ["gallery", "seeds"] {
            let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
            for entry in std::fs::read_dir(root.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_some_and(|e| e == "toml") {
                    as_the_reader(&std::fs::read_to_string(path).unwrap());
                    seen += 1;
                }
            }
        }
        assert!(seen > 20, "{seen}");
    }

    #[test]
    fn a_broken_line_hides_no_other() {
        let paths = |text: &str| -> Vec<String> {
            let outline = Outline::new(text);
            let values = outline.values.iter();
            values
                .map(|v| format!("{}={}", v.path.join("."), &text[v.span.clone()]))
                .collect()
        };
        assert_eq!(
            paths("[links]\na = { b = 1, c = [2\nd = 4\n"),
            [
                "links.a={ b = 1, c = [2",
                "links.a.b=1",
                "links.a.c=[2",
                "links.a.c.0=2",
                "links.d=4"
            ]
        );
        assert_eq!(paths("a = \"x\nb = "), ["a=\"x", "b="]);
        assert_eq!(
            paths("a = { b = , c = 3 }\nd"),
            ["a={ b = , c = 3 }", "a.b=", "a.c=3"]
        );
        assert_eq!(
            paths("a = { b\n[c]\nd = ] 3\ne = 1"),
            ["a={ b", "c.d=", "c.e=1"]
        );
        assert_eq!(
            paths("[links\na = 1\n= 3\n\"b = 2\n. = 3\nc.=4"),
            ["links.a=1", "links.c=4"]
        );
    }

    #[test]
    fn hostile_texts_are_walked_in_time() {
        for text in [
            "[".repeat(200_000),
            "a = ".to_owned() + &"[".repeat(200_000),
            "a={b=".repeat(50_000),
            "a.".repeat(2_000) + "=1",
            "\"".repeat(100_001),
            "a=[\n".repeat(50_000),
        ] {
            let outline = Outline::new(&text);
            assert!(outline.values.len() <= text.len());
        }
    }
}
