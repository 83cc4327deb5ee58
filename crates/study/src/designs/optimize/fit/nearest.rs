//! Where places are met that are met wherever is nearest: in their order, or each by itself.

use std::collections::VecDeque;

use super::met::{Given, Met, Moving, dot, miss, square};
use super::order::{Assigned, Costs};
use super::way::{Here, Way};

/// So many of the nearest segments are looked at for a place that is met by itself.
const CANDIDATES: usize = 3;
/// Steps in which a place is closed in on.
const STEPS: usize = 60;
/// What misses along the way by no more than this part of all misses, or of the sizes at hand, is met where the way passes, not where it turns back.
const PASSES: f64 = 1e-3;
const ROUNDING: f64 = 1e-9;
/// A step below this part of a segment ends that.
const CLOSE: f64 = 1e-13;

/// The way at even places.
pub(super) struct Nodes {
    pub here: Vec<Here>,
    pub step: f64,
}

impl Nodes {
    /// So many segments, and both ends.
    pub fn new(way: &mut Way, segments: usize) -> Option<Self> {
        let step = way.end() / segments as f64;
        let here: Vec<Here> = (0..=segments)
            .map(|k| match way.closed && k == segments {
                // The same place as at the start.
                true => way.here(0.0),
                false => way.here(step * k as f64),
            })
            .collect();
        let sound = |h: &Here| h.at.iter().all(|x| x.is_finite());
        here.iter().all(sound).then_some(Self { here, step })
    }

    pub fn segments(&self) -> usize {
        self.here.len() - 1
    }
}

/// How far along a segment a place is nearest, and the square of its distance there; the segment is straight.
fn on_segment(nodes: &Nodes, segment: usize, given: &Given, place: usize) -> (f64, f64) {
    let [a, b] = [segment, segment + 1].map(|k| nodes.here[k].at);
    let from = miss(&a, given, place);
    // Angles go on over the segment.
    let along = [b[0] - a[0], b[1] - a[1], given.turned(b[2] - a[2])];
    let length = square(&along);
    let part = match length > 0.0 {
        true => -dot(&from, &along) / length,
        false => 0.0,
    };
    let part = part.clamp(0.0, 1.0);
    let at = [0, 1, 2].map(|k| from[k] + part * along[k]);
    (part, square(&at))
}

/// The places of a way nearest to the given ones, in their order.
pub(super) fn ordered(way: &mut Way, nodes: &Nodes, given: &Given) -> Met {
    let (n, segments) = (given.places.len(), nodes.segments());
    let costs = Costs::new(n, segments, |i, k| on_segment(nodes, k, given, i).1);
    let (assigned, turned) = match way.closed {
        false => (costs.open(), false),
        true => {
            let (one, other) = (costs.closed(), costs.turned().closed());
            match other.cost < one.cost {
                true => (other, true),
                false => (one, false),
            }
        }
    };
    let order: Vec<usize> = match turned {
        true => (0..n).rev().collect(),
        false => (0..n).collect(),
    };
    refined(way, nodes, given, &assigned, &order)
}

/// Places that are met together, as their order asks.
struct Block {
    places: Vec<usize>,
    between: [f64; 2],
    u: f64,
}

impl Block {
    /// Both in one, this one first, in the middle of their places.
    fn with(self, next: Self) -> Self {
        let (a, b) = (self.places.len() as f64, next.places.len() as f64);
        Self {
            u: (self.u * a + next.u * b) / (a + b),
            between: [
                self.between[0].min(next.between[0]),
                self.between[1].max(next.between[1]),
            ],
            places: [self.places, next.places].concat(),
        }
    }

    /// The same so much farther along the way.
    fn ahead(self, by: f64) -> Self {
        Self {
            u: self.u + by,
            between: self.between.map(|end| end + by),
            places: self.places,
        }
    }
}

/// Closes in on the places, in this order; those that would pass each other are met in one place, on a closed way the last and the first, too.
fn refined(
    way: &mut Way,
    nodes: &Nodes,
    given: &Given,
    assigned: &Assigned,
    order: &[usize],
) -> Met {
    let mut blocks: VecDeque<Block> = VecDeque::new();
    // Behind all that are there, with those that it would pass.
    let put = |way: &mut Way, blocks: &mut VecDeque<Block>, mut block: Block| {
        close_in(way, nodes, given, &mut block);
        while let Some(last) = blocks.pop_back_if(|last| last.u > block.u) {
            block = last.with(block);
            close_in(way, nodes, given, &mut block);
        }
        blocks.push_back(block);
    };
    for (segment, place) in assigned.segments.iter().zip(order) {
        let (part, _) = on_segment(nodes, segment % nodes.segments(), given, *place);
        let low = *segment as f64 - 1.0;
        let block = Block {
            places: vec![*place],
            between: [low * nodes.step, (low + 3.0) * nodes.step],
            u: (*segment as f64 + part) * nodes.step,
        };
        put(way, &mut blocks, block);
    }
    let turn = way.end();
    let passes = |blocks: &VecDeque<Block>| match (blocks.front(), blocks.back()) {
        (Some(first), Some(last)) => blocks.len() > 1 && last.u > first.u + turn,
        _ => false,
    };
    while way.closed && passes(&blocks) {
        let (first, last) = (blocks.pop_front(), blocks.pop_back());
        if let (Some(first), Some(last)) = (first, last) {
            put(way, &mut blocks, last.with(first.ahead(turn)));
        }
    }
    let mut met = Met::new(given.places.len());
    for block in blocks {
        met.put(way, given, block.u, &block.places);
    }
    met
}

