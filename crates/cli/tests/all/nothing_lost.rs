//! Nothing that a person wrote is replaced, no two runs mix, and what is not whole says so.

use crate::support;
use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::support::{MODEL, command, contents, ends, folder, kempe, names, said, start};

/// Motion from a table called as the study's own would be.
const MEASURED: &str = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0], D = [60, 0] }\ncrank = { A-B = 20 }\n\
    coupler = { B-C = 50 }\nrocker = { D-C = 40 }\n[drives]\n\
    motor = { turns = \"crank\", law = { table = \"TABLE\", time = \"t\", value = \"angle\" } }\n\
    [assembly]\nC = \"left of B -> D\"\n[studies.turn]\nkind = \"motion\"\n";

const TABLE: &str = "t [ms],angle [deg]\n0,10\n100,30\n250,70\n400,90\n";

/// Long enough to do something meanwhile, and with rows from the start.
fn long() -> String {
    let lines = MODEL.lines().filter(|line| !line.starts_with("play"));
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    text.replace("step = 10", "rows = 2000000")
}

fn measured(at: &Path, table: &str) {
    fs::write(at.join("measured.toml"), MEASURED.replace("TABLE", table)).expect("written");
}

/// A refusal: exit code 2, these words, and every file as it was.
fn refused(at: &Path, arguments: &[&str], words: &[&str]) {
    let before = contents(at);
    let output = kempe(at, arguments);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    for word in words.iter().chain(&["help"]) {
        assert!(said.contains(word), "{arguments:?}: {word} in {said}");
    }
    assert!(contents(at) == before, "{arguments:?} changed something");
}

#[test]
fn a_run_does_not_replace_the_table_that_it_reads() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("sub")).expect("made");
    fs::write(at.join("turn.csv"), TABLE).expect("written");
    measured(at, "turn.csv");
    let whole = at.display().to_string();
    for out in [".", "./", "sub/..", "./sub/../.", whole.as_str()] {
        refused(
            at,
            &["run", "measured.toml", "--out", out],
            &["own-input", "turn.csv would be replaced"],
        );
    }
    // What Kempe wrote before is an input as well, once it is read.
    let first = kempe(at, &["run", "m.toml", "--out", "out"]);
    assert!(first.status.success());
    let text = fs::read_to_string(at.join("out/turn.csv")).expect("a table");
    let head = text.replacen("time [s],motor", "t [s],angle", 1);
    assert!(head.starts_with("t [s],angle [deg]"));
    fs::write(
        at.join("measured.toml"),
        MEASURED
            .replace("TABLE", "out/turn.csv")
            .replace("\"t\"", "\"time\"")
            .replace("\"angle\"", "\"motor\""),
    )
    .expect("written");
    refused(
        at,
        &["run", "measured.toml", "--out", "out"],
        &["own-input"],
    );
}

#[test]
fn a_run_does_not_replace_the_model() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("turn.csv"), MODEL).expect("written");
    refused(at, &["run", "turn.csv", "--out", "."], &["own-input"]);
    fs::write(at.join("m.svg"), MODEL).expect("written");
    refused(at, &["draw", "m.svg", "-o", "./m.svg"], &["own-input"]);
    // A disk that does not know capitals apart would lose it.
    refused(at, &["draw", "m.svg", "-o", "M.SVG"], &["own-input"]);
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_a_run_to_what_it_reads() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("data.csv"), TABLE).expect("written");
    measured(at, "data.csv");
    for (name, hard) in [("hard", true), ("soft", false)] {
        let out = at.join(name);
        fs::create_dir(&out).expect("made");
        let link = out.join("turn.csv");
        match hard {
            true => fs::hard_link(at.join("data.csv"), link),
            false => symlink(at.join("data.csv"), link),
        }
        .expect("linked");
        refused(
            at,
            &["run", "measured.toml", "--out", name],
            &["own-input", "data.csv"],
        );
    }
    // The folder itself by another way.
    fs::rename(at.join("data.csv"), at.join("turn.csv")).expect("renamed");
    measured(at, "turn.csv");
    symlink(at, at.join("way")).expect("linked");
    refused(
        at,
        &["run", "measured.toml", "--out", "way"],
        &["own-input"],
    );
    // A link that leads to nothing that is read is somebody's all the same.
    fs::create_dir(at.join("out")).expect("made");
    fs::write(at.join("precious"), "mine").expect("written");
    symlink(at.join("precious"), at.join("out/report.html")).expect("linked");
    refused(
        at,
        &["run", "m.toml", "--out", "out"],
        &["file-exists", "is a link"],
    );
    symlink(at.join("nowhere.svg"), at.join("pose.svg")).expect("linked");
    refused(
        at,
        &["draw", "m.toml", "-o", "pose.svg"],
        &["file-exists", "is a link"],
    );
    symlink(at.join("nowhere.toml"), at.join("new.toml")).expect("linked");
    refused(at, &["new", "new.toml"], &["file-exists"]);
    assert!(!at.join("nowhere.toml").exists() && !at.join("nowhere.svg").exists());
}

