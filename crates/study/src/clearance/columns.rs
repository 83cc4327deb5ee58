//! The columns of a study of clearance: of each quantity its value with play, how far that is from the ideal one, and what the
//! clearances can do to it to first order.

use std::f64::consts::FRAC_1_SQRT_2;

use kempe_dynamics::clearance::Play;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{Leaf, Measure, Nature, Plot};
use kempe_number::math::{hypot, within_half_a_turn};
use kempe_units::{Dimension, Unit};

use crate::columns::Asked;
use crate::quantity::Quantity;
use crate::result::Figure;
use crate::table::Column;
use crate::unit::Units;

/// How many columns a quantity takes at most, its limits in pictures among them.
pub(crate) const COLUMNS: usize = 5;

/// What was found at a row.
pub(super) struct Found {
    /// Values of the measures with play; NaN where none is known.
    pub values: Vec<f64>,
    /// Of each measure its derivatives to the ways in which each joint may stand open.
    pub slopes: Vec<Vec<[f64; 2]>>,
}

impl Found {
    /// Nothing yet.
    pub fn nothing(measures: &[Measure], plays: &[Play]) -> Self {
        Self {
            values: vec![f64::NAN; measures.len()],
            slopes: vec![vec![[f64::NAN; 2]; plays.len()]; measures.len()],
        }
    }
}

/// A quantity with play.
pub(super) struct Deviation {
    /// The quantity.
    pub quantity: Quantity,
    /// Its value with play.
    pub value: Column,
    /// That less the ideal one.
    pub deviation: Column,
    /// What is known of it to first order; `None` of what is no geometry of the pose.
    pub first_order: Option<FirstOrder>,
}

/// What clearances can do to a quantity, to first order.
pub(super) struct FirstOrder {
    /// No directions of the clearances give more.
    pub worst: Column,
    /// Root mean square where all directions are equally likely and none depends on another.
    pub rms: Column,
    /// The parts of the joints in the worst case, row by row, in the unit of the columns.
    pub parts: Vec<Vec<f64>>,
}

/// The quantities of a study of clearance.
pub(super) struct Deviations {
    all: Vec<Deviation>,
    plays: Vec<Play>,
    /// How many of them are columns of the table; the rest is plotted alone.
    columns: usize,
}

impl Deviations {
    pub fn new(mechanism: &Mechanism, units: &Units, asked: &Asked, plays: &[Play]) -> Self {
        let mut all: Vec<Deviation> = Vec::new();
        for quantity in asked.columns.iter().chain(&asked.curves) {
            let known = |d: &Deviation| {
                d.quantity.name == quantity.name && d.quantity.measure == quantity.measure
            };
            if !all.iter().any(known) {
                all.push(Deviation::new(mechanism, quantity, &quantity.unit(units)));
            }
        }
        Self {
            columns: asked.columns.len(),
            plays: plays.to_vec(),
            all,
        }
    }

    /// The quantities.
    pub fn quantities(&self) -> impl Iterator<Item = &Quantity> {
        self.all.iter().map(|d| &d.quantity)
    }

    /// Adds a row: values of all quantities without play (SI), and what was found with it.
    pub fn push(&mut self, ideal: &[f64], found: &Found) {
        let values = ideal.iter().zip(&found.values).zip(&found.slopes);
        for (it, ((ideal, value), slopes)) in self.all.iter_mut().zip(values) {
            let unit = it.value.unit.clone();
            it.value.values.push(unit.from_si(*value));
            let difference = difference(it.quantity.dimension, *value, *ideal);
            it.deviation.values.push(difference / unit.factor());
            let Some(first) = &mut it.first_order else {
                continue;
            };
            let parts: Vec<f64> = (slopes.iter().zip(&self.plays))
                .map(|([x, y], play)| hypot(*x, *y) * play.radial / unit.factor())
                .collect();
            // Of a play to two sides each is the whole, of one all round the mean square of a component is half.
            let squares = (parts.iter().zip(&self.plays)).map(|(part, play)| {
                let share = if play.is_across() { 1.0 } else { FRAC_1_SQRT_2 };
                (share * part) * (share * part)
            });
            first.rms.values.push(squares.sum::<f64>().sqrt());
            first.worst.values.push(parts.iter().sum());
            first.parts.push(parts);
        }
    }

