//! RRR dyads in lanes, one register after the other.
//!
//! Lanes fill several registers, and an operation at a time on all of them needs more than there are: most would wait in memory for
//! what comes next. So the common dyads are solved for as many lanes as one register holds from the first operation to the last, and
//! whatever has to be asked is asked before.

use kempe_number::Lanes;

use crate::bound_dyad::{BoundDyad, DyadArm};
use crate::closed_form::circle_circle;
use crate::configuration::Configuration;
use crate::ids::Spot;
use crate::pose::{Pose, sub};

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

impl<const W: usize> DyadArm<'_, Lanes<W>> {
    /// Whether its placed point is on an axis, and its pose, if wanted, begins at the outer pin with the inner one on its axis.
    fn is_common(&self) -> bool {
        self.at.spot != Spot::Anywhere
            && (!self.wanted || self.on_axis && self.outer.spot == Spot::Origin)
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
        let wa = a.placed::<P, FIXED_A>(poses, part);
        let wb = b.placed::<P, FIXED_B>(poses, part);
        let [difference, outer, inner] = [k[4].part(part), k[5].part(part), k[6].part(part)];
        let v = sub(wb, wa);
        let (reach, _) = circle_circle(v, difference, outer, inner, sign);
        // A pose that nobody wants harms nobody.
        a.keep(poses, part, &k[0], reach, wa);
        if KEEP_B {
            b.keep(poses, part, &k[2], sub(reach, v), wb);
        }
    }
}
