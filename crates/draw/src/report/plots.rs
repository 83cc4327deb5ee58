//! The plots behind a motion's page: what the script needs to draw them at any width, and at another width again.

use super::motion_report::{Column, MotionReport};
use super::rows::Rows;
use super::{columns, json};
use crate::plot::{Axis, Beyond, Curve, Limit, LimitLine, MarkerKind, PlotSpec, thinned};

/// Significant digits of what is only drawn.
const DIGITS: usize = 7;

/// All plots of a motion as a JSON array.
pub(super) fn plots(motion: &MotionReport, rows: &Rows) -> String {
    let plots = motion.plots.iter();
    json::array(plots.map(|spec| plot(motion, rows, spec)))
}

fn plot(motion: &MotionReport, rows: &Rows, spec: &PlotSpec) -> String {
    let curve = |(index, c): (usize, &Curve)| {
        let (x, y) = match &c.told {
            Some(told) => (&told.x, &told.y),
            None => (&c.x, &c.y),
        };
        let own = x.len() == rows.all && y.len() == rows.all;
        let mut fields = vec![
            ("label", json::string(&c.label)),
            ("dashed", c.dashed.to_string()),
            ("dots", c.dots.to_string()),
            ("color", c.color.unwrap_or(index).to_string()),
            ("own", own.to_string()),
        ];
        if let Some(told) = &c.told {
            fields.push(("name", json::string(&told.name)));
        }
        match own {
            true => fields.extend([
                ("x", column(motion, rows, x)),
                ("y", column(motion, rows, y)),
            ]),
            false => fields.extend([("x", drawn(&c.x)), ("y", drawn(&c.y))]),
        }
        // no peak is lost where the page has fewer rows than the curve, or other ones
        if own && (rows.kept.len() < rows.all || c.told.is_some()) {
            let fine = thinned(c);
            let of = |v: &[f64]| drawn(&fine.iter().map(|k| v[*k]).collect::<Vec<f64>>());
            fields.push(("fine", json::array([of(&c.x), of(&c.y)])));
        }
        json::object(&fields)
    };
    let markers = spec.markers.iter().filter(|m| m.at.is_finite());
    let markers = markers.take(200).map(|m| {
        json::object(&[
            ("at", json::number(m.at, 12)),
            ("label", json::string(&m.label)),
            ("kind", json::string(marker(m.kind))),
        ])
    });
    let hodograph = spec.hodograph.as_ref().map_or("null".into(), |h| {
        json::object(&[
            ("drive", column(motion, rows, &h.drive)),
            ("unit", json::string(&h.unit)),
        ])
    });
    json::object(&[
        ("title", json::string(&spec.title)),
        ("x", axis(&spec.x)),
        ("y", axis(&spec.y)),
        (
            "curves",
            json::array(spec.curves.iter().enumerate().map(curve)),
        ),
        ("markers", json::array(markers)),
        ("limits", json::array(spec.limits.iter().map(limit))),
        ("plane", spec.is_plane().to_string()),
        ("hodograph", hodograph),
    ])
}

fn axis(axis: &Axis) -> String {
    let limits = axis.limits.map_or("null".into(), |ends| {
        json::array(ends.map(|v| json::number(v, DIGITS)))
    });
    json::object(&[
        ("label", json::string(&axis.label)),
        ("unit", json::string(&axis.unit)),
        ("log", axis.log.to_string()),
        ("limits", limits),
    ])
}

fn limit(limit: &Limit) -> String {
    let (x, y) = match &limit.line {
        LimitLine::At(value) => ("null".into(), json::number(*value, DIGITS)),
        LimitLine::Along { x, y } => {
            let places: Vec<usize> = thinned(&Curve {
                x: x.clone(),
                y: y.clone(),
                ..Curve::default()
            });
            let of = |v: &[f64]| drawn(&places.iter().map(|k| v[*k]).collect::<Vec<f64>>());
            (of(x), of(y))
        }
    };
    let beyond = match limit.beyond {
        Some(Beyond::Above) => "1",
        Some(Beyond::Below) => "-1",
        None => "0",
    };
    json::object(&[
        ("label", json::string(&limit.label)),
        ("x", x),
        ("y", y),
        ("beyond", beyond.into()),
    ])
}

/// Values with one a row: those that the page has already are named by their column, not repeated.
fn column(motion: &MotionReport, rows: &Rows, values: &[f64]) -> String {
    let Some(values) = values.get(..rows.all).filter(|v| !v.is_empty()) else {
        return drawn(values);
    };
    let same = |other: &Column| {
        let other = other.values.iter().zip(values);
        other.len() == values.len() && { other }.all(|(a, b)| a.to_bits() == b.to_bits())
    };
    match columns::all(motion).position(same) {
        Some(index) => index.to_string(),
        None => columns::values(rows, values),
    }
}

fn drawn(values: &[f64]) -> String {
    json::array(values.iter().map(|v| json::number(*v, DIGITS)))
}

/// The kind of a mark as the page calls it.
pub(super) fn marker(kind: MarkerKind) -> &'static str {
    match kind {
        MarkerKind::DeadPoint => "dead",
        MarkerKind::ChangePoint => "change",
        MarkerKind::Limit => "limit",
        MarkerKind::Event => "event",
    }
}
