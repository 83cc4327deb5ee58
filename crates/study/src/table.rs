//! Tables: column blocks with units, and the evidence for every row.

use kempe_units::Unit;

/// A table of results. All columns are equally long.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Table {
    /// Name of the study it answers.
    pub name: String,
    /// Columns in order.
    pub columns: Vec<Column>,
    /// How many of them, the first ones, say where a row is to be: they have values where it was not reached, too.
    pub places: usize,
    /// Largest closure residual of each row, relative to the mechanism's size (directions in rad); NaN where the row was
    /// not reached.
    pub closure: Vec<f64>,
    /// Smallest singular value of each row's constraint Jacobian, lengths scaled by the mechanism's size.
    pub smallest_singular_value: Vec<f64>,
    /// How far the forces of each row can be trusted; `None` where none were asked for.
    pub forces: Option<ForceColumns>,
    /// How well a simulation keeps the balance of energy and power; `None` of what is not simulated.
    pub balance: Option<BalanceColumns>,
    /// What is to be said about each row, such as why it was not reached.
    pub notes: Vec<Option<String>>,
}

/// Evidence of the forces of all rows, NaN where a row was not reached.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ForceColumns {
    /// Difference of virtual power and of equilibrium in what the drives give, in parts of the terms it is made of.
    pub route_difference: Vec<f64>,
    /// What is left of the worst body's equilibrium, over its largest term.
    pub residual: Vec<f64>,
    /// Condition of the scaled equations of equilibrium.
    pub condition: Vec<f64>,
}

/// How well a simulation keeps its balances, NaN where a row has none.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BalanceColumns {
    /// Energy at hand less what it began with and what work was done on it, in parts of the most that was moved.
    pub energy: Vec<f64>,
    /// Power that inverse dynamics asks of what is let go beyond what it gives, in parts of the largest at which energy was
    /// moved.
    pub power: Vec<f64>,
}

/// A quantity over the rows of a table.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Column {
    /// Name: a named measure, or the measure as written.
    pub name: String,
    /// The unit of the values.
    pub unit: Unit,
    /// One value a row, in the unit; NaN where it was not reached.
    pub values: Vec<f64>,
}

impl Column {
    /// A column without rows.
    pub fn new(name: impl Into<String>, unit: Unit) -> Self {
        Self {
            name: name.into(),
            unit,
            values: Vec::new(),
        }
    }

    /// `name [unit]`; the unit of plain numbers is written 1.
    pub fn head(&self) -> String {
        let unit = match self.unit.text() {
            "" => "1",
            text => text,
        };
        format!("{} [{unit}]", self.name)
    }

    /// The values in SI.
    pub fn si(&self) -> Vec<f64> {
        self.values.iter().map(|v| self.unit.to_si(*v)).collect()
    }
}

impl Table {
    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.notes.len()
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }

    /// All columns of numbers: the quantities, then the evidence.
    pub fn with_evidence(&self) -> Vec<Column> {
        let mut all = self.columns.clone();
        all.extend(self.evidence());
        all
    }

    /// The evidence of the rows as columns.
    pub fn evidence(&self) -> Vec<Column> {
        let column = |name: &str, values: &[f64]| Column {
            values: values.to_vec(),
            ..Column::new(name, Unit::one())
        };
        let mut all = vec![
            column("closure", &self.closure),
            column("smallest_singular_value", &self.smallest_singular_value),
        ];
        if let Some(forces) = &self.forces {
            all.push(column("route_difference", &forces.route_difference));
            all.push(column("equilibrium_residual", &forces.residual));
            all.push(column("condition", &forces.condition));
        }
        if let Some(balance) = &self.balance {
            all.push(column("energy_residual", &balance.energy));
            all.push(column("power_residual", &balance.power));
        }
        all
    }

    /// Stretches of rows with one note: first row, last row, note.
    pub fn noted(&self) -> Vec<(usize, usize, &str)> {
        let mut stretches: Vec<(usize, usize, &str)> = Vec::new();
        for (row, note) in self.notes.iter().enumerate() {
            let Some(note) = note.as_deref() else {
                continue;
            };
            match stretches.last_mut() {
                Some((_, last, text)) if *last + 1 == row && *text == note => *last = row,
                _ => stretches.push((row, row, note)),
            }
        }
        stretches
    }

    /// Largest closure residual over the rows that were reached; NaN when there is none.
    pub fn worst_closure(&self) -> f64 {
        self.closure.iter().copied().fold(f64::NAN, f64::max)
    }

    /// Smallest singular value over the rows that were reached; NaN when there is none.
    pub fn least_singular_value(&self) -> f64 {
        self.smallest_singular_value
            .iter()
            .copied()
            .fold(f64::NAN, f64::min)
    }

    /// Largest difference of the two routes to the forces over the rows that were reached, with its row.
    pub fn worst_route_difference(&self) -> Option<(usize, f64)> {
        self.forces
            .as_ref()
            .and_then(|f| largest(&f.route_difference))
    }

    /// Largest condition of the equations of equilibrium over the rows that were reached, with its row.
    pub fn worst_condition(&self) -> Option<(usize, f64)> {
        self.forces.as_ref().and_then(|f| largest(&f.condition))
    }

    /// Rows that were not reached.
    pub fn unreached(&self) -> usize {
        self.closure.iter().filter(|c| !c.is_finite()).count()
    }
}

/// The largest of what is a number, with its row; of equals the first.
pub(crate) fn largest(values: &[f64]) -> Option<(usize, f64)> {
    let rows = values.iter().copied().enumerate();
    first_best(rows, f64::gt, 0.0)
}

/// The best of what is a number, and the first row of those whose values differ from it by rounding at most.
pub(crate) fn first_best(
    rows: impl Iterator<Item = (usize, f64)> + Clone,
    better: fn(&f64, &f64) -> bool,
    rounding: f64,
) -> Option<(usize, f64)> {
    let mut rows = rows.filter(|(_, value)| !value.is_nan());
    let values = rows.clone().map(|(_, value)| value);
    let best = values.reduce(|a, b| if better(&b, &a) { b } else { a })?;
    let (row, _) = rows.find(|(_, v)| *v == best || (v - best).abs() <= rounding)?;
    Some((row, best))
}
