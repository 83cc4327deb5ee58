//! Sweeps that are killed, shared and joined: the very bytes of an undisturbed run.

use crate::support;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::support::{
    Dice, RECORD, command, contents, ends, folder, kempe, killed, names, said, same,
};

/// 96 designs in 6 parts, some of which cannot turn.
const MODEL: &str = "units = { length = \"mm\", angle = \"deg\" }\n[parameters]\na = \"20 mm\"\nb = \"50 mm\"\n[links]\n\
    frame = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = \"a\" }\ncoupler = { B-C = \"b\", P = [25, 10] }\nrocker = { D-C = 40 }\n[drives]\n\
    motor = { turns = \"crank\", from = 0, to = 360, speed = \"1 rad/s\" }\n[assembly]\nC = \"left of B -> D\"\n[measures]\n\
    swing = \"range(angle(rocker))\"\n[studies.turn]\nkind = \"motion\"\nstep = 10\ncolumns = [\"angle(rocker)\"]\n\
    [studies.family]\nkind = \"sweep\"\nover = \"turn\"\ncolumns = [\"swing\", \"min(transmission_angle(C))\"]\nplot = [\"angle(rocker)\", \"path(P)\"]\n\
    vary = { a = { from = 12, to = 34, count = 12 }, b = { from = 44, to = 58, count = 8 } }\n";

const RUN: [&str; 5] = ["run", "m.toml", "family", "--out", "out"];

fn place() -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("m.toml"), MODEL).expect("written");
    folder
}

/// All files of a folder that a run has written whole.
fn whole(at: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = contents(at);
    all.push((
        RECORD.to_owned(),
        fs::read(at.join(RECORD)).expect("a list"),
    ));
    assert!(!at.join("family.parts").exists(), "parts are left");
    all
}

