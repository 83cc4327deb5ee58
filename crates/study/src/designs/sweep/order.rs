//! Which designs a sweep has, and in which order.

use kempe_model::{Change, Combine, SweepStudy, SweptValues, value};

use crate::designs::bench::Bench;
use crate::result::Figure;
use crate::table::Table;

/// The designs of a sweep.
pub(super) struct Order {
    /// Values of the varied parameters, SI, by design.
    pub designs: Vec<Vec<f64>>,
    /// Where one parameter is changed at a time: the first design is the file's own, and each further one is of this parameter.
    pub of: Vec<Option<usize>>,
}

impl Order {
    /// How many designs a sweep has, where that can be counted.
    pub fn count(study: &SweepStudy) -> Option<usize> {
        let mut counts = study.vary.iter().map(|swept| swept.values.count());
        match study.combine {
            Combine::Grid => counts.try_fold(1_usize, usize::checked_mul),
            Combine::OneAtATime => Some(1 + counts.sum::<usize>()),
            Combine::Together => counts.max(),
        }
    }

    pub fn new(bench: &Bench<'_>, study: &SweepStudy) -> Self {
        let own = bench.own_values();
        let lists: Vec<Vec<f64>> = (study.vary.iter().zip(&own))
            .map(|(swept, own)| values(bench, &swept.values, *own))
            .collect();
        let mut designs = Vec::new();
        let mut of = Vec::new();
        match study.combine {
            Combine::Grid => {
                let count: usize = lists.iter().map(Vec::len).product();
                for mut k in 0..count {
                    let mut design = own.clone();
                    // The last parameter changes first.
                    for (x, list) in design.iter_mut().zip(&lists).rev() {
                        *x = list[k % list.len()];
                        k /= list.len();
                    }
                    designs.push(design);
                }
            }
            Combine::OneAtATime => {
                designs.push(own.clone());
                of.push(None);
                for (k, list) in lists.iter().enumerate() {
                    for value in list.iter().filter(|value| **value != own[k]) {
                        let mut design = own.clone();
                        design[k] = *value;
                        designs.push(design);
                        of.push(Some(k));
                    }
                }
            }
            Combine::Together => {
                for k in 0..lists.first().map_or(0, Vec::len) {
                    designs.push(lists.iter().map(|list| list[k]).collect());
                }
            }
        }
        of.resize(designs.len(), None);
        Self { designs, of }
    }

    /// The least and the greatest value of each parameter.
    pub fn ends(&self) -> Vec<[f64; 2]> {
        let count = self.designs.first().map_or(0, Vec::len);
        let of = |k: usize| {
            let values = self.designs.iter().map(|design| design[k]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            })
        };
        (0..count).map(of).collect()
    }

    /// Of a sweep of one parameter its numbers over that parameter.
    pub fn over_one(&self, bench: &Bench<'_>, table: &Table) -> Option<Vec<Figure>> {
        if bench.varied.len() != 1 || self.designs.len() < 3 {
            return None;
        }
        let x = table.columns.get(1)?;
        let mut rows: Vec<usize> = (0..table.rows()).collect();
        rows.sort_by(|a, b| x.values[*a].total_cmp(&x.values[*b]));
        let numbers = table.columns.iter().skip(2);
        let figure = |column: &crate::table::Column| Figure::Graph {
            name: format!("{} over {}", column.name, x.name),
            x: (x.name.clone(), x.unit.clone()),
            y: (column.name.clone(), column.unit.clone()),
            curves: vec![crate::result::PlaneCurve {
                name: String::new(),
                points: rows
                    .iter()
                    .map(|k| [x.values[*k], column.values[*k]])
                    .collect(),
                dashed: false,
            }],
        };
        Some(numbers.map(figure).collect())
    }
}

/// The values of a parameter, SI.
fn values(bench: &Bench<'_>, values: &SweptValues, own: f64) -> Vec<f64> {
    let parameters = bench.model.parameter_values::<f64>();
    let number = |x| value::<f64>(x, &parameters);
    match values {
        SweptValues::These(list) => list.iter().map(number).collect(),
        SweptValues::Even { from, to, count } => {
            let (from, to) = (number(from), number(to));
            let last = (count - 1) as f64;
            (0..*count)
                .map(|k| match k + 1 == *count {
                    true => to,
                    false => from + (to - from) * (k as f64 / last),
                })
                .collect()
        }
        SweptValues::Around(change) => {
            let by = match change {
                Change::By(by) => number(by),
                Change::Part(part) => number(part) * own.abs(),
            };
            vec![own - by, own, own + by]
        }
    }
}
