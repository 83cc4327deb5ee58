//! When what rubs dry turns back, as that moves with the parameters: forces jump there.

use kempe_model::Measure;
use kempe_number::Number;

use super::varied::Varied;
use super::{CHUNK, Varying};
use crate::force_source::ForceSource;
use crate::measurer::asks_forces;
use crate::statistics::{BESIDE_TURNS, Slide, turns_between};

/// Times at which it is looked whether what rubs turned back, and how near to breaks, in parts of what lies between these.
const LOOKS: f64 = 360.0;
const AT_BREAK: f64 = 1e-9;

/// When something that rubs dry turns back.
#[derive(Clone, Debug, Default)]
pub(super) struct Turns {
    /// Times between the breaks of the laws.
    pub between: Vec<Varying>,
    /// Right at breaks and at both ends of the motion: where these move otherwise, the turn moves out of the stretch that begins or ends there, or into it.
    at_ends: Vec<End>,
}

/// An end of a stretch between breaks of the laws, with what turns back there.
#[derive(Clone, Debug)]
struct End {
    time: f64,
    /// Whether the stretch begins here.
    begins: bool,
    turns: Vec<Turn>,
}

/// Something that turns back at an end.
#[derive(Clone, Debug)]
struct Turn {
    /// Its place among what slides.
    which: usize,
    /// The sense in which it slides behind.
    sense: f64,
    /// How much faster than the end its time moves with each parameter.
    moves: [f64; CHUNK],
}

impl<F: ForceSource, G: ForceSource<Varying>> Varied<'_, F, G> {
    /// When something that rubs dry turns back, where the measure asks for forces.
    pub(super) fn turns(&mut self, measure: &Measure) -> Turns {
        if !asks_forces(&self.motion, measure) {
            return Turns::default();
        }
        if let Some(known) = &self.turns {
            return known.clone();
        }
        let duration = self.duration();
        let near = 2.0 * BESIDE_TURNS * duration.re;
        let asked = self.sampler.asked(&[measure]);
        let (mut found, mut at_ends) = (Vec::new(), Vec::new());
        for [from, to] in self.cuts(duration, &[]) {
            let (begin, width) = (from.re, to.re - from.re);
            // At a break it goes on as the piece does that follows.
            let end = if to.re < duration.re {
                to.re.next_down()
            } else {
                to.re
            };
            let count = (LOOKS * width / duration.re).ceil().max(2.0) as usize;
            let inside = width * AT_BREAK;
            let even = (0..=count).map(|k| {
                let time = width * k as f64 / count as f64;
                begin + time.clamp(inside, width - inside)
            });
            let mut before: Option<(f64, Vec<Slide>)> = None;
            for time in [begin].into_iter().chain(even).chain([end]) {
                let slides = Slide::at(self.sampler, &asked, time);
                if let Some((earlier, known)) = &before {
                    let ends = [(*earlier, &known[..]), (time, &slides[..])];
                    let turns = turns_between(self.sampler, &asked, ends);
                    let inner = |t: f64| begin + near < t && t < end - near;
                    found.extend(turns.into_iter().filter(|(_, time)| inner(*time)));
                }
                if time == begin || time == end {
                    let moving = if time == begin { from } else { to };
                    let turning = slides.iter().enumerate().filter(|(_, it)| it.turns(near));
                    let turning: Vec<usize> = turning.map(|(which, _)| which).collect();
                    let turns = self.turning_at(measure, time, &turning, moving);
                    if !turns.is_empty() {
                        at_ends.push(End {
                            time,
                            begins: time == begin,
                            turns,
                        });
                    }
                }
                before = Some((time, slides));
            }
        }
        let between = found.into_iter().filter_map(|(which, time)| {
            let (_, moves) = self.turning(measure, which, time)?;
            Some(Varying {
                re: time,
                eps: moves,
            })
        });
        let turns = Turns {
            between: between.collect(),
            at_ends,
        };
        self.turns = Some(turns.clone());
        turns
    }

    /// What turns back at an end of a stretch that moves as given.
    fn turning_at(
        &mut self,
        measure: &Measure,
        time: f64,
        which: &[usize],
        end: Varying,
    ) -> Vec<Turn> {
        let turns = which.iter().filter_map(|&which| {
            let (rate, moves) = self.turning(measure, which, time)?;
            (rate != 0.0 && rate.is_finite()).then(|| Turn {
                which,
                sense: rate.signum(),
                moves: std::array::from_fn(|lane| moves[lane] - end.eps[lane]),
            })
        });
        turns.collect()
    }

    /// The rate at which something's speed changes where it turns back, and how the time of that moves.
    fn turning(
        &mut self,
        measure: &Measure,
        which: usize,
        time: f64,
    ) -> Option<(f64, [f64; CHUNK])> {
        let place = self.at_time(Varying::from_f64(time));
        self.value(measure, place);
        let speed = *self.measurer.forces.sliding().get(which)?;
        let (change, rate) = (speed.coefficient(0), speed.coefficient(1).re);
        let moves = change.eps.map(|d| if d == 0.0 { 0.0 } else { -d / rate });
        Some((rate, moves))
    }

    /// By how much more the integral of a measure over the motion changes with each parameter, as that grows and as it shrinks, because turns move into
    /// the motion that lie right at its ends and at breaks of the laws.
    pub(super) fn gained(&mut self, measure: &Measure) -> [[f64; CHUNK]; 2] {
        let ends = self.turns(measure).at_ends;
        [1.0, -1.0].map(|side| {
            std::array::from_fn(|lane| {
                let gained = ends
                    .iter()
                    .map(|end| self.gained_at(measure, end, lane, side));
                gained.sum()
            })
        })
    }

    /// The same at one end, of one parameter that changes to one side.
    fn gained_at(&mut self, measure: &Measure, end: &End, lane: usize, side: f64) -> f64 {
        let inwards = if end.begins { side } else { -side };
        let (mut inside, outside): (Vec<&Turn>, Vec<&Turn>) =
            (end.turns.iter()).partition(|turn| inwards * turn.moves[lane] > 0.0);
        // In the order in which they turn back.
        inside.sort_by(|a, b| (side * a.moves[lane]).total_cmp(&(side * b.moves[lane])));
        let all = end.turns.iter().map(|turn| turn.which + 1);
        let mut senses = vec![None; all.max().unwrap_or(0)];
        let asked = self.sampler.asked(&[measure]);
        let value = |it: &mut Self, senses: &[Option<f64>]| {
            let found = it.sampler.series_sliding(&asked, end.time, senses);
            found
                .first()
                .map_or(f64::NAN, |series| series.coefficient(0))
        };
        for turn in &outside {
            senses[turn.which] = Some(if end.begins { turn.sense } else { -turn.sense });
        }
        for turn in &inside {
            senses[turn.which] = Some(-turn.sense);
        }
        let (mut gained, mut before) = (0.0, f64::NAN);
        for (k, turn) in inside.iter().enumerate() {
            if k == 0 {
                before = value(self, &senses);
            }
            senses[turn.which] = Some(turn.sense);
            let behind = value(self, &senses);
            gained += (before - behind) * turn.moves[lane];
            before = behind;
        }
        gained
    }
}
