//! Motions near change points, on change points and on dead points.

use std::f64::consts::PI;

use super::{Answer, HEAD, check, run, slider_crank};

fn events(answer: &Answer) -> String {
    let owner = match answer.value["studies"][0]["events"].is_null() {
        true => &answer.value["events"],
        false => &answer.value["studies"][0]["events"],
    };
    owner.to_string().replace('-', " ")
}

/// Lengths a little off those of a change point, as files hold them that were rounded to 12 digits: `check` and `run` say the same,
/// and where the excess is more than rounding it is the truth by the cosine law.
#[test]
fn near_a_change_point_check_and_run_say_the_same() {
    for power in 5..=13 {
        for sign in [1.0, -1.0, 0.0] {
            let off = sign * 10.0_f64.powi(-power);
            // The crank is the shortest: its coupler reaches the rocker's end with the rocker in line at half a turn.
            let rocker = 30.0 + off;
            let text = format!(
                "{HEAD}[links]\nframe = {{ A = [0, 0], D = [60, 0] }}\ncrank = {{ A-B = 20 }}\ncoupler = {{ B-C = 50 }}\n\
                 rocker = {{ D-C = {rocker} }}\n[drives]\nm = {{ turns = \"crank\", from = -90, to = 270, speed = 1 }}\n\
                 [assembly]\nC = \"left of B -> D\"\n[studies.s]\nkind = \"motion\"\nrows = 37\n"
            );
            let (checked, ran) = (check(&text), run(&text));
            let clear = power <= 8;
            let limited = off < 0.0;
            let told = |answer: &Answer| {
                let codes = answer.codes();
                (answer.exit, codes.contains(&"range-beyond-limit"))
            };
            assert_eq!(told(&checked), told(&ran), "{off}");
            if clear && sign != 0.0 {
                let expected = if limited { (3, true) } else { (0, false) };
                assert_eq!(told(&checked), expected, "{off}");
                let most = checked.value["reach_si"][1].as_f64().expect("an end");
                if limited {
                    let reach = 50.0 + rocker;
                    let cosine = (400.0 + 3600.0 - reach * reach) / 2400.0;
                    assert!((most - cosine.acos()).abs() < 1e-6, "{off}: {most}");
                }
            }
            if sign == 0.0 || power >= 11 {
                assert_eq!(told(&checked), (0, false), "{off}");
                assert!(events(&checked).contains("change point"), "{off}");
                assert!(events(&ran).contains("change point"), "{off}");
            }
        }
    }
}

/// Several drives that begin and end right on change points: all rows are there and belong to the mechanism.
#[test]
fn rows_on_change_points_at_both_ends_are_there() {
    let other = "n = { turns = \"other\", from = 0, to = 90, speed = 10 }";
    let held = "n = { turns = \"other\", at = 30 }";
    for (from, near, second) in [
        (0, [80.0, 1.0], other),
        (0, [80.0, 1.0], held),
        (180, [40.0, -1.0], other),
        (180, [40.0, -1.0], held),
    ] {
        let first = format!(
            "m = {{ turns = \"crank\", from = {from}, to = {}, speed = 10 }}",
            from + 360
        );
        for drives in [format!("{first}\n{second}"), format!("{second}\n{first}")] {
            let text = format!(
                "{HEAD}[links]\nframe = {{ A = [0, 0], D = [60, 0], F = [200, 0] }}\ncrank = {{ A-B = 20 }}\nrod = {{ B-C = 60 }}\n\
                 rocker = {{ D-C = 20 }}\nother = {{ F-G = 10 }}\n[drives]\n{drives}\n[assembly]\nC = {{ near = {near:?} }}\n\
                 [studies.s]\nkind = \"motion\"\nrows = 37\ncolumns = [\"x(B)\", \"y(B)\", \"x(C)\", \"y(C)\"]\n"
            );
            let answer = run(&text);
            assert_eq!((answer.exit, answer.codes()), (0, vec![]), "{drives}");
            let rows = answer.rows("s");
            assert_eq!(rows.len(), 37);
            for row in &rows {
                let [bx, by, cx, cy] = ["x(B)", "y(B)", "x(C)", "y(C)"]
                    .map(|name| row[name].parse::<f64>().expect("a number"));
                let rod = (cx - bx).hypot(cy - by);
                let rocker = (cx - 60.0).hypot(cy);
                assert!(
                    (rod - 60.0).abs() < 1e-9 && (rocker - 20.0).abs() < 1e-9,
                    "{row:?}"
                );
            }
            for row in [&rows[0], &rows[36]] {
                assert!(row["note"].contains("change point"), "{row:?}");
            }
        }
    }
}

/// A circuit starts at the very dead point that its file names, whichever it is and whatever is driven.
#[test]
fn a_circuit_starts_on_a_dead_point() {
    // Rod and rocker in line by the cosine law, to the last bits.
    let line = ((2.5_f64 * 2.5 + 9.0 - 4.2 * 4.2) / 15.0).acos();
    let rocker = |from: f64, side: &str| {
        format!(
            "units = {{ length = \"m\", angle = \"rad\" }}\n[links]\nframe = {{ A = [0, 0], D = [3, 0] }}\ncrank = {{ A-B = 2.5 }}\n\
             rod = {{ B-C = 2 }}\nrocker = {{ D-C = 2.2 }}\n[drives]\nm = {{ turns = \"crank\", from = {from}, to = 1, speed = 1 }}\n\
             [assembly]\nC = \"{side} of B -> D\"\n[studies.s]\nkind = \"motion\"\ncircuit = true\nrows = 41\ncolumns = [\"m\"]\n"
        )
    };
    let block = |from: i32| {
        slider_crank(
            &format!("slides = \"block\", from = {from}, to = 150"),
            "",
            "[studies.s]\nkind = \"motion\"\ncircuit = true\nrows = 41\ncolumns = [\"m\"]\n",
        )
        .replace("1 rad/s", "10 mm/s")
        .replace("B = { near = [200, 0] }", "A = \"left of O -> B\"")
    };
    for (text, from) in [
        (rocker(line, "left"), line),
        (rocker(line, "right"), line),
        (rocker(-line, "left"), -line),
        (block(200), 200.0),
        (block(100), 100.0),
    ] {
        let answer = run(&text);
        assert_eq!((answer.exit, answer.codes()), (0, vec![]), "{text}");
        let rows = answer.column("s", "m");
        assert_eq!(rows.len(), 41);
        for end in [rows[0], rows[40]] {
            assert!((end - from).abs() < 1e-13 * from.abs() * PI, "{end} {from}");
        }
    }
}
