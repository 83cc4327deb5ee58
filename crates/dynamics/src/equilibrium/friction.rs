//! Friction at the joints: it follows from the loads that it changes, so both are found together.

use kempe_mechanism::constraint::{Joint, Situation, Sliding};
use kempe_mechanism::{BodyId, Geometry, Mechanism};
use kempe_number::Number;

use super::{Equilibrium, SINGULAR};
use crate::friction::{Friction, direction};
use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::vector::{cross, dot, length, sub};
use crate::wrench::Wrench;

/// Speeds below this part of the fastest count as rest where friction is concerned.
pub const STILL: f64 = 1e-12;
/// Accelerations below this part of those that the fastest speed would have over the whole motion count as none.
pub const UNMOVED: f64 = 1e-9;
/// Newton steps of the friction loop before it is given up.
pub const FRICTION_STEPS: usize = 60;
/// A step of the friction loop below this part of the largest multiplier ends it.
pub const FRICTION_STEP: f64 = 1e-13;

/// How fast a motion usually is, so that rest can be told from a slow moment.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Mean speed of every drive, rad/s or m/s.
    pub speeds: Vec<f64>,
    /// How often the motion would fit into a second, 1/s.
    pub frequency: f64,
}

/// Friction at one joint at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionContact<T> {
    /// Which friction.
    pub friction: usize,
    /// First row of the joint.
    pub row: usize,
    /// Relative speed, rad/s or m/s.
    pub speed: T,
    /// Sense of sliding.
    pub direction: f64,
    /// What a unit of resistance does: to the body that slides and to the other.
    pub unit: [(BodyId, Wrench<T>); 2],
}

/// How the friction loop ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionOutcome {
    /// No friction acts.
    None,
    /// Loads and friction are consistent.
    Consistent {
        /// Newton steps made.
        steps: usize,
    },
    /// No finite force moves the mechanism: it jams already with this part of the friction.
    Jammed {
        /// Part of the friction at which the loads go to infinity.
        part: f64,
    },
    /// The loop did not settle.
    NotConverged {
        /// Last step over the largest multiplier.
        step: f64,
    },
}

impl<T: ForceNumber> Equilibrium<T> {
    pub(super) fn find_contacts(
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
        let fastest = self.fastest(at);
        let still = [STILL * fastest, UNMOVED * fastest * self.pace.frequency];
        let still_sliding = still.map(|s| s * self.size);
        let situation = Situation {
            geometry,
            inputs: &at.inputs,
            poses: &at.poses,
            near: &at.near,
        };
        for (index, friction) in frictions.iter().enumerate() {
            let row = self.first_row[friction.constraint];
            let (zero, one) = (T::zero(), T::one());
            let contact = |speed, direction, unit| FrictionContact {
                friction: index,
                row,
                speed,
                direction,
                unit,
            };
            let (v, w) = (&at.velocities, &at.accelerations);
            let constraint = &mechanism.constraints[friction.constraint].0;
            self.contacts.extend(match constraint.sliding(&situation) {
                Some(Sliding::Turning { a, b }) => {
                    let speed = v[b.index()][2] - v[a.index()][2];
                    let gain = w[b.index()][2] - w[a.index()][2];
                    let direction = direction(speed.value(), gain.value(), still);
                    let unit = [(b, [zero, zero, -one]), (a, [zero, zero, one])];
                    Some(contact(speed, direction, unit))
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
                    let gain = dot(tangent, gain).value();
                    let own = [-tangent[0], -tangent[1], -cross(arm, tangent)];
                    let other = [tangent[0], tangent[1], cross(arm_guide, tangent)];
                    let direction = direction(speed.value(), gain, still_sliding);
                    Some(contact(speed, direction, [(point.body, own), (on, other)]))
                }
                None => None,
            });
        }
    }

    /// The fastest that any body moves now, or would move at the usual speeds of the drives, 1/s.
    fn fastest(&self, at: &Instant<T>) -> f64 {
        let in_sizes = |v: [f64; 3]| v[2].max(v[0] / self.size).max(v[1] / self.size);
        let now = (at.velocities.iter()).map(|v| in_sizes(v.map(|x| x.value().abs())));
        let usual = (at.coefficients.iter().zip(&self.pace.speeds))
            .flat_map(|(bodies, speed)| bodies.iter().map(move |c| (c, *speed)))
            .map(|(c, speed)| in_sizes(c.map(|x| (x.value() * speed).abs())));
        now.chain(usual).fold(0.0, f64::max)
    }

