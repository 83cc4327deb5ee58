//! What events do: impacts, friction that sticks and slips, switches.

use crate::happening::Happened;
use crate::lack::Sought;
use crate::plant::Mode;
use crate::question::Resistance;
use crate::record::Ending;
use crate::site::Rub;
use crate::toggle::Toggled;
use crate::touched::Place;
use crate::watch::{Event, Watch};

use super::rests::{LEFT_OVER, Struck};
use super::{Run, TOUCHED};

/// This part of the whole time behind an instant is looked at where it tells too little itself.
const SOON: f64 = 1e-7;
/// What would hold so soon, as a part of the whole time, had nothing kept the mechanism from it, holds.
const JUST: f64 = 1e-10;

impl Run {
    /// Decides what friction holds: see [`Plant::decide_rubbing`](crate::plant::Plant). Tells of what it holds from here on,
    /// and of what it lets go.
    pub(super) fn rub(&mut self, jumped: bool, turns: Option<usize>, lets_go: &[usize]) -> bool {
        if self.plant.mode.rubs.is_empty() {
            return true;
        }
        let before = self.plant.mode.clone();
        let decided = self.decide(jumped, turns, lets_go);
        if decided {
            self.tell_rubbing(&before);
        }
        decided
    }

    /// The same, and nothing is told.
    pub(super) fn decide(&mut self, jumped: bool, turns: Option<usize>, lets_go: &[usize]) -> bool {
        let state = (self.time, self.y.as_mut_slice());
        let decided = (self.plant).decide_rubbing(state, jumped, turns, lets_go);
        self.plant.lack = decided.err();
        decided.is_ok()
    }

    /// Tells of what friction holds that it did not hold before, and of what it lets go.
    pub(super) fn tell_rubbing(&mut self, before: &Mode) {
        let left = before
            .resting
            .iter()
            .filter(|stop| !self.plant.mode.resting.contains(stop));
        for stop in left.copied().collect::<Vec<_>>() {
            self.tell(Happened::Leaves { stop });
        }
        let (rubs, stuck) = (self.plant.mode.rubs.clone(), self.plant.mode.stuck);
        if stuck || before.stuck {
            match (before.stuck, stuck) {
                (false, true) => self.tell(Happened::Sticks),
                (true, false) => self.tell(Happened::Slips),
                _ => {}
            }
            return;
        }
        let places = self.plant.what_rubs();
        for ((before, now), at) in before.rubs.iter().zip(&rubs).zip(places) {
            match (*before == Rub::Held, *now == Rub::Held) {
                (false, true) => self.tell(Happened::Holds { at }),
                (true, false) => self.tell(Happened::LetsGo { at }),
                _ => {}
            }
        }
    }

    /// What an event does, and what comes to hold by it.
    pub(super) fn happens(&mut self, event: Event) -> Option<Ending> {
        if !event.has_value {
            return self.without_value(event.watch);
        }
        if self.ends.is_empty() || !matches!(event.watch, Watch::Strikes(_) | Watch::Turned(_)) {
            return self.does(event);
        }
        // What stops right where a condition begins to hold never comes beyond.
        let mut hold = match self.soon(JUST) {
            Ok((time, y)) => self.holding(time, &y),
            Err(_) => Vec::new(),
        };
        let before = self.y.clone();
        let ending = self.does(event);
        if ending.is_some() {
            return ending;
        }
        // What an impact stops has no speed but by rounding.
        let n = self.plant.free.len();
        let mut y = self.y.clone();
        for (v, before) in y[n..2 * n].iter_mut().zip(&before[n..2 * n]) {
            *v -= LEFT_OVER * before;
        }
        hold.extend(self.holding(self.time, &y));
        hold.sort_unstable();
        hold.dedup();
        hold.into_iter().find_map(|condition| self.holds(condition))
    }

    /// Conditions that did not hold and do at a time and state.
    fn holding(&mut self, time: f64, y: &[f64]) -> Vec<usize> {
        let ends = self.ends.clone();
        let conditions = ends.iter().zip(&self.conditions).enumerate();
        let holds = conditions.filter(|(_, (end, waits))| {
            **waits && (self.plant.value(end, time, y)).is_some_and(|above| above > 0.0)
        });
        holds.map(|(k, _)| k).collect()
    }

    /// A condition holds.
    fn holds(&mut self, condition: usize) -> Option<Ending> {
        if let Some(toggle) = condition.checked_sub(self.question.end_when.len()) {
            self.toggle(toggle, condition);
            return (!self.rub(false, None, &[])).then(|| self.no_way_at_once());
        }
        self.tell(Happened::Ends { condition });
        Some(Ending::Condition(condition))
    }

