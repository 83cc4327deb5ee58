//! Between two nodes of a trace: the cubic with their tangents.

use super::node::{Node, norm};

/// Into so many equal parts a step is cut to read off a guess: 2^30.
const PARTS: f64 = 1_073_741_824.0;
/// Steps of Newton's method for one of them.
const ESTIMATES: usize = 8;
/// A step after which the next is well below a part.
const ESTIMATED: f64 = 1e-6;

/// The cubic through two nodes with their tangents.
pub struct Cubic<'a> {
    from: &'a Node,
    to: &'a Node,
    /// Length of the chord.
    h: f64,
}

/// A place on a cubic.
pub struct CubicPoint<'a> {
    cubic: &'a Cubic<'a>,
    weights: [f64; 4],
}

impl<'a> Cubic<'a> {
    /// The cubic from one node to another.
    pub fn new(from: &'a Node, to: &'a Node) -> Self {
        Self {
            from,
            to,
            h: distance(&from.z, &to.z),
        }
    }

    /// Unit vector from the one to the other.
    pub fn chord(&self) -> impl Iterator<Item = f64> {
        let ends = self.from.z.iter().zip(&self.to.z);
        ends.map(|(a, b)| (b - a) / self.h)
    }

    /// The part of the step at which an unknown that rises all along it has the value `wanted`: the middle of one of
    /// `PARTS` equal parts; beyond the ends the first or last of them.
    pub fn part_where(&self, unknown: usize, wanted: f64) -> f64 {
        let below = |part: f64| self.at(part / PARTS).part(unknown) <= wanted;
        // Newton's method tells the part, nearly always, and what it tells is tried.
        let part = (self.estimate(unknown, wanted) * PARTS)
            .clamp(0.0, PARTS - 1.0)
            .floor();
        if (part == 0.0 || below(part)) && (part == PARTS - 1.0 || !below(part + 1.0)) {
            return (part + 0.5) / PARTS;
        }
        let (mut low, mut high) = (0.0, PARTS);
        while high - low > 1.0 {
            let middle = 0.5 * (low + high);
            if below(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high) / PARTS
    }

    /// Newton's method for [`Cubic::part_where`]; NaN where it finds nothing.
    fn estimate(&self, unknown: usize, wanted: f64) -> f64 {
        let [start, end] = [self.from, self.to].map(|node| node.z[unknown]);
        let [first, last] = [self.from, self.to].map(|node| node.tangent[unknown] * self.h);
        let rise = end - start;
        let (square, cube) = (3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise);
        let mut s = (wanted - start) / rise;
        for _ in 0..ESTIMATES {
            let above = start - wanted + s * (first + s * (square + s * cube));
            let step = above / (first + s * (2.0 * square + s * 3.0 * cube));
            s -= step;
            if step.abs() <= ESTIMATED {
                return s;
            }
        }
        f64::NAN
    }

    /// The place at a part `s` of the step.
    pub fn at(&self, s: f64) -> CubicPoint<'_> {
        CubicPoint {
            cubic: self,
            weights: [
                (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s),
                s * s * (3.0 - 2.0 * s),
                s * (1.0 - s) * (1.0 - s) * self.h,
                s * s * (s - 1.0) * self.h,
            ],
        }
    }
}

impl CubicPoint<'_> {
    /// The `i`-th unknown there.
    pub fn part(&self, i: usize) -> f64 {
        let ([a, b, c, d], Cubic { from, to, .. }) = (self.weights, self.cubic);
        a * from.z[i] + b * to.z[i] + c * from.tangent[i] + d * to.tangent[i]
    }

    /// All of them, in the same storage.
    pub fn put(&self, all: &mut Vec<f64>) {
        let ([a, b, c, d], Cubic { from, to, .. }) = (self.weights, self.cubic);
        let ends = from.z.iter().zip(&to.z);
        let tangents = from.tangent.iter().zip(&to.tangent);
        all.clear();
        all.extend((ends.zip(tangents)).map(|((p, q), (r, s))| a * p + b * q + c * r + d * s));
    }
}

/// The cubic through two nodes with their tangents, at a part `s` of the step.
pub fn hermite(from: &Node, to: &Node, s: f64) -> Vec<f64> {
    let cubic = Cubic::new(from, to);
    let place = cubic.at(s);
    (0..from.z.len()).map(|i| place.part(i)).collect()
}

/// Unit vector from one node to the next.
pub fn chord(from: &Node, to: &Node) -> Vec<f64> {
    let mut v: Vec<f64> = from.z.iter().zip(&to.z).map(|(a, b)| b - a).collect();
    let length = norm(&v);
    v.iter_mut().for_each(|x| *x /= length);
    v
}

/// Distance of two lists of scaled unknowns.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (b - a) * (b - a));
    squares.sum::<f64>().sqrt()
}

/// Which two of the rising `places` enclose `p`: the index of the first; beyond the ends the first or last two.
pub fn interval(places: &[f64], p: f64) -> usize {
    places
        .partition_point(|&place| place <= p)
        .clamp(1, places.len().max(2) - 1)
        - 1
}
