//! The examples people start from: each reads without an error, and is valid by its shape.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use kempe_model::Model;

fn examples() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = ["gallery", "seeds"].map(|f| root.join(f));
    let files = folders
        .iter()
        .filter_map(|f| std::fs::read_dir(f).ok())
        .flatten();
    let mut files: Vec<PathBuf> = files
        .map(|entry| entry.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn every_example_reads() {
    assert!(examples().len() > 30, "the examples are there");
    let mut wrong = String::new();
    for path in examples() {
        let text = std::fs::read_to_string(&path).unwrap();
        let folder = path.parent().unwrap();
        let mut files =
            |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let name = path.file_name().unwrap().to_str().unwrap();
        match Model::from_toml(&text, name, &mut files) {
            Ok(checked) => {
                for d in checked
                    .warnings
                    .iter()
                    .filter(|d| !d.code.ends_with("not-available"))
                {
                    wrong += &d.render_plain(name, &text);
                }
            }
            Err(found) => wrong.extend(found.iter().map(|d| d.render_plain(name, &text))),
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A measure asked of a model that is read already means what it means in the file.
#[test]
fn every_measure_of_the_examples_is_read_alone_as_in_its_file() {
    let mut compared = 0;
    for path in examples() {
        let text = std::fs::read_to_string(&path).unwrap();
        let folder = path.parent().unwrap();
        let mut files =
            |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let model = Model::from_toml(&text, "", &mut files).unwrap().model;
        for named in &model.measures {
            let rest = &text[named.span.end..];
            let (_, value) = rest.split_once('=').unwrap();
            let quote = match value.trim_start().starts_with("\"\"\"") {
                true => "\"\"\"",
                false => "\"",
            };
            // In several lines a backslash joins them.
            let written = value.split(quote).nth(1).unwrap().replace("\\\n", "");
            let written = written.trim_start();
            let alone = model.measure(written).unwrap();
            assert_eq!(
                alone.measure,
                named.measure,
                "{}: {written}",
                path.display()
            );
            assert_eq!(
                (alone.dimension, alone.needs_forces),
                (named.dimension, named.needs_forces)
            );
            let by_name = model.measure(&named.name).unwrap();
            assert_eq!(
                (by_name.dimension, by_name.needs_forces),
                (named.dimension, named.needs_forces)
            );
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared}");
}

#[test]
fn a_measure_that_does_not_fit_the_model_is_told_in_its_own_text() {
    let file = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n";
    let model = Model::from_toml(file, "", &mut |_| Err(String::new()))
        .unwrap()
        .model;
    let diagnostic = model.measure("2 * x(C)").unwrap_err();
    assert_eq!(diagnostic[0].code, "unknown-name");
    let label = &diagnostic[0].labels[0];
    let source = label.source.as_ref().unwrap();
    assert_eq!(&source.text[label.span.clone()], "C");
}
