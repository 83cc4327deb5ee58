//! What acts in some places alone, and how far a step may go so as not to pass it by: where nothing acts, errors allow steps as long as one likes.

use kempe_dynamics::amount::Amount;
use kempe_measure::measure::{visit_leaves, visit_parts};
use kempe_mechanism::Mechanism;
use kempe_model::{Acts, Leaf, Measure};
use kempe_units::{Builtin, Expr};

use crate::plant::Plant;

/// Where something acts one way only, no coordinate goes farther in a step, rad, or in parts of the mechanism's size.
const CAP: f64 = std::f64::consts::TAU / 72.0;
/// Of a table, a step ends at its next point, goes over this part of what lies between two at most, and over the other part of the whole at least; a point
/// that is nearer than the last one was met.
const OF_PIECE: f64 = 1.0 / 3.0;
const PART: f64 = 1e-3;
const NOTHING: f64 = 1e-9;
/// The rate of what a table goes by is told by its change over this part of the whole time.
const SOON: f64 = 1e-9;

/// A table over something that moves.
struct Curve {
    over: Measure,
    knots: Vec<f64>,
    period: Option<f64>,
}

/// What must not be passed by.
pub(crate) struct Sharp {
    curves: Vec<Curve>,
    /// Whether anything begins to act somewhere.
    begins: bool,
    soon: f64,
}

impl Sharp {
    /// Of all that acts, in a simulation of this duration.
    pub fn new(plant: &Plant, until: f64) -> Self {
        let mechanism = &plant.forces.design.mechanism;
        let moves = |amount: &&Amount<f64>| goes_by_place(mechanism, &amount.measure);
        let amounts: Vec<&Amount<f64>> = plant.amounts.all().filter(moves).collect();
        let curves = amounts.iter().filter_map(|amount| {
            let (table, _) = amount.curve.as_ref()?;
            Some(Curve {
                over: amount.measure.clone(),
                knots: table.knots().to_vec(),
                period: table.period(),
            })
        });
        let has_corner = |amount: &&Amount<f64>| has_corner(mechanism, &amount.measure);
        let springs = plant.forces.acting.springs.iter().map(|it| &it.law);
        let one_way = |acts: Acts, stops: &[Option<f64>]| {
            acts != Acts::Both || stops.iter().any(Option::is_some)
        };
        Self {
            curves: curves.collect(),
            begins: amounts.iter().any(has_corner)
                || springs.into_iter().any(|law| one_way(law.acts, &law.stops)),
            soon: SOON * until,
        }
    }

    /// The longest step from a state with these rates.
    pub fn longest(&self, plant: &mut Plant, time: f64, y: &[f64], rates: &[f64]) -> f64 {
        let mut longest = f64::INFINITY;
        if self.begins {
            let size = plant.forces.design.size();
            let states = plant.drives_at(time, y, rates);
            let drives = &plant.forces.design.mechanism.model.drives;
            for (drive, [_, speed, acceleration]) in drives.iter().zip(states) {
                let turns = drive.dimension == kempe_units::Dimension::ANGLE;
                let cap = CAP * if turns { 1.0 } else { size };
                let root = (speed * speed + 2.0 * acceleration.abs() * cap).sqrt();
                longest = longest.min(2.0 * cap / (speed.abs() + root));
            }
        }
        if !self.curves.is_empty() {
            let soon = y.iter().zip(rates).map(|(y, rate)| y + self.soon * rate);
            let soon: Vec<f64> = soon.collect();
            for curve in &self.curves {
                let now = plant.value(&curve.over, time, y);
                let then = plant.value(&curve.over, time + self.soon, &soon);
                if let (Some(now), Some(then)) = (now, then) {
                    let rate = (then - now) / self.soon;
                    longest = longest.min(curve.room(now, rate) / rate.abs());
                }
            }
        }
        longest
    }

