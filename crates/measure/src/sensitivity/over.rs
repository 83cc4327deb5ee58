//! Statistics over a varied motion, and lengths of path.

use kempe_mechanism::structure::Marker;
use kempe_model::{Measure, PointId, SAME_END, Statistic};
use kempe_number::Number;
use kempe_units::Dimension;

use super::varied::{Cumulated, PathPlace, Varied};
use crate::base::{CHUNK, Varying};
use crate::force_source::ForceSource;
use crate::measure::Along;
use crate::measurer::asks_forces;
use crate::quadrature::{AGREED, Floor, gauss, graded, graded_with, integrate, parts};
use crate::statistics::{cycle_of, may_fold, time_ratio};

/// Intervals of time over which path lengths and means are integrated, besides the breaks of the laws.
const GRID: usize = 45;
/// A derivative whose size over the motion is less than this part of the measure's own for a parameter as large as itself is integrated no more closely.
const NO_SLOPE: f64 = 1e-3;
/// Integrals of derivatives by the whole and by halves agree when they differ by no more than this part of their size: of those whose parts nearly cancel,
/// as across the direction to which a pin stands off, more is rounding.
const SLOPES_AGREE: f64 = 1e-12;
/// What changes by no more than this part of itself all along is the same, and so is a derivative that changes by no more than the other; how many
/// parts of the motion are looked at for that.
pub(super) const LEVEL: f64 = 1e-12;
pub(super) const SAME_SLOPE: f64 = 1e-6;
/// Ways of which one takes so little longer than the other take equally long, as far as the times of their ends are known.
const EVEN: f64 = 1e-9;
pub(super) const LOOKED_AT: usize = 12;
/// So far beside an extreme, as a part of the motion, both of its sides are looked at where it does not turn back smoothly.
const BESIDE: f64 = 1e-6;
/// So near to a break, as a part of the motion, extremes of forces that do not turn back lie where something comes to rest.
const BESIDE_REST: f64 = 1e-4;
/// A drive that covers less than this part of the motion in its duration at its pace is at rest.
const RESTS: f64 = 1e-9;
/// A measure that changes by less than this part of its range over the motion at its pace along the path turns back there: less moves its value by rounding.
const TURNS: f64 = 1e-7;
/// Where it is smooth the rate at that distance is about what the bend makes of it; at a fold it is many times as much.
const STEEP: f64 = 100.0;

