//! Pressures of cylinders that oil moves: what they push, how they change, and what they are at the start.

use kempe_linear::Lu;

use crate::lack::Lack;
use crate::plant::Plant;

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