    /// What an event does.
    fn does(&mut self, event: Event) -> Option<Ending> {
        match event.watch {
            Watch::Strikes(stop) => {
                let gap = self.plant.gap(stop, self.time, &self.y);
                if gap.is_some_and(|gap| !gap.gives_way()) {
                    return Some(Ending::Unyielding(stop));
                }
                let before = self.plant.mode.resting.clone();
                let Some(struck) = self.strikes(stop) else {
                    return Some(self.no_way_at_once());
                };
                if !self.settle(struck, &before) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Touches(stop) => {
                self.plant.mode.touched.push(stop);
                let rate = self.plant.gap(stop, self.time, &self.y);
                let speed = rate.map_or(f64::NAN, |gap| -gap.rate);
                self.tell(Happened::Touches { stop, speed });
            }
            Watch::Parts(stop) => {
                self.plant.mode.touched.retain(|s| *s != stop);
            }
            Watch::Meets(at) => {
                let speed = -self.plant.opening(at, &self.y)[1];
                if !self.meets(at, speed) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Separates(at) => {
                self.plant.part(at, self.time);
                let [_, speed] = self.plant.opening(at, &self.y);
                self.tell(Happened::Separates { at, speed });
                if self.plant.may_stick(at) && !self.rub(false, None, &[]) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Leaves(place) => {
                let stop = self.plant.mode.resting.remove(place);
                self.plant.mode.beside.clear();
                self.tell(Happened::Leaves { stop });
                if !self.rub(false, None, &[]) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Turned(place) => {
                if !self.rub(false, Some(place), &[]) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Stirs(place) => {
                if !self.rub(false, None, &[place]) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Slips => {
                let mut first = self.plant.firmness(self.time, &self.y);
                // Where nothing presses yet, what gives way shows as soon as something does.
                let nothing = |(_, places): &(f64, Vec<usize>)| self.plant.presses_nowhere(places);
                if first.as_ref().is_some_and(nothing) {
                    first = match self.soon(SOON) {
                        Ok((time, y)) => self.plant.firmness(time, &y),
                        Err(ending) => return Some(ending),
                    };
                }
                if !first.is_some_and(|(_, first)| self.rub(false, None, &first)) {
                    return Some(self.no_way_at_once());
                }
            }
            Watch::Shrinks(k) => {
                return self.plant.own_drive(k).map(Ending::NoLength);
            }
            Watch::Ends(condition, _) => return self.holds(condition),
        }
        None
    }

    /// A time behind by this part of the whole one, with the state that it comes to; the ending where that is not known.
    fn soon(&mut self, part: f64) -> Result<(f64, Vec<f64>), Ending> {
        let mut rates = vec![0.0; self.y.len()];
        if !self.plant.accelerate(self.time, &self.y, &mut rates) {
            return Err(self.no_way_at_once());
        }
        let (n, by) = (self.plant.free.len(), part * self.question.until);
        let mut y = self.y.clone();
        for (x, rate) in y.iter_mut().zip(&rates) {
            *x += by * rate;
        }
        for k in 0..n {
            y[k] += 0.5 * by * by * rates[n + k];
        }
        Ok((self.time + by, y))
    }

    /// What is watched has no value any more.
    fn without_value(&self, watch: Watch) -> Option<Ending> {
        let sought = match watch {
            Watch::Strikes(stop) | Watch::Touches(stop) | Watch::Parts(stop) => Sought::Stop(stop),
            Watch::Ends(condition, _) => self.sought(condition)?,
            _ => return None,
        };
        Some(Ending::NoValue(sought))
    }

    /// Bodies of a joint with play come together: false where what friction holds then is not known.
    pub(super) fn meets(&mut self, at: Place, speed: f64) -> bool {
        self.plant.touch(at, self.time, speed);
        self.tell(Happened::Meets { at, speed });
        !self.plant.may_stick(at) || self.rub(false, None, &[])
    }

    /// Turns something on or off.
    pub(super) fn toggle(&mut self, index: usize, condition: usize) {
        let Some(toggle) = self.toggles.get_mut(index) else {
            return;
        };
        toggle.turn();
        let (what, value, counts) = (toggle.what, toggle.value, toggle.counts());
        let at_once = toggle.has_one_threshold();
        self.ends[condition] = toggle.awaits.clone();
        match what {
            Toggled::Switch(switch) => {
                self.plant.inner.set(switch, value);
                self.tell(match counts {
                    true => Happened::Counts { switch, to: value },
                    false => Happened::Switches {
                        switch,
                        on: value != 0.0,
                    },
                });
            }
            Toggled::Vacuum(free, side) if value != 0.0 => {
                self.tell(Happened::Cavitates { free, side });
            }
            Toggled::Vacuum(..) => {}
        }
        let awaited = &self.ends[condition];
        self.conditions[condition] =
            at_once || (self.plant.value(awaited, self.time, &self.y)).is_some_and(|x| x < 0.0);
    }

    /// An impact at a stop, and at all others that are closed and closing.
    pub(super) fn strikes(&mut self, stop: usize) -> Option<Struck> {
        let mut stops = vec![stop];
        for other in 0..self.plant.stops.len() {
            let rigid = matches!(self.plant.stops[other].resistance, Resistance::Rigid { .. });
            if other == stop || !rigid {
                continue;
            }
            let gap = self.plant.gap(other, self.time, &self.y)?;
            let scale = gap.scale(&self.plant.scales);
            // Whatever it lies on takes part, even where rounding has it open.
            let mode = &self.plant.mode;
            let lies = mode.resting.contains(&other) || mode.beside.contains(&other);
            if gap.open <= TOUCHED * scale && (gap.rate <= 0.0 || lies) {
                stops.push(other);
            }
        }
        // What is struck again holds by the impact, if it does.
        let held = self.plant.mode.clone();
        self.plant.mode.resting.clear();
        self.plant.mode.beside.clear();
        self.plant.rub_where_it_rests();
        let impact = self.plant.strike(&stops, self.time, &mut self.y)?;
        let rates = impact.rates.iter().map(|[before, _]| before.abs());
        let fastest = rates.fold(0.0, f64::max);
        let mut struck = Struck {
            fastest,
            stops: Vec::new(),
            held,
        };
        for (stop, [before, after]) in stops.iter().zip(&impact.rates) {
            // What opens already is not struck, nor what it lay on before.
            let lay = struck.held.resting.contains(stop) || struck.held.beside.contains(stop);
            if *before >= 0.0 || lay && -before <= LEFT_OVER * fastest {
                continue;
            }
            struck.stops.push(*stop);
            self.tell(Happened::Strikes {
                stop: *stop,
                before: *before,
                after: *after,
            });
        }
        if let Some(work) = self.y.last_mut() {
            *work += impact.work;
        }
        Some(struck)
    }
}
