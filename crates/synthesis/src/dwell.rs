//! Outputs that rest while a point goes along an arc or a line: levers and sliders at a rod from the point, and levers with a slot for it.
//!
//! While the point stays on a circle, the other end of a rod as long as its radius can rest in the circle's centre; while it stays on a line, a slot along
//! that line can rest. What rests there moves while the point goes elsewhere: by how much, and how well the rod then drives it, is chosen by the place
//! of a lever's pivot, or by the direction of a slider's guide.

use std::f64::consts::{PI, TAU};

use kempe_number::math;

use crate::C;
use crate::one_dimension::{peaks, peaks_around, roots};

mod way;

use way::{Swung, clipped, swung};

/// Directions from the rod's end that are tried, and distances along each.
const DIRECTIONS: usize = 96;
const DISTANCES: usize = 64;
/// Of a way that is given in more places, about so many are looked at while a pivot is searched.
const SEARCHED: usize = 180;
/// A pivot that is nearer to the rod's end, or to the point's way, than this part of the way's size is as good as in it.
const NEAREST: f64 = 0.02;
/// Rod and lever that come nearer to one line than this, rad, jam where anything rubs: 5 deg.
const JAMS: f64 = 0.087;
/// What moves by less than this, rad or in sizes of the way, rests always.
const STILL: f64 = 1e-6;

/// A lever that a rod turns.
#[derive(Clone, Copy, Debug)]
pub struct DwellLever {
    /// Its fixed pivot.
    pub pivot: C,
    /// From the pivot to the rod.
    pub length: f64,
    /// On which side of the line from the pivot to the point the rod's end lies: 1 left, -1 right.
    pub side: f64,
    /// The angle through which it swings in all, rad.
    pub swing: f64,
    /// The least angle between rod and lever, 90 deg being the best, rad.
    pub transmission: f64,
}

impl DwellLever {
    /// The angle of the lever, from its pivot to the end of a rod of a length, where the point is at a place, rad.
    pub fn angle(&self, point: C, rod: f64) -> f64 {
        let off = point - self.pivot;
        let cosine = way::between(off, self.length, rod);
        way::lever(off, cosine, [self.length, rod], self.side).arg()
    }
}

/// A slider that a rod pushes.
#[derive(Clone, Copy, Debug)]
pub struct DwellSlider {
    /// The direction of its guide, which passes through the rod's end; of length one.
    pub direction: C,
    /// Whether the rod's end lies ahead of the point along that direction, or behind it.
    pub ahead: bool,
    /// How far it goes in all.
    pub stroke: f64,
    /// The least angle between the rod and what is square to the guide, rad.
    pub transmission: f64,
}

impl DwellSlider {
    /// How far along its guide, from a centre of it, the end of a rod of a length is where the point is at a place.
    pub fn place(&self, point: C, centre: C, rod: f64) -> f64 {
        let off = (point - centre) * self.direction.conj();
        let root = (rod * rod - off.im * off.im).max(0.0).sqrt();
        if self.ahead {
            off.re + root
        } else {
            off.re - root
        }
    }
}

/// A lever with a slot for the point.
#[derive(Clone, Copy, Debug)]
pub struct DwellSlot {
    /// Its fixed pivot, on the line.
    pub pivot: C,
    /// The angle through which it swings in all, rad.
    pub swing: f64,
    /// How near to the pivot the point comes, and how far from it.
    pub slot: [f64; 2],
}

/// The rest that is asked for: where the point goes in all, and what it stays near to meanwhile.
#[derive(Clone, Copy, Debug)]
pub struct Rest<'a> {
    /// Places of the point over the whole motion, evenly; of a cycle the last is the first.
    pub way: &'a [C],
    /// Its place in the middle of the rest.
    pub middle: C,
}

