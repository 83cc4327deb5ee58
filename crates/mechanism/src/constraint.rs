//! Every kind of joint and drive, and who speaks for it.
//!
//! A kind is one file: what it demands of the bodies it ties (residuals over these bodies, their gradients beside them),
//! in which closed forms it takes part, its equations for the homotopy, what it carries and how it rubs. What each must
//! answer is [`Joint`]; here stands only the list of kinds, and the way to the one asked. Rank, Newton groups, closure
//! evidence and joint reactions all come from there; the closed forms are held to the rows.

mod belt;
mod coincide;
mod direction;
mod distance;
mod gears;
mod isotropic;
mod joint;
mod loads;
mod on_arc;
mod on_curve;
mod on_line;
mod pilot;
mod rack;
mod released;
mod situation;
mod travel;

pub use self::belt::Belt;
pub use self::coincide::Coincide;
pub use self::direction::Direction;
pub use self::distance::Distance;
pub use self::gears::Gears;
pub use self::isotropic::{Isotropic, Vector};
pub use self::joint::{Gradient, InAngles, Joint, Opened, Pairs, Touch, Unit};
pub use self::loads::{LoadPoint, Rubs, Sliding};
pub use self::on_arc::OnArc;
pub use self::on_curve::{OnCurve, Shoe};
pub use self::on_line::OnLine;
pub use self::pilot::{MOST_PILOTS, Pilot};
pub use self::rack::Rack;
pub use self::released::Released;
pub use self::situation::{Input, Situation};
pub use self::travel::Travel;

use kempe_model::{DriveId, JointId, LinkId, PointId};
use kempe_number::Number;

use crate::ids::{BodyId, Marker};
use crate::parts::Parts;
use crate::step::{Condition, Step};

/// What a constraint comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A pin made by a shared point name; `link` is the later of the two links.
    Pin {
        /// The point.
        point: PointId,
        /// The later link.
        link: LinkId,
    },
    /// A joint of the file.
    Joint(JointId),
    /// A drive.
    Drive(DriveId),
}

impl Source {
    /// The joint that may be let go; `None` for a drive.
    pub fn released(self) -> Option<kempe_model::Released> {
        match self {
            Self::Pin { point, link } => Some(kempe_model::Released::Pin { point, link }),
            Self::Joint(joint) => Some(kempe_model::Released::Joint(joint)),
            Self::Drive(_) => None,
        }
    }
}

impl From<kempe_model::Released> for Source {
    fn from(joint: kempe_model::Released) -> Self {
        match joint {
            kempe_model::Released::Pin { point, link } => Self::Pin { point, link },
            kempe_model::Released::Joint(joint) => Self::Joint(joint),
        }
    }
}

