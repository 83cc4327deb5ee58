//! Friction: each place that rubs slides in a sense of its own, or is held.
//!
//! A place that slides resists with all its friction against the sense in which it does, until its speed changes sign. One that is held
//! resists with what it takes to stay at rest, by itself or together with others ([`crate::sticking`]), until that is more than its limit.

use kempe_dynamics::friction::Sense;
use kempe_dynamics::let_go::SLOW;
use kempe_linear::Anderson;
use kempe_model::InnerState;
use kempe_number::math;

use crate::barrier::Gap;
use crate::cone::{Cones, Limit};
use crate::inner::Moved;
use crate::lack::Lack;
use crate::plant::Plant;
use crate::site::{Acts, Rub, Rubs, Site};
use crate::sticking::{leave_out, limited, shared, spanned, together, yielding};
use crate::touched::Place;
use crate::vector::dot;
use crate::vector::{add, sum};

/// A speed that is this part of the fastest of its place is none.
const REST: f64 = 1e-9;
/// A row that is this part of the longest of all is none: its place hardly slides by any coordinate.
const UNMOVED: f64 = 1e-10;
/// Corrections of what holds, at most.
const CORRECTIONS: usize = 200;
/// Accelerations are settled when they change by this part, or by this one and by no less any more.
const SETTLED: f64 = 4.0 * f64::EPSILON;
const NEARLY: f64 = 1e-10;
/// A row that is this part of its length off those of stops stands still where they do.
const APART: f64 = 1e-9;
/// Places bear as much as the one that bears most, where it is less by this part.
const AS_MUCH: f64 = 1e-9;
/// An acceleration that is this part of what acts is none.
const LEFT_OVER: f64 = 1e-10;

/// A place at the state last looked at.
struct Here {
    speed: f64,
    /// The rate of the speed where it is none.
    gain: f64,
    limit: f64,
    viscous: f64,
    /// Derivatives of the speed to those of the coordinates that are let go.
    gradient: Vec<f64>,
}

/// Rows at an instant: how they accelerate, which forces act along them, and how large these may be.
struct Now<'a> {
    /// The rows along which forces act: of stops that rub while they slide not those of their gaps.
    by: &'a [Vec<f64>],
    accelerations: &'a [f64],
    forces: &'a [f64],
    limits: &'a [f64],
}

/// What came of it.
struct Acted {
    /// How many of the rows are those of stops.
    stops: usize,
    /// How rows accelerate, and the size of what adds up to that.
    after: Vec<f64>,
    terms: Vec<f64>,
    /// What rows would accelerate by at most where all forces acted along them alone: terms of which some vanish by symmetry leave rounding
    /// of this size.
    by_all: Vec<f64>,
    /// Which of the places anything moves that is let go.
    moves: Vec<bool>,
}

impl Plant {
    /// What rubs, in the order of the places.
    pub fn what_rubs(&self) -> Vec<Rubs> {
        let sites = self.rubbing.sites.iter().map(|site| match site.what {
            Acts::Joint(index, _) => {
                let constraint = self.forces.acting.friction[index].constraint;
                Rubs::Joint(self.forces.design.mechanism.constraints[constraint].1)
            }
            Acts::Contact(at) | Acts::Rigid(at, _) => Rubs::Contact(at),
            Acts::Seals(moved) => Rubs::Seals(self.free[self.inner.moved[moved].free]),
        });
        sites.collect()
    }

    /// The places among the inner states of the parts of friction.
    pub fn friction_places(&self) -> Vec<usize> {
        self.rubbing.sites.iter().map(|site| site.inner).collect()
    }

    /// The parts of friction, as last known.
    pub fn friction_values(&self) -> Vec<f64> {
        let sites = self.rubbing.sites.iter();
        sites.map(|site| self.inner.values[site.inner]).collect()
    }

    /// Cylinders whose seals rub, with the places of their parts among the inner states.
    pub fn seals(&self) -> Vec<(Moved, usize)> {
        let sites = self
            .rubbing
            .sites
            .iter()
            .filter_map(|site| match site.what {
                Acts::Seals(moved) => Some((self.inner.moved[moved], site.inner)),
                Acts::Joint(..) | Acts::Contact(_) | Acts::Rigid(..) => None,
            });
        sites.collect()
    }

