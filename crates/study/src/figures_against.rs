//! The plots of a study with another design's curves in them: this one's solid, the other one's dashed.

use kempe_draw::plot::{Axis, Curve, PlotSpec, Told};
use kempe_model::Model;
use kempe_units::Unit;

use crate::comparison::{Matched, converted};
use crate::figures::{chosen, figures, hodograph, noise, path};
use crate::result::{Figure, StudyResult};
use crate::table::Column;

/// The plots of a study, called as [`figures`] calls them, with the curves of another design's result of the same study. A plot
/// of what the other one has not stays as it is.
pub fn figures_against(
    model: &Model,
    result: &StudyResult,
    other_model: &Model,
    other: &StudyResult,
) -> Vec<(String, PlotSpec)> {
    let matched = Matched::of(result, other);
    let mut plots = figures(model, result);
    for ((_, plot), figure) in plots.iter_mut().zip(chosen(model, result)) {
        let others = match &figure {
            Figure::Curves { curves, .. } => over_the_drive(result, curves, other),
            Figure::Within { curve, .. } => {
                over_the_drive(result, std::slice::from_ref(curve), other)
            }
            Figure::Plane { .. }
            | Figure::Graph { .. }
            | Figure::Front { .. }
            | Figure::Histogram { .. } => Vec::new(),
            Figure::Path(point) => {
                let name = model.points.get(point.index()).map_or("", |p| &p.name);
                let index = other_model.points.iter().position(|p| p.name == name);
                let spec = index.map(|index| path(other_model, name, index, other));
                in_the_plane(&format!("y({name})"), spec)
            }
            Figure::Hodograph(name, _) => {
                let axes = other.figures.iter().find_map(|figure| match figure {
                    Figure::Hodograph(own, axes) if own == name => Some(axes),
                    _ => None,
                });
                let spec = axes
                    .zip(other.abscissa())
                    .map(|(axes, along)| hodograph(name, axes, along, noise(other)));
                in_the_plane(name, spec)
            }
        };
        overlay(plot, others, &matched);
    }
    plots
}

/// A curve of the other design beside one of this.
struct Beside {
    /// The number of this design's curve.
    index: usize,
    /// What it shows.
    name: String,
    /// Abscissae with their unit, and ordinates.
    values: [(Vec<f64>, Unit); 2],
}

/// Curves over what this design's rows run along, where the other one knows that too.
fn over_the_drive(result: &StudyResult, curves: &[Column], other: &StudyResult) -> Vec<Beside> {
    let along = result.abscissa().and_then(|own| quantity(other, &own.name));
    let Some(along) = along else {
        return Vec::new();
    };
    let beside = |(index, curve): (usize, &Column)| {
        let column = quantity(other, &curve.name)?;
        let values = [along, column].map(|c| (c.values.clone(), c.unit.clone()));
        Some(Beside {
            index,
            name: curve.name.clone(),
            values,
        })
    };
    curves.iter().enumerate().filter_map(beside).collect()
}

/// The one curve of a plot in the plane.
fn in_the_plane(name: &str, spec: Option<PlotSpec>) -> Vec<Beside> {
    let beside = spec.and_then(|spec| {
        let curve = spec.curves.into_iter().next()?;
        Some(Beside {
            index: 0,
            name: name.to_owned(),
            values: [(curve.x, unit(&spec.x)?), (curve.y, unit(&spec.y)?)],
        })
    });
    beside.into_iter().collect()
}

fn unit(axis: &Axis) -> Option<Unit> {
    match axis.unit.as_str() {
        "" => Some(Unit::one()),
        text => Unit::parse(text).ok(),
    }
}

/// A quantity of a result: a column of its table, or a plotted one.
pub(crate) fn quantity<'r>(result: &'r StudyResult, name: &str) -> Option<&'r Column> {
    let plotted = result.figures.iter().flat_map(|figure| match figure {
        Figure::Curves { curves, limits } => curves.iter().chain(limits),
        Figure::Within { curve, bound } => std::slice::from_ref(curve)
            .iter()
            .chain(std::slice::from_ref(bound)),
        Figure::Path(_)
        | Figure::Hodograph(..)
        | Figure::Plane { .. }
        | Figure::Graph { .. }
        | Figure::Front { .. }
        | Figure::Histogram { .. } => [].iter().chain(&[]),
    });
    (result.table.columns.iter().chain(plotted)).find(|c| c.name == name)
}

/// Puts the other design's curves into a plot.
fn overlay(plot: &mut PlotSpec, others: Vec<Beside>, matched: &Matched) {
    let alone = plot.curves.len() == 1;
    let axes = [unit(&plot.x), unit(&plot.y)];
    let curve = |beside: Beside| {
        let [x, y] = [0, 1].map(|k: usize| {
            let ((values, from), to) = (&beside.values[k], axes[k].as_ref()?);
            let same = from.dimension() == to.dimension();
            same.then(|| converted_all(values, from, to))
        });
        let (x, y, name) = (x?, y?, format!("{}, against", beside.name));
        Some(Curve {
            label: match alone {
                true => "against".to_owned(),
                false => name.clone(),
            },
            told: Some(Told {
                name,
                x: matched.values(&x),
                y: matched.values(&y),
            }),
            x,
            y,
            dashed: true,
            dots: false,
            // Several quantities keep their colours; a lone one leaves another colour free.
            color: Some(if alone { 1 } else { beside.index }),
        })
    };
    let others: Vec<Curve> = others.into_iter().filter_map(curve).collect();
    if others.is_empty() {
        for curve in &mut plot.curves {
            let name = if alone { "" } else { &curve.label };
            curve.label = format!("{name} only in this design")
                .trim_start()
                .to_owned();
        }
        return;
    }
    for curve in &mut plot.curves {
        curve.dashed = false;
        if alone {
            curve.label = "this".to_owned();
        }
    }
    plot.curves.extend(others);
}

/// Values in another unit of their dimension.
pub(crate) fn converted_all(values: &[f64], from: &Unit, to: &Unit) -> Vec<f64> {
    values.iter().map(|v| converted(*v, from, to)).collect()
}
