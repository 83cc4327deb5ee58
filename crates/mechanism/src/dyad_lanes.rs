//! RRR dyads in lanes, one register after the other.
//!
//! Lanes fill several registers, and an operation at a time on all of them needs more than there are: most would wait in memory for
//! what comes next. So the common dyads are solved for as many lanes as one register holds from the first operation to the last, and
//! whatever has to be asked is asked before. Where nothing of a dyad is looked at but the place of one point, that goes from the
//! registers straight to where it is wanted, and no pose is kept.

use kempe_number::Lanes;

use crate::bound_dyad::{BoundDyad, DyadArm};
use crate::branch::Branch;
use crate::closed_form::circle_circle;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::ids::{Marker, Spot};
use crate::local_marker::LocalMarker;
use crate::plan::{DyadBody, Plan};
use crate::pose::{Pose, sub};
use crate::step::Step;

/// Into how many parts lanes are parted at most.
const MOST_PARTS: usize = 4;

/// Does something for up to [`MOST_PARTS`] parts, one after the other, whose numbers are constants.
macro_rules! for_parts {
    ($parts:expr, |$part:ident| $does:expr) => {
        for_parts!(@ $parts, $part, $does, 0 1 2 3);
    };
    (@ $parts:expr, $part:ident, $does:expr, $($index:literal)*) => {
        $( if $index < $parts { let $part: usize = $index; $does; } )*
    };
}

/// Whether the placed point of a body is on an axis, and its pose, if wanted, begins at the outer pin with the inner one on its axis.
fn is_common(at: Spot, [outer, inner]: [Spot; 2], wanted: bool) -> bool {
    let begins_there = outer == Spot::Origin && matches!(inner, Spot::Origin | Spot::Axis);
    at != Spot::Anywhere && (!wanted || begins_there)
}

impl<const W: usize> DyadArm<'_, Lanes<W>> {
    fn is_common(&self) -> bool {
        is_common(self.at.spot, [self.outer.spot, self.inner], self.wanted)
    }

    /// The place of the outer pin, on the frame or on a moving body.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn placed<const P: usize, const FIXED: bool>(
        &self,
        poses: &[Pose<Lanes<W>>],
        part: usize,
    ) -> [Lanes<P>; 2] {
        if FIXED {
            return [self.at.p[0].part(part), self.at.p[1].part(part)];
        }
        let whole = &poses[self.at.body];
        let pose = Pose {
            x: whole.x.part::<P>(part),
            y: whole.y.part(part),
            c: whole.c.part(part),
            s: whole.s.part(part),
        };
        // At the origin it is 0 along the axis.
        pose.place_on_axis(self.at.p[0].part(part))
    }

    /// Keeps the pose with the outer pin at `world` and the inner one off it by `seen`; `own` is how far it is off over its square.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn keep<const P: usize>(
        &self,
        poses: &mut [Pose<Lanes<W>>],
        part: usize,
        own: &Lanes<W>,
        seen: [Lanes<P>; 2],
        world: [Lanes<P>; 2],
    ) {
        let pose = &mut poses[self.body];
        let own = own.part(part);
        pose.x.set_part(part, world[0]);
        pose.y.set_part(part, world[1]);
        pose.c.set_part(part, own * seen[0]);
        pose.s.set_part(part, own * seen[1]);
    }
}

/// Where the places of a point go, state by state.
pub trait PointRoom<const W: usize> {
    /// Room for x and y in a state; `None` where nothing is to be written.
    fn room(&mut self, state: usize) -> Option<[&mut [f64; W]; 2]>;
}

impl Plan {
    /// Whether [`Plan::place_point`] can place this point by the step.
    pub fn places_point(&self, step: usize, point: Marker) -> bool {
        let Step::Dyad(dyad) = &self.steps[step] else {
            return false;
        };
        let on = |arm: &DyadBody| arm.inner.body == point.body;
        let common =
            |arm: &DyadBody| is_common(arm.at.spot, [arm.outer.spot, arm.inner.spot], on(arm));
        let (a, b) = (&dyad.a, &dyad.b);
        (on(a) || on(b))
            && (common(a) && common(b))
            && (a.at.spot, b.at.spot) != (Spot::Frame, Spot::Frame)
            && matches!(point.spot, Spot::Axis | Spot::Anywhere)
    }

    /// Solves a dyad for several states, and gives the places of a point of one of its bodies without keeping a pose. The sum of all x is
    /// finite where they all have a place. `None` unless the dyad [can](Plan::places_point), or where there is no room.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn place_point<const W: usize>(
        &self,
        step: usize,
        point: Marker,
        design: &Design<Lanes<W>>,
        branch: &Branch,
        states: &[Configuration<Lanes<W>>],
        rooms: &mut impl PointRoom<W>,
    ) -> Option<f64> {
        let Step::Dyad(dyad) = &self.steps[step] else {
            return None;
        };
        let (dyad, point) = (
            BoundDyad::new(design, dyad),
            LocalMarker::new(design, point),
        );
        let sign = branch.signs[step];
        match W {
            8 => dyad.place_parts::<2>(states, sign, point, rooms),
            16 => dyad.place_parts::<4>(states, sign, point, rooms),
            _ => None,
        }
    }
}