/// What one run writes that nothing disturbs.
fn undisturbed(at: &Path) -> Vec<(String, Vec<u8>)> {
    let output = kempe(at, &["run", "m.toml", "family", "--out", "whole"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let all = whole(&at.join("whole"));
    let written: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    for name in [
        "family.csv",
        "family.parquet",
        "family.rows.parquet",
        "report.html",
    ] {
        assert!(written.contains(&name), "{written:?}");
    }
    all
}

/// The files of parts in a folder.
fn parts(at: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(at) else {
        return Vec::new();
    };
    let mut all: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| {
            !path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .starts_with('.')
        })
        .collect();
    all.sort();
    all
}

#[test]
fn a_run_that_is_killed_at_any_moment_goes_on_to_the_same_bytes() {
    let folder = place();
    let at = folder.path();
    // Parts that take a while, so that it is killed on its way.
    let long = MODEL.replace("step = 10", "step = 2");
    fs::write(at.join("m.toml"), long).expect("written");
    let wanted = undisturbed(at);
    let mut dice = Dice(20_261_124);
    let mut resumed = 0;
    for _ in 0..4 {
        let there = || parts(&at.join("out/family.parts")).len();
        let more = |dice: &mut Dice| dice.roll(3) as usize;
        let kept = killed(at, &RUN, 3, there, more, &mut dice);
        let output = kempe(at, &RUN);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        if kept > 0 {
            resumed += 1;
            let words = format!("family: resuming, {kept} of 6 parts are there");
            assert!(said(&output).contains(&words), "{}", said(&output));
        }
        same(&whole(&at.join("out")), &wanted);
        fs::remove_dir_all(at.join("out")).expect("removed");
    }
    assert!(resumed > 0, "it was never resumed");
}

#[test]
fn four_shards_merge_to_the_bytes_of_one_run() {
    let folder = place();
    let at = folder.path();
    let wanted = undisturbed(at);
    let shard = |k: usize| {
        let (out, shard) = (format!("shard-{k}"), format!("{k}/4"));
        let output = kempe(
            at,
            &["run", "m.toml", "family", "--out", &out, "--shard", &shard],
        );
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        assert_eq!(names(&at.join(&out)), ["family.parts"]);
    };
    [3, 1, 4].into_iter().for_each(shard);
    let merge = |folders: &[&str], out: &str| {
        let arguments = [&["merge", "m.toml", "family"], folders, &["--out", out]].concat();
        kempe(at, &arguments)
    };
    let lacking = merge(&["shard-1", "shard-3", "shard-4"], "merged");
    assert_eq!(lacking.status.code(), Some(2));
    for words in [
        "part-missing",
        "2 of 6 parts of `family` are missing",
        "the shards 2/4",
    ] {
        assert!(
            said(&lacking).contains(words),
            "{words}: {}",
            said(&lacking)
        );
    }
    assert!(!at.join("merged").exists());
    shard(2);
    // In any order, and the folder of parts itself will do.
    let output = merge(
        &["shard-2/family.parts", "shard-4", "shard-1", "shard-3"],
        "merged",
    );
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    same(&whole(&at.join("merged")), &wanted);
    assert_eq!(parts(&at.join("shard-1/family.parts")).len(), 2);
    // A run finds the parts of shards in its folder.
    for k in 2..=4 {
        for part in parts(&at.join(format!("shard-{k}/family.parts"))) {
            let name = part.file_name().expect("a name");
            fs::copy(&part, at.join("shard-1/family.parts").join(name)).expect("copied");
        }
    }
    let output = kempe(at, &["run", "m.toml", "family", "--out", "shard-1"]);
    assert!(said(&output).contains("6 of 6 parts"), "{}", said(&output));
    same(&whole(&at.join("shard-1")), &wanted);
}

#[test]
fn parts_of_another_model_are_neither_used_nor_touched() {
    let folder = place();
    let at = folder.path();
    let run = ["run", "m.toml", "family", "--out", "out", "--shard", "1/2"];
    assert!(
        kempe(at, &[&run[..], &["--set", "a=21mm"]].concat())
            .status
            .success()
    );
    let others = parts(&at.join("out/family.parts"));
    assert_eq!(others.len(), 3);
    let wanted = undisturbed(at);
    let output = kempe(at, &RUN);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let words = "out/family.parts holds 3 parts of another model";
    assert!(said(&output).contains(words), "{}", said(&output));
    assert_eq!(parts(&at.join("out/family.parts")), others);
    fs::remove_dir_all(at.join("out/family.parts")).expect("removed");
    same(&whole(&at.join("out")), &wanted);
    // Nor are they merged with these.
    assert!(
        kempe(at, &[&run[..], &["--set", "a=21mm"]].concat())
            .status
            .success()
    );
    let merged = kempe(at, &["merge", "m.toml", "family", "out", "--out", "merged"]);
    assert_eq!(merged.status.code(), Some(2));
    for words in [
        "6 of 6 parts",
        "made of another model file, with other parameters set",
    ] {
        assert!(said(&merged).contains(words), "{words}: {}", said(&merged));
    }
}

#[test]
fn a_damaged_part_is_computed_again_or_refused() {
    let folder = place();
    let at = folder.path();
    let wanted = undisturbed(at);
    let all = ["run", "m.toml", "family", "--out", "out", "--shard", "1/1"];
    assert!(kempe(at, &all).status.success());
    let own = parts(&at.join("out/family.parts"));
    assert_eq!(own.len(), 6);
    let bytes = fs::read(&own[2]).expect("a part");
    let mut turned = bytes.clone();
    turned[bytes.len() / 2] ^= 1;
    for damage in [&turned[..], &bytes[..bytes.len() - 9], b""] {
        fs::write(&own[2], damage).expect("written");
        let merged = kempe(at, &["merge", "m.toml", "family", "out", "--out", "merged"]);
        assert_eq!(merged.status.code(), Some(2));
        let said = said(&merged);
        assert!(
            said.contains("part-damaged") && said.contains("000002.part"),
            "{said}"
        );
    }
    // One part in the place of another is none.
    fs::copy(&own[1], &own[2]).expect("copied");
    let again = kempe(at, &all);
    assert!(again.status.success());
    assert!(
        said(&again).contains("000002.part was not as it was written"),
        "{}",
        said(&again)
    );
    assert!(fs::read(&own[2]).expect("a part") == bytes);
    fs::write(&own[2], &turned).expect("written");
    let output = kempe(at, &RUN);
    assert!(output.status.success(), "{}", said(&output));
    same(&whole(&at.join("out")), &wanted);
}

#[test]
fn what_is_no_part_is_not_replaced() {
    let folder = place();
    let at = folder.path();
    let shard = ["run", "m.toml", "family", "--out", "out", "--shard", "1/3"];
    assert!(kempe(at, &shard).status.success());
    let own = parts(&at.join("out/family.parts"));
    fs::write(&own[0], "mine").expect("written");
    for arguments in [&shard[..], &RUN[..]] {
        let output = kempe(at, arguments);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("file-exists"), "{}", said(&output));
        assert_eq!(fs::read(&own[0]).expect("mine"), b"mine");
    }
    // A file in the place of the folder.
    fs::remove_dir_all(at.join("out")).expect("removed");
    fs::create_dir(at.join("out")).expect("made");
    fs::write(at.join("out/family.parts"), "mine").expect("written");
    let output = kempe(at, &shard);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert_eq!(
        fs::read(at.join("out/family.parts")).expect("mine"),
        b"mine"
    );
}

