//! The plots a study asks for.

use kempe_draw::plot::{Axis, Beyond, Curve, Limit, Marker, MarkerKind, PlotSpec, Scale};
use kempe_model::Model;
use kempe_motion::events::EventKind;
use kempe_units::{Dimension, Unit};

use crate::result::{Event, Figure, PlaneCurve, StudyResult};
use crate::table::Column;

/// The kind of mark an event gets.
pub(crate) fn marker_kind(kind: EventKind) -> MarkerKind {
    match kind {
        EventKind::Limit => MarkerKind::DeadPoint,
        EventKind::ChangePoint => MarkerKind::ChangePoint,
        EventKind::ModeChange => MarkerKind::Event,
    }
}

/// The plots of a study, each with a name for its file: `swing`, `path-P`.
///
/// A study that names no plot gets one of each of its first quantities.
pub fn figures(model: &Model, result: &StudyResult) -> Vec<(String, PlotSpec)> {
    let Some(x) = result.abscissa() else {
        return Vec::new();
    };
    let mut plots: Vec<(String, PlotSpec)> = Vec::new();
    for figure in &chosen(model, result) {
        let (name, plot) = match figure {
            Figure::Curves { curves, limits } => {
                let spec = curves_plot(x, curves, markers(x, result));
                let limited = limits.iter().fold(spec, |spec, limit| {
                    spec.with_limit(Limit::along(
                        limit.name.clone(),
                        x.values.clone(),
                        limit.values.clone(),
                    ))
                });
                (names(curves), limited)
            }
            Figure::Within { curve, bound } => {
                let spec = curves_plot(x, std::slice::from_ref(curve), markers(x, result));
                let along = |label: &str, sign: f64, beyond: Beyond| {
                    let values = bound.values.iter().map(|y| sign * y).collect();
                    Limit {
                        beyond: Some(beyond),
                        ..Limit::along(label, x.values.clone(), values)
                    }
                };
                let spec = (spec.with_limit(along(&bound.name, 1.0, Beyond::Above)))
                    .with_limit(along("", -1.0, Beyond::Below));
                (curve.name.clone(), spec)
            }
            Figure::Hodograph(name, axes) => {
                (name.clone(), hodograph(name, axes, x, noise(result)))
            }
            Figure::Plane { name, unit, curves } => (name.clone(), plane(unit, curves)),
            Figure::Graph { name, x, y, curves } => (name.clone(), graph([x, y], curves)),
            Figure::Front { x, y, own } => (y.name.clone(), front(x, y, *own)),
            Figure::Histogram {
                number,
                unit,
                edges,
                counts,
                limits,
            } => (
                format!("histogram-{number}"),
                histogram((number, unit), edges, counts, limits),
            ),
            Figure::Path(point) => {
                let name = model.points.get(point.index()).map_or("", |p| &p.name);
                (
                    format!("path-{name}"),
                    path(model, name, point.index(), result),
                )
            }
        };
        let file = free_name(file_name(&name), |name| {
            name == MECHANISM || plots.iter().any(|(n, _)| n.to_lowercase() == name)
        });
        plots.push((file, plot));
    }
    plots
}

/// What the plots of a study show, in their order.
pub(crate) fn chosen(model: &Model, result: &StudyResult) -> Vec<Figure> {
    // Over the numbers of modes there is nothing to draw.
    if !result.figures.is_empty() || !result.shapes.is_empty() {
        return result.figures.clone();
    }
    let drives = 1 + model.drives.len();
    let own = result.table.columns.iter().skip(drives);
    let own = own.take(MOST_DEFAULT).cloned();
    own.map(|c| Figure::Curves {
        curves: vec![c],
        limits: Vec::new(),
    })
    .collect()
}

/// Plots of a study that names none.
const MOST_DEFAULT: usize = 4;

/// The name of the picture of the mechanism itself, which no plot has.
pub const MECHANISM: &str = "mechanism";

/// The name, or the first of `name-2`, `name-3`, … that is not taken, where capitals do not count.
fn free_name(name: String, taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2..).map(|k| format!("{name}-{k}"));
    std::iter::once(name.clone())
        .chain(numbered)
        .find(|n| !taken(&n.to_lowercase()))
        .unwrap_or(name)
}

/// Bytes of a file name that a measure's text may take.
const MOST_BYTES: usize = 60;

/// The parts of a measure's text that a file name takes.
fn file_name(name: &str) -> String {
    let safe = |c: char| {
        if c.is_alphanumeric() || c == '_' {
            c
        } else {
            '-'
        }
    };
    let text: String = name.chars().map(safe).collect();
    let mut parts = text.split('-').filter(|p| !p.is_empty());
    let first = parts.next().unwrap_or("plot").to_owned();
    let joined = parts.fold(first, |all, part| all + "-" + part);
    let end = joined.floor_char_boundary(MOST_BYTES.min(joined.len()));
    joined[..end].trim_end_matches('-').to_owned()
}

