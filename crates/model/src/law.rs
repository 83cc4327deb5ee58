//! How a drive moves in time, in numbers: the coordinate of a [`Law`] and, on a Taylor number, all its derivatives.

use std::f64::consts::{PI, TAU};

use kempe_number::Number;
use kempe_units::Expr;

use crate::drive::{Law, LawPiece, RiseLaw};
use crate::geometry::value;
use crate::spline::{piece, spline_at};

/// A time this near to the end of a law, as a part of it, is the end: sums and quotients of a file's numbers miss it by
/// their rounding, and drives that end together do so to the last bit.
pub const SAME_END: f64 = 1e-12;

/// Secants that close in on a time before bisection does.
const SECANTS: usize = 3;
/// How far to both sides of a secant's root the time is looked for, in parts of it.
const NEAR_SECANT: f64 = 4.0 * f64::EPSILON;

/// A piece of a law with its place in time.
struct TimedPiece<'a, T> {
    piece: &'a LawPiece,
    start: T,
    from: T,
    duration: T,
    to: T,
}

/// When every piece of a law begins and where, for parameters that stay: see [`Law::placed`].
#[derive(Clone, Debug)]
pub struct PlacedLaw {
    from: f64,
    /// Start, coordinate there, duration and coordinate at the end, by piece.
    places: Vec<[f64; 4]>,
}

impl Law {
    /// Where its pieces lie, for who asks [`Law::at_placed`] often.
    pub fn placed(&self, parameters: &[f64]) -> PlacedLaw {
        PlacedLaw {
            from: value(&self.from, parameters),
            places: (self.stretches(parameters))
                .map(|s| [s.start, s.from, s.duration, s.to])
                .collect(),
        }
    }

    /// Whether its pieces lie there for other parameters, too: then it has the same coordinate at all times.
    pub fn is_placed(&self, placed: &PlacedLaw, parameters: &[f64]) -> bool {
        let places = placed.places.iter().copied();
        let own = self.stretches(parameters);
        value(&self.from, parameters) == placed.from
            && own.map(|s| [s.start, s.from, s.duration, s.to]).eq(places)
    }

    /// [`Law::at`] with its pieces where they lie.
    pub fn at_placed<T: Number>(&self, t: T, placed: &PlacedLaw) -> T {
        let start = T::from_f64(placed.from);
        let stretches = self.pieces.iter().zip(&placed.places);
        let stretches = stretches.map(|(piece, place)| {
            let [start, from, duration, to] = place.map(T::from_f64);
            TimedPiece {
                piece,
                start,
                from,
                duration,
                to,
            }
        });
        let after = || after(stretches, t, start, None);
        t.choose_with(after, || start)
    }

    /// A law that stands still, SI.
    pub fn standing(at: f64) -> Self {
        Self {
            from: Expr::Const(at),
            pieces: vec![LawPiece::Dwell {
                duration: Expr::Const(0.0),
            }],
        }
    }

    /// How long the law takes, s. A held coordinate takes no time.
    pub fn duration<T: Number>(&self, parameters: &[T]) -> T {
        self.stretches(parameters)
            .last()
            .map_or(T::zero(), |s| s.start + s.duration)
    }

    /// From where the law starts to where it ends, rad or m.
    pub fn way<T: Number>(&self, parameters: &[T]) -> T {
        self.at(self.duration(parameters), parameters) - self.at(T::zero(), parameters)
    }

    /// The coordinate (rad or m) at the time `t` s; before the start and behind the end the law stands still.
    ///
    /// With a Taylor number that runs in `t` this gives speed, acceleration and jerk as well. Where two pieces meet, the
    /// later one is meant; at the end the last piece, to within [`SAME_END`]: rates there are those of the motion.
    pub fn at<T: Number>(&self, t: T, parameters: &[T]) -> T {
        let start = value(&self.from, parameters);
        let after = || after(self.stretches(parameters), t, start, None);
        t.choose_with(after, || start)
    }

    /// As [`Law::at`], but before the start the first piece goes on, and behind `end`, where the motion ends, the last one of a law
    /// that ends there: so what is smooth at the ends of a motion can be looked at from both sides.
    pub fn going_on<T: Number>(&self, t: T, parameters: &[T], end: f64) -> T {
        let start = value(&self.from, parameters);
        after(self.stretches(parameters), t, start, Some(end))
    }

