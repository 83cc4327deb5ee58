//! What the tests of the program share.
#![allow(dead_code)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A crank-rocker with one study, `turn`.
pub const MODEL: &str = include_str!("../cmd/run.in/four-bar.toml");

/// The list of what Kempe wrote, which every folder with results has.
pub const RECORD: &str = ".kempe-files.json";

/// A folder with the crank-rocker in `m.toml`.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.toml"), MODEL).expect("written");
    folder
}

/// The program, to be started in a folder.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kempe"));
    command.args(arguments).current_dir(folder);
    command
}

/// Runs the program in a folder.
pub fn kempe(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("kempe runs")
}

/// Starts the program in a folder, with pipes for what it says.
pub fn start(folder: &Path, arguments: &[&str]) -> Child {
    command(folder, arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("kempe runs")
}

/// What the program said on the error stream.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The names in a folder, without the list of what Kempe wrote.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|e| e.expect("an entry").file_name())
        .map(|name| name.into_string().expect("text"))
        .filter(|name| name != RECORD)
        .collect();
    names.sort();
    names
}

/// All files of a folder, by their names, with what they hold.
pub fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<String> = names(folder);
    all.retain(|name| fs::symlink_metadata(folder.join(name)).is_ok_and(|m| m.is_file()));
    let read = |name: String| {
        let bytes = fs::read(folder.join(&name)).expect("a file");
        (name, bytes)
    };
    all.into_iter().map(read).collect()
}

/// Waits for a child that must end soon; one that hangs is killed.
pub fn ends(mut child: Child, within: Duration) -> Output {
    let begun = Instant::now();
    while child.try_wait().expect("a state").is_none() {
        if begun.elapsed() > within {
            child.kill().expect("killed");
            panic!("it hangs");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().expect("it ended")
}

/// Sends a signal by its name, as in `TERM`.
#[cfg(unix)]
pub fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
}

/// The files that are expected, with what they hold, and no others.
pub fn same(found: &[(String, Vec<u8>)], wanted: &[(String, Vec<u8>)]) {
    let names = |all: &[(String, Vec<u8>)]| -> Vec<String> {
        all.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(found), names(wanted));
    for ((name, own), (_, other)) in found.iter().zip(wanted) {
        assert!(own == other, "{name} differs");
    }
}

/// Numbers that look random and are the same each time (Knuth's linear congruences).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self, below: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % below
    }
}

/// Starts the same run again and again, with results in `out`, and kills it a moment after it has so many parts more; how many there are in the end.
pub fn killed(
    at: &Path,
    run: &[&str],
    times: usize,
    parts: impl Fn() -> usize,
    mut more: impl FnMut(&mut Dice) -> usize,
    dice: &mut Dice,
) -> usize {
    let mut kept = 0;
    for _ in 0..times {
        let mut child = start(at, run);
        let wanted = kept + more(dice);
        while parts() < wanted && child.try_wait().expect("a state").is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(dice.roll(40)));
        child.kill().expect("killed");
        child.wait().expect("it ended");
        let now = parts();
        // Where it came to its end, it starts anew.
        let ended = at.join("out/report.html").exists();
        assert!(now >= kept || ended, "parts are lost");
        kept = now;
    }
    kept
}