fn names(columns: &[Column]) -> String {
    let all: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    // What all have in common is said once.
    let heads: Vec<&str> = (all.iter())
        .filter_map(|name| Some(name.rsplit_once(", ")?.0))
        .collect();
    match heads.first() {
        Some(head) if heads.len() == all.len() && heads.iter().all(|h| h == head) => {
            (*head).to_owned()
        }
        _ => all.join(", "),
    }
}

/// A force below this part of the largest of the study is what rounding left of none.
const NO_FORCE: f64 = 1e-12;

/// The size below which a force of a study is none, SI.
pub(crate) fn noise(result: &StudyResult) -> f64 {
    let force = |unit: &Unit| unit.dimension() == Dimension::FORCE;
    let of_figures = result.figures.iter().flat_map(|figure| match figure {
        Figure::Hodograph(_, axes) => axes.as_slice(),
        Figure::Curves { curves, .. } => curves.as_slice(),
        Figure::Within { curve, .. } => std::slice::from_ref(curve),
        Figure::Path(_)
        | Figure::Plane { .. }
        | Figure::Graph { .. }
        | Figure::Front { .. }
        | Figure::Histogram { .. } => &[],
    });
    let columns = result.table.columns.iter().chain(of_figures);
    let values = columns.filter(|c| force(&c.unit)).flat_map(Column::si);
    let arrows = result.frames.iter().flat_map(|f| &f.arrows);
    let arrows = arrows.flat_map(|a| a.force);
    let largest = values.chain(arrows).map(f64::abs);
    NO_FORCE * largest.filter(|v| v.is_finite()).fold(0.0, f64::max)
}

/// Curves in the plane.
fn plane(unit: &Unit, curves: &[PlaneCurve]) -> PlotSpec {
    let axis = |name: &str| (name.to_owned(), unit.clone());
    PlotSpec {
        equal_aspect: true,
        ..graph([&axis("x"), &axis("y")], curves)
    }
}

/// Curves of one quantity over another.
fn graph(axes: [&(String, Unit); 2], curves: &[PlaneCurve]) -> PlotSpec {
    let [x, y] = axes.map(|(name, unit)| Axis::new(name.clone(), unit.text()));
    PlotSpec {
        x,
        y,
        curves: curves.iter().map(own_curve).collect(),
        ..PlotSpec::default()
    }
}

fn own_curve(curve: &PlaneCurve) -> Curve {
    Curve {
        label: curve.name.clone(),
        x: curve.points.iter().map(|p| p[0]).collect(),
        y: curve.points.iter().map(|p| p[1]).collect(),
        dashed: curve.dashed,
        ..Curve::default()
    }
}

/// Room around the outermost dots, in parts of what they span.
const DOTS_MARGIN: f64 = 0.05;

/// Designs as dots in two goals.
pub(crate) fn front(x: &Column, y: &Column, own: Option<[f64; 2]>) -> PlotSpec {
    let axis = |column: &Column, k: usize| {
        let values = column.values.iter().copied().chain(own.map(|own| own[k]));
        let limits = Scale::range(values, false, DOTS_MARGIN);
        Axis {
            limits: Some(limits),
            ..Axis::new(column.name.clone(), column.unit.text())
        }
    };
    let mut curves = vec![Curve {
        label: own.map_or(String::new(), |_| "the front".to_owned()),
        x: x.values.clone(),
        y: y.values.clone(),
        dots: true,
        ..Curve::default()
    }];
    curves.extend(own.map(|own| Curve {
        label: "the file's own".to_owned(),
        x: vec![own[0]],
        y: vec![own[1]],
        dots: true,
        dashed: true,
        ..Curve::default()
    }));
    PlotSpec {
        x: axis(x, 0),
        y: axis(y, 1),
        curves,
        ..PlotSpec::default()
    }
}

/// Counts over a number, in steps, with its limits as lines.
fn histogram(
    (number, unit): (&str, &Unit),
    edges: &[f64],
    counts: &[f64],
    limits: &[(String, f64)],
) -> PlotSpec {
    let ends = edges.windows(2).zip(counts);
    let steps = ends.flat_map(|(pair, count)| [[pair[0], *count], [pair[1], *count]]);
    let first = edges.first().map(|x| [*x, 0.0]);
    let last = edges.last().map(|x| [*x, 0.0]);
    let outline: Vec<[f64; 2]> = first.into_iter().chain(steps).chain(last).collect();
    let most = counts.iter().copied().fold(0.0, f64::max);
    let line = |(name, at): &(String, f64)| Curve {
        label: name.clone(),
        x: vec![*at; 2],
        y: vec![0.0, most],
        dashed: true,
        ..Curve::default()
    };
    let mut curves = vec![Curve {
        label: if limits.is_empty() {
            String::new()
        } else {
            number.to_owned()
        },
        x: outline.iter().map(|p| p[0]).collect(),
        y: outline.iter().map(|p| p[1]).collect(),
        ..Curve::default()
    }];
    curves.extend(limits.iter().map(line));
    PlotSpec {
        x: Axis::new(number, unit.text()),
        y: Axis::new("pieces", ""),
        curves,
        ..PlotSpec::default()
    }
}

