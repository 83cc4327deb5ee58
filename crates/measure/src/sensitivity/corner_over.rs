//! Corners of numbers over a motion: of two extremes that are equally large and change otherwise, a change of the design makes now the one and now the
//! other the extreme; and an extreme may stand right at a corner of its measure.

use kempe_model::{Leaf, Measure, Statistic};
use kempe_number::Number;

use super::over::{LEVEL, LOOKED_AT, SAME_SLOPE};
use super::varied::Varied;
use crate::base::{CHUNK, Varying};
use crate::force_source::ForceSource;
use crate::measure::visit_leaves;

/// What derivatives differ by is rounding where it changes a measure by less than this part of what that is made of.
const ROUNDING: f64 = 1e-9;

type Lanes = [bool; CHUNK];

fn either(a: Lanes, b: Lanes) -> Lanes {
    std::array::from_fn(|k| a[k] || b[k])
}

impl<F: ForceSource, G: ForceSource<Varying>> Varied<'_, F, G> {
    /// What moves a number over the motion away from a corner, and its derivatives on the other side of that where they are known: of a mean, as the
    /// parameter shrinks.
    pub(super) fn corner_over(
        &mut self,
        statistic: &Statistic,
        measure: &Measure,
        value: Varying,
    ) -> (Lanes, [f64; CHUNK]) {
        match statistic {
            Statistic::Mean => self.corner_of_mean(measure, value),
            _ => (
                self.corner_of_extremes(statistic, measure),
                [f64::NAN; CHUNK],
            ),
        }
    }

    fn corner_of_extremes(&mut self, statistic: &Statistic, measure: &Measure) -> Lanes {
        let sides = match statistic {
            Statistic::Min => &[0][..],
            Statistic::Max => &[1],
            Statistic::Range => &[0, 1],
            // A place has its own, and so has what takes equally long both ways.
            _ => return [false; CHUNK],
        };
        let Some((low, high)) = self.sampler.extremes(measure) else {
            return [false; CHUNK];
        };
        let range = high.1 - low.1;
        let place = self.at_time(Varying::from_f64(high.0));
        let size = self.size_of(measure, place);
        if range.abs() <= LEVEL * size.max(high.1.abs()).max(low.1.abs()) {
            return self.corner_all_along(measure);
        }
        let least = (SAME_SLOPE * range.abs()).max(ROUNDING * size);
        let rivals = self.sampler.rivals(measure);
        let of_side = |all: Lanes, side: &usize| {
            let times = &rivals[*side];
            let parted = self.parted(measure, times, least);
            let own = times.iter().take(1);
            let own = own.fold([false; CHUNK], |all, time| {
                either(all, self.corner_of_extreme(measure, *time))
            });
            let [sign, extreme] = [[-1.0, low.1], [1.0, high.1]][*side];
            let own = either(own, self.leaps(measure, sign, extreme));
            either(all, either(parted, own))
        };
        sides.iter().fold([false; CHUNK], of_side)
    }

    /// What changes equally large extremes otherwise, by more than this over what it changes by itself.
    fn parted(&mut self, measure: &Measure, times: &[f64], least: f64) -> Lanes {
        if times.len() < 2 {
            return [false; CHUNK];
        }
        let changes = self.changes();
        let all = times.iter().map(|time| self.extreme(measure, *time).1);
        let all: Vec<Varying> = all.collect();
        std::array::from_fn(|lane| {
            let slopes = all.iter().map(|it| it.eps[lane]).filter(|d| d.is_finite());
            let [a, b] = slopes.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], d| {
                [a.min(d), b.max(d)]
            });
            let apart = b - a;
            apart > SAME_SLOPE * a.abs().max(b.abs()) && apart * changes[lane] > least
        })
    }

    /// The value of an extreme found at a time with its derivatives, and which of them move it away from a corner.
    pub(super) fn at_extreme(&mut self, measure: &Measure, time: f64) -> (Varying, Lanes) {
        let value = self.extreme(measure, time).1;
        (value, self.corner_of_extreme(measure, time))
    }

    /// What moves an extreme away from a corner of its measure; where both sides meet in it, as the size of what passes zero does, it goes with them.
    fn corner_of_extreme(&mut self, measure: &Measure, time: f64) -> Lanes {
        let place = match self.moving_at(measure, time) {
            Some(moving) => self.at_time(Varying { re: time, ..moving }),
            None if self.fold(measure, time).is_some() => return [false; CHUNK],
            None => self.at_time(Varying::from_f64(time)),
        };
        self.value_at_corner(measure, place).1
    }

    /// A mean is at a corner where its measure is at one all along, and where a turn of what rubs lies at an end of the motion: it moves into that on one
    /// side alone, but where the motion goes on there as it begins.
    fn corner_of_mean(&mut self, measure: &Measure, mean: Varying) -> (Lanes, [f64; CHUNK]) {
        let all_along = self.corner_all_along(measure);
        let [up, down] = self.gained(measure);
        let (changes, duration) = (self.changes(), self.sampler.duration());
        let apart: [f64; CHUNK] = std::array::from_fn(|lane| (up[lane] - down[lane]) / duration);
        let parted = std::array::from_fn(|lane| {
            let apart = apart[lane].abs();
            apart > SAME_SLOPE * (mean.eps[lane].abs() + apart)
                && apart * changes[lane] > ROUNDING * mean.re.abs()
        });
        let mut nested = false;
        visit_leaves(self.motion.mechanism(), measure, &mut |leaf| {
            nested |= matches!(leaf, Leaf::Over(..));
        });
        let other = std::array::from_fn(|lane| match nested || all_along[lane] {
            true => f64::NAN,
            false => mean.eps[lane] - apart[lane],
        });
        (either(all_along, parted), other)
    }

    /// What moves a measure away from a corner where it stands at that for more than an instant.
    fn corner_all_along(&mut self, measure: &Measure) -> Lanes {
        let duration = self.sampler.duration();
        let mut before = [false; CHUNK];
        let mut all = [false; CHUNK];
        for k in 0..LOOKED_AT {
            let time = duration * (k as f64 + 0.5) / LOOKED_AT as f64;
            let place = self.at_time(Varying::from_f64(time));
            let here = self.value_at_corner(measure, place).1;
            all = either(all, std::array::from_fn(|lane| here[lane] && before[lane]));
            before = here;
        }
        all
    }
}
