//! Joints with play in which contact comes and goes: what their bodies do to each other while they touch.
//!
//! Such a joint is let go ([`kempe_mechanism::Mechanism::releasing`]); the coordinates of its rows tell how far it stands open, and
//! indentations come from them, not from small differences of places. Where contact begins and ends is found by the
//! simulation, which knows how fast every contact began.

mod compile;

use kempe_contact::{BlockInGuide, Body, Friction, Normal, Onset, PinWithPlay, Touch};
use kempe_mechanism::constraint::Input;
use kempe_mechanism::structure::Source;
use kempe_mechanism::{BodyId, Pose};
use kempe_model::{DriveId, Touching};
use kempe_number::{Jet, Number};

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
    /// At once. What presses is the effort of the coordinates.
    AtOnce {
        /// The part of the speed that an impact gives back.
        restitution: f64,
        /// The coefficient of friction, which sets in at once.
        friction: f64,
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
    /// The amounts that tell which part of the greatest friction acts at every place, positive where it resists sliding along the slip
    /// ([`Touch::slip`]); none where the sliding speed tells. Where it resists at once they tell the friction itself, N.
    pub parts: Vec<usize>,
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

    /// Whether friction holds what rests: which part of it acts is a matter of the whole mechanism then.
    pub fn sticks(&self) -> bool {
        match &self.resists {
            Resists::ByLaw { friction, .. } => {
                friction.onset == Onset::Sign && friction.kinetic > 0.0
            }
            Resists::AtOnce { friction, .. } => *friction > 0.0,
        }
    }

    /// The coefficient of friction of what resists at once; none of what gives.
    pub fn friction_at_once(&self) -> f64 {
        match self.resists {
            Resists::AtOnce { friction, .. } => friction,
            Resists::ByLaw { .. } => 0.0,
        }
    }

    /// The bodies at an instant.
    fn bodies<T: ForceNumber>(&self, at: &Instant<T>) -> [Body<T>; 2] {
        self.bodies.map(|body| Body {
            pose: at.poses[body.index()],
            motion: at.velocities[body.index()],
        })
    }

    /// Where it touches or would touch, place by place, where the coordinates of its rows are these.
    fn each_touch<T: Number>(
        &self,
        bodies: &[Body<T>; 2],
        open: [Input<T>; 2],
        mut visit: impl FnMut(usize, &Touch<T>),
    ) {
        match &self.shape {
            Shape::Pin(pin) => {
                // The rows tell where the bore's centre is, seen from the pin's.
                let apart = open.map(|row| -row.value);
                visit(0, &pin.lift().touch_at(bodies, apart));
            }
            Shape::Block(block) => {
                let [angle, off] = open;
                let all = (block.lift()).touches_at(bodies, off.value, [angle.c, angle.s]);
                for (place, touch) in all.iter().enumerate() {
                    visit(place, touch);
                }
            }
        }
    }

    /// How its bodies slide over each other at a place that touches, with the accelerations at an instant, by the coordinates of some drives;
    /// nothing where it gives and does not touch. What presses where it resists at once is not known here: the limit is that of 1 N.
    pub fn slides(&self, place: usize, at: &Instant<f64>, drives: &[DriveId]) -> Option<Slides> {
        let began = match self.resists {
            Resists::ByLaw { .. } => self.began(place, at.time)?,
            Resists::AtOnce { .. } => 0.0,
        };
        let limit_at = |touch: &Touch<Jet<f64, 2>>| match &self.resists {
            Resists::ByLaw { normal, friction } => {
                friction.kinetic * normal.force(-touch.gap.value(), touch.approach.value(), began)
            }
            Resists::AtOnce { friction, .. } => *friction,
        };
        let bodies = self.bodies.map(|body| in_time(at, body));
        let open = self.along.map(|drive| {
            let (input, speed) = (&at.inputs[drive.index()], at.drive_speeds[drive.index()]);
            Input {
                c: Jet::from_coefficients([input.c, -input.s * speed]),
                s: Jet::from_coefficients([input.s, input.c * speed]),
                value: Jet::from_coefficients([input.value, speed]),
            }
        });
        let mut found = None;
        self.each_touch(&bodies, open, |k, touch| {
            if k == place {
                found = Some((*touch.slip.coefficients(), limit_at(touch)));
            }
        });
        let ([speed, gain], limit) = found?;
        let open = self.along.map(|drive| at.inputs[drive.index()]);
        let slope = |drive: &DriveId| {
            let coefficients = &at.coefficients[drive.index()];
            let bodies = self.bodies.map(|body| Body {
                pose: at.poses[body.index()],
                motion: coefficients[body.index()],
            });
            let mut slope = 0.0;
            self.each_touch(&bodies, open, |k, touch| {
                if k == place {
                    slope = touch.slip;
                }
            });
            slope
        };
        Some(Slides {
            speed,
            gain,
            limit,
            gradient: drives.iter().map(slope).collect(),
        })
    }

    /// What it does to its bodies at an instant, about their origins: `add` is called for each.
    pub(crate) fn act<T: ForceNumber>(
        &self,
        at: &Instant<T>,
        mut add: impl FnMut(BodyId, Wrench<T>),
    ) {
        let Resists::ByLaw { normal, friction } = &self.resists else {
            return self.rub(at, add);
        };
        if (0..self.places()).all(|place| self.began(place, at.time).is_none()) {
            return;
        }
        let (normal, friction) = (normal.lift(), friction.lift());
        let bodies = self.bodies(at);
        let open = self.along.map(|drive| at.inputs[drive.index()]);
        self.each_touch(&bodies, open, |place, touch| {
            let Some(began) = self.began(place, at.time) else {
                return;
            };
            let [pressing, by_speed] = touch.forces(&normal, &friction, T::from_f64(began));
            let along = match self.parts.get(place) {
                Some(part) => -(at.amounts[*part] * friction.kinetic * pressing),
                None => by_speed,
            };
            let wrenches = touch.wrenches(&bodies, [pressing, along]);
            for (body, wrench) in self.bodies.iter().zip(wrenches) {
                add(*body, wrench);
            }
        });
    }

    /// What friction does to its bodies where it resists at once.
    fn rub<T: ForceNumber>(&self, at: &Instant<T>, mut add: impl FnMut(BodyId, Wrench<T>)) {
        if self.parts.is_empty() {
            return;
        }
        let bodies = self.bodies(at);
        let open = self.along.map(|drive| at.inputs[drive.index()]);
        self.each_touch(&bodies, open, |place, touch| {
            let resists = self.parts.get(place).map(|part| at.amounts[*part]);
            let along = resists.map_or_else(T::zero, |resists| -resists);
            let wrenches = touch.wrenches(&bodies, [T::zero(), along]);
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

/// How bodies slide over each other where they touch.
#[derive(Clone, Debug)]
pub struct Slides {
    /// How fast, m/s: see [`Touch::slip`].
    pub speed: f64,
    /// The rate of that, m/s^2.
    pub gain: f64,
    /// The greatest friction, N.
    pub limit: f64,
    /// Derivatives of the speed to those of the drives' coordinates.
    pub gradient: Vec<f64>,
}

/// A body as it moves and accelerates at an instant.
fn in_time(at: &Instant<f64>, body: BodyId) -> Body<Jet<f64, 2>> {
    let (pose, velocity) = (&at.poses[body.index()], at.velocities[body.index()]);
    let acceleration = at.accelerations[body.index()];
    let series = |value: f64, rate: f64| Jet::from_coefficients([value, rate]);
    let [x, y, turning] = velocity;
    Body {
        pose: Pose {
            x: series(pose.x, x),
            y: series(pose.y, y),
            c: series(pose.c, -pose.s * turning),
            s: series(pose.s, pose.c * turning),
        },
        motion: [0, 1, 2].map(|k| series(velocity[k], acceleration[k])),
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
