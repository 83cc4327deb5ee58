//! How to say which of several assemblies is meant, in the words of the file.

use kempe_mechanism::Design;
use kempe_mechanism::plan::Step;
use kempe_mechanism::structure::{BodyId, Marker};
use kempe_model::{HintKind, LinkId, Model, PointId};
use kempe_motion::assemble::Assembly;
use kempe_number::math::{hypot, log10};
use kempe_units::Dimension;

use crate::unit::{Units, rounded, shown};

/// Alternatives that are written out; of more the first are.
const SHOWN: usize = 6;
/// A point tells assemblies apart when its places are at least this part of the mechanism's size from each other.
const APART: f64 = 1e-2;
/// A link's angle tells assemblies apart when it differs by this, rad, at least: more than the rounding of what is written.
const APART_ANGLE: f64 = 0.1;
/// Places are written to this part of the mechanism's size.
const ROUND: f64 = 1e-3;

/// For each assembly, in their order, what to write under `[assembly]` to choose it: sides where these tell all of them
/// apart, else places of as few points as do, and angles of links where no points do. Of what the file has a hint of already
/// nothing is said again. Nothing where not all can be told apart.
pub(crate) fn hints(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<String> {
    let shown = &assemblies[..assemblies.len().min(SHOWN)];
    let sides = sides(design, shown);
    let unique = |lines: &[String]| (1..lines.len()).all(|k| !lines[..k].contains(&lines[k]));
    if unique(&sides) && sides.iter().all(|line| !line.is_empty()) {
        return sides;
    }
    let mut near = places(design, shown);
    near.extend(angles(design, shown));
    let Some(chosen) = telling_apart(&near, shown.len()) else {
        return Vec::new();
    };
    let line = |k: usize| {
        let parts: Vec<&str> = chosen.iter().map(|near| near.lines[k].as_str()).collect();
        parts.join(" and ")
    };
    (0..shown.len()).map(line).collect()
}

/// What a hint near something would say of each assembly.
struct NearLines {
    /// How far apart two assemblies have it, in parts of what tells them apart; by pairs, in [`pairs`]' order.
    apart: Vec<f64>,
    /// What to write for each.
    lines: Vec<String>,
}

/// All pairs of so many.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(|k| (0..k).map(move |j| (j, k)))
}

/// As few of the hints as tell all assemblies apart: that which parts most pairs first, and parts them farthest.
fn telling_apart(near: &[NearLines], count: usize) -> Option<Vec<&NearLines>> {
    let mut open: Vec<usize> = (0..pairs(count).count()).collect();
    let mut chosen = Vec::new();
    while !open.is_empty() {
        let gain = |hint: &NearLines| {
            let parted = open.iter().map(|pair| hint.apart[*pair]);
            let parted: Vec<f64> = parted.filter(|apart| *apart >= 1.0).collect();
            (
                parted.len(),
                parted.into_iter().fold(f64::INFINITY, f64::min),
            )
        };
        let best = near.iter().map(|hint| (gain(hint), hint)).reduce(|a, b| {
            let better = b.0.0 > a.0.0 || b.0.0 == a.0.0 && b.0.1 > a.0.1;
            if better { b } else { a }
        });
        let (_, hint) = best.filter(|((parted, _), _)| *parted > 0)?;
        open.retain(|pair| hint.apart[*pair] < 1.0);
        chosen.push(hint);
    }
    Some(chosen)
}

/// Whether the file has a hint of a point already.
fn hinted(model: &Model, wanted: PointId) -> bool {
    (model.assembly.iter()).any(|hint| match hint.kind {
        HintKind::Side { point, .. } | HintKind::NearPlace { point, .. } => point == wanted,
        HintKind::NearAngle { .. } => false,
    })
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
        let own = mechanism.markers[inner_a.index as usize].point;
        if left.iter().all(|l| *l == left[0]) || hinted(&mechanism.model, own) {
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

/// The places of every point that the file has no hint of.
fn places(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<NearLines> {
    let mechanism = &*design.mechanism;
    let model = &mechanism.model;
    let size = design.size();
    let unit = Units::of(model).unit(Dimension::LENGTH);
    let step = kempe_number::powi(10.0, log10(ROUND * unit.from_si(size)).floor() as i32);
    let written = |si: f64| rounded((shown(si, &unit) / step).round() * step);
    let of_point = |index: usize| {
        let point = PointId(index as u32);
        if hinted(model, point) {
            return None;
        }
        let marker = mechanism.any_marker(point)?;
        let places: Option<Vec<[f64; 2]>> = assemblies
            .iter()
            .map(|a| place(design, a, marker))
            .collect();
        let places = places?;
        let apart = |(j, k): (usize, usize)| {
            let (p, q) = (places[j], places[k]);
            hypot(p[0] - q[0], p[1] - q[1]) / (APART * size)
        };
        let name = &model.points[index].name;
        let line = |p: &[f64; 2]| {
            let [x, y] = p.map(written);
            format!("{name} = {{ near = [{x}, {y}] }}")
        };
        Some(NearLines {
            apart: pairs(places.len()).map(apart).collect(),
            lines: places.iter().map(line).collect(),
        })
    };
    (0..model.points.len()).filter_map(of_point).collect()
}

/// The angles of every link that the file has no hint of.
fn angles(design: &Design<f64>, assemblies: &[Assembly]) -> Vec<NearLines> {
    let mechanism = &*design.mechanism;
    let model = &mechanism.model;
    let hinted = |wanted: LinkId| {
        (model.assembly.iter())
            .any(|hint| matches!(hint.kind, HintKind::NearAngle { link, .. } if link == wanted))
    };
    let of_link = |index: usize| {
        let link = LinkId(index as u32);
        let body = mechanism.body_of(link);
        if body == BodyId::GROUND || hinted(link) {
            return None;
        }
        let seat = design.geometry.seat_angles[index];
        let angles: Vec<f64> = (assemblies.iter())
            .map(|a| a.poses[body.index()].angle_near(-seat) + seat)
            .collect();
        let apart = |(j, k): (usize, usize)| {
            let (s, c) = kempe_number::math::sin_cos(angles[j] - angles[k]);
            kempe_number::math::atan2(s, c).abs() / APART_ANGLE
        };
        let name = &model.links[index].name;
        let line = |angle: &f64| {
            // A round zero has no sign.
            let degrees = angle.to_degrees().round() + 0.0;
            format!("{name} = {{ near = \"{degrees} deg\" }}")
        };
        Some(NearLines {
            apart: pairs(angles.len()).map(apart).collect(),
            lines: angles.iter().map(line).collect(),
        })
    };
    (0..model.links.len()).filter_map(of_link).collect()
}