#[test]
fn only_what_kempe_wrote_and_nobody_changed_is_replaced() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("out")).expect("made");
    // Known before the run, and known only after it.
    for name in ["turn.parquet", "report.html", "turn-swing.svg"] {
        let path = at.join("out").join(name);
        fs::write(&path, "mine").expect("written");
        let output = kempe(at, &["run", "m.toml", "--out", "out"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            said(&output).contains("Kempe did not write it"),
            "{}",
            said(&output)
        );
        assert_eq!(
            contents(&at.join("out")),
            [(name.to_owned(), b"mine".to_vec())]
        );
        fs::remove_file(path).expect("removed");
    }
    for set in ["a=20mm", "a=19mm"] {
        let output = kempe(at, &["run", "m.toml", "--out", "out", "--set", set]);
        assert!(output.status.success(), "{}", said(&output));
    }
    let path = at.join("out/turn.csv");
    let mut text = fs::read_to_string(&path).expect("a table");
    text.push_str("my remark\n");
    fs::write(&path, &text).expect("written");
    let before = contents(&at.join("out"));
    let output = kempe(at, &["run", "m.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("was changed since Kempe wrote it"));
    assert!(contents(&at.join("out")) == before);
    // A picture that was touched, and what an earlier stopped run left, before anything is computed.
    fs::write(at.join("long.toml"), long()).expect("written");
    for name in ["turn-swing.svg", "turn.partial.csv"] {
        let path = at.join("out").join(name);
        fs::remove_file(at.join("out/turn.csv")).expect("removed");
        fs::write(&path, "mine").expect("written");
        let run = start(at, &["run", "long.toml", "--out", "out"]);
        let output = ends(run, Duration::from_secs(5));
        assert!(said(&output).contains(name), "{}", said(&output));
        fs::remove_file(&path).expect("removed");
        let output = kempe(at, &["run", "m.toml", "--out", "out"]);
        assert!(output.status.success(), "{}", said(&output));
    }
    // Pictures go the same way.
    fs::write(at.join("mine.svg"), "<svg/>").expect("written");
    refused(at, &["draw", "m.toml", "-o", "mine.svg"], &["file-exists"]);
    for _ in 0..2 {
        assert!(
            kempe(at, &["draw", "m.toml", "-o", "pose.svg"])
                .status
                .success()
        );
    }
    fs::write(at.join("pose.svg"), "<svg/>").expect("written");
    refused(
        at,
        &["draw", "m.toml", "-o", "pose.svg"],
        &["file-exists", "was changed"],
    );
    // Nor does `new` replace what `draw` would.
    fs::copy(at.join("m.toml"), at.join("x.toml")).expect("copied");
    refused(at, &["new", "x.toml"], &["file-exists"]);
    refused(at, &["new", "x", "--kind", "four-bar"], &["file-exists"]);
}

#[test]
fn places_that_are_none_are_refused_before_anything_is_computed() {
    let folder = folder();
    let at = folder.path();
    // It would take minutes.
    fs::write(at.join("long.toml"), long()).expect("written");
    fs::write(at.join("file"), "mine").expect("written");
    fs::create_dir(at.join("pose.svg")).expect("made");
    for arguments in [
        &["run", "long.toml", "--out", "file"][..],
        &["run", "long.toml", "--out", "long.toml"],
        &["run", "long.toml", "--out", "--quiet"],
        &["draw", "long.toml", "-o", "pose.svg"],
        &["draw", "long.toml", "-o", "no/such/pose.svg"],
        &["draw", "long.toml", "-o", ".svg"],
    ] {
        let output = ends(start(at, arguments), Duration::from_secs(20));
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            said(&output)
        );
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(at.join("nowhere"), at.join("dangling")).expect("linked");
        let run = ["run", "long.toml", "--out", "dangling"];
        refused(at, &run, &["a link that leads nowhere"]);
        assert!(!at.join("nowhere").exists());
    }
    assert!(!at.join("no").exists());
    assert_eq!(fs::read(at.join("file")).expect("a file"), b"mine");
}

#[test]
fn lists_that_kempe_did_not_write_are_left_alone() {
    let folder = folder();
    let at = folder.path();
    for text in ["mine", "{}", "{\"files\": {\"../m.toml\": 1}}"] {
        fs::create_dir_all(at.join("out")).expect("made");
        fs::write(at.join("out").join(support::RECORD), text).expect("written");
        let output = kempe(at, &["run", "m.toml", "--out", "out"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains("move it away"), "{}", said(&output));
        assert!(names(&at.join("out")).is_empty());
    }
}

/// Waits until a run holds its folder.
fn held(at: &Path) {
    let lock = at.join("out/.kempe-lock");
    for _ in 0..2000 {
        if fs::read_to_string(&lock).is_ok_and(|who| who.ends_with("UTC")) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("nobody holds the folder");
}

#[test]
fn two_runs_do_not_mix() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("long.toml"), long()).expect("written");
    let mut first = start(at, &["run", "long.toml", "--out", "out"]);
    held(at);
    let second = kempe(at, &["run", "m.toml", "--out", "out"]);
    let words = said(&second);
    assert_eq!(second.status.code(), Some(2), "{words}");
    let who = format!("process {}, since 2", first.id());
    assert!(
        words.contains("folder-busy") && words.contains(&who),
        "{words}"
    );
    // Killed, it holds nobody up, and what it left goes.
    first.kill().expect("killed");
    first.wait().expect("ended");
    assert!(at.join("out/.kempe-lock").exists());
    fs::write(at.join("out/.kempe-0123456789abcdef.part"), "half a table").expect("written");
    let third = kempe(at, &["run", "m.toml", "--out", "out"]);
    assert!(third.status.success(), "{}", said(&third));
    assert_eq!(
        names(&at.join("out")).len(),
        6,
        "{:?}",
        names(&at.join("out"))
    );
}

#[cfg(unix)]
#[test]
fn many_pictures_at_once_find_their_way_into_one_folder() {
    let folder = folder();
    let at = folder.path();
    let pictures: Vec<String> = (0..8).map(|k| format!("p{k}.svg")).collect();
    let children: Vec<_> = (pictures.iter())
        .map(|name| start(at, &["draw", "m.toml", "-o", name]))
        .collect();
    for child in children {
        let output = ends(child, Duration::from_secs(60));
        assert!(output.status.success(), "{}", said(&output));
    }
    // Each is known as Kempe's.
    for name in &pictures {
        assert!(kempe(at, &["draw", "m.toml", "-o", name]).status.success());
    }
}

/// A stopped run: how it ends, and what stands in `out` afterwards.
#[cfg(unix)]
fn stopped(at: &Path, name: &str, arguments: &[&str]) -> std::process::Output {
    // It is left alone longer every time that it had no row yet.
    for doubled in 0..9 {
        let child = start(at, arguments);
        std::thread::sleep(Duration::from_millis(100 << doubled));
        support::signal(&child, name);
        let output = ends(child, Duration::from_secs(120));
        assert_eq!(output.status.code(), Some(130), "{name}: {}", said(&output));
        if at.join("out/turn.partial.csv").exists() {
            return output;
        }
    }
    panic!("it does not come far enough");
}

#[cfg(unix)]
#[test]
fn a_stopped_run_stands_beside_the_earlier_result_and_says_so() {
    let folder = folder();
    let at = folder.path();
    let whole = kempe(at, &["run", "m.toml", "--out", "out"]);
    assert!(whole.status.success());
    let before = contents(&at.join("out"));
    let two = long() + "\n[studies.later]\nkind = \"motion\"\n";
    fs::write(at.join("long.toml"), two).expect("written");
    for name in ["INT", "TERM", "HUP"] {
        let output = stopped(
            at,
            name,
            &["run", "long.toml", "--out", "out", "--json", "--quiet"],
        );
        let words = said(&output);
        assert!(
            words.contains("partial-result") && words.contains("report.partial.html"),
            "{words}"
        );
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["partial"], true);
        assert_eq!(value["studies"][0]["interrupted"], true);
        let files = value["files"].as_array().expect("files");
        assert!(
            files
                .iter()
                .all(|f| f.as_str().is_some_and(|f| f.contains(".partial.")))
        );
        let mut now = contents(&at.join("out"));
        now.retain(|(name, _)| !name.contains(".partial."));
        assert!(now == before, "{name}");
        let csv = fs::read_to_string(at.join("out/turn.partial.csv")).expect("a table");
        let first = csv.lines().next().unwrap_or("");
        let rows = csv.lines().count() - 2;
        assert_eq!(
            first,
            format!("# partial: {rows} of 2000000 rows of turn, the run was stopped")
        );
        let parquet = fs::read(at.join("out/turn.partial.parquet")).expect("a table");
        let mark = format!("{rows} of 2000000 rows of turn");
        assert!(parquet.windows(mark.len()).any(|w| w == mark.as_bytes()));
        let html = fs::read_to_string(at.join("out/report.partial.html")).expect("a page");
        assert!(
            html.contains("Partial result: the run was stopped") && html.contains("later: no rows")
        );
        // a table that is saved from the page says so, too
        assert!(html.contains(&format!("\"mark\":\"# partial: {mark}")));
        assert!(!at.join("out/later.partial.csv").exists());
        if name != "HUP" {
            let partial = contents(&at.join("out"));
            let partial = partial
                .iter()
                .filter(|(name, _)| name.contains(".partial."));
            for (name, _) in partial {
                fs::remove_file(at.join("out").join(name)).expect("removed");
            }
        }
    }
    // The next whole run is told from it by its names.
    assert!(
        kempe(at, &["run", "m.toml", "--out", "out"])
            .status
            .success()
    );
    assert!(contents(&at.join("out")).iter().any(|(name, bytes)| {
        name == "turn.csv" && before.iter().any(|(n, b)| n == name && b == bytes)
    }));
}

