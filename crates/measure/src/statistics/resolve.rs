//! Where samples stand too far apart to show what measures do between them: a narrow peak, a pole.
//!
//! Between two samples every measure is bounded ([`Sampler::bounds`]). Where the bounds of a coefficient of its series
//! let it change by more than a small part of the measure's own size, the samples do not show it: another is put in the
//! middle, and so on, until they do.

use kempe_model::Measure;
use kempe_number::Interval;

use super::nature::Nature;
use super::stretches::SmoothStretch;
use crate::force_source::ForceSource;
use crate::measure::{ORDER, Series, order_of};
use crate::sampler::{Between, Kept, Sampler};

/// What the k-th coefficient may change by between samples, times the k-th power of their distance, in parts of the measure's
/// size: what is left of the last bounds by how much the series of the samples miss what lies between.
const SHOWN: [f64; ORDER] = [0.5, 0.25, 0.05, 5e-3, 1e-4];
/// Samples that tell the size of measures before any is looked at closely.
const FIRST: usize = 48;
/// At one in so many of them what rounding makes of measures is looked at.
const ROUNDED: usize = 8;
/// A measure counts at least as this part of what it could be at most.
const UNSEEN: f64 = 1e-9;
/// A measure no larger than so many times the rounding of what it is made of is zero but for rounding: it counts as
/// so many times that rounding, a millionth of what it is made of.
const ROUNDING: [f64; 2] = [1e3, 1e9];
/// A measure that is bounded this closely between two samples, in parts of its size, is level, whatever its rates: the speed of what rests has none.
const LEVEL: f64 = 1e-12;
/// Halvings of an interval at most, and of the whole motion: what is narrower still is a pole, a jump or a kink, and nearer to
/// it the bounds of poses are rounding.
const HALVINGS: [i32; 2] = [36, 40];
/// Samples put between others at most, and so many more for each of the others.
const BUDGET: (usize, usize) = (20_000, 1);

/// Tells where samples are put between others.
pub(super) struct Resolution {
    between: Between,
    /// Which of the measures surveyed each is; none for loads.
    surveyed: Vec<Option<usize>>,
    /// How many coefficients of every measure are known.
    known: Vec<usize>,
    /// Which measures have no jump and no kink.
    smooth: Vec<bool>,
    /// The size of every measure, as far as samples tell.
    size: Vec<f64>,
    /// What it can be at most, seen from afar: near a pole it grows no more.
    most: Vec<f64>,
    /// What rounding makes of it.
    rounding: Vec<f64>,
    /// Whether samples would have had to be put in for it when there were no more.
    open: Vec<bool>,
    budget: usize,
    duration: f64,
}

/// How two samples stand to what lies between them.
pub(super) enum Shown {
    /// They show it.
    Yes,
    /// They do not.
    No,
    /// They do not, and stand as near to each other as they can; the measures surveyed that have no bound between them.
    Never(Vec<usize>),
}

impl Resolution {
    /// Looks at the measures from afar. Loads are looked at where forces are asked for.
    pub fn new<F: ForceSource>(
        sampler: &mut Sampler<F>,
        measures: &[Measure],
        forces: bool,
        stretches: &[SmoothStretch],
    ) -> Self {
        let motion = sampler.motion().clone();
        let mechanism = motion.mechanism();
        let mut surveyed = Vec::new();
        let mut own: Vec<Measure> = Vec::new();
        let mut smooth = Vec::new();
        let mut take = |measure: &Measure, index| {
            let nature = Nature::of(mechanism, measure);
            if nature.wild {
                own.push(measure.clone());
                smooth.push(nature.smooth);
                surveyed.push(index);
            }
        };
        for (index, measure) in measures.iter().enumerate() {
            take(measure, Some(index));
        }
        // What forces are between samples their loads tell.
        if forces {
            (sampler.forces().measures().iter()).for_each(|load| take(load, None));
        }
        let of: Vec<&Measure> = own.iter().collect();
        let mut asked = sampler.asked(&of);
        asked.forces = false;
        let known = own.iter().map(|measure| {
            let order = order_of(mechanism, measure).map_or(ORDER, |order| order as usize);
            ORDER - order.min(ORDER)
        });
        let known = known.collect();
        let samples: usize = stretches.iter().map(|s| s.intervals).sum();
        let mut it = Self {
            size: vec![0.0; own.len()],
            most: vec![0.0; own.len()],
            rounding: vec![0.0; own.len()],
            open: vec![false; own.len()],
            known,
            smooth,
            budget: BUDGET.0 + BUDGET.1 * samples,
            duration: sampler.duration(),
            between: sampler.between(asked),
            surveyed,
        };
        it.look_from_afar(sampler, stretches);
        it
    }

