//! A plant whose coordinates are those of a spanning tree: what drives that are let go are to it.

use kempe_dynamics::Rates;
use kempe_linear::Lu;
use kempe_mechanism::structure::BodyId;
use kempe_model::DriveId;

use crate::places::Places;
use crate::plant::Plant;
use crate::ties::{About, Own};
use crate::vector::dot;

impl Plant {
    /// Looks at how the links move in the state last taken, and at what the ties ask for.
    pub(crate) fn look_tied(&mut self, time: f64) -> bool {
        if !self.is_closed() {
            return false;
        }
        let (Some(ties), Places::Several(several)) = (&mut self.ties, &mut self.places) else {
            return false;
        };
        if !several.moving_at(time, &self.coordinates, &mut self.instant) {
            return false;
        }
        let about = About {
            free: &self.free,
            driven: &self.driven,
            scales: &self.scales,
        };
        ties.ask(time, &about, several);
        // How drives go that are no coordinates, where nothing accelerates but as ties ask for.
        for k in 0..self.own_count() {
            let drive = self.own_drive(k);
            if let (Some(drive), false) = (drive, self.is_coordinate(k)) {
                let [q, v, a] = self.own_state(k);
                self.coordinates[drive.index()] = Rates::from_coefficients([q, v, 0.5 * a]);
            }
        }
        true
    }

    /// How long it is, s, until the branch on which it is comes to an end by itself or to a change point, if it goes on as it does in the
    /// state last taken, by what changes within `just`, s. None where it does not, or passes it.
    pub(crate) fn meets_in(&mut self, time: f64, just: f64) -> Option<f64> {
        let (Some(ties), Places::Several(several)) = (&self.ties, &mut self.places) else {
            return self.places.meets_in(&self.coordinates, just);
        };
        let about = About {
            free: &self.free,
            driven: &self.driven,
            scales: &self.scales,
        };
        let at = &self.instant;
        ties.meets_in((time, just), &about, several, &self.coordinates, at)
    }

    /// How many drives are let go.
    pub(crate) fn own_count(&self) -> usize {
        self.ties
            .as_ref()
            .map_or(self.free.len(), |ties| ties.own.len())
    }

    /// A drive that is let go.
    pub(crate) fn own_drive(&self, k: usize) -> Option<DriveId> {
        match &self.ties {
            None => self.free.get(k).copied(),
            Some(ties) => ties.drives.get(k).copied(),
        }
    }

    fn is_coordinate(&self, k: usize) -> bool {
        let own = self.ties.as_ref().and_then(|ties| ties.own.get(k));
        own.is_none_or(|own| matches!(own, Own::Coordinate(_)))
    }

    /// Coordinate, speed and acceleration of a drive that is let go, as the links move at the instant.
    pub(crate) fn own_state(&self, k: usize) -> [f64; 3] {
        let Some(own) = self.ties.as_ref().and_then(|ties| ties.own.get(k)) else {
            return [f64::NAN; 3];
        };
        let at = &self.instant;
        match *own {
            Own::Coordinate(place) => {
                let drive = self.free[place].index();
                let q = &self.coordinates[drive];
                [
                    q.coefficient(0),
                    q.coefficient(1),
                    at.drive_accelerations[drive],
                ]
            }
            Own::Length(ends) => {
                let ends = ends.map(|marker| {
                    let arm = at.arm(marker.body, self.forces.design.geometry.marker(marker));
                    [
                        at.place(marker.body, arm),
                        at.velocity(marker.body, arm),
                        at.acceleration(marker.body, arm),
                    ]
                });
                let [span, rate, bend] =
                    [0, 1, 2].map(|k| [0, 1].map(|axis| ends[1][k][axis] - ends[0][k][axis]));
                let length = dot(&span, &span).sqrt();
                let speed = dot(&span, &rate) / length;
                let more = dot(&rate, &rate) - speed * speed + dot(&span, &bend);
                [length, speed, more / length]
            }
            Own::Angle([a, b], more) => {
                let turn = |of: fn(&[f64; 3]) -> f64, all: &[[f64; 3]]| {
                    of(&all[a.index()]) - of(&all[b.index()])
                };
                [
                    at.angle(a) - at.angle(b) + more,
                    turn(|v| v[2], &at.velocities),
                    turn(|v| v[2], &at.accelerations),
                ]
            }
        }
    }

