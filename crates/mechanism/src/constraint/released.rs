//! A row of a joint that is let go: it is held at the coordinate of a drive in place of zero, or moves freely, by whatever
//! that coordinate does.
//!
//! What the drive gives then is what the row carried: the load of a joint is the generalised force of the coordinate that
//! lets it go.

use kempe_model::{DriveId, LinkId};
use kempe_number::Number;

use super::isotropic::Isotropic;
use super::joint::{Gradient, InAngles, Joint, Opened, Pairs, Touch, Unit};
use super::loads::{LoadPoint, Rubs, Sliding};
use super::situation::Situation;
use crate::ids::BodyId;
use crate::parts::Parts;
use crate::step::Condition;

/// One row of a joint, off by the coordinate of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Released<J> {
    /// The joint.
    pub joint: J,
    /// Which of its rows.
    pub row: u8,
    /// The drive whose coordinate the row has, in the row's unit.
    pub input: DriveId,
}

impl<J: Joint> Joint for Released<J> {
    fn unit(&self) -> Unit {
        self.joint.unit()
    }

    fn touches(&self) -> [Option<Touch>; 3] {
        self.joint.touches()
    }

    fn drive(&self) -> Option<DriveId> {
        Some(self.input)
    }

    fn pairs(&self) -> Pairs {
        Pairs::default()
    }

    fn links(&self, parts: &Parts) -> Vec<LinkId> {
        self.joint.links(parts)
    }

    #[inline]
    fn residual<T: Number>(&self, at: &Situation<'_, T>) -> [T; 2] {
        let row = self.joint.openings(at)[usize::from(self.row)];
        [row - at.inputs[self.input.index()].value, T::zero()]
    }

    #[inline]
    fn gradients<T: Number>(&self, at: &Situation<'_, T>, mut emit: impl FnMut(Gradient<T>)) -> T {
        self.joint.opening_gradients(at, |gradient| {
            if gradient.row == usize::from(self.row) {
                emit(Gradient { row: 0, ..gradient });
            }
        });
        -T::one()
    }

    /// Never: assemblies are those of the joint that holds.
    fn isotropic(&self, _: &Situation<'_, f64>, _: f64) -> Option<Isotropic> {
        None
    }

    fn in_angles(&self, at: &Situation<'_, f64>) -> Option<InAngles> {
        let it = self.joint.in_angles(at)?;
        Some(InAngles {
            constant: it.constant + at.inputs[self.input.index()].value,
            ..it
        })
    }

    fn opened(&self) -> Option<Opened> {
        // A pin's two rows are along the frame's axes, whichever of its bodies asks.
        let [Some(Touch::Point(a)), Some(Touch::Point(b)), None] = self.joint.touches() else {
            return None;
        };
        self.joint.pin(b.body).map(|_| Opened {
            pin: [a, b],
            row: self.row,
            input: self.input,
        })
    }

    fn condition(&self, body: BodyId) -> Option<Condition> {
        let input = self.input;
        match self.joint.condition(body)? {
            Condition::OnLine { own, line } => Some(Condition::BesideLine { own, line, input }),
            Condition::Through { line, point } => {
                Some(Condition::LineBeside { line, point, input })
            }
            _ => None,
        }
    }

    fn counts_turns(&self) -> bool {
        self.joint.counts_turns()
    }

    fn load_point(&self, body: BodyId) -> Option<LoadPoint> {
        self.joint.load_point(body)
    }

    fn load_place<T: Number>(&self, at: &Situation<'_, T>) -> Option<[T; 2]> {
        self.joint.load_place(at)
    }

    /// Pins and guides rub where they stand open as where they do not: what holds them there is their load, and a pin's second row
    /// follows its first. Teeth do not: a row of angles carries a moment, not the force between them.
    fn rubs(&self) -> Option<Rubs> {
        let rubs = self.joint.rubs().filter(|_| self.row == 0);
        rubs.filter(|rubs| matches!(rubs, Rubs::AboutPin | Rubs::AlongGuide))
    }

    fn sliding<T: Number>(&self, at: &Situation<'_, T>) -> Option<Sliding<T>> {
        self.joint.sliding(at)
    }
}
