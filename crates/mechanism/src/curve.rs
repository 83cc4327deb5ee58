//! Smooth curves through points of a body: closed or open cubic splines.
//!
//! The parameter of a spline is the length of its chords: splines over it come near the shape that the points are taken from
//! with the fourth power of their distance, however unevenly they are spread (M. S. Floater, 2008: Chordal cubic spline
//! interpolation is fourth-order accurate). Place, tangent and curvature are continuous, so accelerations and reactions
//! are; the jerk jumps at the points.
//!
//! A place on the curve is told by the direction of a shoe (E. J. Haug, 1989, gives a point follower the parameter of its
//! curve for a coordinate of its own). A turn of it leads once round a closed curve. On an open one the half turn from -90
//! to 90 degrees leads from end to end, and the cubics of the end pieces go on beyond.

use std::f64::consts::TAU;

use kempe_model::spline::{closed_moments, moments, piece};
use kempe_number::{Number, math, piecewise};

use crate::pose::{Pose, dot, sub};

/// A cubic in x and y by rising powers.
type Cubic<T> = [[T; 4]; 2];

/// A place of a curve and its derivative to the angle of the shoe there, m and m/rad.
#[derive(Clone, Copy, Debug)]
pub struct CurvePlace<T> {
    /// The place, in the body.
    pub place: [T; 2],
    /// Its derivative.
    pub rate: [T; 2],
}

/// A smooth curve of a body, in the body's own coordinates.
#[derive(Clone, Debug)]
pub struct LocalCurve<T> {
    /// Whether it comes back to its first point.
    closed: bool,
    /// Parameter at the start of every piece: the angle of the shoe on a closed curve, the tangent of half of it on an open
    /// one.
    starts: Vec<T>,
    /// The pieces, each about its start.
    pieces: Vec<Cubic<T>>,
}

impl<T: Number> LocalCurve<T> {
    /// A curve whose points are not known yet.
    pub(crate) fn unknown(points: usize, closed: bool) -> Self {
        let pieces = if closed { points } else { points - 1 };
        Self {
            closed,
            starts: vec![T::zero(); pieces],
            pieces: vec![[[T::zero(); 4]; 2]; pieces],
        }
    }

    /// The curve through three points at least. NaN where one follows on the same spot.
    pub fn through(points: &[[T; 2]], closed: bool) -> Self {
        let mut it = Self::unknown(points.len(), closed);
        it.update(points);
        it
    }

    /// The curve through as many other points, in the same storage.
    pub(crate) fn update(&mut self, points: &[[T; 2]]) {
        let count = points.len();
        let next = |k: usize| points[(k + 1) % count];
        let chords: Vec<T> = (0..self.pieces.len())
            .map(|k| {
                let chord = sub(next(k), points[k]);
                dot(chord, chord).sqrt()
            })
            .collect();
        let whole = chords.iter().fold(T::zero(), |sum, chord| sum + *chord);
        let (first, range) = if self.closed { (0.0, TAU) } else { (-1.0, 2.0) };
        let steps: Vec<T> = chords.iter().map(|chord| *chord * range / whole).collect();
        let mut at = T::from_f64(first);
        for (start, step) in self.starts.iter_mut().zip(&steps) {
            *start = at;
            at += *step;
        }
        for axis in 0..2 {
            let values: Vec<T> = points.iter().map(|p| p[axis]).collect();
            let moments = if self.closed {
                closed_moments(&steps, &values)
            } else {
                let times: Vec<T> = self.starts.iter().copied().chain([at]).collect();
                moments(&times, &values)
            };
            for (k, cubic) in self.pieces.iter_mut().enumerate() {
                let next = (k + 1) % count;
                cubic[axis] = piece(
                    steps[k],
                    [values[k], values[next]],
                    [moments[k], moments[next]],
                );
            }
        }
    }

    /// Where the curve is at the direction of a shoe, whose angle is within half a turn of `near`, rad.
    #[inline]
    pub fn at(&self, shoe: &Pose<T>, near: f64) -> CurvePlace<T> {
        if !self.closed {
            let half = shoe.s / (shoe.c + 1.0);
            let to_angle = (half.square() + 1.0) * 0.5;
            let CurvePlace { place, rate } = self.evaluate(half, 0..1);
            return CurvePlace {
                place,
                rate: rate.map(|x| x * to_angle),
            };
        }
        // Less than a turn on either side of the first point; lane by lane brought into the first turn.
        let angle = shoe.angle_near(near) - TAU * (near / TAU).round();
        if T::IN_LANES {
            return self.evaluate(angle.choose(angle, angle + TAU), 0..1);
        }
        let angle = if angle.value() < 0.0 {
            angle + TAU
        } else {
            angle
        };
        // An interval may reach into the turn before or after.
        self.evaluate(angle, -1..2)
    }

