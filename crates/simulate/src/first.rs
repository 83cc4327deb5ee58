//! What happens first in a step.
//!
//! Whatever is watched is positive until it happens. It is looked at in some places of the step, and where it falls and rises again between
//! them, at its lowest: a stop may be struck and left in one long step.

use kempe_integrate::{crossing, dip};
use kempe_model::Measure;

use crate::plant::Plant;
use crate::step::Step;
use crate::watch::{Event, Watch, watches};

/// Places within a step that are looked at.
const PARTS: usize = 8;
/// Whether something falls at an end of a step is seen so near to it, as a part of the distance of places.
const NEAR_END: f64 = 1e-6;
/// Halvings towards the beginning of a step before what began at zero counts as never having been open.
const HALVINGS: usize = 40;

/// What happens first in the last step, and when. Conditions that come to be false on the way are armed from then on.
pub(crate) fn first(
    it: &mut dyn Step,
    plant: &mut Plant,
    ends: &[Measure],
    conditions: &mut [bool],
    y: &mut [f64],
) -> Option<Event> {
    let step = [it.before(), it.time()];
    let mut earliest: Option<Event> = None;
    for watch in watches(plant, conditions) {
        let mut look = Look {
            it,
            plant,
            ends,
            y,
            watch,
            step,
            armed: !matches!(watch, Watch::Ends(_, false)),
            valueless: false,
        };
        let found = look.along(earliest.map(|event| event.time));
        if let Watch::Ends(k, _) = watch
            && let Some(known) = conditions.get_mut(k)
        {
            *known |= look.armed;
        }
        if let Some(event) = found
            && earliest.is_none_or(|first| event.time < first.time)
        {
            earliest = found;
        }
    }
    earliest
}

/// One thing that is watched, in a step.
struct Look<'a> {
    it: &'a mut dyn Step,
    plant: &'a mut Plant,
    ends: &'a [Measure],
    y: &'a mut [f64],
    watch: Watch,
    step: [f64; 2],
    /// Whether it would happen where it falls below zero.
    armed: bool,
    /// Whether there was a pose but no value where it was asked for last.
    valueless: bool,
}

impl Look<'_> {
    fn at(&mut self, time: f64) -> f64 {
        let there = self.it.between(self.plant, time, self.y);
        let value = there.then(|| self.watch.value(self.plant, self.ends, time, self.y));
        let value = value.flatten();
        self.valueless = value.is_some_and(|x| !x.is_finite());
        value.unwrap_or(f64::NAN)
    }

    fn place(&self, k: usize) -> f64 {
        let [from, to] = self.step;
        match k {
            PARTS => to,
            k => from + (to - from) * (k as f64 / PARTS as f64),
        }
    }

    /// By how much it may be below zero where that is rounding.
    fn slack(&mut self) -> f64 {
        self.watch
            .slack(self.plant, self.ends, self.step[0], self.y)
    }

    fn happens(&self, time: f64) -> Event {
        Event {
            time,
            watch: self.watch,
            has_value: true,
        }
    }

    /// When it happens first; something else happens at `other`.
    fn along(&mut self, other: Option<f64>) -> Option<Event> {
        let from = self.step[0];
        let mut values = [f64::NAN; PARTS + 1];
        values[0] = self.at(from);
        let mut low = from;
        let mut open = values[0] > 0.0;
        // The last place at which it had a value, and whether it had none at the last.
        let (mut known, mut lost) = (from, self.valueless);
        // What begins closed may be off by rounding.
        let slack = if open { 0.0 } else { self.slack() };
        for k in 1..=PARTS {
            let high = self.place(k);
            // What comes behind the first event does not come.
            if other.is_some_and(|first| first < high) && !self.armed {
                return None;
            }
            let value = self.at(high);
            values[k] = value;
            // At an instant alone it may have none, as the curvature of a path where its point turns back.
            if self.valueless && lost {
                return Some(self.loses(known, high));
            }
            lost = self.valueless;
            if !lost {
                known = high;
            }
            if open && let Some(time) = self.dips(&values, k) {
                return Some(self.happens(time));
            }
            if value > 0.0 || (value == 0.0 && open) {
                (low, open, self.armed) = (high, true, true);
                continue;
            }
            if !self.armed || value.is_nan() || (!open && value >= -slack) {
                continue;
            }
            let time = match open {
                true => crossing(|t| self.at(t), low, high),
                false => self.opens_and_closes(low, high),
            };
            return time.map(|time| self.happens(time));
        }
        None
    }

    /// It has a value, and further on none.
    fn loses(&mut self, mut known: f64, mut none: f64) -> Event {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (known + none);
            self.at(middle);
            match self.valueless {
                true => none = middle,
                false => known = middle,
            }
        }
        Event {
            time: known,
            watch: self.watch,
            has_value: false,
        }
    }

    /// It begins at zero and ends below: open a little later, or never.
    fn opens_and_closes(&mut self, low: f64, high: f64) -> Option<f64> {
        let mut part = high - low;
        let opens = (0..HALVINGS).find_map(|_| {
            part *= 0.5;
            (self.at(low + part) > 0.0).then_some(low + part)
        });
        match opens {
            Some(opens) => crossing(|t| self.at(t), opens, high),
            None => Some(low),
        }
    }

    /// Where it falls below zero between places where it is above, the last of which is the k-th.
    fn dips(&mut self, values: &[f64; PARTS + 1], k: usize) -> Option<f64> {
        let lowest_between = |k: usize| {
            let low = values[k - 1];
            (values[k - 2] > 0.0 && low <= values[k - 2] && low <= values[k]).then_some(low)
        };
        // It cannot fall by more than it rises to the sides.
        let may = |low: f64, sides: [usize; 2]| {
            low > 0.0 && 2.0 * low <= values[sides[0]].max(values[sides[1]])
        };
        if k >= 2
            && let Some(low) = lowest_between(k)
            && may(low, [k - 2, k])
            && let Some(time) = self.dips_between(k - 2, k)
        {
            return Some(time);
        }
        let near = NEAR_END * (self.place(1) - self.place(0));
        let (first, last) = (values[0], values[PARTS]);
        if k == 2 && first < values[1] && may(first, [1, 2]) && self.at(self.step[0] + near) < first
        {
            return self.dips_between(0, 1);
        }
        if k == PARTS
            && last < values[PARTS - 1]
            && may(last, [PARTS - 2, PARTS - 1])
            && self.at(self.step[1] - near) < last
        {
            return self.dips_between(PARTS - 1, PARTS);
        }
        None
    }

    fn dips_between(&mut self, a: usize, b: usize) -> Option<f64> {
        let below = -self.slack();
        let (a, b) = (self.place(a), self.place(b));
        let there = dip(|t| self.at(t), a, b, below)?;
        crossing(|t| self.at(t), a, there)
    }
}