#[test]
fn shards_are_of_sweeps_alone() {
    let folder = place();
    let at = folder.path();
    let before = contents(at);
    for (arguments, words) in [
        (
            &["run", "m.toml", "turn", "--out", "out", "--shard", "1/2"][..],
            "`turn` is no sweep",
        ),
        (
            &["run", "m.toml", "nothing", "--out", "out", "--shard", "1/2"],
            "unknown-study",
        ),
        (&["run", "m.toml", "family", "--shard", "1/2"], "--out"),
        (
            &["run", "m.toml", "family", "--out", "out", "--shard", "3/2"],
            "2/4",
        ),
        (
            &["merge", "m.toml", "turn", ".", "--out", "out"],
            "`turn` is no sweep",
        ),
        (
            &["merge", "m.toml", "family", "nowhere", "--out", "out"],
            "no folder nowhere",
        ),
        (
            &["merge", "m.toml", "other", ".", "--out", "out"],
            "unknown-study",
        ),
    ] {
        let output = kempe(at, arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            said(&output)
        );
        assert!(
            said(&output).contains(words),
            "{arguments:?}: {}",
            said(&output)
        );
        assert!(
            contents(at) == before && !at.join("out").exists(),
            "{arguments:?}"
        );
    }
    // Without a name all sweeps of the file are meant.
    let output = kempe(
        at,
        &["run", "m.toml", "--out", "out", "--shard", "2/2", "--json"],
    );
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["studies"][0]["study"], "family");
    assert_eq!(value["studies"][0]["parts_finished"], 3);
}

#[cfg(unix)]
#[test]
fn a_run_that_is_stopped_keeps_its_parts_and_says_so() {
    let folder = place();
    let at = folder.path();
    // Long enough to be stopped.
    let long = MODEL.replace("step = 10", "step = 0.1");
    fs::write(at.join("m.toml"), &long).expect("written");
    let child = command(at, &RUN)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("kempe runs");
    while parts(&at.join("out/family.parts")).is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    support::signal(&child, "INT");
    let output = ends(child, Duration::from_secs(60));
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    let said = said(&output);
    for words in ["finished parts are kept", "it goes on from there"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let table = fs::read_to_string(at.join("out/family.partial.csv")).expect("a table");
    let first = table.lines().next().unwrap_or_default();
    assert!(
        first.starts_with("# partial: ") && first.contains("of 96 rows of family"),
        "{first}"
    );
    assert!(!at.join("out/family.rows.parquet").exists());
    assert!(!parts(&at.join("out/family.parts")).is_empty());
}
