//! Edges towards which a function is steep without bound, as an angle is where a linkage locks.
//!
//! There a function goes with the root of the distance, and its slope is what leads along the edge and a part across it that grows with the root's inverse.
//! What two places on a way to the edge have more and less of is across alone, so that the edge's normal is known from exact slopes: what holds a design
//! along such an edge is the small difference of large numbers, which a normal by differences of places would not tell.

use super::edge::Edge;
use super::local::{Local, Of, Part};
use super::search::Search;
use super::vector::{along, dot, length};

/// Of two distances to the edge the nearer is so many times less; the slope of a root is the root of that steeper, more or less.
const NEARER: f64 = 1e-2;
const STEEPER: [f64; 2] = [5.0, 20.0];
/// Slopes of less than this, in scales, are not steep: a normal by differences tells what is left of them.
const STEEP: f64 = 10.0;
/// The normal leads out along the way by at least this part.
const LEADS_OUT: f64 = 0.05;
/// What a place is worth at its end is asked so far from the edge, in parts of the box.
const CLOSE: f64 = 1e-8;

impl Search<'_> {
    /// The edge's normal at a place on it, from where a way leads out, by a place so far inside of it on that way; `None` where nothing is steep towards it.
    pub fn steep_normal(
        &mut self,
        inside: &Local,
        (on_edge, out, far): (&[f64], &[f64], f64),
    ) -> Option<Vec<f64>> {
        if !is_steep(inside) {
            return None;
        }
        let nearer = along(on_edge, out, -NEARER * far);
        let nearer = self.at(self.space.design(&nearer))?;
        let gains = steepest(inside).into_iter().filter_map(|a| {
            let all = steepest(&nearer);
            let b = all.into_iter().find(|b| b.of == a.of)?;
            let steeper = length(&b.slope) / length(&a.slope);
            let is_root = STEEPER[0] < steeper && steeper < STEEPER[1];
            let gain = b.slope.iter().zip(&a.slope).map(|(b, a)| b - a);
            is_root.then(|| gain.collect::<Vec<f64>>())
        });
        let gain = gains.max_by(|a, b| length(a).total_cmp(&length(b)))?;
        let outwards = dot(&gain, out);
        let size = dot(&gain, &gain).sqrt().copysign(outwards);
        (outwards / size > LEADS_OUT).then(|| gain.iter().map(|x| x / size).collect())
    }

    /// The place closest to an edge that holds a place, with the edge as slopes have it there; `None` where nothing is steep towards it.
    pub fn close_to_edge(&mut self, place: &Local) -> Option<Local> {
        if !is_steep(place) {
            return None;
        }
        let (from, out, t) = self.way_out(place)?;
        let close = along(&from, &out, t - CLOSE);
        let close = self.at(self.space.design(&close))?;
        let on_edge = along(&from, &out, t);
        let normal = self.steep_normal(&close, (&on_edge, &out, CLOSE))?;
        let edge = Edge {
            normal,
            at: on_edge,
        };
        Some(close.beside(Some(edge), &self.space))
    }
}

/// Whether a function may be steep without bound here.
fn is_steep(place: &Local) -> bool {
    let mut own = place.parts.iter().filter(|part| part.of != Of::Edge);
    own.any(|part| length(&part.slope) > STEEP)
}

/// The steepest part of every function.
fn steepest(place: &Local) -> Vec<&Part> {
    let mut all: Vec<&Part> = place
        .parts
        .iter()
        .filter(|part| part.of != Of::Edge)
        .collect();
    all.sort_by(|a, b| length(&b.slope).total_cmp(&length(&a.slope)));
    let mut known: Vec<Of> = Vec::new();
    all.retain(|part| {
        let is_new = !known.contains(&part.of);
        known.push(part.of);
        is_new
    });
    all
}
