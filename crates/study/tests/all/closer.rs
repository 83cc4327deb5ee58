//! The tables of docs/door-closer.md are what the examples give.
#![allow(clippy::unwrap_used)]

use kempe_model::Model;
use kempe_study::{Silent, run};

const PAGE: &str = include_str!("../../../../docs/door-closer.md");
const ONE: &str = include_str!("../../../../examples/seeds/door-closer.toml");
const TWO: &str = include_str!("../../../../examples/gallery/two-valve-closer.toml");

/// Closing time, s, and speed of the door's edge there, mm/s.
fn closing(text: &str, set: &[(&str, &str)]) -> [f64; 2] {
    let set: Vec<(String, String)> = (set.iter())
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    let read = Model::from_toml_with(text, "x.toml", &mut |_| Err(String::new()), &set);
    let model = read.unwrap().model;
    let study = model.studies.iter().find(|s| s.name == "closing").unwrap();
    let result = run(&model, study, &mut Silent).unwrap();
    assert!(result.diagnostics.is_empty(), "{:#?}", result.diagnostics);
    let last = |name: &str| *result.table.column(name).unwrap().values.last().unwrap();
    [last("time"), last("speed(X)")]
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
