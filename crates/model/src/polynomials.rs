//! Polynomials in time, one after the other: coordinates that were found, such as by a simulation.

use kempe_number::{Number, piecewise, polynomial_through};

/// Coefficients of one polynomial.
pub const COEFFICIENTS: usize = 9;

/// A part of a polynomial this short says nothing more of where its slope vanishes.
const SHORTEST: f64 = 1e-9;

/// Where the coordinates at the ends of a polynomial are rounded by this part of what the largest acceleration moves, they say little of accelerations.
const OF_ROUNDING: f64 = 1e-8;
/// Accelerations tell how the speed changed to so much of what the largest does, and to so many roundings of both speeds.
const AGREES: f64 = 1e-11;
const ROUNDINGS: f64 = 8.0;

/// Polynomials of degree 8 that follow each other in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomials {
    /// Where each begins, and where the last one ends, s, rising.
    times: Vec<f64>,
    /// Coefficients of each in the time from its middle, in halves of its length.
    coefficients: Vec<[f64; COEFFICIENTS]>,
    /// The times, and those at which the coordinate turns back: from one to the next it is monotone.
    turns: Vec<f64>,
    /// Coordinate, speed and half the acceleration at both ends.
    ends: [[f64; 3]; 2],
}

impl Polynomials {
    /// The polynomials through given states, coordinate, speed and acceleration at the ends of each, and given accelerations at
    /// its quarters: an error of places inside, which a second derivative would magnify, has no part in them. Where they are so short
    /// that the rounding of the coordinates at both ends would show in the accelerations between, these alone lead back from the end.
    /// `None` where the times do not rise or the numbers of times, states and quarters do not agree.
    pub fn through(times: &[f64], ends: &[[f64; 3]], quarters: &[[f64; 3]]) -> Option<Self> {
        let fits = times.len() == ends.len() && ends.len() == quarters.len() + 1;
        if !fits || quarters.is_empty() || !times.windows(2).all(|w| w[0] < w[1]) {
            return None;
        }
        let of = |(k, quarters): (usize, &[f64; 3])| {
            let half = 0.5 * (times[k + 1] - times[k]);
            let ends = [ends[k], ends[k + 1]];
            back_from_end(half, ends, *quarters)
                .unwrap_or_else(|| polynomial(half, ends, *quarters))
        };
        let coefficients = quarters.iter().enumerate().map(of).collect();
        Some(Self::new(times, coefficients))
    }

    /// The rate in the middle of one such polynomial that lasts so long, s.
    pub fn middle_rate(long: f64, ends: [[f64; 3]; 2], quarters: [f64; 3]) -> f64 {
        let half = 0.5 * long;
        polynomial(half, ends, quarters)[1] / half
    }

    /// The polynomials through values at equal parts of each, both ends included. `None` where the times do not rise, or there
    /// are not values for every polynomial.
    pub fn at_equal_parts(times: &[f64], values: &[[f64; COEFFICIENTS]]) -> Option<Self> {
        let fits = times.len() == values.len() + 1 && !values.is_empty();
        let places: [f64; COEFFICIENTS] =
            std::array::from_fn(|k| 2.0 * k as f64 / (COEFFICIENTS - 1) as f64 - 1.0);
        let of = |values: &[f64; COEFFICIENTS]| {
            let mut coefficients = *values;
            polynomial_through(&places, &mut coefficients);
            coefficients
        };
        (fits && times.windows(2).all(|w| w[0] < w[1]))
            .then(|| Self::new(times, values.iter().map(of).collect()))
    }

