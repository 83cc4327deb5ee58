//! The samples that all numbers over a motion share: the mechanism is solved once at each, for all of them.

use std::collections::BTreeMap;

use kempe_model::Measure;
use kempe_motion::progress::{Done, Progress, Stage};

use super::resolve::{Resolution, Shown};
use super::stretches::SmoothStretch;
use crate::force_source::ForceSource;
use crate::measure::Series;
use crate::sampler::{Asked, Kept, Sampler};

/// Halvings of an interval by which an end without a rate of its own is approached: nearer than its 2^40th part nothing
/// can be told from the end.
const HALVINGS: i32 = 40;

/// All measures at a time.
pub(super) struct Sample {
    pub time: f64,
    pub series: Vec<Series<f64>>,
}

/// One measure at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub time: f64,
    pub series: Series<f64>,
}

impl Point {
    /// Samples the only measure asked for.
    pub fn take<F: ForceSource>(sampler: &mut Sampler<F>, asked: &Asked, time: f64) -> Self {
        let series = sampler.series_at(asked, time);
        Self {
            time,
            series: series.first().copied().unwrap_or(undefined()),
        }
    }

    pub fn value(&self) -> f64 {
        self.series.coefficient(0)
    }

    pub fn rate(&self) -> f64 {
        self.series.coefficient(1)
    }
}

impl Sample {
    fn take<F: ForceSource>(sampler: &mut Sampler<F>, asked: &Asked, time: f64) -> Self {
        let series = sampler.series_at(asked, time);
        Self { time, series }
    }

    pub fn point(&self, index: usize) -> Point {
        Point {
            time: self.time,
            series: self.series.get(index).copied().unwrap_or(undefined()),
        }
    }
}

fn undefined() -> Series<f64> {
    Series::from_coefficients([f64::NAN; crate::measure::ORDER])
}

/// Measures that are looked at one after the other at many of the same times: what one of them asks of a state is kept for
/// the others.
pub(super) struct Closely<'m> {
    measures: Vec<&'m Measure>,
    asked: Asked,
    /// By the bits of the time.
    known: BTreeMap<u64, Vec<Series<f64>>>,
}

impl<'m> Closely<'m> {
    pub fn new<F: ForceSource>(sampler: &Sampler<F>, measures: Vec<&'m Measure>) -> Self {
        Self {
            asked: sampler.asked(&measures),
            measures,
            known: BTreeMap::new(),
        }
    }

    /// Samples one of them.
    pub fn take<F: ForceSource>(
        &mut self,
        sampler: &mut Sampler<F>,
        measure: &Measure,
        time: f64,
    ) -> Point {
        let at = (self.known.entry(time.to_bits()))
            .or_insert_with(|| sampler.series_at(&self.asked, time));
        let place = self.measures.iter().position(|m| *m == measure);
        let series = place.and_then(|place| at.get(place).copied());
        Point {
            time,
            series: series.unwrap_or(undefined()),
        }
    }
}

/// Hears a sample, with the one before it where nothing lies between; tells whether it wants more.
pub(super) type Heard<'h, F> = dyn FnMut(&mut Sampler<F>, Option<&Sample>, &Sample) -> bool + 'h;

/// What a survey could not look into.
#[derive(Debug, Default)]
pub(super) struct Unseen {
    /// Measures, by their index, that have no bound between two samples however near.
    pub unbounded: Vec<(usize, [f64; 2])>,
    /// Measures, by their index, for which more samples would have been needed than are taken; `None` stands for loads.
    pub too_fast: Vec<Option<usize>>,
    /// Times at which samples were put between others.
    pub closely: Vec<f64>,
}

impl Unseen {
    /// Takes up an interval, together with one of the same measure right before it.
    fn take(&mut self, measure: usize, between: [f64; 2]) {
        let known = self.unbounded.iter_mut().rev();
        let mut known = known.filter(|(index, _)| *index == measure);
        match known.next() {
            Some((_, [_, to])) if *to == between[0] => *to = between[1],
            _ => self.unbounded.push((measure, between)),
        }
    }
}