    /// The times at which one piece ends and the next begins, both ends of the motion included, s.
    pub fn breaks(&self, parameters: &[f64]) -> Vec<f64> {
        let mut breaks = vec![0.0];
        for stretch in self.stretches(parameters) {
            match stretch.piece {
                LawPiece::Polynomials(it) => {
                    breaks.extend(it.breaks().iter().skip(1).map(|t| stretch.start + t));
                }
                _ => breaks.push(stretch.start + stretch.duration),
            }
        }
        breaks
    }

    /// The times between which the law is smooth, those inside of pieces and both ends included, s, rising.
    pub fn knots(&self, parameters: &[f64]) -> Vec<f64> {
        let mut knots = self.breaks(parameters);
        for stretch in self.stretches(parameters) {
            knots.extend(stretch.piece.knots().iter().map(|t| stretch.start + t));
        }
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    }

    /// The times at which the coordinate turns back, both ends of the motion included, s, rising.
    pub fn turns(&self, parameters: &[f64]) -> Vec<f64> {
        let mut times = self.breaks(parameters);
        for stretch in self.stretches(parameters) {
            times.extend(turns(stretch.piece).iter().map(|t| stretch.start + t));
        }
        times.sort_by(f64::total_cmp);
        let mut kept: Vec<f64> = Vec::new();
        // Where it is last known to be, and which way it went there; where it rests it has not turned yet.
        let (mut last, mut way) = (self.at(0.0, parameters), 0.0);
        for pair in times.windows(2) {
            let next = self.at(pair[1], parameters);
            if next != last {
                if (next - last) * way <= 0.0 {
                    kept.push(pair[0]);
                }
                (last, way) = (next, next - last);
            }
        }
        kept.extend(times.last());
        kept
    }

    /// Smallest and largest coordinate of the motion (rad or m).
    pub fn extent(&self, parameters: &[f64]) -> (f64, f64) {
        let from = value(&self.from, parameters);
        let mut extent = (from, from);
        let mut take = |x: f64| extent = (extent.0.min(x), extent.1.max(x));
        for stretch in self.stretches(parameters) {
            take(stretch.to);
            for t in turns(stretch.piece) {
                take(stretch.at(t));
            }
        }
        extent
    }

    /// The first time at which the coordinate takes the value `x`, s; `None` when it never does.
    pub fn first_time(&self, x: f64, parameters: &[f64]) -> Option<f64> {
        self.times(x, parameters).next()
    }

    /// The times at which the coordinate comes to the value `x`, s, rising; where two pieces meet, or it turns, perhaps twice.
    pub fn times<'a>(&'a self, x: f64, parameters: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let at_once = value(&self.from, parameters) == x;
        let later = self.stretches(parameters);
        let later = later.flat_map(move |s| {
            let start = s.start;
            s.times(x).map(move |time| start + time)
        });
        at_once.then_some(0.0).into_iter().chain(later)
    }

    /// The pieces in their places, one after the other. An iterator, because laws are evaluated in every row of a motion on
    /// several drives, which must not allocate.
    fn stretches<'a, T: Number>(
        &'a self,
        parameters: &'a [T],
    ) -> impl ExactSizeIterator<Item = TimedPiece<'a, T>> + Clone {
        let mut start = T::zero();
        let mut from = value(&self.from, parameters);
        self.pieces.iter().map(move |piece| {
            let (to, duration) = match piece {
                LawPiece::ConstantSpeed { to, speed } => {
                    let to = value(to, parameters);
                    (to, (to - from).abs() / value(speed, parameters))
                }
                LawPiece::ConstantAcceleration { to, acceleration } => {
                    let to = value(to, parameters);
                    (
                        to,
                        ((to - from).abs() * 2.0 / value(acceleration, parameters)).sqrt(),
                    )
                }
                LawPiece::Dwell { duration } => (from, value(duration, parameters)),
                LawPiece::Rise { to, duration, .. } => {
                    (value(to, parameters), value(duration, parameters))
                }
                LawPiece::Table { times, values, .. } => {
                    let last = |list: &[f64]| T::from_f64(list.last().copied().unwrap_or(0.0));
                    (last(values), last(times))
                }
                LawPiece::Polynomials(it) => (T::from_f64(it.end()), T::from_f64(it.duration())),
            };
            let stretch = TimedPiece {
                piece,
                start,
                from,
                duration,
                to,
            };
            start += duration;
            from = to;
            stretch
        })
    }
}

