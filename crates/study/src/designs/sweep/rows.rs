//! The rows of all designs of a sweep as Parquet, part by part.

use std::io::{self, Write};
use std::ops::Range;

use kempe_model::{Diagnostic, Model, Study, StudyKind};

use super::part::Part;
use super::parts::{FILE_NUMBERS, Layout};
use super::question::Question;
use crate::designs::kept_parts::Parts;
use crate::encode::{ParquetError, ParquetWriter};

/// Why rows are not written.
#[derive(Debug)]
pub enum RowsError {
    /// A part is not to be had.
    Part(Box<Diagnostic>),
    /// They cannot be written.
    Written(io::Error),
}

impl From<ParquetError> for RowsError {
    fn from(error: ParquetError) -> Self {
        Self::Written(match error {
            // What the disk said is of more use than that somebody said it.
            ParquetError::External(inner) => match inner.downcast::<io::Error>() {
                Ok(error) => *error,
                Err(other) => io::Error::other(other),
            },
            other => io::Error::other(other),
        })
    }
}

/// The files with the rows of all designs of a sweep: one, or as many as hold them.
pub struct RowFiles<'m> {
    name: &'m str,
    question: Question<'m>,
    layout: Layout,
    /// By file: its parts.
    files: Vec<Range<usize>>,
}

impl<'m> RowFiles<'m> {
    /// Those of a study, with 4 GiB of numbers in a file. None of other studies than sweeps, and of rows that would have no room.
    pub fn of(model: &'m Model, study: &'m Study) -> Option<Self> {
        Self::with_numbers(model, study, FILE_NUMBERS)
    }

    /// The same, with so many numbers in a file.
    pub fn with_numbers(model: &'m Model, study: &'m Study, most: f64) -> Option<Self> {
        let StudyKind::Sweep(asked) = &study.kind else {
            return None;
        };
        if super::is_over_designs(model, asked) {
            return None;
        }
        let question = Question::new(model, &study.name, asked, &mut kempe_motion::Silent).ok()?;
        let layout = Layout::of(&question);
        (layout.row_room() && layout.count() > 0).then(|| Self {
            name: &study.name,
            question,
            layout,
            files: layout.row_files(most),
        })
    }

    /// How many files there are.
    pub fn count(&self) -> usize {
        self.files.len()
    }

    /// Writes one of them as a Parquet file, a group of rows for each part.
    ///
    /// # Errors
    ///
    /// Those of the parts and of the file.
    pub fn write<W: Write + Send>(
        &self,
        file: usize,
        parts: &mut dyn Parts,
        metadata: &[(String, String)],
        to: W,
    ) -> Result<(), RowsError> {
        let question = &self.question;
        let mut written = ParquetWriter::new(to, &question.row_table(), metadata)?;
        for number in self.files.get(file).cloned().unwrap_or_default() {
            let designs = self.layout.designs(number);
            let bytes = parts.kept(number).map_err(RowsError::Part)?;
            let part = bytes
                .and_then(|bytes| Part::from_bytes(question, designs.start, designs.len(), &bytes));
            let rows = part.and_then(|part| part.rows).ok_or_else(|| {
                let message = format!("part {} of `{}` is gone", number + 1, self.name);
                RowsError::Part(Box::new(Diagnostic::error("part-missing", message)))
            })?;
            written.write(&rows)?;
        }
        written.close()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{RowsError, io};
    use crate::encode::ParquetError;

    #[test]
    fn a_full_disk_is_told_as_one() {
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let RowsError::Written(told) = ParquetError::from(full).into() else {
            panic!("it was written to");
        };
        assert_eq!(told.kind(), io::ErrorKind::StorageFull);
    }
}
