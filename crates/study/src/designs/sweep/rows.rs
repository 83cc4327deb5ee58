//! The rows of all designs of a sweep as one Parquet file, part by part.

use std::io::Write;

use kempe_model::{Diagnostic, Model, Study, StudyKind};

use super::part::Part;
use super::parts::{Layout, Parts};
use super::question::Question;
use crate::encode::{ParquetError, ParquetWriter};

/// Why rows are not written.
#[derive(Debug)]
pub enum RowsError {
    /// A part is not to be had.
    Part(Box<Diagnostic>),
    /// They cannot be written.
    Written(ParquetError),
}

impl From<ParquetError> for RowsError {
    fn from(error: ParquetError) -> Self {
        Self::Written(error)
    }
}

/// Writes the rows of all designs of a sweep as a Parquet file, a group of rows for each part. False, and nothing is written, where there are
/// none: of other studies, and where they have no room.
///
/// # Errors
///
/// Those of the parts and of the file.
pub fn write_rows<W: Write + Send>(
    model: &Model,
    study: &Study,
    parts: &mut dyn Parts,
    metadata: &[(String, String)],
    to: W,
) -> Result<bool, RowsError> {
    let StudyKind::Sweep(asked) = &study.kind else {
        return Ok(false);
    };
    let Ok(question) = Question::new(model, &study.name, asked, &mut kempe_motion::Silent) else {
        return Ok(false);
    };
    let layout = Layout::of(&question);
    if !parts.rows() || !layout.row_room || layout.count() == 0 {
        return Ok(false);
    }
    let mut file = ParquetWriter::new(to, &question.row_table(), metadata)?;
    for number in 0..layout.count() {
        let designs = layout.designs(number);
        let bytes = parts.kept(number).map_err(RowsError::Part)?;
        let part = bytes
            .and_then(|bytes| Part::from_bytes(&question, designs.start, designs.len(), &bytes));
        let rows = part.and_then(|part| part.rows).ok_or_else(|| {
            let message = format!("part {} of `{}` is gone", number + 1, study.name);
            RowsError::Part(Box::new(Diagnostic::error("part-missing", message)))
        })?;
        file.write(&rows)?;
    }
    file.close()?;
    Ok(true)
}
