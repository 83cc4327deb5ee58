//! Joints with play in which contact comes and goes: what their bodies do to each other while they touch.
//!
//! Such a joint is let go ([`kempe_mechanism::Mechanism::releasing`]); the coordinates of its rows tell how far it stands open, and
//! indentations come from them, not from small differences of places. Where contact begins and ends is found by the
//! simulation, which knows how fast every contact began.

mod compile;

use kempe_contact::{BlockInGuide, Body, Friction, Normal, PinWithPlay, Touch};
use kempe_mechanism::BodyId;
use kempe_mechanism::structure::Source;
use kempe_model::{DriveId, Touching};
use kempe_number::Number;

use crate::instant::Instant;
use crate::number::ForceNumber;
use crate::wrench::{self, Wrench};

/// What touches.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// A pin in its bore.
    Pin(PinWithPlay<f64>),
    /// A block in its guide.
    Block(BlockInGuide<f64>),
}

/// How the bodies resist each other.
#[derive(Clone, Copy, Debug)]
pub enum Resists {
    /// They give: a force presses while they touch, and friction goes with it.
    ByLaw {
        /// The force that presses.
        normal: Normal<f64>,
        /// The force along the sliding.
        friction: Friction<f64>,
    },
    /// At once. What holds them is the effort of the coordinates.
    AtOnce {
        /// The part of the speed that an impact gives back.
        restitution: f64,
    },
}

/// A joint with play whose bodies touch and part.
#[derive(Clone, Debug)]
pub struct JointContact {
    /// The joint.
    pub joint: Source,
    /// The coordinates of its rows.
    pub along: [DriveId; 2],
    /// How its bodies resist each other.
    pub resists: Resists,
    /// When it touches at every place, in order: one place of a pin, the four corners of a block. Nothing where it resists at once.
    pub touches: Vec<Vec<Touching>>,
    /// The bodies of the bore or guide, and of the pin or block.
    bodies: [BodyId; 2],
    shape: Shape,
}

impl JointContact {
    /// How many places can touch.
    pub fn places(&self) -> usize {
        self.touches.len()
    }

    /// How far it is open at a place, m, where the coordinates of its rows are these.
    pub fn gap<T: Number>(&self, place: usize, open: [T; 2]) -> T {
        match &self.shape {
            Shape::Pin(pin) => pin.lift().gap(open),
            Shape::Block(block) => {
                let [angle, off] = open;
                let (sine, cosine) = angle.sin_cos();
                let gaps = block.lift().gaps(off, [cosine, sine]);
                (gaps.get(place).copied()).unwrap_or_else(|| T::from_f64(f64::NAN))
            }
        }
    }

    /// Where it touches or would touch at an instant, place by place; `visit` is handed the bodies, too.
    fn each_touch<T: ForceNumber>(
        &self,
        at: &Instant<T>,
        mut visit: impl FnMut(usize, &Touch<T>, &[Body<T>; 2]),
    ) {
        let bodies = self.bodies.map(|body| Body {
            pose: at.poses[body.index()],
            motion: at.velocities[body.index()],
        });
        let open = self.along.map(|drive| at.inputs[drive.index()]);
        match &self.shape {
            Shape::Pin(pin) => {
                // The rows tell where the bore's centre is, seen from the pin's.
                let apart = open.map(|row| -row.value);
                visit(0, &pin.lift().touch_at(&bodies, apart), &bodies);
            }
            Shape::Block(block) => {
                let [angle, off] = open;
                let all = (block.lift()).touches_at(&bodies, off.value, [angle.c, angle.s]);
                for (place, touch) in all.iter().enumerate() {
                    visit(place, touch, &bodies);
                }
            }
        }
    }

    /// What it does to its bodies at an instant, about their origins: `add` is called for each.
    pub(crate) fn act<T: ForceNumber>(
        &self,
        at: &Instant<T>,
        mut add: impl FnMut(BodyId, Wrench<T>),
    ) {
        let Resists::ByLaw { normal, friction } = &self.resists else {
            return;
        };
        if (0..self.places()).all(|place| self.began(place, at.time).is_none()) {
            return;
        }
        let (normal, friction) = (normal.lift(), friction.lift());
        self.each_touch(at, |place, touch, bodies| {
            let Some(began) = self.began(place, at.time) else {
                return;
            };
            let forces = touch.forces(&normal, &friction, T::from_f64(began));
            let wrenches = touch.wrenches(bodies, forces);
            for (body, wrench) in self.bodies.iter().zip(wrenches) {
                add(*body, wrench);
            }
        });
    }

    /// How fast the contact at a place began that lasts at a time, as its law counts it, m/s; none where it does not touch.
    fn began(&self, place: usize, time: f64) -> Option<f64> {
        let touches = self.touches.get(place)?;
        let next = touches.partition_point(|touch| touch.from <= time);
        let last = touches.get(next.checked_sub(1)?)?;
        (time < last.to).then_some(last.counts_as)
    }
}

/// Adds what contacts do to the bodies at an instant.
pub(crate) fn act<T: ForceNumber>(
    contacts: &[JointContact],
    at: &Instant<T>,
    on_bodies: &mut [Wrench<T>],
) {
    for contact in contacts {
        contact.act(at, |body, w| wrench::add(&mut on_bodies[body.index()], w));
    }
}
