//! Many paths along one way: lanes are filled from a queue, threads share it, and results come in the order of the starts.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::equations::{State, Way};
use kempe_number::Lanes8;

use crate::double::Double;
use crate::flock::{Flock, Orders, Pack, Place};
use crate::given::Given;
use crate::tracker::{Care, End, Next, Tracker};

/// Hears how many paths of how many have ended, now and then, and may stop the rest.
pub type Progress<'a> = &'a dyn Fn(usize, usize) -> ControlFlow<()>;

/// Linear systems that are solved between two calls of the progress, in every lane; those with twice the digits take longer.
const BETWEEN_CALLS: [usize; 2] = [2000, 100];

/// Leads solutions from data to other data, on the threads that the machine has. The ends come in the order of the starts and do not depend on
/// threads. `None` where the progress stopped it.
pub fn follow_all(
    from: &Given,
    to: &Given,
    starts: &[State],
    care: Care,
    progress: Progress,
) -> Option<Vec<End>> {
    let starts: Vec<Place> = starts.iter().map(Place::start).collect();
    let ended = follow_on(from, to, &starts, care, progress)?;
    Some(ended.into_iter().map(|(end, _)| end).collect())
}

/// The same from places on the way, with the last place that each passed.
pub(crate) fn follow_on(
    from: &Given,
    to: &Given,
    starts: &[Place],
    care: Care,
    progress: Progress,
) -> Option<Vec<(End, Place)>> {
    if care.doubled {
        follow_in::<Double>(from, to, starts, care, progress)
    } else {
        follow_in::<Lanes8>(from, to, starts, care, progress)
    }
}

fn follow_in<P: Pack>(
    from: &Given,
    to: &Given,
    starts: &[Place],
    care: Care,
    progress: Progress,
) -> Option<Vec<(End, Place)>> {
    let way = Way::new(from, to);
    let queue = Queue {
        starts,
        next: AtomicUsize::new(0),
        ended: AtomicUsize::new(0),
        stopped: AtomicBool::new(false),
    };
    let work = |progress: Option<Progress>| queue.work::<P>(&way, care, progress);
    let helpers = threads().min(starts.len().div_ceil(P::LANES)).max(1) - 1;
    let mut ended: Vec<(usize, End, Place)> = Vec::with_capacity(starts.len());
    if helpers == 0 {
        ended = work(Some(progress));
    } else {
        std::thread::scope(|scope| {
            let others: Vec<_> = (0..helpers).map(|_| scope.spawn(|| work(None))).collect();
            ended.extend(work(Some(progress)));
            for other in others {
                match other.join() {
                    Ok(some) => ended.extend(some),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
        });
    }
    if queue.stopped.into_inner() {
        return None;
    }
    ended.sort_by_key(|(index, ..)| *index);
    let ended = ended.into_iter();
    Some(ended.map(|(_, end, place)| (end, place)).collect())
}

/// Threads that the machine offers: one where there are none.
fn threads() -> usize {
    if cfg!(target_family = "wasm") {
        return 1;
    }
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

struct Queue<'a> {
    starts: &'a [Place],
    next: AtomicUsize,
    ended: AtomicUsize,
    stopped: AtomicBool,
}

impl Queue<'_> {
    fn take(&self) -> Option<usize> {
        let index = self.next.fetch_add(1, Ordering::Relaxed);
        (index < self.starts.len()).then_some(index)
    }

    /// Follows paths of the queue until it is empty: ends by index, with the last places passed.
    fn work<P: Pack>(
        &self,
        way: &Way,
        care: Care,
        progress: Option<Progress>,
    ) -> Vec<(usize, End, Place)> {
        let mut ends = Vec::new();
        let mut flock = Flock::<P>::new();
        let mut orders = Orders::none();
        let mut lanes: Vec<Option<(usize, Tracker)>> = vec![None; P::LANES];
        for lane in 0..P::LANES {
            lanes[lane] = self.fill(&mut flock, lane, care);
        }
        let mut solved = 0;
        while lanes.iter().any(Option::is_some) {
            P::advance(way, &mut flock, &orders);
            orders = Orders::none();
            for lane in 0..P::LANES {
                let Some((index, tracker)) = &mut lanes[lane] else {
                    continue;
                };
                let next = tracker.decide(flock.correction.lane(lane), flock.largest.lane(lane));
                if let Next::Step | Next::Back = next {
                    if let Next::Step = next {
                        orders.accept.set_lane(lane, 1.0);
                    }
                    orders.predict.set_lane(lane, 1.0);
                    for (order, weights) in orders.weights.iter_mut().zip(tracker.weights()) {
                        order[0].set_lane(lane, weights[0]);
                        order[1].set_lane(lane, weights[1]);
                    }
                    flock.t.set_lane(lane, tracker.at);
                    continue;
                }
                let end = match next {
                    Next::Arrived => End::Arrived(Box::new(flock.corrected(lane))),
                    Next::Ended(end) => end,
                    Next::Correct | Next::Step | Next::Back => continue,
                };
                let last = Place {
                    t: tracker.t,
                    state: flock.last(lane),
                };
                ends.push((*index, end, last));
                self.ended.fetch_add(1, Ordering::Relaxed);
                lanes[lane] = self.fill(&mut flock, lane, care);
            }
            solved += 1;
            if solved == BETWEEN_CALLS[usize::from(care.doubled)] {
                solved = 0;
                if self.should_stop(progress) {
                    break;
                }
            }
        }
        ends
    }

    fn fill<P: Pack>(
        &self,
        flock: &mut Flock<P>,
        lane: usize,
        care: Care,
    ) -> Option<(usize, Tracker)> {
        let index = self.take()?;
        flock.load(lane, &self.starts[index]);
        Some((index, Tracker::new(care, self.starts[index].t)))
    }

    fn should_stop(&self, progress: Option<Progress>) -> bool {
        let ended = self.ended.load(Ordering::Relaxed);
        if let Some(progress) = progress
            && progress(ended, self.starts.len()).is_break()
        {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.stopped.load(Ordering::Relaxed)
    }
}
