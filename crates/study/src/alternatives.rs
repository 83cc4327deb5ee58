//! How to say which of several assemblies is meant, in the words of the file.

use kempe_mechanism::Design;
use kempe_mechanism::plan::Step;
use kempe_mechanism::structure::Marker;
use kempe_model::PointId;
use kempe_motion::assemble::Assembly;
use kempe_number::math::{hypot, log10};
use kempe_units::Dimension;

use crate::unit::{Units, rounded, shown};

/// Alternatives that are written out; of more the first are.
const SHOWN: usize = 6;
/// A point tells assemblies apart when its places are at least this part of the mechanism's size from each other.
const APART: f64 = 1e-2;
/// Places are written to this part of the mechanism's size.
const ROUND: f64 = 1e-3;

/// For each assembly, in their order, what to write under `[assembly]` to choose it: sides where these tell all of them
/// apart, else a place of the point that differs most. Nothing where no single point tells them apart.
pub(crate) fn hints(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<String> {
    let shown = &assemblies[..assemblies.len().min(SHOWN)];
    let sides = sides(design, shown);
    let unique = |lines: &[String]| (1..lines.len()).all(|k| !lines[..k].contains(&lines[k]));
    if unique(&sides) && sides.iter().all(|line| !line.is_empty()) {
        return sides;
    }
    places(design, shown)
}

fn place(design: &Design<f64>, assembly: &Assembly, marker: Marker) -> Option<[f64; 2]> {
    let pose = assembly.poses.get(marker.body.index())?;
    Some(pose.place(design.geometry.marker(marker)))
}

/// The sides of all dyads whose sides differ.
fn sides(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<String> {
    let mechanism = &*design.mechanism;
    let plan = &mechanism.plan;
    let name = |m: Marker| {
        let at = mechanism.markers.get(m.index as usize)?;
        Some(mechanism.model.points.get(at.point.index())?.name.as_str())
    };
    let mut lines = vec![String::new(); assemblies.len()];
    for step in &plan.steps {
        let Step::Dyad(dyad) = step else {
            continue;
        };
        let (at_a, inner_a, at_b) = (dyad.a.at, dyad.a.inner, dyad.b.at);
        let left: Option<Vec<bool>> = assemblies
            .iter()
            .map(|assembly| {
                let [from, to, p] = [at_a, at_b, inner_a].map(|m| place(design, assembly, m));
                let (from, to, p) = (from?, to?, p?);
                let (along, off) = (
                    [to[0] - from[0], to[1] - from[1]],
                    [p[0] - from[0], p[1] - from[1]],
                );
                Some(along[0] * off[1] - along[1] * off[0] > 0.0)
            })
            .collect();
        let (Some(left), Some(point), Some(from), Some(to)) =
            (left, name(inner_a), name(at_a), name(at_b))
        else {
            continue;
        };
        if left.iter().all(|l| *l == left[0]) {
            continue;
        }
        for (line, left) in lines.iter_mut().zip(left) {
            let side = if left { "left" } else { "right" };
            let and = if line.is_empty() { "" } else { " and " };
            line.push_str(&format!("{and}{point} = \"{side} of {from} -> {to}\""));
        }
    }
    lines
}

/// The place of the point whose places differ most.
fn places(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<String> {
    let mechanism = &*design.mechanism;
    let model = &mechanism.model;
    let size = design.size();
    let candidates = (0..model.points.len()).filter_map(|index| {
        let marker = mechanism.any_marker(PointId(index as u32))?;
        let places: Option<Vec<[f64; 2]>> = assemblies
            .iter()
            .map(|a| place(design, a, marker))
            .collect();
        let places = places?;
        let mut nearest = f64::INFINITY;
        for (k, p) in places.iter().enumerate() {
            for q in &places[..k] {
                nearest = nearest.min(hypot(p[0] - q[0], p[1] - q[1]));
            }
        }
        (nearest >= APART * size).then_some((nearest, index, places))
    });
    let best = candidates.reduce(|best, next| if next.0 > best.0 { next } else { best });
    let Some((_, index, places)) = best else {
        return Vec::new();
    };
    let unit = Units::of(model).unit(Dimension::LENGTH);
    let step = kempe_number::powi(10.0, log10(ROUND * unit.from_si(size)).floor() as i32);
    let written = |si: f64| rounded((shown(si, &unit) / step).round() * step);
    let name = &model.points[index].name;
    (places.iter())
        .map(|p| {
            format!(
                "{name} = {{ near = [{}, {}] }}",
                written(p[0]),
                written(p[1])
            )
        })
        .collect()
}