    fn new(times: &[f64], coefficients: Vec<[f64; COEFFICIENTS]>) -> Self {
        let side = |k: usize, s: f64| {
            let (half, c) = (0.5 * (times[k + 1] - times[k]), &coefficients[k]);
            let [[slope, _], [second, _]] = slope_about(c, s, 0.0);
            // At 1 the sum of all, at -1 of all with signs in turn.
            let value = match s > 0.0 {
                true => c.iter().sum(),
                false => c.iter().rev().fold(0.0, |sum, c| c - sum),
            };
            [value, slope / half, 0.5 * second / (half * half)]
        };
        let mut it = Self {
            ends: [side(0, -1.0), side(coefficients.len() - 1, 1.0)],
            times: times.to_vec(),
            turns: Vec::with_capacity(times.len()),
            coefficients,
        };
        for k in 0..it.coefficients.len() {
            let [from, to] = it.span(k);
            it.turns.push(from);
            let mut turns = Vec::new();
            flat(&it.coefficients[k], -1.0, 1.0, &mut turns);
            for turn in turns {
                let t = it.time_in(k, turn);
                if from < t && t < to {
                    it.turns.push(t);
                }
            }
        }
        it.turns.extend(times.last());
        it
    }

    /// Whether the coordinate stays at a value.
    pub fn is_constant(&self, value: f64) -> bool {
        let stays = |c: &[f64; COEFFICIENTS]| c[0] == value && c[1..].iter().all(|c| *c == 0.0);
        self.coefficients.iter().all(stays)
    }

    /// Where each begins, and where the last one ends, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The times, and those at which the coordinate turns back, rising.
    fn turns(&self) -> &[f64] {
        &self.turns
    }

    /// How long they last together, s.
    fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The coordinate at a time; farther out than the polynomials at the ends are long, by parabolas, for high powers say nothing there.
    fn at<T: Number>(&self, t: T) -> T {
        let last = self.coefficients.len();
        let out = |side: usize, from: f64| {
            let [q, v, a] = self.ends[side];
            let past = t - from;
            (past * a + v) * past + q
        };
        let [first, end] = [self.times[0], self.times[last]];
        let [early, late] = [self.times[1] - first, end - self.times[last - 1]];
        (t - (end + late)).choose_with(
            || out(1, end),
            || (t - (first - early)).choose_with(|| self.within(t), || out(0, first)),
        )
    }

    fn within<T: Number>(&self, t: T) -> T {
        let past = |k: usize| t - self.times[k];
        let [value] = piecewise(self.coefficients.len(), &past, &|k| {
            let Some(coefficients) = self.coefficients.get(k) else {
                return [T::from_f64(f64::NAN)];
            };
            let [from, to] = self.span(k);
            let s = (t - 0.5 * (from + to)) / (0.5 * (to - from));
            let sum = coefficients.iter().rev();
            [sum.fold(T::zero(), |sum, c| sum * s + *c)]
        });
        value
    }

    fn span(&self, k: usize) -> [f64; 2] {
        [self.times[k], self.times[k + 1]]
    }

    /// The time of a place of a polynomial, from -1 to 1.
    fn time_in(&self, k: usize, place: f64) -> f64 {
        let [from, to] = self.span(k);
        0.5 * (from + to) + 0.5 * (to - from) * place
    }
}

/// Stretches of polynomials, one after the other in time. Where one ends and the next begins, rates may jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretches {
    stretches: Vec<Polynomials>,
    /// Where each begins, and where the last one ends, s.
    breaks: Vec<f64>,
    /// Where every polynomial begins, and where the last one ends, s, rising.
    knots: Vec<f64>,
}

impl Stretches {
    /// The times of each count from its own start; `None` where there is none.
    pub fn new(stretches: Vec<Polynomials>) -> Option<Self> {
        let mut breaks = vec![0.0];
        let mut end = 0.0;
        for stretch in &stretches {
            end += stretch.duration();
            breaks.push(end);
        }
        let knots = times_of(&stretches, &breaks, Polynomials::times);
        (!stretches.is_empty()).then_some(Self {
            stretches,
            breaks,
            knots,
        })
    }

    /// Where each begins, and where the last one ends, s.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Where every polynomial begins, and where the last one ends, s, rising.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The knots, and the times at which the coordinate turns back, s, rising.
    pub(crate) fn turns(&self) -> Vec<f64> {
        times_of(&self.stretches, &self.breaks, Polynomials::turns)
    }

    /// How long they last together, s.
    pub(crate) fn duration(&self) -> f64 {
        self.breaks.last().copied().unwrap_or(0.0)
    }