    /// One Newton step on the plain multipliers with this share of the friction; returns its relative size.
    pub(super) fn step(
        &mut self,
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
        share: f64,
    ) -> f64 {
        let right = &mut self.right;
        right.fill(0.0);
        for (body, w) in needed.iter().enumerate().skip(1) {
            for k in 0..3 {
                right[3 * (body - 1) + k] = w[k].value();
            }
        }
        for entry in self.entries.iter().filter(|e| e.body != BodyId::GROUND) {
            for k in 0..3 {
                right[3 * (entry.body.index() - 1) + k] -=
                    entry.to[k].value() * self.plain[entry.row];
            }
        }
        for contact in &self.contacts {
            let friction = &frictions[contact.friction];
            let (_, load) = load_of(friction, &self.plain[contact.row..]);
            let viscous = (friction.law.viscous * contact.speed).value();
            let slope = friction.slope(contact.speed.value(), contact.direction);
            let resistance = (slope * load + viscous) * share;
            for (body, unit) in contact.unit.iter().filter(|u| u.0 != BodyId::GROUND) {
                for k in 0..3 {
                    right[3 * (body.index() - 1) + k] -= unit[k].value() * resistance;
                }
            }
        }
        let wide = &mut self.wide_plain;
        for (k, value) in right[..self.columns].iter().enumerate() {
            let scale = if k % 3 < 2 { self.size } else { 1.0 };
            wide[self.order.columns[k]] = value * scale;
        }
        self.qr.solve_transposed(wide);
        let (mut largest, mut step) = (0.0_f64, 0.0_f64);
        let places = self.order.rows.iter().zip(&self.unit);
        for (lambda, (place, unit)) in self.plain.iter_mut().zip(places) {
            let delta = wide[*place];
            *lambda += delta * unit;
            largest = largest.max((*lambda / unit).abs());
            step = step.max(delta.abs());
        }
        if largest > 0.0 { step / largest } else { step }
    }

    /// Newton's method with friction fed back, from the frictionless multipliers.
    pub(super) fn iterate(
        &mut self,
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
    ) -> FrictionOutcome {
        let free = self.qr.determinant();
        let square = self.rows == self.columns;
        let (mut last, mut steps) = (f64::INFINITY, 0);
        while steps < FRICTION_STEPS {
            self.refactor(frictions, 1.0);
            if !(self.qr.smallest_pivot_ratio() > SINGULAR) {
                break;
            }
            last = self.step(frictions, needed, 1.0);
            steps += 1;
            if last <= FRICTION_STEP {
                break;
            }
        }
        self.refactor(frictions, 1.0);
        let turned = square && !(self.qr.determinant() * free.signum() > 0.0);
        if turned || !(last <= FRICTION_STEP.sqrt()) {
            let jam = if square {
                self.find_jam(frictions, needed, free)
            } else {
                None
            };
            return match jam {
                Some(part) => FrictionOutcome::Jammed { part },
                None => FrictionOutcome::NotConverged { step: last },
            };
        }
        FrictionOutcome::Consistent { steps }
    }

    fn refactor(&mut self, frictions: &[Friction<T>], share: f64) {
        let plain = std::mem::take(&mut self.plain);
        self.factor(frictions, Some((&plain, share)));
        self.plain = plain;
    }

    /// The part of the friction with which the loads go to infinity: followed from none in steps that shrink on it.
    fn find_jam(
        &mut self,
        frictions: &[Friction<T>],
        needed: &[Wrench<T>],
        free: f64,
    ) -> Option<f64> {
        let (mut done, mut advance) = (0.0, 0.125);
        let mut good = self.frictionless.clone();
        while done < 1.0 && advance > 1e-6 {
            let share = f64::min(done + advance, 1.0);
            self.plain.copy_from_slice(&good);
            let mut settled = false;
            for _ in 0..FRICTION_STEPS {
                self.refactor(frictions, share);
                if !(self.qr.determinant() * free.signum() > 0.0) {
                    break;
                }
                if self.step(frictions, needed, share) <= FRICTION_STEP {
                    settled = true;
                    break;
                }
            }
            if settled {
                done = share;
                good.copy_from_slice(&self.plain);
            } else {
                advance *= 0.5;
            }
        }
        (done < 1.0).then_some(done)
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

    /// Power that friction takes, W: never positive.
    pub fn friction_power(&self, frictions: &[Friction<T>]) -> T {
        let mut sum = T::zero();
        for contact in &self.contacts {
            sum -= resistance(frictions, contact, &self.lambda) * contact.speed;
        }
        sum
    }

    /// Whether friction acts at a joint that does not move and is not about to: its size is not determined there.
    pub fn rests(&self, frictions: &[Friction<T>]) -> bool {
        self.contacts.iter().any(|contact| {
            contact.direction == 0.0 && frictions[contact.friction].law.kinetic.value() > 0.0
        })
    }
}

/// Rows and size of a joint's load at plain multipliers.
pub(super) fn load_of<T>(friction: &Friction<T>, lambda: &[f64]) -> (usize, f64) {
    match friction.radius {
        Some(_) => (2, kempe_number::math::hypot(lambda[0], lambda[1])),
        None => (1, lambda[0].abs()),
    }
}

pub(super) fn resistance<T: Number>(
    frictions: &[Friction<T>],
    contact: &FrictionContact<T>,
    lambda: &[T],
) -> T {
    let friction = &frictions[contact.friction];
    let load = match friction.radius {
        Some(_) => length([lambda[contact.row], lambda[contact.row + 1]]),
        None => lambda[contact.row].abs(),
    };
    friction.resistance(contact.speed, contact.direction, load)
}
