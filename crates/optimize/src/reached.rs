//! What starts led to, and what may be left to find.

use crate::problem::Scales;
use crate::progress::Ended;
use crate::space::Space;
use crate::sqp::Optimum;
use crate::standing::worst_first;

/// Optima nearer than this part of the box whose objectives agree to the other part are one.
pub(crate) const NEAR: f64 = 1e-3;
const AGREE: f64 = 1e-6;

/// Values that differ by less than this part of what is usual in the box are one, too: it is as far as ways down go.
const CLOSE: f64 = 1e-8;

/// The values that starts led to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reached {
    /// Each, rising.
    values: Vec<f64>,
    /// What is usual.
    scale: f64,
}

impl Reached {
    /// Takes up where starts led to, of values that are usually of this size.
    pub(crate) fn take(&mut self, values: impl Iterator<Item = f64>, scale: f64) {
        self.scale = scale;
        self.values.extend(values);
        self.values.sort_by(f64::total_cmp);
    }

    /// Starts that led to an optimum.
    pub fn starts(&self) -> usize {
        self.values.len()
    }

    /// Optima of different values.
    pub fn optima(&self) -> usize {
        let differ = |pair: &&[f64]| {
            let size = pair[0].abs().max(pair[1].abs());
            pair[1] - pair[0] > (AGREE * size).max(CLOSE * self.scale)
        };
        let further = self.values.windows(2).filter(differ).count();
        further + usize::from(!self.values.is_empty())
    }

    /// The part of all starts that lead to other values than these did, as is to be expected: `w (w + 1) / (s (s - 1))` where `s` starts led to `w` of them
    /// (C. G. E. Boender and A. H. G. Rinnooy Kan, 1987), 1 at most.
    pub fn unseen(&self) -> f64 {
        let [optima, starts] = [self.optima(), self.starts()].map(|count| count as f64);
        match starts > 1.0 {
            true => (optima * (optima + 1.0) / (starts * (starts - 1.0))).min(1.0),
            false => 1.0,
        }
    }
}

/// Those of some optima that differ, with how many of them each is, the best first.
pub(crate) fn distinct(
    found: impl IntoIterator<Item = Optimum>,
    (scales, tolerance): (&Scales, f64),
    space: &Space,
) -> Vec<(Optimum, usize)> {
    let mut reached = Vec::new();
    for optimum in found {
        add(&mut reached, optimum, space);
    }
    sorted(reached, scales, tolerance)
}

/// Puts an optimum beside those that were reached before, or counts it to the one that it is.
fn add(reached: &mut Vec<(Optimum, usize)>, optimum: Optimum, space: &Space) {
    let same = |other: &Optimum| {
        let (a, b) = (other.objective(), optimum.objective());
        other.ended.is_optimal() == optimum.ended.is_optimal()
            && ((a - b).abs() <= AGREE * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
                || [other, &optimum].map(|o| o.ended) == [Ended::Least; 2])
            && space.distance(&other.design, &optimum.design) <= NEAR
    };
    match reached.iter_mut().find(|(other, _)| same(other)) {
        Some((other, times)) => {
            *times += 1;
            if optimum.objective() < other.objective() && optimum.violation <= other.violation {
                *other = optimum;
            }
        }
        None => reached.push((optimum, 1)),
    }
}

/// The best first; of equals an optimum.
fn sorted(
    mut reached: Vec<(Optimum, usize)>,
    scales: &Scales,
    tolerance: f64,
) -> Vec<(Optimum, usize)> {
    let optimal = |o: &Optimum| u8::from(!o.ended.is_optimal());
    let keeps = |o: &Optimum| o.violation <= tolerance;
    reached.sort_by(|(a, _), (b, _)| {
        let by_worst = match (keeps(a), keeps(b)) {
            (false, false) => worst_first(&a.evaluation, &b.evaluation, scales, 0.0),
            (a, b) => b.cmp(&a),
        };
        let by_objective = || a.objective().total_cmp(&b.objective());
        (by_worst.then_with(by_objective)).then(optimal(a).cmp(&optimal(b)))
    });
    reached
}

#[cfg(test)]
mod tests {
    use super::Reached;

    fn of(values: impl Iterator<Item = f64>) -> Reached {
        let mut reached = Reached::default();
        reached.take(values, 1.0);
        reached
    }

    #[test]
    fn one_valley_is_known_after_seven_starts_and_each_further_takes_some_more() {
        let unseen =
            |optima: usize, starts: usize| of((0..starts).map(|k| (k % optima) as f64)).unseen();
        assert!(unseen(1, 6) > 0.05 && unseen(1, 7) < 0.05);
        assert!(unseen(2, 11) > 0.05 && unseen(2, 12) < 0.05);
        assert_eq!((unseen(4, 4), unseen(1, 1), unseen(1, 0)), (1.0, 1.0, 1.0));
    }

    #[test]
    fn values_that_agree_are_one() {
        let mut reached = of([1.0, -2.0, -2.0].into_iter());
        reached.take([1.0 + 1e-9, -2.0 + 1e-12].into_iter(), 1.0);
        assert_eq!((reached.starts(), reached.optima()), (5, 2));
        assert!((reached.unseen() - 0.3).abs() < 1e-15);
        assert_eq!(of([1e-20, 3e-12, 1e-9].into_iter()).optima(), 1);
    }
}