/// Where on its stretch a block is nearest.
fn close_in(way: &mut Way, nodes: &Nodes, given: &Given, block: &mut Block) {
    let [mut low, mut high] = block.between;
    if !way.closed {
        (low, high) = (low.max(0.0), high.min(way.end()));
    }
    let mut u = block.u.clamp(low, high);
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..STEPS {
        let here = way.here(u);
        // Half the slope of the sum of squares, and its curvature where the misses are small.
        let mut slope = 0.0;
        for place in &block.places {
            slope += dot(&miss(&here.at, given, *place), &here.rate);
        }
        let small = block.places.len() as f64 * square(&here.rate);
        match slope > 0.0 {
            true => high = u,
            false => low = u,
        }
        let secant = before.map(|(v, other)| (slope - other) / (u - v));
        let curvature = secant.filter(|c| *c > 0.05 * small).unwrap_or(small);
        let mut next = u - slope / curvature;
        if !(next > low && next < high) {
            // An end of the stretch may be nearest itself.
            next = match slope > 0.0 {
                true => low + 0.1 * (u - low),
                false => high - 0.1 * (high - u),
            };
        }
        let done = (next - u).abs() <= CLOSE * nodes.step || high - low <= CLOSE * nodes.step;
        before = Some((u, slope));
        u = next;
        if done {
            break;
        }
    }
    // As near to an end of an open way as counting goes is the end.
    let near = 1e-9 * nodes.step;
    if !way.closed {
        if u <= near {
            u = 0.0;
        } else if u >= way.end() - near {
            u = way.end();
        }
    }
    block.u = u;
}

/// The places of a way nearest to the given ones, whatever their order.
pub(super) fn each(way: &mut Way, nodes: &Nodes, given: &Given) -> Met {
    let count = nodes.segments();
    let mut met = Met::new(given.places.len());
    for place in 0..given.places.len() {
        let all: Vec<(f64, f64)> = (0..count)
            .map(|k| on_segment(nodes, k, given, place))
            .collect();
        let at = |k: usize| all[k].1;
        let is_low = |k: &usize| {
            let before = match (*k, way.closed) {
                (0, false) => f64::INFINITY,
                (0, true) => at(count - 1),
                _ => at(k - 1),
            };
            let after = match (k + 1 == count, way.closed) {
                (true, false) => f64::INFINITY,
                (true, true) => at(0),
                _ => at(k + 1),
            };
            at(*k) <= before && at(*k) <= after
        };
        let mut low: Vec<usize> = (0..count).filter(is_low).collect();
        low.sort_by(|a, b| at(*a).total_cmp(&at(*b)));
        let mut best: Option<(f64, f64)> = None;
        for segment in low.into_iter().take(CANDIDATES) {
            let from = segment as f64 - 1.0;
            let mut block = Block {
                places: vec![place],
                between: [from * nodes.step, (from + 3.0) * nodes.step],
                u: (segment as f64 + all[segment].0) * nodes.step,
            };
            close_in(way, nodes, given, &mut block);
            let there = square(&miss(&way.here(block.u).at, given, place));
            if best.is_none_or(|(_, other)| there < other) {
                best = Some((block.u, there));
            }
        }
        if let Some((u, _)) = best {
            met.put(way, given, u, &[place]);
        }
    }
    met
}

impl Met {
    /// Meets places at one place of the way, which is free to move along it unless it is an end or the way turns back there: it has no direction then, and what
    /// is missed is missed along it, too.
    fn put(&mut self, way: &mut Way, given: &Given, u: f64, places: &[usize]) {
        let at_end = !way.closed && (u <= 0.0 || u >= way.end());
        let here = way.here(u);
        for place in places {
            self.at[*place] = way.within(u);
            self.misses[*place] = miss(&here.at, given, *place);
            self.moving[*place] = if at_end { Moving::End } else { Moving::Held };
        }
        let own = square(&here.rate);
        if !at_end && own > 0.0 && own.is_finite() {
            let size = (own * places.len() as f64).sqrt();
            let tangent = here.rate.map(|x| x / size);
            let misses = || places.iter().map(|place| &self.misses[*place]);
            let along: f64 = misses().map(|miss| dot(miss, &tangent)).sum();
            let missed = misses().map(square).sum::<f64>().sqrt();
            if along.abs() <= PASSES * missed + ROUNDING * square(&here.at).sqrt() {
                self.free
                    .push(places.iter().map(|place| (*place, tangent)).collect());
            }
        }
    }
}
