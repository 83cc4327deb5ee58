//! Stops: how far they are open, what an impact does, and what holds a rest.

use kempe_dynamics::pressed::slopes;
use kempe_linear::Lu;
use kempe_measure::measure::{Along, History, measure};
use kempe_model::{DriveId, Measure};
use kempe_motion::Progress;
use kempe_number::Jet;

use crate::barrier::{Gap, Opens, along};
use crate::plant::Plant;
use crate::question::Resistance;
use crate::touched::Place;
use crate::vector::dot;

/// Passes over the contacts of one impact, at most.
const PASSES: usize = 500;
/// Exact impulses are this near to those that passes found.
const NEAR: f64 = 1e-3;
/// An impulse that changes by less than this part is settled.
const SETTLED: f64 = 1e-15;

/// So many times a stop that goes by itself is looked at on its way.
const LOOKS: usize = 1000;

/// Beside the start is this far off (in path scales).
const BESIDE: f64 = 1e-3;

/// An impact at several stops.
pub(crate) struct Impact {
    /// Rates before and after.
    pub rates: Vec<[f64; 2]>,
    /// Work done on the mechanism by the contacts, J, and by drives that keep their laws.
    pub work: f64,
}

impl Plant {
    /// A measure of the pose at a state.
    pub fn value(&mut self, what: &Measure, time: f64, y: &[f64]) -> Option<f64> {
        self.take_as_it_is(time, y);
        let state = self.state(time)?;
        Some(measure(&state, &History::default(), None, what, Along::Time).coefficient(0))
    }

    /// Whether what a stop bounds goes on by itself at the start, `y`: by drives that keep their laws or by time, and by nothing that is
    /// let go. That may be so right there alone, where it turns back; so a little beside it, too.
    pub fn goes_by_itself(&mut self, stop: usize, y: &[f64]) -> bool {
        let mut beside = y.to_vec();
        for (q, scale) in beside.iter_mut().zip(&self.scales) {
            *q += BESIDE * scale;
        }
        let mut by_itself = |y: &[f64]| {
            let gap = self.gap(stop, 0.0, y);
            gap.is_some_and(|gap| {
                let moves = gap.rate != 0.0 || gap.by_driven.iter().any(|slope| *slope != 0.0);
                moves && !gap.gives_way()
            })
        };
        by_itself(y) && by_itself(&beside)
    }

    /// Whether a stop that [goes by itself](Self::goes_by_itself) from the start, `y`, on closes until a time, s, or nobody can tell.
    pub fn closes_by_itself(
        &mut self,
        stop: usize,
        until: f64,
        y: &[f64],
        progress: &mut dyn Progress,
    ) -> bool {
        let mut is_open = |k: usize| {
            let time = until * k as f64 / LOOKS as f64;
            let open = self.look(time, y).then(|| self.open(stop, time, y));
            // Angles and guesses go on from here.
            let known = self.places.go_on(time, &self.coordinates, progress).is_ok();
            known && open.flatten().is_some_and(|open| open > 0.0)
        };
        let open = (0..=LOOKS).take_while(|k| is_open(*k)).count();
        // And back to the start.
        for k in (0..open).rev() {
            is_open(k);
        }
        open <= LOOKS
    }

    /// How far a stop is open at a state.
    pub fn open(&mut self, stop: usize, time: f64, y: &[f64]) -> Option<f64> {
        match self.stops.get(stop)?.opens.clone() {
            Opens::Measure(what) => self.value(&what, time, y),
            Opens::Joint(at) => Some(self.opening_in(at, y, |_, [q, _]| q)),
        }
    }

    /// A stop at a state.
    pub fn gap(&mut self, stop: usize, time: f64, y: &[f64]) -> Option<Gap> {
        match self.stops.get(stop)?.opens.clone() {
            Opens::Measure(what) => self.gap_of(&what, time, y),
            Opens::Joint(at) => Some(self.gap_at(at, y)),
        }
    }

    fn gap_of(&mut self, what: &Measure, time: f64, y: &[f64]) -> Option<Gap> {
        if self.ties.is_some() && !self.look(time, y) {
            return None;
        }
        self.take_as_it_is(time, y);
        let state = self.state(time)?;
        let along = |along| measure(&state, &History::default(), None, what, along);
        let series = along(Along::Time);
        let slope = |drive: &DriveId| along(Along::Drive(*drive)).coefficient(1);
        let gap = Gap {
            open: series.coefficient(0),
            rate: series.coefficient(1),
            bend: 2.0 * series.coefficient(2),
            gradient: self.free.iter().map(slope).collect(),
            by_driven: self.driven.iter().map(slope).collect(),
        };
        Some(match &self.ties {
            None => gap,
            Some(ties) => ties.of_gap(gap, &self.scales),
        })
    }

