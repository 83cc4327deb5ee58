//! Designs that are less than all their neighbours: each may lie in a valley of its own (A. Törn and S. Viitanen's topographical search, 1994).

use crate::space::Space;

/// Neighbours of a design, for each variable.
const NEIGHBOURS: usize = 2;

/// Which designs are the nearest to each.
pub(crate) struct Topography {
    near: Vec<Vec<usize>>,
}

impl Topography {
    /// Of designs all over a box.
    pub fn of(designs: &[&[f64]], space: &Space) -> Self {
        let near = |k: usize| {
            let others = (0..designs.len()).filter(|other| *other != k);
            let others = others.map(|other| (space.distance(designs[k], designs[other]), other));
            let mut others: Vec<(f64, usize)> = others.collect();
            let count = (NEIGHBOURS * designs[k].len()).min(others.len());
            if count < others.len() {
                others
                    .select_nth_unstable_by(count, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                others.truncate(count);
            }
            others.into_iter().map(|(_, other)| other).collect()
        };
        Self {
            near: (0..designs.len()).map(near).collect(),
        }
    }

    /// Of an order of these designs those that come before all their neighbours.
    pub fn least(&self, order: &[usize]) -> Vec<usize> {
        let mut place = vec![usize::MAX; self.near.len()];
        for (k, design) in order.iter().enumerate() {
            place[*design] = k;
        }
        let is_least = |design: &&usize| {
            (self.near[**design].iter()).all(|other| place[*other] > place[**design])
        };
        order.iter().filter(is_least).copied().collect()
    }
}
