//! The ends of a front: the least of each objective, and where the others are least beside it.

use crate::front::{EndsFrom, FIRST_ORDER, Refined, Way};
use crate::one_of::OneOf;
use crate::problem::Candidate;
use crate::progress::{Ended, Progress};
use crate::rounds::{Begun, Further, MultiStartOptions, choose, followed, scales_of};
use crate::space::Space;
use crate::standing::ranked;
use crate::topography::Topography;
use crate::widen::{Lead, NEAR, Widening, with_found};

/// Designs that a way to an end tries, about, and one to the least of one objective alone: no more are begun than can be gone.
const OF_END: usize = 60;
const OF_LEAST: usize = 20;
/// How often ends are led on that ways to others led to.
const AGAIN: usize = 3;

impl Lead<'_> {
    /// The front with its ends: the least of each objective, from the front and from what so many starts all over the box lead to, or more. Samples that are
    /// evaluated for them join others.
    pub(crate) fn with_ends(
        &mut self,
        front: Vec<Refined>,
        samples: &mut Vec<Candidate>,
        (widening, starts): (&Widening, usize),
    ) -> Vec<Refined> {
        let objectives = self.problem.objectives();
        // A third of what is left is for what lies between the ends.
        let most = match objectives {
            2 => self.left() - self.left() / 3,
            _ => self.left(),
        };
        let before = self.evaluations;
        let starts = starts.min(most / (objectives * OF_END));
        if starts > 0 {
            self.ends_from = EndsFrom::Samples;
        }
        let ranges = self.ranges(&front);
        let mut begun = Vec::new();
        for k in 0..objectives {
            let best = best(&front, k).cloned();
            let design = best.as_ref().map(|it| it.design.clone());
            self.led.extend(design.clone().map(|it| (k, it)));
            let mut ways = Vec::new();
            if starts > 0 && self.goes_on() {
                let spent = self.evaluations - before;
                let most = most.saturating_sub(spent) / 2 / (objectives - k);
                let end = (k, design, ranges[k]);
                ways = self.on_from_least(end, samples, (widening, starts), most);
            }
            if ways.is_empty() {
                ways.extend(best.map(|it| Way::to_end(&it, k)));
            }
            begun.extend(ways.into_iter().map(|way| (k, way)));
        }
        if self.ended == Ended::Stopped {
            return with_found(front, begun.into_iter().map(|(_, way)| way).collect());
        }
        let spent = self.evaluations - before;
        self.led_to_ends(front, begun, most.saturating_sub(spent))
    }

    /// Ways on from what a known end and starts all over the box lead to where one objective alone is lessened, by the front's range of that.
    fn on_from_least(
        &mut self,
        (objective, end, range): (usize, Option<Vec<f64>>, f64),
        samples: &mut Vec<Candidate>,
        (widening, starts): (&Widening, usize),
        most: usize,
    ) -> Vec<Way> {
        let alone = OneOf::new(self.problem, objective);
        let n = self.problem.bounds().len();
        let options = MultiStartOptions {
            samples: Some(widening.samples * n),
            starts,
            further: widening.further.clone(),
            start: widening.start.clone(),
            evaluations: most,
            sqp: self.options.clone(),
            seed: widening.seed,
        };
        let begun = Begun {
            evaluations: self.evaluations,
            scales: None,
            samples: samples.iter().map(|it| alone.of(it)).collect(),
            start: end,
        };
        let (budget, hears) = (self.budget, &mut self.hears);
        let found = followed(&alone, &options, begun, self.workers, &mut |told| {
            hears(&Progress {
                budget,
                best: None,
                violation: 0.0,
                ..*told
            })
        });
        self.evaluations += found.evaluations;
        if found.ended == Ended::Stopped {
            self.ended = Ended::Stopped;
            return Vec::new();
        }
        let may_be = |further: &Further| found.reached.unseen() > further.unseen;
        if widening.further.as_ref().is_some_and(may_be) && found.reached.starts() > 0 {
            self.ends_from = EndsFrom::SomeSamples;
        }
        let space = Space::new(self.problem.bounds());
        let optima = found.optima(self.options.feasibility, starts, &space);
        samples.extend(alone.looked_at());
        let ways = optima.into_iter().map(|it| {
            let candidate = self.known(it.design);
            if !it.ended.is_optimal() {
                return Way::to_end(&candidate, objective);
            }
            let mut shares = vec![0.0; self.problem.objectives()];
            shares[objective] = 1.0;
            let scale = it.scales.objectives.first();
            let least = Refined {
                candidate,
                residual: it.residual * scale.map_or(1.0, |scale| scale / range),
                shares,
                ended: it.ended,
            };
            Way::on_from(least, objective)
        });
        ways.collect()
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
            let Some(end) = best(&front, k) else { continue };
            let others = self.others(known, (k, end), starts);
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

    /// The designs from which the least of one objective is sought beside an end of the front: those that are less than all their neighbours.
    fn others<'c>(
        &self,
        designs: &'c [Candidate],
        (objective, end): (usize, &Candidate),
        starts: usize,
    ) -> Vec<&'c Candidate> {
        let space = Space::new(self.problem.bounds());
        let one = OneOf::new(self.problem, objective);
        let alone: Vec<Candidate> = designs.iter().chain([end]).map(|it| one.of(it)).collect();
        let scales = scales_of(&one, &alone);
        let order = ranked(&alone, &scales, self.options.feasibility);
        let all: Vec<&[f64]> = alone.iter().map(|it| it.design.as_slice()).collect();
        let mut order = Topography::of(&all, &space).least(&order);
        order.retain(|k| *k < designs.len());
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