impl<const W: usize> BoundDyad<'_, Lanes<W>> {
    /// [`BoundDyad::solve`] without a determinant for several states, `P` lanes at a time; `false` if this dyad is none of the common ones.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn solve_parts<const P: usize>(
        &self,
        states: &mut [Configuration<Lanes<W>>],
        sign: f64,
    ) -> bool {
        let Self { a, b, .. } = self;
        if W / P > MOST_PARTS || !(a.is_common() && b.is_common()) {
            return false;
        }
        macro_rules! solve {
            ($fixed_a:literal, $fixed_b:literal) => {
                match b.wanted {
                    true => solve!($fixed_a, $fixed_b, true),
                    false => solve!($fixed_a, $fixed_b, false),
                }
            };
            ($($form:literal),*) => {
                for state in states {
                    let poses = &mut state.poses[..];
                    // Every part for itself: of a known one the compiler knows that it lies in a register of its own.
                    for_parts!(W / P, |part| {
                        self.solve_part::<P, $($form),*>(poses, part, sign)
                    });
                }
            };
        }
        match (a.at.spot, b.at.spot) {
            (Spot::Frame, Spot::Frame) => return false,
            (Spot::Frame, _) => solve!(true, false),
            (_, Spot::Frame) => solve!(false, true),
            _ => solve!(false, false),
        }
        true
    }

    /// Solves one part: whether the outer pins are on the frame and whether the second body's pose is wanted is known to the compiler.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve_part<const P: usize, const FIXED_A: bool, const FIXED_B: bool, const KEEP_B: bool>(
        &self,
        poses: &mut [Pose<Lanes<W>>],
        part: usize,
        sign: f64,
    ) {
        let Self { a, b, constants: k } = self;
        let ([wa, wb], v, reach) = self.reach_part::<P, FIXED_A, FIXED_B>(poses, part, sign);
        // A pose that nobody wants harms nobody.
        a.keep(poses, part, &k[0], reach, wa);
        if KEEP_B {
            b.keep(poses, part, &k[2], sub(reach, v), wb);
        }
    }

    /// The places of the outer pins, the vector between them, and that from the first to the inner one.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn reach_part<const P: usize, const FIXED_A: bool, const FIXED_B: bool>(
        &self,
        poses: &[Pose<Lanes<W>>],
        part: usize,
        sign: f64,
    ) -> ([[Lanes<P>; 2]; 2], [Lanes<P>; 2], [Lanes<P>; 2]) {
        let Self { a, b, constants: k } = self;
        let wa = a.placed::<P, FIXED_A>(poses, part);
        let wb = b.placed::<P, FIXED_B>(poses, part);
        let [difference, outer, inner] = [k[4].part(part), k[5].part(part), k[6].part(part)];
        let v = sub(wb, wa);
        let (reach, _) = circle_circle(v, difference, outer, inner, sign);
        ([wa, wb], v, reach)
    }

    /// [`Plan::place_point`], `P` lanes at a time.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn place_parts<const P: usize>(
        &self,
        states: &[Configuration<Lanes<W>>],
        sign: f64,
        point: LocalMarker<'_, Lanes<W>>,
        rooms: &mut impl PointRoom<W>,
    ) -> Option<f64> {
        let Self { a, b, .. } = self;
        macro_rules! place {
            ($fixed_a:literal, $fixed_b:literal) => {
                match point.body == b.body {
                    true => place!($fixed_a, $fixed_b, true),
                    false => place!($fixed_a, $fixed_b, false),
                }
            };
            ($fixed_a:literal, $fixed_b:literal, $on_b:literal) => {
                match point.spot {
                    Spot::Axis => place!($fixed_a, $fixed_b, $on_b, true),
                    _ => place!($fixed_a, $fixed_b, $on_b, false),
                }
            };
            ($($form:literal),*) => {{
                let mut sum = Lanes([0.0; P]);
                for (index, state) in states.iter().enumerate() {
                    let [x, y] = rooms.room(index)?;
                    let poses = &state.poses[..];
                    for_parts!(W / P, |part| {
                        let place = self.place_part::<P, $($form),*>(poses, part, sign, point);
                        sum += place[0];
                        x.as_chunks_mut().0[part] = place[0].0;
                        y.as_chunks_mut().0[part] = place[1].0;
                    });
                }
                Some(sum.0.iter().sum())
            }};
        }
        match (a.at.spot, b.at.spot) {
            (Spot::Frame, Spot::Frame) => None,
            (Spot::Frame, _) => place!(true, false),
            (_, Spot::Frame) => place!(false, true),
            _ => place!(false, false),
        }
    }

    /// The place of a point, known to be on the second body or on the first, and on its axis or not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn place_part<
        const P: usize,
        const FIXED_A: bool,
        const FIXED_B: bool,
        const ON_B: bool,
        const ON_AXIS: bool,
    >(
        &self,
        poses: &[Pose<Lanes<W>>],
        part: usize,
        sign: f64,
        point: LocalMarker<'_, Lanes<W>>,
    ) -> [Lanes<P>; 2] {
        let k = self.constants;
        let ([wa, wb], v, reach) = self.reach_part::<P, FIXED_A, FIXED_B>(poses, part, sign);
        let (own, seen, [x, y]) = match ON_B {
            true => (k[2].part(part), sub(reach, v), wb),
            false => (k[0].part(part), reach, wa),
        };
        let (c, s) = (own * seen[0], own * seen[1]);
        let pose = Pose { x, y, c, s };
        let along = point.p[0].part(part);
        match ON_AXIS {
            true => pose.place_on_axis(along),
            false => pose.place([along, point.p[1].part(part)]),
        }
    }
}
