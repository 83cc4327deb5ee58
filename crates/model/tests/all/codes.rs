//! Every code that any crate writes into a diagnostic stands in the lists, with what it means, and no other does.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use kempe_model::{CODES, LATER_CODES};

/// What takes a code as its first argument.
const TAKERS: &[&str] = &[
    "Diagnostic::error(",
    "Diagnostic::warning(",
    "Issue::new(",
    "Problem::new(",
];

/// The sources of all crates, without the lists themselves.
fn sources() -> Vec<(PathBuf, String)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = std::fs::read_dir(crates).unwrap();
    let mut todo: Vec<PathBuf> = folders.map(|f| f.unwrap().path().join("src")).collect();
    let mut found = Vec::new();
    while let Some(path) = todo.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).unwrap();
            todo.extend(entries.map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|e| e == "rs")
            && !path.ends_with("model/src/codes.rs")
        {
            let text = std::fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

/// The string that a text begins with, after white space.
fn literal(text: &str) -> Option<&str> {
    let (word, _) = text.trim_start().strip_prefix('"')?.split_once('"')?;
    Some(word)
}

/// The codes that a source writes: first arguments, and what a method `code` answers.
fn written(text: &str) -> Vec<&str> {
    let first = TAKERS
        .iter()
        .flat_map(|taker| text.split(taker).skip(1).filter_map(literal));
    let answers = text.split("fn code(&self)").skip(1).flat_map(|rest| {
        let body = rest.split("\n    }").next().unwrap_or(rest);
        body.split("=>").skip(1).filter_map(literal)
    });
    first.chain(answers).collect()
}

fn listed() -> BTreeSet<&'static str> {
    let all = CODES.iter().chain(LATER_CODES);
    all.map(|code| code.code).collect()
}

#[test]
fn every_code_that_is_written_is_listed() {
    let (listed, sources) = (listed(), sources());
    let mut seen = BTreeSet::new();
    for (path, text) in &sources {
        for code in written(text) {
            assert!(
                listed.contains(code),
                "{}: `{code}` is in no list",
                path.display()
            );
            seen.insert(code);
        }
    }
    // Some go by other ways; most are seen here.
    assert!(seen.len() > 100, "only {} codes are seen", seen.len());
    let quoted = |code: &str| {
        let quoted = format!("\"{code}\"");
        sources.iter().any(|(_, text)| text.contains(&quoted))
    };
    let unused: Vec<_> = listed.iter().filter(|code| !quoted(code)).collect();
    assert!(unused.is_empty(), "nobody writes {unused:?}");
}

#[test]
fn codes_are_in_order_stand_once_and_mean_something() {
    for list in [CODES, LATER_CODES] {
        assert!(list.windows(2).all(|w| w[0].code < w[1].code));
        assert!(list.iter().all(|code| code.meaning.len() > 10));
    }
    assert_eq!(listed().len(), CODES.len() + LATER_CODES.len());
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "in no list of codes")]
fn a_diagnostic_with_an_unlisted_code_is_a_mistake_of_ours() {
    let _ = kempe_model::Diagnostic::error("no-such-code", "");
}