/// Declares the kinds, and [`Joint`] for the enum over them: each question goes to the kind's own file.
macro_rules! kinds {
    (
        joints_and_drives { $($(#[$doc:meta])* $kind:ident,)* }
        joints_let_go { $($held:ident as $released:ident,)* }
    ) => {
        /// One condition between bodies.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Constraint {
            $($(#[$doc])* $kind($kind),)*
            $(
                /// A row of this joint that is let go.
                $released(Released<$held>),
            )*
        }

        $(impl From<$kind> for Constraint {
            fn from(joint: $kind) -> Self {
                Self::$kind(joint)
            }
        })*

        impl Constraint {
            /// The constraint that holds one row of this joint at the coordinate of a drive in place of zero. `None` for a
            /// constraint that holds a drive already.
            pub fn releasing(self, row: u8, input: DriveId) -> Option<Self> {
                match self {
                    // An angle that is let go is a driven angle: whole turns, and a closed form.
                    Self::Direction(joint @ Direction { input: None, .. }) => {
                        let input = Some(input);
                        Some(Direction { input, ..joint }.into())
                    }
                    $(Self::$held(joint) => Some(Self::$released(Released { joint, row, input })),)*
                    _ => None,
                }
            }
        }

        /// Asks the kind that a constraint is of.
        macro_rules! ask {
            ($constraint:expr, $joint:ident => $answer:expr) => {
                match $constraint {
                    $(Constraint::$kind($joint) => $answer,)*
                    $(Constraint::$released($joint) => $answer,)*
                }
            };
        }
    };
}
kinds! {
    joints_and_drives {
        /// Two points coincide: two rows.
        Coincide,
        /// A point lies on a line.
        OnLine,
        /// The angle between two bodies is set.
        Direction,
        /// The distance of two points is a drive's coordinate.
        Distance,
        /// A point's coordinate along a line is a drive's coordinate.
        Travel,
        /// Two gears in mesh on an arm.
        Gears,
        /// A pinion rolling on a rack.
        Rack,
        /// A belt or chain over two wheels on an arm.
        Belt,
        /// A point lies on a circular arc.
        OnArc,
        /// A point lies on a smooth curve, at the place that a shoe tells: two rows.
        OnCurve,
        /// A shoe goes with its pin: two rows.
        Shoe,
        /// Some coordinate tells the place of a mechanism that is let go.
        Pilot,
    }
    joints_let_go {
        Coincide as ReleasedPin,
        OnLine as ReleasedSlot,
        OnArc as ReleasedArcSlot,
        Gears as ReleasedGears,
        Rack as ReleasedRack,
        Belt as ReleasedBelt,
    }
}

impl Joint for Constraint {
    #[inline]
    fn rows(&self) -> usize {
        ask!(self, joint => joint.rows())
    }

    #[inline]
    fn unit(&self) -> Unit {
        ask!(self, joint => joint.unit())
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        ask!(self, joint => joint.touches())
    }

    fn touched(&self) -> Vec<Touch> {
        ask!(self, joint => joint.touched())
    }

    #[inline]
    fn drive(&self) -> Option<DriveId> {
        ask!(self, joint => joint.drive())
    }

    fn pairs(&self) -> Pairs {
        ask!(self, joint => joint.pairs())
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        ask!(self, joint => joint.links(parts))
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        ask!(self, joint => joint.residual(at))
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) -> T {
        ask!(self, joint => joint.gradients(at, emit))
    }

    fn is_reversed<T: Number>(&self, at: &Situation<'_, T>) -> bool {
        ask!(self, joint => joint.is_reversed(at))
    }

    fn is_past_end(&self, at: &Situation<'_, f64>) -> bool {
        ask!(self, joint => joint.is_past_end(at))
    }

    fn pin(&self, body: BodyId) -> Option<(Marker, Marker)> {
        ask!(self, joint => joint.pin(body))
    }

    fn opened(&self) -> Option<Opened> {
        ask!(self, joint => joint.opened())
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        ask!(self, joint => joint.condition(body))
    }

    fn turn(&self, body: BodyId, index: usize) -> Option<Step> {
        ask!(self, joint => joint.turn(body, index))
    }

    fn roll(&self, pin: (Marker, Marker), index: usize) -> Option<Step> {
        ask!(self, joint => joint.roll(pin, index))
    }

    #[inline]
    fn angle<T: Number>(&self, at: &Situation<'_, T>, body: BodyId) -> Option<T> {
        ask!(self, joint => joint.angle(at, body))
    }

    fn isotropic(&self, at: &Situation<'_, f64>, scale: f64) -> Option<Isotropic> {
        ask!(self, joint => joint.isotropic(at, scale))
    }

    fn in_angles(&self, at: &Situation<'_, f64>) -> Option<InAngles> {
        ask!(self, joint => joint.in_angles(at))
    }

    fn counts_turns(&self) -> bool {
        ask!(self, joint => joint.counts_turns())
    }

    fn opened_by(&self, parts: &Parts) -> Vec<(LinkId, LinkId)> {
        ask!(self, joint => joint.opened_by(parts))
    }

    fn needs_pins(&self) -> Option<[Marker; 2]> {
        ask!(self, joint => joint.needs_pins())
    }

    fn load_gradients<T: Number>(&self, at: &Situation<'_, T>, emit: impl FnMut(Gradient<T>)) {
        ask!(self, joint => joint.load_gradients(at, emit))
    }

    fn load_unit(&self) -> Unit {
        ask!(self, joint => joint.load_unit())
    }

    fn load_point(&self, body: BodyId) -> Option<LoadPoint> {
        ask!(self, joint => joint.load_point(body))
    }

    fn load_place<T: Number>(&self, at: &Situation<'_, T>) -> Option<[T; 2]> {
        ask!(self, joint => joint.load_place(at))
    }

    fn rubs(&self) -> Option<Rubs> {
        ask!(self, joint => joint.rubs())
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        ask!(self, joint => joint.sliding(at))
    }
}

impl Constraint {
    /// The bodies it ties; one that it touches twice may come twice.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> {
        self.touched().into_iter().map(Touch::body)
    }
}

impl<T: Number> Situation<'_, T> {
    /// The residual rows of a constraint; only the first [`Joint::rows`] count.
    #[inline]
    pub fn residual(&self, constraint: &Constraint) -> [T; 2] {
        constraint.residual(self)
    }

    /// The derivatives of a constraint's rows, as [`Joint::gradients`] hands them out.
    #[inline]
    pub fn gradients(&self, constraint: &Constraint, emit: impl FnMut(Gradient<T>)) -> T {
        constraint.gradients(self, emit)
    }

    /// Whether a direction points the opposite way: the residual, a sine, does not tell.
    pub fn is_reversed(&self, constraint: &Constraint) -> bool {
        constraint.is_reversed(self)
    }
}
