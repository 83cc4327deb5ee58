//! Fuzz targets: a workspace of their own, held to compile, seeded with the examples.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{cargo, has, root, run};

/// Every target passes the lints on the stable toolchain.
///
/// # Errors
///
/// What failed.
pub fn check() -> Result<(), String> {
    // The versions of the workspace, so that nothing is built or held twice.
    let lock = root().join("fuzz/Cargo.lock");
    fs::copy(root().join("Cargo.lock"), &lock)
        .map_err(|error| format!("{}: {error}", lock.display()))?;
    let clippy = [
        "clippy",
        "--manifest-path",
        "fuzz/Cargo.toml",
        "--target-dir",
        "target/fuzz",
        // Nothing is linked here, so the fuzzing engine need not be compiled.
        "--no-default-features",
        "--",
        "-D",
        "warnings",
    ];
    cargo(&clippy, &[])
}

/// Every fuzz target for so many seconds.
///
/// # Errors
///
/// What failed, or what is missing.
pub fn fuzz(seconds: u32) -> Result<(), String> {
    if !has("fuzz") {
        return Err("cargo-fuzz is missing: rustup toolchain install nightly && cargo install --locked cargo-fuzz".into());
    }
    let limit = format!("-max_total_time={seconds}");
    let folder = root().join("fuzz");
    let mut failed: Vec<String> = Vec::new();
    for target in targets(&folder.join("fuzz_targets"))? {
        seed(&target, &folder.join("corpus").join(&target))?;
        let arguments = [
            "+nightly",
            "fuzz",
            "run",
            target.as_str(),
            "--",
            limit.as_str(),
            "-rss_limit_mb=2048",
            "-timeout=30",
        ];
        // By name, not the cargo that runs this: a toolchain is named.
        let mut command = Command::new("cargo");
        failed.extend(
            run(
                command.args(arguments),
                &format!("cargo {}", arguments.join(" ")),
            )
            .err(),
        );
    }
    if failed.is_empty() {
        Ok(())
    } else {
        Err(failed.join("\n       "))
    }
}

/// Puts the examples into a target's corpus; of expressions, what stands in quotes there.
fn seed(target: &str, corpus: &Path) -> Result<(), String> {
    let told = |error: std::io::Error| format!("{}: {error}", corpus.display());
    fs::create_dir_all(corpus).map_err(told)?;
    for model in models()? {
        let text = fs::read_to_string(&model).map_err(told)?;
        let stem = model.file_stem().unwrap_or_default().to_string_lossy();
        let parts: Vec<&str> = match target {
            "expression" => text.split('"').skip(1).step_by(2).collect(),
            _ => vec![&text],
        };
        for (index, part) in parts.iter().enumerate() {
            fs::write(corpus.join(format!("{stem}-{index}")), part).map_err(told)?;
        }
    }
    Ok(())
}

/// The example files, sorted.
fn models() -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    for folder in ["seeds", "gallery"] {
        found.extend(files(&root().join("examples").join(folder), "toml")?);
    }
    Ok(found)
}

/// The names of the fuzz targets, sorted.
fn targets(folder: &Path) -> Result<Vec<String>, String> {
    let files = files(folder, "rs")?;
    let names = files.iter().filter_map(|path| path.file_stem());
    Ok(names
        .map(|name| name.to_string_lossy().into_owned())
        .collect())
}

/// The files of a folder with one extension, sorted.
fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    paths.sort();
    Ok(paths)
}
