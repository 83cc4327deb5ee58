//! A body that a placed pin or line and a pin on a smooth curve hold: every pose it can take, found along the curve.
//!
//! One equation in the angle of the shoe is left, and interval arithmetic tells which parts of the curve hold no solution
//! of it and on which it is monotonic (R. E. Moore, 1966). So all of them between the ends of the curve are found.

use std::f64::consts::{FRAC_PI_2, PI};

use kempe_mechanism::blocks::Unknown;
use kempe_mechanism::constraint::{Joint, OnCurve};
use kempe_mechanism::curve::LocalCurve;
use kempe_mechanism::plan::{Condition, NewtonBlock};
use kempe_mechanism::pose::{Pose, cross, dot, sub};
use kempe_mechanism::structure::{BodyId, Constraint};
use kempe_mechanism::{Configuration, Design, Geometry};
use kempe_number::{Interval, Number, math};

/// Parts into which a curve is cut at first.
const PARTS: usize = 64;
/// On a part this narrow, rad, with one solution Newton's method finds it from anywhere.
const NARROW: f64 = 1e-3;
/// On a part this narrow, rad, two solutions are one.
const SAME: f64 = 1e-8;
/// Most parts that are looked at: where the pin fits a whole stretch of the curve there is no end.
const MOST_PARTS: usize = 20_000;

/// Poses near those of a block, one for each; `None` where the block is of another kind.
pub(super) fn poses(
    design: &Design<f64>,
    block: &NewtonBlock,
    state: &Configuration<f64>,
) -> Option<Vec<Vec<Pose<f64>>>> {
    let held = Held::of(design, block, &state.poses)?;
    let plain = OtherSide::new(&held, &design.geometry);
    let geometry: Geometry<Interval> = design.geometry.map(Interval::from_f64);
    let wide = OtherSide::new(&held, &geometry);
    let closed = design.mechanism.curves[held.on.curve.index as usize].closed;
    let reach = if closed { PI } else { FRAC_PI_2 };

    let gap = |angle: f64| wide.gap(Interval::from_f64(angle)).0;
    let cut = |k: usize| reach * (2.0 * k as f64 / PARTS as f64 - 1.0);
    let mut parts: Vec<Interval> = (0..PARTS)
        .rev()
        .map(|k| Interval::new(cut(k), cut(k + 1)))
        .collect();
    let (mut found, mut seen) = (Vec::new(), 0);
    while let Some(part) = parts.pop() {
        seen += 1;
        if seen > MOST_PARTS {
            return None;
        }
        let (gap_there, slope) = wide.gap(part);
        if !gap_there.contains_zero() && !gap_there.is_empty() {
            continue;
        }
        let is_monotonic = !slope.contains_zero() && !slope.is_empty();
        if is_monotonic {
            let ends = gap(part.lo()) * gap(part.hi());
            if ends.lo() > 0.0 {
                continue;
            }
        }
        if part.width() <= SAME || (is_monotonic && part.width() <= NARROW) {
            found.push(plain.poses(part.midpoint(), &state.poses));
            continue;
        }
        let (first, second) = part.bisect();
        parts.extend([second, first]);
    }
    Some(found)
}

/// How the body is held apart from the curve.
#[derive(Clone, Copy)]
enum Hold {
    /// Pinned: its own point and where that is.
    Pinned([f64; 2], [f64; 2]),
    /// Its angle known, its own point on a line: origin and direction.
    Sliding([f64; 2], [f64; 2], [f64; 2]),
}

/// A body of a block, held so that one freedom is left, with a pin on a curve between it and a placed body.
struct Held<'a> {
    on: OnCurve,
    body: BodyId,
    hold: Hold,
    poses: &'a [Pose<f64>],
}

