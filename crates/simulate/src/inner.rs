//! Inner states on their way: the pressures of cylinders that are let go, which go with the coordinates, and switches, which
//! events turn on and off.

use kempe_dynamics::oil::Oil;
use kempe_linear::Lu;
use kempe_measure::Series;
use kempe_measure::state::ORDER;
use kempe_model::{Chamber, DriveId, InnerState, Model};

use crate::lack::Lack;
use crate::plant::Plant;

/// A cylinder that its oil moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// Its place among the oils that act.
    pub oil: usize,
    /// That of its drive among those that are let go.
    pub free: usize,
    /// That of its first pressure among the model's inner states.
    pub place: usize,
    /// Those of its openings among the plant's amounts; the second is the opposite of the first where it has none.
    pub openings: [Option<usize>; 2],
}

/// The inner states of a plant.
#[derive(Clone, Debug, Default)]
pub(crate) struct Inner {
    /// Cylinders that their oil moves.
    pub moved: Vec<Moved>,
    /// Inner states of the model, as last taken: what nothing follows is not known.
    pub values: Vec<f64>,
    /// The place of the first switch among them.
    first_switch: usize,
}

impl Inner {
    /// Those of a model in which these drives are let go; `openings` makes places of the openings of an oil.
    pub fn new(
        model: &Model,
        oils: &[Oil<f64>],
        free: &[DriveId],
        mut openings: impl FnMut(&Oil<f64>) -> [Option<usize>; 2],
    ) -> Self {
        let moved = oils.iter().enumerate().filter_map(|(index, oil)| {
            Some(Moved {
                oil: index,
                free: free.iter().position(|drive| *drive == oil.drive)?,
                place: model.inner_place(InnerState::Pressure(oil.drive, Chamber::Bore))?,
                openings: openings(oil),
            })
        });
        let moved = moved.collect();
        let states = model.inner_states().len();
        let first_switch = states - model.actions.switches.len();
        let mut values = vec![f64::NAN; states];
        values[first_switch..].fill(0.0);
        Self {
            moved,
            values,
            first_switch,
        }
    }

    /// How many pressures go with the coordinates.
    pub fn pressures(&self) -> usize {
        2 * self.moved.len()
    }

    /// Takes the pressures of a state, Pa.
    pub fn take(&mut self, pressures: &[f64]) {
        for (moved, both) in self.moved.iter().zip(pressures.chunks_exact(2)) {
            self.values[moved.place..moved.place + 2].copy_from_slice(both);
        }
    }

    /// The pressures last taken of a cylinder.
    pub fn of(&self, moved: &Moved) -> [f64; 2] {
        [self.values[moved.place], self.values[moved.place + 1]]
    }

    /// The switches: 1 where they are on, 0 where they are off, or how far they have counted.
    pub fn switches(&self) -> &[f64] {
        &self.values[self.first_switch..]
    }

    /// Sets a switch.
    pub fn set(&mut self, switch: usize, value: f64) {
        self.values[self.first_switch + switch] = value;
    }

    /// The states as series in time at the instant: how a pressure changes is not known of it.
    pub fn series(&self) -> Vec<Series<f64>> {
        let all = self.values.iter().enumerate();
        let series = all.map(|(place, value)| {
            let rate = if place < self.first_switch {
                f64::NAN
            } else {
                0.0
            };
            let mut coefficients = [rate; ORDER];
            coefficients[0] = *value;
            Series::from_coefficients(coefficients)
        });
        series.collect()
    }
}

impl Plant {
    /// Adds what the oil of cylinders pushes to the forces along the coordinates that are let go.
    pub(crate) fn push_by_oil(&mut self) {
        let mut pushes = Vec::new();
        for (index, moved) in self.inner.moved.iter().enumerate() {
            let oil = &self.forces.acting.oils[moved.oil];
            let speed = self.coordinates[oil.drive.index()].coefficient(1);
            let push = oil.push(self.inner.of(moved), speed);
            let push = push - self.seals_resist(index, oil.friction);
            match self.ties {
                None => self.given[moved.free] += push,
                Some(_) => pushes.push((moved.free, push)),
            }
        }
        for (own, push) in pushes {
            self.give(own, push);
        }
    }

    /// Rates of the pressures at the state last taken, for the amounts last found.
    pub(crate) fn pressure_rates(&self, rates: &mut [f64]) -> Result<(), Lack> {
        let opening = |place: Option<usize>| place.map(|place| self.amounts.values[place]);
        for (moved, rates) in self.inner.moved.iter().zip(rates.chunks_exact_mut(2)) {
            let oil = &self.forces.acting.oils[moved.oil];
            let q = &self.coordinates[oil.drive.index()];
            let bore = opening(moved.openings[0]).unwrap_or(0.0);
            let openings = [bore, opening(moved.openings[1]).unwrap_or(-bore)];
            let length = [q.coefficient(0), q.coefficient(1)];
            match oil.rates(length, self.inner.of(moved), openings) {
                Some(found) => rates.copy_from_slice(&found),
                None => return Err(Lack::Oil(oil.drive)),
            }
        }
        Ok(())
    }

    /// Pressures at the start, into the state `y`: those that are told, and of the other cylinders those that hold them where they
    /// are. False where nothing holds them.
    pub(crate) fn pressures_at_start(&mut self, y: &mut [f64]) -> bool {
        let n = self.free.len();
        let mut holds = Vec::new();
        for (k, moved) in self.inner.moved.iter().enumerate() {
            let oil = &self.forces.acting.oils[moved.oil];
            let start = oil.start.unwrap_or([oil.tank; 2]);
            y[2 * (n + k)..2 * (n + k + 1)].copy_from_slice(&start);
            if oil.start.is_none() {
                holds.push((k, *moved));
            }
        }
        if holds.is_empty() {
            return true;
        }
        let mut rates = vec![0.0; y.len()];
        if !self.accelerate(0.0, y, &mut rates) {
            return false;
        }
        // Forces beside those of the tank that leave their drives without acceleration.
        let answers: Vec<Vec<f64>> = (holds.iter())
            .map(|(_, moved)| {
                let mut answer = self.own_row(moved.free);
                self.let_go.respond(&mut answer);
                answer
            })
            .collect();
        let mut factors = Lu::new(holds.len());
        if !factors.factor(|row, column| self.own_along(holds[row].1.free, &answers[column])) {
            self.lack = Some(Lack::Mass);
            return false;
        }
        let mut forces: Vec<f64> = (holds.iter())
            .map(|(_, m)| -self.own_acceleration(m.free, &rates[n..2 * n]))
            .collect();
        factors.solve(&mut forces);
        for ((k, moved), more) in holds.iter().zip(forces) {
            let both = self.forces.acting.oils[moved.oil].holding(more);
            y[2 * (n + k)..2 * (n + k + 1)].copy_from_slice(&both);
        }
        let holds = y.iter().all(|x| x.is_finite());
        self.lack = (!holds).then_some(Lack::Force);
        holds
    }
}
