//! The core as a WebAssembly module: it imports nothing, and under node it gives the bytes of the native program.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{
    answers, apt_install, cargo, cargo_program, output, root, run, target_folder, told,
};

const TARGET: &str = "wasm32-unknown-unknown";

/// Model files in `examples/`: closed forms, Newton's method, a table, forces, a chosen counterweight, gears, what moves by itself.
const EXAMPLES: &[&str] = &[
    "seeds/crank-rocker.toml",
    "seeds/door-lock.toml",
    "seeds/luffing-crane.toml",
    "gallery/five-bar.toml",
    "gallery/balanced-four-bar.toml",
    "gallery/geared-five-bar.toml",
    "gallery/trebuchet.toml",
];

/// What builds for the browser here.
enum Builder {
    /// The workspace's own toolchain, to which rustup added the target.
    Rustup,
    /// Debian's packages: they hold the standard library as source only.
    Debian,
}

/// Programs of Debian's packages, which stand beside the workspace's own toolchain.
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
/// Where `rust-web-src` lays the standard library.
const DEBIAN_SOURCE: &str = "/usr/lib/rustlib/src/rust/library/std";
/// The linker of `lld-19`.
const DEBIAN_LINKER: &str = "wasm-ld-19";
const DEBIAN_PACKAGES: &[&str] = &["rustc-web", "cargo-web", "rust-web-src", "lld-19"];

/// Builds the module and the native program, and holds the module's answers against the program's.
///
/// # Errors
///
/// What is missing, did not build or differs.
pub fn wasm() -> Result<(), String> {
    cargo(&["build", "--locked", "--package", "kempe-cli"], &[])?;
    against_program()
}

/// Builds the module and holds its answers against those of the native program that stands there.
///
/// # Errors
///
/// What is missing, did not build or differs.
pub fn against_program() -> Result<(), String> {
    let missing = EXAMPLES.iter().filter(|example| !model(example).is_file());
    let missing: Vec<&str> = missing.copied().collect();
    if !missing.is_empty() {
        return Err(format!(
            "examples/ has no {}, which the module is held against: name another one in xtask/src/wasm.rs",
            missing.join(", ")
        ));
    }
    node()?;
    let module = build(&builder()?)?;
    let size = fs::metadata(&module).map_or(0, |m| m.len());
    println!("{} has {:.1} MB", module.display(), size as f64 * 1e-6);
    let results = target_folder().join("wasm-native");
    if results.exists() {
        fs::remove_dir_all(&results).map_err(|error| format!("{}: {error}", results.display()))?;
    }
    let differing: Vec<String> = EXAMPLES
        .iter()
        .filter_map(|example| compare(&module, example, &results).err())
        .collect();
    match differing.is_empty() {
        true => Ok(()),
        false => Err(differing.join("\n       ")),
    }
}

/// The file of an example.
fn model(example: &str) -> PathBuf {
    root().join("examples").join(example)
}

/// Asks the native program and the module the same.
fn compare(module: &Path, example: &str, results: &Path) -> Result<(), String> {
    let model = model(example);
    let native = results.join(example);
    let program = target_folder()
        .join("debug")
        .join(format!("kempe{}", std::env::consts::EXE_SUFFIX));
    let mut ran = Command::new(&program);
    ran.arg("run").arg(&model).arg("--out").arg(&native);
    told(ran.arg("--quiet"), &format!("kempe run {example}"))?;
    let mut checked = Command::new(&program);
    checked.arg("check").arg(&model).arg("--json");
    let report = told(&mut checked, &format!("kempe check {example}"))?;
    fs::write(native.join("check.json"), report).map_err(|error| error.to_string())?;
    let mut node = Command::new("node");
    node.arg(root().join("xtask/src/wasm.mjs"));
    node.arg(module).arg(&model).arg(&native);
    run(&mut node, &format!("node wasm.mjs {example}"))
}

/// The module, in the profile of the tests: quick to build, not small.
fn build(builder: &Builder) -> Result<PathBuf, String> {
    let mut folder = target_folder();
    let (program, name) = match builder {
        Builder::Rustup => (cargo_program(), "cargo"),
        Builder::Debian => {
            folder = folder.join("debian");
            (DEBIAN_CARGO.into(), DEBIAN_CARGO)
        }
    };
    let arguments = [
        "build",
        "--locked",
        "--package",
        "kempe-wasm",
        "--target",
        TARGET,
    ];
    let mut command = Command::new(program);
    command.args(arguments).arg("--target-dir").arg(&folder);
    if matches!(builder, Builder::Debian) {
        // `build-std` is what only an unstable compiler may do, or one that is told it may.
        command.args(["-Z", "build-std=std,panic_abort", "--ignore-rust-version"]);
        command
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTC", DEBIAN_RUSTC);
        command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", DEBIAN_LINKER);
    }
    run(&mut command, &format!("{name} {}", arguments.join(" ")))?;
    Ok(folder.join(TARGET).join("debug/kempe_wasm.wasm"))
}

/// What can build here, after installing what is missing.
fn builder() -> Result<Builder, String> {
    if has_target() {
        return Ok(Builder::Rustup);
    }
    if answers("rustup", &["--version"]) {
        let mut add = Command::new("rustup");
        add.args(["target", "add", TARGET]);
        if run(&mut add, &format!("rustup target add {TARGET}")).is_ok() && has_target() {
            return Ok(Builder::Rustup);
        }
    }
    if debian_can() || (apt_install(DEBIAN_PACKAGES).is_ok() && debian_can()) {
        return Ok(Builder::Debian);
    }
    Err(format!(
        "nothing here builds for {TARGET}. Install one of these and try again:\n       \
         rustup target add {TARGET}\n       \
         apt-get install {}   (Debian, as root)",
        DEBIAN_PACKAGES.join(" ")
    ))
}

/// Whether the workspace's own compiler has the target's standard library.
fn has_target() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let mut asked = Command::new(rustc);
    asked.args(["--print", "target-libdir", "--target", TARGET]);
    output(&mut asked, "rustc --print target-libdir").is_ok_and(|printed| {
        let folder = PathBuf::from(String::from_utf8_lossy(&printed).trim());
        fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some())
    })
}

/// Whether Debian's packages are there, and whether there is a source of the standard library to build.
fn debian_can() -> bool {
    Path::new(DEBIAN_SOURCE).exists()
        && answers(DEBIAN_CARGO, &["--version"])
        && answers(DEBIAN_RUSTC, &["--version"])
        && answers(DEBIAN_LINKER, &["--version"])
}

/// Node runs the module.
fn node() -> Result<(), String> {
    let there = || answers("node", &["--version"]);
    if there() || (apt_install(&["nodejs"]).is_ok() && there()) {
        return Ok(());
    }
    Err("node is missing, which runs the WebAssembly module: https://nodejs.org, or apt-get install nodejs".into())
}