/// A curve in the plane; of forces without the noise in them, SI.
pub(crate) fn hodograph(name: &str, [x, y]: &[Column; 2], along: &Column, noise: f64) -> PlotSpec {
    let values = |column: &Column| -> Vec<f64> {
        let is_force = column.unit.dimension() == Dimension::FORCE;
        let plain = |v: &f64| match is_force && column.unit.to_si(*v).abs() < noise {
            true => 0.0,
            false => *v,
        };
        column.values.iter().map(plain).collect()
    };
    PlotSpec {
        title: name.to_owned(),
        x: Axis::new("x", x.unit.text()),
        y: Axis::new("y", y.unit.text()),
        curves: vec![Curve {
            label: String::new(),
            x: values(x),
            y: values(y),
            ..Curve::default()
        }],
        equal_aspect: true,
        ..PlotSpec::default()
    }
    .as_hodograph(along.values.clone(), along.unit.text())
}

/// The marks of events over a column.
fn markers(x: &Column, result: &StudyResult) -> Vec<Marker> {
    let marker = |event: &Event| {
        // An event stands at a coordinate of the drive; along time or an arc it is where its row is.
        let at = if result.along == 0 {
            x.values.get(event.row).copied().unwrap_or(f64::NAN)
        } else {
            x.unit.from_si(event.at)
        };
        Marker {
            at,
            label: match event.kind {
                EventKind::Limit => "limit".into(),
                _ => "change point".into(),
            },
            kind: marker_kind(event.kind),
        }
    };
    result.events.iter().map(marker).collect()
}

/// Columns of one dimension over another column.
pub(crate) fn curves_plot(x: &Column, columns: &[Column], markers: Vec<Marker>) -> PlotSpec {
    PlotSpec {
        title: String::new(),
        x: Axis::new(x.name.clone(), x.unit.text()),
        // Several curves have a legend.
        y: Axis::new(
            match columns {
                [one] => one.name.clone(),
                _ => String::new(),
            },
            columns.first().map_or("", |c| c.unit.text()),
        ),
        curves: columns
            .iter()
            .enumerate()
            .map(|(index, y)| Curve {
                label: if columns.len() > 1 {
                    y.name.clone()
                } else {
                    String::new()
                },
                x: x.values.clone(),
                y: y.values.clone(),
                dashed: index > 0,
                ..Curve::default()
            })
            .collect(),
        markers,
        ..PlotSpec::default()
    }
}

pub(crate) fn path(model: &Model, name: &str, point: usize, result: &StudyResult) -> PlotSpec {
    let unit = &model.units.length;
    let coordinate = |k: usize| -> Vec<f64> {
        let at = |f: &crate::result::Frame| f.points.get(point).map_or(f64::NAN, |p| p[k]);
        result.frames.iter().map(|f| at(f) / unit.factor).collect()
    };
    PlotSpec {
        title: format!("Path of {name}"),
        x: Axis::new("x", unit.name.clone()),
        y: Axis::new("y", unit.name.clone()),
        curves: vec![Curve {
            label: String::new(),
            x: coordinate(0),
            y: coordinate(1),
            ..Curve::default()
        }],
        equal_aspect: true,
        ..PlotSpec::default()
    }
}

#[cfg(test)]
mod tests {
    use super::{file_name, free_name};

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_name("rate(swing, 2)"), "rate-swing-2");
        assert_eq!(file_name("path-P"), "path-P");
        assert_eq!(file_name("../../x"), "x");
        assert_eq!(file_name("/ * /"), "plot");
    }

    #[test]
    fn names_of_files_are_free_and_short() {
        let taken = |name: &str| ["a", "a-2", "mechanism"].contains(&name);
        assert_eq!(free_name("b".into(), taken), "b");
        assert_eq!(free_name("A".into(), taken), "A-3");
        assert_eq!(free_name("mechanism".into(), taken), "mechanism-2");
        assert_eq!(file_name("hypot(x(P), y(P)) / 2"), "hypot-x-P-y-P-2");
        assert_eq!(file_name(&"ä".repeat(80)).len(), 60);
        assert_eq!(file_name("+"), "plot");
    }
}