    /// Looks at every place that rubs by itself from now on; the model must follow as many.
    pub fn follow_friction(&mut self) {
        let model = &self.forces.design.mechanism.model;
        let size = self.forces.design.size();
        let friction = self.forces.acting.friction.iter().enumerate();
        let joints = friction
            .filter(|(_, f)| f.is_dry())
            .filter_map(|(index, f)| {
                let Sense::Amount(amount) = f.sense else {
                    return None;
                };
                Some((
                    Acts::Joint(index, amount),
                    if f.turns() { 1.0 } else { size },
                ))
            });
        let contacts = self.forces.acting.contacts.iter().enumerate();
        let contacts = contacts
            .filter(|(_, it)| it.sticks())
            .flat_map(|(contact, it)| (0..it.places()).map(move |place| Place { contact, place }))
            .map(|at| match self.stop_of(at) {
                None => (Acts::Contact(at), size),
                Some(stop) => (Acts::Rigid(at, stop), size),
            });
        let seals = self.inner.moved.iter().enumerate();
        let seals = seals
            .filter(|(_, m)| self.forces.acting.oils[m.oil].friction > 0.0)
            .map(|(index, _)| (Acts::Seals(index), size));
        let sites =
            joints
                .chain(contacts)
                .chain(seals)
                .enumerate()
                .filter_map(|(place, (what, size))| {
                    Some(Site {
                        what,
                        inner: model.inner_place(InnerState::Friction(place))?,
                        size,
                        fastest: 0.0,
                        resists: 0.0,
                    })
                });
        self.rubbing.sites = sites.collect();
        // Nothing rubs until that is decided: what is found before, such as pressures that hold, counts no friction.
        self.mode.rubs = vec![Rub::Idle; self.rubbing.sites.len()];
        self.take_senses();
    }

    /// Hands what is known of every place to what acts.
    pub(crate) fn take_senses(&mut self) {
        for (site, rub) in self.rubbing.sites.iter().zip(&self.mode.rubs) {
            self.inner.values[site.inner] = match rub {
                Rub::Slides(sense) => *sense,
                Rub::Held | Rub::Idle | Rub::Apart => 0.0,
            };
            if let Acts::Joint(index, amount) = site.what {
                self.forces.acting.friction[index].sense = match rub {
                    Rub::Slides(_) | Rub::Idle | Rub::Apart => Sense::Amount(amount),
                    Rub::Held => Sense::Resists(site.resists),
                };
            }
        }
        self.take_rigid();
    }

    /// What the seals of a cylinder resist with, by its place among those that oil moves.
    pub(crate) fn seals_resist(&self, moved: usize, friction: f64) -> f64 {
        let mut sites = self.rubbing.sites.iter().zip(&self.mode.rubs);
        match sites.find(|(site, _)| matches!(site.what, Acts::Seals(k) if k == moved)) {
            Some((_, Rub::Slides(sense))) => sense * friction,
            // What holds is found with the rest.
            Some((_, Rub::Held | Rub::Idle | Rub::Apart)) | None => 0.0,
        }
    }

    /// The places at the state last looked at, with the loads and accelerations last found.
    fn rubbing_here(&mut self) -> Vec<Here> {
        let joints = self.forces.sliding(&self.instant);
        let n = self.free.len();
        let of = |site: &Site| match site.what {
            Acts::Joint(index, _) => {
                let rubbing = joints.iter().find(|r| r.friction == index);
                rubbing.map(|r| Here {
                    speed: r.speed,
                    gain: r.gain,
                    limit: r.limit,
                    viscous: r.viscous,
                    gradient: (self.free.iter())
                        .map(|d| r.slope(&self.instant, *d))
                        .collect(),
                })
            }
            Acts::Contact(at) | Acts::Rigid(at, _) => {
                let contact = &self.forces.acting.contacts[at.contact];
                let slides = contact.slides(at.place, &self.instant, &self.free);
                let presses = match site.what {
                    Acts::Rigid(_, stop) => self.push_of(stop).max(0.0),
                    _ => 1.0,
                };
                slides.map(|s| Here {
                    speed: s.speed,
                    gain: s.gain,
                    limit: s.limit * presses,
                    viscous: 0.0,
                    gradient: s.gradient,
                })
            }
            Acts::Seals(moved) => {
                let moved = &self.inner.moved[moved];
                let drive = self.free[moved.free];
                let mut gradient = vec![0.0; n];
                gradient[moved.free] = 1.0;
                Some(Here {
                    speed: self.coordinates[drive.index()].coefficient(1),
                    gain: self
                        .let_go
                        .accelerations
                        .get(moved.free)
                        .copied()
                        .unwrap_or(0.0),
                    limit: self.forces.acting.oils[moved.oil].friction,
                    viscous: 0.0,
                    gradient,
                })
            }
        };
        let nothing = || Here {
            speed: 0.0,
            gain: 0.0,
            limit: 0.0,
            viscous: 0.0,
            gradient: vec![0.0; n],
        };
        let sites = self.rubbing.sites.iter();
        sites.map(|site| of(site).unwrap_or_else(nothing)).collect()
    }

