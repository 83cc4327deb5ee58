//! Sweeps over studies that are run as a whole for every design, as any other program would: their numbers are those that they tell.
//!
//! Studies of motion, forces and simulations are moved on the bench, where any measure can be asked of them; these are the rest.

use kempe_batch::{Executor, Serial};
use kempe_model::{Diagnostic, Model, OptimizeStudy, Severity, Study, StudyKind};
use kempe_motion::Progress;

use super::answer::Answer;
use super::drawn::Drawn;
use crate::designs::bench::Bench;
use crate::designs::kept_parts::Unkept;
use crate::designs::notes::{NEXT, noted, with_notes};
use crate::designs::optimize::COUNTS;
use crate::result::{Figure, Scalar, StudyResult};
use crate::run_one::run_one;
use crate::table::{Column, Table};
use crate::vibrations::numbers_of_modes;

/// The number of the best design of an optimum.
const BEST: f64 = 1.0;

/// What a study tells, as it does of the file's own design.
pub(super) struct Whole {
    /// Its numbers, without values.
    pub numbers: Vec<Column>,
    /// What the study itself calls them.
    names: Vec<String>,
    /// What they are of the file's own design.
    own: Vec<f64>,
    /// What is to be told of it.
    pub told: Vec<Diagnostic>,
    /// Its table, without rows.
    pub table: Table,
    /// How many rows it has.
    pub rows: usize,
    /// Which column its rows run along.
    pub along: usize,
    /// What of its plots has columns in the table.
    pub plots: Vec<Drawn>,
    /// Which columns these are.
    pub curves: Vec<usize>,
}

/// Whether a study is run as a whole.
pub(super) fn is_whole(kind: &StudyKind) -> bool {
    match kind {
        StudyKind::Motion(along) => along.circuit,
        StudyKind::Forces(_) | StudyKind::Simulate(_) => false,
        _ => true,
    }
}

/// Whether a study is one of many designs itself: it takes long, and its rows are designs and pieces, which are not kept of every design.
pub(super) fn is_of_designs(kind: &StudyKind) -> bool {
    matches!(kind, StudyKind::Tolerance(_) | StudyKind::Optimize(_))
}

impl Whole {
    /// Runs the file's own design, so that it is known what the study tells.
    ///
    /// # Errors
    /// Why it does not run.
    pub fn new(
        model: &Model,
        over: &Study,
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let own = run_one(model, over, (&Serial, &mut Unkept), progress)?;
        let numbers = numbers_of(model, over, &own);
        let names = numbers.iter().map(|s| s.name.clone()).collect();
        let own_values = numbers.iter().map(|s| s.value).collect();
        let numbers = numbers.into_iter().map(|s| Column::new(s.name, s.unit));
        let numbers: Vec<Column> = numbers.collect();
        let told = own.diagnostics;
        let rows = own.table.rows();
        let table = without_rows(own.table);
        let place = |name: &str| table.columns.iter().position(|c| c.name == name);
        let mut plots = Vec::new();
        let mut curves = Vec::new();
        for figure in &own.figures {
            let Figure::Curves { curves: drawn, .. } = figure else {
                continue;
            };
            let places: Option<Vec<usize>> = drawn.iter().map(|c| place(&c.name)).collect();
            if let Some(places) = places {
                plots.push(Drawn::Curves(
                    drawn.iter().map(|c| c.name.clone()).collect(),
                ));
                curves.extend(places);
            }
        }
        Ok(Self {
            numbers,
            names,
            own: own_values,
            rows,
            along: own.along,
            plots,
            curves,
            told,
            table,
        })
    }

    /// Tells numbers apart from parameters that vary, by name and value in the file. What only says again what varies is left out.
    pub fn apart_from(&mut self, varied: &[(&str, f64)], over: &str) {
        let same = |k: usize| varied.iter().find(|(name, _)| *name == self.names[k]);
        let keep = |k: &usize| same(*k).is_none_or(|(_, own)| *own != self.own[*k]);
        let kept: Vec<usize> = (0..self.names.len()).filter(keep).collect();
        let column = |k: &usize| match same(*k) {
            Some((name, _)) => Column {
                name: format!("{name} of {over}"),
                ..self.numbers[*k].clone()
            },
            None => self.numbers[*k].clone(),
        };
        let numbers = kept.iter().map(column).collect();
        self.names = kept.iter().map(|k| self.names[*k].clone()).collect();
        self.own = kept.iter().map(|k| self.own[*k]).collect();
        self.numbers = numbers;
    }

