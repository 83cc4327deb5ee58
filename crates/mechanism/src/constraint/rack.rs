//! A pinion rolling on a rack. Its row is a length: how far the pinion's centre is ahead of where it rolled to.

use kempe_model::LinkId;
use kempe_number::Number;

use super::isotropic::Isotropic;
use super::joint::{Gradient, Joint, Pairs, Touch};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use super::travel::{travel_gradients, travelled};
use crate::ids::{BodyId, LineRef, Marker};
use crate::parts::Parts;
use crate::pose::left;
use crate::step::{Condition, Step};

/// `s + radius (angle_pinion - angle_rack) = offset`, `s` along the rack's line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rack {
    /// Pitch line on the rack.
    pub line: LineRef,
    /// The pinion's centre.
    pub center: Marker,
    /// Index into the geometry's gear constants.
    pub constants: u32,
}

impl Rack {
    /// The pitch point, and the unit vector from there to the pinion's centre for a pinion on the left of the line.
    fn pitch<T: Number>(&self, at: &Situation<'_, T>) -> ([T; 2], [T; 2]) {
        let k = &at.geometry.gears[self.constants as usize];
        let (center, up) = (at.place(self.center), left(at.line(self.line).1));
        ([0, 1].map(|i| center[i] - up[i] * k.second), up)
    }
}

impl Joint for Rack {
    fn touches(&self) -> [Option<Touch>; 3] {
        [
            Some(Touch::Whole(self.line.body)),
            Some(Touch::Point(self.center)),
            Some(Touch::Angle(self.center.body)),
        ]
    }

    fn pairs(&self) -> Pairs {
        Pairs::HIGHER
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        vec![parts.link_of(self.center), parts.link_of_line(self.line)]
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let k = &at.geometry.gears[self.constants as usize];
        let travel = travelled(at, self.center, self.line);
        let rolled = k.second * (at.angle(self.center.body) - at.angle(self.line.body));
        [travel + rolled - k.constant, T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        travel_gradients(at, self.center, self.line, &mut emit);
        let k = &at.geometry.gears[self.constants as usize];
        emit(Gradient::to_angle(self.center.body, k.second));
        emit(Gradient::to_angle(self.line.body, -k.second));
        T::zero()
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let Self {
            line,
            center,
            constants,
        } = *self;
        (line.body == body).then_some(Condition::Roll {
            line,
            center,
            constants,
        })
    }

    fn turn(&self, body: BodyId, constraint: usize) -> Option<Step> {
        Some(Step::Gear { body, constraint })
    }

    fn roll(&self, (own, at): (Marker, Marker), constraint: usize) -> Option<Step> {
        let is_pinion = self.center == own && self.line.body != own.body;
        is_pinion.then_some(Step::Roll {
            own,
            at,
            constraint,
        })
    }

    #[inline]
    fn angle<T: Number>(&self, at: &Situation<'_, T>, body: BodyId) -> Option<T> {
        let k = &at.geometry.gears[self.constants as usize];
        let turn = (k.constant - travelled(at, self.center, self.line)) / k.second;
        // The rack itself can only be the one sought when its line's place is known without its angle.
        (body == self.center.body).then(|| at.angle(self.line.body) + turn)
    }

    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    fn counts_turns(&self) -> bool {
        true
    }

    fn opened_by(&self, parts: &Parts) -> Vec<(LinkId, LinkId)> {
        let [rack, pinion, _] = parts.gears[self.constants as usize].links;
        vec![(pinion, rack)]
    }

    fn load_point(&self, _: BodyId) -> Option<LoadPoint> {
        Some(LoadPoint::At(self.center))
    }

    fn load_place<T: Number>(&self, at: &Situation<'_, T>) -> Option<[T; 2]> {
        Some(self.pitch(at).0)
    }

    fn rubs(&self) -> Option<Rubs> {
        Some(Rubs::Teeth {
            constants: self.constants,
            rack: true,
        })
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        let (point, up) = self.pitch(at);
        let k = &at.geometry.gears[self.constants as usize];
        let side = k.second.choose(T::one(), -T::one());
        Some(Sliding::Rolling {
            a: self.center.body,
            b: self.line.body,
            point,
            off: up.map(|x| x * side),
            unit: T::one(),
        })
    }
}
