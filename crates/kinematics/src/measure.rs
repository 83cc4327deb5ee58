//! Measures evaluated: what the names of the model language mean at a pose, as series.
//!
//! Every measure is evaluated as a Taylor series: along the path of the drives, along time, or along one drive with
//! the others at rest. Rates and kinematic coefficients are then coefficients of the series, and no measure needs a
//! formula for its derivative.

use kempe_model::{
    DriveId, ForceMeasure, Leaf, Line, LinkId, LinkPointRef, Measure, PointId, PoseMeasure,
    Statistic,
};
use kempe_number::{Jet, Number, math};

use crate::mechanism::Mechanism;
use crate::pose::{Pose, cross, dot, left, sub};
use crate::state::Design;

/// Coefficients carried by a series: position and four derivatives.
pub const ORDER: usize = 5;

/// A series in the path parameter, in time or in one drive.
pub type Series<B> = Jet<B, ORDER>;

/// What a series runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The path parameter: the coordinate of the only moving drive, or time when several move.
    Path,
    /// Time.
    Time,
    /// One drive, the others at rest.
    Drive(DriveId),
}

/// Answers questions to the forces.
pub type Forces<'a, B> = &'a dyn Fn(&ForceMeasure) -> Series<B>;

/// A pose with its series along one variable, and all that is needed to measure it.
pub struct Moment<'a, B> {
    /// The mechanism.
    pub mechanism: &'a Mechanism,
    /// The design, as constants of the series.
    pub design: &'a Design<Series<B>>,
    /// Parameter values.
    pub parameters: &'a [B],
    /// Time, s.
    pub time: B,
    /// Poses along the path parameter.
    pub path: &'a [Pose<Series<B>>],
    /// The path parameter as a series in time.
    pub clock: Series<B>,
    /// Poses along each drive, where they were asked for.
    pub drives: &'a [Option<Vec<Pose<Series<B>>>>],
    /// The drive that is the path parameter itself.
    pub path_drive: Option<DriveId>,
    /// Drive coordinates along the path.
    pub coordinates: &'a [Series<B>],
    /// Angles of the bodies to within half a turn, rad.
    pub near: &'a [f64],
    /// Unwrapped values for directions between points of different bodies.
    pub directions: Vec<((PointId, PointId), f64)>,
    /// Lengths of path swept so far and since the start.
    pub swept: Vec<(PointId, B)>,
    /// Answers questions to the forces, where forces are computed.
    pub forces: Option<Forces<'a, B>>,
    /// Values of the statistics that occur, in SI.
    pub statistics: &'a [(Statistic, Measure, B)],
}

