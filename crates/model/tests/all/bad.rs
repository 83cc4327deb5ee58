//! One small wrong file for each code: `tests/bad/CODE.toml` holds the expected places in comments, `# error: LINE:COL code`, and
//! the snapshot beside it the whole text; `CODE.ABOUT.toml` shows more of the same code. `INSTA_UPDATE=always` rewrites the snapshots; the comments are written by hand.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use kempe_model::{CODES, Diagnostic, Model, Severity};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad")
}

fn names() -> Vec<String> {
    let files = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let mut names: Vec<String> = files
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    names
}

fn read(name: &str) -> (Vec<Diagnostic>, String) {
    let bytes = std::fs::read(folder().join(format!("{name}.toml"))).unwrap();
    let mut files = |file: &str| {
        std::fs::read_to_string(folder().join(file)).map_err(|_| "no such file".to_owned())
    };
    let found = match Model::from_bytes(&bytes, name, &mut files, &[]) {
        Ok(checked) => checked.warnings,
        Err(found) => found,
    };
    (found, String::from_utf8_lossy(&bytes).into_owned())
}

/// `error: LINE:COL code` of each diagnostic.
fn places(found: &[Diagnostic], text: &str) -> Vec<String> {
    let place = |d: &Diagnostic| {
        let severity = if d.severity == Severity::Error {
            "error"
        } else {
            "warning"
        };
        let plain = d.render_plain("", text);
        let place = plain
            .lines()
            .nth(1)
            .and_then(|line| line.split_once("┌ :"))
            .map_or("-", |(_, place)| place);
        format!("{severity}: {place} {}", d.code)
    };
    found.iter().map(place).collect()
}

#[test]
fn every_wrong_file_says_what_is_wrong() {
    let mut wrong = String::new();
    for name in names() {
        let (found, text) = read(&name);
        let expected: Vec<String> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# "))
            .filter(|line| line.starts_with("error: ") || line.starts_with("warning: "))
            .map(str::to_owned)
            .collect();
        let found_places = places(&found, &text);
        if expected != found_places {
            wrong += &format!("{name}.toml: expected {expected:#?}, found {found_places:#?}\n");
        }
        let rendered: String = found
            .iter()
            .map(|d| d.render_plain(&format!("{name}.toml"), &text) + "\n")
            .collect();
        insta::with_settings!({ snapshot_path => "../bad", prepend_module_to_snapshot => false, omit_expression => true }, {
            insta::assert_snapshot!(name.as_str(), rendered);
        });
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_code_has_its_file() {
    let codes: BTreeSet<String> = CODES.iter().map(|c| c.code.to_owned()).collect();
    let code = |name: &str| name.split('.').next().unwrap_or("").to_owned();
    let files: BTreeSet<String> = names().iter().map(|name| code(name)).collect();
    assert_eq!(codes, files);
    for name in names() {
        let (found, _) = read(&name);
        assert!(
            found.iter().any(|d| d.code == code(&name)),
            "{name}.toml does not give its code"
        );
        for d in &found {
            assert!(
                codes.contains(d.code),
                "{} is not in the list of codes",
                d.code
            );
            assert!(
                d.help.is_some() && !d.labels.is_empty() || d.code == "not-utf8",
                "{d:?} helps nobody"
            );
        }
    }
}
