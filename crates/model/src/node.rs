//! Values and keys of a TOML text, each with its place.

use crate::ids::Span;

/// A value with its place (quotes and brackets included).
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub span: Span,
    pub value: Value,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(Text),
    Number(f64),
    Bool(bool),
    Date,
    Array(Vec<Node>),
    Table(Table),
}

/// A string, with the way back from its characters to the file's bytes.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub content: String,
    /// Byte of the file where the content starts, behind the opening quote.
    start: usize,
    /// Decoded and file offsets (from the start) behind every escape; empty for a string without one.
    escapes: Vec<(usize, usize)>,
}

/// A table's entries in file order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub entries: Vec<(Key, Node)>,
}

/// A key with its place.
#[derive(Clone, Debug)]
pub(crate) struct Key {
    pub name: String,
    pub span: Span,
}

impl Node {
    /// What the value is, in words: `a string`.
    pub fn what(&self) -> &'static str {
        match &self.value {
            Value::Text(_) => "a string",
            Value::Number(_) => "a number",
            Value::Bool(_) => "true or false",
            Value::Date => "a date",
            Value::Array(_) => "an array",
            Value::Table(_) => "a table",
        }
    }
}

impl Table {
    /// The value of a key.
    pub fn get(&self, name: &str) -> Option<&Node> {
        self.entries
            .iter()
            .find(|(k, _)| k.name == name)
            .map(|(_, v)| v)
    }

    /// A key and its value.
    pub fn entry(&self, name: &str) -> Option<&(Key, Node)> {
        self.entries.iter().find(|(k, _)| k.name == name)
    }
}

impl Text {
    /// The file's bytes of a range of the content's bytes.
    pub fn span(&self, inner: Span) -> Span {
        self.place(inner.start)..self.place(inner.end.max(inner.start))
    }

    fn place(&self, inner: usize) -> usize {
        let inner = inner.min(self.content.len());
        let i = self
            .escapes
            .partition_point(|(decoded, _)| *decoded <= inner);
        match i.checked_sub(1).and_then(|i| self.escapes.get(i)) {
            Some((decoded, raw)) => self.start + raw + (inner - decoded),
            None => self.start + inner,
        }
    }

    pub fn new(content: String, span: &Span, source: &str) -> Self {
        let raw = source.get(span.clone()).unwrap_or("");
        let quotes = if raw.starts_with("\"\"\"") || raw.starts_with("'''") {
            3
        } else {
            1
        };
        let body = raw.get(quotes..).unwrap_or("");
        // a line end right behind the opening quotes does not count
        let skip = match (quotes, body) {
            (3, b) if b.starts_with("\r\n") => 2,
            (3, b) if b.starts_with('\n') => 1,
            _ => 0,
        };
        let mut escapes = Vec::new();
        if raw.starts_with('"') {
            find_escapes(body.get(skip..).unwrap_or(""), &mut escapes);
        }
        Self {
            content,
            start: span.start + quotes + skip,
            escapes,
        }
    }
}

/// Offsets behind each escape of a basic string, decoded and as written.
fn find_escapes(body: &str, escapes: &mut Vec<(usize, usize)>) {
    let bytes = body.as_bytes();
    let (mut raw, mut decoded) = (0, 0);
    while let Some(&b) = bytes.get(raw) {
        if b != b'\\' {
            raw += 1;
            decoded += 1;
            continue;
        }
        let (length, width) = match bytes.get(raw + 1) {
            Some(b'u') => (6, hex_width(body.get(raw + 2..raw + 6))),
            Some(b'U') => (10, hex_width(body.get(raw + 2..raw + 10))),
            Some(b'x') => (4, hex_width(body.get(raw + 2..raw + 4))),
            // a backslash at a line's end swallows the white space behind it
            Some(b' ' | b'\t' | b'\n' | b'\r') => {
                let rest = bytes.get(raw + 1..).unwrap_or(&[]);
                (
                    1 + rest.iter().take_while(|b| b.is_ascii_whitespace()).count(),
                    0,
                )
            }
            _ => (2, 1),
        };
        raw += length;
        decoded += width;
        escapes.push((decoded, raw));
    }
}

fn hex_width(digits: Option<&str>) -> usize {
    let code = digits
        .and_then(|d| u32::from_str_radix(d, 16).ok())
        .and_then(char::from_u32);
    code.map_or(1, char::len_utf8)
}
