//! What a sweep tells in words: its designs, exact derivatives beside differences, and which parameter changes a number most.

use kempe_model::Diagnostic;
use kempe_motion::Silent;

use super::question::Question;
use crate::designs::bench::Sloped;
use crate::designs::idle::idle;
use crate::quantity::Quantity;
use crate::result::{Figure, Listing, PlaneCurve};
use crate::sensitivities::unit_per;
use crate::table::{Column, Table};
use crate::unit::{number_text, shown};

/// Of so many numbers it is told which parameter changes them most.
const RANKED: usize = 8;
/// Half the height of a bar, in the distance of two.
const HALF_BAR: f64 = 0.35;
/// What is told where there is nothing.
const NONE: &str = "none";

/// What is known of the file's own design.
pub(super) struct Own {
    /// Its numbers with their derivatives, SI; none where it does not move, or a simulation is run.
    sloped: Vec<Sloped>,
    /// What is to be told of its numbers.
    told: Vec<Diagnostic>,
}

impl Own {
    /// Asks the file's own design.
    pub fn of(question: &Question<'_>) -> Self {
        let bench = &question.bench;
        // A study that is run as a whole tells what it tells alone.
        let none = || Self {
            sloped: Vec::new(),
            told: (question.whole.as_ref()).map_or(Vec::new(), |whole| whole.told.clone()),
        };
        if !question.has_derivatives() {
            return none();
        }
        let values = bench.own_values();
        let Ok(motion) = bench.motion(&values, &mut Silent) else {
            return none();
        };
        let quantities: Vec<&Quantity> = bench.numbers.iter().collect();
        let told = match bench.along(&motion, &quantities, &mut Silent) {
            Ok(along) => along.number_warnings(Some(&question.name), &quantities),
            Err(_) => return none(),
        };
        Self {
            sloped: bench.slopes(&values).unwrap_or_default(),
            told,
        }
    }

    /// What is to be told of it.
    pub fn told(&self, question: &Question<'_>) -> Vec<Diagnostic> {
        let slopes: Vec<&[f64]> = self.sloped.iter().map(|it| it.slope.as_slice()).collect();
        let ends = question.designs.axes.iter().zip(&question.designs.own);
        let ends = ends.map(|(axis, own)| {
            let all = axis.iter().copied();
            [f64::min, f64::max].map(|of| all.clone().reduce(of).unwrap_or(*own))
        });
        let ends: Vec<[f64; 2]> = ends.collect();
        let spans = question.study.vary.iter().map(|it| it.span.clone());
        let idle = match slopes.is_empty() {
            true => Vec::new(),
            false => idle(&question.bench, &slopes, &ends, spans),
        };
        self.told.iter().cloned().chain(idle).collect()
    }
}