    pub(crate) fn gap_at(&self, at: Place, y: &[f64]) -> Gap {
        let in_time = |_, [q, v]: [f64; 2]| Jet::<f64, 3>::from_coefficients([q, v, 0.0]);
        let [open, rate, bend] = *self.opening_in(at, y, in_time).coefficients();
        let along = |coordinate: usize| {
            let one = |k: usize, [q, _]: [f64; 2]| {
                Jet::<f64, 2>::from_coefficients([q, if k == coordinate { 1.0 } else { 0.0 }])
            };
            self.opening_in(at, y, one).coefficient(1)
        };
        Gap {
            open,
            rate,
            bend: 2.0 * bend,
            gradient: (0..self.free.len()).map(along).collect(),
            by_driven: vec![0.0; self.driven.len()],
        }
    }

    /// What soft stops that are touched push, along the coordinates.
    pub(crate) fn push(&mut self, time: f64, y: &[f64]) -> bool {
        let mut on_bodies = Vec::new();
        for index in 0..self.mode.touched.len() {
            let stop = self.mode.touched[index];
            let Some((push, gap)) = self.soft_push(stop, time, y) else {
                return false;
            };
            if self.carry(stop) {
                on_bodies.push((stop, push, gap.gradient));
                self.pressing += push * gap.rate;
                continue;
            }
            for (given, j) in self.given.iter_mut().zip(&gap.gradient) {
                *given += push * j;
            }
        }
        self.take(time, y);
        on_bodies.into_iter().all(|it| self.press(it, time))
    }

    /// Whether it counts what joints carry of the push of a stop: where friction hangs on that.
    pub(crate) fn carry(&self, stop: usize) -> bool {
        let bodies = self.stops.get(stop).is_some_and(|stop| stop.on_bodies);
        bodies && !self.forces.acting.friction.is_empty()
    }

    /// Lets a stop push on the bodies that it bounds, in the state last taken, and along drives what of its gap's gradient is not theirs.
    pub(crate) fn press(
        &mut self,
        (stop, push, gradient): (usize, f64, Vec<f64>),
        time: f64,
    ) -> bool {
        let Some(barrier) = self.stops.get(stop) else {
            return false;
        };
        let on_drives = barrier.on_drives;
        let Opens::Measure(gap) = barrier.opens.clone() else {
            return false;
        };
        let Some(state) = self.state(time) else {
            return false;
        };
        let links = self.forces.design.mechanism.model.links.len();
        self.instant.pressed.resize(links, [0.0; 3]);
        let slopes = slopes(&state, &gap);
        for (link, slope) in &slopes {
            let own = &mut self.instant.pressed[link.index()];
            *own = std::array::from_fn(|k| own[k] + push * slope[k]);
        }
        if on_drives {
            let mechanism = &self.forces.design.mechanism;
            for ((given, drive), all) in self.given.iter_mut().zip(&self.free).zip(gradient) {
                let coefficients = &self.instant.coefficients[drive.index()];
                let bodies = slopes.iter().map(|(link, slope)| {
                    dot(slope, &coefficients[mechanism.body_of(*link).index()])
                });
                let more = push * (all - bodies.sum::<f64>());
                *given += more;
                // That is no power of what bodies carry.
                self.pressing -= more * self.coordinates[drive.index()].coefficient(1);
            }
        }
        true
    }

    /// The stops whose pushes bodies carry.
    pub fn on_bodies(&self) -> impl Iterator<Item = usize> {
        let stops = self.stops.iter().enumerate();
        stops.filter(|(_, stop)| stop.on_bodies).map(|(k, _)| k)
    }

    /// Whether one of these pushes.
    pub fn presses_on_bodies(&self) -> bool {
        let mut pushing = self.mode.resting.iter().chain(&self.mode.touched);
        pushing.any(|stop| self.stops[*stop].on_bodies)
    }

    /// What the stops push whose pushes bodies carry, one after the other, at a state; nothing where that is not known.
    pub fn pushes_on_bodies(&mut self, time: f64, y: &[f64]) -> Option<Vec<f64>> {
        let stops: Vec<usize> = self.on_bodies().collect();
        let push = |stop: usize| {
            if let Some(place) = self.mode.resting.iter().position(|k| *k == stop) {
                return self.pushed(place, time, y);
            }
            match self.mode.touched.contains(&stop) {
                true => self.soft_push(stop, time, y).map(|(push, _)| push),
                false => Some(0.0),
            }
        };
        stops.into_iter().map(push).collect()
    }

    /// What a soft stop pushes that is touched, and where.
    fn soft_push(&mut self, stop: usize, time: f64, y: &[f64]) -> Option<(f64, Gap)> {
        let gap = self.gap(stop, time, y)?;
        let push = match self.stops.get(stop)?.resistance {
            Resistance::Soft { stiffness, damping } => {
                (-stiffness * gap.open - damping * gap.rate).max(0.0)
            }
            Resistance::Rigid { .. } => 0.0,
        };
        Some((push, gap))
    }

