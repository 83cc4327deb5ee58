//! The mean of a measure over time, from the series at its samples.
//!
//! Between two samples the integral is that of the polynomial which agrees with as many coefficients of both series as are
//! known (two-point Hermite quadrature: N. Obreschkoff, 1940; order 2 m with m coefficients). It is held against the same
//! over two neighbouring intervals at once; where both differ, as at a kink, the interval is halved until whole and halves
//! agree.

use super::pole::Pole;
use super::survey::Point;
use crate::quadrature::{Floor, graded, integrate};
use kempe_number::math;

/// An integral over two intervals at once may differ from that by each by this part of the integral of the function's size.
/// Where it is smooth most of that is then taken off (L. F. Richardson's extrapolation); a kink that is not seen counts
/// less than that.
const NEIGHBOURS_AGREE: f64 = 1e-12;
/// What is taken off may be no more than this part.
const LEFT: f64 = 1e-13;
/// The integral by the whole may differ from that by halves by this part.
const AGREED: f64 = 1e-14;
/// An integral whose open parts differ by no more than this part of that of the function's size has settled.
const SETTLED: f64 = 1e-9;
/// Halvings at most, and so many more for every interval.
const HALVINGS: (usize, usize) = (4000, 64);
/// Where halving everything that is open leaves more than this part of all differences, and does so again, they are rounding
/// of the measure: a jump, which is slowest, leaves a half.
const LEFT_BY_ROUNDING: f64 = 0.7;
/// A part this much narrower than the interval that it came from is not halved further.
const NARROWEST: f64 = 1e-15;

/// Takes a sample at a time.
type Take<'t> = dyn FnMut(f64) -> Point + 't;

/// A measure's samples, stretch by stretch.
#[derive(Clone, Debug, Default)]
pub(super) struct Mean {
    stretches: Vec<Vec<Point>>,
}

/// An interval that is looked at more closely.
struct Part {
    ends: [Point; 2],
    middle: Point,
    /// Width of the interval that it came from.
    origin: f64,
    /// Its integral, by halves.
    integral: f64,
    /// By how much whole and halves differ.
    gap: f64,
}

impl Mean {
    /// Adds a sample; `begins` a stretch.
    pub fn add(&mut self, begins: bool, now: Point) {
        match self.stretches.last_mut() {
            Some(points) if !begins => points.push(now),
            _ => self.stretches.push(vec![now]),
        }
    }

    /// The mean over the samples' time, and how many of its digits hold where it did not settle; `known` coefficients of the
    /// series are known, `take` takes more samples, and at `poles` it is infinite.
    pub fn finish(
        &self,
        take: &mut Take<'_>,
        known: usize,
        duration: f64,
        poles: &[Pole],
    ) -> (f64, Option<u32>) {
        if duration <= 0.0 {
            let first = self.stretches.first().and_then(|points| points.first());
            return (first.map_or(f64::NAN, Point::value), None);
        }
        let size: f64 = (self.stretches.iter().flat_map(|points| points.windows(2)))
            .map(|pair| {
                let width = pair[1].time - pair[0].time;
                0.5 * width * (pair[0].value().abs() + pair[1].value().abs())
            })
            .filter(|size| size.is_finite())
            .sum();
        let (mut sum, mut unsure) = (self.between_stretches(known), 0.0);
        let mut open: Vec<Part> = Vec::new();
        let mut count = 0;
        let mut pieces = Vec::new();
        for points in &self.stretches {
            let (own, about_poles) = around_poles(take, points, poles, duration);
            pieces.extend(own);
            for (integral, doubt) in about_poles {
                sum += integral;
                unsure += doubt * integral.abs();
            }
        }
        for points in &pieces {
            let each: Vec<f64> = (points.windows(2))
                .map(|pair| hermite(&pair[0], &pair[1], known))
                .collect();
            let mut agrees = vec![each.len() > 1; each.len()];
            // What is left in each, by the pairs that it belongs to: one at the ends of a stretch, two elsewhere.
            let mut left = vec![0.0; each.len()];
            let last = each.len().max(1) - 1;
            for (index, three) in points.windows(3).enumerate() {
                let both = hermite(&three[0], &three[2], known);
                let gap = each[index] + each[index + 1] - both;
                let rests = extrapolated(gap, [&three[0], &three[1], &three[2]], known);
                let agree = gap.abs() <= NEIGHBOURS_AGREE * size
                    && rests.iter().all(|rest| rest.abs() <= LEFT * size);
                if !agree {
                    agrees[index..index + 2].fill(false);
                }
                for (k, rest) in [index, index + 1].into_iter().zip(rests) {
                    let pairs = if k == 0 || k == last { 1.0 } else { 2.0 };
                    left[k] += rest / pairs;
                }
            }
            count += each.len();
            for (index, integral) in each.into_iter().enumerate() {
                let (a, b) = (points[index], points[index + 1]);
                if agrees[index] {
                    sum += integral + left[index];
                } else if a.value().is_finite() && b.value().is_finite() {
                    open.push(Part::new(take, known, [a, b], b.time - a.time));
                } else {
                    sum += unbounded(take, [a.time, b.time], size);
                }
            }
        }
        let (rest, open) = closer(take, known, size, open, count);
        sum += rest;
        let open = open + unsure;
        let digits = (open > SETTLED * size).then(|| {
            let digits = -math::log10(open / sum.abs());
            digits.clamp(0.0, 15.0) as u32
        });
        (sum / duration, digits)
    }

