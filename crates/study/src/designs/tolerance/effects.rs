//! What each of the things that differ does by itself, from pieces alone: the part of a number's variance that is left of it on average over all others.
//!
//! Main effects (I. M. Sobol', Math. Model. Comput. Exp. 1 (1993) 407-414). Pieces that have nearly the same of one thing are a class; what the means of
//! classes differ by comes from it (K. Pearson's correlation ratio), less what they differ by because each has few pieces.

use super::sampled::Question;

/// With fewer pieces than this in a class its mean says little.
const IN_CLASS: usize = 25;
/// Classes at most, and at least: with fewer nothing is told.
const CLASSES: [usize; 2] = [32, 4];
/// More pieces tell no more that is worth the time.
const MOST_PIECES: usize = 1 << 17;
/// What is less than so many times its standard error is not told from nothing.
const SURE: f64 = 3.0;

/// Main effects on a number.
pub(super) struct Effects {
    /// By source: its part of the variance; nothing where it is no more than `least`.
    pub parts: Vec<f64>,
    /// What is less than this is not told from nothing.
    pub least: f64,
}

impl Effects {
    /// Of a number by its values for the pieces, in their order; none where there are too few of them.
    pub fn new(question: &Question<'_, '_>, values: &[f64]) -> Option<Self> {
        let pieces: Vec<(usize, f64)> = (values.iter().copied().enumerate())
            .filter(|(_, x)| x.is_finite())
            .take(MOST_PIECES)
            .collect();
        let count = pieces.len() as f64;
        let classes = (pieces.len() / IN_CLASS).min(CLASSES[0]);
        if classes < CLASSES[1] {
            return None;
        }
        let mean = pieces.iter().map(|(_, x)| x).sum::<f64>() / count;
        let all = pieces.iter().map(|(_, x)| (x - mean) * (x - mean));
        let all: f64 = all.sum();
        let part = |source: usize| {
            let mut sums = vec![(0.0, 0.0); classes];
            for (piece, x) in &pieces {
                let drawn = question.sobol.coordinate(*piece as u32, source);
                let class = (drawn * classes as f64) as usize;
                let sum = &mut sums[class.min(classes - 1)];
                *sum = (sum.0 + 1.0, sum.1 + (x - mean));
            }
            let between = sums.iter().filter(|(count, _)| *count > 0.0);
            let between: f64 = between.map(|(count, sum)| sum * sum / count).sum();
            let within = (all - between) / (count - classes as f64);
            (between - (classes - 1) as f64 * within) / all
        };
        // The variance of the squares of so many means, where it does nothing.
        let least = SURE * (2.0 * (classes - 1) as f64).sqrt() / count;
        let parts = (0..question.sources.len()).map(part);
        let parts = parts.map(|x| if x > least { x } else { 0.0 }).collect();
        (all > 0.0).then_some(Self { parts, least })
    }
}
