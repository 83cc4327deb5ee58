//! A front led from designs of other valleys: where limits part the box into islands, or a valley ends beside the front, each may have a piece of the front
//! that no way from the others leads to.

use crate::front::{Refined, Way};
use crate::problem::{Candidate, Evaluation};
use crate::refine::evenly;
use crate::rounds::{choose, scales_of};
use crate::space::Space;
use crate::standing::{Standing, ranked};
use crate::topography::Topography;
use crate::widen::{Lead, with_found};

/// Places of the front towards which ways go, and ways at most.
const PLACES: usize = 8;
const WAYS: usize = 16;
/// Designs that one tries, about, and the part of those that are left that is for all of them.
const OF_WAY: usize = 20;
const PART: usize = 6;

impl Lead<'_> {
    /// The front with where ways lead to from designs that are nearer to some place of it than all their neighbours, the front's own among them.
    pub(crate) fn with_other_valleys(
        &mut self,
        front: Vec<Refined>,
        known: &[Candidate],
    ) -> Vec<Refined> {
        let most = self.left() / PART;
        let wanted = (most / OF_WAY).min(WAYS);
        if !self.goes_on() || wanted == 0 {
            return front;
        }
        let ranges = self.ranges(&front);
        let space = Space::new(self.problem.bounds());
        let scales = scales_of(self.problem, known);
        let own = front.iter().map(|member| &member.candidate);
        let all: Vec<&Candidate> = known.iter().chain(own).collect();
        let designs: Vec<&[f64]> = all.iter().map(|it| it.design.as_slice()).collect();
        let topography = Topography::of(&designs, &space);
        // Of each the place of the front that it is nearest to, and how it stands there.
        let mut starts: Vec<Option<(Standing, Vec<f64>)>> = vec![None; known.len()];
        for place in evenly(&front, PLACES) {
            let target = &place.candidate.evaluation.objectives;
            let told = all.iter().map(|it| towards(it, target, &ranges));
            let told: Vec<Candidate> = told.collect();
            let order = ranked(&told, &scales, self.options.feasibility);
            for k in topography.least(&order) {
                if k >= known.len() || !known[k].evaluation.is_defined() {
                    continue;
                }
                let here = Standing::of(&told[k].evaluation, &scales, self.options.feasibility);
                let is_better = |(before, _): &(Standing, _)| here.order(before).is_lt();
                if starts[k].as_ref().is_none_or(is_better) {
                    starts[k] = Some((here, target.clone()));
                }
            }
        }
        let mut order: Vec<(usize, Standing)> = (starts.iter().enumerate())
            .filter_map(|(k, start)| start.as_ref().map(|(standing, _)| (k, *standing)))
            .collect();
        order.sort_by(|(_, a), (_, b)| a.order(b));
        let order: Vec<usize> = order.into_iter().map(|(k, _)| k).collect();
        let chosen = choose(known, &order, wanted, &space).into_iter();
        let ways = chosen.filter_map(|k| {
            let (_, target) = starts[k].take()?;
            Some(Way::towards(known[k].design.clone(), target))
        });
        let mut ways: Vec<Way> = ways.collect();
        self.go(&mut ways, &ranges, most);
        with_found(front, ways)
    }
}

/// A design by its largest change from a target alone.
fn towards(candidate: &Candidate, target: &[f64], ranges: &[f64]) -> Candidate {
    let changes = candidate
        .evaluation
        .objectives
        .iter()
        .zip(target)
        .zip(ranges);
    let changes = changes.map(|((own, target), range)| (own - target) / range);
    Candidate {
        design: Vec::new(),
        evaluation: Evaluation {
            objectives: changes.reduce(f64::max).into_iter().collect(),
            ..candidate.evaluation.clone()
        },
    }
}