/// The coordinate at a time that is not before the first of these stretches; `end` is where they begin. Those that end at
/// `on` go on behind it.
fn after<'a, T: Number>(
    mut stretches: impl ExactSizeIterator<Item = TimedPiece<'a, T>> + Clone,
    t: T,
    end: T,
    on: Option<f64>,
) -> T {
    let Some(stretch) = stretches.next() else {
        return end;
    };
    let later = stretches;
    let until = (stretch.start + stretch.duration).constant_part();
    let here = || stretch.at(t - stretch.start);
    let by_time = || {
        let behind = || after(later.clone(), t, stretch.to, on);
        (t - until).choose_with(behind, || match on {
            // Before the start, where nothing can go on in a stretch without duration.
            Some(_) => (-stretch.duration).choose_with(|| stretch.from, here),
            None => here(),
        })
    };
    if later.len() > 0 {
        return by_time();
    }
    let by_time = || match on {
        Some(on) => (until - on * (1.0 - SAME_END)).choose_with(here, by_time),
        None => by_time(),
    };
    // A last stretch without duration is none.
    (-stretch.duration).choose_with(by_time, || {
        let off = (t.constant_part() - until).abs();
        (until * SAME_END - off).choose_with(|| stretch.at_end(t), by_time)
    })
}

impl<T: Number> TimedPiece<'_, T> {
    /// The coordinate at a time counted from the stretch's start.
    fn at(&self, t: T) -> T {
        let travel = self.to - self.from;
        match self.piece {
            LawPiece::ConstantSpeed { .. } => self.from + travel * (t / self.duration),
            LawPiece::ConstantAcceleration { .. } => {
                self.from + travel * (t / self.duration).square()
            }
            LawPiece::Dwell { .. } => self.from,
            LawPiece::Rise { by, .. } => self.from + travel * by.at(t / self.duration),
            LawPiece::Table {
                times,
                values,
                moments,
            } => spline_at(times, values, moments, t),
            LawPiece::Polynomials(it) => it.at(t),
        }
    }
}

impl<T: Number> TimedPiece<'_, T> {
    /// The coordinate at the end of the stretch, exactly; with its rates where `t` is a series.
    fn at_end(&self, t: T) -> T {
        let local = t - self.start;
        let reached = self.at(local + (self.duration.constant_part() - local.constant_part()));
        reached + (self.to.constant_part() - reached.constant_part())
    }
}

impl<'a> TimedPiece<'a, f64> {
    /// The times, s from its start, at which the coordinate comes to `x`.
    fn times(self, x: f64) -> impl Iterator<Item = f64> + 'a {
        let mut ends = turns(self.piece);
        if ends.is_empty() {
            ends = vec![0.0, self.duration];
        }
        (1..ends.len()).filter_map(move |k| self.crossing(x, ends[k - 1], ends[k]))
    }

    /// The time in `[low, high]`, between which the coordinate is monotone, where it is `x`: by secants to near it, then by bisection to the
    /// last bit.
    fn crossing(&self, x: f64, mut low: f64, mut high: f64) -> Option<f64> {
        let rising = self.at(high) >= self.at(low);
        let beyond = |t: f64| {
            if rising {
                self.at(t) >= x
            } else {
                self.at(t) <= x
            }
        };
        if self.at(low) == x {
            return Some(low);
        }
        // The end is reached at the end: the formula may miss it by its last bits, and near rest it is there long before by rounding.
        if high == self.duration && self.to == x {
            return Some(high);
        }
        if !beyond(high) || beyond(low) {
            return None;
        }
        for _ in 0..SECANTS {
            let (below, above) = (self.at(low), self.at(high));
            let near = low + (x - below) / (above - below) * (high - low);
            let margin = NEAR_SECANT * near.abs();
            for time in [near - margin, near + margin] {
                if low < time && time < high {
                    if beyond(time) {
                        high = time
                    } else {
                        low = time
                    }
                }
            }
        }
        loop {
            let middle = low + (high - low) / 2.0;
            if middle <= low || middle >= high {
                return Some(high);
            }
            if beyond(middle) {
                high = middle
            } else {
                low = middle
            }
        }
    }
}

/// The times, s from its start, from one of which to the next a piece of several parts is monotone; none of any other, which
/// is monotone all along.
fn turns(piece: &LawPiece) -> Vec<f64> {
    match piece {
        LawPiece::Table {
            times,
            values,
            moments,
        } => knots_and_turns(times, values, moments).collect(),
        LawPiece::Polynomials(it) => it.turns(),
        _ => Vec::new(),
    }
}