#[test]
fn readers_know_a_partial_table() {
    let folder = folder();
    let at = folder.path();
    fs::write(
        at.join("t.csv"),
        format!("# partial: 4 of 9 rows of turn, the run was stopped\n{TABLE}"),
    )
    .expect("written");
    measured(at, "t.csv");
    for verb in ["check", "run"] {
        refused(
            at,
            &[verb, "measured.toml"],
            &["table-partial", "4 of 9 rows"],
        );
    }
    let case = "model = \"m.toml\"\nsource = \"a run\"\n[[table]]\nfile = \"t.csv\"\n";
    fs::write(at.join("case.toml"), case).expect("written");
    let verify = kempe(at, &["verify", "case.toml"]);
    assert_eq!(verify.status.code(), Some(2));
    assert!(
        said(&verify).contains("partial result: 4 of 9 rows"),
        "{}",
        said(&verify)
    );
    // Any other comment is one.
    fs::write(at.join("t.csv"), format!("# measured\n{TABLE}")).expect("written");
    assert_eq!(
        kempe(at, &["check", "measured.toml"]).status.code(),
        Some(0)
    );
}

/// What a run that is told by `nohup` to stay does when the terminal closes.
#[cfg(target_os = "linux")]
#[test]
fn nohup_keeps_a_run_from_being_stopped() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("long.toml"), long()).expect("written");
    let script = "trap '' HUP; exec \"$0\" run long.toml --out out";
    let mut child = std::process::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_kempe")])
        .current_dir(at)
        .spawn()
        .expect("sh runs");
    held(at);
    std::thread::sleep(Duration::from_millis(300));
    support::signal(&child, "HUP");
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a state").is_none(), "it goes on");
    child.kill().expect("killed");
    child.wait().expect("ended");
}