    /// Derivatives of the coordinate of a drive that is let go to the coordinates, at the instant.
    pub(crate) fn own_row(&self, k: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.free.len()];
        let own = self.ties.as_ref().and_then(|ties| ties.own.get(k));
        let at = &self.instant;
        match own {
            None => row[k] = 1.0,
            Some(Own::Coordinate(place)) => row[*place] = 1.0,
            Some(Own::Length(ends)) => {
                let arms = ends
                    .map(|marker| at.arm(marker.body, self.forces.design.geometry.marker(marker)));
                let places = [0, 1].map(|k| at.place(ends[k].body, arms[k]));
                let span = [0, 1].map(|axis| places[1][axis] - places[0][axis]);
                let length = dot(&span, &span).sqrt();
                for (x, drive) in row.iter_mut().zip(&self.free) {
                    let moves = [0, 1].map(|k| {
                        let [x, y, turn] = at.coefficients[drive.index()][ends[k].body.index()];
                        [x - turn * arms[k][1], y + turn * arms[k][0]]
                    });
                    let apart = [0, 1].map(|axis| moves[1][axis] - moves[0][axis]);
                    *x = dot(&span, &apart) / length;
                }
            }
            Some(Own::Angle([a, b], _)) => {
                for (x, drive) in row.iter_mut().zip(&self.free) {
                    let turns = &at.coefficients[drive.index()];
                    *x = turns[a.index()][2] - turns[b.index()][2];
                }
            }
        }
        row
    }

    /// How a drive that is let go goes where the coordinates go so.
    pub(crate) fn own_along(&self, k: usize, coordinates: &[f64]) -> f64 {
        match self.ties {
            None => coordinates[k],
            Some(_) => dot(&self.own_row(k), coordinates),
        }
    }

    /// How a drive that is let go accelerates where the coordinates do so at the state last looked at.
    pub(crate) fn own_acceleration(&self, k: usize, accelerations: &[f64]) -> f64 {
        match self.ties {
            None => accelerations[k],
            // The links accelerate so already.
            Some(_) => self.own_state(k)[2],
        }
    }

    /// The coordinate of a drive that is let go, and its size.
    pub(crate) fn length_of(&mut self, k: usize, time: f64, y: &[f64]) -> Option<[f64; 2]> {
        if self.ties.is_none() {
            return Some([*y.get(k)?, *self.scales.get(k)?]);
        }
        self.take(time, y);
        let length = self.is_closed().then(|| self.own_state(k)[0])?;
        let ties = self.ties.as_ref()?;
        Some([length, *ties.sizes.get(k)?])
    }

    /// Lets something push along a drive that is let go.
    pub(crate) fn give(&mut self, k: usize, push: f64) {
        let row = self.own_row(k);
        for (given, x) in self.given.iter_mut().zip(row) {
            *given += push * x;
        }
    }

    /// What stops push along the coordinates, and motors along their drives.
    pub(crate) fn give_tied(&mut self, pushes: &[f64]) {
        self.given.fill(0.0);
        self.given[..pushes.len()].copy_from_slice(pushes);
        for k in 0..self.own_count() {
            let Some(turned) = self.motors.get(k).copied().flatten() else {
                continue;
            };
            let (motor, sense) = (&self.forces.acting.motors[turned.motor], turned.sense);
            let throttle = turned
                .throttle
                .map_or(1.0, |place| self.amounts.values[place]);
            let push = sense * motor.gives(throttle, sense * self.own_state(k)[1]);
            self.give(k, push);
        }
    }

    /// The speeds of the coordinates at the state last taken.
    pub(crate) fn speeds(&self) -> Vec<f64> {
        let speed = |drive: &DriveId| self.coordinates[drive.index()].coefficient(1);
        self.free.iter().map(speed).collect()
    }

    /// Puts the state last taken, which closes, in the place of one that may not.
    pub(crate) fn keep_closed(&self, y: &mut [f64]) {
        if self.ties.is_none() {
            return;
        }
        let n = self.free.len();
        for (k, drive) in self.free.iter().enumerate() {
            let q = &self.coordinates[drive.index()];
            (y[k], y[n + k]) = (q.coefficient(0), q.coefficient(1));
        }
    }

    /// Coordinate, speed and acceleration at a state with these rates: of every drive of the model, and behind them of what tells the
    /// place for those that are let go.
    pub(crate) fn drives_tied(&mut self, time: f64, y: &[f64], rates: &[f64]) -> Vec<[f64; 3]> {
        let n = self.free.len();
        let known = self.look(time, y);
        let mut all: Vec<[f64; 3]> = (self.coordinates.iter())
            .map(|q| [0, 1, 2].map(|k| q.derivative(k)))
            .collect();
        for (drive, a) in self.free.iter().zip(&rates[n..2 * n]) {
            self.instant.accelerate(*drive, *a);
        }
        let nothing = [f64::NAN; 3];
        let states: Vec<[f64; 3]> = (0..self.own_count())
            .map(|k| if known { self.own_state(k) } else { nothing })
            .collect();
        for (k, state) in states.iter().enumerate() {
            if let Some(drive) = self.own_drive(k) {
                all[drive.index()] = *state;
            }
        }
        self.remember(&states);
        all.truncate(self.own_drives());
        let pilots: Vec<Option<BodyId>> = match &self.ties {
            Some(ties) => ties.pilots.clone(),
            None => Vec::new(),
        };
        let at = &self.instant;
        let told = pilots.iter().zip(&states).map(|(pilot, own)| match pilot {
            None => *own,
            Some(_) if !known => nothing,
            Some(body) => [
                at.angle(*body),
                at.velocities[body.index()][2],
                at.accelerations[body.index()][2],
            ],
        });
        all.extend(told);
        all
    }

    /// The sizes of what tells the place: of the drives that are let go, and 1 rad of links that turn in their stead.
    pub(crate) fn told_scales(&self) -> Vec<f64> {
        match &self.ties {
            None => self.scales.clone(),
            Some(ties) => {
                let own = ties.sizes.iter().zip(&ties.pilots);
                own.map(|(size, pilot)| pilot.map_or(*size, |_| 1.0))
                    .collect()
            }
        }
    }
}

