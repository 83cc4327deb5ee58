//! CSV after RFC 4180: one head line, 17 significant digits, empty fields where a row has no value.

use std::fmt::Write as _;

use kempe_model::PARTIAL_TABLE;

use crate::table::Table;

/// The table as CSV text: every number reads back as the same `f64`. Lines end in `\n`.
pub fn csv(table: &Table) -> String {
    let columns = table.with_evidence();
    let mut out = String::new();
    for column in &columns {
        out.push_str(&quoted(&column.head()));
        out.push(',');
    }
    out.push_str("note\n");
    for (row, note) in table.notes.iter().enumerate() {
        for column in &columns {
            let value = column.values.get(row).copied().unwrap_or(f64::NAN);
            push_number(&mut out, value);
            out.push(',');
        }
        out.push_str(&quoted(note.as_deref().unwrap_or("")));
        out.push('\n');
    }
    out
}

/// A table of a study that was stopped, with a first line that says how far it came: `# partial: 12 of 37 rows`. Whatever reads
/// it as a whole table stumbles; Kempe's own readers tell the reason.
pub fn marked_partial(csv: &str, how_far: &str) -> String {
    format!("{PARTIAL_TABLE} {how_far}\n{csv}")
}

/// A number with 17 significant digits, in plain notation where that is readable; nothing for NaN.
pub(super) fn push_number(out: &mut String, value: f64) {
    if value.is_nan() {
        return;
    }
    let size = value.abs();
    let written = if value == 0.0 {
        write!(out, "0")
    } else if value.is_infinite() {
        write!(out, "{}", if value > 0.0 { "inf" } else { "-inf" })
    } else if (1e-4..1e15).contains(&size) {
        // Digits behind the point so that there are 17 in all.
        let text = format!("{value:.16e}");
        let exponent: i32 = text
            .split_once('e')
            .and_then(|(_, e)| e.parse().ok())
            .unwrap_or(0);
        let decimals = (16 - exponent).max(0) as usize;
        write!(out, "{value:.decimals$}")
    } else {
        write!(out, "{value:.16e}")
    };
    debug_assert!(written.is_ok(), "text takes everything");
}

/// A field in quotes where it needs them.
pub(super) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Column;
    use kempe_units::Unit;
    use proptest::prelude::*;

    fn table(values: Vec<f64>) -> Table {
        Table {
            name: "t".into(),
            closure: vec![0.0; values.len()],
            places: 0,
            forces: None,
            smallest_singular_value: vec![f64::NAN; values.len()],
            balance: None,
            notes: vec![None; values.len()],
            columns: vec![Column {
                values,
                ..Column::new("atan2(x(P), y(P))", Unit::one())
            }],
        }
    }

    #[test]
    fn heads_with_commas_and_notes_with_quotes_are_quoted() {
        let mut t = table(vec![1.5]);
        t.notes[0] = Some("not \"reached\", by far".into());
        assert_eq!(
            csv(&t),
            "\"atan2(x(P), y(P)) [1]\",closure [1],smallest_singular_value [1],note\n\
             1.5000000000000000,0,,\"not \"\"reached\"\", by far\"\n"
        );
    }

    #[test]
    fn numbers_have_17_digits() {
        for (value, text) in [
            (0.1, "0.10000000000000001"),
            (117.512_206_516_641_09, "117.51220651664109"),
            (-1e-7, "-9.9999999999999995e-8"),
            (1.0, "1.0000000000000000"),
            (123_456_789.0, "123456789.00000000"),
            (f64::INFINITY, "inf"),
        ] {
            let mut out = String::new();
            push_number(&mut out, value);
            assert_eq!(out, text);
        }
    }

    proptest! {
        #[test]
        fn every_number_reads_back(value in proptest::num::f64::ANY) {
            let mut out = String::new();
            push_number(&mut out, value);
            if value.is_nan() {
                prop_assert_eq!(out, "");
            } else {
                let back: f64 = out.parse().unwrap();
                prop_assert!(back == value, "{} {}", out, value);
                let digits = out.split(['e', 'E']).next().unwrap_or("").chars().filter(char::is_ascii_digit);
                let significant = digits.skip_while(|c| *c == '0').count();
                prop_assert!(value == 0.0 || value.is_infinite() || significant == 17, "{}", out);
            }
        }
    }
}