impl<F: ForceSource, G: ForceSource<Varying>> Varied<'_, F, G> {
    /// A statistic of a measure over the motion.
    pub(super) fn over(&mut self, statistic: &Statistic, measure: &Measure) -> Varying {
        let nothing = Varying::from_f64(f64::NAN);
        match statistic {
            Statistic::At { drive, value } => {
                let at = kempe_model::value(value, self.parameters());
                let time = match drive {
                    None => (self.sampler.within(at.re)).map(|re| Varying { re, ..at }),
                    Some(drive) => (self.sampler.time_of(*drive, at.re))
                        .map(|time| self.passing(*drive, at, time)),
                };
                match time {
                    Some(time) => {
                        let place = self.at_time(time);
                        self.value_off_corners(measure, place)
                    }
                    None => nothing,
                }
            }
            Statistic::Mean => {
                let duration = self.duration();
                if duration.re <= 0.0 {
                    let place = self.at_time(Varying::zero());
                    return self.value(measure, place);
                }
                // Whether there is one, and what it is, is known.
                let mean = self.sampler.over_motion(statistic.clone(), measure);
                if mean.is_nan() {
                    return nothing;
                }
                let turns = self.turns(measure).between;
                let mut sum =
                    self.integrate(duration, &turns, &mut |it, place| it.value(measure, place));
                let [more, _] = self.gained(measure);
                (sum.eps.iter_mut().zip(more)).for_each(|(eps, more)| *eps += more);
                Varying {
                    re: mean,
                    ..sum / duration
                }
            }
            Statistic::Min | Statistic::Max | Statistic::Range | Statistic::TimeRatio => {
                let Some((low, high)) = self.sampler.extremes(measure) else {
                    return nothing;
                };
                if *statistic != Statistic::TimeRatio
                    && low.0 != high.0
                    && let Some(level) = self.of_level(statistic, measure, [low.0, high.0])
                {
                    return level;
                }
                // One that no statistic asks for is not closed in on: nothing is taken from there.
                match statistic {
                    Statistic::Min => self.extreme(measure, low.0).1,
                    Statistic::Max => self.extreme(measure, high.0).1,
                    Statistic::Range => {
                        self.extreme(measure, high.0).1 - self.extreme(measure, low.0).1
                    }
                    _ => {
                        let range = (high.1 - low.1).abs();
                        let Some(ends) = self.sampler.strokes(measure) else {
                            return nothing;
                        };
                        let [low, high] = ends.map(|time| self.in_cycle(measure, range, time));
                        let Some(part) = cycle_of(self.sampler, measure, range) else {
                            return nothing;
                        };
                        let ratio = time_ratio(high - low, self.duration() * part);
                        self.off_even(ratio)
                    }
                }
            }
        }
    }

    /// A statistic of a measure, whose extremes were found at these times, that is the same all along but for rounding; `None` of another. Where its
    /// derivative to a parameter is not the same all along, too, the statistic has none: a change this way makes another place the extreme than one
    /// that way.
    fn of_level(
        &mut self,
        statistic: &Statistic,
        measure: &Measure,
        ends: [f64; 2],
    ) -> Option<Varying> {
        let duration = self.duration().re;
        let changes = self.changes();
        let mut at = |time: f64| {
            let place = self.at_time(Varying::from_f64(time));
            self.value(measure, place)
        };
        let [low, high] = ends.map(&mut at);
        let slopes = changes.iter().zip(&high.eps);
        let scale = slopes.fold(high.re.abs(), |all, (change, slope)| {
            all.max((change * slope).abs())
        });
        if !((high.re - low.re).abs() <= LEVEL * scale) {
            return None;
        }
        let along = (0..=LOOKED_AT).map(|k| at(duration * k as f64 / LOOKED_AT as f64));
        let all: Vec<Varying> = [low, high].into_iter().chain(along).collect();
        let place = self.at_time(Varying::from_f64(ends[1]));
        let scale = scale.max(self.size_of(measure, place));
        let value = match statistic {
            Statistic::Min => low,
            Statistic::Max => high,
            _ => high - low,
        };
        let eps = std::array::from_fn(|lane| {
            let slopes = all.iter().map(|it| it.eps[lane]);
            let [a, b] = slopes.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            });
            let same = b - a <= SAME_SLOPE * a.abs().max(b.abs())
                || (b - a) * changes[lane] <= LEVEL * scale;
            if same { value.eps[lane] } else { f64::NAN }
        });
        Some(Varying { eps, ..value })
    }

    /// What the parameters change by where they change by what they are: a measure itself may be zero.
    pub(super) fn changes(&self) -> [f64; CHUNK] {
        let (model, size) = (&self.motion.mechanism().model, self.motion.size());
        let mut changes = [0.0; CHUNK];
        for (it, x) in model.parameters.iter().zip(self.parameters()) {
            let own = match it.dimension {
                Dimension::LENGTH => size,
                Dimension::ANGLE => 1.0,
                _ => x.re.abs(),
            };
            for (change, varies) in changes.iter_mut().zip(&x.eps) {
                *change += own * varies;
            }
        }
        changes
    }

    /// Time and value of an extreme found at `time`.
    pub(super) fn extreme(&mut self, measure: &Measure, time: f64) -> (Varying, Varying) {
        // At an end of a piece the time moves with the law; otherwise with the zero of the rate.
        let duration = self.sampler.duration();
        let near = |by: f64| move |b: &Varying| (b.re - time).abs() <= by * duration;
        if let Some(moving) = self.moving_at(measure, time) {
            // On the side of the piece on which it was found.
            return self.moving_with(moving, measure, time);
        }
        let place = self.at_time(Varying::from_f64(time));
        let series = self.series(measure, place);
        let (rate, bend) = (series.coefficient(1), series.coefficient(2).re * 2.0);
        let level = rate.re.abs() <= BESIDE * self.sampler.duration() * bend.abs();
        // Right beside where what rubs comes to rest forces do not turn back: they end there.
        if !level && asks_forces(&self.motion, measure) {
            let mut rests = self.breaks().into_iter().filter(near(BESIDE_REST));
            if let Some(moving) = rests.next() {
                return self.moving_with(moving, measure, time);
            }
        }
        // A root of nothing has neither rate nor bend, and one of rounding has a bend that is rounding.
        let value = series.coefficient(0).re.abs();
        let unsure = value <= LEVEL * self.size_of(measure, place)
            || may_fold(self.motion.mechanism(), measure);
        if (!level || unsure)
            && let Some(found) = self.fold(measure, time)
        {
            return found;
        }
        (
            Varying {
                re: time,
                eps: rate.eps.map(|d| -d / bend),
            },
            series.coefficient(0),
        )
    }

    /// The same at a time that moves as another does.
    fn moving_with(&mut self, other: Varying, measure: &Measure, time: f64) -> (Varying, Varying) {
        let moving = Varying { re: time, ..other };
        let place = self.at_time(moving);
        (moving, self.value(measure, place))
    }

    /// Time of an extreme of a measure that has this range, found at `time` in a cycle. At an end of a law's piece it moves with the law, unless the measure
    /// only passes there, as over the seam of a turn that begins at a dead centre: then with the zero of the rate, if both sides say the same.
    fn in_cycle(&mut self, measure: &Measure, range: f64, time: f64) -> Varying {
        let found = self.extreme(measure, time).0;
        let (duration, closes) = (self.sampler.duration(), self.duration());
        let near = SAME_END * duration;
        if (self.breaks().iter()).all(|b| (b.re - time).abs() > near) {
            return found;
        }
        let at_seam = time <= near || time >= duration - near;
        let sides = match at_seam {
            true => [duration, 0.0],
            false => [(time - near).next_down(), time + near],
        };
        let [before, behind] = sides.map(|side| self.passed(measure, range, side));
        let (Some(before), Some(behind)) = (before, behind) else {
            return found;
        };
        let later = if at_seam { closes.eps } else { [0.0; CHUNK] };
        let own = if at_seam && time > near {
            before
        } else {
            behind
        };
        let changes = self.changes();
        let eps = std::array::from_fn(|lane| {
            let apart = (before[lane] - later[lane] - behind[lane]).abs();
            let most = before[lane].abs().max(behind[lane].abs());
            let same = apart <= SAME_SLOPE * most.max(later[lane].abs())
                || apart * changes[lane] <= LEVEL * duration;
            if same { own[lane] } else { f64::NAN }
        });
        Varying { re: time, eps }
    }

    /// A time ratio: where both ways take equally long, what makes one of them the slower has no derivative.
    fn off_even(&self, ratio: Varying) -> Varying {
        if !((ratio.re - 1.0).abs() <= EVEN) {
            return ratio;
        }
        let changes = self.changes();
        let eps = std::array::from_fn(|lane| {
            let stays = (ratio.eps[lane] * changes[lane]).abs() <= LEVEL;
            if stays { ratio.eps[lane] } else { f64::NAN }
        });
        Varying { eps, ..ratio }
    }

    /// How the zero of a measure's rate moves that lies at a time; `None` where there is none, or only the drive comes to rest. With a drive at rest where
    /// the mechanism turns back, too, it moves at once by more than any part of a change: that is not finite.
    fn passed(&mut self, measure: &Measure, range: f64, time: f64) -> Option<[f64; CHUNK]> {
        let place = self.at_time(Varying::from_f64(time));
        let series = self.series(measure, place);
        let (rate, bend) = (series.coefficient(1), series.coefficient(2).re * 2.0);
        let (low, high) = self.motion.demanded;
        let duration = self.sampler.duration();
        let pace = self.measurer.states.path_rate(place.time).re;
        if pace.abs() * duration <= RESTS * (high - low) {
            let along = self.series_along(measure, place, Along::Path);
            let turns_back = along.coefficient(1).re.abs() * (high - low) <= TURNS * range;
            return turns_back.then_some([f64::NAN; CHUNK]);
        }
        let level = rate.re.abs() <= BESIDE * duration * bend.abs();
        level.then(|| rate.eps.map(|d| -d / bend))
    }

    /// Time and value of an extreme at which a measure turns back at once, as the size of what passes zero does: it stays where both sides
    /// meet. `None` where it does not turn back so.
    pub(super) fn fold(&mut self, measure: &Measure, time: f64) -> Option<(Varying, Varying)> {
        let by = BESIDE * self.sampler.duration();
        let [before, after] = [-by, by].map(|beside| {
            let place = self.at_time(Varying::from_f64(time + beside));
            let series = self.series(measure, place);
            let (value, rate) = (series.coefficient(0), series.coefficient(1));
            // Each side by its own course, at the time itself.
            let bend = series.coefficient(2);
            let there = value - rate * beside + bend * (beside * beside);
            let rate = rate - bend * (2.0 * beside);
            (there, rate, bend.re.abs() * 2.0 * by)
        });
        let steep = |(_, rate, smooth): &(Varying, Varying, f64)| rate.re.abs() > STEEP * smooth;
        let turns = before.1.re * after.1.re < 0.0 && steep(&before) && steep(&after);
        turns.then(|| {
            let moves = (after.0 - before.0) / (before.1 - after.1);
            let value = before.0 + before.1 * moves;
            (Varying { re: time, ..moves }, value)
        })
    }

    /// Length of path swept by a point until a time.
    pub(super) fn length(&mut self, point: PointId, until: Varying) -> Varying {
        let mechanism = self.motion.mechanism().clone();
        if mechanism.is_fixed(point) {
            return Varying::zero();
        }
        let Some(marker) = mechanism.any_marker(point) else {
            return Varying::from_f64(f64::NAN);
        };
        let known = self.lengths.iter().position(|known| known.point == point);
        let known = known.unwrap_or_else(|| {
            let length = self.cumulated(point, marker);
            self.lengths.push(length);
            self.lengths.len() - 1
        });
        let marks = &self.lengths[known].marks;
        let passed = marks.partition_point(|(time, _)| time.re <= until.re);
        let (from, length) = marks[passed.max(1) - 1];
        let width = until - from;
        let rest = gauss(0.0, 1.0, &mut |u| {
            let place = self.at_time(from + width * u);
            Some(values(self.speed(marker, place) * width))
        });
        length + rest.map_or(Varying::from_f64(f64::NAN), base)
    }

    /// The length swept by a point, at times between which one quadrature is enough.
    fn cumulated(&mut self, point: PointId, marker: Marker) -> Cumulated {
        let mut marks = vec![(Varying::zero(), Varying::zero())];
        let mut sum = Varying::zero();
        let duration = self.duration();
        let floor = self.floor();
        for [from, to] in self.cuts(duration, &[]) {
            let width = to - from;
            let found = parts(&graded(count(width, duration)), floor, &mut |u| {
                let place = self.at_time(from + width * u);
                Some(values(self.speed(marker, place) * width))
            });
            for part in found.iter().flatten() {
                sum += base(part.integral());
                marks.push((from + width * part.to, sum));
            }
        }
        Cumulated { point, marks }
    }

    /// Speed of a point, m/s.
    fn speed(&mut self, marker: Marker, place: PathPlace<Varying>) -> Varying {
        if !self.measurer.find(place) {
            return Varying::from_f64(f64::NAN);
        }
        let rate = self.measurer.states.path_rate(place.time);
        let state = self.measurer.state();
        let local = state.design.geometry.marker(marker);
        let at = state.poses[marker.body.index()].place(local);
        let (dx, dy) = (at[0].coefficient(1), at[1].coefficient(1));
        if rate.re == 0.0 || (dx.re == 0.0 && dy.re == 0.0) {
            // A root has no derivative here; what stays at rest stays at that.
            return (dx.abs() + dy.abs()) * rate.abs();
        }
        ((dx.square() + dy.square()) * rate.square()).sqrt()
    }

    /// Derivatives that are rounding of what is integrated.
    fn floor(&self) -> Floor<{ 1 + CHUNK }> {
        let changes = self.changes();
        let least = |change: f64| match change > 0.0 {
            true => NO_SLOPE / change,
            false => 0.0,
        };
        Floor {
            size: 0.0,
            of_first: values(Varying {
                re: 0.0,
                eps: changes.map(least),
            }),
            agreed: values(Varying {
                re: AGREED,
                eps: [SLOPES_AGREE; CHUNK],
            }),
        }
    }

    /// Integral over time from the start, between the breaks of the laws and the given turns, the times at which it has to be looked
    /// closely, and those of an even grid.
    fn integrate(
        &mut self,
        until: Varying,
        turns: &[Varying],
        f: &mut dyn FnMut(&mut Self, PathPlace<Varying>) -> Varying,
    ) -> Varying {
        let mut sum = Varying::zero();
        let floor = self.floor();
        for [from, to] in self.cuts(until, turns) {
            let width = to - from;
            let own = self.sampler.closely.iter();
            let own: Vec<f64> = own.map(|t| (t - from.re) / width.re).collect();
            let stretches = graded_with(count(width, until), &own);
            let part = integrate(&stretches, floor, &mut |u| {
                let place = self.at_time(from + width * u);
                Some(values(f(self, place) * width))
            });
            sum += part.map_or(Varying::from_f64(f64::NAN), base);
        }
        sum
    }

    /// Stretches of time from the start between the breaks of the laws and other moving times.
    pub(super) fn cuts(&self, until: Varying, turns: &[Varying]) -> Vec<[Varying; 2]> {
        let mut cuts = vec![Varying::zero(), until];
        let breaks = self.breaks().into_iter().chain(turns.iter().copied());
        cuts.extend(breaks.filter(|t| 0.0 < t.re && t.re < until.re));
        cuts.sort_by(|a, b| a.re.total_cmp(&b.re));
        let pairs = cuts.windows(2).map(|pair| [pair[0], pair[1]]);
        pairs.filter(|[from, to]| to.re > from.re).collect()
    }

    pub(super) fn duration(&self) -> Varying {
        let laws = self.motion.mechanism().model.drives.iter();
        laws.map(|d| d.law.duration(self.parameters()))
            .fold(Varying::zero(), Varying::max)
    }

    /// Times at which some law goes from one piece to the next, as they move with the parameters.
    pub(super) fn breaks(&self) -> Vec<Varying> {
        let mut list = vec![Varying::zero(), self.duration()];
        for drive in &self.motion.mechanism().model.drives {
            let mut law = drive.law.clone();
            while !law.pieces.is_empty() {
                list.push(law.duration(self.parameters()));
                law.pieces.pop();
            }
        }
        list
    }
}

/// In how many parts a stretch of so much of a time is integrated first.
fn count(width: Varying, all: Varying) -> usize {
    (GRID as f64 * width.re / all.re).ceil() as usize
}

fn values(x: Varying) -> [f64; 1 + CHUNK] {
    let mut values = [x.re; 1 + CHUNK];
    values[1..].copy_from_slice(&x.eps);
    values
}

fn base([re, eps @ ..]: [f64; 1 + CHUNK]) -> Varying {
    Varying { re, eps }
}