impl<'a> Held<'a> {
    fn of(design: &Design<f64>, block: &NewtonBlock, poses: &'a [Pose<f64>]) -> Option<Self> {
        let of = |index: usize| &design.mechanism.constraints[index].0;
        let [(a, _), (b, _)] = block.equations.by_constraint[..] else {
            return None;
        };
        let (on, other) = match (of(a), of(b)) {
            (Constraint::OnCurve(on), other) | (other, Constraint::OnCurve(on)) => (*on, other),
            _ => return None,
        };
        let mut angle_sought = false;
        let mut bodies = Vec::new();
        for unknown in block.unknowns.iter().filter(|u| u.body() != on.shoe) {
            angle_sought |= matches!(unknown, Unknown::Angle(_));
            bodies.push(unknown.body());
        }
        bodies.dedup();
        let [body] = bodies[..] else {
            return None;
        };
        let geometry = &design.geometry;
        let hold = if angle_sought {
            let (own, at) = other.pin(body)?;
            let at = poses[at.body.index()].place(geometry.marker(at));
            Hold::Pinned(geometry.marker(own), at)
        } else {
            let Some(Condition::OnLine { own, line }) = other.condition(body) else {
                return None;
            };
            let (placed, local) = (&poses[line.body.index()], geometry.line(line));
            Hold::Sliding(
                geometry.marker(own),
                placed.place(local.origin),
                placed.turn(local.direction),
            )
        };
        let one_moves = (on.point.body == body) != (on.curve.body == body);
        one_moves.then_some(Self {
            on,
            body,
            hold,
            poses,
        })
    }
}

/// The contact of pin and curve by the angle of the shoe, on one kind of number.
struct OtherSide<'a, T> {
    held: &'a Held<'a>,
    curve: &'a LocalCurve<T>,
    pin: [T; 2],
}

impl<'a, T: Number> OtherSide<'a, T> {
    fn new(held: &'a Held<'a>, geometry: &'a Geometry<T>) -> Self {
        Self {
            held,
            curve: geometry.curve(held.on.curve),
            pin: geometry.marker(held.on.point),
        }
    }

    /// Where the contact is on the body and in the frame, with the derivatives to the shoe's angle.
    fn contact(&self, angle: T) -> [[[T; 2]; 2]; 2] {
        let Held {
            on, body, poses, ..
        } = self.held;
        let shoe = Pose::from_angle(T::zero(), T::zero(), angle);
        let place = self.curve.at(&shoe, angle.value());
        let placed = |of: BodyId| poses[of.index()].map(T::from_f64);
        let still = [T::zero(); 2];
        if on.curve.body == *body {
            let world = placed(on.point.body).place(self.pin);
            [[place.place, place.rate], [world, still]]
        } else {
            let pose = placed(on.curve.body);
            let world = [pose.place(place.place), pose.turn(place.rate)];
            [[self.pin, still], world]
        }
    }

    /// How far the body is from fitting, and the derivative of that to the shoe's angle.
    fn gap(&self, angle: T) -> (T, T) {
        let [[own, own_rate], [world, world_rate]] = self.contact(angle);
        let lift = |v: [f64; 2]| v.map(T::from_f64);
        match self.held.hold {
            Hold::Pinned(pin, at) => {
                let (arm, reach) = (sub(own, lift(pin)), sub(world, lift(at)));
                let gap = reach[0].square() + reach[1].square() - arm[0].square() - arm[1].square();
                (gap, (dot(reach, world_rate) - dot(arm, own_rate)) * 2.0)
            }
            Hold::Sliding(tip, origin, direction) => {
                let body = self.held.poses[self.held.body.index()].map(T::from_f64);
                let off = sub(sub(world, body.turn(sub(own, lift(tip)))), lift(origin));
                let rate = sub(world_rate, body.turn(own_rate));
                (cross(lift(direction), off), cross(lift(direction), rate))
            }
        }
    }
}

impl OtherSide<'_, f64> {
    /// The body and the shoe put where the contact is.
    fn poses(&self, angle: f64, before: &[Pose<f64>]) -> Vec<Pose<f64>> {
        let [[own, _], [world, _]] = self.contact(angle);
        let mut poses = before.to_vec();
        let body = &mut poses[self.held.body.index()];
        *body = match self.held.hold {
            Hold::Pinned(pin, at) => {
                let (arm, reach) = (sub(own, pin), sub(world, at));
                let turn = math::atan2(reach[1], reach[0]) - math::atan2(arm[1], arm[0]);
                let (s, c) = math::sin_cos(turn);
                Pose::pinned(c, s, pin, at)
            }
            Hold::Sliding(..) => Pose::pinned(body.c, body.s, own, world),
        };
        poses[self.held.on.shoe.index()] = Pose::from_angle(world[0], world[1], angle);
        poses
    }
}