    /// What a design tells.
    pub fn ask(
        &self,
        bench: &Bench<'_>,
        values: &[f64],
        (rows, drawn): (bool, bool),
        (executor, progress): (&dyn Executor, &mut dyn Progress),
    ) -> Answer {
        let none = |why: String| Answer {
            numbers: vec![f64::NAN; self.numbers.len()],
            closure: f64::NAN,
            singular_value: f64::NAN,
            note: Some(why),
            rows: rows.then(|| self.table.clone()),
            curves: drawn.then(|| vec![Vec::new(); 1 + self.curves.len()]),
        };
        if let Err(refused) = bench.design(values) {
            return none(refused.why);
        }
        let (model, _) = bench.model_with(values);
        let result = match run_one(&model, bench.over, (executor, &mut Unkept), progress) {
            Ok(result) => result,
            Err(told) => {
                let first = told.first().map(|d| d.message.clone());
                return none(first.unwrap_or_default());
            }
        };
        // As the study alone fails.
        let failed = (result.diagnostics.iter()).find(|d| d.severity == Severity::Error);
        if let Some(why) = failed {
            return none(with_notes(why));
        }
        let told = numbers_of(&model, bench.over, &result);
        let numbers: Vec<f64> = self.names.iter().map(|it| number(&told, it)).collect();
        let lacking = self.numbers.iter().zip(&numbers).find(|(_, x)| x.is_nan());
        let lacking = lacking.map(|(it, _)| format!("`{}` has no value", it.name));
        let told = noted(&[&bench.over.name], &result.diagnostics).into_iter();
        let notes: Vec<String> = lacking.into_iter().chain(told).collect();
        let table = self.matched(result.table);
        let curve = |k: &usize| table.columns[*k].values.clone();
        Answer {
            // What has no rows leaves nothing open.
            closure: match table.rows() {
                0 => 0.0,
                _ => table.worst_closure(),
            },
            singular_value: table.least_singular_value(),
            note: (!notes.is_empty()).then(|| notes.join(NEXT)),
            curves: drawn.then(|| {
                let along = std::iter::once(&self.along);
                along.chain(&self.curves).map(curve).collect()
            }),
            rows: rows.then_some(table),
            numbers,
        }
    }

    /// A design's table with the columns of the file's own design: one that it does not have is empty there.
    fn matched(&self, table: Table) -> Table {
        let rows = table.rows();
        let own = |wanted: &Column| {
            let found = table.columns.iter().find(|c| c.name == wanted.name);
            let values = found.map(|c| c.values.clone());
            Column {
                values: values.unwrap_or_else(|| vec![f64::NAN; rows]),
                ..wanted.clone()
            }
        };
        Table {
            columns: self.table.columns.iter().map(own).collect(),
            forces: self.table.forces.as_ref().and(table.forces),
            balance: None,
            ..table
        }
    }
}

/// The numbers of a design: what its summary tells, and of vibrations what they are. That is what its rows come to where it tells no others, as of a circuit.
fn numbers_of(model: &Model, over: &Study, result: &StudyResult) -> Vec<Scalar> {
    match &over.kind {
        StudyKind::Vibrations(study) => numbers_of_modes(model, study, result),
        StudyKind::Optimize(asked) => numbers_of_optimum(asked, result),
        _ if result.scalars.is_empty() => {
            let columns = result.table.columns.iter().enumerate();
            let told = columns.filter(|(k, _)| *k != result.along);
            told.flat_map(|(_, column)| in_rows(column)).collect()
        }
        _ => result.scalars.clone(),
    }
}

/// What was found, with the columns of the best design, where there is one: both sides of limits among them.
fn numbers_of_optimum(asked: &OptimizeStudy, result: &StudyResult) -> Vec<Scalar> {
    let told = result.scalars.iter();
    let mut all: Vec<Scalar> = told
        .filter(|it| !COUNTS.contains(&it.name.as_str()))
        .cloned()
        .collect();
    let designs = result.table.columns.first();
    let best = designs.and_then(|column| column.values.iter().position(|x| *x == BEST));
    if let (Some(best), 0..=1) = (best, asked.goals.len()) {
        for column in result.table.columns.iter().skip(1) {
            if !all.iter().any(|it| it.name == column.name) {
                all.push(Scalar {
                    name: column.name.clone(),
                    unit: column.unit.clone(),
                    value: column.values[best],
                });
            }
        }
    }
    all
}

/// The least and the greatest value of a column.
fn in_rows(column: &Column) -> [Scalar; 2] {
    let finite = column.values.iter().copied().filter(|x| x.is_finite());
    let ends = [f64::min, f64::max].map(|of| finite.clone().reduce(of).unwrap_or(f64::NAN));
    let named = [("least", ends[0]), ("greatest", ends[1])];
    named.map(|(word, value)| Scalar {
        name: format!("{}, {word} in its rows", column.name),
        unit: column.unit.clone(),
        value,
    })
}

fn number(told: &[Scalar], wanted: &str) -> f64 {
    let found = told.iter().find(|s| s.name == wanted);
    found.map_or(f64::NAN, |s| s.value)
}

fn without_rows(table: Table) -> Table {
    let columns = table.columns.into_iter();
    Table {
        columns: columns
            .map(|c| Column {
                values: Vec::new(),
                ..c
            })
            .collect(),
        closure: Vec::new(),
        smallest_singular_value: Vec::new(),
        forces: table.forces.map(|_| Default::default()),
        balance: None,
        notes: Vec::new(),
        ..table
    }
}
