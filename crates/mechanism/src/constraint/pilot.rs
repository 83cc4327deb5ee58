//! What tells the place of a mechanism that is let go: the coordinate of a drive, or, where that drive comes to a dead point of its
//! own, the angle of some body. Its row is that of the one that counts.
//!
//! Whichever it is, the pose is the same: what changes along a motion is by what it is found.

use kempe_model::{DriveId, LinkId};
use kempe_number::Number;

use super::Constraint;
use super::direction::Direction;
use super::distance::Distance;
use super::isotropic::Isotropic;
use super::joint::{Gradient, Joint, Pairs, Touch, Unit};
use super::loads::LoadPoint;
use super::situation::Situation;
use super::travel::Travel;
use crate::ids::BodyId;
use crate::parts::Parts;
use crate::pose::{cross, dot};

/// Bodies among which the coordinate is chosen, at most.
pub const MOST_PILOTS: usize = 6;

/// One coordinate of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pilot {
    own: Own,
    /// Bodies whose angles may be the coordinate; the frame where there are no more.
    bodies: [BodyId; MOST_PILOTS],
    /// The drive whose coordinate says which counts: 0 for the own one, from 1 on the bodies.
    chosen: DriveId,
    /// The drive whose coordinate it is.
    input: DriveId,
}

/// What the drive that is let go holds, at the pilot's coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Own {
    Direction(Direction),
    Distance(Distance),
    Travel(Travel),
}

/// Asks the drive that is let go.
macro_rules! own {
    ($own:expr, $it:ident => $answer:expr) => {
        match $own {
            Own::Direction($it) => $answer,
            Own::Distance($it) => $answer,
            Own::Travel($it) => $answer,
        }
    };
}

impl Pilot {
    /// For what a drive holds, with its coordinate at `input`, or the angle of one of `bodies`, as `chosen` says. `None` for what
    /// is no drive's, or for more bodies than [`MOST_PILOTS`].
    pub fn new(own: Constraint, bodies: &[BodyId], chosen: DriveId) -> Option<Self> {
        let (own, input) = match own {
            Constraint::Direction(it) => (Own::Direction(it), it.input?),
            Constraint::Distance(it) => (Own::Distance(it), it.input),
            Constraint::Travel(it) => (Own::Travel(it), it.input),
            _ => return None,
        };
        let mut places = [BodyId::GROUND; MOST_PILOTS];
        places.get_mut(..bodies.len())?.copy_from_slice(bodies);
        Some(Self {
            own,
            bodies: places,
            chosen,
            input,
        })
    }

    /// The body whose angle counts; `None` for the own coordinate.
    #[inline]
    fn body<T: Number>(&self, at: &Situation<'_, T>) -> Option<BodyId> {
        // A whole number, whichever way it was rounded on the way here.
        let chosen = (at.inputs[self.chosen.index()].value.value() + 0.5) as usize;
        self.bodies.get(chosen.checked_sub(1)?).copied()
    }

    /// Sine and cosine of how far the angle of a body is ahead of the coordinate.
    #[inline]
    fn ahead<T: Number>(&self, at: &Situation<'_, T>, body: BodyId) -> [T; 2] {
        let (pose, q) = (&at.poses[body.index()], &at.inputs[self.input.index()]);
        let own = [pose.c, pose.s];
        [cross([q.c, q.s], own), dot([q.c, q.s], own)]
    }
}

impl Joint for Pilot {
    fn unit(&self) -> Unit {
        own!(self.own, it => it.unit())
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        own!(self.own, it => it.touches())
    }

    fn touched(&self) -> Vec<Touch> {
        let bodies = self.bodies.iter().filter(|body| **body != BodyId::GROUND);
        let own = self.touches().into_iter().flatten();
        own.chain(bodies.map(|body| Touch::Angle(*body))).collect()
    }

    fn drive(&self) -> Option<DriveId> {
        Some(self.input)
    }

    fn pairs(&self) -> Pairs {
        Pairs::default()
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        let of_body = |body: &BodyId| parts.seats.iter().position(|seat| seat.body == *body);
        let bodies = self.bodies.iter().filter(|body| **body != BodyId::GROUND);
        let others = bodies.filter_map(of_body);
        let mut links = own!(self.own, it => it.links(parts));
        links.extend(others.map(|link| LinkId(link as u32)));
        links
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        match self.body(at) {
            None => own!(self.own, it => it.residual(at)),
            Some(body) => [self.ahead(at, body)[0], T::zero()],
        }
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        match self.body(at) {
            None => own!(self.own, it => it.gradients(at, emit)),
            Some(body) => {
                let [_, cosine] = self.ahead(at, body);
                emit(Gradient::to_angle(body, cosine));
                -cosine
            }
        }
    }

    fn is_reversed<T: Number>(&self, at: &Situation<'_, T>) -> bool {
        match self.body(at) {
            None => own!(self.own, it => it.is_reversed(at)),
            Some(body) => self.ahead(at, body)[1].value() < 0.0,
        }
    }

    /// Never: its mechanism goes on from a pose.
    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    /// Nowhere: it carries nothing.
    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        None
    }
}
