//! Four poses: the curves of all their fixed and moving pivots.
//!
//! A fixed pivot g leaves three equations linear in the moving one; they agree where a determinant vanishes, a circular cubic in g, the
//! centre-point curve (L. Burmester, 1888). It passes through the poles. A ray from one of them meets it in two more points, so
//! the ray's angle and a sign tell all points of the curve; where the two become one the curve turns back. These angles are roots of a
//! quartic, which therefore says how the curve hangs together before any point of it is found.

use std::f64::consts::{PI, TAU};

use kempe_linear::C;
use kempe_number::math;

use crate::displacements::{Displacements, Row, with_fixed};
use crate::dyad::Dyad;
use crate::error::SynthesisError;
use crate::kernel::{DependentRow, kernel};
use crate::polynomial::roots;
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

/// How a curve is drawn, in units of the problem: the distance that the displacements' shifts are over their turns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CurveDrawing {
    /// Farthest that the curve may lie from a chord of the drawing. 0.01 by default, which one does not see in a picture of `reach`.
    pub flatness: f64,
    /// How far pivots may lie from the point that the displacements move least. 10 by default: beyond, links are ten times the
    /// size of the task.
    pub reach: f64,
}

impl Default for CurveDrawing {
    fn default() -> Self {
        Self {
            flatness: 0.01,
            reach: 10.0,
        }
    }
}

impl CurveDrawing {
    /// The same with another flatness.
    pub fn with_flatness(self, flatness: f64) -> Self {
        Self { flatness, ..self }
    }

    /// The same with another reach.
    pub fn with_reach(self, reach: f64) -> Self {
        Self { reach, ..self }
    }
}

/// A dyad on a drawn curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Its parameter on the loop, for [`BurmesterCurve::dyad`].
    pub parameter: f64,
    /// The fixed pivot.
    pub fixed: C,
    /// The moving pivot, as a point of the body.
    pub moving: C,
}

/// An unbroken part of the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePiece {
    /// The loop that it is of.
    pub of_loop: usize,
    /// Whether it returns to its first point, which is then not repeated.
    pub closed: bool,
    /// Its points in order.
    pub points: Vec<CurvePoint>,
}

/// Parts into which a loop is cut before it is looked where it bends.
const PARTS: usize = 24;
/// Equations of a point of the curve agree to this part of their terms.
const TOLD: f64 = 1e-7;
/// Halvings of such a part at most.
const HALVINGS: u32 = 10;
/// Halvings towards the place where the curve leaves the picture.
const TO_THE_EDGE: u32 = 8;
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

    /// The whole curve as it is to be drawn.
    pub fn drawn(&self, drawing: CurveDrawing) -> Vec<CurvePiece> {
        self.drawn_where(drawing, |_, _| true)
    }

    /// The parts of the curve whose fixed pivot and moving pivot (a point of the body) are wanted; they end where that ends.
    pub fn drawn_where(
        &self,
        drawing: CurveDrawing,
        wanted: impl Fn(C, C) -> bool,
    ) -> Vec<CurvePiece> {
        let mut pieces = Vec::new();
        for (of_loop, part) in self.loops.iter().enumerate() {
            let mut pen = Pen {
                curve: self,
                part,
                of_loop,
                drawing,
                wanted: &wanted,
                pieces: Vec::new(),
                down: false,
            };
            pen.draw();
            pieces.append(&mut pen.pieces);
        }
        pieces
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
        let (s0, c0) = math::sin_cos(start);
        // As a polynomial in t, the ray (c0, s0) t + (-s0, c0): c = c0 t - s0, s = s0 t + c0.
        let mut in_t = [0.0; 5];
        for (k, q) in quartic.iter().enumerate() {
            let mut term = vec![*q];
            for factor in 0..4 {
                let [constant, slope] = if factor < k { [c0, s0] } else { [-s0, c0] };
                let mut next = vec![0.0; term.len() + 1];
                for (i, x) in term.iter().enumerate() {
                    next[i] += x * constant;
                    next[i + 1] += x * slope;
                }
                term = next;
            }
            for (sum, x) in in_t.iter_mut().zip(&term) {
                *sum += x;
            }
        }
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

/// Draws one loop.
struct Pen<'a, F> {
    curve: &'a BurmesterCurve,
    part: &'a Loop,
    of_loop: usize,
    drawing: CurveDrawing,
    wanted: &'a F,
    pieces: Vec<CurvePiece>,
    down: bool,
}

#[derive(Clone, Copy)]
struct Seen {
    parameter: f64,
    at: Homogeneous,
    inside: bool,
}

