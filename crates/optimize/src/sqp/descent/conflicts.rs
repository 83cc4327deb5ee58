//! Which constraints contradict each other by themselves, of those that are missed together.

use crate::progress::Ended;
use crate::workers::Alone;

use super::super::options::SqpOptions;
use super::super::violation::View;
use super::{Descent, RESTORATIONS};

/// Constraints that contradict each other, with their shares of the multipliers of the least violation, the largest first.
type Group = Vec<(usize, f64)>;

impl<'a> Descent<'a> {
    /// Of constraints that are missed together at a design of least violation those that contradict each other by themselves, group by group.
    pub(super) fn groups(
        &mut self,
        view: &View<'a>,
        design: &[f64],
        all: &[(usize, f64)],
    ) -> Vec<Group> {
        let mut groups = Vec::new();
        let mut left = all.to_vec();
        let mut next = Some((all.to_vec(), design.to_vec()));
        while let Some(found) = next {
            let group = self.smallest(view, found);
            left.retain(|(k, _)| view.is_eased(*k) || group.iter().all(|(own, _)| own != k));
            groups.push(group);
            next = self.still(view, &left, design);
        }
        groups
    }

    /// Of a group one after the other is left out, the least first, and what is not missed is not taken up again (J. W. Chinneck and E. W. Dravnieks,
    /// 1991).
    fn smallest(&mut self, view: &View<'a>, (mut group, mut design): (Group, Vec<f64>)) -> Group {
        for (left_out, _) in group.clone().iter().rev() {
            let others = group.iter().copied().filter(|(k, _)| k != left_out);
            let others: Group = others.collect();
            if others.len() < group.len()
                && let Some(still) = self.still(view, &others, &design)
            {
                (group, design) = still;
            }
        }
        group
    }

    /// Those of some constraints that are still missed where no others are looked at, and where their violation is least; `None` where all are kept, or
    /// no more designs are allowed.
    fn still(
        &mut self,
        view: &View<'a>,
        some: &[(usize, f64)],
        design: &[f64],
    ) -> Option<(Group, Vec<f64>)> {
        if some.iter().all(|(k, _)| view.is_eased(*k)) {
            return None;
        }
        let all = 0..view.problem.constraints();
        let left_out = all.filter(|k| some.iter().all(|(own, _)| own != k));
        let alone = View {
            left_out: left_out.collect(),
            ..view.clone()
        };
        let options = SqpOptions {
            evaluations: (self.search.allowed).saturating_sub(self.search.evaluations),
            ..self.options.clone()
        };
        let mut inner = (options.evaluations > 0)
            .then(|| Self::of(alone.clone(), design, &options).ok())
            .flatten()?;
        inner.restorations = RESTORATIONS;
        let ended = loop {
            if inner.meets_all() {
                break Ended::Stopped;
            }
            if let Some(ended) = inner.step(&Alone) {
                break ended;
            }
        };
        let found = inner.end(ended);
        self.search.evaluations += found.evaluations;
        self.search.slopes += found.slopes;
        let missed = found.ended.is_optimal() && found.objective() > self.options.feasibility;
        let group = alone.conflict(&found.design, &found.multipliers);
        (missed && !group.is_empty()).then_some((group, found.design))
    }
}
