//! The examples and what is near to them: whatever a text asks for, its check and its studies end, and their answers are sound.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use crate::bounded::{Reached, check_and_run};
use crate::mutation::{Chance, vary};

/// Words of progress that a check or a study may take.
const WORK: usize = 300;
const MUTANTS: usize = 400;

/// The examples with the tables they name, in order.
fn examples() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = ["seeds", "gallery"].map(|f| std::fs::read_dir(root.join(f)).unwrap());
    let files = folders.into_iter().flatten().map(|e| e.unwrap().path());
    let models = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let mut found: Vec<(String, String)> = models
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.to_str().unwrap().to_owned(), text)
        })
        .collect();
    found.sort();
    found
}

fn tried(path: &str, text: &str) -> Reached {
    let folder = Path::new(path).parent().unwrap();
    let mut files =
        |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        check_and_run(text.as_bytes(), &mut files, WORK)
    })) {
        Ok(reached) => reached,
        Err(_) => panic!("{path} varied:\n{text}"),
    }
}

#[test]
fn checks_and_studies_of_mutants_end_and_explain_themselves() {
    let examples = examples();
    let mut chance = Chance::new();
    let (mut read, mut tables, mut rows) = (0, 0, 0);
    for round in 0..MUTANTS {
        let (path, text) = &examples[round % examples.len()];
        let reached = tried(path, &vary(text, &mut chance));
        read += usize::from(reached.read);
        tables += reached.tables;
        rows += reached.rows;
    }
    println!("{read} read, {tables} tables, {rows} rows");
    assert!(read > MUTANTS / 3 && tables > MUTANTS / 5 && rows > 10 * MUTANTS);
}