    /// The curve at a parameter that lies in these turns of the first piece.
    fn evaluate(&self, parameter: T, turns: std::ops::Range<i32>) -> CurvePlace<T> {
        let count = self.pieces.len();
        let place = |k: usize| {
            let turn = turns.start + (k / count) as i32;
            (k % count, parameter - TAU * f64::from(turn))
        };
        let past = |k: usize| {
            let (piece, parameter) = place(k);
            parameter - self.starts[piece]
        };
        let [x, y, dx, dy] = piecewise(count * turns.len(), &past, &|k| {
            let (piece, parameter) = place(k);
            let CurvePlace { place, rate } = self.on_piece(piece, parameter);
            [place[0], place[1], rate[0], rate[1]]
        });
        CurvePlace {
            place: [x, y],
            rate: [dx, dy],
        }
    }

    fn on_piece(&self, piece: usize, parameter: T) -> CurvePlace<T> {
        let t = parameter - self.starts[piece];
        let cubic = &self.pieces[piece];
        CurvePlace {
            place: cubic.map(|[a, b, c, d]| ((d * t + c) * t + b) * t + a),
            rate: cubic.map(|[_, b, c, d]| (d * 3.0 * t + c * 2.0) * t + b),
        }
    }

    /// Takes over another's numbers through `f`, in the same storage.
    pub(crate) fn assign<U: Copy>(&mut self, other: &LocalCurve<U>, f: impl Fn(U) -> T) {
        self.closed = other.closed;
        self.starts.clear();
        self.starts.extend(other.starts.iter().map(|x| f(*x)));
        self.pieces.clear();
        let pieces = other.pieces.iter();
        self.pieces
            .extend(pieces.map(|axes| axes.map(|axis| axis.map(&f))));
    }
}

/// A shoe this little, rad, beyond the end of its curve stands at it.
const AT_END: f64 = 1e-9;
/// Newton steps to the foot of a perpendicular; from a sample near it a few are enough.
const FOOT_STEPS: usize = 8;
/// Samples of every piece among which the nearest is looked for.
const FOOT_SAMPLES: usize = 16;

impl LocalCurve<f64> {
    /// Places along the curve from its first point on, as many from every piece, with the derivatives to the parameter: an
    /// open curve's last point comes at the end, the first of a closed one does not come again.
    pub fn along(&self, of_piece: usize) -> Vec<CurvePlace<f64>> {
        let samples =
            (0..self.pieces.len()).flat_map(|piece| (0..of_piece).map(move |k| (piece, k)));
        let inside = samples.map(|(piece, k)| {
            let part = k as f64 / of_piece as f64;
            let start = self.starts[piece];
            self.on_piece(piece, start + (self.end(piece) - start) * part)
        });
        let last = self.pieces.len() - 1;
        let end = (!self.closed).then(|| self.on_piece(last, self.end(last)));
        inside.chain(end).collect()
    }

    /// Whether a shoe is beyond the ends of an open curve.
    pub fn is_past_end(&self, shoe: &Pose<f64>) -> bool {
        !self.closed && shoe.c < -AT_END
    }

    /// How far a place is from the nearest one of the curve between its ends, m.
    pub fn distance(&self, from: [f64; 2]) -> f64 {
        self.nearest(from).1
    }

    /// The angle of a shoe at the place of the curve, between its ends, that is nearest to another, rad, and how far that
    /// is, m.
    pub(crate) fn nearest(&self, from: [f64; 2]) -> (f64, f64) {
        let apart = |place: [f64; 2]| {
            let off = sub(place, from);
            math::hypot(off[0], off[1])
        };
        let (mut nearest, mut least) = (0.0, f64::INFINITY);
        for piece in 0..self.pieces.len() {
            let (start, end) = (self.starts[piece], self.end(piece));
            let samples = (0..=FOOT_SAMPLES).map(|k| {
                let at = start + (end - start) * k as f64 / FOOT_SAMPLES as f64;
                (at, apart(self.on_piece(piece, at).place))
            });
            let best = samples.min_by(|a, b| a.1.total_cmp(&b.1));
            let mut at = best.map_or(start, |(at, _)| at);
            for _ in 0..=FOOT_STEPS {
                let CurvePlace { place, rate } = self.on_piece(piece, at);
                if apart(place) < least {
                    (nearest, least) = (at, apart(place));
                }
                // Gauss and Newton's step towards the foot, kept on the piece.
                let foot = at - dot(sub(place, from), rate) / dot(rate, rate);
                at = math::min(math::max(foot, start), end);
            }
        }
        let angle = if self.closed {
            nearest
        } else {
            2.0 * math::atan2(nearest, 1.0)
        };
        (angle, least)
    }

    fn end(&self, piece: usize) -> f64 {
        let last = if self.closed { TAU } else { 1.0 };
        self.starts.get(piece + 1).copied().unwrap_or(last)
    }
}
