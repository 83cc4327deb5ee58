//! Values that vary along a motion: what loads are made of.

use kempe_measure::measure::{order_of, visit_leaves};
use kempe_mechanism::Mechanism;
use kempe_model::{self as model, Leaf, Measure, Span};
use kempe_number::Number;

use crate::problem::Problem;
use crate::table::Table;

/// A value that varies: a measure, or a curve over one.
#[derive(Clone, Debug)]
pub struct Amount<T> {
    /// What is measured.
    pub measure: Measure,
    /// The curve over it, with a factor on its values.
    pub curve: Option<(Table, T)>,
}

impl<T: Number> Amount<T> {
    /// Compiles a varying value.
    pub(crate) fn new(
        mechanism: &Mechanism,
        amount: &model::Amount,
        parameters: &[T],
        span: &Span,
        what: &str,
        problems: &mut Vec<Problem>,
    ) -> Self {
        let it = match amount {
            model::Amount::Measure(measure) => Self {
                measure: measure.clone(),
                curve: None,
            },
            model::Amount::Table {
                over,
                at,
                values,
                period,
                factor,
                ..
            } => {
                let table = Table::new(at, values, *period);
                let factor = model::value(factor, parameters);
                if let Err(reason) = &table {
                    problems.push(Problem::new("bad-table", span, format!("{what}: {reason}")));
                }
                Self {
                    measure: (**over).clone(),
                    curve: table.ok().map(|table| (table, factor)),
                }
            }
        };
        let mut asks_forces = false;
        visit_leaves(mechanism, &it.measure, &mut |leaf| {
            asks_forces |= matches!(leaf, Leaf::Force(_));
        });
        if asks_forces {
            problems.push(Problem::new(
                "load-of-force",
                span,
                format!("{what} depends on a force: a load may depend on the motion only"),
            ));
        }
        if let Err(reason) = order_of(mechanism, &it.measure) {
            problems.push(Problem::new(
                "load-measure",
                span,
                format!("{what} {reason}"),
            ));
        }
        it
    }

    /// Its value where the measure has this one.
    pub fn of(&self, measured: T) -> T {
        match &self.curve {
            Some((table, factor)) => table.value(measured) * *factor,
            None => measured,
        }
    }
}
