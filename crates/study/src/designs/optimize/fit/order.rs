//! Which segment of a way each place falls to, in their order: dynamic programming.
//!
//! The first segment of a closed way is found by M. Maes (1990): of two starts the better assignments do not cross, so that those for starts between
//! them lie between, and halving the starts costs a logarithm more than one start.

use std::ops::RangeInclusive;

/// What each place costs on each segment of a way.
pub(super) struct Costs {
    segments: usize,
    of: Vec<f64>,
}

/// Segments of places in their order, and what they cost together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Assigned {
    /// The segments, not falling; of a closed way they count on past its end.
    pub segments: Vec<usize>,
    pub cost: f64,
}

impl Costs {
    /// Costs by place and segment.
    pub fn new(places: usize, segments: usize, cost: impl Fn(usize, usize) -> f64) -> Self {
        let all = (0..places).flat_map(|i| (0..segments).map(move |k| (i, k)));
        Self {
            segments,
            of: all.map(|(i, k)| cost(i, k)).collect(),
        }
    }

    fn places(&self) -> usize {
        self.of.len() / self.segments.max(1)
    }

    fn cost(&self, place: usize, segment: usize) -> f64 {
        self.of[place * self.segments + segment % self.segments]
    }

    /// The same with the places the other way round.
    pub fn turned(&self) -> Self {
        let rows = self.of.chunks_exact(self.segments.max(1)).rev();
        Self {
            segments: self.segments,
            of: rows.flatten().copied().collect(),
        }
    }

    /// The best segments along an open way.
    pub fn open(&self) -> Assigned {
        let last = self.segments - 1;
        self.within(&vec![0..=last; self.places()])
    }

    /// The best segments along a closed way.
    pub fn closed(&self) -> Assigned {
        let (n, k) = (self.places(), self.segments);
        let from = |start: usize, low: &[usize], high: &[usize]| {
            let window = |i: usize| -> RangeInclusive<usize> {
                match i {
                    0 => start..=start,
                    _ => low[i].max(start)..=high[i].min(start + k - 1),
                }
            };
            self.within(&(0..n).map(window).collect::<Vec<_>>())
        };
        let first = from(0, &vec![0; n], &vec![k - 1; n]);
        // A turn later it is the same.
        let last: Vec<usize> = first.segments.iter().map(|s| s + k).collect();
        let mut best = first.clone();
        let mut open: Vec<(usize, usize, Vec<usize>, Vec<usize>)> =
            vec![(0, k, first.segments, last)];
        while let Some((low, high, below, above)) = open.pop() {
            if high - low < 2 {
                continue;
            }
            let middle = (low + high) / 2;
            let found = from(middle, &below, &above);
            if found.cost < best.cost {
                best = found.clone();
            }
            open.push((low, middle, below, found.segments.clone()));
            open.push((middle, high, found.segments, above));
        }
        best
    }

    /// The best segments where each place has a window of them.
    fn within(&self, windows: &[RangeInclusive<usize>]) -> Assigned {
        // For each place and segment of its window: the least cost of all places so far, the last no farther than there, and where it is.
        let mut tables: Vec<(usize, Vec<(f64, usize)>)> = Vec::with_capacity(windows.len());
        for (i, window) in windows.iter().enumerate() {
            let first = *window.start();
            let mut least = (f64::INFINITY, first);
            let own = window.clone().map(|segment| {
                let before = match tables.last() {
                    None => 0.0,
                    Some((start, table)) => match segment.checked_sub(*start) {
                        None => f64::INFINITY,
                        Some(k) => table[k.min(table.len() - 1)].0,
                    },
                };
                let cost = before + self.cost(i, segment);
                if cost < least.0 {
                    least = (cost, segment);
                }
                least
            });
            let own = own.collect();
            tables.push((first, own));
        }
        let cost = tables
            .last()
            .and_then(|(_, t)| t.last())
            .map_or(0.0, |t| t.0);
        let mut segments = vec![0; tables.len()];
        let mut until = usize::MAX;
        for (segment, (start, table)) in segments.iter_mut().zip(&tables).rev() {
            let k = until
                .saturating_sub(*start)
                .min(table.len().saturating_sub(1));
            until = table.get(k).map_or(*start, |t| t.1);
            *segment = until;
        }
        Assigned { segments, cost }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempe_number::Random;

    fn all(costs: &Costs, from: usize, to: usize, i: usize) -> f64 {
        if i == costs.places() {
            return 0.0;
        }
        let tried = (from..=to).map(|s| costs.cost(i, s) + all(costs, s, to, i + 1));
        tried.fold(f64::INFINITY, f64::min)
    }

    /// Against every assignment there is.
    #[test]
    fn no_assignment_is_better() {
        let mut random = Random(5);
        for _ in 0..40 {
            let (n, k) = (4, 7);
            let table: Vec<f64> = (0..n * k).map(|_| random.uniform()).collect();
            let costs = Costs::new(n, k, |i, s| table[i * k + s]);
            let open = costs.open();
            assert!((open.cost - all(&costs, 0, k - 1, 0)).abs() < 1e-12);
            let closed = costs.closed();
            let starts = (0..k).map(|s| costs.cost(0, s) + all(&costs, s, s + k - 1, 1));
            let best = starts.fold(f64::INFINITY, f64::min);
            assert!((closed.cost - best).abs() < 1e-12);
            for found in [&open, &closed] {
                assert!(found.segments.windows(2).all(|pair| pair[0] <= pair[1]));
                let sum: f64 = (found.segments.iter().enumerate())
                    .map(|(i, s)| costs.cost(i, *s))
                    .sum();
                assert!((sum - found.cost).abs() < 1e-12);
            }
        }
    }
}