    /// The pictures: of each measure that is plotted how far it deviates, with the worst case; paths and hodographs as they are
    /// with play.
    pub fn figures(&self, plots: &[Plot]) -> Vec<Figure> {
        let named = |name: &str| self.all.iter().find(|d| d.quantity.name == name);
        if plots.is_empty() {
            let shown = self.all.iter().take(MOST_DEFAULT);
            return shown.map(|d| pictured(&[d])).collect();
        }
        let of = |plot: &Plot| match plot {
            Plot::Curves(columns) => {
                let all: Vec<&Deviation> = columns.iter().filter_map(|c| named(&c.name)).collect();
                (!all.is_empty()).then(|| pictured(&all))
            }
            Plot::Path(point) => Some(Figure::Path(*point)),
            Plot::Hodograph(hodograph) => {
                let mut axes = self
                    .all
                    .iter()
                    .filter(|d| d.quantity.name == hodograph.name);
                let axes = [axes.next()?, axes.next()?].map(|d| d.value.clone());
                Some(Figure::Hodograph(hodograph.name.clone(), axes))
            }
        };
        plots.iter().filter_map(of).collect()
    }

    /// The columns of the table, and the deviations of what is tabulated.
    pub fn finished(self) -> (Vec<Column>, Vec<Deviation>) {
        let mut all = self.all;
        all.truncate(self.columns);
        let columns = all.iter().flat_map(Deviation::columns).collect();
        (columns, all)
    }
}

/// Pictures of a study that names none.
const MOST_DEFAULT: usize = 4;

impl Deviation {
    fn new(mechanism: &Mechanism, quantity: &Quantity, unit: &Unit) -> Self {
        let name = &quantity.name;
        let column = |what: &str| Column::new(format!("{name} {what}"), unit.clone());
        let first_order = is_geometry(mechanism, &quantity.measure).then(|| FirstOrder {
            worst: column("worst case"),
            rms: column("rms"),
            parts: Vec::new(),
        });
        Self {
            value: Column::new(name.clone(), unit.clone()),
            deviation: column("deviation"),
            first_order,
            quantity: quantity.clone(),
        }
    }

    fn columns(&self) -> Vec<Column> {
        let first = self.first_order.iter().flat_map(|f| [&f.worst, &f.rms]);
        ([&self.value, &self.deviation].into_iter().chain(first))
            .cloned()
            .collect()
    }
}

/// The deviations in one picture; of one alone between the worst cases.
fn pictured(all: &[&Deviation]) -> Figure {
    if let [one] = all
        && let Some(first) = &one.first_order
    {
        return Figure::Within {
            curve: one.deviation.clone(),
            bound: first.worst.clone(),
        };
    }
    Figure::Curves {
        curves: all.iter().map(|d| d.deviation.clone()).collect(),
        limits: Vec::new(),
    }
}

/// Whether a measure is a function of the pose alone, whose derivatives to the clearances are known.
fn is_geometry(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut alone = true;
    visit_leaves(mechanism, measure, &mut |leaf| {
        alone &= match leaf {
            Leaf::Parameter(_) | Leaf::Named(_) | Leaf::Drive(_) => true,
            Leaf::Pose(pose) => matches!(pose.nature(), Nature::Geometric(0)),
            _ => false,
        };
    });
    alone
}

/// A quantity whose values with play are in a column, beside the ideal ones (SI).
pub(super) fn deviation_of(
    mechanism: &Mechanism,
    quantity: &Quantity,
    value: Column,
    ideal: &[f64],
) -> Deviation {
    let unit = value.unit.clone();
    let mut it = Deviation::new(mechanism, quantity, &unit);
    it.first_order = None;
    let all = value.values.iter().zip(ideal);
    (it.deviation.values).extend(all.map(|(value, ideal)| {
        difference(quantity.dimension, unit.to_si(*value), *ideal) / unit.factor()
    }));
    it.value = value;
    it
}

/// How far a value is from the ideal one, SI.
fn difference(dimension: Dimension, value: f64, ideal: f64) -> f64 {
    match dimension {
        Dimension::ANGLE => within_half_a_turn(value - ideal),
        _ => value - ideal,
    }
}