    /// The coordinate at the end.
    pub(crate) fn end(&self) -> f64 {
        self.stretches.last().map_or(f64::NAN, |it| it.ends[1][0])
    }

    /// The coordinate at a time.
    pub(crate) fn at<T: Number>(&self, t: T) -> T {
        let past = |k: usize| t - self.breaks[k];
        let [value] = piecewise(self.stretches.len(), &past, &|k| {
            let unknown = || T::from_f64(f64::NAN);
            let stretch = self.stretches.get(k);
            [stretch.map_or_else(unknown, |stretch| stretch.at(past(k)))]
        });
        value
    }
}

/// Times of stretches that begin at these times, where those of one are at its ends the same as its neighbours'.
fn times_of(
    stretches: &[Polynomials],
    breaks: &[f64],
    of: impl Fn(&Polynomials) -> &[f64],
) -> Vec<f64> {
    let all = stretches.iter().zip(breaks);
    let all = all.flat_map(|(stretch, from)| of(stretch).iter().map(move |t| from + t));
    let mut times: Vec<f64> = all.collect();
    times.dedup();
    times
}

/// The polynomial through coordinate, speed and acceleration at -1 and 1 and through accelerations at -1/2, 0 and 1/2, where
/// `half` is the time of 1.
fn polynomial(half: f64, ends: [[f64; 3]; 2], quarters: [f64; 3]) -> [f64; COEFFICIENTS] {
    let [low, high] = ends.map(|[q, v, a]| [q, v * half, a * half * half]);
    let [before, middle, after] = quarters.map(|a| a * half * half);
    // Even and odd parts are solved apart, by elimination.
    let c2 = 0.5 * middle;
    let slope = 0.5 * (high[1] - low[1]) - middle;
    let quarter = 0.5 * (after + before) - middle;
    let end = 0.5 * (high[2] + low[2]) - middle;
    let c8 = (quarter - 0.75 * slope + 0.21875 * (end - 3.0 * slope)) / 1.875;
    let c6 = (end - 3.0 * slope - 32.0 * c8) / 12.0;
    let c4 = (slope - 6.0 * c6 - 8.0 * c8) / 4.0;
    let c0 = 0.5 * (high[0] + low[0]) - c2 - c4 - c6 - c8;
    let value = 0.5 * (high[0] - low[0]);
    let slope = 0.5 * (high[1] + low[1]) - value;
    let quarter = 0.5 * (after - before);
    let end = 0.5 * (high[2] - low[2]);
    let c7 = (quarter - 1.5 * slope + 0.4375 * (end - 3.0 * slope)) / 2.8125;
    let c5 = (end - 3.0 * slope - 24.0 * c7) / 8.0;
    let c3 = 0.5 * (slope - 4.0 * c5 - 6.0 * c7);
    let c1 = value - c3 - c5 - c7;
    [c0, c1, c2, c3, c4, c5, c6, c7, c8]
}

/// The polynomial through coordinate and speed at 1 and through accelerations at both ends and at -1/2, 0 and 1/2, where `half` is the
/// time of 1; `None` where the coordinate at -1 says more than that, or these accelerations do not tell how the speed changed.
fn back_from_end(
    half: f64,
    ends: [[f64; 3]; 2],
    quarters: [f64; 3],
) -> Option<[f64; COEFFICIENTS]> {
    let [[start, slow, first], [q, v, last]] = ends;
    let [before, middle, after] = quarters;
    let rounding = f64::EPSILON * (start.abs() + q.abs());
    let largest = [first, before, middle, after, last].map(f64::abs);
    let largest = largest.into_iter().fold(0.0, f64::max);
    if rounding <= OF_ROUNDING * largest * half * half {
        return None;
    }
    let mut bends = [first, before, middle, after, last];
    polynomial_through(&[-1.0, -0.5, 0.0, 0.5, 1.0], &mut bends);
    let mut c = [0.0; COEFFICIENTS];
    for (k, bend) in bends.iter().enumerate() {
        c[k + 2] = bend * half * half / ((k + 1) * (k + 2)) as f64;
    }
    c[1] = v * half - (2..COEFFICIENTS).map(|k| k as f64 * c[k]).sum::<f64>();
    c[0] = q - c[1..].iter().sum::<f64>();
    let [[back, _], _] = slope_about(&c, -1.0, 0.0);
    let near = AGREES * largest * half + ROUNDINGS * f64::EPSILON * (slow.abs() + v.abs());
    ((back / half - slow).abs() <= near).then_some(c)
}

