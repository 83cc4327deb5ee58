//! Gaps of a front of two objectives, where its designs are farther apart than they should be.

use crate::front::Refined;
use crate::problem::Candidate;

/// A gap this many times as wide as others should be is one.
const WIDE: f64 = 1.6;

/// How far two designs are apart, by the front's ranges.
pub(crate) fn width(a: &Refined, b: &Refined, ranges: &[f64]) -> f64 {
    let [a, b] = [a, b].map(|m| &m.candidate.evaluation.objectives);
    let both = a.iter().zip(b).zip(ranges);
    both.map(|((a, b), range)| ((b - a) / range).abs()).sum()
}

/// Between a member and the next, so many designs are missing.
pub(crate) struct Gap {
    after: usize,
    pub missing: usize,
}

impl Gap {
    pub fn ends<'m>(&self, members: &'m [Refined]) -> [&'m Candidate; 2] {
        [self.after, self.after + 1].map(|k| &members[k].candidate)
    }

    /// Places on the chord between its ends.
    pub fn places(&self, members: &[Refined]) -> Vec<Place> {
        let [a, b] = self.ends(members);
        let between = |a: &[f64], b: &[f64], part: f64| -> Vec<f64> {
            let both = a.iter().zip(b);
            both.map(|(a, b)| a + part * (b - a)).collect()
        };
        let parts = (1..=self.missing).map(|k| k as f64 / (self.missing + 1) as f64);
        let place = parts.map(|part| Place {
            blend: between(&a.design, &b.design, part),
            nearer: if part <= 0.5 { a } else { b }.design.clone(),
            target: between(&a.evaluation.objectives, &b.evaluation.objectives, part),
        });
        place.collect()
    }
}

/// A place on the chord between two designs.
pub(crate) struct Place {
    /// The design between them.
    pub blend: Vec<f64>,
    /// The nearer of both.
    pub nearer: Vec<f64>,
    /// The objectives there.
    pub target: Vec<f64>,
}

pub(crate) fn objectives_of(candidate: &Candidate) -> Vec<f64> {
    candidate.evaluation.objectives.clone()
}

/// The gaps of a front of two objectives that should have so many designs evenly, the widest first, with so many missing at most.
pub(crate) fn gaps(
    members: &[Refined],
    ranges: &[f64],
    (points, most): (usize, usize),
    empty: &[[Vec<f64>; 2]],
) -> Vec<Gap> {
    // What is too much in the end where it was thick is left out.
    let left = (2 * points).saturating_sub(members.len()).min(most);
    let widths = members.windows(2).map(|pair| {
        let known = empty.contains(&[0, 1].map(|k| objectives_of(&pair[k].candidate)));
        if known {
            0.0
        } else {
            width(&pair[0], &pair[1], ranges)
        }
    });
    let widths: Vec<f64> = widths.collect();
    let wanted = widths.iter().sum::<f64>() / points.saturating_sub(1).max(1) as f64;
    let mut order: Vec<usize> = (0..widths.len()).collect();
    order.sort_by(|a, b| widths[*b].total_cmp(&widths[*a]).then(a.cmp(b)));
    let mut all: Vec<Gap> = Vec::new();
    let mut placed = 0;
    for after in order {
        let missing = (widths[after] / wanted).round() as usize;
        let missing = missing.saturating_sub(1).max(1).min(left - placed);
        if missing == 0 || widths[after].is_nan() || widths[after] <= WIDE * wanted {
            break;
        }
        placed += missing;
        all.push(Gap { after, missing });
    }
    all
}
