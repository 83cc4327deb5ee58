//! The samples that all numbers over a motion share: the mechanism is solved once at each, for all of them.

use std::collections::{BTreeMap, VecDeque};

use kempe_model::Measure;
use kempe_motion::progress::{Done, Progress, Stage};

use super::resolve::{Resolution, Shown};
use super::reversals::{BESIDE, Slide, reversals};
use super::stretches::SmoothStretch;
use crate::force_source::ForceSource;
use crate::measure::Series;
use crate::sampler::{Asked, Kept, Sampler};

/// Halvings of an interval by which an end without a rate of its own is approached: nearer than its 2^40th part nothing
/// can be told from the end.
const HALVINGS: i32 = 40;
/// So many intervals are looked at together at most: what their ends show need not be looked at one by one, which takes most of the time.
const TOGETHER: usize = 8;

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
    pub fn point(&self, index: usize) -> Point {
        Point {
            time: self.time,
            series: self.series.get(index).copied().unwrap_or(undefined()),
        }
    }
}

/// A sample that waits to be told.
struct Ahead {
    sample: Sample,
    kept: Kept,
    slides: Vec<Slide>,
    /// The distance to the one before it at which samples stand without others between.
    interval: f64,
    /// Whether others were put between.
    halved: bool,
}

impl Ahead {
    fn take<F: ForceSource>(
        sampler: &mut Sampler<F>,
        resolution: &mut Resolution,
        (asked, time): (&Asked, f64),
        interval: f64,
    ) -> Self {
        let series = sampler.series_at(asked, time);
        Self {
            slides: Slide::all(sampler, asked),
            kept: resolution.keep(sampler, &series),
            sample: Sample { time, series },
            interval,
            halved: false,
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
        let mut last: Option<(Sample, Kept, Vec<Slide>)> = None;
        let mut times = stretch.times(&rows, duration).into_iter();
        let mut ahead: VecDeque<Ahead> = VecDeque::new();
        let mut together = 1;
        loop {
            while ahead.len() < together
                && let Some(time) = times.next()
            {
                progress
                    .reached(Stage::Measuring, Done::Part(time / duration))
                    .continue_value()?;
                let before = ahead.back().map(|it| &it.sample);
                let before = before.or(last.as_ref().map(|(sample, ..)| sample));
                let interval = before.map_or(0.0, |before| time - before.time);
                ahead.push_back(Ahead::take(
                    sampler,
                    &mut resolution,
                    (asked, time),
                    interval,
                ));
            }
            if ahead.is_empty() {
                break;
            }
            let mut shown = together.min(ahead.len());
            if let Some((before, kept, _)) = &last {
                let ends = |k: usize| {
                    let end: &Ahead = &ahead[k - 1];
                    [(before.time, kept), (end.sample.time, &end.kept)]
                };
                // What the first and the last of several show, the others show.
                while shown > 1 && !resolution.shown_at_once(sampler, ends(shown)) {
                    shown /= 2;
                }
                let [from, to] = ends(1).map(|(time, _)| time);
                let middle = 0.5 * (from + to);
                let alone =
                    (shown == 1).then(|| resolution.shown(sampler, ends(1), ahead[0].interval));
                match alone {
                    Some(Shown::No) if from < middle && middle < to => {
                        let interval = ahead[0].interval;
                        unseen.closely.push(middle);
                        ahead[0].halved = true;
                        let mut between =
                            Ahead::take(sampler, &mut resolution, (asked, middle), interval);
                        between.halved = true;
                        ahead.push_front(between);
                        together = 1;
                        continue;
                    }
                    Some(Shown::Never(open)) => {
                        open.into_iter().for_each(|k| unseen.take(k, [from, to]));
                    }
                    _ => {}
                }
            }
            together = match shown == together && !ahead[0].halved {
                true => (2 * together).min(TOGETHER),
                false => shown,
            };
            for Ahead {
                sample,
                kept,
                slides,
                ..
            } in ahead.drain(..shown)
            {
                // Forces jump where friction turns over: both sides are looked at, and nothing lies between them.
                let ends = last.as_ref().map(|(before, _, own)| {
                    [(before.time, own.as_slice()), (sample.time, &slides)]
                });
                let turns = ends.map(|ends| reversals(sampler, asked, ends));
                let turns = turns.unwrap_or_default();
                let beside = BESIDE * duration;
                for (side, together) in turns.sides(beside) {
                    let it = Ahead::take(sampler, &mut resolution, (asked, side), 0.0);
                    let before = last.as_ref().filter(|_| together).map(|it| &it.0);
                    if !heard(sampler, before, &it.sample) {
                        return Some(unseen);
                    }
                    last = Some((it.sample, it.kept, it.slides));
                }
                if turns.ends() {
                    last = None;
                }
                let near = last.as_ref().map(|(before, ..)| nearing(before, &sample));
                for near in near.into_iter().flatten() {
                    let between = Ahead::take(sampler, &mut resolution, (asked, near), 0.0);
                    if !heard(sampler, last.as_ref().map(|it| &it.0), &between.sample) {
                        return Some(unseen);
                    }
                    last = Some((between.sample, between.kept, between.slides));
                }
                if !heard(sampler, last.as_ref().map(|it| &it.0), &sample) {
                    return Some(unseen);
                }
                last = Some((sample, kept, slides));
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
