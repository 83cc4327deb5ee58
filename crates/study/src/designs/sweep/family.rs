//! Families of curves: what is plotted, of several designs in one picture; and numbers over the one parameter that varies.

use kempe_units::Unit;

use super::drawn::Drawn;
use super::question::{DRAWN, Question};
use crate::result::{Figure, Listing, PlaneCurve};
use crate::table::{Column, Table};

/// So many numbers are plotted over the one parameter that varies.
const NUMBERS: usize = 8;

/// Curves in a picture that have a colour of their own; the next ones are dashed.
const COLOURS: usize = 6;

/// The curves of designs, what they run along first.
type Curves = [(usize, Vec<Vec<f64>>)];

/// All pictures of a sweep but its tornadoes.
pub(super) fn figures(question: &Question<'_>, table: &Table, curves: &Curves) -> Vec<Figure> {
    let mut figures = Vec::new();
    let varied = question.designs.own.len();
    if varied == 1 && !question.designs.one_at_a_time() && table.rows() > 1 {
        let numbers = table.columns.iter().skip(1 + varied).take(NUMBERS);
        figures.extend(numbers.map(|column| Figure::Curves {
            curves: vec![column.clone()],
            limits: Vec::new(),
        }));
    }
    let along = question.abscissa();
    // The first curve is what they run along.
    let mut first = 1;
    for plot in &question.plots {
        figures.push(family(question, plot, (&along, curves), first));
        first += match plot {
            Drawn::Curves(names) => names.len(),
            Drawn::Path(_) => 2,
        };
    }
    figures
}

/// One picture of several designs; what it shows begins at the `first` of their curves.
fn family(
    question: &Question<'_>,
    plot: &Drawn,
    (along, curves): (&Column, &Curves),
    first: usize,
) -> Figure {
    let pairs = |own: &[Vec<f64>], x: usize, y: usize| -> Vec<[f64; 2]> {
        let (xs, ys) = (own.get(x), own.get(y));
        let both = xs.into_iter().flatten().zip(ys.into_iter().flatten());
        both.map(|(x, y)| [*x, *y]).collect()
    };
    match plot {
        Drawn::Path(point) => {
            let name = question.model.points.get(point.index());
            let curve = |(index, own): &(usize, Vec<Vec<f64>>)| PlaneCurve {
                name: label(question, *index),
                points: pairs(own, first, first + 1),
                dashed: false,
            };
            Figure::Plane {
                name: format!("path-{}", name.map_or("", |p| &p.name)),
                unit: question.units.unit(kempe_units::Dimension::LENGTH),
                curves: curves.iter().map(curve).collect(),
            }
        }
        Drawn::Curves(names) => {
            let one = names.len() == 1;
            let family = curves.iter().enumerate().flat_map(|(n, (index, own))| {
                let label = label(question, *index);
                names.iter().enumerate().map(move |(k, column)| PlaneCurve {
                    name: match one {
                        true => label.clone(),
                        false => format!("{column}, {label}"),
                    },
                    points: pairs(own, 0, first + k),
                    dashed: match one {
                        true => (n / COLOURS) % 2 == 1,
                        false => k > 0,
                    },
                })
            });
            let unit = question.curve_unit(first - 1);
            let alone = names.first().filter(|_| one);
            Figure::Graph {
                name: names.join(", "),
                x: (along.name.clone(), along.unit.clone()),
                y: (
                    alone.cloned().unwrap_or_default(),
                    unit.unwrap_or_else(Unit::one),
                ),
                curves: family.collect(),
            }
        }
    }
}

/// A design by its parameters.
fn label(question: &Question<'_>, index: usize) -> String {
    let designs = &question.designs;
    let text =
        |k: usize, value: f64| format!("{} = {}", question.name_of(k), question.text_of(k, value));
    if designs.one_at_a_time() {
        return match designs.changed(index) {
            Some((k, value)) => text(k, value),
            None => "as in the file".to_owned(),
        };
    }
    let values = designs.values(index);
    let all = values.iter().enumerate().map(|(k, value)| text(k, *value));
    all.collect::<Vec<_>>().join(", ")
}

/// That not all designs are drawn.
pub(super) fn left_out(question: &Question<'_>) -> Option<Listing> {
    let all = question.designs.count();
    (all > DRAWN && question.curves() > 1).then(|| Listing {
        title: format!(
            "in the pictures are the curves of {DRAWN} designs of {all}, evenly among them"
        ),
        head: Vec::new(),
        rows: Vec::new(),
    })
}
