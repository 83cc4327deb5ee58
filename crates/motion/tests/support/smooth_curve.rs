//! Smooth curves through points by another way than the product's: slopes at the points from a dense system.

use super::{V, add, cross, norm, sub, times};

/// A cubic spline over the length of its chords.
pub struct SmoothCurve {
    knots: Vec<f64>,
    points: Vec<V>,
    slopes: Vec<V>,
    closed: bool,
}

impl SmoothCurve {
    pub fn through(points: &[V], closed: bool) -> Self {
        let mut points = points.to_vec();
        if closed {
            points.push(points[0]);
        }
        let n = points.len();
        let mut knots = vec![0.0];
        for k in 1..n {
            knots.push(knots[k - 1] + norm(sub(points[k], points[k - 1])));
        }
        let chord = |k: usize| {
            times(
                sub(points[k + 1], points[k]),
                1.0 / (knots[k + 1] - knots[k]),
            )
        };
        let h = |k: usize| knots[k + 1] - knots[k];
        // A piece's second derivative at its ends, as factors of its slopes and its chord.
        let start = |k: usize| (-4.0 / h(k), -2.0 / h(k), 6.0 / h(k));
        let end = |k: usize| (2.0 / h(k), 4.0 / h(k), -6.0 / h(k));
        // Its third derivative.
        let third = |k: usize| (6.0 / h(k).powi(2), 6.0 / h(k).powi(2), -12.0 / h(k).powi(2));
        let (mut a, mut b) = (vec![vec![0.0; n]; n], vec![[0.0; 2]; n]);
        let mut same = |row: usize,
                        (k, of_k): (usize, (f64, f64, f64)),
                        (l, of_l): (usize, (f64, f64, f64))| {
            a[row][k] += of_k.0;
            a[row][k + 1] += of_k.1;
            a[row][l] -= of_l.0;
            a[row][l + 1] -= of_l.1;
            b[row] = sub(times(chord(l), of_l.2), times(chord(k), of_k.2));
        };
        for k in 1..n - 1 {
            same(k, (k - 1, end(k - 1)), (k, start(k)));
        }
        if closed {
            same(0, (n - 2, end(n - 2)), (0, start(0)));
            (a[n - 1][0], a[n - 1][n - 1]) = (1.0, -1.0);
        } else if n > 3 {
            same(0, (0, third(0)), (1, third(1)));
            same(n - 1, (n - 3, third(n - 3)), (n - 2, third(n - 2)));
        } else {
            // The parabola: no third derivative at either piece.
            same(0, (0, third(0)), (1, (0.0, 0.0, 0.0)));
            same(n - 1, (n - 2, third(n - 2)), (0, (0.0, 0.0, 0.0)));
        }
        let slopes = solved(a, b);
        Self {
            knots,
            points,
            slopes,
            closed,
        }
    }

    /// How many pieces it has.
    pub fn pieces(&self) -> usize {
        self.knots.len() - 1
    }

    /// Place and tangent on a piece, at a part of it.
    pub fn at(&self, piece: usize, part: f64) -> (V, V) {
        let h = self.knots[piece + 1] - self.knots[piece];
        let (p, q) = (self.points[piece], self.points[piece + 1]);
        let (v, w) = (
            times(self.slopes[piece], h),
            times(self.slopes[piece + 1], h),
        );
        let t = part;
        let sum = |f: [f64; 4]| {
            add(
                add(times(p, f[0]), times(v, f[1])),
                add(times(q, f[2]), times(w, f[3])),
            )
        };
        let place = sum([
            (1.0 + 2.0 * t) * (1.0 - t).powi(2),
            t * (1.0 - t).powi(2),
            t * t * (3.0 - 2.0 * t),
            t * t * (t - 1.0),
        ]);
        let tangent = sum([
            6.0 * t * (t - 1.0),
            (1.0 - t) * (1.0 - 3.0 * t),
            6.0 * t * (1.0 - t),
            t * (3.0 * t - 2.0),
        ]);
        (place, times(tangent, 1.0 / h))
    }

    /// How far a point lies on the left of the curve; the end pieces of an open one go on.
    pub fn distance(&self, from: V) -> f64 {
        let (piece, t) = self.nearest(from);
        let (place, tangent) = self.at(piece, t);
        let off = sub(from, place);
        cross(tangent, off).signum() * norm(off)
    }

    /// Whether the place nearest to a point is beyond the ends of an open curve.
    pub fn is_left(&self, from: V) -> bool {
        let (piece, t) = self.nearest(from);
        !self.closed && (piece == 0 && t < 0.0 || piece + 1 == self.pieces() && t > 1.0)
    }

    /// Piece and part of it where the curve is nearest to a point.
    fn nearest(&self, from: V) -> (usize, f64) {
        const SAMPLES: i32 = 40;
        let pieces = self.pieces() as i32;
        let step = 1.0 / f64::from(SAMPLES);
        let apart = |along: f64| {
            let (piece, part) = self.spot(along);
            norm(sub(self.at(piece, part).0, from))
        };
        let mut samples: Vec<f64> = (-1..=pieces * SAMPLES + 1)
            .map(|k| f64::from(k) * step)
            .collect();
        if !self.closed {
            // Beyond the ends in growing steps, a thousand pieces far.
            let mut beyond = 2.0 * step;
            while beyond < 1e3 {
                samples.extend([-beyond, f64::from(pieces) + beyond]);
                beyond *= 1.03;
            }
            samples.sort_by(f64::total_cmp);
        }
        let inner = 1..samples.len() - 1;
        let best = inner.min_by(|a, b| apart(samples[*a]).total_cmp(&apart(samples[*b])));
        let best = best.unwrap_or(1);
        let (mut a, mut b) = (samples[best - 1], samples[best + 1]);
        for _ in 0..120 {
            let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
            if apart(c) < apart(d) {
                b = d;
            } else {
                a = c;
            }
        }
        self.spot(0.5 * (a + b))
    }

    /// The piece so many pieces along the curve, and the part of it; the end pieces of an open curve go on.
    fn spot(&self, along: f64) -> (usize, f64) {
        let pieces = self.pieces() as f64;
        let along = if self.closed {
            along.rem_euclid(pieces)
        } else {
            along
        };
        let piece = along.floor().clamp(0.0, pieces - 1.0);
        (piece as usize, along - piece)
    }
}

/// Gauss's elimination with pivots.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<V>) -> Vec<V> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()));
        let pivot = pivot.unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in 0..n {
            if i == k {
                continue;
            }
            let factor = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= factor * a[k][j];
            }
            b[i] = sub(b[i], times(b[k], factor));
        }
    }
    (0..n).map(|k| times(b[k], 1.0 / a[k][k])).collect()
}
