//! What a sweep asks of every design: its numbers, the rows of the study that is run, and curves of some.

use kempe_batch::{Executor, Serial};
use kempe_mechanism::Mechanism;
use kempe_model::{
    Diagnostic, Leaf, Model, MotionStudy, ParameterId, Plot, PointId, PoseMeasure, Severity,
    StudyKind, SweepStudy, value,
};
use kempe_motion::Progress;
use kempe_units::{Dimension, Expr, Unit};

use super::answer::Answer;
use super::designs::Designs;
use super::drawn::Drawn;
use super::whole::{Whole, is_whole};
use crate::columns::Asked;
use crate::designs::asked::{knows_forces, numbers_of};
use crate::designs::bench::{Bench, Refused, crosses};
use crate::designs::notes::{CROSSES, NEXT, noted};
use crate::designs::over::study_of;
use crate::designs::rows::{DesignRows, rows_of, sink};
use crate::motion::abscissa;
use crate::quantity::Quantity;
use crate::rows::RowPlace;
use crate::sink::RowSink;
use crate::table::{Column, Table};
use crate::unit::{Units, shown};

/// So many designs have their curves in a picture; of more, some that lie evenly among them.
pub(super) const DRAWN: usize = 24;

/// A sweep that is ready to be asked design by design.
pub(super) struct Question<'m> {
    pub model: &'m Model,
    pub study: &'m SweepStudy,
    pub name: String,
    pub designs: Designs,
    pub bench: Bench<'m>,
    /// What is known of a study that is run as a whole.
    pub whole: Option<Whole>,
    pub units: Units,
    /// The rows of the study that is run, where it says so itself.
    along: &'m MotionStudy,
    /// What is plotted of several designs.
    pub plots: Vec<Drawn>,
    /// What is evaluated in the rows: columns, and curves of designs that are drawn.
    rows: Asked,
    curves: Vec<Quantity>,
    /// Which column of the rows their curves run along: as the file's own design goes, or time.
    along_column: usize,
}

impl<'m> Question<'m> {
    /// A sweep of a model.
    ///
    /// # Errors
    ///
    /// What of it no design can answer.
    pub fn new(
        model: &'m Model,
        name: &str,
        study: &'m SweepStudy,
        progress: &mut dyn Progress,
    ) -> Result<Self, Vec<Diagnostic>> {
        let over = study_of(model, &study.over)?;
        let varied: Vec<ParameterId> = study.vary.iter().map(|it| it.parameter).collect();
        let mut whole = match is_whole(&over.kind) {
            true => Some(Whole::new(model, over, progress)?),
            false => None,
        };
        let mut numbers = match &whole {
            Some(_) => Vec::new(),
            None => numbers_of(model, &study.over, over),
        };
        // What is varied has a column as it is.
        let is_varied =
            |name: &str| (varied.iter()).any(|id| model.parameters[id.index()].name == name);
        numbers.retain(|number| !is_varied(&number.name));
        if let Some(whole) = &mut whole {
            let (parameters, units) = (model.parameter_values(), Units::of(model));
            let shown = |id: &ParameterId| {
                let parameter = &model.parameters[id.index()];
                let own = shown(parameters[id.index()], &units.unit(parameter.dimension));
                (parameter.name.as_str(), own)
            };
            let varied: Vec<(&str, f64)> = varied.iter().map(shown).collect();
            whole.apart_from(&varied, &over.name);
        }
        let bench = Bench::new(model, &study.over, varied, numbers)?;
        let along = over.kind.along();
        let mut rows = match &over.kind {
            StudyKind::Motion(along) => Asked::of_motion(model, along),
            _ => Asked::of_forces(&Mechanism::new(model), along),
        };
        rows.scalars.clear();
        rows.curves.clear();
        let plots = match study.over.asked.plots.is_empty() {
            true => &along.plots,
            false => &study.over.asked.plots,
        };
        let curves = plots.iter().flat_map(|plot| plotted(model, plot));
        let curves: Vec<Quantity> = curves.collect();
        let plots: Vec<Drawn> = plots.iter().filter_map(Drawn::of).collect();
        let (plots, curves) = match &whole {
            Some(whole) => (whole.plots.clone(), Vec::new()),
            None => (plots, curves),
        };
        let along_column = whole.as_ref().map_or(0, |whole| whole.along);
        Ok(Self {
            whole,
            model,
            study,
            name: name.to_owned(),
            designs: Designs::new(model, study),
            bench,
            units: Units::of(model),
            along,
            curves,
            along_column,
            plots,
            rows,
        })
    }

    /// The unit of a parameter that varies.
    pub fn unit_of(&self, parameter: usize) -> Unit {
        let id = self.bench.varied.get(parameter);
        let own = id.and_then(|id| self.model.parameters.get(id.index()));
        self.units
            .unit(own.map_or(Dimension::NONE, |p| p.dimension))
    }

