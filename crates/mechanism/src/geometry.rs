//! Where the points and lines of every body lie in it, on one kind of number: everything the constraints need.

use kempe_number::Number;

use crate::curve::LocalCurve;
use crate::ids::{ArcRef, CurveRef, LineRef, Marker};
use crate::parts::Parts;
use crate::pose::{Pose, dot, left, sub};
use crate::sources::LineSource;

/// A directed line of a body, in the body's own coordinates.
#[derive(Clone, Copy, Debug)]
pub struct LocalLine<T> {
    /// A point of the line.
    pub origin: [T; 2],
    /// Its unit direction.
    pub direction: [T; 2],
}

/// An arc whose radius squared differs by this little, in parts of it, from that of a semicircle over its ends is one:
/// rounding decides no shape, and a root of zero would have no derivatives.
const SEMICIRCLE: f64 = 1e-12;

/// A part of a mechanism's largest coordinate: rounding of it is far below what steps to places are compared to, and only places nearer to the frame's
/// origin are touched by it.
const LEAST_REACH: f64 = 1e-4;

/// A circular arc of a body, in the body's own coordinates.
#[derive(Clone, Copy, Debug)]
pub struct LocalArc<T> {
    /// Centre.
    pub center: [T; 2],
    /// Radius.
    pub radius: T,
}

impl<T: Number> LocalArc<T> {
    /// The arc from one point to another whose centre lies on the left of the way for `side` +1, on the right for -1.
    /// NaN where the radius is too small to reach both.
    pub fn through(from: [T; 2], to: [T; 2], radius: T, side: f64) -> Self {
        let half = sub(to, from).map(|x| x * 0.5);
        let square = dot(half, half);
        let excess = radius.square() / square - 1.0;
        let nowhere = T::from_f64(f64::NAN);
        let bent = (excess - SEMICIRCLE).choose(excess.sqrt(), T::zero());
        let rise = (excess + SEMICIRCLE).choose(bent, nowhere) * side;
        let up = left(half);
        Self {
            center: [0, 1].map(|i| from[i] + half[i] + up[i] * rise),
            radius,
        }
    }
}

/// Constants of a gear pair or rack: `first angle_a + second angle_b - (first + second) angle_arm = constant`.
#[derive(Clone, Copy, Debug)]
pub struct GearConstants<T> {
    /// Factor of the first angle.
    pub first: T,
    /// Factor of the second angle.
    pub second: T,
    /// Right-hand side, link seats taken in.
    pub constant: T,
}

/// The dimensions of a mechanism in the coordinates of its bodies.
#[derive(Clone, Debug)]
pub struct Geometry<T> {
    /// Pose of every link in its body.
    pub seats: Vec<Pose<T>>,
    /// Angle of every link in its body, rad, its whole turns counted.
    pub seat_angles: Vec<T>,
    /// Whole turns, rad, by which every link's angle is counted further than its weld says.
    pub turns: Vec<f64>,
    /// Local coordinates of every marker in its body.
    pub markers: Vec<[T; 2]>,
    /// Lines.
    pub lines: Vec<LocalLine<T>>,
    /// Arcs.
    pub arcs: Vec<LocalArc<T>>,
    /// Smooth curves.
    pub curves: Vec<LocalCurve<T>>,
    /// Angle constants as unit vectors.
    pub angles: Vec<[T; 2]>,
    /// Gear constants.
    pub gears: Vec<GearConstants<T>>,
}

impl<T: Number> Geometry<T> {
    /// Evaluates a mechanism's dimensions for parameter values (SI, in the model's order).
    pub fn new(parts: &Parts, parameters: &[T]) -> Self {
        let zero = T::zero();
        let along = LocalLine {
            origin: [zero; 2],
            direction: [zero; 2],
        };
        let arc = LocalArc {
            center: [zero; 2],
            radius: zero,
        };
        let gear = GearConstants {
            first: zero,
            second: zero,
            constant: zero,
        };
        let mut it = Self {
            seats: vec![Pose::identity(); parts.model.links.len()],
            seat_angles: vec![zero; parts.model.links.len()],
            turns: vec![0.0; parts.model.links.len()],
            markers: vec![[zero; 2]; parts.markers.len()],
            lines: vec![along; parts.lines.len()],
            arcs: vec![arc; parts.arcs.len()],
            curves: (parts.curves.iter())
                .map(|curve| LocalCurve::unknown(curve.through.len(), curve.closed))
                .collect(),
            angles: vec![[T::one(), zero]; parts.angles.len()],
            gears: vec![gear; parts.gears.len()],
        };
        it.update(parts, parameters);
        it
    }

