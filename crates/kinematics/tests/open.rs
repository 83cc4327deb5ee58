//! Known weaknesses, each with its file: run with `--ignored`, and move out of here what passes.
#![allow(clippy::unwrap_used)]

mod support;

use support::Case;

fn open(name: &str) -> Case {
    let path = format!("{}/tests/open/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Case::read(&std::fs::read_to_string(path).unwrap(), name)
}

/// A gear pair inside a loop of ten links, no hints: the complete method does not apply to gears, and none of the random
/// starts leads to the pose from which the dimensions were measured.
#[test]
#[ignore = "open: blocks with gears are searched from random starts"]
fn a_gear_in_a_loop_without_hints_is_assembled() {
    assert!(open("gear-in-loop").motion().is_ok());
}
