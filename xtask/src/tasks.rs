//! The tasks.

use crate::shell::{cargo, has};
use crate::{chromium, circles, fuzz, peers, slim, wasm};

/// Format, circles of files, lints, docs, tests, doctests, the slim library, the fuzz targets, the module for browsers. All steps run; the
/// failures are told at the end.
///
/// # Errors
///
/// The steps that failed.
pub fn test(fast: bool) -> Result<(), String> {
    let mut failed: Vec<String> = Vec::new();
    let mut step = |result: Result<(), String>| failed.extend(result.err());
    step(cargo(&["fmt", "--all", "--check"], &[]));
    step(circles::circles());
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
        step(slim::slim());
        step(fuzz::check());
    }
    step(chromium::ready());
    // Without it the same tests run, one file after the other.
    if has("nextest") {
        let nextest = [
            "nextest",
            "run",
            "--workspace",
            "--locked",
            "--no-fail-fast",
        ];
        step(cargo(&nextest, &[]));
        step(cargo(&["test", "--workspace", "--locked", "--doc"], &[]));
    } else {
        let test = ["test", "--workspace", "--locked", "--no-fail-fast"];
        step(cargo(&test, &[]));
    }
    if !fast {
        // The tests were built with the program.
        step(wasm::against_program());
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

/// All benchmarks, or those that are asked for as of `cargo bench`; peers stand beside all of them.
///
/// # Errors
///
/// What failed.
pub fn bench(rest: &[&str]) -> Result<(), String> {
    let mut arguments = vec!["bench", "--workspace", "--benches"];
    arguments.extend(rest);
    cargo(&arguments, &[])?;
    match rest.is_empty() {
        true => peers::beside(),
        false => Ok(()),
    }
}
