//! Extremes that are as large as the largest, but for rounding, elsewhere on the motion: a number over it stands at a corner there.

/// Values that differ by less than this part of the largest are equal but for rounding.
const EQUAL: f64 = 1e-12;
/// What lies within this part of the motion belongs to one extreme.
const ONE: f64 = 1e-3;
/// So many are kept: of a motion that goes through the same many times, the first.
const MOST: usize = 16;

/// The largest values of a measure, each with its time.
#[derive(Clone, Debug)]
pub(super) struct Rivals {
    /// Times nearer to each other than this belong to one extreme, s.
    near: f64,
    list: Vec<(f64, f64)>,
}

impl Rivals {
    /// None yet, of a motion that lasts so long.
    pub fn new(duration: f64) -> Self {
        Self {
            near: ONE * duration,
            list: Vec::new(),
        }
    }

    /// Adds a value, where the measure is so large as far as it is known.
    pub fn take(&mut self, (time, value): (f64, f64), size: f64) {
        if !value.is_finite() {
            return;
        }
        let largest = self.list.iter().map(|(_, v)| *v);
        let largest = largest.fold(value, f64::max);
        let least = largest - EQUAL * size;
        self.list.retain(|(_, v)| *v >= least);
        if value < least {
            return;
        }
        let near = (self.list.iter()).position(|(t, _)| (t - time).abs() <= self.near);
        match near {
            Some(own) if value > self.list[own].1 => self.list[own] = (time, value),
            None if self.list.len() < MOST => self.list.push((time, value)),
            _ => {}
        }
    }

    /// Their times.
    pub fn times(&self) -> Vec<f64> {
        self.list.iter().map(|(time, _)| *time).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_as_large_elsewhere_is_kept_and_what_is_near_is_one() {
        let mut rivals = Rivals::new(1.0);
        let all = [(0.0, 1.0), (0.1, 2.0), (0.1001, 2.0 + 1e-15), (0.5, 1.9)];
        all.into_iter().for_each(|at| rivals.take(at, 2.0));
        assert_eq!(rivals.times(), [0.1001]);
        rivals.take((0.7, 2.0), 2.0);
        assert_eq!(rivals.times(), [0.1001, 0.7]);
        rivals.take((0.9, 3.0), 3.0);
        assert_eq!(rivals.times(), [0.9]);
    }
}
