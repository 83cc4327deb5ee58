//! Puts the validation cases and the example models into the program, so that `kempe verify` runs anywhere.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default()).join("../..");
    let mut list =
        String::from("/// Files that came with the program, by their path in the repository.\n");
    list.push_str("const EMBEDDED: &[(&str, &str)] = &[\n");
    for folder in [
        "examples/benchmarks",
        "examples/gallery",
        "examples/seeds",
        "validation",
        "validation/models",
    ] {
        println!("cargo::rerun-if-changed={}", root.join(folder).display());
        for file in files(&root.join(folder)) {
            let name = file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            list.push_str(&format!(
                "    ({:?}, include_str!({:?})),\n",
                format!("{folder}/{name}"),
                file
            ));
        }
    }
    list.push_str("];\n");
    let out = PathBuf::from(std::env::var("OUT_DIR").unwrap_or_default()).join("embedded.rs");
    if let Err(error) = fs::write(&out, list) {
        println!("cargo::error={} cannot be written: {error}", out.display());
    }
}

/// Models and tables in a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let wanted = |p: &PathBuf| p.extension().is_some_and(|e| e == "toml" || e == "csv");
    let mut files: Vec<PathBuf> = entries
        .filter_map(|e| Some(e.ok()?.path()))
        .filter(wanted)
        .collect();
    files.sort();
    files
}