/// Samples a motion stretch by stretch, and where its rows stand, and as much more closely as its measures change between
/// samples. `heard` is told each sample, with the one before it on the same stretch; what it answers says whether to go on.
/// `None` when stopped.
///
/// Where one of two neighbours lacks a rate that the other has, as at a limit, samples ever nearer to it are put between
/// them.
pub(super) fn survey<F: ForceSource>(
    sampler: &mut Sampler<F>,
    asked: &Asked,
    stretches: &[SmoothStretch],
    progress: &mut dyn Progress,
    heard: &mut Heard<'_, F>,
) -> Option<Unseen> {
    let duration = sampler.duration();
    let rows = sampler.rows().to_vec();
    let mut resolution = Resolution::new(sampler, &asked.measures, asked.forces, stretches);
    let mut unseen = Unseen::default();
    for stretch in stretches {
        let mut last: Option<(Sample, Kept)> = None;
        let mut interval = 0.0;
        for time in stretch.times(&rows, duration) {
            progress
                .reached(Stage::Measuring, Done::Part(time / duration))
                .continue_value()?;
            if let Some((before, _)) = &last {
                interval = time - before.time;
            }
            let take = |sampler: &mut Sampler<F>, resolution: &mut Resolution, time: f64| {
                let sample = Sample::take(sampler, asked, time);
                let kept = resolution.keep(sampler, &sample.series);
                (sample, kept)
            };
            // The last of them is the next to be told.
            let mut waiting = vec![take(sampler, &mut resolution, time)];
            while let Some((sample, kept)) = waiting.pop() {
                if let Some((before, kept_before)) = &last {
                    let ends = [(before.time, kept_before), (sample.time, &kept)];
                    let middle = 0.5 * (before.time + sample.time);
                    match resolution.shown(sampler, ends, interval) {
                        Shown::No if before.time < middle && middle < sample.time => {
                            waiting.push((sample, kept));
                            unseen.closely.push(middle);
                            waiting.push(take(sampler, &mut resolution, middle));
                            continue;
                        }
                        Shown::Never(open) => {
                            let between = [before.time, sample.time];
                            open.into_iter().for_each(|k| unseen.take(k, between));
                        }
                        _ => {}
                    }
                    for near in nearing(before, &sample) {
                        let between = take(sampler, &mut resolution, near);
                        if !heard(sampler, last.as_ref().map(|it| &it.0), &between.0) {
                            return Some(unseen);
                        }
                        last = Some(between);
                    }
                }
                if !heard(sampler, last.as_ref().map(|it| &it.0), &sample) {
                    return Some(unseen);
                }
                last = Some((sample, kept));
            }
        }
    }
    unseen.too_fast = resolution.left_open().collect();
    Some(unseen)
}

/// Times between two samples, rising, ever nearer to one that lacks a rate which the other has.
fn nearing(from: &Sample, to: &Sample) -> Vec<f64> {
    let lacks = |a: &Sample, b: &Sample| {
        let mut pairs = a.series.iter().zip(&b.series);
        pairs.any(|(a, b)| {
            let finite = |s: &Series<f64>, k| s.coefficient(k).is_finite();
            finite(a, 0) && !finite(a, 1) && finite(b, 1)
        })
    };
    let part = |k: i32| (to.time - from.time) * kempe_number::powi(2.0, -k);
    let mut times = Vec::new();
    if lacks(from, to) {
        times.extend((1..=HALVINGS).rev().map(|k| from.time + part(k)));
    }
    if lacks(to, from) {
        // The middle once only.
        let first = if times.is_empty() { 1 } else { 2 };
        times.extend((first..=HALVINGS).map(|k| to.time - part(k)));
    }
    times.retain(|t| from.time < *t && *t < to.time);
    times
}
