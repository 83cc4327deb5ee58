//! Which designs a sweep has, in their order.

use kempe_model::{Change, Combine, Model, ParameterId, SweepStudy, Swept, SweptValues, value};

use crate::unit::{Units, rounded};

/// The designs of a sweep, none of them made before it is asked for.
#[derive(Clone, Debug)]
pub(super) struct Designs {
    /// Values of each parameter, SI; one at a time those that the file has not itself.
    pub axes: Vec<Vec<f64>>,
    /// The file's own values, SI.
    pub own: Vec<f64>,
    combine: Combine,
}

impl Designs {
    pub fn new(model: &Model, study: &SweepStudy) -> Self {
        let parameters = model.parameter_values();
        let of = |id: ParameterId| parameters.get(id.index()).copied().unwrap_or(f64::NAN);
        let own: Vec<f64> = study.vary.iter().map(|it| of(it.parameter)).collect();
        let axes = study.vary.iter().zip(&own).map(|(swept, own)| {
            let mut values = values_of(model, swept, *own, &parameters);
            if study.combine == Combine::OneAtATime {
                values.retain(|value| value != own);
            }
            values
        });
        Self {
            axes: axes.collect(),
            own,
            combine: study.combine,
        }
    }

    /// How many there are, without overflow.
    pub fn count(&self) -> usize {
        let lengths = self.axes.iter().map(Vec::len);
        match self.combine {
            Combine::Grid => lengths.fold(1, usize::saturating_mul),
            Combine::OneAtATime => lengths.fold(1, usize::saturating_add),
            Combine::Together => lengths.min().unwrap_or(0),
        }
    }

    /// The values of a design, SI: of a grid the last parameter goes fastest; one at a time the file's own design is the first.
    pub fn values(&self, index: usize) -> Vec<f64> {
        let at = |axis: &Vec<f64>, k: usize| axis.get(k).copied().unwrap_or(f64::NAN);
        match self.combine {
            Combine::Together => self.axes.iter().map(|axis| at(axis, index)).collect(),
            Combine::Grid => {
                let mut left = index;
                let mut values = vec![f64::NAN; self.axes.len()];
                for (value, axis) in values.iter_mut().zip(&self.axes).rev() {
                    let count = axis.len().max(1);
                    *value = at(axis, left % count);
                    left /= count;
                }
                values
            }
            Combine::OneAtATime => {
                let mut values = self.own.clone();
                if let Some((k, value)) = self.changed(index)
                    && let Some(own) = values.get_mut(k)
                {
                    *own = value;
                }
                values
            }
        }
    }

    /// The parameter that a design changes and its value, one at a time; none for the file's own design and for other sweeps.
    pub fn changed(&self, index: usize) -> Option<(usize, f64)> {
        if self.combine != Combine::OneAtATime {
            return None;
        }
        let mut left = index.checked_sub(1)?;
        for (k, axis) in self.axes.iter().enumerate() {
            match axis.get(left) {
                Some(value) => return Some((k, *value)),
                None => left -= axis.len(),
            }
        }
        None
    }

    /// Whether parameters change one at a time.
    pub fn one_at_a_time(&self) -> bool {
        self.combine == Combine::OneAtATime
    }
}

/// The values of a parameter, SI.
fn values_of(model: &Model, swept: &Swept, own: f64, parameters: &[f64]) -> Vec<f64> {
    match &swept.values {
        SweptValues::These(values) => values.iter().map(|it| value(it, parameters)).collect(),
        SweptValues::Even { from, to, count } => {
            let [from, to] = [from, to].map(|it| value(it, parameters));
            let units = Units::of(model);
            let dimension = model.parameters.get(swept.parameter.index());
            let unit = units.unit(dimension.map_or(kempe_units::Dimension::NONE, |p| p.dimension));
            let [start, end] = [from, to].map(|it| unit.from_si(it));
            let last = count.saturating_sub(1);
            let inner = |k: usize| {
                // Round in the file's unit, as rows are.
                unit.to_si(rounded(start + (end - start) * (k as f64 / last as f64)))
            };
            (0..*count)
                .map(|k| match k {
                    0 => from,
                    _ if k == last => to,
                    _ => inner(k),
                })
                .collect()
        }
        SweptValues::Around(change) => {
            let by = match change {
                Change::By(by) => value(by, parameters),
                Change::Part(part) => (own * value(part, parameters)).abs(),
            };
            vec![own - by, own, own + by]
        }
    }
}
