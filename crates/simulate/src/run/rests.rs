//! Stops on which it comes to rest.

use kempe_linear::Lu;

use crate::barrier::{Gap, along};
use crate::happening::Happened;
use crate::plant::Mode;
use crate::question::Resistance;

use super::{Run, TOUCHED};

/// A rate this part of that before an impact is none: what should be zero is left over by rounding.
pub(super) const LEFT_OVER: f64 = 1e-9;
/// A flight from a stop that lasts this part of the whole time is none: it rests.
const CHATTER: f64 = 1e-9;
/// Nor is one that rises by this much (in path scales), hardly more than rounding, or by no more than it is closed by.
const RISE: f64 = 2e-15;

/// What an impact struck.
#[derive(Debug, Default)]
pub(super) struct Struck {
    /// The fastest rate before.
    pub fastest: f64,
    /// The stops.
    pub stops: Vec<usize>,
    /// How it was held before.
    pub held: Mode,
}

impl Run {
    /// Takes up the stops on which it comes to rest: closed, hardly opening, and pressed on. `struck` is the fastest rate of an
    /// impact just before. Which ones these are.
    fn rest(&mut self, struck: f64) -> Vec<usize> {
        let mut rests = Vec::new();
        // What it rests on may press it on others.
        loop {
            let known = rests.len();
            self.rest_once(struck, &mut rests);
            if rests.len() == known {
                return rests;
            }
        }
    }

    /// The same, every stop looked at once.
    fn rest_once(&mut self, struck: f64, rests: &mut Vec<usize>) {
        let mut rates = vec![0.0; self.y.len()];
        if self.plant.mode.stuck || !self.plant.accelerate(self.time, &self.y, &mut rates) {
            return;
        }
        let n = self.plant.free.len();
        for stop in 0..self.plant.stops.len() {
            let rigid = matches!(self.plant.stops[stop].resistance, Resistance::Rigid { .. });
            let mode = &self.plant.mode;
            if !rigid || mode.resting.contains(&stop) || mode.beside.contains(&stop) {
                continue;
            }
            let Some(gap) = self.plant.gap(stop, self.time, &self.y) else {
                continue;
            };
            let scale = gap.scale(&self.plant.scales);
            let opening = gap.opening(&rates[n..2 * n]);
            // The flight to come, back to where it began.
            let flight = -2.0 * gap.rate / opening;
            let closed = gap.open.abs() <= TOUCHED * scale;
            let still = opening.abs() <= LEFT_OVER * gap.terms(&rates[n..2 * n]);
            if closed && still && !self.plant.mode.resting.is_empty() {
                self.plant.mode.beside.push(stop);
                continue;
            }
            let rise = -0.5 * gap.rate * gap.rate / opening;
            let stays =
                flight <= CHATTER * self.question.until || rise <= (RISE * scale).max(-gap.open);
            // What closes is what an impact left, or what it would come to in no time.
            let closes = -gap.rate > LEFT_OVER * struck && -flight > CHATTER * self.question.until;
            if closed && opening < 0.0 && !closes && stays {
                self.plant.mode.resting.push(stop);
                self.still();
                rests.push(stop);
                // What it does to the others changes.
                if !self.plant.accelerate(self.time, &self.y, &mut rates) {
                    return;
                }
            }
        }
    }

    /// Tells of stops on which it comes to rest, and on which it did not before.
    fn tell_rests(&mut self, rests: &[usize], before: &[usize]) {
        for stop in rests.iter().filter(|stop| !before.contains(stop)) {
            self.tell(Happened::Rests { stop: *stop });
        }
    }

    /// Decides at the start on which stops it rests, and what friction holds there.
    pub(super) fn rest_at_start(&mut self) -> bool {
        if self.plant.has_rigid_friction() {
            let before = self.plant.mode.clone();
            return self.rest_and_rub(0.0, &before);
        }
        let rests = self.rest(0.0);
        self.tell_rests(&rests, &[]);
        self.plant.mode.resting.is_empty() || self.rub(false, None, &[])
    }

    /// Decides on which stops it rests where some of them rub, and what is held there, by turns until neither changes, and tells of it.
    /// `before` is how it was held.
    fn rest_and_rub(&mut self, struck: f64, before: &Mode) -> bool {
        let mut known = true;
        let mut turns = 0;
        while known && !self.rest(struck).is_empty() {
            known = self.decide(false, None, &[]);
            turns += 1;
            // It rests by what rubs, and does not by what rubs then.
            if turns > self.plant.stops.len() {
                self.plant.lack = Some(self.plant.wedged(&self.plant.mode.resting));
                known = false;
            }
        }
        let rests = self.plant.mode.resting.clone();
        self.tell_rests(&rests, &before.resting);
        let before = Mode {
            resting: Vec::new(),
            ..before.clone()
        };
        self.tell_rubbing(&before);
        known
    }

    /// Takes what is left of the rates of all stops on which it rests from the speeds, at once: one alone would move the others.
    fn still(&mut self) {
        let n = self.plant.free.len();
        if self.plant.is_alone() {
            self.y[1] = 0.0;
            return;
        }
        let resting = self.plant.mode.resting.clone();
        let gaps: Option<Vec<Gap>> = (resting.iter())
            .map(|stop| self.plant.gap(*stop, self.time, &self.y))
            .collect();
        let Some(gaps) = gaps else { return };
        let matrix = self.plant.yielding(&gaps);
        let mut factors = Lu::new(gaps.len());
        if !factors.factor(|row, column| matrix[row][column]) {
            return;
        }
        let mut impulses: Vec<f64> = gaps.iter().map(|gap| -gap.rate).collect();
        factors.solve(&mut impulses);
        let mut change = along(&gaps, &impulses, n);
        self.plant.let_go.respond(&mut change);
        for (v, change) in self.y[n..2 * n].iter_mut().zip(&change) {
            *v += change;
        }
    }

    /// Takes up the stops on which it rests after something was struck, or jerked. `before` are those on which it did: what it leaves is
    /// told, unless it was struck.
    pub(super) fn settle(&mut self, struck: Struck, before: &[usize]) -> bool {
        // What holds what is known before what rests, and again where that changes it.
        let known = if self.plant.has_rigid_friction() {
            self.decide(true, None, &[]) && self.rest_and_rub(struck.fastest, &struck.held)
        } else {
            let known = self.rub(true, None, &[]);
            let rests = self.rest(struck.fastest);
            self.tell_rests(&rests, before);
            known && (rests.is_empty() || self.rub(false, None, &[]))
        };
        let leaves = before.iter().filter(|stop| {
            let mode = &self.plant.mode;
            !mode.resting.contains(stop)
                && !mode.beside.contains(stop)
                && !struck.stops.contains(stop)
        });
        for stop in leaves.copied().collect::<Vec<_>>() {
            self.tell(Happened::Leaves { stop });
        }
        known
    }
}
