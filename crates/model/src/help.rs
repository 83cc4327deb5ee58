//! Help on the words of the model file: its sections, kinds and keys.

use crate::key_table::FILE;
use crate::keys::{Key, Kind, Need, Takes};

/// What there is to say of a word of the model file, the name of a section, of a kind of entry or of a key, in every place
/// where it stands; nothing for other words.
///
/// # Example
///
/// ```
/// let text = kempe_model::language::help("bore").unwrap();
/// assert!(text.contains("Diameter of the piston") && text.contains("[cylinders]"));
/// assert!(kempe_model::language::help("bor").is_none());
/// ```
pub fn help(word: &str) -> Option<String> {
    let mut diagnostics = Vec::new();
    visit_keys(&mut |path, kind, key| {
        if key.name == word {
            diagnostics.push(of_key(path, kind, key));
        }
    });
    let mut kinds: Vec<&Kind> = Vec::new();
    visit_keys(&mut |_, kind, _| {
        let named = kind.name == word || kind.what == word;
        if named && !kinds.iter().any(|known| std::ptr::eq(*known, kind)) {
            kinds.push(kind);
        }
    });
    diagnostics.extend(kinds.into_iter().map(of_kind));
    (!diagnostics.is_empty()).then(|| diagnostics.join("\n"))
}

/// Calls `f` with every key of the language, the section in which it stands and its kind of table.
pub fn visit_keys(f: &mut impl FnMut(&str, &'static Kind, &'static Key)) {
    for section in FILE.keys() {
        f("", &FILE, section);
        for kind in kinds_of(&section.takes) {
            visit_kind(section.name, kind, f);
        }
    }
}

fn visit_kind(
    section: &str,
    kind: &'static Kind,
    f: &mut impl FnMut(&str, &'static Kind, &'static Key),
) {
    for key in kind.keys().chain(kind.points) {
        f(section, kind, key);
        for inner in kinds_of(&key.takes) {
            visit_kind(section, inner, f);
        }
    }
}

/// The kinds of tables that a key takes.
fn kinds_of(takes: &Takes) -> Vec<&'static Kind> {
    match takes {
        Takes::Table(kind) | Takes::Amount(kind) => vec![kind],
        Takes::Entries(kinds) => kinds.to_vec(),
        Takes::Two(one) | Takes::List(one, _) | Takes::Values(one) => kinds_of(one),
        Takes::AnyOf(some) => some.iter().flat_map(kinds_of).collect(),
        _ => Vec::new(),
    }
}

fn of_key(section: &str, kind: &Kind, key: &Key) -> String {
    let place = match section {
        "" => format!("[{}]", key.name),
        _ if kind.what == kind.name => format!("`{}` in [{section}], {}", key.name, kind.what),
        _ => format!("`{}` in [{section}], {} {}", key.name, kind.what, kind.name),
    };
    let need = match key.need {
        Need::Required => "needed".to_owned(),
        Need::Optional => "may be left out".to_owned(),
        Need::OneOf => {
            let all = kind.keys().filter(|key| key.need == Need::OneOf);
            let all: Vec<&str> = all.map(|key| key.name).collect();
            format!("one of {}", all.join(", "))
        }
    };
    format!(
        "{place}\n    {}\n    {}; {need}\n    such as {} = {}\n",
        key.about,
        key.takes.in_words(),
        key.name,
        key.example
    )
}

fn of_kind(kind: &Kind) -> String {
    let keys: Vec<&str> = kind
        .points
        .iter()
        .chain(kind.keys())
        .map(|key| key.name)
        .collect();
    format!(
        "{} {}\n    {}\n    its keys: {}\n    such as {}\n",
        kind.what,
        kind.name,
        kind.about,
        keys.join(", "),
        kind.example
    )
}
