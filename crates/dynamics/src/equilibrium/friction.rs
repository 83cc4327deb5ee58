//! Friction at the joints: where it acts and in which sense, and what it does to the bodies.

use kempe_mechanism::constraint::{Joint, Sliding};
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_model::DriveId;
use kempe_number::Number;

use super::Equilibrium;
use super::contact::{FrictionContact, load, resistance, slides_dry};
use super::pace::{STILL, UNMOVED};
use crate::friction::{Bearing, Friction, Sense};
use crate::instant::Instant;
use crate::number::{ForceNumber, PlainNumber};
use crate::vector::{cross, dot, sub};
use crate::wrench::Wrench;

/// A motion is at its end within this part of it.
const AT_END: f64 = 1e-12;

/// Teeth part where they do so at more than this part of the fastest speed: rounding stays far below.
const PARTING: f64 = 1e-9;

/// A joint that rubs, at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Rubbing<T: ForceNumber> {
    /// Its place among the friction that acts.
    pub friction: usize,
    /// How fast it slides, rad/s at a pin, m/s on a line.
    pub speed: T,
    /// The rate of that where it is none, rad/s^2 or m/s^2.
    pub gain: T,
    /// What dry friction resists with at most, N m or N.
    pub limit: T,
    /// What viscous friction resists with, N m or N.
    pub viscous: T,
    /// What a unit of resistance does: to the body that slides and to the other.
    unit: [(BodyId, Wrench<T>); 2],
}

impl<T: ForceNumber> Rubbing<T> {
    /// How fast it slides where one drive moves alone with unit speed.
    pub fn slope(&self, at: &Instant<T>, drive: DriveId) -> T {
        let moved = &at.coefficients[drive.index()];
        let power = |(body, unit): &(BodyId, Wrench<T>)| {
            let by = moved[body.index()];
            unit[0] * by[0] + unit[1] * by[1] + unit[2] * by[2]
        };
        -(power(&self.unit[0]) + power(&self.unit[1]))
    }
}

