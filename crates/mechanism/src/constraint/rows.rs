//! The rows of every constraint: residuals, and their gradients beside them.

use kempe_number::Number;

use super::{Constraint, Situation};
use crate::pose::{cross, dot, sub};
use crate::structure::{BodyId, LineRef, Marker};

impl<T: Number> Situation<'_, T> {
    /// Whether a direction points the opposite way: the residual, a sine, does not tell.
    pub fn is_reversed(&self, constraint: &Constraint) -> bool {
        match *constraint {
            Constraint::Direction {
                a,
                b,
                offset,
                input,
            } => {
                let pose = &self.poses[a.index()];
                dot(self.wanted_direction(b, offset, input), [pose.c, pose.s]).value() < 0.0
            }
            _ => false,
        }
    }

    /// The residual rows of a constraint; only the first [`Constraint::rows`] count.
    #[inline]
    pub fn residual(&self, constraint: &Constraint) -> [T; 2] {
        let row = match *constraint {
            Constraint::Coincide { a, b } => return sub(self.place(b), self.place(a)),
            Constraint::OnLine { point, line } => {
                let (origin, direction) = self.line(line);
                cross(direction, sub(self.place(point), origin))
            }
            Constraint::Direction {
                a,
                b,
                offset,
                input,
            } => {
                let pose = &self.poses[a.index()];
                cross(self.wanted_direction(b, offset, input), [pose.c, pose.s])
            }
            Constraint::Distance { a, b, input } => {
                let span = sub(self.place(b), self.place(a));
                let length = self.inputs[input.index()].value;
                // (|span|^2 - length^2) / (2 length): a length, and smooth where the points meet.
                (dot(span, span) - length.square()) / (length * 2.0)
            }
            Constraint::Travel { point, line, input } => {
                let (origin, direction) = self.line(line);
                dot(direction, sub(self.place(point), origin)) - self.inputs[input.index()].value
            }
            Constraint::Gears {
                a,
                b,
                arm,
                constants,
            } => {
                let k = &self.geometry.gears[constants as usize];
                let arm = self.angle(arm);
                (k.first * (self.angle(a) - arm) + k.second * (self.angle(b) - arm) - k.constant)
                    / (k.first.abs() + k.second.abs())
            }
            Constraint::Rack {
                line,
                center,
                constants,
            } => {
                let k = &self.geometry.gears[constants as usize];
                let (origin, direction) = self.line(line);
                let travel = dot(direction, sub(self.place(center), origin));
                travel + k.second * (self.angle(center.body) - self.angle(line.body)) - k.constant
            }
        };
        [row, T::zero()]
    }
}

/// One entry of the constraint Jacobian: the derivative of a row to a body's x, y and angle.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<T = f64> {
    /// Row of the constraint.
    pub row: usize,
    /// The body.
    pub body: BodyId,
    /// Derivatives to x, y (per m) and angle (per rad).
    pub to: [T; 3],
}

impl<T: Number> Situation<'_, T> {
    /// Hands the rows of the constraint Jacobian to `emit`, and returns the derivative of each row to the coordinate
    /// of the constraint's drive (zero without one). These are the derivatives of [`Situation::residual`] at any pose,
    /// not only where the constraint holds.
    #[inline]
    pub fn gradients(&self, constraint: &Constraint, mut emit: impl FnMut(Gradient<T>)) -> T {
        let (zero, one) = (T::zero(), T::one());
        // From the body's origin: to its own point (intervals stay narrow without the detour over the frame), to any.
        let own_arm =
            |marker: Marker| self.poses[marker.body.index()].turn(self.geometry.marker(marker));
        let arm = |body: BodyId, p: [T; 2]| {
            let pose = &self.poses[body.index()];
            [p[0] - pose.x, p[1] - pose.y]
        };
        match *constraint {
            Constraint::Coincide { a, b } => {
                for (marker, sign) in [(b, 1.0), (a, -1.0)] {
                    let r = own_arm(marker);
                    emit(Gradient {
                        row: 0,
                        body: marker.body,
                        to: [one * sign, zero, r[1] * -sign],
                    });
                    emit(Gradient {
                        row: 1,
                        body: marker.body,
                        to: [zero, one * sign, r[0] * sign],
                    });
                }
                zero
            }
            Constraint::OnLine { point, line } => {
                let (p, t) = (self.place(point), self.line(line).1);
                emit(Gradient {
                    row: 0,
                    body: point.body,
                    to: [-t[1], t[0], dot(t, own_arm(point))],
                });
                emit(Gradient {
                    row: 0,
                    body: line.body,
                    to: [t[1], -t[0], -dot(t, arm(line.body, p))],
                });
                zero
            }
            Constraint::Direction {
                a,
                b,
                offset,
                input,
            } => {
                let pose = &self.poses[a.index()];
                let cosine = dot(self.wanted_direction(b, offset, input), [pose.c, pose.s]);
                emit(Gradient {
                    row: 0,
                    body: a,
                    to: [zero, zero, cosine],
                });
                emit(Gradient {
                    row: 0,
                    body: b,
                    to: [zero, zero, -cosine],
                });
                if input.is_some() { -cosine } else { zero }
            }
            Constraint::Distance { a, b, input } => {
                let length = self.inputs[input.index()].value;
                let span = sub(self.place(b), self.place(a));
                for (marker, sign) in [(b, one / length), (a, -(one / length))] {
                    let turn = cross(own_arm(marker), span);
                    emit(Gradient {
                        row: 0,
                        body: marker.body,
                        to: [span[0] * sign, span[1] * sign, turn * sign],
                    });
                }
                (dot(span, span) / (length * length) + 1.0) * -0.5
            }
            Constraint::Travel { point, line, .. } => {
                self.travel_gradients(point, line, &mut emit);
                -one
            }
            Constraint::Gears {
                a,
                b,
                arm,
                constants,
            } => {
                let k = &self.geometry.gears[constants as usize];
                let size = k.first.abs() + k.second.abs();
                for (body, factor) in [(a, k.first), (b, k.second), (arm, -k.first - k.second)] {
                    emit(Gradient {
                        row: 0,
                        body,
                        to: [zero, zero, factor / size],
                    });
                }
                zero
            }
            Constraint::Rack {
                line,
                center,
                constants,
            } => {
                self.travel_gradients(center, line, &mut emit);
                let k = &self.geometry.gears[constants as usize];
                emit(Gradient {
                    row: 0,
                    body: center.body,
                    to: [zero, zero, k.second],
                });
                emit(Gradient {
                    row: 0,
                    body: line.body,
                    to: [zero, zero, -k.second],
                });
                zero
            }
        }
    }

    fn travel_gradients(&self, point: Marker, line: LineRef, emit: &mut impl FnMut(Gradient<T>)) {
        let (p, t) = (self.place(point), self.line(line).1);
        let guide = &self.poses[line.body.index()];
        let own = self.poses[point.body.index()].turn(self.geometry.marker(point));
        let turn = cross(own, t);
        emit(Gradient {
            row: 0,
            body: point.body,
            to: [t[0], t[1], turn],
        });
        let turn = cross(t, [p[0] - guide.x, p[1] - guide.y]);
        emit(Gradient {
            row: 0,
            body: line.body,
            to: [-t[0], -t[1], turn],
        });
    }
}
