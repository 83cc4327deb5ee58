//! How far designs close that are solved in lanes: every place is solved by itself there, and behind a limit of its own a design may close again.

use std::sync::Arc;

use kempe_batch::{Batch, Designs, Layout};
use kempe_model::PointId;
use kempe_motion::Motion;

use crate::executor::run;

/// Places on the way from the start at which it is looked whether designs close ...
const LOOKS: usize = 64;
/// ... and so far beside them, as a part of the whole way, where they do not seem to.
const BESIDE: f64 = 1e-6;
/// Values that are looked at together: they stay in the processor's cache.
const TOGETHER: usize = 1 << 18;

/// Between which places each of many designs closes with all its links, on the way from where a motion starts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Closing(Vec<[f64; 2]>);

impl Closing {
    /// Of so many designs, by their parameter values one after the other, on the way to these places.
    pub fn new(
        motion: &Arc<Motion>,
        (values, count): (&[f64], usize),
        places: &[f64],
        threads: usize,
    ) -> Self {
        let mut closes = vec![[f64::NEG_INFINITY, f64::INFINITY]; count];
        let start = motion.start;
        let ends = (places.iter()).fold([start; 2], |[low, high], p| [p.min(low), p.max(high)]);
        let width = ends[1] - ends[0];
        let looks = (0..=LOOKS).map(|k| ends[0] + width * k as f64 / LOOKS as f64);
        let looks: Vec<f64> = looks.chain([start]).collect();
        let open = open(motion, (values, count), &looks, threads);
        let is_doubtful = |design: &usize| open.iter().any(|open| open[*design]);
        let doubtful: Vec<usize> = (0..count).filter(is_doubtful).collect();
        // Where it is stretched out a linkage does not close by rounding alone: right beside it does.
        let parameters = values.len() / count.max(1);
        let own = (doubtful.iter()).flat_map(|design| &values[design * parameters..][..parameters]);
        let own: Vec<f64> = own.copied().collect();
        let towards_start = |p: &f64| match *p < start {
            true => p + BESIDE * width,
            false => p - BESIDE * width,
        };
        let beside: Vec<f64> = looks.iter().map(towards_start).collect();
        let open_beside = self::open(motion, (&own, doubtful.len()), &beside, threads);
        for ((place, open), beside) in looks.iter().zip(&open).zip(&open_beside) {
            let both = doubtful.iter().zip(beside);
            for (design, _) in both.filter(|(design, beside)| open[**design] && **beside) {
                let [low, high] = &mut closes[*design];
                if *place <= start {
                    *low = low.max(*place);
                }
                if *place >= start {
                    *high = high.min(*place);
                }
            }
        }
        Self(closes)
    }

    /// The designs that do not close all the way.
    pub fn limited(&self) -> Vec<usize> {
        let all = self.0.iter().enumerate();
        let limited = all.filter(|(_, ends)| ends.iter().any(|end| end.is_finite()));
        limited.map(|(design, _)| design).collect()
    }

    /// Whether a design does not close somewhere between the start and a place.
    pub fn is_beyond(&self, place: f64, design: usize) -> bool {
        let ends = self.0.get(design);
        ends.is_some_and(|[low, high]| !(*low < place && place < *high))
    }
}

/// By place: which designs do not close there with all their links.
fn open(
    motion: &Arc<Motion>,
    (values, count): (&[f64], usize),
    places: &[f64],
    threads: usize,
) -> Vec<Vec<bool>> {
    let mut all = vec![vec![false; count]; places.len()];
    let mechanism = motion.mechanism();
    let mut seen = vec![false; mechanism.bodies];
    // One point of every link tells whether it has a place.
    let mut own: Vec<PointId> = (0..mechanism.model.points.len() as u32)
        .map(PointId)
        .collect();
    own.retain(|point| {
        let marker = mechanism.any_marker(*point);
        marker.is_some_and(|marker| !std::mem::replace(&mut seen[marker.body.index()], true))
    });
    let Ok(batch) = Batch::new(motion, &own) else {
        return all;
    };
    let designs = Designs {
        values,
        count,
        layout: Layout::ByDesign,
    };
    let room = count * batch.columns();
    if room == 0 {
        return all;
    }
    let together = (TOGETHER / room).max(1);
    let mut out = Vec::new();
    for (all, places) in all.chunks_mut(together).zip(places.chunks(together)) {
        out.clear();
        out.resize(places.len() * room, 0.0);
        let done = run(threads, |executor| {
            batch.designs_on(executor, designs, places, &mut out)
        });
        if done.is_err() {
            break;
        }
        for (open, found) in all.iter_mut().zip(out.chunks_exact(room)) {
            for column in found.chunks_exact(count) {
                for (open, value) in open.iter_mut().zip(column) {
                    *open |= value.is_nan();
                }
            }
        }
    }
    all
}