    fn look_from_afar<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        stretches: &[SmoothStretch],
    ) {
        if self.size.is_empty() {
            return;
        }
        let each = (FIRST / stretches.len()).max(1);
        // Of many stretches not every one is looked at.
        for stretch in stretches.iter().step_by(stretches.len().div_ceil(FIRST)) {
            let mut before: Option<Kept> = None;
            for k in 0..=each {
                let part = k as f64 / each as f64;
                let time = stretch.from + (stretch.to - stretch.from) * part;
                let values = sampler.series_at(&self.between.asked, time);
                for (size, value) in self.size.iter_mut().zip(&values) {
                    take_up(size, value.coefficient(0));
                }
                let now = sampler.keep(&self.between);
                if k % ROUNDED == 0 {
                    let alone = sampler.bounds(&self.between, &now, &now);
                    for (rounding, bounds) in self.rounding.iter_mut().zip(&alone) {
                        take_up(rounding, bounds.coefficient(0).width());
                    }
                }
                if let Some(before) = &before {
                    let bounds = sampler.bounds(&self.between, before, &now);
                    for (most, bounds) in self.most.iter_mut().zip(&bounds) {
                        take_up(most, bounds.coefficient(0).mag());
                    }
                }
                before = Some(now);
            }
        }
        for (size, most) in self.size.iter().zip(&mut self.most) {
            *most = most.max(*size);
        }
    }

    /// The size that changes of a measure are held against.
    fn size_of(&self, index: usize) -> f64 {
        let [zero, seen] = ROUNDING.map(|times| times * self.rounding[index]);
        let least = UNSEEN * self.most[index];
        let size = self.size[index];
        let least = if size <= zero { least.max(seen) } else { least };
        size.max(least)
    }

    /// Takes up a value of a measure as its size.
    fn take_up(&mut self, index: usize, value: f64) {
        if value.abs() <= self.most[index] {
            take_up(&mut self.size[index], value);
        }
    }

    /// Keeps the moment last sampled; `series` are those of the measures surveyed.
    pub fn keep<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        series: &[Series<f64>],
    ) -> Kept {
        for index in 0..self.size.len() {
            if let Some(value) = self.surveyed[index].and_then(|index| series.get(index)) {
                self.take_up(index, value.coefficient(0));
            }
        }
        sampler.keep(&self.between)
    }

    /// Whether two samples show all that lies between them, others among it.
    pub fn shown_at_once<F: ForceSource>(
        &mut self,
        sampler: &Sampler<F>,
        ends: [(f64, &Kept); 2],
    ) -> bool {
        self.not_shown(sampler, ends).is_none()
    }

    /// Whether two samples show what lies between them; `interval` is the distance at which samples stand without.
    pub fn shown<F: ForceSource>(
        &mut self,
        sampler: &Sampler<F>,
        ends: [(f64, &Kept); 2],
        interval: f64,
    ) -> Shown {
        let Some((bounds, open)) = self.not_shown(sampler, ends) else {
            return Shown::Yes;
        };
        let width = ends[1].0 - ends[0].0;
        let [of_interval, of_motion] = HALVINGS.map(|n| kempe_number::powi(2.0, -n));
        if width <= (of_interval * interval).max(of_motion * self.duration) {
            let unbounded = self.surveyed.iter().zip(&bounds);
            let unbounded = unbounded.filter(|(_, b)| b.coefficient(0).width() == f64::INFINITY);
            return Shown::Never(unbounded.filter_map(|(index, _)| *index).collect());
        }
        if self.budget == 0 {
            open.into_iter().for_each(|index| self.open[index] = true);
            return Shown::Yes;
        }
        self.budget -= 1;
        Shown::No
    }

    /// The bounds of all measures between two samples, and those of which the samples do not show what lies between them; none where they show all
    /// of it, the poses too.
    fn not_shown<F: ForceSource>(
        &mut self,
        sampler: &Sampler<F>,
        [a, b]: [(f64, &Kept); 2],
    ) -> Option<(Vec<Series<Interval>>, Vec<usize>)> {
        let width = b.0 - a.0;
        let follow = a.1.shows(b.1, sampler.motion().size());
        if self.size.is_empty() && follow {
            return None;
        }
        let bounds = match self.size.is_empty() {
            true => Vec::new(),
            false => sampler.bounds(&self.between, a.1, b.1),
        };
        // Of loads no series are sampled: what their bounds leave out tells their size.
        for (index, bounds) in bounds.iter().enumerate() {
            self.take_up(index, bounds.coefficient(0).mig());
        }
        let is_open = |index: usize, bounds: &Series<Interval>| {
            let mut power = 1.0;
            // Beside a pole a measure counts as what it is there, and no more than from afar elsewhere.
            let size = self.size_of(index).max(bounds.coefficient(0).mig());
            if bounds.coefficient(0).width() <= LEVEL * size {
                return false;
            }
            (0..self.known[index]).any(|k| {
                let change = bounds.coefficient(k).width() * power;
                power *= width;
                // Of what has no value nothing can be told.
                change > SHOWN[k] * size
            })
        };
        let narrower = |index: usize, bounds: &Series<Interval>| {
            let of = (index, self.known[index]);
            sampler.bounds_of_smooth(&self.between, [a.1, b.1], of, bounds)
        };
        let open: Vec<usize> = (bounds.iter().enumerate())
            .filter(|(index, bounds)| is_open(*index, bounds))
            .filter(|(index, bounds)| {
                !self.smooth[*index] || is_open(*index, &narrower(*index, bounds))
            })
            .map(|(index, _)| index)
            .collect();
        (!follow || !open.is_empty()).then_some((bounds, open))
    }

    /// The measures surveyed for which more samples would have been needed than are taken; `None` stands for loads.
    pub fn left_open(&self) -> impl Iterator<Item = Option<usize>> {
        let open = self.surveyed.iter().zip(&self.open);
        open.filter(|(_, open)| **open).map(|(index, _)| *index)
    }
}

fn take_up(size: &mut f64, value: f64) {
    if value.is_finite() {
        *size = size.max(value.abs());
    }
}