/// A coordinate tells the place poorly where some link turns so many times as fast as it, in rad and mechanism sizes.
const STEEP: f64 = 6.0;

/// How well the place is told along the motion that is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Telling {
    /// Well.
    Well,
    /// Near a dead point of what tells it, where a link may do better.
    Poorly,
    /// Not across a dead point that lies between two states.
    NotAcross,
}

impl Plant {
    /// How every body turns, in rad per rad or m, where what tells the place for one drive goes and what tells it for the others stands
    /// still, at the instant; one after the other. Nothing where that is not known.
    pub(crate) fn turnings(&self) -> Option<Vec<Vec<f64>>> {
        let ties = self.ties.as_ref()?;
        let at = &self.instant;
        let ways = ties.directions(&self.scales);
        let count = ties.own.len();
        let turn = |way: &[f64], body: usize| {
            let parts = self.free.iter().zip(way);
            parts
                .map(|(drive, part)| part * at.coefficients[drive.index()][body][2])
                .sum::<f64>()
        };
        let pilots = ties
            .pilots
            .iter()
            .enumerate()
            .map(|(k, pilot)| match pilot {
                None => {
                    let row = self.own_row(k);
                    ways.iter().map(|way| dot(&row, way)).collect::<Vec<f64>>()
                }
                Some(body) => ways.iter().map(|way| turn(way, body.index())).collect(),
            });
        let pilots: Vec<Vec<f64>> = pilots.collect();
        let mut factors = Lu::new(count);
        if ways.len() != count || !factors.factor(|row, column| pilots[row][column]) {
            return None;
        }
        let all = (0..count).map(|k| {
            let mut parts = vec![0.0; count];
            parts[k] = 1.0;
            factors.solve(&mut parts);
            let bodies = 0..at.poses.len();
            let turns = bodies.map(|body| {
                let by = ways.iter().zip(&parts);
                by.map(|(way, part)| part * turn(way, body)).sum()
            });
            turns.collect()
        });
        Some(all.collect())
    }

    /// How well what tells the place for the drives that are let go does so in the state last looked at, and since that before it.
    pub(crate) fn telling_now(&mut self, time: f64) -> Telling {
        if self.ties.is_none() {
            return Telling::Well;
        }
        let (is_tied, scales) = (self.tied().is_some(), self.told_scales());
        let found = self.turnings();
        let (Some(ties), Some(all)) = (&mut self.ties, found) else {
            return Telling::Well;
        };
        let before = ties.turned.replace((time, all.clone()));
        let mut telling = Telling::Well;
        let mut worst = STEEP;
        for (k, (turns, scale)) in all.iter().zip(&scales).enumerate() {
            let larger = |a: &usize, b: &usize| turns[*a].abs().total_cmp(&turns[*b].abs());
            let Some(body) = (0..turns.len()).max_by(larger) else {
                continue;
            };
            // Beyond its dead point the fastest link goes the other way by it.
            let then = before.as_ref().map_or(0.0, |(_, before)| before[k][body]);
            if then * turns[body] < 0.0 && then.abs().min(turns[body].abs()) * scale > 1.0 {
                ties.poor = Some((k, turns.clone()));
                return Telling::NotAcross;
            }
            let steep = turns[body].abs() * scale;
            if steep >= worst && !is_tied {
                worst = steep;
                ties.poor = Some((k, turns.clone()));
                telling = Telling::Poorly;
            }
        }
        telling
    }

    /// Looks at what tells the place at a time and state from which a step goes on.
    pub(crate) fn telling_from(&mut self, time: f64, y: &[f64]) {
        let known = match &mut self.ties {
            None => true,
            Some(ties) => {
                let known = ties.turned.as_ref().is_some_and(|(then, _)| *then == time);
                if !known {
                    ties.turned = None;
                }
                known
            }
        };
        if !known && self.look(time, y) {
            self.telling_now(time);
        }
    }

    /// Notes what the projection took from a state at the end of a step.
    pub(crate) fn took(&mut self) {
        if let Some(ties) = &mut self.ties {
            ties.taken = ties.taken.max(ties.off);
        }
    }
}
