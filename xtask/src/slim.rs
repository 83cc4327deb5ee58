//! The library without default features is slim: no writer of Parquet, no rasteriser, no font, no calendar.

use std::process::Command;

use crate::shell::{cargo, cargo_program, output};

/// Crates that only default features may bring in, each with the feature it belongs to.
const RICH: &[(&str, &str)] = &[
    ("parquet", "parquet"),
    ("chrono", "parquet"),
    ("tiny-skia", "raster"),
    ("png", "raster"),
    ("gif", "raster"),
    ("ttf-parser", "raster"),
    ("miniz_oxide", "raster"),
    ("dejavu", "raster"),
];

/// The crates that have features.
const WITH_FEATURES: &[&str] = &["kempe-draw", "kempe-study", "kempe"];

/// The crates with features pass the lints without any, tests included, and the library's dependencies are few.
///
/// # Errors
///
/// What does not build, or a dependency that should not be there.
pub fn slim() -> Result<(), String> {
    let full = dependencies(&[])?;
    let slim = dependencies(&["--no-default-features"])?;
    for (name, feature) in RICH {
        // A name that the whole library does not have either would hold nothing.
        if !full.iter().any(|found| found == name) {
            return Err(format!(
                "kempe no longer depends on {name} through its feature `{feature}`: take it from the list in xtask"
            ));
        }
        if slim.iter().any(|found| found == name) {
            return Err(format!(
                "kempe without default features depends on {name}, which belongs to its feature `{feature}`"
            ));
        }
    }
    println!(
        "kempe depends on {} crates, without default features on {}",
        full.len(),
        slim.len()
    );
    let mut clippy = vec![
        "clippy",
        "--locked",
        "--no-default-features",
        "--all-targets",
    ];
    for name in WITH_FEATURES {
        clippy.extend(["--package", name]);
    }
    clippy.extend(["--", "-D", "warnings"]);
    cargo(&clippy, &[])
}

/// The names of all crates that the library is built of.
fn dependencies(features: &[&str]) -> Result<Vec<String>, String> {
    let mut tree = Command::new(cargo_program());
    tree.args([
        "tree",
        "--locked",
        "--package",
        "kempe",
        "--edges",
        "normal,build",
    ]);
    tree.args(["--prefix", "none", "--format", "{p}"])
        .args(features);
    let shown = format!("cargo tree --package kempe {}", features.join(" "));
    let printed = output(&mut tree, shown.trim_end())?;
    let text = String::from_utf8_lossy(&printed);
    let mut names: Vec<String> = text
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .map(str::to_owned)
        .collect();
    names.sort();
    names.dedup();
    Ok(names)
}