impl Rest<'_> {
    fn size(&self) -> f64 {
        let Some(first) = self.way.first() else {
            return 0.0;
        };
        self.way
            .iter()
            .fold(0.0, |m, p| m.max((*p - *first).norm()))
    }

    /// Fewer places of the way, both ends among them.
    fn coarse(&self) -> Vec<C> {
        let every = (self.way.len() / SEARCHED).max(1);
        let last = self.way.len().saturating_sub(1);
        let kept = (0..self.way.len()).filter(|k| k % every == 0 || *k == last);
        kept.map(|k| self.way[k]).collect()
    }

    /// The levers whose rod of a length goes from the point to a centre, with pivots within two corners: the best transmission among
    /// its neighbours; with a given swing (rad), the best of these. The best come first.
    pub fn levers(
        &self,
        centre: C,
        rod: f64,
        corners: [C; 2],
        swing: Option<f64>,
    ) -> Vec<DwellLever> {
        let coarse = self.coarse();
        let least = NEAREST * self.size();
        let side = |pivot: C| {
            ((self.middle - pivot).conj() * (centre - pivot))
                .im
                .signum()
        };
        let look =
            |way: &[C], pivot: C| swung(way, pivot, (centre - pivot).norm(), rod, side(pivot));
        let pivot = |direction: f64, distance: f64| centre + C::from_polar(distance, direction);
        // Of a direction the best distance with what a lever does there.
        let best = |way: &[C], direction: f64| -> Option<(f64, Swung)> {
            let [from, to] = clipped(centre, C::from_polar(1.0, direction), corners)?;
            let range = [from.max(least), to];
            let at = |distance: f64| look(way, pivot(direction, distance));
            let found: Vec<f64> = match swing {
                Some(wanted) => roots(range, DISTANCES, &|d| Some(at(d)?.swing - wanted)),
                None => peaks(range, DISTANCES, &|d| Some(at(d)?.spare)),
            };
            let found = found.into_iter().filter_map(|d| Some((d, at(d)?)));
            found.max_by(|a, b| a.1.spare.total_cmp(&b.1.spare))
        };
        let directions = peaks_around([0.0, TAU], DIRECTIONS, &|direction| {
            best(&coarse, direction).map(|(_, it)| it.spare)
        });
        let mut found: Vec<DwellLever> = (directions.into_iter())
            .filter_map(|direction| {
                let (distance, it) = best(self.way, direction)?;
                let moves = it.swing > STILL && it.spare > 1.0 - math::cos(JAMS);
                moves.then(|| DwellLever {
                    pivot: pivot(direction, distance),
                    length: distance,
                    side: side(pivot(direction, distance)),
                    swing: it.swing,
                    transmission: math::acos(1.0 - it.spare),
                })
            })
            .collect();
        found.sort_by(|a, b| b.transmission.total_cmp(&a.transmission));
        // The search goes round: one at its end is one at its start.
        found.dedup_by(|a, b| (a.pivot - b.pivot).norm() < 1e-3 * b.length);
        found
    }

    /// The sliders that a rod of a length moves from a centre: of a given stroke all, else those of the best transmission among their
    /// neighbours. The best come first.
    pub fn sliders(&self, centre: C, rod: f64, stroke: Option<f64>) -> Vec<DwellSlider> {
        let at = |angle: f64| {
            let direction = C::from_polar(1.0, angle);
            DwellSlider {
                direction,
                ahead: ((self.middle - centre) * direction.conj()).re < 0.0,
                stroke: 0.0,
                transmission: 0.0,
            }
        };
        let look = |way: &[C], angle: f64| -> Option<(f64, f64)> {
            let it = at(angle);
            let mut off = 0.0_f64;
            let places = way.iter().map(|place| {
                let aside = ((*place - centre) * it.direction.conj()).im.abs();
                off = off.max(aside);
                it.place(*place, centre, rod)
            });
            let stroke = way::range(&places.collect::<Vec<f64>>());
            (off < rod).then_some((stroke, 1.0 - off / rod))
        };
        let coarse = self.coarse();
        let found = match stroke {
            Some(wanted) => roots([0.0, PI], 2 * DIRECTIONS, &|a| {
                Some(look(self.way, a)?.0 - wanted)
            }),
            None => peaks_around([0.0, PI], 2 * DIRECTIONS, &|a| Some(look(&coarse, a)?.1)),
        };
        let size = self.size();
        let mut found: Vec<DwellSlider> = (found.into_iter())
            .filter_map(|angle| {
                let (stroke, spare) = look(self.way, angle)?;
                let moves = stroke > STILL * size && spare > 1.0 - math::cos(JAMS);
                moves.then(|| DwellSlider {
                    stroke,
                    transmission: math::acos(1.0 - spare),
                    ..at(angle)
                })
            })
            .collect();
        found.sort_by(|a, b| b.transmission.total_cmp(&a.transmission));
        found.dedup_by(|a, b| (a.direction * b.direction.conj()).im.abs() < 1e-3);
        found
    }

    /// The slotted levers of a swing (rad) that rest while the point is on a line, with pivots on that line within two corners; those with
    /// the shortest slot for its nearest end come first.
    pub fn slots(&self, on: C, direction: C, corners: [C; 2], swing: f64) -> Vec<DwellSlot> {
        let least = NEAREST * self.size();
        let Some(range) = clipped(on, direction, corners) else {
            return Vec::new();
        };
        let look = |t: f64| {
            let pivot = on + direction.scale(t);
            way::turned(self.way, pivot).filter(|it| it.slot[0] > least)
        };
        let found = roots(range, 8 * DISTANCES, &|t| Some(look(t)?.swing - swing));
        let mut found: Vec<DwellSlot> = (found.into_iter())
            .filter_map(|t| {
                let it = look(t)?;
                Some(DwellSlot {
                    pivot: on + direction.scale(t),
                    swing: it.swing,
                    slot: it.slot,
                })
            })
            .collect();
        let ratio = |it: &DwellSlot| it.slot[1] / it.slot[0];
        found.sort_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        found
    }
}
