//! Links upon each other, bars that nearly repeat others, and groups that hold each other.

use super::{Answer, HEAD, ask, check, run, slider_crank};

const STUDY: &str = "[studies.s]\nkind = \"motion\"\nrows = 25\ncolumns = [\"x(B)\"]\n";
const TURN: &str = "turns = \"crank\", from = 0, to = 360";

fn redundant(answer: &Answer) -> (Option<u64>, Option<u64>) {
    let count = |name: &str| answer.value[name].as_u64();
    (count("mobility_rank"), count("redundant"))
}

/// Parallel rods and cranks, one or two too many, before and after those that they repeat.
#[test]
fn what_repeats_a_link_is_assembled_and_told() {
    let single = run(&slider_crank(TURN, "", STUDY)).column("s", "x(B)");
    for (links, more) in [
        ("other = { A-B = 150 }", 1),
        ("other = { B-A = 150 }", 1),
        ("other = { A = [1, 1], B = [91, 121] }", 1),
        ("other = { O-A = 50 }", 1),
        ("one = { A-B = 150 }\ntwo = { B-A = 150 }", 2),
        ("one = { O-A = 50 }\ntwo = { A-B = 150 }", 2),
    ] {
        let before = slider_crank(TURN, links, STUDY);
        let after =
            slider_crank(TURN, "", STUDY).replace("[joints]", &format!("{links}\n[joints]"));
        for text in [before, after] {
            let checked = check(&text);
            assert_eq!(redundant(&checked), (Some(1), Some(more)), "{links}");
            let ran = run(&text);
            for answer in [&checked, &ran] {
                assert_eq!((answer.exit, answer.codes()), (1, vec!["overconstrained"]));
            }
            let found = ran.column("s", "x(B)");
            assert_eq!(found.len(), single.len());
            let apart = found.iter().zip(&single).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-9, "{links}");
        }
    }
}

/// Two links that share two pins leave a turn free that count does not show: it is told, not a length that does not fit.
#[test]
fn links_that_turn_as_one_are_undetermined() {
    for links in [
        "one = { A-C = 30 }\ntwo = { A-C = 30 }",
        "one = { A-C = 30 }\ntwo = { C = [3, 4], A = [21, 28] }",
    ] {
        let text = format!(
            "{HEAD}[links]\nframe = {{ A = [0, 0] }}\ncrank = {{ A-B = 20 }}\n{links}\n\
             [drives]\nm = {{ {TURN}, speed = 1 }}\n"
        );
        let answer = check(&text);
        assert_eq!((answer.exit, answer.codes()[0]), (3, "undetermined"));
        assert!(
            answer.words().contains("they turn as one link"),
            "{}",
            answer.words()
        );
    }
}

/// A triangle of links is rigid: a drive between its sides is told as that, in any order and of any size.
#[test]
fn a_drive_within_a_triangle_is_told() {
    let sides = [("a", "A-B", 3.0), ("b", "B-C", 4.0), ("c", "A-C", 5.0)];
    for order in [[0, 1, 2], [2, 1, 0], [1, 0, 2]] {
        for size in ["1", "1e-5"] {
            let links = order.map(|k: usize| {
                let (name, pins, length) = sides[k];
                format!("{name} = {{ {pins} = \"{length} * {size} m\" }}\n")
            });
            let text = format!(
                "units = {{ angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0] }}\n{}\
                 [drives]\nm = {{ turns = \"a\", relative_to = \"c\", from = 53.13010235415598, to = 100, speed = 10 }}\n",
                links.concat()
            );
            let answer = check(&text);
            assert_eq!((answer.exit, answer.codes()), (3, vec!["undetermined"]));
            let words = answer.words();
            assert!(
                words.contains("a drive between them cannot move them")
                    && words.contains("about A"),
                "{words}"
            );
        }
    }
}

