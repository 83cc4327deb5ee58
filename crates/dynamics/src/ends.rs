//! What springs and dampers act between: two points, or two links.

use kempe_mechanism::structure::Marker;
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_model::{Between, LinkId, Span};
use kempe_number::Number;

use crate::instant::Instant;
use crate::number::{ForceNumber, PlainNumber};
use crate::problem::Problem;
use crate::vector::{dot, length, sub, times};
use crate::wrench::{self, Wrench};

/// Two ends, found in the mechanism.
#[derive(Clone, Copy, Debug)]
pub enum Ends {
    /// Two points, with the links that carry them.
    Points([(LinkId, Marker); 2]),
    /// Two links and their bodies.
    Links([(LinkId, BodyId); 2]),
}

/// How far apart the ends are.
#[derive(Clone, Copy, Debug)]
pub struct Extension<T> {
    /// Distance (m), or angle of the second link against the first (rad).
    pub length: T,
    /// Its rate.
    pub rate: T,
    /// From the first point to the second, m; zero between links.
    pub span: [T; 2],
}

impl Ends {
    /// Finds the ends; `None` when a point is not on its link.
    pub fn new(mechanism: &Mechanism, between: &Between) -> Option<Self> {
        Some(match *between {
            Between::Points(a, b) => Self::Points([
                (a.link, mechanism.marker(a)?),
                (b.link, mechanism.marker(b)?),
            ]),
            Between::Links(a, b) => Self::Links([a, b].map(|link| (link, mechanism.body_of(link)))),
        })
    }

    /// Finds the ends of something with a name; tells (by the codes given) when one is on no link, or when they can never
    /// part.
    pub(crate) fn checked<T: ForceNumber>(
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        between: &Between,
        ([lost, idle], name, span): ([&'static str; 2], String, &Span),
        problems: &mut Vec<Problem>,
    ) -> Option<Self> {
        let Some(ends) = Self::new(mechanism, between) else {
            let message = format!("an end of {name} is on no link");
            problems.push(Problem::new(lost, span, message));
            return None;
        };
        if ends.is_idle(geometry) {
            let message =
                format!("{name} is between a point and itself, or between links that are one body");
            problems.push(Problem::new(idle, span, message));
        }
        Some(ends)
    }

    /// How far apart the ends are at an instant.
    pub fn stretch<T: Number>(&self, geometry: &Geometry<T>, at: &Instant<T>) -> Extension<T> {
        match self {
            Self::Points([(_, a), (_, b)]) => {
                let arm = |m: &Marker| at.arm(m.body, geometry.marker(*m));
                let (arm_a, arm_b) = (arm(a), arm(b));
                let span = sub(at.place(b.body, arm_b), at.place(a.body, arm_a));
                let parting = sub(at.velocity(b.body, arm_b), at.velocity(a.body, arm_a));
                let distance = length(span);
                let rate = (-distance).choose_with(T::zero, || dot(span, parting) / distance);
                Extension {
                    length: distance,
                    rate,
                    span,
                }
            }
            Self::Links([(link_a, a), (link_b, b)]) => {
                let angle = |link: &LinkId, body: &BodyId| {
                    at.angle(*body) + geometry.seat_angles[link.index()]
                };
                Extension {
                    length: angle(link_b, b) - angle(link_a, a),
                    rate: at.velocities[b.index()][2] - at.velocities[a.index()][2],
                    span: [T::zero(); 2],
                }
            }
        }
    }

    /// Adds a tension to the links at both ends: a pull of `pull` times the span vector, or a torque that resists growth
    /// of the angle.
    pub fn pull<T: Number>(
        &self,
        geometry: &Geometry<T>,
        at: &Instant<T>,
        stretch: &Extension<T>,
        pull: T,
        on_links: &mut [Wrench<T>],
    ) {
        match self {
            Self::Points([(link_a, a), (link_b, b)]) => {
                let force = times(stretch.span, pull);
                let arm = |m: &Marker| at.arm(m.body, geometry.marker(*m));
                wrench::add(
                    &mut on_links[link_a.index()],
                    wrench::of_force(force, arm(a)),
                );
                let back = force.map(|f| -f);
                wrench::add(
                    &mut on_links[link_b.index()],
                    wrench::of_force(back, arm(b)),
                );
            }
            Self::Links([(a, _), (b, _)]) => {
                on_links[a.index()][2] += pull;
                on_links[b.index()][2] -= pull;
            }
        }
    }

    /// Whether the ends can never part: the same point of the same body, or links of one body. In lanes: whether any can.
    pub fn is_idle<T: ForceNumber>(&self, geometry: &Geometry<T>) -> bool {
        match self {
            Self::Points([(_, a), (_, b)]) => {
                let apart = |lane: usize| {
                    let place = |m: &Marker| geometry.marker(*m).map(|x| x.value_in(lane));
                    length(sub(place(a), place(b)))
                };
                a.body == b.body && (0..T::Plain::LANES).any(|lane| apart(lane) == 0.0)
            }
            Self::Links([(_, a), (_, b)]) => a == b,
        }
    }
}