/// The times of a table, and those between them at which its spline turns back: from one to the next it is monotone.
fn knots_and_turns<'a>(
    times: &'a [f64],
    values: &'a [f64],
    moments: &'a [f64],
) -> impl Iterator<Item = f64> + 'a {
    let pair = |list: &[f64], i: usize| Some([*list.get(i)?, *list.get(i + 1)?]);
    let segment = move |i: usize| {
        let [start, end] = pair(times, i)?;
        let [_, b, c, d] = piece(end - start, pair(values, i)?, pair(moments, i)?);
        let inside = move |t: &f64| start < *t && *t < end;
        let mut turns = zeros(b, 2.0 * c, 3.0 * d).map(|s| start + s);
        turns.sort_by(f64::total_cmp);
        Some(turns.into_iter().filter(inside))
    };
    (0..times.len()).flat_map(move |i| {
        let turns = segment(i).into_iter().flatten();
        times.get(i).copied().into_iter().chain(turns)
    })
}

/// The zeros of `a + b x + c x^2`, without cancellation; not finite where there is none.
fn zeros(a: f64, b: f64, c: f64) -> [f64; 2] {
    let sum = b + (b * b - 4.0 * a * c).sqrt().copysign(b);
    [-0.5 * sum / c, -2.0 * a / sum]
}

/// A law whose end is its beginning turned round, by that near the end: there the terms of a polynomial differ by rounding, and the sense of its speed with them.
fn to_rest<T: Number>(s: T, law: impl Fn(T) -> T) -> T {
    (s - NEAR_REST).choose_with(|| -law(-s + 1.0) + 1.0, || law(s))
}

/// The part of the time behind which that is done.
const NEAR_REST: f64 = 0.99;

impl RiseLaw {
    /// The part of the rise done when the part `s` in `[0, 1]` of the time has passed; from 0 to 1.
    ///
    /// Source: VDI 2143 part 1 (1980), the standard laws from rest to rest.
    pub fn at<T: Number>(self, s: T) -> T {
        match self {
            RiseLaw::Cycloidal => s - (s * TAU).sin_cos().0 / TAU,
            RiseLaw::Harmonic => (-(s * PI).sin_cos().1 + 1.0) / 2.0,
            RiseLaw::Polynomial345 => {
                to_rest(s, |s| s.square() * s * ((s * 6.0 - 15.0) * s + 10.0))
            }
            RiseLaw::Polynomial4567 => to_rest(s, |s| {
                s.square().square() * (((s * -20.0 + 70.0) * s - 84.0) * s + 35.0)
            }),
        }
    }