/// Slope and how much it may change within `half` of a place, by its own derivatives there; and the same of its derivative.
fn slope_about(coefficients: &[f64; COEFFICIENTS], at: f64, half: f64) -> [[f64; 2]; 2] {
    // Coefficients about the place, by repeated synthetic division.
    let mut c = *coefficients;
    for first in 0..COEFFICIENTS {
        for k in (first..COEFFICIENTS - 1).rev() {
            c[k] += at * c[k + 1];
        }
    }
    let (mut change, mut bend) = (0.0, 0.0);
    let mut power = half;
    for k in 2..COEFFICIENTS {
        let n = k as f64;
        change += n * c[k].abs() * power;
        if k > 2 {
            bend += n * (n - 1.0) * c[k].abs() * power / half;
        }
        power *= half;
    }
    [[c[1], change], [2.0 * c[2], bend]]
}

/// The places between `low` and `high` where the slope changes its sign, rising: parts are halved until the slope has none, or one
/// by its monotony.
fn flat(coefficients: &[f64; COEFFICIENTS], low: f64, high: f64, found: &mut Vec<f64>) {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let [[slope, change], [second, bend]] = slope_about(coefficients, middle, half);
    // Where it stands still it turns nowhere.
    if !(slope.abs() <= change) || change == 0.0 {
        return;
    }
    let slope_at = |s: f64| slope_about(coefficients, s, 0.0)[0][0];
    if second.abs() > bend || half < SHORTEST {
        let (mut a, mut b) = (low, high);
        let falls = slope_at(a) > 0.0;
        if (slope_at(b) > 0.0) == falls {
            return;
        }
        loop {
            let next = 0.5 * (a + b);
            if next <= a || next >= b {
                break;
            }
            if (slope_at(next) > 0.0) == falls {
                a = next;
            } else {
                b = next;
            }
        }
        found.push(b);
        return;
    }
    flat(coefficients, low, middle, found);
    flat(coefficients, middle, high, found);
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use kempe_number::Jet;
    use kempe_number::math::sin_cos;

    /// Half a vibration and more, by its own formula.
    fn swing() -> Polynomials {
        let times: Vec<f64> = (0..=12).map(|k| 0.3 * f64::from(k)).collect();
        let state = |t: f64| {
            let (s, c) = sin_cos(2.0 * t);
            [s, 2.0 * c, -4.0 * s]
        };
        let quarter =
            |w: &[f64]| [0.25, 0.5, 0.75].map(|part| state(w[0] + part * (w[1] - w[0]))[2]);
        let quarters: Vec<[f64; 3]> = times.windows(2).map(quarter).collect();
        let ends: Vec<[f64; 3]> = times.iter().map(|t| state(*t)).collect();
        Polynomials::through(&times, &ends, &quarters).unwrap()
    }

    #[test]
    fn a_smooth_motion_comes_back_with_its_rates() {
        let swing = swing();
        for k in 0..=360 {
            let t = 0.01 * f64::from(k);
            let found: Jet<f64, 3> = swing.at(Jet::variable(t));
            let (s, c) = sin_cos(2.0 * t);
            for (order, exact) in [s, 2.0 * c, -4.0 * s].into_iter().enumerate() {
                let off = (found.derivative(order) - exact).abs();
                assert!(off < 1e-7, "{t} {order}: {off}");
            }
        }
    }

    #[test]
    fn polynomials_of_that_degree_are_exact() {
        let value = |t: Jet<f64, 3>| {
            let square = t * t;
            square * square * square * square - square * t * 3.0 + t * 0.5 - 2.0
        };
        let state = |t: f64| {
            let series = value(Jet::variable(t));
            [0, 1, 2].map(|k| series.derivative(k))
        };
        let quarters = [0.375, 0.75, 1.125].map(|t| state(t)[2]);
        let it = Polynomials::through(&[0.0, 1.5], &[0.0, 1.5].map(state), &[quarters]).unwrap();
        for k in 0..=15 {
            let t = Jet::variable(0.1 * f64::from(k));
            let (found, exact): (Jet<f64, 3>, _) = (it.at(t), value(t));
            for order in 0..3 {
                let off = (found.derivative(order) - exact.derivative(order)).abs();
                assert!(off < 1e-12 * 200.0, "{k} {order}: {off}");
            }
        }
    }

    /// What rounding of the places would make of a step of a femtosecond has no part in it, and beyond its end it goes on as it did.
    #[test]
    fn a_step_of_no_length_goes_back_from_its_end() {
        let (from, to) = (1.0, 1.0 + 1e-15);
        let noise = 1e-16;
        let ends = [
            [0.5 + noise, 2.0 + 9.81 * (to - from), -9.81],
            [0.5, 2.0, -9.81],
        ];
        let times = [0.0, to - from];
        let short = Polynomials::through(&times, &ends, &[[-9.81; 3]]).unwrap();
        for t in [0.0, 0.1 * (to - from), to - from, 1e-9, 1e-3] {
            let accelerates = short.at(Jet::<f64, 3>::variable(t)).derivative(2);
            assert!((accelerates + 9.81).abs() < 1e-9, "{t}");
        }
        let later = short.at(1e-3);
        assert!(
            (later - (0.5 + 2e-3 - 0.5 * 9.81e-6)).abs() < 1e-12,
            "{later}"
        );
    }

    /// A first step of a moment, as a simulation begins with, says nothing of before by its high powers.
    #[test]
    fn far_out_it_goes_on_by_parabolas() {
        let state = |t: f64| {
            let (s, c) = sin_cos(2.0 * t);
            [s, 2.0 * c, -4.0 * s]
        };
        let times = [0.0, 1e-7, 0.1, 0.1 + 1e-7];
        let quarter =
            |w: &[f64]| [0.25, 0.5, 0.75].map(|part| state(w[0] + part * (w[1] - w[0]))[2]);
        let quarters: Vec<[f64; 3]> = times.windows(2).map(quarter).collect();
        let it = Polynomials::through(&times, &times.map(state), &quarters).unwrap();
        for t in [-1e-3, -3e-7, -1e-7, 0.0, 0.05, 0.1, 0.1 + 2e-7, 0.1 + 1e-3] {
            let off: f64 = it.at(t) - state(t)[0];
            assert!(off.abs() < 1e-8, "{t}: {off:e}");
        }
    }

    #[test]
    fn it_turns_where_its_speed_vanishes() {
        let swing = swing();
        let quarter = std::f64::consts::FRAC_PI_4;
        let turns: Vec<f64> = (swing.turns().iter().copied())
            .filter(|t| !swing.times().contains(t))
            .collect();
        assert_eq!(turns.len(), 2, "{turns:?}");
        for (turn, exact) in turns.iter().zip([quarter, 3.0 * quarter]) {
            assert!((turn - exact).abs() < 1e-9, "{turn}");
        }
        let values =
            [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0].map(|t: f64| t * t * t - 2.0 * t + 1.0);
        let it = Polynomials::at_equal_parts(&[0.0, 4.0], &[values]).unwrap();
        for k in 0..=40 {
            let t = 0.1 * f64::from(k);
            let (found, exact): (f64, f64) = (it.at(t), t * t * t - 2.0 * t + 1.0);
            assert!((found - exact).abs() < 1e-12, "{t}: {found}, not {exact}");
        }
        let still = Polynomials::at_equal_parts(&[0.0, 1.0], &[[3.0; COEFFICIENTS]]).unwrap();
        assert_eq!((still.turns().len(), still.is_constant(3.0)), (2, true));
        assert!(Polynomials::through(&[0.0, 0.0], &[[0.0; 3]; 2], &[[0.0; 3]]).is_none());
        assert!(Polynomials::through(&[0.0, 1.0], &[[0.0; 3]; 3], &[[0.0; 3]]).is_none());
    }
}
