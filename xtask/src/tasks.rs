//! The tasks.

use std::fs;
use std::path::Path;

use crate::shell::{cargo, has, root};

/// Format, lints, docs, tests, doctests. All steps run; the first failure is told at the end.
///
/// # Errors
///
/// The steps that failed.
pub fn test(fast: bool) -> Result<(), String> {
    let mut failed: Vec<String> = Vec::new();
    let mut step = |result: Result<(), String>| failed.extend(result.err());
    step(cargo(&["fmt", "--all", "--check"], &[]));
    if !fast {
        let clippy = [
            "clippy",
            "--workspace",
            "--all-targets",
            "--locked",
            "--",
            "-D",
            "warnings",
        ];
        step(cargo(&clippy, &[]));
    }
    if nextest() {
        step(cargo(
            &[
                "nextest",
                "run",
                "--workspace",
                "--locked",
                "--no-fail-fast",
            ],
            &[],
        ));
        step(cargo(&["test", "--workspace", "--locked", "--doc"], &[]));
    } else {
        step(cargo(
            &["test", "--workspace", "--locked", "--no-fail-fast"],
            &[],
        ));
    }
    if !fast {
        let doc = ["doc", "--workspace", "--locked", "--no-deps"];
        step(cargo(&doc, &[("RUSTDOCFLAGS", "-D warnings")]));
    }
    println!();
    if failed.is_empty() {
        println!("all steps passed");
        Ok(())
    } else {
        Err(failed.join("\n       "))
    }
}

/// Whether cargo-nextest is there, after trying to install it.
fn nextest() -> bool {
    if has("nextest") {
        return true;
    }
    println!("cargo-nextest is not installed: installing it (once, a few minutes)");
    if cargo(&["install", "--locked", "cargo-nextest"], &[]).is_ok() && has("nextest") {
        return true;
    }
    println!(
        "it cannot be installed here: the tests run one file after the other with cargo test.\n\
              To have it: cargo install --locked cargo-nextest, or https://nexte.st"
    );
    false
}

/// All benchmarks.
///
/// # Errors
///
/// What failed.
pub fn bench(rest: &[&str]) -> Result<(), String> {
    let mut arguments = vec!["bench", "--workspace", "--benches"];
    arguments.extend(rest);
    cargo(&arguments, &[])
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
    let targets = targets(&root().join("fuzz/fuzz_targets"))?;
    let mut failed: Vec<String> = Vec::new();
    for target in targets {
        let run = [
            "+nightly",
            "fuzz",
            "run",
            target.as_str(),
            "--",
            limit.as_str(),
            "-rss_limit_mb=2048",
            "-timeout=10",
        ];
        failed.extend(plain_cargo(&run).err());
    }
    if failed.is_empty() {
        Ok(())
    } else {
        Err(failed.join("\n       "))
    }
}

/// Cargo by name, so that a toolchain may be named.
fn plain_cargo(arguments: &[&str]) -> Result<(), String> {
    let shown = format!("cargo {}", arguments.join(" "));
    println!("\n> {shown}");
    let status = std::process::Command::new("cargo")
        .args(arguments)
        .current_dir(root())
        .status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(format!("{shown} failed")),
        Err(error) => Err(format!("{shown}: {error}")),
    }
}

/// The names of the fuzz targets, sorted.
fn targets(folder: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    Ok(names)
}
