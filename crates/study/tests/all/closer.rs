//! The tables of docs/door-closer.md are what the examples give.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Silent, run};

const PAGE: &str = include_str!("../../../../docs/door-closer.md");
const ONE: &str = include_str!("../../../../examples/seeds/door-closer.toml");
const TWO: &str = include_str!("../../../../examples/gallery/two-valve-closer.toml");

/// Closing time, s, and speed of the door's edge there, mm/s.
fn closing(text: &str, set: &[(&str, &str)]) -> [f64; 2] {
    let [time, last, _] = closed(text, set);
    [time, last]
}

/// The same, and the largest speed of the edge on its way.
fn closed(text: &str, set: &[(&str, &str)]) -> [f64; 3] {
    let set: Vec<(String, String)> = (set.iter())
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    let read = Model::from_toml_with(text, "x.toml", &mut |_| Err(String::new()), &set);
    let model = read.unwrap().model;
    let study = model.studies.iter().find(|s| s.name == "closing").unwrap();
    let result = run(&model, study, &mut Silent).unwrap();
    assert!(result.diagnostics.is_empty(), "{:#?}", result.diagnostics);
    let column = |name: &str| &result.table.column(name).unwrap().values;
    let last = |name: &str| *column(name).last().unwrap();
    let fastest = column("speed(X)").iter().copied().fold(0.0, f64::max);
    [last("time"), last("speed(X)"), fastest]
}

#[test]
fn the_page_tells_what_the_examples_give() {
    let mut rows = 0;
    for line in PAGE.lines().filter(|line| line.contains(" N m s |")) {
        let cells: Vec<&str> = line
            .split('|')
            .map(str::trim)
            .filter(|c| !c.is_empty())
            .collect();
        let found = match cells[..cells.len() - 2] {
            [valve] => closing(ONE, &[("valve", valve)]),
            [sweep, latch] => closing(TWO, &[("sweep", sweep), ("latch", latch)]),
            _ => panic!("{line}"),
        };
        let [time, speed] = found;
        let told = [format!("{time:.2} s"), format!("{speed:.0} mm/s")];
        assert_eq!(told.as_slice(), &cells[cells.len() - 2..], "{line}");
        rows += 1;
    }
    assert_eq!(rows, 13);
}

#[test]
fn a_program_apart_finds_the_same() {
    // Circles, velocities of the links by their loop, reduced mass, Runge-Kutta of order 4: agrees with itself to 1e-12.
    for (found, time, speed) in [
        (closing(ONE, &[]), 3.874481034360, 0.2308024520118568),
        (
            closing(TWO, &[("sweep", "10 N m s"), ("latch", "20 N m s")]),
            3.418611136179325,
            0.1554393547607339,
        ),
    ] {
        assert!((found[0] / time - 1.0).abs() < 1e-10, "{}", found[0]);
        assert!(
            (found[1] / (900.0 * speed) - 1.0).abs() < 1e-10,
            "{}",
            found[1]
        );
    }
}

/// Both valves chosen: the edge is on its way and at the frame as fast as it may be, and each valve turned either way breaks a limit or takes longer.
#[test]
fn both_valves_are_set_for_the_shortest_time() {
    let read = Model::from_toml(TWO, "x.toml", &mut |_| Err(String::new()));
    let model = read.unwrap().model;
    let study = model.studies.iter().find(|s| s.name == "setting").unwrap();
    let result = run(&model, study, &mut Silent).unwrap();
    assert!(result.diagnostics.is_empty(), "{:#?}", result.diagnostics);
    let number = |name: &str| {
        let mut all = result.scalars.iter();
        all.find(|s| s.name == name).unwrap().value
    };
    let valves = [number("sweep"), number("latch")];
    let with = |by: [f64; 2]| {
        let [sweep, latch] = [0, 1].map(|k| format!("{:.15} N m s", valves[k] * by[k]));
        closed(TWO, &[("sweep", &sweep), ("latch", &latch)])
    };
    let [time, last, fastest] = with([1.0, 1.0]);
    assert!((number("max(time)") - time).abs() < 1e-6 && (time - 3.08498).abs() < 1e-5);
    // Rows are 20 ms apart, so that they may miss the fastest instant a little.
    assert!((last - 150.0).abs() < 1e-3 && (fastest - 700.0).abs() < 0.5);
    assert!((valves[0] - 8.435_45).abs() < 1e-4 && (valves[1] - 19.095_1).abs() < 1e-3);
    for k in 0..2 {
        let [longer, _, _] = with([0, 1].map(|j| if j == k { 1.01 } else { 1.0 }));
        let [_, harder, faster] = with([0, 1].map(|j| if j == k { 0.99 } else { 1.0 }));
        assert!(longer > time + 1e-3, "{k}: {longer}");
        assert!(harder > 150.5 || faster > 700.5, "{k}: {harder} {faster}");
    }
}
