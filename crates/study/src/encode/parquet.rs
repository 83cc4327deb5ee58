//! Parquet: one column of doubles a quantity, units and origin in the key-value metadata.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
pub use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::table::Table;

/// Rows written at a time.
const GROUP: usize = 1 << 17;

/// The table as a Parquet file. Values that a row has not are null. `metadata` goes into the file's key-value metadata
/// besides the columns' units (`unit:NAME`).
///
/// # Errors
///
/// Those of the encoder.
pub fn parquet(table: &Table, metadata: &[(String, String)]) -> Result<Vec<u8>, ParquetError> {
    let mut bytes = Vec::new();
    let mut file = ParquetWriter::new(&mut bytes, table, metadata)?;
    file.write(table)?;
    file.close()?;
    Ok(bytes)
}

/// Writes a Parquet file group by group of rows.
pub(crate) struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
}

impl<W: Write + Send> ParquetWriter<W> {
    /// A file for tables with the columns of this one.
    ///
    /// # Errors
    ///
    /// Those of the encoder.
    pub fn new(to: W, table: &Table, metadata: &[(String, String)]) -> Result<Self, ParquetError> {
        let columns = table.with_evidence();
        let mut fields = Vec::with_capacity(columns.len() + 1);
        for column in &columns {
            let head = column.head();
            let field = Type::primitive_type_builder(&head, PhysicalType::DOUBLE)
                .with_repetition(Repetition::OPTIONAL);
            fields.push(Arc::new(field.build()?));
        }
        let note = Type::primitive_type_builder("note", PhysicalType::BYTE_ARRAY)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(Some(LogicalType::String));
        fields.push(Arc::new(note.build()?));
        let schema = Type::group_type_builder("table")
            .with_fields(fields)
            .build()?;

        let mut entries: Vec<KeyValue> = metadata
            .iter()
            .map(|(k, v)| KeyValue::new(k.clone(), v.clone()))
            .collect();
        entries.push(KeyValue::new("study".to_owned(), table.name.clone()));
        for column in &columns {
            let key = format!("unit:{}", column.name);
            entries.push(KeyValue::new(key, column.unit.text().to_owned()));
        }
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_created_by(format!("kempe {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(entries))
            .build();
        let file = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
        Ok(Self { file })
    }

    /// Writes the rows of a table, in groups of their own.
    ///
    /// # Errors
    ///
    /// Those of the encoder.
    pub fn write(&mut self, table: &Table) -> Result<(), ParquetError> {
        let columns = table.with_evidence();
        let mut start = 0;
        while start < table.rows() || start == 0 {
            let end = (start + GROUP).min(table.rows());
            let mut group = self.file.next_row_group()?;
            for column in &columns {
                let block = column.values.get(start..end).unwrap_or(&[]);
                let there: Vec<i16> = block.iter().map(|v| i16::from(!v.is_nan())).collect();
                let values: Vec<f64> = block.iter().copied().filter(|v| !v.is_nan()).collect();
                if let Some(mut writer) = group.next_column()? {
                    writer
                        .typed::<DoubleType>()
                        .write_batch(&values, Some(&there), None)?;
                    writer.close()?;
                }
            }
            let block = table.notes.get(start..end).unwrap_or(&[]);
            let there: Vec<i16> = block.iter().map(|n| i16::from(n.is_some())).collect();
            let values: Vec<ByteArray> =
                block.iter().flatten().map(|n| n.as_str().into()).collect();
            if let Some(mut writer) = group.next_column()? {
                writer
                    .typed::<ByteArrayType>()
                    .write_batch(&values, Some(&there), None)?;
                writer.close()?;
            }
            group.close()?;
            start = end.max(1);
        }
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    ///
    /// Those of the encoder.
    pub fn close(self) -> Result<(), ParquetError> {
        self.file.close()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Column;
    use kempe_units::Unit;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    #[test]
    fn columns_units_and_gaps_read_back() {
        let table = Table {
            name: "turn".into(),
            columns: vec![Column {
                values: vec![0.1, f64::NAN, -3e200],
                ..Column::new("swing", Unit::parse("deg").unwrap())
            }],
            closure: vec![1e-16, f64::NAN, 0.0],
            places: 0,
            forces: None,
            smallest_singular_value: vec![0.5; 3],
            balance: None,
            notes: vec![None, Some("not reached, é".into()), None],
        };
        let origin = [("model".to_owned(), "abc".to_owned())];
        let bytes = parquet(&table, &origin).unwrap();
        assert_eq!(bytes, parquet(&table, &origin).unwrap(), "same bytes twice");
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let metadata = reader.metadata().file_metadata();
        let entries = metadata.key_value_metadata().unwrap();
        let value = |key: &str| {
            let found = entries.iter().find(|e| e.key == key);
            found.and_then(|e| e.value.clone()).unwrap()
        };
        assert_eq!(
            (value("model"), value("unit:swing")),
            ("abc".into(), "deg".into())
        );
        assert_eq!(metadata.schema_descr().column(0).name(), "swing [deg]");
        let rows: Vec<_> = reader
            .get_row_iter(None)
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0].get_double(0).unwrap(), 0.1);
        assert!(rows[1].get_double(0).is_err());
        assert_eq!(rows[2].get_double(0).unwrap(), -3e200);
        assert_eq!(rows[1].get_string(3).unwrap(), "not reached, é");
    }

    #[test]
    fn a_table_without_rows_is_a_file() {
        let table = Table {
            name: "none".into(),
            columns: vec![],
            closure: vec![],
            places: 0,
            forces: None,
            smallest_singular_value: vec![],
            balance: None,
            notes: vec![],
        };
        let bytes = parquet(&table, &[]).unwrap();
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
    }
}
