//! What `check` and `run` answer of one motion, how much of it is proved, how far it reaches, and how it is drawn.

use std::f64::consts::{PI, TAU};
use std::fs;

use serde_json::Value;

use super::{HEAD, ask, check, crank_rocker, run, slider_crank, support};

/// Two cranks with a dyad between them, and the drives that move them.
fn five_bar(dyad: [f64; 2], drives: &str) -> String {
    format!(
        "{HEAD}[links]\nframe = {{ A = [0, 0], E = [100, 0] }}\na = {{ A-B = 60 }}\nb = {{ B-C = {} }}\n\
         c = {{ C-D = {} }}\nd = {{ E-D = 60 }}\n[drives]\n{drives}\n[assembly]\nC = \"left of B -> D\"\n",
        dyad[0], dyad[1]
    )
}

const STUDY: &str = "[studies.s]\nkind = \"motion\"\nrows = 51\n";

/// Whatever keeps a study from its rows is told by `check` as by `run`, with the same code and the same exit code.
#[test]
fn check_and_run_agree_on_what_is_not_reached() {
    let first = "m = { turns = \"a\", from = 90, to = 200, speed = 10 }";
    let second = "n = { turns = \"d\", from = 90, to = -20, speed = 7 }";
    let slot = |to: i32| {
        format!(
            "[links]\nframe = {{ A = [0, 0], P = [1, 1], Q = [2, 1] }}\ncrank = {{ A-B = 1 }}\nblock = {{ C = [0, 0] }}\n\
             [joints]\nguide = {{ slider = \"block\", at = \"C\", on = \"P -> Q\" }}\nrod = {{ pin = \"C\", on = \"A -> B\" }}\n\
             [drives]\nm = {{ turns = \"crank\", from = 90, to = {to}, speed = \"1 rad/s\" }}\n{STUDY}"
        )
    };
    let pair = |drives: &str| five_bar([70.0, 70.0], drives) + STUDY;
    for (code, text) in [
        ("range-beyond-limit", pair(&format!("{first}\n{second}"))),
        ("range-beyond-limit", pair(&format!("{second}\n{first}"))),
        ("motion-runs-away", slot(-30)),
        ("motion-runs-away", slot(200)),
        (
            "range-too-long",
            slider_crank("turns = \"crank\", from = 0, to = 1e15", "", STUDY),
        ),
        (
            "range-too-long",
            slider_crank("turns = \"crank\", from = 0, to = -1e20", "", STUDY),
        ),
    ] {
        let (checked, ran) = (check(&text), run(&text));
        for answer in [&checked, &ran] {
            assert_eq!(answer.exit, 3, "{code}: {}", answer.words());
            assert!(answer.codes().contains(&code), "{code}: {}", answer.words());
        }
        let rows = ran.rows("s");
        let empty = rows
            .iter()
            .filter(|r| r["note"].starts_with("not reached") || r["note"].starts_with("beyond"));
        let told = &ran.value["studies"][0]["rows_not_reached"];
        assert_eq!(told.as_u64(), Some(empty.count() as u64), "{code}");
        assert_ne!(told.as_u64(), Some(0), "{code}");
    }
}

fn proof(text: &str) -> (f64, Vec<Value>, i32) {
    let answer = ask(&["check", "--certify"], text, &[]);
    let proof = &answer.value["proof"];
    let gaps = proof["gaps"].as_array().expect("a list").clone();
    (
        proof["fraction"].as_f64().expect("a part"),
        gaps,
        answer.exit,
    )
}

/// What is proved is told as a part of what was asked for, not of what can be reached.
#[test]
fn a_proof_is_of_the_demanded_range() {
    // Links in line: cosines at the limits of a crank, of a rocker and of a block's crank that is driven by the block.
    let crank = (-0.093_75_f64).acos() / PI;
    let rocker = ((0.0625_f64 - 0.958_333_333_333_333_3).acos().to_degrees() - 120.0) / 150.0;
    let texts = [
        (
            crank_rocker("")
                .replace("B-C = 50, P = [25, 10]", "B-C = 25")
                .replace("to = 360", "to = 180"),
            crank,
        ),
        (
            crank_rocker("")
                .replace(
                    "\"crank\", from = 0, to = 360",
                    "\"rocker\", from = 120, to = 270",
                )
                .replace("C = \"left of B -> D\"", "B = \"left of A -> C\""),
            rocker,
        ),
        (
            slider_crank("slides = \"block\", from = 150, to = 350", "", "")
                .replace("1 rad/s", "10 mm/s")
                .replace("B = { near = [200, 0] }", "A = \"left of O -> B\""),
            0.25,
        ),
    ];
    for (text, part) in texts {
        let (fraction, gaps, exit) = proof(&text);
        assert_eq!(exit, 3);
        assert!((fraction - part).abs() < 1e-3, "{fraction} {part}");
        let words = format!("{gaps:?}");
        assert!(words.contains("does not come there"), "{words}");
    }
}

