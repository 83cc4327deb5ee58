//! Measures of a pose: places, angles, distances, and the geometry of paths.

use kempe_model::{Line, LinkId, LinkPointRef, PointId, PoseMeasure};
use kempe_number::Number;

use super::{Along, Moment, Series};
use crate::pose::{Pose, cross, dot, left, sub};

impl<B: Number> Moment<'_, B> {
    /// A measure of the poses of one series.
    pub(super) fn geometric(
        &self,
        measure: &PoseMeasure,
        poses: &[Pose<Series<B>>],
        along: Along,
    ) -> Series<B> {
        let point = |p: PointId| self.point(poses, p);
        match measure {
            PoseMeasure::X(p) => point(*p)[0],
            PoseMeasure::Y(p) => point(*p)[1],
            PoseMeasure::XOn(p, link) => self.seen_from(poses, *p, *link)[0],
            PoseMeasure::YOn(p, link) => self.seen_from(poses, *p, *link)[1],
            PoseMeasure::Angle(link) => self.angle(poses, *link),
            PoseMeasure::AngleBetween(link, other) => {
                self.angle(poses, *link) - self.angle(poses, *other)
            }
            PoseMeasure::Direction(a, b) => {
                let v = sub(point(*b), point(*a));
                let near = self
                    .directions
                    .iter()
                    .find(|(pair, _)| *pair == (*a, *b))
                    .map_or(0.0, |(_, near)| *near);
                Pose {
                    x: v[0],
                    y: v[1],
                    c: v[0],
                    s: v[1],
                }
                .angle_near(near)
            }
            PoseMeasure::Distance(a, b) => {
                let v = sub(point(*b), point(*a));
                dot(v, v).sqrt()
            }
            PoseMeasure::DistanceToLine(p, line) => {
                let (origin, direction) = self.guide(poses, *line);
                cross(direction, sub(point(*p), origin))
            }
            PoseMeasure::Travel(at, line) => {
                let (origin, direction) = self.guide(poses, *line);
                dot(direction, sub(point(at.point), origin))
            }
            PoseMeasure::TransmissionAngle { at, a, b, folded } => {
                let corner = point(*at);
                let (u, v) = (sub(point(*a), corner), sub(point(*b), corner));
                let along = if *folded { dot(u, v).abs() } else { dot(u, v) };
                cross(u, v).abs().atan2(along)
            }
            PoseMeasure::InstantCenterX(a, b) => self.instant_center(poses, *a, *b)[0],
            PoseMeasure::InstantCenterY(a, b) => self.instant_center(poses, *a, *b)[1],
            PoseMeasure::Curvature(p) => {
                let (curvature, _) = self.curvature(point(*p));
                // Positive turning left along the travel, whichever way the path parameter runs.
                if self.clock.coefficient(1).value() < 0.0 && along != Along::Path {
                    -curvature
                } else {
                    curvature
                }
            }
            PoseMeasure::CurvatureCenterX(p) => self.curvature(point(*p)).1[0],
            PoseMeasure::CurvatureCenterY(p) => self.curvature(point(*p)).1[1],
            PoseMeasure::MechanicalAdvantage(output, drive) => {
                Series::one()
                    / self.coefficient(
                        output,
                        *drive,
                        1,
                        if along == Along::Time {
                            Along::Path
                        } else {
                            along
                        },
                    )
            }
            _ => Series::from_f64(f64::NAN),
        }
    }

    /// A point in the frame.
    pub(super) fn point(&self, poses: &[Pose<Series<B>>], point: PointId) -> [Series<B>; 2] {
        match self.mechanism.any_marker(point) {
            Some(marker) => poses[marker.body.index()].place(self.design.geometry.marker(marker)),
            None => [Series::from_f64(f64::NAN); 2],
        }
    }

    /// Pose of a link, not of its body.
    fn link(&self, poses: &[Pose<Series<B>>], link: LinkId) -> Pose<Series<B>> {
        let body = &poses[self.mechanism.body_of(link).index()];
        let seat = &self.design.geometry.seats[link.index()];
        let [x, y] = body.place([seat.x, seat.y]);
        let [c, s] = body.turn([seat.c, seat.s]);
        Pose { x, y, c, s }
    }

    /// Unwrapped angle of a link.
    pub(super) fn angle(&self, poses: &[Pose<Series<B>>], link: LinkId) -> Series<B> {
        let body = self.mechanism.body_of(link).index();
        poses[body].angle_near(self.near[body]) + self.design.geometry.seat_angles[link.index()]
    }

    /// Origin and unit direction of a line in the frame.
    fn guide(&self, poses: &[Pose<Series<B>>], line: Line) -> ([Series<B>; 2], [Series<B>; 2]) {
        let marker = |point| {
            let at = LinkPointRef {
                link: line.link,
                point,
            };
            match self.mechanism.marker(at) {
                Some(marker) => {
                    poses[marker.body.index()].place(self.design.geometry.marker(marker))
                }
                None => [Series::from_f64(f64::NAN); 2],
            }
        };
        let origin = marker(line.from);
        let span = sub(marker(line.to), origin);
        let length = dot(span, span).sqrt();
        (origin, [span[0] / length, span[1] / length])
    }

    /// A point seen from a link.
    fn seen_from(&self, poses: &[Pose<Series<B>>], point: PointId, link: LinkId) -> [Series<B>; 2] {
        let frame = self.link(poses, link);
        frame.unturn(sub(self.point(poses, point), [frame.x, frame.y]))
    }

    /// Instant centre of two links: the point where both have the same velocity. Infinite when they only translate
    /// against each other.
    fn instant_center(&self, poses: &[Pose<Series<B>>], a: LinkId, b: LinkId) -> [Series<B>; 2] {
        let motion = |link: LinkId| {
            let pose = self.link(poses, link);
            // Rate of the angle from c s' - s c'; velocity of the body's point that passes the frame's origin.
            let rate = pose.c * pose.s.differentiate() - pose.s * pose.c.differentiate();
            let velocity = [
                pose.x.differentiate() + rate * pose.y,
                pose.y.differentiate() - rate * pose.x,
            ];
            (velocity, rate)
        };
        let ((va, wa), (vb, wb)) = (motion(a), motion(b));
        let (v, w) = (sub(vb, va), wa - wb);
        [v[1] / w, -v[0] / w]
    }

    /// Curvature of a path and its centre, from the first two derivatives along the path parameter.
    fn curvature(&self, p: [Series<B>; 2]) -> (Series<B>, [Series<B>; 2]) {
        let d = [p[0].differentiate(), p[1].differentiate()];
        let dd = [d[0].differentiate(), d[1].differentiate()];
        let square = dot(d, d);
        let bend = cross(d, dd);
        let curvature = bend / (square * square.sqrt());
        let reach = square / bend;
        let n = left(d);
        (curvature, [p[0] + n[0] * reach, p[1] + n[1] * reach])
    }
}