    /// What the mechanism's masses oppose to unit impulses at some gaps: changes of their rates.
    pub(crate) fn yielding(&self, gaps: &[Gap]) -> Vec<Vec<f64>> {
        let row = |gap: &Gap| {
            let mut response = gap.gradient.clone();
            self.let_go.respond(&mut response);
            let to = |other: &Gap| dot(&other.gradient, &response);
            gaps.iter().map(to).collect()
        };
        gaps.iter().map(row).collect()
    }

    /// Strikes rigid stops at a state, whose speeds it changes: by Newton's law of impact, all at once, none pulling.
    pub fn strike(&mut self, stops: &[usize], time: f64, y: &mut [f64]) -> Option<Impact> {
        let mut rates = vec![0.0; y.len()];
        if !self.accelerate(time, y, &mut rates) {
            return None;
        }
        let gaps: Option<Vec<Gap>> = stops.iter().map(|s| self.gap(*s, time, y)).collect();
        let gaps = gaps?;
        let restitution = |stop: &usize| match self.stops.get(*stop).map(|s| s.resistance) {
            Some(Resistance::Rigid { restitution }) => restitution,
            _ => 0.0,
        };
        if stops.iter().any(|stop| self.rubs_at(*stop)) {
            return self.strike_rubbing(stops, &gaps, y);
        }
        let matrix = self.yielding(&gaps);
        // 0 <= impulse, 0 <= rate after + restitution * rate before, one of them 0: by projected Gauss-Seidel.
        let wanted: Vec<f64> = (gaps.iter().zip(stops))
            .map(|(gap, stop)| -(1.0 + restitution(stop)) * gap.rate)
            .collect();
        let mut impulses = vec![0.0_f64; gaps.len()];
        for _ in 0..PASSES {
            let mut settled = true;
            for k in 0..gaps.len() {
                let others: f64 = (0..gaps.len())
                    .filter(|j| *j != k)
                    .map(|j| matrix[k][j] * impulses[j])
                    .sum();
                let new = ((wanted[k] - others) / matrix[k][k]).max(0.0);
                settled &= (new - impulses[k]).abs() <= SETTLED * new.abs();
                impulses[k] = new;
            }
            if settled {
                break;
            }
        }
        polish(&matrix, &wanted, &mut impulses);
        self.take_impulses(&gaps, &matrix, &impulses, y)
    }

    /// Changes the speeds of a state by impulses along gaps, which yield to each other as the matrix says.
    pub(crate) fn take_impulses(
        &self,
        gaps: &[Gap],
        matrix: &[Vec<f64>],
        impulses: &[f64],
        y: &mut [f64],
    ) -> Option<Impact> {
        let n = self.free.len();
        let mut change = along(gaps, impulses, n);
        self.let_go.respond(&mut change);
        // Drives that keep their laws give what momentum along them changes beyond what the contacts give, and move as they do.
        let carried = (self.forces).carried(&self.instant, &self.driven, &self.free, &change);
        let by_driven = carried.iter().zip(&self.driven).enumerate();
        let by_driven = by_driven.map(|(k, (carried, drive))| {
            let by_contacts = gaps.iter().zip(impulses);
            let by_contacts: f64 = by_contacts.map(|(gap, p)| p * gap.by_driven[k]).sum();
            (carried - by_contacts) * self.coordinates[drive.index()].coefficient(1)
        });
        let by_driven: f64 = by_driven.sum();
        for (v, change) in y[n..2 * n].iter_mut().zip(&change) {
            *v += change;
        }
        let mut impact = Impact {
            rates: Vec::new(),
            work: by_driven,
        };
        for (k, gap) in gaps.iter().enumerate() {
            let gained: f64 = (0..gaps.len()).map(|j| matrix[k][j] * impulses[j]).sum();
            let after = gap.rate + gained;
            impact.rates.push([gap.rate, after]);
            impact.work += 0.5 * impulses[k] * (gap.rate + after);
        }
        impact
            .rates
            .iter()
            .flatten()
            .all(|r| r.is_finite())
            .then_some(impact)
    }
}

/// Solves exactly for those impulses that act: passes come nearer and nearer only where contacts lean on each other. They stay what they
/// are where contacts repeat each other, or where one would pull.
fn polish(matrix: &[Vec<f64>], wanted: &[f64], impulses: &mut [f64]) {
    let acting: Vec<usize> = (0..impulses.len()).filter(|k| impulses[*k] > 0.0).collect();
    let mut factors = Lu::new(acting.len());
    if !factors.factor(|row, column| matrix[acting[row]][acting[column]]) {
        return;
    }
    let mut exact: Vec<f64> = acting.iter().map(|k| wanted[*k]).collect();
    factors.solve(&mut exact);
    let near = |(k, exact): (&usize, &f64)| (exact - impulses[*k]).abs() <= NEAR * impulses[*k];
    if acting.iter().zip(&exact).all(near) {
        for (k, exact) in acting.iter().zip(exact) {
            impulses[*k] = exact;
        }
    }
}