    /// The name of a parameter that varies.
    pub fn name_of(&self, parameter: usize) -> &str {
        let id = self.bench.varied.get(parameter);
        let own = id.and_then(|id| self.model.parameters.get(id.index()));
        own.map_or("", |p| p.name.as_str())
    }

    /// A value of a parameter with its unit.
    pub fn text_of(&self, parameter: usize, si: f64) -> String {
        self.units.text(si, self.unit_of(parameter).dimension())
    }

    /// The numbers of every design, without values.
    pub fn numbers(&self) -> Vec<Column> {
        match &self.whole {
            Some(whole) => whole.numbers.clone(),
            None => (self.bench.numbers.iter())
                .map(|q| Column::new(q.name.clone(), q.unit(&self.units)))
                .collect(),
        }
    }

    /// Whether derivatives of the numbers are known.
    pub fn has_derivatives(&self) -> bool {
        self.whole.is_none() && !matches!(self.bench.over.kind, StudyKind::Simulate(_))
    }

    /// How many rows a design has at most.
    pub fn most_rows(&self) -> f64 {
        let parameters = self.model.parameter_values();
        match (&self.whole, &self.bench.over.kind) {
            (Some(whole), _) => whole.rows.max(1) as f64,
            (None, StudyKind::Simulate(study)) => {
                let until = value(&study.until, &parameters);
                crate::rows::count(self.model, &self.along.rows, &parameters, until)
            }
            _ => crate::rows::most(self.model, &self.along.rows, &parameters),
        }
    }

    /// The table of designs without rows: their numbers, what varies, and what is asked of them.
    pub fn table(&self) -> Table {
        let varied =
            (0..self.designs.own.len()).map(|k| Column::new(self.name_of(k), self.unit_of(k)));
        let numbers = self.numbers();
        let first = Column::new("design", Unit::one());
        empty(
            &self.name,
            std::iter::once(first).chain(varied).chain(numbers),
            1 + self.designs.own.len(),
        )
    }

    /// The table of the rows of all designs, without any.
    pub fn row_table(&self) -> Table {
        let own = match &self.whole {
            Some(whole) => whole.table.clone(),
            None => Table {
                forces: knows_forces(self.bench.over).then(Default::default),
                ..self.sink(&self.rows).table
            },
        };
        let places = own.places;
        let mut columns = own.columns;
        columns.insert(0, Column::new("design", Unit::one()));
        let mut table = empty(
            &format!("{}.rows", self.name),
            columns.into_iter(),
            1 + places,
        );
        table.forces = own.forces;
        table
    }

    fn sink(&self, asked: &Asked) -> RowSink {
        sink(&self.name, self.model, &self.units, asked)
    }

    /// Whether a design is drawn: some that lie evenly among all, the first and the last among them.
    pub fn is_drawn(&self, index: usize) -> bool {
        let all = self.designs.count();
        if self.curves() == 1 {
            return false;
        }
        if all <= DRAWN {
            return true;
        }
        let nearest = |k: usize| (k as f64 * (all - 1) as f64 / (DRAWN - 1) as f64).round();
        let near = (index as f64 * (DRAWN - 1) as f64 / (all - 1) as f64).round() as usize;
        nearest(near) == index as f64
    }

    /// The unit of a curve.
    pub fn curve_unit(&self, index: usize) -> Option<Unit> {
        if let Some(whole) = &self.whole {
            let column = whole.table.columns.get(*whole.curves.get(index)?)?;
            return Some(column.unit.clone());
        }
        Some(self.curves.get(index)?.unit(&self.units))
    }

    /// How many curves a design that is drawn has, what its rows run along among them.
    pub fn curves(&self) -> usize {
        let of_whole = self.whole.as_ref().map(|whole| whole.curves.len());
        1 + of_whole.unwrap_or(self.curves.len())
    }

    /// What the curves of drawn designs run along, as a column without values.
    pub fn abscissa(&self) -> Column {
        let columns = match &self.whole {
            Some(whole) => whole.table.columns.clone(),
            None => self.sink(&Asked::default()).table.columns,
        };
        let column = columns.into_iter().nth(self.along_column);
        column.unwrap_or_else(|| Column::new("time", Unit::one()))
    }

    /// Asks one design of a study that takes long, on the whole machine.
    pub fn ask_long(
        &self,
        index: usize,
        executor: &dyn Executor,
        progress: &mut dyn Progress,
    ) -> Answer {
        let values = self.designs.values(index);
        match &self.whole {
            Some(whole) => {
                let asked = (false, self.is_drawn(index));
                whole.ask(&self.bench, &values, asked, (executor, progress))
            }
            None => self.ask(index, false),
        }
    }

    /// Asks one design, with all its rows where that is wanted.
    pub fn ask(&self, index: usize, rows: bool) -> Answer {
        if let Some(whole) = &self.whole {
            let values = self.designs.values(index);
            let with: (&dyn Executor, &mut dyn Progress) = (&Serial, &mut self.bench.watch());
            return whole.ask(&self.bench, &values, (rows, self.is_drawn(index)), with);
        }
        match self.asked(index, rows) {
            Ok(answer) => answer,
            Err(refused) => Answer {
                numbers: vec![f64::NAN; self.bench.numbers.len()],
                closure: f64::NAN,
                singular_value: f64::NAN,
                note: Some(refused.why),
                rows: None,
                curves: None,
            },
        }
    }