impl<F: Fn(C, C) -> bool> Pen<'_, F> {
    fn look(&self, parameter: f64) -> Seen {
        let at = self.curve.at(self.part, parameter);
        let near = |p: C| p.norm_sqr() <= self.drawing.reach * self.drawing.reach;
        let mut inside = at.is_told && near(at.fixed) && near(at.moving);
        if inside {
            let (fixed, moving) = self.curve.point(&at);
            inside = (self.wanted)(fixed, moving);
        }
        Seen {
            parameter,
            at,
            inside,
        }
    }

    fn draw(&mut self) {
        let first = self.look(0.0);
        if first.inside {
            self.put(&first);
        }
        let mut last = first;
        for k in 1..=PARTS {
            let mut next = if k < PARTS {
                self.look(TAU * k as f64 / PARTS as f64)
            } else {
                first
            };
            next.parameter = TAU * k as f64 / PARTS as f64;
            self.part(&last, &next, 0);
            last = next;
        }
        let unbroken = self.down;
        let Some(final_piece) = self.pieces.last_mut() else {
            return;
        };
        // The last piece ends where the first began.
        if unbroken && first.inside {
            final_piece.points.pop();
            if self.pieces.len() == 1 {
                self.pieces[0].closed = true;
            } else if let Some(mut end) = self.pieces.pop() {
                end.points.append(&mut self.pieces[0].points);
                self.pieces[0].points = end.points;
            }
        }
    }

    fn put(&mut self, seen: &Seen) {
        let (fixed, moving) = self.curve.point(&seen.at);
        let point = CurvePoint {
            parameter: seen.parameter,
            fixed,
            moving,
        };
        match self.pieces.last_mut().filter(|_| self.down) {
            Some(piece) => piece.points.push(point),
            None => self.pieces.push(CurvePiece {
                of_loop: self.of_loop,
                closed: false,
                points: vec![point],
            }),
        }
        self.down = true;
    }

    /// Draws from one place, which is drawn, to another.
    fn part(&mut self, from: &Seen, to: &Seen, halvings: u32) {
        let middle = self.look(0.5 * (from.parameter + to.parameter));
        let inside = [from, &middle, to].map(|s| s.inside);
        if inside == [true; 3] {
            if self.is_flat(from, &middle, to) || halvings >= HALVINGS {
                // Two points near each other on both sides of infinity are not joined.
                if halvings >= HALVINGS && !self.is_near(from, to) {
                    self.down = false;
                }
                self.put(to);
                return;
            }
        } else if inside == [false; 3] {
            return;
        } else if halvings >= TO_THE_EDGE {
            if !middle.inside || !to.inside {
                if middle.inside {
                    self.put(&middle);
                }
                self.down = false;
            } else if !from.inside {
                self.put(&middle);
            }
            if to.inside {
                self.put(to);
            }
            return;
        }
        self.part(from, &middle, halvings + 1);
        self.part(&middle, to, halvings + 1);
    }

    fn is_flat(&self, from: &Seen, middle: &Seen, to: &Seen) -> bool {
        let off = |of: fn(&Homogeneous) -> C| {
            let (a, m, b) = (of(&from.at), of(&middle.at), of(&to.at));
            let (chord, side) = (b - a, m - a);
            let square = chord.norm_sqr();
            // Beside the chord; where the curve turns back, as far as it goes.
            let along = (crate::pose::dot(chord, side) / square).clamp(0.0, 1.0);
            let along = if square > 0.0 { along } else { 0.0 };
            (side - chord.scale(along)).norm_sqr()
        };
        let flatness = self.drawing.flatness * self.drawing.flatness;
        off(|h| h.fixed) <= flatness && off(|h| h.moving) <= flatness
    }

    fn is_near(&self, from: &Seen, to: &Seen) -> bool {
        let apart = |a: C, b: C| (a - b).norm() <= 0.5 * self.drawing.reach;
        apart(from.at.fixed, to.at.fixed) && apart(from.at.moving, to.at.moving)
    }
}

/// A cubic in two variables: coefficients by the powers of x and y.
struct Cubic([[f64; 4]; 4]);

impl Cubic {
    /// The determinant of the three rows that a fixed pivot x + i y leaves.
    fn of(rows: &[Row; 3]) -> Self {
        // Each row is p + x q + y r.
        let parts: [[[f64; 3]; 3]; 3] = std::array::from_fn(|k| {
            let p = with_fixed(&rows[k], C::zero());
            let along = |g: C| {
                let there = with_fixed(&rows[k], g);
                std::array::from_fn(|i| there[i] - p[i])
            };
            [p, along(C::one()), along(C::i())]
        });
        let mut cubic = [[0.0; 4]; 4];
        for (i, a) in parts[0].iter().enumerate() {
            for (j, b) in parts[1].iter().enumerate() {
                let product = [
                    a[1] * b[2] - a[2] * b[1],
                    a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0],
                ];
                for (k, c) in parts[2].iter().enumerate() {
                    let powers = |of: usize| [i, j, k].iter().filter(|p| **p == of).count();
                    cubic[powers(1)][powers(2)] +=
                        product[0] * c[0] + product[1] * c[1] + product[2] * c[2];
                }
            }
        }
        Self(cubic)
    }

    /// Value and gradient at a point.
    fn about(&self, at: C) -> [f64; 3] {
        let (x, y, c) = (at.re, at.im, &self.0);
        let power = |b: f64, n: usize| kempe_number::powi(b, n as i32);
        let mut sum = [0.0; 3];
        for i in 0..4 {
            for j in 0..4 - i {
                sum[0] += c[i][j] * power(x, i) * power(y, j);
                if i > 0 {
                    sum[1] += c[i][j] * i as f64 * power(x, i - 1) * power(y, j);
                }
                if j > 0 {
                    sum[2] += c[i][j] * j as f64 * power(x, i) * power(y, j - 1);
                }
            }
        }
        sum
    }

    /// Its quadratic part about a point: the factors of dx^2, dx dy and dy^2.
    fn second_about(&self, at: C) -> [f64; 3] {
        let (x, y, c) = (at.re, at.im, &self.0);
        [
            c[2][0] + 3.0 * c[3][0] * x + c[2][1] * y,
            c[1][1] + 2.0 * (c[2][1] * x + c[1][2] * y),
            c[0][2] + c[1][2] * x + 3.0 * c[0][3] * y,
        ]
    }
}