/// Of all cases, one that takes no time.
#[cfg(target_os = "linux")]
const CASE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../validation/a01-pendulum.toml"
);

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let folder = folder();
    let at = folder.path();
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["run", "--help"],
        &["help", "draw"],
        &["check", "m.toml"],
        &["check", "m.toml", "--json"],
        &["check", "no.toml", "--json"],
        &["run", "m.toml"],
        &["run", "m.toml", "--json"],
        &["run", "m.toml", "--out", "out"],
        &["sensitivities", "m.toml"],
        &["sensitivities", "m.toml", "--json"],
        &["new", "full.toml"],
        &["schema"],
        &["measures"],
        &["measures", "--json"],
        &["verify", CASE],
        &["verify", CASE, "--json"],
        &["completions", "bash"],
    ] {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("a device");
        let output = command(at, arguments)
            .stdout(full)
            .output()
            .expect("kempe runs");
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        let message = "the standard output cannot be written: no space left on device";
        assert_eq!(said.matches(message).count(), 1, "{arguments:?}: {said}");
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = folder();
    let at = folder.path();
    for arguments in [
        &["--help"][..],
        &["schema"],
        &["check", "m.toml", "--json"],
        &["run", "m.toml", "--json"],
        &["completions", "bash"],
    ] {
        let mut child = start(at, arguments);
        drop(child.stdout.take());
        let output = ends(child, Duration::from_secs(60));
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert_eq!(said(&output), "", "{arguments:?}");
    }
}

