//! Four poses: the curves of all their fixed and moving pivots.
//!
//! A fixed pivot g leaves three equations linear in the moving one; they agree where a determinant vanishes, a circular cubic in g, the
//! centre-point curve (L. Burmester, 1888). It passes through the poles. A ray from one of them meets it in two more points, so
//! the ray's angle and a sign tell all points of the curve; where the two become one the curve turns back. These angles are roots of a
//! quartic, which therefore says how the curve hangs together before any point of it is found.

mod cubic;
mod drawing;

pub use drawing::{CurveDrawing, CurvePiece, CurvePoint};

use std::f64::consts::PI;

use kempe_linear::C;
use kempe_number::math;

use cubic::Cubic;

use crate::displacements::{Displacements, with_fixed};
use crate::dyad::Dyad;
use crate::error::SynthesisError;
use crate::kernel::{DependentRow, kernel};
use crate::newton::Row;
use crate::polynomial::{along, roots};
use crate::pose::{Pose, pole};

/// The dyads with two pins that guide a body through four poses: a curve of fixed pivots and one of moving pivots, point by point.
#[derive(Clone, Debug)]
pub struct BurmesterCurve {
    displacements: Displacements,
    first: Pose,
    rows: [Row; 3],
    /// The pole that rays start from.
    pole: C,
    /// Along a ray at (c, s) the cubic is r (a r^2 + b r + e): coefficients of a and e in c, s, of b in c^2, c s, s^2.
    a: [f64; 2],
    b: [f64; 3],
    e: [f64; 2],
    loops: Vec<Loop>,
}

/// A closed part of the curve, told by a parameter from 0 to a whole turn.
#[derive(Clone, Copy, Debug)]
enum Loop {
    /// Rays of all angles from this one, and one of the two points on each.
    Full { start: f64, sign: f64 },
    /// Rays from `middle - half` to `middle + half`, with one point and back with the other.
    Between { middle: f64, half: f64 },
}

/// Equations of a point of the curve agree to this part of their terms.
const TOLD: f64 = 1e-7;
/// Rays among which the one with the largest discriminant is looked for.
const RAYS: usize = 8;
/// A root this near to the real axis, beside 1, is a real one, double but for rounding.
const NEARLY_REAL: f64 = 1e-9;

impl BurmesterCurve {
    /// The curve of four poses.
    ///
    /// # Errors
    /// Poses that are not finite, repeated, without turns or about one point, or that leave more than a curve.
    pub fn new(poses: &[Pose; 4]) -> Result<Self, SynthesisError> {
        let displacements = Displacements::new(poses)?;
        displacements.must_turn()?;
        let found: Vec<Row> = displacements.rows().collect();
        let dependent =
            |DependentRow(row): DependentRow| SynthesisError::Dependent { datum: row + 1 };
        kernel::<7, 4>(&found).map_err(dependent)?;
        let rows: [Row; 3] = std::array::from_fn(|k| {
            let length = found[k].iter().map(|x| x * x).sum::<f64>().sqrt();
            found[k].map(|x| x / length)
        });
        let cubic = Cubic::of(&rows);
        let (mut best, mut start) = (0.0, None);
        for i in 0..4 {
            for j in i + 1..4 {
                let Some(pole) = pole(&poses[i], &poses[j]) else {
                    continue;
                };
                let pole = displacements.seen(pole);
                let [_, x, y] = cubic.about(pole);
                // A pole nearby through which the curve passes once.
                let worth = math::hypot(x, y) / (1.0 + pole.norm_sqr());
                if worth > best {
                    (best, start) = (worth, Some(pole));
                }
            }
        }
        let Some(pole) = start else {
            return Err(SynthesisError::Dependent { datum: 3 });
        };
        let [_, ex, ey] = cubic.about(pole);
        let mut curve = Self {
            first: poses[0],
            displacements,
            rows,
            pole,
            a: [cubic.0[3][0], cubic.0[0][3]],
            b: cubic.second_about(pole),
            e: [ex, ey],
            loops: Vec::new(),
        };
        curve.find_loops();
        Ok(curve)
    }

    /// How many closed parts the curve has, one or two; each but an oval passes through infinity.
    pub fn loops(&self) -> usize {
        self.loops.len()
    }

    /// The dyad at a parameter, from 0 to a whole turn, of a loop; `None` where a pivot lies at infinity, where the curve
    /// crosses itself so that a fixed pivot has many moving ones, or where there is no such loop.
    pub fn dyad(&self, of_loop: usize, parameter: f64) -> Option<Dyad> {
        let point = self.at(self.loops.get(of_loop)?, parameter);
        let (fixed, moving) = self.point(&point);
        let is_there = point.is_told && fixed.is_finite() && moving.is_finite();
        is_there.then(|| Dyad::rr(fixed, moving, &self.first))
    }

