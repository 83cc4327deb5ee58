//! When what rubs dry turns back, as that moves with the parameters: forces jump there.

use kempe_model::{Measure, SAME_END};
use kempe_number::Number;

use super::over::{LOOKED_AT, SAME_SLOPE};
use super::turn::{End, Turn, Turns};
use super::varied::{PathPlace, Varied};
use crate::base::{CHUNK, Varying};
use crate::force_source::ForceSource;
use crate::measurer::asks_forces;
use crate::state::Series;
use crate::statistics::{BESIDE_TURNS, Slide, turns_between};

/// Times at which it is looked whether what rubs turned back, and how near to breaks, in parts of what lies between these.
const LOOKS: f64 = 360.0;
const AT_BREAK: f64 = 1e-9;
/// Of the usual speed over so many powers of the duration, less than this part is nothing.
const RESTS: f64 = 1e-9;
/// What is slower than this part of the fastest never slides.
const NEVER: f64 = 1e-12;
/// What turns back at a place that moves with it does so to this part of the motion's duration.
const MOVES: f64 = 1e-8;
/// What both sides differ by is rounding, and what both ends of a motion that closes do.
const SAME: f64 = 1e-10;
const CLOSED: f64 = 1e-8;

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
            // However short it is, it begins once and ends once.
            let ends = [(begin, Some((true, from))), (end, Some((false, to)))];
            let times = ends
                .into_iter()
                .take(1)
                .chain(even.map(|time| (time, None)));
            let mut before: Option<(f64, Vec<Slide>)> = None;
            for (time, at_end) in times.chain(ends.into_iter().skip(1)) {
                let slides = Slide::at(self.sampler, &asked, time);
                if let Some((earlier, known)) = &before {
                    let ends = [(*earlier, &known[..]), (time, &slides[..])];
                    let turns = turns_between(self.sampler, &asked, ends);
                    let inner = |t: f64| begin + near < t && t < end - near;
                    found.extend(turns.into_iter().filter(|(_, time)| inner(*time)));
                }
                if let Some((begins, moving)) = at_end {
                    let turning = slides.iter().enumerate().filter(|(_, it)| it.turns(near));
                    let turning: Vec<usize> = turning.map(|(which, _)| which).collect();
                    let place = self.at_time(Varying { re: time, ..moving });
                    let turns = self.turning_at(measure, &turning, place);
                    if !turns.is_empty() {
                        at_ends.push(End {
                            time,
                            begins,
                            turns,
                        });
                    }
                }
                before = Some((time, slides));
            }
        }
        let between = found.into_iter().filter_map(|(which, time)| {
            let place = self.at_time(Varying::from_f64(time));
            self.value(measure, place);
            let speed = *self.measurer.forces.sliding().get(which)?;
            let (change, rate) = (speed.coefficient(0), speed.coefficient(1).re);
            Some(Varying {
                re: time,
                eps: change.eps.map(|d| if d == 0.0 { 0.0 } else { -d / rate }),
            })
        });
        let turns = Turns {
            between: between.collect(),
            at_ends,
        };
        self.turns = Some(turns.clone());
        turns
    }

    /// What of this turns back at a place.
    fn turning_at(
        &mut self,
        measure: &Measure,
        which: &[usize],
        place: PathPlace<Varying>,
    ) -> Vec<Turn> {
        let turns = which.iter().filter_map(|&which| {
            let (sense, moves) = self.turning(measure, which, place)?;
            Some(Turn {
                which,
                sense,
                moves,
            })
        });
        turns.collect()
    }

    /// The sense in which something that slides somewhere does behind a place right at which it turns back, and how much faster than the place the time moves at which it does;
    /// not a number where it does at once, as where the drive is at rest there.
    fn turning(
        &mut self,
        measure: &Measure,
        which: usize,
        place: PathPlace<Varying>,
    ) -> Option<(f64, [f64; CHUNK])> {
        self.value(measure, place);
        let speed = *self.measurer.forces.sliding().get(which)?;
        let all = self.usual_speeds(measure);
        let usual = *all.get(which)?;
        // What never slides does not turn back.
        if usual <= NEVER * all.iter().copied().fold(0.0, f64::max) {
            return None;
        }
        let (duration, changes) = (self.sampler.duration(), self.changes());
        let of_order = |k: usize| RESTS * usual / kempe_number::powi(duration, k as i32);
        let rate = speed.coefficient(1).re;
        if rate.abs() > of_order(1) {
            let moves = speed.coefficient(0).eps;
            let moves = moves.map(|d| if d == 0.0 { 0.0 } else { -d / rate });
            return Some((rate.signum(), moves));
        }
        // It stands still for longer than it would where it turns back with a rate.
        let known = match speed.coefficient(2).re.abs() > of_order(2) {
            true => 2,
            false => 3,
        };
        let moved = |lane: usize| {
            let change = |k: usize| (speed.coefficient(k).eps[lane] * changes[lane]).abs();
            (0..known).any(|k| change(k) > of_order(k))
        };
        let moves = std::array::from_fn(|lane| if moved(lane) { f64::NAN } else { 0.0 });
        Some((1.0, moves))
    }

    /// How fast each thing that rubs slides at most at some places of the motion.
    fn usual_speeds(&mut self, measure: &Measure) -> Vec<f64> {
        if let Some(known) = &self.usual_speeds {
            return known.clone();
        }
        let asked = self.sampler.asked(&[measure]);
        let duration = self.sampler.duration();
        let mut most: Vec<f64> = Vec::new();
        for k in 0..LOOKED_AT {
            let time = duration * (k as f64 + 0.5) / LOOKED_AT as f64;
            let speeds = self.sampler.sliding_at(&asked, time);
            most.resize(most.len().max(speeds.len()), 0.0);
            (most.iter_mut().zip(speeds)).for_each(|(most, speed)| *most = most.max(speed.abs()));
        }
        self.usual_speeds = Some(most.clone());
        most
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
        let at_once = end.turns.iter().any(|turn| turn.moves[lane].is_nan());
        if at_once && !self.is_level_at(measure, end) {
            return f64::NAN;
        }
        let (mut inside, outside): (Vec<&Turn>, Vec<&Turn>) =
            (end.turns.iter()).partition(|turn| inwards * turn.moves[lane] > 0.0);
        // In the order in which they turn back.
        inside.sort_by(|a, b| (side * a.moves[lane]).total_cmp(&(side * b.moves[lane])));
        let mut senses = end.senses(|_| None);
        let value =
            |it: &mut Self, senses: &[Option<f64>]| it.value_sliding(measure, end.time, senses);
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

    /// What moves the value of a measure of forces away from a place right at which something turns back: it jumps there.
    pub(super) fn corner_of_turn(
        &mut self,
        measure: &Measure,
        place: PathPlace<Varying>,
    ) -> [bool; CHUNK] {
        let none = [false; CHUNK];
        if !asks_forces(&self.motion, measure) {
            return none;
        }
        let near = 2.0 * BESIDE_TURNS * self.sampler.duration();
        let speeds = self.measurer.forces.sliding().into_iter().enumerate();
        let turning = speeds.filter(|(_, speed)| {
            let [now, rate] = [0, 1].map(|k| speed.coefficient(k).re.abs());
            now <= near * rate
        });
        let turning: Vec<usize> = turning.map(|(which, _)| which).collect();
        let here = End {
            time: place.time.re,
            begins: true,
            turns: self.turning_at(measure, &turning, place),
        };
        let moved = here.moved(self.changes(), self.sampler.duration());
        match moved != none && !self.is_smooth_at(measure, &here) {
            true => moved,
            false => none,
        }
    }

    /// What makes the largest value of a measure, or for a sign of -1 the smallest, leap beyond what it is: a turn right at an end of the motion or at a break
    /// moves into it, and what lies on its other side is beyond that.
    pub(super) fn leaps(&mut self, measure: &Measure, sign: f64, extreme: f64) -> [bool; CHUNK] {
        let mut leaps = [false; CHUNK];
        for end in self.turns(measure).at_ends {
            let outside = if end.begins { -1.0 } else { 1.0 };
            let senses = end.senses(|turn| Some(outside * turn.sense));
            let beyond = self.value_sliding(measure, end.time, &senses);
            if sign * (beyond - extreme) > CLOSED * extreme.abs() {
                let moved = end.moved(self.changes(), self.sampler.duration());
                (leaps.iter_mut().zip(moved)).for_each(|(it, moved)| *it |= moved);
            }
        }
        leaps
    }

    /// How the time of an extreme moves that lies at a break of the laws, at an end of the motion, or where what rubs turns back; `None` elsewhere. Where it
    /// turns back right at a break and the motion goes on there as it came, or at its other end, the extreme goes with what turns back.
    pub(super) fn moving_at(&mut self, measure: &Measure, time: f64) -> Option<Varying> {
        let duration = self.sampler.duration();
        let near = |by: f64, other: f64| (other - time).abs() <= by * duration;
        let beside = 2.0 * BESIDE_TURNS;
        let turns = self.turns(measure);
        let at_end = turns.at_ends.iter().any(|end| near(beside, end.time));
        let by = if at_end { beside } else { SAME_END };
        let mut breaks = self.breaks().into_iter();
        let Some(own) = breaks.find(|b| near(by, b.re)) else {
            let mut between = turns.between.into_iter();
            return between.find(|turn| near(beside, turn.re));
        };
        let mut eps = own.eps;
        for end in turns.at_ends.iter().filter(|end| near(beside, end.time)) {
            let mut all = turns.at_ends.iter();
            let Some(other) = all.find(|it| it.goes_on(end, duration)) else {
                continue;
            };
            let [a, b] = [end, other].map(|it| {
                let senses = it.senses(|turn| Some(turn.sense));
                self.value_sliding(measure, it.time, &senses)
            });
            if !((a - b).abs() <= CLOSED * a.abs().max(b.abs())) || self.is_smooth_at(measure, end)
            {
                continue;
            }
            for (lane, eps) in eps.iter_mut().enumerate() {
                let moves = end.turns.iter().chain(&other.turns);
                let moves = moves.map(|turn| turn.moves[lane]);
                let [least, most] = moves
                    .clone()
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                        [a.min(x), b.max(x)]
                    });
                let known = least.is_finite() && moves.clone().all(f64::is_finite);
                if known && most - least <= SAME_SLOPE * most.abs().max(least.abs()) {
                    *eps = own.eps[lane] + most;
                }
            }
            break;
        }
        Some(Varying { eps, ..own })
    }

    /// Whether a measure does not jump by what turns back at an end.
    fn is_level_at(&mut self, measure: &Measure, end: &End) -> bool {
        let [before, behind] = self.sides(measure, end);
        let place = self.at_time(Varying::from_f64(end.time));
        let size = self.size_of(measure, place).max(0.0);
        let [before, behind] = [before, behind].map(|series| series.coefficient(0));
        (before - behind).abs() <= SAME * before.abs().max(behind.abs()).max(size)
    }

    /// Whether its rate does not jump there, either: its derivatives do as that does.
    fn is_smooth_at(&mut self, measure: &Measure, end: &End) -> bool {
        let duration = self.sampler.duration();
        let sides = self.sides(measure, end);
        let [before, behind] = sides.map(|series| series.coefficient(1));
        let usual = sides[0].coefficient(0).abs() / duration;
        let same = SAME_SLOPE * before.abs().max(behind.abs()).max(usual);
        self.is_level_at(measure, end) && (before - behind).abs() <= same
    }

    /// A measure before and behind what turns back at an end, as series in time.
    fn sides(&mut self, measure: &Measure, end: &End) -> [Series<f64>; 2] {
        [-1.0, 1.0].map(|side| {
            let senses = end.senses(|turn| Some(side * turn.sense));
            self.series_sliding(measure, end.time, &senses)
        })
    }

    /// The value of a measure at a time where what rubs is taken to slide in these senses.
    fn value_sliding(&mut self, measure: &Measure, time: f64, senses: &[Option<f64>]) -> f64 {
        self.series_sliding(measure, time, senses).coefficient(0)
    }

    fn series_sliding(
        &mut self,
        measure: &Measure,
        time: f64,
        senses: &[Option<f64>],
    ) -> Series<f64> {
        let asked = self.sampler.asked(&[measure]);
        let found = self.sampler.series_sliding(&asked, time, senses);
        found.first().copied().unwrap_or(Series::from_f64(f64::NAN))
    }
}

