//! Numbers over a motion: never less than its own rows and tables show, and told where they have no value.

use std::f64::consts::{PI, TAU};

use super::{Answer, HEAD, ask, crank_rocker, run, slider_crank};

/// No row of this column lies beyond these numbers.
fn holds_its_rows(answer: &Answer, study: &str, column: &str, [low, high]: [&str; 2]) {
    let numbers = answer.numbers();
    let (low, high) = (numbers[low], numbers[high]);
    let slack = 1e-12 * (high - low);
    let rows = answer.column(study, column);
    assert!(rows.len() > 100);
    for x in rows {
        assert!(
            low - slack <= x && x <= high + slack,
            "{x}: {low} to {high}"
        );
    }
}

/// A load that is 1 N but for a peak of 77 N that no row sees, over a place, over time and as a formula of a speed.
#[test]
fn a_narrow_peak_of_a_load_is_in_the_numbers_and_in_what_it_does() {
    let over_place = "x [mm],F [N]\n-100,1\n10,1\n10.001,77\n10.002,1\n200,1\n";
    let over_time = "t [s],F [N]\n0,1\n0.5,1\n0.50001,77\n0.50002,1\n10,1\n";
    for (load, table) in [
        ("{ table = \"card.csv\", over = \"x(P)\" }", over_place),
        ("{ table = \"card.csv\", over = \"time\" }", over_time),
        (
            "\"1 N + 76 N * exp(-((angular_speed(rocker) - 1 rad/s) / (0.0001 rad/s))^2)\"",
            "",
        ),
        (
            "\"1 N + 76 N * max(0, 1 - abs(angle(rocker) - 120 deg) / (0.001 deg))\"",
            "",
        ),
    ] {
        let text = crank_rocker(&format!(
            "[loads]\ng = {{ force = [{load}, 0], at = \"P\" }}\n\
             [measures]\nhigh = \"max(load(g))\"\nlow = \"min(load(g))\"\nmost = \"max(torque(m))\"\nleast = \"min(torque(m))\"\n\
             [studies.f]\nkind = \"forces\"\nrows = 361\ncolumns = [\"torque(m)\", \"load(g)\"]\n"
        ));
        let answer = ask(&["run"], &text, &[("card.csv", table)]);
        assert_eq!((answer.exit, answer.codes()), (0, vec![]), "{load}");
        let numbers = answer.numbers();
        assert!((numbers["high"] - 77.0).abs() < 1e-6, "{load}: {numbers:?}");
        assert!((numbers["low"] - 1.0).abs() < 1e-6, "{load}: {numbers:?}");
        holds_its_rows(&answer, "f", "load(g)", ["low", "high"]);
        holds_its_rows(&answer, "f", "torque(m)", ["least", "most"]);
        // The load works on P: the torque's peak is 77 times what it is at the same place under 1 N.
        let largest = numbers["most"].max(-numbers["least"]);
        let rows = answer.column("f", "torque(m)");
        let in_rows = rows.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        assert!(largest > 5.0 * in_rows, "{load}: {largest} {in_rows}");
    }
}

/// The spline through points that lie unevenly overshoots between them, far beyond what 16 steps to a segment show.
#[test]
fn a_law_by_points_reaches_as_far_as_its_spline() {
    let turn = "t [s],q [deg]\n0,0\n1,180\n1.001,181\n1.002,181\n2,360\n";
    let text = crank_rocker(
        "[measures]\nhigh = \"max(m)\"\nlow = \"min(m)\"\nfast = \"max(rate(m))\"\nslow = \"min(rate(m))\"\n\
         [studies.s]\nkind = \"motion\"\nrows = 2001\ncolumns = [\"m\", \"rate(m)\"]\n",
    )
    .replace(
        "from = 0, to = 360, speed = \"5 rad/s\"",
        "law = { table = \"law.csv\", time = \"t\", value = \"q\" }",
    );
    for command in ["check", "run"] {
        let answer = ask(&[command], &text, &[("law.csv", turn)]);
        assert_eq!((answer.exit, answer.codes()), (0, vec![]), "{command}");
        if command == "run" {
            holds_its_rows(&answer, "s", "m", ["low", "high"]);
            holds_its_rows(&answer, "s", "rate(m)", ["slow", "fast"]);
        }
    }
    // A block between its ends by the table, and beyond them by the spline: both commands know.
    let slide = "t [s],x [mm]\n0,150\n0.1,195\n1,195\n1.1,150\n";
    let text = slider_crank(
        "slides = \"block\", law = { table = \"law.csv\", time = \"t\", value = \"x\" }",
        "",
        "[studies.s]\nkind = \"motion\"\nrows = 201\n",
    )
    .replace(", speed = \"1 rad/s\"", "")
    .replace("B = { near = [200, 0] }", "A = \"left of O -> B\"");
    let told: Vec<(i32, bool)> = ["check", "run"]
        .map(|command| {
            let answer = ask(&[command], &text, &[("law.csv", slide)]);
            (answer.exit, answer.codes().contains(&"range-beyond-limit"))
        })
        .to_vec();
    assert_eq!(told, [(3, true); 2]);
}