/// No file may grow beyond a few blocks, as on a disk that is full.
#[cfg(unix)]
#[test]
fn results_that_do_not_fit_on_the_disk_leave_everything_as_it_was() {
    let folder = folder();
    let at = folder.path();
    let limited = |arguments: &str| {
        let script = format!("trap '' XFSZ; ulimit -f 2; exec \"$0\" {arguments}");
        let output = std::process::Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_kempe")])
            .current_dir(at)
            .output();
        output.expect("sh runs")
    };
    for arguments in [
        "run m.toml --out fresh",
        "draw m.toml -o a.svg",
        "draw m.toml -o a.gif",
    ] {
        let output = limited(arguments);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {said}");
        assert!(said.contains("cannot be written: file too large"), "{said}");
        assert_eq!(contents(at).len(), 1, "{:?}", names(at));
        assert!(!at.join("fresh").exists());
    }
    assert!(
        kempe(at, &["run", "m.toml", "--out", "out"])
            .status
            .success()
    );
    let before = contents(&at.join("out"));
    assert_eq!(
        limited("run m.toml --out out --set a=19mm").status.code(),
        Some(2)
    );
    assert!(contents(&at.join("out")) == before);
}

#[cfg(unix)]
#[test]
fn what_is_no_plain_file_is_refused_at_once() {
    let folder = folder();
    let at = folder.path();
    let made = std::process::Command::new("mkfifo")
        .arg(at.join("pipe.toml"))
        .status();
    assert!(made.expect("mkfifo runs").success());
    fs::create_dir(at.join("cases")).expect("made");
    fs::rename(at.join("pipe.toml"), at.join("cases/pipe.toml")).expect("moved");
    let quick = |arguments: &[&str], word: &str| {
        let output = ends(start(at, arguments), Duration::from_secs(20));
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            said(&output)
        );
        assert!(
            said(&output).contains(word),
            "{arguments:?}: {}",
            said(&output)
        );
    };
    for verb in ["check", "run", "sensitivities"] {
        quick(&[verb, "cases/pipe.toml"], "is a pipe");
        quick(&[verb, "/dev/zero"], "is a device");
        quick(&[verb, "cases"], "is a folder");
    }
    quick(&["draw", "/dev/zero", "-o", "a.svg"], "is a device");
    quick(&["verify", "cases"], "a pipe, not a plain file");
    quick(&["verify", "/dev/zero"], "a device, not a plain file");
    let case = "model = \"/dev/zero\"\n[[value]]\nmeasure = \"x(B)\"\nexpect = 1\n";
    fs::write(at.join("case.toml"), case).expect("written");
    quick(&["verify", "case.toml"], "a device, not a plain file");
    measured(at, "cases/pipe.toml");
    quick(&["check", "measured.toml"], "a pipe, not a plain file");
    measured(at, "cases");
    quick(&["check", "measured.toml"], "a folder, not a plain file");
}

#[test]
fn files_beyond_their_limit_are_refused_with_what_to_do() {
    let folder = folder();
    let at = folder.path();
    let sized = |name: &str, bytes: u64| {
        let file = fs::File::create(at.join(name)).expect("made");
        file.set_len(bytes).expect("long");
    };
    sized("huge.toml", (8 << 20) + 1);
    refused_briefly(
        at,
        &["check", "huge.toml"],
        &["huge.toml has more than 8 MiB", "tables beside it"],
    );
    refused_briefly(
        at,
        &["verify", "huge.toml"],
        &["huge.toml cannot be read: it has more than 8 MiB"],
    );
    sized("huge.csv", (64 << 20) + 1);
    measured(at, "huge.csv");
    refused_briefly(
        at,
        &["check", "measured.toml"],
        &["it has more than 64 MiB: leave out rows"],
    );
    // Not far below, it is read: what is wrong with it is told.
    let comment = "#".repeat(9 << 20);
    fs::write(at.join("huge.csv"), format!("{comment}\n{TABLE}")).expect("written");
    assert!(kempe(at, &["check", "measured.toml"]).status.success());
}