impl End {
    /// Which parameters, that change by so much, move any of the turns.
    fn moved(&self, changes: [f64; CHUNK], duration: f64) -> [bool; CHUNK] {
        std::array::from_fn(|lane| {
            let mut moves = self.turns.iter().map(|turn| turn.moves[lane]);
            let far = |by: f64| by.is_nan() || (by * changes[lane]).abs() > MOVES * duration;
            moves.any(far)
        })
    }

    /// Whether the motion goes on here as it came to another end, or there as here: at a break, and at its own two ends.
    fn goes_on(&self, other: &Self, duration: f64) -> bool {
        let apart = (self.time - other.time).abs();
        let near = SAME_END * duration;
        let alike = |(a, b): (&Turn, &Turn)| (a.which, a.sense) == (b.which, b.sense);
        self.begins != other.begins
            && (apart <= near || apart >= duration - near)
            && self.turns.len() == other.turns.len()
            && self.turns.iter().zip(&other.turns).all(alike)
    }

    /// Senses of what turns back here, by their place among what slides.
    fn senses(&self, of: impl Fn(&Turn) -> Option<f64>) -> Vec<Option<f64>> {
        let places = self.turns.iter().map(|turn| turn.which + 1);
        let mut senses = vec![None; places.max().unwrap_or(0)];
        for turn in &self.turns {
            senses[turn.which] = of(turn);
        }
        senses
    }
}
