//! The keys of studies that adjust.

use super::of_studies::STUDY_KINDS;
use super::row::{NONE, kind, may, must};
use crate::keys::{Key, Kind, Named, Takes as T};

/// So many parameters may be unknown.
pub(crate) const MAX_UNKNOWN: usize = 16;

static ROWS: T = T::List(&T::Values(&T::AnyValue), 1);

pub(crate) static STUDY: Kind = kind("study", "adjust",
    "kind = \"adjust\", unknown = [\"a\", \"b\"], match = [{ lever = \"30 deg\", box = \"100.248 deg\" }, { lever = \"50 deg\", box = \"67.321 deg\" }]",
    "The values of some parameters with which the mechanism does what was measured on it.",
    &[&[
        must("kind", STUDY_KINDS, "\"adjust\"", "What kind of study it is."),
        must("unknown", T::List(&T::Name(Named::Parameter), 1), "[\"a\", \"b\"]", "The parameters that are looked for, from the values that the file gives them."),
        must("match", T::AnyOf(&[ROWS, T::Table(&TABLE)]), "[{ lever = \"30 deg\", box = \"100.248 deg\" }]", "What was measured together: where drives stood, and the angles of links or values of measures there, by their names. A row without a drive tells of the whole motion."),
        may("deviations", T::Values(&T::AnyValue), "{ box = \"0.3 deg\" }", "Standard deviations of what was measured, by the same names: they weigh the rows, and confidence follows from them."),
        may("bounds", T::Values(&T::Two(&T::AnyOf(&[T::AnyValue, T::Words(NONE)]))), "{ a = [\"20 mm\", \"200 mm\"] }", "Between which values a parameter is looked for."),
    ]]);

static TABLE_KEYS: [Key; 2] = [
    must("table", T::Name(Named::File), "\"measured.csv\"", "The file, in the model's folder."),
    may("columns", T::Values(&T::Name(Named::Column)), "{ lever = \"A\", box = \"B\" }", "The heads of the columns, by the names of the drives, links and measures they are of; without it the heads that are such names."),
];

pub(crate) static TABLE: Kind = kind("measured table", "match",
    "match = { table = \"measured.csv\", columns = { lever = \"A\", box = \"B\" } }",
    "What was measured, row by row in a table beside the file.",
    &[&TABLE_KEYS]);