    /// Evaluates the dimensions anew, in the same storage.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn update(&mut self, parts: &Parts, parameters: &[T]) {
        for (index, link) in parts.model.links.iter().enumerate() {
            link.evaluate_into(parameters, &mut self.markers[parts.markers_of(index)]);
        }
        let is_plain = parts.lines.is_empty()
            && parts.arcs.is_empty()
            && parts.curves.is_empty()
            && parts.gears.is_empty()
            && parts.seats.iter().all(|seat| seat.weld.is_none())
            && parts.angles.iter().all(|angle| parts.is_zero(angle));
        if !is_plain {
            self.update_relations(parts, parameters);
        }
    }

    /// A length that coordinates of places are compared to, m, where they are nearly zero themselves: a small part of the largest in any body.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn least_reach(&self) -> T {
        let mut largest = T::from_f64(f64::MIN_POSITIVE);
        for marker in &self.markers {
            largest = largest.max(marker[0].abs()).max(marker[1].abs());
        }
        largest * LEAST_REACH
    }

    /// Evaluates what stands between links: welds, lines, angles and gears.
    #[inline(never)]
    fn update_relations(&mut self, parts: &Parts, parameters: &[T]) {
        let scalar = |expr: &kempe_model::Scalar| kempe_model::value(expr, parameters);
        if parts.seats.iter().any(|seat| seat.weld.is_some()) {
            self.seat_links(parts, &scalar);
        }
        for (index, line) in parts.lines.iter().enumerate() {
            self.lines[index] = match *line {
                LineSource::Points(from, to) => {
                    let origin = self.marker(from);
                    let span = sub(self.marker(to), origin);
                    let length = (span[0].square() + span[1].square()).sqrt();
                    LocalLine {
                        origin,
                        direction: [span[0] / length, span[1] / length],
                    }
                }
                LineSource::AxisOf(link) => {
                    let seat = self.seats[link.index()];
                    LocalLine {
                        origin: [seat.x, seat.y],
                        direction: [seat.c, seat.s],
                    }
                }
            };
        }
        for (index, arc) in parts.arcs.iter().enumerate() {
            let (from, to) = (self.marker(arc.from), self.marker(arc.to));
            self.arcs[index] = LocalArc::through(from, to, scalar(&arc.radius), arc.side);
        }
        for (index, curve) in parts.curves.iter().enumerate() {
            let points: Vec<[T; 2]> = curve.through.iter().map(|m| self.marker(*m)).collect();
            self.curves[index].update(&points);
        }
        for (index, angle) in parts.angles.iter().enumerate() {
            if parts.is_zero(angle) {
                // As it was made.
                continue;
            }
            let value = match angle.value {
                kempe_units::Expr::Const(0.0) => Pose::identity(),
                _ => Pose::from_angle(T::zero(), T::zero(), scalar(&angle.value)),
            };
            let base = match angle.along {
                Some(line) => self.line(line).direction,
                None => [self.seats[angle.b.index()].c, self.seats[angle.b.index()].s],
            };
            self.angles[index] = self.seats[angle.a.index()].unturn(value.turn(base));
        }
        for (index, gear) in parts.gears.iter().enumerate() {
            let (first, second) = (scalar(&gear.first), scalar(&gear.second));
            let seat = gear.links.map(|link| self.seat_angles[link.index()]);
            let constant =
                scalar(&gear.constant) - first * (seat[0] - seat[2]) - second * (seat[1] - seat[2]);
            self.gears[index] = GearConstants {
                first,
                second,
                constant,
            };
        }
    }

    /// Places welded links in their bodies, and their markers with them.
    fn seat_links(&mut self, parts: &Parts, scalar: &impl Fn(&kempe_model::Scalar) -> T) {
        let count = parts.model.links.len();
        let mut seats: Vec<Option<(Pose<T>, T)>> = vec![None; count];
        for link in 0..count {
            seat(parts, &self.markers, scalar, link, &mut seats);
        }
        for (link, seat) in seats.into_iter().enumerate() {
            let Some((pose, angle)) = seat else {
                continue;
            };
            self.seat_angles[link] = angle + self.turns[link];
            if parts.seats[link].weld.is_none() {
                continue;
            }
            self.seats[link] = pose;
            for marker in &mut self.markers[parts.markers_of(link)] {
                *marker = pose.place(*marker);
            }
        }
    }

    /// Counts every link's angle by these whole turns, rad, further than its weld says.
    pub fn count_turns(&mut self, parts: &Parts, turns: &[f64]) {
        if self.turns == turns {
            return;
        }
        let further = |link: usize| turns[link] - self.turns[link];
        for (link, angle) in self.seat_angles.iter_mut().enumerate() {
            *angle = *angle + further(link);
        }
        for (gear, source) in self.gears.iter_mut().zip(&parts.gears) {
            let [a, b, arm] = source.links.map(|link| further(link.index()));
            gear.constant = gear.constant - gear.first * (a - arm) - gear.second * (b - arm);
        }
        self.turns = turns.to_vec();
    }

    /// Local coordinates of a marker.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn marker(&self, marker: Marker) -> [T; 2] {
        self.markers[marker.index as usize]
    }

    /// A line in its body.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn line(&self, line: LineRef) -> LocalLine<T> {
        self.lines[line.index as usize]
    }

    /// An arc in its body.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn arc(&self, arc: ArcRef) -> LocalArc<T> {
        self.arcs[arc.index as usize]
    }

    /// A smooth curve in its body.
    #[inline]
    pub fn curve(&self, curve: CurveRef) -> &LocalCurve<T> {
        &self.curves[curve.index as usize]
    }

    /// The plain values.
    pub fn value(&self) -> Geometry<f64> {
        self.map(T::value)
    }

    /// Every dimension through `f`.
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> Geometry<U> {
        let mut it = Geometry {
            seats: Vec::new(),
            seat_angles: Vec::new(),
            turns: Vec::new(),
            markers: Vec::new(),
            lines: Vec::new(),
            arcs: Vec::new(),
            curves: Vec::new(),
            angles: Vec::new(),
            gears: Vec::new(),
        };
        it.assign(self, f);
        it
    }
}

