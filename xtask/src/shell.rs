//! Running programs and telling how long they took.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

/// The root of the repository.
pub fn root() -> PathBuf {
    let own = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    own.parent()
        .map_or(own.clone(), std::borrow::ToOwned::to_owned)
}

/// The folder that cargo builds in.
pub fn target_folder() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| root().join("target"), |dir| root().join(dir))
}

/// The cargo that runs this.
pub fn cargo_program() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Runs cargo in the root of the repository.
///
/// # Errors
///
/// What failed, in one line.
pub fn cargo(arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    let mut command = Command::new(cargo_program());
    command.args(arguments);
    command.envs(variables.iter().copied());
    run(&mut command, &format!("cargo {}", arguments.join(" ")))
}

/// Runs a program in the root of the repository and shows it as `shown`.
///
/// # Errors
///
/// What failed, in one line.
pub fn run(command: &mut Command, shown: &str) -> Result<(), String> {
    println!("\n> {shown}");
    let start = Instant::now();
    let status = command
        .current_dir(root())
        .status()
        .map_err(|error| format!("{shown}: {error}"))?;
    println!("> {shown}: {:.0} s", start.elapsed().as_secs_f64());
    if status.success() {
        Ok(())
    } else {
        Err(format!("{shown} failed"))
    }
}

/// What a program prints on its standard output, run in the root of the repository.
///
/// # Errors
///
/// What failed, in one line.
pub fn output(command: &mut Command, shown: &str) -> Result<Vec<u8>, String> {
    ended(command, shown, &[0])
}

/// As [`output`], of `kempe`, which ends with 1 where it warns of something.
///
/// # Errors
///
/// What failed, in one line.
pub fn told(command: &mut Command, shown: &str) -> Result<Vec<u8>, String> {
    ended(command, shown, &[0, 1])
}

fn ended(command: &mut Command, shown: &str, codes: &[i32]) -> Result<Vec<u8>, String> {
    let output = command
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("{shown}: {error}"))?;
    match output
        .status
        .code()
        .is_some_and(|code| codes.contains(&code))
    {
        true => Ok(output.stdout),
        false => Err(format!("{shown} failed")),
    }
}

/// Whether a program is there and answers `--version`.
pub fn answers(program: &str, arguments: &[&str]) -> bool {
    Command::new(program)
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Whether a cargo subcommand is there.
pub fn has(subcommand: &str) -> bool {
    answers(
        &cargo_program().to_string_lossy(),
        &[subcommand, "--version"],
    )
}

/// Installs Debian packages where that is possible: as root, with apt.
///
/// # Errors
///
/// What failed, in one line.
pub fn apt_install(packages: &[&str]) -> Result<(), String> {
    if !answers("apt-get", &["--version"]) {
        return Err("there is no apt-get".into());
    }
    let apt = |arguments: &[&str]| {
        let mut command = Command::new("apt-get");
        command
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive");
        run(&mut command, &format!("apt-get {}", arguments.join(" ")))
    };
    apt(&["update"])?;
    let mut install = vec!["install", "--yes", "--no-install-recommends"];
    install.extend(packages);
    apt(&install)
}
