//! What a result tells.

use std::sync::Arc;

use kempe_mechanism::{Design, Mechanism};
use kempe_model::{LinkId, LinkPointRef, Model, PointId};
use kempe_study::StudyResult;

/// One of its numbers by its whole name, in the file's units.
#[track_caller]
pub fn scalar(result: &StudyResult, name: &str) -> f64 {
    let found = result.scalars.iter().find(|s| s.name == name);
    let names = || result.scalars.iter().map(|s| s.name.as_str());
    match found {
        Some(found) => found.value,
        None => panic!("no {name} among {:?}", names().collect::<Vec<_>>()),
    }
}

/// One of its columns, in the file's units.
#[track_caller]
pub fn column(result: &StudyResult, name: &str) -> Vec<f64> {
    let names = || result.table.columns.iter().map(|c| c.name.as_str());
    match result.table.column(name) {
        Some(found) => found.values.clone(),
        None => panic!("no {name} among {:?}", names().collect::<Vec<_>>()),
    }
}

/// The places of points of one link in its axes, with these parameters, m; none where no link has them all.
pub fn places_on_one_link(
    mechanism: &Arc<Mechanism>,
    parameters: &[f64],
    points: &[&str],
) -> Vec<[f64; 2]> {
    let design = Design::new(mechanism, parameters);
    let model = &mechanism.model;
    let on = |link: usize| {
        let place = |name: &&str| {
            let point = model.points.iter().position(|p| p.name == *name)?;
            let [link, point] = [link as u32, point as u32];
            let at = LinkPointRef {
                link: LinkId(link),
                point: PointId(point),
            };
            Some(design.geometry.marker(mechanism.marker(at)?))
        };
        points.iter().map(place).collect::<Option<Vec<_>>>()
    };
    (0..model.links.len()).find_map(on).unwrap_or_default()
}

/// What the file of a linkage names as its lengths is what its links are built by, whoever changes them.
#[track_caller]
pub fn assert_built_by_its_lengths(model: &Model, text: &str) {
    let mechanism = Mechanism::new(model);
    let mut told = 0;
    for (index, parameter) in model.parameters.iter().enumerate() {
        // A length of a link, or how far its guide passes to the left of a pivot.
        let points: &[&str] = match parameter.name.as_str() {
            "ground" => &["A", "D"],
            "crank_length" => &["A", "B"],
            "coupler_length" => &["B", "C"],
            "rocker_length" => &["D", "C"],
            "offset" if text.contains("E = ") => &["A", "E", "F"],
            "offset" => &["B", "G", "H"],
            _ => continue,
        };
        let mut values: Vec<f64> = model.parameter_values();
        values[index] = 1.01 * values[index] + 1e-4;
        let on_one_link = places_on_one_link(&mechanism, &values, points);
        let way = |[a, b]: [[f64; 2]; 2]| [b[0] - a[0], b[1] - a[1]];
        let length = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
        let built = match on_one_link[..] {
            [a, b] => length(way([a, b])),
            [pivot, e, f] => {
                let (along, to) = (way([e, f]), way([pivot, e]));
                (along[0] * to[1] - along[1] * to[0]) / length(along)
            }
            _ => panic!("no link with {points:?}\n{text}"),
        };
        let apart = (built - values[index]).abs();
        assert!(
            apart < 1e-12 * (1.0 + values[index].abs()),
            "{}: {} built as {built}\n{text}",
            parameter.name,
            values[index]
        );
        told += 1;
    }
    assert!(told >= 2, "{text}");
}