impl<U: Number> Geometry<U> {
    /// Takes over every dimension of another design of the same mechanism through `f`, in the same storage.
    pub(crate) fn assign<T: Copy>(&mut self, other: &Geometry<T>, f: impl Fn(T) -> U) {
        let pair = |v: &[T; 2]| [f(v[0]), f(v[1])];
        refill(&mut self.seats, &other.seats, |p| Pose {
            x: f(p.x),
            y: f(p.y),
            c: f(p.c),
            s: f(p.s),
        });
        refill(&mut self.seat_angles, &other.seat_angles, |a| f(*a));
        self.turns.clone_from(&other.turns);
        refill(&mut self.markers, &other.markers, pair);
        refill(&mut self.lines, &other.lines, |l| LocalLine {
            origin: pair(&l.origin),
            direction: pair(&l.direction),
        });
        refill(&mut self.arcs, &other.arcs, |a| LocalArc {
            center: pair(&a.center),
            radius: f(a.radius),
        });
        self.curves
            .resize_with(other.curves.len(), || LocalCurve::unknown(0, true));
        for (curve, from) in self.curves.iter_mut().zip(&other.curves) {
            curve.assign(from, &f);
        }
        refill(&mut self.angles, &other.angles, pair);
        refill(&mut self.gears, &other.gears, |g| GearConstants {
            first: f(g.first),
            second: f(g.second),
            constant: f(g.constant),
        });
    }
}

/// Fills a list anew from another through `f`.
fn refill<T, U>(list: &mut Vec<U>, from: &[T], f: impl Fn(&T) -> U) {
    list.clear();
    list.extend(from.iter().map(f));
}

impl Geometry<f64> {
    /// Puts every shoe where its curve is nearest to its pin, the other bodies being where they are.
    pub fn place_shoes(&self, parts: &Parts, poses: &mut [Pose<f64>]) {
        for (source, curve) in parts.curves.iter().zip(&self.curves) {
            let Some(on) = source.through.first().map(|first| first.body) else {
                continue;
            };
            let pin = poses[source.pin.body.index()].place(self.marker(source.pin));
            let body = &poses[on.index()];
            let (angle, _) = curve.nearest(body.unturn(sub(pin, [body.x, body.y])));
            poses[source.shoe.index()] = Pose::from_angle(pin[0], pin[1], angle);
        }
    }

    /// A characteristic length of the mechanism, m: the largest distance of two markers of one body.
    pub fn size(&self, parts: &Parts) -> f64 {
        let mut low = vec![[f64::INFINITY; 2]; parts.bodies];
        let mut high = vec![[f64::NEG_INFINITY; 2]; parts.bodies];
        for (link, seat) in parts.seats.iter().enumerate() {
            let body = seat.body.index();
            for p in &self.markers[parts.markers_of(link)] {
                for k in 0..2 {
                    low[body][k] = low[body][k].min(p[k]);
                    high[body][k] = high[body][k].max(p[k]);
                }
            }
        }
        let size = (low.iter().zip(&high))
            .filter(|(l, h)| l[0] <= h[0])
            .map(|(l, h)| kempe_number::math::hypot(h[0] - l[0], h[1] - l[1]))
            .fold(0.0, f64::max);
        if size > 0.0 && size.is_finite() {
            size
        } else {
            1.0
        }
    }
}

/// Places a link in its body: welded links hang on the link they are welded to.
fn seat<T: Number>(
    parts: &Parts,
    local: &[[T; 2]],
    scalar: &impl Fn(&kempe_model::Scalar) -> T,
    link: usize,
    seats: &mut Vec<Option<(Pose<T>, T)>>,
) -> (Pose<T>, T) {
    if let Some(known) = seats[link] {
        return known;
    }
    let seated = match &parts.seats[link].weld {
        None => (Pose::identity(), T::zero()),
        Some((parent, point, angle)) => {
            let (base, base_angle) = seat(parts, local, scalar, parent.index(), seats);
            let find = |l: usize| {
                let points = &parts.model.links[l].points;
                points
                    .iter()
                    .position(|p| p.point == *point)
                    .map_or([T::zero(); 2], |i| local[parts.markers_of(l)][i])
            };
            let angle = scalar(angle);
            let turn = Pose::from_angle(T::zero(), T::zero(), angle);
            let [c, s] = base.turn([turn.c, turn.s]);
            (
                Pose::pinned(c, s, find(link), base.place(find(parent.index()))),
                base_angle + angle,
            )
        }
    };
    seats[link] = Some(seated);
    seated
}
