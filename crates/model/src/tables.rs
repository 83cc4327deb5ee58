//! Tables handed over in memory, where there is no disk or none that may be read.

use std::collections::BTreeMap;
use std::fmt::Write;

/// The tables that a model file names, by the names that it gives them.
///
/// Whoever has no files, a page in a browser or a program that computed a curve, puts the tables in here and hands them to
/// the reader. They are read as files are: with the same limits, and the same diagnostics about their heads and cells.
///
/// # Example
///
/// ```
/// use kempe_model::{Model, Tables};
/// let text = r#"
///     [links]
///     frame = { A = [0, 0] }
///     crank = { A-B = 1 }
///     [drives]
///     motor = { turns = "crank", law = { table = "measured" } }
/// "#;
/// let mut tables = Tables::new();
/// tables.insert_columns("measured", &[("t [ms]", &[0.0, 100.0, 250.0]), ("value [deg]", &[10.0, 30.0, 70.0])]);
/// let model = Model::from_toml(text, "crank", &mut tables.files()).unwrap().model;
/// assert_eq!(model.drives[0].law.duration::<f64>(&[]), 0.25);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tables {
    texts: BTreeMap<String, String>,
}

impl Tables {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Enters a table as the text of a CSV file; what had the name before is replaced.
    pub fn insert(&mut self, name: impl Into<String>, csv: impl Into<String>) {
        self.texts.insert(name.into(), csv.into());
    }

    /// Enters a table by its columns: the head of each with its unit, as in `"angle [deg]"`, and its numbers in that unit.
    ///
    /// The numbers are read back to the same bits. Columns of different lengths leave cells empty, numbers that are not
    /// finite are no numbers, and a head with a line end or a comma parts what it should not: the reader tells all of these.
    pub fn insert_columns(&mut self, name: impl Into<String>, columns: &[(&str, &[f64])]) {
        let heads: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
        let rows = columns.iter().map(|(_, cells)| cells.len()).max();
        let mut text = heads.join(",");
        text.push('\n');
        for row in 0..rows.unwrap_or(0) {
            for (i, (_, cells)) in columns.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                if let Some(cell) = cells.get(row) {
                    // writing to a string does not fail
                    let _ = write!(text, "{cell:?}");
                }
            }
            text.push('\n');
        }
        self.insert(name, text);
    }

    /// The CSV text of a table.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.texts.get(name).map(String::as_str)
    }

    /// The tables with their names, in the order of the names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.texts
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()))
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.texts.is_empty()
    }

    /// What [`Model::from_toml`](crate::Model::from_toml) asks for the content of a file.
    pub fn files(&self) -> impl FnMut(&str) -> Result<String, String> + '_ {
        |name| {
            self.texts.get(name).cloned().ok_or_else(|| {
                let near = kempe_units::nearest(name, self.texts.keys().map(String::as_str));
                match near {
                    Some(near) => format!("no table of this name was handed over, but `{near}`"),
                    None => "no table of this name was handed over".to_owned(),
                }
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    const FILE: &str = "[links]\nframe = { A = [0, 0] }\ncrank = { A-B = 1 }\n[drives]\nm = { turns = \"crank\", law = { table = \"t.csv\" } }\n";

    fn listed(tables: &Tables) -> Vec<(&'static str, String)> {
        let found = Model::from_toml(FILE, "", &mut tables.files()).unwrap_err();
        found.into_iter().map(|d| (d.code, d.message)).collect()
    }

    #[test]
    fn columns_are_read_to_the_last_bit() {
        let times = [0.0, 0.1 + 0.2, 1e17, f64::MAX];
        let values = [-0.0, 1.0 / 3.0, 5e-324, -1e-7];
        let mut tables = Tables::new();
        tables.insert_columns("t.csv", &[("t [s]", &times), ("value [rad]", &values)]);
        let text = tables.get("t.csv").unwrap();
        let cells = text.lines().skip(1).flat_map(|line| line.split(','));
        let read: Vec<u64> = cells.map(|c| c.parse::<f64>().unwrap().to_bits()).collect();
        let put: Vec<u64> = (times.iter().zip(&values))
            .flat_map(|(t, x)| [t.to_bits(), x.to_bits()])
            .collect();
        assert_eq!(read, put);
    }

    #[test]
    fn what_is_wrong_is_told_as_of_a_file() {
        let mut tables = Tables::new();
        assert_eq!(listed(&tables)[0].0, "table-unreadable");
        tables.insert_columns("t.cvs", &[("t", &[0.0, 1.0]), ("value", &[0.0, 1.0])]);
        assert!(listed(&tables)[0].1.contains("but `t.cvs`"));
        for (columns, code) in [
            (
                &[("t", &[0.0, 1.0][..]), ("value", &[0.0])][..],
                "table-values",
            ),
            (
                &[("t", &[0.0, 1.0]), ("value", &[0.0, f64::NAN])],
                "table-values",
            ),
            (
                &[("t", &[0.0, 0.0]), ("value", &[0.0, 1.0])],
                "table-values",
            ),
            (&[("t", &[0.0, 1.0])], "table-column"),
            (
                &[("t", &[0.0, 1.0]), ("value [mm]", &[0.0, 1.0])],
                "unit-mismatch",
            ),
            (&[], "table-column"),
        ] {
            tables.insert_columns("t.csv", columns);
            assert_eq!(listed(&tables)[0].0, code, "{columns:?}");
        }
    }
}