impl<T: ForceNumber> Equilibrium<T> {
    /// How fast what rubs dry slides, where nothing but its own speed tells the sense of its friction.
    pub(crate) fn sliding<'e>(
        &'e self,
        frictions: &'e [Friction<T>],
    ) -> impl Iterator<Item = T> + 'e {
        let slides = |contact: &&FrictionContact<T>| slides_dry(frictions, contact);
        self.contacts.iter().filter(slides).map(|it| it.speed)
    }

    pub(crate) fn find_contacts(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        frictions: &[Friction<T>],
        at: &Instant<T>,
    ) {
        self.contacts.clear();
        if frictions.is_empty() {
            return;
        }
        let size = T::Plain::of_lanes(|lane| self.lanes[lane].size);
        let fastest = self.fastest(at, size);
        for lane in &mut self.lanes {
            lane.fastest = fastest.lane_value(lane.index());
        }
        let still = [fastest * STILL, fastest * UNMOVED * self.pace.frequency];
        let still_sliding = still.map(|s| s * size);
        // What stands goes on as it gains speed; at the end it comes from there.
        let onwards = if self.is_at_end(at) { -1.0 } else { 1.0 };
        let situation = at.situation(geometry);
        for (index, friction) in frictions.iter().enumerate() {
            let row = self.layout.first_row[friction.constraint];
            let (zero, one) = (T::zero(), T::one());
            let contact = |speed, gain, direction: T::Plain, unit| FrictionContact {
                friction: index,
                row,
                speed,
                gain,
                direction: match friction.sense {
                    Sense::Amount(place) => at.amounts[place],
                    _ => zero.plus(0, direction),
                },
                resists: match friction.sense {
                    Sense::Resists(resistance) => Some(resistance),
                    _ => None,
                },
                unit,
            };
            let (v, w) = (&at.velocities, &at.accelerations);
            let constraint = &mechanism.constraints[friction.constraint].0;
            self.contacts.extend(match constraint.sliding(&situation) {
                Some(Sliding::Turning { a, b }) => {
                    let speed = v[b.index()][2] - v[a.index()][2];
                    let gain = w[b.index()][2] - w[a.index()][2];
                    let direction = speed.plain().direction(gain.plain() * onwards, still);
                    let unit = [(b, [zero, zero, -one]), (a, [zero, zero, one])];
                    Some(contact(speed, gain, direction, unit))
                }
                Some(Sliding::Along { point, on, tangent }) => {
                    let arm = at.arm(point.body, geometry.marker(point));
                    let guide = &at.poses[on.index()];
                    let arm_guide = sub(at.place(point.body, arm), [guide.x, guide.y]);
                    let parting = sub(at.velocity(point.body, arm), at.velocity(on, arm_guide));
                    let gain = sub(
                        at.acceleration(point.body, arm),
                        at.acceleration(on, arm_guide),
                    );
                    let speed = dot(tangent, parting);
                    let gain = dot(tangent, gain);
                    let own = [-tangent[0], -tangent[1], -cross(arm, tangent)];
                    let other = [tangent[0], tangent[1], cross(arm_guide, tangent)];
                    let direction = speed
                        .plain()
                        .direction(gain.plain() * onwards, still_sliding);
                    let unit = [(point.body, own), (on, other)];
                    Some(contact(speed, gain, direction, unit))
                }
                Some(Sliding::Rolling {
                    a,
                    b,
                    point,
                    off,
                    unit,
                }) => Some(match friction.bearing {
                    Bearing::Flanks(_) => {
                        let push = |body: BodyId, force: [T; 2]| {
                            let pose = &at.poses[body.index()];
                            let arm = sub(point, [pose.x, pose.y]);
                            (body, [force[0], force[1], cross(arm, force)])
                        };
                        let unit = [push(a, off), push(b, off.map(|x| -x))];
                        let speed = |body: BodyId| {
                            let pose = &at.poses[body.index()];
                            dot(off, at.velocity(body, sub(point, [pose.x, pose.y])))
                        };
                        contact(speed(a) - speed(b), zero, T::Plain::one(), unit)
                    }
                    bearing => {
                        let path = match bearing {
                            Bearing::Teeth(teeth) => teeth.path * unit,
                            _ => zero,
                        };
                        let turning = v[b.index()][2] - v[a.index()][2];
                        let gain = w[b.index()][2] - w[a.index()][2];
                        let direction = turning.plain().direction(gain.plain() * onwards, still);
                        let unit = [(b, [zero, zero, -path]), (a, [zero, zero, path])];
                        contact(turning * path, gain * path, direction, unit)
                    }
                }),
                None => None,
            });
        }
        let sliding = (self.contacts.iter_mut()).filter(|it| slides_dry(frictions, it));
        for (contact, sense) in sliding.zip(&self.senses) {
            if let Some(sense) = sense {
                contact.direction = T::from_f64(*sense);
            }
        }
    }

    /// Whether a motion ends here.
    fn is_at_end(&self, at: &Instant<T>) -> bool {
        at.time * self.pace.frequency >= 1.0 - AT_END
    }

    /// The fastest that any body moves now, or would move at the usual speeds of the drives, 1/s.
    fn fastest(&self, at: &Instant<T>, size: T::Plain) -> T::Plain {
        let in_sizes = |v: [T::Plain; 3]| v[2].larger(v[0] / size).larger(v[1] / size);
        let now = (at.velocities.iter()).map(|v| in_sizes(v.map(|x| x.plain().abs())));
        let usual = (at.coefficients.iter().zip(&self.pace.speeds))
            .flat_map(|(bodies, speed)| bodies.iter().map(move |c| (c, *speed)))
            .map(|(c, speed)| in_sizes(c.map(|x| (x.plain() * speed).abs())));
        now.chain(usual).fold(T::Plain::zero(), T::Plain::larger)
    }

    /// Hands out what friction does: constraint, body, wrench about the body's origin; the sliding body comes first.
    pub(crate) fn each_friction(
        &self,
        frictions: &[Friction<T>],
        mut take: impl FnMut(usize, BodyId, Wrench<T>),
    ) {
        for contact in &self.contacts {
            let resistance = resistance(frictions, contact, &self.lambda);
            for (body, unit) in &contact.unit {
                let constraint = frictions[contact.friction].constraint;
                take(constraint, *body, unit.map(|u| u * resistance));
            }
        }
    }

    /// Hands out what viscous friction alone does at an instant: body, wrench about the body's origin.
    pub(crate) fn each_viscous(
        &mut self,
        mechanism: &Mechanism,
        geometry: &Geometry<T>,
        frictions: &[Friction<T>],
        at: &Instant<T>,
        mut take: impl FnMut(BodyId, Wrench<T>),
    ) {
        self.find_contacts(mechanism, geometry, frictions, at);
        for contact in &self.contacts {
            let resistance = frictions[contact.friction].law.viscous * contact.speed;
            for (body, unit) in &contact.unit {
                take(*body, unit.map(|u| u * resistance));
            }
        }
    }

    /// How every joint that rubs slides at an instant, and what it resists with at most by the loads last found: those are to be
    /// found again where anything moved otherwise.
    pub fn rubbing<'a>(
        &'a self,
        frictions: &'a [Friction<T>],
    ) -> impl Iterator<Item = Rubbing<T>> + 'a {
        let rubbing = self
            .contacts
            .iter()
            .filter(|c| frictions[c.friction].rubs());
        rubbing.map(|contact| {
            let friction = &frictions[contact.friction];
            let load = load(friction, contact, &self.lambda);
            Rubbing {
                friction: contact.friction,
                speed: contact.speed,
                gain: contact.gain,
                limit: friction.per_load(contact.speed) * load + friction.law.drag,
                viscous: friction.law.viscous * contact.speed,
                unit: contact.unit,
            }
        })
    }

    /// Power that friction takes, W: never positive.
    pub fn friction_power(&self, frictions: &[Friction<T>]) -> T {
        let mut sum = T::zero();
        let rubbing = (self.contacts.iter()).filter(|c| frictions[c.friction].rubs());
        for contact in rubbing {
            sum -= resistance(frictions, contact, &self.lambda) * contact.speed;
        }
        sum
    }

    /// Constraints whose teeth part, or are pressed into each other, by the motion at hand: their force would do work. In
    /// lanes: in any of them.
    pub fn parting(&self, frictions: &[Friction<T>]) -> impl Iterator<Item = usize> {
        let flanks = (self.contacts.iter()).filter(|c| !frictions[c.friction].rubs());
        let moving = flanks.filter(|contact| {
            let still = |lane: usize| PARTING * self.lanes[lane].size * self.lanes[lane].fastest;
            (0..T::Plain::LANES).any(|lane| contact.speed.value_in(lane).abs() > still(lane))
        });
        moving.map(|contact| frictions[contact.friction].constraint)
    }

    /// Whether friction acts at a joint that does not move and is not about to: its size is not determined there. In lanes:
    /// in any of them.
    pub fn rests(&self, frictions: &[Friction<T>]) -> bool {
        self.contacts.iter().any(|contact| {
            let friction = &frictions[contact.friction];
            let law = &friction.law;
            let by_speed = matches!(friction.sense, Sense::BySpeed);
            let still = |lane: usize| {
                let dry = law.kinetic.value_in(lane) > 0.0 || law.drag.value_in(lane) > 0.0;
                contact.direction.value_in(lane) == 0.0 && dry
            };
            by_speed && (0..T::Plain::LANES).any(still)
        })
    }
}