    /// The integrals between stretches, by the series of the points beside: between what rests at an instant, a stretch of its own, and where
    /// it slides fast enough to be looked at by the latter's, about what turns back by those of both sides.
    fn between_stretches(&self, known: usize) -> f64 {
        let ends = self.stretches.windows(2).map(|pair| {
            let [before, behind] = [&pair[0], &pair[1]];
            let (Some(from), Some(to)) = (before.last(), behind.first()) else {
                return 0.0;
            };
            let width = to.time - from.time;
            if width <= 0.0 {
                return 0.0;
            }
            let of_before = match (before.len(), behind.len()) {
                (1, 2..) => 0.0,
                (2.., 1) => width,
                _ => 0.5 * width,
            };
            onwards(from, of_before, known) - onwards(to, of_before - width, known)
        });
        ends.filter(|integral| integral.is_finite()).sum()
    }
}

/// The integral of a point's series from there on.
fn onwards(point: &Point, width: f64, known: usize) -> f64 {
    let mut power = 1.0;
    let of = |k: usize| {
        power *= width;
        power * point.series.coefficient(k) / (k + 1) as f64
    };
    (0..finite(point, known)).map(of).sum()
}

impl Part {
    fn new(take: &mut Take<'_>, known: usize, ends: [Point; 2], origin: f64) -> Self {
        let [a, b] = ends;
        let middle = take(0.5 * (a.time + b.time));
        if !(a.time < middle.time && middle.time < b.time) {
            // There is no time between.
            return Self {
                ends,
                middle,
                origin,
                integral: hermite(&a, &b, known),
                gap: 0.0,
            };
        }
        let halves = hermite(&a, &middle, known) + hermite(&middle, &b, known);
        let gap = halves - hermite(&a, &b, known);
        let rests = extrapolated(gap, [&a, &middle, &b], known);
        Self {
            ends,
            middle,
            origin,
            integral: halves + rests[0] + rests[1],
            gap: gap.abs(),
        }
    }
}

/// The integral over parts, each halved until whole and halves agree, and by how much they differ all the same.
fn closer(
    take: &mut Take<'_>,
    known: usize,
    size: f64,
    mut open: Vec<Part>,
    intervals: usize,
) -> (f64, f64) {
    let mut sum = 0.0;
    let mut left = HALVINGS.0 + HALVINGS.1 * intervals;
    let (mut last, mut stalled) = (f64::INFINITY, false);
    loop {
        open.retain(|part| {
            let narrow = part.ends[1].time - part.ends[0].time <= NARROWEST * part.origin;
            let done = narrow || part.gap <= AGREED * size;
            if done {
                sum += part.integral;
            }
            !done
        });
        let all: f64 = (open.iter().map(|part| part.gap))
            .filter(|gap| gap.is_finite())
            .sum();
        let stalls = all > LEFT_BY_ROUNDING * last;
        if open.is_empty() || open.len() > left || stalls && stalled {
            break;
        }
        (last, stalled) = (all, stalls);
        left -= open.len();
        let mut finer = Vec::with_capacity(2 * open.len());
        for part in &open {
            let [a, b] = part.ends;
            if !part.middle.value().is_finite() {
                sum += unbounded(take, [a.time, b.time], size);
                continue;
            }
            for ends in [[a, part.middle], [part.middle, b]] {
                finer.push(Part::new(take, known, ends, part.origin));
            }
        }
        open = finer;
    }
    let gaps = open
        .iter()
        .map(|part| part.gap)
        .filter(|gap| gap.is_finite());
    let gap = gaps.sum();
    (
        sum + open.iter().map(|part| part.integral).sum::<f64>(),
        gap,
    )
}

