//! What every joint and every drive must answer for itself.

use kempe_model::{DriveId, LinkId};
use kempe_number::Number;

use super::isotropic::Isotropic;
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::step::{Condition, Step};

/// Everything that a kind of constraint says of itself. Whoever needs it asks through
/// [`Constraint`](super::Constraint) and never looks at the kind.
///
/// A room of its own file holds its rows and their gradients, what it touches, the closed forms in which it takes part,
/// its equations for the homotopy, and what it carries.
pub trait Joint {
    /// How many rows it has: one or two.
    fn rows(&self) -> usize {
        1
    }

    /// In what its rows are counted.
    fn unit(&self) -> Unit {
        Unit::Length
    }

    /// What of its bodies it touches: all of it, unless [`Joint::touched`] says more.
    fn touches(&self) -> [Option<Touch>; 3];

    /// All that it touches of its bodies.
    fn touched(&self) -> Vec<Touch> {
        self.touches().into_iter().flatten().collect()
    }

    /// The drive whose coordinate it holds.
    fn drive(&self) -> Option<DriveId> {
        None
    }

    /// What it adds to the count of links and pairs.
    fn pairs(&self) -> Pairs;

    /// The links that it acts on, one for each of its bodies, the link that feels its load first.
    fn links(&self, parts: &Parts) -> Vec<LinkId>;

    /// The residual rows; only the first [`Joint::rows`] count.
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2];

    /// Hands the derivatives of the rows to `emit`, at any pose, not only where the constraint holds, and returns the
    /// derivative of the row to the coordinate of its drive (zero without one).
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) -> T;

    /// How far each row stands open, as [`Joint::residual`] unless that is so to first order alone.
    fn openings<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        self.residual(at)
    }

    /// The derivatives of [`Joint::openings`], as [`Joint::gradients`] hands them out.
    fn opening_gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) {
        self.gradients(at, emit);
    }

    /// Whether a direction points the opposite way where the residual, a sine, does not tell.
    fn is_reversed<T: Number>(&self, _: &Situation<'_, T>) -> bool {
        false
    }

    /// Whether its rows hold beyond where the joint ends: the motion may go there, no assembly starts there.
    fn is_past_end(&self, _: &Situation<'_, f64>) -> bool {
        false
    }

    /// As a pin of a body: its own point and the other.
    fn pin(&self, _: BodyId) -> Option<(Marker, Marker)> {
        None
    }

    /// As a row of a pin that is let go.
    fn opened(&self) -> Option<Opened> {
        None
    }

    /// As a condition on a body whose other side is placed, for the closed forms.
    fn condition(&self, _: BodyId) -> Option<Condition> {
        None
    }

    /// The step that turns a body by this constraint alone, which is the mechanism's `index`th.
    fn turn(&self, _: BodyId, _index: usize) -> Option<Step> {
        None
    }

    /// The step that turns a body pinned at this marker of its own to a placed one, `(own, at)`, whatever its angle.
    fn roll(&self, _pin: (Marker, Marker), _index: usize) -> Option<Step> {
        None
    }

    /// The angle of a body by this constraint, rad, where angles count turns.
    fn angle<T: Number>(&self, _: &Situation<'_, T>, _: BodyId) -> Option<T> {
        None
    }

    /// Its equation in isotropic coordinates, lengths counted in `scale` (m); `None` where it is not algebraic in them.
    fn isotropic(&self, at: &Situation<'_, f64>, scale: f64) -> Option<Isotropic>;

    /// Its equation in the angles of bodies, where it is one of angles alone.
    fn in_angles(&self, _: &Situation<'_, f64>) -> Option<InAngles> {
        None
    }

    /// Whether it counts the turns of its bodies.
    fn counts_turns(&self) -> bool {
        false
    }

    /// Pairs of links, the first turning against the second, by whose angle a loop that this constraint closes can be
    /// swept through with the constraint left out; none where the loop is solved otherwise.
    fn opened_by(&self, _: &Parts) -> Vec<(LinkId, LinkId)> {
        Vec::new()
    }

    /// The pins by which its wheels turn on their arm: its rows tell the angles of wheels whose pins hold, and no others.
    fn needs_pins(&self) -> Option<[Marker; 2]> {
        None
    }

    /// Hands out the derivatives of the rows whose multipliers are the loads it carries: those of the residual, unless a
    /// condition that says the same of a motion tells better where the load acts.
    fn load_gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) {
        self.gradients(at, emit);
    }

    /// In what the rows of [`Joint::load_gradients`] are counted.
    fn load_unit(&self) -> Unit {
        self.unit()
    }

    /// Where the load on a body is counted; `None` where another constraint of the same joint tells.
    fn load_point(&self, body: BodyId) -> Option<LoadPoint>;

    /// Where its load acts in the frame, m, where that is no point of a body.
    fn load_place<T: Number>(&self, _: &Situation<'_, T>) -> Option<[T; 2]> {
        None
    }

    /// What rubs in it; `None` where no friction acts.
    fn rubs(&self) -> Option<Rubs> {
        None
    }

    /// How its bodies slide on each other, where it rubs.
    fn sliding<T: Number>(&self, _: &Situation<'_, T>) -> Option<Sliding<T>> {
        None
    }
}

/// A row of a pin that is let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opened {
    /// The pin's points: the second is off the first.
    pub pin: [Marker; 2],
    /// Which of its rows: 0 along the frame's x axis, 1 along y.
    pub row: u8,
    /// The drive whose coordinate tells how far.
    pub input: DriveId,
}

/// In what rows are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// m: lengths count in mechanism sizes beside angles.
    Length,
    /// rad, or the sine of an angle.
    Angle,
}

impl Unit {
    /// The factor that makes rows comparable with others' in a mechanism of this size, m.
    pub fn factor(self, size: f64) -> f64 {
        match self {
            Self::Length => 1.0 / size,
            Self::Angle => 1.0,
        }
    }
}

/// Something of a body that a constraint touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// A point: the body's place, and its angle unless the point lies at its origin.
    Point(Marker),
    /// A line or curve of the body: place and angle.
    Whole(BodyId),
    /// The angle alone.
    Angle(BodyId),
}

impl Touch {
    /// Whose it is.
    pub fn body(self) -> BodyId {
        match self {
            Self::Point(marker) => marker.body,
            Self::Whole(body) | Self::Angle(body) => body,
        }
    }
}

/// Links and pairs as Chebyshev and Grübler count them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// Links that no file names.
    pub links: i64,
    /// Lower pairs.
    pub lower: i64,
    /// Higher pairs.
    pub higher: i64,
}

impl Pairs {
    /// One higher pair.
    pub const HIGHER: Self = Self {
        links: 0,
        lower: 0,
        higher: 1,
    };
}

/// `sum of factor angle = constant`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InAngles {
    /// Bodies with their factors.
    pub terms: [(BodyId, f64); 3],
    /// Right-hand side.
    pub constant: f64,
}

/// One entry of the constraint Jacobian: the derivative of a row to a body's x, y and angle.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<T = f64> {
    /// Row of the constraint.
    pub row: usize,
    /// The body.
    pub body: BodyId,
    /// Derivatives to x, y (per m) and angle (per rad).
    pub to: [T; 3],
}

impl<T: Number> Gradient<T> {
    /// The derivative of the first row to a body's angle alone.
    #[inline(always)]
    pub(super) fn to_angle(body: BodyId, factor: T) -> Self {
        Self {
            row: 0,
            body,
            to: [T::zero(), T::zero(), factor],
        }
    }
}