/// A toggle within the motion, and a pole right at its beginning.
#[test]
fn what_is_infinite_is_told_with_its_place() {
    let study = "[studies.s]\nkind = \"motion\"\nrows = 341\ncolumns = [\"gain\"]\n";
    let block = slider_crank(
        "turns = \"crank\", from = 10, to = 350",
        "",
        &format!(
            "[measures]\ngain = \"mechanical_advantage(x(B), m)\"\nhigh = \"max(gain)\"\n{study}"
        ),
    );
    let begins = crank_rocker(&format!(
        "[measures]\ngain = \"1 / m\"\nhigh = \"max(gain)\"\n{study}"
    ));
    for (text, place) in [(block, "m = 180 deg"), (begins, "m = 0 deg")] {
        let answer = run(&text);
        assert_eq!((answer.exit, answer.codes()[0]), (1, "infinite"));
        assert!(
            answer.words().contains(place) && answer.words().contains("`high` is infinite"),
            "{}",
            answer.words()
        );
        assert!(!answer.numbers().contains_key("high"));
    }
}

/// Means of what is fast and of what is weakly infinite, by their closed forms; those that diverge have none.
#[test]
fn means_are_right_to_the_digits_that_are_told_or_have_no_value() {
    let root = (2.0_f64.sqrt() + (TAU - 2.0).sqrt()) * 2.0 / TAU;
    let logarithm = TAU.ln() - 1.0;
    for (of, truth) in [
        ("abs(cos(700 * m))", Some(2.0 / PI)),
        ("abs(sin(300 * m + 1 rad))", Some(2.0 / PI)),
        ("1 / sqrt(abs(m / 1 rad - 2))", Some(root)),
        ("ln(m / 1 rad)", Some(logarithm)),
        ("1 / (m / 1 rad - 2)^2", None),
        ("tan(m)", None),
        ("1 / sin(m / 2)", None),
    ] {
        let answer = run(&crank_rocker(&format!(
            "[measures]\nmean = \"mean({of})\"\n[studies.s]\nkind = \"motion\"\nrows = 7\n"
        )));
        let found = answer.numbers().get("mean").copied();
        match (truth, found) {
            (Some(truth), Some(found)) => {
                let told = !answer.codes().is_empty();
                let allowed = if told { 1e-4 } else { 1e-8 };
                assert!(
                    (found / truth - 1.0).abs() < allowed,
                    "{of}: {found} {truth}"
                );
            }
            (None, None) => {
                assert_eq!(answer.exit, 1, "{of}");
                assert!(answer.codes().contains(&"diverges"), "{of}");
            }
            (_, found) => panic!("{of}: {found:?} {:?}", answer.codes()),
        }
    }
}

/// A ram under a load at either end of its way, and its crank the other way: friction holds it where the load would drive
/// without friction and must be driven with it.
#[test]
fn self_locking_is_told_in_the_rows_where_the_load_no_longer_drives() {
    let text = |load: i32, range: &str, coefficient: f64| {
        format!(
            "{HEAD}[links]\nframe = {{ A = [0, 0], E = [0, 0], G = [300, 0] }}\ncrank = {{ A-B = 10 }}\n\
             rod = {{ B-C = 60 }}\nram = {{ C = [0, 0] }}\n\
             [joints]\nway = {{ slider = \"ram\", at = \"C\", on = \"E -> G\" }}\n\
             [loads]\nw = {{ force = [\"{load} N\", 0], at = \"C\", on = \"ram\" }}\n\
             [friction]\nall = {{ coefficient = {coefficient}, radius = \"12 mm\" }}\n\
             [drives]\nm = {{ turns = \"crank\", {range}, speed = \"1 rad/s\" }}\n[assembly]\nC = {{ near = [70, 0] }}\n\
             [studies.s]\nkind = \"forces\"\nstep = 5\ncolumns = [\"torque(m)\", \"power(m)\"]\n"
        )
    };
    for (load, range) in [
        (-1000, "from = -30, to = 30"),
        (1000, "from = -30, to = 30"),
        (-1000, "from = 30, to = -30"),
        (1000, "from = 150, to = 210"),
    ] {
        let free = run(&text(load, range, 1e-9)).column("s", "power(m)");
        let answer = run(&text(load, range, 0.3));
        let rows = answer.rows("s");
        assert_eq!((rows.len(), free.len()), (13, 13));
        let mut held = 0;
        for (row, free) in rows.iter().zip(free) {
            // At the dead point itself nothing is driven.
            if free.abs() < 1e-6 {
                continue;
            }
            let rubbed: f64 = row["power(m)"].parse().expect("a number");
            let locked = free < 0.0 && rubbed > 0.0;
            assert_eq!(row["note"].contains("self-locking"), locked, "{row:?}");
            held += usize::from(locked);
        }
        assert!(held >= 5, "{load} {range}: {held}");
        assert_eq!((answer.exit, answer.codes()), (1, vec!["self-locking"]));
        // With little of it the load drives in every row but that of the dead point.
        let slippery = run(&text(load, range, 0.01));
        assert_eq!(slippery.exit, 0, "{:?}", slippery.codes());
    }
}