    /// b^2 - 4 a e as a quartic in c and s, by the power of s.
    fn discriminant(&self) -> [f64; 5] {
        let ([a0, a1], [b0, b1, b2], [e0, e1]) = (self.a, self.b, self.e);
        let ae = [a0 * e0, a0 * e1 + a1 * e0, a1 * e1];
        [
            b0 * b0 - 4.0 * ae[0],
            2.0 * b0 * b1 - 4.0 * ae[1],
            b1 * b1 + 2.0 * b0 * b2 - 4.0 * (ae[0] + ae[2]),
            2.0 * b1 * b2 - 4.0 * ae[1],
            b2 * b2 - 4.0 * ae[2],
        ]
    }

    fn find_loops(&mut self) {
        let quartic = self.discriminant();
        let at = |c: f64, s: f64| {
            let mut sum = 0.0;
            for (k, q) in quartic.iter().enumerate() {
                sum += q * kempe_number::powi(c, 4 - k as i32) * kempe_number::powi(s, k as i32);
            }
            sum
        };
        let value = |angle: f64| {
            let (s, c) = math::sin_cos(angle);
            at(c, s)
        };
        // Angles count from a ray on which the discriminant is large, so that no root lies near a half turn.
        let start = (0..RAYS)
            .map(|k| PI * k as f64 / RAYS as f64)
            .max_by(|p, q| value(*p).abs().total_cmp(&value(*q).abs()))
            .unwrap_or(0.0);
        let in_t = along(&quartic, math::sin_cos(start));
        let mut turns: Vec<f64> = (roots(&in_t).into_iter())
            .filter(|t| t.im.abs() <= NEARLY_REAL * (1.0 + t.norm()))
            .map(|t| start + math::atan2(1.0, t.re))
            .collect();
        turns.sort_by(f64::total_cmp);
        if turns.is_empty() {
            if value(start) > 0.0 {
                self.loops = [1.0, -1.0].map(|sign| Loop::Full { start, sign }).to_vec();
            }
            return;
        }
        let count = turns.len();
        self.loops = (0..count)
            .filter_map(|k| {
                let low = turns[k];
                let high = if k + 1 < count {
                    turns[k + 1]
                } else {
                    turns[0] + PI
                };
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
                (half > 0.0 && value(middle) > 0.0).then_some(Loop::Between { middle, half })
            })
            .collect();
    }

    /// The products (w, z, w g) at a parameter, not of any size.
    fn at(&self, part: &Loop, parameter: f64) -> Homogeneous {
        let (angle, sign) = match *part {
            Loop::Full { start, sign } => (start + 0.5 * parameter, sign),
            Loop::Between { middle, half } => {
                let (s, c) = math::sin_cos(parameter);
                (middle + half * c, if s < 0.0 { -1.0 } else { 1.0 })
            }
        };
        let (s, c) = math::sin_cos(angle);
        let a = self.a[0] * c + self.a[1] * s;
        let b = self.b[0] * c * c + self.b[1] * c * s + self.b[2] * s * s;
        let e = self.e[0] * c + self.e[1] * s;
        let root = math::max(b * b - 4.0 * a * e, 0.0).sqrt();
        // r = (-b + sign root) / 2a without cancellation.
        let (above, below) = if (b > 0.0) == (sign < 0.0) {
            (-b + sign * root, 2.0 * a)
        } else {
            (2.0 * e, -b - sign * root)
        };
        let r = above / below;
        let g = self.pole + C::new(c * r, s * r);
        let rows = self.rows.map(|row| with_fixed(&row, g));
        let mut best = [0.0; 3];
        let mut size = -1.0;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let (p, q) = (&rows[i], &rows[j]);
            let product = [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ];
            let square = product.iter().map(|x| x * x).sum();
            if square > size {
                (best, size) = (product, square);
            }
        }
        let [w, x, y] = best;
        let z = C::new(x / w, y / w);
        // Where the curve crosses itself the moving pivot is what rounding makes it.
        let left = rows.iter().fold(0.0, |m: f64, row| {
            math::max(m, (row[0] + row[1] * z.re + row[2] * z.im).abs())
        });
        Homogeneous {
            fixed: g,
            moving: z,
            is_told: left <= TOLD * (1.0 + g.norm()) * (1.0 + z.norm()),
        }
    }

    fn point(&self, point: &Homogeneous) -> (C, C) {
        (
            self.displacements.place(point.fixed),
            self.displacements.body_point(point.moving),
        )
    }
}

/// Pivots in the problem's coordinates, infinite or not.
#[derive(Clone, Copy)]
struct Homogeneous {
    fixed: C,
    moving: C,
    /// Whether the three equations agree on the moving pivot.
    is_told: bool,
}