    /// Whether a step between two states passes by what it must not.
    pub fn passes(&self, plant: &mut Plant, from: (f64, &[f64]), to: (f64, &[f64])) -> bool {
        self.curves.iter().any(|curve| {
            let mut at = |(time, y): (f64, &[f64])| plant.value(&curve.over, time, y);
            let (Some(from), Some(to)) = (at(from), at(to)) else {
                return false;
            };
            // What was told by rates may be a little off.
            (to - from).abs() > 2.0 * curve.room(from, to - from)
        })
    }

    /// Whether steps may be too long at all.
    pub fn is_there(&self) -> bool {
        self.begins || !self.curves.is_empty()
    }
}

impl Curve {
    /// How far a step from a place may go in the sense of a rate.
    fn room(&self, from: f64, rate: f64) -> f64 {
        let [Some(first), Some(last)] = [self.knots.first(), self.knots.last()] else {
            return f64::INFINITY;
        };
        let place = match self.period {
            Some(period) => from - ((from - first) / period).floor() * period,
            None => from,
        };
        let whole = self.period.unwrap_or(last - first);
        let (least, nothing) = (PART * whole, NOTHING * whole);
        let ahead = rate >= 0.0;
        // The point above the piece that a step goes over.
        let mut next = match ahead {
            true => self.knots.partition_point(|it| *it <= place + nothing),
            false => self.knots.partition_point(|it| *it < place - nothing),
        };
        let mut round = 0.0;
        if let Some(period) = self.period {
            match (ahead, next) {
                (true, next_of) if next_of == self.knots.len() => (next, round) = (1, period),
                (false, 0) => (next, round) = (self.knots.len() - 1, -period),
                _ => {}
            }
        }
        let knot = |k: Option<usize>| Some(self.knots.get(k?)? + round);
        let (below, above) = (knot(next.checked_sub(1)), knot(Some(next)));
        let goal = if ahead { above } else { below };
        let piece = below.zip(above).map_or(f64::INFINITY, |(a, b)| b - a);
        let room = goal.map(|goal| (goal - place).abs().min(OF_PIECE * piece));
        room.map_or(f64::INFINITY, |room| room.max(least))
    }
}

/// Whether a measure goes by where something is or how it moves.
fn goes_by_place(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= !matches!(
            leaf,
            Leaf::Parameter(_) | Leaf::Named(_) | Leaf::Time | Leaf::Inner(_)
        );
    });
    found
}

/// Whether a measure takes the least, greatest or absolute value of anything.
fn has_corner(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_parts(&mechanism.model, measure, &mut |part| {
        found |= matches!(
            part,
            Expr::Call(Builtin::Min | Builtin::Max | Builtin::Abs, _)
        );
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_goes_over_a_third_of_a_piece_in_either_sense() {
        let curve = |period: Option<f64>| Curve {
            over: Expr::Leaf(Leaf::Time),
            knots: vec![1.0, 3.0, 3.5, 5.0],
            period,
        };
        let near = |found: f64, exact: f64| {
            assert!((found - exact).abs() < 1e-10, "{found} {exact}");
        };
        for round in [0.0, 4.0, -8.0] {
            let again = curve(Some(4.0));
            for (place, ahead, behind) in [
                (1.0, 2.0 / 3.0, 0.5),
                (2.0, 2.0 / 3.0, 2.0 / 3.0),
                (2.5, 0.5, 2.0 / 3.0),
                (3.0, 0.5 / 3.0, 2.0 / 3.0),
                (3.4, 0.1, 0.5 / 3.0),
                (4.9, 0.1, 0.5),
            ] {
                near(again.room(place + round, 1.0), ahead);
                near(again.room(place + round, -1.0), behind);
            }
            // What misses a point by rounding has met it.
            near(again.room(3.0 + round - 1e-11, 1.0), 0.5 / 3.0);
            near(again.room(3.0 + round + 1e-11, -1.0), 2.0 / 3.0);
        }
        let once = curve(None);
        near(once.room(-7.0, 1.0), 8.0);
        near(once.room(9.0, -1.0), 4.0);
        assert_eq!(once.room(5.0, 1.0), f64::INFINITY);
        assert_eq!(once.room(1.0, -1.0), f64::INFINITY);
        // No step is shorter than it helps.
        near(once.room(3.0 - 1e-6, 1.0), 4e-3);
    }
}
