//! One cause, one message: what follows from a mistake that is told is not told besides.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use kempe_model::{Diagnostic, Model, Severity};

fn read(text: &str) -> Vec<Diagnostic> {
    let table = "t,angle,p,force,x,y\n0,0,0,0,0,0\n1,2,1,1,1,1\n";
    match Model::from_toml(text, "broken", &mut |_| Ok(table.to_owned())) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    }
}

fn errors(text: &str) -> Vec<Diagnostic> {
    let found = read(text).into_iter();
    found.filter(|d| d.severity == Severity::Error).collect()
}

/// Model files that read without an error.
fn sound_files() -> Vec<(String, String)> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders: Vec<PathBuf> = vec![here.join("tests/good"), here.join("../../examples")];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        entries.sort();
        for path in entries {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                if errors(&text).is_empty() {
                    found.push((path.display().to_string(), text));
                }
            }
        }
    }
    assert!(found.len() > 10);
    found
}

/// The line of a byte.
fn line_of(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    text[start..].lines().next().unwrap_or("")
}

#[test]
fn a_sign_that_is_missing_is_one_mistake() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for (name, text) in sound_files() {
        let signs = text.match_indices(|c| "[]{}\"=".contains(c));
        for (at, sign) in signs {
            let line = line_of(&text, at);
            if line.trim_start().starts_with('#') || line.contains("\"\"\"") {
                continue;
            }
            let mut broken = text.clone();
            broken.replace_range(at..at + 1, "");
            let found = errors(&broken);
            if !found.iter().any(|d| d.code == "toml-syntax") {
                continue;
            }
            tried += 1;
            if found.len() > 1 || found[0].code != "toml-syntax" {
                wrong.push(told(
                    &format!("{name}: without `{sign}` of {line}"),
                    &found,
                    &broken,
                ));
            }
        }
    }
    none(&wrong, tried);
}

fn told(what: &str, found: &[Diagnostic], text: &str) -> String {
    let texts: Vec<String> = found.iter().map(|d| d.render_plain("", text)).collect();
    format!("{what}\n{}", texts.concat())
}

fn none(wrong: &[String], tried: usize) {
    assert!(tried > 20);
    assert!(
        wrong.is_empty(),
        "{} of {tried}\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// The text with another word in the place of one, wherever it stands whole.
fn with_word(text: &str, word: &str, other: &str) -> String {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(word) {
        let whole = !rest[..at].ends_with(is_name) && !rest[at + word.len()..].starts_with(is_name);
        out += &rest[..at];
        out += if whole { other } else { word };
        rest = &rest[at + word.len()..];
    }
    out + rest
}

#[test]
fn a_parameter_with_a_capital_letter_is_one_mistake() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for (name, text) in sound_files() {
        let Ok(checked) = Model::from_toml(&text, "", &mut |_| Err(String::new())) else {
            continue;
        };
        for parameter in checked.model.parameters.iter().map(|p| &p.name) {
            // a key of the language stays one
            let keys = ["radius", "ground", "step"].contains(&parameter.as_str());
            for other in ["L9", "l-9"].into_iter().filter(|_| !keys) {
                let broken = with_word(&text, parameter, other);
                let found = errors(&broken);
                tried += 1;
                if found.len() != 1 || !["bad-name", "toml-syntax"].contains(&found[0].code) {
                    wrong.push(told(
                        &format!("{name}: {parameter} as {other}"),
                        &found,
                        &broken,
                    ));
                }
            }
        }
    }
    none(&wrong, tried);
}

#[test]
fn a_misspelt_section_is_one_mistake() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for (name, text) in sound_files() {
        let headers = text.match_indices("\n[").map(|(at, _)| at + 2);
        for at in headers.chain(text.starts_with('[').then_some(1)) {
            // two letters change places
            let mut broken = text.clone();
            let swapped: String = [&text[at + 2..at + 3], &text[at + 1..at + 2]].concat();
            broken.replace_range(at + 1..at + 3, &swapped);
            if broken == text || text[at + 1..at + 3].contains(|c: char| !c.is_alphabetic()) {
                continue;
            }
            let found = errors(&broken);
            tried += 1;
            if found.len() != 1 || found[0].code != "unknown-key" {
                wrong.push(told(
                    &format!("{name}: {}", line_of(&broken, at)),
                    &found,
                    &broken,
                ));
            }
        }
    }
    none(&wrong, tried);
}

#[test]
fn a_misspelt_key_is_one_mistake() {
    let keys = [
        "turns",
        "slides",
        "stiffness",
        "damping",
        "between",
        "force",
        "torque",
        "coefficient",
        "curve",
        "kind",
        "table",
    ];
    let (mut tried, mut wrong) = (0, Vec::new());
    for (name, text) in sound_files() {
        for key in keys {
            for (at, _) in text.match_indices(&format!("{key} = ")) {
                let line = line_of(&text, at);
                if line.trim_start().starts_with('#')
                    || text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_')
                {
                    continue;
                }
                let mut broken = text.clone();
                broken.insert(at + 2, 'x');
                let found = errors(&broken);
                tried += 1;
                if found.len() != 1 || !["unknown-key", "missing-key"].contains(&found[0].code) {
                    wrong.push(told(
                        &format!("{name}: {}", line_of(&broken, at)),
                        &found,
                        &broken,
                    ));
                }
            }
        }
    }
    none(&wrong, tried);
}

#[test]
fn a_file_without_a_frame_is_one_mistake() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for (name, text) in sound_files() {
        for other in ["fraem", "ground", "wall"] {
            let broken: String = text
                .lines()
                .map(
                    |line| match line.trim_start().starts_with("frame") && line.contains('=') {
                        true => line.replacen("frame", other, 1) + "\n",
                        false => line.replace("[links.frame]", &format!("[links.{other}]")) + "\n",
                    },
                )
                .collect();
            // what asks for linkages alone needs none
            if broken == text {
                continue;
            }
            let found = errors(&broken);
            tried += 1;
            if found.len() != 1 || found[0].code != "no-frame" {
                wrong.push(told(&format!("{name}: {other}"), &found, &broken));
            }
        }
    }
    none(&wrong, tried);
}
