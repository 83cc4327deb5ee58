//! Whether clearances are small beside the links they are at.

use kempe_number::math;
use kempe_units::Dimension;

use crate::clearance::{Clearance, ClearanceAt};
use crate::diagnostic::Diagnostic;
use crate::geometry::value;
use crate::ids::{JointId, LinkId, PointId};
use crate::joint::JointKind;
use crate::model::Model;

/// A length that a clearance has to be small beside.
struct Beside {
    /// m.
    length: f64,
    /// Between which points of which link it is.
    link: LinkId,
    ends: [PointId; 2],
}

impl Model {
    /// Clearances (SI, with these parameter values) that are not small beside the links they are at.
    pub(crate) fn clearances_too_large(&self, parameters: &[f64]) -> Vec<Diagnostic> {
        let all = self.clearances.iter().filter_map(|clearance| {
            let radial = value(&clearance.radial, parameters);
            let beside = self.beside(&clearance.at, parameters).into_iter();
            beside
                .filter(|(_, beside)| radial >= beside.length)
                .map(|(at, beside)| self.too_large(clearance, radial, &at, &beside))
                .next()
        });
        all.collect()
    }

    fn too_large(
        &self,
        clearance: &Clearance,
        radial: f64,
        at: &str,
        beside: &Beside,
    ) -> Diagnostic {
        let [a, b] = beside
            .ends
            .map(|point| self.points[point.index()].name.as_str());
        let link = self.links[beside.link.index()].name.as_str();
        let [radial, length] = [radial, beside.length].map(|x| self.shown(x, Dimension::LENGTH));
        Diagnostic::error(
            "clearance-too-large",
            format!("the clearance at {at}, {radial}, is no smaller than the distance {a}-{b} on link `{link}`, {length}"),
        )
        .at(clearance.span.clone(), "")
        .help("a clearance is a small part of its links: say it with its unit, radial = \"10 um\"")
    }

    /// What the joints of an entry are called, each with the length that its clearance has to be small beside.
    fn beside(&self, at: &ClearanceAt, parameters: &[f64]) -> Vec<(String, Beside)> {
        let of_pin = |point: PointId| {
            let name = self.points.get(point.index())?.name.clone();
            let beside = self
                .next_pin(point, parameters)
                .filter(|_| self.is_pin(point))?;
            Some((name, beside))
        };
        let of_joint = |id: JointId| {
            let joint = self.joints.get(id.index())?;
            let (pin, line) = match &joint.kind {
                JointKind::Slider { at: pin, on, .. } | JointKind::Slot { pin, on } => {
                    (pin.point, (on.link, [on.from, on.to]))
                }
                JointKind::ArcSlot { pin, on } => (pin.point, (on.link, [on.from, on.to])),
                _ => return None,
            };
            // Where no other pin is near, the guide itself.
            let guide = || self.distance(line.0, line.1, parameters);
            let beside = self.next_pin(pin, parameters).or_else(guide)?;
            Some((format!("`{}`", joint.name), beside))
        };
        let has_own = |at: &ClearanceAt| self.clearances.iter().any(|c| same_place(&c.at, at));
        match at {
            ClearanceAt::Pin { point, .. } => of_pin(*point).into_iter().collect(),
            ClearanceAt::Joint(id) => of_joint(*id).into_iter().collect(),
            ClearanceAt::All => {
                let pins = (0..self.points.len() as u32).map(PointId);
                let pins = pins.filter(|point| {
                    let (point, on) = (*point, Vec::new());
                    !has_own(&ClearanceAt::Pin { point, on })
                });
                let joints = (0..self.joints.len() as u32).map(JointId);
                let joints = joints.filter(|id| !has_own(&ClearanceAt::Joint(*id)));
                (pins.filter_map(of_pin))
                    .chain(joints.filter_map(of_joint))
                    .collect()
            }
        }
    }

    fn is_pin(&self, point: PointId) -> bool {
        let point = self.points.get(point.index());
        point.is_some_and(|p| p.links.len() > 1)
    }

    /// The distance to the nearest other pin on a link of a point.
    fn next_pin(&self, pin: PointId, parameters: &[f64]) -> Option<Beside> {
        let links = self.points.get(pin.index())?.links.iter();
        let others = links.flat_map(|id| {
            let points = self.links.get(id.index()).map(|link| &link.points);
            let others = points.into_iter().flatten().map(|p| p.point);
            let pins = others.filter(|other| *other != pin && self.is_pin(*other));
            pins.filter_map(|other| self.distance(*id, [pin, other], parameters))
        });
        // The first of the nearest.
        others.reduce(|least, other| {
            if other.length < least.length {
                other
            } else {
                least
            }
        })
    }

    /// The distance of two points on a link; `None` where there is none.
    fn distance(&self, id: LinkId, ends: [PointId; 2], parameters: &[f64]) -> Option<Beside> {
        let link = self.links.get(id.index())?;
        let places: Vec<[f64; 2]> = link.evaluate(parameters);
        let place = |point: PointId| {
            let index = link.points.iter().position(|p| p.point == point)?;
            places.get(index)
        };
        let (a, b) = (place(ends[0])?, place(ends[1])?);
        let length = math::hypot(b[0] - a[0], b[1] - a[1]);
        (length > 0.0).then_some(Beside {
            length,
            link: id,
            ends,
        })
    }
}

/// Whether two entries tell of the same pin or joint.
fn same_place(a: &ClearanceAt, b: &ClearanceAt) -> bool {
    match (a, b) {
        (ClearanceAt::Pin { point: a, .. }, ClearanceAt::Pin { point: b, .. }) => a == b,
        (ClearanceAt::Joint(a), ClearanceAt::Joint(b)) => a == b,
        _ => false,
    }
}
