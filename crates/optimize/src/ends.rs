//! The ends of a front: the least of each objective, and where the others are least beside it.

use crate::front::{EndsFrom, FIRST_ORDER, Refined, Way};
use crate::multi_start::{choose, scales_of};
use crate::problem::Evaluation;
use crate::progress::Ended;
use crate::space::Space;
use crate::standing::{Candidate, ranked};
use crate::topography::Topography;
use crate::widen::{Lead, NEAR, with_found};

/// Designs that a way to an end tries, about, and one to the least of one objective alone: no more are begun than can be gone.
const OF_END: usize = 60;
const OF_LEAST: usize = 20;
/// How often ends are led on that ways to others led to.
const AGAIN: usize = 3;

impl Lead<'_> {
    /// The front with its ends: the least of each objective, from the front and from elsewhere.
    pub(crate) fn with_ends(
        &mut self,
        front: Vec<Refined>,
        (samples, own, starts): (&[Candidate], Option<&Candidate>, usize),
    ) -> Vec<Refined> {
        let objectives = self.problem.objectives();
        // A third of what is left is for what lies between the ends.
        let most = match objectives {
            2 => self.left() - self.left() / 3,
            _ => self.left(),
        };
        let starts = starts.min(most / (objectives * OF_END));
        let mut begun = Vec::new();
        for k in 0..objectives {
            let best = best(&front, k).into_iter();
            self.led
                .extend(best.clone().map(|it| (k, it.design.clone())));
            let others = self.others(samples, (k, None), starts);
            let all = best.chain(own).chain(others);
            begun.extend(all.map(|start| (k, Way::to_end(start, k))));
        }
        if !samples.is_empty() && starts > 0 {
            self.ends_from = EndsFrom::Samples;
        }
        self.led_to_ends(front, begun, most)
    }

    /// The front with ends from elsewhere, where few designs may be evaluated: from known ones ways go to the least of each objective alone, and from the
    /// best of them on, if it is less than the end that there is.
    pub(crate) fn with_other_ends(
        &mut self,
        front: Vec<Refined>,
        (known, starts): (&[Candidate], usize),
    ) -> Vec<Refined> {
        let objectives = self.problem.objectives();
        let most = self.left() / 3;
        let starts = starts.min(most / (objectives * OF_LEAST));
        if !self.goes_on() || known.is_empty() || starts == 0 {
            return front;
        }
        self.ends_from = EndsFrom::Known;
        let before = self.evaluations;
        let ranges = self.ranges(&front);
        let mut begun = Vec::new();
        for k in 0..objectives {
            let others = self.others(known, (k, best(&front, k)), starts);
            begun.extend(others.into_iter().map(|start| (k, Way::to_least(start, k))));
        }
        let (of, mut ways): (Vec<usize>, Vec<Way>) = begun.into_iter().unzip();
        self.go(&mut ways, &ranges, most);
        if self.ended == Ended::Stopped {
            return front;
        }
        let on = (0..objectives).filter_map(|k| {
            let own = of.iter().zip(&ways).filter(|(of, _)| **of == k);
            let found = own.filter_map(|(_, way)| way.member.as_ref().map(|it| &it.candidate));
            let value = |it: &Candidate| it.evaluation.objectives[k];
            let there = found.min_by(|a, b| value(a).total_cmp(&value(b)))?;
            let is_less = value(there) < value(best(&front, k)?) - NEAR * ranges[k];
            is_less.then(|| (k, Way::to_end(there, k)))
        });
        let on: Vec<(usize, Way)> = on.collect();
        self.note_led(&of, &ways);
        let front = with_found(front, ways);
        self.led_to_ends(front, on, most.saturating_sub(self.evaluations - before))
    }

    /// The front led on from what is its end though no way to that led there: on the way to the least of one objective there may be a valley that is lower in
    /// others, too. Where designs do for it, from the end of each objective to those of all others.
    pub(crate) fn with_ends_of_others(
        &mut self,
        mut front: Vec<Refined>,
        from_all: bool,
    ) -> Vec<Refined> {
        let objectives = self.problem.objectives();
        for _ in 0..AGAIN {
            let mut begun: Vec<(usize, Way)> = Vec::new();
            for k in 0..objectives {
                for from in (0..objectives).filter(|from| from_all || *from == k) {
                    let Some(start) = best(&front, from) else {
                        continue;
                    };
                    let way = (k, start.design.clone());
                    if !self.led.contains(&way) {
                        self.led.push(way);
                        begun.push((k, Way::to_end(start, k)));
                    }
                }
            }
            if begun.is_empty() || !self.goes_on() {
                break;
            }
            let most = self.left() / 3;
            front = self.led_to_ends(front, begun, most);
        }
        front
    }

    /// Notes where ways to the ends of objectives led to.
    fn note_led(&mut self, objectives: &[usize], ways: &[Way]) {
        for (k, way) in objectives.iter().zip(ways) {
            let there = way.member.as_ref().map(|it| it.candidate.design.clone());
            self.led.extend(there.map(|design| (*k, design)));
        }
    }

    /// The front with where ways lead to, each to the end of one objective, for which so many designs may be evaluated.
    fn led_to_ends(
        &mut self,
        front: Vec<Refined>,
        begun: Vec<(usize, Way)>,
        most: usize,
    ) -> Vec<Refined> {
        let objectives = self.problem.objectives();
        let (ends, mut ways): (Vec<usize>, Vec<Way>) = begun.into_iter().unzip();
        let ranges = self.ranges(&front);
        let was_cut = self.go(&mut ways, &ranges, most).was_cut;
        self.note_led(&ends, &ways);
        let is_open = |k: &usize| {
            let mut own = ends.iter().zip(&ways).filter(|(end, _)| *end == k);
            own.any(|(_, way)| way.is_open)
        };
        let open: Vec<usize> = (0..objectives).filter(is_open).collect();
        // What was stopped on its way is no end.
        ways.retain(|way| {
            let stopped = |m: &Refined| m.ended == Ended::Stopped;
            !way.member.as_ref().is_some_and(stopped)
        });
        let mut members = with_found(front, ways);
        if !open.is_empty() && self.goes_on() {
            let ranges = self.ranges(&members);
            let ways = (open.iter()).filter_map(|k| Some(Way::beside(best(&members, *k)?, *k)));
            let mut ways: Vec<Way> = ways.collect();
            self.go(&mut ways, &ranges, usize::MAX);
            self.note_led(&open, &ways);
            members = with_found(members, ways);
        }
        let mut ends = (0..objectives).filter_map(|k| end(&members, k));
        self.is_short |= was_cut && ends.any(|end| !(end.residual <= FIRST_ORDER));
        members
    }

    /// The designs from which the least of one objective is sought besides: from the end of a front there may be a way to a place alone that is least among
    /// those near to it. Beside that end, if it is told, only those that are less than all their neighbours.
    fn others<'c>(
        &self,
        designs: &'c [Candidate],
        (objective, beside): (usize, Option<&Candidate>),
        starts: usize,
    ) -> Vec<&'c Candidate> {
        let space = Space::new(self.problem.bounds());
        let alone = designs.iter().chain(beside).map(|it| {
            let own = it.evaluation.objectives.get(objective).copied();
            Candidate {
                design: it.design.clone(),
                evaluation: Evaluation {
                    objectives: own.into_iter().collect(),
                    ..it.evaluation.clone()
                },
            }
        });
        let alone: Vec<Candidate> = alone.collect();
        let scales = scales_of(self.problem, designs);
        let mut order = ranked(&alone, &scales, self.options.feasibility);
        if beside.is_some() {
            let all: Vec<&[f64]> = alone.iter().map(|it| it.design.as_slice()).collect();
            order = Topography::of(&all, &space).least(&order);
            order.retain(|k| *k < designs.len());
        }
        let chosen = choose(designs, &order, starts, &space).into_iter();
        chosen.map(|k| &designs[k]).collect()
    }
}

/// The design of a front with the least of one objective.
fn best(front: &[Refined], objective: usize) -> Option<&Candidate> {
    end(front, objective).map(|it| &it.candidate)
}

fn end(front: &[Refined], objective: usize) -> Option<&Refined> {
    let value = |it: &&Refined| it.candidate.evaluation.objectives[objective];
    (front.iter()).min_by(|a, b| value(a).total_cmp(&value(b)))
}