    /// Whether friction may hold the bodies of a joint with play at a place.
    pub fn may_stick(&self, at: Place) -> bool {
        let contacts = &self.forces.acting.contacts;
        contacts.get(at.contact).is_some_and(|it| it.sticks())
    }

    /// Whether anything is held that is looked at by itself.
    pub fn holds_somewhere(&self) -> bool {
        self.mode.rubs.contains(&Rub::Held)
    }

    /// Rows of stops on which it rests and of places, as [`crate::sticking`] sees them: first the stops, then the places; those of places
    /// that hardly slide by any coordinate are nothing.
    fn rows(&self, gaps: &[Gap], here: &[Here], places: &[usize]) -> Vec<Vec<f64>> {
        let halved = |gradient: &Vec<f64>| {
            let mut row = gradient.clone();
            self.let_go.halve(&mut row);
            row
        };
        let all: Vec<Vec<f64>> = here.iter().map(|here| halved(&here.gradient)).collect();
        let sites = self.rubbing.sites.iter();
        let long: Vec<f64> = (sites.zip(&all))
            .map(|(site, row)| dot(row, row).sqrt() / site.size)
            .collect();
        let longest = long.iter().copied().fold(0.0, f64::max);
        let own = places.iter().map(|k| match long[*k] <= UNMOVED * longest {
            true => vec![0.0; self.free.len()],
            false => all[*k].clone(),
        });
        let stops = gaps.iter().map(|gap| halved(&gap.gradient));
        stops.chain(own).collect()
    }

    /// Lets stops push and places resist so that nothing opens and nothing slides that is held. Why nothing can, if it cannot.
    pub(crate) fn hold_still(&mut self, time: f64, y: &[f64]) -> Result<(), Lack> {
        let held = self.held_places();
        let found = self.act_in(time, y, &held, |rows, stops, now| {
            let all: Vec<usize> = (0..rows.len()).collect();
            let (by_stops, of_stops) = spanned(rows, &all[..stops], Vec::new());
            if of_stops.len() < stops {
                return None;
            }
            let (_, of_places) = spanned(rows, &all[stops..], by_stops.clone());
            let independent = [of_stops, of_places].concat();
            let left = independent.iter().map(|k| -now.accelerations[*k]).collect();
            let more = yielding(rows, &independent, left)?;
            let mut whole = sum(rows, now.forces);
            for (k, more) in independent.iter().zip(more) {
                add(&mut whole, more, &rows[*k]);
            }
            // What slides only with a stop's gap stands still with it.
            let apart = rows[stops..].iter().map(|row| {
                let mut off = row.clone();
                leave_out(&by_stops, &mut off);
                match dot(&off, &off) <= APART * APART * dot(row, row) {
                    true => vec![0.0; off.len()],
                    false => off,
                }
            });
            let apart: Vec<Vec<f64>> = apart.collect();
            let mut target = whole.clone();
            leave_out(&by_stops, &mut target);
            let borne = shared(&apart, &now.limits[stops..], &target)?;
            for (row, force) in rows[stops..].iter().zip(&borne) {
                add(&mut whole, -force, row);
            }
            let pushes = together(rows, &all[..stops], &whole)?;
            Some([pushes, borne].concat())
        });
        found.map(|_| ())
    }

    /// The places that are held.
    fn held_places(&self) -> Vec<usize> {
        let rubs = self.mode.rubs.iter().enumerate();
        rubs.filter(|(_, rub)| **rub == Rub::Held)
            .map(|(k, _)| k)
            .collect()
    }

