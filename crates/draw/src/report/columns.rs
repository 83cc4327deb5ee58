//! The columns of a motion's table for the page: every number as it is, in as few bytes as may be.

use super::motion_report::{Column, MotionReport, Note};
use super::rows::Rows;
use super::{base64, json};

/// Names, units and values of all columns, and how many of them are which; their notes.
pub(super) fn columns(motion: &MotionReport, rows: &Rows) -> Vec<(&'static str, String)> {
    let column = |c: &Column| {
        json::object(&[
            ("name", json::string(&c.name)),
            ("unit", json::string(&c.unit)),
            ("v", values(rows, &c.values)),
        ])
    };
    let note = |n: &Note| {
        json::array([
            n.first.to_string(),
            n.last.to_string(),
            json::string(&n.text),
        ])
    };
    vec![
        ("cols", json::array(all(motion).map(column))),
        ("own", motion.columns.len().to_string()),
        ("more", motion.more.len().to_string()),
        ("drive", motion.drive.to_string()),
        ("notes", json::array(motion.notes.iter().map(note))),
        ("mark", json::string(&motion.mark)),
    ]
}

/// All columns: those of the table, what is plotted besides, the evidence.
pub(super) fn all(motion: &MotionReport) -> impl Iterator<Item = &Column> {
    let plotted = motion.columns.iter().chain(&motion.more);
    plotted.chain(&motion.tests)
}

/// The kept values so that each reads back as it is: an array of the shortest numbers, or the bytes of the numbers in base 64.
pub(super) fn values(rows: &Rows, values: &[f64]) -> String {
    let kept = || {
        let of = |row: &usize| values.get(*row).copied().unwrap_or(f64::NAN);
        rows.kept.iter().map(of)
    };
    let bytes: Vec<u8> = kept().flat_map(f64::to_le_bytes).collect();
    let packed = json::string(&base64::encoded(&bytes));
    if kept().any(f64::is_infinite) {
        return packed;
    }
    let plain = json::array(kept().map(shortest));
    match plain.len() <= packed.len() {
        true => plain,
        false => packed,
    }
}

/// The shortest text that reads back as the number.
fn shortest(value: f64) -> String {
    if value.is_nan() {
        return "null".into();
    }
    let (plain, power) = (value.to_string(), format!("{value:e}"));
    match plain.len() <= power.len() {
        true => plain,
        false => power,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_number_reads_back(value in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO) {
            let back: f64 = shortest(value).parse().unwrap();
            prop_assert_eq!(back.to_bits(), value.to_bits());
        }
    }

    #[test]
    fn what_has_many_digits_is_packed_and_what_is_infinite_too() {
        let rows = Rows {
            all: 3,
            kept: vec![0, 1, 2],
        };
        assert_eq!(values(&rows, &[0.0, 90.5, f64::NAN]), "[0,90.5,null]");
        assert_eq!(
            values(&rows, &[1.0, f64::INFINITY]),
            "\"AAAAAAAA8D8AAAAAAADwfwAAAAAAAPh/\""
        );
        let odd = [0.1_f64 + 0.2, 1.0 / 3.0, 2.0 / 3.0];
        assert!(values(&rows, &odd).starts_with('"'));
    }
}
