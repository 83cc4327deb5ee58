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
