//! One small wrong file for each code that comes once a model is read: `tests/bad/CODE.toml` begins with the command that tells it,
//! `# kempe run`. A code without a file has a reason.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use kempe_model::LATER_CODES;
use serde_json::Value;

/// What is told of the command line, or of files besides the model.
const COMMAND_LINE: &str = "no model file is wrong";
/// What is told to programs that build models, which the reader refuses with a code of its own.
const BUILT: &str = "the reader refuses a file with it by another code";
/// What is told to programs that hold a model.
const PROGRAM: &str = "only a program can ask for it";
/// What guards a computation: a small file that comes to it would be a mistake of ours.
const GUARD: &str = "no small file is known to come to it";

#[rustfmt::skip]
const WITHOUT: &[(&str, &[&str])] = &[
    (COMMAND_LINE, &[
        "bad-case", "bad-request", "cannot-draw", "cannot-write", "command-line", "crowded-picture", "file-exists", "folder-busy", "no-file", "not-written", "nothing-to-compare", "own-input",
        "no-parts", "part-damaged", "part-missing", "partial-result",         "stopped",
        "unknown-picture",
    ]),
    (BUILT, &[
        "bad-table", "contradictory-pressures", "cylinder-count", "damper-ends", "damper-idle", "friction-place",
        "friction-radius", "friction-teeth", "load-measure", "load-of-force", "load-on-nothing", "missing-supply", "motor-curve", "negative-damping",
        "negative-friction", "negative-mass", "negative-radius", "negative-stiffness", "oil-not-positive", "rod-too-thick", "scale", "spring-ends",
        "spring-idle", "stops-crossed",
    ]),
    (PROGRAM, &[
        "another-design", "no-time", "not-reached", "not-the-path", "settled-parameter", "wrong-length",
    ]),
    (GUARD, &[
        "assemblies-incomplete", "branches-entangled", "changes-too-fast", "circuit-open", "friction-at-rest", "friction-not-converged",
        "jammed", "not-balanced", "routes-differ", "rows-open",
    ]),
];

fn files() -> Vec<(String, PathBuf)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut files: Vec<(String, PathBuf)> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| {
            let name = path.file_stem().expect("a name").to_string_lossy();
            (name.split('.').next().unwrap_or("").to_owned(), path)
        })
        .collect();
    files.sort();
    files
}

/// The diagnostics anywhere in an answer.
fn diagnostics<'v>(value: &'v Value, found: &mut Vec<&'v Value>) {
    match value {
        Value::Object(entries) if entries.contains_key("severity") => found.push(value),
        Value::Object(entries) => entries.values().for_each(|v| diagnostics(v, found)),
        Value::Array(items) => items.iter().for_each(|v| diagnostics(v, found)),
        _ => {}
    }
}

#[test]
fn every_code_has_a_file_that_provokes_it_or_a_reason() {
    let files: BTreeSet<String> = files().into_iter().map(|(code, _)| code).collect();
    let mut reasons = BTreeMap::new();
    for (reason, codes) in WITHOUT {
        for code in *codes {
            assert!(
                reasons.insert((*code).to_owned(), *reason).is_none(),
                "{code} has two reasons"
            );
            assert!(
                !files.contains(*code),
                "{code} has a file and a reason: {reason}"
            );
        }
    }
    let answered: BTreeSet<String> = files.into_iter().chain(reasons.into_keys()).collect();
    let codes: BTreeSet<String> = LATER_CODES.iter().map(|c| c.code.to_owned()).collect();
    assert_eq!(answered, codes);
}

#[test]
fn every_file_is_told_its_code_with_a_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut helpless = Vec::new();
    for (code, path) in files() {
        let text = std::fs::read_to_string(&path).expect("a file");
        let command = text
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("# kempe "));
        let command = command.unwrap_or_else(|| panic!("{code}: no command"));
        let mut kempe = Command::new(env!("CARGO_BIN_EXE_kempe"));
        kempe.arg(command).arg(&path).arg("--json");
        if command == "run" {
            kempe.arg("--out").arg(folder.path().join(&code));
        }
        let output = kempe.output().expect("kempe runs");
        let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let mut found = Vec::new();
        diagnostics(&answer, &mut found);
        let told: Vec<&str> = found.iter().filter_map(|d| d["code"].as_str()).collect();
        assert!(told.contains(&code.as_str()), "{code}: told {told:?}");
        assert_ne!(output.status.code(), Some(0), "{code}: as if all were well");
        for d in found.iter().filter(|d| d["code"].as_str() == Some(&code)) {
            if d["help"].as_str().is_none_or(str::is_empty) {
                helpless.push(format!("{code}: {}", d["message"]));
            }
        }
    }
    assert!(helpless.is_empty(), "no remedy: {helpless:#?}");
}
