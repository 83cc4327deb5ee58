//! What keeps a simulation from beginning is told by `check` just as `run` tells it, word by word, and what `run` does well is not
//! refused by `check`.
#![allow(clippy::unwrap_used)]

use crate::support;
use std::fs;

use serde_json::Value;

/// What a command says of a model, and the code with which it ends.
fn asked(command: &str, model: &str) -> (Vec<Value>, Option<i32>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let output = support::kempe(folder.path(), &[command, "m.toml", "--json"]);
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let told = answer["diagnostics"].as_array().unwrap().clone();
    (told, output.status.code())
}

/// A crank-rocker with masses, driven as said, and what else is in the file.
fn crank_rocker(drive: &str, rest: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\n\
         crank = {{ A-B = 20, mass = 1, inertia = \"100 kg mm^2\" }}\n\
         coupler = {{ B-C = 50, mass = 1, inertia = \"100 kg mm^2\" }}\n\
         rocker = {{ D-C = 40, mass = 1, inertia = \"100 kg mm^2\" }}\n[assembly]\nC = {{ near = [50, 40] }}\nB = {{ near = [10, 18] }}\n\
         [drives]\nmotor = {{ {drive} }}\n{rest}"
    )
}

/// Two pendulums, one on the other: the upper one keeps a law unless it is let go.
fn pendulums(rest: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ O = [0, 0] }}\n\
         arm = {{ O-A = 100, mass = 1, inertia = \"1e-3 kg m^2\" }}\nbob = {{ A-B = 100, mass = 1, inertia = \"1e-3 kg m^2\" }}\n\
         [drives]\nlift = {{ turns = \"arm\", from = 0, to = 90, speed = \"90 deg/s\" }}\n\
         free = {{ turns = \"bob\", relative_to = \"arm\", at = 0 }}\n{rest}"
    )
}

fn cylinder(oil: &str, start: &str) -> String {
    format!(
        "[links]\nframe = {{ A = [0, 0], F = [0.5, -0.4] }}\nboom = {{ A-T = 2, B = [0.8, 0], mass = \"200 kg\", inertia = \"70 kg m^2\" }}\n\
         [drives]\nlift = {{ cylinder = \"F-B\", at = {start} }}\n[assembly]\nT = {{ near = [2, 0] }}\n\
         [cylinders.lift]\nbore = \"80 mm\"\nrod = \"50 mm\"\nsupply = \"160 bar\"\n\
         [cylinders.lift.oil]\nbulk_modulus = \"14000 bar\"\nvolume = [\"200 cm^3\", \"200 cm^3\"]\nvalve = \"0.1\"\n\
         flow = \"20 L/min\"\ndrop = \"35 bar\"\n{oil}\n[studies.s]\nkind = \"simulate\"\nuntil = \"10 ms\"\nrows = 3\n"
    )
}

