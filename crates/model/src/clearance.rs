//! Play at joints, and the study of what it does.

use kempe_number::math;
use kempe_units::Dimension;

use crate::contact::ContactProperties;
use crate::diagnostic::Diagnostic;
use crate::geometry::value;
use crate::ids::{JointId, LinkId, PointId, Scalar, Span};
use crate::model::Model;
use crate::study::MotionStudy;

/// Play at a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    /// Where.
    pub at: ClearanceAt,
    /// How far the centres of a pin and its bore may part, or how far a slider may leave its line to either side, m.
    pub radial: Scalar,
    /// What is known of the bodies that touch there.
    pub contact: ContactProperties,
    /// Where it stands in the file.
    pub span: Span,
}

/// Where there is play.
#[derive(Clone, Debug, PartialEq)]
pub enum ClearanceAt {
    /// At a pin: where several links share it, between these and the first link of the point; all of them where none is named.
    Pin {
        /// The point.
        point: PointId,
        /// The links that have play on the pin.
        on: Vec<LinkId>,
    },
    /// Across the line of a slider or slot.
    Joint(JointId),
    /// At every pin, slider and slot that has none of its own.
    All,
}

/// What play at the joints does to the motion where contact is never lost.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearanceStudy {
    /// Rows, columns and plots.
    pub along: MotionStudy,
    /// How the links in the clearances turn.
    pub rates: ClearanceRates,
}

/// What is assumed of the contact in joints with play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceModel {
    /// It is never lost: each clearance is a massless link along the reaction of its joint.
    Continuous,
    /// It comes and goes; a spring and a damper press where it is.
    TwoState,
    /// It comes and goes by impacts, and may stay.
    ThreeState,
}

/// How the massless links in the clearances turn, as far as speeds and accelerations go by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearanceRates {
    /// Not at all.
    Frozen,
    /// Evenly, as fast as the reaction turns.
    Turning,
}

impl Model {
    /// Clearances (SI, with these parameter values) that are not small beside the links they are at.
    pub(crate) fn clearances_too_large(&self, parameters: &[f64]) -> Vec<Diagnostic> {
        let own = |point: PointId| {
            (self.clearances.iter())
                .any(|c| matches!(c.at, ClearanceAt::Pin { point: own, .. } if own == point))
        };
        let pins = |clearance: &Clearance| match clearance.at {
            ClearanceAt::Pin { point, .. } => vec![point],
            ClearanceAt::Joint(_) => Vec::new(),
            ClearanceAt::All => (0..self.points.len() as u32)
                .map(PointId)
                .filter(|point| !own(*point))
                .collect(),
        };
        let all = self.clearances.iter().filter_map(|clearance| {
            let radial = value(&clearance.radial, parameters);
            let pins = pins(clearance).into_iter();
            pins.filter_map(|pin| self.next_pin(pin, parameters))
                .find(|(length, ..)| radial >= *length)
                .map(|(length, link, ends)| {
                    let [a, b] = ends.map(|point| self.points[point.index()].name.as_str());
                    let link = self.links[link.index()].name.as_str();
                    let [radial, length] =
                        [radial, length].map(|x| self.shown(x, Dimension::LENGTH));
                    Diagnostic::error(
                        "clearance-too-large",
                        format!("the clearance at {a}, {radial}, is no smaller than the distance {a}-{b} on link `{link}`, {length}"),
                    )
                    .at(clearance.span.clone(), "")
                    .help("a clearance is a small part of its links: say it with its unit, radial = \"10 um\"")
                })
        });
        all.collect()
    }

    /// The distance to the nearest other pin on a link of a pin, m, with that link and both pins.
    fn next_pin(&self, pin: PointId, parameters: &[f64]) -> Option<(f64, LinkId, [PointId; 2])> {
        let is_pin = |point: PointId| {
            let point = self.points.get(point.index());
            point.is_some_and(|p| p.links.len() > 1)
        };
        if !is_pin(pin) {
            return None;
        }
        let mut nearest: Option<(f64, LinkId, [PointId; 2])> = None;
        for id in &self.points.get(pin.index())?.links {
            let link = self.links.get(id.index())?;
            let places: Vec<[f64; 2]> = link.evaluate(parameters);
            let place = |point: PointId| {
                let index = link.points.iter().position(|p| p.point == point)?;
                places.get(index)
            };
            let Some(own) = place(pin) else { continue };
            for other in link.points.iter().map(|p| p.point) {
                let Some(at) = place(other).filter(|_| other != pin && is_pin(other)) else {
                    continue;
                };
                let length = math::hypot(at[0] - own[0], at[1] - own[1]);
                if length > 0.0 && nearest.is_none_or(|(least, ..)| length < least) {
                    nearest = Some((length, *id, [pin, other]));
                }
            }
        }
        nearest
    }
}
