//! What follows from a drawing, in words: the distances of the points of every link that is drawn.

use std::collections::BTreeMap;

use kempe_mechanism::Design;
use kempe_model::{Link, Model, PointId, value};
use kempe_number::math::hypot;
use kempe_units::Dimension;
use serde::Serialize;

use crate::unit::Units;

/// A given distance differs from the drawn one when it does so by more than this part of it: digits that were left out.
const ROUNDED: f64 = 1e-9;
/// Of a link with more points than this only the way from each point to the next, and back to the first, is told.
const ALL_PAIRS: usize = 4;

/// A link that is drawn, by the distances of its points.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct DrawnLink {
    /// Name of the link.
    pub link: String,
    /// Distances such as `A-B 20 mm`, and `A-B 20 mm (drawn 20.2 mm)` where the file gives another than is drawn.
    pub lengths: Vec<String>,
    /// The same, m.
    pub lengths_si: Vec<f64>,
}

/// The links that are drawn. Of a link whose points the file places otherwise, the distances that are not as drawn.
pub(crate) fn links(design: &Design<f64>, units: &Units) -> Vec<DrawnLink> {
    let model = &design.mechanism.model;
    let parameters = &design.parameters;
    let places: BTreeMap<PointId, [f64; 2]> = (model.drawing.places.iter())
        .map(|(point, place)| {
            let [x, y] = &place.at;
            (*point, [value(x, parameters), value(y, parameters)])
        })
        .collect();
    let mut found = Vec::new();
    if places.is_empty() {
        return found;
    }
    for (i, link) in model.links.iter().enumerate() {
        let listed = model.drawing.links.iter().any(|id| id.index() == i);
        let lengths = lengths(model, link, listed, &places, parameters, units);
        if lengths.is_empty() {
            continue;
        }
        let (lengths, lengths_si) = lengths.into_iter().unzip();
        let link = link.name.clone();
        found.push(DrawnLink {
            link,
            lengths,
            lengths_si,
        });
    }
    found
}

fn lengths(
    model: &Model,
    link: &Link,
    listed: bool,
    places: &BTreeMap<PointId, [f64; 2]>,
    parameters: &[f64],
    units: &Units,
) -> Vec<(String, f64)> {
    let own: Vec<[f64; 2]> = link.evaluate(parameters);
    let drawn = link.points.iter().zip(own);
    let drawn: Vec<_> = drawn
        .filter_map(|(p, own)| Some((p.point, own, *places.get(&p.point)?)))
        .collect();
    let apart = |a: [f64; 2], b: [f64; 2]| hypot(b[0] - a[0], b[1] - a[1]);
    let name = |point: PointId| {
        model
            .points
            .get(point.index())
            .map_or("?", |p| p.name.as_str())
    };
    let mut lengths = Vec::new();
    for (i, j) in pairs(drawn.len()) {
        let (Some(&(a, a_own, a_at)), Some(&(b, b_own, b_at))) = (drawn.get(i), drawn.get(j))
        else {
            continue;
        };
        let (is, was) = (apart(a_own, b_own), apart(a_at, b_at));
        let as_drawn = (is - was).abs() <= ROUNDED * was;
        if as_drawn && !listed {
            continue;
        }
        let names = [a, b].map(name).join("-");
        let text = match as_drawn {
            true => units.text(is, Dimension::LENGTH),
            false => {
                let [is, was] = units.texts([is, was], Dimension::LENGTH);
                format!("{is} (drawn {was})")
            }
        };
        lengths.push((format!("{names} {text}"), is));
    }
    lengths
}

/// Which points' distances are told.
fn pairs(count: usize) -> Vec<(usize, usize)> {
    match count {
        0 | 1 => Vec::new(),
        _ if count <= ALL_PAIRS => (0..count)
            .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
            .collect(),
        _ => (0..count)
            .map(|i| (i.min((i + 1) % count), i.max((i + 1) % count)))
            .collect(),
    }
}

/// The hints of a file that its drawing gives, by their place in the model.
pub(crate) fn gives_hint(model: &Model, index: usize) -> bool {
    index + model.drawing.hints >= model.assembly.len()
}
