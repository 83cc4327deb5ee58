//! Measures of a pose: places, angles, distances, and the geometry of paths.

use kempe_mechanism::pose::{Pose, cross, dot, left, sub};
use kempe_model::{Line, LinkId, LinkPointRef, PointId, PoseMeasure};
use kempe_number::Number;

use super::{Along, Moment, Series, only_value, undefined};

/// A speed, in mechanism sizes per typical change of the path, that is rounding.
const NO_SPEED: f64 = 1e-14;
/// A point turns back where its speed is below this part of its acceleration (both per typical change of the path): nearer
/// to the place of reversal, by the third power, rounding takes the digits of the curvature of its path: seven are left here.
const REVERSAL: f64 = 1e-3;
/// ... and less than this speed, in the units of [`NO_SPEED`]: towards a limit of the drive both grow beyond all bounds.
const SLOW: f64 = 1e-3;
/// Links translate where their turning moves a mechanism size by less than this part of their sliding; a path is straight
/// where a mechanism size is less than this part of its radius.
const TRANSLATION: f64 = 1e-12;

/// Beyond all measure, with nothing to be said of how it changes.
fn infinite<B: Number>() -> Series<B> {
    only_value(B::from_f64(f64::INFINITY))
}

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
                let v = self.way(poses, *a, *b);
                let near = self
                    .history
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
                let v = self.way(poses, *a, *b);
                dot(v, v).sqrt()
            }
            PoseMeasure::DistanceToLine(p, line) => {
                let (origin, direction) = self.guide(poses, *line);
                cross(direction, sub(point(*p), origin))
            }
            PoseMeasure::Travel(at, line) => {
                let (origin, direction) = self.guide(poses, *line);
                let own = self
                    .on_link(poses, *at)
                    .filter(|_| self.state.mechanism().comes_apart());
                dot(
                    direction,
                    sub(own.unwrap_or_else(|| point(at.point)), origin),
                )
            }
            PoseMeasure::TransmissionAngle { at, a, b, folded } => {
                let [u, v] = [a, b].map(|end| self.way(poses, *at, *end));
                let along = if *folded { dot(u, v).abs() } else { dot(u, v) };
                cross(u, v).abs().atan2(along)
            }
            PoseMeasure::InstantCenterX(a, b) => self.instant_center(poses, *a, *b)[0],
            PoseMeasure::InstantCenterY(a, b) => self.instant_center(poses, *a, *b)[1],
            PoseMeasure::Curvature(p) => {
                let (curvature, _) = self.curvature(point(*p));
                // Positive turning left along the travel, whichever way the path parameter runs.
                if self.state.abscissa.heading < 0.0 && along != Along::Path {
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
            _ => undefined(),
        }
    }

    /// From one point to another, in the frame; where a link has both, as that link has them.
    fn way(&self, poses: &[Pose<Series<B>>], a: PointId, b: PointId) -> [Series<B>; 2] {
        let together = || {
            let points = &self.state.mechanism().model.points;
            let links = [a, b].map(|p| points.get(p.index()).map_or(&[][..], |p| &p.links));
            let link = *links[0].iter().find(|link| links[1].contains(link))?;
            let [a, b] = [a, b].map(|point| self.on_link(poses, LinkPointRef { link, point }));
            Some(sub(b?, a?))
        };
        let apart = self
            .state
            .mechanism()
            .comes_apart()
            .then(together)
            .flatten();
        apart.unwrap_or_else(|| sub(self.point(poses, b), self.point(poses, a)))
    }

    /// A point in the frame where one of its links has it.
    fn on_link(&self, poses: &[Pose<Series<B>>], at: LinkPointRef) -> Option<[Series<B>; 2]> {
        let marker = self.state.mechanism().marker(at)?;
        let local = self.state.design.geometry.marker(marker);
        Some(poses[marker.body.index()].place(local))
    }

    /// A point in the frame; of several links where the first of them has it.
    pub(super) fn point(&self, poses: &[Pose<Series<B>>], point: PointId) -> [Series<B>; 2] {
        match self.state.mechanism().any_marker(point) {
            Some(marker) => {
                poses[marker.body.index()].place(self.state.design.geometry.marker(marker))
            }
            None => [undefined(); 2],
        }
    }

    /// Pose of a link, not of its body.
    fn link(&self, poses: &[Pose<Series<B>>], link: LinkId) -> Pose<Series<B>> {
        let body = &poses[self.state.mechanism().body_of(link).index()];
        let seat = &self.state.design.geometry.seats[link.index()];
        let [x, y] = body.place([seat.x, seat.y]);
        let [c, s] = body.turn([seat.c, seat.s]);
        Pose { x, y, c, s }
    }

    /// Unwrapped angle of a link.
    pub(super) fn angle(&self, poses: &[Pose<Series<B>>], link: LinkId) -> Series<B> {
        let body = self.state.mechanism().body_of(link).index();
        poses[body].angle_near(self.state.near[body])
            + self.state.design.geometry.seat_angles[link.index()]
    }

    /// Origin and unit direction of a line in the frame.
    fn guide(&self, poses: &[Pose<Series<B>>], line: Line) -> ([Series<B>; 2], [Series<B>; 2]) {
        let marker = |point| {
            let at = LinkPointRef {
                link: line.link,
                point,
            };
            match self.state.mechanism().marker(at) {
                Some(marker) => {
                    poses[marker.body.index()].place(self.state.design.geometry.marker(marker))
                }
                None => [undefined(); 2],
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

    /// Size of the mechanism, m.
    fn size(&self) -> f64 {
        let plain = self.state.design.plain.first();
        plain.map_or(1.0, |geometry| geometry.size(self.state.mechanism()))
    }

    /// Whether a point of the mechanism stands still here, as at the end of a stroke: its path has no direction then.
    pub fn stands_still(&self, point: PointId) -> bool {
        let stillness = self.stillness(self.point(&self.state.poses, point));
        stillness.nonnegative() == Some(true)
    }

    /// At least zero where a moving point stands still, below where it moves.
    fn stillness(&self, p: [Series<B>; 2]) -> B {
        let size = |order: usize| {
            let [x, y] = [0, 1].map(|k| p[k].derivative(order));
            length([x, y]) * kempe_number::powi(self.state.abscissa.unit, order as i32)
        };
        let speed = size(1) / self.size();
        let turns_back = (-speed + SLOW).min(size(2) * REVERSAL - size(1));
        (-speed + NO_SPEED).choose_with(B::one, || turns_back)
    }

    /// Instant centre of two links: the point where both have the same velocity. Infinite, in both coordinates, when they
    /// only translate against each other; none when they are at rest.
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
        let size = self.size();
        // How fast they slide and turn; where they are at rest for a moment, what they do next decides.
        let speeds = |order: usize| {
            let [x, y, w] = [v[0], v[1], w].map(|s| s.coefficient(order));
            let (slide, turn) = (length([x, y]), w.abs() * size);
            let unit = kempe_number::powi(self.state.abscissa.unit, order as i32 + 1);
            let rests = -(slide.max(turn) * unit) + NO_SPEED * size;
            (rests, slide * TRANSLATION - turn)
        };
        let ((rests, translates), (rests_on, translates_next)) = (speeds(0), speeds(1));
        let translates = rests.choose(translates_next, translates);
        let rests = rests.choose(rests_on, rests);
        [v[1] / w, -v[0] / w].map(|place| {
            let at_work = choose(translates, infinite(), place);
            choose(rests, undefined(), at_work)
        })
    }

    /// Curvature of a path and its centre, from the first two derivatives along the path parameter; none where the point
    /// stands still, and an infinite centre where the path is straight.
    fn curvature(&self, p: [Series<B>; 2]) -> (Series<B>, [Series<B>; 2]) {
        let still = self.stillness(p);
        let d = [p[0].differentiate(), p[1].differentiate()];
        let dd = [d[0].differentiate(), d[1].differentiate()];
        let square = dot(d, d);
        let bend = cross(d, dd);
        let speed = length([d[0].coefficient(0), d[1].coefficient(0)]);
        let straight =
            speed * speed * speed * TRANSLATION - bend.coefficient(0).abs() * self.size();
        let reach = square / bend;
        let n = left(d);
        let center = [0, 1].map(|k| {
            let center = choose(straight, infinite(), p[k] + n[k] * reach);
            choose(still, undefined(), center)
        });
        let curvature = bend / (square * square.sqrt());
        (choose(still, undefined(), curvature), center)
    }
}

fn length<B: Number>([x, y]: [B; 2]) -> B {
    (x.square() + y.square()).sqrt()
}

/// One of two series by the sign of a number, lane by lane.
fn choose<B: Number>(sign: B, nonnegative: Series<B>, negative: Series<B>) -> Series<B> {
    Series::constant(sign).choose(nonnegative, negative)
}
