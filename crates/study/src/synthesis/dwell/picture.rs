//! The point's way with the stretches that come near to a circle or a line.

use std::f64::consts::TAU;

use kempe_synthesis::{C, Stretch};
use kempe_units::Dimension;

use super::asked::{Asked, Near};
use crate::result::{Figure, PlaneCurve};

/// Pieces of a circle as it is drawn.
const PIECES: usize = 180;
/// Half of the cross at a centre, as a part of the way's size.
const CROSS: f64 = 0.02;

pub(super) fn picture(asked: &Asked<'_>, stretches: &[&Stretch<Near>]) -> Figure {
    let unit = asked.units.unit(Dimension::LENGTH);
    let drawn = |name: &str, dashed: bool, lines: Vec<Vec<C>>| {
        let lines = lines.iter().map(|line| line.iter().map(|p| [p.re, p.im]));
        PlaneCurve::lines(name, dashed, lines, &unit)
    };
    let point = &asked.model.points[asked.task.point.index()].name;
    let (low, high) = (asked.range[0], asked.range[1]);
    let steps = asked.way.len().saturating_sub(1).max(1);
    let on_stretch = |stretch: &Stretch<Near>| {
        let index = |at: f64| ((at - low) / (high - low) * steps as f64).round() as usize;
        let (from, to) = (index(stretch.from), index(stretch.from + asked.dwell));
        // Of a cycle the last place is the first.
        (from..=to)
            .filter_map(|k| {
                asked
                    .way
                    .get(if k > steps { k - steps } else { k })
                    .copied()
            })
            .collect::<Vec<C>>()
    };
    let size = asked
        .way
        .iter()
        .fold(0.0_f64, |m, p| m.max((*p - asked.way[0]).norm()));
    let near: Vec<Vec<C>> = (stretches.iter())
        .map(|stretch| match stretch.near {
            // Of a large circle only what lies beside the way.
            Near::Circle { centre, radius } => {
                let middle = on_stretch(stretch);
                let towards = middle
                    .get(middle.len() / 2)
                    .map_or(0.0, |p| (*p - centre).arg());
                let half = (size / radius).min(0.5 * TAU);
                let at = |k: usize| towards - half + 2.0 * half * (k as f64 / PIECES as f64);
                (0..=PIECES)
                    .map(|k| centre + C::from_polar(radius, at(k)))
                    .collect()
            }
            Near::Line { point, direction } => {
                let middle = on_stretch(stretch);
                let about = middle
                    .get(middle.len() / 2)
                    .map_or(0.0, |p| ((*p - point) * direction.conj()).re);
                [-size, size]
                    .map(|by| point + direction.scale(about + by))
                    .to_vec()
            }
        })
        .collect();
    let crosses = stretches.iter().flat_map(|stretch| match stretch.near {
        Near::Circle { centre, .. } => {
            let arms = [C::new(CROSS * size, 0.0), C::new(0.0, CROSS * size)];
            arms.map(|arm| vec![centre - arm, centre + arm]).to_vec()
        }
        Near::Line { .. } => Vec::new(),
    });
    let crosses: Vec<Vec<C>> = crosses.collect();
    let mut curves = vec![
        drawn(&format!("way of {point}"), false, vec![asked.way.clone()]),
        drawn(
            "stretches of rest",
            false,
            stretches.iter().map(|it| on_stretch(it)).collect(),
        ),
        drawn("nearest to them", true, near),
    ];
    if !crosses.is_empty() {
        curves.push(drawn("centres", false, crosses));
    }
    Figure::Plane {
        name: "way".to_owned(),
        unit,
        curves,
    }
}
