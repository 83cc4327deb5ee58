//! What a lever does as a point goes its way.

use kempe_number::math;

use crate::C;

/// What a lever does that a rod turns.
#[derive(Clone, Copy)]
pub(super) struct Swung {
    /// The angle through which it swings, rad.
    pub swing: f64,
    /// One less the greatest cosine of the angle between rod and lever: 0 where they come into line, 1 where they stay square.
    pub spare: f64,
}

/// A lever of a length that a rod of a length turns, on one side of the line from its pivot to the point (1 left of it, -1 right); `None` where
/// the two do not reach the point, come into line, or the lever goes round.
pub(super) fn swung(way: &[C], pivot: C, length: f64, rod: f64, side: f64) -> Option<Swung> {
    let mut greatest = 0.0_f64;
    let mut angles = Angles::default();
    for place in way {
        let off = *place - pivot;
        let cosine = between(off, length, rod);
        greatest = greatest.max(cosine.abs());
        // A NaN is none, either.
        if !(greatest < 1.0) {
            return None;
        }
        angles.push(lever(off, cosine, [length, rod], side));
    }
    Some(Swung {
        swing: angles.swing()?,
        spare: 1.0 - greatest,
    })
}

/// The cosine of the angle between rod and lever, of the triangle that they make with the way from the pivot to the point.
pub(super) fn between(off: C, length: f64, rod: f64) -> f64 {
    (rod * rod + length * length - off.norm_sqr()) / (2.0 * rod * length)
}

/// The direction of a lever from its pivot, from which the point is so far off; not of length one.
pub(super) fn lever(off: C, cosine: f64, [length, rod]: [f64; 2], side: f64) -> C {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    off * C::new(length - rod * cosine, side * rod * sine)
}

/// What a lever does whose slot the point goes along.
pub(super) struct Turned {
    /// The angle through which it swings, rad.
    pub swing: f64,
    /// How near to its pivot the point comes, and how far from it.
    pub slot: [f64; 2],
}

/// A slotted lever; `None` where it goes round.
pub(super) fn turned(way: &[C], pivot: C) -> Option<Turned> {
    let mut angles = Angles::default();
    let mut slot = [f64::INFINITY, 0.0_f64];
    for place in way {
        let off = *place - pivot;
        let far = off.norm();
        slot = [slot[0].min(far), slot[1].max(far)];
        angles.push(off);
    }
    Some(Turned {
        swing: angles.swing()?,
        slot,
    })
}

/// Directions one after the other, whose angles go on from each to the next.
#[derive(Default)]
struct Angles {
    last: Option<C>,
    angles: Vec<f64>,
}

impl Angles {
    fn push(&mut self, direction: C) {
        let on = match (self.last, self.angles.last()) {
            (Some(last), Some(angle)) => {
                let step = direction * last.conj();
                angle + math::atan2(step.im, step.re)
            }
            _ => 0.0,
        };
        self.last = Some(direction);
        self.angles.push(on);
    }

    /// The range of the angles; `None` of half a turn and more.
    fn swing(&self) -> Option<f64> {
        let swing = range(&self.angles);
        (swing < std::f64::consts::PI).then_some(swing)
    }
}

/// From the least to the greatest of a smooth function's samples, and between these by parabolas.
pub(super) fn range(samples: &[f64]) -> f64 {
    let beyond = |k: usize| -> Option<f64> {
        let before = samples.get(k.checked_sub(1)?)?;
        let (at, after) = (samples.get(k)?, samples.get(k + 1)?);
        let (slope, bend) = (0.5 * (after - before), after - 2.0 * at + before);
        (bend != 0.0).then(|| (0.5 * slope * slope / bend).abs())
    };
    let most = |sense: f64| {
        let worth = |k: &usize| sense * samples[*k];
        let most = (0..samples.len()).max_by(|a, b| worth(a).total_cmp(&worth(b)));
        most.map_or(0.0, |k| worth(&k) + beyond(k).unwrap_or(0.0))
    };
    most(1.0) + most(-1.0)
}

/// The part of a ray that lies within two corners of a box, in lengths of its direction.
pub(super) fn clipped(from: C, direction: C, corners: [C; 2]) -> Option<[f64; 2]> {
    let [a, b] = corners;
    let bounds = [
        (from.re, direction.re, a.re.min(b.re), a.re.max(b.re)),
        (from.im, direction.im, a.im.min(b.im), a.im.max(b.im)),
    ];
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for (start, step, least, most) in bounds {
        if step == 0.0 {
            if !(least..=most).contains(&start) {
                return None;
            }
            continue;
        }
        let ends = [(least - start) / step, (most - start) / step];
        low = low.max(ends[0].min(ends[1]));
        high = high.min(ends[0].max(ends[1]));
    }
    (low < high).then_some([low, high])
}
