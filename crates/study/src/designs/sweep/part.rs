//! A part of a sweep: what is known of some designs that follow each other, and the bytes that tell it.

use super::answer::Answer;
use super::question::Question;
use crate::table::{ForceColumns, Table};

/// Designs of a part at least, unless there are fewer.
const FEWEST: usize = 16;
/// Parts of a sweep about, where that makes them larger.
const MANY: usize = 1024;
/// Numbers in the rows of a part at most, unless one design has more.
const MOST_NUMBERS: f64 = (8 << 20) as f64;

/// How many designs a part has, by all designs and the numbers in the rows of one: the study alone decides. Of those that each take long it is one, if that
/// does not make too many parts.
pub(super) fn designs_in_part(designs: usize, numbers: f64, each_long: bool) -> usize {
    let wanted = designs.div_ceil(MANY);
    let wanted = if each_long {
        wanted
    } else {
        wanted.max(FEWEST)
    };
    let fits = (MOST_NUMBERS / numbers.max(1.0)).floor();
    wanted.min(fits.max(1.0) as usize).max(1)
}

/// What is known of the designs of a part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    /// A row for each design.
    pub designs: Table,
    /// Designs that are drawn, with their curves.
    pub curves: Vec<(usize, Vec<Vec<f64>>)>,
    /// The rows of all designs, where they are kept.
    pub rows: Option<Table>,
}

impl Part {
    pub fn new(question: &Question<'_>, rows: bool) -> Self {
        Self {
            designs: question.table(),
            curves: Vec::new(),
            rows: rows.then(|| question.row_table()),
        }
    }

    /// Adds what is known of the next design.
    pub fn push(&mut self, question: &Question<'_>, index: usize, answer: Answer) {
        let number = index as f64 + 1.0;
        let values = question.designs.values(index);
        let values = values
            .iter()
            .enumerate()
            .map(|(k, si)| crate::unit::shown(*si, &question.unit_of(k)));
        let all = std::iter::once(number)
            .chain(values)
            .chain(answer.numbers.iter().copied());
        for (column, value) in self.designs.columns.iter_mut().zip(all) {
            column.values.push(value);
        }
        self.designs.closure.push(answer.closure);
        (self.designs.smallest_singular_value).push(answer.singular_value);
        self.designs.notes.push(answer.note);
        self.curves
            .extend(answer.curves.map(|curves| (index, curves)));
        if let (Some(all), Some(own)) = (&mut self.rows, answer.rows) {
            append_rows(all, number, own);
        }
    }

    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        put_table(&mut out, &self.designs);
        put_count(&mut out, self.curves.len());
        for (index, curves) in &self.curves {
            put_count(&mut out, *index);
            put_count(&mut out, curves.len());
            curves.iter().for_each(|curve| put_numbers(&mut out, curve));
        }
        put_count(&mut out, usize::from(self.rows.is_some()));
        if let Some(rows) = &self.rows {
            put_table(&mut out, rows);
        }
        out
    }

    /// From bytes; none where they do not tell so many designs of this sweep from the first on.
    pub fn from_bytes(
        question: &Question<'_>,
        first: usize,
        count: usize,
        bytes: &[u8],
    ) -> Option<Self> {
        let mut left = Reader(bytes);
        let designs = left.table(question.table())?;
        let mut curves = Vec::new();
        for _ in 0..left.count()? {
            let index = left.count()?;
            let own: Option<Vec<Vec<f64>>> = (0..left.count()?).map(|_| left.numbers()).collect();
            let own = own.filter(|own| own.len() == question.curves())?;
            curves.push((index, own));
        }
        let rows = match left.count()? {
            0 => None,
            _ => Some(left.table(question.row_table())?),
        };
        let numbers = designs.columns.first().map(|c| c.values.as_slice());
        let wanted = (first..first + count).map(|index| index as f64 + 1.0);
        let fits = numbers.is_some_and(|it| it.iter().copied().eq(wanted));
        (fits && left.0.is_empty()).then_some(Self {
            designs,
            curves,
            rows,
        })
    }
}

