//! How far a step may go, whatever its errors are: what goes by time may begin and end within it.

use std::f64::consts::TAU;

use kempe_dynamics::amount::Amount;
use kempe_measure::measure::visit_leaves;
use kempe_mechanism::Mechanism;
use kempe_model::{DriveId, DriveKind, Leaf, Measure};
use kempe_units::Expr;

use crate::corners::corners;

/// Steps there are at least in the whole time, where expressions go by it: corners may follow closely on each other, or go by more than time.
const LEAST: f64 = 500.0;
/// Points of tables at which steps end, at most: of more they are looked at as expressions are.
const MOST: f64 = 50_000.0;
/// Steps there are at least in a piece of a law that is kept, or in a turn of it: what its drive works is not held to a tolerance.
const OF_LAW: f64 = 12.0;
/// A step is not ended for what is nearer than this part of the whole time.
const NOTHING: f64 = 1e-12;

/// How far steps may go.
pub(crate) struct StepLimits {
    /// Times beyond which none goes, rising.
    ends: Vec<f64>,
    /// The longest.
    longest: f64,
    /// Of every law that is kept, where its pieces begin and end and the longest step in each.
    laws: Vec<Vec<([f64; 2], f64)>>,
    nothing: f64,
}

impl StepLimits {
    /// Of a simulation of this duration, by what acts and the drives that keep their laws.
    pub fn new<'a>(
        mechanism: &Mechanism,
        parameters: &[f64],
        until: f64,
        amounts: impl Iterator<Item = &'a Amount<f64>>,
        driven: &[DriveId],
    ) -> Self {
        let knots = driven.iter().map(|drive| {
            let own = &mechanism.model.drives[drive.index()];
            (own, own.law.knots(parameters))
        });
        let (mut ends, mut laws) = (Vec::new(), Vec::new());
        for (drive, knots) in knots {
            let turning = matches!(drive.kind, DriveKind::Turn { .. });
            let pieces = knots.windows(2).map(|both| {
                let [from, to] = [both[0], both[1]].map(|t| drive.law.at(t, parameters));
                let turns = if turning {
                    (to - from).abs() / TAU
                } else {
                    0.0
                };
                let longest = (both[1] - both[0]) / (OF_LAW * turns.max(1.0));
                ([both[0], both[1]], longest)
            });
            laws.push(pieces.collect());
            ends.extend(knots);
        }
        let mut longest = f64::INFINITY;
        for amount in amounts {
            let model = &mechanism.model;
            ends.extend(corners(model, parameters, &amount.measure, until));
            match times(amount, until) {
                Some(times) => ends.extend(times),
                None if goes_by_time(mechanism, &amount.measure) => longest = until / LEAST,
                None => {}
            }
        }
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        Self {
            ends,
            longest,
            laws,
            nothing: NOTHING * until,
        }
    }

    /// Where a step from a time ends at the latest.
    pub fn after(&self, time: f64) -> f64 {
        let next = self.ends.partition_point(|end| *end <= time + self.nothing);
        let next = self.ends.get(next).copied().unwrap_or(f64::INFINITY);
        let now = time + self.nothing;
        let of_law = self.laws.iter().filter_map(|pieces| {
            let place = pieces.partition_point(|([from, _], _)| *from <= now);
            let ([_, to], longest) = pieces.get(place.checked_sub(1)?)?;
            (now < *to).then_some(*longest)
        });
        let longest = of_law.fold(self.longest, f64::min);
        next.min(time + longest)
    }
}

/// The times of the points of a table over time, where these are not too many.
fn times(amount: &Amount<f64>, until: f64) -> Option<Vec<f64>> {
    let (Expr::Leaf(Leaf::Time), Some((table, _))) = (&amount.measure, &amount.curve) else {
        return None;
    };
    let own = table.knots();
    let rounds = table
        .period()
        .map_or(1.0, |period| (until / period).ceil() + 1.0);
    if rounds * own.len() as f64 > MOST {
        return None;
    }
    let begins = match (table.period(), own.first()) {
        (Some(period), Some(first)) => -(first / period).ceil() * period,
        _ => 0.0,
    };
    let period = table.period().unwrap_or(0.0);
    let shifts = (0..rounds as usize).map(|k| begins + period * k as f64);
    Some(
        shifts
            .flat_map(|shift| own.iter().map(move |time| shift + time))
            .collect(),
    )
}

fn goes_by_time(mechanism: &Mechanism, measure: &Measure) -> bool {
    let mut found = false;
    visit_leaves(mechanism, measure, &mut |leaf| {
        found |= matches!(leaf, Leaf::Time);
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_dynamics::table::Table;

    #[test]
    fn points_of_tables_that_repeat_are_met_from_the_start() {
        for (first, period) in [(0.0, 1.0), (2.5, 1.0), (-3.25, 1.5), (0.75, 0.8)] {
            let at = [first, first + 0.25, first + 0.5];
            let table = Table::new(&at, &[0.0, 1.0, 0.0], Some(period)).unwrap();
            let amount = Amount {
                measure: Expr::Leaf(Leaf::Time),
                curve: Some((table, 1.0)),
            };
            let times = times(&amount, 10.0).unwrap();
            for x in at {
                let mut met = x - ((x / period).floor() * period);
                while met < 10.0 {
                    assert!(
                        times.iter().any(|t| (t - met).abs() < 1e-12),
                        "{first} {met}"
                    );
                    met += period;
                }
            }
        }
    }
}