    fn asked(&self, index: usize, rows: bool) -> Result<Answer, Refused> {
        let (motion, of_motion) =
            (self.bench).told_motion(&self.designs.values(index), &mut self.bench.watch())?;
        let quantities: Vec<&Quantity> = self.bench.numbers.iter().collect();
        // By themselves, so that they hang on nothing else that is asked.
        let mut along = self
            .bench
            .along(&motion, &quantities, &mut self.bench.watch())?;
        let values = along.values(RowPlace::Drive(motion.start));
        let numbers: Vec<f64> = quantities
            .iter()
            .zip(&values)
            .map(|(q, si)| q.unit(&self.units).from_si(*si))
            .collect();
        let drawn = self.is_drawn(index);
        let mut asked = Asked::default();
        if rows {
            asked.columns.clone_from(&self.rows.columns);
        }
        if drawn {
            asked.curves.clone_from(&self.curves);
        }
        let DesignRows {
            table,
            curves,
            told,
        } = rows_of(
            (&self.bench, &self.name),
            &motion,
            self.along,
            (&asked, rows),
            self.along_column,
        )?;
        let of_numbers = along.number_warnings(Some(&self.name), &quantities);
        let lacking = quantities.iter().zip(&values).find(|(_, x)| x.is_nan());
        let lacking = lacking.map(|(q, _)| format!("`{}` has no value", q.name));
        let crosses = crosses(&motion).then(|| CROSSES.to_owned());
        // What its rows warn of is told with a simulation.
        let of_rows = match self.bench.over.kind {
            StudyKind::Simulate(_) => &[],
            _ => &told[..],
        };
        let told = of_motion.iter().chain(&of_numbers).chain(of_rows);
        let told = noted(&[&self.name, &self.bench.over.name], told);
        let notes: Vec<String> = lacking.into_iter().chain(crosses).chain(told).collect();
        Ok(Answer {
            numbers,
            closure: table.worst_closure(),
            singular_value: table.least_singular_value(),
            note: (!notes.is_empty()).then(|| notes.join(NEXT)),
            curves: drawn.then(|| {
                let along = table.columns.get(self.along_column);
                let along = along.map(|c| c.values.clone());
                std::iter::once(along.unwrap_or_default())
                    .chain(curves)
                    .collect()
            }),
            rows: rows.then_some(table),
        })
    }

    /// Moves the file's own design, from which others are found sooner; what is to be told of it. Where it does not move, others may.
    ///
    /// # Errors
    ///
    /// That it was stopped.
    pub fn begin(
        &mut self,
        progress: &mut dyn Progress,
    ) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        if self.whole.is_some() {
            return Ok(Vec::new());
        }
        let told = match self.bench.begin(progress) {
            Err(told) if told.iter().any(|d| d.code == "stopped") => return Err(told),
            Ok(told) | Err(told) => told,
        };
        if !matches!(self.bench.over.kind, StudyKind::Simulate(_))
            && let Ok(own) = self.bench.motion(&self.bench.own_values(), progress)
        {
            self.along_column = abscissa(&own, &own.design.parameters);
        }
        let over = &self.bench.over.name;
        let of_own = |mut d: Diagnostic| {
            if d.severity == Severity::Error {
                d.severity = Severity::Warning;
                d.message = format!(
                    "the file's own design does not move as study `{over}` asks: {}",
                    d.message
                );
            }
            d
        };
        Ok(told.into_iter().map(of_own).collect())
    }
}

/// What is evaluated for a plot.
fn plotted(model: &Model, plot: &Plot) -> Vec<Quantity> {
    match plot {
        Plot::Curves(columns) => columns
            .iter()
            .map(|column| Quantity {
                name: column.name.clone(),
                measure: column.measure.clone(),
                dimension: column.dimension,
            })
            .collect(),
        Plot::Path(point) => {
            let name = model.points.get(point.index()).map_or("", |p| &p.name);
            let axis = |name: String, measure: fn(PointId) -> PoseMeasure| Quantity {
                name,
                measure: Expr::Leaf(Leaf::Pose(measure(*point))),
                dimension: Dimension::LENGTH,
            };
            vec![
                axis(format!("x({name})"), PoseMeasure::X),
                axis(format!("y({name})"), PoseMeasure::Y),
            ]
        }
        Plot::Hodograph(_) => Vec::new(),
    }
}

fn empty(name: &str, columns: impl Iterator<Item = Column>, places: usize) -> Table {
    Table {
        name: name.to_owned(),
        columns: columns.collect(),
        places,
        closure: Vec::new(),
        smallest_singular_value: Vec::new(),
        forces: None,
        balance: None,
        notes: Vec::new(),
    }
}
