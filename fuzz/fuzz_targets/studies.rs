//! Any bytes: what can be read is checked and its studies are run, with bounded work, and the answers are sound.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/study/tests/support/bounded.rs"]
mod bounded;

/// Words of progress that a check or a study may take.
const WORK: usize = 200;
/// What any file holds that a model names: the columns that tables of the examples have.
const TABLE: &str = "t [s],left [deg],right [deg],crank [deg],pressure [bar]\n0,30,60,0,1\n1,40,70,90,4\n2,60,90,200,9\n";

fuzz_target!(|data: &[u8]| {
    bounded::check_and_run(data, &mut |_| Ok(TABLE.to_owned()), WORK);
});