/// A piston that its crank does not drive, beside a pendulum.
const DEAD_POINT: &str = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { O = [0, 0], G = [300, 0], P = [0, -200] }\n\
    crank = { O-A = 50, mass = 1, inertia = \"1e-3 kg m^2\" }\nrod = { A-B = 150, mass = 1, inertia = \"1e-3 kg m^2\" }\n\
    block = { B = [0, 0], mass = 1, inertia = 0 }\nbob = { P-Q = 100, mass = 1, inertia = \"1e-3 kg m^2\" }\n\
    [joints]\nbore = { slider = \"block\", at = \"B\", on = \"O -> G\" }\n\
    [drives]\nswing = { turns = \"bob\", at = 0 }\nm = { slides = \"bore\", at = 190 }\n[assembly]\nB = { near = [190, 0] }\nA = { near = [50, 10] }\n\
    [studies.s]\nkind = \"simulate\"\nuntil = \"0.1 s\"\nstart = { m = 200 }\n";

const SIMULATE: &str = "[studies.s]\nkind = \"simulate\"\nuntil = \"10 ms\"\nrows = 3\n";
const CONTACT: &str = "[clearance]\nB = { radial = \"50 um\", radius = \"5 mm\", restitution = 0.3 }\n\
    [studies.s]\nkind = \"clearance\"\nmodel = \"three-state\"\nuntil = \"1 ms\"\nrows = 3\ncolumns = [\"angle(rocker)\"]\n";

/// The simulation for another time.
fn for_long(until: &str) -> String {
    SIMULATE.replace("10 ms", until)
}

/// The same pendulums, the lower one turned twice round in a second.
fn turned_twice(rest: &str) -> String {
    let law = "to = 720, speed = \"720 deg/s\"";
    pendulums(rest).replace("to = 90, speed = \"90 deg/s\"", law)
}

/// What each file is, and words of what is told of it by both.
fn refused() -> Vec<(&'static str, String, &'static str)> {
    let held = |rest: &str| crank_rocker("turns = \"crank\", at = 30", rest);
    vec![
        (
            "a start beyond a stop",
            held(&format!("{SIMULATE}stops = {{ crank = [40, 200] }}\n")),
            "it starts beyond the lower stop of crank, by 10 deg",
        ),
        (
            "the same where joints have play",
            held(&format!(
                "{CONTACT}release = \"motor\"\nstops = {{ crank = [40, 200] }}\n"
            )),
            "it starts beyond the lower stop of crank, by 10 deg",
        ),
        (
            "no mass",
            "[links]\nframe = { A = [0, 0] }\narm = { A-B = 1, mass = 2, inertia = 1 }\nfeeler = { B-C = 1 }\n\
             [drives]\nshoulder = { turns = \"arm\", at = 0 }\nwrist = { turns = \"feeler\", relative_to = \"arm\", at = 0 }\n"
                .to_owned()
                + SIMULATE,
            "moves no mass",
        ),
        (
            "a dead point",
            DEAD_POINT.to_owned(),
            "it stands at a dead point of what is let go",
        ),
        (
            "a stop on a drive that keeps its law",
            pendulums(&for_long("1 s")) + "release = \"free\"\nstops = { lift = [\"none\", 45] }\n",
            "nothing that is let go gives way at the upper stop of lift",
        ),
        (
            "a stop that gives, on a link that a kept drive turns",
            pendulums(&for_long("1 s"))
                + "release = \"free\"\nstops = { arm = { between = [\"none\", 45], stiffness = \"5 N m/deg\" } }\n",
            "nothing that is let go gives way at the upper stop of arm",
        ),
        (
            "a stop that time alone closes",
            held("[measures]\nh = \"10 mm - 1 mm * time / 1 s\"\n")
                + &for_long("20 s")
                + "stops = { h = [0, \"none\"] }\n",
            "nothing that is let go gives way at the lower stop of h",
        ),
        (
            "a stop that a kept drive comes to in its second turn",
            turned_twice(&for_long("1 s")) + "release = \"free\"\nstops = { arm = [\"none\", 700] }\n",
            "nothing that is let go gives way at the upper stop of arm",
        ),
        (
            "a tolerance that tells nothing",
            held(SIMULATE) + "tolerance = 10\n",
            "a `tolerance` of 10 tells nothing of the motion",
        ),
        (
            "the same where joints have play",
            held(CONTACT) + "tolerance = 0.02\n",
            "a `tolerance` of 0.02 tells nothing of the motion",
        ),
        (
            "oil whose start is outside the stroke",
            cylinder("closed = \"0.5 m\"\nstroke = \"0.4 m\"", "0.45"),
            "starts outside the stroke of its cylinder, by 0.05 m: that goes from 0.5 m to 0.9 m",
        ),
        (
            "a load without a value",
            held("[loads]\nl = { torque = \"1 N m / (time / 1 s)\", on = \"crank\" }\n")
                + SIMULATE,
            "the load `l` has no finite value at the start",
        ),
        (
            "a stop without a value",
            held("[measures]\nh = \"asin(2)\"\n") + SIMULATE + "stops = { h = [0, 10] }\n",
            "what the lower stop of h bounds has no finite value at the start",
        ),
        (
            "a condition without a value",
            held(SIMULATE) + "end_when = \"sqrt(time / 1 s - 5) >= 1\"\n",
            "the condition `sqrt(time / 1 s - 5) >= 1` has no finite value at the start",
        ),
        (
            "a switch in a study of forces",
            crank_rocker(
                "turns = \"crank\", from = 60, to = 90, speed = 90",
                "[switches]\nlow = { on = \"angle(rocker) <= 100 deg\" }\n\
                 [loads]\nbrake = { torque = \"-1 N m * switch(low)\", on = \"rocker\" }\n[studies.f]\nkind = \"forces\"\nrows = 3\n",
            ),
            "goes by a pressure or a switch, which only a simulation follows",
        ),
    ]
}

#[test]
fn check_tells_what_run_refuses_in_the_same_words() {
    for (what, model, words) in refused() {
        let (checked, check_code) = asked("check", &model);
        let (ran, run_code) = asked("run", &model);
        assert_eq!(checked, ran, "{what}");
        assert_eq!((check_code, run_code), (Some(3), Some(3)), "{what}");
        let found = checked.iter().find(|d| {
            let message = d["message"].as_str().unwrap_or_default();
            message.contains(words)
        });
        let found = found.unwrap_or_else(|| panic!("{what}: {checked:#?}"));
        assert_eq!(found["severity"], "error", "{what}");
        assert!(
            found["help"].as_str().is_some_and(|h| !h.is_empty()),
            "{what}"
        );
    }
}

#[test]
fn what_is_let_go_need_not_come_to_the_end_of_its_law() {
    for (what, model) in [
        (
            "a law that is let go",
            crank_rocker(
                "turns = \"rocker\", from = 110, to = 200, speed = 10",
                SIMULATE,
            ),
        ),
        (
            "a law whose start nothing stands at",
            crank_rocker(
                "turns = \"rocker\", from = 110, to = 200, speed = 10",
                SIMULATE,
            ) + "start = { motor = 120 }\n",
        ),
        (
            "a law beyond the limit, later than the study looks",
            crank_rocker(
                "turns = \"rocker\", from = 110, to = 200, speed = 10",
                CONTACT,
            ),
        ),
    ] {
        for command in ["check", "run"] {
            let (told, code) = asked(command, &model);
            assert_eq!(told, [] as [Value; 0], "{what}: {command}");
            assert_eq!(code, Some(0), "{what}: {command}");
        }
    }
}

#[test]
fn stops_that_nothing_comes_to_are_no_hindrance() {
    let free = "release = \"free\"\n";
    for (what, model) in [
        (
            "a law that takes longer",
            pendulums(SIMULATE) + free + "stops = { lift = [\"none\", 45] }\n",
        ),
        (
            "a law that ends before",
            pendulums(&for_long("2 s")) + free + "stops = { lift = [\"none\", 91] }\n",
        ),
        (
            "a link that turns twice",
            turned_twice(&for_long("1 s")) + free + "stops = { arm = [\"none\", 721] }\n",
        ),
        (
            "a time that does not come",
            pendulums("[measures]\nh = \"10 mm - 1 mm * time / 1 s\"\n")
                + &for_long("1 s")
                + free
                + "stops = { h = [0, \"none\"] }\n",
        ),
    ] {
        for command in ["check", "run"] {
            let (told, code) = asked(command, &model);
            assert_eq!(told, [] as [Value; 0], "{what}: {command}");
            assert_eq!(code, Some(0), "{what}: {command}");
        }
    }
}

#[test]
fn a_single_pose_of_vibrations_is_judged_alike() {
    let model = "units = { length = \"mm\" }\n[links]\nframe = { A = [0, 0] }\narm = { A-B = 100, mass = 1, inertia = \"1e-3 kg m^2\" }\n\
        [drives]\nturn = { turns = \"arm\", at = \"90 deg\" }\n[studies.v]\nkind = \"vibrations\"\nequilibrium = false\n";
    let (checked, code) = asked("check", model);
    assert_eq!(checked, asked("run", model).0);
    assert_eq!(checked[0]["code"], "unstable-pose", "{checked:#?}");
    assert_eq!(code, Some(1));
}

/// A pendulum with what is asked of it.
fn pendulum(rest: &str) -> String {
    format!(
        "units = {{ length = \"mm\", angle = \"deg\" }}\n[links]\nframe = {{ O = [0, 0], F = [100, 0] }}\n\
         bob = {{ O-A = 100, mass = 1, inertia = \"1e-3 kg m^2\" }}\n[drives]\nswing = {{ turns = \"bob\", at = 0 }}\n{rest}"
    )
}

const SWING: &str = "[studies.s]\nkind = \"simulate\"\nuntil = \"1 s\"\nrows = 11\n";

#[test]
fn what_ends_a_simulation_is_told_with_its_name_and_time() {
    let root = "sqrt(1 - time / 0.1 s)";
    let cases = [
        (
            pendulum(&format!(
                "[loads]\nw = {{ torque = \"1 N m * {root}\", on = \"bob\" }}\n{SWING}"
            )),
            "0.1 s",
            "the load `w` has no finite value from there on",
        ),
        (
            pendulum(&format!(
                "[loads]\nw = {{ torque = \"0.1 N m / (1 - time / 0.1 s)\", on = \"bob\" }}\n{SWING}"
            )),
            "0.1 s",
            "the load `w` grows without bound there",
        ),
        (
            pendulum(&format!("{SWING}end_when = \"{root} <= -1\"\n")),
            "0.1 s",
            "the condition `sqrt(1 - time / 0.1 s) <= -1` has no finite value from there on",
        ),
        (
            pendulum(&format!(
                "[switches]\nx = {{ on = \"{root} <= -1\" }}\n{SWING}"
            )),
            "0.1 s",
            "what turns the switch `x` has no finite value from there on",
        ),
        (
            pendulum(&format!(
                "[measures]\nh = \"angle(bob) + 0 deg * {root}\"\n{SWING}stops = {{ h = [-300, 50] }}\n"
            )),
            "0.1 s",
            "what the lower stop of h bounds has no finite value from there on",
        ),
        (
            pendulum(
                &format!("{SWING}start = {{ swing_rate = \"100 rad/s\" }}\n")
                    .replace("1 s", "100 s"),
            ) + "stops = { swing = { between = [-1, 1], restitution = 1 } }\n",
            "",
            "it strikes the lower stop of swing 10000 times between",
        ),
        (
            pendulum(SWING).replace("turns = \"bob\", at = 0", "cylinder = \"F-A\", at = 50")
                + "[assembly]\nA = \"left of O -> F\"\n",
            "",
            "the two points of the cylinder `swing` meet there",
        ),
    ];
    for (model, time, why) in cases {
        let (told, code) = asked("run", &model);
        let ended = told.iter().find(|d| d["code"] == "simulation-ended");
        let ended = ended.unwrap_or_else(|| panic!("{told:#?}\n{model}"));
        let end = format!("the simulation goes no farther than {time}");
        assert!(ended["message"].as_str().unwrap().contains(&end), "{ended}");
        assert!(ended["notes"].to_string().contains(why), "{ended}");
        assert_eq!(code, Some(3));
    }
}

/// The curvature of a path has no value while its point stands still: that is no reason to end.
#[test]
fn what_lacks_a_value_for_an_instant_goes_on() {
    let model = pendulum(SWING) + "end_when = \"curvature(A) >= 100 rad/m\"\n";
    for command in ["check", "run"] {
        let (told, code) = asked(command, &model);
        assert_eq!((told, code), (vec![], Some(0)), "{command}");
    }
}

#[test]
fn strikes_at_a_joint_with_play_take_one_line_of_what_happened() {
    let folder = tempfile::tempdir().unwrap();
    let model = "units = { length = \"mm\", angle = \"deg\" }\n[links]\nframe = { O = [0, 0], E = [0, 0], G = [300, 0] }\n\
        crank = { O-A = 50, mass = 0.5, inertia = \"2e-4 kg m^2\" }\nrod = { A-B = 150, mass = 0.5, inertia = \"1e-3 kg m^2\" }\n\
        block = { B = [0, 0], mass = 1, inertia = \"1e-4 kg m^2\" }\n[joints]\nbore = { slider = \"block\", at = \"B\", on = \"E -> G\" }\n\
        [drives]\nmotor = { turns = \"crank\", from = 0, to = 720, speed = \"600 rpm\" }\n[assembly]\nB = { near = [200, 0] }\n\
        [clearance]\nbore = { radial = \"50 um\", restitution = 0.4, length = 40, height = 30 }\n\
        [studies.knock]\nkind = \"clearance\"\nmodel = \"three-state\"\nuntil = \"20 ms\"\nrows = 5\ncolumns = [\"x(B)\"]\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let output = support::kempe(folder.path(), &["run", "m.toml"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let (_, happened) = text.split_once("What happened").unwrap();
    let (happened, listed) = happened.split_once("Contacts").unwrap();
    let lines = |text: &str, words: &str| text.lines().filter(|l| l.contains(words)).count();
    assert_eq!(
        lines(happened, "strikes the rear left corner of bore"),
        1,
        "{happened}"
    );
    assert!(
        happened.contains("corner of bore, ") && happened.contains(" times until "),
        "{happened}"
    );
    assert!(
        lines(listed, "the rear left corner of bore") > 5,
        "{listed}"
    );
}

/// A block that falls on a stop just before the end, with others that move in time: its last row is there, on whichever side of
/// the impact. It falls 4.905 mm in the root of 0.001 s^2.
#[test]
fn the_last_row_is_there_just_behind_an_impact() {
    let folder = tempfile::tempdir().unwrap();
    let model = "units = { length = \"mm\", angle = \"deg\" }\ngravity = [0, \"-9.81 m/s^2\"]\n[parameters]\nt = \"1 s\"\n\
        [links]\nframe = { O = [0, 0], G = [0, 300] }\nblock = { B = [0, 0], mass = 1, inertia = 0 }\n\
        arm = { B-C = 100, mass = \"0.5 kg\", inertia = \"1e-3 kg m^2\", center = \"B\" }\n\
        [joints]\nbore = { slider = \"block\", at = \"B\", on = \"O -> G\" }\n\
        [drives]\nm = { slides = \"bore\", at = 100 }\na = { turns = \"arm\", at = 0 }\n\
        [studies.s]\nkind = \"simulate\"\nuntil = \"t\"\nrows = 3\ncolumns = [\"y(B)\", \"rate(y(B))\"]\n\
        stops = { m = { between = [\"95.095 mm\", \"none\"], restitution = 0.5 } }\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let fall = 0.001_f64.sqrt();
    for part in [
        -1e-9, -1e-12, 0.0, 1e-14, 1e-13, 2e-12, 1e-11, 1e-10, 1e-9, 1e-8,
    ] {
        let until = format!("t={:?} s", fall * (1.0 + part));
        let arguments = ["run", "m.toml", "--set", &until, "--json", "--out", "out"];
        let output = support::kempe(folder.path(), &arguments);
        let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(answer["diagnostics"], serde_json::json!([]), "{part:e}");
        let table = fs::read_to_string(folder.path().join("out/s.csv")).unwrap();
        let last: Vec<&str> = table.lines().last().unwrap().split(',').collect();
        let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
        let cell = |name: &str| -> f64 {
            let at = head.iter().position(|h| h.starts_with(name)).unwrap();
            last[at].parse().unwrap()
        };
        assert!((cell("y(B)") - 95.095).abs() < 1e-5, "{part:e}");
        let (before, after) = (-9810.0 * fall, 0.5 * 9810.0 * fall);
        let rate = cell("rate(y(B))");
        let near = |speed: f64| (rate - speed).abs() < 1e-3;
        // Within the rounding of an end both sides are right.
        assert!(
            if part > 1e-12 {
                near(after)
            } else {
                near(before) || near(after)
            },
            "{part:e}: {rate}"
        );
    }
}

#[test]
fn a_case_of_a_study_that_is_not_there_is_told_the_near_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("m.toml"),
        pendulum(SWING).replace("studies.s", "studies.swinging"),
    )
    .unwrap();
    let case = "title = \"case\"\nmodel = \"m.toml\"\nstudy = \"swingin\"\n[[value]]\nat = \"time = 0 s\"\nmeasure = \"angle(bob)\"\nexpect = \"0 deg\"\n";
    fs::write(folder.path().join("case.toml"), case).unwrap();
    let output = support::kempe(folder.path(), &["verify", "case.toml"]);
    let told = support::said(&output);
    assert!(told.contains("there is no study `swingin`"), "{told}");
    assert!(told.contains("did you mean `swinging`?"), "{told}");
    let output = support::kempe(folder.path(), &["verify", "casee.toml"]);
    let told = support::said(&output);
    assert!(told.contains("did you mean case.toml?"), "{told}");
}