/// Puts the rows of a design behind those of others.
fn append_rows(all: &mut Table, design: f64, own: Table) {
    let rows = own.rows();
    let mut columns = all.columns.iter_mut();
    if let Some(first) = columns.next() {
        first.values.extend(std::iter::repeat_n(design, rows));
    }
    for (column, values) in columns.zip(own.columns) {
        column.values.extend(values.values);
    }
    all.closure.extend(own.closure);
    (all.smallest_singular_value).extend(own.smallest_singular_value);
    if let Some(forces) = &mut all.forces {
        let own = own.forces.unwrap_or_default();
        forces.route_difference.extend(own.route_difference);
        forces.residual.extend(own.residual);
        forces.condition.extend(own.condition);
    }
    all.notes.extend(own.notes);
}

/// Puts the rows of a table behind those of another one that is made alike.
pub(super) fn append(all: &mut Table, more: &Table) {
    for (column, own) in all.columns.iter_mut().zip(&more.columns) {
        column.values.extend_from_slice(&own.values);
    }
    all.closure.extend_from_slice(&more.closure);
    (all.smallest_singular_value).extend_from_slice(&more.smallest_singular_value);
    all.notes.extend_from_slice(&more.notes);
}

fn put_count(out: &mut Vec<u8>, count: usize) {
    out.extend_from_slice(&(count as u64).to_le_bytes());
}

fn put_numbers(out: &mut Vec<u8>, numbers: &[f64]) {
    put_count(out, numbers.len());
    out.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
}

fn put_table(out: &mut Vec<u8>, table: &Table) {
    for column in blocks(table) {
        put_numbers(out, column);
    }
    put_count(out, table.notes.len());
    for note in &table.notes {
        // One more than the length, so that nothing differs from none.
        put_count(out, note.as_ref().map_or(0, |text| text.len() + 1));
        out.extend_from_slice(note.as_deref().unwrap_or("").as_bytes());
    }
}

/// The numbers of a table, column by column.
fn blocks(table: &Table) -> impl Iterator<Item = &Vec<f64>> {
    let forces = table.forces.iter();
    let forces = forces.flat_map(|f| [&f.route_difference, &f.residual, &f.condition]);
    let own = table.columns.iter().map(|c| &c.values);
    own.chain([&table.closure, &table.smallest_singular_value])
        .chain(forces)
}

/// Bytes that are still to be read.
struct Reader<'b>(&'b [u8]);

impl<'b> Reader<'b> {
    fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }

    fn count(&mut self) -> Option<usize> {
        let bytes = self.take(8)?.try_into().ok()?;
        usize::try_from(u64::from_le_bytes(bytes)).ok()
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        let bytes = self.count()?.checked_mul(8)?;
        let numbers = self.take(bytes)?.chunks_exact(8);
        let number = |bytes: &[u8]| Some(f64::from_le_bytes(bytes.try_into().ok()?));
        numbers.map(number).collect()
    }

    /// A table with the columns of an empty one.
    fn table(&mut self, mut table: Table) -> Option<Table> {
        for column in &mut table.columns {
            column.values = self.numbers()?;
        }
        table.closure = self.numbers()?;
        table.smallest_singular_value = self.numbers()?;
        if table.forces.is_some() {
            table.forces = Some(ForceColumns {
                route_difference: self.numbers()?,
                residual: self.numbers()?,
                condition: self.numbers()?,
            });
        }
        let rows = self.count()?;
        for _ in 0..rows {
            let note = match self.count()? {
                0 => None,
                longer => Some(String::from_utf8(self.take(longer - 1)?.to_vec()).ok()?),
            };
            table.notes.push(note);
        }
        let whole = blocks(&table).all(|c| c.len() == rows);
        whole.then_some(table)
    }
}