/// A stretch's samples without those right about its poles, in pieces; and the integrals over what is left out between
/// them, each with what part of it is in doubt.
fn around_poles(
    take: &mut Take<'_>,
    points: &[Point],
    poles: &[Pole],
    duration: f64,
) -> (Vec<Vec<Point>>, Vec<(f64, f64)>) {
    let (mut pieces, mut integrals) = (vec![Vec::new()], Vec::new());
    let [Some(first), Some(last)] = [points.first(), points.last()] else {
        return (pieces, integrals);
    };
    let mut poles: Vec<&Pole> = (poles.iter())
        .filter(|pole| {
            let [from, to] = pole.sides(duration);
            first.time < to && from < last.time
        })
        .collect();
    poles.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut points = points.iter().copied().peekable();
    for pole in poles {
        let [from, to] = pole.sides(duration);
        let piece = pieces.last_mut();
        if let Some(piece) = piece {
            while let Some(point) = points.next_if(|point| point.time < from) {
                piece.push(point);
            }
            if from > first.time {
                let point = take(from);
                integrals.push((pole.integral(from, point.value()), pole.doubt));
                piece.push(point);
            }
        }
        while points.next_if(|point| point.time <= to).is_some() {}
        pieces.push(Vec::new());
        if to < last.time {
            let point = take(to);
            integrals.push((pole.integral(to, point.value()), pole.doubt));
            pieces
                .last_mut()
                .into_iter()
                .for_each(|piece| piece.push(point));
        }
    }
    if let Some(piece) = pieces.last_mut() {
        piece.extend(points);
    }
    (pieces, integrals)
}

/// The integral over an interval with no finite value at an end, or in its middle: ever closer steps towards both ends.
fn unbounded(take: &mut Take<'_>, [from, to]: [f64; 2], size: f64) -> f64 {
    let width = to - from;
    let found = integrate(&graded(2), Floor::of(size), &mut |u| {
        let time = from + width * (u * u * (3.0 - 2.0 * u));
        let weight = width * 6.0 * u * (1.0 - u);
        Some([weight * take(time).value()])
    });
    found.map_or(f64::NAN, |[integral]| integral)
}

/// What is left of the integrals over two neighbouring steps, of the `gap` by which both are more than one step over both:
/// with m coefficients a step errs as the 2 m + 1st power of its width.
fn extrapolated(gap: f64, points: [&Point; 3], known: usize) -> [f64; 2] {
    let orders = points.map(|p| finite(p, known));
    let order = orders[0];
    if order == 0 || orders != [order; 3] {
        return [0.0; 2];
    }
    let [a, b, c] = points.map(|p| p.time);
    let parts = [(b - a) / (c - a), (c - b) / (c - a)];
    let powers = parts.map(|part| (0..2 * order).fold(part, |power, _| power * part));
    powers.map(|power| gap * power / (1.0 - powers[0] - powers[1]))
}

/// How many of the `known` first coefficients are finite.
fn finite(point: &Point, known: usize) -> usize {
    let coefficients = point.series.coefficients().iter().take(known);
    coefficients.take_while(|c| c.is_finite()).count()
}

/// The integral of the polynomial that agrees with the finite ones of the `known` first coefficients at both points.
fn hermite(a: &Point, b: &Point, known: usize) -> f64 {
    let order = finite(a, known).min(finite(b, known));
    if order == 0 {
        return f64::NAN;
    }
    let width = b.time - a.time;
    // Of m coefficients the k-th is weighted C(m, k) / C(2 m, k) / k, counted from 1.
    let (m, mut ratio, mut power, mut sign, mut sum) = (order as f64, 1.0, 1.0, 1.0, 0.0);
    for k in 0..order {
        let counted = k as f64;
        ratio *= (m - counted) / (2.0 * m - counted);
        power *= width;
        let both = a.series.coefficient(k) + sign * b.series.coefficient(k);
        sum += ratio / (counted + 1.0) * power * both;
        sign = -sign;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Series;
    use kempe_number::Number;

    #[test]
    fn a_polynomial_of_twice_the_order_is_integrated_exactly() {
        for known in 1..=5_usize {
            for degree in 0..2 * known {
                let at = |t: f64| {
                    let x = Series::variable(t);
                    let power = (0..degree).fold(Series::from_f64(1.0), |p, _| p * x);
                    Point {
                        time: t,
                        series: power,
                    }
                };
                let (from, to) = (0.3_f64, 1.7_f64);
                let primitive = |t: f64| (0..=degree).fold(1.0, |p, _| p * t) / (degree + 1) as f64;
                let found = hermite(&at(from), &at(to), known);
                let truth = primitive(to) - primitive(from);
                assert!(
                    (found - truth).abs() < 1e-13 * truth.abs(),
                    "{known} {degree}: {found} {truth}"
                );
            }
        }
    }
}
