//! Many values in a few numbers.

use super::spread::normal_quantile;

/// Parts of all pieces below which a value is told.
pub(super) const PARTS: [f64; 5] = [0.001_35, 0.05, 0.5, 0.95, 0.998_65];

/// What many values are.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Summary {
    /// How many values there are.
    pub count: usize,
    pub mean: f64,
    pub deviation: f64,
    pub least: f64,
    pub greatest: f64,
    /// By [`PARTS`]: the value that this part stays below; none where there are too few values to tell.
    pub quantiles: [Option<f64>; PARTS.len()],
}

impl Summary {
    /// Of what is finite; `None` where nothing is.
    pub fn new(values: &[f64]) -> Option<Self> {
        let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        let first = *finite.first()?;
        let count = finite.len();
        let n = count as f64;
        let mean = first + finite.iter().map(|x| x - first).sum::<f64>() / n;
        let square: f64 = finite.iter().map(|x| (x - mean) * (x - mean)).sum();
        let least = finite.iter().copied().min_by(f64::total_cmp);
        let greatest = finite.iter().copied().max_by(f64::total_cmp);
        Some(Self {
            count,
            mean,
            deviation: (square / (n - 1.0).max(1.0)).sqrt(),
            least: least.unwrap_or(first),
            greatest: greatest.unwrap_or(first),
            quantiles: PARTS.map(|part| {
                let few = part.min(1.0 - part) * n < 1.0;
                (!few).then(|| quantile(&mut finite, part))
            }),
        })
    }
}

/// The value that a part of all values stays below; their order changes.
pub(super) fn quantile(values: &mut [f64], part: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = (part * values.len() as f64 - 0.5).clamp(0.0, last as f64);
    let below = place.floor() as usize;
    let (_, value, higher) = values.select_nth_unstable_by(below, f64::total_cmp);
    let value = *value;
    let above = higher.iter().copied().min_by(f64::total_cmp);
    value + (place - below as f64) * (above.unwrap_or(value) - value)
}

/// How many of all are good, with the interval in which that lies at 95 %: E. B. Wilson, J. Amer. Statist. Assoc. 22 (1927) 209-212.
/// Of pieces that are drawn more evenly than at random it is on the safe side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Yield {
    pub part: f64,
    pub within: [f64; 2],
}

impl Yield {
    pub fn new(good: usize, all: usize) -> Self {
        let n = all as f64;
        let part = good as f64 / n;
        let z = normal_quantile(0.975);
        let square = z * z / n;
        let middle = (part + 0.5 * square) / (1.0 + square);
        let half = z / (1.0 + square) * (part * (1.0 - part) / n + square / (4.0 * n)).sqrt();
        // What is sure on one side is so to the last digit.
        let low = if good == 0 { 0.0 } else { middle - half };
        let high = if good == all { 1.0 } else { middle + half };
        Self {
            part,
            within: [low, high],
        }
    }
}

/// Values counted in equal bins.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Ends of the bins.
    pub edges: Vec<f64>,
    /// Values in each.
    pub counts: Vec<f64>,
}

/// Bins at least and at most.
const BINS: [usize; 2] = [8, 60];

impl Counts {
    /// Of what is finite; `None` where all are one.
    pub fn new(values: &[f64], summary: &Summary) -> Option<Self> {
        let (low, high) = (summary.least, summary.greatest);
        if !(high - low > 1e-12 * low.abs().max(high.abs())) {
            return None;
        }
        let bins = ((summary.count as f64).sqrt() as usize).clamp(BINS[0], BINS[1]);
        let mut counts = vec![0.0; bins];
        for x in values.iter().filter(|x| x.is_finite()) {
            let bin = ((x - low) / (high - low) * bins as f64) as usize;
            counts[bin.min(bins - 1)] += 1.0;
        }
        let edge = |k: usize| low + (high - low) * k as f64 / bins as f64;
        Some(Self {
            edges: (0..=bins).map(edge).collect(),
            counts,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_values_are_told_as_by_hand() {
        let it = Summary::new(&[4.0, 1.0, f64::NAN, 2.0, 3.0]).expect("values");
        assert_eq!(
            (it.count, it.mean, it.least, it.greatest),
            (4, 2.5, 1.0, 4.0)
        );
        assert!((it.deviation - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(it.quantiles, [None, None, Some(2.5), None, None]);
        let many: Vec<f64> = (0..10_000).map(f64::from).collect();
        let it = Summary::new(&many).expect("values");
        assert_eq!(it.quantiles[1], Some(499.5));
        assert!(it.quantiles.iter().all(Option::is_some));
        assert!(Summary::new(&[f64::INFINITY]).is_none());
        let counts = Counts::new(&many, &it).expect("bins");
        assert_eq!((counts.counts.len(), counts.edges.len()), (60, 61));
        assert_eq!(counts.counts.iter().sum::<f64>(), 10_000.0);
    }

    /// L. D. Brown, T. T. Cai and A. DasGupta (2001): for 0 of 10 up to 0.2775, for 5 of 10 from 0.2366 to 0.7634.
    #[test]
    fn yields_lie_in_wilsons_interval() {
        let none = Yield::new(0, 10);
        assert!((none.within[1] - 0.2775).abs() < 1e-4 && none.within[0] == 0.0);
        let half = Yield::new(5, 10);
        assert!((half.within[0] - 0.2366).abs() < 1e-4 && (half.within[1] - 0.7634).abs() < 1e-4);
        assert_eq!(Yield::new(10, 10).within[1], 1.0);
    }
}