/// A structure whose lengths agree exactly where its drive starts is locked there; it does not lack a pose.
#[test]
fn a_locked_structure_is_no_loop_that_does_not_close() {
    let frame = "frame = { A = [0, 0], D = [60, 0] }";
    let ways = [
        (
            "a = { A-B = 25 }\nb = { B-D = 65 }",
            "m = { turns = \"a\", from = 90, to = 100, speed = 10 }",
        ),
        (
            "b = { D-B = 65 }\na = { A-B = 25 }",
            "m = { turns = \"a\", from = 90, to = 0, speed = 10 }",
        ),
        (
            "a = { A-B = 25 }\nb = { B-D = 65 }",
            "m = { turns = \"a\", at = -90 }",
        ),
        // In line it gives by a hair, and goes nowhere.
        (
            "a = { A-B = 25 }\nb = { B-D = 35 }",
            "m = { turns = \"a\", from = 0, to = 90, speed = 10 }",
        ),
        (
            "a = { A-B = 25 }\nb = { B-D = 85 }",
            "m = { turns = \"a\", from = 180, to = 90, speed = 10 }",
        ),
        (
            "a = { A-B = 30 }\nb = { B-C = 40 }\nc = { A-C = 50 }",
            "m = { turns = \"c\", from = 0, to = 90, speed = 10 }\n\
             n = { turns = \"a\", relative_to = \"c\", from = 53.13010235415598, to = 100, speed = 10 }",
        ),
    ];
    for (links, drives) in ways {
        let text = |links: &str| format!("{HEAD}[links]\n{frame}\n{links}\n[drives]\n{drives}\n");
        for command in ["check", "run"] {
            let answer = ask(&[command], &text(links), &[]);
            assert_eq!(
                (answer.exit, answer.codes()),
                (3, vec!["locked"]),
                "{links}"
            );
            assert!(answer.words().contains("one too many"));
            assert!(!answer.words().contains("no pose"), "{}", answer.words());
            // A length that is off leaves no pose.
            let off = (links.replace("65", "66").replace("40", "41"))
                .replace("35", "36")
                .replace("85", "86");
            let answer = ask(&[command], &text(&off), &[]);
            assert_eq!(
                (answer.exit, answer.codes()),
                (3, vec!["cannot-assemble"]),
                "{links}"
            );
        }
    }
}

/// A law that ends or starts in the middle of the motion where branches meet: which it is, where, and what to do.
#[test]
fn a_law_that_ends_where_branches_meet_is_named() {
    let text = |law: &str| {
        format!(
            "{HEAD}[links]\nframe = {{ A = [0, 0], D = [40, 0], E = [0, 100], H = [50, 100] }}\n\
             crank = {{ A-B = 20 }}\nb = {{ B-C = 40 }}\nc = {{ D-C = 20 }}\n\
             e = {{ E-F = 15 }}\nf = {{ F-G = 45 }}\nh = {{ H-G = 30 }}\n\
             [drives]\nm = {{ turns = \"crank\", {law} }}\nn = {{ turns = \"e\", from = 0, to = 360, speed = 18 }}\n\
             [assembly]\nC = \"left of B -> D\"\nG = \"left of F -> H\"\n"
        )
    };
    for law in [
        "from = 0, to = 360, speed = 36",
        "from = 30, law = [{ to = 180, in = 5 }, { dwell = 5 }, { to = 330, in = 5 }]",
    ] {
        let answer = check(&text(law));
        assert_eq!((answer.exit, answer.codes()), (3, vec!["motion-stuck"]));
        let words = answer.words();
        assert!(words.contains("the law of `m`"), "{words}");
        assert!(!words.contains("the law of `n`"), "{words}");
    }
    let beside = check(&text("from = 30, to = 350, speed = 36"));
    assert_eq!(beside.exit, 0, "{}", beside.words());
}

/// A third crank of a parallelogram whose pivot is off by a little: rank, redundancy, motion and proof say one thing, whether it is
/// placed after the others or together with them.
#[test]
fn bars_that_nearly_repeat_others_are_told_alike_by_all() {
    let text = |off: &str, driven: &str| {
        format!(
            "units = {{ length = \"m\", angle = \"deg\" }}\n[links]\nframe = {{ A = [0, 0], D = [1.3, 0], F = [0.6, 0.4] }}\n\
             crank = {{ A-B = 0.7 }}\nrod = {{ B = [0, 0], C = [1.3, 0], G = [\"0.6 m + {off} m\", 0.4] }}\n\
             rocker = {{ D-C = 0.7 }}\nthird = {{ F-G = 0.7 }}\n\
             [drives]\nm = {{ turns = \"{driven}\", from = 40, to = 130, speed = 10 }}\n\
             [assembly]\nC = {{ near = [1.8, 0.5] }}\nB = {{ near = [0.5, 0.5] }}\n"
        )
    };
    for (driven, off) in [
        ("crank", "0"),
        ("crank", "4e-11"),
        ("crank", "8e-10"),
        ("crank", "-8e-10"),
        ("rocker", "1e-13"),
        ("rocker", "-4e-11"),
        ("third", "-4e-11"),
    ] {
        let answer = ask(&["check", "--certify"], &text(off, driven), &[]);
        let told = (answer.exit, answer.codes());
        assert_eq!(told, (1, vec!["overconstrained"]), "{driven} {off}");
        assert_eq!(redundant(&answer), (Some(1), Some(1)), "{driven} {off}");
        let proof = &answer.value["proof"];
        assert_eq!(proof["redundant"], 1, "{driven} {off}");
        assert!(proof["fraction"].as_f64().expect("a part") > 0.999, "{off}");
    }
    for (driven, off) in [("crank", "1e-5"), ("rocker", "-1e-3")] {
        let answer = check(&text(off, driven));
        let told = (answer.exit, answer.codes());
        assert_eq!(told, (3, vec!["cannot-assemble"]), "{driven} {off}");
    }
}
