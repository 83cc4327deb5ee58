//! What `kempe run`, `draw` and `new` leave in the file system.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::{MODEL, folder, kempe, names, said};

#[test]
fn a_run_leaves_tables_figures_and_a_report_and_the_same_bytes_again() {
    let folder = folder();
    let at = folder.path();
    assert!(
        kempe(at, &["run", "m.toml", "--out", "one"])
            .status
            .success()
    );
    assert!(
        kempe(at, &["run", "m.toml", "--out", "two"])
            .status
            .success()
    );
    let files = [
        "report.html",
        "turn-mechanism.svg",
        "turn-path-P.svg",
        "turn-swing.svg",
        "turn.csv",
        "turn.parquet",
    ];
    assert_eq!(names(&at.join("one")), files);
    for file in files {
        let (one, two) = (
            fs::read(at.join("one").join(file)),
            fs::read(at.join("two").join(file)),
        );
        assert_eq!(one.expect("a file"), two.expect("a file"), "{file}");
    }
    let csv = fs::read_to_string(at.join("one/turn.csv")).expect("text");
    assert_eq!(csv.lines().count(), 38);
    assert!(csv.starts_with("time [s],motor [deg],swing [deg],rate(swing) [rad/s],closure [1],smallest_singular_value [1],note\n"));
    let html = fs::read_to_string(at.join("one/report.html")).expect("text");
    let outside = html.match_indices("://").filter(|(i, _)| {
        !html[..*i].ends_with("http") || !html[*i..].starts_with("://www.w3.org/")
    });
    assert_eq!(outside.count(), 0, "nothing is fetched");
}

#[test]
fn the_report_tells_its_date_where_asked() {
    let folder = folder();
    let at = folder.path();
    let report = |arguments: &[&str]| {
        let all = [&["run", "m.toml", "--out", "out"], arguments].concat();
        assert!(kempe(at, &all).status.success());
        fs::read_to_string(at.join("out/report.html")).expect("text")
    };
    let (plain, dated) = (report(&[]), report(&["--date"]));
    assert!(!plain.contains(" UTC"));
    let (before, after) = dated.split_once(" UTC").expect("a date");
    let date = &before[before.len() - 19..];
    assert!(
        date.starts_with("20") && date.as_bytes()[10] == b' ',
        "{date}"
    );
    let without = format!("{}{after}", &before[..before.len() - 21]);
    assert_eq!(without, plain, "nothing else differs");
}

#[test]
fn a_failed_run_leaves_the_earlier_result_as_it_was() {
    let folder = folder();
    let at = folder.path();
    assert!(
        kempe(at, &["run", "m.toml", "--out", "out"])
            .status
            .success()
    );
    let before: Vec<Vec<u8>> = names(&at.join("out"))
        .iter()
        .map(|n| fs::read(at.join("out").join(n)).expect("a file"))
        .collect();
    let same = || {
        let now = names(&at.join("out"));
        let now: Vec<Vec<u8>> = now
            .iter()
            .map(|n| fs::read(at.join("out").join(n)).expect("a file"))
            .collect();
        assert!(now == before);
    };
    // It cannot be assembled.
    assert_eq!(
        kempe(at, &["run", "m.toml", "--out", "out", "--set", "a=300mm"])
            .status
            .code(),
        Some(3)
    );
    same();
    // One of its files cannot be written: a folder is in its way.
    fs::remove_file(at.join("out/turn-swing.svg")).expect("removed");
    fs::create_dir(at.join("out/turn-swing.svg")).expect("made");
    let blocked = kempe(at, &["run", "m.toml", "--out", "out", "--set", "a=19mm"]);
    assert_eq!(blocked.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&blocked.stderr).contains("turn-swing.svg is a folder"));
    fs::remove_dir(at.join("out/turn-swing.svg")).expect("removed");
    fs::write(at.join("out/turn-swing.svg"), &before[3]).expect("written");
    same();
    // The folder itself cannot be made.
    fs::write(at.join("file"), "").expect("written");
    assert_eq!(
        kempe(at, &["run", "m.toml", "--out", "file/out"])
            .status
            .code(),
        Some(2)
    );
}

