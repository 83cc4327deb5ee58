//! Points that only one link carries, where a link hangs loose: likely a pin whose name is misspelt once.

use kempe_mechanism::Mechanism;
use kempe_mechanism::structure::BodyId;
use kempe_model::{Diagnostic, LinkPoint, Model, PointId, Span};
use kempe_units::nearest;

use crate::words::list;

/// A point of a link that no other link carries, and no joint.
struct Lone<'m> {
    name: &'m str,
    link: &'m str,
    span: Span,
    /// The point that is likely meant.
    near: Option<&'m str>,
}

fn lone<'m>(model: &'m Model, mechanism: &'m Mechanism, bodies: &[BodyId]) -> Vec<Lone<'m>> {
    let links = model.links.iter().zip(&mechanism.seats);
    let loose = links.filter(|(_, seat)| bodies.contains(&seat.body));
    let joined: Vec<PointId> = (model.joints.iter())
        .flat_map(|joint| joint.kind.points())
        .collect();
    let of_link = |link: &'m kempe_model::Link| {
        let is_lone = |point: &&LinkPoint| {
            let known = model.points.get(point.point.index());
            known.is_some_and(|p| p.links.len() == 1) && !joined.contains(&point.point)
        };
        link.points.iter().filter(is_lone).map(move |point| {
            let name = model.points[point.point.index()].name.as_str();
            let elsewhere = model.points.iter().filter(|other| {
                let on = |place: &LinkPoint| model.points[place.point.index()].name == other.name;
                !link.points.iter().any(on)
            });
            Lone {
                name,
                link: &link.name,
                span: point.span.clone(),
                near: nearest(name, elsewhere.map(|p| p.name.as_str())),
            }
        })
    };
    loose.flat_map(|(link, _)| of_link(link)).collect()
}

/// Adds to a diagnostic on links that nothing determines what may be a misspelt pin of theirs; its place comes first. `otherwise` is the
/// help where no name is near another.
pub(crate) fn with_lone_points(
    mut diagnostic: Diagnostic,
    model: &Model,
    mechanism: &Mechanism,
    bodies: &[BodyId],
    otherwise: &str,
) -> Diagnostic {
    let lone = lone(model, mechanism, bodies);
    if let Some((point, near)) = lone.iter().find_map(|p| Some((p, p.near?))) {
        let message = format!("{}: {} is on no other link", diagnostic.message, point.name);
        let labels = std::mem::take(&mut diagnostic.labels);
        diagnostic = diagnostic
            .at(point.span.clone(), format!("did you mean {near}?"))
            .help(format!(
                "did you mean {near}? A point that two links name is a pin between them"
            ));
        diagnostic.message = message;
        return labels
            .into_iter()
            .fold(diagnostic, |d, label| d.see(label.span, label.text));
    }
    let mut by_link: Vec<(&str, Vec<String>)> = Vec::new();
    for point in &lone {
        match by_link.iter_mut().find(|(link, _)| *link == point.link) {
            Some((_, names)) => names.push(point.name.to_owned()),
            None => by_link.push((point.link, vec![point.name.to_owned()])),
        }
    }
    if !by_link.is_empty() {
        let each = by_link
            .iter()
            .map(|(link, names)| format!("{} on `{link}`", list(names)));
        let each: Vec<String> = each.collect();
        diagnostic = diagnostic.note(format!("on one link only: {}", each.join("; ")));
    }
    let help = match by_link.len() {
        0 | 1 => otherwise.to_owned(),
        _ => {
            format!("{otherwise}; if two of these points are one pin, name it alike on both links")
        }
    };
    diagnostic.help(help)
}