/// Exact derivatives at the file's own design, beside what differences of designs say that differ in one parameter alone.
pub(super) fn derivatives(question: &Question<'_>, own: &Own, table: &Table) -> Option<Listing> {
    let numbers = question.bench.numbers.iter().zip(&own.sloped).enumerate();
    let rows = numbers.flat_map(|(n, (number, sloped))| {
        let unit = number.unit(&question.units);
        sloped.slope.iter().enumerate().map(move |(k, slope)| {
            let per = question.unit_of(k);
            let exact = unit.from_si(*slope) * per.to_si(1.0);
            let text = |x: Option<f64>| match x.filter(|x| x.is_finite()) {
                Some(x) => number_text(x),
                None => NONE.to_owned(),
            };
            let own = [
                *question.designs.own.get(k).unwrap_or(&f64::NAN),
                sloped.value,
            ];
            let own = [shown(own[0], &per), shown(own[1], &unit)];
            let [below, above] = beside(question, table, (n, k), own);
            vec![
                number.name.clone(),
                question.name_of(k).to_owned(),
                text(Some(exact)),
                text(below),
                text(above),
                unit_per(&unit, &per),
            ]
        })
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let head = [
        "number",
        "parameter",
        "derivative",
        "from below",
        "to above",
        "unit",
    ];
    (!rows.is_empty()).then(|| Listing {
        title: "exact derivatives at the file's own values, beside differences of the designs"
            .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
    })
}

/// The slope of a number from the nearest design below the file's own and to the nearest above that differ from it in one parameter alone. They are far from
/// each other where it bends, as where the largest value over the motion changes from one peak to another.
fn beside(
    question: &Question<'_>,
    table: &Table,
    (number, k): (usize, usize),
    [x, y]: [f64; 2],
) -> [Option<f64>; 2] {
    let around = alone(question, table, number, k);
    let below = around.iter().rev().find(|(other, _)| *other < x);
    let above = around.iter().find(|(other, _)| *other > x);
    [below, above].map(|other| other.map(|other| (other.1 - y) / (other.0 - x)))
}

/// The values of a parameter and of a number, in the order of the first, of all designs that have the file's own values but for that parameter.
fn alone(question: &Question<'_>, table: &Table, number: usize, k: usize) -> Vec<(f64, f64)> {
    let own: Vec<f64> = (question.designs.own.iter().enumerate())
        .map(|(k, si)| shown(*si, &question.unit_of(k)))
        .collect();
    let at = |column: usize, row: usize| {
        let column = table.columns.get(column);
        column.and_then(|c| c.values.get(row)).copied()
    };
    let mut found: Vec<(f64, f64)> = (0..table.rows())
        .filter(|row| {
            let mut others = own.iter().enumerate().filter(|(other, _)| *other != k);
            others.all(|(other, own)| at(1 + other, *row) == Some(*own))
        })
        .filter_map(|row| Some((at(1 + k, row)?, at(1 + own.len() + number, row)?)))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// A parameter with what its least and greatest values make of a number.
struct Bar {
    parameter: usize,
    /// Its least and greatest value, in its unit, with the number there.
    ends: [(f64, f64); 2],
    /// The least and the greatest value of the number.
    reach: [f64; 2],
}

/// Which parameter changes a number most, one at a time: in words and as a picture.
pub(super) fn tornado(question: &Question<'_>, table: &Table) -> (Vec<Listing>, Vec<Figure>) {
    let numbers = question.numbers();
    let ranked = numbers.iter().take(RANKED).enumerate();
    ranked
        .filter_map(|(n, number)| {
            let bars = bars(question, table, n);
            let column = table.columns.get(1 + question.designs.own.len() + n);
            let own = column.and_then(|c| c.values.first()).copied();
            (!bars.is_empty()).then(|| {
                (
                    in_words(question, number, &bars),
                    drawn(question, number, &bars, own.unwrap_or(f64::NAN)),
                )
            })
        })
        .unzip()
}

fn bars(question: &Question<'_>, table: &Table, number: usize) -> Vec<Bar> {
    let bar = |parameter: usize| {
        let found = alone(question, table, number, parameter);
        let finite = found.iter().map(|(_, y)| *y).filter(|y| y.is_finite());
        let reach = [f64::min, f64::max].map(|of| finite.clone().reduce(of));
        match (found.as_slice(), reach) {
            ([first, .., last], [Some(least), Some(greatest)]) => Some(Bar {
                parameter,
                ends: [*first, *last],
                reach: [least, greatest],
            }),
            _ => None,
        }
    };
    let mut all: Vec<Bar> = (0..question.designs.own.len()).filter_map(bar).collect();
    let size = |bar: &Bar| bar.reach[1] - bar.reach[0];
    // Stable: equal ones stay in the order of the file.
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    all
}

fn in_words(question: &Question<'_>, number: &Column, bars: &[Bar]) -> Listing {
    let head = number.head();
    let rows = bars.iter().map(|bar| {
        let value = |x: f64| match x.is_finite() {
            true => number_text(x),
            false => NONE.to_owned(),
        };
        let [(from, at_from), (to, at_to)] = bar.ends;
        let unit = question.unit_of(bar.parameter);
        vec![
            Column::new(question.name_of(bar.parameter), unit).head(),
            number_text(from),
            number_text(to),
            value(at_from),
            value(at_to),
            value(bar.reach[1] - bar.reach[0]),
        ]
    });
    let names = ["parameter", "least", "greatest", "there", "there", "change"];
    Listing {
        title: format!("what changes {head} most"),
        head: names.map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

/// Bars from the least to the greatest value of a number, the longest on top.
fn drawn(question: &Question<'_>, number: &Column, bars: &[Bar], own: f64) -> Figure {
    let bar = |(rank, bar): (usize, &Bar)| {
        let middle = (bars.len() - rank) as f64;
        let (low, high) = (middle - HALF_BAR, middle + HALF_BAR);
        let [least, greatest] = bar.reach;
        let [(from, _), (to, _)] = bar.ends;
        let unit = question.unit_of(bar.parameter);
        let ends = [from, to].map(number_text).join(" to ");
        PlaneCurve {
            name: format!(
                "{}: {ends} {}",
                question.name_of(bar.parameter),
                unit.text()
            )
            .trim_end()
            .to_owned(),
            points: vec![
                [least, low],
                [greatest, low],
                [greatest, high],
                [least, high],
                [least, low],
            ],
            dashed: false,
        }
    };
    let own = own.is_finite().then(|| PlaneCurve {
        name: "as in the file".to_owned(),
        points: vec![[own, 1.0 - HALF_BAR], [own, bars.len() as f64 + HALF_BAR]],
        dashed: true,
    });
    Figure::Graph {
        name: format!("tornado-{}", number.name),
        x: (number.name.clone(), number.unit.clone()),
        y: ("place from below".to_owned(), kempe_units::Unit::one()),
        curves: bars.iter().enumerate().map(bar).chain(own).collect(),
    }
}
