//! The plots a study asks for.

use kempe_draw::plot::{Axis, Curve, Limit, Marker, MarkerKind, PlotSpec};
use kempe_kinematics::events::EventKind;
use kempe_model::Model;

use crate::result::{Event, Figure, StudyResult};
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
    let drives = 1 + model.drives.len();
    let mut chosen: Vec<Figure> = result.figures.clone();
    if chosen.is_empty() {
        let own = result.table.columns.iter().skip(drives);
        let own = own.take(MOST_DEFAULT).cloned();
        chosen = own
            .map(|c| Figure::Curves {
                curves: vec![c],
                limits: Vec::new(),
            })
            .collect();
    }
    let mut plots: Vec<(String, PlotSpec)> = Vec::new();
    for figure in &chosen {
        let (name, plot) = match figure {
            Figure::Curves { curves, limits } => {
                let spec = curves_plot(x, curves, result);
                let limited = limits.iter().fold(spec, |spec, limit| {
                    spec.with_limit(Limit::along(
                        limit.name.clone(),
                        x.values.clone(),
                        limit.values.clone(),
                    ))
                });
                (names(curves), limited)
            }
            Figure::Hodograph(name, axes) => (name.clone(), hodograph(name, axes, x)),
            Figure::Path(point) => {
                let name = model.points.get(point.index()).map_or("", |p| &p.name);
                (
                    format!("path-{name}"),
                    path(model, name, point.index(), result),
                )
            }
        };
        let mut file = file_name(&name);
        let taken = plots.iter().filter(|(n, _)| *n == file).count();
        if taken > 0 {
            file = format!("{file}-{}", plots.len() + 1);
        }
        plots.push((file, plot));
    }
    plots
}

/// Plots of a study that names none.
const MOST_DEFAULT: usize = 4;

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
    joined.chars().take(60).collect()
}

fn names(columns: &[Column]) -> String {
    let all: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    all.join(", ")
}

fn hodograph(name: &str, [x, y]: &[Column; 2], along: &Column) -> PlotSpec {
    PlotSpec {
        title: name.to_owned(),
        x: Axis::new("x", x.unit.text()),
        y: Axis::new("y", y.unit.text()),
        curves: vec![Curve {
            label: String::new(),
            x: x.values.clone(),
            y: y.values.clone(),
            dashed: false,
        }],
        equal_aspect: true,
        ..PlotSpec::default()
    }
    .as_hodograph(along.values.clone(), along.unit.text())
}

fn curves_plot(x: &Column, columns: &[Column], result: &StudyResult) -> PlotSpec {
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
            })
            .collect(),
        markers: result.events.iter().map(marker).collect(),
        ..PlotSpec::default()
    }
}

fn path(model: &Model, name: &str, point: usize, result: &StudyResult) -> PlotSpec {
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
            dashed: false,
        }],
        equal_aspect: true,
        ..PlotSpec::default()
    }
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_name("rate(swing, 2)"), "rate-swing-2");
        assert_eq!(file_name("path-P"), "path-P");
        assert_eq!(file_name("../../x"), "x");
        assert_eq!(file_name("/ * /"), "plot");
    }
}