    /// The stops on which it rests, at a state.
    fn resting_gaps(&mut self, time: f64, y: &[f64]) -> Option<Vec<Gap>> {
        let stops = self.mode.resting.clone();
        stops.iter().map(|stop| self.gap(*stop, time, y)).collect()
    }

    /// Finds how everything accelerates while the stops on which it rests push and some places resist as `choose` says of their rows
    /// (see [`crate::sticking`]), the first so many of which are those of the stops: the forces along them. How they accelerate along the rows then.
    fn act_in(
        &mut self,
        time: f64,
        y: &[f64],
        places: &[usize],
        mut choose: impl FnMut(&[Vec<f64>], usize, &Now<'_>) -> Option<Vec<f64>>,
    ) -> Result<Acted, Lack> {
        let gaps = self.resting_gaps(time, y).ok_or(Lack::Pose)?;
        self.pushes = vec![0.0; gaps.len()];
        self.take_senses();
        self.act(time, y, &[])?;
        let given = self.given.clone();
        let (forces, instant) = (&mut self.forces, &mut self.instant);
        (forces.let_go_smoothly(instant, &self.free, &given, &mut self.let_go))
            .map_err(Lack::of)?;
        let pose = self.rubbing_here();
        let rows = self.rows(&gaps, &pose, places);
        let (pushing, by) = self.pushing(&gaps, &rows);
        let back = self.back;
        let (mut before, mut first) = (f64::INFINITY, 0.0_f64);
        let mut mixing = Anderson::default();
        for correction in 0..CORRECTIONS {
            self.take_senses();
            self.given.copy_from_slice(&given);
            for (gap, push) in gaps.iter().zip(&self.pushes) {
                add(&mut self.given, *push, &gap.gradient);
            }
            for k in places {
                let site = &self.rubbing.sites[*k];
                match site.what {
                    // With its load, by what acts.
                    Acts::Joint(..) | Acts::Rigid(..) => {}
                    Acts::Contact(_) | Acts::Seals(_) => {
                        add(&mut self.given, -site.resists, &pose[*k].gradient);
                    }
                }
            }
            (self.forces).left_by_friction(
                &self.instant,
                &self.free,
                &self.given,
                &mut self.let_go,
            );
            let here = self.rubbing_here();
            let mut left = self.let_go.left().to_vec();
            self.let_go.halve(&mut left);
            let by_stops = gaps.iter().map(|gap| {
                let opens = gap.opening(&self.let_go.accelerations);
                opens + back * (2.0 * gap.rate + back * gap.open)
            });
            let by_places = places.iter().map(|k| here[*k].gain + back * here[*k].speed);
            let accelerations: Vec<f64> = (by_stops.chain(by_places).zip(&rows))
                .map(|(a, row)| a + dot(row, &left))
                .collect();
            let resist = places.iter().map(|k| -self.rubbing.sites[*k].resists);
            let forces: Vec<f64> = self.pushes.iter().copied().chain(resist).collect();
            let limits: Vec<f64> = (std::iter::repeat_n(f64::INFINITY, gaps.len()))
                .chain(places.iter().map(|k| here[*k].limit))
                .collect();
            if !limits.iter().chain(&accelerations).all(|x| !x.is_nan()) {
                return Err(Lack::Friction);
            }
            let now = Now {
                by: &by,
                accelerations: &accelerations,
                forces: &forces,
                limits: &limits,
            };
            let found =
                choose(&rows, gaps.len(), &now).ok_or_else(|| self.wedged(&self.mode.resting))?;
            let mut more = self.let_go.left().to_vec();
            let gradients = pushing
                .iter()
                .chain(places.iter().map(|k| &here[*k].gradient));
            let mut changes = vec![0.0; self.free.len()];
            for ((gradient, row), (new, old)) in gradients.zip(&by).zip(found.iter().zip(&forces)) {
                add(&mut changes, new - old, row);
                // What hardly slides by any coordinate is none of the rows.
                if row.iter().any(|x| *x != 0.0) {
                    add(&mut more, new - old, gradient);
                }
            }
            self.let_go.respond(&mut more);
            let mut found = found;
            if correction >= SLOW {
                // All of a size: accelerations in path scales, forces in parts of the largest.
                let largest = found
                    .iter()
                    .map(|f| f.abs())
                    .fold(f64::MIN_POSITIVE, f64::max);
                let sizes: Vec<f64> = (self.scales.iter().copied())
                    .chain(found.iter().map(|_| largest))
                    .collect();
                let whole = self.let_go.accelerations.iter().chain(&forces);
                let by = found.iter().zip(&forces).map(|(new, old)| new - old);
                let by = more.iter().copied().chain(by);
                let whole: Vec<f64> = whole.zip(&sizes).map(|(x, size)| x / size).collect();
                let by: Vec<f64> = by.zip(&sizes).map(|(x, size)| x / size).collect();
                let step = mixing.step(&whole, &by);
                let mut step = step.iter().zip(&sizes).map(|(x, size)| x * size);
                more.iter_mut().zip(&mut step).for_each(|(x, new)| *x = new);
                for (new, (old, step)) in found.iter_mut().zip(forces.iter().zip(step)) {
                    *new = old + step;
                }
            }
            (self.let_go).accelerate(&mut self.instant, &self.free, &more);
            self.pushes.copy_from_slice(&found[..gaps.len()]);
            for (k, force) in places.iter().zip(&found[gaps.len()..]) {
                self.rubbing.sites[*k].resists = -force;
            }
            let change = more.iter().zip(&self.scales).map(|(a, s)| (a / s).abs());
            let change = change.fold(0.0, math::max);
            let whole = self.let_go.accelerations.iter().zip(&self.scales);
            let whole = whole.map(|(a, s)| (a / s).abs()).fold(0.0, f64::max);
            if !change.is_finite() {
                return Err(Lack::Friction);
            }
            let terms = self.let_go.by_terms().iter().zip(&self.scales);
            let terms = terms.map(|(a, s)| (a / s).abs()).fold(0.0, f64::max);
            first = first.max(whole).max(change).max(terms);
            let rounds = change <= NEARLY * first && change > 0.5 * before;
            before = change;
            if rounds || change <= SETTLED * whole || change == 0.0 {
                self.take_senses();
                let after = accelerations
                    .iter()
                    .zip(&rows)
                    .map(|(a, row)| a + dot(row, &changes));
                let long = |row: &Vec<f64>| dot(row, row).sqrt();
                let forces = by.iter().zip(&found).map(|(by, f)| long(by) * f.abs());
                let forces: f64 = forces.sum();
                return Ok(Acted {
                    stops: gaps.len(),
                    by_all: rows.iter().map(|row| forces * long(row)).collect(),
                    after: after.collect(),
                    moves: (rows[gaps.len()..].iter())
                        .map(|row| row.iter().any(|x| *x != 0.0))
                        .collect(),
                    terms: (accelerations.iter().zip(&rows))
                        .map(|(a, row)| {
                            let by = by.iter().zip(&found).map(|(r, f)| (dot(row, r) * f).abs());
                            a.abs() + by.sum::<f64>()
                        })
                        .collect(),
                });
            }
        }
        Err(Lack::Friction)
    }

    /// How far everything that is held is from giving way, as a part of its limit: negative where something does. With what gives way
    /// first.
    pub fn firmness(&mut self, time: f64, y: &[f64]) -> Option<(f64, Vec<usize>)> {
        if self.held(time, y).is_err() {
            return None;
        }
        let here = self.rubbing_here();
        let part = |k: usize| {
            let (site, here) = (&self.rubbing.sites[k], &here[k]);
            let dry = (site.resists - here.viscous).abs();
            // What nothing can hold slides.
            let sliding = here.speed.abs() / self.hardly(k);
            let borne = if dry == 0.0 { 0.0 } else { dry / here.limit };
            borne.max(if site.resists == 0.0 { sliding } else { 0.0 })
        };
        let held = (0..here.len()).filter(|k| self.mode.rubs[*k] == Rub::Held);
        let parts: Vec<(usize, f64)> = held.map(|k| (k, part(k))).collect();
        let most = parts.iter().map(|(_, part)| *part).fold(0.0, f64::max);
        let first = parts
            .iter()
            .filter(|(_, part)| *part >= most * (1.0 - AS_MUCH));
        Some((1.0 - most.min(2.0), first.map(|(k, _)| *k).collect()))
    }

    /// Whether nothing presses in these places, at the state last looked at.
    pub fn presses_nowhere(&mut self, places: &[usize]) -> bool {
        let here = self.rubbing_here();
        places.iter().all(|k| here[*k].limit == 0.0)
    }

    /// A speed that is none in a place.
    pub fn hardly(&self, place: usize) -> f64 {
        let fastest = self.rubbing.sites.iter().map(|s| s.fastest / s.size);
        let size = self.rubbing.sites.get(place).map_or(0.0, |site| site.size);
        REST * size * fastest.fold(self.back, f64::max)
    }

    /// How fast a place slides in its sense, in a state; by how much it is slower than anything that moves, where it is idle.
    pub fn slides(&mut self, place: usize, time: f64, y: &[f64]) -> Option<f64> {
        if !self.look(time, y) {
            return None;
        }
        let here = self.rubbing_here();
        for (site, here) in self.rubbing.sites.iter_mut().zip(&here) {
            site.fastest = site.fastest.max(here.speed.abs());
        }
        let speed = here.get(place)?.speed;
        match self.mode.rubs.get(place)? {
            Rub::Slides(sense) => Some(speed * sense),
            Rub::Idle | Rub::Held | Rub::Apart => Some(self.hardly(place) - speed.abs()),
        }
    }

    /// Decides in a state, whose speeds it clears of what should be none, which places are held and in which sense the others slide.
    /// Those that were held stay at rest, unless speeds `jumped`; `turns` is at rest too, and `lets_go` gives way. Why it cannot be known, if it cannot.
    pub fn decide_rubbing(
        &mut self,
        (time, y): (f64, &mut [f64]),
        jumped: bool,
        turns: Option<usize>,
        lets_go: &[usize],
    ) -> Result<(), Lack> {
        self.mode.stuck = false;
        if !self.look(time, y) {
            return Err(Lack::Pose);
        }
        let here = self.rubbing_here();
        for (site, here) in self.rubbing.sites.iter_mut().zip(&here) {
            site.fastest = site.fastest.max(here.speed.abs());
        }
        let mut candidates = Vec::new();
        for (k, here) in here.iter().enumerate() {
            let site = &self.rubbing.sites[k];
            let apart = match site.what {
                Acts::Contact(at) => !self.is_touching(at),
                Acts::Rigid(_, stop) => !self.mode.resting.contains(&stop),
                Acts::Joint(..) | Acts::Seals(_) => false,
            };
            if apart {
                self.mode.rubs[k] = Rub::Apart;
                continue;
            }
            let rests = here.speed.abs() <= self.hardly(k);
            let was_held = !jumped && matches!(self.mode.rubs[k], Rub::Held | Rub::Idle);
            self.mode.rubs[k] = if lets_go.contains(&k) {
                let sense = match site.resists {
                    _ if !rests => here.speed,
                    resists => resists,
                };
                Rub::Slides(sense.signum())
            } else if was_held || rests || turns == Some(k) {
                candidates.push(k);
                Rub::Held
            } else {
                Rub::Slides(here.speed.signum())
            };
        }
        self.decide_among(time, y, &candidates)?;
        self.clear_speeds(time, y)
    }

    /// Finds which of some places at rest are held, and how the others begin to slide.
    fn decide_among(&mut self, time: f64, y: &[f64], candidates: &[usize]) -> Result<(), Lack> {
        for k in candidates {
            self.rubbing.sites[*k].resists = 0.0;
        }
        let ties = self.limits_by_pushes(candidates);
        let found = self.act_in(time, y, candidates, |rows, stops, now| {
            let whole = sum(now.by, now.forces);
            let free: Vec<f64> = (now.accelerations.iter().zip(rows))
                .map(|(a, row)| a - dot(row, &whole))
                .collect();
            match &ties {
                None => Some(limited(rows, &free, now.limits)),
                Some(ties) => {
                    let limits = ties.iter().zip(&now.limits[stops..]);
                    let limits: Vec<Limit> = limits
                        .map(|(tie, limit)| tie.unwrap_or(Limit::Fixed(*limit)))
                        .collect();
                    let (by, limits) = (now.by, limits.as_slice());
                    Cones { rows, by, limits }.forces(&free)
                }
            }
        })?;
        let here = self.rubbing_here();
        let sites = self.rubbing.sites.iter();
        let most = sites
            .zip(&here)
            .map(|(site, here)| here.gain.abs() / site.size);
        let most = most.fold(0.0, f64::max);
        let all = self.let_go.acceleration();
        for (place, k) in candidates.iter().enumerate() {
            let (after, terms) = (
                found.after[found.stops + place],
                found.terms[found.stops + place],
            );
            let by_all = match ties {
                Some(_) => found.by_all[found.stops + place],
                None => 0.0,
            };
            // No row accelerates by more than all that is let go, seen as rows are.
            let row = {
                let mut row = here[*k].gradient.clone();
                self.let_go.halve(&mut row);
                dot(&row, &row).sqrt()
            };
            let sizes = [terms, by_all, most * self.rubbing.sites[*k].size, row * all];
            let slides = after.abs() > LEFT_OVER * sizes.into_iter().fold(0.0, f64::max);
            self.mode.rubs[*k] = match (slides, found.moves[place]) {
                (true, _) => Rub::Slides(after.signum()),
                (false, true) => Rub::Held,
                (false, false) => Rub::Idle,
            };
        }
        if ties.is_some() {
            let opens =
                (0..found.stops).map(|stop| found.after[stop] > LEFT_OVER * found.by_all[stop]);
            self.leave(&opens.collect::<Vec<bool>>());
        }
        self.take_senses();
        Ok(())
    }

    /// Takes what is left of their speeds from what is held; all that moves stands still where that holds everything.
    fn clear_speeds(&mut self, time: f64, y: &mut [f64]) -> Result<(), Lack> {
        let here = self.rubbing_here();
        let held = self.held_places();
        if held.is_empty() {
            return Ok(());
        }
        let gaps = self.resting_gaps(time, y).ok_or(Lack::Pose)?;
        let rows = self.rows(&gaps, &here, &held);
        let all: Vec<usize> = (0..rows.len()).collect();
        let (by_stops, of_stops) = spanned(&rows, &all[..gaps.len()], Vec::new());
        let (_, of_places) = spanned(&rows, &all[gaps.len()..], by_stops);
        let n = self.free.len();
        let by_friction = !of_places.is_empty();
        let independent = [of_stops, of_places].concat();
        if by_friction && independent.len() == n && self.driven.is_empty() {
            self.mode.stuck = true;
            y[n..2 * n].fill(0.0);
            return Ok(());
        }
        let rates: Vec<f64> = (independent.iter())
            .map(|k| match k.checked_sub(gaps.len()) {
                None => -gaps[*k].rate,
                Some(place) => -here[held[place]].speed,
            })
            .collect();
        let impulses = yielding(&rows, &independent, rates).ok_or(Lack::Rest)?;
        let mut change = vec![0.0; n];
        for (k, impulse) in independent.iter().zip(&impulses) {
            let gradient = match k.checked_sub(gaps.len()) {
                None => &gaps[*k].gradient,
                Some(place) => &here[held[place]].gradient,
            };
            add(&mut change, *impulse, gradient);
        }
        self.let_go.respond(&mut change);
        for (v, change) in y[n..2 * n].iter_mut().zip(&change) {
            *v += change;
        }
        Ok(())
    }

    /// The parts of their greatest friction that act in all places, at a state; of rigid contacts the friction itself, N.
    pub fn friction_parts(&mut self, time: f64, y: &[f64]) -> Option<Vec<f64>> {
        let hangs = self.holds_somewhere() || self.rubs_rigidly();
        if hangs && self.held(time, y).is_err() {
            return None;
        }
        let here = self.rubbing_here();
        let places = self.rubbing.sites.iter().zip(&self.mode.rubs).zip(&here);
        let parts = places.map(|((site, rub), here)| match rub {
            _ if matches!(site.what, Acts::Rigid(..)) => self.inner.values[site.inner],
            Rub::Slides(sense) => *sense,
            Rub::Idle | Rub::Apart => 0.0,
            Rub::Held => match site.resists - here.viscous {
                0.0 => 0.0,
                // Where nothing presses there is no limit to speak of.
                dry => (dry / here.limit).clamp(-1.0, 1.0),
            },
        });
        Some(parts.collect())
    }
}
