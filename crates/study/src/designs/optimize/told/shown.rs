//! The table and the files of designs that were found, with what their motions warn of.

use std::sync::Arc;

use kempe_model::{Diagnostic, Model, Severity, StudyKind};
use kempe_motion::Motion;
use kempe_motion::progress::Silent;
use kempe_units::Unit;

use super::teller::{MOST_FILES, Teller, Told};
use crate::designs::bench::Answer;
use crate::designs::notes::{NEXT, noted};
use crate::designs::warned::warned;
use crate::motion::run_along;
use crate::quantity::Quantity;
use crate::result::{FoundDesign, StudyResult};
use crate::run_motion::run_motion;
use crate::simulation::simulation;
use crate::table::{Column, Table};
use crate::unit::shown;

impl Teller<'_, '_> {
    /// The table, the files and all that does not hang on the method.
    pub(super) fn shown(
        &self,
        own: Option<&Told>,
        all: &[Told],
        stopped: Option<usize>,
        diagnostics: Vec<Diagnostic>,
    ) -> StudyResult {
        let rows: Vec<(&Told, f64)> = own
            .map(|own| (own, 0.0))
            .into_iter()
            .chain(
                all.iter()
                    .zip(1..)
                    .map(|(told, number)| (told, f64::from(number))),
            )
            .collect();
        let mut number = Column::new("design", Unit::one());
        number.values = rows.iter().map(|(_, number)| *number).collect();
        let mut columns = vec![number];
        for (k, chosen) in self.study.vary.iter().enumerate() {
            let parameter = &self.bench.model.parameters[chosen.parameter.index()];
            let unit = self.units.unit(parameter.dimension);
            let mut column = Column::new(&parameter.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(told.design[k], &unit))
                .collect();
            columns.push(column);
        }
        for (k, goal) in self.study.goals.iter().enumerate() {
            // A goal may be what is varied.
            if columns.iter().any(|known| known.name == goal.number.name) {
                continue;
            }
            let unit = self.goal_unit(k);
            let mut column = Column::new(&goal.number.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(self.goal(k, &told.evaluation), &unit))
                .collect();
            columns.push(column);
        }
        for (k, quantity) in self.beside.numbers.iter().enumerate() {
            if columns.iter().any(|known| known.name == quantity.name) {
                continue;
            }
            let unit = quantity.unit(&self.units);
            let mut column = Column::new(&quantity.name, unit.clone());
            column.values = rows
                .iter()
                .map(|(told, _)| shown(told.beside.numbers[k], &unit))
                .collect();
            columns.push(column);
        }
        let mut designs = Vec::new();
        let mut told = diagnostics;
        let is_front = self.study.goals.len() > 1 && all.len() > 1;
        let mut warnings: Vec<Option<String>> = Vec::new();
        for (k, it) in all.iter().take(MOST_FILES).enumerate() {
            let (design, more) = self.design(k + 1, all.len(), it);
            let own = noted(&[&self.bench.over.name], &more);
            warnings.push((!own.is_empty()).then(|| own.join(NEXT)));
            // What is said of the file's own design in the same words is not said again.
            let new = |d: &Diagnostic| told.iter().all(|known| known.message != d.message);
            if k == 0 && !is_front {
                let more: Vec<Diagnostic> = more.into_iter().filter(new).collect();
                told.extend(more.into_iter().map(of_best));
            }
            designs.push(design);
        }
        if is_front {
            let notes = warnings.iter().map(Option::as_deref);
            let of = (self.name, &self.study.over);
            let notes = (notes, all.len());
            told.extend(warned(of, self.bench, notes, |k| all[k].design.clone()));
        }
        let warnings = (own.iter().map(|_| None)).chain(warnings);
        let warnings = warnings.chain(std::iter::repeat(None));
        let notes = rows.iter().zip(warnings).map(|((told, _), warnings)| {
            let notes: Vec<String> = told.note.clone().into_iter().chain(warnings).collect();
            (!notes.is_empty()).then(|| notes.join(NEXT))
        });
        // Of a design whose motion is told that of all its rows, as in a sweep; else of where it starts.
        let evidence = |of: fn(&Table) -> f64, of_start: fn(&Answer) -> f64| -> Vec<f64> {
            let tables = designs.iter().map(|it| Some(&it.motion.as_ref()?.table));
            let tables = (own.iter().map(|_| None)).chain(tables);
            let tables = tables.chain(std::iter::repeat(None));
            let both = rows.iter().zip(tables);
            both.map(|((told, _), table)| table.map_or_else(|| of_start(&told.beside), of))
                .collect()
        };
        let table = Table {
            name: self.name.to_owned(),
            columns,
            places: 1 + self.study.vary.len(),
            closure: evidence(Table::worst_closure, |it| it.closure),
            smallest_singular_value: evidence(Table::least_singular_value, |it| {
                it.smallest_singular_value
            }),
            forces: None,
            balance: None,
            notes: notes.collect(),
        };
        let demanded_rows = table.rows();
        StudyResult {
            name: self.name.to_owned(),
            table,
            beside: Vec::new(),
            scalars: Vec::new(),
            figures: Vec::new(),
            listings: Vec::new(),
            contacts: Vec::new(),
            happenings: Vec::new(),
            frames: Vec::new(),
            shapes: Vec::new(),
            designs,
            events: Vec::new(),
            along: 0,
            assemblies: (0, 0),
            diagnostics: told,
            demanded_rows,
            stopped_at: stopped.map(|tried| format!("{tried} designs")),
        }
    }

