use super::*;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|n| n != RECORD)
        .collect();
    names.sort();
    names
}

fn open(folder: &Path) -> Output {
    Output::folder(folder, &[]).unwrap()
}

/// A result in a folder, as a run leaves it.
fn result(folder: &Path, files: &[(&str, &str)]) {
    let mut output = open(folder);
    for (name, text) in files {
        output.add(name, text.as_bytes()).unwrap();
    }
    output.publish().unwrap();
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

fn code<T>(refused: Result<T, Box<Diagnostic>>) -> &'static str {
    refused.err().map_or("", |d| d.code)
}

#[test]
fn files_appear_together() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    result(at, &[("a.csv", "old")]);
    let mut output = open(at);
    output.add("a.csv", b"new").unwrap();
    output.add("b.csv", b"new").unwrap();
    assert_eq!(text(at, "a.csv"), "old");
    assert!(!at.join("b.csv").exists());
    output.publish().unwrap();
    assert_eq!(
        (text(at, "a.csv"), text(at, "b.csv")),
        ("new".into(), "new".into())
    );
    assert_eq!(names(at), ["a.csv", "b.csv"]);
}

#[test]
fn what_somebody_else_wrote_or_changed_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("mine.csv"), "mine").unwrap();
    assert_eq!(code(open(at).add("mine.csv", b"new")), "file-exists");
    result(at, &[("a.csv", "old")]);
    fs::write(at.join("a.csv"), "old, with a remark").unwrap();
    assert_eq!(code(open(at).add("a.csv", b"new")), "file-exists");
    // Put there while a run computed.
    let mut output = open(at);
    output.add("b.csv", b"new").unwrap();
    fs::write(at.join("b.csv"), "mine").unwrap();
    assert_eq!(code(output.publish()), "file-exists");
    assert_eq!(text(at, "b.csv"), "mine");
    assert_eq!(names(at), ["a.csv", "b.csv", "mine.csv"]);
}

#[test]
fn what_is_read_is_not_replaced_even_if_kempe_wrote_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    result(at, &[("a.csv", "t,x")]);
    let input = at.join("a.csv");
    for name in ["a.csv", "A.CSV"] {
        let refused = Output::folder(at, std::slice::from_ref(&input))
            .unwrap()
            .add(name, b"");
        assert_eq!(code(refused), "own-input", "{name}");
    }
    assert_eq!(text(at, "a.csv"), "t,x");
}

#[test]
fn a_failure_leaves_the_earlier_result_and_no_litter() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    result(at, &[("a.csv", "old")]);
    fs::create_dir(at.join("b.csv")).unwrap();
    let mut output = open(at);
    output.add("a.csv", b"new").unwrap();
    assert_eq!(code(output.add("b.csv", b"new")), "cannot-write");
    drop(output);
    assert_eq!(text(at, "a.csv"), "old");
    assert_eq!(names(at), ["a.csv", "b.csv"]);
}

#[test]
fn a_failure_halfway_puts_everything_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    result(at, &[("a.csv", "old")]);
    let before = fs::read(at.join(RECORD)).unwrap();
    let mut output = open(at);
    for name in ["a.csv", "b.csv", "c.csv"] {
        output.add(name, b"new").unwrap();
    }
    // The third cannot take its place any more.
    fs::remove_file(&output.waiting[2].hidden).unwrap();
    assert_eq!(code(output.publish()), "cannot-write");
    assert_eq!(text(at, "a.csv"), "old");
    assert_eq!(names(at), ["a.csv"]);
    assert_eq!(fs::read(at.join(RECORD)).unwrap(), before);
}

/// The process is killed after each step in turn: the next run finds the earlier result whole, or the later one.
#[test]
fn a_run_that_was_killed_while_it_published_is_taken_back() {
    for steps in 0..=3 {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        result(at, &[("a.csv", "old a"), ("b.csv", "old b")]);
        let mut output = open(at);
        for (name, text) in [("a.csv", "new a"), ("b.csv", "new b"), ("c.csv", "new c")] {
            output.add(name, text.as_bytes()).unwrap();
        }
        // As `publish` does, and no further.
        for waiting in &mut output.waiting {
            let there = waiting.path.exists();
            waiting.kept = there.then(|| at.join(hidden::name(hidden::REPLACED)));
            let kept = waiting.kept.as_deref().and_then(Path::file_name);
            let entry = Appearing {
                mark: waiting.mark.clone(),
                kept: kept.map(|k| k.to_str().unwrap().to_owned()),
            };
            output.record.appearing.insert(waiting.name.clone(), entry);
        }
        output.record.write(at).unwrap();
        for waiting in output.waiting.iter_mut().take(steps) {
            waiting.appear().unwrap();
        }
        output.waiting.clear();
        drop(output);
        drop(open(at));
        assert_eq!(
            (text(at, "a.csv"), text(at, "b.csv")),
            ("old a".into(), "old b".into())
        );
        assert_eq!(names(at), ["a.csv", "b.csv"], "{steps} steps");
        result(at, &[("a.csv", "newer")]);
    }
}

#[test]
fn a_file_is_not_written_twice_whatever_its_capitals() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut output = open(at);
    output.add("a.csv", b"one").unwrap();
    assert_eq!(code(output.add("A.csv", b"two")), "cannot-write");
    drop(output);
    assert!(names(at).is_empty());
}

/// The same bytes under the same name are one file; other bytes are another result, and nothing is left of them.
#[test]
fn a_table_may_go_with_many_designs() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut output = open(at);
    output.add("law.csv", b"one").unwrap();
    output.add("law.csv", b"one").unwrap();
    assert_eq!(code(output.add("law.csv", b"two")), "cannot-write");
    assert_eq!(code(output.add("LAW.csv", b"one")), "cannot-write");
    output.publish().unwrap();
    assert_eq!(names(at), ["law.csv"]);
    assert_eq!(text(at, "law.csv"), "one");
}

#[test]
fn leftovers_of_a_killed_run_are_removed_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in [
        ".kempe-0123456789abcdef.part",
        ".kempe-0123456789abcdef.old",
        ".kempe-notes.part",
        ".turn.csv.4711.part",
        "turn.csv",
    ] {
        fs::write(at.join(name), "").unwrap();
    }
    drop(open(at));
    assert_eq!(
        names(at),
        [".kempe-notes.part", ".turn.csv.4711.part", "turn.csv"]
    );
}

#[test]
fn folders_made_for_nothing_are_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("deep/results");
    let output = open(&out);
    assert!(out.exists());
    drop(output);
    assert!(names(folder.path()).is_empty());
}

#[cfg(unix)]
#[test]
fn links_are_neither_followed_nor_replaced() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("precious"), "mine").unwrap();
    symlink(at.join("precious"), at.join("a.csv")).unwrap();
    symlink(at.join("nowhere"), at.join("b.csv")).unwrap();
    for name in ["a.csv", "b.csv"] {
        assert_eq!(code(open(at).add(name, b"new")), "file-exists", "{name}");
        assert_eq!(
            code(create(&at.join(name), b"new")),
            "file-exists",
            "{name}"
        );
        assert!(fs::symlink_metadata(at.join(name)).unwrap().is_symlink());
    }
    assert_eq!(text(at, "precious"), "mine");
    assert!(!at.join("nowhere").exists());
}