fn refused_briefly(at: &Path, arguments: &[&str], words: &[&str]) {
    let output = ends(start(at, arguments), Duration::from_secs(30));
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    for word in words {
        assert!(said(&output).contains(word), "{word} in {}", said(&output));
    }
}

#[test]
fn tables_are_beside_or_below_their_model() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir_all(at.join("model/below")).expect("made");
    let path = at.join("model/measured.toml");
    let model = |table: &str| {
        fs::write(&path, MEASURED.replace("TABLE", table)).expect("written");
    };
    for table in ["t.csv", "model/t.csv", "model/below/t.csv"] {
        fs::write(at.join(table), TABLE).expect("written");
    }
    let whole = at.join("t.csv").display().to_string();
    let check = |more: &[&str]| kempe(at, &[&["check", "model/measured.toml"], more].concat());
    for inside in ["t.csv", "below/t.csv", "./below/t.csv"] {
        model(inside);
        assert!(check(&[]).status.success(), "{inside}");
    }
    let mut outside = vec!["../t.csv", "below/../t.csv", whole.as_str()];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&whole, at.join("model/way.csv")).expect("linked");
        std::os::unix::fs::symlink(at, at.join("model/up")).expect("linked");
        outside.extend(["way.csv", "up/t.csv"]);
    }
    for table in outside {
        model(table);
        let output = check(&[]);
        assert_eq!(output.status.code(), Some(2), "{table}");
        assert!(
            said(&output).contains("--allow-outside"),
            "{table}: {}",
            said(&output)
        );
        let allowed = check(&["--allow-outside"]);
        assert!(allowed.status.success(), "{table}: {}", said(&allowed));
    }
    // A case's tables too; its model may be anywhere.
    let case = |table: &str| {
        let text =
            format!("model = \"../m.toml\"\nsource = \"s\"\n[[table]]\nfile = \"{table}\"\n");
        fs::write(at.join("model/case.toml"), text).expect("written");
        kempe(at, &["verify", "model/case.toml"])
    };
    assert!(said(&case("../t.csv")).contains("--allow-outside"));
    assert!(!said(&case("t.csv")).contains("--allow-outside"));
}

#[test]
fn bytes_that_are_no_text_are_told_with_their_place() {
    let folder = folder();
    let at = folder.path();
    measured(at, "t.csv");
    fs::write(at.join("t.csv"), b"t [ms],angle [deg]\n0,10\n100,\xff30\n").expect("written");
    refused(
        at,
        &["check", "measured.toml"],
        &["line 3 is not UTF-8 text"],
    );
    fs::write(at.join("t.csv"), b"t [ms],angle [deg]\n0,10\n100,3\x000\n").expect("written");
    refused(
        at,
        &["check", "measured.toml"],
        &["line 3 has a byte of zero"],
    );
    fs::write(at.join("nul.toml"), b"title = \"a\x00b\"\n").expect("written");
    refused(at, &["check", "nul.toml"], &["toml-syntax", "U+0000"]);
}

#[test]
fn rows_are_bounded_by_memory_before_anything_is_computed() {
    let folder = folder();
    let at = folder.path();
    let columns: Vec<String> = (0..400).map(|k| format!("\"x(P) * {}\"", k + 2)).collect();
    let model = |rows: &str, studies: usize| {
        let body = MODEL.split("[studies.turn]").next().expect("a model");
        let studies = (0..studies).map(|k| {
            format!(
                "[studies.s{k}]\nkind = \"motion\"\n{rows}\ncolumns = [{}]\n",
                columns.join(", ")
            )
        });
        fs::write(
            at.join("big.toml"),
            body.to_owned() + &studies.collect::<String>(),
        )
        .expect("written");
    };
    // 3 GB each.
    for rows in ["rows = 1000000", "step = 0.00036", "step = \"6.2831 us\""] {
        model(rows, 1);
        for arguments in [
            &["run", "big.toml", "--out", "out"][..],
            &["draw", "big.toml", "-o", "a.gif"],
            &["check", "big.toml"],
        ] {
            refused_briefly(
                at,
                arguments,
                &[
                    "too-large",
                    "a study holds at most 2 GiB",
                    "ask for fewer rows",
                ],
            );
        }
    }
    // Each fits, all together do not.
    model("rows = 400000", 5);
    refused_briefly(
        at,
        &["run", "big.toml"],
        &[
            "too-large",
            "5 studies take",
            "run them one after the other",
        ],
    );
    assert_eq!(names(at), ["big.toml", "m.toml"]);
}
