//! What acts in some places alone, and how far a step may go so as not to pass it by: where nothing acts, errors allow steps as long as one likes.

use kempe_dynamics::amount::Amount;
use kempe_measure::measure::{visit_leaves, visit_parts};
use kempe_mechanism::Mechanism;
use kempe_model::{Acts, Leaf, Measure};
use kempe_units::{Builtin, Expr};

use crate::plant::Plant;

/// Where something acts one way only, no coordinate goes farther in a step, rad, or in parts of the mechanism's size.
const CAP: f64 = std::f64::consts::TAU / 72.0;
/// Of a table, a step goes over two points at most, or over this part of it.
const PART: f64 = 1e-3;
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
        let least = PART * self.period.unwrap_or(last - first);
        // The second point ahead; behind the last of them those of the next round follow.
        let ahead = match rate >= 0.0 {
            true => {
                let next = self.knots.partition_point(|knot| *knot <= place + least);
                let second = self.knots.get(next + 1);
                let round = self.period.and_then(|period| {
                    let left = (next + 1).checked_sub(self.knots.len())?;
                    Some(self.knots.get(left + 1)? + period)
                });
                second.copied().or(round).map(|knot| knot - place)
            }
            false => {
                let next = self.knots.partition_point(|knot| *knot < place - least);
                let second = next.checked_sub(2).and_then(|k| self.knots.get(k));
                let round = self.period.and_then(|period| {
                    let left = 2_usize.checked_sub(next)?;
                    let k = self.knots.len().checked_sub(1 + left)?;
                    Some(self.knots.get(k)? - period)
                });
                second.copied().or(round).map(|knot| place - knot)
            }
        };
        let to_end = match rate >= 0.0 {
            true => last - place,
            false => place - first,
        };
        let beyond = if to_end > 0.0 { to_end } else { f64::INFINITY };
        ahead.unwrap_or(beyond).max(least)
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