impl<B: Number> Moment<'_, B> {
    /// The value of a measure, SI.
    pub fn value(&self, measure: &Measure) -> B {
        self.series(measure, Along::Time).coefficient(0)
    }

    /// A measure as a series.
    pub fn series(&self, measure: &Measure, along: Along) -> Series<B> {
        measure.eval(&mut |leaf| self.leaf(leaf, along))
    }

    fn leaf(&self, leaf: &Leaf, along: Along) -> Series<B> {
        match leaf {
            Leaf::Parameter(id) => self
                .parameters
                .get(id.index())
                .map_or(Series::from_f64(f64::NAN), |value| Series::constant(*value)),
            Leaf::Named(index) => match self.mechanism.model.measures.get(*index) {
                Some(named) => self.series(&named.measure, along),
                None => Series::from_f64(f64::NAN),
            },
            Leaf::Drive(drive) => match along {
                Along::Drive(d) if d == *drive => {
                    Series::variable(self.coordinates[d.index()].coefficient(0))
                }
                Along::Drive(_) => Series::constant(self.coordinates[drive.index()].coefficient(0)),
                _ => self.along_time(self.coordinates[drive.index()], along),
            },
            Leaf::Time => match along {
                Along::Time => Series::variable(self.time),
                _ => Series::constant(self.time),
            },
            // Forces are known to the crate that computes them; here they have no value.
            Leaf::Force(measure) => self
                .forces
                .map_or(Series::from_f64(f64::NAN), |forces| forces(measure)),
            Leaf::Rate(measure, order) => (0..*order)
                .fold(self.series(measure, Along::Time), |series, _| {
                    series.differentiate()
                }),
            Leaf::Coefficient(measure, drive, order) => {
                self.coefficient(measure, *drive, *order, along)
            }
            Leaf::Over(statistic, measure) => {
                let known = self
                    .statistics
                    .iter()
                    .find(|(s, m, _)| s == statistic && m == &**measure);
                Series::constant(known.map_or(B::from_f64(f64::NAN), |(_, _, value)| *value))
            }
            Leaf::Pose(measure) => self.pose_measure(measure, along),
        }
    }

    /// The n-th derivative of a measure to a drive's coordinate. As a series in time it needs the drive to be the only
    /// one that moves; otherwise only its value is known and its derivatives are NaN.
    fn coefficient(
        &self,
        measure: &Measure,
        drive: DriveId,
        order: u32,
        along: Along,
    ) -> Series<B> {
        let series = (0..order).fold(self.series(measure, Along::Drive(drive)), |s, _| {
            s.differentiate()
        });
        match along {
            Along::Drive(d) if d == drive => series,
            _ if self.path_drive == Some(drive) => self.along_time(series, along),
            _ => {
                let mut coefficients = [B::from_f64(f64::NAN); ORDER];
                coefficients[0] = series.coefficient(0);
                Series::from_coefficients(coefficients)
            }
        }
    }

    /// A series along the path, along what is asked for.
    fn along_time(&self, series: Series<B>, along: Along) -> Series<B> {
        match along {
            // Without time (on a circuit) only the value is known.
            Along::Time if !self.clock.coefficient(1).value().is_finite() => {
                let mut coefficients = [B::from_f64(f64::NAN); ORDER];
                coefficients[0] = series.coefficient(0);
                Series::from_coefficients(coefficients)
            }
            Along::Time => series.compose(&self.clock),
            Along::Path | Along::Drive(_) => series,
        }
    }

    fn poses(&self, along: Along) -> &[Pose<Series<B>>] {
        match along {
            Along::Drive(drive) if self.path_drive != Some(drive) => self
                .drives
                .get(drive.index())
                .and_then(Option::as_deref)
                .unwrap_or(self.path),
            _ => self.path,
        }
    }

    /// What is geometry is measured along the path and carried over to time; what is motion is measured in time.
    fn pose_measure(&self, measure: &PoseMeasure, along: Along) -> Series<B> {
        if is_motion(measure) {
            return self.motion_measure(measure);
        }
        let poses = self.poses(along);
        let geometric = self.geometric(measure, poses, along);
        self.along_time(geometric, along)
    }

    fn point(&self, poses: &[Pose<Series<B>>], point: PointId) -> [Series<B>; 2] {
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

    fn angle(&self, poses: &[Pose<Series<B>>], link: LinkId) -> Series<B> {
        let body = self.mechanism.body_of(link).index();
        poses[body].angle_near(self.near[body]) + self.design.geometry.seat_angles[link.index()]
    }

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

    fn geometric(
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

    /// Measures of the motion in time.
    fn motion_measure(&self, measure: &PoseMeasure) -> Series<B> {
        let velocity = |p: PointId| {
            let at = self.point(self.path, p);
            [
                at[0].compose(&self.clock).differentiate(),
                at[1].compose(&self.clock).differentiate(),
            ]
        };
        match measure {
            PoseMeasure::Speed(p) => {
                let v = velocity(*p);
                dot(v, v).sqrt()
            }
            PoseMeasure::Acceleration(p) => {
                let v = velocity(*p);
                let a = [v[0].differentiate(), v[1].differentiate()];
                dot(a, a).sqrt()
            }
            PoseMeasure::AngularSpeed(link) => self
                .angle(self.path, *link)
                .compose(&self.clock)
                .differentiate(),
            PoseMeasure::AngularAcceleration(link) => self
                .angle(self.path, *link)
                .compose(&self.clock)
                .differentiate()
                .differentiate(),
            PoseMeasure::PathLength(p) => {
                let v = velocity(*p);
                let start = self
                    .swept
                    .iter()
                    .find(|(q, _)| q == p)
                    .map_or(B::from_f64(f64::NAN), |(_, length)| *length);
                dot(v, v).sqrt().integrate(start)
            }
            _ => Series::from_f64(f64::NAN),
        }
    }
}

/// Measures that only make sense in time.
fn is_motion(measure: &PoseMeasure) -> bool {
    matches!(
        measure,
        PoseMeasure::Speed(_)
            | PoseMeasure::Acceleration(_)
            | PoseMeasure::AngularSpeed(_)
            | PoseMeasure::AngularAcceleration(_)
            | PoseMeasure::PathLength(_)
    )
}

/// How often a measure must be differentiated to be evaluated, or why it cannot be.
///
/// # Errors
/// A sentence for the user: a rate inside a kinematic coefficient, or an order beyond what the series carry.
pub fn order_of(mechanism: &Mechanism, measure: &Measure) -> Result<u32, String> {
    let order = depth(mechanism, measure, false)?;
    if order as usize >= ORDER {
        return Err(format!(
            "needs derivatives of order {order}; the highest available is {}",
            ORDER - 1
        ));
    }
    Ok(order)
}

fn depth(mechanism: &Mechanism, measure: &Measure, in_coefficient: bool) -> Result<u32, String> {
    let mut deepest = 0;
    for leaf in measure.leaves() {
        let own = match leaf {
            Leaf::Parameter(_) | Leaf::Drive(_) | Leaf::Time => 0,
            Leaf::Force(_) if in_coefficient => {
                return Err("a force has no derivative to a drive".into());
            }
            Leaf::Force(_) => 2,
            Leaf::Named(index) => match mechanism.model.measures.get(*index) {
                Some(named) => depth(mechanism, &named.measure, in_coefficient)?,
                None => 0,
            },
            Leaf::Rate(_, _) if in_coefficient => {
                return Err("a rate in time has no derivative to a drive: take rate() of the coefficient instead".into());
            }
            Leaf::Rate(inner, order) => order + depth(mechanism, inner, false)?,
            Leaf::Coefficient(inner, _, order) => order + depth(mechanism, inner, true)?,
            Leaf::Over(_, inner) => {
                depth(mechanism, inner, false)?;
                0
            }
            Leaf::Pose(pose) if in_coefficient && is_motion(pose) => {
                return Err("a speed or acceleration in time has no derivative to a drive".into());
            }
            Leaf::Pose(pose) => match pose {
                PoseMeasure::Speed(_)
                | PoseMeasure::AngularSpeed(_)
                | PoseMeasure::InstantCenterX(..)
                | PoseMeasure::InstantCenterY(..) => 1,
                PoseMeasure::Acceleration(_)
                | PoseMeasure::AngularAcceleration(_)
                | PoseMeasure::Curvature(_)
                | PoseMeasure::CurvatureCenterX(_)
                | PoseMeasure::CurvatureCenterY(_) => 2,
                PoseMeasure::MechanicalAdvantage(inner, _) => 1 + depth(mechanism, inner, true)?,
                _ => 0,
            },
        };
        deepest = deepest.max(own);
    }
    Ok(deepest)
}

/// Calls `f` for every leaf of a measure, inside rates, coefficients, statistics and named measures as well.
pub fn visit_leaves(mechanism: &Mechanism, measure: &Measure, f: &mut impl FnMut(&Leaf)) {
    for leaf in measure.leaves() {
        f(leaf);
        match leaf {
            Leaf::Named(index) => {
                if let Some(named) = mechanism.model.measures.get(*index) {
                    visit_leaves(mechanism, &named.measure, f);
                }
            }
            Leaf::Rate(inner, _) | Leaf::Coefficient(inner, _, _) | Leaf::Over(_, inner) => {
                visit_leaves(mechanism, inner, f);
            }
            Leaf::Pose(PoseMeasure::MechanicalAdvantage(inner, _)) => {
                visit_leaves(mechanism, inner, f)
            }
            _ => {}
        }
    }
}

/// The direction from one point to another, principal value, rad.
pub(crate) fn plain_direction(
    mechanism: &Mechanism,
    design: &Design<f64>,
    poses: &[Pose<f64>],
    a: PointId,
    b: PointId,
) -> f64 {
    let place = |p: PointId| {
        mechanism.any_marker(p).map_or([f64::NAN; 2], |m| {
            poses[m.body.index()].place(design.geometry.marker(m))
        })
    };
    let v = sub(place(b), place(a));
    math::atan2(v[1], v[0])
}
