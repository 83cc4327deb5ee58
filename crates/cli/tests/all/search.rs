//! Optimisations that are killed, stopped and gone on with: the very bytes of an undisturbed run.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::support::{
    Dice, RECORD, contents, ends, folder, kempe, killed, names, said, same, signal, start,
};

/// A search whose every design takes a while, so that it can be killed on its way: a crank-rocker whose largest angular acceleration is to be small.
const MODEL: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\nc = \"40 mm\"\n[links]\n\
    frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = \"b\" }\nrocker = { D-C = \"c\" }\n[drives]\n\
    motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> D\"\n[measures]\n\
    swing = \"range(angle(rocker))\"\npeak = \"max(abs(rate(rate(angle(rocker)))))\"\n[studies.turn]\nkind = \"motion\"\nstep = 10\n\
    [studies.best]\nkind = \"optimize\"\nover = \"turn\"\nminimize = \"peak\"\nsubject_to = [\"swing >= 50 deg\", \"transmission_angle(C) >= 35 deg\"]\n\
    vary = { a = [10, 30], b = [45, 65], c = [30, 50] }\nmethod = \"METHOD\"\n";

const RUN: [&str; 5] = ["run", "m.toml", "best", "--out", "out"];

fn place(method: &str) -> tempfile::TempDir {
    let folder = folder();
    let model = MODEL.replace("METHOD", method);
    fs::write(folder.path().join("m.toml"), model).expect("written");
    folder
}

/// All files of a folder that a run has written whole, and those of the designs.
fn whole(at: &Path) -> Vec<(String, Vec<u8>)> {
    assert!(!at.join("best.parts").exists(), "parts are left");
    let mut all = contents(at);
    all.extend(contents(&at.join("best")));
    all.push((
        RECORD.to_owned(),
        fs::read(at.join(RECORD)).expect("a list"),
    ));
    all
}

/// How many parts of a search there are.
fn parts(at: &Path) -> usize {
    let folder = at.join("out/best.parts");
    match folder.exists() {
        true => names(&folder)
            .iter()
            .filter(|name| !name.starts_with('.'))
            .count(),
        false => 0,
    }
}

#[test]
fn a_search_that_is_killed_at_any_moment_goes_on_to_the_same_bytes() {
    let mut dice = Dice(20_261_125);
    let mut resumed = 0;
    for method in ["multi-start", "differential evolution"] {
        let folder = place(method);
        let at = folder.path();
        let output = kempe(at, &["run", "m.toml", "best", "--out", "whole"]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let wanted = whole(&at.join("whole"));
        assert!(wanted.iter().any(|(name, _)| name == "01.toml"));
        for _ in 0..2 {
            let more = |dice: &mut Dice| 1 + dice.roll(4) as usize;
            let kept = killed(at, &RUN, 3, || parts(at), more, &mut dice);
            let output = kempe(at, &RUN);
            assert_eq!(output.status.code(), Some(0), "{}", said(&output));
            if kept > 0 {
                resumed += 1;
                let words = "best: resuming, ";
                assert!(said(&output).contains(words), "{}", said(&output));
                assert!(said(&output).contains("of the search"), "{}", said(&output));
            }
            same(&whole(&at.join("out")), &wanted);
            fs::remove_dir_all(at.join("out")).expect("removed");
        }
    }
    assert!(resumed > 1, "{resumed}");
}

#[test]
fn what_is_to_be_resumed_must_be_there() {
    let folder = place("multi-start");
    let at = folder.path();
    let asked = [&RUN[..], &["--resume"]].concat();
    let output = kempe(at, &asked);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let told = said(&output);
    assert!(told.contains("nothing to resume in out"), "{told}");
    assert!(!at.join("out").exists(), "something was begun");
    let mut child = start(at, &RUN);
    while parts(at) < 2 && child.try_wait().expect("a state").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("killed");
    child.wait().expect("it ended");
    assert!(parts(at) > 0, "it ended too soon");
    // Of other values none of these fits.
    let output = kempe(at, &[&asked[..], &["--set", "c=41 mm"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let told = said(&output);
    assert!(told.contains("of other values of parameters"), "{told}");
    let output = kempe(at, &asked);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("resuming"), "{}", said(&output));
    assert_eq!(parts(at), 0);
}

#[test]
fn parts_of_a_search_that_are_damaged_are_asked_again() {
    let folder = place("multi-start");
    let at = folder.path();
    let output = kempe(at, &["run", "m.toml", "best", "--out", "whole"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let wanted = whole(&at.join("whole"));
    let mut child = start(at, &RUN);
    while parts(at) < 4 && child.try_wait().expect("a state").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("killed");
    child.wait().expect("it ended");
    let folder = at.join("out/best.parts");
    let name = names(&folder)
        .into_iter()
        .find(|n| n.ends_with("000001.part"))
        .expect("a part");
    let mut bytes = fs::read(folder.join(&name)).expect("a part");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(folder.join(&name), bytes).expect("written");
    let output = kempe(at, &RUN);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(
        said(&output).contains("000001.part was not as it was written"),
        "{}",
        said(&output)
    );
    same(&whole(&at.join("out")), &wanted);
}

/// Ctrl-C keeps the best so far, says that it was stopped, and the next run goes on.
#[cfg(unix)]
/// There is nothing to go on with.
#[test]
fn a_search_without_an_answer_leaves_no_parts() {
    let folder = place("differential evolution");
    let at = folder.path();
    let model = fs::read_to_string(at.join("m.toml")).expect("written");
    let too_long = model.replace("a = [10, 30]", "a = [300, 400]");
    fs::write(at.join("m.toml"), too_long).expect("written");
    let output = kempe(at, &RUN);
    let told = said(&output);
    assert!(told.contains("no-answer"), "{told}");
    assert!(!told.contains("parts are kept"), "{told}");
    assert!(!at.join("out/best.parts").exists());
}

#[test]
fn a_search_that_is_stopped_keeps_its_best() {
    let folder = place("multi-start");
    let at = folder.path();
    let output = kempe(at, &["run", "m.toml", "best", "--out", "whole"]);
    let wanted = whole(&at.join("whole"));
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let mut child = start(at, &RUN);
    while parts(at) < 5 && child.try_wait().expect("a state").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    signal(&child, "INT");
    let stopped = ends(child, Duration::from_secs(60));
    assert_eq!(stopped.status.code(), Some(130), "{}", said(&stopped));
    for words in [
        "partial-result",
        "parts of the search in",
        "it goes on from there",
    ] {
        assert!(
            said(&stopped).contains(words),
            "{words}: {}",
            said(&stopped)
        );
    }
    let summary = String::from_utf8_lossy(&stopped.stdout);
    assert!(
        summary.contains("stopped before its end: the best so far"),
        "{summary}"
    );
    assert!(at.join("out/best.partial.csv").exists() && parts(at) >= 5);
    let output = kempe(at, &RUN);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    fs::remove_dir_all(at.join("whole")).expect("removed");
    // Nothing of the partial result is left beside it, and all is as it would have been.
    for name in ["best.partial", "best.partial.csv"] {
        assert!(!at.join("out").join(name).exists(), "{name} is left");
    }
    let found = contents(&at.join("out"));
    for (name, own) in wanted
        .iter()
        .filter(|(name, _)| name.starts_with("best.") || name == "report.html")
    {
        let other = found
            .iter()
            .find(|(other, _)| other == name)
            .expect("a file");
        assert!(own == &other.1, "{name} differs");
    }
}