    /// What is to be told of the goals of a design, and of what its limits are of.
    fn number_warnings(&self, motion: &Arc<Motion>) -> Vec<Diagnostic> {
        let goals = self.bench.numbers.iter().take(self.study.goals.len());
        let goals = goals.filter(|_| self.study.fit.is_none());
        let all: Vec<&Quantity> = goals.chain(&self.beside.numbers).collect();
        let along = self.bench.along(motion, &all, &mut Silent);
        let over = Some(self.bench.over.name.as_str());
        along.map_or_else(|_| Vec::new(), |it| it.number_warnings(over, &all))
    }

    /// A design as a file, moved by the study that is run.
    fn design(&self, number: usize, of: usize, told: &Told) -> (FoundDesign, Vec<Diagnostic>) {
        let (model, file) = self.bench.model_with(&told.design);
        let read = Model::from_toml(&file.toml, &model.title, &mut file.tables.files());
        let model = read.map_or(model, |checked| checked.model);
        let motion = match &self.bench.over.kind {
            StudyKind::Motion(along) => {
                run_motion(&model, &self.bench.over.name, along, &mut Silent)
            }
            StudyKind::Forces(along) => {
                run_along(&model, &self.bench.over.name, along, true, &mut Silent)
            }
            StudyKind::Simulate(it) => {
                let found = simulation(&model, &self.bench.over.name, it, &[], &mut Silent);
                found.map(|(result, _)| result)
            }
            _ => Err(Vec::new()),
        };
        let (motion, mut more) = match motion {
            Ok(motion) => {
                let told = motion.diagnostics.clone();
                (Some(Box::new(motion)), told)
            }
            Err(more) => {
                let soft = more.into_iter().map(|mut d| {
                    d.severity = Severity::Warning;
                    d
                });
                (None, soft.collect())
            }
        };
        // A simulation has told of its own.
        if !matches!(self.bench.over.kind, StudyKind::Simulate(_))
            && let Ok((moves, otherwise)) = self.bench.told_motion(&told.design, &mut Silent)
        {
            more.extend(otherwise);
            let of_numbers = self.number_warnings(&moves).into_iter();
            let new = |d: &Diagnostic| more.iter().all(|known| known.message != d.message);
            let of_numbers: Vec<Diagnostic> = of_numbers.filter(new).collect();
            more.extend(of_numbers);
        }
        let digits = of.to_string().len().max(2);
        let goals = (0..self.study.goals.len()).map(|k| {
            let value = self.goal(k, &told.evaluation);
            let value = self.bench.numbers[k].text(value, &self.units);
            format!("{} = {value}", self.study.goals[k].number.name)
        });
        let name = format!("{number:0digits$}");
        let design = FoundDesign {
            title: format!("{name}: {}", goals.collect::<Vec<_>>().join(", ")),
            name,
            file,
            model,
            motion,
        };
        (design, more)
    }
}

/// What the study that is run tells of the best design; it is none of the file's.
fn of_best(mut told: Diagnostic) -> Diagnostic {
    told.message = format!("the best design: {}", told.message);
    told.labels.clear();
    told
}
