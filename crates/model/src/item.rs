//! Values of the language as they are written, and whole files made of them.

/// A value of a model file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    Number(f64),
    Text(String),
    Flag(bool),
    List(Vec<Item>),
    /// Between braces.
    Table(Vec<(String, Item)>),
}

impl Item {
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// As TOML, on one line unless a list holds tables.
    pub fn write(&self, out: &mut String) {
        match self {
            Self::Number(x) => out.push_str(&number(*x)),
            Self::Text(text) => out.push_str(&quoted(text)),
            Self::Flag(flag) => out.push_str(if *flag { "true" } else { "false" }),
            Self::List(items) => {
                let lines = items.len() > 1 && items.iter().all(|i| matches!(i, Self::Table(_)));
                let separator = if lines { "\n    " } else { " " };
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    match (i, lines) {
                        (0, false) => {}
                        (0, true) => out.push_str(separator),
                        _ => {
                            out.push(',');
                            out.push_str(separator);
                        }
                    }
                    item.write(out);
                }
                out.push_str(if lines { "\n]" } else { "]" });
            }
            Self::Table(entries) if entries.is_empty() => out.push_str("{}"),
            Self::Table(entries) => {
                out.push_str("{ ");
                for (i, (name, item)) in entries.iter().enumerate() {
                    if i > 0 {
                        out.push_str(", ");
                    }
                    out.push_str(&key(name));
                    out.push_str(" = ");
                    item.write(out);
                }
                out.push_str(" }");
            }
        }
    }
}

/// A file: values before all sections, and the sections with their entries.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct File {
    pub head: Vec<(String, Item)>,
    pub sections: Vec<(String, Vec<(String, Item)>)>,
}

impl File {
    /// The section of a name, made when it is not there.
    pub fn section(&mut self, name: &str) -> &mut Vec<(String, Item)> {
        let at = match self.sections.iter().position(|(known, _)| known == name) {
            Some(at) => at,
            None => {
                self.sections.push((name.to_owned(), Vec::new()));
                self.sections.len() - 1
            }
        };
        &mut self.sections[at].1
    }

    /// The file as TOML: sections with entries only, studies each under a header of its own.
    pub fn to_toml(&self) -> String {
        let mut out = String::new();
        let line = |out: &mut String, name: &str, item: &Item| {
            out.push_str(&key(name));
            out.push_str(" = ");
            item.write(out);
            out.push('\n');
        };
        for (name, item) in &self.head {
            line(&mut out, name, item);
        }
        for (section, entries) in self.sections.iter().filter(|(_, e)| !e.is_empty()) {
            let headed = |item: &Item| section == "studies" && matches!(item, Item::Table(_));
            if entries.iter().any(|(_, item)| !headed(item)) {
                out.push_str(&format!("\n[{section}]\n"));
            }
            for (name, item) in entries.iter().filter(|(_, item)| !headed(item)) {
                line(&mut out, name, item);
            }
            for (name, item) in entries.iter().filter(|(_, item)| headed(item)) {
                out.push_str(&format!("\n[{section}.{}]\n", key(name)));
                if let Item::Table(entries) = item {
                    for (name, item) in entries {
                        line(&mut out, name, item);
                    }
                }
            }
        }
        out.trim_start().to_owned()
    }
}

/// A number with the fewest digits that read back as it; those that are not finite are TOML's.
pub(crate) fn number(x: f64) -> String {
    match (x.is_nan(), x.is_infinite()) {
        (true, _) => "nan".to_owned(),
        (_, true) => if x > 0.0 { "inf" } else { "-inf" }.to_owned(),
        // a whole number has no sign of its own at zero
        _ if x == 0.0 && x.is_sign_negative() => "-0.0".to_owned(),
        _ => {
            let text = format!("{x:?}");
            text.strip_suffix(".0").unwrap_or(&text).to_owned()
        }
    }
}

/// A key, in quotes where it needs them.
pub(crate) fn key(name: &str) -> String {
    match is_bare(name) {
        true => name.to_owned(),
        false => quoted(name),
    }
}

/// Whether a key needs no quotes.
pub(crate) fn is_bare(name: &str) -> bool {
    !name.is_empty()
        && name
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A string on one line.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for x in [
            0.0,
            -0.0,
            20.0,
            -0.5,
            1e300,
            5e-324,
            1e16,
            123_456_789_012_345_680.0,
        ] {
            let text = format!("x = {}", number(x));
            let read: toml::Table = toml::from_str(&text).unwrap();
            let read = match &read["x"] {
                toml::Value::Integer(i) => *i as f64,
                other => other.as_float().unwrap(),
            };
            assert_eq!(read.to_bits(), x.to_bits(), "{text}");
        }
        for name in ["", "a b", "é", "A-B", "\"\\\n\u{7f}\u{1}"] {
            let text = format!("{} = {}", key(name), quoted(name));
            let read: toml::Table = toml::from_str(&text).unwrap();
            assert_eq!(read[name].as_str(), Some(name), "{text}");
        }
    }
}