#[test]
fn json_is_one_object_on_the_standard_output() {
    let folder = folder();
    let output = kempe(folder.path(), &["run", "m.toml", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let study = &value["studies"][0];
    assert_eq!(
        (&study["study"], &study["rows"]),
        (&"turn".into(), &37.into())
    );
    let play = study["values"][0]["value"].as_f64().expect("a number");
    assert!((play - 60.032_348_552_12).abs() < 1e-9);
    assert_eq!(study["table"]["columns"][2]["unit"], "deg");
    assert!(output.stderr.is_empty(), "quiet when piped");
}

#[test]
fn pictures_of_every_kind() {
    let folder = folder();
    let at = folder.path();
    for (name, start) in [
        ("a.svg", &b"<svg"[..]),
        ("a.png", b"\x89PNG"),
        ("a.dxf", b"  0\nSECTION"),
        ("a.gif", b"GIF89a"),
        ("a.apng", b"\x89PNG"),
    ] {
        let output = kempe(at, &["draw", "m.toml", "-o", name, "--width", "200"]);
        assert!(
            output.status.success(),
            "{name}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(
            fs::read(at.join(name)).expect("a file").starts_with(start),
            "{name}"
        );
    }
    assert!(
        kempe(
            at,
            &["draw", "m.toml", "-o", "b.svg", "--at", "motor=30deg"]
        )
        .status
        .success()
    );
    assert_ne!(
        fs::read(at.join("a.svg")).ok(),
        fs::read(at.join("b.svg")).ok()
    );
    for wrong in [
        ["--at", "motr=30deg"],
        ["--at", "motor=30mm"],
        ["--at", "motor"],
    ] {
        let output = kempe(at, &["draw", "m.toml", "-o", "c.svg", wrong[0], wrong[1]]);
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
    }
    assert!(!at.join("c.svg").exists());
}

#[test]
fn every_starter_checks_and_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    for starter in kempe_model::STARTERS {
        let made = kempe(at, &["new", starter.name]);
        assert!(made.status.success());
        let file = format!("{}.toml", starter.name);
        let text = fs::read_to_string(at.join(&file)).expect("a file");
        // What asks for linkages draws none.
        let drawn = text.contains("[places]") || text.contains("kind    = \"synthesize\"");
        assert!(drawn && text.contains(&format!("kempe run {file}")));
        let check = kempe(at, &["check", &file, "--strict"]);
        assert!(
            check.status.success(),
            "{}",
            String::from_utf8_lossy(&check.stderr)
        );
        let run = kempe(at, &["run", &file, "--strict", "--out", starter.name]);
        assert!(
            run.status.success(),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        );
        fs::write(at.join(&file), "mine").expect("written");
        for again in [&["new", starter.name][..], &["new", &file]] {
            assert_eq!(kempe(at, again).status.code(), Some(2));
        }
        let kept = fs::read_to_string(at.join(&file)).expect("a file");
        assert_eq!(kept, "mine", "never overwritten");
    }
}

#[test]
fn starters_are_listed_where_none_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let listed = kempe(at, &["new"]);
    assert!(listed.status.success());
    let unknown = kempe(at, &["new", "sixbar"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert_eq!(
        kempe(at, &["new", "--kind", "linkage"]).status.code(),
        Some(2)
    );
    let said = [&listed.stdout, &unknown.stderr].map(|s| String::from_utf8_lossy(s).into_owned());
    for starter in kempe_model::STARTERS {
        for said in &said {
            let line = said.lines().find(|line| line.contains(starter.name));
            assert!(line.is_some_and(|l| l.contains(starter.doc)), "{said}");
        }
    }
    assert!(said[1].contains("did you mean `six-bar`?"), "{}", said[1]);
    assert!(
        fs::read_dir(at).expect("a folder").next().is_none(),
        "nothing is written"
    );
    // a file of one's own name, of one kind or the other
    assert!(kempe(at, &["new", "mine.toml"]).status.success());
    assert!(
        kempe(at, &["new", "train.toml", "--kind", "gear-train"])
            .status
            .success()
    );
    let text = fs::read_to_string(at.join("train.toml")).expect("a file");
    assert!(text.contains("teeth"));
}

#[test]
fn verify_meets_every_reference_and_fails_on_a_miss() {
    let folder = folder();
    let at = folder.path();
    let all = kempe(at, &["verify", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&all.stdout).expect("JSON");
    assert!(value["compared"].as_u64().expect("a count") > 300);
    assert_eq!(
        value["missed"],
        0,
        "{}",
        String::from_utf8_lossy(&all.stdout)
    );
    assert!(all.status.success());
    let case = "model = \"m.toml\"\nsource = \"wrong on purpose\"\n[[value]]\nmeasure = \"range(swing)\"\nexpect = \"61.5 deg\"\n";
    fs::write(at.join("case.toml"), case).expect("written");
    let missed = kempe(at, &["verify", "case.toml"]);
    assert_eq!(missed.status.code(), Some(1));
    let said = String::from_utf8_lossy(&missed.stdout).into_owned();
    assert!(
        said.contains("MISSED range(swing)") && said.contains("wrong on purpose"),
        "{said}"
    );
    fs::write(at.join("case.toml"), "modle = 3").expect("written");
    assert_eq!(kempe(at, &["verify", "case.toml"]).status.code(), Some(2));
}

/// What `kempe` says when Ctrl-C ends it as far on as `far` asks: it is left alone twice as long every time that it had not
/// come so far, however slow the machine is.
#[cfg(unix)]
fn interrupted(at: &Path, arguments: &[&str], far: impl Fn(&Output) -> bool) -> Output {
    for doubled in 0..9 {
        let child = Command::new(env!("CARGO_BIN_EXE_kempe"))
            .args(arguments)
            .current_dir(at)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("kempe runs");
        std::thread::sleep(std::time::Duration::from_millis(100 << doubled));
        let signalled = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(signalled.expect("kill runs").success());
        let output = child.wait_with_output().expect("it ends");
        if far(&output) {
            assert_eq!(output.status.code(), Some(130));
            return output;
        }
    }
    panic!("{arguments:?} does not come far enough");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_finished_rows() {
    let folder = folder();
    let at = folder.path();
    let long = MODEL.replace("step = 10", "rows = 400000");
    fs::write(at.join("long.toml"), long).expect("written");
    let lines =
        || fs::read_to_string(at.join("out/turn.partial.csv")).map_or(0, |t| t.lines().count());
    let output = interrupted(at, &["run", "long.toml", "--out", "out"], |_| {
        let far = lines() > 2;
        if !far {
            // The next run begins anew.
            let _ = fs::remove_dir_all(at.join("out"));
        }
        far
    });
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("of 400000 rows, stopped"), "{said}");
    assert!(lines() < 400_001, "{}", lines());
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_a_check_that_follows_a_long_motion() {
    let folder = folder();
    let at = folder.path();
    // A million turns: the trace would take far longer than this test.
    let long = MODEL
        .replace("to = 360", "to = 3.6e8")
        .replace("step = 10", "rows = 2");
    assert_ne!(long, MODEL);
    fs::write(at.join("long.toml"), long).expect("written");
    for verb in [
        &["check", "long.toml"][..],
        &["run", "long.toml", "--out", "out"],
    ] {
        interrupted(at, verb, |output| {
            String::from_utf8_lossy(&output.stderr).contains("stopped while following the motion")
        });
    }
    assert!(!at.join("out").exists(), "nothing was finished");
}

/// A row of four-bars whose drawing, with all its names, takes far longer than its motion.
#[cfg(unix)]
#[test]
fn ctrl_c_stops_the_drawing_of_a_report() {
    let folder = folder();
    let at = folder.path();
    let many = include_str!("../../../../examples/benchmarks/n-four-bar-40.toml");
    let study = |name: &str| {
        format!("[studies.{name}]\nkind = \"motion\"\nrows = 3\ncolumns = [\"x(B0)\"]\n")
    };
    let (head, _) = many.split_once("[studies.fall]").expect("a study");
    let turns = head.replace(
        "at = \"90 deg\"",
        "from = \"90 deg\", to = \"120 deg\", speed = \"1 rad/s\"",
    );
    assert_ne!(turns, head);
    let studies: String = ["a", "b", "c", "d", "e", "f"].map(study).concat();
    fs::write(at.join("many.toml"), turns + &studies).expect("written");
    let output = interrupted(at, &["run", "many.toml", "--out", "out"], |output| {
        let far = String::from_utf8_lossy(&output.stderr).contains("while its report was drawn");
        if !far {
            let _ = fs::remove_dir_all(at.join("out"));
        }
        far
    });
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("partial"), "{said}");
    // whole tables that say what they are, and no page
    for name in ["a", "f"] {
        let table = fs::read_to_string(at.join(format!("out/{name}.partial.csv"))).expect("text");
        assert!(
            table.starts_with('#') || table.contains("all 3 rows"),
            "{table}"
        );
        assert!(!at.join(format!("out/{name}.csv")).exists());
    }
    assert!(!at.join("out/report.partial.html").exists());
    assert!(!at.join("out/report.html").exists());
}

#[test]
fn check_proves_a_motion_and_says_where_it_cannot() {
    let folder = folder();
    let at = folder.path();
    let whole = kempe(at, &["check", "m.toml", "--certify", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&whole.stdout).expect("JSON");
    assert_eq!(value["proof"]["fraction"], 1.0);
    assert_eq!(value["proof"]["runs"].as_array().map(Vec::len), Some(1));
    let text = kempe(at, &["check", "m.toml", "--certify"]);
    let said = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(
        said.contains("Proved    100 % of motor 0 deg to 360 deg"),
        "{said}"
    );
    // A parallelogram collapses twice in a turn: change points, where nothing is proved.
    let parallel = include_str!("../../../../examples/gallery/parallelogram.toml");
    fs::write(at.join("p.toml"), parallel).expect("written");
    let text = kempe(at, &["check", "p.toml", "--certify"]);
    let said = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(said.contains("at a change point"), "{said}");
}

#[test]
fn sensitivities_are_those_of_differences() {
    let folder = folder();
    let at = folder.path();
    let value_of = |arguments: &[&str]| -> serde_json::Value {
        let output = kempe(
            at,
            &[&["sensitivities", "m.toml", "--json"], arguments].concat(),
        );
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let here = value_of(&["--at", "motor=30deg"]);
    assert_eq!(here["place"], "motor = 30 deg");
    let measure = &here["measures"][0];
    let slope = &measure["derivatives"][0];
    let parameter = slope["parameter"].as_str().expect("a name").to_owned();
    let base = 20.0;
    let value = |a: f64| -> f64 {
        let set = format!("{parameter}={a}mm");
        value_of(&["--at", "motor=30deg", "--set", &set])["measures"][0]["value"]
            .as_f64()
            .expect("a number")
    };
    let h = 1e-3;
    let difference = (value(base + h) - value(base - h)) / (2.0 * h);
    let exact = slope["value"].as_f64().expect("a number");
    assert!(
        (difference - exact).abs() < 1e-6 * exact.abs().max(1.0),
        "{exact} {difference}"
    );
    assert_eq!(slope["unit"], "deg/mm");
    let wrong = kempe(at, &["sensitivities", "m.toml", "--at", "moter=30deg"]);
    assert_eq!(wrong.status.code(), Some(2));
}

/// The model and the commands of the README's table.
#[test]
fn the_steps_of_the_readme_work_on_its_model() {
    let readme = include_str!("../../../../README.md");
    let model = readme.split("```toml\n").nth(1).expect("a model");
    let model = model.split("```").next().expect("its end");
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::write(at.join("crank.toml"), model).expect("written");
    let rows = readme.lines().filter_map(|l| l.strip_prefix("| `kempe "));
    let mut steps: Vec<String> = rows
        .filter_map(|row| row.split('`').next())
        .filter(|step| step.contains("FILE"))
        .map(str::to_owned)
        .collect();
    assert!(steps.len() >= 4, "{steps:?}");
    // What the table says of options.
    steps.push("run FILE --out DIR --set a=25mm".to_owned());
    steps.push("check FILE --certify".to_owned());
    for step in steps {
        let words = step.replace("FILE", "crank.toml").replace("DIR", "out");
        let words: Vec<&str> = words.split(' ').collect();
        let output = kempe(at, &words);
        assert!(
            output.status.success(),
            "{step}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    assert!(at.join("out/report.html").exists() && at.join("pose.svg").exists());
}

#[test]
fn no_two_files_of_a_model_have_one_name() {
    let folder = folder();
    let at = folder.path();
    let twice = kempe(at, &["run", "m.toml", "turn", "turn", "--out", "twice"]);
    assert!(twice.status.success());
    assert_eq!(names(&at.join("twice")).len(), 6);
    // A plot called as the picture of the mechanism, and plots that two studies might call the same.
    let model = MODEL
        .replace("play  =", "mechanism = \"y(P)\"\nb = \"x(P)\"\na_b = \"x(C)\"\nplay  =")
        .replace(
            "plot = [\"swing\", \"path(P)\"]",
            "plot = [\"mechanism\", \"swing - angle(coupler)\", [\"b\", \"a_b\"], [\"b\", \"a_b\"]]\n\
             [studies.turn-swing]\nkind = \"motion\"\nplot = [\"angle(coupler)\"]",
        );
    fs::write(at.join("clash.toml"), model).expect("written");
    let run = kempe(at, &["run", "clash.toml", "--out", "clash"]);
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    assert_eq!(
        names(&at.join("clash")),
        [
            "report.html",
            "turn-b-a_b-2.svg",
            "turn-b-a_b.svg",
            "turn-mechanism-2.svg",
            "turn-mechanism.svg",
            "turn-swing-angle-coupler.svg",
            "turn-swing-mechanism.svg",
            "turn-swing.csv",
            "turn-swing.parquet",
            "turn.csv",
            "turn.parquet",
            "turn.swing-angle-coupler.svg",
        ]
    );
}

#[test]
fn a_study_that_cannot_run_leaves_the_folder_as_it_was() {
    let folder = folder();
    let at = folder.path();
    // Driven up to `top`; around, it goes as far as it can.
    let model = MODEL
        .replace("[parameters]\n", "[parameters]\ntop = \"40 deg\"\n")
        .replace("A-B = \"a\"", "A-B = 45")
        .replace("B-C = 50", "B-C = 30")
        .replace("from = 0, to = 360", "from = 30, to = \"top\"")
        .replace(
            "[studies.turn]",
            "[studies.around]\nkind = \"motion\"\ncircuit = true\n[studies.turn]",
        );
    fs::write(at.join("part.toml"), model).expect("written");
    let first = kempe(at, &["run", "part.toml", "--out", "out"]);
    let said = String::from_utf8_lossy(&first.stderr).into_owned();
    assert_eq!(first.status.code(), Some(0), "{said}");
    let read = || -> Vec<Vec<u8>> {
        let all = names(&at.join("out"));
        all.iter()
            .map(|n| fs::read(at.join("out").join(n)).expect("a file"))
            .collect()
    };
    let before = read();
    let run = kempe(
        at,
        &["run", "part.toml", "--out", "out", "--set", "top=170deg"],
    );
    assert_eq!(run.status.code(), Some(3));
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(
        said.contains("nothing was written to out: `turn` could not run")
            && said.contains("kempe run part.toml around --out out"),
        "{said}"
    );
    assert!(read() == before);
    let alone = [
        "run",
        "part.toml",
        "around",
        "--out",
        "out",
        "--set",
        "top=170deg",
    ];
    assert_eq!(kempe(at, &alone).status.code(), Some(0));
    assert!(read() != before);
}

/// A pipe as a table would keep the reader waiting for ever.
#[cfg(unix)]
#[test]
fn a_table_is_a_plain_file() {
    let folder = folder();
    let at = folder.path();
    let motor = MODEL.lines().find(|line| line.starts_with("motor"));
    let motor = motor.expect("a drive");
    let law = "motor = { turns = \"crank\", law = { table = \"/dev/null\" } }";
    fs::write(at.join("t.toml"), MODEL.replace(motor, law)).expect("written");
    let out = kempe(at, &["check", "t.toml", "--allow-outside"]);
    assert_eq!(out.status.code(), Some(2));
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(said.contains("it is a device, not a plain file"), "{said}");
}

#[cfg(unix)]
#[test]
fn readers_that_go_away_do_not_keep_a_run_from_its_end() {
    let folder = folder();
    let at = folder.path();
    // Something to say on both streams.
    let loud = MODEL.replace("C = \"left of B -> D\"", "");
    fs::write(at.join("loud.toml"), loud).expect("written");
    for arguments in [
        &["run", "loud.toml", "--out", "out"][..],
        &["check", "loud.toml"],
        &["run", "no.toml"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_kempe"))
            .args(arguments)
            .current_dir(at)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("kempe runs");
        drop((child.stdout.take(), child.stderr.take()));
        let code = child.wait().expect("it ends").code();
        assert!(code.is_some_and(|c| c <= 3), "{arguments:?}: {code:?}");
    }
    assert!(at.join("out/report.html").exists());
}

#[test]
fn sizes_are_written_into_pictures_where_they_are_asked_for() {
    let folder = folder();
    let at = folder.path();
    for (name, words) in [("d.svg", "a = 20 mm"), ("d.dxf", "DIMENSIONS")] {
        let plain = kempe(at, &["draw", "m.toml", "-o", name]);
        assert!(plain.status.success(), "{}", said(&plain));
        let text = |name: &str| fs::read_to_string(at.join(name)).expect("a picture");
        let without = text(name);
        let sized = kempe(at, &["draw", "m.toml", "-o", name, "--dimensions"]);
        assert!(sized.status.success(), "{}", said(&sized));
        assert!(
            text(name).contains(words) && text(name) != without,
            "{name}"
        );
    }
}

/// A picture that moves shows a simulation as it is found: a pendulum let go swings, and one that its drive holds does not.
#[test]
fn pictures_of_simulations_move() {
    const PENDULUM: &str = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0] }\n\
        rod = { A-B = 100, mass = 1, inertia = \"100 kg mm^2\" }\n[drives]\nswing = { turns = \"rod\", at = 0 }\n[studies.s]\n";
    let folder = folder();
    let at = folder.path();
    let picture = |name: &str, study: &str| {
        fs::write(at.join("p.toml"), format!("{PENDULUM}{study}\n")).expect("written");
        let output = kempe(at, &["draw", "p.toml", "-o", name, "--width", "200"]);
        assert!(output.status.success(), "{}", said(&output));
        fs::metadata(at.join(name)).expect("a picture").len()
    };
    let swings = picture("swings.gif", "kind = \"simulate\"\nuntil = \"1 s\"");
    let held = picture("held.gif", "kind = \"motion\"");
    // Frames that are all one cost next to nothing.
    assert!(swings > 5 * held, "{swings} {held}");
}