    /// The law's name in a model file.
    pub const fn name(self) -> &'static str {
        match self {
            RiseLaw::Cycloidal => "cycloidal",
            RiseLaw::Harmonic => "harmonic",
            RiseLaw::Polynomial345 => "3-4-5",
            RiseLaw::Polynomial4567 => "4-5-6-7",
        }
    }

    /// All of them.
    pub const ALL: [RiseLaw; 4] = [
        RiseLaw::Cycloidal,
        RiseLaw::Harmonic,
        RiseLaw::Polynomial345,
        RiseLaw::Polynomial4567,
    ];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::moments;
    use kempe_number::{Interval, Jet, Lanes};

    fn c(x: f64) -> Expr<crate::ids::ParameterId> {
        Expr::Const(x)
    }

    fn laws() -> Vec<Law> {
        let rise = |by| LawPiece::Rise {
            to: c(1.7),
            duration: c(0.8),
            by,
        };
        let times = vec![0.0, 0.3, 0.5, 1.1, 1.4];
        let values = vec![0.5, 0.9, 0.2, 0.4, 1.0];
        let moments = moments(&times, &values);
        let mut laws: Vec<Law> = RiseLaw::ALL
            .iter()
            .map(|by| Law {
                from: c(0.5),
                pieces: vec![rise(*by)],
            })
            .collect();
        laws.push(Law {
            from: c(0.5),
            pieces: vec![LawPiece::Table {
                times,
                values,
                moments,
            }],
        });
        laws.push(Law {
            from: c(0.5),
            pieces: vec![
                LawPiece::Dwell { duration: c(0.2) },
                rise(RiseLaw::Polynomial4567),
                LawPiece::ConstantSpeed {
                    to: c(-0.3),
                    speed: c(4.0),
                },
                LawPiece::ConstantAcceleration {
                    to: c(0.4),
                    acceleration: c(2.0),
                },
            ],
        });
        laws
    }

    /// Source: central differences of fourth order; their error is far below the tolerance at this step.
    #[test]
    fn series_agree_with_differences() {
        for law in laws() {
            let breaks = law.breaks(&[]);
            for w in breaks.windows(2) {
                let (t, h) = (w[0] + 0.37 * (w[1] - w[0]), 1e-4);
                let x: Jet<f64, 4> = law.at(Jet::variable(t), &[]);
                let f = |k: f64| law.at(t + k * h, &[]);
                let speed = (f(-2.0) - 8.0 * f(-1.0) + 8.0 * f(1.0) - f(2.0)) / (12.0 * h);
                let acceleration = (f(-1.0) - 2.0 * f(0.0) + f(1.0)) / (h * h);
                assert_eq!(x.value(), law.at(t, &[]));
                assert!((x.derivative(1) - speed).abs() < 1e-9, "{law:?}");
                assert!((x.derivative(2) - acceleration).abs() < 1e-4, "{law:?}");
            }
        }
    }

    #[test]
    fn laws_go_one_way_between_their_turns() {
        let piece = |values: &[f64]| {
            let times: Vec<f64> = (0..values.len()).map(|k| 0.3 * k as f64).collect();
            LawPiece::Table {
                moments: moments(&times, values),
                values: values.to_vec(),
                times,
            }
        };
        let rest = |duration| LawPiece::Dwell {
            duration: c(duration),
        };
        let late = Law {
            from: c(0.0),
            pieces: vec![
                rest(0.5),
                piece(&[0.0, 1.0, 0.2, 0.2, 0.9]),
                rest(0.2),
                piece(&[0.9, 0.1, 0.4]),
                rest(0.1),
            ],
        };
        assert_eq!(late.turns(&[]).len(), 6, "{:?}", late.turns(&[]));
        for law in laws().into_iter().chain([late]) {
            let turns = law.turns(&[]);
            assert!(turns.is_sorted());
            let way = |from: f64, to: f64| law.at(to, &[]) - law.at(from, &[]);
            let mut last = 0.0;
            for w in turns.windows(2) {
                let whole = way(w[0], w[1]);
                assert!(whole * last <= 0.0, "{law:?} goes on at {}", w[0]);
                let at = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / 200.0;
                for k in 0..200 {
                    assert!(way(at(k), at(k + 1)) * whole >= -1e-15, "{law:?}: {w:?}");
                }
                last = whole;
            }
        }
    }

    #[test]
    fn standard_laws_start_and_end_at_rest() {
        for law in laws().iter().take(4) {
            let LawPiece::Rise { by, .. } = law.pieces[0] else {
                panic!()
            };
            for (t, x) in [(0.0, 0.5), (0.8, 1.7)] {
                let series: Jet<f64, 4> = law.at(Jet::variable(t), &[]);
                assert!((series.value() - x).abs() < 1e-15);
                assert!(series.derivative(1).abs() < 1e-12);
                let smooth = by != RiseLaw::Harmonic;
                assert_eq!(series.derivative(2).abs() < 1e-11, smooth, "{by:?}");
                let calm = series.derivative(3).abs() < 1e-8;
                assert_eq!(
                    calm,
                    matches!(by, RiseLaw::Polynomial4567 | RiseLaw::Harmonic),
                    "{by:?}"
                );
            }
        }
    }

    /// A polynomial comes to rest as it left it, to the last digits of its speed: their sign is the sense of friction.
    #[test]
    fn polynomials_end_as_they_begin() {
        for law in [RiseLaw::Polynomial345, RiseLaw::Polynomial4567] {
            for k in 2..9 {
                let part = kempe_number::powi(2.0, -4 * k);
                let [begins, ends] = [part, 1.0 - part].map(|s| {
                    let series: Jet<f64, 4> = law.at(Jet::variable(s));
                    series.derivative(1)
                });
                assert!(
                    (begins / ends - 1.0).abs() < 1e-12,
                    "{law:?}: {begins} {ends}"
                );
            }
        }
    }

    #[test]
    fn pieces_follow_each_other_and_the_law_stands_still_outside() {
        let law = &laws()[5];
        let breaks = law.breaks(&[]);
        assert!(
            (law.duration::<f64>(&[]) - (0.2 + 0.8 + 0.5 + (1.4f64 / 2.0).sqrt())).abs() < 1e-15
        );
        for t in &breaks[1..4] {
            assert!((law.at(*t, &[]) - law.at(*t - 1e-12, &[])).abs() < 1e-10);
        }
        assert_eq!((law.at(-1.0, &[]), law.at(99.0, &[])), (0.5, 0.4));
        assert_eq!(law.extent(&[]), (-0.3, 1.7));
        let held = Law {
            from: c(3.0),
            pieces: vec![LawPiece::Dwell { duration: c(0.0) }],
        };
        assert_eq!(
            (
                held.duration::<f64>(&[]),
                held.at(0.0, &[]),
                held.at(5.0, &[])
            ),
            (0.0, 3.0, 3.0)
        );
    }

    /// The extent of a table holds all of its spline, which overshoots between points that lie unevenly, and no more; the first
    /// time of its ends is where they are.
    #[test]
    fn a_table_reaches_as_far_as_its_spline() {
        for times in [
            vec![0.0, 1.0, 1.001, 1.002, 2.0],
            vec![0.0, 0.3, 0.5, 2.0, 2.1],
        ] {
            let values = vec![0.0, 3.1, 3.2, 3.2, 6.3];
            let moments = crate::spline::moments(&times, &values);
            let end = times[times.len() - 1];
            let law = Law {
                from: c(0.0),
                pieces: vec![LawPiece::Table {
                    times,
                    values,
                    moments,
                }],
            };
            let (low, high) = law.extent(&[]);
            let slack = 1e-12 * (high - low);
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..=100_000 {
                let x: f64 = law.at(end * f64::from(k) / 1e5, &[]);
                assert!(low - slack <= x && x <= high + slack, "{x} {low} {high}");
                (least, most) = (least.min(x), most.max(x));
            }
            let near = 1e-6 * (high - low);
            assert!(least - low < near && high - most < near);
            for x in [low, high] {
                let t = law.first_time(x, &[]).unwrap();
                assert!((law.at::<f64>(t, &[]) - x).abs() <= slack, "{x} {t}");
            }
        }
    }

    /// Times in several pieces at once: each lane has the bits of its own, an interval holds all between.
    #[test]
    fn every_part_of_a_time_is_in_its_own_piece() {
        for law in laws() {
            let end = law.duration::<f64>(&[]);
            let times: [f64; 16] = std::array::from_fn(|k| end * (k as f64 / 12.0 - 0.1));
            let lanes: Jet<Lanes<16>, 3> = law.at(Jet::variable(Lanes(times)), &[]);
            for (lane, t) in times.iter().enumerate() {
                let alone: Jet<f64, 3> = law.at(Jet::variable(*t), &[]);
                let found = lanes.coefficients().map(|c| c.lane(lane));
                assert_eq!(found, *alone.coefficients(), "{law:?} {t}");
            }
            for (k, low) in times.iter().enumerate() {
                for high in &times[k..] {
                    let bounds = law.at(Interval::new(*low, *high), &[]);
                    for i in 0..=20 {
                        let t = low + (high - low) * f64::from(i) / 20.0;
                        let x: f64 = law.at(t, &[]);
                        // A number is held with the rounding of its own evaluation.
                        let near = bounds + Interval::new(-1e-14, 1e-14);
                        assert!(near.contains(x), "{law:?} {t}: {x} not in {bounds:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn first_time_finds_the_coordinate() {
        for law in laws() {
            for x in [0.5, 0.6, 0.999, 1.0] {
                let t = law.first_time(x, &[]).unwrap();
                assert!((law.at(t, &[]) - x).abs() < 1e-14, "{law:?} {x} {t}");
            }
            assert_eq!(law.first_time(9.0, &[]), None);
        }
    }

    /// Near rest rounding hides the last of the way.
    #[test]
    fn the_end_is_reached_at_the_end() {
        for by in RiseLaw::ALL {
            for to in [1.7, -2.0, 0.3] {
                let piece = LawPiece::Rise {
                    to: c(to),
                    duration: c(0.8),
                    by,
                };
                let law = Law {
                    from: c(0.5),
                    pieces: vec![piece],
                };
                assert_eq!(law.first_time(to, &[]), Some(0.8), "{by:?}");
            }
        }
    }

    /// Of a law by a formula the first time is the very first at which it is there, up to what rounding hides.
    #[test]
    fn nothing_is_there_before_the_first_time() {
        for law in laws() {
            for k in 1..50 {
                let x = 0.5 + 0.49 * f64::from(k) / 50.0;
                let t = law.first_time(x, &[]).unwrap();
                for part in 0..1000 {
                    let earlier = t * (1.0 - 1e-9) * f64::from(part) / 1000.0;
                    assert!(law.at(earlier, &[]) < x, "{law:?} {x} {t} {earlier}");
                }
            }
        }
    }
}