/// A range of very many turns is left unproved for want of work, and that is what is told.
#[test]
fn a_proof_that_stops_names_its_budget() {
    let crank = "turns = \"crank\", from = 0, to = 3600000";
    for text in [
        crank_rocker("").replace("to = 360", "to = 3600000"),
        slider_crank(crank, "", ""),
    ] {
        let (fraction, gaps, exit) = proof(&text);
        assert_eq!(exit, 1);
        assert!(0.0 < fraction && fraction < 1.0, "{fraction}");
        assert!(!gaps.is_empty());
        for gap in gaps {
            let words = gap.to_string();
            assert!(
                words.contains("work allowed") && words.contains("shorter range"),
                "{words}"
            );
        }
    }
}

/// A drive that is held takes no part in the reach of the other.
#[test]
fn the_reach_is_that_of_the_drive_that_moves() {
    let held = "n = { turns = \"d\", at = 90 }";
    let moving = "m = { turns = \"a\", from = 60, to = 100, speed = 10 }";
    for drives in [format!("{held}\n{moving}"), format!("{moving}\n{held}")] {
        // B comes no farther from D than 176.7, no nearer than 56.6.
        let answer = check(&five_bar([100.0, 100.0], &drives));
        assert_eq!((answer.exit, answer.codes()), (0, vec![]));
        assert_eq!(answer.value["reach"], "m turns fully");
        // With a dyad of 120 the cosine law tells where B is as far from D as it may be.
        let answer = check(&five_bar([60.0, 60.0], &drives));
        assert_eq!(answer.exit, 0, "{}", answer.words());
        let (middle, far) = (60.0_f64.atan2(100.0), 60.0_f64.hypot(100.0));
        let to = ((3600.0 + far * far - 14400.0) / (2.0 * 60.0 * far)).acos();
        let reach = answer.value["reach_si"].as_array().expect("two").clone();
        let reach: Vec<f64> = reach.iter().filter_map(Value::as_f64).collect();
        let turns = |x: f64| ((x + TAU / 2.0).rem_euclid(TAU)) - TAU / 2.0;
        for (found, expected) in reach.iter().zip([middle - to, middle + to]) {
            assert!((turns(*found) - expected).abs() < 1e-9, "{reach:?}");
        }
    }
}

/// Polygons of a picture whose fill is that of gears and racks: their corners, mm on paper.
fn polygons(svg: &str) -> Vec<Vec<[f64; 2]>> {
    let paths = svg.split("<path d=\"").skip(1);
    let filled = paths.filter(|p| p.contains("fill-opacity=\"0.16\""));
    let shapes = filled.filter_map(|p| p.split('"').next());
    let corners = |shape: &str| {
        let corners = shape.trim_matches(['M', 'Z']).split('L');
        let numbers = |corner: &str| -> Option<[f64; 2]> {
            let (x, y) = corner.split_once(' ')?;
            Some([x.parse().ok()?, y.parse().ok()?])
        };
        corners.map(numbers).collect()
    };
    shapes.filter_map(corners).collect()
}

/// A rack whose pinion has no teeth to draw is a thin strip along its way; with teeth it has them.
#[test]
fn a_rack_is_drawn_as_a_strip() {
    let text = |radius: i32, side: &str, teeth: &str| {
        let place = if side == "right" { radius } else { -radius };
        format!(
            "{HEAD}[links]\nframe = {{ O = [{place}, 0], R0 = [0, -50], R1 = [0, 50] }}\nrack = {{ R = [0, 0] }}\n\
             finger = {{ O-A = 70 }}\n[joints]\nguide = {{ slider = \"rack\", at = \"R\", on = \"R0 -> R1\" }}\n\
             mesh = {{ rack = \"rack\", pinion = \"finger\", radius = {radius}, side = \"{side}\"{teeth} }}\n\
             [drives]\nair = {{ slides = \"rack\", from = 30, to = 45, speed = \"50 mm/s\" }}\n"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    for (radius, side) in [(20, "right"), (20, "left"), (60, "right")] {
        fs::write(at.join("m.toml"), text(radius, side, "")).expect("written");
        let output = support::kempe(at, &["draw", "m.toml", "-o", "m.svg"]);
        assert!(output.status.success(), "{}", support::said(&output));
        let svg = fs::read_to_string(at.join("m.svg")).expect("a picture");
        let [strip] = &polygons(&svg)[..] else {
            panic!("{:?}", polygons(&svg));
        };
        let extent = |k: usize| {
            let of = strip.iter().map(|p| p[k]);
            of.clone().fold(f64::MIN, f64::max) - of.fold(f64::MAX, f64::min)
        };
        assert!(extent(1) < 5.0 && extent(1) < extent(0), "{strip:?}");
    }
}
