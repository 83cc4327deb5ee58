//! The curve as a chain of chords that lies near it.

use std::f64::consts::TAU;

use kempe_linear::C;

use super::{BurmesterCurve, Homogeneous, Loop};
use crate::pose::dot;

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
/// Halvings of such a part at most.
const HALVINGS: u32 = 10;
/// Halvings towards the place where the curve leaves the picture.
const TO_THE_EDGE: u32 = 8;

impl BurmesterCurve {
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
        (self.loops.iter().enumerate())
            .flat_map(|(of_loop, part)| draw(self, part, of_loop, drawing, &wanted))
            .collect()
    }
}

/// Draws a loop.
fn draw(
    curve: &BurmesterCurve,
    part: &Loop,
    of_loop: usize,
    drawing: CurveDrawing,
    wanted: &impl Fn(C, C) -> bool,
) -> Vec<CurvePiece> {
    let mut pen = Pen {
        curve,
        part,
        of_loop,
        drawing,
        wanted,
        pieces: Vec::new(),
        down: false,
    };
    pen.draw();
    pen.pieces
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
            let along = (dot(chord, side) / square).clamp(0.0, 1.0);
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
